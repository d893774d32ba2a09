/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/surrogate.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

int eo_surrogate_terms(enum eo_tail tail, int n)
{
  return tail == EO_TAIL_LINEAR ? n + 1 : tail == EO_TAIL_SEPARABLE ? 2 * n + 1 : (n + 1) * (n + 2) / 2;
}

enum eo_code eo_surrogate_init(struct eo_surrogate *surrogate, int variables, int rows_max, int outputs_max,
                               enum eo_tail tail, struct eo_error *error)
{
  *surrogate = (struct eo_surrogate){.variables = variables, .rows_max = rows_max, .outputs_max = outputs_max};
  const int terms_max = eo_surrogate_terms(tail, variables);
  const size_t n = (size_t)variables, m = (size_t)rows_max, o = (size_t)outputs_max, q = (size_t)terms_max;
  surrogate->mean = malloc(n * sizeof(double));
  surrogate->x = malloc(n * m * sizeof(double));
  surrogate->coefficient = malloc(o * m * sizeof(double));
  surrogate->polynomial = malloc(o * q * sizeof(double));
  surrogate->residual = malloc(o * m * sizeof(double));
  surrogate->belief = malloc(m * sizeof(double));
  surrogate->distance = malloc(m * sizeof(double));
  surrogate->kernel = malloc(m * sizeof(double));
  surrogate->term = malloc(q * sizeof(double));
  surrogate->point = malloc(n * sizeof(double));
  surrogate->matrix = malloc(m * m * sizeof(double));
  surrogate->columns = malloc(q * m * sizeof(double));
  surrogate->diagonal = malloc(m * sizeof(double));
  if (surrogate->mean && surrogate->x && surrogate->coefficient && surrogate->polynomial && surrogate->residual &&
      surrogate->belief && surrogate->distance && surrogate->kernel && surrogate->term && surrogate->point &&
      surrogate->matrix && surrogate->columns && surrogate->diagonal)
    return eo_saddle_init(&surrogate->saddle, rows_max, terms_max, error);
  eo_surrogate_done(surrogate);
  return eo_error_memory(error);
}

void eo_surrogate_done(struct eo_surrogate *surrogate)
{
  free(surrogate->mean);
  free(surrogate->x);
  free(surrogate->coefficient);
  free(surrogate->polynomial);
  free(surrogate->residual);
  free(surrogate->belief);
  free(surrogate->distance);
  free(surrogate->apart);
  free(surrogate->kernel);
  free(surrogate->term);
  free(surrogate->point);
  free(surrogate->matrix);
  free(surrogate->columns);
  free(surrogate->diagonal);
  eo_saddle_done(&surrogate->saddle);
  *surrogate = (struct eo_surrogate){0};
}

enum eo_code eo_surrogate_set_blocks(struct eo_surrogate *surrogate, int blocks, const int *block,
                                     struct eo_error *error)
{
  free(surrogate->apart);
  surrogate->blocks = blocks > 1 ? blocks : 0;
  surrogate->block = block;
  surrogate->apart = malloc((size_t)surrogate->blocks * (size_t)surrogate->rows_max * sizeof(double) + 1);
  return surrogate->apart ? EO_OK : eo_error_memory(error);
}

/* p(z): 1, z_k; then z_k^2; then z_k z_l, k < l. */
static void fill_terms(enum eo_tail tail, int n, const double *z, double *term, int stride)
{
  int t = 0;
  term[stride * t++] = 1;
  for (int k = 0; k < n; k++)
    term[stride * t++] = z[k];
  for (int k = 0; k < n && tail != EO_TAIL_LINEAR; k++)
    term[stride * t++] = z[k] * z[k];
  for (int k = 0; k < n && tail == EO_TAIL_QUADRATIC; k++)
    for (int l = k + 1; l < n; l++)
      term[stride * t++] = z[k] * z[l];
}

static void copy_rows(struct eo_surrogate *surrogate, const double *x, int rows)
{
  const int n = surrogate->variables;
  for (int k = 0; k < n; k++) {
    double sum = 0;
    for (int j = 0; j < rows; j++)
      sum += x[(size_t)j * n + k];
    surrogate->mean[k] = sum / rows;
    for (int j = 0; j < rows; j++)
      surrogate->x[(size_t)k * surrogate->rows_max + j] = x[(size_t)j * n + k] - surrogate->mean[k];
  }
}

