/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oscillator in modes under a push that is a sine, once it has settled, against its frequency response; at rest
   under a constant one; and the order of its error. */
#include <complex.h>
#include <math.h>
#include <string.h>

#include "dynamics/long_motion.h"
#include "support/tap.h"

enum { N = 2 };
static const double mean = 1e8, mesh_damping = 300; /* N/m, N s/m */

/* Two unit masses, the first behind the mesh, the second on a spring between them and to the ground. */
static struct eo_oscillator make_oscillator(void)
{
  struct eo_oscillator o = {.n = N, .ends = 1};
  const double k[N * N] = {3e7, -3e7, -3e7, 9e7}, c[N * N] = {400, -200, -200, 900};
  memcpy(o.stiffness, k, sizeof k);
  memcpy(o.damping, c, sizeof c);
  o.mesh[0][0] = 1;
  o.load[0] = 1000;
  return o;
}

/* Of the first mass per N along the mesh, by Cramer's rule. */
static double complex response(const struct eo_oscillator *o, double frequency)
{
  double complex a[N * N];
  for (int i = 0; i < N * N; i++)
    a[i] = o->stiffness[i] + I * frequency * o->damping[i] + (i == 0 ? mean + I * frequency * mesh_damping : 0) -
           (i % (N + 1) == 0 ? frequency * frequency : 0);
  return a[3] / (a[0] * a[3] - a[1] * a[2]);
}

/* How far X, X' and the acceleration are off in the last of many periods, of their amplitudes; the largest of them. */
static double off(const struct eo_oscillator *o, double frequency, int steps, double apart[3])
{
  enum { PERIODS = 300 };
  static const double weight[1][EO_MAX_COORDINATES] = {{1}};
  struct eo_long_motion motion;
  struct eo_error error;
  double step = 2 * M_PI / frequency / steps, before[2] = {0}, force[2] = {0}, x[2], v[2];
  double complex of = response(o, frequency), turn = I * frequency;
  if (eo_long_motion_init(&motion, o, mesh_damping, mean, step, 1, weight, &error))
    return NAN;
  memset(apart, 0, 3 * sizeof *apart);
  for (int i = 0; i < PERIODS * steps; i++) {
    double complex there = cexp(I * frequency * step * (i + 1));
    eo_long_motion_go(&motion, before, force, x, v);
    before[0] = force[0];
    force[0] = creal(there);
    if (i < (PERIODS - 1) * steps)
      continue;
    apart[0] = fmax(apart[0], fabs(x[0] + motion.gain[0][0] * force[0] - creal(of * there)) / cabs(of));
    apart[1] = fmax(apart[1],
                    fabs(v[0] + motion.rate_gain[0][0] * force[0] - creal(turn * of * there)) / cabs(turn * of));
    apart[2] = fmax(apart[2], fabs(eo_long_motion_read(&motion, 0, before, force) - creal(turn * turn * of * there)) /
                                  cabs(turn * turn * of));
  }
  return fmax(apart[0], fmax(apart[1], apart[2]));
}

int main(void)
{
  const struct eo_oscillator o = make_oscillator();
  const double frequency[] = {5000, 11000};
  double apart[3];
  for (int i = 0; i < 2; i++) {
    double coarse = off(&o, frequency[i], 32, apart), fine = off(&o, frequency[i], 64, apart);
    ok(fine < 3e-4, "at %g rad/s 64 steps are within %.1e of the frequency response", frequency[i], fine);
    ok(coarse > 7 * fine, "half the steps are within %.1e, at least seven times further off", coarse);
  }
  /* Modes are gone within a step, and at last leave no number at all. The motion follows the pushes at once, its
     acceleration their parabola, which has the curvature of a step before. */
  for (double slow = 100; slow >= 1e-3; slow /= 10) {
    off(&o, slow, 64, apart);
    ok(apart[0] < 1e-3 && apart[1] < 1e-2 && apart[2] < 0.5, "at %g rad/s 64 steps are within %.1e, %.1e, %.1e", slow,
       apart[0], apart[1], apart[2]);
  }
  struct eo_long_motion motion;
  struct eo_error error;
  double still[2] = {NAN}, force[2] = {500, 0}, x[2], v[2];
  static const double weight[1][EO_MAX_COORDINATES] = {{1}};
  bool made = eo_long_motion_still(&o, mean, still) &&
              !eo_long_motion_init(&motion, &o, mesh_damping, mean, 1e-5, 1, weight, &error);
  ok(made, "the long motion is made");
  close_to(still[0] / (1000 * creal(response(&o, 0))), 1, 1e-12, "motion at rest under the constant loads");
  eo_long_motion_rest(&motion, force);
  for (int i = 0; i < 100; i++)
    eo_long_motion_go(&motion, force, force, x, v);
  close_to((x[0] + motion.gain[0][0] * force[0]) / (500 * creal(response(&o, 0))), 1, 1e-11,
           "motion at rest under a constant push");
  ok(fabs(eo_long_motion_read(&motion, 0, force, force)) < 1e-6, "a motion at rest has no acceleration");
  return tap_done();
}
