/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/comparison.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"

static const double SAME_TORQUE = 0.01, SAME_SPEED = 0.02;
static const double FAR = 3.5;        /* robust standard deviations (Iglewicz and Hoaglin 1993) */
static const double LEAST_FAR = 0.25; /* of log(ratio): nearer is no outlier whatever the spread */

void eo_measured_take(struct eo_measured *measured, const struct eo_transmission *transmission,
                      const struct eo_findings *findings)
{
  measured->speed = transmission->speed;
  measured->harmonics = transmission->harmonics;
  memcpy(measured->order, transmission->mesh, sizeof measured->order);
  measured->rms = transmission->rms;
  measured->rms_sigma = transmission->rms_sigma;
  measured->warnings = 0;
  for (int i = 0; i < findings->count && i < EO_MAX_FINDINGS; i++)
    measured->warnings += findings->finding[i].severity >= EO_SEVERITY_WARNING;
}

static double likeness_at(const struct eo_measured *measured, const struct eo_rig_prediction *prediction, double shift)
{
  double sum = 0, size[2] = {0, 0};
  int harmonics = measured->harmonics < prediction->harmonics ? measured->harmonics : prediction->harmonics;
  for (int h = 1; h <= harmonics; h++) {
    sum += creal(conj(measured->order[h - 1].amplitude) * prediction->order[h - 1] *
                 cexp(2 * M_PI * I * h * shift)); /* theory (M5) */
    size[0] += pow(cabs(measured->order[h - 1].amplitude), 2);
    size[1] += pow(cabs(prediction->order[h - 1]), 2);
  }
  return size[0] > 0 && size[1] > 0 ? sum / sqrt(size[0] * size[1]) : 0;
}

static void align(const struct eo_measured *measured, struct eo_compared *compared)
{
  enum { STEPS = 512 };
  double width = 1.0 / STEPS;
  compared->likeness = -2;
  for (int i = 0; i < STEPS; i++) {
    double likeness = likeness_at(measured, &compared->prediction, i * width);
    if (likeness > compared->likeness) {
      compared->likeness = likeness;
      compared->shift = i * width;
    }
  }
  for (; width > 1e-7; width /= 2)
    for (int side = -1; side <= 1; side += 2) {
      double likeness = likeness_at(measured, &compared->prediction, compared->shift + side * width);
      if (likeness > compared->likeness) {
        compared->likeness = likeness;
        compared->shift += side * width;
      }
    }
  compared->shift -= floor(compared->shift);
}

void eo_comparison_curves(const struct eo_measured *measured, const struct eo_compared *compared, int count,
                          double *measured_curve, double *predicted_curve)
{
  for (int i = 0; i < count; i++) {
    double phase = (double)i / count;
    measured_curve[i] = predicted_curve[i] = 0;
    for (int h = 1; h <= measured->harmonics; h++)
      measured_curve[i] += creal(measured->order[h - 1].amplitude * cexp(2 * M_PI * I * h * phase));
    for (int h = 1; h <= compared->prediction.harmonics; h++)
      predicted_curve[i] +=
          creal(compared->prediction.order[h - 1] * cexp(2 * M_PI * I * h * (phase + compared->shift)));
  }
}

static double median(double *value, int count)
{
  eo_sort_numbers(count, value);
  return count ? (value[(count - 1) / 2] + value[count / 2]) / 2 : NAN;
}

static bool same_point(const struct eo_measured *a, const struct eo_measured *b)
{
  return a->end == b->end && fabs(a->torque / b->torque - 1) < SAME_TORQUE &&
         fabs(a->speed / b->speed - 1) < SAME_SPEED;
}

static enum eo_code find_ratios(struct eo_comparison *comparison, struct eo_error *error)
{
  double *value = malloc(sizeof *value * (size_t)(comparison->count + 1));
  int n = 0;
  comparison->ratio = comparison->spread = NAN;
  if (!value)
    return eo_error_memory(error);
  for (int i = 0; i < comparison->count; i++)
    if (comparison->point[i].ratio > 0)
      value[n++] = log(comparison->point[i].ratio);
  double middle = median(value, n);
  for (int i = 0; i < n; i++)
    value[i] = fabs(value[i] - middle);
  comparison->ratio = exp(middle);
  comparison->spread = n > 2 ? 1.4826 * median(value, n) : NAN;
  free(value);
  return EO_OK;
}

