/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The design document: every way to get a key wrong, defaults against the product's description, hashes. */
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "document/examples.h"
#include "flexibility/flexibility.h"
#include "format/json.h"
#include "support/tap.h"

static struct eo_faults faults;
static struct eo_design design;

static json_t *parse(const char *text)
{
  struct eo_error error;
  json_t *document = eo_json_parse(text, strlen(text), &error);
  if (!document)
    printf("# %s\n", error.text);
  return document;
}

static const char *minimal = "{\"gear_pair\":{\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_"
                             "angle_deg\":24,\"face_width_mm\":55},\"load_cases\":[{\"torque_Nm\":828,\"speed_rpm\":"
                             "2000}]}";

/* Number of faults of a document; releases it. */
static int count_faults(json_t *document)
{
  faults.count = 0;
  eo_design_decode(document, &design, NULL, &faults);
  json_decref(document);
  return faults.count;
}

static int expected_faults, missed_faults;
static char long_text[1000];

/* The complete document with one value replaced (or removed) must give one fault, at that value. */
static void provoke(const json_t *complete, const char *pointer, json_t *value)
{
  json_t *document = json_deep_copy(complete), *place = document;
  char path[300], *key = path, *last = NULL;
  snprintf(path, sizeof path, "%s", pointer + 1);
  for (char *slash; (slash = strchr(key, '/')); key = slash + 1) {
    *slash = '\0';
    place = json_is_array(place) ? json_array_get(place, (size_t)atoi(key)) : json_object_get(place, key);
  }
  last = key;
  if (!value)
    json_object_del(place, last);
  else if (json_is_array(place))
    json_array_set(place, (size_t)atoi(last), value);
  else
    json_object_set(place, last, value);
  char *shown = value ? json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT) : strdup("nothing");
  int count = count_faults(document);
  expected_faults++;
  if (count < 1 || strcmp(faults.fault[0].pointer, pointer) != 0) {
    missed_faults++;
    printf("# %s = %.60s: %d faults, %s: %s\n", pointer, shown, count, count ? faults.fault[0].pointer : "",
           count ? faults.fault[0].text : "");
  }
  free(shown);
  json_decref(value);
}

static void provoke_number(const json_t *complete, const char *pointer, const struct eo_field *field, double low,
                           double high)
{
  bool whole = field->kind == EO_FIELD_INTEGER || field->kind == EO_FIELD_SEED;
  double step = whole ? 1 : 1e-6 * (high - low);
  provoke(complete, pointer, json_real(low - step));
  provoke(complete, pointer, json_real(high + step));
  provoke(complete, pointer, json_real(1e308));
  provoke(complete, pointer, json_string("6"));
  provoke(complete, pointer, json_true());
  if (whole)
    provoke(complete, pointer, json_real(low + 0.5));
}

static void provoke_table(const json_t *complete, const char *pointer, const struct eo_table *table);

static void provoke_field(const json_t *complete, const char *pointer, const struct eo_field *field)
{
  char inner[300];
  if (!(field->flags & EO_FIELD_NULLABLE))
    provoke(complete, pointer, json_null());
  if (field->flags & EO_FIELD_REQUIRED)
    provoke(complete, pointer, NULL);
  switch (field->kind) {
  case EO_FIELD_NUMBER:
  case EO_FIELD_INTEGER:
  case EO_FIELD_SEED:
    provoke_number(complete, pointer, field, field->low, field->high);
    break;
  case EO_FIELD_FLAG:
    provoke(complete, pointer, json_integer(1));
    provoke(complete, pointer, json_string("true"));
    break;
  case EO_FIELD_TEXT:
  case EO_FIELD_CHOICE:
    provoke(complete, pointer, json_integer(0));
    if (field->choices)
      provoke(complete, pointer, json_string("Other"));
    else
      provoke(complete, pointer, json_string(long_text));
    break;
  case EO_FIELD_NUMBERS:
    provoke(complete, pointer, json_array());
    provoke(complete, pointer, json_integer(1));
    if (field->flags & EO_FIELD_ASCENDING)
      provoke(complete, pointer, json_pack("[f,f]", field->low + 2, field->low + 1));
    break;
  case EO_FIELD_OBJECT:
    provoke(complete, pointer, json_array());
    provoke_table(complete, pointer, field->table);
    break;
  case EO_FIELD_LIST:
    provoke(complete, pointer, json_object());
    snprintf(inner, sizeof inner, "%.250s/0", pointer);
    provoke(complete, inner, json_integer(3));
    provoke_table(complete, inner, field->table);
    break;
  case EO_FIELD_SERIES:
  case EO_FIELD_MATRIX:
  case EO_FIELD_DOCUMENT:
  case EO_FIELD_NAMES: /* no design has one: test-layout */
    break;
  }
}

