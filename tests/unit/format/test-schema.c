/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The descriptions of the design for programs against the design itself: every example obeys its schema as it is
   written and as it is read, what the tables refuse the schema refuses too, and the form's fields are the keys of the
   document with its defaults. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "document/examples.h"
#include "format/json.h"
#include "format/object.h"
#include "document/measurement_document.h"
#include "document/result_private.h"
#include "format/form.h"
#include "format/schema.h"
#include "document/study_result.h"
#include "document/sweep_document.h"
#include "support/tap.h"

static bool has_type(const json_t *value, const char *type)
{
  return (strcmp(type, "object") == 0 && json_is_object(value)) ||
         (strcmp(type, "array") == 0 && json_is_array(value)) ||
         (strcmp(type, "string") == 0 && json_is_string(value)) ||
         (strcmp(type, "boolean") == 0 && json_is_boolean(value)) ||
         (strcmp(type, "null") == 0 && json_is_null(value)) || (strcmp(type, "number") == 0 && json_is_number(value)) ||
         (strcmp(type, "integer") == 0 && json_is_number(value) &&
          floor(json_number_value(value)) == json_number_value(value));
}

static bool type_fits(const json_t *schema, const json_t *value)
{
  const json_t *type = json_object_get(schema, "type");
  bool fits = json_is_string(type) && has_type(value, json_string_value(type));
  for (size_t i = 0; i < json_array_size(type); i++)
    fits = fits || has_type(value, json_string_value(json_array_get(type, i)));
  return fits;
}

static bool within(const json_t *schema, const char *low, const char *high, double value)
{
  return !(value < eo_json_find_number(schema, low)) && !(value > eo_json_find_number(schema, high));
}

static int count_wrong(const json_t *schema, const json_t *value, const char *where);

static int wrong_in_object(const json_t *schema, const json_t *object)
{
  const json_t *properties = json_object_get(schema, "properties"), *required = json_object_get(schema, "required");
  const char *key;
  json_t *value;
  int wrong = 0;
  for (size_t i = 0; i < json_array_size(required); i++)
    wrong += !json_object_get(object, json_string_value(json_array_get(required, i)));
  json_object_foreach((json_t *)object, key, value)
      wrong += json_object_get(properties, key) ? count_wrong(json_object_get(properties, key), value, key) : 1;
  return wrong;
}

static int count_wrong(const json_t *schema, const json_t *value, const char *where)
{
  int wrong = !type_fits(schema, value);
  const json_t *choices = json_object_get(schema, "enum");
  bool chosen = !choices;
  for (size_t i = 0; i < json_array_size(choices); i++)
    chosen = chosen || json_equal(json_array_get(choices, i), value);
  wrong += !chosen;
  if (json_is_number(value))
    wrong += !within(schema, "minimum", "maximum", json_number_value(value));
  if (json_is_string(value))
    wrong += !within(schema, "minLength", "maxLength", (double)json_string_length(value));
  if (json_is_array(value)) {
    wrong += !within(schema, "minItems", "maxItems", (double)json_array_size(value));
    for (size_t i = 0; i < json_array_size(value); i++)
      wrong += count_wrong(json_object_get(schema, "items"), json_array_get(value, i), where);
  }
  if (json_is_object(value))
    wrong += wrong_in_object(schema, value);
  if (wrong)
    printf("# %s\n", where);
  return wrong;
}

static void check_examples(const json_t *input, const json_t *output)
{
  struct eo_design design;
  struct eo_geometry geometry;
  for (int i = 0; eo_example_at(i); i++) {
    eo_example_build(eo_example_at(i)->name, &design);
    json_t *open = eo_design_encode(&design);
    ok(count_wrong(input, open, "input") == 0, "%s obeys the schema of what is read", eo_example_at(i)->name);
    ok(eo_design_complete(&design, &geometry, NULL) == EO_OK, "the example can be completed");
    json_t *resolved = eo_design_encode(&design);
    ok(count_wrong(output, resolved, "output") == 0, "the completed example obeys the schema of what is written");
    json_decref(open);
    json_decref(resolved);
  }
}

