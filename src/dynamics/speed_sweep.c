/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/speed_sweep.h"

#include "dynamics/vibration_private.h"

static enum eo_code check_speeds(int count, const struct eo_vibration_case *load, struct eo_error *error)
{
  if (count < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A sweep needs at least one speed.");
  for (int i = 1; i < count; i++)
    if (!(load[i].speed > load[i - 1].speed))
      return eo_error_set(error, EO_ERROR_INPUT, "",
                          "The speeds of a sweep must ascend; number %d is %g rad/s after %g.", i, load[i].speed,
                          load[i - 1].speed);
  return EO_OK;
}

/* No motion keeps to an unstable state, in a sweep neither. holds: the solver has the result's solution. */
static enum eo_code keep_stable(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, bool holds,
                                struct eo_vibration *result, struct eo_error *error)
{
  struct eo_vibration again;
  enum eo_code code = holds ? EO_OK : eo_vibration_solve(solver, load, EO_START_COLD, &again, error);
  if (code || (!holds && again.outcome == EO_VIBRATION_NOT_CONVERGED))
    return code;
  return eo_vibration_keep_stable(solver, load, result, error);
}

enum eo_code eo_vibration_follow(struct eo_vibration_solver *solver, int count, const struct eo_vibration_case *load,
                                 const struct eo_vibration *alone, int direction, struct eo_vibration *result,
                                 struct eo_error *error)
{
  bool separated = false, holds = false; /* at the neighbour; the solver holds its stable solution */
  EO_TRY(check_speeds(count, load, error));
  for (int step = 0, before = 0; step < count; step++) {
    int i = direction > 0 ? step : count - 1 - step;
    struct eo_vibration again;
    if (separated && !holds)
      EO_TRY(eo_vibration_solve(solver, &load[before], EO_START_COLD, &again, error));
    if (separated)
      EO_TRY(eo_vibration_solve(solver, &load[i], EO_START_WARM, &result[i], error));
    holds = separated && result[i].outcome != EO_VIBRATION_NOT_CONVERGED;
    if (!holds)
      result[i] = alone[i];
    if (result[i].outcome == EO_VIBRATION_CONTACT_LOST)
      EO_TRY(keep_stable(solver, &load[i], holds, &result[i], error));
    separated = result[i].outcome == EO_VIBRATION_CONTACT_LOST;
    holds = solver->solved;
    before = i;
  }
  return EO_OK;
}
