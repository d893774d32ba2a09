/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The design document: every way to get a key wrong, defaults against the product's description, derived defaults
   against the model's printed figures, and keys that contradict each other. */
#include <stdlib.h>
#include <string.h>

#include "design/pair_identity.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "flexibility/flexibility.h"
#include "format/json.h"
#include "document/search_space.h"
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
  ok(eo_design_complete(&complete, &geometry, NULL) == EO_OK, "the base design is right");
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
  ok(expected_faults > 700, "on every key of the document");
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
  ok(strstr(faults.fault[5].text, "\"normal_module_mm\"") != NULL, "a misspelt key is told what it may have meant: %s",
     faults.fault[5].text);
  ok(strcmp(faults.fault[3].text, "99 is outside 0 .. 60 deg.") == 0, "value and range are named: %s",
     faults.fault[3].text);
  ok(count_faults(parse("{}")) == 6, "an empty document misses six keys");
  ok(strcmp(faults.fault[5].pointer, "/load_cases") == 0 && strstr(faults.fault[2].text, "transverse_module_mm"),
     "a load case among them; the module may be stated in other ways: %s", faults.fault[2].text);
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
  ok(design.load_cases == 1 && design.load_case[0].share == 1, "no load case is added");
  ok(eo_design_complete(&design, &geometry, NULL) == EO_OK, "it can be completed");
  ok(design.gear_pair.ends == 2 && design.gear_pair.dedendum_coefficient == 1.25 &&
         design.gear_pair.fillet_radius_coefficient == 0.38,
     "basic rack");
  close_to(design.gear_pair.normal_pressure_angle, 0.3490658503988659, 1e-16, "pressure angle 20 deg");
  ok(design.material.youngs_modulus == 206e9 && design.material.poissons_ratio == 0.3 &&
         design.material.density == 7850,
     "steel");
  ok(design.alignment.shaft_angle_in_plane == 0 && design.alignment.shaft_angle_out_of_plane == 0, "aligned");
  close_to(design.gear_pair.backlash, 2. / 3 * (60e-6 + 0.0005 * 0.2003184389666066 + 0.03 * 6e-3), 1e-12,
           "backlash of ISO/TR 10064-2");
  near(design.supports.bearing_stiffness[0], 7.572e8, 1e-3, "bearings by the size of the pinion");
  near(design.supports.bearing_stiffness[1], 7.572e8 * cbrt(44. / 17), 1e-3, "and of the gear");
  near(design.supports.gear_axial_stiffness[0], 0.2 * 7.572e8 * cbrt(44. / 17), 1e-3, "along the axis a fifth");
  ok(design.supports.bearing_damping_ratio == 0.05 && design.supports.groove_damping_ratio == 0.02 &&
         design.supports.mesh_damping_ratio == 0.07,
     "damping");
  ok(design.objective.weight[0] == 0.4 && design.objective.weight[1] == 0.15 && design.objective.weight[2] == 0.45,
     "weights of section 5.2");
  ok(design.optimization.search.population == 50 && design.optimization.search.generations == 200 &&
         design.optimization.search.crossover == 0.8 && design.optimization.search.mutation == 0.3 &&
         design.optimization.search.trust_threshold == 0.6 && design.optimization.search.redundancy_threshold == 1e-7,
     "Table 2");
  ok(design.resolution.positions == 64 && design.resolution.cells_per_line == 30 &&
         design.resolution.sector_teeth == 5 && design.resolution.tip_edge_contact &&
         design.resolution.neighbour_coupling && design.resolution.mesh_law == EO_LAW_TANGENT &&
         design.resolution.harmonics == 24 && design.resolution.te_harmonics == 16,
     "resolution");
  close_to(design.optimization.tip_relief.high, 120e-6, 1e-18, "reliefs up to 0.02 m_n");
  close_to(design.optimization.lead_crowning.high, 40e-6, 1e-18, "crowning up to 40 um");
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
  ok(warnings.count == 1 && strstr(warnings.text[0], "summed to 4"), "and it is said: %s", warnings.text[0]);
  json_decref(document);
  warnings.count = 0;
  document = with_cases(
      "[{\"speed_rpm\":9,\"torque_Nm\":100},{\"speed_rpm\":9,\"torque_Nm\":200},{\"speed_rpm\":9,\"torque_Nm\":300}]");
  ok(eo_design_decode(document, &design, &warnings, &faults) && design.load_case[2].share == 1. / 3 && !warnings.count,
     "no shares: equal ones, without a word");
  json_decref(document);
  ok(count_faults(
         with_cases("[{\"speed_rpm\":9,\"torque_Nm\":100,\"share\":1},{\"speed_rpm\":9,\"torque_Nm\":200}]")) == 1 &&
         strcmp(faults.fault[0].pointer, "/load_cases") == 0,
     "some shares stated, some not");
  ok(count_faults(with_cases("[{\"speed_rpm\":9,\"torque_Nm\":100,\"share\":0}]")) == 1, "shares that sum to 0");
  ok(count_faults(with_cases("[]")) == 1, "no load case");
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
     "one end: the right end's modification is dropped with a warning");
  json_decref(document);
  document = eo_design_encode(&design);
  ok(!json_object_get(json_object_get(json_object_get(document, "modification"), "pinion"), "right"),
     "and not written");
  json_decref(document);
}

