/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same oscillator by time integration (CVODE), from a given or the static start to the periodic state: the
   independent check of the harmonic balance, and a way to a start value where Newton finds none. */
#ifndef EASEOFF_DYNAMICS_INTEGRATION_H
#define EASEOFF_DYNAMICS_INTEGRATION_H

#include "base/error.h"
#include "base/progress.h"
#include "dynamics/oscillator.h"

struct eo_integration_options {
  double relative_tolerance; /* of CVODE, > 0 */
  double settled;  /* periodic when the state changes over one period by less than this share of its swing, > 0;
                      or by less than 1e-5 of it without settling further, which is the integration's own noise */
  int max_periods; /* >= 1 */
  int samples;     /* of each mesh period that is recorded, >= 2 */
  int max_repeat;  /* 1..4: the most mesh periods after which the state may repeat; the smallest number counts, and more
                      than one only where the state comes back a thousand times nearer than after fewer */
};

/* rtol 1e-8, settled 1e-7, 1000 periods, 1024 samples, repeating with every period. */
extern const struct eo_integration_options eo_integration_defaults;

/* One mesh at one instant. */
struct eo_mesh_state {
  double deflection, rate;     /* X, X', prescribed motion included */
  double elastic, force;       /* the law alone; with the damping, N */
  double margin, margin_slope; /* as struct eo_mesh_force */
};

/* The last period, of so many mesh periods as the state takes to repeat, at equidistant phases; the arrays belong to
   the caller and have room for max_repeat mesh periods. */
struct eo_integration {
  double *acceleration;                 /* [repeat samples][n] r", from the equation of motion */
  struct eo_mesh_state *mesh;           /* [repeat samples][2] */
  double state[2 * EO_MAX_COORDINATES]; /* r, r' at the end of the period */
  int repeat;                           /* mesh periods after which the state repeats; 1 where it does not settle */
  bool periodic;                        /* settled; else the last of max_periods is recorded */
  double change;                        /* of the state over the last but one period / swing, the smallest allowed */
  int periods;
  long steps; /* CVODE's, of the whole run */
};

/* start[2 n]: r, r' at phase 0. Errors: EO_ERROR_NUMERIC (CVODE gave up), EO_ERROR_MEMORY, EO_ERROR_CANCELLED. */
enum eo_code eo_integrate(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle,
                          const struct eo_integration_options *options, const double *start,
                          struct eo_integration *result, const struct eo_progress *progress, struct eo_error *error);

/* Acceleration r" at one state, and its meshes (NULL: not wanted). */
void eo_oscillator_acceleration(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle, double phase,
                                const double *position, const double *velocity, double *acceleration,
                                struct eo_mesh_state *mesh);

#endif
