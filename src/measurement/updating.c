#include "measurement/updating.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "numerics/dense.h"
#include "numerics/least_squares.h"

static const double MODEL_ERROR = 0.05, TWIN = 0.95, STUDENT = 1.96, OPEN = 0.5;
enum { STARTS_PER_UNKNOWN = 8, ITERATIONS = 25 };

struct fit {
  const struct eo_design *design;
  const struct eo_measured *measured;
  const struct eo_update_settings *settings;
  const struct eo_progress *progress;
  struct eo_pair pair;            /* with an impact patch of its own */
  struct eo_evaluator *evaluator; /* on it */
  struct eo_design trial;
  int order[EO_MOST_MEASURED]; /* measurements with the same loaded contact after each other: the evaluator solves it
                                  once */
  int count, residuals, evaluations, expected;
  double model_error;
};

/* ---- the unknowns ---- */

const char *const eo_unknown_names[EO_UNKNOWNS + 1] = {"pinion_bearing_stiffness_N_per_um",
                                                       "gear_bearing_stiffness_N_per_um",
                                                       "mesh_damping_ratio",
                                                       "gear_axial_stiffness_N_per_um",
                                                       "pinion_axial_stiffness_N_per_um",
                                                       "shaft_angle_error_in_plane_deg",
                                                       "shaft_angle_error_out_of_plane_deg",
                                                       "impact_patch_mm",
                                                       NULL};

const char *eo_unknown_name(enum eo_unknown unknown)
{
  return eo_unknown_names[unknown];
}

static double *member_of(struct eo_design *d, enum eo_unknown unknown)
{
  switch (unknown) {
  case EO_UNKNOWN_PINION_BEARING:
    return &d->supports.bearing_stiffness[EO_PINION];
  case EO_UNKNOWN_GEAR_BEARING:
    return &d->supports.bearing_stiffness[EO_GEAR];
  case EO_UNKNOWN_MESH_DAMPING:
    return &d->supports.mesh_damping_ratio;
  case EO_UNKNOWN_GEAR_AXIAL:
    return &d->supports.gear_axial_stiffness[EO_LEFT];
  case EO_UNKNOWN_PINION_AXIAL:
    return &d->alignment.pinion_axial_stiffness;
  case EO_UNKNOWN_IN_PLANE:
    return &d->alignment.shaft_angle_in_plane;
  case EO_UNKNOWN_OUT_OF_PLANE:
    return &d->alignment.shaft_angle_out_of_plane;
  case EO_UNKNOWN_IMPACT_PATCH:
  case EO_UNKNOWNS:
    break;
  }
  return &d->resolution.impact_patch;
}

double eo_unknown_get(const struct eo_design *design, enum eo_unknown unknown)
{
  return *member_of((struct eo_design *)design, unknown);
}

void eo_unknown_set(struct eo_design *design, enum eo_unknown unknown, double value)
{
  *member_of(design, unknown) = value;
  if (unknown == EO_UNKNOWN_GEAR_AXIAL)
    design->supports.gear_axial_stiffness[EO_RIGHT] = value;
  if (unknown == EO_UNKNOWN_PINION_AXIAL)
    design->alignment.pinion_axial = EO_AXIAL_SPRING;
}

static bool logarithmic(enum eo_unknown unknown)
{
  return unknown != EO_UNKNOWN_IN_PLANE && unknown != EO_UNKNOWN_OUT_OF_PLANE;
}

static double from_unit(const struct eo_update_range *r, double x)
{
  return logarithmic(r->unknown) ? r->low * pow(r->high / r->low, x) : r->low + x * (r->high - r->low);
}

static double to_unit(const struct eo_update_range *r, double value)
{
  double x = logarithmic(r->unknown) ? log(value / r->low) / log(r->high / r->low)
                                     : (value - r->low) / (r->high - r->low);
  return fmin(1, fmax(0, x));
}

/* ---- residuals ---- */

static void set_trial(struct fit *f, const double *x)
{
  f->trial = *f->design;
  for (int i = 0; i < f->settings->unknowns; i++)
    eo_unknown_set(&f->trial, f->settings->range[i].unknown, from_unit(&f->settings->range[i], x[i]));
  f->pair.impact.patch = f->pair.resolution.impact_patch = f->trial.resolution.impact_patch;
}

/* (measured - predicted) / standard deviation of each order's acceleration; a state that is not found counts as none at
   all. */
static void add_residuals(const struct fit *f, const struct eo_measured *m, const struct eo_rig_prediction *p,
                          double *residual)
{
  for (int h = 0; h < m->harmonics; h++) {
    double noise = m->order[h].sigma * pow(m->order[h].order * m->speed, 2);
    double sigma =
        sqrt(noise * noise + pow(EO_RMS_SYSTEMATIC * m->order[h].acceleration, 2) + pow(f->model_error * m->rms, 2));
    residual[h] = (m->order[h].acceleration - (p->valid ? p->acceleration[h] : 0)) / sigma;
  }
}

