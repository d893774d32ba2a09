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

#endif
