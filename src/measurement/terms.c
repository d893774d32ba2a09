/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/terms.h"

#include <math.h>
#include <stdlib.h>

#include "numerics/dense.h"

static bool known_order(const struct eo_terms *terms, double order, double distance)
{
  for (int i = 0; i < terms->orders; i++)
    if (fabs(terms->order[i] - order) < distance)
      return true;
  return false;
}

static void add_order(struct eo_terms *terms, double order)
{
  int at = terms->orders++;
  terms->order[at] = order;
  terms->part[at][0] = -1;
  for (int i = 0; i < at; i++)
    for (int j = 0; j <= i; j++)
      if (fabs(terms->order[i] + terms->order[j] - order) < 1e-9) {
        terms->part[at][0] = i;
        terms->part[at][1] = j;
      }
}

void eo_terms_init(struct eo_terms *terms, const int teeth[2], int harmonics, double turns, double from, double to)
{
  *terms = (struct eo_terms){.drift = EO_DRIFT_TERMS, .middle = (from + to) / 2, .half = (to - from) / 2};
  for (int h = 1; h <= harmonics; h++)
    add_order(terms, (double)h * teeth[EO_PINION]);
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < EO_SHAFT_ORDERS; k++) {
      double order = (k + 1) * (member == EO_PINION ? 1.0 : (double)teeth[EO_PINION] / teeth[EO_GEAR]);
      bool there = known_order(terms, order, 0.7 / turns);
      terms->shaft_at[member][k] = there ? -1 : terms->orders;
      if (!there)
        add_order(terms, order);
    }
  terms->count = terms->drift + 2 * terms->orders;
}

void eo_terms_at(const struct eo_terms *terms, double time, double theta, double *value)
{
  double x = (time - terms->middle) / terms->half;
  double complex turn[2 * EO_SHAFT_ORDERS + EO_MESH_ORDERS];
  value[0] = 1;
  value[1] = x;
  value[2] = (3 * x * x - 1) / 2;
  value[3] = (5 * x * x - 3) * x / 2;
  for (int i = 0; i < terms->orders; i++) {
    turn[i] = terms->part[i][0] >= 0 ? turn[terms->part[i][0]] * turn[terms->part[i][1]]
                                     : cexp(I * terms->order[i] * theta);
    value[terms->drift + 2 * i] = creal(turn[i]); /* theory (M2) */
    value[terms->drift + 2 * i + 1] = cimag(turn[i]);
  }
}

enum eo_code eo_normal_init(struct eo_normal *normal, int terms, struct eo_error *error)
{
  *normal = (struct eo_normal){.columns = terms + 1};
  normal->gram = calloc((size_t)normal->columns * normal->columns, sizeof *normal->gram);
  normal->block = malloc(sizeof *normal->block * (size_t)(EO_NORMAL_BLOCK * normal->columns));
  return normal->gram && normal->block ? EO_OK : eo_error_memory(error);
}

void eo_normal_done(struct eo_normal *normal)
{
  free(normal->gram);
  free(normal->block);
  *normal = (struct eo_normal){0};
}

double *eo_normal_row(struct eo_normal *normal)
{
  return normal->block + (size_t)normal->held * (size_t)normal->columns;
}

static void flush(struct eo_normal *normal)
{
  eo_dense_add_gram(normal->held, normal->columns, normal->block, normal->gram);
  normal->held = 0;
}

void eo_normal_add(struct eo_normal *normal)
{
  normal->rows++;
  if (++normal->held == EO_NORMAL_BLOCK)
    flush(normal);
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
