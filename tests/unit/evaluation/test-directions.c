/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flanks, directions and alignments of load cases: symmetries that hold exactly, whatever the flanks are, and what apex
   offsets, stops and thrusts do to a floating pinion. Closed-form compliance, few positions. */
#include "document/design_document.h"
#include "document/examples.h"
#include "evaluation/evaluator.h"
#include "support/synthetic-pair.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

enum { POSITIONS = 12 };

static struct eo_pair *pair;
static struct eo_evaluator *evaluator;

/* Aligned, unmodified, one load case. */
static struct eo_design plain_design(void)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error;
  eo_example_build("paper", &design);
  design.alignment.shaft_angle_in_plane = 0;
  design.resolution.positions = POSITIONS;
  design.resolution.te_harmonics = 5;
  design.resolution.cells_per_line = 12;
  design.load_cases = 1;
  design.load_case[0].torque = 828;
  design.load_case[0].share = 1;
  if (eo_design_complete(&design, &geometry, &error))
    stop(&error);
  return design;
}

/* Flanks without any symmetry, on both members and ends. */
static struct eo_flank_modification odd_flank(int k)
{
  struct eo_flank_modification f = {.tip_relief = 10e-6 + k * 1e-6,
                                    .tip_relief_start = 1.8e-3,
                                    .root_relief = 8e-6,
                                    .root_relief_start = 2.5e-3 + k * 0.1e-3,
                                    .lead_crowning = 5e-6,
                                    .helix_slope = (k - 1.5) * 3e-6,
                                    .twist = (2 - k) * 6e-6,
                                    .profile_slope = k * 1e-6,
                                    .end_relief = {0, 6e-6},
                                    .end_relief_length = {0, 9e-3}};
  f.triangular[EO_TIP_SIDE][EO_LEADING_SIDE] = (struct eo_triangular_relief){8e-6, 3e-3, 12e-3, 2};
  return f;
}

/* delta(u, -y). */
static struct eo_flank_modification turned_over(struct eo_flank_modification f)
{
  struct eo_flank_modification t = f;
  t.helix_slope = -f.helix_slope;
  t.twist = -f.twist;
  for (int i = 0; i < 2; i++) {
    t.end_relief[i] = f.end_relief[1 - i];
    t.end_relief_length[i] = f.end_relief_length[1 - i];
    for (int side = 0; side < 2; side++)
      t.triangular[side][i] = f.triangular[side][1 - i];
  }
  return t;
}

static const double knot_u[5] = {-5.6e-3, -3e-3, 0, 2e-3, 5.6e-3}, knot_y[4] = {-26e-3, -9e-3, 8e-3, 25e-3};

/* A grid with a number for each knot; over: columns from last to first. */
static void put_grid(struct eo_design *design, enum eo_flank_side side, int member, int end, bool over)
{
  double y[4], delta[20];
  struct eo_error error;
  for (int j = 0; j < 4; j++)
    y[j] = over ? -knot_y[3 - j] : knot_y[j];
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 4; j++) {
      int from = over ? 3 - j : j;
      delta[i * 4 + j] = 1e-6 * (((3 * i + 7 * from + 5 * member + 2 * end) % 11) - 5) / 3;
    }
  struct eo_flank_grid grid = {.u_knots = 5, .y_knots = 4, .u = knot_u, .y = y, .delta = delta};
  if (eo_flank_grids_put(&design->grids, side, member, end, &grid, &error))
    stop(&error);
}

/* Drive flanks without symmetry. */
static struct eo_design odd_design(void)
{
  struct eo_design design = plain_design();
  for (int k = 0; k < 4; k++)
    design.modification.flank[k / 2][k % 2] = odd_flank(k);
  put_grid(&design, EO_DRIVE_FLANK, EO_PINION, EO_LEFT, false);
  put_grid(&design, EO_DRIVE_FLANK, EO_GEAR, EO_RIGHT, false);
  return design;
}

