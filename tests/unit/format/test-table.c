/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field tables themselves, and units: what the document says is what the program gets, bit for bit. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "reference/stage.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "document/geometry_table.h"
#include "format/json.h"
#include "http/routes.h"
#include "support/tap.h"

static uint64_t state = 42;

static double uniform(void) /* 0 .. 1, 53 bits */
{
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (double)(state >> 11) / 9007199254740992.;
}

/* The unit stands in the key, or in that of the object around it ("rms_m_per_s2": {"normal": ...}). */
static bool ends_with_suffix(const char *name, const struct eo_unit *unit)
{
  size_t key = strlen(name), suffix = strlen(unit->suffix);
  return key > suffix && name[key - suffix - 1] == '_' && strcmp(name + key - suffix, unit->suffix) == 0;
}

static bool sound_number(const struct eo_field *field)
{
  bool sound = field->low < field->high && (field->kind == EO_FIELD_NUMBERS || isnan(field->fallback) ||
                                            (field->fallback >= field->low && field->fallback <= field->high));
  if (field->kind == EO_FIELD_NUMBERS && field->fallbacks)
    for (int i = 0; i < field->count; i++)
      sound = sound && field->fallbacks[i] >= field->low && field->fallbacks[i] <= field->high;
  return sound && (!(field->flags & EO_FIELD_NULLABLE) || field->derived);
}

static int unsound(const struct eo_table *table, const char *around)
{
  int bad = 0;
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    bool number = field->kind == EO_FIELD_NUMBER || field->kind == EO_FIELD_NUMBERS || field->kind == EO_FIELD_INTEGER;
    bool sound = field->help && *field->help && field->offset < table->size &&
                 (!field->unit || ends_with_suffix(field->key, field->unit) || ends_with_suffix(around, field->unit)) &&
                 (!number || sound_number(field));
    sound = sound &&
            (field->kind != EO_FIELD_LIST || (field->high <= field->count && field->row_count <= field->count));
    sound = sound && (field->kind != EO_FIELD_CHOICE || field->choices);
    for (int j = 0; j < i; j++)
      sound = sound && strcmp(field->key, table->field[j].key) != 0;
    if (!sound) {
      bad++;
      printf("# %s: %s\n", table->name, field->key);
    }
    if (field->table)
      bad += unsound(field->table, field->key);
  }
  return bad;
}

static void test_tables(void)
{
  ok(unsound(&eo_design_table, "") == 0,
     "the design's tables have unique keys, units in the suffix, defaults within ranges, and help");
  ok(unsound(&eo_geometry_table, "") == 0, "the geometry's table has them too");
  const struct eo_stage *const stage[] = {
      &eo_stage_geometry,    &eo_stage_modification, &eo_stage_surface, &eo_stage_gap,       &eo_stage_tca,
      &eo_stage_flexibility, &eo_stage_hertz,        &eo_stage_contact, &eo_stage_impact,    &eo_stage_root_stress,
      &eo_stage_iso6336,     &eo_stage_dynamics,     &eo_stage_sdof,    &eo_stage_objective, &eo_stage_evaluation};
  for (size_t i = 0; i < sizeof stage / sizeof *stage; i++)
    ok(unsound(stage[i]->input, "") + unsound(stage[i]->output, "") == 0, "the tables of the stage %s have them too",
       stage[i]->name);
  for (int i = 0; eo_routes[i]; i++)
    for (const struct eo_route *route = eo_routes[i]; route->pattern; route++)
      ok(!route->order || unsound(route->order, "") == 0, "the table of what %s takes has them too", route->name);
}

/* An object that may be absent, with a series in it, alone and in a list. */
struct inner {
  double number;
  struct eo_numbers series;
};
static const struct eo_field inner[] = {
    EO_NUMBER_REQUIRED(struct inner, number, "number", NULL, 0, 10, "a number"),
    EO_SERIES(struct inner, series, "series_mm", &eo_unit_mm, 10, 0, 10, 0, "numbers"),
};
static const struct eo_table inner_table = EO_TABLE("inner", struct inner, inner);

struct outer {
  struct inner maybe;
  int present, rows;
  struct inner row[4];
};
static const struct eo_field outer[] = {
    EO_OPTIONAL(struct outer, maybe, present, "maybe", &inner_table, "nothing", "an object"),
    EO_LIST(struct outer, row, rows, "rows", &inner_table, 0, 4, "objects"),
};
static const struct eo_table outer_table = EO_TABLE("outer", struct outer, outer);