static void check_refusals(const json_t *input)
{
  static const char *const wrong[] = {
      "{}",
      "{\"gear_pair\":{}}",
      "{\"gear_pair\":{\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24}}",
      "{\"gear_pair\":{\"pinion_teeth\":17.5,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24,\"face_"
      "width_mm\":55}}",
      "{\"gear_pair\":{\"pinion_teeth\":3,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24,\"face_width_"
      "mm\":55}}",
      "{\"gear_pair\":{\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":\"6\",\"helix_angle_deg\":24,\"face_"
      "width_mm\":55}}",
      "{\"gear_pair\":{\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24,\"face_"
      "width_mm\":55},\"extra\":1}",
      "{\"gear_pair\":{\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24,\"face_"
      "width_mm\":55},\"load_cases\":{}}",
      "{\"load_cases\":[{\"torque_Nm\":1,\"speed_rpm\":1}],\"gear_pair\":{\"pinion_teeth\":17,\"gear_teeth\":44,"
      "\"normal_module_mm\":6,\"helix_angle_deg\":24,\"face_"
      "width_mm\":55},"
      "\"alignment\":{\"pinion_axial\":\"glued\"}}",
      "{\"gear_pair\":{\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24,\"face_"
      "width_mm\":55},"
      "\"objective\":{\"weights\":[1,2]}}"};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    struct eo_design design;
    struct eo_faults faults = {0};
    json_t *document = json_loads(wrong[i], 0, NULL);
    ok(document && !eo_design_decode(document, &design, NULL, &faults) &&
           count_wrong(input, document, "as it should be") > 0,
       "decoder and schema both refuse design %zu: %s", i + 1, faults.fault[0].text);
    json_decref(document);
  }
}

static int count_strange(const json_t *fields, const struct eo_table *table, const json_t *defaults)
{
  int strange = json_array_size(fields) != (size_t)table->count;
  for (int i = 0; i < table->count && !strange; i++) {
    const json_t *field = json_array_get(fields, (size_t)i), *value = json_object_get(field, "default"),
                 *below = json_object_get(field, "fields");
    const struct eo_field *row = &table->field[i];
    bool required = row->flags & EO_FIELD_REQUIRED;
    strange += strcmp(json_string_value(json_object_get(field, "key")), row->key) != 0 ||
               !json_is_string(json_object_get(field, "kind")) ||
               json_is_true(json_object_get(field, "required")) != required || (required && value) ||
               !json_is_string(json_object_get(field, "help"));
    strange += (row->flags & EO_FIELD_ENTRY && !json_is_string(json_object_get(field, "entry")));
    const json_t *written = json_object_get(defaults, row->key);
    bool omitted = row->flags & EO_FIELD_OMIT && !written && json_array_size(value) == 0;
    strange += value && defaults && !(row->flags & EO_FIELD_ENTRY) && !omitted && !json_equal(value, written);
    strange += (row->kind == EO_FIELD_NUMBER && json_number_value(json_object_get(field, "low")) != row->low);
    strange += (row->table != NULL) != (below != NULL);
    if (below)
      strange += count_strange(below, row->table,
                               row->kind == EO_FIELD_OBJECT ? json_object_get(defaults, row->key) : NULL);
    if (strange)
      printf("# %s\n", row->key);
  }
  return strange;
}

static void check_form(void)
{
  struct eo_design design;
  memset(&design, 0, sizeof design);
  eo_table_defaults(&eo_design_table, &design);
  json_t *form = eo_table_fields(&eo_design_table), *defaults = eo_table_encode(&eo_design_table, &design);
  ok(form && count_strange(json_object_get(form, "fields"), &eo_design_table, defaults) == 0,
     "the form has every key with its default");
  json_decref(form);
  json_decref(defaults);
}

