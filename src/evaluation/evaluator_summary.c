/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <string.h>

#include "evaluation/objective_terms.h"
#include "evaluation/scalar.h"

/* The gap field of an end as the bodies of a load case hold it; *bent is made where they are elastic. */
static const struct eo_gap_field *loaded_field(const struct eo_evaluator *evaluator,
                                               const struct eo_case_result *load_case, int end,
                                               struct eo_gap_field *bent)
{
  const struct eo_gap_field *field = &eo_meeting_of(evaluator, load_case)->field[eo_reuse_stored_at(evaluator, end)];
  if (!evaluator->bodies_are_elastic)
    return field;
  *bent = *field;
  bent->deflection = &load_case->end[end].deflection;
  return bent;
}

/* Z0 and the datum on rigid bodies, the datum again with the bodies as the load holds them; first_contact[positions]
   receives Z0 with those. */
static void find_first_contact(const struct eo_evaluator *evaluator, struct eo_case_result *load_case, int end,
                               double *first_contact)
{
  struct eo_end_result *result = &load_case->end[end];
  int stored = eo_reuse_stored_at(evaluator, end);
  const struct eo_meeting *meeting = eo_meeting_of(evaluator, load_case);
  size_t bytes = sizeof *result->unloaded * (size_t)evaluator->pair->grid->positions;
  memcpy(result->unloaded, meeting->gaps[stored].unloaded, bytes);
  result->datum = result->loaded_datum = meeting->datum[stored];
  memcpy(first_contact, result->unloaded, bytes);
  if (evaluator->bodies_are_elastic) {
    struct eo_gap_field bent;
    const struct eo_gap_field *field = loaded_field(evaluator, load_case, end, &bent);
    result->loaded_datum = eo_gap_field_datum(field);
    eo_loaded_first_contact(eo_evaluator_grid(evaluator, end), field, NULL, first_contact);
  }
}

/* Raises the largest line load, Hertz pressure and share of P on tip edges to those of one position. *steepest: the
   largest q / rho up to here, which the largest pressure goes with. */
static void raise_peaks(struct eo_end_result *result, const struct eo_contact_grid *grid, int position,
                        double *steepest)
{
  const struct eo_contact_position *line = &grid->position[position];
  double edge = 0;
  for (int i = 0; i < line->points; i++) {
    double q = result->loaded.line_load[line->first + i];
    result->max_line_load = q > result->max_line_load ? q : result->max_line_load;
    if (q > *steepest * line->radius[i]) {
      *steepest = q / line->radius[i];
      result->max_pressure = eo_loaded_pressure(grid, q, line->radius[i]);
    }
    edge += line->kind[i] == EO_POINT_LINE ? 0 : q * line->length[i];
  }
  if (result->loaded.load[position] > 0)
    result->edge_share = fmax(result->edge_share, edge / result->loaded.load[position]);
}

/* Peaks over the mesh cycle, and the secant stiffness P / (Z - Z0). */
static void summarise(const struct eo_evaluator *evaluator, struct eo_case_result *load_case, int end)
{
  const struct eo_contact_grid *grid = eo_evaluator_grid(evaluator, end);
  struct eo_end_result *result = &load_case->end[end];
  double low = INFINITY, high = -INFINITY, steepest = 0;
  double *first_contact = result->stiffness; /* until the stiffness takes its place */
  result->max_pressure = result->max_line_load = result->edge_share = 0;
  find_first_contact(evaluator, load_case, end, first_contact);
  for (int j = 0; j < grid->positions; j++) {
    raise_peaks(result, grid, j, &steepest);
    result->stiffness[j] = result->loaded.load[j] / (result->loaded.approach[j] - first_contact[j]); /* theory (C3) */
    low = fmin(low, result->loaded.approach[j]);
    high = fmax(high, result->loaded.approach[j]);
  }
  eo_face_load_find(&result->face, grid, &result->loaded);
  result->transmission_peak = (high - low) / cos(grid->geometry.base_helix_angle);
}

void eo_end_summarise(struct eo_evaluator *evaluator, const struct eo_run *run, int end)
{
  (void)run;
  for (int k = 0; k < evaluator->result.cases && !evaluator->kept[end]; k++)
    summarise(evaluator, &evaluator->result.load_case[k], end);
}

/* LTE of the pair: the mean of the ends, the right one behind by the stagger; of unequal helices the rotation that
   leaves no axial displacement. */