/* Distances of a point, less the mean, from the first rows, whole and within each block. */
static void measure(const struct eo_surrogate *surrogate, const double *z, int rows)
{
  const size_t stride = (size_t)surrogate->rows_max;
  double *whole = surrogate->distance;
  memset(whole, 0, (size_t)rows * sizeof *whole);
  for (int b = 0; b < surrogate->blocks; b++)
    memset(surrogate->apart + (size_t)b * stride, 0, (size_t)rows * sizeof *whole);
  for (int k = 0; k < surrogate->variables; k++) {
    const double *column = surrogate->x + (size_t)k * stride, zk = z[k];
    double *sum = surrogate->blocks ? surrogate->apart + (size_t)surrogate->block[k] * stride : whole;
    for (int j = 0; j < rows; j++)
      sum[j] += (column[j] - zk) * (column[j] - zk);
  }
  for (int b = 0; b < surrogate->blocks; b++) {
    double *part = surrogate->apart + (size_t)b * stride;
    for (int j = 0; j < rows; j++) {
      whole[j] += part[j];
      part[j] = sqrt(part[j]);
    }
  }
  for (int j = 0; j < rows; j++)
    whole[j] = sqrt(whole[j]);
}

/* The cubes of all of them: theory (H10). */
static void fill_kernel(const struct eo_surrogate *surrogate, int rows, double *kernel)
{
  const double *d = surrogate->distance;
  for (int j = 0; j < rows; j++)
    kernel[j] = d[j] * d[j] * d[j];
  for (int b = 0; b < surrogate->blocks; b++) {
    d = surrogate->apart + (size_t)b * (size_t)surrogate->rows_max;
    for (int j = 0; j < rows; j++)
      kernel[j] += d[j] * d[j] * d[j];
  }
}

static void fill_matrices(struct eo_surrogate *surrogate, double ridge)
{
  const int m = surrogate->rows;
  for (int i = 0; i < m; i++) {
    double *row = surrogate->matrix + (size_t)i * m;
    for (int k = 0; k < surrogate->variables; k++)
      surrogate->point[k] = surrogate->x[(size_t)k * surrogate->rows_max + i];
    measure(surrogate, surrogate->point, i);
    fill_kernel(surrogate, i, row);
    for (int j = 0; j < i; j++)
      surrogate->matrix[(size_t)j * m + i] = row[j];
    row[i] = ridge;
    fill_terms(surrogate->tail, surrogate->variables, surrogate->point, surrogate->columns + i, m);
  }
}

bool eo_surrogate_fit(struct eo_surrogate *surrogate, enum eo_tail tail, double ridge, const double *x, const double *y,
                      int rows, int outputs)
{
  struct eo_surrogate *this_surrogate = surrogate;
  this_surrogate->tail = tail;
  this_surrogate->rows = rows;
  this_surrogate->terms = eo_surrogate_terms(tail, this_surrogate->variables);
  this_surrogate->outputs = outputs;
  if (rows <= this_surrogate->terms || rows > this_surrogate->rows_max)
    return false;
  copy_rows(this_surrogate, x, rows);
  fill_matrices(this_surrogate, ridge);
  if (!eo_saddle_factor(&this_surrogate->saddle, rows, this_surrogate->terms, this_surrogate->matrix,
                        this_surrogate->columns))
    return false;
  eo_saddle_inverse_diagonal(&this_surrogate->saddle, this_surrogate->diagonal);
  eo_saddle_solve(&this_surrogate->saddle, outputs, y, this_surrogate->coefficient, this_surrogate->rows_max,
                  this_surrogate->polynomial);
  for (int o = 0; o < outputs; o++) {
    const double *c = this_surrogate->coefficient + (size_t)o * this_surrogate->rows_max;
    double *e = this_surrogate->residual + (size_t)o * this_surrogate->rows_max;
    for (int j = 0; j < rows; j++)
      e[j] = fabs(c[j] / this_surrogate->diagonal[j]);
  }
  return true;
}