static const struct eo_unit *const units[] = {
    &eo_unit_N_per_mm_um, &eo_unit_um_mm_per_N, &eo_unit_mm_per_s, &eo_unit_m_per_s2, &eo_unit_m_per_s,
    &eo_unit_sqrt_MPa,    &eo_unit_N_per_um,    &eo_unit_N_per_mm, &eo_unit_per_um,   &eo_unit_mm,
    &eo_unit_um,          &eo_unit_deg,         &eo_unit_rpm,      &eo_unit_Nm,       &eo_unit_N,
    &eo_unit_MPa,         &eo_unit_ms,          &eo_unit_Hz,       &eo_unit_h,        &eo_unit_C,
    &eo_unit_K,           &eo_unit_W,           &eo_unit_HV,       &eo_unit_urad};

/* The unit that a key ends with; the longer ones come first. */
static const struct eo_unit *unit_of(const char *key)
{
  for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
    size_t whole = strlen(key), length = strlen(units[i]->suffix);
    if (whole > length && key[whole - length - 1] == '_' && strcmp(key + whole - length, units[i]->suffix) == 0)
      return units[i];
  }
  return NULL;
}

/* Ends like a unit and has none. */
static bool has_no_unit(const char *key)
{
  return strcmp(key, "Z_W") == 0 || strcmp(key, "b_over_h") == 0;
}

/* above: the unit that the key of the object names. */
static int count_odd_units(const struct eo_outline *outline, const struct eo_unit *above)
{
  const struct eo_outline_row *row;
  int odd = 0;
  for (int i = 0; (row = eo_outline_at(outline, i)); i++) {
    const struct eo_unit *named = unit_of(row->key) ? unit_of(row->key) : above;
    if (row->outline)
      odd += count_odd_units(row->outline, unit_of(row->key));
    else if (!row->table && row->unit != named && strchr("[n", *row->shape) && !has_no_unit(row->key)) {
      printf("# %s/%s\n", outline->name, row->key);
      odd++;
    }
  }
  return odd;
}

static void check_units(void)
{
  static const struct eo_outline *const outlines[] = {&eo_result_outline, &eo_study_outline, &eo_sweep_outline,
                                                      &eo_measurement_outline, &eo_measurement_brief};
  int odd = 0;
  for (size_t i = 0; i < sizeof outlines / sizeof outlines[0]; i++)
    odd += count_odd_units(outlines[i], NULL);
  ok(odd == 0, "every number has the unit that its key, or the one above, names");
}

static const struct eo_outline_row inner_rows[] = {EO_KEY("b", "number?", "included", .unit = &eo_unit_mm),
                                                   EO_KEY("c", "flag", "not always", .when = "now and then")};
static const struct eo_outline inner = EO_OUTLINE("Inner", inner_rows);
static const struct eo_outline_row outer_rows[] = {
    EO_KEY("a", "[text?]|integer", "first"), {.outline = &inner}, EO_KEY("d", "object?", "last", .outline = &inner)};
static const struct eo_outline outer = EO_OUTLINE("Outer", outer_rows);

/* Takes the outline's keys from a document that has these; NULL: one is missing. */
static json_t *take_keys(const char *keys)
{
  json_t *document = json_object();
  for (; *keys; keys++)
    json_object_set_new(document, (const char[]){*keys, 0}, json_integer(1));
  json_t *object = eo_outline_take(&outer, document);
  json_decref(document);
  return object;
}

static void check_required_keys(void)
{
  static const char *const good[] = {"abcd", "abd", "bdace"}, *const bad[] = {"", "ab", "acd"};
  for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
    json_t *object = take_keys(good[i]);
    ok(object && json_object_get(object, "b"), "\"%s\" has what the outline names", good[i]);
    json_decref(object);
  }
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    json_t *object = take_keys(bad[i]);
    ok(!object, "\"%s\" has not what the outline names", bad[i]);
    json_decref(object);
  }
}

