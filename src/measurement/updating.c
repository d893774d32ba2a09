/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/updating_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/dense.h"

static const double FIRST_MODEL_ERROR = 0.05; /* of the search, before the misfit tells */
static const double LEAST_MODEL_ERROR = 1e-4; /* no model of a gear pair is better */
static const double POOR = 0.2; /* model error that the misfit would need: beyond, the inputs do not explain the data */
static const double TWIN = 0.95, OPEN = 0.5;
enum { ROUNDS = 3 }; /* of the model error with the minima */

#define KEY(name, key) key,
const char *const eo_unknown_names[EO_UNKNOWNS + 1] = {EO_UNKNOWN_INPUTS(KEY) NULL};

const char *eo_unknown_name(enum eo_unknown unknown)
{
  return eo_unknown_names[unknown];
}

static double *member_of(struct eo_design *design, enum eo_unknown unknown)
{
  switch (unknown) {
  case EO_UNKNOWN_PINION_BEARING:
    return &design->supports.bearing_stiffness[EO_PINION];
  case EO_UNKNOWN_GEAR_BEARING:
    return &design->supports.bearing_stiffness[EO_GEAR];
  case EO_UNKNOWN_MESH_DAMPING:
    return &design->supports.mesh_damping_ratio;
  case EO_UNKNOWN_GEAR_AXIAL:
    return &design->supports.gear_axial_stiffness[EO_LEFT];
  case EO_UNKNOWN_PINION_AXIAL:
    return &design->alignment.pinion_axial_stiffness;
  case EO_UNKNOWN_IN_PLANE:
    return &design->alignment.shaft_angle_in_plane;
  case EO_UNKNOWN_OUT_OF_PLANE:
    return &design->alignment.shaft_angle_out_of_plane;
  case EO_UNKNOWN_IMPACT_PATCH:
  case EO_UNKNOWNS:
    break;
  }
  return &design->resolution.impact_patch;
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

double eo_fit_from_unit(const struct eo_update_range *range, double x)
{
  return logarithmic(range->unknown) ? range->low * pow(range->high / range->low, x)
                                     : range->low + x * (range->high - range->low);
}

double eo_fit_to_unit(const struct eo_update_range *range, double value)
{
  double x = logarithmic(range->unknown) ? log(value / range->low) / log(range->high / range->low)
                                         : (value - range->low) / (range->high - range->low);
  return fmin(1, fmax(0, x));
}

void eo_fit_begin(struct eo_fit *fit, const char *stage, double from, double to, int expected)
{
  fit->stage = stage;
  fit->from = from;
  fit->to = to;
  fit->begun = fit->evaluations;
  fit->expected = expected > 0 ? expected : 1;
}

void eo_fit_set_trial(struct eo_fit *fit, const double *x)
{
  fit->trial = *fit->design;
  for (int i = 0; i < fit->settings->unknowns; i++)
    eo_unknown_set(&fit->trial, fit->settings->range[i].unknown, eo_fit_from_unit(&fit->settings->range[i], x[i]));
  fit->pair.impact.patch = fit->pair.resolution.impact_patch = fit->trial.resolution.impact_patch;
}

/* Variance of an order's acceleration from the recording alone. */
static double noise_variance(const struct eo_measured *measured, int h)
{
  double noise = measured->order[h].sigma * pow(measured->order[h].order * measured->speed, 2);
  return noise * noise + pow(EO_RMS_SYSTEMATIC * measured->order[h].acceleration, 2);
}

/* (measured - predicted) / standard deviation of each order's acceleration. */
static void weigh(const struct eo_fit *fit, double *residual)
{
  for (int i = 0, at = 0; i < fit->count; i++) {
    const struct eo_measured *measured = &fit->measured[fit->order[i]];
    for (int h = 0; h < measured->harmonics; h++, at++)
      residual[at] = (measured->order[h].acceleration - fit->predicted[at]) /
                     sqrt(noise_variance(measured, h) + pow(fit->model_error * measured->rms, 2));
  }
}

enum eo_code eo_fit_residuals(void *context, const double *x, double *residual, struct eo_error *error)
{
  struct eo_fit *fit = context;
  struct eo_rig_prediction prediction;
  double done = fmin(1, (double)(fit->evaluations - fit->begun) / fit->expected), *predicted = fit->predicted;
  eo_fit_set_trial(fit, x);
  fit->evaluations++;
  if (eo_progress_report(fit->progress, fit->stage, fit->from + done * (fit->to - fit->from)))
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
  for (int i = 0; i < fit->count; i++) {
    const struct eo_measured *measured = &fit->measured[fit->order[i]];
    enum eo_code code = eo_prediction_run(&prediction, fit->evaluator[fit->with[i]], &fit->trial, measured->unmodified,
                                          measured->torque, measured->speed, measured->end, measured->harmonics, error);
    if (code)
      return code;
    for (int h = 0; h < measured->harmonics; h++) /* a state that is not found counts as none at all */
      *predicted++ = prediction.valid ? prediction.acceleration[h] : 0;
  }
  weigh(fit, residual);
  return EO_OK;
}

static void sort_measurements(struct eo_fit *fit)
{
  for (int i = 0; i < fit->count; i++) {
    const struct eo_measured *measured = &fit->measured[i];
    int at = i;
    for (; at > 0; at--) {
      const struct eo_measured *before = &fit->measured[fit->order[at - 1]];
      if (before->unmodified < measured->unmodified ||
          (before->unmodified == measured->unmodified && before->torque <= measured->torque))
        break;
      fit->order[at] = fit->order[at - 1];
    }
    fit->order[at] = i;
  }
}

/* An evaluator for each label and torque, in turns where there are many. */
static enum eo_code make_evaluators(struct eo_fit *fit, struct eo_error *error)
{
  int group = 0;
  enum eo_code code = EO_OK;
  for (int i = 0; i < fit->count && !code; i++) {
    const struct eo_measured *measured = &fit->measured[fit->order[i]],
                             *before = &fit->measured[fit->order[i ? i - 1 : 0]];
    group += measured->unmodified != before->unmodified || measured->torque != before->torque;
    fit->with[i] = group % EO_FIT_EVALUATORS;
    if (fit->with[i] == fit->evaluators)
      code = eo_evaluator_new(&fit->evaluator[fit->evaluators++], &fit->pair, 1, error);
  }
  return code;
}

/* The model error with which the squares of the best fit come out as large as they should, one for each order beyond
   the unknowns; by halving, its square grows the sum's denominators. */
static enum eo_code find_model_error(struct eo_fit *fit, const double *x, double *residual, struct eo_error *error)
{
  double low = LEAST_MODEL_ERROR, high = 1;
  enum eo_code code = eo_fit_residuals(fit, x, residual, error);
  for (int i = 0; i < 40 && !code; i++) {
    fit->model_error = sqrt(low * high);
    weigh(fit, residual);
    *(eo_dot(fit->residuals, residual, residual) > fit->residuals - fit->settings->unknowns ? &low
                                                                                            : &high) = fit->model_error;
  }
  return code;
}

/* The two-sided 95 % quantile of Student's distribution, by its series in 1 / freedom (Fisher and Cornish 1960); to
   1e-2 from three degrees on. */
static double student(int freedom)
{
  double z = 1.959964, v = freedom;
  return z + (pow(z, 3) + z) / (4 * v) + (5 * pow(z, 5) + 16 * pow(z, 3) + 3 * z) / (96 * v * v) +
         (3 * pow(z, 7) + 19 * pow(z, 5) + 17 * pow(z, 3) - 15 * z) / (384 * v * v * v);
}

/* Covariance (J'J)^-1 at the best values, with differences of a thousandth of the ranges. */
static enum eo_code find_covariance(struct eo_fit *fit, struct eo_update *update, const double *x, double *covariance,
                                    double *room, struct eo_error *error)
{
  int n = update->unknowns, m = fit->residuals;
  double matrix[EO_UNKNOWNS * EO_UNKNOWNS] = {0}, values[EO_UNKNOWNS], moved[EO_UNKNOWNS], *here = room;
  enum eo_code code = eo_fit_residuals(fit, x, here, error);
  for (int j = 0; j < n && !code; j++) {
    double step = x[j] < 0.5 ? 2e-4 : -2e-4, *there = room + (size_t)(j + 1) * (size_t)m;
    memcpy(moved, x, sizeof moved);
    moved[j] += step;
    code = eo_fit_residuals(fit, moved, there, error);
    for (int i = 0; i < m && !code; i++)
      there[i] = (there[i] - here[i]) / step;
  }
  if (code)
    return code;
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++)
      for (int i = 0; i < m; i++)
        matrix[a * n + b] += room[(size_t)(a + 1) * (size_t)m + (size_t)i] *
                             room[(size_t)(b + 1) * (size_t)m + (size_t)i];
  if (eo_dense_symmetric_eigen(n, matrix, values))
    return eo_error_memory(error);
  double least = fmax(values[n - 1], 1) * 1e-12;
  update->condition = values[n - 1] / fmax(values[0], least);
  for (int i = 0; i < n * n; i++)
    covariance[i] = 0;
  for (int k = 0; k < n; k++)
    for (int a = 0; a < n; a++)
      for (int b = 0; b < n; b++)
        covariance[a * n + b] += matrix[k * n + a] * matrix[k * n + b] / fmax(values[k], least);
  return EO_OK;
}

