/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Halves of unequal helix as one pair: the transverse section they share, shares that balance the thrusts, what each
   half is beside a pair of two like it, symmetry, the limit of equal helices, and a held pinion at rest and in motion.
   Closed-form compliance. */
#include "design/resolution.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "dynamics/model.h"
#include "evaluation/evaluator.h"
#include "exchange/tooth.h"
#include "flexibility/closed_form.h"
#include "gear/fillet.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

enum { POSITIONS = 32 };
static struct eo_closed_form form = {1.5e-9, 12e-3, -0.8e-3, 20, 4000};
static const double degree = M_PI / 180;

static void stop(const struct eo_error *error)
{
  printf("Bail out! %s: %s\n", error->pointer, error->text);
  exit(1);
}

/* The paper's pair, aligned, unmodified but for a crowning; right: helix of the right half, deg. */
static struct eo_design design_of(double right)
{
  struct eo_design design;
  eo_example_build("paper", &design);
  design.gear_pair.right_helix_angle = right * degree;
  design.alignment.shaft_angle_in_plane = 0;
  design.load_cases = 1;
  design.load_case[0].share = 1;
  for (int end = 0; end < 2; end++)
    design.modification.flank[EO_PINION][end].lead_crowning = 8e-6;
  design.resolution.positions = POSITIONS;
  design.resolution.te_harmonics = 0;
  design.resolution.cells_per_line = 20;
  return design;
}

/* A pair whose halves are both like one of another; what is derived there is stated here. */
static struct eo_design half_of(const struct eo_design *resolved, int end)
{
  struct eo_design design = design_of(NAN);
  design.gear_pair = eo_gear_pair_half(&resolved->gear_pair, end);
  return design;
}

static struct eo_pair *prepare(struct eo_design *design)
{
  struct eo_geometry geometry;
  struct eo_pair *pair = NULL;
  struct eo_error error = {0};
  if (eo_design_complete(design, &geometry, &error))
    stop(&error);
  const struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}};
  if (eo_pair_new(&pair, design, &options, NULL, &error))
    stop(&error);
  return pair;
}

static const struct eo_evaluation *evaluate(struct eo_pair *pair, const struct eo_design *design,
                                            struct eo_evaluator **evaluator)
{
  const struct eo_evaluation *evaluation = NULL;
  struct eo_error error = {0};
  if (eo_evaluator_new(evaluator, pair, design->load_cases, &error) ||
      eo_evaluator_run(*evaluator, design, NULL, EO_WANT_CURVES, &evaluation, &error))
    stop(&error);
  return evaluation;
}

static double mean(const double *value)
{
  double sum = 0;
  for (int j = 0; j < POSITIONS; j++)
    sum += value[j] / POSITIONS;
  return sum;
}

/* tan beta_b = tan beta cos alpha_t where the program has sin beta_b = sin beta cos alpha_n. */
static void test_section(void)
{
  struct eo_design design = design_of(28);
  struct eo_pair *pair = prepare(&design);
  const struct eo_geometry *left = &pair->geometry, *right = &pair->right->geometry;
  double alpha = atan(tan(20 * degree) / cos(24 * degree));
  near(tan(right->base_helix_angle), tan(28 * degree) * cos(alpha), 1e-14, "base helix of the right half");
  near(tan(left->base_helix_angle), tan(24 * degree) * cos(alpha), 1e-14, "base helix of the left half");
  near(right->normal_module, 6e-3 / cos(24 * degree) * cos(28 * degree), 1e-14, "normal module of the right half");
  near(right->transverse_pressure_angle, alpha, 1e-14, "transverse pressure angle of the right half, that of the left");
  for (int i = 0; i < 2; i++) {
    near(right->base_radius[i], left->base_radius[i], 1e-14, "base circle of the right half, that of the left");
    ok(right->tip_radius[i] == left->tip_radius[i], "both halves have one tip circle, to the last bit");
    near(right->root_radius[i], left->root_radius[i], 1e-14, "root circle of the right half, that of the left");
    near(eo_geometry_half_angle(right, i, right->working_radius[i]),
         eo_geometry_half_angle(left, i, left->working_radius[i]), 1e-13,
         "tooth thickness of the right half, that of the left");
  }
  near(right->transverse_contact_ratio, left->transverse_contact_ratio, 1e-12,
       "transverse contact ratio of the right half, that of the left");
  near(right->overlap_ratio, 55e-3 * tan(28 * degree) / (M_PI * right->transverse_module), 1e-13,
       "overlap ratio of the right half: b tan beta / (pi m_t)");
  double lead = pair->right->grid->position[0].phase - pair->grid->position[0].phase +
                pair->ahead[0] * left->transverse_base_pitch / POSITIONS;
  near(lead, 52.5e-3 * cos(alpha) * (tan(28 * degree) - tan(24 * degree)), 1e-12,
       "place where the helices meet in the middle of the groove, m of roll");
  eo_pair_free(pair);
}

