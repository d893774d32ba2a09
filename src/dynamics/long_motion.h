/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oscillator with meshes of constant stiffness and damping, driven along its meshes by pushes that are a
   parabola in each of many equal steps, through those at both ends of it and the one before: exact, in complex modes,
   and a few dozen products a step. */
#ifndef EASEOFF_DYNAMICS_LONG_MOTION_H
#define EASEOFF_DYNAMICS_LONG_MOTION_H

#include <stdbool.h>

#include "base/error.h"
#include "dynamics/oscillator.h"

/* Modes come in pairs of conjugates, of which one is kept, or are real; their number is made even. */
enum { EO_MOTION_MODES = 2 * EO_MAX_COORDINATES, EO_MOTION_READINGS = 10 };

/* Real and imaginary parts, by mode. */
struct eo_motion_row {
  _Alignas(16) double part[2][EO_MOTION_MODES];
};

struct eo_long_motion {
  int modes, ends;
  double step;                                   /* s */
  struct eo_motion_row turn;                     /* by which a free step turns a mode */
  struct eo_motion_row early[2], kick[2], to[2]; /* [mesh] of 1 N in the step before, at the beginning of a step, and
                                                    what it leaves at its end */
  bool forgets;                                /* a mode is gone within a step: nothing of what follows holds `early` */
  struct eo_motion_row before[2];              /* [mesh] of 1 N in the step before, then */
  struct eo_motion_row deflection[2], rate[2]; /* [mesh] X and X' of a mode, as twice the real part of a pair */
  struct eo_motion_row rest[2];                /* [mesh] state that 1 N for good leads to */
  struct eo_motion_row state;         /* modes less what the push at this instant, plus what the one before has in them:
                                         with both in one number a step takes a third of the products */
  double gain[2][2], rate_gain[2][2]; /* X and X' of a mesh at the end of a step from 1 N there on a mesh */
  double early_gain[2][2], early_rate_gain[2][2]; /* and from 1 N at its beginning, beside the state */
  int readings;
  struct eo_motion_row reading[EO_MOTION_READINGS]; /* of accelerations */
  double direct[EO_MOTION_READINGS][2];             /* and of 1 N along a mesh, */
  double early_direct[EO_MOTION_READINGS][2];       /* of 1 N there the step before */
};

/* mean: stiffness of each mesh, N/m; damping: of each, N s/m. weight[readings][n]: of the accelerations r". At rest
   without pushes. Errors: EO_ERROR_NUMERIC: there are no modes. */
enum eo_code eo_long_motion_init(struct eo_long_motion *motion, const struct eo_oscillator *oscillator, double damping,
                                 double mean, double step, int readings, const double (*weight)[EO_MAX_COORDINATES],
                                 struct eo_error *error);

/* X of the meshes at this stiffness under the constant loads; false: there is no such place. */
bool eo_long_motion_still(const struct eo_oscillator *oscillator, double mean, double deflection[2]);

/* At rest under constant pushes force[2], N. */
void eo_long_motion_rest(struct eo_long_motion *motion, const double force[2]);

/* One step with these pushes at the beginning of the step before and of its own: X and X' at its end beside the gains
   of the pushes there. */
void eo_long_motion_go(struct eo_long_motion *motion, const double before[2], const double force[2],
                       double deflection[2], double rate[2]);

/* A reading of the accelerations under the pushes of the moment and those of the step before. */
double eo_long_motion_read(const struct eo_long_motion *motion, int reading, const double before[2],
                           const double force[2]);

#endif