/* Reads the text, checks that it is printed as `expected`, and returns the number of faults. */
static int read_outer(const char *input, const char *expected)
{
  static struct eo_faults faults;
  struct outer read = {.present = -1};
  struct eo_error error;
  struct eo_text text = {0};
  json_t *document = eo_json_parse(input, strlen(input), &error), *back;
  faults.count = 0;
  eo_table_decode(&outer_table, document, NULL, &read, &faults);
  back = eo_table_encode(&outer_table, &read);
  eo_json_write(&text, back, EO_JSON_COMPACT);
  if (expected)
    ok(text.data && strcmp(text.data, expected) == 0, "%s is printed as %s", input, text.data ? text.data : "nothing");
  eo_text_done(&text);
  json_decref(back);
  json_decref(document);
  eo_table_done(&outer_table, &read);
  return faults.count;
}

static void test_optional(void)
{
  ok(read_outer("{}", "{\"maybe\":null,\"rows\":[]}") == 0, "an optional object may be absent");
  ok(read_outer("{\"maybe\":null}", "{\"maybe\":null,\"rows\":[]}") == 0, "an optional object may be null");
  ok(read_outer("{\"maybe\":{\"number\":1,\"series_mm\":[2,3]}}",
                "{\"maybe\":{\"number\":1,\"series_mm\":[2,3]},\"rows\":[]}") == 0,
     "an optional object may be there");
  ok(read_outer("{\"maybe\":{}}", NULL) == 1, "an optional object that is there requires what it says");
  ok(read_outer("{\"rows\":[{\"number\":1,\"series_mm\":[2]},{\"number\":2}]}",
                "{\"maybe\":null,\"rows\":[{\"number\":1,\"series_mm\":[2]},{\"number\":2,\"series_mm\":[]}]}") == 0,
     "rows with series are read and written");
  ok(read_outer("{\"rows\":[{\"number\":1,\"series_mm\":[2,11]},{\"number\":12}]}", NULL) == 2,
     "each fault of rows is told");
  ok(read_outer("{\"maybe\":3,\"rows\":[{\"number\":0},{\"number\":0},{\"number\":0},{\"number\":0},{\"number\":0}]}",
                NULL) == 2,
     "what is no object and too many rows are told");
}

/* What requests have that designs do not: another name of a key, an object that somebody else reads, whole numbers that
   may be absent, texts that may not be empty. */
struct order {
  double number, whole;
  char name[8];
  const json_t *document;
};
static const struct eo_field order[] = {
    {.key = "number_mm",
     .alias = "number",
     .kind = EO_FIELD_NUMBER,
     .offset = offsetof(struct order, number),
     .unit = &eo_unit_mm,
     .low = 0,
     .high = 10,
     .fallback = 1,
     .help = "a number"},
    {.key = "whole",
     .kind = EO_FIELD_NUMBER,
     .flags = EO_FIELD_NULLABLE | EO_FIELD_WHOLE,
     .offset = offsetof(struct order, whole),
     .low = -10,
     .high = 10,
     .fallback = NAN,
     .derived = "none",
     .help = "a whole number"},
    EO_TEXT_DERIVED(struct order, name, "name", 2, "none", "a text"),
    EO_DOCUMENT(struct order, document, "document", "Document", EO_FIELD_REQUIRED, "an object"),
};
static const struct eo_table order_table = EO_TABLE("order", struct order, order);

static void test_orders(void)
{
  static const struct {
    const char *input, *pointer; /* of the only fault; NULL: none */
    double number, whole;        /* mm */
    const char *name;
  } row[] = {{"{\"document\":{}}", NULL, 1, NAN, ""},
             {"{\"number\":2,\"whole\":-3,\"name\":\"ab\",\"document\":{\"any\":[1]}}", NULL, 2, -3, "ab"},
             {"{\"number_mm\":2,\"whole\":null,\"name\":null,\"document\":{}}", NULL, 2, NAN, ""},
             {"{\"number\":2,\"number_mm\":2,\"document\":{}}", "/number_mm", 2, NAN, ""},
             {"{\"number\":11,\"document\":{}}", "/number_mm", 1, NAN, ""},
             {"{\"whole\":0.5,\"document\":{}}", "/whole", 1, NAN, ""},
             {"{\"name\":\"a\",\"document\":{}}", "/name", 1, NAN, ""},
             {"{\"name\":\"\",\"document\":{}}", "/name", 1, NAN, ""},
             {"{\"document\":null}", "/document", 1, NAN, ""},
             {"{}", "/document", 1, NAN, ""}};
  static struct eo_faults faults;
  for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
    struct order read;
    json_t *document = json_loads(row[i].input, 0, NULL);
    faults.count = 0;
    eo_table_decode(&order_table, document, NULL, &read, &faults);
    bool right = row[i].pointer ? faults.count == 1 && strcmp(faults.fault[0].pointer, row[i].pointer) == 0
                                : !faults.count && read.document == json_object_get(document, "document");
    ok(right && fabs(1e3 * read.number - row[i].number) < 1e-9 && strcmp(read.name, row[i].name) == 0 &&
           (isnan(row[i].whole) ? isnan(read.whole) : read.whole == row[i].whole),
       "%s: %s", row[i].input, faults.count ? faults.fault[0].text : "read");
    json_decref(document);
  }
}