struct answer {
  double approach[2][POSITIONS], load[2][POSITIONS], transmission[POSITIONS], swing, mean;
  struct eo_impact impact[2];
  struct eo_running running;
  bool at_stop;
};

static struct answer solve_case(struct eo_design *design, int k)
{
  const struct eo_evaluation *r = NULL;
  struct eo_geometry geometry;
  struct eo_error error;
  struct answer a;
  if (eo_design_complete(design, &geometry, &error) || eo_evaluator_contact(evaluator, design, &r, &error))
    stop(&error);
  const struct eo_case_result *c = &r->load_case[k];
  for (int end = 0; end < 2; end++) {
    memcpy(a.approach[end], c->end[end].loaded.approach, sizeof a.approach[end]);
    memcpy(a.load[end], c->end[end].loaded.load, sizeof a.load[end]);
    a.impact[end] = c->end[end].impact;
  }
  memcpy(a.transmission, c->transmission, sizeof a.transmission);
  a.swing = c->peak_to_peak;
  a.mean = c->mean;
  a.running = c->running;
  a.at_stop = c->at_stop;
  return a;
}

static struct answer solve(struct eo_design *design)
{
  return solve_case(design, 0);
}

/* Largest difference of the approaches of end i of a and end j of b, m. */
static double apart(const struct answer *a, int i, const struct answer *b, int j)
{
  double most = 0;
  for (int k = 0; k < POSITIONS; k++)
    most = fmax(most, fabs(a->approach[i][k] - b->approach[j][k]));
  return most;
}

static const double ROUNDING = 1e-13; /* m, of approaches near 1e-5 m solved to a thousandth of a nanometre */

/* coast(delta(u, y), kappa, gamma, e) = drive(delta(u, -y), -kappa, gamma, -e), hand by hand. */
static void test_coast(void)
{
  static struct eo_design drive, coast;
  drive = odd_design();
  coast = plain_design();
  for (int k = 0; k < 4; k++)
    coast.modification.coast[k / 2][k % 2] = turned_over(odd_flank(k));
  put_grid(&coast, EO_COAST_FLANK, EO_PINION, EO_LEFT, true);
  put_grid(&coast, EO_COAST_FLANK, EO_GEAR, EO_RIGHT, true);
  drive.alignment.shaft_angle_in_plane = -3e-4;
  drive.alignment.shaft_angle_out_of_plane = 1e-4;
  drive.alignment.apex_offset[EO_PINION] = -12e-6;
  coast.alignment.shaft_angle_in_plane = 3e-4;
  coast.alignment.shaft_angle_out_of_plane = 1e-4;
  coast.alignment.apex_offset[EO_PINION] = 12e-6;
  coast.load_case[0].direction = EO_ASTERN;
  struct answer a = solve(&drive), b = solve(&coast);
  ok(a.running.flank == EO_DRIVE_FLANK && b.running.flank == EO_COAST_FLANK, "astern the coast flanks carry");
  close_to(apart(&a, 0, &b, 0), 0, ROUNDING,
           "left end of a mirrored design on the coast flank against the drive flank");
  close_to(apart(&a, 1, &b, 1), 0, ROUNDING,
           "right end of a mirrored design on the coast flank against the drive flank");
  close_to(a.impact[0].force, b.impact[0].force, 1e-6 * a.impact[0].force,
           "entering impact of a mirrored design on the coast flank");
  coast.modification.coast[EO_PINION][EO_LEFT].helix_slope += 5e-6;
  struct answer c = solve(&coast);
  ok(apart(&b, 0, &c, 0) > 1e-7, "the coast flank's own modification counts");
  coast.modification.flank[EO_PINION][EO_LEFT].tip_relief = 30e-6;
  coast.modification.flank[EO_PINION][EO_LEFT].tip_relief_start = 1e-3;
  struct answer d = solve(&coast);
  close_to(apart(&c, 0, &d, 0), 0, 0, "effect of the drive flank's modification on the coast flank");
}

