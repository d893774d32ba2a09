/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every way to state one gear ends in the same design, bit for bit; what contradicts is refused at its key; a hundred
   drawn gears are completed or refused with number, limit and remedy; the first edit of any field of any example leads
   to a design or to a fault that names the field. */
#include <stdlib.h>
#include <string.h>

#include "contact/grid.h"
#include "document/assumption.h"
#include "document/completion.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "format/json.h"
#include "gear/entry.h"
#include "rating/pair_dimensions.h"
#include "support/drawn-gears.h"
#include "support/tap.h"

static struct eo_faults faults;
static struct eo_design design;
static struct eo_geometry geometry;
static struct eo_error error;

static bool complete(json_t *document)
{
  faults.count = 0;
  memset(&error, 0, sizeof error);
  bool good = eo_design_decode(document, &design, NULL, &faults);
  if (!good)
    eo_faults_first(&faults, &error);
  good = good && eo_design_complete(&design, &geometry, &error) == EO_OK;
  json_decref(document);
  return good;
}

static json_t *with_pair(const char *pair)
{
  struct eo_error fault;
  char text[2000];
  snprintf(text, sizeof text, "{\"load_cases\":[{\"torque_Nm\":100,\"speed_rpm\":1000}],\"gear_pair\":{%s}}", pair);
  json_t *document = eo_json_parse(text, strlen(text), &fault);
  if (!document)
    printf("# %s\n", fault.text);
  return document;
}

/* The same gear in several drawings' words; the first row has the canonical keys. Numbers are as the completed design
   prints them. */
#define TEETH "\"ends\":1,\"pinion_teeth\":23,\"gear_teeth\":71,\"helix_angle_deg\":18,\"face_width_mm\":40,"

/* Paths by which a completed design is stated again; %s: key and number of each. */
static const char *const paths[] = {
    "%m,%x1,%x2",         "%mt,%x1,%x2",        "%dp,%x1,%x2",
    "%dpt,%x1,%x2",       "%m,%at,%x1,%x2",     "%m,%x1,%a",
    "%m,%x2,%a",          "%m,%x1,%sum",        "%m,%x2,%aw",
    "%m,%x1,%aw",         "%m,%x1,%x2,%a",      "%m,%x1,%x2,%aw",
    "%m,%x1,%x2,%sum",    "%m,%l1,%l2",         "%m,%l1,%a",
    "%m,%x1,%x2,%d1,%d2", "%m,%x1,%x2,%h1,%h2", "%mt,%at,%l1,%aw,%h1,%d2",
    "%dp,%x1,%sum,%h1",   "%m,%x1,%x2,%a,%k0",
};

static void add_number(struct eo_text *text, const char *key, double value, int digits)
{
  eo_text_print(text, "\"%s\":%.*g", key, digits, value);
}

