/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A surrogate of a value through what it is made of (anatomy.h): one surrogate per part, all on the same rows, put
   together by the known reductions. It has the kinks of the value where a surrogate of the value itself would round
   them off. Without an anatomy it is the surrogate of the value. One object per thread. */
#ifndef EASEOFF_OPTIMIZER_COMPOSITE_H
#define EASEOFF_OPTIMIZER_COMPOSITE_H

#include "optimizer/anatomy.h"
#include "optimizer/surrogate.h"
#include "optimizer/true_rows.h"

struct eo_composite {
  const struct eo_anatomy *anatomy; /* borrowed; no groups: none */
  struct eo_surrogate surrogate;    /* output 0: the rest; then the parts */
  double offset, scale;             /* what it gives is (value - offset) / scale */
  double *y;                        /* [1 + parts][rows_max], packed by rows; owned, as all below */
  double *part;                     /* [1 + parts] at the visited point */
  double *residual;                 /* [rows_max] of the value, leave-one-out, absolute */
  double *coefficient, *polynomial; /* [rows_max], [terms] of the tangent at the visited point */
  double *weight;                   /* [1 + parts] of the parts in it */
  double *size;                     /* [groups] mean reduction over the rows, absolute */
  double softness;                  /* of the largest parts, in sizes; 0: as they are */
};

/* Room for rows_max rows of so many variables. anatomy: borrowed. Errors: memory. */
enum eo_code eo_composite_init(struct eo_composite *composite, const struct eo_anatomy *anatomy, int variables,
                               int rows_max, enum eo_tail tail, struct eo_error *error);
void eo_composite_done(struct eo_composite *composite);

/* What eo_composite_fit() is made from. The archive's parts of the rows count where there is an anatomy. */
struct eo_composite_rows {
  const struct eo_archive *archive;
  int count;
  const int *row;                  /* [count] of the archive, each whole */
  const double *x;                 /* [count][variables] where they stand for the surrogate */
  const double *value;             /* [count] */
  double offset, scale, most_rest; /* most_rest: larger rests count as this, in units of scale */
};

/* False when the rows do not determine the tail. */
bool eo_composite_fit(struct eo_composite *composite, enum eo_tail tail, double ridge,
                      const struct eo_composite_rows *rows);

/* Goes to a point and returns the value there, its largest parts as soft as told. The gradient belongs to it: where
   kinks are sharp that of the parts which the reductions take. */
double eo_composite_value(struct eo_composite *composite, const double *x);
void eo_composite_gradient(struct eo_composite *composite, double *gradient);

/* Improves x[variables] inside low..high towards a minimum, first over rounded kinks, then over sharper ones. Returns
   the value there. */
double eo_composite_minimise(struct eo_composite *composite, const double *low, const double *high, int steps,
                             double tolerance, double *x);

/* Whether a row of the archive can serve. */
bool eo_composite_takes(const struct eo_composite *composite, const struct eo_archive *archive, int row);

#endif