static void test_leading_apex(void)
{
  static struct eo_design drive, coast, leading;
  drive = plain_design();
  coast = drive;
  leading = drive;
  for (int end = 0; end < 2; end++) {
    struct eo_flank_modification f = {.tip_relief = 12e-6, .tip_relief_start = 1.6e-3, .lead_crowning = 8e-6};
    drive.modification.flank[EO_PINION][end] = coast.modification.coast[EO_PINION][end] = f;
    leading.modification.flank[EO_PINION][end] = leading.modification.coast[EO_PINION][end] = f;
  }
  coast.load_case[0].direction = EO_ASTERN;
  struct answer a = solve(&drive), b = solve(&coast);
  close_to(apart(&a, 0, &b, 0), 0, ROUNDING, "aligned coast flanks like symmetric drive flanks against these");
  drive.shafts.enabled = coast.shafts.enabled = leading.shafts.enabled = true;
  leading.alignment.apex = EO_APEX_LEADING;
  leading.load_case[0].direction = EO_ASTERN;
  a = solve(&drive);
  b = solve(&coast);
  struct answer c = solve(&leading);
  ok(apart(&a, 0, &b, 0) > 1e-8, "on elastic shafts the reversed drive is another result, by %.3g um",
     1e6 * apart(&a, 0, &b, 0));
  close_to(apart(&a, 0, &c, 0), 0, ROUNDING, "reversed drive under a leading apex against the first");
}

static void test_driver(void)
{
  static struct eo_design design, gear, both;
  design = odd_design();
  gear = design;
  both = design;
  gear.load_case[0].driver = EO_GEAR;
  struct answer a = solve(&design), b = solve(&gear);
  ok(b.running.flank == EO_DRIVE_FLANK && b.running.backwards, "a speed increaser runs backwards on its drive flanks");
  close_to(apart(&a, 0, &b, 0) + apart(&a, 1, &b, 1), 0, 0, "approaches of a speed increaser at the same places");
  ok(a.impact[0].touched && b.impact[0].touched && b.impact[0].phase > a.impact[0].phase,
     "contact of a speed increaser enters at the pinion's tip: c %.4g, not %.4g mm", 1e3 * b.impact[0].phase,
     1e3 * a.impact[0].phase);
  both.load_cases = 2;
  both.load_case[1] = both.load_case[0];
  both.load_case[0].share = both.load_case[1].share = 0.5;
  both.load_case[1].driver = EO_GEAR;
  struct answer overrun = solve_case(&both, 1);
  ok(overrun.running.flank == EO_COAST_FLANK && overrun.running.backwards,
     "a gear that drives beside load cases in which the pinion does runs on the coast flanks");
}

/* The periodic state of a backwards run is that of the reversed curves: mesh orders have the same size. */
static void test_backwards_vibration(void)
{
  static struct eo_design design;
  design = odd_design();
  struct eo_geometry geometry;
  struct eo_error error;
  const struct eo_evaluation *r;
  double rms[2];
  for (int driver = 0; driver < 2; driver++) {
    design.load_case[0].driver = driver;
    if (eo_design_complete(&design, &geometry, &error) || eo_evaluator_run(evaluator, &design, NULL, 0, &r, &error))
      stop(&error);
    rms[driver] = r->load_case[0].vibration.rms_pair[EO_READING_NORMAL];
  }
  ok(rms[0] > 0 && rms[1] > 0 && fabs(rms[1] / rms[0] - 1) < 0.2,
     "the pair vibrates alike both ways, with %.4g forwards and %.4g m/s2 backwards", rms[0], rms[1]);
}

/* Left and right exchanged: flanks change places, both shaft angle errors their sign. */
static void test_exchange(void)
{
  static struct eo_design one, other;
  one = odd_design();
  other = plain_design();
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < 2; end++)
      other.modification.flank[member][end] = one.modification.flank[member][1 - end];
  memset(&one.grids, 0, sizeof one.grids);
  one.alignment.shaft_angle_in_plane = 4e-4;
  one.alignment.shaft_angle_out_of_plane = -2e-4;
  other.alignment.shaft_angle_in_plane = -4e-4;
  other.alignment.shaft_angle_out_of_plane = 2e-4;
  struct answer a = solve(&one), b = solve(&other);
  close_to(apart(&a, 0, &b, 1) + apart(&a, 1, &b, 0), 0, ROUNDING, "left and right under exchanged settings");
}

