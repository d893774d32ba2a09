/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/law.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/fourier.h"

enum { MAX_ORDER = 4096, MAX_ROWS = 1024, CHECKED_PHASES = 256 };

void eo_law_done(struct eo_law *law)
{
  if (!law)
    return;
  free(law->series);
  free(law->load);
  *law = (struct eo_law){0};
}

static enum eo_code reserve(struct eo_law *law, int rows, int order, struct eo_error *error)
{
  if (order < 0 || order > MAX_ORDER || rows < 1 || rows > MAX_ROWS)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A mesh law cannot have %d rows of %d harmonics.", rows, order);
  int needed = rows * eo_fourier_terms(order);
  if (needed <= law->capacity)
    return EO_OK;
  double *series = malloc(sizeof *series * needed), *load = malloc(sizeof *load * needed);
  if (!series || !load) {
    free(series);
    free(load);
    return eo_error_memory(error);
  }
  free(law->series);
  free(law->load);
  law->series = series;
  law->load = load;
  law->capacity = needed;
  law->rows = 0;
  return EO_OK;
}

enum eo_code eo_law_copy(struct eo_law *law, const struct eo_law *source, struct eo_error *error)
{
  if (!source->rows) {
    eo_law_done(law);
    return EO_OK;
  }
  enum eo_code code = reserve(law, source->rows, source->order, error);
  if (code)
    return code;
  struct eo_law copy = *source;
  copy.series = law->series;
  copy.load = law->load;
  copy.capacity = law->capacity;
  memcpy(copy.series, source->series,
         (size_t)source->rows * (size_t)eo_fourier_terms(source->order) * sizeof *copy.series);
  if (source->kind == EO_MESH_TABLE)
    memcpy(copy.load, source->load, (size_t)source->rows * sizeof *copy.load);
  *law = copy;
  return EO_OK;
}

static int all_finite(int n, const double *value)
{
  for (int i = 0; i < n; i++)
    if (!isfinite(value[i]))
      return 0;
  return 1;
}

static enum eo_code refuse_values(const char *what, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_INPUT, "", "The mesh law's %s must be finite numbers.", what);
}

/* Below this a series never comes. */
static double lower_bound(int order, const double *series)
{
  double bound = series[0];
  for (int k = 1; k <= order; k++)
    bound -= hypot(series[2 * k - 1], series[2 * k]);
  return bound;
}

/* A stiffness that is not positive somewhere would make the law meaningless, whatever the solver then does with it. */
static enum eo_code check_positive(int order, const double *series, const char *what, struct eo_error *error)
{
  bool bounded = lower_bound(order, series) > 0;
  for (int i = 0; i < CHECKED_PHASES && !bounded; i++) {
    double value = eo_fourier_value(order, series, (double)i / CHECKED_PHASES);
    if (!(value > 0))
      return eo_error_set(error, EO_ERROR_INPUT, "", "The mesh law's %s must be positive; at phase %.3f it is %g.",
                          what, (double)i / CHECKED_PHASES, value);
  }
  return EO_OK;
}

/* Takes over everything but the memory. */
static void adopt(struct eo_law *law, const struct eo_law *values)
{
  double *series = law->series, *load = law->load;
  int capacity = law->capacity;
  *law = *values;
  law->series = series;
  law->load = load;
  law->capacity = capacity;
}

enum eo_code eo_law_set_stiffness(struct eo_law *law, int order, const double *k, double front, double back,
                                  struct eo_error *error)
{
  enum eo_code code;
  if (order < 0 || !all_finite(eo_fourier_terms(order), k) || !isfinite(front) || !(back <= front))
    return refuse_values("stiffness and backlash", error);
  if ((code = check_positive(order, k, "stiffness", error)) || (code = reserve(law, 1, order, error)))
    return code;
  adopt(law, &(struct eo_law){.kind = EO_MESH_STIFFNESS, .rows = 1, .order = order, .front = front, .back = back});
  memcpy(law->series, k, sizeof *k * eo_fourier_terms(order));
  return EO_OK;
}

enum eo_code eo_law_set_power(struct eo_law *law, int order, const double *coefficient, const double *offset,
                              double exponent, double front, struct eo_error *error)
{
  enum eo_code code;
  if (order < 0 || !all_finite(eo_fourier_terms(order), coefficient) || !all_finite(eo_fourier_terms(order), offset) ||
      !isfinite(front))
    return refuse_values("coefficients", error);
  if (!(exponent >= 1 && exponent <= 10))
    return eo_error_set(error, EO_ERROR_INPUT, "", "The exponent of a power law must lie between 1 and 10, not %g.",
                        exponent);
  if ((code = check_positive(order, coefficient, "coefficient", error)) || (code = reserve(law, 2, order, error)))
    return code;
  adopt(law, &(struct eo_law){.kind = EO_MESH_POWER, .rows = 2, .order = order, .front = front, .exponent = exponent});
  memcpy(law->series, coefficient, sizeof *coefficient * eo_fourier_terms(order));
  memcpy(law->series + eo_fourier_terms(order), offset, sizeof *offset * eo_fourier_terms(order));
  return EO_OK;
}

