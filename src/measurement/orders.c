/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/orders.h"

#include <math.h>
#include <stdlib.h>

double eo_transmission_mesh(const struct eo_transmission *transmission, double phase)
{
  double sum = 0;
  for (int h = 0; h < transmission->harmonics; h++)
    sum += creal(transmission->mesh[h].amplitude * cexp(2 * M_PI * I * (h + 1) * phase));
  return sum;
}

double eo_transmission_rms(const struct eo_order_line *line, int count, double omega, double *sigma)
{
  double square = 0, variance = 0, shift[2] = {0, 0};
  for (int i = 0; i < count; i++) {
    double weight = pow(line[i].order * omega, 4) / 2, noise = line[i].sigma * line[i].sigma; /* theory (M3) */
    double signal = pow(cabs(line[i].amplitude), 2) - 2 * noise;
    square += weight * signal;
    variance += weight * weight * 4 * noise * (fmax(signal, 0) + noise);
    for (int k = 0; k < 2; k++)
      shift[k] += 2 * weight * cabs(line[i].amplitude) * line[i].systematic[k];
  }
  square = fmax(square, 0);
  double rms = sqrt(square), spread = sqrt(variance);
  double above = sqrt(square + spread) - rms, below = (rms - sqrt(fmax(0, square - 2 * spread))) / 2;
  *sigma = hypot(hypot(fmax(above, below), EO_RMS_SYSTEMATIC * rms),
                 rms > 0 ? hypot(shift[0], shift[1]) / (2 * rms) : 0);
  return rms;
}

void eo_transmission_done(struct eo_transmission *result)
{
  free(result->spectrum);
  free(result->track);
  result->spectrum = NULL;
  result->track = NULL;
}
