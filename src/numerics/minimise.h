/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Local minima: of a smooth function in a box, of any function of one variable in an interval. */
#ifndef EASEOFF_NUMERICS_MINIMISE_H
#define EASEOFF_NUMERICS_MINIMISE_H

/* Value at x[n]; fills gradient[n]. */
typedef double eo_smooth_function(void *context, const double *x, double *gradient);

enum { EO_MINIMISE_MAX = 64 }; /* largest n */

/* Projected quasi-Newton (BFGS on the free variables, Bertsekas 1982): improves x, inside low..high, and returns the
   value there. At most `steps` iterations; ends early when a step moves no variable by more than `tolerance`. */
double eo_minimise(eo_smooth_function *function, void *context, const double *low, const double *high, int n, int steps,
                   double tolerance, double *x);

typedef double eo_line_function(void *context, double x);

/* Local minimum in low..high of a function that may have kinks, from x, where it is `value`: parabolas where they lead
   on, else golden sections (Brent, Algorithms for Minimization without Derivatives, 1973, chapter 5). Returns the least
   value met and puts its place into *x, which is within `tolerance` (> 0) of the minimum. */
double eo_minimise_along(eo_line_function *function, void *context, double low, double high, double tolerance,
                         double value, double *x);

#endif