static void read_twins(struct eo_update *update, const double *covariance)
{
  int n = update->unknowns;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      struct eo_updated *updated = &update->unknown[i];
      double size = sqrt(covariance[i * n + i] * covariance[j * n + j]);
      update->correlation[i][j] = size > 0 ? covariance[i * n + j] / size : 0;
      if (j != i && fabs(update->correlation[i][j]) > fmax(TWIN, fabs(updated->correlation))) {
        updated->twin = j;
        updated->correlation = update->correlation[i][j];
      }
    }
}

/* One minimum in the units of the inputs; within reach, with the profile of every input. */
static enum eo_code read_minimum(struct eo_fit *fit, struct eo_update *update, const struct eo_minimum *minimum,
                                 double limit, const double *covariance, double hull[][2], struct eo_error *error)
{
  struct eo_update_minimum *out = &update->minimum[update->minima++];
  *out = (struct eo_update_minimum){.misfit = sqrt(minimum->square / fit->residuals),
                                    .within = minimum->square <= limit};
  enum eo_code code = EO_OK;
  update->within += out->within;
  for (int i = 0; i < update->unknowns && !code; i++) {
    double reach[2] = {minimum->x[i], minimum->x[i]}, sigma = sqrt(covariance[i * update->unknowns + i]);
    if (out->within)
      code = eo_fit_profile(fit, minimum, i, sigma, limit, reach, error);
    out->value[i] = eo_fit_from_unit(&fit->settings->range[i], minimum->x[i]);
    for (int side = 0; side < 2; side++)
      out->confidence[i][side] = eo_fit_from_unit(&fit->settings->range[i], reach[side]);
    if (out->within) {
      hull[i][0] = fmin(hull[i][0], reach[0]);
      hull[i][1] = fmax(hull[i][1], reach[1]);
    }
  }
  return code;
}