/* Rigid, by hand: T = r_b (P_L cos L + P_R cos R), P_L sin L = P_R sin R. */
static void test_shares(void)
{
  struct eo_design design = design_of(28);
  struct eo_pair *pair = prepare(&design), *half[2];
  struct eo_evaluator *evaluator, *other[2];
  const struct eo_evaluation *e = evaluate(pair, &design, &evaluator);
  const struct eo_case_result *c = &e->load_case[0];
  double l = pair->geometry.base_helix_angle, r = pair->right->geometry.base_helix_angle,
         tangential = c->load_case.torque / pair->geometry.base_radius[0];
  const double *load[2] = {c->end[0].loaded.load, c->end[1].loaded.load};
  near(load[0][0], tangential * sin(r) / sin(l + r), 1e-12, "load of the flatter half, which carries more, N");
  near(load[1][0], tangential * sin(l) / sin(l + r), 1e-12, "load of the steeper half, which carries less, N");
  for (int end = 0; end < 2; end++) {
    struct eo_design alone = half_of(&design, end);
    double share = load[end][0] * cos(end ? r : l) / tangential;
    alone.load_case[0].torque *= 2 * share;
    half[end] = prepare(&alone);
    const struct eo_end_result *of = &evaluate(half[end], &alone, &other[end])->load_case[0].end[end],
                               *own = &c->end[end];
    near(of->loaded.load[0], load[end][0], 1e-12, "load of a half in a pair of two like it, N");
    near(mean(own->loaded.approach), mean(of->loaded.approach), 2e-4, "mean Z of a half in a pair of two like it, m");
    near(mean(own->stiffness), mean(of->stiffness), 2e-4, "mesh stiffness of a half in a pair of two like it, N/m");
    near(own->max_pressure, of->max_pressure, 0.02, "pressure of a half in a pair of two like it, Pa");
    near(own->impact.force, of->impact.force, 0.02, "entering impact of a half in a pair of two like it, N");
    near(half[end]->geometry.transverse_contact_ratio + half[end]->geometry.overlap_ratio,
         eo_pair_half(pair, end)->geometry.transverse_contact_ratio + eo_pair_half(pair, end)->geometry.overlap_ratio,
         1e-11, "contact ratio of a half in a pair of two like it");
  }
  double worst = 0;
  for (int j = 0; j < POSITIONS; j++) {
    int at = (j + pair->ahead[0] + 2 * POSITIONS) % POSITIONS;
    double z = (c->end[0].loaded.approach[j] * sin(r) + c->end[1].loaded.approach[at] * sin(l)) / sin(l + r);
    worst = fmax(worst, fabs(c->transmission[j] - z));
  }
  close_to(worst, 0, 1e-15, "rotation that no axial displacement is part of, m");
  const struct eo_vibration *v = &c->vibration;
  ok(v->outcome != EO_VIBRATION_NOT_CONVERGED && v->rms_pair[0] > 0,
     "the pair of unlike halves vibrates with %.3g m/s2", v->rms_pair[0]);
  for (int end = 0; end < 2; end++)
    near(v->force_mean[end], load[end][0], 1e-6, "mean mesh force of the vibration, N");
  for (int end = 0; end < 2; end++) {
    eo_evaluator_free(other[end]);
    eo_pair_free(half[end]);
  }
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
}

