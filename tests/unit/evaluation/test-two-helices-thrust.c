/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Halves of unequal helix on their coast flanks and under a coupling's thrust, with a pinion that floats, is sprung or
   is held: what a mirrored design does, and the balance of forces by hand. A pair that nobody published; closed-form
   compliance. */
#include "document/design_document.h"
#include "document/design_export.h"
#include "document/flank_grid_document.h"
#include "evaluation/evaluator.h"
#include "flexibility/closed_form.h"
#include "format/json.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

enum { POSITIONS = 24 };
static const double ROUNDING = 1e-13; /* m, of approaches near 1e-5 m */
static const double SPRUNG = 1e-11;   /* m, where loads are sought until the springs agree */
static const double SPRING = 3e8;     /* N/m */
static struct eo_closed_form form = {1.4e-9, 11e-3, -0.7e-3, 18, 4000};

/* Filled in: the load cases. */
static const char document[] =
    "{\"version\":2,\"gear_pair\":{\"pinion_teeth\":21,\"gear_teeth\":58,\"normal_module_mm\":4,\"helix_angle_deg\":27,"
    "\"right_helix_angle_deg\":30,\"face_width_mm\":40,\"ends\":2,\"groove_width_mm\":30},"
    "\"load_cases\":[%s],"
    "\"resolution\":{\"positions\":24,\"te_harmonics\":3,\"cells_per_line\":16}}";

#define AHEAD "{\"torque_Nm\":450,\"speed_rpm\":2800}"
#define ASTERN "{\"torque_Nm\":-450,\"speed_rpm\":-2800}"
#define OVERRUN AHEAD ",{\"torque_Nm\":-450,\"speed_rpm\":2800}" /* the second one: the gear drives */

static void stop(const struct eo_error *error)
{
  printf("Bail out! %s: %s\n", error->pointer, error->text);
  exit(1);
}

static struct eo_design design_of(enum eo_axial axial, const char *load_cases)
{
  static struct eo_faults faults;
  struct eo_design design;
  struct eo_error error;
  char text[sizeof document + 200];
  snprintf(text, sizeof text, document, load_cases);
  json_t *read = eo_json_parse(text, strlen(text), &error);
  memset(&faults, 0, sizeof faults);
  if (!eo_design_decode(read, &design, NULL, &faults)) {
    eo_faults_first(&faults, &error);
    stop(&error);
  }
  json_decref(read);
  design.alignment.pinion_axial = axial;
  design.alignment.pinion_axial_stiffness = SPRING;
  for (int i = 0; i < 2; i++) /* nothing gives beside that spring */
    design.supports.bearing_stiffness[i] = design.supports.gear_axial_stiffness[i] =
        design.supports.groove_axial_stiffness[i] = design.supports.groove_torsional_stiffness[i] = 1e17;
  return design;
}

static struct eo_design plain_design(enum eo_axial axial)
{
  return design_of(axial, AHEAD);
}

/* A groove with which the right half leads by half a base pitch: it lags by as much when the pair runs the other way
   round, which is the same phase. Of other grooves the two ends of a mirrored design meet at another phase. */
static void set_groove(struct eo_design *design)
{
  struct eo_design copy = *design;
  struct eo_geometry geometry;
  struct eo_error error;
  if (eo_design_complete(&copy, &geometry, &error))
    stop(&error);
  double lead = eo_geometry_right_lead(&geometry, &copy.gear_pair), width = copy.gear_pair.face_width;
  double per_groove = lead / (width + copy.gear_pair.groove_width);
  design->gear_pair.groove_width = geometry.transverse_base_pitch / 2 / per_groove - width;
}

static struct eo_pair *prepare(struct eo_design *design)
{
  struct eo_geometry geometry;
  struct eo_pair *pair = NULL;
  struct eo_error error = {0};
  const struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}, .own_pivots = true};
  if (eo_design_complete(design, &geometry, &error) || eo_pair_new(&pair, design, &options, NULL, &error))
    stop(&error);
  return pair;
}