static void provoke_table(const json_t *complete, const char *pointer, const struct eo_table *table)
{
  char inner[300];
  for (int i = 0; i < table->count; i++) {
    snprintf(inner, sizeof inner, "%.200s/%.80s", pointer, table->field[i].key);
    if (!(table->field[i].flags & EO_FIELD_ELSEWHERE))
      provoke_field(complete, inner, &table->field[i]);
  }
  snprintf(inner, sizeof inner, "%.250s/no_such_key", pointer);
  provoke(complete, inner, json_integer(1));
}

static void test_every_fault(void)
{
  static struct eo_design complete;
  struct eo_geometry geometry;
  memset(long_text, 'x', sizeof long_text - 1);
  eo_example_build("paper-case-b", &complete);
  complete.objective.robust = EO_ROBUST_MEAN;
  complete.rating.accuracy_grade = 5;                      /* so that the rating is in the document */
  complete.tolerance.rows = complete.tolerance.limits = 1; /* and these */
  complete.tolerance.row[0].cut = NAN;
  strcpy(complete.tolerance.row[0].key, "speed_factor");
  strcpy(complete.tolerance.limit[0].output, "peak_to_peak_um");
  complete.tolerance.limit[0].most = 1;
  complete.objective.terms = complete.objective.limits = 1;
  complete.objective.term[0] = (struct eo_objective_term){.weight = 1, .scale = NAN, .percent = NAN};
  complete.objective.limit[0] = (struct eo_objective_limit){.most = 1, .percent = NAN};
  for (int i = 0; i < 4; i++) /* and all flanks */
    complete.modification.coast[i / 2][i % 2].helix_slope = 1e-6;
  complete.load_case[0].has_alignment = 1;
  complete.load_case[0].alignment = (struct eo_case_alignment){NAN, NAN, NAN, NAN};
  complete.optimization.variables = EO_VARIABLES_LISTED;
  complete.optimization.listed = 1;
  complete.optimization.list[0] =
      (struct eo_listed_variable){.member = EO_PINION, .end = EO_BOTH_ENDS, .bounds = {0, 40}};
  ok(eo_design_complete(&complete, &geometry, NULL) == EO_OK, "the base design of these faults is right");
  json_t *document = eo_design_encode(&complete), *ends, *flank;
  const char *member, *end;
  json_object_foreach(json_object_get(document, "modification"), member, ends) /* a complete design has them in grids */
      json_object_foreach(ends, end, flank)
  {
    json_object_set_new(flank, "grid_nodes", json_pack("[{s:i}]", "row", 1));
    json_object_set_new(json_object_get(flank, "coast"), "grid_nodes", json_pack("[{s:i}]", "row", 1));
  }
  provoke_table(document, "", &eo_design_table);
  json_decref(document);
  ok(missed_faults == 0, "%d single faults, each reported at its key", expected_faults);
  ok(expected_faults > 700, "the single faults are on every key of the document");
}

static void test_all_at_once(void)
{
  json_t *document = parse(
      "{\"gear_pair\":{\"pinion_teeth\":\"17\",\"gear_teeth\":44.5,\"normal_modul_mm\":6,\"helix_angle_deg\":99},"
      "\"load_cases\":[{\"torque_Nm\":-2e8},{\"speed_rpm\":2e6}],\"alignment\":3,\"nonsense\":{}}");
  static const char *const expected[] = {"/gear_pair/pinion_teeth",
                                         "/gear_pair/gear_teeth",
                                         "/gear_pair/normal_module_mm",
                                         "/gear_pair/helix_angle_deg",
                                         "/gear_pair/face_width_mm",
                                         "/gear_pair/normal_modul_mm",
                                         "/alignment",
                                         "/load_cases/0/torque_Nm",
                                         "/load_cases/0/speed_rpm",
                                         "/load_cases/1/torque_Nm",
                                         "/load_cases/1/speed_rpm",
                                         "/nonsense"};
  int count = count_faults(document), good = 0, n = (int)(sizeof expected / sizeof expected[0]);
  for (int i = 0; i < count && i < n; i++)
    good += strcmp(faults.fault[i].pointer, expected[i]) == 0;
  ok(count == n && good == n, "%d faults in one document are all reported, in its order", n);
  ok(strstr(faults.fault[5].text, "\"normal_module_mm\"") != NULL,
     "the fault of a misspelt key says what it may have meant: %s", faults.fault[5].text);
  ok(strcmp(faults.fault[3].text, "99 is outside 0 .. 60 deg.") == 0, "the fault of a value names it and its range: %s",
     faults.fault[3].text);
  ok(count_faults(parse("{}")) == 6, "an empty document misses six keys");
  ok(strcmp(faults.fault[5].pointer, "/load_cases") == 0 && strstr(faults.fault[2].text, "transverse_module_mm"),
     "the load case is among what an empty document misses; the module may be stated in other ways: %s",
     faults.fault[2].text);
  ok(count_faults(parse("{\"load_cases\":[{\"torque_Nm\":1,\"speed_rpm\":1}],\"gear_pair\":{\"a~b/"
                        "c\\n\":1,\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24,"
                        "\"face_width_mm\":55}}")) == 1 &&
         strcmp(faults.fault[0].pointer, "/gear_pair/a~0b~1c?") == 0,
     "pointers are escaped and stay on one line: %s", faults.fault[0].pointer);
}

