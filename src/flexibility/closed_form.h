/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A compliance in closed form, for checking everything above it without finite elements:
   C(i,j) = c exp(-|eta_i - eta_j|/l) f(s_i) f(s_j) on the same pair, 0 otherwise; f = 1 + f1 |s - s0| + f2 (s - s0)^2.
 */
#ifndef EASEOFF_FLEXIBILITY_CLOSED_FORM_H
#define EASEOFF_FLEXIBILITY_CLOSED_FORM_H

#include "flexibility/kernel.h"

struct eo_closed_form {
  double compliance; /* c, m/N */
  double length;     /* l, m */
  double centre;     /* s0, m */
  double linear;     /* f1, 1/m */
  double quadratic;  /* f2, 1/m2 */
};

/* context: a struct eo_closed_form. */
eo_kernel_function eo_closed_form_kernel;

#endif
