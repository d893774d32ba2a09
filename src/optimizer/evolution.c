/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/evolution.h"

#include "numerics/dense.h"
#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double smallest_step = 1e-10, largest_step = 0.5;

enum { PARENTS_MAX = 32 };

/* How fast what is learnt; names and values as in Hansen 2016, table 1. */
struct rates {
  int parents;
  double weight[PARENTS_MAX]; /* [parents], falling, sum 1 */
  double mass;                /* mu_eff */
  double path, step_path, rank_one, rank_many, damping, normal;
};

enum eo_code eo_evolution_init(struct eo_evolution *evolution, int variables, struct eo_error *error)
{
  const size_t n = (size_t)variables;
  *evolution = (struct eo_evolution){.variables = variables};
  evolution->mean = calloc(n, sizeof(double));
  evolution->covariance = calloc(n * n, sizeof(double));
  evolution->axes = calloc(n * n, sizeof(double));
  evolution->length = calloc(n, sizeof(double));
  evolution->path = calloc(n, sizeof(double));
  evolution->step_path = calloc(n, sizeof(double));
  evolution->steps = calloc(PARENTS_MAX * n, sizeof(double));
  evolution->move = calloc(2 * n, sizeof(double));
  return evolution->steps && evolution->mean && evolution->covariance && evolution->axes && evolution->length &&
                 evolution->path && evolution->step_path && evolution->move
             ? EO_OK
             : eo_error_memory(error);
}

void eo_evolution_done(struct eo_evolution *evolution)
{
  free(evolution->mean);
  free(evolution->covariance);
  free(evolution->axes);
  free(evolution->length);
  free(evolution->path);
  free(evolution->step_path);
  free(evolution->steps);
  free(evolution->move);
  *evolution = (struct eo_evolution){0};
}

void eo_evolution_restart(struct eo_evolution *evolution, const double *mean, double step)
{
  const int n = evolution->variables;
  memcpy(evolution->mean, mean, (size_t)n * sizeof *mean);
  memset(evolution->covariance, 0, (size_t)(n * n) * sizeof *evolution->covariance);
  memset(evolution->axes, 0, (size_t)(n * n) * sizeof *evolution->axes);
  for (int k = 0; k < n; k++) {
    evolution->covariance[k * n + k] = evolution->axes[k * n + k] = evolution->length[k] = 1;
    evolution->path[k] = evolution->step_path[k] = 0;
  }
  evolution->generations = 0;
  evolution->step = step;
}

void eo_evolution_sample(const struct eo_evolution *evolution, struct eo_random random, double *x)
{
  const int n = evolution->variables;
  memcpy(x, evolution->mean, (size_t)n * sizeof *x);
  for (int i = 0; i < n; i++) {
    const double along = evolution->step * evolution->length[i] * eo_random_normal(random, (uint64_t)i);
    for (int k = 0; k < n; k++)
      x[k] += along * evolution->axes[i * n + k];
  }
  for (int k = 0; k < n; k++)
    x[k] = eo_unit_clip(x[k]);
}

static void set_rates(struct rates *rates, int n, int count)
{
  double sum = 0, squares = 0;
  rates->parents = count / 2 < PARENTS_MAX ? count / 2 : PARENTS_MAX;
  for (int i = 0; i < rates->parents; i++) {
    rates->weight[i] = log(0.5 * (count + 1)) - log(i + 1);
    sum += rates->weight[i];
  }
  for (int i = 0; i < rates->parents; i++) {
    rates->weight[i] /= sum;
    squares += rates->weight[i] * rates->weight[i];
  }
  const double mass = rates->mass = 1 / squares;
  rates->path = (4 + mass / n) / (n + 4 + 2 * mass / n);
  rates->step_path = (mass + 2) / (n + mass + 5);
  rates->rank_one = 2 / ((n + 1.3) * (n + 1.3) + mass);
  rates->rank_many = fmin(1 - rates->rank_one, 2 * (mass - 2 + 1 / mass) / ((n + 2) * (n + 2) + mass));
  rates->damping = 1 + rates->step_path + 2 * fmax(0, sqrt((mass - 1) / (n + 1)) - 1);
  rates->normal = sqrt(n) * (1 - 1 / (4. * n) + 1 / (21. * n * n)); /* expected length of a normal vector */
}

/* steps[parents][n]: from the mean, in units of the step. Those of points that were not sampled here are cut to a
   length that a sample may well have (Hansen 2011, injecting external solutions). */