static void test_many_faults(void)
{
  json_t *document = parse(minimal);
  char key[600];
  for (int i = 0; i < 300; i++) {
    snprintf(key, sizeof key, "%d-%0500d", i, 0);
    json_object_set_new(document, key, json_null());
  }
  ok(count_faults(document) == 300 && strlen(faults.fault[EO_MAX_FAULTS - 1].pointer) < sizeof faults.fault[0].pointer,
     "300 faults with long keys are counted, %d kept", EO_MAX_FAULTS);
  design.load_cases = -7;
  count_faults(parse("{}"));
  ok(design.load_cases == -7, "a faulty document leaves the design alone");
}

static void test_defaults(void)
{
  struct eo_geometry geometry;
  ok(count_faults(parse(minimal)) == 0, "teeth, module, helix angle, face width and a load case are enough");
  ok(design.load_cases == 1 && design.load_case[0].share == 1, "decoding adds no load case");
  ok(eo_design_complete(&design, &geometry, NULL) == EO_OK, "the least design can be completed");
  ok(design.gear_pair.ends == 2 && design.gear_pair.dedendum_coefficient == 1.25 &&
         design.gear_pair.fillet_radius_coefficient == 0.38,
     "the basic rack by default is that of ISO 53");
  close_to(design.gear_pair.normal_pressure_angle, 0.3490658503988659, 1e-16, "pressure angle by default");
  ok(design.material.youngs_modulus == 206e9 && design.material.poissons_ratio == 0.3 &&
         design.material.density == 7850,
     "the material by default is steel");
  ok(design.alignment.shaft_angle_in_plane == 0 && design.alignment.shaft_angle_out_of_plane == 0,
     "the shafts are aligned by default");
  close_to(design.gear_pair.backlash, 2. / 3 * (60e-6 + 0.0005 * 0.2003184389666066 + 0.03 * 6e-3), 1e-12,
           "backlash by default, of ISO/TR 10064-2");
  near(design.supports.bearing_stiffness[0], 7.572e8, 1e-3, "stiffness of the pinion's bearings by its size");
  near(design.supports.bearing_stiffness[1], 7.572e8 * cbrt(44. / 17), 1e-3,
       "stiffness of the gear's bearings by its size");
  near(design.supports.gear_axial_stiffness[0], 0.2 * 7.572e8 * cbrt(44. / 17), 1e-3,
       "stiffness along the axis, a fifth of that across it");
  ok(design.supports.bearing_damping_ratio == 0.05 && design.supports.groove_damping_ratio == 0.02 &&
         design.supports.mesh_damping_ratio == 0.07,
     "the damping by default is that of the theory");
  ok(design.objective.weight[0] == 0.4 && design.objective.weight[1] == 0.15 && design.objective.weight[2] == 0.45,
     "the weights by default are those of section 5.2");
  ok(design.optimization.search.population == 50 && design.optimization.search.generations == 200 &&
         design.optimization.search.crossover == 0.8 && design.optimization.search.mutation == 0.3 &&
         design.optimization.search.trust_threshold == 0.6 && design.optimization.search.redundancy_threshold == 1e-7,
     "the search by default is that of Table 2");
  ok(design.resolution.positions == 64 && design.resolution.cells_per_line == 30 &&
         design.resolution.elements.sector_teeth == 5 && design.resolution.tip_edge_contact &&
         design.resolution.elements.neighbour_coupling && design.resolution.mesh_law == EO_LAW_TANGENT &&
         design.resolution.harmonics == 24 && design.resolution.te_harmonics == 16,
     "the resolution by default is that of the theory");
  close_to(design.optimization.tip_relief.high, 120e-6, 1e-18, "reliefs by default go up to 0.02 m_n");
  close_to(design.optimization.lead_crowning.high, 40e-6, 1e-18, "crownings by default go up to 40 um");
}

