/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the optimizers against closed forms: random numbers, saddle points, minimisation, surrogates, history,
   Pareto. */
#include "base/random.h"
#include "numerics/factor.h"
#include "numerics/minimise.h"
#include "optimizer/evolution.h"
#include "optimizer/prediction_history.h"
#include "optimizer/operators.h"
#include "optimizer/pareto.h"
#include "optimizer/surrogate.h"
#include "support/hypervolume.h"
#include "support/tap.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static double unit(int i, int k)
{
  return eo_random_unit(eo_random_at(77, 5, 0, (uint64_t)i), (uint64_t)k);
}

static void test_random(void)
{
  enum { COUNT = 20000 };
  double mean = 0, square = 0, normal = 0, normal_square = 0, product = 0;
  for (int i = 0; i < COUNT; i++) {
    const double u = unit(i, 0), z = eo_random_normal(eo_random_at(1, 2, 3, (uint64_t)i), 0);
    mean += u / COUNT;
    square += u * u / COUNT;
    product += u * unit(i, 1) / COUNT;
    normal += z / COUNT;
    normal_square += z * z / COUNT;
  }
  close_to(mean, 0.5, 0.01, "mean of uniform numbers");
  close_to(square, 1.0 / 3, 0.01, "second moment of uniform numbers");
  close_to(product, 0.25, 0.01, "mean product of neighbouring draws");
  close_to(normal, 0, 0.03, "mean of normal numbers");
  close_to(normal_square, 1, 0.04, "variance of normal numbers");
  ok(eo_random_index(eo_random_at(1, 1, 1, 1), 9, 1) == 0, "an index among one is 0");
}

/* A x = b is checked by multiplying back. */
static void test_saddle(void)
{
  enum { M = 12, Q = 3 };
  double a[M * M], p[Q * M], y[M], c[M], b[Q], diagonal[M], worst = 0;
  struct eo_saddle saddle;
  struct eo_error error;
  for (int i = 0; i < M; i++) {
    y[i] = unit(i, 10);
    for (int j = 0; j <= i; j++)
      a[i * M + j] = a[j * M + i] = exp(-abs(i - j)) + (i == j ? 0.5 : 0);
    for (int k = 0; k < Q; k++)
      p[k * M + i] = pow(i / (double)M, k);
  }
  ok(eo_saddle_init(&saddle, M, Q, &error) == EO_OK && eo_saddle_factor(&saddle, M, Q, a, p),
     "a saddle point is factorised");
  eo_saddle_solve(&saddle, 1, y, c, M, b);
  for (int i = 0; i < M; i++) {
    double row = -y[i];
    for (int j = 0; j < M; j++)
      row += a[i * M + j] * c[j];
    for (int k = 0; k < Q; k++)
      row += p[k * M + i] * b[k];
    worst = fmax(worst, fabs(row));
  }
  for (int k = 0; k < Q; k++) {
    double row = 0;
    for (int i = 0; i < M; i++)
      row += p[k * M + i] * c[i];
    worst = fmax(worst, fabs(row));
  }
  ok(worst < 1e-12, "the solution of a saddle point satisfies the equations: %.2g", worst);
  eo_saddle_inverse_diagonal(&saddle, diagonal);
  worst = 0;
  for (int j = 0; j < M; j++) { /* column j of the inverse is the solution for a unit vector */
    memset(y, 0, sizeof y);
    y[j] = 1;
    eo_saddle_solve(&saddle, 1, y, c, M, b);
    worst = fmax(worst, fabs(c[j] - diagonal[j]));
  }
  ok(worst < 1e-13, "the diagonal of the inverse is right to %.2g", worst);
  memcpy(p + M, p, M * sizeof *p);
  ok(!eo_saddle_factor(&saddle, M, Q, a, p), "a tail of less than full rank is noticed");
  a[0] = -50;
  ok(!eo_saddle_factor(&saddle, M, 1, a, p), "a matrix that is not positive definite is noticed");
  eo_saddle_done(&saddle);
}

static double bowl(void *context, const double *x, double *gradient)
{
  (void)context;
  gradient[0] = 2 * (x[0] - 2) + x[1];
  gradient[1] = 20 * (x[1] - 0.1) + x[0];
  return (x[0] - 2) * (x[0] - 2) + 10 * (x[1] - 0.1) * (x[1] - 0.1) + x[0] * x[1];
}