/* The same pair looked at from the other side. */
static void test_swapped(void)
{
  struct eo_design design = design_of(28);
  design.alignment.shaft_angle_in_plane = 0.03 * degree;
  struct eo_pair *pair = prepare(&design);
  struct eo_design turned = half_of(&design, EO_RIGHT);
  turned.gear_pair.right_helix_angle = 24 * degree;
  turned.alignment.shaft_angle_in_plane = -0.03 * degree;
  struct eo_pair *other = prepare(&turned);
  struct eo_evaluator *evaluator[2];
  const struct eo_case_result *a = &evaluate(pair, &design, &evaluator[0])->load_case[0],
                              *b = &evaluate(other, &turned, &evaluator[1])->load_case[0];
  near(other->right->geometry.normal_module, 6e-3, 1e-11,
       "the right half of the exchanged pair is the former left one");
  near(a->mean, b->mean, 1e-4, "mean LTE of the exchanged pair, m");
  near(a->peak_to_peak, b->peak_to_peak, 0.02, "PPLTE of the exchanged pair, m");
  for (int end = 0; end < 2; end++) {
    near(a->end_force[end], b->end_force[1 - end], 1e-12, "loads of the exchanged pair's ends, N");
    near(mean(a->end[end].loaded.approach), mean(b->end[1 - end].loaded.approach), 2e-4,
         "mean approaches of the exchanged pair's ends, m");
    near(a->end[end].impact.force, b->end[1 - end].impact.force, 0.02,
         "entering impacts of the exchanged pair's ends, N");
  }
  near(a->vibration.rms_pair[0], b->vibration.rms_pair[0], 0.03, "vibration of the exchanged pair, m/s2");
  for (int i = 0; i < 2; i++)
    eo_evaluator_free(evaluator[i]);
  eo_pair_free(pair);
  eo_pair_free(other);
}

/* A hundred millionth of a degree makes no difference, but ends that differ are coupled in torsion. */
static void test_limit(void)
{
  struct eo_design equal = design_of(NAN), nearly = design_of(24 + 1e-8);
  equal.supports.torsional_coupling = nearly.supports.torsional_coupling = EO_COUPLING_ON;
  equal.shafts.enabled = nearly.shafts.enabled = true;
  struct eo_pair *pair[2] = {prepare(&equal), prepare(&nearly)};
  struct eo_evaluator *evaluator[2];
  const struct eo_case_result *a = &evaluate(pair[0], &equal, &evaluator[0])->load_case[0],
                              *b = &evaluate(pair[1], &nearly, &evaluator[1])->load_case[0];
  ok(!pair[0]->right && pair[1]->right, "the one pair has one half and the other two");
  near(a->peak_to_peak, b->peak_to_peak, 1e-5, "PPLTE on elastic shafts, m");
  near(a->mean, b->mean, 1e-7, "mean LTE on elastic shafts, m");
  near(a->vibration.rms_pair[0], b->vibration.rms_pair[0], 1e-3, "vibration on elastic shafts, m/s2");
  for (int i = 0; i < 2; i++) {
    eo_evaluator_free(evaluator[i]);
    eo_pair_free(pair[i]);
  }
}

/* Held: rigidly, the ends turn alike; by springs and bearings that give, the contact at rest and the equations of
   motion share the torque alike. */
