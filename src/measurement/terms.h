/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The terms of the least squares fit and their values along the rows: the inside of eo_transmission_measure(). */
#ifndef EASEOFF_MEASUREMENT_TERMS_H
#define EASEOFF_MEASUREMENT_TERMS_H

#include "measurement/orders.h"

enum { EO_DRIFT_TERMS = 4, EO_MOST_TERMS = EO_DRIFT_TERMS + 2 * (2 * EO_SHAFT_ORDERS + EO_MESH_ORDERS) };

struct eo_terms {
  int drift, count; /* terms of the drift; all terms: then a cosine and a sine per order */
  int orders;
  double order[2 * EO_SHAFT_ORDERS + EO_MESH_ORDERS]; /* mesh orders first */
  int part[2 * EO_SHAFT_ORDERS + EO_MESH_ORDERS][2];  /* two earlier orders whose sum it is; -1: none */
  int shaft_at[2][EO_SHAFT_ORDERS];                   /* index into order; -1: coincides with another one */
  double middle, half;                                /* of the time, s */
};

/* Orders nearer to each other than 0.7 / turns cannot be told apart: the later one is left out. */
void eo_terms_init(struct eo_terms *terms, const int teeth[2], int harmonics, double turns, double from, double to);

/* value[count] at a time and smooth pinion angle. */
void eo_terms_at(const struct eo_terms *terms, double time, double theta, double *value);

/* Accumulates [A b]' [A b] over blocks of rows and solves for the coefficients. */
struct eo_normal {
  int columns; /* terms + 1 */
  int64_t rows;
  double *gram;  /* owned, [columns][columns], upper triangle */
  double *block; /* owned, [EO_NORMAL_BLOCK][columns] */
  int held;
};
enum { EO_NORMAL_BLOCK = 256 };
enum eo_code eo_normal_init(struct eo_normal *normal, int terms, struct eo_error *error);
void eo_normal_done(struct eo_normal *normal);
/* The next row to fill: terms, then the right-hand side. */
double *eo_normal_row(struct eo_normal *normal);
void eo_normal_add(struct eo_normal *normal);
/* coefficient[terms]; *condition of the equilibrated matrix. Directions below 1e-11 of the largest are left at zero. */
enum eo_code eo_normal_solve(struct eo_normal *normal, double *coefficient, double *condition, struct eo_error *error);

#endif
