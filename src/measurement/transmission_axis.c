/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/transmission_private.h"

#include <math.h>

static const double SWING_KNOWN = 0.3; /* standard deviation of its share up to which the sidebands settle it */
static const double SWING_PRIOR = 0.5; /* standard deviation of the share where they do not */

/* What a phase of the axis does to the mesh orders: their derivative, m/rad. */
static double mesh_slope(const struct eo_fit *fit, double theta)
{
  double complex mesh = cexp(I * fit->settings->teeth[EO_PINION] * theta), power = 1, sum = 0;
  for (int h = 0; h < fit->result->harmonics; h++)
    sum += I * fit->terms.order[h] * eo_fit_amplitude(fit, h) * (power *= mesh);
  return creal(sum);
}

/* The fit of the share: what is left of the transmission error against what the swing would do to the mesh orders. */
static enum eo_code add_swing(struct eo_fit *fit, const double row[3], int64_t index, struct eo_error *error)
{
  double theta = eo_axis_angle(&fit->axis, row[1]), part[3];
  (void)index;
  (void)error;
  if (theta < fit->from || theta > fit->to)
    return EO_OK;
  eo_fit_parts(fit, row, theta, part);
  double residual = eo_fit_error(fit, row) - part[0] - part[1] - part[2];
  double effect = mesh_slope(fit, theta) * eo_axis_swing(&fit->axis, theta);
  fit->swing_sums[0] += residual * effect;
  fit->swing_sums[1] += effect * effect;
  eo_beside_add(&fit->beside, theta, residual);
  return EO_OK;
}

/* Shaft orders of the pinion in the transmission error come from its encoder, and then the axis has them too, or from
   the gears, and then it has not. The sidebands of the mesh orders tell: with the wrong axis the swing e leaves
   (d TE / d theta) e in the residual. Where they are too weak the encoder is taken for the cause, and what that changes
   is part of the uncertainty. */
enum eo_code eo_fit_settle_axis(struct eo_fit *fit, struct eo_error *error)
{
  struct eo_axis *axis = &fit->axis;
  for (int k = 0; k < EO_SHAFT_ORDERS; k++)
    axis->swing[k] = fit->terms.shaft_at[EO_PINION][k] < 0 ? 0
                                                           : -eo_fit_amplitude(fit, fit->terms.shaft_at[EO_PINION][k]) /
                                                                 fit->settings->base_radius[EO_PINION];
  axis->share = 1;
  enum eo_code code = eo_fit_solve(fit, error);
  if (!code)
    code = eo_fit_each_row(fit, add_swing, "axis", error);
  if (code)
    return code;
  double noise = 0, wanted = 0;
  for (int h = 0; h < fit->result->harmonics; h++) { /* of a row, from the noise beside the strongest orders */
    double weight = pow(fit->terms.order[h] * cabs(eo_fit_amplitude(fit, h)), 2);
    noise += weight * pow(eo_beside_sigma(&fit->beside, h, 0), 2) * (double)fit->result->rows / 2;
    wanted += weight;
  }
  double sigma = wanted > 0 && fit->swing_sums[1] > 0 ? sqrt(noise / wanted / fit->swing_sums[1]) : INFINITY;
  fit->share_sigma = SWING_PRIOR;
  if (!(sigma < SWING_KNOWN))
    return EO_OK;
  double off = fit->swing_sums[0] / fit->swing_sums[1];
  fit->share_sigma = sigma;
  if (off < 3 * sigma)
    return EO_OK;
  axis->share = fmax(0, 1 - off);
  return eo_fit_solve(fit, error);
}