struct answer {
  double approach[2][POSITIONS], load[2][POSITIONS], transmission[POSITIONS];
  enum eo_flank_side flank;
  int ahead; /* of the right half, positions */
};

/* Of the last load case. */
static struct answer solve(const struct eo_pair *pair, const struct eo_design *wanted)
{
  struct eo_design design = *wanted;
  const struct eo_evaluation *result = NULL;
  struct eo_evaluator *evaluator = NULL;
  struct eo_geometry geometry;
  struct eo_error error = {0};
  struct answer answer;
  if (eo_design_complete(&design, &geometry, &error) || eo_evaluator_new(&evaluator, pair, 2, &error) ||
      eo_evaluator_contact(evaluator, &design, &result, &error))
    stop(&error);
  const struct eo_case_result *load_case = &result->load_case[result->cases - 1];
  for (int end = 0; end < 2; end++) {
    memcpy(answer.approach[end], load_case->end[end].loaded.approach, sizeof answer.approach[end]);
    memcpy(answer.load[end], load_case->end[end].loaded.load, sizeof answer.load[end]);
  }
  memcpy(answer.transmission, load_case->transmission, sizeof answer.transmission);
  answer.flank = load_case->running.flank;
  answer.ahead = pair->ahead[load_case->running.inwards];
  eo_evaluator_free(evaluator);
  return answer;
}

/* Position of the right half that stands beside one of the left half. */
static int beside(const struct answer *answer, int j)
{
  return (j + answer->ahead + 4 * POSITIONS) % POSITIONS;
}

static double worst(const double *a, const double *b)
{
  double most = 0;
  for (int j = 0; j < POSITIONS; j++)
    most = fmax(most, fabs(a[j] - b[j]));
  return most;
}

/* Flanks without symmetry; turned: delta(u, -y). */
static struct eo_flank_modification odd_flank(int k, bool turned)
{
  double sign = turned ? -1 : 1;
  struct eo_flank_modification flank = {.tip_relief = (9 + k) * 1e-6,
                                        .tip_relief_start = 1.1e-3,
                                        .root_relief = 6e-6,
                                        .root_relief_start = 1.5e-3,
                                        .lead_crowning = 5e-6,
                                        .helix_slope = sign * (k - 1.5) * 3e-6,
                                        .twist = sign * (2 - k) * 4e-6};
  flank.end_relief[turned ? EO_TRAILING_SIDE : EO_LEADING_SIDE] = 5e-6;
  flank.end_relief_length[turned ? EO_TRAILING_SIDE : EO_LEADING_SIDE] = 7e-3;
  return flank;
}

/* coast(delta(u, y), kappa, gamma, e, F) = drive(delta(u, -y), -kappa, gamma, -e, -F), hand by hand, with errors about
   each mid face: about the middle of the groove they also move the ends, the other way on the other flank. */
static void mirror(struct eo_design *drive, struct eo_design *coast, const char *coast_case)
{
  *coast = design_of(drive->alignment.pinion_axial, coast_case);
  coast->gear_pair = drive->gear_pair;
  for (int k = 0; k < 4; k++) {
    drive->modification.flank[k / 2][k % 2] = odd_flank(k, false);
    coast->modification.coast[k / 2][k % 2] = odd_flank(k, true);
  }
  drive->alignment.shaft_angle_in_plane = -3e-4;
  drive->alignment.shaft_angle_out_of_plane = 1e-4;
  drive->alignment.apex_offset[EO_PINION] = -9e-6;
  drive->alignment.coupling_thrust = -700;
  coast->alignment.shaft_angle_in_plane = 3e-4;
  coast->alignment.shaft_angle_out_of_plane = 1e-4;
  coast->alignment.apex_offset[EO_PINION] = 9e-6;
  coast->alignment.coupling_thrust = 700;
}