static const struct eo_unit *const units[] = {NULL,
                                              &eo_unit_mm,
                                              &eo_unit_um,
                                              &eo_unit_nm,
                                              &eo_unit_deg,
                                              &eo_unit_rpm,
                                              &eo_unit_Nm,
                                              &eo_unit_MPa,
                                              &eo_unit_GPa,
                                              &eo_unit_N_per_um,
                                              &eo_unit_per_mm,
                                              &eo_unit_ms,
                                              &eo_unit_um_mm_per_N,
                                              &eo_unit_um_per_N,
                                              &eo_unit_per_mm2};

static void test_units(void)
{
  int long_lost = 0, short_changed = 0, unsettled = 0, count = 20000;
  for (int i = 0; i < count; i++) {
    const struct eo_unit *unit = units[i % (int)(sizeof units / sizeof units[0])];
    double scale = pow(10, floor(20 * uniform() - 10)), value = scale * (uniform() - 0.5);
    double inside = eo_unit_in(unit, value);
    long_lost += eo_unit_in(unit, eo_unit_out(unit, inside)) != inside;
    char text[40];
    snprintf(text, sizeof text, "%.*g", 1 + (int)(12 * uniform()), value);
    double decimal = strtod(text, NULL);
    short_changed += eo_unit_out(unit, eo_unit_in(unit, decimal)) != decimal;
    double once = eo_unit_in(unit, eo_unit_out(unit, value)), twice = eo_unit_in(unit, eo_unit_out(unit, once));
    unsettled += once != twice || fabs(once - value) > 2.3e-16 * fabs(value);
  }
  ok(long_lost == 0, "%d random document numbers of all units survive out and in", count);
  ok(short_changed == 0, "decimals of up to 12 digits come back as they were written");
  ok(unsettled == 0, "any SI double settles at once, at most one rounding away");
  ok(eo_unit_in(&eo_unit_mm, 6) == 0.006 && eo_unit_in(&eo_unit_um, 14) == 14e-6 && eo_unit_in(&eo_unit_MPa, 1) == 1e6,
     "6 mm, 14 um and 1 MPa are the nearest doubles");
  close_to(eo_unit_in(&eo_unit_rpm, 2000), 209.43951023931953, 1e-12, "2000 rpm, in rad/s");
  close_to(eo_unit_in(&eo_unit_N_per_mm_um, 20), 2e10, 0, "20 N/(mm um), in Pa");
}

static bool same_bits(const void *a, const void *b, size_t size)
{
  return memcmp(a, b, size) == 0;
}

