/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/speed_sweep.h"

#include <math.h>
#include <stdlib.h>

#include "dynamics/vibration_private.h"
#include "numerics/fourier.h"

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

static enum eo_code solve_alone(struct eo_vibration_solver *solver, int count, const struct eo_vibration_case *load,
                                struct eo_vibration *alone, const struct eo_progress *progress, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int i = 0; i < count && !code; i++) {
    code = eo_vibration_solve(solver, &load[i], EO_START_COLD, &alone[i], error);
    if (!code && eo_progress_report(progress, "speed sweep", (double)(i + 1) / count))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "The sweep was cancelled.");
  }
  return code;
}

/* at: [count] cases, alone: [count] what they are without a neighbour. */
static enum eo_code sweep_both_ways(struct eo_vibration_solver *solver, const struct eo_vibration_case *at, int count,
                                    struct eo_vibration *alone, struct eo_vibration *up, struct eo_vibration *down,
                                    const struct eo_progress *progress, struct eo_error *error)
{
  EO_TRY(check_speeds(count, at, error));
  EO_TRY(solve_alone(solver, count, at, alone, progress, error));
  if (up)
    EO_TRY(eo_vibration_follow(solver, count, at, alone, +1, up, error));
  return down ? eo_vibration_follow(solver, count, at, alone, -1, down, error) : EO_OK;
}

enum eo_code eo_vibration_sweep(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, int count,
                                const double *speed, struct eo_vibration *up, struct eo_vibration *down,
                                const struct eo_progress *progress, struct eo_error *error)
{
  size_t n = count > 0 ? (size_t)count : 1;
  struct eo_vibration_case *at = calloc(n, sizeof *at);
  struct eo_vibration *alone = calloc(n, sizeof *alone);
  for (int i = 0; i < count && at; i++) {
    at[i] = *load;
    at[i].speed = speed[i];
  }
  enum eo_code code = at && alone ? sweep_both_ways(solver, at, count, alone, up, down, progress, error)
                                  : eo_error_memory(error);
  free(at);
  free(alone);
  return code;
}

struct trace {
  int teeth, harmonics, ends, capacity, count;
  struct eo_trace_point *point;
};

static int note_point(void *context, const struct eo_branch_point *branch_point)
{
  struct trace *trace = context;
  struct eo_trace_point *out = &trace->point[trace->count++];
  *out = (struct eo_trace_point){.speed = branch_point->frequency / trace->teeth,
                                 .direction = branch_point->direction,
                                 .fold = branch_point->fold};
  for (int end = 0; end < trace->ends; end++) {
    double square = 0;
    const double *x = branch_point->x + end * eo_fourier_terms(trace->harmonics);
    for (int k = 1; k <= trace->harmonics; k++)
      square += pow(k * branch_point->frequency, 4) * (x[2 * k - 1] * x[2 * k - 1] + x[2 * k] * x[2 * k]) / 2;
    out->rms[end] = sqrt(square);
    out->contact_loss[end] = eo_alternating_loss(branch_point->grid, end);
  }
  return trace->count >= trace->capacity;
}

enum eo_code eo_vibration_trace(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, double low,
                                double high, int direction, int capacity, struct eo_trace_point *point, int *count,
                                enum eo_branch_end *end, struct eo_error *error)
{
  struct eo_vibration start;
  struct eo_cycle cycle;
  if (!(low > 0 && low < high && load->speed >= low && load->speed <= high) || capacity < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "A branch is traced within 0 < low <= speed <= high, not %g, %g, %g rad/s.", low, load->speed,
                        high);
  *count = 0;
  enum eo_code code = eo_vibration_solve(solver, load, EO_START_COLD, &start, error);
  if (!code)
    code = eo_vibration_prepare(solver, load, &cycle, error);
  if (code || start.outcome == EO_VIBRATION_NOT_CONVERGED)
    return code;
  struct trace trace = {load->pinion_teeth, solver->harmonics, solver->model.parameters.ends, capacity, 0, point};
  struct eo_branch_options options = eo_branch_defaults;
  options.low = low * load->pinion_teeth * (1 - 1e-12);
  options.high = high * load->pinion_teeth * (1 + 1e-12);
  options.max_points = capacity;
  options.size = fmax(start.deflection_swing[0], start.force_mean[0] / solver->model.oscillator.shift);
  code = eo_branch_follow(solver->balance, &solver->model.oscillator, &cycle, solver->x, direction, &options,
                          note_point, &trace, end, error);
  solver->solved = false;
  *count = trace.count;
  return code;
}
