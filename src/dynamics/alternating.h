/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Alternating frequency-time: a mesh law evaluated on equidistant phases of a truncated Fourier series, and brought
   back (Cameron and Griffin 1989). Where teeth separate between two samples both count by the share of their cells that
   is in contact, so that force and Jacobian stay continuous and do not feel the samples. */
#ifndef EASEOFF_DYNAMICS_ALTERNATING_H
#define EASEOFF_DYNAMICS_ALTERNATING_H

#include "base/error.h"
#include "dynamics/oscillator.h"

/* One end on the time grid; every array has one number per sample. */
struct eo_time_end {
  int rows;
  double *row;     /* [samples][rows] of the law */
  int capacity;    /* numbers that fit into row */
  double *x, *v;   /* deflection, m, and its rate, m/s */
  double *force;   /* law and damping, both weighted, N */
  double *elastic; /* law alone, N */
  double *slope;   /* d law / dX */
  double *margin, *margin_slope;
  double *cell;   /* share of contact between this sample and the next */
  double *weight; /* share of contact of the two half cells about this sample: 0..1 */
  double *gate;   /* weight of the mesh damping: the same, or 1 when it always acts */
  double *work;
};

struct eo_alternating {
  int harmonics, samples;
  double *basis; /* [1 + 4 harmonics][samples]: 1, cos, sin, ... */
  struct eo_time_end end[2];
  double *scratch; /* [3][1 + 4 harmonics] */
};

/* Errors: EO_ERROR_MEMORY; EO_ERROR_INPUT when samples <= 2 harmonics. */
enum eo_code eo_alternating_new(struct eo_alternating **grid, int harmonics, int samples, struct eo_error *error);
void eo_alternating_free(struct eo_alternating *grid); /* NULL is fine */

/* Evaluates the law of an end at all samples; to be called whenever the law or its shift has changed. */
enum eo_code eo_alternating_prepare(struct eo_alternating *grid, int end, const struct eo_law *law, double shift,
                                    struct eo_error *error);

/* force[1 + 2 harmonics]: the series of F for the deflection x[1 + 2 harmonics]. attached: as eo_law_force(). */
void eo_alternating_force(struct eo_alternating *grid, int end, const struct eo_cycle *cycle, const double *x,
                          bool attached, double *force);

/* Adds dF/dx of the last eo_alternating_force() to jacobian[1 + 2 harmonics][...] with the given row stride. */
void eo_alternating_jacobian(struct eo_alternating *grid, int end, const struct eo_cycle *cycle, bool attached,
                             int stride, double *jacobian);

/* slope[1 + 2 harmonics]: series of dF/d frequency at fixed x (through the rate in the mesh damping). */
void eo_alternating_frequency_slope(struct eo_alternating *grid, int end, const struct eo_cycle *cycle, double *slope);

/* series[terms] of samples on the grid, terms <= 1 + 4 harmonics. */
void eo_alternating_transform(const struct eo_alternating *grid, int terms, const double *sample, double *series);

/* sample[samples] of series[1 + 2 harmonics]. */
void eo_alternating_synthesis(const struct eo_alternating *grid, const double *series, double *sample);

/* Fills cell, weight and gate of an end from its margins; eo_alternating_force() does so itself. */
void eo_alternating_gate(struct eo_alternating *grid, int end, bool gated);

/* Share of the cycle out of contact, 0..1, of the last eo_alternating_force(). */
double eo_alternating_loss(const struct eo_alternating *grid, int end);

#endif
