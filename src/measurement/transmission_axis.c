/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/transmission_private.h"

#include <math.h>

static const double SWING_KNOWN = 0.3; /* standard deviation of its share up to which the sidebands settle it */
static const double SWING_PRIOR = 0.5; /* standard deviation of the share where they do not */
static const double SURE = 3;          /* standard deviations by which a share must differ to be believed */

/* What a phase of the axis does to the mesh orders: their derivative, m/rad. */
static double mesh_slope(const struct eo_order_fit *fit, double theta)
{
  double complex mesh = cexp(I * fit->settings->teeth[EO_PINION] * theta), power = 1, sum = 0;
  for (int h = 0; h < fit->result->harmonics; h++)
    sum += I * fit->terms.order[h] * eo_order_fit_amplitude(fit, h) * (power *= mesh);
  return creal(sum);
}

/* The fit of the share: what is left of the transmission error against what the swing would do to the mesh orders. */
static enum eo_code add_swing(struct eo_order_fit *fit, const double row[3], int64_t index, struct eo_error *error)
{
  double theta, part[3], residual;
  (void)index;
  (void)error;
  if (!eo_order_fit_residual(fit, row, &theta, part, &residual))
    return EO_OK;
  double slope = mesh_slope(fit, theta);
  for (int member = 0; member < 2; member++) {
    double effect = slope * eo_axis_swing(&fit->axis, member, theta);
    fit->swing_sums[member][0] += residual * effect;
    fit->swing_sums[member][1] += effect * effect;
  }
  eo_beside_add(&fit->beside, theta, residual);
  return EO_OK;
}

/* The swings: shaft orders of the transmission error, as angles of the pinion. */
static void find_swings(struct eo_order_fit *fit)
{
  struct eo_axis *axis = &fit->axis;
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < EO_SHAFT_ORDERS; k++) {
      int at = fit->terms.shaft_at[member][k];
      axis->swing[member][k] = at < 0 ? 0 : -eo_order_fit_amplitude(fit, at) / fit->settings->base_radius[EO_PINION];
    }
}

/* Variance of a row's noise, from that beside the orders which feel a swing most. */
static double noise_of_rows(const struct eo_order_fit *fit)
{
  double noise = 0, wanted = 0;
  for (int h = 0; h < fit->result->harmonics; h++) {
    double weight = pow(fit->terms.order[h] * cabs(eo_order_fit_amplitude(fit, h)), 2);
    noise += weight * pow(eo_beside_sigma(&fit->beside, h, 0), 2) * (double)fit->result->rows / 2;
    wanted += weight;
  }
  return wanted > 0 ? noise / wanted : INFINITY;
}

/* The share of one shaft's swing by the least squares of what was left; true when it is clearly another one. */
static bool settle_share(struct eo_order_fit *fit, int member, double noise)
{
  const double *sums = fit->swing_sums[member];
  double sigma = sums[1] > 0 ? sqrt(noise / sums[1]) : INFINITY;
  fit->share_sigma[member] = SWING_PRIOR;
  if (!(sigma < SWING_KNOWN))
    return false;
  double off = sums[0] / sums[1], share = fmin(fmax(fit->axis.share[member] - off, 0), 1);
  bool other = fabs(share - fit->axis.share[member]) > SURE * sigma;
  fit->share_sigma[member] = sigma;
  if (other)
    fit->axis.share[member] = share;
  return other;
}

/* Shaft orders in the transmission error come from an encoder or from the gears. Those of the pinion's encoder the axis
   has too; run-out of the gears turns the shafts, and the axis has the part that the pinion follows. The sidebands of
   the mesh orders tell: with the wrong axis the swing e leaves (d TE / d theta) e in the residual. Where they are too
   weak the encoders are taken for the cause, and what that changes is part of the uncertainty. */
enum eo_code eo_order_fit_settle_axis(struct eo_order_fit *fit, struct eo_error *error)
{
  find_swings(fit);
  fit->axis.share[EO_PINION] = 1;
  enum eo_code code = eo_order_fit_solve(fit, error);
  if (!code)
    code = eo_order_fit_each_row(fit, add_swing, "axis", error);
  if (code)
    return code;
  double noise = noise_of_rows(fit);
  bool pinion = settle_share(fit, EO_PINION, noise), gear = settle_share(fit, EO_GEAR, noise);
  return pinion || gear ? eo_order_fit_solve(fit, error) : EO_OK;
}