static enum eo_code residuals_at(void *context, const double *x, double *residual, struct eo_error *error)
{
  struct fit *f = context;
  struct eo_rig_prediction prediction;
  set_trial(f, x);
  f->evaluations++;
  if (eo_progress_report(f->progress, "fit of the inputs", fmin(0.99, (double)f->evaluations / f->expected)))
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
  for (int i = 0; i < f->count; i++) {
    const struct eo_measured *m = &f->measured[f->order[i]];
    enum eo_code code = eo_prediction_run(&prediction, f->evaluator, &f->trial, m->unmodified, m->torque, m->speed,
                                          m->end, m->harmonics, error);
    if (code)
      return code;
    add_residuals(f, m, &prediction, residual);
    residual += m->harmonics;
  }
  return EO_OK;
}

static double mean_square(int count, const double *value)
{
  double sum = 0;
  for (int i = 0; i < count; i++)
    sum += value[i] * value[i] / count;
  return sum;
}

static void sort_measurements(struct fit *f)
{
  for (int i = 0; i < f->count; i++) {
    const struct eo_measured *m = &f->measured[i];
    int at = i;
    for (; at > 0; at--) {
      const struct eo_measured *before = &f->measured[f->order[at - 1]];
      if (before->unmodified < m->unmodified || (before->unmodified == m->unmodified && before->torque <= m->torque))
        break;
      f->order[at] = f->order[at - 1];
    }
    f->order[at] = i;
  }
}

/* ---- the search ---- */

static int greatest_divisor(int a, int b)
{
  return b ? greatest_divisor(b, a % b) : a;
}

/* The at-th number from 1 that shares no divisor with `of`: multiplying by it permutes 0 .. of - 1. */
static int permuting_factor(int at, int of)
{
  int factor = 1;
  while (at > 0)
    at -= greatest_divisor(++factor, of) == 1;
  return factor;
}

/* Points spread over the ranges, one in each slice of every unknown (McKay, Beckman, Conover 1979), and what the design
   says now. */
static enum eo_code look_around(struct fit *f, int starts, double *best, double *residual, double *before,
                                struct eo_error *error)
{
  int n = f->settings->unknowns;
  double lowest, x[EO_UNKNOWNS];
  for (int j = 0; j < n; j++)
    best[j] = to_unit(&f->settings->range[j], eo_unknown_get(f->design, f->settings->range[j].unknown));
  enum eo_code code = residuals_at(f, best, residual, error);
  lowest = *before = code ? NAN : mean_square(f->residuals, residual);
  for (int i = 0; i < starts && !code; i++) {
    for (int j = 0; j < n; j++) {
      struct eo_random r = eo_random_at(f->settings->seed, 1, (uint64_t)i, (uint64_t)j);
      int slice = (i * permuting_factor(j, starts) + j) % starts;
      x[j] = (slice + eo_random_unit(r, 0)) / starts;
    }
    code = residuals_at(f, x, residual, error);
    double value = code ? NAN : mean_square(f->residuals, residual);
    if (value < lowest) {
      lowest = value;
      memcpy(best, x, sizeof *x * (size_t)n);
    }
  }
  return code;
}

/* ---- what the data tell ---- */

static void read_intervals(const struct fit *f, struct eo_update *u, const double *x, const double *covariance)
{
  int n = u->unknowns;
  for (int i = 0; i < n; i++) {
    struct eo_updated *p = &u->unknown[i];
    const struct eo_update_range *r = &f->settings->range[i];
    double sigma = sqrt(fmax(covariance[i * n + i], 0)), reach = STUDENT * sigma;
    *p = (struct eo_updated){.unknown = r->unknown,
                             .before = eo_unknown_get(f->design, r->unknown),
                             .value = from_unit(r, x[i]),
                             .low = r->low,
                             .high = r->high,
                             .twin = -1};
    p->confidence[0] = from_unit(r, fmax(0, x[i] - reach));
    p->confidence[1] = from_unit(r, fmin(1, x[i] + reach));
    p->at_bound = x[i] < 1e-6 || x[i] > 1 - 1e-6;
    p->undetermined = !(2 * reach < OPEN);
    for (int j = 0; j < n; j++) {
      double size = sqrt(covariance[i * n + i] * covariance[j * n + j]);
      u->correlation[i][j] = size > 0 ? covariance[i * n + j] / size : 0;
      if (j != i && fabs(u->correlation[i][j]) > fmax(TWIN, fabs(p->correlation))) {
        p->twin = j;
        p->correlation = u->correlation[i][j];
      }
    }
  }
}

