/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Periodic spline and harmonics against functions in closed form; the fast transform against the slow one. */
#include <stdbool.h>
#include <string.h>

#include "base/random.h"
#include "numerics/fft.h"
#include "numerics/periodic.h"
#include "support/tap.h"

static double smooth(double phase, double *slope)
{
  double a = 2 * M_PI * phase, value = exp(sin(a)) + 0.3 * cos(3 * a + 0.7);
  *slope = 2 * M_PI * (cos(a) * exp(sin(a)) - 0.9 * sin(3 * a + 0.7));
  return value;
}

/* Largest error of value and slope between n nodes. */
static void spline_error(int n, double error[2])
{
  static struct eo_periodic spline;
  static double node[EO_PERIODIC_MOST];
  double slope, rate;
  for (int i = 0; i < n; i++)
    node[i] = smooth((double)i / n, &slope);
  eo_periodic_init(&spline, n, node);
  error[0] = error[1] = 0;
  for (int i = 0; i < 2000; i++) {
    double phase = (i + 0.3) / 2000, wanted = smooth(phase, &slope);
    error[0] = fmax(error[0], fabs(eo_periodic_at(&spline, phase, &rate) - wanted));
    error[1] = fmax(error[1], fabs(rate - slope));
  }
}

static void test_order(void)
{
  double coarse[2], fine[2];
  spline_error(64, coarse);
  spline_error(128, fine);
  close_to(log2(coarse[0] / fine[0]), 4, 0.15, "order of convergence of the value");
  close_to(log2(coarse[1] / fine[1]), 3, 0.15, "order of convergence of the slope");
  ok(fine[0] < 3e-6, "the error with 128 nodes is %.1e", fine[0]);
}

/* What makes it a spline: the second derivative, taken from the slopes on either side of each node, does not jump. */
static void test_continuity(void)
{
  struct eo_periodic spline;
  double node[5] = {1, -2, 0.5, 4, 3}, bend = 0, h = 1e-4;
  eo_periodic_init(&spline, 5, node);
  for (int i = 0; i < 5; i++) {
    double at = i / 5.0, before = i ? at : 1,
           slope[6]; /* on a cubic three slopes give the second derivative at their end exactly */
    close_to(eo_periodic_at(&spline, at, NULL), node[i], 1e-14, "value of the spline at a node");
    for (int k = 0; k < 3; k++) {
      eo_periodic_at(&spline, before - (k + 0.5) * h, &slope[k]);
      eo_periodic_at(&spline, at + (k + 0.5) * h, &slope[3 + k]);
    }
    double left = (2 * slope[0] - 3 * slope[1] + slope[2]) / h, right = (-2 * slope[3] + 3 * slope[4] - slope[5]) / h;
    bend = fmax(bend, fabs(left - right) / fmax(1, fabs(left)));
  }
  ok(bend < 1e-8, "the spline's second derivative does not jump: %.1e", bend);
  close_to(eo_periodic_at(&spline, 1, NULL), node[0], 1e-14, "value at phase 1, that at phase 0");
}

static void test_flat(void)
{
  struct eo_periodic spline;
  double node[3] = {7, 7, 7}, slope;
  eo_periodic_init(&spline, 3, node);
  close_to(eo_periodic_at(&spline, 0.41, &slope), 7, 1e-14, "value of a constant with three nodes");
  close_to(slope, 0, 1e-13, "slope of a constant");
}

static void test_harmonics(void)
{
  enum { COUNT = 32, HARMONICS = 15 };
  double node[COUNT], amplitude[HARMONICS][2], worst = 0;
  for (int i = 0; i < COUNT; i++) {
    node[i] = 2.5;
    for (int h = 1; h <= HARMONICS; h++)
      node[i] += cos(2 * M_PI * h * i / COUNT) / h - 0.1 * h * sin(2 * M_PI * h * i / COUNT);
  }
  close_to(eo_periodic_harmonics(COUNT, node, HARMONICS, amplitude), 2.5, 1e-14, "mean of a trigonometric polynomial");
  for (int h = 1; h <= HARMONICS; h++)
    worst = fmax(worst, hypot(amplitude[h - 1][0] - 1.0 / h, amplitude[h - 1][1] - 0.1 * h));
  close_to(worst, 0, 1e-13, "harmonics of a trigonometric polynomial");
}

/* Sizes that come again, and more of them than are kept. */
static void test_fft_tables(void)
{
  enum { SIZES = 20, FIRST = 5, MOST = FIRST + SIZES };
  struct eo_fft_tables *tables;
  struct eo_error error = {0};
  bool same = eo_fft_tables_new(&tables, &error) == EO_OK;
  for (int i = 0; i < 2 * SIZES && same; i++) {
    double complex kept[MOST], own[MOST];
    int n = FIRST + i % SIZES;
    for (int k = 0; k < n; k++)
      kept[k] = own[k] = eo_random_normal(eo_random_at(2, 0, 0, 0), (uint64_t)(100 * i + k));
    same = !eo_fft_forward(tables, n, kept, &error) && !eo_fft_forward(NULL, n, own, &error) &&
           memcmp(kept, own, sizeof *own * (size_t)n) == 0;
  }
  ok(same, "tables that are kept change no byte");
  eo_fft_tables_free(tables);
}

/* Powers of two, teeth with a common factor, a prime number of them, a single sample. */
static void test_fft(void)
{
  enum { MOST = 748 };
  static const int length[] = {1, 2, 64, 291, 509, MOST};
  struct eo_error error = {0};
  for (size_t l = 0; l < sizeof length / sizeof length[0]; l++) {
    double complex x[MOST], fast[MOST];
    double worst = 0;
    int n = length[l];
    for (int i = 0; i < n; i++)
      fast[i] = x[i] = eo_random_normal(eo_random_at(1, 0, 0, 0), (uint64_t)i) +
                       I * eo_random_normal(eo_random_at(1, 0, 0, 1), (uint64_t)i);
    enum eo_code code = eo_fft_forward(NULL, n, fast, &error);
    for (int k = 0; k < n; k++) {
      double complex sum = 0;
      for (int i = 0; i < n; i++)
        sum += x[i] * cexp(-2 * M_PI * I * ((long long)i * k % n) / n);
      worst = fmax(worst, cabs(sum - fast[k]));
    }
    ok(!code && worst < 1e-12 * n, "the fast transform of %d samples is the slow one: %.2g", n, worst);
  }
}

int main(void)
{
  test_order();
  test_continuity();
  test_flat();
  test_harmonics();
  test_fft();
  test_fft_tables();
  return tap_done();
}