/* Member by member: padding between members is nobody's business. */
static bool same(const struct eo_table *table, const char *a, const char *b)
{
  bool equal = true;
  for (int i = 0; i < table->count && equal; i++) {
    const struct eo_field *field = &table->field[i];
    const char *x = a + field->offset, *y = b + field->offset;
    int rows = field->kind == EO_FIELD_LIST ? *(const int *)(a + field->count_offset) : 0;
    if (field->flags & EO_FIELD_ELSEWHERE)
      continue;
    switch (field->kind) {
    case EO_FIELD_NUMBER:
      equal = (isnan(*(const double *)x) && isnan(*(const double *)y)) || same_bits(x, y, sizeof(double));
      break;
    case EO_FIELD_INTEGER:
    case EO_FIELD_CHOICE:
      equal = same_bits(x, y, sizeof(int));
      break;
    case EO_FIELD_SEED:
      equal = same_bits(x, y, sizeof(uint64_t));
      break;
    case EO_FIELD_FLAG:
      equal = *(const bool *)x == *(const bool *)y;
      break;
    case EO_FIELD_TEXT:
      equal = strcmp(x, y) == 0;
      break;
    case EO_FIELD_NAMES:
      equal = memcmp(x, y, (size_t)field->count * (size_t)field->room) == 0;
      break;
    case EO_FIELD_NUMBERS:
      equal = isnan(*(const double *)x) ? isnan(*(const double *)y)
                                        : same_bits(x, y, (size_t)field->count * sizeof(double));
      break;
    case EO_FIELD_OBJECT:
      if (field->flags & EO_FIELD_NULLABLE && !*(const int *)(a + field->count_offset))
        equal = !*(const int *)(b + field->count_offset);
      else
        equal = same(field->table, x, y);
      break;
    case EO_FIELD_LIST:
      equal = rows == *(const int *)(b + field->count_offset);
      for (int j = 0; j < rows && equal; j++)
        equal = same(field->table, x + (size_t)j * field->table->size, y + (size_t)j * field->table->size);
      break;
    case EO_FIELD_SERIES:
    case EO_FIELD_MATRIX:
    case EO_FIELD_DOCUMENT:
      break;
    }
    if (!equal)
      printf("# differs: %s\n", field->key);
  }
  return equal;
}

static bool same_design(const struct eo_design *a, const struct eo_design *b)
{
  return same(&eo_design_table, (const char *)a, (const char *)b);
}

/* Through encode, text, parser and decode. */
static bool through_text(const struct eo_design *design, struct eo_design *back)
{
  static struct eo_faults faults;
  struct eo_error error;
  struct eo_text text = {0};
  struct eo_warnings warnings = {0};
  json_t *document = eo_design_encode(design);
  eo_json_write(&text, document, EO_JSON_PRETTY);
  json_decref(document);
  json_t *parsed = eo_json_parse(text.data, text.size, &error);
  faults.count = 0;
  bool good = parsed && eo_design_decode(parsed, back, &warnings, &faults) && warnings.count == 0;
  if (!good)
    printf("# %s: %s\n", parsed ? faults.fault[0].pointer : "", parsed ? faults.fault[0].text : error.text);
  json_decref(parsed);
  eo_text_done(&text);
  return good;
}

static void test_examples(void)
{
  const struct eo_example *example;
  for (int i = 0; (example = eo_example_at(i)); i++) {
    static struct eo_design design, back, complete, again;
    struct eo_geometry geometry, geometry_again;
    struct eo_error error = {0};
    char hash[EO_HASH_LENGTH + 1], hash_again[EO_HASH_LENGTH + 1];
    ok(eo_example_build(example->name, &design) && through_text(&design, &back) && same_design(&design, &back),
       "%s survives its document", example->name);
    complete = design;
    if (!ok(eo_design_complete(&complete, &geometry, &error) == EO_OK, "%s is a possible design %s %s", example->name,
            error.pointer, error.text))
      continue;
    ok(through_text(&complete, &back) && same_design(&complete, &back), "%s survives with every default resolved",
       example->name);
    again = back;
    ok(eo_design_complete(&again, &geometry_again, &error) == EO_OK && same_design(&complete, &again) &&
           memcmp(&geometry, &geometry_again, sizeof geometry) == 0,
       "%s: completing the resolved document changes nothing, the geometry's bits included", example->name);
    ok(!eo_design_hash(&complete, hash, &error) && !eo_design_hash(&again, hash_again, &error) &&
           strcmp(hash, hash_again) == 0 && strlen(hash) == 64,
       "%s has the hash %.8s before and after", example->name, hash);
  }
}

static json_t *random_value(const struct eo_field *field);

/* Keys that say otherwise what another key says, and those that other code reads. */
static bool is_alternative(const struct eo_field *field)
{
  return field->flags & EO_FIELD_ELSEWHERE || strcmp(field->key, "hours") == 0 ||
         (strncmp(field->key, "shaft_angle_error", 17) == 0 && field->unit == &eo_unit_um);
}

static json_t *random_object(const struct eo_table *table)
{
  json_t *object = json_object();
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    if (field->flags & EO_FIELD_ENTRY || is_alternative(field)) /* what is read and never written cannot come back */
      continue;
    if (field->flags & EO_FIELD_REQUIRED || uniform() < 0.8)
      json_object_set_new(object, field->key,
                          strcmp(field->key, "version") ? random_value(field) : json_integer((json_int_t)field->high));
  }
  return object;
}

