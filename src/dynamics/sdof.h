/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A single degree of freedom with backlash, the classical test of everything above (Comparin and Singh 1989; Kahraman
   and Singh 1990):  x" + 2 z x' + (1 + e cos W t) f(x) = F_m + F_h W^2 cos W t,  f = x - 1, 0, x + 1 outside, inside
   the backlash. */
#ifndef EASEOFF_DYNAMICS_SDOF_H
#define EASEOFF_DYNAMICS_SDOF_H

#include <stdbool.h>

#include "base/error.h"

/* Dimensionless. */
struct eo_sdof {
  double damping;           /* z, >= 0 */
  double mean_force;        /* F_m, > 0 */
  double alternating_force; /* F_h */
  double stiffness_share;   /* e, |e| < 1 */
  double frequency;         /* W, > 0 */
};

enum eo_sdof_start {
  EO_SDOF_STATE, /* from the state x, x' at t = 0 */
  EO_SDOF_LOW,   /* the stable state with the smallest swing at this frequency */
  EO_SDOF_HIGH,  /* the one with the largest */
};

struct eo_sdof_response {
  bool converged;
  double mean, rms; /* rms without the mean */
  double peak_to_peak;
  double amplitude[2]; /* of the first and second harmonic */
  double contact_loss; /* share of the period out of contact */
  bool back_contact;
  double floquet; /* largest |multiplier| */
};

/* Errors: EO_ERROR_INPUT with the key of the case (/z, /Fm, /e, /W), EO_ERROR_MEMORY, EO_ERROR_NUMERIC. */
enum eo_code eo_sdof_solve(const struct eo_sdof *sdof, enum eo_sdof_start start, const double state[2],
                           struct eo_sdof_response *response, struct eo_error *error);

enum { EO_SDOF_MAX_FOLDS = 16 };

struct eo_sdof_folds {
  int count;
  double frequency[EO_SDOF_MAX_FOLDS];
  bool going_up[EO_SDOF_MAX_FOLDS]; /* the branch went towards higher frequencies before it turned: an upward sweep
                                       jumps here */
  double contact_lost; /* where the branch first leaves full contact, a little before the jump; NaN: nowhere */
};

/* Folds met while following the branch from W = low upwards until it leaves low..high. sdof->frequency is not used.
   Errors: as eo_sdof_solve(). */
enum eo_code eo_sdof_folds(const struct eo_sdof *sdof, double low, double high, struct eo_sdof_folds *folds,
                           struct eo_error *error);

/* Frequencies at which the linear response (e = 0) just leaves contact: F_h W^2 / |1 - W^2 + 2 i z W| = F_m.
   Returns how many there are (0..2), ascending. */
int eo_sdof_grazing(const struct eo_sdof *sdof, double frequency[2]);

#endif
