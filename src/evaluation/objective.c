/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/objective.h"

#include <math.h>

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

/* By how much of the limit a value exceeds it; a limit that is off (NaN) is never exceeded. */
static double excess(double limit, double value)
{
  if (!(value > limit))
    return 0;
  return limit > 0 ? value / limit - 1 : value;
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

static double violation(const struct eo_objective *o, const struct eo_objective_case *v,
                        const struct eo_objective_case *before)
{
  double sum = excess(o->contact_pressure, v->contact_pressure) + excess(o->root_stress, v->root_stress) +
               excess(o->peak_to_peak, v->peak_to_peak) + excess(o->edge_load_share, v->edge_load_share) +
               excess(o->contact_loss, v->contact_loss) + shortfall(o->flank_safety, v->flank_safety) +
               shortfall(o->root_safety, v->root_safety) + shortfall(o->film_ratio, v->film_ratio) +
               excess(o->contact_temperature, v->contact_temperature);
  if (o->no_worse_than_unmodified)
    sum += worse(v->peak_to_peak, before->peak_to_peak) + worse(v->impact, before->impact) + worse(v->rms, before->rms);
  return sum;
}

void eo_objective_value(const struct eo_objective *objective, int cases, const struct eo_load_case *load_case,
                        const struct eo_objective_case *value, const struct eo_objective_case *unmodified,
                        bool relief_outside, struct eo_objective_value *result)
{
  struct eo_objective_sums before;
  *result = (struct eo_objective_value){0};
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
  if (result->sums.failed || !(result->objective > 0)) {
    result->objective = NAN;
    result->fitness = EO_FITNESS_WORST;
    return;
  }
  result->fitness = 1 / result->objective - objective->penalty * result->violation; /* theory (O3) */
}

bool eo_objective_wants_rating(const struct eo_objective *o)
{
  return !isnan(o->flank_safety) || !isnan(o->root_safety) || !isnan(o->film_ratio) || !isnan(o->contact_temperature);
}

bool eo_objective_relief_outside(const struct eo_modification *modification, double bottom, double top)
{
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < 2; end++) {
      const struct eo_flank_modification *m = &modification->flank[member][end];
      double own_top = member == EO_PINION ? top : -bottom, own_bottom = member == EO_PINION ? -bottom : top;
      if ((m->tip_relief > 0 && m->tip_relief_start >= own_top) ||
          (m->root_relief > 0 && m->root_relief_start >= own_bottom))
        return true;
    }
  return false;
}
