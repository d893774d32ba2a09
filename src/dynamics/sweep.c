#include "dynamics/sweep.h"

#include <math.h>

#include "dynamics/vibration-internal.h"
#include "numerics/fourier.h"

static enum eo_code check_speeds(int count, const double *speed, struct eo_error *error)
{
  if (count < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A sweep needs at least one speed.");
  for (int i = 0; i < count; i++)
    if (!(speed[i] > 0 && isfinite(speed[i])) || (i && speed[i] < speed[i - 1]))
      return eo_error_set(error, EO_ERROR_INPUT, "", "The speeds of a sweep must be positive and ascend; number %d is %g rad/s.", i, speed[i]);
  return EO_OK;
}

/* From the last solution where it had lost contact, else, or when that leads nowhere, afresh. */
static enum eo_code solve_next(struct eo_vibration_solver *s, const struct eo_vibration_case *load, bool *separated,
                               struct eo_vibration *result, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  bool found = false;
  if (*separated) {
    code = eo_vibration_solve(s, load, EO_START_WARM, result, error);
    found = !code && result->outcome != EO_VIBRATION_NOT_CONVERGED;
  }
  if (!code && !found)
    code = eo_vibration_solve(s, load, EO_START_COLD, result, error);
  *separated = !code && result->outcome == EO_VIBRATION_CONTACT_LOST;
  return code;
}

static enum eo_code sweep_up(struct eo_vibration_solver *s, struct eo_vibration_case *load, int count, const double *speed,
                             struct eo_vibration *up, const struct eo_progress *progress, struct eo_error *error)
{
  bool separated = false;
  for (int i = 0; i < count; i++) {
    load->speed = speed[i];
    enum eo_code code = solve_next(s, load, &separated, &up[i], error);
    if (!code && eo_progress_report(progress, "speed sweep", 0.5 * i / count))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "The sweep was cancelled.");
    if (code)
      return code;
  }
  return EO_OK;
}

/* A state in full contact does not depend on the direction, so it is taken over from the way up. */
static enum eo_code sweep_down(struct eo_vibration_solver *s, struct eo_vibration_case *load, int count, const double *speed,
                               const struct eo_vibration *up, struct eo_vibration *down, const struct eo_progress *progress,
                               struct eo_error *error)
{
  bool separated = false;
  for (int i = count - 1; i >= 0; i--) {
    if (up && !separated && up[i].outcome == EO_VIBRATION_CONVERGED) {
      down[i] = up[i];
      continue;
    }
    load->speed = speed[i];
    enum eo_code code = solve_next(s, load, &separated, &down[i], error);
    if (!code && eo_progress_report(progress, "speed sweep", 1 - 0.5 * i / count))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "The sweep was cancelled.");
    if (code)
      return code;
  }
  return EO_OK;
}

enum eo_code eo_vibration_sweep(struct eo_vibration_solver *s, const struct eo_vibration_case *load, int count,
                                const double *speed, struct eo_vibration *up, struct eo_vibration *down,
                                const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_vibration_case at = *load;
  enum eo_code code = check_speeds(count, speed, error);
  if (!code && up)
    code = sweep_up(s, &at, count, speed, up, progress, error);
  if (!code && down)
    code = sweep_down(s, &at, count, speed, up, down, progress, error);
  return code;
}

struct trace {
  int teeth, harmonics, ends, capacity, count;
  struct eo_trace_point *point;
};

static int note_point(void *context, const struct eo_branch_point *p)
{
  struct trace *t = context;
  struct eo_trace_point *out = &t->point[t->count++];
  *out = (struct eo_trace_point){.speed = p->frequency / t->teeth, .direction = p->direction, .fold = p->fold};
  for (int end = 0; end < t->ends; end++) {
    double square = 0;
    const double *x = p->x + end * eo_fourier_terms(t->harmonics);
    for (int k = 1; k <= t->harmonics; k++)
      square += pow(k * p->frequency, 4) * (x[2 * k - 1] * x[2 * k - 1] + x[2 * k] * x[2 * k]) / 2;
    out->rms[end] = sqrt(square);
    out->contact_loss[end] = eo_alternating_loss(p->grid, end);
  }
  return t->count >= t->capacity;
}

enum eo_code eo_vibration_trace(struct eo_vibration_solver *s, const struct eo_vibration_case *load, double low, double high,
                                int direction, int capacity, struct eo_trace_point *point, int *count,
                                enum eo_branch_end *end, struct eo_error *error)
{
  struct eo_vibration start;
  struct eo_cycle cycle;
  if (!(low > 0 && low < high && load->speed >= low && load->speed <= high) || capacity < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A branch is traced within 0 < low <= speed <= high, not %g, %g, %g rad/s.", low,
                        load->speed, high);
  *count = 0;
  enum eo_code code = eo_vibration_solve(s, load, EO_START_COLD, &start, error);
  if (!code)
    code = eo_vibration_prepare(s, load, &cycle, error);
  if (code || start.outcome == EO_VIBRATION_NOT_CONVERGED)
    return code;
  struct trace trace = {load->pinion_teeth, s->harmonics, s->model.parameters.ends, capacity, 0, point};
  struct eo_branch_options options = eo_branch_defaults;
  options.low = low * load->pinion_teeth * (1 - 1e-12);
  options.high = high * load->pinion_teeth * (1 + 1e-12);
  options.max_points = capacity;
  options.size = fmax(start.deflection_swing[0], start.force_mean[0] / s->model.oscillator.shift);
  code = eo_branch_follow(s->balance, &s->model.oscillator, &cycle, s->x, direction, &options, note_point, &trace, end, error);
  s->solved = false;
  *count = trace.count;
  return code;
}