/* Covariance (J'J)^-1, widened where the residuals are larger than their standard deviations say. */
static enum eo_code judge(const struct fit *f, struct eo_update *u, const double *x, const double *jacobian,
                          double square, struct eo_error *error)
{
  int n = u->unknowns;
  double matrix[EO_UNKNOWNS * EO_UNKNOWNS] = {0}, values[EO_UNKNOWNS], covariance[EO_UNKNOWNS * EO_UNKNOWNS] = {0};
  for (int i = 0; i < f->residuals; i++)
    for (int a = 0; a < n; a++)
      for (int b = 0; b < n; b++)
        matrix[a * n + b] += jacobian[i * n + a] * jacobian[i * n + b];
  if (eo_dense_symmetric_eigen(n, matrix, values))
    return eo_error_memory(error);
  double widen = fmax(1, square / (f->residuals - n)), least = fmax(values[n - 1], 1) * 1e-12;
  u->condition = values[n - 1] / fmax(values[0], least);
  for (int k = 0; k < n; k++)
    for (int a = 0; a < n; a++)
      for (int b = 0; b < n; b++)
        covariance[a * n + b] += widen * matrix[k * n + a] * matrix[k * n + b] / fmax(values[k], least);
  read_intervals(f, u, x, covariance);
  return EO_OK;
}

static enum eo_code check(const struct eo_update_settings *s, int count, int residuals, struct eo_error *error)
{
  if (s->unknowns < 1 || s->unknowns > EO_UNKNOWNS)
    return eo_error_set(error, EO_ERROR_INPUT, "/unknowns", "An update takes 1 to %d unknowns.", EO_UNKNOWNS);
  for (int i = 0; i < s->unknowns; i++) {
    const struct eo_update_range *r = &s->range[i];
    for (int j = 0; j < i; j++)
      if (s->range[j].unknown == r->unknown)
        return eo_error_set(error, EO_ERROR_INPUT, "/unknowns", "%s stands in the list twice.",
                            eo_unknown_name(r->unknown));
    if (!(r->high > r->low) || (logarithmic(r->unknown) && !(r->low > 0)))
      return eo_error_set(error, EO_ERROR_INPUT, "/unknowns", "The range of %s is empty or not positive.",
                          eo_unknown_name(r->unknown));
  }
  if (count < 1 || residuals <= s->unknowns)
    return eo_error_set(error, EO_ERROR_INPUT, "", "%d measured orders cannot determine %d unknowns.", residuals,
                        s->unknowns);
  return EO_OK;
}

static enum eo_code search(struct fit *f, struct eo_update *u, struct eo_design *updated, struct eo_error *error)
{
  int n = u->unknowns, starts = f->settings->starts > 0 ? f->settings->starts : STARTS_PER_UNKNOWN * n;
  const struct eo_least_squares_options options = {.iterations = ITERATIONS, .step = 1e-3, .tolerance = 1e-5};
  struct eo_least_squares_report report;
  double x[EO_UNKNOWNS], *residual = malloc(sizeof *residual * (size_t)(f->residuals * (n + 1))),
                         *jacobian = residual + f->residuals;
  if (!residual)
    return eo_error_memory(error);
  f->expected = starts + 6 * (n + 2);
  enum eo_code code = look_around(f, starts, x, residual, &u->before, error);
  if (!code)
    code = eo_least_squares(residuals_at, f, n, f->residuals, &options, x, jacobian, &report, error);
  if (!code)
    code = judge(f, u, x, jacobian, report.square, error);
  if (!code) {
    u->before = sqrt(u->before);
    u->after = sqrt(report.square / f->residuals);
    u->converged = report.converged;
    u->evaluations = f->evaluations;
    set_trial(f, x);
    if (updated)
      *updated = f->trial;
  }
  free(residual);
  return code;
}

enum eo_code eo_update_run(struct eo_update *update, const struct eo_pair *pair, const struct eo_design *design,
                           int count, const struct eo_measured *measured, const struct eo_update_settings *settings,
                           struct eo_design *updated, const struct eo_progress *progress, struct eo_error *error)
{
  struct fit *f = calloc(1, sizeof *f);
  *update = (struct eo_update){.unknowns = settings->unknowns, .used = count};
  if (!f)
    return eo_error_memory(error);
  f->design = design;
  f->measured = measured;
  f->settings = settings;
  f->progress = progress;
  f->pair = *pair;
  f->count = count;
  f->model_error = settings->model_error > 0 ? settings->model_error : MODEL_ERROR;
  for (int i = 0; i < count; i++)
    f->residuals += measured[i].harmonics;
  update->residuals = f->residuals;
  enum eo_code code = count > EO_MOST_MEASURED
                          ? eo_error_set(error, EO_ERROR_INPUT, "", "%d measurements are too many.", count)
                          : EO_OK;
  if (!code)
    sort_measurements(f);
  code = code ? code : check(settings, count, f->residuals, error);
  if (!code)
    code = eo_evaluator_new(&f->evaluator, &f->pair, 1, error);
  if (!code)
    code = search(f, update, updated, error);
  eo_evaluator_free(f->evaluator);
  free(f);
  return code;
}
