/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/alternating.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/dense.h"
#include "numerics/fourier.h"

enum { END_ARRAYS = 11 };

static int make_end(struct eo_time_end *end, int samples)
{
  double *all = calloc((size_t)END_ARRAYS * samples, sizeof *all);
  if (!all)
    return -1;
  double **array[END_ARRAYS] = {&end->x,     &end->v,      &end->force,        &end->elastic,
                                &end->slope, &end->margin, &end->margin_slope, &end->cell,
                                &end->gate,  &end->work,   &end->weight};
  for (int i = 0; i < END_ARRAYS; i++)
    *array[i] = all + (size_t)i * samples;
  return 0;
}

static void fill_basis(struct eo_alternating *g)
{
  int n = g->samples;
  for (int i = 0; i < n; i++)
    g->basis[i] = 1;
  for (int k = 1; k <= 2 * g->harmonics; k++)
    for (int i = 0; i < n; i++) {
      double angle = 2 * M_PI * (double)((long)k * i % n) / n;
      g->basis[(size_t)(2 * k - 1) * n + i] = cos(angle);
      g->basis[(size_t)(2 * k) * n + i] = sin(angle);
    }
}

enum eo_code eo_alternating_new(struct eo_alternating **grid, int harmonics, int samples, struct eo_error *error)
{
  if (harmonics < 1 || harmonics > EO_MAX_HARMONICS || samples <= 2 * harmonics)
    return eo_error_set(error, EO_ERROR_INPUT, "/resolution/harmonics",
                        "%d harmonics on %d samples cannot be balanced; 1 to %d harmonics are.", harmonics, samples,
                        EO_MAX_HARMONICS);
  struct eo_alternating *g = calloc(1, sizeof *g);
  if (!g)
    return eo_error_memory(error);
  g->harmonics = harmonics;
  g->samples = samples;
  g->basis = malloc(sizeof *g->basis * samples * (1 + 4 * harmonics));
  g->scratch = malloc(sizeof *g->scratch * 3 * (1 + 4 * harmonics));
  if (!g->basis || !g->scratch || make_end(&g->end[0], samples) || make_end(&g->end[1], samples)) {
    eo_alternating_free(g);
    return eo_error_memory(error);
  }
  fill_basis(g);
  *grid = g;
  return EO_OK;
}

void eo_alternating_free(struct eo_alternating *g)
{
  if (!g)
    return;
  for (int end = 0; end < 2; end++) {
    free(g->end[end].x);
    free(g->end[end].row);
  }
  free(g->basis);
  free(g->scratch);
  free(g);
}

/* The series of f(phase + shift). */
static void turn_series(int order, const double *series, double shift, double *turned)
{
  turned[0] = series[0];
  for (int k = 1; k <= order; k++) {
    double c = cos(2 * M_PI * k * shift), s = sin(2 * M_PI * k * shift);
    turned[2 * k - 1] = series[2 * k - 1] * c + series[2 * k] * s;
    turned[2 * k] = series[2 * k] * c - series[2 * k - 1] * s;
  }
}

enum eo_code eo_alternating_prepare(struct eo_alternating *g, int end, const struct eo_law *law, double shift,
                                    struct eo_error *error)
{
  struct eo_time_end *e = &g->end[end];
  int needed = g->samples * law->rows, n = g->samples;
  if (needed > e->capacity) {
    double *row = malloc(sizeof *row * needed);
    if (!row)
      return eo_error_memory(error);
    free(e->row);
    e->row = row;
    e->capacity = needed;
  }
  e->rows = law->rows;
  if (law->order > 2 * g->harmonics) {
    for (int i = 0; i < n; i++)
      eo_law_rows(law, (double)i / n + shift, e->row + (size_t)i * law->rows);
    return EO_OK;
  }
  for (int r = 0; r < law->rows; r++) {
    turn_series(law->order, law->series + (size_t)r * eo_fourier_terms(law->order), shift, g->scratch);
    eo_dense_multiply_transposed(eo_fourier_terms(law->order), n, g->basis, g->scratch, e->work);
    for (int i = 0; i < n; i++)
      e->row[(size_t)i * law->rows + r] = e->work[i];
  }
  return EO_OK;
}

