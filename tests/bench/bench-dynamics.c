/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Speed of the dynamics alone: three torques under the tangent law, mirror and unequal ends, contact loss, a speed
   sweep. */
#include <stdio.h>
#include <time.h>

#include "support/speed-sweep.h"
#include "support/dynamics-fixture.h"

enum { REPEATS = 200, SPEEDS = 200, HARMONICS = 24 };

static double seconds(void)
{
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A made-up but typical transmission error and stiffness over the mesh cycle. */
static void curves(double skew, double *z, double *k)
{
  for (int i = 0; i < 64; i++) {
    double a = 2 * M_PI * i / 64;
    z[i] = 1e-6 * (9 + skew + 0.3 * cos(a) + 0.1 * sin(2 * a + skew) + 0.02 * cos(7 * a));
    k[i] = 1e9 * (1 + 0.05 * cos(a + skew) - 0.02 * sin(2 * a));
  }
}

static double three_torques(struct eo_vibration_solver *solver, bool mirror, double *rms)
{
  const struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law[2] = {{0}, {0}};
  double z[64], k[64], start = seconds();
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    eo_vibration_set_model(solver, &p, NULL);
    for (int torque = 0; torque < 3; torque++) {
      for (int end = 0; end < 2; end++) {
        curves(mirror ? 0 : end, z, k);
        eo_law_set_tangent(&law[end], 64, z, k, eo_dynamics_mesh_load(&p, 621 + 207 * torque, 0), 10, -1e-4, NULL);
      }
      struct eo_vibration r;
      struct eo_vibration_case load = paper_case(&law[0], &law[1]);
      load.torque = 621 + 207 * torque;
      eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
      *rms = r.rms_pair[0];
    }
  }
  double taken = (seconds() - start) / REPEATS;
  eo_law_done(&law[0]);
  eo_law_done(&law[1]);
  return taken;
}

static double sweep(struct eo_vibration_solver *solver, double damping, int *lost)
{
  static struct eo_vibration up[SPEEDS], down[SPEEDS];
  static double speed[SPEEDS];
  struct eo_dynamics_parameters p = paper_pair();
  scale_damping(&p, damping);
  struct eo_law law = {0};
  stiffness_law(&law, 3);
  for (int i = 0; i < SPEEDS; i++)
    speed[i] = (500 + 14500.0 * i / (SPEEDS - 1)) * M_PI / 30;
  struct eo_vibration_case load = paper_case(&law, &law);
  double start = seconds();
  eo_vibration_set_model(solver, &p, NULL);
  sweep_speeds(solver, &load, SPEEDS, speed, up, down);
  double taken = seconds() - start;
  *lost = 0;
  for (int i = 0; i < SPEEDS; i++)
    *lost += down[i].outcome == EO_VIBRATION_CONTACT_LOST;
  eo_law_done(&law);
  return taken;
}

int main(void)
{
  struct eo_vibration_solver *solver = NULL;
  double rms;
  int lost;
  eo_vibration_new(&solver, HARMONICS, 0, NULL);
  three_torques(solver, true, &rms);
  double taken = three_torques(solver, true, &rms);
  printf("three torques, equal ends:      %8.3f ms   (rms %.4f)\n", 1e3 * taken, rms);
  taken = three_torques(solver, false, &rms);
  printf("three torques, unequal ends:    %8.3f ms   (rms %.4f)\n", 1e3 * taken, rms);
  taken = sweep(solver, 1, &lost);
  printf("%d speeds up and down:         %8.3f ms   (%d without contact)\n", SPEEDS, 1e3 * taken, lost);
  taken = sweep(solver, 0.2, &lost);
  printf("%d speeds, a fifth of damping: %8.3f ms   (%d without contact)\n", SPEEDS, 1e3 * taken, lost);
  eo_vibration_free(solver);
  return 0;
}
