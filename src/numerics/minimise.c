/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/minimise.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

struct iterate {
  int n;
  const double *low, *high;
  double x[EO_MINIMISE_MAX], gradient[EO_MINIMISE_MAX], value;
  double inverse[EO_MINIMISE_MAX * EO_MINIMISE_MAX]; /* of the Hessian, [n][n] */
};

static void reset_inverse(struct iterate *it)
{
  memset(it->inverse, 0, (size_t)it->n * (size_t)it->n * sizeof(double));
  for (int k = 0; k < it->n; k++)
    it->inverse[k * it->n + k] = 1;
}

static bool is_held(const struct iterate *it, int k)
{
  return (it->x[k] <= it->low[k] && it->gradient[k] > 0) || (it->x[k] >= it->high[k] && it->gradient[k] < 0);
}

/* Returns the slope along the direction, < 0 unless every variable is held. */
static double find_direction(const struct iterate *it, double *direction)
{
  double slope = 0;
  for (int k = 0; k < it->n; k++) {
    direction[k] = 0;
    for (int l = 0; l < it->n && !is_held(it, k); l++)
      direction[k] -= is_held(it, l) ? 0 : it->inverse[k * it->n + l] * it->gradient[l];
    slope += direction[k] * it->gradient[k];
  }
  return slope;
}

/* Before anything is known of the curvature, the first step should be of the size of the box. */
static double first_length(const struct iterate *it, const double *direction)
{
  double length = 1;
  for (int k = 0; k < it->n; k++)
    if (direction[k] != 0)
      length = fmin(length, (it->high[k] - it->low[k]) / (2 * fabs(direction[k])));
  return length;
}

static bool search_line(struct iterate *next, const struct iterate *it, eo_smooth_function *function, void *context,
                        const double *direction, double length)
{
  enum { HALVINGS = 20 };
  static const double ARMIJO = 1e-4; /* of the fall that the gradient promises */
  for (int halving = 0; halving < HALVINGS; halving++, length /= 2) {
    double predicted = 0;
    for (int k = 0; k < it->n; k++) {
      next->x[k] = fmin(fmax(it->x[k] + length * direction[k], it->low[k]), it->high[k]);
      predicted += it->gradient[k] * (next->x[k] - it->x[k]);
    }
    next->value = function(context, next->x, next->gradient);
    if (predicted < 0 && next->value <= it->value + ARMIJO * predicted)
      return true;
  }
  return false;
}

/* BFGS on the inverse; skipped when the curvature along the step is not positive. */
static void update_inverse(struct iterate *it, const double *step, const double *change)
{
  static const double FLAT = 1e-10; /* of the product of step and change */
  const int n = it->n;
  double curvature = 0, scaled[EO_MINIMISE_MAX], quadratic = 0, length = 0, turn = 0;
  for (int k = 0; k < n; k++) {
    curvature += step[k] * change[k];
    length += step[k] * step[k];
    turn += change[k] * change[k];
  }
  if (!(curvature > FLAT * sqrt(length * turn)))
    return;
  for (int k = 0; k < n; k++) {
    scaled[k] = 0;
    for (int l = 0; l < n; l++)
      scaled[k] += it->inverse[k * n + l] * change[l];
    quadratic += change[k] * scaled[k];
  }
  for (int k = 0; k < n; k++)
    for (int l = 0; l < n; l++)
      it->inverse[k * n + l] += (1 + quadratic / curvature) * step[k] * step[l] / curvature -
                                (scaled[k] * step[l] + step[k] * scaled[l]) / curvature;
}

static double accept(struct iterate *it, const struct iterate *next)
{
  double step[EO_MINIMISE_MAX], change[EO_MINIMISE_MAX], moved = 0;
  for (int k = 0; k < it->n; k++) {
    step[k] = next->x[k] - it->x[k];
    change[k] = next->gradient[k] - it->gradient[k];
    moved = fmax(moved, fabs(step[k]));
  }
  memcpy(it->x, next->x, sizeof it->x);
  memcpy(it->gradient, next->gradient, sizeof it->gradient);
  it->value = next->value;
  update_inverse(it, step, change);
  return moved;
}