/* Share of a cell in contact when the margin goes linearly from a to b. */
static double contact_share(double a, double b)
{
  if (a > 0 && b > 0)
    return 1;
  if (a <= 0 && b <= 0)
    return 0;
  return fmax(a, b) / fabs(a - b);
}

void eo_alternating_gate(struct eo_alternating *g, int end, bool gated)
{
  struct eo_time_end *e = &g->end[end];
  int n = g->samples;
  for (int i = 0; i < n; i++)
    e->cell[i] = contact_share(e->margin[i], e->margin[(i + 1) % n]);
  for (int i = 0; i < n; i++) {
    e->weight[i] = (e->cell[i] + e->cell[(i + n - 1) % n]) / 2;
    e->gate[i] = gated ? e->weight[i] : 1;
  }
}

void eo_alternating_transform(const struct eo_alternating *g, int terms, const double *sample, double *series)
{
  eo_dense_multiply(terms, g->samples, g->basis, sample, series);
  series[0] /= g->samples;
  for (int i = 1; i < terms; i++)
    series[i] *= 2.0 / g->samples;
}

void eo_alternating_synthesis(const struct eo_alternating *g, const double *series, double *sample)
{
  eo_dense_multiply_transposed(eo_fourier_terms(g->harmonics), g->samples, g->basis, series, sample);
}

static void rate_of(int harmonics, double frequency, const double *x, double *rate)
{
  rate[0] = 0;
  for (int k = 1; k <= harmonics; k++) {
    rate[2 * k - 1] = frequency * k * x[2 * k];
    rate[2 * k] = -frequency * k * x[2 * k - 1];
  }
}

void eo_alternating_force(struct eo_alternating *g, int end, const struct eo_cycle *cycle, const double *x,
                          bool attached, double *force)
{
  struct eo_time_end *e = &g->end[end];
  int n = g->samples;
  rate_of(g->harmonics, cycle->frequency, x, g->scratch);
  eo_alternating_synthesis(g, x, e->x);
  eo_alternating_synthesis(g, g->scratch, e->v);
  for (int i = 0; i < n; i++) {
    struct eo_mesh_force f = eo_law_force(cycle->law[end], e->row + (size_t)i * e->rows, e->x[i], attached);
    e->elastic[i] = f.force;
    e->slope[i] = f.slope;
    e->margin[i] = f.margin;
    e->margin_slope[i] = f.margin_slope;
  }
  eo_alternating_gate(g, end, cycle->gated);
  for (int i = 0; i < n; i++) {
    if (attached)
      e->weight[i] = e->gate[i] = 1;
    e->force[i] = e->weight[i] * e->elastic[i] + cycle->mesh_damping * e->gate[i] * e->v[i];
  }
  eo_alternating_transform(g, eo_fourier_terms(g->harmonics), e->force, force);
}

/* With a = mean of f cos n, b = mean of f sin n: adds the matrix of x -> series of f x. */
static void add_multiplication(int harmonics, const double *a, const double *b, int stride, double *matrix)
{
  matrix[0] += a[0];
  for (int l = 1; l <= harmonics; l++) {
    matrix[2 * l - 1] += a[l];
    matrix[2 * l] += b[l];
    matrix[(size_t)(2 * l - 1) * stride] += 2 * a[l];
    matrix[(size_t)(2 * l) * stride] += 2 * b[l];
  }
  for (int k = 1; k <= harmonics; k++) {
    double *cosine = matrix + (size_t)(2 * k - 1) * stride, *sine = cosine + stride;
    for (int l = 1; l <= harmonics; l++) {
      int apart = abs(k - l);
      double together_a = a[k + l], together_b = b[k + l], apart_b = k >= l ? b[apart] : -b[apart];
      cosine[2 * l - 1] += a[apart] + together_a;
      cosine[2 * l] += together_b - apart_b;
      sine[2 * l - 1] += together_b + apart_b;
      sine[2 * l] += a[apart] - together_a;
    }
  }
}

