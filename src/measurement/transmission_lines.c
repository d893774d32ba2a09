/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the coefficients of the fit say of the orders, with how sure they are. */
#include "measurement/transmission_private.h"

#include <math.h>
#include <string.h>

static const double OWN_SHARE = 0.5, OWN_SIGMA = 0.29; /* of the vibration, at the pinion: 0 to 1, all alike */
static const double NOISE_KNOWN = 0.3; /* relative: noise from third differences, which is not white in every encoder */

static const int sideband_turns[EO_SIDEBANDS] = {-2, -1, 1, 2};

static struct eo_order_line line_of(const struct eo_order_fit *fit, int at)
{
  double order = fit->terms.order[at], speed = fit->result->speed;
  double complex amplitude = eo_order_fit_amplitude(fit, at);
  return (struct eo_order_line){
      .order = order, .amplitude = amplitude, .acceleration = order * order * speed * speed * cabs(amplitude)};
}

/* The axis shows the pinion's share s of the vibration f too, theta = reading + s f / r_b: what is fitted is
   f + s (f^2)' / (2 r_b). Its part at mesh order h + 1 for s = 1, m. */
static double complex own_vibration(const struct eo_order_fit *fit, int h)
{
  int orders = fit->result->harmonics;
  double complex square = 0; /* of f^2 at that order */
  for (int j = 0; j < h; j++)
    square += eo_order_fit_amplitude(fit, j) * eo_order_fit_amplitude(fit, h - 1 - j) / 2;
  for (int j = 0; j + h + 1 < orders; j++)
    square += conj(eo_order_fit_amplitude(fit, j)) * eo_order_fit_amplitude(fit, j + h + 1);
  return I * fit->terms.order[h] * square / (2 * fit->settings->base_radius[EO_PINION]);
}

/* A mesh order, what noise of the axis and values between samples take away put back; how sure that is. Only the gear's
   part of the vibration, 1 - s, is lost between the gear's samples. */
static struct eo_order_line mesh_line(const struct eo_order_fit *fit, int h)
{
  struct eo_order_line line = line_of(fit, h);
  double complex own = own_vibration(fit, h);
  const struct eo_interpolation *between = &fit->angles->interpolated;
  double in_phase = creal(own * conj(line.amplitude)) / fmax(cabs(line.amplitude), 1e-300);
  double complex lost = 1 - eo_interpolation_gain(between, line.order * fit->result->speed * between->step);
  in_phase += creal(lost) * cabs(line.amplitude);
  line.amplitude = (line.amplitude - OWN_SHARE * own) * (1 + (1 - OWN_SHARE) * lost);
  line.acceleration = pow(line.order * fit->result->speed, 2) * cabs(line.amplitude);
  double phase = line.order * fit->result->axis_noise, left = exp(-phase * phase / 2);
  line.amplitude /= left;
  line.acceleration /= left;
  line.sigma = eo_beside_sigma(&fit->beside, h, fit->result->residual) / left;
  double swing = 1 - eo_axis_loss(&fit->axis, line.order, fit->share_sigma);
  line.systematic[0] = cabs(line.amplitude) * hypot(swing, NOISE_KNOWN * (1 - left));
  line.systematic[1] = OWN_SIGMA * in_phase;
  return line;
}

static void read_sidebands(struct eo_order_fit *fit, int h)
{
  struct eo_transmission *result = fit->result;
  for (int k = 0; k < 2 * EO_SIDEBANDS; k++) {
    int member = k / EO_SIDEBANDS, at = k % EO_SIDEBANDS;
    double shaft = member == EO_GEAR ? (double)fit->settings->teeth[EO_PINION] / fit->settings->teeth[EO_GEAR] : 1;
    double order = result->mesh[h].order + shaft * sideband_turns[at];
    double complex amplitude = eo_beside_sideband(&fit->beside, h, member, sideband_turns[at]);
    result->sideband[h][member][at] =
        (struct eo_order_line){.order = order,
                               .amplitude = amplitude,
                               .sigma = result->mesh[h].sigma,
                               .acceleration = order * order * result->speed * result->speed * cabs(amplitude)};
  }
}

/* How much smaller the RMS would be on the axis as it was read. */
static double axis_bias(const struct eo_order_fit *fit)
{
  const struct eo_transmission *result = fit->result;
  double with = 0, without = 0;
  for (int h = 0; h < result->harmonics; h++) {
    double phase = result->mesh[h].order * result->axis_noise, square = pow(result->mesh[h].acceleration, 2);
    with += square;
    without += square *
               pow(eo_axis_loss(&fit->axis, result->mesh[h].order, fit->axis.share) * exp(-phase * phase / 2), 2);
  }
  return with > 0 ? 1 - sqrt(without / with) : 0;
}

void eo_order_fit_read_lines(struct eo_order_fit *fit)
{
  struct eo_transmission *result = fit->result;
  double at_most = result->residual / fit->settings->base_radius[EO_PINION]; /* what both channels share is no noise */
  result->axis_noise = fmin(eo_axis_noise_sigma(&fit->noise), at_most);
  result->axis_swing = fit->axis.share[EO_PINION] * cabs(fit->axis.swing[EO_PINION][0]);
  for (int h = 0; h < result->harmonics; h++) {
    result->mesh[h] = mesh_line(fit, h);
    result->rms_upto[h] = eo_transmission_rms(result->mesh, h + 1, result->speed, &result->rms_sigma);
    read_sidebands(fit, h);
  }
  result->axis_bias = axis_bias(fit);
  result->rms = result->harmonics ? result->rms_upto[result->harmonics - 1] : 0;
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < EO_SHAFT_ORDERS; k++) {
      result->separate[member][k] = fit->terms.shaft_at[member][k] >= 0;
      double order = (k + 1) *
                     (member == EO_GEAR ? (double)fit->settings->teeth[EO_PINION] / fit->settings->teeth[EO_GEAR] : 1);
      result->shaft[member][k] = result->separate[member][k] ? line_of(fit, fit->terms.shaft_at[member][k])
                                                             : (struct eo_order_line){.order = order};
      result->shaft[member][k].sigma = sqrt(2) * result->residual / sqrt((double)result->rows);
    }
  memcpy(result->drift, fit->coefficient, sizeof result->drift);
}
