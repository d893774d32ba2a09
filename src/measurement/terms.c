/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/terms.h"

#include <math.h>
#include <stdlib.h>

#include "numerics/dense.h"

static bool known_order(const struct eo_terms *t, double order, double distance)
{
  for (int i = 0; i < t->orders; i++)
    if (fabs(t->order[i] - order) < distance)
      return true;
  return false;
}

static void add_order(struct eo_terms *t, double order)
{
  int at = t->orders++;
  t->order[at] = order;
  t->part[at][0] = -1;
  for (int i = 0; i < at; i++)
    for (int j = 0; j <= i; j++)
      if (fabs(t->order[i] + t->order[j] - order) < 1e-9) {
        t->part[at][0] = i;
        t->part[at][1] = j;
      }
}

void eo_terms_init(struct eo_terms *t, const int teeth[2], int harmonics, double turns, double from, double to)
{
  *t = (struct eo_terms){.drift = EO_DRIFT_TERMS, .middle = (from + to) / 2, .half = (to - from) / 2};
  for (int h = 1; h <= harmonics; h++)
    add_order(t, (double)h * teeth[EO_PINION]);
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < EO_SHAFT_ORDERS; k++) {
      double order = (k + 1) * (member == EO_PINION ? 1.0 : (double)teeth[EO_PINION] / teeth[EO_GEAR]);
      bool there = known_order(t, order, 0.7 / turns);
      t->shaft_at[member][k] = there ? -1 : t->orders;
      if (!there)
        add_order(t, order);
    }
  t->count = t->drift + 2 * t->orders;
}

void eo_terms_at(const struct eo_terms *t, double time, double theta, double *value)
{
  double x = (time - t->middle) / t->half;
  double complex turn[2 * EO_SHAFT_ORDERS + EO_MESH_ORDERS];
  value[0] = 1;
  value[1] = x;
  value[2] = (3 * x * x - 1) / 2;
  value[3] = (5 * x * x - 3) * x / 2;
  for (int i = 0; i < t->orders; i++) {
    turn[i] = t->part[i][0] >= 0 ? turn[t->part[i][0]] * turn[t->part[i][1]] : cexp(I * t->order[i] * theta);
    value[t->drift + 2 * i] = creal(turn[i]); /* theory (M2) */
    value[t->drift + 2 * i + 1] = cimag(turn[i]);
  }
}

enum eo_code eo_normal_init(struct eo_normal *n, int terms, struct eo_error *error)
{
  *n = (struct eo_normal){.columns = terms + 1};
  n->gram = calloc((size_t)n->columns * n->columns, sizeof *n->gram);
  n->block = malloc(sizeof *n->block * (size_t)(EO_NORMAL_BLOCK * n->columns));
  return n->gram && n->block ? EO_OK : eo_error_memory(error);
}

void eo_normal_done(struct eo_normal *n)
{
  free(n->gram);
  free(n->block);
  *n = (struct eo_normal){0};
}

double *eo_normal_row(struct eo_normal *n)
{
  return n->block + (size_t)n->held * (size_t)n->columns;
}

static void flush(struct eo_normal *n)
{
  eo_dense_add_gram(n->held, n->columns, n->block, n->gram);
  n->held = 0;
}

void eo_normal_add(struct eo_normal *n)
{
  n->rows++;
  if (++n->held == EO_NORMAL_BLOCK)
    flush(n);
}

enum eo_code eo_normal_solve(struct eo_normal *normal, double *coefficient, double *condition, struct eo_error *error)
{
  int terms = normal->columns - 1;
  flush(normal);
  double *matrix = malloc(sizeof *matrix * (size_t)(terms * terms + 3 * terms));
  if (!matrix)
    return eo_error_memory(error);
  double *values = matrix + terms * terms, *scale = values + terms;
  for (int i = 0; i < terms; i++)
    scale[i] = 1 / sqrt(fmax(normal->gram[i * normal->columns + i], 1e-300));
  for (int i = 0; i < terms; i++)
    for (int j = 0; j < terms; j++)
      matrix[i * terms + j] = scale[i] * scale[j] * normal->gram[(i < j ? i : j) * normal->columns + (i < j ? j : i)];
  int failed = eo_dense_symmetric_eigen(terms, matrix, values);
  for (int i = 0; i < terms; i++)
    coefficient[i] = 0;
  for (int k = 0; k < terms && !failed; k++) {
    double sum = 0;
    if (values[k] < 1e-11 * values[terms - 1])
      continue;
    for (int i = 0; i < terms; i++)
      sum += matrix[k * terms + i] * scale[i] * normal->gram[i * normal->columns + terms];
    for (int i = 0; i < terms; i++)
      coefficient[i] += scale[i] * matrix[k * terms + i] * sum / values[k];
  }
  *condition = failed ? NAN : values[terms - 1] / fmax(values[0], 1e-300);
  free(matrix);
  return failed ? eo_error_set(error, EO_ERROR_NUMERIC, "", "The least squares fit of the orders failed.") : EO_OK;
}
