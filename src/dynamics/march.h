/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oscillator by equal steps: between kicks it moves exactly under meshes of constant stiffness, and the kicks are
   what the mesh forces differ from those (Strang's splitting, second order in the step). Hundreds of periods of
   transient cost less than ten of CVODE. */
#ifndef EASEOFF_DYNAMICS_MARCH_H
#define EASEOFF_DYNAMICS_MARCH_H

#include "base/error.h"
#include "dynamics/oscillator.h"

struct eo_march_options {
  double angle;   /* by which the meshes alone may turn the motion in a step, rad: 0.15 for two or three digits */
  double settled; /* as struct eo_integration_options has them */
  int max_repeat;
  int max_periods; /* a motion that has not come back within `on_its_way` after `patience` periods never settles */
  int patience;
  double on_its_way; /* share of the swing */
};

struct eo_march {
  double state[2 * EO_MAX_COORDINATES]; /* r, r' at the end of the last period */
  bool periodic;                        /* settled */
  double change;                        /* of the state over the last 1 .. max_repeat periods / swing, the smallest */
  int repeat, periods;
};

/* start[2 n]: r, r' at phase 0. Errors: EO_ERROR_NUMERIC (too many steps a period), EO_ERROR_MEMORY. */
enum eo_code eo_march(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle,
                      const struct eo_march_options *options, const double *start, struct eo_march *result,
                      struct eo_error *error);

#endif
