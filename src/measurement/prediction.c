/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/prediction.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "design/design_grids.h"

double eo_prediction_pinion_share(const struct eo_supports *supports, const struct eo_geometry *geometry)
{
  double mass[2];
  for (int i = 0; i < 2; i++)
    mass[i] = supports->inertia[i] / pow(geometry->base_radius[i], 2);
  return mass[EO_GEAR] / (mass[EO_PINION] + mass[EO_GEAR]);
}

static void read_orders(struct eo_rig_prediction *prediction, const struct eo_evaluation *evaluation,
                        const struct eo_case_result *result, int end, int teeth)
{
  double mesh = teeth * prediction->speed, square = 0, low = INFINITY, high = -INFINITY;
  for (int h = 1; h <= prediction->harmonics; h++) {
    double complex acceleration = h <= evaluation->harmonics ? result->end[end].order[EO_CHANNEL_ROTATIONAL][h] : 0;
    /* theory (M4) */
    prediction->order[h - 1] = acceleration / pow(h * mesh, 2); /* r_g phi_g - r_p phi_p is minus the reading */
    prediction->acceleration[h - 1] = cabs(acceleration);
    square += pow(cabs(acceleration), 2) / 2;
  }
  prediction->rms = sqrt(square);
  for (int i = 0; i < 512; i++) {
    double value = 0;
    for (int h = 1; h <= prediction->harmonics; h++)
      value += creal(prediction->order[h - 1] * cexp(2 * M_PI * I * h * i / 512));
    low = fmin(low, value);
    high = fmax(high, value);
  }
  prediction->peak_to_peak = high - low;
}

enum eo_code eo_prediction_run(struct eo_rig_prediction *prediction, struct eo_evaluator *evaluator,
                               const struct eo_design *design, bool unmodified, double torque, double speed, int end,
                               int harmonics, struct eo_error *error)
{
  const struct eo_evaluation *evaluation;
  struct eo_design *one = malloc(sizeof *one);
  if (!one)
    return eo_error_memory(error);
  *one = *design;
  one->load_cases = 1;
  one->load_case[0].torque = torque;
  one->load_case[0].speed = speed;
  one->load_case[0].share = 1;
  if (unmodified)
    one->modification = eo_design_unmodified(design);
  enum eo_code code = eo_evaluator_run(evaluator, one, NULL, EO_WANT_CURVES, &evaluation, error);
  if (!code) {
    const struct eo_case_result *result = &evaluation->load_case[0];
    *prediction = (struct eo_rig_prediction){.torque = torque,
                                             .speed = speed,
                                             .harmonics = harmonics,
                                             .rms = NAN,
                                             .peak_to_peak = NAN,
                                             .valid = result->vibration.outcome != EO_VIBRATION_NOT_CONVERGED};
    for (int h = 0; h < harmonics; h++)
      prediction->order[h] = prediction->acceleration[h] = NAN;
    if (prediction->valid)
      read_orders(prediction, evaluation, result, evaluation->ends == 2 ? end : EO_LEFT,
                  one->gear_pair.teeth[EO_PINION]);
  }
  free(one);
  return code;
}
