/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_evaluation.h"

#include <math.h>
#include <stdlib.h>

#include "evaluation/evaluator.h"

enum { MOST_POSITIONS = 4096 };

struct stage {
  int positions;
  double z[2][MOST_POSITIONS], stiffness[2][MOST_POSITIONS]; /* [end], m, N/m */
  double datum[2];                                           /* m */
};

static void read_curves(struct eo_case *pair, double unit, int *positions, double curve[2][MOST_POSITIONS])
{
  if (pair && eo_case_size(pair) != 2)
    eo_case_fault(pair, "Two lists, [left, right], are expected here.");
  for (int end = 0; end < 2; end++) {
    int n = eo_case_numbers(eo_case_at(pair, end), *positions, MOST_POSITIONS, curve[end]);
    *positions = n > 0 ? n : *positions;
    for (int j = 0; j < n; j++)
      curve[end][j] *= unit;
  }
}

static void read_stage(struct eo_case *item, struct stage *this_stage)
{
  struct eo_case *stage = eo_case_find(item, "stage"), *ends = eo_case_find(item, "ends"),
                 *datum = ends ? eo_case_find(ends, "datum_Z_um") : NULL;
  this_stage->positions = -1;
  read_curves(eo_case_need(stage, "Z_um"), 1e-6, &this_stage->positions, this_stage->z);
  read_curves(eo_case_need(stage, "kt_N_um"), 1e6, &this_stage->positions, this_stage->stiffness);
  for (int end = 0; end < 2; end++)
    this_stage->datum[end] = datum ? 1e-6 * eo_case_element(datum, end) : 0;
}

/* The response under the tangent or the secant law of the arrays. */
static enum eo_code solve_stage(const struct eo_geometry *geometry, const struct stage *stage,
                                const struct eo_design *design, bool secant, struct eo_vibration_solver *solver,
                                struct eo_vibration *result, struct eo_error *error)
{
  struct eo_law law[2] = {{0}, {0}};
  const struct eo_load_case *load_case = &design->load_case[0];
  const double force = load_case->torque / (2 * geometry->base_radius[0] * cos(geometry->base_helix_angle)),
               back = -design->gear_pair.backlash;
  const int order = design->resolution.te_harmonics;
  const struct eo_vibration_case load = {.torque = load_case->torque,
                                         .speed = load_case->speed,
                                         .pinion_teeth = geometry->teeth[0],
                                         .law = {&law[0], &law[1]},
                                         .phase_right = -design->alignment.stagger,
                                         .gated = true};
  enum eo_code code = EO_OK;
  for (int end = 0; end < 2 && !code; end++)
    code = secant ? eo_law_set_secant(&law[end], stage->positions, stage->z[end], force, stage->datum[end], order, back,
                                      error)
                  : eo_law_set_tangent(&law[end], stage->positions, stage->z[end], stage->stiffness[end], force, order,
                                       back, error);
  if (!code)
    code = eo_vibration_solve(solver, &load, EO_START_COLD, result, error);
  eo_law_done(&law[0]);
  eo_law_done(&law[1]);
  return code;
}

static void compare_stage(struct eo_verification *verification, struct eo_case *out, const char *key,
                          const struct eo_vibration *vibration, enum eo_reading reading)
{
  const double relative = 1e-3;
  struct eo_case *expected = eo_case_find(out, key);
  if (!expected)
    return;
  if (vibration->outcome == EO_VIBRATION_NOT_CONVERGED) {
    eo_verify_diverged(verification, expected);
    return;
  }
  double wanted = eo_case_real(expected);
  eo_verify_derived(verification, expected, "of the stage arrays", vibration->rms_pair[reading], wanted,
                    relative * fabs(wanted));
}

static enum eo_code check_stage(struct eo_verification *verification, struct eo_case *out, const struct stage *stage,
                                const struct eo_geometry *geometry, const struct eo_design *design,
                                struct eo_vibration_solver *solver, struct eo_error *error)
{
  struct eo_dynamics_parameters parameters;
  struct eo_vibration tangent, secant;
  EO_TRY(eo_dynamics_parameters_init(&parameters, geometry, design->gear_pair.ends, 0, &design->supports, false, 1,
                                     error));
  EO_TRY(eo_vibration_set_model(solver, &parameters, error));
  EO_TRY(solve_stage(geometry, stage, design, false, solver, &tangent, error));
  EO_TRY(solve_stage(geometry, stage, design, true, solver, &secant, error));
  compare_stage(verification, out, "rms_n", &tangent, EO_READING_NORMAL);
  compare_stage(verification, out, "rms_t", &tangent, EO_READING_TRANSVERSE);
  compare_stage(verification, out, "rms_rot", &tangent, EO_READING_ROTATIONAL);
  compare_stage(verification, out, "rms_n_secant", &secant, EO_READING_NORMAL);
  return EO_OK;
}

enum eo_code eo_verify_stage_arrays(struct eo_verification *verification, struct eo_case *out, struct eo_case *item,
                                    const struct eo_geometry *geometry, const struct eo_design *design,
                                    struct eo_error *error)
{
  struct eo_vibration_solver *solver = NULL;
  struct stage *stage = calloc(1, sizeof *stage);
  if (!stage)
    return eo_error_memory(error);
  read_stage(item, stage);
  enum eo_code code = EO_OK;
  if (!eo_case_faulty(item))
    code = eo_vibration_new(&solver, design->resolution.harmonics, 0, error);
  if (solver)
    code = check_stage(verification, out, stage, geometry, design, solver, error);
  eo_vibration_free(solver);
  free(stage);
  return code;
}