static enum eo_code check_samples(int positions, int order, struct eo_error *error)
{
  if (positions < 1 || order < 0 || 2 * order > positions)
    return eo_error_set(error, EO_ERROR_INPUT, "", "%d mesh positions cannot carry %d harmonics.", positions, order);
  return EO_OK;
}

enum eo_code eo_law_set_table(struct eo_law *law, int rows, int positions, const double *load, const double *deflection,
                              int order, double front, struct eo_error *error)
{
  enum eo_code code = check_samples(positions, order, error);
  if (code)
    return code;
  if (rows < 2 || !all_finite(rows, load) || !all_finite(rows * positions, deflection) || !isfinite(front))
    return refuse_values("table (at least two loads)", error);
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < positions; j++)
      if (load[i] < 0 ||
          (i > 0 && !(load[i] > load[i - 1] && deflection[i * positions + j] > deflection[(i - 1) * positions + j])))
        return eo_error_set(error, EO_ERROR_INPUT, "",
                            "Loads and deflections of a mesh table must ascend; row %d does not.", i);
  if ((code = reserve(law, rows, order, error)))
    return code;
  adopt(law, &(struct eo_law){.kind = EO_MESH_TABLE, .rows = rows, .order = order, .front = front});
  memcpy(law->load, load, sizeof *load * rows);
  for (int i = 0; i < rows; i++)
    eo_fourier_series(positions, deflection + (size_t)i * positions, order,
                      law->series + (size_t)i * eo_fourier_terms(order));
  return EO_OK;
}

enum eo_code eo_law_set_tangent(struct eo_law *law, int positions, const double *deflection, const double *tangent,
                                double nominal, int order, double back, struct eo_error *error)
{
  enum eo_code code = check_samples(positions, order, error);
  if (code)
    return code;
  if (!all_finite(positions, deflection) || !all_finite(positions, tangent) || !(nominal > 0 && isfinite(nominal)) ||
      isnan(back))
    return refuse_values("deflections, stiffnesses and (positive) load", error);
  if ((code = reserve(law, 2, order, error)))
    return code;
  double *k = law->series + eo_fourier_terms(order);
  eo_fourier_series(positions, deflection, order, law->series);
  eo_fourier_series(positions, tangent, order, k);
  law->rows = 0; /* not usable until the check below has passed */
  if ((code = check_positive(order, k, "tangent stiffness", error)))
    return code;
  adopt(law, &(struct eo_law){.kind = EO_MESH_TANGENT,
                              .rows = 2,
                              .order = order,
                              .nominal = nominal,
                              .back = back,
                              .back_stiffness = k[0]});
  return EO_OK;
}

enum eo_code eo_law_set_back(struct eo_law *law, double back, double stiffness, struct eo_error *error)
{
  if (!isfinite(back) || !(back < law->front) || !(stiffness > 0 && isfinite(stiffness)))
    return eo_error_set(error, EO_ERROR_INPUT, "", "Back flanks at %g m with a stiffness of %g N/m make no backlash.",
                        back, stiffness);
  law->back = back;
  law->back_stiffness = stiffness;
  return EO_OK;
}

enum eo_code eo_law_set_secant(struct eo_law *law, int positions, const double *deflection, double nominal,
                               double datum, int order, double back, struct eo_error *error)
{
  enum eo_code code = check_samples(positions, order, error);
  if (code)
    return code;
  if (!all_finite(positions, deflection) || !(nominal > 0 && isfinite(nominal)) || !isfinite(datum) || !(back <= 0))
    return refuse_values("deflections, datum and (positive) load", error);
  double *stiffness = malloc(sizeof *stiffness * positions);
  if (!stiffness)
    return eo_error_memory(error);
  code = reserve(law, 1, order, error);
  for (int i = 0; i < positions && !code; i++) {
    stiffness[i] = nominal / (deflection[i] - datum);
    if (!(deflection[i] > datum))
      code = eo_error_set(error, EO_ERROR_INPUT, "", "The loaded deflection %g m lies before first contact at %g m.",
                          deflection[i], datum);
  }
  if (!code) {
    law->rows = 0;
    eo_fourier_series(positions, stiffness, order, law->series);
    code = check_positive(order, law->series, "secant stiffness", error);
  }
  if (!code)
    adopt(law, &(struct eo_law){.kind = EO_MESH_STIFFNESS, .rows = 1, .order = order, .front = 0, .back = back});
  free(stiffness);
  return code;
}

void eo_law_rows(const struct eo_law *law, double phase, double *row)
{
  double c = cos(2 * M_PI * phase), s = sin(2 * M_PI * phase), ck = 1, sk = 0;
  int terms = eo_fourier_terms(law->order);
  for (int i = 0; i < law->rows; i++)
    row[i] = law->series[i * terms];
  for (int k = 1; k <= law->order; k++) {
    double next = ck * c - sk * s;
    sk = sk * c + ck * s;
    ck = next;
    for (int i = 0; i < law->rows; i++)
      row[i] += law->series[i * terms + 2 * k - 1] * ck + law->series[i * terms + 2 * k] * sk;
  }
}

