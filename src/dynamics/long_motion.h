/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oscillator with meshes of constant stiffness and damping, driven along its meshes by pushes that are a
   parabola in each of many equal steps, through those at both ends of it and the one before: exact, in complex modes,
   and a few dozen products a step. */
#ifndef EASEOFF_DYNAMICS_LONG_MOTION_H
#define EASEOFF_DYNAMICS_LONG_MOTION_H

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
  double step;                                    /* s */
  struct eo_motion_row turn;                      /* by which a free step turns a mode */
  struct eo_motion_row before[2], from[2], to[2]; /* [mesh] what 1 N leaves that pushed at the beginning of the step
                                                     before, at that of this one, at its end */
  struct eo_motion_row deflection[2], rate[2];    /* [mesh] X and X' of a mode, as twice the real part of a pair */
  struct eo_motion_row rest[2];                   /* [mesh] state that 1 N for good leads to */
  struct eo_motion_row state;
  double gain[2][2], rate_gain[2][2]; /* X and X' of a mesh at the end of a step from 1 N there on a mesh */
  int readings;
  struct eo_motion_row reading[EO_MOTION_READINGS]; /* of accelerations */
  double direct[EO_MOTION_READINGS][2];             /* and of 1 N along a mesh */
};

/* mean: stiffness of each mesh, N/m; damping: of each, N s/m. weight[readings][n]: of the accelerations r". At rest
   without pushes. Errors: EO_ERROR_NUMERIC: there are no modes. */
enum eo_code eo_long_motion_init(struct eo_long_motion *motion, const struct eo_oscillator *oscillator, double damping,
                                 double mean, double step, int readings, const double (*weight)[EO_MAX_COORDINATES],
                                 struct eo_error *error);

/* At rest under constant pushes force[2], N. */
void eo_long_motion_rest(struct eo_long_motion *motion, const double force[2]);

/* The first half of a step, without the pushes at its end: X and X' that it leads to beside their gains. before: pushes
   at the beginning of the step before. */
void eo_long_motion_go(struct eo_long_motion *motion, const double before[2], const double force[2],
                       double deflection[2], double rate[2]);

/* The other half: pushes at the end. */
void eo_long_motion_arrive(struct eo_long_motion *motion, const double force[2]);

/* A reading of the accelerations under the pushes of the moment. */
double eo_long_motion_read(const struct eo_long_motion *motion, int reading, const double force[2]);

#endif