/* What stands for a word of a path in a drawing of the geometry. */
static void add_word(struct eo_text *text, const char *word, const struct eo_geometry *g)
{
  const double degree = M_PI / 180, inch = 25.4e-3;
  double sum = g->profile_shift[0] + g->profile_shift[1];
  const struct {
    const char *word, *key;
    double value;
    int digits;
  } row[] = {
      {"m", "normal_module_mm", 1e3 * g->normal_module, 15},
      {"mt", "transverse_module_mm", 1e3 * g->transverse_module, 17},
      {"dp", "normal_diametral_pitch_per_inch", inch / g->normal_module, 17},
      {"dpt", "transverse_diametral_pitch_per_inch", inch / g->transverse_module, 17},
      {"at", "transverse_pressure_angle_deg", g->transverse_pressure_angle / degree, 17},
      {"x1", "pinion_profile_shift", g->profile_shift[0], 15},
      {"x2", "gear_profile_shift", g->profile_shift[1], 15},
      {"a", "centre_distance_mm", eo_unit_out(&eo_unit_mm, g->centre_distance), 17},
      {"sum", "profile_shift_sum", sum, 15},
      {"aw", "working_pressure_angle_deg", g->working_pressure_angle / degree, 17},
      {"l1", "pinion_profile_shift_mm", 1e3 * g->profile_shift[0] * g->normal_module, 15},
      {"l2", "gear_profile_shift_mm", 1e3 * g->profile_shift[1] * g->normal_module, 15},
      {"d1", "pinion_tip_diameter_mm", 2e3 * g->tip_radius[0], 17},
      {"d2", "gear_tip_diameter_mm", 2e3 * g->tip_radius[1], 17},
      {"h1", "pinion_addendum_mm", 1e3 * (g->tip_radius[0] - g->reference_radius[0]), 15},
      {"h2", "gear_addendum_mm", 1e3 * (g->tip_radius[1] - g->reference_radius[1]), 15},
      {"k0", "tip_alteration_coefficient",
       (g->centre_distance - g->reference_radius[0] - g->reference_radius[1]) / g->normal_module - sum, 17},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    if (strcmp(word, row[i].word) == 0)
      add_number(text, row[i].key, row[i].value, row[i].digits);
}

static json_t *along(const char *path, const struct eo_geometry *g)
{
  struct eo_text text = {0};
  char copy[200], *rest = copy, *word;
  snprintf(copy, sizeof copy, "%s", path);
  for (bool first = true; (word = strtok_r(rest, ",", &rest)); first = false) {
    eo_text_add(&text, first ? TEETH : ",");
    add_word(&text, word + 1, g);
  }
  json_t *document = with_pair(text.data);
  eo_text_done(&text);
  return document;
}

/* As text: the last bit that the document can hold. */
static char *as_text(void)
{
  struct eo_text text = {0};
  json_t *document = eo_design_encode(&design);
  json_object_del(json_object_get(document, "gear_pair"), "tip_alteration_coefficient"); /* stated or not */
  eo_json_write(&text, document, EO_JSON_CANONICAL);
  json_decref(document);
  return text.data;
}

static void test_paths(const char *start, const char *what)
{
  int same = 0, count = (int)(sizeof paths / sizeof *paths);
  ok(complete(with_pair(start)), "the pair %s is made %s", what, error.text);
  struct eo_geometry first = geometry;
  char *expected = as_text();
  for (int i = 0; i < count; i++) {
    bool good = complete(along(paths[i], &first));
    char *found = good ? as_text() : NULL;
    if (found && strcmp(found, expected) == 0)
      same++;
    else {
      size_t at = 0;
      while (found && found[at] == expected[at])
        at++;
      printf("# %s: %s%s: %.80s\n", paths[i], error.pointer, error.text, found ? found + (at > 40 ? at - 40 : 0) : "");
    }
    free(found);
  }
  ok(same == count, "%d of %d ways to state the pair give the same document", same, count);
  free(expected);
}

/* One number in two drawings, each with all its digits: a module of its own, and what makes it. */
static void test_digits(void)
{
  static const struct {
    const char *key, *other;
    double value, same;
  } row[] = {
      {"normal_module_mm", "normal_diametral_pitch_per_inch", 25.4 / 7, 7},
      {"normal_module_mm", "transverse_diametral_pitch_per_inch", 25.4 / 7 * 0.9510565162951535, 7},
      {"normal_module_mm", "transverse_module_mm", 3.7 * 0.9510565162951535, 3.7},
      {"normal_pressure_angle_deg", "transverse_pressure_angle_deg", 20.152236347338746, 21.1},
      {"pinion_profile_shift", "pinion_profile_shift_mm", 1. / 3, 1},
      {"pinion_tip_diameter_mm", "pinion_addendum_mm", 69. / 0.9510565162951535 + 6.2, 3.1},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    char text[2][400], *made[2];
    const char *module = strstr(row[i].key, "module") ? "" : "\"normal_module_mm\":3,";
    for (int way = 0; way < 2; way++) {
      snprintf(text[way], sizeof text[way], TEETH "%s\"%s\":%.17g", module, way ? row[i].other : row[i].key,
               way ? row[i].same : row[i].value);
      made[way] = complete(with_pair(text[way])) ? as_text() : NULL;
    }
    ok(made[0] && made[1] && strcmp(made[0], made[1]) == 0, "%s of %.17g says the same as %s of %.17g%s", row[i].key,
       row[i].value, row[i].other, row[i].same, error.text);
    free(made[0]);
    free(made[1]);
  }
}

/* Statements that contradict each other: each refused at a key that is one of them, with both numbers. */
static void test_contradictions(void)
{
  static const struct {
    const char *pair, *key, *text;
  } row[] = {
      {"\"normal_module_mm\":3,\"normal_diametral_pitch_per_inch\":8", "/gear_pair/normal_diametral_pitch_per_inch",
       "3.175"},
      {"\"normal_module_mm\":3,\"normal_pressure_angle_deg\":20,\"transverse_pressure_angle_deg\":20",
       "/gear_pair/transverse_pressure_angle_deg", "leave one"},
      {"\"normal_module_mm\":3,\"pinion_profile_shift\":0.2,\"pinion_profile_shift_mm\":0.7",
       "/gear_pair/pinion_profile_shift_mm", "0.2333"},
      {"\"normal_module_mm\":3,\"pinion_profile_shift\":0.2,\"gear_profile_shift\":0.1,\"profile_shift_sum\":0.4",
       "/gear_pair/profile_shift_sum", "sum to 0.3"},
      {"\"normal_module_mm\":3,\"centre_distance_mm\":149,\"working_pressure_angle_deg\":25",
       "/gear_pair/working_pressure_angle_deg", "leave one"},
      {"\"normal_module_mm\":3,\"pinion_profile_shift\":0.4,\"gear_profile_shift\":0.4,\"centre_distance_mm\":149",
       "/gear_pair/centre_distance_mm", "sum of the shifts"},
      {"\"normal_module_mm\":3,\"pinion_addendum_mm\":3,\"pinion_tip_diameter_mm\":80",
       "/gear_pair/pinion_tip_diameter_mm", "leave one"},
      {"\"normal_module_mm\":3,\"centre_distance_mm\":100", "/gear_pair/centre_distance_mm", "base radii"},
      {"\"normal_module_mm\":3,\"profile_shift_sum\":-9", "/gear_pair/pinion_profile_shift", "-9"},
      {"\"normal_module_mm\":3,\"fillet_radius_coefficient\":0.7", "/gear_pair/fillet_radius_coefficient", "at most"},
      {"\"normal_module_mm\":3,\"thickness_series\":\"zz25\"", "/gear_pair/thickness_series", "DIN 3967"},
      {"\"normal_module_mm\":3,\"thickness_series\":\"cd-25\"", "/gear_pair/thickness_series", "\"cd-25\" is not"},
      {"\"normal_module_mm\":3,\"thickness_series\":\"25cd5\"", "/gear_pair/thickness_series", "\"25cd5\" is not"},
      {"\"normal_module_mm\":3,\"pinion_thickness_allowance_um\":[-90,-60]", "/gear_pair/pinion_thickness_allowance_um",
       "[upper, lower]"},
      {"\"normal_diametral_pitch_per_inch\":0.1", "/gear_pair/normal_diametral_pitch_per_inch", "outside"},
      {"\"face\":1", "/gear_pair/normal_module_mm", "transverse_diametral_pitch_per_inch"},
      {"\"normal_module_mm\":3,\"planet_count\":3", "/gear_pair/planet_count", "Planetary"},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    char pair[600];
    snprintf(pair, sizeof pair, TEETH "%s", row[i].pair);
    ok(!complete(with_pair(pair)) && strcmp(error.pointer, row[i].key) == 0 && strstr(error.text, row[i].text),
       "%s is refused: %s: %s", row[i].pair, error.pointer, error.text);
  }
}

/* DIN 3967 writes the letters first, many drawings the number. */
static void test_series(void)
{
  static const char *const spelt[] = {"cd25", "25cd", "cd 25", "CD25", " 25 Cd "};
  for (size_t i = 0; i < sizeof spelt / sizeof *spelt; i++) {
    char pair[300];
    snprintf(pair, sizeof pair, TEETH "\"normal_module_mm\":3,\"thickness_series\":\"%s\"", spelt[i]);
    ok(complete(with_pair(pair)), "\"%s\" is read as a series %s", spelt[i], error.text);
    close_to(1e6 * design.gear_pair.thickness_allowance[EO_PINION][0], -70, 1e-6, "A_sne of the series at 73 mm, um");
    close_to(1e6 * design.gear_pair.thickness_allowance[EO_PINION][1], -110, 1e-6, "A_sni of the series at 73 mm, um");
  }
}

static void test_drawn(void)
{
  enum { DRAWN = 400 };
  int completed = 0, refused = 0, wrong = 0, unmeasured = 0;
  for (int i = 0; i < DRAWN; i++) {
    static struct eo_pair_dimensions dimensions;
    if (complete(drawn(i))) {
      completed++;
      eo_pair_dimensions_init(&dimensions, &design.gear_pair, &geometry);
      for (int k = 0; k < 2; k++) {
        const struct eo_member_dimensions *m = &dimensions.member[k];
        bool odd = !isfinite(m->normal_thickness[EO_LOWER]) || (!m->teeth_spanned && !*m->span_reason) ||
                   (isnan(m->ball) && !*m->ball_reason);
        unmeasured += odd;
        if (odd)
          printf("# %d, member %d: s_n %.4g mm, k %d, ball %.4g mm\n", i, k, 1e3 * m->normal_thickness[EO_LOWER],
                 m->teeth_spanned, 1e3 * m->ball);
      }
      continue;
    }
    refused++;
    bool good = is_fair_refusal(&error);
    wrong += !good;
    if (!good)
      printf("# %d: %s: %s\n", i, error.pointer, error.text);
  }
  ok(wrong == 0, "%d gears are drawn: %d completed, %d refused with a number at a key that was stated", DRAWN,
     completed, refused);
  ok(completed > DRAWN / 2 && unmeasured == 0, "most drawn gears are complete and can be measured");
}

/* Own widths of the members: the same design however it is stated; what is beyond the common width adds mass. */
static void test_widths(void)
{
  static const char *const same[] = {"\"pinion_face_width_mm\":41,\"gear_face_width_mm\":36",
                                     "\"face_width_mm\":36,\"pinion_face_width_mm\":41",
                                     "\"face_width_mm\":36,\"pinion_face_width_mm\":41,\"gear_face_width_mm\":36"};
  static const struct {
    const char *pair, *key, *text;
  } wrong[] = {
      {"\"face_width_mm\":40,\"pinion_face_width_mm\":41,\"gear_face_width_mm\":36", "/gear_pair/face_width_mm",
       "share 36"},
      {"\"face_width_mm\":40,\"gear_face_width_mm\":36", "/gear_pair/gear_face_width_mm", "narrower"},
      {"\"ends\":2,\"groove_width_mm\":4,\"face_width_mm\":36,\"gear_face_width_mm\":40",
       "/gear_pair/gear_face_width_mm", "groove"},
      {"\"normal_pressure_angle_deg\":20", "/gear_pair/face_width_mm", "pinion_face_width_mm, gear_face_width_mm"},
  };
  const char *head = "\"pinion_teeth\":23,\"gear_teeth\":71,\"helix_angle_deg\":18,\"normal_module_mm\":3,";
  char pair[600], *first = NULL;
  snprintf(pair, sizeof pair, "%s\"face_width_mm\":36", head);
  complete(with_pair(pair));
  double plain[2] = {design.supports.mass[0], design.supports.mass[1]};
  for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
    snprintf(pair, sizeof pair, "%s%s", head, same[i]);
    ok(complete(with_pair(pair)) && geometry.face_width == 36e-3 && geometry.member_width[EO_PINION] == 41e-3 &&
           geometry.member_width[EO_GEAR] == 36e-3,
       "widths of 41 and 36 mm of the members share 36 mm %s", error.text);
    char *text = as_text();
    ok(!first || strcmp(text, first) == 0, "widths stated either way give the same bits");
    free(i ? text : NULL);
    first = i ? first : text;
  }
  free(first);
  double more = 5e-3 * M_PI * 7850 *
                (pow(geometry.reference_radius[0], 2) - pow(design.gear_pair.groove_diameter[0] / 2, 2) / 2 -
                 pow(design.gear_pair.bore[0] / 2, 2) / 2);
  near(design.supports.mass[0] - plain[0], more, 1e-9,
       "mass of a pinion that is 5 mm wider, half of it out of the groove, kg");
  ok(design.supports.mass[1] == plain[1], "the gear is what it was beside a wider pinion");
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    snprintf(pair, sizeof pair, "%s%s", head, wrong[i].pair);
    ok(!complete(with_pair(pair)) && strcmp(error.pointer, wrong[i].key) == 0 && strstr(error.text, wrong[i].text),
       "%s is refused: %s: %s", wrong[i].pair, error.pointer, error.text);
  }
}