static void read_unknowns(const struct eo_fit *fit, struct eo_update *update, const double *x, double hull[][2])
{
  for (int i = 0; i < update->unknowns; i++) {
    const struct eo_update_range *range = &fit->settings->range[i];
    update->unknown[i] =
        (struct eo_updated){.unknown = range->unknown,
                            .before = eo_unknown_get(fit->design, range->unknown),
                            .value = eo_fit_from_unit(range, x[i]),
                            .low = range->low,
                            .high = range->high,
                            .confidence = {eo_fit_from_unit(range, hull[i][0]), eo_fit_from_unit(range, hull[i][1])},
                            .at_bound = x[i] < 1e-6 || x[i] > 1 - 1e-6,
                            .undetermined = !(hull[i][1] - hull[i][0] < OPEN),
                            .twin = -1};
  }
}

/* The sum of squares up to which values are not ruled out: the best one plus the square of Student's quantile, in units
   of what the fit leaves where that is more than the standard deviations say. */
static enum eo_code judge(struct eo_fit *fit, struct eo_update *update, const struct eo_minima *minima, double *room,
                          struct eo_error *error)
{
  int freedom = fit->residuals - update->unknowns;
  double covariance[EO_UNKNOWNS * EO_UNKNOWNS], hull[EO_UNKNOWNS][2];
  double widen = fmax(1, minima->minimum[0].square / freedom),
         limit = minima->minimum[0].square + widen * pow(student(freedom > 2 ? freedom : 3), 2);
  const double *x = minima->minimum[0].x;
  enum eo_code code = find_covariance(fit, update, x, covariance, room, error);
  for (int i = 0; i < update->unknowns; i++)
    hull[i][0] = hull[i][1] = x[i];
  int reachable = 0;
  for (int i = 0; i < minima->count; i++)
    reachable += minima->minimum[i].square <= limit;
  eo_fit_begin(fit, "fit: how sure", 0.7, 1,
               reachable * update->unknowns * 40 * (update->unknowns > 1 ? 3 * update->unknowns : 1));
  for (int i = 0; i < minima->count && !code; i++)
    code = read_minimum(fit, update, &minima->minimum[i], limit, covariance, hull, error);
  read_unknowns(fit, update, x, hull);
  read_twins(update, covariance);
  return code;
}

static enum eo_code check(const struct eo_update_settings *settings, int count, int residuals, struct eo_error *error)
{
  if (settings->unknowns < 1 || settings->unknowns > EO_UNKNOWNS)
    return eo_error_set(error, EO_ERROR_INPUT, "/unknowns", "An update takes 1 to %d unknowns.", EO_UNKNOWNS);
  for (int i = 0; i < settings->unknowns; i++) {
    const struct eo_update_range *range = &settings->range[i];
    for (int j = 0; j < i; j++)
      if (settings->range[j].unknown == range->unknown)
        return eo_error_set(error, EO_ERROR_INPUT, "/unknowns", "%s stands in the list twice.",
                            eo_unknown_name(range->unknown));
    if (!(range->high > range->low) || (logarithmic(range->unknown) && !(range->low > 0)))
      return eo_error_set(error, EO_ERROR_INPUT, "/unknowns", "The range of %s is empty or not positive.",
                          eo_unknown_name(range->unknown));
  }
  if (count < 1 || residuals <= settings->unknowns)
    return eo_error_set(error, EO_ERROR_INPUT, "", "%d measured orders cannot determine %d unknowns.", residuals,
                        settings->unknowns);
  return EO_OK;
}