static double swing_of(const struct answer *a)
{
  return a->swing;
}

static void test_apex(void)
{
  static struct eo_design design, offset;
  design = odd_design();
  offset = design;
  double bb = pair->geometry.base_helix_angle, lean = sin(bb), e = 20e-6;
  offset.alignment.apex_offset[EO_PINION] = e;
  struct answer a = solve(&design), b = solve(&offset);
  close_to(swing_of(&b), swing_of(&a), ROUNDING, "change of a floating pinion's PPLTE by an apex offset");
  close_to(b.mean - a.mean, tan(bb) * e / 2, ROUNDING,
           "change of the mean transmission error by an apex offset, tan(beta_b) e/2");
  double moved = (b.approach[0][0] - b.approach[1][0] - a.approach[0][0] + a.approach[1][0]) / (2 * lean);
  close_to(moved, -e / 2, ROUNDING, "change of the pinion's place by an apex offset, -e/2");
  offset.alignment.apex_offset[EO_GEAR] = e;
  struct answer c = solve(&offset);
  close_to(apart(&a, 1, &c, 1), 0, 0, "effect of equal offsets of both members");
}

static void test_stops(void)
{
  static struct eo_design floating;
  floating = odd_design();
  floating.alignment.apex_offset[EO_PINION] = 60e-6;
  static struct eo_design wide, tight, spring, narrow;
  wide = floating;
  tight = floating;
  spring = floating;
  narrow = floating;
  wide.alignment.pinion_axial = tight.alignment.pinion_axial = narrow.alignment.pinion_axial = EO_AXIAL_STOPS;
  spring.alignment.pinion_axial = EO_AXIAL_SPRING;
  wide.alignment.pinion_axial_clearance = 1e-3;
  narrow.alignment.pinion_axial_clearance = 20e-6;
  tight.alignment.pinion_axial_clearance = 0;
  struct answer a = solve(&floating), b = solve(&wide), c = solve(&spring), d = solve(&tight), e = solve(&narrow);
  close_to(apart(&a, 0, &b, 0) + apart(&a, 1, &b, 1), 0, 1e-11, "pinion between wide stops against a floating one");
  close_to(apart(&c, 0, &d, 0) + apart(&c, 1, &d, 1), 0, 1e-11,
           "pinion between stops without play against one on their spring");
  ok(!b.at_stop && e.at_stop && e.load[0][0] > a.load[0][0] + 1 && e.load[0][0] < c.load[0][0] - 1,
     "at a stop it carries some of what the spring would: %.0f N, floating %.0f, held %.0f", e.load[0][0], a.load[0][0],
     c.load[0][0]);
}

static void test_thrust(void)
{
  static struct eo_design design;
  design = odd_design();
  double lean = sin(pair->geometry.base_helix_angle);
  design.alignment.coupling_thrust = 1000;
  struct answer a = solve(&design);
  close_to(lean * (a.load[1][0] - a.load[0][0]), -1000, 1e-6,
           "load of the left end, on which a thrust to the right presses");
  design.alignment.apex = EO_APEX_LEADING;
  struct answer b = solve(&design);
  close_to(lean * (b.load[1][0] - b.load[0][0]), 1000, 1e-6,
           "load of the right end, on which it presses with the apex leading");
  struct eo_error error;
  const struct eo_evaluation *r;
  design.alignment.coupling_thrust = 1e5;
  ok(eo_evaluator_contact(evaluator, &design, &r, &error) == EO_ERROR_INPUT &&
         strcmp(error.pointer, "/alignment/coupling_thrust_N") == 0,
     "a thrust that unloads an end is refused: %s", error.text);
}