static void test_coast(enum eo_axial axial, const char *name, double tolerance)
{
  struct eo_design drive = plain_design(axial), coast;
  char what[120];
  set_groove(&drive);
  mirror(&drive, &coast, ASTERN);
  struct eo_pair *pair = prepare(&drive);
  struct answer a = solve(pair, &drive), b = solve(pair, &coast);
  ok(a.flank == EO_DRIVE_FLANK && b.flank == EO_COAST_FLANK && (a.ahead - b.ahead) % POSITIONS == 0,
     "%s: astern the coast flanks carry, the right half %d and %d positions ahead", name, a.ahead, b.ahead);
  for (int end = 0; end < 2; end++) {
    snprintf(what, sizeof what, "%s: a mirrored design on its coast flanks is the drive, %s, m", name,
             end ? "right" : "left");
    close_to(worst(a.approach[end], b.approach[end]), 0, tolerance, what);
  }
  snprintf(what, sizeof what, "%s: and its transmission error, m", name);
  close_to(worst(a.transmission, b.transmission), 0, tolerance, what);
  mirror(&drive, &coast, OVERRUN);
  struct answer d = solve(pair, &coast);
  ok(d.flank == EO_COAST_FLANK, "%s: so they do under a negative torque beside a positive one", name);
  snprintf(what, sizeof what, "%s: with the same approaches, m", name);
  close_to(worst(a.approach[0], d.approach[0]) + worst(a.approach[1], d.approach[1]), 0, 2 * tolerance, what);
  coast.alignment.coupling_thrust = -700;
  struct answer c = solve(pair, &coast);
  double moved = worst(b.approach[0], c.approach[0]);
  ok(axial == EO_AXIAL_FIXED ? moved == 0 : moved > 1e-8, "%s: a thrust the other way round moves the ends by %.3g um",
     name, 1e6 * moved);
  eo_pair_free(pair);
}

/* Of any groove: the ends of a floating pinion do not depend on each other. */
static void test_floating_coast(void)
{
  struct eo_design drive = plain_design(EO_AXIAL_FLOATING), coast;
  mirror(&drive, &coast, ASTERN);
  struct eo_pair *pair = prepare(&drive);
  struct answer a = solve(pair, &drive), b = solve(pair, &coast);
  ok((a.ahead - b.ahead) % POSITIONS != 0, "a groove of 30 mm puts the right half %d and %d positions ahead", a.ahead,
     b.ahead);
  for (int end = 0; end < 2; end++)
    close_to(worst(a.approach[end], b.approach[end]), 0, ROUNDING,
             "approach of each floating end against that of the mirrored drive, m");
  eo_pair_free(pair);
}

/* P_R sin L_R - P_L sin L_L + F + k x, which nothing else takes, and what is missing of the torque; x: axial, from what
   the ends approach, + where the right end gives way. */
static void find_balance(const struct eo_pair *pair, const struct answer *answer, double thrust, double stiffness,
                         double *axial, double *torque)
{
  double l = pair->geometry.base_helix_angle, r = pair->right->geometry.base_helix_angle;
  *axial = *torque = 0;
  for (int j = 0; j < POSITIONS; j++) {
    int at = beside(answer, j);
    double left = answer->load[0][j], right = answer->load[1][at];
    double x = (answer->approach[1][at] / cos(r) - answer->approach[0][j] / cos(l)) / (tan(l) + tan(r));
    *axial = fmax(*axial, fabs(right * sin(r) - left * sin(l) + thrust + stiffness * x));
    *torque = fmax(*torque, fabs((left * cos(l) + right * cos(r)) * pair->geometry.base_radius[0] - 450));
  }
}

