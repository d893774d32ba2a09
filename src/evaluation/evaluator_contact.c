/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <string.h>

/* Forgets what belongs to the last run alone. */
static void clear_case(struct eo_case_result *load_case)
{
  load_case->body_iterations = 0;
  for (int reading = 0; reading < EO_READINGS; reading++)
    load_case->band[reading][0] = load_case->band[reading][1] = NAN;
  for (int end = 0; end < 2; end++) {
    load_case->end[end].deflection = (struct eo_deflection){0};
    for (int member = 0; member < 2; member++)
      load_case->end[end].root[member].phases = 0;
  }
}

/* P = T / (ends r_b cos(beta_b)), normal to the flank. */
void eo_evaluator_set_cases(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  const struct eo_geometry *geometry = &evaluator->pair->geometry;
  struct eo_evaluation *result = &evaluator->result;
  result->ends = run->design->gear_pair.ends;
  result->cases = run->design->load_cases;
  result->static_ms = result->impact_ms = result->dynamics_ms = result->root_ms = 0;
  for (int k = 0; k < result->cases; k++) {
    struct eo_case_result *load_case = &result->load_case[k];
    load_case->load_case = run->design->load_case[k];
    load_case->force = load_case->load_case.torque /
                       (result->ends * geometry->base_radius[EO_PINION] * cos(geometry->base_helix_angle));
    clear_case(load_case);
  }
}

/* Makes the bodies' influence when the design asks for elastic bodies and they have changed. */
enum eo_code eo_evaluator_fit_bodies(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error)
{
  EO_TIMED(evaluator->result.static_ms);
  const struct eo_shafts *shafts = &run->design->shafts;
  const struct eo_pair *pair = evaluator->pair;
  if (shafts->enabled && evaluator->elastic_bodies && eo_shafts_equal(shafts, &evaluator->shafts))
    return EO_OK;
  eo_elastic_free(evaluator->elastic_bodies);
  evaluator->elastic_bodies = NULL;
  if (!shafts->enabled)
    return EO_OK;
  if (!evaluator->gaps_on_bent_bodies.gap)
    EO_TRY(eo_loaded_gaps_init(&evaluator->gaps_on_bent_bodies, pair->grid, error));
  evaluator->shafts = *shafts;
  return eo_elastic_new(&evaluator->elastic_bodies, pair->grid, &pair->gear_pair, shafts, error);
}

/* How stiffly the ends are held to one axial position of the pinion: the springs of the dynamic model at rest, so that
   the loads here and the mean forces of the vibration are the same. Elastic bodies twist in the gaps already: their
   grooves count as rigid here. */
enum eo_code eo_evaluator_find_hold(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error)
{
  const struct eo_design *design = run->design;
  struct eo_dynamics_parameters parameters;
  struct eo_dynamics_model model;
  evaluator->axial_stiffness = 0;
  if (design->gear_pair.ends == 1 || eo_alignment_axial_stiffness(&design->alignment) == 0)
    return EO_OK;
  EO_TRY(eo_evaluator_parameters(evaluator, design, 1, &parameters, error));
  for (int member = 0; member < 2; member++)
    if (design->shafts.enabled && parameters.groove_torsional_stiffness[member] > 0) {
      parameters.groove_torsional_stiffness[member] = INFINITY;
      parameters.groove_torsional_damping[member] = 0;
    }
  EO_TRY(eo_dynamics_model_init(&model, &parameters, error));
  evaluator->axial_stiffness = eo_dynamics_model_axial_stiffness(&model);
  return EO_OK;
}

void eo_end_set_gaps(struct eo_evaluator *evaluator, const struct eo_run *run, int thread, int end)
{
  const struct eo_pair *pair = evaluator->pair;
  const struct eo_modification *modification = &run->design->modification;
  (void)thread;
  if (!evaluator->needs_solving[end])
    return;
  eo_gap_field_init(&evaluator->field[end], &pair->geometry, &modification->flank[EO_PINION][end],
                    &modification->flank[EO_GEAR][end], end, run->scenario.in_plane, run->scenario.out_of_plane,
                    pair->pivot[end], pair->grid->corner);
  eo_loaded_gaps_set(&evaluator->gaps[end], pair->grid, &evaluator->field[end]);
}