/* A value beside the one that stands there; NULL: none to be had. */
static json_t *edited(const struct eo_field *field, const json_t *value, int way)
{
  double low = fmax(field->low, -1e9), high = fmin(field->high, 1e9), now = json_number_value(value);
  double wanted = way == 0   ? (json_is_number(value) && now != 0 ? now * 0.8 : low + 0.25 * (high - low))
                  : way == 1 ? (json_is_number(value) && now != 0 ? now * 1.3 : low + 0.01 * (high - low))
                  : way == 2 ? low
                             : high;
  wanted = fmin(fmax(wanted, low), high);
  if (field->kind == EO_FIELD_INTEGER || field->kind == EO_FIELD_SEED)
    return json_integer((json_int_t)round(wanted));
  if (field->kind == EO_FIELD_NUMBER)
    return json_real(wanted);
  if (field->kind == EO_FIELD_FLAG)
    return json_boolean(!json_is_true(value));
  if (field->kind == EO_FIELD_CHOICE)
    return json_string(field->choices[way % 2 && field->choices[1] ? 1 : 0]);
  return NULL;
}

static int edits, strange;

/* The refusal names the key itself, or is about the geometry, where each of its keys mends it. */
static bool is_at(const char *pointer)
{
  if (strcmp(error.pointer, pointer) == 0)
    return true;
  bool geometry_key = strncmp(pointer, "/gear_pair/", 11) == 0;
  return geometry_key &&
         (strncmp(error.pointer, "/gear_pair/", 11) == 0 || strncmp(error.pointer, "/modification/", 14) == 0);
}