static void test_held(void)
{
  struct eo_design design = design_of(28);
  design.alignment.pinion_axial = EO_AXIAL_FIXED;
  design.supports.torsional_coupling = EO_COUPLING_ON;
  for (int i = 0; i < 2; i++) /* what is infinite would be derived */
    design.supports.bearing_stiffness[i] = design.supports.gear_axial_stiffness[i] =
        design.supports.groove_axial_stiffness[i] = design.supports.groove_torsional_stiffness[i] = 1e17;
  struct eo_pair *pair = prepare(&design);
  struct eo_evaluator *evaluator;
  const struct eo_case_result *c = &evaluate(pair, &design, &evaluator)->load_case[0];
  double l = pair->geometry.base_helix_angle, r = pair->right->geometry.base_helix_angle, worst = 0, torque = 0;
  for (int j = 0; j < POSITIONS; j++) {
    int at = (j + pair->ahead[0] + 2 * POSITIONS) % POSITIONS;
    const struct eo_loaded_end *left = &c->end[0].loaded, *right = &c->end[1].loaded;
    worst = fmax(worst, fabs(left->approach[j] / cos(l) - right->approach[at] / cos(r)));
    torque = fmax(torque, fabs((left->load[j] * cos(l) + right->load[at] * cos(r)) * pair->geometry.base_radius[0] -
                               c->load_case.torque));
  }
  close_to(worst, 0, 1e-10, "difference between both ends of a pair held fast, m");
  close_to(torque, 0, 1e-8, "torque that both ends of a pair held fast carry, N m");
  ok(mean(c->end[0].loaded.load) * sin(l) > 1.02 * mean(c->end[1].loaded.load) * sin(r) ||
         mean(c->end[0].loaded.load) * sin(l) < 0.98 * mean(c->end[1].loaded.load) * sin(r),
     "a pair held fast leaves a thrust on the support: %.5g and %.5g N", mean(c->end[0].loaded.load) * sin(l),
     mean(c->end[1].loaded.load) * sin(r));
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  design = design_of(28);
  design.alignment.pinion_axial = EO_AXIAL_SPRING;
  design.alignment.pinion_axial_stiffness = 3e8;
  design.resolution.mesh_law = EO_LAW_TABLE;
  pair = prepare(&design);
  c = &evaluate(pair, &design, &evaluator)->load_case[0];
  for (int end = 0; end < 2; end++)
    near(c->vibration.force_mean[end], mean(c->end[end].loaded.load), 1e-3,
         "force of a sprung pinion at rest and in motion, N");
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
}

/* By hand: bearings give by cos(beta_b) P/k, and twice that across for unlike loads; everything else is rigid. */
static void test_rest(void)
{
  double l = 0.3, r = 0.45, k[2] = {4e8, 9e8};
  struct eo_dynamics_parameters parameters = {.ends = 2,
                                              .base_radius = {0.05, 0.13},
                                              .base_helix_angle = l,
                                              .right_base_helix_angle = r,
                                              .mass = {5, 30},
                                              .inertia = {0.01, 0.4},
                                              .bearing_stiffness = {k[0], k[1]},
                                              .gear_axial_stiffness = {INFINITY, INFINITY},
                                              .groove_axial_stiffness = {1e15, 1e15},
                                              .groove_torsional_stiffness = {INFINITY, INFINITY},
                                              .pinion_axial_stiffness = 1e9};
  struct eo_dynamics_model model;
  struct eo_error error;
  if (eo_dynamics_model_init(&model, &parameters, &error))
    stop(&error);
  double left = 2 * sin(r) * cos(l) / sin(l + r), right = 2 * sin(l) * cos(r) / sin(l + r);
  near(eo_dynamics_model_axial_rest(&model), -cos(l) * cos(l) * (1 / k[0] + 1 / k[1]) * (left - right), 1e-7,
       "stiffness to which unlike bearing forces part the ends, m/N");
  parameters.pinion_axial_stiffness = 0;
  parameters.groove_torsional_stiffness[0] = parameters.groove_torsional_stiffness[1] = 0;
  parameters.gear_axial_stiffness[0] = parameters.gear_axial_stiffness[1] = 2e8;
  if (eo_dynamics_model_init(&model, &parameters, &error))
    stop(&error);
  eo_dynamics_model_load(&model, 1000, EO_IMPACT_NONE);
  ok(model.zero_modes == 3 && model.zero_mode_load < 1e-12,
     "a floating pair has %d rigid motions, and no work on them: %.1e", model.zero_modes, model.zero_mode_load);
  near(eo_dynamics_mesh_load(&parameters, 1000, 0) * sin(l), eo_dynamics_mesh_load(&parameters, 1000, 1) * sin(r),
       1e-14, "thrusts of a floating pair, in balance");
}