void eo_end_solve(struct eo_evaluator *evaluator, const struct eo_run *run, int thread, int end)
{
  struct eo_evaluation *result = &evaluator->result;
  double force[EO_MAX_LOAD_CASES];
  struct eo_loaded_end loaded[EO_MAX_LOAD_CASES];
  if (!evaluator->needs_solving[end])
    return;
  for (int k = 0; k < result->cases; k++) {
    force[k] = result->load_case[k].force;
    loaded[k] = result->load_case[k].end[end].loaded;
  }
  eo_loaded_solve(evaluator->loaded[thread], evaluator->pair->grid, &evaluator->gaps[end], run->scenario.compliance,
                  result->cases, force, loaded);
  for (int k = 0; k < result->cases; k++)
    result->load_case[k].end[end].loaded.failures = loaded[k].failures;
}

static void copy_loads(const struct eo_contact_grid *grid, struct eo_loaded_end *to, const struct eo_loaded_end *from)
{
  size_t n = (size_t)grid->positions;
  memcpy(to->load, from->load, n * sizeof(double));
  memcpy(to->approach, from->approach, n * sizeof(double));
  memcpy(to->tangent, from->tangent, n * sizeof(double));
  memcpy(to->line_load, from->line_load, (size_t)grid->points * sizeof(double));
  to->failures = from->failures;
}

void eo_evaluator_copy_equal_end(struct eo_evaluator *evaluator)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->static_ms);
  for (int k = 0; k < result->cases && result->equal_ends; k++)
    copy_loads(evaluator->pair->grid, &result->load_case[k].end[EO_RIGHT].loaded,
               &result->load_case[k].end[EO_LEFT].loaded);
}

/* A solution that failed to converge on elastic bodies is counted at the left end. */
void eo_evaluator_bend_bodies(struct eo_evaluator *evaluator, const struct eo_run *run, double force,
                              struct eo_loaded_end both[2], struct eo_elastic_report *report)
{
  struct eo_elastic_case load = {force, run->scenario.compliance, evaluator->axial_stiffness,
                                 eo_evaluator_stagger(run->design, evaluator->pair->grid->positions)};
  eo_elastic_solve(evaluator->elastic_bodies, evaluator->loaded[0], evaluator->gaps, &load, both, report);
  both[EO_LEFT].failures += report->failures;
}

void eo_evaluator_bend_cases(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->static_ms);
  if (!evaluator->elastic_bodies)
    return;
  for (int k = 0; k < result->cases; k++) {
    struct eo_case_result *load_case = &result->load_case[k];
    struct eo_loaded_end both[2] = {load_case->end[EO_LEFT].loaded, load_case->end[EO_RIGHT].loaded};
    struct eo_elastic_report report;
    eo_evaluator_bend_bodies(evaluator, run, load_case->force, both, &report);
    load_case->body_iterations = report.most_iterations;
    for (int end = 0; end < result->ends; end++) {
      load_case->end[end].loaded.failures = both[end].failures;
      load_case->end[end].deflection = report.mean[end];
    }
  }
}

/* On elastic bodies the springs have had their say already. */
void eo_evaluator_balance_cases(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->static_ms);
  int stagger = eo_evaluator_stagger(run->design, result->positions);
  if (evaluator->elastic_bodies || !eo_reuse_shares_unevenly(evaluator, run->design))
    return;
  for (int k = 0; k < result->cases; k++) {
    struct eo_case_result *load_case = &result->load_case[k];
    struct eo_loaded_gaps gaps[2] = {evaluator->gaps[EO_LEFT],
                                     evaluator->gaps[eo_reuse_stored_at(evaluator, EO_RIGHT)]};
    struct eo_loaded_end both[2] = {load_case->end[EO_LEFT].loaded, load_case->end[EO_RIGHT].loaded};
    eo_loaded_balance(evaluator->loaded[0], evaluator->pair->grid, gaps, run->scenario.compliance,
                      evaluator->axial_stiffness, stagger, load_case->force, both);
    for (int end = 0; end < 2; end++)
      load_case->end[end].loaded.failures = both[end].failures;
  }
}