static double banana(void *context, const double *x, double *gradient)
{
  (void)context;
  const double a = x[1] - x[0] * x[0];
  gradient[0] = -400 * a * x[0] - 2 * (1 - x[0]);
  gradient[1] = 200 * a;
  return 100 * a * a + (1 - x[0]) * (1 - x[0]);
}

static void test_minimise(void)
{
  const double low[2] = {-2, -2}, high[2] = {1, 2};
  double x[2] = {-1, 1};
  eo_minimise(bowl, NULL, low, high, 2, 50, 1e-12, x);
  close_to(x[0], 1, 1e-12, "minimum of a variable at a bound");
  close_to(x[1], 0.05, 1e-8, "minimum of the variable that is free beside it"); /* 20 (y - 0.1) + 1 = 0 */
  double y[2] = {-1.2, 1};
  const double wide[2] = {3, 3};
  eo_minimise(banana, NULL, low, wide, 2, 200, 1e-12, y);
  close_to(y[0], 1, 1e-6, "first variable of Rosenbrock's minimum");
  close_to(y[1], 1, 1e-6, "second variable of Rosenbrock's minimum");
}

static double quadratic(const double *x)
{
  return 1 + 2 * x[0] - x[1] + 3 * x[0] * x[0] + x[1] * x[2] - 2 * x[2] * x[2] + 0.5 * x[0] * x[2];
}

/* A surrogate reproduces what its tail can express, and its gradient is that of its value. */
static void test_surrogate(void)
{
  enum { M = 30, N = 3 };
  double x[M * N], y[M], gradient[N];
  struct eo_surrogate s;
  struct eo_error error;
  ok(eo_surrogate_init(&s, N, M, 1, EO_TAIL_QUADRATIC, &error) == EO_OK, "room is made for a surrogate");
  for (int j = 0; j < M; j++) {
    for (int k = 0; k < N; k++)
      x[j * N + k] = unit(j, 20 + k);
    y[j] = quadratic(x + j * N);
  }
  const double q[N] = {0.3, 0.8, 0.4}, cubic = 1e-3;
  ok(eo_surrogate_fit(&s, EO_TAIL_QUADRATIC, 1e-9, x, y, M, 1), "a quadratic tail is fitted");
  eo_surrogate_visit(&s, q);
  close_to(eo_surrogate_value(&s, 0), quadratic(q), 1e-10, "value of a surrogate of a quadratic function");
  eo_surrogate_set_scale(&s, s.residual, 1);
  eo_surrogate_visit(&s, x);
  close_to(eo_surrogate_credibility(&s, 0.1), 1, 1e-9, "credibility of such a surrogate at a row");

  for (int j = 0; j < M; j++)
    y[j] = sin(4 * x[j * N]) * x[j * N + 1] + cubic;
  for (int tail = EO_TAIL_LINEAR; tail <= EO_TAIL_QUADRATIC; tail++) {
    ok(eo_surrogate_fit(&s, (enum eo_tail)tail, 1e-9, x, y, M, 1), "tail %d is fitted", tail);
    double worst = 0, step = 1e-5;
    eo_surrogate_visit(&s, q);
    eo_surrogate_gradient(&s, 0, gradient);
    for (int k = 0; k < N; k++) {
      double up[N], down[N];
      memcpy(up, q, sizeof up);
      memcpy(down, q, sizeof down);
      up[k] += step;
      down[k] -= step;
      eo_surrogate_visit(&s, up);
      double slope = eo_surrogate_value(&s, 0);
      eo_surrogate_visit(&s, down);
      slope = (slope - eo_surrogate_value(&s, 0)) / (2 * step);
      worst = fmax(worst, fabs(slope - gradient[k]));
    }
    ok(worst < 1e-7, "the surrogate's gradient is the slope of its value: %.2g", worst);
    worst = 0;
    for (int j = 0; j < M; j++) {
      eo_surrogate_visit(&s, x + j * N);
      worst = fmax(worst, fabs(eo_surrogate_value(&s, 0) - y[j]));
    }
    ok(worst < 1e-6, "the surrogate passes through its rows: %.2g", worst);
  }
  ok(!eo_surrogate_fit(&s, EO_TAIL_QUADRATIC, 1e-9, x, y, 10, 1), "too few rows make no surrogate");
  for (int j = 0; j < M; j++)
    x[j * N + 2] = 0.5;
  ok(!eo_surrogate_fit(&s, EO_TAIL_LINEAR, 1e-9, x, y, M, 1), "rows in one plane make no surrogate");
  eo_surrogate_done(&s);
}