/* Angle of the drive flank at the pitch radius, carried on to the middle of the groove. */
static double angle_at_groove(const struct eo_design *design, const struct eo_geometry *geometry, int member, int end)
{
  struct eo_tooth tooth;
  struct eo_error error;
  double angle[2], z[2], u, v;
  if (eo_tooth_init(&tooth, design, geometry, member, end, &error))
    stop(&error);
  for (int i = 0; i < 2; i++) {
    struct eo_surface_point exact;
    double point[3];
    eo_surface_coordinates(tooth.geometry, member, 0, 1e-3 * (2 * i - 1), &u, &v);
    eo_surface_evaluate(tooth.geometry, member, &tooth.shape[0], u, v, &exact);
    eo_tooth_place(&tooth, false, &exact, point, NULL);
    angle[i] = atan2(point[0], point[1]);
    z[i] = point[2];
  }
  eo_tooth_done(&tooth);
  return angle[0] - z[0] * (angle[1] - angle[0]) / (z[1] - z[0]);
}

static void test_export(double right_helix, double right_width)
{
  struct eo_design design = design_of(right_helix);
  struct eo_geometry geometry;
  struct eo_error error = {0};
  design.gear_pair.right_face_width = right_width;
  for (int end = 0; end < 2; end++)
    design.modification.flank[EO_PINION][end].lead_crowning = 0;
  if (eo_design_complete(&design, &geometry, &error))
    stop(&error);
  for (int member = 0; member < 2; member++) {
    double pitch = 2 * M_PI / geometry.teeth[member];
    close_to(remainder(angle_at_groove(&design, &geometry, member, EO_LEFT) -
                           angle_at_groove(&design, &geometry, member, EO_RIGHT),
                       pitch),
             0, 1e-9, "exported flanks of both halves in the middle of the groove, rad");
  }
}

static void refuse(double left, double right, int ends, const char *pointer, const char *words)
{
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_error error = {0};
  eo_example_build(ends == 2 ? "paper" : "single", &design);
  design.gear_pair.helix_angle = left * degree;
  design.gear_pair.right_helix_angle = right * degree;
  ok(eo_design_complete(&design, &geometry, &error) && strcmp(error.pointer, pointer) == 0 && strstr(error.text, words),
     "helix angles of %g and %g deg are refused: %s", left, right, error.text);
}

static void test_refusals(void)
{
  struct eo_design design = design_of(24);
  struct eo_geometry geometry;
  struct eo_error error = {0};
  ok(!eo_design_complete(&design, &geometry, &error) && isnan(design.gear_pair.right_helix_angle),
     "a right helix like the left one is not written");
  refuse(12, 20, 1, "/gear_pair/right_helix_angle_deg", "one end");
  refuse(0, 20, 2, "/gear_pair/right_helix_angle_deg", "no thrust to balance");
}

int main(void)
{
  test_section();
  test_shares();
  test_swapped();
  test_limit();
  test_held();
  test_rest();
  test_export(28, NAN);
  test_export(NAN, 40e-3);
  test_refusals();
  return tap_done();
}
