/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vibration over speed: the branches that an upward and a downward sweep meet, and a branch traced through its folds.
 */
#ifndef EASEOFF_DYNAMICS_SPEED_SWEEP_H
#define EASEOFF_DYNAMICS_SPEED_SWEEP_H

#include "dynamics/continuation.h"
#include "dynamics/vibration.h"

/* The branch met while the speed goes up (direction +1: from the first load to the last) or down (-1). load[count]: one
   case per speed, ascending; alone[count]: each of them solved on its own, EO_START_COLD. While the teeth stay in
   contact the state does not depend on where the sweep came from and result[i] = alone[i]; where they have separated,
   the neighbour's solution is the start, so both directions follow their own branches as far as these reach, and differ
   where both exist. An unstable state is left by one time integration, see eo_vibration_keep_stable(). Speeds without a
   stable periodic state carry their outcome. Nothing of it depends on what the solver did
   before. Errors: EO_ERROR_INPUT (speeds that do not ascend), EO_ERROR_MEMORY. */
enum eo_code eo_vibration_follow(struct eo_vibration_solver *solver, int count, const struct eo_vibration_case *load,
                                 const struct eo_vibration *alone, int direction, struct eo_vibration *result,
                                 struct eo_error *error);

/* Both directions of a sweep at speed[count] (pinion, rad/s, ascending; load->speed is not used) on one thread. up and
   down [count], either may be NULL. Errors: also EO_ERROR_CANCELLED. */
enum eo_code eo_vibration_sweep(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, int count,
                                const double *speed, struct eo_vibration *up, struct eo_vibration *down,
                                const struct eo_progress *progress, struct eo_error *error);

struct eo_trace_point {
  double speed;           /* of the pinion, rad/s */
  double rms[2];          /* of the normal acceleration X" at each end, m/s2 */
  double contact_loss[2]; /* share of the cycle */
  int direction;          /* +1: the branch goes on towards higher speeds */
  bool fold;              /* the branch turns here */
};

/* Follows the branch through the solution at load->speed, in the given direction (+1, -1) and through folds until it
   leaves low..high (rad/s, low <= load->speed <= high) or `capacity` points are stored. *count is 0 when there is no
   periodic state at the start. Errors: EO_ERROR_INPUT, EO_ERROR_MEMORY. */
enum eo_code eo_vibration_trace(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, double low,
                                double high, int direction, int capacity, struct eo_trace_point *point, int *count,
                                enum eo_branch_end *end, struct eo_error *error);

#endif