/* Each field of an object and of those in it, four ways. */
static void edit_table(const json_t *document, const struct eo_table *table, const char *group)
{
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    char pointer[200];
    snprintf(pointer, sizeof pointer, "%s/%s", group, field->key);
    if (field->kind == EO_FIELD_OBJECT && json_is_object(eo_json_find(document, pointer + 1)))
      edit_table(document, field->table, pointer);
    for (int way = 0; way < 4; way++) {
      json_t *copy = json_deep_copy(document), *object = (json_t *)eo_json_find(copy, *group ? group + 1 : group),
             *value = edited(field, json_object_get(object, field->key), way);
      if (!value) {
        json_decref(copy);
        continue;
      }
      json_object_set_new(object, field->key, value);
      edits++;
      if (complete(copy) || is_at(pointer))
        continue;
      strange++;
      printf("# %s, way %d: %s: %s\n", pointer, way, error.pointer, error.text);
    }
  }
}

/* Every object that an example may have, so that each of its fields is there to be edited. */
static json_t *with_every_object(const struct eo_example *example)
{
  struct eo_design start;
  eo_example_build(example->name, &start);
  json_t *document = eo_design_encode(&start), *list = json_object_get(document, "load_cases"), *row, *flank;
  const char *member, *end;
  json_t *ends;
  size_t i;
  json_array_foreach(list, i, row) json_object_set_new(row, "alignment", json_object());
  json_object_foreach(json_object_get(document, "modification"), member, ends) json_object_foreach(ends, end, flank)
      json_object_set_new(flank, "coast", json_object());
  if (!json_object_get(document, "rating"))
    json_object_set_new(document, "rating", json_pack("{s:{},s:{},s:{}}", "pinion", "gear", "lubricant"));
  return document;
}