static json_t *with_cases(const char *cases)
{
  json_t *document = parse(minimal);
  json_object_set_new(document, "load_cases", json_loads(cases, 0, NULL));
  return document;
}

static void test_shares(void)
{
  struct eo_warnings warnings = {0};
  faults.count = 0;
  json_t *document =
      with_cases("[{\"speed_rpm\":9,\"torque_Nm\":100,\"share\":3},{\"speed_rpm\":9,\"torque_Nm\":200,\"share\":1}]");
  ok(eo_design_decode(document, &design, &warnings, &faults) && design.load_case[0].share == 0.75 &&
         design.load_case[1].share == 0.25,
     "shares are scaled to the sum 1");
  ok(warnings.count == 1 && strstr(warnings.text[0], "summed to 4"), "a warning says that shares were scaled: %s",
     warnings.text[0]);
  json_decref(document);
  warnings.count = 0;
  document = with_cases(
      "[{\"speed_rpm\":9,\"torque_Nm\":100},{\"speed_rpm\":9,\"torque_Nm\":200},{\"speed_rpm\":9,\"torque_Nm\":300}]");
  ok(eo_design_decode(document, &design, &warnings, &faults) && design.load_case[2].share == 1. / 3 && !warnings.count,
     "load cases without shares have equal ones, without a warning");
  json_decref(document);
  ok(count_faults(
         with_cases("[{\"speed_rpm\":9,\"torque_Nm\":100,\"share\":1},{\"speed_rpm\":9,\"torque_Nm\":200}]")) == 1 &&
         strcmp(faults.fault[0].pointer, "/load_cases") == 0,
     "shares that are stated for some load cases alone are refused");
  ok(count_faults(with_cases("[{\"speed_rpm\":9,\"torque_Nm\":100,\"share\":0}]")) == 1,
     "shares that sum to 0 are refused");
  ok(count_faults(with_cases("[]")) == 1, "a list of no load case is refused");
}

/* A mesh that the preparation would refuse is refused at its field. */
static void test_mesh_of_a_resolution(void)
{
  const char *key[] = {"layers", "flank_rows", "fillet_elements"};
  const int most[] = {EO_LAYERS_MOST, EO_FLANK_ROWS_MOST, EO_FILLET_ELEMENTS_MOST};
  for (int i = 0; i < 3; i++)
    for (int beyond = 0; beyond < 2; beyond++) {
      json_t *document = parse(minimal);
      json_object_set_new(document, "resolution", json_pack("{s:i}", key[i], most[i] + beyond));
      ok(count_faults(document) == beyond, "%s = %d is %s", key[i], most[i] + beyond, beyond ? "refused" : "taken");
    }
}

static void test_one_end(void)
{
  struct eo_warnings warnings = {0};
  json_t *document = parse(minimal);
  json_object_set_new(json_object_get(document, "gear_pair"), "ends", json_integer(1));
  json_object_set_new(
      document, "modification",
      json_pack("{s:{s:{s:i},s:{s:i}}}", "pinion", "left", "tip_relief_um", 5, "right", "tip_relief_um", 7));
  faults.count = 0;
  ok(eo_design_decode(document, &design, &warnings, &faults) && warnings.count == 1 &&
         design.modification.flank[0][1].tip_relief == 0 && design.modification.flank[0][0].tip_relief == 5e-6,
     "the right end's modification is dropped with a warning where there is one end");
  json_decref(document);
  document = eo_design_encode(&design);
  ok(!json_object_get(json_object_get(json_object_get(document, "modification"), "pinion"), "right"),
     "the right end's modification is not written where there is one end");
  json_decref(document);
}

