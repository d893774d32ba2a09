/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The vibration under a sequence of mesh cycles that differ from each other and repeat after many: the lumped model
   with the tangent law sample by sample, by equal steps in time, exact for forces that are a
   parabola in a step (doc/theory/single-teeth.md). Stiffness varies with the
   teeth and they may part; impact pulses are not in it. */
#ifndef EASEOFF_DYNAMICS_LONG_RESPONSE_H
#define EASEOFF_DYNAMICS_LONG_RESPONSE_H

#include <complex.h>
#include <stdbool.h>

#include "dynamics/model.h"
#include "numerics/fft.h"

/* Of a period of so many cycles the steps would be too many. */
enum { EO_LONG_MOST_CYCLES = 4096 };

struct eo_long_case {
  const struct eo_dynamics_parameters *parameters;
  double torque; /* total on the pinion, N m, > 0 */
  double speed;  /* of the pinion, rad/s, > 0 */
  int pinion_teeth;
  int cycles, positions;       /* of the period; of each cycle */
  int harmonics;               /* of the mesh that are kept of what follows, at most positions/2 - 1 */
  const double *deflection[2]; /* [end]: [cycles positions] in the order of time: Z at which the end carries P, m */
  const double *tangent[2];    /* k_tan, N/m */
  double back;                 /* X at which the back flanks touch, m */
  struct eo_fft_tables *fft;   /* borrowed; NULL: none are kept */
  bool levels_alone;           /* of the accelerations the RMS normal to the teeth, no more */
};

enum eo_long_outcome {
  EO_LONG_IN_CONTACT,
  EO_LONG_CONTACT_LOST,
  EO_LONG_NOT_SETTLED, /* the motion has not come back after the periods that were tried: of the last one */
  EO_LONG_NO_LAW,      /* the stiffness that is kept is not positive everywhere */
  EO_LONG_TOO_LONG,
};

struct eo_long_response {
  enum eo_long_outcome outcome;
  int periods;             /* marched until the motion came back */
  double change;           /* of the state over the last one / its swing */
  double rms[EO_READINGS]; /* accelerations, mean of the ends' RMS, m/s2 */
  double contact_loss[2];  /* [end] share of the period without contact */
  double force_most[2];    /* largest mesh force with damping, N */
  int force_cycle[2];      /* and in which cycle of time */
  int lines;               /* of the spectra: line k is at order k / (revolutions of the pinion in the period) */
  double complex *acceleration[EO_READINGS]; /* [lines] of the mean of the ends, m/s2; owned, NULL without a response */
};

/* Errors: memory; EO_ERROR_INPUT of the parameters. eo_long_response_done() also after an error. */
enum eo_code eo_long_response_find(struct eo_long_response *response, const struct eo_long_case *load,
                                   struct eo_error *error);
void eo_long_response_done(struct eo_long_response *response);

#endif