/* Repeats of the same point that disagree by more than their uncertainty allows. */
static double nearest_repeat(const struct eo_measured *measured, int count, int at)
{
  double nearest = INFINITY;
  for (int i = 0; i < count; i++)
    if (i != at && measured[i].unmodified == measured[at].unmodified && same_point(&measured[i], &measured[at]))
      nearest = fmin(nearest, fabs(measured[i].rms - measured[at].rms) /
                                  fmax(hypot(measured[i].rms_sigma, measured[at].rms_sigma), 0.05 * measured[at].rms));
  return nearest;
}

static void judge_point(struct eo_comparison *comparison, const struct eo_measured *measured, int at)
{
  struct eo_compared *compared = &comparison->point[at];
  double off = fabs(log(compared->ratio / comparison->ratio)), repeat = nearest_repeat(measured, comparison->count, at);
  if (comparison->count >= 4 && isfinite(off) && off > LEAST_FAR && off > FAR * comparison->spread)
    snprintf(compared->reason, sizeof compared->reason,
             "Its RMS is %.3g times the prediction, that of the others about %.3g times.", compared->ratio,
             comparison->ratio);
  else if (isfinite(repeat) && repeat > 4)
    snprintf(compared->reason, sizeof compared->reason,
             "No other recording at this torque and speed comes near its RMS of %.4g m/s2.", measured[at].rms);
  compared->outlier = *compared->reason != 0;
  if (compared->outlier && measured[at].warnings)
    snprintf(compared->reason + strlen(compared->reason), sizeof compared->reason - strlen(compared->reason),
             " The recording itself carries %d warnings.", measured[at].warnings);
}

static bool reduce(const struct eo_comparison *comparison, const struct eo_measured *measured, int at,
                   struct eo_reduction *reduction)
{
  double rms = 0, variance = 0, predicted = 0;
  *reduction = (struct eo_reduction){.modified = at, .torque = measured[at].torque, .speed = measured[at].speed};
  for (int i = 0; i < comparison->count; i++)
    if (measured[i].unmodified && same_point(&measured[i], &measured[at])) {
      reduction->unmodified++;
      rms += measured[i].rms;
      variance += measured[i].rms_sigma * measured[i].rms_sigma;
      predicted += comparison->point[i].prediction.rms;
    }
  if (!reduction->unmodified || measured[at].unmodified)
    return false;
  rms /= reduction->unmodified;
  reduction->measured = 1 - measured[at].rms / rms;
  reduction->measured_sigma = hypot(measured[at].rms_sigma / rms,
                                    measured[at].rms / (rms * rms) * sqrt(variance) / reduction->unmodified);
  reduction->predicted = 1 - comparison->point[at].prediction.rms / (predicted / reduction->unmodified);
  return true;
}

enum eo_code eo_comparison_run(struct eo_comparison *comparison, struct eo_evaluator *evaluator,
                               const struct eo_design *design, int count, const struct eo_measured *measured,
                               const struct eo_progress *progress, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  *comparison = (struct eo_comparison){.count = count};
  if (count < 0 || count > EO_MOST_MEASURED)
    return eo_error_set(error, EO_ERROR_INPUT, "", "%d measurements are more than the %d that are compared at once.",
                        count, EO_MOST_MEASURED);
  comparison->point = calloc((size_t)count + 1, sizeof *comparison->point);
  comparison->reduction = calloc((size_t)count + 1, sizeof *comparison->reduction);
  if (!comparison->point || !comparison->reduction)
    return eo_error_memory(error);
  for (int i = 0; i < count && !code; i++) {
    const struct eo_measured *this_measured = &measured[i];
    struct eo_compared *compared = &comparison->point[i];
    if (eo_progress_report(progress, "predictions", (double)i / count))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    code = eo_prediction_run(&compared->prediction, evaluator, design, this_measured->unmodified, this_measured->torque,
                             this_measured->speed, this_measured->end, this_measured->harmonics, error);
    compared->ratio = compared->likeness = compared->shift = NAN;
    if (!code && compared->prediction.valid) {
      compared->ratio = this_measured->rms / compared->prediction.rms;
      align(this_measured, compared);
    }
  }
  if (!code)
    code = find_ratios(comparison, error);
  if (code)
    return code;
  for (int i = 0; i < count; i++) {
    judge_point(comparison, measured, i);
    comparison->reductions += reduce(comparison, measured, i, &comparison->reduction[comparison->reductions]);
  }
  return EO_OK;
}

void eo_comparison_done(struct eo_comparison *comparison)
{
  free(comparison->point);
  free(comparison->reduction);
  *comparison = (struct eo_comparison){0};
}