/* Figures of physics.md section 9, of the paper pair. */
static void test_derived(void)
{
  struct eo_geometry geometry;
  struct eo_error error = {0};
  eo_example_build("paper-case-a", &design);
  ok(isnan(design.gear_pair.bore[EO_GEAR]) && isnan(design.supports.mass[0]), "derived values are open in an example");
  ok(eo_design_complete(&design, &geometry, &error) == EO_OK, "and are found %s", error.text);
  near(design.supports.mass[EO_PINION], 5.608, 2e-4, "m_p, kg");
  near(design.supports.inertia[EO_PINION], 8.134e-3, 2e-4, "I_p, kg m2");
  near(design.supports.mass[EO_GEAR], 35.73, 2e-4, "m_g, kg");
  near(design.supports.inertia[EO_GEAR], 0.3970, 2e-4, "I_g, kg m2");
  near(design.supports.groove_axial_stiffness[EO_PINION], 2.90e10, 2e-3, "EA/L of the pinion's groove, N/m");
  near(design.supports.groove_axial_stiffness[EO_GEAR], 2.13e11, 2e-3, "EA/L of the gear's groove, N/m");
  close_to(design.gear_pair.bore[EO_GEAR], 0.09, 1e-15, "gear bore 90 mm");
  close_to(design.gear_pair.centre_distance, 0.2003184389666066, 1e-15, "centre distance");
  close_to(design.modification.flank[EO_PINION][EO_LEFT].lead_crowning, 12.23e-6, 0.005e-6,
           "a_l 1.35e-8/um at the face ends");
  ok(isnan(design.supports.mesh_damping_stiffness), "mesh damping waits for the mesh stiffness");
  close_to(design.optimization.search.share_radius, 0.03, 1e-15, "r_share for 5 variables");
  eo_example_build("paper-case-b", &design);
  eo_design_complete(&design, &geometry, &error);
  close_to(design.optimization.search.share_radius, 0.11, 0.005, "r_share for 10 variables");
  close_to(design.shafts.bearing_position[EO_PINION][EO_RIGHT], 0.025 + 0.055 + 0.0275, 1e-15,
           "right bearing half a face width outside");
}

static void test_robust(void)
{
  struct eo_geometry geometry;
  eo_example_build("paper", &design);
  design.objective.robust = EO_ROBUST_WORST;
  eo_design_complete(&design, &geometry, NULL);
  ok(design.objective.scenarios == 7 && design.objective.scenario[0].in_plane == design.alignment.shaft_angle_in_plane,
     "a robust objective has seven scenarios, the nominal one first");
}

/* What takes more than one key: each with the key it is reported at. */
struct contradiction {
  const char *what, *key;
  void (*apply)(struct eo_design *design);
};

