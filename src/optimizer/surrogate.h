/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cubic radial basis functions with a polynomial tail, and how far they can be believed: leave-one-out residuals and
   the credibility made of them. The tail is centred on the mean of the rows.

     s(x) = sum_j c_j |x - x_j|^3 + b' p(x - mean),   (A + ridge I, P; P', 0) (c; b) = (y; 0)
     leave-one-out residual of row j: |c_j / ((A + ridge I, P; P', 0)^-1)_jj|     (Rippa 1999)
     R(x) = exp(-d_min / (4 l)) sum_j w_j exp(-3 e_j / s),  w_j ~ exp(-d_j / l), sum w_j = 1

   One object per thread. */
#ifndef EASEOFF_OPTIMIZER_SURROGATE_H
#define EASEOFF_OPTIMIZER_SURROGATE_H

#include "base/error.h"
#include "numerics/factor.h"

#include <stdbool.h>

enum eo_tail { EO_TAIL_LINEAR, EO_TAIL_SEPARABLE, EO_TAIL_QUADRATIC };

struct eo_surrogate {
  int variables, rows_max, outputs_max;
  enum eo_tail tail; /* of the fit, with the rows and terms it has */
  int rows, terms, outputs;
  double *mean;                        /* [variables]; owned, as all below */
  double *x;                           /* [variables][rows_max] */
  double *coefficient;                 /* [outputs_max][rows_max] c */
  double *polynomial;                  /* [outputs_max][terms] b */
  double *residual;                    /* [outputs_max][rows_max] leave-one-out, absolute */
  double *belief;                      /* [rows_max] exp(-3 e_j / s) */
  int blocks;                          /* of variables; 0: none */
  const int *block;                    /* [variables] whose block; borrowed */
  double *distance;                    /* [rows_max] of the point last visited */
  double *apart;                       /* [blocks][rows_max] likewise, within each block */
  double *kernel;                      /* [rows_max] likewise */
  double *term;                        /* [terms] likewise */
  double *point;                       /* [variables] likewise, less the mean */
  double *matrix, *columns, *diagonal; /* scratch of the fit: [rows][rows], [terms][rows], [rows] */
  struct eo_saddle saddle;
};

/* Terms of a tail in n variables. */
int eo_surrogate_terms(enum eo_tail tail, int n);

/* Room for rows_max rows, outputs_max right-hand sides and any tail up to the given one. */
enum eo_code eo_surrogate_init(struct eo_surrogate *surrogate, int variables, int rows_max, int outputs_max,
                               enum eo_tail tail, struct eo_error *error);
void eo_surrogate_done(struct eo_surrogate *surrogate);

/* Variables in blocks whose effects nearly add up: block[variables] in 0 .. blocks - 1, borrowed. */
enum eo_code eo_surrogate_set_blocks(struct eo_surrogate *surrogate, int blocks, const int *block,
                                     struct eo_error *error);

/* Fits x[rows][variables], y[outputs][rows]. False when the rows do not determine the tail: then there is no surrogate.
 */
bool eo_surrogate_fit(struct eo_surrogate *surrogate, enum eo_tail tail, double ridge, const double *x, const double *y,
                      int rows, int outputs);

/* Goes to a point; what follows is the surrogate there. */
void eo_surrogate_visit(struct eo_surrogate *surrogate, const double *x);
double eo_surrogate_value(const struct eo_surrogate *surrogate, int output);
void eo_surrogate_gradient(const struct eo_surrogate *surrogate, int output, double *gradient);

/* The values of all outputs there; the gradient of a weighted sum of them, made of their coefficients[rows] and
   polynomials[terms]. */
void eo_surrogate_values(struct eo_surrogate *surrogate, double *value);
void eo_surrogate_slope(const struct eo_surrogate *surrogate, const double *coefficient, const double *polynomial,
                        double *gradient);

/* Credibility R in 0..1 at the visited point, by the residuals[rows] and on the scale s set before. */
void eo_surrogate_set_scale(struct eo_surrogate *surrogate, const double *residual, double scale);
double eo_surrogate_credibility(const struct eo_surrogate *surrogate, double length);

#endif