static double random_number(const struct eo_field *field)
{
  double value = field->low + (field->high - field->low) * pow(uniform(), 8 * uniform());
  return fmin(fmax(value, field->low), field->high);
}

static json_t *random_value(const struct eo_field *field)
{
  int choices = 0, rows = field->count ? 1 + (int)(uniform() * fmin(field->count, 4)) : 0;
  json_t *array;
  double low;
  for (; field->choices && field->choices[choices]; choices++)
    ;
  choices -= choices > 0 && strcmp(field->choices[choices - 1], "lead_slope_um") == 0; /* migrated on reading */
  if (field->flags & EO_FIELD_NULLABLE && field->kind != EO_FIELD_NUMBERS && uniform() < 0.3 &&
      strcmp(field->key, "share") != 0)
    return json_null();
  switch (field->kind) {
  case EO_FIELD_NUMBER:
    return json_real(random_number(field));
  case EO_FIELD_INTEGER:
  case EO_FIELD_SEED:
    return json_real(floor(random_number(field)));
  case EO_FIELD_FLAG:
    return json_boolean(uniform() < 0.5);
  case EO_FIELD_TEXT:
    return json_string(choices             ? field->choices[(int)(choices * uniform())]
                       : field->count < 40 ? "cd25"
                                           : "Stirnradgetriebe \xc3\xa4\xe2\x82\xac \"x\" \\ \n");
  case EO_FIELD_NAMES:
    return json_integer((json_int_t)field->low);
  case EO_FIELD_CHOICE:
    return json_string(field->choices[(int)(choices * uniform())]);
  case EO_FIELD_NUMBERS:
    array = json_array();
    low = random_number(field) / 2;
    for (int i = 0; i < field->count; i++)
      json_array_append_new(
          array, json_real(low + (i + 1) * (field->high - low) / (field->count + 1) * (0.9 + 0.1 * uniform())));
    return array;
  case EO_FIELD_OBJECT:
    return random_object(field->table);
  case EO_FIELD_LIST:
    array = json_array();
    for (int i = 0; i < rows && strcmp(field->key, "grid_nodes") != 0; i++) /* which go into the grid when written */
      json_array_append_new(array, random_object(field->table));
    return array;
  case EO_FIELD_SERIES:
  case EO_FIELD_MATRIX:
  case EO_FIELD_DOCUMENT:
    break;
  }
  return NULL;
}

/* Shares as they are after a first reading, so that only the encoding is on trial. */
static void state_shares(json_t *document)
{
  json_t *cases = json_object_get(document, "load_cases"), *row;
  size_t i;
  json_array_foreach(cases, i, row) json_object_set_new(row, "share", json_real(1 + uniform()));
}

/* Torque and speed without signs, which would say what direction and driver say beside them. */
static void drop_signs(json_t *document)
{
  static const char *const keys[] = {"torque_Nm", "speed_rpm", "power_kW"};
  json_t *cases = json_object_get(document, "load_cases"), *row;
  size_t i;
  json_array_foreach(cases, i, row)
  {
    for (int k = 0; k < 3; k++)
      if (json_object_get(row, keys[k]))
        json_object_set_new(row, keys[k], json_real(fabs(json_number_value(json_object_get(row, keys[k])))));
  }
}

static void test_random_designs(void)
{
  int wrong = 0, refused = 0, count = 400;
  static struct eo_faults faults;
  static struct eo_design design, back;
  for (int i = 0; i < count; i++) {
    json_t *document = random_object(&eo_design_table);
    if (!json_object_get(document, "gear_pair")) {
      struct eo_field pair = {.kind = EO_FIELD_OBJECT, .table = &eo_gear_pair_table};
      json_object_set_new(document, "gear_pair", random_value(&pair));
    }
    state_shares(document);
    drop_signs(document);
    faults.count = 0;
    if (!eo_design_decode(document, &design, NULL, &faults)) {
      printf("# %s: %s\n", faults.fault[0].pointer, faults.fault[0].text);
      refused++;
    } else
      wrong += !through_text(&design, &back) || !same_design(&design, &back);
    json_decref(document);
  }
  ok(refused == 0, "%d random documents within the ranges are read", count);
  ok(wrong == 0, "random documents survive encoding and decoding bit for bit");
}

int main(void)
{
  test_tables();
  test_optional();
  test_orders();
  test_units();
  test_examples();
  test_random_designs();
  return tap_done();
}