static void test_balance(enum eo_axial axial, const char *name)
{
  char what[120];
  for (int coast = 0; coast < 2; coast++) {
    struct eo_design design = plain_design(axial), other;
    mirror(&design, &other, ASTERN);
    design = coast ? other : design;
    design.alignment.apex_offset[EO_PINION] = 0;
    struct eo_pair *pair = prepare(&design);
    struct answer answer = solve(pair, &design);
    double missing[2];
    /* + presses on the left end of drive flanks; the axial forces of coast flanks point the other way */
    double thrust = coast ? -design.alignment.coupling_thrust : design.alignment.coupling_thrust;
    find_balance(pair, &answer, thrust, axial == EO_AXIAL_SPRING ? SPRING : 0, &missing[0], &missing[1]);
    snprintf(what, sizeof what, "%s, %s: thrusts of both ends, the coupling's and the spring's, N", name,
             coast ? "coast" : "drive");
    close_to(missing[0], 0, 1e-2, what);
    snprintf(what, sizeof what, "%s, %s: the torque, N m", name, coast ? "coast" : "drive");
    close_to(missing[1], 0, 1e-8, what);
    eo_pair_free(pair);
  }
}

/* Held fast, the support takes the thrust: both ends turn alike with any. */
static void test_held(void)
{
  struct eo_design design = plain_design(EO_AXIAL_FIXED);
  for (int end = 0; end < 2; end++)
    design.modification.flank[EO_PINION][end] = odd_flank(end, false);
  struct eo_pair *pair = prepare(&design);
  struct answer a = solve(pair, &design);
  design.alignment.coupling_thrust = 5000;
  struct answer b = solve(pair, &design);
  double apart = 0, l = pair->geometry.base_helix_angle, r = pair->right->geometry.base_helix_angle;
  for (int j = 0; j < POSITIONS; j++)
    apart = fmax(apart, fabs(a.approach[0][j] / cos(l) - a.approach[1][beside(&a, j)] / cos(r)));
  close_to(apart, 0, 1e-10, "difference between both ends of a held pinion, m");
  close_to(worst(a.approach[0], b.approach[0]) + worst(a.approach[1], b.approach[1]), 0, 0,
           "effect of a thrust of 5000 N on a held pinion, m");
  eo_pair_free(pair);
}

/* The stiffer the spring the less of the thrust comes to the teeth. */
static void test_between(void)
{
  static const double stiffness[] = {1e2, 1e8, 1e15};
  double shift[3];
  struct eo_design design = plain_design(EO_AXIAL_SPRING);
  struct eo_pair *pair = prepare(&design);
  for (int i = 0; i < 3; i++) {
    design.alignment.pinion_axial_stiffness = stiffness[i];
    design.alignment.coupling_thrust = 0;
    struct answer without = solve(pair, &design);
    design.alignment.coupling_thrust = 900;
    struct answer with = solve(pair, &design);
    double l = pair->geometry.base_helix_angle, r = pair->right->geometry.base_helix_angle;
    shift[i] = 0;
    for (int j = 0; j < POSITIONS; j++)
      shift[i] += ((with.load[0][j] - without.load[0][j]) * sin(l) - (with.load[1][j] - without.load[1][j]) * sin(r)) /
                  POSITIONS;
  }
  close_to(shift[0], 900, 1e-2, "load that a spring of 100 N/m leaves to the teeth, of 900 N");
  ok(shift[1] > 50 && shift[1] < 850, "a spring of 100 N/um leaves a part to the teeth: %.4g N", shift[1]);
  close_to(shift[2], 0, 1e-2, "load that a spring of 1e15 N/m leaves to the teeth, N");
  eo_pair_free(pair);
}

/* The table of one flank in an export of all. */
static json_t *find_table(const char *text, int member, int end)
{
  struct eo_error error;
  char heading[60];
  snprintf(heading, sizeof heading, "# %s, %s, drive flank\n", member ? "gear" : "pinion", end ? "right" : "left");
  const char *at = strstr(text, heading);
  const char *next = at ? strstr(at + 1, "#") : NULL;
  char *own = at ? strndup(at, next ? (size_t)(next - at) : strlen(at)) : NULL;
  json_t *table = own ? eo_flank_grid_from_text(own, &error) : NULL;
  free(own);
  return table;
}

