/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas of test problems in case files, for instance "1/(1+sum((x-c)^2)), c=[0.3,0.6,0.45]": an expression in the
   point x, evaluated element by element, and definitions of scalars or vectors after it. Operators + - * / ^ and
   brackets; sum, mean, prod, min, max, norm make a number of a vector; exp, log, sqrt, abs, sin, cos, tanh act on each
   element; pi, n (the number of variables), k (1 .. n). */
#ifndef EASEOFF_REFERENCE_FORMULA_H
#define EASEOFF_REFERENCE_FORMULA_H

#include "base/error.h"

enum { EO_FORMULA_VARIABLES = 64 };

/* Value of the formula at x[n]; EO_ERROR_INPUT when it cannot be read or is not a number but a vector. */
enum eo_code eo_formula_evaluate(const char *text, const double *x, int n, double *value, struct eo_error *error);

#endif