static void test_first_edit(void)
{
  const struct eo_example *example;
  for (int i = 0; (example = eo_example_at(i)); i++) {
    json_t *document = with_every_object(example);
    edit_table(document, &eo_design_table, "");
    edit_table(document, &eo_load_case_table, "/load_cases/0");
    json_decref(document);
  }
  ok(strange == 0 && edits > 5000, "%d first edits of the examples lead to a design or to a fault at the field", edits);
}

/* Version 1: the defaults of the paper's rig, with a note; the same document of version 2 has its own. */
static void test_migration(void)
{
  static struct eo_warnings warnings;
  json_t *document = with_pair("\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":3,\"helix_angle_deg\":24,"
                               "\"face_width_mm\":30,\"pinion_profile_shift\":0.3,\"centre_distance_mm\":101");
  json_object_del(document, "load_cases");
  json_object_set_new(document, "version", json_integer(1));
  faults.count = warnings.count = 0;
  ok(eo_design_decode(document, &design, &warnings, &faults) && eo_design_complete(&design, &geometry, &error) == EO_OK,
     "a document of version 1 is read %s%s", faults.count ? faults.fault[0].text : "", error.text);
  ok(design.load_cases == 3 && design.load_case[1].torque == 828 && design.gear_pair.backlash == 100e-6 &&
         design.gear_pair.profile_shift[EO_GEAR] == 0 && design.supports.bearing_stiffness[0] == 8e8 &&
         design.optimization.tip_relief.high == 40e-6,
     "a document of version 1 has what it left out then");
  close_to(design.alignment.shaft_angle_in_plane, 0.1 * M_PI / 180, 1e-18,
           "shaft angle error of a document of version 1, rad");
  close_to(2 * geometry.tip_radius[0], 1e-3 * (3 / cos(24 * M_PI / 180) * 17 + 6 * 1.3), 1e-15,
           "tip diameter of a document of version 1, that of the rack, m");
  ok(warnings.count == 1 && strstr(warnings.text[0], "version 1"), "a note tells of the version: %s", warnings.text[0]);
  json_decref(document);
}

/* Documents that the program of version 1 wrote whole are recognised without a version. */
static void test_written_by_first(void)
{
  static struct eo_warnings warnings;
  struct eo_design start;
  eo_example_build("shifted", &start);
  json_t *document = eo_design_encode(&start), *pair = json_object_get(document, "gear_pair");
  static const char *const newer[] = {"tip_alteration_coefficient", "pinion_addendum_coefficient", "thickness_series",
                                      NULL};
  json_object_del(document, "version");
  for (int i = 0; newer[i]; i++)
    json_object_del(pair, newer[i]);
  json_object_set_new(json_object_get(document, "resolution"), "te_harmonics", json_integer(16));
  warnings.count = faults.count = 0;
  ok(eo_design_decode(document, &design, &warnings, &faults) && design.gear_pair.tip_alteration == 0 &&
         warnings.count == 1,
     "a whole document of version 1 keeps its tips");
  json_decref(document);
}

static void test_assumed(void)
{
  ok(complete(with_pair("\"pinion_teeth\":20,\"gear_teeth\":60,\"transverse_module_mm\":5,\"helix_angle_deg\":20,"
                        "\"face_width_mm\":50,\"profile_shift_sum\":0.4,\"pinion_addendum_mm\":5")),
     "a terse design is made %s", error.text);
  json_t *assumed = eo_assumptions_encode(&design, false), *row;
  struct eo_text keys = {0};
  size_t i;
  json_array_foreach(assumed, i, row) eo_text_print(&keys, "%s;", json_string_value(json_object_get(row, "key")));
  ok(strstr(keys.data, "/gear_pair/backlash_um;") && strstr(keys.data, "/gear_pair/gear_profile_shift;") &&
         strstr(keys.data, "/gear_pair/gear_tip_diameter_mm;") && strstr(keys.data, "/alignment/stagger;") &&
         strstr(keys.data, "/supports/pinion_mass_kg;") && strstr(keys.data, "/modification/gear/right;"),
     "what a terse design does not state is listed");
  ok(!strstr(keys.data, "normal_module_mm") && !strstr(keys.data, "centre_distance_mm;") &&
         !strstr(keys.data, "pinion_tip_diameter_mm") && !strstr(keys.data, "pinion_teeth;") &&
         !strstr(keys.data, "/optimization"),
     "what it states in another way, or an analysis does not use, is not listed");
  eo_text_done(&keys);
  json_decref(assumed);
}

/* Where the fillet ends the involute begins: at the place of both curves, which the rating room finds in its own way
   from the tooth alone. */