/* Flanks without a kink, exported as tables and read as grids, are the same flanks. */
static void test_sampled(void)
{
  static struct eo_faults faults;
  struct eo_design named = plain_design(EO_AXIAL_FLOATING), sampled = named;
  struct eo_text text = {0};
  struct eo_geometry geometry;
  struct eo_error error;
  const struct eo_flank_modification flank = {
      .twist = 12e-6, .profile_slope = 5e-6, .helix_slope = -7e-6, .profile_barrel = 6e-6, .lead_crowning = 8e-6};
  for (int end = 0; end < 2; end++) {
    named.modification.flank[EO_PINION][end] = flank;
    named.modification.flank[EO_GEAR][end].profile_barrel = 4e-6;
    named.modification.flank[EO_GEAR][end].helix_slope = 3e-6;
  }
  named.load_case[0].torque = sampled.load_case[0].torque = 1500; /* enough for tip edges */
  struct eo_pair *pair = prepare(&named);
  if (eo_design_complete(&named, &geometry, &error) ||
      eo_export_write(eo_export_find("flank-grids"), &named, &geometry, 25, 31, &text, &error))
    stop(&error);
  json_t *modification = json_object();
  for (int k = 0; k < 4; k++) {
    const char *member = k / 2 ? "gear" : "pinion", *end = k % 2 ? "right" : "left";
    if (!json_object_get(modification, member))
      json_object_set_new(modification, member, json_object());
    json_object_set_new(json_object_get(modification, member), end,
                        json_pack("{s:o}", "grid", find_table(text.data, k / 2, k % 2)));
  }
  eo_flank_grids_decode(modification, 2, &sampled.grids, &faults);
  json_decref(modification);
  eo_text_done(&text);
  struct answer a = solve(pair, &named), b = solve(pair, &sampled);
  close_to(1e9 * worst(a.approach[0], b.approach[0]), 0, 2,
           "left flanks exported and read as grids against the pair, nm");
  close_to(1e9 * worst(a.approach[1], b.approach[1]), 0, 2,
           "right flanks exported and read as grids against the pair, nm");
  close_to(1e9 * worst(a.transmission, b.transmission), 0, 2,
           "transmission error of flanks exported and read as grids, nm");
  eo_pair_free(pair);
}

static void test_too_much(void)
{
  struct eo_design design = plain_design(EO_AXIAL_FLOATING);
  struct eo_pair *pair = prepare(&design);
  struct eo_evaluator *evaluator = NULL;
  const struct eo_evaluation *result;
  struct eo_geometry geometry;
  struct eo_error error = {0};
  double l = pair->geometry.base_helix_angle, r = pair->right->geometry.base_helix_angle;
  double tangential = 450 / pair->geometry.base_radius[0];
  const double most[2] = {tangential * tan(l), -tangential * tan(r)}; /* one end carries all */
  if (eo_evaluator_new(&evaluator, pair, 1, &error))
    stop(&error);
  for (int i = 0; i < 2; i++)
    for (int more = 0; more < 2; more++) {
      design.alignment.coupling_thrust = most[i] * (more ? 1.001 : 0.999);
      enum eo_code code = eo_design_complete(&design, &geometry, &error);
      if (!code)
        code = eo_evaluator_contact(evaluator, &design, &result, &error);
      ok(more ? code == EO_ERROR_INPUT && strcmp(error.pointer, "/alignment/coupling_thrust_N") == 0 : !code,
         "a thrust of %.6g N beside a most of %.6g N is judged: %s", design.alignment.coupling_thrust, most[i],
         code ? error.text : "");
    }
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
}

int main(void)
{
  test_coast(EO_AXIAL_FLOATING, "floating", ROUNDING);
  test_coast(EO_AXIAL_SPRING, "sprung", SPRUNG);
  test_coast(EO_AXIAL_FIXED, "held", SPRUNG);
  test_coast(EO_AXIAL_STOPS, "between stops", SPRUNG);
  test_floating_coast();
  test_balance(EO_AXIAL_FLOATING, "floating");
  test_balance(EO_AXIAL_SPRING, "sprung");
  test_held();
  test_between();
  test_sampled();
  test_too_much();
  return tap_done();
}