/* A grid sampled from flanks by name. */
static void test_sampled_grid(void)
{
  enum { U = 25, Y = 31 };
  static struct eo_design named, sampled;
  named = plain_design();
  sampled = named;
  struct eo_flank_modification f = {
      .twist = 12e-6, .profile_slope = 5e-6, .helix_slope = -7e-6, .profile_barrel = 6e-6, .lead_crowning = 8e-6};
  struct eo_modification_shape shape;
  double u[U], y[Y], delta[U * Y], end[2];
  struct eo_error error;
  named.modification.flank[EO_PINION][EO_LEFT] = f;
  eo_modification_init(&shape, &pair->geometry, EO_PINION, &f);
  eo_active_profile(&pair->geometry, EO_PINION, end);
  for (int i = 0; i < U; i++) /* somewhat beyond the active profile, where slices may touch */
    u[i] = end[0] - 0.2e-3 + (end[1] - end[0] + 0.4e-3) * i / (U - 1);
  for (int j = 0; j < Y; j++)
    y[j] = pair->geometry.face_width * ((double)j / (Y - 1) - 0.5);
  for (int i = 0; i < U; i++)
    for (int j = 0; j < Y; j++)
      delta[i * Y + j] = eo_modification_at(&shape, u[i], y[j]);
  struct eo_flank_grid grid = {.u_knots = U, .y_knots = Y, .u = u, .y = y, .delta = delta};
  if (eo_flank_grids_put(&sampled.grids, EO_DRIVE_FLANK, EO_PINION, EO_LEFT, &grid, &error))
    stop(&error);
  struct answer a = solve(&named), b = solve(&sampled);
  close_to(1e9 * apart(&a, 0, &b, 0), 0, 2, "grid sampled from a flank by name against this flank, nm");
}

static void test_own_alignment(void)
{
  static struct eo_design design, other;
  design = odd_design();
  other = design;
  design.load_cases = 2;
  design.load_case[1] = design.load_case[0];
  design.load_case[0].share = design.load_case[1].share = 0.5;
  design.load_case[1].has_alignment = 1;
  design.load_case[1].alignment = (struct eo_case_alignment){NAN, NAN, 27e-6, NAN};
  other.alignment.deviation_in_plane = 27e-6;
  struct answer first = solve_case(&design, 0), own = solve_case(&design, 1), alone = solve(&other);
  near(own.running.in_plane, atan(27e-6 / 55e-3), 1e-9, "slope of 27 um over the face width of one end");
  close_to(apart(&own, 0, &alone, 0), 0, 0, "a load case's own alignment against a design that has it");
  ok(apart(&own, 0, &first, 0) > 1e-7 && first.running.in_plane == 0, "the other load case keeps the design's");
}

static struct eo_design turning(const struct eo_design *design, const char *hand, const char *rotation)
{
  static struct eo_design turned;
  turned = *design;
  struct eo_geometry geometry;
  struct eo_error error;
  snprintf(turned.gear_pair.hand, sizeof turned.gear_pair.hand, "%s", hand);
  snprintf(turned.alignment.pinion_rotation, sizeof turned.alignment.pinion_rotation, "%s", rotation);
  if (eo_design_complete(&turned, &geometry, &error))
    stop(&error);
  return turned;
}