static void thick_bore(struct eo_design *d)
{
  d->gear_pair.bore[EO_PINION] = 0.09;
}
static void thin_groove(struct eo_design *d)
{
  d->gear_pair.groove_diameter[EO_GEAR] = 0.08;
}
static void thick_groove(struct eo_design *d)
{
  d->gear_pair.groove_diameter[EO_PINION] = 0.1;
}
static void no_groove(struct eo_design *d)
{
  d->gear_pair.groove_width = 0;
}
static void late_tip(struct eo_design *d)
{
  d->modification.flank[EO_PINION][EO_RIGHT].tip_relief_start = 5.2e-3;
}
static void late_root(struct eo_design *d)
{
  d->modification.flank[EO_PINION][EO_LEFT].root_relief_start = 5.8e-3;
}
static void late_gear_tip(struct eo_design *d)
{
  d->modification.flank[EO_GEAR][EO_LEFT].tip_relief = 1e-5;
  d->modification.flank[EO_GEAR][EO_LEFT].tip_relief_start =
      5.74e-3; /* the gear's tip side ends where the pinion's root side does */
}
static void no_relief_length(struct eo_design *d)
{
  d->modification.flank[EO_PINION][EO_LEFT].end_relief[1] = 1e-5;
}
static void long_end_reliefs(struct eo_design *d)
{
  for (int k = 0; k < 2; k++) {
    d->modification.flank[EO_PINION][EO_LEFT].end_relief[k] = 1e-5;
    d->modification.flank[EO_PINION][EO_LEFT].end_relief_length[k] = 0.028;
  }
}
static void wide_bounds(struct eo_design *d)
{
  d->optimization.tip_relief_start.high = 5.2e-3;
}
static void wide_root_bounds(struct eo_design *d)
{
  d->optimization.root_relief_start.high = 5.8e-3;
}
static void high_floor(struct eo_design *d)
{
  d->optimization.search.removal_threshold = 0.6;
}
static void whole_elite(struct eo_design *d)
{
  d->optimization.search.algorithm = EO_GA;
  d->optimization.search.elite = d->optimization.search.population;
}
static void same_variable(struct eo_design *d)
{
  d->optimization.variables = EO_VARIABLES_LISTED;
  d->optimization.listed = 2;
  d->optimization.list[0] = d->optimization.list[1] =
      (struct eo_listed_variable){.member = EO_PINION, .end = EO_BOTH_ENDS, .bounds = {0, 40}};
}
static void no_variables(struct eo_design *d)
{
  d->optimization.variables = EO_VARIABLES_LISTED;
}
static void even_sector(struct eo_design *d)
{
  d->resolution.body = EO_BODY_SECTOR;
  d->resolution.sector_teeth = 4;
}
static void many_harmonics(struct eo_design *d)
{
  d->resolution.te_harmonics = 33;
}
static void crossed_bearings(struct eo_design *d)
{
  d->shafts.enabled = true;
  d->shafts.bearing_position[EO_GEAR][EO_LEFT] = 0.2;
}
static void bearing_inside(struct eo_design *d)
{
  d->shafts.enabled = true;
  d->shafts.bearing_position[EO_PINION][EO_RIGHT] = 0.079;
}
static void left_bearing_inside(struct eo_design *d)
{
  d->shafts.enabled = true;
  d->shafts.bearing_position[EO_GEAR][EO_LEFT] = -0.0799;
}
static void thin_shaft(struct eo_design *d)
{
  d->shafts.enabled = true;
  d->shafts.shaft_diameter[EO_GEAR] = 0.09;
}
static void no_weights(struct eo_design *d)
{
  d->objective.weight[0] = d->objective.weight[1] = d->objective.weight[2] = 0;
}
static void undercut(struct eo_design *d)
{
  d->gear_pair.teeth[EO_PINION] = 8;
}
static void pointed(struct eo_design *d)
{
  d->gear_pair.tip_diameter[EO_PINION] = 0.14;
  d->gear_pair.dedendum_coefficient = 3;
  d->gear_pair.fillet_radius_coefficient = 0.02;
}
static void tip_in_fillet(struct eo_design *d)
{
  d->gear_pair.addendum_coefficient = 1.2;
}
static void narrow_face(struct eo_design *d)
{
  d->gear_pair.face_width = 5e-3;
  d->gear_pair.addendum_coefficient = 0.5;
}
static void jammed(struct eo_design *d)
{
  d->gear_pair.centre_distance = 0.2;
}