void eo_surrogate_visit(struct eo_surrogate *surrogate, const double *x)
{
  for (int k = 0; k < surrogate->variables; k++)
    surrogate->point[k] = x[k] - surrogate->mean[k];
  measure(surrogate, surrogate->point, surrogate->rows);
  fill_kernel(surrogate, surrogate->rows, surrogate->kernel);
  fill_terms(surrogate->tail, surrogate->variables, surrogate->point, surrogate->term, 1);
}

double eo_surrogate_value(const struct eo_surrogate *surrogate, int output)
{
  const double *c = surrogate->coefficient + (size_t)output * surrogate->rows_max;
  const double *b = surrogate->polynomial + (size_t)output * surrogate->terms;
  double value = 0;
  for (int j = 0; j < surrogate->rows; j++)
    value += c[j] * surrogate->kernel[j];
  for (int t = 0; t < surrogate->terms; t++)
    value += b[t] * surrogate->term[t];
  return value;
}

void eo_surrogate_values(struct eo_surrogate *surrogate, double *value)
{
  const struct eo_surrogate *this_surrogate = surrogate;
  cblas_dgemv(CblasRowMajor, CblasNoTrans, this_surrogate->outputs, this_surrogate->rows, 1,
              this_surrogate->coefficient, this_surrogate->rows_max, this_surrogate->kernel, 1, 0, value, 1);
  cblas_dgemv(CblasRowMajor, CblasNoTrans, this_surrogate->outputs, this_surrogate->terms, 1,
              this_surrogate->polynomial, this_surrogate->terms, this_surrogate->term, 1, 1, value, 1);
}

static void add_tail_gradient(const struct eo_surrogate *surrogate, const double *b, double *gradient)
{
  const int n = surrogate->variables;
  int t = 1;
  for (int k = 0; k < n; k++)
    gradient[k] += b[t++];
  for (int k = 0; k < n && surrogate->tail != EO_TAIL_LINEAR; k++)
    gradient[k] += 2 * b[t++] * surrogate->point[k];
  for (int k = 0; k < n && surrogate->tail == EO_TAIL_QUADRATIC; k++)
    for (int l = k + 1; l < n; l++, t++) {
      gradient[k] += b[t] * surrogate->point[l];
      gradient[l] += b[t] * surrogate->point[k];
    }
}

void eo_surrogate_slope(const struct eo_surrogate *surrogate, const double *coefficient, const double *polynomial,
                        double *gradient)
{
  const double *c = coefficient, *d = surrogate->distance;
  for (int k = 0; k < surrogate->variables; k++) {
    const double *column = surrogate->x + (size_t)k * surrogate->rows_max, z = surrogate->point[k];
    const double *own = surrogate->blocks ? surrogate->apart + (size_t)surrogate->block[k] * (size_t)surrogate->rows_max
                                          : NULL;
    double sum = 0;
    for (int j = 0; j < surrogate->rows; j++)
      sum += c[j] * (d[j] + (own ? own[j] : 0)) * (z - column[j]);
    gradient[k] = 3 * sum;
  }
  add_tail_gradient(surrogate, polynomial, gradient);
}

void eo_surrogate_gradient(const struct eo_surrogate *surrogate, int output, double *gradient)
{
  eo_surrogate_slope(surrogate, surrogate->coefficient + (size_t)output * surrogate->rows_max,
                     surrogate->polynomial + (size_t)output * surrogate->terms, gradient);
}

void eo_surrogate_set_scale(struct eo_surrogate *surrogate, const double *residual, double scale)
{
  for (int j = 0; j < surrogate->rows; j++)
    surrogate->belief[j] = exp(-3 * residual[j] / scale);
}

double eo_surrogate_credibility(const struct eo_surrogate *surrogate, double length)
{
  const double negligible = 40; /* exp(-40) is below the rounding of the sum */
  const double *d = surrogate->distance;
  double nearest = INFINITY, sum = 0, believed = 0;
  for (int j = 0; j < surrogate->rows; j++)
    nearest = d[j] < nearest ? d[j] : nearest;
  for (int j = 0; j < surrogate->rows; j++) {
    const double exponent = (d[j] - nearest) / length;
    if (exponent > negligible)
      continue;
    const double w = exp(-exponent);
    sum += w;
    believed += w * surrogate->belief[j];
  }
  return exp(-nearest / (4 * length)) * believed / sum;
}