/* expected: NULL: the shape is none. */
static void check_shape(const char *shape, const char *expected)
{
  const struct eo_outline_row rows[] = {EO_KEY("a", shape, "a row")};
  const struct eo_outline outline = EO_OUTLINE("Shape", rows);
  json_t *schemas = json_object(), *wanted = expected ? json_loads(expected, 0, NULL) : NULL;
  bool good = eo_outline_add_schemas(&outline, schemas);
  const json_t *properties = json_object_get(json_object_get(schemas, "Shape"), "properties");
  ok(expected ? good && wanted && json_equal(json_object_get(properties, "a"), wanted) : !good,
     "the shape %s becomes its JSON Schema, or is refused", shape);
  json_decref(schemas);
  json_decref(wanted);
}

static void check_outline_schema(void)
{
  json_t *
      schemas = json_object(),
     *expected = json_loads(
         "{\"Outer\":{\"type\":\"object\",\"properties\":{"
         "\"a\":{\"anyOf\":[{\"type\":\"array\",\"items\":{\"anyOf\":[{\"type\":\"string\"},{\"type\":\"null\"}]}},{"
         "\"type\":\"integer\"}],\"description\":\"first\"},"
         "\"b\":{\"anyOf\":[{\"type\":\"number\"},{\"type\":\"null\"}],\"description\":\"included\",\"x-unit\":\"mm\"},"
         "\"c\":{\"type\":\"boolean\",\"description\":\"not always; now and then\"},"
         "\"d\":{\"anyOf\":[{\"$ref\":\"#/components/schemas/"
         "Inner\"},{\"type\":\"null\"}],\"description\":\"last\"}},\"required\":[\"a\",\"b\",\"d\"]},"
         "\"Inner\":{\"type\":\"object\",\"properties\":{\"b\":{\"anyOf\":[{\"type\":\"number\"},{\"type\":\"null\"}],"
         "\"description\":\"included\",\"x-unit\":\"mm\"},"
         "\"c\":{\"type\":\"boolean\",\"description\":\"not always; now and then\"}},\"required\":[\"b\"]}}",
         0, NULL);
  ok(eo_outline_add_schemas(&outer, schemas) && expected && json_equal(schemas, expected),
     "an outline becomes a JSON Schema");
  json_decref(schemas);
  json_decref(expected);
  check_shape("[text", NULL);
  check_shape("{number", NULL);
  check_shape("{number]", NULL);
  check_shape("number}", NULL);
  check_shape("{[number?]}?", "{\"anyOf\":[{\"type\":\"object\",\"additionalProperties\":{\"type\":\"array\",\"items\":"
                              "{\"anyOf\":[{\"type\":\"number\"},{\"type\":\"null\"}]}}},{\"type\":\"null\"}],"
                              "\"description\":\"a row\"}");
}

static void check_taking(void)
{
  json_t *whole = json_loads("{\"x\":1,\"a\":2,\"b\":3,\"d\":{\"b\":4,\"y\":5}}", 0, NULL),
         *wanted = json_loads("{\"a\":2,\"b\":3,\"d\":{\"b\":4}}", 0, NULL);
  json_t *part = eo_outline_take(&outer, whole);
  ok(json_equal(part, wanted), "an outline takes what it names of a longer document");
  json_decref(part);
  json_decref(wanted);
  json_decref(whole);
}

struct part {
  double length;
  int count;
};

struct whole {
  double mass, missing, steps;
  int kind, none;
  int64_t big;
  bool yes;
  char name[8], empty[8];
  const char *text;
  struct part part, inner;
  int rows;
  struct part *row;
};

static const char *const kinds[] = {"one", "other", NULL};

static bool never(const void *source)
{
  (void)source;
  return false;
}

