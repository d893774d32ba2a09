/* Vibration over speed: both directions of a speed sweep, and a branch traced through its folds. */
#ifndef EASEOFF_DYNAMICS_SWEEP_H
#define EASEOFF_DYNAMICS_SWEEP_H

#include "dynamics/continuation.h"
#include "dynamics/vibration.h"

/* Solves at speed[count] (pinion, rad/s, ascending; load->speed is not used) once upwards and once downwards. While the teeth
   stay in contact every speed is solved on its own; where they separate the direction's last solution is the start, so up and
   down follow their own branches as far as these reach, and differ where both exist. up and down [count], either may be NULL;
   speeds without a periodic state carry their outcome. One thread; several sweeps may run at once, each with its own solver.
   Errors: EO_ERROR_INPUT, EO_ERROR_MEMORY, EO_ERROR_CANCELLED. */
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

/* Follows the branch through the solution at load->speed, in the given direction (+1, -1) and through folds until it leaves
   low..high (rad/s, low <= load->speed <= high) or `capacity` points are stored. *count is 0 when there is no periodic state at
   the start. Errors: EO_ERROR_INPUT, EO_ERROR_MEMORY. */
enum eo_code eo_vibration_trace(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, double low, double high,
                                int direction, int capacity, struct eo_trace_point *point, int *count,
                                enum eo_branch_end *end, struct eo_error *error);

#endif