static void test_roots(void)
{
  static const struct {
    const char *pair, *what;
    double published; /* d_Ff, mm; 0: none */
  } row[] = {
      {"\"ends\":1,\"pinion_teeth\":9,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24,\"face_width_"
       "mm\":55",
       "undercut", 0},
      {"\"ends\":1,\"pinion_teeth\":17,\"gear_teeth\":60,\"normal_module_mm\":4,\"helix_angle_deg\":0,\"face_width_"
       "mm\":20,"
       "\"pinion_profile_shift\":-0.35,\"gear_profile_shift\":0.35,\"fillet_radius_coefficient\":0.25",
       "undercut by negative shift", 0},
      {"\"ends\":1,\"pinion_teeth\":24,\"gear_teeth\":95,\"normal_module_mm\":14,\"helix_angle_deg\":10,\"face_width_"
       "mm\":360,"
       "\"pinion_profile_shift\":0.48,\"centre_distance_mm\":861,\"pinion_generating_shift\":0.4672",
       "cut with its upper allowance", 328.754},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    double end[2], start[2], normal[2];
    ok(complete(with_pair(row[i].pair)), "%s is made %s", row[i].what, error.text);
    const struct eo_tooth tooth = {.teeth = geometry.teeth[0],
                                   .normal_module = geometry.normal_module,
                                   .normal_pressure_angle = geometry.normal_pressure_angle,
                                   .helix_angle = geometry.helix_angle,
                                   .profile_shift = geometry.generating_shift[0],
                                   .dedendum_coefficient = geometry.dedendum[0] / geometry.normal_module,
                                   .fillet_radius_coefficient = geometry.fillet_radius[0] / geometry.normal_module};
    eo_geometry_fillet(&geometry, EO_PINION, 1, end, normal);
    eo_geometry_involute(&geometry, EO_PINION, geometry.form_radius[0], start, normal);
    close_to(hypot(end[0] - start[0], end[1] - start[1]), 0, 1e-9, "gap between fillet and involute, m");
    close_to(2 * geometry.form_radius[0], eo_tooth_form_diameter(&tooth, NULL), 1e-9,
             "form diameter where they meet, m");
    if (row[i].published > 0)
      close_to(2e3 * geometry.form_radius[0], row[i].published, 1e-3, "form diameter as published, mm");
  }
}

/* A tool with 100 um of protuberance and 60 um of stock: the fillet runs 40 um inside the flank of a tool without, ends
   where its rounding has come back to the flank, and weakens the root. */
static void test_protuberance(void)
{
  const char *pair = "\"ends\":1,\"pinion_teeth\":24,\"gear_teeth\":95,\"normal_module_mm\":6,\"helix_angle_deg\":10,"
                     "\"face_width_mm\":60,\"pinion_protuberance_um\":%g,\"pinion_grinding_stock_um\":60";
  char text[600];
  double plain[2], cut[2], end[2], start[2], normal[2], plain_form;
  snprintf(text, sizeof text, pair, 60.);
  complete(with_pair(text));
  plain_form = geometry.form_radius[0];
  eo_geometry_fillet(&geometry, EO_PINION, 0.75, plain, normal);
  snprintf(text, sizeof text, pair, 100.);
  ok(complete(with_pair(text)) && geometry.residual_undercut[0] == 40e-6 && !geometry.undercut[0],
     "a pair with protuberance is made %s", error.text);
  double nearest = INFINITY;
  for (int i = 0; i <= 4000; i++) {
    eo_geometry_fillet(&geometry, EO_PINION, i / 4000., cut, normal);
    nearest = fmin(nearest, hypot(cut[0] - plain[0], cut[1] - plain[1]));
  }
  ok(nearest > 20e-6 && nearest < 45e-6, "the fillet of a protuberance lies %.1f um further in", 1e6 * nearest);
  eo_geometry_fillet(&geometry, EO_PINION, 1, end, normal);
  eo_geometry_involute(&geometry, EO_PINION, geometry.form_radius[0], start, normal);
  close_to(hypot(end[0] - start[0], end[1] - start[1]), 0, 1e-9,
           "gap between the fillet of a protuberance and its involute, m");
  ok(geometry.form_radius[0] > plain_form, "a protuberance puts the form circle further out: %.4f instead of %.4f mm",
     1e3 * geometry.form_radius[0], 1e3 * plain_form);
}

/* A chamfer ends the flank: contact begins and ends there, the clearance stays that of the tip. */
static void test_chamfer(void)
{
  const char *plain = TEETH "\"normal_module_mm\":3";
  ok(complete(with_pair(plain)), "a pair without a chamfer is made");
  struct eo_geometry before = geometry;
  ok(complete(with_pair(TEETH "\"normal_module_mm\":3,\"gear_tip_chamfer_mm\":0.3")),
     "a pair with a chamfer is made %s", error.text);
  close_to(geometry.tip_form_radius[EO_GEAR], before.tip_radius[EO_GEAR] - 0.3e-3, 1e-15,
           "radius of the end of a chamfered flank, below the tip");
  close_to(-geometry.path_start,
           sqrt(pow(geometry.tip_form_radius[EO_GEAR], 2) - pow(geometry.base_radius[EO_GEAR], 2)) -
               geometry.tangent_length[EO_GEAR],
           1e-15, "start of contact at the chamfer, m");
  ok(geometry.tip_clearance[EO_GEAR] == before.tip_clearance[EO_GEAR] &&
         geometry.transverse_contact_ratio < before.transverse_contact_ratio,
     "a chamfer leaves less contact and the same clearance");
}