static json_t *write_kind_twice(const void *source)
{
  const struct whole *whole = source;
  return json_pack("[s, s]", kinds[whole->kind], kinds[whole->kind]);
}

static const struct eo_outline_row part_rows[] = {
    EO_KEY("length_mm", "number?", "a length", .unit = &eo_unit_mm, EO_AT(struct part, length)),
    EO_KEY("count", "integer", "a number", EO_AT(struct part, count)),
};
static const struct eo_outline part_outline = EO_OUTLINE("Part", part_rows);

static const struct eo_outline_row whole_rows[] = {
    EO_KEY("mass", "number?", "a number", EO_AT(struct whole, mass)),
    EO_KEY("missing", "number?", "not a number", EO_AT(struct whole, missing)),
    EO_KEY("unknown", "number?", "not known", EO_AT(struct whole, mass), .known = never),
    EO_KEY("steps", "integer?", "a whole number", EO_AT(struct whole, steps)),
    EO_KEY("no_steps", "integer?", "not known", EO_AT(struct whole, missing)),
    EO_KEY("kind", "word", "a word", .words = kinds, EO_AT(struct whole, kind)),
    EO_KEY("none", "word?", "no word", .words = kinds, EO_AT(struct whole, none)),
    EO_KEY("big", "integer", "a large number", EO_AT(struct whole, big)),
    EO_KEY("yes", "flag", "a flag", EO_AT(struct whole, yes)),
    EO_KEY("name", "text", "a text", EO_AT(struct whole, name)),
    EO_KEY("empty", "text", "no text", EO_AT(struct whole, empty)),
    EO_KEY("no_text", "text?", "no text", EO_AT(struct whole, empty)),
    EO_KEY("text", "text?", "a text", EO_AT(struct whole, text)),
    EO_KEY("part", "object", "a part", .outline = &part_outline, EO_AT(struct whole, part)),
    {.outline = &part_outline, .offset = offsetof(struct whole, inner)},
    EO_KEY("rows", "[object]", "parts", .outline = &part_outline, EO_ROWS_AT(struct whole, row, rows)),
    EO_KEY("lengths_mm", "[number?]", "a column", .unit = &eo_unit_mm,
           EO_COLUMN_AT(struct whole, row, rows, struct part, length)),
    EO_KEY("twice", "[text]", "written by a function", .write = write_kind_twice),
    EO_KEY("absent", "flag", "not there", .when = "never", EO_AT(struct whole, yes), .there = never),
};
static const struct eo_outline whole_outline = EO_OUTLINE("Whole", whole_rows);

static const struct eo_outline_row silent_rows[] = {EO_KEY("mass", "number", "neither member nor function")};
static const struct eo_outline silent_outline = EO_OUTLINE("Silent", silent_rows);

static const struct eo_outline_row unsaid_rows[] = {
    EO_KEY("yes", "flag", "not there, and does not say when", EO_AT(struct whole, yes), .there = never)};
static const struct eo_outline unsaid_outline = EO_OUTLINE("Unsaid", unsaid_rows);