static const struct contradiction contradictions[] = {
    {"bore that cuts the rim", "/gear_pair/pinion_bore_mm", thick_bore},
    {"groove body thinner than the bore", "/gear_pair/gear_groove_diameter_mm", thin_groove},
    {"groove body above the root", "/gear_pair/pinion_groove_diameter_mm", thick_groove},
    {"two ends without a groove", "/gear_pair/groove_width_mm", no_groove},
    {"tip relief beyond the active flank", "/modification/pinion/right/tip_relief_start_mm", late_tip},
    {"root relief beyond the active flank", "/modification/pinion/left/root_relief_start_mm", late_root},
    {"the gear's tip relief beyond its active flank", "/modification/gear/left/tip_relief_start_mm", late_gear_tip},
    {"end relief without a length", "/modification/pinion/left/leading_end_relief_um", no_relief_length},
    {"end reliefs that overlap", "/modification/pinion/left/leading_end_relief_length_mm", long_end_reliefs},
    {"a sector without a middle tooth", "/resolution/sector_teeth", even_sector},
    {"more harmonics than positions resolve", "/resolution/te_harmonics", many_harmonics},
    {"bearings in the wrong order", "/shafts/gear_left_bearing_mm", crossed_bearings},
    {"right bearing inside the toothed body", "/shafts/pinion_right_bearing_mm", bearing_inside},
    {"left bearing inside the toothed body", "/shafts/gear_left_bearing_mm", left_bearing_inside},
    {"a shaft no thicker than its bore", "/shafts/gear_shaft_diameter_mm", thin_shaft},
    {"no weight", "/objective/weights", no_weights},
    {"undercut into the active flank", "/gear_pair/pinion_profile_shift", undercut},
    {"pointed or interfering tip", NULL, pointed},
    {"tip in the fillet", "/gear_pair/addendum_coefficient", tip_in_fillet},
    {"no continuous contact", "/gear_pair/face_width_mm", narrow_face},
    {"negative backlash", "/gear_pair/centre_distance_mm", jammed},
};

static void test_contradictions(void)
{
  for (size_t i = 0; i < sizeof contradictions / sizeof contradictions[0]; i++) {
    struct eo_geometry geometry;
    struct eo_error error = {0};
    eo_example_build("paper-case-a", &design);
    contradictions[i].apply(&design);
    static struct eo_design before;
    before = design;
    enum eo_code code = eo_design_complete(&design, &geometry, &error);
    ok(code == EO_ERROR_INPUT && (!contradictions[i].key || strcmp(error.pointer, contradictions[i].key) == 0) &&
           error.text[0] && memcmp(&before, &design, sizeof before) == 0,
       "%s: %s: %s", contradictions[i].what, error.pointer, error.text);
  }
}

/* What only a search uses: no analysis is refused for it, a search is, and whoever reads the design is told. */
static const struct contradiction search_contradictions[] = {
    {"tip start bounds outside the flank", "/optimization/bounds/tip_relief_start_mm", wide_bounds},
    {"root start bounds outside the flank", "/optimization/bounds/root_relief_start_mm", wide_root_bounds},
    {"R_0 >= R*", "/optimization/removal_threshold", high_floor},
    {"an elite of everybody", "/optimization/elite", whole_elite},
    {"a variable twice", "/optimization/variable_list/1", same_variable},
    {"variables that nobody lists", "/optimization/variable_list", no_variables},
};

static void test_search_contradictions(void)
{
  for (size_t i = 0; i < sizeof search_contradictions / sizeof *search_contradictions; i++) {
    const struct contradiction *row = &search_contradictions[i];
    struct eo_geometry geometry;
    struct eo_error error = {0};
    static struct eo_study_space space;
    static struct eo_warnings warnings;
    eo_example_build("paper-case-a", &design);
    row->apply(&design);
    ok(eo_design_complete(&design, &geometry, &error) == EO_OK, "%s: no matter of an analysis", row->what);
    ok(eo_study_space_init(&space, &design, &geometry, &error) == EO_ERROR_INPUT &&
           strcmp(error.pointer, row->key) == 0,
       "but a search is refused: %s: %s", error.pointer, error.text);
    warnings.count = 0;
    eo_design_note_findings(&design, &geometry, &warnings);
    ok(warnings.count == 1 && strcmp(warnings.key[0], row->key) == 0, "and it is said: %s", warnings.text[0]);
  }
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
     "modification and seed change the design's hash, not its problem's");
  design.material.density = nextafter(7850, 8000);
  eo_design_problem(&design, &spec, problem[1], NULL);
  ok(strcmp(problem[0], problem[1]) != 0, "one bit of the density changes both");
  eo_text_done(&spec);
  eo_hash_hex("abc", 3, first);
  ok(strcmp(first, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad") == 0,
     "SHA-256 of \"abc\" (FIPS 180-4)");
}

static struct eo_pair_identity identity_of(const struct eo_design *d)
{
  return eo_pair_identity_of(&d->gear_pair, &d->material, &d->resolution);
}

/* Moves one member of a group of the design by its field. */
static void nudge(void *group, const struct eo_field *field)
{
  char *place = (char *)group + field->offset;
  if (field->kind == EO_FIELD_NUMBER)
    *(double *)(void *)place = isnan(*(double *)(void *)place) ? 1 : nextafter(*(double *)(void *)place, INFINITY);
  else if (field->kind == EO_FIELD_FLAG)
    *(bool *)(void *)place = !*(bool *)(void *)place;
  else
    *(int *)(void *)place += 1;
}