/* An iron wheel on a steel pinion: closed forms of Hertz and of ISO 6336-1, and a law that does not jump where unlike
   materials become alike. */
static void test_materials(void)
{
  struct eo_material unlike = {206e9, 0.3, 7850, 110e9, 0.26, 7200},
                     nearly = {206e9, 0.3, 7850, 206e9 * (1 + 1e-12), NAN, NAN},
                     alike = {206e9, 0.3, 7850, NAN, NAN, NAN};
  double sum = 0.91 / 206e9 + (1 - 0.26 * 0.26) / 110e9;
  near(0.91 / eo_material_contact_modulus(&unlike), sum / 2, 1e-12, "contact modulus by the mean of (1 - nu^2)/E");
  near(eo_material_mean_modulus(&unlike), 2 / (1 / 206e9 + 1 / 110e9), 1e-12, "mean modulus 2 E1 E2/(E1 + E2)");
  ok(eo_material_is_one(&alike) && !eo_material_is_one(&unlike), "one material is told from two");
  complete(with_pair(TEETH "\"normal_module_mm\":3"));
  near(eo_contact_local_constant(&geometry, &nearly, 1e-3), eo_contact_local_constant(&geometry, &alike, 1e-3), 1e-11,
       "local approach of nearly the same material over that of the same");
  /* Weber and Banaschek's two terms, written out at a load: delta = sum A_i q (2 ln(2 h_i/b) - nu_i/(1 - nu_i)). */
  double q = 2e5, s = -2e-3, compliance[2] = {0.91 / (M_PI * 206e9), (1 - 0.26 * 0.26) / (M_PI * 110e9)}, delta = 0;
  double nu[2] = {0.3, 0.26}, all = compliance[0] + compliance[1];
  double b = sqrt(4 * q * eo_geometry_relative_radius(&geometry, s) * all);
  for (int i = 0; i < 2; i++)
    delta += compliance[i] * q * (2 * log(2 * eo_geometry_depth(&geometry, i, s) / b) - nu[i] / (1 - nu[i]));
  near(all * q * (eo_contact_local_constant(&geometry, &unlike, s) - log(q)), delta, 1e-12,
       "local approach of two materials, m");
  json_t *document = with_pair(TEETH "\"normal_module_mm\":3");
  json_object_set_new(document, "material",
                      json_pack("{s:f,s:f}", "gear_youngs_modulus_GPa", 3., "gear_density_kg_per_m3", 1410.));
  complete(document);
  double steel = design.supports.mass[EO_GEAR];
  complete(with_pair(TEETH "\"normal_module_mm\":3"));
  near(steel / design.supports.mass[EO_GEAR], 1410. / 7850, 1e-12, "mass of a polymer wheel over that of steel");
}

/* f_Sigma_beta of a published gearbox, 27 um over 360 mm: 0.0043 deg, stated and not assumed. */
static void test_deviation(void)
{
  json_t *document = with_pair("\"ends\":1,\"pinion_teeth\":24,\"gear_teeth\":95,\"normal_module_mm\":14,"
                               "\"helix_angle_deg\":10,\"face_width_mm\":360"),
         *row;
  struct eo_text keys = {0};
  size_t i;
  json_object_set_new(document, "alignment", json_pack("{s:i}", "shaft_angle_error_out_of_plane_um", 27));
  complete(document);
  near(design.alignment.shaft_angle_out_of_plane * 180 / M_PI, 0.004297, 1e-4,
       "shaft angle error of 27 um over 360 mm, deg");
  json_t *assumed = eo_assumptions_encode(&design, false);
  json_array_foreach(assumed, i, row) eo_text_print(&keys, "%s;", json_string_value(json_object_get(row, "key")));
  ok(!strstr(keys.data, "out_of_plane_deg") && strstr(keys.data, "in_plane_deg"),
     "the angle that is not stated is 0, with a note");
  eo_text_done(&keys);
  json_decref(assumed);
}

/* The limits that a grade sets: of a published gearbox, F_beta 25 and 27 um over 360 mm, f_Sigma_beta 27 um where the
   bearings are twice as far apart as the face is wide: 13.5 um over the face. */
static void test_error_grade(void)
{
  const char *pair = "\"ends\":1,\"pinion_teeth\":24,\"gear_teeth\":95,\"normal_module_mm\":14,"
                     "\"helix_angle_deg\":10,\"face_width_mm\":360";
  json_t *document = with_pair(pair);
  json_object_set_new(document, "alignment", json_pack("{s:i}", "shaft_error_grade", 6));
  ok(complete(document), "a grade that stands for shaft angle errors is read %s", error.text);
  near(design.alignment.shaft_angle_out_of_plane * 360e-3, 13.5e-6, 0.02,
       "deviation out of plane by the grade, over the face, m");
  near(design.alignment.shaft_angle_in_plane, -2 * design.alignment.shaft_angle_out_of_plane, 1e-12,
       "deviation in the plane by the grade, twice that, the other way round");
  document = eo_design_encode(&design);
  double angle = design.alignment.shaft_angle_in_plane;
  ok(complete(document) && design.alignment.shaft_angle_in_plane == angle,
     "an angle that follows from the grade may stand beside it %s", error.text);
  document = with_pair(pair);
  json_object_set_new(document, "alignment",
                      json_pack("{s:i,s:f}", "shaft_error_grade", 6, "shaft_angle_error_in_plane_deg", 0.05));
  ok(!complete(document) && strcmp(error.pointer, "/alignment/shaft_error_grade") == 0 && strstr(error.text, "0.05"),
     "an angle that contradicts the grade is refused: %s", error.text);
}

