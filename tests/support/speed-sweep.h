/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both directions of a sweep at speeds of their own, on one thread. */
#ifndef EASEOFF_TESTS_SUPPORT_SPEED_SWEEP_H
#define EASEOFF_TESTS_SUPPORT_SPEED_SWEEP_H

#include "dynamics/speed_sweep.h"

enum { SWEEP_MOST = 400 };

/* speed[count]: of the pinion, rad/s, ascending; load->speed is not used. up and down [count]. False: it failed. */
static inline bool sweep_speeds(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, int count,
                                const double *speed, struct eo_vibration *up, struct eo_vibration *down)
{
  struct eo_vibration_case at[SWEEP_MOST];
  struct eo_vibration alone[SWEEP_MOST];
  if (count > SWEEP_MOST)
    return false;
  for (int i = 0; i < count; i++) {
    at[i] = *load;
    at[i].speed = speed[i];
    if (eo_vibration_solve(solver, &at[i], EO_START_COLD, &alone[i], NULL))
      return false;
  }
  return !eo_vibration_follow(solver, count, at, alone, +1, up, NULL) &&
         !eo_vibration_follow(solver, count, at, alone, -1, down, NULL);
}

#endif
