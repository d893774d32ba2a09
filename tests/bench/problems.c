/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "problems.h"

#include "base/random.h"

#include <math.h>
#include <string.h>

enum { SPHERE, ROSENBROCK, RASTRIGIN, ACKLEY, ELLIPSOID, SCHAFFERS, GALLAGHER, RIPPLE };
static const char *const names[PROBLEMS] = {"sphere",    "rosenbrock",   "rastrigin", "ackley",
                                            "ellipsoid", "schaffers-f7", "gallagher", "ripple"};

const char *problem_name(int kind)
{
  return names[kind];
}

/* Gram-Schmidt on normal numbers. */
static void fill_rotation(struct problem *p, uint64_t instance)
{
  const int n = p->n;
  for (int i = 0; i < n; i++) {
    double *row = p->rotation + i * n, length = 0;
    for (int k = 0; k < n; k++)
      row[k] = eo_random_normal(eo_random_at(instance, 101, (uint64_t)p->kind, (uint64_t)i), (uint64_t)k);
    for (int j = 0; j < i; j++) {
      double dot = 0;
      for (int k = 0; k < n; k++)
        dot += row[k] * p->rotation[j * n + k];
      for (int k = 0; k < n; k++)
        row[k] -= dot * p->rotation[j * n + k];
    }
    for (int k = 0; k < n; k++)
      length += row[k] * row[k];
    for (int k = 0; k < n; k++)
      row[k] /= sqrt(length);
  }
}

static void fill_peaks(struct problem *p, uint64_t instance)
{
  const int n = p->n;
  for (int i = 0; i < PEAKS; i++) {
    const struct eo_random random = eo_random_at(instance, 102, 0, (uint64_t)i);
    const double condition = i == 0 ? 1000 : pow(1000, 2.0 * eo_random_index(random, 500, 100) / 99);
    for (int k = 0; k < n; k++) {
      p->peak[i][k] = i == 0 ? p->optimum[k] : eo_random_unit(random, (uint64_t)k);
      const int place = (k + eo_random_index(random, 501, n)) % n;
      p->shape[i][k] = pow(condition, (n > 1 ? 0.5 * place / (n - 1) : 0) - 0.25);
    }
  }
}

static void fill_waves(struct problem *p, uint64_t instance)
{
  for (int k = 0; k <= p->n; k++)
    for (int h = 0; h < 16; h++)
      p->wave[k][h] = eo_random_normal(eo_random_at(instance, 103, 0, (uint64_t)k), (uint64_t)h) / (1 + h / 2) *
                      (k == p->n ? 0.03 : 1);
}

void problem_init(struct problem *problem, int kind, int n, uint64_t instance)
{
  *problem = (struct problem){.kind = kind, .n = n};
  for (int k = 0; k < n; k++)
    problem->optimum[k] = 0.15 + 0.7 * eo_random_unit(eo_random_at(instance, 100, (uint64_t)kind, (uint64_t)k), 0);
  fill_rotation(problem, instance);
  if (kind == GALLAGHER)
    fill_peaks(problem, instance);
  if (kind == RIPPLE)
    fill_waves(problem, instance);
}

static double rosenbrock(const double *d, int n)
{
  double f = 0;
  for (int k = 0; k + 1 < n; k++) {
    const double a = 1 + 4.096 * d[k], b = 1 + 4.096 * d[k + 1];
    f += 100 * (a * a - b) * (a * a - b) + (a - 1) * (a - 1);
  }
  return f;
}

static double rastrigin(const double *d, int n)
{
  double f = 0;
  for (int k = 0; k < n; k++) {
    const double z = 10.24 * d[k];
    f += 10 + z * z - 10 * cos(2 * M_PI * z);
  }
  return f;
}

static double ackley(const double *d, int n)
{
  double squares = 0, cosines = 0;
  for (int k = 0; k < n; k++) {
    const double z = 65.536 * d[k];
    squares += z * z;
    cosines += cos(2 * M_PI * z);
  }
  return 20 + M_E - 20 * exp(-0.2 * sqrt(squares / n)) - exp(cosines / n);
}

static double sum_squares(const double *z, int n, double condition, double scale)
{
  double f = 0;
  for (int k = 0; k < n; k++)
    f += pow(condition, n > 1 ? (double)k / (n - 1) : 0) * scale * z[k] * scale * z[k];
  return f;
}

static double schaffers(const double *z, int n)
{
  double sum = 0;
  for (int k = 0; k + 1 < n; k++) {
    const double a = 10 * pow(10, 0.5 * k / (n - 1)) * z[k], b = 10 * pow(10, 0.5 * (k + 1) / (n - 1)) * z[k + 1];
    const double s = sqrt(a * a + b * b), wave = sin(50 * pow(s, 0.2));
    sum += sqrt(s) * (1 + wave * wave);
  }
  return sum * sum / ((n - 1) * (n - 1));
}

static double gallagher(const struct problem *p, const double *x)
{
  const int n = p->n;
  double highest = 0;
  for (int i = 0; i < PEAKS; i++) {
    double square = 0;
    for (int k = 0; k < n; k++) {
      double z = 0;
      for (int l = 0; l < n; l++)
        z += p->rotation[k * n + l] * 10 * (x[l] - p->peak[i][l]);
      square += p->shape[i][k] * z * z;
    }
    const double height = i == 0 ? 10 : 1.1 + 8.0 * (i - 1) / 99;
    highest = fmax(highest, height * exp(-square / (2 * n)));
  }
  return (10 - highest) * (10 - highest);
}

/* Like a gear: peak to peak and root mean square of a wave that the variables bend; what is left at best is a kink. */
static double ripple(const struct problem *p, const double *d)
{
  double low = INFINITY, high = -INFINITY, squares = 0;
  for (int t = 0; t < 64; t++) {
    double value = 0;
    for (int h = 0; h < 16; h++) {
      double amplitude = p->wave[p->n][h];
      for (int k = 0; k < p->n; k++)
        amplitude += p->wave[k][h] * (d[k] + (h % 3 == 0 ? d[k] * d[(k + 1) % p->n] : 0));
      value += amplitude * (h % 2 ? sin : cos)(2 * M_PI * (1 + h / 2) * t / 64.0);
    }
    low = fmin(low, value);
    high = fmax(high, value);
    squares += value * value;
  }
  return 0.4 * (high - low) + 0.6 * sqrt(squares / 64);
}

double problem_value(const struct problem *problem, const double *x)
{
  const int n = problem->n;
  double d[PROBLEM_VARIABLES], z[PROBLEM_VARIABLES];
  for (int k = 0; k < n; k++)
    d[k] = x[k] - problem->optimum[k];
  for (int k = 0; k < n; k++) {
    z[k] = 0;
    for (int l = 0; l < n; l++)
      z[k] += problem->rotation[k * n + l] * d[l];
  }
  switch (problem->kind) {
  case SPHERE:
    return sum_squares(d, n, 1, 10);
  case ROSENBROCK:
    return rosenbrock(d, n);
  case RASTRIGIN:
    return rastrigin(d, n);
  case ACKLEY:
    return ackley(d, n);
  case ELLIPSOID:
    return sum_squares(z, n, 1e6, 10);
  case SCHAFFERS:
    return schaffers(z, n);
  case GALLAGHER:
    return gallagher(problem, x);
  default:
    return ripple(problem, d);
  }
}
