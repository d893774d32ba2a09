/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/composite.h"

#include "numerics/minimise.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum eo_code eo_composite_init(struct eo_composite *composite, const struct eo_anatomy *anatomy, int variables,
                               int rows_max, enum eo_tail tail, struct eo_error *error)
{
  const size_t outputs = 1 + (size_t)anatomy->parts, rows = (size_t)rows_max;
  *composite = (struct eo_composite){.anatomy = anatomy};
  composite->y = malloc(outputs * rows * sizeof(double));
  composite->part = malloc(outputs * sizeof(double));
  composite->residual = malloc(rows * sizeof(double));
  composite->coefficient = malloc(rows * sizeof(double));
  composite->polynomial = malloc((size_t)eo_surrogate_terms(tail, variables) * sizeof(double));
  composite->weight = malloc(outputs * sizeof(double));
  composite->size = malloc(((size_t)anatomy->groups + 1) * sizeof(double));
  if (!composite->weight || !composite->size)
    return eo_error_memory(error);
  if (!composite->y || !composite->part || !composite->residual || !composite->coefficient || !composite->polynomial)
    return eo_error_memory(error);
  const enum eo_code code = eo_surrogate_init(&composite->surrogate, variables, rows_max, (int)outputs, tail, error);
  return code ? code : eo_surrogate_set_blocks(&composite->surrogate, anatomy->blocks, anatomy->block, error);
}

void eo_composite_done(struct eo_composite *composite)
{
  free(composite->y);
  free(composite->part);
  free(composite->residual);
  free(composite->coefficient);
  free(composite->polynomial);
  free(composite->weight);
  free(composite->size);
  eo_surrogate_done(&composite->surrogate);
  *composite = (struct eo_composite){0};
}

bool eo_composite_takes(const struct eo_composite *composite, const struct eo_archive *archive, int row)
{
  return !eo_archive_failed(archive, row) && (composite->anatomy->parts == 0 || archive->whole[row]);
}

/* The value of parts[1 + parts] as the composite gives it. */
/* theory (H7) */
static double put_together(const struct eo_composite *composite, const double *part)
{
  return part[0] + eo_anatomy_sum(composite->anatomy, part + 1) / composite->scale;
}

static void set_right_sides(struct eo_composite *composite, const struct eo_composite_rows *rows)
{
  const int parts = composite->anatomy->parts, count = rows->count;
  for (int j = 0; j < count; j++) {
    const double *part = parts ? rows->archive->part + (size_t)rows->row[j] * (size_t)parts : NULL;
    const double rest = (rows->value[j] - rows->offset - eo_anatomy_sum(composite->anatomy, part)) / rows->scale;
    composite->y[j] = parts ? fmin(rest, rows->most_rest) : rest;
    for (int o = 0; o < parts; o++)
      composite->y[(size_t)(1 + o) * (size_t)count + (size_t)j] = part[o];
  }
}

/* What the other rows say of each, put together, against what it is. */
static void leave_one_out(struct eo_composite *composite)
{
  const struct eo_surrogate *surrogate = &composite->surrogate;
  const int outputs = 1 + composite->anatomy->parts, rows = surrogate->rows;
  for (int j = 0; j < rows; j++) {
    if (outputs == 1) {
      composite->residual[j] = surrogate->residual[j];
      continue;
    }
    for (int o = 0; o < outputs; o++)
      composite->part[o] = composite->y[(size_t)o * (size_t)rows + (size_t)j];
    const double known = put_together(composite, composite->part);
    for (int o = 0; o < outputs; o++)
      composite->part[o] -= surrogate->coefficient[(size_t)o * (size_t)surrogate->rows_max + (size_t)j] /
                            surrogate->diagonal[j];
    composite->residual[j] = fabs(put_together(composite, composite->part) - known);
  }
}

