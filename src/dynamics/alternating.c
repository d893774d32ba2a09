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

static void fill_basis(struct eo_alternating *alternating)
{
  int n = alternating->samples;
  for (int i = 0; i < n; i++)
    alternating->basis[i] = 1;
  for (int k = 1; k <= 2 * alternating->harmonics; k++)
    for (int i = 0; i < n; i++) {
      double angle = 2 * M_PI * (double)((long)k * i % n) / n;
      alternating->basis[(size_t)(2 * k - 1) * n + i] = cos(angle);
      alternating->basis[(size_t)(2 * k) * n + i] = sin(angle);
    }
}

enum eo_code eo_alternating_new(struct eo_alternating **grid, int harmonics, int samples, struct eo_error *error)
{
  if (harmonics < 1 || harmonics > EO_MAX_HARMONICS || samples <= 2 * harmonics)
    return eo_error_set(error, EO_ERROR_INPUT, "/resolution/harmonics",
                        "%d harmonics on %d samples cannot be balanced; 1 to %d harmonics are.", harmonics, samples,
                        EO_MAX_HARMONICS);
  struct eo_alternating *alternating = calloc(1, sizeof *alternating);
  if (!alternating)
    return eo_error_memory(error);
  alternating->harmonics = harmonics;
  alternating->samples = samples;
  alternating->basis = malloc(sizeof *alternating->basis * samples * (1 + 4 * harmonics));
  alternating->scratch = malloc(sizeof *alternating->scratch * 3 * (1 + 4 * harmonics));
  if (!alternating->basis || !alternating->scratch || make_end(&alternating->end[0], samples) ||
      make_end(&alternating->end[1], samples)) {
    eo_alternating_free(alternating);
    return eo_error_memory(error);
  }
  fill_basis(alternating);
  *grid = alternating;
  return EO_OK;
}