/* How many fields of a group change the identity of the pair; those that do not are listed in `kept`, and the key says
   the same. */
static int count_identifying(const struct eo_table *table, size_t group, const char *const *kept)
{
  int count = 0;
  for (int i = 0; i < table->count; i++) {
    static struct eo_design moved;
    char key[2][EO_HASH_LENGTH + 1];
    moved = design;
    nudge((char *)&moved + group, &table->field[i]);
    struct eo_pair_identity before = identity_of(&design), after = identity_of(&moved);
    eo_pair_identity_key(&before, key[0]);
    eo_pair_identity_key(&after, key[1]);
    bool equal = eo_pair_identity_equal(&before, &after), listed = false;
    for (int k = 0; kept[k]; k++)
      listed = listed || strcmp(kept[k], table->field[i].key) == 0;
    ok(equal == listed && equal == (strcmp(key[0], key[1]) == 0), "%s %s", table->field[i].key,
       listed ? "keeps the prepared pair" : "needs another pair");
    count += !equal;
  }
  return count;
}

static void test_pair_identity(void)
{
  struct eo_geometry geometry;
  static const char *const none[] = {NULL},
                           *const entries[] = {"transverse_module_mm",
                                               "pinion_generating_shift",
                                               "gear_generating_shift",
                                               "normal_diametral_pitch_per_inch",
                                               "transverse_diametral_pitch_per_inch",
                                               "transverse_pressure_angle_deg",
                                               "pinion_profile_shift_mm",
                                               "gear_profile_shift_mm",
                                               "profile_shift_sum",
                                               "working_pressure_angle_deg",
                                               "pinion_addendum_mm",
                                               "gear_addendum_mm",
                                               "tip_alteration_coefficient",
                                               "thickness_series",
                                               "pinion_thickness_allowance_um",
                                               "gear_thickness_allowance_um",
                                               "centre_distance_allowance_um",
                                               "pinion_teeth_spanned",
                                               "gear_teeth_spanned",
                                               "pinion_measuring_ball_mm",
                                               "gear_measuring_ball_mm",
                                               "hand",
                                               NULL},
                           *const kept[] = {
                               "hub_windup", "marking_thickness_um", "mesh_law", "solver", "impact_in_dynamics",
                               "harmonics",  "te_harmonics",         NULL};
  eo_example_build("paper", &design);
  eo_design_complete(&design, &geometry, NULL);
  int count = count_identifying(&eo_gear_pair_table, offsetof(struct eo_design, gear_pair), entries) +
              count_identifying(&eo_material_table, offsetof(struct eo_design, material), none) +
              count_identifying(&eo_resolution_table, offsetof(struct eo_design, resolution), kept);
  ok(count == EO_PAIR_MEMBERS, "and that is all that identifies a pair: %d members", count);
}

/* Every setting of the optimizer has its row in the document, with the same default. */
static void test_search(void)
{
  struct eo_optimizer_settings standard;
  const struct eo_optimizer_settings *search = &design.optimization.search;
  struct eo_error error = {0};
  struct eo_geometry geometry;
  int differing = 0;
  eo_example_build("paper-case-b", &design);
  eo_optimizer_defaults(&standard, EO_CREDIBILITY_GA, 10);
#define COMPARE(member, ...) differing += search->member != standard.member;
#define SKIP(...)
  EO_OPTIMIZER_SETTINGS(COMPARE, COMPARE, COMPARE, SKIP, COMPARE, COMPARE, COMPARE)
  ok(differing == 0 && search->algorithm == EO_CREDIBILITY_GA && isnan(search->share_radius),
     "an example has the optimizer's defaults");
  ok(eo_design_complete(&design, &geometry, &error) == EO_OK && search->variables == 10 && search->objectives == 3 &&
         search->share_radius == eo_optimizer_share_radius(&standard),
     "a complete design says how many variables there are");
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
    ok(wrong.count == 0 && resolution.body == row[i].body, "%s means the %s", row[i].text,
       row[i].body == EO_BODY_RING ? "ring" : "sector");
    json_decref(document);
  }
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
  test_derived();
  test_robust();
  test_contradictions();
  test_search_contradictions();
  test_hashes();
  test_pair_identity();
  test_search();
  return tap_done();
}