static void summarise_pair(const struct eo_evaluator *evaluator, const struct eo_run *run,
                           struct eo_case_result *load_case)
{
  int n = evaluator->result.positions, last = evaluator->result.ends - 1;
  int stagger = eo_evaluator_stagger(evaluator->pair, run->design, &load_case->running);
  const double *left = load_case->end[EO_LEFT].loaded.approach, *right = load_case->end[last].loaded.approach;
  const struct eo_double_helix helix = eo_pair_double_helix(evaluator->pair);
  double low = INFINITY, high = -INFINITY, normal = cos(evaluator->pair->geometry.base_helix_angle),
         of_left = 2 * helix.share[EO_LEFT], of_right = 2 * helix.share[EO_RIGHT] * helix.scale[EO_RIGHT];
  load_case->mean = 0;
  for (int j = 0; j < n; j++) {
    double z = (of_left * left[j] + of_right * right[(j + n - stagger) % n]) / 2 / normal; /* theory (Y2) */
    load_case->transmission[j] = z;
    load_case->mean += z / n;
    low = fmin(low, z);
    high = fmax(high, z);
  }
  load_case->peak_to_peak = high - low;
  load_case->contact_failures = 0;
  for (int end = 0; end <= last; end++)
    load_case->contact_failures += load_case->end[end].loaded.failures;
}

void eo_evaluator_summarise_pairs(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  EO_TIMED(evaluator->result.static_ms);
  for (int k = 0; k < evaluator->result.cases; k++)
    summarise_pair(evaluator, run, &evaluator->result.load_case[k]);
}

/* Of an end that is kept, the touch is where it was; the speed may be another. */
static void find_impact(const struct eo_evaluator *evaluator, const struct eo_run *run,
                        struct eo_case_result *load_case, int end)
{
  struct eo_impact *impact = &load_case->end[end].impact;
  double speed = load_case->load_case.speed * run->scenario.speed;
  const struct eo_pair *pair = eo_pair_half(evaluator->pair, end);
  struct eo_impact_settings settings = pair->impact;
  struct eo_gap_field bent;
  settings.backwards = load_case->running.backwards;
  if (evaluator->kept[end]) {
    eo_impact_strike(impact, pair->grid, &settings, speed, run->scenario.compliance);
    return;
  }
  if (!evaluator->bodies_are_elastic)
    settings.incoming = &eo_meeting_of(evaluator, load_case)->incoming[eo_reuse_stored_at(evaluator, end)];
  eo_impact_find(impact, pair->grid, loaded_field(evaluator, load_case, end, &bent), pair->kernel, &settings,
                 load_case->end[end].loaded.approach, speed, run->scenario.compliance);
}

void eo_evaluator_find_impacts(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->impact_ms);
  bool copies_left = eo_reuse_copies_left(evaluator, run->design);
  for (int k = 0; k < result->cases; k++)
    for (int end = 0; end < result->ends; end++) {
      struct eo_case_result *load_case = &result->load_case[k];
      if (end == EO_RIGHT && copies_left)
        load_case->end[end].impact = load_case->end[EO_LEFT].impact;
      else
        find_impact(evaluator, run, load_case, end);
    }
}

/* The worst of the ends, but for the RMS, which is the mean of theirs. */
static struct eo_objective_case objective_of(const struct eo_case_result *load_case, int ends, int positions, bool root)
{
  struct eo_objective_case objective = {.peak_to_peak = load_case->peak_to_peak,
                                        .rms = load_case->vibration.rms_pair[EO_READING_NORMAL],
                                        .root_stress = root ? 0 : NAN,
                                        .flank_safety = NAN,
                                        .root_safety = NAN,
                                        .film_ratio = NAN,
                                        .contact_temperature = NAN,
                                        .failed = load_case->contact_failures > 0 ||
                                                  load_case->vibration.outcome == EO_VIBRATION_NOT_CONVERGED};
  for (int i = 0; i < EO_OBJECTIVE_SAMPLES; i++)
    objective.transmission[i] = load_case->transmission[i * positions / EO_OBJECTIVE_SAMPLES] - load_case->mean;
  for (int end = 0; end < 2; end++)
    objective.end_impact[end] = load_case->end[end < ends ? end : 0].impact.force;
  for (int end = 0; end < ends; end++) {
    const struct eo_end_result *result = &load_case->end[end];
    objective.impact = fmax(objective.impact, result->impact.force);
    objective.contact_pressure = fmax(objective.contact_pressure, result->max_pressure);
    objective.edge_load_share = fmax(objective.edge_load_share, result->edge_share);
    objective.contact_loss = fmax(objective.contact_loss, load_case->vibration.contact_loss[end]);
    for (int member = 0; root && member < 2; member++)
      objective.root_stress = fmax(objective.root_stress, result->root[member].maximum);
  }
  return objective;
}

void eo_evaluator_collect_objectives(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  struct eo_evaluation *result = &evaluator->result;
  bool scalars = eo_objective_wants_scalars(&run->design->objective);
  for (int k = 0; k < result->cases; k++) {
    result->objective[k] = objective_of(&result->load_case[k], result->ends, result->positions, run->root);
    for (int i = 0; i < EO_SCALARS; i++)
      result->objective[k].scalar[i] = scalars ? eo_scalar_value(eo_scalar_at(i), result, k) : NAN;
  }
}
