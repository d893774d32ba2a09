/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vibration over speed: the branches that an upward and a downward sweep meet. */
#ifndef EASEOFF_DYNAMICS_SPEED_SWEEP_H
#define EASEOFF_DYNAMICS_SPEED_SWEEP_H

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

#endif
