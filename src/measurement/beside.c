/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/beside.h"

#include <math.h>
#include <stdlib.h>

#include "base/sort.h"

enum { SIDEBANDS = 2 }; /* whole turns that count as such */
static const double REPEATS =
    2.5; /* times the power between the orders: the median of a dozen reaches it by chance in 1 % */

void eo_beside_init(struct eo_beside *beside, const int teeth[2], int harmonics, double turns)
{
  *beside = (struct eo_beside){.harmonics = harmonics,
                               .teeth = teeth[EO_PINION],
                               .gear = (double)teeth[EO_PINION] / teeth[EO_GEAR],
                               .turns = turns};
}

/* Places of the phasors: below, then above, in each of the three families. */
static int bin_at(int side, int bin)
{
  return side * EO_BESIDE_BINS + bin;
}
static int turn_at(int member, int side, int turn)
{
  return 2 * EO_BESIDE_BINS + (2 * member + side) * EO_BESIDE_TURNS + turn - 1;
}

static void put_powers(double complex step, double complex start, int count, double *real, double *imaginary)
{
  double complex power = start;
  for (int i = 0; i < count; i++) {
    power *= step;
    real[i] = creal(power);
    imaginary[i] = cimag(power);
  }
}

/* exp(-i offset theta) of every offset above; those below are their conjugates. */
static void find_phasors(const struct eo_beside *beside, double theta, double *real, double *imaginary)
{
  double complex bin = cexp(-I * theta / beside->turns);
  put_powers(bin, bin, EO_BESIDE_BINS, real + bin_at(1, 0), imaginary + bin_at(1, 0));
  put_powers(cexp(-I * theta), 1, EO_BESIDE_TURNS, real + turn_at(EO_PINION, 1, 1),
             imaginary + turn_at(EO_PINION, 1, 1));
  put_powers(cexp(-I * theta * beside->gear), 1, EO_BESIDE_TURNS, real + turn_at(EO_GEAR, 1, 1),
             imaginary + turn_at(EO_GEAR, 1, 1));
  for (int i = 0; i < EO_BESIDE_BINS; i++) {
    real[bin_at(0, i)] = real[bin_at(1, i)];
    imaginary[bin_at(0, i)] = -imaginary[bin_at(1, i)];
  }
  for (int member = 0; member < 2; member++)
    for (int i = 1; i <= EO_BESIDE_TURNS; i++) {
      real[turn_at(member, 0, i)] = real[turn_at(member, 1, i)];
      imaginary[turn_at(member, 0, i)] = -imaginary[turn_at(member, 1, i)];
    }
}

void eo_beside_add(struct eo_beside *beside, double theta, double residual)
{
  double real[EO_BESIDE_PHASORS], imaginary[EO_BESIDE_PHASORS];
  double complex unit = cexp(-I * beside->teeth * theta), mesh = residual;
  find_phasors(beside, theta, real, imaginary);
  for (int h = 0; h < beside->harmonics; h++) {
    mesh *= unit;
    double x = creal(mesh), y = cimag(mesh), *sum_x = beside->real[h], *sum_y = beside->imaginary[h];
    for (int i = 0; i < EO_BESIDE_PHASORS; i++) {
      sum_x[i] += x * real[i] - y * imaginary[i];
      sum_y[i] += x * imaginary[i] + y * real[i];
    }
  }
  beside->rows++;
}

static double power_at(const struct eo_beside *beside, int h, int i)
{
  return beside->real[h][i] * beside->real[h][i] + beside->imaginary[h][i] * beside->imaginary[h][i];
}

/* The mean power of noise from the median: power is exponentially distributed, and the r-th smallest of n such values
   has the mean 1/n + ... + 1/(n - r + 1) of theirs (Renyi 1953); ln 2 for many. */
static double mean_power(double *power, int n)
{
  int upper = n - n / 2;
  double expected = 0;
  for (int k = upper + 1; k <= n; k++)
    expected += 1.0 / k;
  expected += (n % 2 ? 1.0 : 0.5) / upper;
  eo_sort_numbers(n, power);
  return (power[(n - 1) / 2] + power[n / 2]) / (2 * expected);
}

static double repeating_power(const struct eo_beside *beside, int h, int member)
{
  double power[2 * EO_BESIDE_TURNS];
  int n = 0;
  for (int side = 0; side < 2; side++)
    for (int turn = SIDEBANDS + 1; turn <= EO_BESIDE_TURNS; turn++)
      power[n++] = power_at(beside, h, turn_at(member, side, turn));
  return mean_power(power, n);
}

static bool is_sideband(const struct eo_beside *beside, double distance)
{
  bool near = false;
  for (int k = 1; k <= SIDEBANDS; k++)
    near = near || fabs(distance - k) < 1.5 / beside->turns || fabs(distance - k * beside->gear) < 1.5 / beside->turns;
  return near;
}

double eo_beside_sigma(const struct eo_beside *beside, int h, double residual)
{
  double power[2 * EO_BESIDE_BINS], rows = (double)beside->rows, most = rows * residual * residual;
  int n = 0;
  for (int i = 0; i < 2 * EO_BESIDE_BINS; i++)
    if (!is_sideband(beside, (i % EO_BESIDE_BINS + EO_BESIDE_NEAREST) / beside->turns))
      power[n++] = power_at(beside, h, i);
  if (n >= 6) {
    double repeating = fmax(repeating_power(beside, h, EO_PINION), repeating_power(beside, h, EO_GEAR));
    most = mean_power(power, n);
    most = repeating > REPEATS * most ? repeating : most;
  }
  return sqrt(2 * most) / rows;
}

double complex eo_beside_sideband(const struct eo_beside *beside, int h, int member, int turns)
{
  int at = turn_at(member, turns > 0, abs(turns));
  return 2 * (beside->real[h][at] + I * beside->imaginary[h][at]) / (double)beside->rows;
}