static void test_history(void)
{
  struct eo_history h;
  struct eo_error error;
  struct eo_history_law law = {.share_radius = 0.2,
                               .weight_decay = 20,
                               .credibility_loss = 0.8,
                               .removal_threshold = 0.1,
                               .redundancy_threshold = 1e-7};
  double worst = 0;
  bool inside = true, credible = true;
  eo_history_init(&h, 2, 2, &error);
  for (int j = 0; j < 300; j++) {
    const double x[2] = {unit(j, 30), unit(j, 31)};
    eo_history_add(&h, x, unit(j, 32), j % 2 ? 1 : 0.7, j % 2 == 0, &error);
  }
  for (int i = 0; i < 200; i++) {
    const double x[2] = {unit(i, 33), unit(i, 34)};
    const struct eo_history_estimate e = eo_history_predict(&h, &law, x);
    double sum = 0, low = INFINITY, high = -INFINITY;
    for (int j = 0; j < h.count; j++) {
      sum += h.weight[j];
      low = h.weight[j] > 0 ? fmin(low, h.fitness[j]) : low;
      high = h.weight[j] > 0 ? fmax(high, h.fitness[j]) : high;
    }
    worst = fmax(worst, fabs(sum - 1));
    inside = inside && e.fitness >= low - 1e-12 && e.fitness <= high + 1e-12;
    credible = credible && e.credibility >= 0.7 && e.credibility <= 1;
  }
  ok(worst < 1e-12, "the weights of a region sum up to 1: %.2g", worst);
  ok(inside, "a prediction lies within the fitness of its region");
  ok(credible, "the credibility of a prediction lies within that of its region");
  eo_history_done(&h);

  /* A cross: the middle is unique in space though both coordinates have neighbours; then a predicted twin of a true
     row. */
  const double cross[][2] = {{0.5, 0.1}, {0.1, 0.5}, {0.5, 0.5}, {0.5, 0.9}, {0.9, 0.5}};
  eo_history_init(&h, 2, 8, &error);
  for (int j = 0; j < 5; j++)
    eo_history_add(&h, cross[j], 1, 1, false, &error);
  ok(eo_history_mark_redundant(&h, &law) == 0, "a row that is unique in space is not redundant");
  for (int j = 0; j < 2; j++)
    eo_history_add(&h, cross[2], 1, 1, true, &error);
  ok(eo_history_mark_redundant(&h, &law) > 0 && !h.removed[2], "a true row survives its predicted twins");
  const int kept = h.count - 1;
  eo_history_compact(&h);
  ok(h.count <= kept && !h.predicted[2] && h.x[4] == 0.5 && h.x[5] == 0.5, "a true row stays where it was");
  eo_history_done(&h);
}

static void test_latin(void)
{
  enum { M = 40, N = 4 };
  double x[M * N], scratch[M];
  bool each = true;
  eo_latin_hypercube(x, M, N, 3, 2, scratch);
  for (int k = 0; k < N; k++) {
    int seen[M] = {0};
    for (int j = 0; j < M; j++)
      seen[(int)(M * x[j * N + k])]++;
    for (int j = 0; j < M; j++)
      each = each && seen[j] == 1;
  }
  ok(each, "a latin hypercube has one point in every cell of every variable");
}

static void test_pareto(void)
{
  const double f[] = {1, 4, 2, 2, 4, 1, 3, 3, 5, 5, 2, 2, 0, 0};
  const double violation[] = {0, 0, 0, 0, 0, 0, 1};
  const int expected[] = {0, 0, 0, 1, 2, 0, 3};
  int rank[7], scratch[14], order[7];
  double crowding[7];
  eo_pareto_rank(f, violation, 7, 2, rank, scratch);
  ok(memcmp(rank, expected, sizeof rank) == 0, "the rows are sorted into their fronts: %d %d %d %d %d %d %d", rank[0],
     rank[1], rank[2], rank[3], rank[4], rank[5], rank[6]);
  eo_pareto_crowding(f, rank, 7, 2, crowding, scratch);
  ok(isinf(crowding[0]) && isinf(crowding[2]), "the ends of a front stand out");
  close_to(crowding[1], 2.0 / 3, 1e-12, "crowding of the first of two equal points");  /* (2 - 1)/3 + (2 - 1)/3 */
  close_to(crowding[5], 4.0 / 3, 1e-12, "crowding of the second of two equal points"); /* (4 - 2)/3 + (4 - 2)/3 */
  eo_pareto_order(rank, crowding, 7, order);
  ok(order[0] == 0 && order[1] == 2 && order[6] == 6,
     "best fronts first, then the least crowded, an infeasible row last");

  double two[] = {1, 3, 2, 2, 3, 1, 9, 9};
  const double reference[] = {4, 4, 4};
  close_to(hypervolume(two, 4, 2, reference), 6, 1e-12, "area of a staircase");
  double three[] = {0, 2, 2, 2, 0, 2, 2, 2, 0};
  const double corner[] = {3, 3, 3};
  close_to(hypervolume(three, 3, 3, corner), 7, 1e-12, "volume of three boxes of 3 x 1 x 1 that share a cube");
}

