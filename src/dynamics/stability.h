/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Floquet multipliers of a periodic state: what becomes of a small disturbance over one mesh period. */
#ifndef EASEOFF_DYNAMICS_STABILITY_H
#define EASEOFF_DYNAMICS_STABILITY_H

#include <complex.h>

#include "base/error.h"
#include "dynamics/oscillator.h"

/* Linearises about the deflections x[2][1 + 2 harmonics] (a result of eo_balance_solve()) and integrates the 2 n
   disturbances over one period (Runge-Kutta 4, steps from the largest eigenfrequency). Where contact begins or ends,
   the jump of the mesh damping enters as a saltation. multiplier[2 n] by descending size: stable when |multiplier[0]|
   < 1. Errors: EO_ERROR_NUMERIC (more than 2e5 steps: speed too low for the stiffness), EO_ERROR_MEMORY. */
enum eo_code eo_floquet(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle, int harmonics,
                        const double *x, double complex *multiplier, struct eo_error *error);

/* Size of the largest multiplier of a state whose teeth stay in contact, faster: with E the motion over one of many
   equal steps under the mean mesh stiffnesses (matrix exponential) and the departures of the stiffnesses from them as
   kicks between the steps, the disturbances grow over a period by the product of kicks and E (Strang's splitting,
   second order in the step; within 1e-3 of eo_floquet()). x as above. Errors: EO_ERROR_NUMERIC (eigenvalues),
   EO_ERROR_MEMORY. */
enum eo_code eo_floquet_attached(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle, int harmonics,
                                 const double *x, double *largest, struct eo_error *error);

#endif