static void test_outline(void)
{
  static const char expected[] =
      "{\"mass\":0.333333333333,\"missing\":null,\"unknown\":null,\"steps\":12,\"no_steps\":null,\"kind\":\"other\","
      "\"none\":"
      "null,\"big\":9007199254740991,\"yes\":true,\"name\":\"abc\",\"empty\":\"\",\"no_text\":null,\"text\":\"long\","
      "\"part\":{\"length_mm\":2,\"count\":3},\"length_mm\":4,\"count\":5,\"rows\":[{\"length_mm\":1,\"count\":7},{"
      "\"length_mm\":null,\"count\":8}],\"lengths_mm\":[1,null],\"twice\":[\"other\",\"other\"]}";
  struct part rows[] = {{1e-3, 7}, {NAN, 8}};
  const struct whole whole = {.mass = 1. / 3,
                              .missing = NAN,
                              .steps = 12,
                              .kind = 1,
                              .none = -1,
                              .big = 9007199254740991,
                              .yes = true,
                              .name = "abc",
                              .text = "long",
                              .part = {2e-3, 3},
                              .inner = {4e-3, 5},
                              .rows = 2,
                              .row = rows};
  struct eo_text text = {0};
  json_t *document = eo_outline_encode(&whole_outline, &whole), *silent = eo_outline_encode(&silent_outline, &whole),
         *unsaid = eo_outline_encode(&unsaid_outline, &whole);
  if (document)
    eo_json_write(&text, document, EO_JSON_COMPACT);
  ok(text.data && strcmp(text.data, expected) == 0, "an outline writes a struct: %s",
     text.data ? text.data : "nothing");
  ok(!silent, "a row that says neither member nor function is a fault");
  ok(!unsaid, "a row that is not there and does not say when it is is a fault");
  json_decref(document);
  json_decref(silent);
  eo_text_done(&text);
}

struct curves {
  bool here, away;
  struct eo_series cycle, map, left_out;
  json_t *made, *not_there;
};

static const struct eo_outline_row curve_rows[] = {
    EO_KEY("cycle_um", "[number?]?", "from its third value on", .unit = &eo_unit_um, EO_AT(struct curves, cycle)),
    EO_KEY("map", "[[number?]]?", "two rows", EO_AT(struct curves, map), EO_IF(struct curves, here)),
    EO_KEY("left_out", "[number?]?", "nothing", EO_AT(struct curves, left_out)),
    EO_KEY("made", "any", "by somebody else", EO_AT(struct curves, made)),
    EO_KEY("not_there", "any", "made for nothing", .when = "never", EO_AT(struct curves, not_there),
           EO_IF(struct curves, away)),
};
static const struct eo_outline curve_outline = EO_OUTLINE("Curves", curve_rows);

static void check_curves(void)
{
  static const double value[] = {1, 2, NAN, 4};
  struct curves curves = {.here = true,
                          .cycle = {.value = value, .count = 4, .lag = 2, .scale = 1e-6 / 3, .digits = 3},
                          .map = {.value = value, .rows = 2, .count = 2, .scale = 1, .digits = 9},
                          .left_out = eo_series_of(4, NULL, 9),
                          .made = json_string("made"),
                          .not_there = json_object()};
  struct eo_text text = {0};
  json_t *document = eo_outline_encode(&curve_outline, &curves);
  if (document)
    eo_json_write(&text, document, EO_JSON_COMPACT);
  ok(text.data && strcmp(text.data, "{\"cycle_um\":[null,1.33,0.333,0.667],\"map\":[[1,2],[null,4]],\"left_out\":null,"
                                    "\"made\":\"made\"}") == 0,
     "an outline writes curves, maps and what others made: %s", text.data ? text.data : "nothing");
  json_decref(document);
  eo_text_done(&text);
  curves = (struct curves){.here = true, .not_there = json_object()};
  ok(!eo_outline_encode(&curve_outline, &curves), "a part that could not be made is a fault of the whole");
}

int main(void)
{
  check_units();
  check_required_keys();
  check_outline_schema();
  check_taking();
  check_curves();
  json_t *input = eo_table_json_schema(&eo_design_table, true), *output = eo_table_json_schema(&eo_design_table, false);
  check_examples(input, output);
  check_refusals(input);
  check_form();
  json_t *sweep = eo_table_json_schema(&eo_sweep_request_table, true),
         *request = json_loads("{\"torque_Nm\":{\"from\":1,\"to\":2,\"points\":3}}", 0, NULL);
  ok(sweep && count_wrong(sweep, request, "sweep") == 0, "a sweep's request obeys its schema");
  json_decref(sweep);
  json_decref(request);
  json_decref(input);
  json_decref(output);
  test_outline();
  return tap_done();
}