enum { AXES = 4, OFFSPRING = 8 };

/* Curvatures 1, 100, 10^4, 10^6, least at 0.3 in each variable; the first is cut off by the cube when low is above
   that. */
static double ellipsoid(const double *x)
{
  double sum = 0, curvature = 1;
  for (int k = 0; k < AXES; k++, curvature *= 100)
    sum += curvature * (x[k] - 0.3) * (x[k] - 0.3);
  return sum;
}

/* A valley along x0 = x1 = ... whose floor is a kink, falling towards 0, where the cube ends. */
static double kink(const double *x)
{
  double sum = x[0], wall = 0;
  for (int k = 1; k < AXES; k++) {
    wall = fmax(wall, fabs(x[k] - x[k - 1]));
    sum += x[k];
  }
  return sum + 100 * wall;
}

static double evolve(struct eo_evolution *e, double (*value)(const double *), int generations)
{
  double x[OFFSPRING][AXES], f[OFFSPRING], best = INFINITY;
  for (int g = 0; g < generations; g++) {
    const double *order[OFFSPRING];
    for (int i = 0; i < OFFSPRING; i++) {
      eo_evolution_sample(e, eo_random_at(1, EO_STREAM_EVOLUTION, (uint64_t)g, (uint64_t)i), x[i]);
      f[i] = value(x[i]);
      int j = i;
      for (; j > 0 && value(order[j - 1]) > f[i]; j--)
        order[j] = order[j - 1];
      order[j] = x[i];
      best = fmin(best, f[i]);
    }
    if (!eo_evolution_learn(e, order, OFFSPRING))
      break;
  }
  return best;
}

static void test_evolution(void)
{
  static const double start[AXES] = {0.8, 0.7, 0.6, 0.5};
  struct eo_evolution e;
  struct eo_error error;
  ok(eo_evolution_init(&e, AXES, &error) == EO_OK, "an evolution strategy is made");
  eo_evolution_restart(&e, start, 0.1);
  const double best = evolve(&e, ellipsoid, 400);
  bool learnt = true;
  for (int k = 1; k < AXES; k++) { /* the covariance becomes the inverse of the curvature (Hansen 2016) */
    const double ratio = e.covariance[(k - 1) * (AXES + 1)] / e.covariance[k * (AXES + 1)];
    learnt = learnt && ratio > 100 / 5. && ratio < 100 * 5.;
  }
  ok(best < 1e-8, "3200 points on an ellipsoid of condition 10^6 end at %.1e", best);
  ok(learnt, "the covariance has learnt the ellipsoid's curvatures");
  eo_evolution_restart(&e, start, 0.1);
  const double end = evolve(&e, kink, 150), before = kink(start);
  ok(end < 1e-3 * before, "a valley with a kinked floor leads into a corner of the cube: %.1e from %.1e", end, before);
  const double far[2][AXES] = {{1, 1, 1, 1}, {0, 0, 0, 0}}, *given[2] = {far[0], far[1]};
  eo_evolution_restart(&e, start, 1e-3);
  ok(eo_evolution_learn(&e, given, 2) && e.step < 3e-3 && fabs(e.mean[0] - start[0]) < 0.01,
     "a point from far away moves the mean by no more than a sample may");
  eo_evolution_restart(&e, start, 1e-300);
  ok(!eo_evolution_learn(&e, (const double *[]){start, start}, 2), "a step that has vanished is told");
  eo_evolution_done(&e);
}

int main(void)
{
  test_random();
  test_saddle();
  test_minimise();
  test_surrogate();
  test_history();
  test_latin();
  test_pareto();
  test_evolution();
  return tap_done();
}
