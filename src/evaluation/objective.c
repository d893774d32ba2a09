/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/objective.h"

#include <math.h>

#include "evaluation/objective_terms.h"

struct eo_objective_case eo_objective_nothing(void)
{
  struct eo_objective_case nothing = {.peak_to_peak = NAN,
                                      .impact = NAN,
                                      .rms = NAN,
                                      .contact_pressure = NAN,
                                      .root_stress = NAN,
                                      .edge_load_share = NAN,
                                      .contact_loss = NAN,
                                      .flank_safety = NAN,
                                      .root_safety = NAN,
                                      .film_ratio = NAN,
                                      .contact_temperature = NAN,
                                      .failed = true,
                                      .end_impact = {NAN, NAN}};
  for (int i = 0; i < EO_OBJECTIVE_SAMPLES; i++)
    nothing.transmission[i] = NAN;
  for (int i = 0; i < EO_SCALARS; i++)
    nothing.scalar[i] = NAN;
  return nothing;
}

void eo_objective_sum(int cases, const struct eo_load_case *load_case, const struct eo_objective_case *value,
                      struct eo_objective_sums *sums)
{
  *sums = (struct eo_objective_sums){0};
  for (int k = 0; k < cases; k++) {
    sums->f[0] += load_case[k].share * fabs(value[k].peak_to_peak) / cases; /* theory (O1) */
    sums->f[1] += load_case[k].share * fabs(value[k].impact) / cases;
    sums->f[2] += load_case[k].share * value[k].rms / cases;
    sums->failed |= value[k].failed;
  }
  for (int i = 0; i < 3; i++)
    sums->failed |= !isfinite(sums->f[i]);
}

/* By how much of itself a value falls short of a limit from below. */
static double shortfall(double limit, double value)
{
  const double nothing = 1e-3; /* of the limit: what is not rated counts as next to none */
  return value < limit ? limit / fmax(value, nothing * limit) - 1 : 0;
}

static double worse(double value, double before)
{
  return before > 0 && value > before ? value / before - 1 : 0;
}

static double violation(const struct eo_objective *objective, const struct eo_objective_case *objective_case,
                        const struct eo_objective_case *before)
{
  double sum = eo_objective_excess(objective->contact_pressure, objective_case->contact_pressure) +
               eo_objective_excess(objective->root_stress, objective_case->root_stress) +
               eo_objective_excess(objective->peak_to_peak, objective_case->peak_to_peak) +
               eo_objective_excess(objective->edge_load_share, objective_case->edge_load_share) +
               eo_objective_excess(objective->contact_loss, objective_case->contact_loss) +
               shortfall(objective->flank_safety, objective_case->flank_safety) +
               shortfall(objective->root_safety, objective_case->root_safety) +
               shortfall(objective->film_ratio, objective_case->film_ratio) +
               eo_objective_excess(objective->contact_temperature, objective_case->contact_temperature);
  if (objective->no_worse_than_unmodified)
    sum += worse(objective_case->peak_to_peak, before->peak_to_peak) + worse(objective_case->impact, before->impact) +
           worse(objective_case->rms, before->rms);
  return sum;
}

void eo_objective_weigh(const struct eo_objective *objective, int cases, const struct eo_load_case *load_case,
                        const struct eo_objective_case *value, const struct eo_objective_case *unmodified,
                        bool relief_outside, struct eo_objective_value *result)
{
  struct eo_objective_sums before;
  *result = (struct eo_objective_value){.nominal = NAN};
  eo_objective_sum(cases, load_case, value, &result->sums);
  eo_objective_sum(cases, load_case, unmodified, &before);
  for (int i = 0; i < 3; i++) {
    double scale = objective->normalise == EO_NORMALISE_NONE ? 1 : before.f[i];
    if (objective->weight[i] == 0)
      continue;
    /* An objective that the unmodified pair already has at zero cannot be normalised; it counts only once it is there.
     */
    /* theory (O2) */
    result->objective += objective->weight[i] * (scale > 0 ? result->sums.f[i] / scale : result->sums.f[i] > 0);
  }
  for (int k = 0; k < cases; k++)
    result->violation += violation(objective, &value[k], &unmodified[k]);
  if (objective->relief_inside_active_flank && relief_outside)
    result->violation += 1;
  if (!eo_objective_has_scalars(objective, cases, value))
    result->sums.failed = true;
  else
    eo_objective_add_terms(objective, cases, load_case, value, unmodified, result);
}

void eo_objective_value(const struct eo_objective *objective, int cases, const struct eo_load_case *load_case,
                        const struct eo_objective_case *value, const struct eo_objective_case *unmodified,
                        bool relief_outside, struct eo_objective_value *result)
{
  eo_objective_weigh(objective, cases, load_case, value, unmodified, relief_outside, result);
  eo_objective_judge(objective, result);
}

void eo_objective_judge(const struct eo_objective *objective, struct eo_objective_value *value)
{
  if (value->sums.failed || !(value->objective > 0)) {
    value->objective = NAN;
    value->fitness = EO_FITNESS_WORST;
    return;
  }
  value->fitness = 1 / value->objective - objective->penalty * value->violation; /* theory (O3) */
}

bool eo_objective_wants_rating(const struct eo_objective *objective)
{
  return !isnan(objective->flank_safety) || !isnan(objective->root_safety) || !isnan(objective->film_ratio) ||
         !isnan(objective->contact_temperature);
}

bool eo_objective_relief_outside(const struct eo_modification *modification, double bottom, double top)
{
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < 2; end++) {
      const struct eo_flank_modification *flank_modification = &modification->flank[member][end];
      double own_top = member == EO_PINION ? top : -bottom, own_bottom = member == EO_PINION ? -bottom : top;
      if ((flank_modification->tip_relief > 0 && flank_modification->tip_relief_start >= own_top) ||
          (flank_modification->root_relief > 0 && flank_modification->root_relief_start >= own_bottom))
        return true;
    }
  return false;
}