/* The same for x -> series of f dx/dt. */
static void add_rate_multiplication(int harmonics, double frequency, const double *a, const double *b, int stride,
                                    double *matrix)
{
  for (int l = 1; l <= harmonics; l++) {
    matrix[2 * l - 1] -= frequency * l * b[l];
    matrix[2 * l] += frequency * l * a[l];
  }
  for (int k = 1; k <= harmonics; k++) {
    double *cosine = matrix + (size_t)(2 * k - 1) * stride, *sine = cosine + stride;
    for (int l = 1; l <= harmonics; l++) {
      int apart = abs(k - l);
      double together_a = a[k + l], together_b = b[k + l], apart_b = k >= l ? b[apart] : -b[apart],
             rate = frequency * l;
      cosine[2 * l - 1] -= rate * (together_b - apart_b);
      cosine[2 * l] += rate * (a[apart] + together_a);
      sine[2 * l - 1] -= rate * (a[apart] - together_a);
      sine[2 * l] += rate * (together_b + apart_b);
    }
  }
}

/* Means of f cos n and f sin n up to n = 2 harmonics, in scratch. */
static void moments(struct eo_alternating *g, const double *f, double **a, double **b)
{
  int order = 2 * g->harmonics, terms = eo_fourier_terms(order);
  double *series = g->scratch;
  *a = g->scratch + terms;
  *b = g->scratch + 2 * terms;
  eo_alternating_transform(g, terms, f, series);
  (*a)[0] = series[0];
  (*b)[0] = 0;
  for (int k = 1; k <= order; k++) {
    (*a)[k] = series[2 * k - 1] / 2;
    (*b)[k] = series[2 * k] / 2;
  }
}

/* The share of a cell in which contact begins or ends depends on both its margins: one rank-one term per such cell. */
static void add_crossings(struct eo_alternating *g, const struct eo_time_end *e, double damping, int stride,
                          double *matrix)
{
  /* row: the forces whose weights change; column: how the share changes with the deflections */
  int n = g->samples, terms = eo_fourier_terms(g->harmonics);
  double *row = g->scratch, *column = g->scratch + terms;
  for (int i = 0; i < n; i++) {
    int next = (i + 1) % n;
    double a = e->margin[i], b = e->margin[next];
    if ((a > 0) == (b > 0))
      continue;
    double here = e->elastic[i] + damping * e->v[i], there = e->elastic[next] + damping * e->v[next];
    double width = (a - b) * (a - b), sign = a > b ? 1 : -1;
    double slope_a = -sign * b / width * e->margin_slope[i], slope_b = sign * a / width * e->margin_slope[next];
    for (int t = 0; t < terms; t++) {
      const double *basis = g->basis + (size_t)t * n;
      row[t] = (t ? 1.0 : 0.5) * (here * basis[i] + there * basis[next]) / n;
      column[t] = slope_a * basis[i] + slope_b * basis[next];
    }
    for (int s = 0; s < terms; s++)
      for (int t = 0; t < terms; t++)
        matrix[(size_t)s * stride + t] += row[s] * column[t];
  }
}

void eo_alternating_jacobian(struct eo_alternating *g, int end, const struct eo_cycle *cycle, bool attached, int stride,
                             double *jacobian)
{
  struct eo_time_end *e = &g->end[end];
  double *a, *b;
  for (int i = 0; i < g->samples; i++)
    e->work[i] = e->weight[i] * e->slope[i];
  moments(g, e->work, &a, &b);
  add_multiplication(g->harmonics, a, b, stride, jacobian);
  if (!attached)
    add_crossings(g, e, cycle->gated ? cycle->mesh_damping : 0, stride, jacobian);
  if (cycle->mesh_damping == 0)
    return;
  moments(g, e->gate, &a, &b);
  for (int k = 0; k <= 2 * g->harmonics; k++) {
    a[k] *= cycle->mesh_damping;
    b[k] *= cycle->mesh_damping;
  }
  add_rate_multiplication(g->harmonics, cycle->frequency, a, b, stride, jacobian);
}

void eo_alternating_frequency_slope(struct eo_alternating *g, int end, const struct eo_cycle *cycle, double *slope)
{
  struct eo_time_end *e = &g->end[end];
  for (int i = 0; i < g->samples; i++)
    e->work[i] = cycle->mesh_damping * e->gate[i] * e->v[i] / cycle->frequency;
  eo_alternating_transform(g, eo_fourier_terms(g->harmonics), e->work, slope);
}

double eo_alternating_loss(const struct eo_alternating *g, int end)
{
  double contact = 0;
  for (int i = 0; i < g->samples; i++)
    contact += g->end[end].cell[i];
  return fmax(0, 1 - contact / g->samples);
}