double eo_minimise(eo_smooth_function *function, void *context, const double *low, const double *high, int n, int steps,
                   double tolerance, double *x)
{
  struct iterate it = {.n = n, .low = low, .high = high}, next = it;
  double direction[EO_MINIMISE_MAX];
  bool fresh = true;
  memcpy(it.x, x, (size_t)n * sizeof *x);
  it.value = function(context, it.x, it.gradient);
  reset_inverse(&it);
  for (int step = 0; step < steps; step++) {
    if (!(find_direction(&it, direction) < 0))
      break;
    const double length = fresh ? first_length(&it, direction) : 1;
    if (search_line(&next, &it, function, context, direction, length)) {
      fresh = false;
      if (accept(&it, &next) < tolerance)
        break;
    } else if (fresh) {
      break;
    } else {
      reset_inverse(&it);
      fresh = true;
    }
  }
  memcpy(x, it.x, (size_t)n * sizeof *x);
  return it.value;
}

/* The best place met, the second best and the one before, and the last two moves. */
struct line_search {
  double low, high;
  double place[3], value[3];
  double move, before;
};

/* The parabola through the three places, if its bottom lies inside and it moves less than half the move before last. */
static bool along_parabola(struct line_search *search, double tolerance, double *move)
{
  double x = search->place[0], r = (x - search->place[1]) * (search->value[0] - search->value[2]),
         q = (x - search->place[2]) * (search->value[0] - search->value[1]),
         p = (x - search->place[2]) * q - (x - search->place[1]) * r, twice = 2 * (q - r);
  if (fabs(search->before) <= tolerance || twice == 0)
    return false;
  *move = -p / twice;
  if (!(fabs(*move) < fabs(search->before) / 2) || x + *move <= search->low || x + *move >= search->high)
    return false;
  if (x + *move - search->low < 2 * tolerance || search->high - x - *move < 2 * tolerance)
    *move = copysign(tolerance, (search->low + search->high) / 2 - x);
  return true;
}

/* Takes in a value: the interval shrinks towards the better of it and the best one. */
static void take_value(struct line_search *search, double x, double value)
{
  int at = value < search->value[0] ? 0 : value <= search->value[1] || search->place[1] == search->place[0] ? 1 : 2;
  double bound = at == 0 ? search->place[0] : x, inside = at == 0 ? x : search->place[0];
  if (inside < bound)
    search->high = bound;
  else
    search->low = bound;
  if (at == 2 && value > search->value[2] && search->place[2] != search->place[0] &&
      search->place[2] != search->place[1])
    return;
  for (int i = 2; i > at; i--) {
    search->place[i] = search->place[i - 1];
    search->value[i] = search->value[i - 1];
  }
  search->place[at] = x;
  search->value[at] = value;
}

double eo_minimise_along(eo_line_function *function, void *context, double low, double high, double tolerance,
                         double value, double *x)
{
  enum { STEPS = 100 };
  static const double GOLDEN = 0.3819660112501051; /* (3 - sqrt 5) / 2 */
  struct line_search search = {low, high, {*x, *x, *x}, {value, value, value}, 0, 0};
  for (int i = 0; i < STEPS; i++) {
    double middle = (search.low + search.high) / 2, move = 0;
    if (fabs(search.place[0] - middle) <= 2 * tolerance - (search.high - search.low) / 2)
      break;
    if (along_parabola(&search, tolerance, &move)) {
      search.before = search.move;
    } else {
      search.before = (search.place[0] < middle ? search.high : search.low) - search.place[0];
      move = GOLDEN * search.before;
    }
    search.move = move;
    double next = search.place[0] + (fabs(move) < tolerance ? copysign(tolerance, move) : move);
    take_value(&search, next, function(context, next));
  }
  *x = search.place[0];
  return search.value[0];
}