static void find_steps(struct eo_evolution *evolution, const struct rates *rates, const double *const *x)
{
  const int n = evolution->variables;
  const double longest = sqrt(n) + 2. * n / (n + 2);
  for (int i = 0; i < rates->parents; i++) {
    double *step = evolution->steps + (size_t)i * n, square = 0;
    for (int k = 0; k < n; k++)
      step[k] = (x[i][k] - evolution->mean[k]) / evolution->step;
    for (int j = 0; j < n; j++) {
      double along = 0;
      for (int k = 0; k < n; k++)
        along += evolution->axes[j * n + k] * step[k];
      square += along * along / (evolution->length[j] * evolution->length[j]);
    }
    const double cut = square > longest * longest ? longest / sqrt(square) : 1;
    for (int k = 0; k < n; k++)
      step[k] *= cut;
  }
}

/* move = the weighted mean of the steps; whitened = C^-1/2 move. */
static void find_move(const struct eo_evolution *evolution, const struct rates *rates, double *move, double *whitened)
{
  const int n = evolution->variables;
  for (int k = 0; k < n; k++) {
    move[k] = whitened[k] = 0;
    for (int i = 0; i < rates->parents; i++)
      move[k] += rates->weight[i] * evolution->steps[i * n + k];
  }
  for (int j = 0; j < n; j++) {
    double along = 0;
    for (int k = 0; k < n; k++)
      along += evolution->axes[j * n + k] * move[k];
    for (int k = 0; k < n; k++)
      whitened[k] += evolution->axes[j * n + k] * along / evolution->length[j];
  }
}

/* Rank one from the path, rank mu from the steps. */
static void learn_covariance(struct eo_evolution *evolution, const struct rates *rates, bool steady)
{
  const int n = evolution->variables;
  const double lost = steady ? 0 : rates->rank_one * rates->path * (2 - rates->path);
  for (int k = 0; k < n; k++)
    for (int l = 0; l < n; l++) {
      double many = 0;
      for (int i = 0; i < rates->parents; i++)
        many += rates->weight[i] * evolution->steps[i * n + k] * evolution->steps[i * n + l];
      double *c = evolution->covariance + k * n + l;
      *c = (1 - rates->rank_one - rates->rank_many + lost) * *c +
           rates->rank_one * evolution->path[k] * evolution->path[l] + rates->rank_many * many;
    }
}

static bool find_axes(struct eo_evolution *evolution)
{
  const int n = evolution->variables;
  memcpy(evolution->axes, evolution->covariance, (size_t)(n * n) * sizeof *evolution->axes);
  if (eo_dense_symmetric_eigen(n, evolution->axes, evolution->length))
    return false;
  for (int i = 0; i < n; i++) {
    if (!(evolution->length[i] > 0) || !isfinite(evolution->length[i]))
      return false;
    evolution->length[i] = sqrt(evolution->length[i]);
  }
  return true;
}

bool eo_evolution_learn(struct eo_evolution *evolution, const double *const *x, int count)
{
  const int n = evolution->variables;
  double *move = evolution->move, *whitened = evolution->move + n, square = 0;
  struct rates rates;
  set_rates(&rates, n, count);
  find_steps(evolution, &rates, x);
  find_move(evolution, &rates, move, whitened);
  evolution->generations++;
  for (int k = 0; k < n; k++) {
    evolution->step_path[k] = (1 - rates.step_path) * evolution->step_path[k] +
                              sqrt(rates.step_path * (2 - rates.step_path) * rates.mass) * whitened[k];
    square += evolution->step_path[k] * evolution->step_path[k];
  }
  const double length = sqrt(square), settled = sqrt(1 - pow(1 - rates.step_path, 2 * evolution->generations));
  const bool steady = length / settled < (1.4 + 2. / (n + 1)) * rates.normal;
  for (int k = 0; k < n; k++)
    evolution->path[k] = (1 - rates.path) * evolution->path[k] +
                         (steady ? sqrt(rates.path * (2 - rates.path) * rates.mass) * move[k] : 0);
  learn_covariance(evolution, &rates, steady);
  for (int k = 0; k < n; k++)
    evolution->mean[k] += evolution->step * move[k];
  evolution->step = fmin(evolution->step * exp(rates.step_path / rates.damping * (length / rates.normal - 1)),
                         largest_step);
  return find_axes(evolution) && evolution->step > smallest_step;
}