static int usual_starts(int unknowns)
{
  return unknowns == 1 ? 96 : unknowns == 2 ? 384 : 768;
}

/* The model error and the minima belong to each other: the one that leaves least says how good the model is. */
static enum eo_code settle(struct eo_fit *fit, struct eo_minima *minima, double *room, struct eo_error *error)
{
  if (fit->settings->model_error > 0)
    return EO_OK;
  eo_fit_begin(fit, "fit: how good the model is", 0.6, 0.7, ROUNDS * minima->count * 3 * (fit->settings->unknowns + 1));
  for (int i = 0; i < ROUNDS; i++) {
    EO_TRY(find_model_error(fit, minima->minimum[0].x, room, error));
    EO_TRY(eo_fit_refine(fit, minima, error));
  }
  return EO_OK;
}

static enum eo_code find_and_judge(struct eo_fit *fit, struct eo_update *update, struct eo_minima *minima, double *room,
                                   struct eo_error *error)
{
  double start[EO_UNKNOWNS];
  int n = update->unknowns, starts = fit->settings->starts > 0 ? fit->settings->starts : usual_starts(n);
  EO_TRY(eo_fit_search(fit, starts, minima, &update->before, error));
  EO_TRY(settle(fit, minima, room, error));
  for (int i = 0; i < n; i++)
    start[i] = eo_fit_to_unit(&fit->settings->range[i], eo_unknown_get(fit->design, fit->settings->range[i].unknown));
  EO_TRY(eo_fit_residuals(fit, start, room, error));
  update->before = sqrt(eo_dot(fit->residuals, room, room) / fit->residuals);
  update->after = sqrt(minima->minimum[0].square / fit->residuals);
  update->model_error = fit->model_error;
  update->converged = minima->minimum[0].converged;
  EO_TRY(judge(fit, update, minima, room, error));
  double spent = fit->settings->model_error > 0 ? update->after * fit->model_error : fit->model_error;
  update->poor = spent > POOR;
  update->evaluations = fit->evaluations;
  return EO_OK;
}

static enum eo_code search(struct eo_fit *fit, struct eo_update *update, struct eo_design *updated,
                           struct eo_error *error)
{
  struct eo_minima *minima = malloc(sizeof *minima);
  double *room = malloc(sizeof *room * (size_t)(fit->residuals * (update->unknowns + 1)));
  enum eo_code code = minima && room ? find_and_judge(fit, update, minima, room, error) : eo_error_memory(error);
  if (!code)
    eo_fit_set_trial(fit, minima->minimum[0].x);
  if (!code && updated)
    *updated = fit->trial;
  free(minima);
  free(room);
  return code;
}

static enum eo_code run(struct eo_fit *fit, struct eo_update *update, struct eo_design *updated, struct eo_error *error)
{
  if (fit->count > EO_MOST_MEASURED)
    return eo_error_set(error, EO_ERROR_INPUT, "", "%d measurements are too many.", fit->count);
  sort_measurements(fit);
  EO_TRY(check(fit->settings, fit->count, fit->residuals, error));
  fit->predicted = calloc((size_t)fit->residuals, sizeof *fit->predicted);
  if (!fit->predicted)
    return eo_error_memory(error);
  EO_TRY(make_evaluators(fit, error));
  return search(fit, update, updated, error);
}

enum eo_code eo_update_run(struct eo_update *update, const struct eo_pair *pair, const struct eo_design *design,
                           int count, const struct eo_measured *measured, const struct eo_update_settings *settings,
                           struct eo_design *updated, const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_fit *fit = calloc(1, sizeof *fit);
  *update = (struct eo_update){.unknowns = settings->unknowns, .used = count};
  if (!fit)
    return eo_error_memory(error);
  fit->design = design;
  fit->measured = measured;
  fit->settings = settings;
  fit->progress = progress;
  fit->pair = *pair;
  fit->count = count;
  fit->model_error = settings->model_error > 0 ? settings->model_error : FIRST_MODEL_ERROR;
  for (int i = 0; i < count; i++)
    fit->residuals += measured[i].harmonics;
  update->residuals = fit->residuals;
  enum eo_code code = run(fit, update, updated, error);
  for (int i = 0; i < fit->evaluators; i++)
    eo_evaluator_free(fit->evaluator[i]);
  free(fit->predicted);
  free(fit);
  return code;
}