static void test_power(void)
{
  json_t *document = with_pair(TEETH "\"normal_module_mm\":3");
  json_object_set_new(document, "load_cases", json_pack("[{s:i,s:f}]", "power_kW", 5000, "speed_rpm", 1165.9));
  ok(complete(document), "a power that stands for a torque is read %s", error.text);
  near(design.load_case[0].torque, 40953, 2e-5, "torque of 5000 kW at 1165.9 rpm, N m");
  document = with_pair(TEETH "\"normal_module_mm\":3");
  json_object_set_new(document, "load_cases",
                      json_pack("[{s:i,s:f,s:i}]", "power_kW", 5, "speed_rpm", 1000., "torque_Nm", 40));
  ok(!complete(document) && strcmp(error.pointer, "/load_cases/0/power_kW") == 0 && strstr(error.text, "47.7464829"),
     "a power that contradicts a torque is refused: %s", error.text);
}

/* Signs as a drive's table has them, against the same load case in words. */
static void test_signs(void)
{
  static const struct {
    double torque, speed;
    const char *direction, *driver;
  } row[] = {{40, -900, "astern", "gear"}, {-40, 900, "ahead", "gear"}, {-40, -900, "astern", "pinion"}};
  for (int i = 0; i < 3; i++) {
    json_t *document = with_pair(TEETH "\"normal_module_mm\":3");
    json_object_set_new(document, "load_cases",
                        json_pack("[{s:i,s:i},{s:f,s:f}]", "torque_Nm", 50, "speed_rpm", 1000, "torque_Nm",
                                  row[i].torque, "speed_rpm", row[i].speed));
    bool done = complete(document);
    struct eo_load_case by_sign = design.load_case[1];
    document = with_pair(TEETH "\"normal_module_mm\":3");
    json_object_set_new(document, "load_cases",
                        json_pack("[{s:i,s:i},{s:f,s:f,s:s,s:s}]", "torque_Nm", 50, "speed_rpm", 1000, "torque_Nm",
                                  fabs(row[i].torque), "speed_rpm", fabs(row[i].speed), "direction", row[i].direction,
                                  "driver", row[i].driver));
    done = done && complete(document);
    const struct eo_load_case *by_word = &design.load_case[1];
    ok(done && by_sign.torque == by_word->torque && by_sign.speed == by_word->speed &&
           by_sign.direction == by_word->direction && by_sign.driver == by_word->driver &&
           by_sign.flank == by_word->flank,
       "%g N m at %g rpm runs %s, and the %s drives %s", row[i].torque, row[i].speed, row[i].direction, row[i].driver,
       error.text);
  }
  json_t *document = with_pair(TEETH "\"normal_module_mm\":3");
  json_object_set_new(document, "load_cases",
                      json_pack("[{s:f,s:f,s:s}]", "power_kW", -5., "speed_rpm", 1000., "driver", "pinion"));
  ok(!complete(document) && strcmp(error.pointer, "/load_cases/0/driver") == 0 && strstr(error.text, "gear drives"),
     "a word that contradicts a sign is refused: %s", error.text);
  document = with_pair(TEETH "\"normal_module_mm\":3");
  json_object_set_new(document, "load_cases", json_pack("[{s:f,s:f}]", "torque_Nm", 40., "speed_rpm", -0.05));
  ok(!complete(document) && strcmp(error.pointer, "/load_cases/0/speed_rpm") == 0 && strstr(error.text, "0.1"),
     "a power at next to no speed is refused: %s", error.text);
}

int main(void)
{
  test_paths(TEETH "\"normal_module_mm\":2.5,\"pinion_profile_shift\":0.35,\"gear_profile_shift\":0.12", "shifted");
  test_paths(TEETH "\"normal_diametral_pitch_per_inch\":6,\"pinion_profile_shift\":-0.1,\"gear_profile_shift\":0.3",
             "in inches");
  test_paths(TEETH "\"normal_module_mm\":7,\"pinion_profile_shift\":0.4,\"gear_profile_shift\":-0.4", "zero sum");
  test_digits();
  test_contradictions();
  test_widths();
  test_error_grade();
  test_signs();
  test_series();
  test_drawn();
  test_first_edit();
  test_migration();
  test_written_by_first();
  test_assumed();
  test_roots();
  test_protuberance();
  test_chamfer();
  test_materials();
  test_deviation();
  test_power();
  return tap_done();
}
