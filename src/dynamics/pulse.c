/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "dynamics/oscillator.h"

double eo_pulse_value(const struct eo_pulse *pulse, double frequency, double phase)
{
  double along;
  switch (pulse->shape) {
  case EO_PULSE_NONE:
    return 0;
  case EO_PULSE_HALF_SINE:
    along = phase - pulse->start;
    along -= floor(along);
    return along < pulse->duration ? pulse->amplitude * sin(M_PI * along / pulse->duration) : 0;
  case EO_PULSE_COSINE:
    return pulse->amplitude * frequency * frequency * cos(2 * M_PI * phase);
  }
  return 0;
}

/* Integral of sin(pi x / d) exp(-2 pi i k x) over 0..d; at 2 k d = 1 it is -i d / 2. */
static double complex half_sine_integral(double d, int k)
{
  double ratio = 2 * k * d;
  if (fabs(ratio - 1) < 1e-9)
    return -0.5 * d * I;
  return d / M_PI * (1 + cexp(-I * M_PI * ratio)) / (1 - ratio * ratio);
}

double complex eo_pulse_harmonic(const struct eo_pulse *pulse, double frequency, double shift, int k)
{
  switch (pulse->shape) {
  case EO_PULSE_NONE:
    return 0;
  case EO_PULSE_HALF_SINE:
    return (k ? 2 : 1) * pulse->amplitude * cexp(2 * M_PI * I * k * (shift - pulse->start)) *
           half_sine_integral(pulse->duration, k);
  case EO_PULSE_COSINE:
    return k == 1 ? pulse->amplitude * frequency * frequency * cexp(2 * M_PI * I * shift) : 0;
  }
  return 0;
}