static void measure_groups(struct eo_composite *composite, const struct eo_composite_rows *rows)
{
  const struct eo_anatomy *anatomy = composite->anatomy;
  for (int g = 0, first = 0; g < anatomy->groups; first += anatomy->group[g++].count) {
    composite->size[g] = 0;
    for (int j = 0; j < rows->count; j++) {
      int most, least;
      const double *part = rows->archive->part + (size_t)rows->row[j] * (size_t)anatomy->parts + first;
      composite->size[g] += fabs(eo_anatomy_reduce(&anatomy->group[g], part, &most, &least)) / rows->count;
    }
  }
}

bool eo_composite_fit(struct eo_composite *composite, enum eo_tail tail, double ridge,
                      const struct eo_composite_rows *rows)
{
  composite->offset = rows->offset;
  composite->scale = rows->scale;
  set_right_sides(composite, rows);
  if (!eo_surrogate_fit(&composite->surrogate, tail, ridge, rows->x, composite->y, rows->count,
                        1 + composite->anatomy->parts))
    return false;
  leave_one_out(composite);
  measure_groups(composite, rows);
  return true;
}

/* The weights of all outputs in the gradient at the visited point, and the value there. */
static double weigh(struct eo_composite *composite)
{
  const struct eo_anatomy *anatomy = composite->anatomy;
  double value = composite->part[0];
  memset(composite->weight, 0, (1 + (size_t)anatomy->parts) * sizeof(double));
  composite->weight[0] = 1;
  for (int g = 0, first = 1; g < anatomy->groups; first += anatomy->group[g++].count) {
    const double weight = anatomy->group[g].weight / composite->scale,
                 softness = composite->softness * composite->size[g];
    double *own = composite->weight + first;
    if (softness > 0 && anatomy->group[g].count > 1) {
      value += weight * eo_anatomy_soften(&anatomy->group[g], composite->part + first, softness, own);
      for (int i = 0; i < anatomy->group[g].count; i++)
        own[i] *= weight;
      continue;
    }
    int most, least;
    value += weight * eo_anatomy_reduce(&anatomy->group[g], composite->part + first, &most, &least);
    own[most] += weight;
    if (least >= 0)
      own[least] -= weight;
  }
  return value;
}

double eo_composite_value(struct eo_composite *composite, const double *x)
{
  eo_surrogate_visit(&composite->surrogate, x);
  if (composite->anatomy->parts == 0)
    return composite->part[0] = eo_surrogate_value(&composite->surrogate, 0);
  eo_surrogate_values(&composite->surrogate, composite->part);
  return weigh(composite);
}

void eo_composite_gradient(struct eo_composite *composite, double *gradient)
{
  struct eo_surrogate *surrogate = &composite->surrogate;
  if (composite->anatomy->parts == 0) {
    eo_surrogate_gradient(surrogate, 0, gradient);
    return;
  }
  cblas_dgemv(CblasRowMajor, CblasTrans, surrogate->outputs, surrogate->rows, 1, surrogate->coefficient,
              surrogate->rows_max, composite->weight, 1, 0, composite->coefficient, 1);
  cblas_dgemv(CblasRowMajor, CblasTrans, surrogate->outputs, surrogate->terms, 1, surrogate->polynomial,
              surrogate->terms, composite->weight, 1, 0, composite->polynomial, 1);
  eo_surrogate_slope(surrogate, composite->coefficient, composite->polynomial, gradient);
}

static double value_and_gradient(void *context, const double *x, double *gradient)
{
  const double value = eo_composite_value(context, x);
  eo_composite_gradient(context, gradient);
  return value;
}

double eo_composite_minimise(struct eo_composite *composite, const double *low, const double *high, int steps,
                             double tolerance, double *x)
{
  static const double softness[] = {0.1,
                                    0.01}; /* where the range of a curve is the aim: a tenth of a usual one first */
  const int n = composite->surrogate.variables;
  for (int stage = 0; stage < 2 && composite->anatomy->parts; stage++) {
    composite->softness = softness[stage];
    eo_minimise(value_and_gradient, composite, low, high, n, steps / 2, tolerance, x);
  }
  composite->softness = 0;
  return eo_minimise(value_and_gradient, composite, low, high, n, composite->anatomy->parts ? steps / 4 : steps,
                     tolerance, x);
}