static struct eo_mesh_force stiffness_force(double k, double x, double front, double back, int attached)
{
  if (x > front || attached)
    return (struct eo_mesh_force){k * (x - front), k, x - front, 1}; /* theory (L1) */
  if (x < back)
    return (struct eo_mesh_force){k * (x - back), k, back - x, -1};
  if (x - front > back - x)
    return (struct eo_mesh_force){0, 0, x - front, 1};
  return (struct eo_mesh_force){0, 0, back - x, -1};
}

/* Out of contact in front by the (negative) margin: the back flanks, if there are any. */
static struct eo_mesh_force behind(const struct eo_law *law, double x, double margin)
{
  double back = law->back_stiffness > 0 ? law->back - x : -INFINITY;
  if (back > 0)
    return (struct eo_mesh_force){-law->back_stiffness * back, law->back_stiffness, back, -1};
  if (margin >= back)
    return (struct eo_mesh_force){0, 0, margin, 1};
  return (struct eo_mesh_force){0, 0, back, -1};
}

static struct eo_mesh_force power_force(const struct eo_law *law, const double *row, double x)
{
  double margin = x - law->front - row[1];
  if (margin <= 0)
    return behind(law, x, margin);
  double force = row[0] * pow(margin, law->exponent);
  return (struct eo_mesh_force){force, law->exponent * force / margin, margin, 1};
}

static struct eo_mesh_force table_force(const struct eo_law *law, const double *row, double x)
{
  double z = x - law->front;
  if (z <= row[0])
    return behind(law, x, z - row[0]);
  int low = 0, high = law->rows - 1;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (z >= row[middle])
      low = middle;
    else
      high = middle;
  }
  double slope = (law->load[low + 1] - law->load[low]) / (row[low + 1] - row[low]);
  return (struct eo_mesh_force){law->load[low] + slope * (z - row[low]), slope, z - row[0], 1}; /* theory (L3) */
}

static struct eo_mesh_force tangent_force(const struct eo_law *law, const double *row, double x, int attached)
{
  double k = row[1], force = law->nominal + k * (x - law->front - row[0]); /* theory (L2) */
  if (force > 0 || attached)
    return (struct eo_mesh_force){force, k, force / k, 1};
  return behind(law, x, force / k);
}

struct eo_mesh_force eo_law_force(const struct eo_law *law, const double *row, double x, int attached)
{
  switch (law->kind) {
  case EO_MESH_STIFFNESS:
    return stiffness_force(row[0], x, law->front, law->back, attached);
  case EO_MESH_POWER:
    return power_force(law, row, x);
  case EO_MESH_TABLE:
    return table_force(law, row, x);
  case EO_MESH_TANGENT:
    return tangent_force(law, row, x, attached);
  }
  return (struct eo_mesh_force){0};
}

int eo_law_is_affine(const struct eo_law *law)
{
  return law->kind == EO_MESH_STIFFNESS || law->kind == EO_MESH_TANGENT;
}

double eo_law_deflection(const struct eo_law *law, const double *row, double load)
{
  int i = 0;
  switch (law->kind) {
  case EO_MESH_STIFFNESS:
    return law->front + load / row[0];
  case EO_MESH_POWER:
    return law->front + row[1] + pow(load / row[0], 1 / law->exponent);
  case EO_MESH_TABLE:
    while (i < law->rows - 2 && load > law->load[i + 1])
      i++;
    return law->front + row[i] + (row[i + 1] - row[i]) * (load - law->load[i]) / (law->load[i + 1] - law->load[i]);
  case EO_MESH_TANGENT:
    return law->front + row[0] + (load - law->nominal) / row[1];
  }
  return 0;
}

bool eo_law_touches_above(const struct eo_law *law, double x)
{
  bool above = x < law->front;
  bool bounded = x < law->front + lower_bound(law->order, law->series);
  for (int i = 0; i < CHECKED_PHASES && above && !bounded; i++)
    above = x < law->front + eo_fourier_value(law->order, law->series, (double)i / CHECKED_PHASES);
  return above;
}

/* Sines change their sign. */
void eo_law_reverse(struct eo_law *law)
{
  for (int row = 0; row < law->rows; row++)
    for (int k = 1; k <= law->order; k++)
      law->series[row * eo_fourier_terms(law->order) + 2 * k] *= -1;
}

int eo_law_equal(const struct eo_law *a, const struct eo_law *b)
{
  if (a == b)
    return 1;
  return a->kind == b->kind && a->rows == b->rows && a->order == b->order && a->front == b->front &&
         a->back == b->back && a->back_stiffness == b->back_stiffness && a->exponent == b->exponent &&
         a->nominal == b->nominal &&
         !memcmp(a->series, b->series, sizeof *a->series * a->rows * eo_fourier_terms(a->order)) &&
         (a->kind != EO_MESH_TABLE || !memcmp(a->load, b->load, sizeof *a->load * a->rows));
}
