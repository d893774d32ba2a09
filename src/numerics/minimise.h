/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Local minimum of a smooth function in a box. */
#ifndef EASEOFF_NUMERICS_MINIMISE_H
#define EASEOFF_NUMERICS_MINIMISE_H

/* Value at x[n]; fills gradient[n]. */
typedef double eo_smooth_function(void *context, const double *x, double *gradient);

enum { EO_MINIMISE_MAX = 64 }; /* largest n */

/* Projected quasi-Newton (BFGS on the free variables, Bertsekas 1982): improves x, inside low..high, and returns the
   value there. At most `steps` iterations; ends early when a step moves no variable by more than `tolerance`. */
double eo_minimise(eo_smooth_function *function, void *context, const double *low, const double *high, int n, int steps,
                   double tolerance, double *x);

#endif
