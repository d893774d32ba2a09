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

enum eo_code eo_evolution_init(struct eo_evolution *e, int variables, struct eo_error *error)
{
  const size_t n = (size_t)variables;
  *e = (struct eo_evolution){.variables = variables};
  e->mean = calloc(n, sizeof(double));
  e->covariance = calloc(n * n, sizeof(double));
  e->axes = calloc(n * n, sizeof(double));
  e->length = calloc(n, sizeof(double));
  e->path = calloc(n, sizeof(double));
  e->step_path = calloc(n, sizeof(double));
  e->steps = calloc(PARENTS_MAX * n, sizeof(double));
  e->move = calloc(2 * n, sizeof(double));
  return e->steps && e->mean && e->covariance && e->axes && e->length && e->path && e->step_path && e->move
             ? EO_OK
             : eo_error_memory(error);
}

void eo_evolution_done(struct eo_evolution *e)
{
  free(e->mean);
  free(e->covariance);
  free(e->axes);
  free(e->length);
  free(e->path);
  free(e->step_path);
  free(e->steps);
  free(e->move);
  *e = (struct eo_evolution){0};
}

void eo_evolution_restart(struct eo_evolution *e, const double *mean, double step)
{
  const int n = e->variables;
  memcpy(e->mean, mean, (size_t)n * sizeof *mean);
  memset(e->covariance, 0, (size_t)(n * n) * sizeof *e->covariance);
  memset(e->axes, 0, (size_t)(n * n) * sizeof *e->axes);
  for (int k = 0; k < n; k++) {
    e->covariance[k * n + k] = e->axes[k * n + k] = e->length[k] = 1;
    e->path[k] = e->step_path[k] = 0;
  }
  e->generations = 0;
  e->step = step;
}

void eo_evolution_sample(const struct eo_evolution *e, struct eo_random random, double *x)
{
  const int n = e->variables;
  memcpy(x, e->mean, (size_t)n * sizeof *x);
  for (int i = 0; i < n; i++) {
    const double along = e->step * e->length[i] * eo_random_normal(random, (uint64_t)i);
    for (int k = 0; k < n; k++)
      x[k] += along * e->axes[i * n + k];
  }
  for (int k = 0; k < n; k++)
    x[k] = eo_unit_clip(x[k]);
}

static void set_rates(struct rates *r, int n, int count)
{
  double sum = 0, squares = 0;
  r->parents = count / 2 < PARENTS_MAX ? count / 2 : PARENTS_MAX;
  for (int i = 0; i < r->parents; i++) {
    r->weight[i] = log(0.5 * (count + 1)) - log(i + 1);
    sum += r->weight[i];
  }
  for (int i = 0; i < r->parents; i++) {
    r->weight[i] /= sum;
    squares += r->weight[i] * r->weight[i];
  }
  const double mass = r->mass = 1 / squares;
  r->path = (4 + mass / n) / (n + 4 + 2 * mass / n);
  r->step_path = (mass + 2) / (n + mass + 5);
  r->rank_one = 2 / ((n + 1.3) * (n + 1.3) + mass);
  r->rank_many = fmin(1 - r->rank_one, 2 * (mass - 2 + 1 / mass) / ((n + 2) * (n + 2) + mass));
  r->damping = 1 + r->step_path + 2 * fmax(0, sqrt((mass - 1) / (n + 1)) - 1);
  r->normal = sqrt(n) * (1 - 1 / (4. * n) + 1 / (21. * n * n)); /* expected length of a normal vector */
}

/* steps[parents][n]: from the mean, in units of the step. Those of points that were not sampled here are cut to a
   length that a sample may well have (Hansen 2011, injecting external solutions). */
static void find_steps(struct eo_evolution *e, const struct rates *r, const double *const *x)
{
  const int n = e->variables;
  const double longest = sqrt(n) + 2. * n / (n + 2);
  for (int i = 0; i < r->parents; i++) {
    double *step = e->steps + (size_t)i * n, square = 0;
    for (int k = 0; k < n; k++)
      step[k] = (x[i][k] - e->mean[k]) / e->step;
    for (int j = 0; j < n; j++) {
      double along = 0;
      for (int k = 0; k < n; k++)
        along += e->axes[j * n + k] * step[k];
      square += along * along / (e->length[j] * e->length[j]);
    }
    const double cut = square > longest * longest ? longest / sqrt(square) : 1;
    for (int k = 0; k < n; k++)
      step[k] *= cut;
  }
}

/* move = the weighted mean of the steps; whitened = C^-1/2 move. */
static void find_move(const struct eo_evolution *e, const struct rates *r, double *move, double *whitened)
{
  const int n = e->variables;
  for (int k = 0; k < n; k++) {
    move[k] = whitened[k] = 0;
    for (int i = 0; i < r->parents; i++)
      move[k] += r->weight[i] * e->steps[i * n + k];
  }
  for (int j = 0; j < n; j++) {
    double along = 0;
    for (int k = 0; k < n; k++)
      along += e->axes[j * n + k] * move[k];
    for (int k = 0; k < n; k++)
      whitened[k] += e->axes[j * n + k] * along / e->length[j];
  }
}

/* Rank one from the path, rank mu from the steps. */
static void learn_covariance(struct eo_evolution *e, const struct rates *r, bool steady)
{
  const int n = e->variables;
  const double lost = steady ? 0 : r->rank_one * r->path * (2 - r->path);
  for (int k = 0; k < n; k++)
    for (int l = 0; l < n; l++) {
      double many = 0;
      for (int i = 0; i < r->parents; i++)
        many += r->weight[i] * e->steps[i * n + k] * e->steps[i * n + l];
      double *c = e->covariance + k * n + l;
      *c = (1 - r->rank_one - r->rank_many + lost) * *c + r->rank_one * e->path[k] * e->path[l] + r->rank_many * many;
    }
}

static bool find_axes(struct eo_evolution *e)
{
  const int n = e->variables;
  memcpy(e->axes, e->covariance, (size_t)(n * n) * sizeof *e->axes);
  if (eo_dense_symmetric_eigen(n, e->axes, e->length))
    return false;
  for (int i = 0; i < n; i++) {
    if (!(e->length[i] > 0) || !isfinite(e->length[i]))
      return false;
    e->length[i] = sqrt(e->length[i]);
  }
  return true;
}

bool eo_evolution_learn(struct eo_evolution *e, const double *const *x, int count)
{
  const int n = e->variables;
  double *move = e->move, *whitened = e->move + n, square = 0;
  struct rates r;
  set_rates(&r, n, count);
  find_steps(e, &r, x);
  find_move(e, &r, move, whitened);
  e->generations++;
  for (int k = 0; k < n; k++) {
    e->step_path[k] = (1 - r.step_path) * e->step_path[k] +
                      sqrt(r.step_path * (2 - r.step_path) * r.mass) * whitened[k];
    square += e->step_path[k] * e->step_path[k];
  }
  const double length = sqrt(square), settled = sqrt(1 - pow(1 - r.step_path, 2 * e->generations));
  const bool steady = length / settled < (1.4 + 2. / (n + 1)) * r.normal;
  for (int k = 0; k < n; k++)
    e->path[k] = (1 - r.path) * e->path[k] + (steady ? sqrt(r.path * (2 - r.path) * r.mass) * move[k] : 0);
  learn_covariance(e, &r, steady);
  for (int k = 0; k < n; k++)
    e->mean[k] += e->step * move[k];
  e->step = fmin(e->step * exp(r.step_path / r.damping * (length / r.normal - 1)), largest_step);
  return find_axes(e) && e->step > smallest_step;
}