static void test_hashes(void)
{
  char first[EO_HASH_LENGTH + 1], second[EO_HASH_LENGTH + 1], problem[2][EO_HASH_LENGTH + 1];
  struct eo_text spec = {0};
  eo_example_build("paper", &design);
  eo_design_hash(&design, first, NULL);
  eo_design_problem(&design, &spec, problem[0], NULL);
  design.modification.flank[EO_PINION][EO_LEFT].tip_relief = 1e-6;
  design.optimization.search.seed = 7;
  eo_design_hash(&design, second, NULL);
  eo_design_problem(&design, &spec, problem[1], NULL);
  ok(strcmp(first, second) != 0 && strcmp(problem[0], problem[1]) == 0,
     "modification and seed change the hash of the design and not that of its problem");
  design.material.density = nextafter(7850, 8000);
  eo_design_problem(&design, &spec, problem[1], NULL);
  ok(strcmp(problem[0], problem[1]) != 0, "one bit of the density changes both hashes");
  json_t *before = eo_design_encode(&design);
  json_object_del(json_object_get(before, "alignment"), "centre_distance_deviation_um");
  json_object_del(json_object_get(before, "tolerance"), "centre_distance");
  eo_design_hash_document(before, first, NULL);
  json_decref(before);
  eo_design_hash(&design, second, NULL);
  ok(strcmp(first, second) == 0, "a design of before axes could stand apart keeps its hash");
  eo_design_problem(&design, &spec, problem[0], NULL);
  design.alignment.centre_distance_deviation = 1e-6;
  eo_design_hash(&design, second, NULL);
  eo_design_problem(&design, &spec, problem[1], NULL);
  ok(strcmp(first, second) != 0 && strcmp(problem[0], problem[1]) != 0, "axes that do have another");
  eo_text_done(&spec);
  eo_hash_hex("abc", 3, first);
  ok(strcmp(first, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad") == 0,
     "the hash of \"abc\" is that of FIPS 180-4");
}

/* A resolution that names the sector's teeth but no body is older than the ring. */
static void test_body(void)
{
  static const struct {
    const char *text;
    enum eo_body body;
  } row[] = {{"{}", EO_BODY_RING},
             {"{\"sector_teeth\": 3}", EO_BODY_SECTOR},
             {"{\"sector_teeth\": 5, \"body\": \"ring\"}", EO_BODY_RING},
             {"{\"body\": \"sector\"}", EO_BODY_SECTOR}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    struct eo_resolution resolution;
    struct eo_faults wrong = {0};
    json_t *document = json_loads(row[i].text, 0, NULL);
    eo_table_decode(&eo_resolution_table, document, NULL, &resolution, &wrong);
    ok(wrong.count == 0 && resolution.elements.body == row[i].body, "%s means the %s", row[i].text,
       row[i].body == EO_BODY_RING ? "ring" : "sector");
    json_decref(document);
  }
}

/* Astern the coast flanks carry. */
static void test_other_flank(void)
{
  static struct eo_design astern;
  static struct eo_warnings found;
  struct eo_geometry geometry;
  struct eo_error error;
  const char *text[3] = {0};
  eo_example_build("paper", &astern);
  const double index[64] = {1e-6};
  astern.pitch.stated = true;
  if (eo_tooth_tables_add(&astern.pitch.tables, EO_DRIVE_FLANK, EO_PINION, EO_LEFT, EO_TOOTH_INDEX,
                          astern.gear_pair.teeth[EO_PINION], index, &error))
    printf("Bail out! %s\n", error.text);
  for (int step = 0; step < 3; step++) {
    astern.load_case[0].direction = step > 0 ? EO_ASTERN : EO_AHEAD;
    astern.pitch.member[EO_PINION].tolerance_class = step == 2 ? 5 : 0;
    found.count = 0;
    if (eo_design_complete(&astern, &geometry, &error))
      printf("Bail out! %s\n", error.text);
    eo_design_note_findings(&astern, &geometry, &found);
    for (int i = 0; i < found.count; i++)
      text[step] = strcmp(found.key[i], "/pitch/pinion") == 0 ? found.text[i] : text[step];
  }
  ok(!text[0], "ahead the drive flanks carry, of which there are tables");
  ok(text[1] && strstr(text[1], "Load case 1 runs on the coast flanks") && strstr(text[1], "drive flanks alone"),
     "astern a finding says whose tables are not used: %s", text[1] ? text[1] : "nothing");
  ok(!text[2], "a class draws the teeth of the other flanks");
}

int main(void)
{
  test_body();
  test_every_fault();
  test_all_at_once();
  test_many_faults();
  test_defaults();
  test_shares();
  test_mesh_of_a_resolution();
  test_one_end();
  test_hashes();
  test_other_flank();
  return tap_done();
}
