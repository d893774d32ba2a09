/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cubic splines through values at given points, with the not-a-knot end condition (de Boor 1978), as coefficients of
   B-splines: four of them are different from zero at any place. */
#ifndef EASEOFF_FLEXIBILITY_SPLINE_H
#define EASEOFF_FLEXIBILITY_SPLINE_H

#include "base/error.h"

enum { EO_SPLINE_MAX = 129, EO_SPLINE_WIDTH = 4 };

struct eo_spline {
  int count;          /* values = B-splines, 4..EO_SPLINE_MAX */
  double first, last; /* ends of the range */
  double margin;      /* outside, straight on for this length, then constant */
  double knot[EO_SPLINE_MAX + EO_SPLINE_WIDTH];
  double *to_coefficients; /* [count][count]: B-spline coefficients from values */
};

/* place[count] ascends strictly. Beyond the ends the spline goes on straight for the first and last interval's length.
 */
enum eo_code eo_spline_init(struct eo_spline *spline, int count, const double *place, struct eo_error *error);
void eo_spline_done(struct eo_spline *spline);

/* Weights of the B-splines *first .. *first + 3 at x. */
void eo_spline_weights(const struct eo_spline *spline, double x, int *first, double weight[EO_SPLINE_WIDTH]);

/* row[count]: weights of the *values* at x, for use outside inner loops. */
void eo_spline_value_weights(const struct eo_spline *spline, double x, double *row);

#endif