/* Two of hand, rotation and apex say the third. */
static void test_hand_and_rotation(void)
{
  static const char *const hands[2] = {"left", "right"}, *const rotations[2] = {"counterclockwise", "clockwise"};
  static struct eo_design design, turned, derived;
  design = plain_design();
  *design.gear_pair.hand = '\0';
  for (int hand = 0; hand < 2; hand++)
    for (int clockwise = 0; clockwise < 2; clockwise++) {
      turned = turning(&design, hands[hand], rotations[clockwise]);
      ok(turned.alignment.apex == (hand == clockwise ? EO_APEX_LEADING : EO_APEX_TRAILING) &&
             eo_design_rotation(&turned) == (clockwise ? 1 : -1) && !*turned.alignment.pinion_rotation,
         "a %s hand that turns %s has apex %d", hands[hand], rotations[clockwise], turned.alignment.apex);
      design.alignment.apex = turned.alignment.apex;
      derived = turning(&design, "", rotations[clockwise]);
      ok(strcmp(derived.gear_pair.hand, hands[hand]) == 0, "apex and rotation ask for a %s hand", hands[hand]);
      design.alignment.apex = EO_APEX_TRAILING;
    }
  turned = turning(&design, "", "");
  ok(strcmp(turned.gear_pair.hand, "right") == 0 && eo_design_rotation(&turned) == -1,
     "a pair of which nothing is stated is right-handed and turns counterclockwise");
}

/* One end on shafts without symmetry: the pinion of the other hand that turns the other way is the mirror image in the
   plane of the axes, the one that turns the same way that in a plane across them. */
static void test_mirror(void)
{
  static struct eo_design design, mirrored;
  struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}, .own_pivots = true};
  struct eo_pair *two = pair, *single = NULL;
  struct eo_evaluator *of_two = evaluator;
  struct eo_error error;
  design = plain_design();
  design.gear_pair.ends = 1;
  *design.gear_pair.hand = '\0';
  design.modification.flank[EO_PINION][EO_LEFT] = odd_flank(1);
  design.alignment.pinion_axial = EO_AXIAL_FIXED;
  design.alignment.shaft_angle_in_plane = 2e-4;
  design.alignment.shaft_angle_out_of_plane = -1e-4;
  design.shafts.enabled = true;
  for (int i = 0; i < 2; i++) {
    design.shafts.bearing_position[i][EO_LEFT] = -0.06;
    design.shafts.bearing_position[i][EO_RIGHT] = 0.11;
    design.shafts.drive_side[i] = EO_DRIVE_LEFT;
  }
  design = turning(&design, "right", "counterclockwise");
  if (eo_pair_new(&single, &design, &options, NULL, &error) || eo_evaluator_new(&evaluator, single, 1, &error))
    stop(&error);
  pair = single;
  struct answer a = solve(&design);
  mirrored = turning(&design, "left", "clockwise");
  struct answer b = solve(&mirrored);
  close_to(apart(&a, 0, &b, 0), 0, 0, "the other hand turning the other way against the pair");
  mirrored = turning(&design, "left", "counterclockwise");
  struct answer c = solve(&mirrored);
  ok(apart(&a, 0, &c, 0) > 1e-8, "the other hand turning the same way gives another result, by %.3g um",
     1e6 * apart(&a, 0, &c, 0));
  mirrored.alignment.shaft_angle_in_plane *= -1;
  mirrored.alignment.shaft_angle_out_of_plane *= -1;
  for (int i = 0; i < 2; i++) {
    mirrored.shafts.bearing_position[i][EO_LEFT] = -0.11;
    mirrored.shafts.bearing_position[i][EO_RIGHT] = 0.06;
    mirrored.shafts.drive_side[i] = EO_DRIVE_RIGHT;
  }
  struct answer d = solve(&mirrored);
  close_to(apart(&a, 0, &d, 0), 0, ROUNDING, "the other hand with shafts and errors mirrored too against the pair");
  eo_evaluator_free(evaluator);
  eo_pair_free(single);
  pair = two;
  evaluator = of_two;
}

int main(void)
{
  static struct eo_design design;
  design = plain_design();
  struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}, .own_pivots = true};
  struct eo_error error;
  if (eo_pair_new(&pair, &design, &options, NULL, &error) || eo_evaluator_new(&evaluator, pair, 2, &error))
    stop(&error);
  test_coast();
  test_leading_apex();
  test_driver();
  test_backwards_vibration();
  test_exchange();
  test_apex();
  test_stops();
  test_thrust();
  test_sampled_grid();
  test_own_alignment();
  test_hand_and_rotation();
  test_mirror();
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  return tap_done();
}