void eo_alternating_free(struct eo_alternating *alternating)
{
  if (!alternating)
    return;
  for (int end = 0; end < 2; end++) {
    free(alternating->end[end].x);
    free(alternating->end[end].row);
  }
  free(alternating->basis);
  free(alternating->scratch);
  free(alternating);
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

enum eo_code eo_alternating_prepare(struct eo_alternating *alternating, int end, const struct eo_law *law, double shift,
                                    struct eo_error *error)
{
  struct eo_time_end *time_end = &alternating->end[end];
  int needed = alternating->samples * law->rows, n = alternating->samples;
  if (needed > time_end->capacity) {
    double *row = malloc(sizeof *row * needed);
    if (!row)
      return eo_error_memory(error);
    free(time_end->row);
    time_end->row = row;
    time_end->capacity = needed;
  }
  time_end->rows = law->rows;
  if (law->order > 2 * alternating->harmonics) {
    for (int i = 0; i < n; i++)
      eo_law_rows(law, (double)i / n + shift, time_end->row + (size_t)i * law->rows);
    return EO_OK;
  }
  for (int r = 0; r < law->rows; r++) {
    turn_series(law->order, law->series + (size_t)r * eo_fourier_terms(law->order), shift, alternating->scratch);
    eo_dense_multiply_transposed(eo_fourier_terms(law->order), n, alternating->basis, alternating->scratch,
                                 time_end->work);
    for (int i = 0; i < n; i++)
      time_end->row[(size_t)i * law->rows + r] = time_end->work[i];
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

void eo_alternating_gate(struct eo_alternating *alternating, int end, bool gated)
{
  struct eo_time_end *time_end = &alternating->end[end];
  int n = alternating->samples;
  for (int i = 0; i < n; i++)
    time_end->cell[i] = contact_share(time_end->margin[i], time_end->margin[(i + 1) % n]);
  for (int i = 0; i < n; i++) {
    time_end->weight[i] = (time_end->cell[i] + time_end->cell[(i + n - 1) % n]) / 2;
    time_end->gate[i] = gated ? time_end->weight[i] : 1;
  }
}

void eo_alternating_transform(const struct eo_alternating *alternating, int terms, const double *sample, double *series)
{
  eo_dense_multiply(terms, alternating->samples, alternating->basis, sample, series);
  series[0] /= alternating->samples;
  for (int i = 1; i < terms; i++)
    series[i] *= 2.0 / alternating->samples;
}

void eo_alternating_synthesis(const struct eo_alternating *alternating, const double *series, double *sample)
{
  eo_dense_multiply_transposed(eo_fourier_terms(alternating->harmonics), alternating->samples, alternating->basis,
                               series, sample);
}

static void rate_of(int harmonics, double frequency, const double *x, double *rate)
{
  rate[0] = 0;
  for (int k = 1; k <= harmonics; k++) {
    rate[2 * k - 1] = frequency * k * x[2 * k];
    rate[2 * k] = -frequency * k * x[2 * k - 1];
  }
}

void eo_alternating_force(struct eo_alternating *alternating, int end, const struct eo_cycle *cycle, const double *x,
                          bool attached, double *force)
{
  struct eo_time_end *time_end = &alternating->end[end];
  int n = alternating->samples;
  rate_of(alternating->harmonics, cycle->frequency, x, alternating->scratch);
  eo_alternating_synthesis(alternating, x, time_end->x);
  eo_alternating_synthesis(alternating, alternating->scratch, time_end->v);
  for (int i = 0; i < n; i++) {
    struct eo_mesh_force mesh_force = eo_law_force(cycle->law[end], time_end->row + (size_t)i * time_end->rows,
                                                   time_end->x[i], attached);
    time_end->elastic[i] = mesh_force.force;
    time_end->slope[i] = mesh_force.slope;
    time_end->margin[i] = mesh_force.margin;
    time_end->margin_slope[i] = mesh_force.margin_slope;
  }
  eo_alternating_gate(alternating, end, cycle->gated);
  for (int i = 0; i < n; i++) {
    if (attached)
      time_end->weight[i] = time_end->gate[i] = 1;
    time_end->force[i] = time_end->weight[i] * time_end->elastic[i] +
                         cycle->mesh_damping * time_end->gate[i] * time_end->v[i];
  }
  eo_alternating_transform(alternating, eo_fourier_terms(alternating->harmonics), time_end->force, force);
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
static void moments(struct eo_alternating *alternating, const double *f, double **a, double **b)
{
  int order = 2 * alternating->harmonics, terms = eo_fourier_terms(order);
  double *series = alternating->scratch;
  *a = alternating->scratch + terms;
  *b = alternating->scratch + 2 * terms;
  eo_alternating_transform(alternating, terms, f, series);
  (*a)[0] = series[0];
  (*b)[0] = 0;
  for (int k = 1; k <= order; k++) {
    (*a)[k] = series[2 * k - 1] / 2;
    (*b)[k] = series[2 * k] / 2;
  }
}

/* The share of a cell in which contact begins or ends depends on both its margins: one rank-one term per such cell. */
static void add_crossings(struct eo_alternating *alternating, const struct eo_time_end *time_end, double damping,
                          int stride, double *matrix)
{
  /* row: the forces whose weights change; column: how the share changes with the deflections */
  int n = alternating->samples, terms = eo_fourier_terms(alternating->harmonics);
  double *row = alternating->scratch, *column = alternating->scratch + terms;
  for (int i = 0; i < n; i++) {
    int next = (i + 1) % n;
    double a = time_end->margin[i], b = time_end->margin[next];
    if ((a > 0) == (b > 0))
      continue;
    double here = time_end->elastic[i] + damping * time_end->v[i],
           there = time_end->elastic[next] + damping * time_end->v[next];
    double width = (a - b) * (a - b), sign = a > b ? 1 : -1;
    double slope_a = -sign * b / width * time_end->margin_slope[i],
           slope_b = sign * a / width * time_end->margin_slope[next];
    for (int t = 0; t < terms; t++) {
      const double *basis = alternating->basis + (size_t)t * n;
      row[t] = (t ? 1.0 : 0.5) * (here * basis[i] + there * basis[next]) / n;
      column[t] = slope_a * basis[i] + slope_b * basis[next];
    }
    for (int s = 0; s < terms; s++)
      for (int t = 0; t < terms; t++)
        matrix[(size_t)s * stride + t] += row[s] * column[t];
  }
}

void eo_alternating_jacobian(struct eo_alternating *alternating, int end, const struct eo_cycle *cycle, bool attached,
                             int stride, double *jacobian)
{
  struct eo_time_end *time_end = &alternating->end[end];
  double *a, *b;
  for (int i = 0; i < alternating->samples; i++)
    time_end->work[i] = time_end->weight[i] * time_end->slope[i];
  moments(alternating, time_end->work, &a, &b);
  add_multiplication(alternating->harmonics, a, b, stride, jacobian);
  if (!attached)
    add_crossings(alternating, time_end, cycle->gated ? cycle->mesh_damping : 0, stride, jacobian);
  if (cycle->mesh_damping == 0)
    return;
  moments(alternating, time_end->gate, &a, &b);
  for (int k = 0; k <= 2 * alternating->harmonics; k++) {
    a[k] *= cycle->mesh_damping;
    b[k] *= cycle->mesh_damping;
  }
  add_rate_multiplication(alternating->harmonics, cycle->frequency, a, b, stride, jacobian);
}

void eo_alternating_frequency_slope(struct eo_alternating *alternating, int end, const struct eo_cycle *cycle,
                                    double *slope)
{
  struct eo_time_end *time_end = &alternating->end[end];
  for (int i = 0; i < alternating->samples; i++)
    time_end->work[i] = cycle->mesh_damping * time_end->gate[i] * time_end->v[i] / cycle->frequency;
  eo_alternating_transform(alternating, eo_fourier_terms(alternating->harmonics), time_end->work, slope);
}

double eo_alternating_loss(const struct eo_alternating *alternating, int end)
{
  double contact = 0;
  for (int i = 0; i < alternating->samples; i++)
    contact += alternating->end[end].cell[i];
  return fmax(0, 1 - contact / alternating->samples);
}
