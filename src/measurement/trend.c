#include "measurement/trend.h"

#include <math.h>
#include <stdlib.h>

enum eo_code eo_trend_start(struct eo_trend *t, double from, double to, int intervals, double origin, double rate,
                            struct eo_error *error)
{
  int n = intervals + 3;
  *t = (struct eo_trend){
      .intervals = intervals, .start = from, .step = (to - from) / intervals, .origin = origin, .rate = rate};
  t->coefficient = calloc((size_t)n, sizeof *t->coefficient);
  t->band = calloc((size_t)n * 4, sizeof *t->band);
  return t->coefficient && t->band ? EO_OK : eo_error_memory(error);
}

void eo_trend_done(struct eo_trend *t)
{
  free(t->coefficient);
  free(t->band);
  t->coefficient = t->band = NULL;
}

/* The piece that a time lies in and the four B-splines there (de Boor 1978), slopes per piece. */
static int basis(const struct eo_trend *t, double time, double value[4], double slope[4])
{
  double x = (time - t->start) / t->step;
  int piece = x < 0 ? 0 : x >= t->intervals ? t->intervals - 1 : (int)x;
  double u = x - piece, v = 1 - u;
  value[0] = v * v * v / 6;
  value[1] = (3 * u * u * u - 6 * u * u + 4) / 6;
  value[2] = (3 * v * v * v - 6 * v * v + 4) / 6;
  value[3] = u * u * u / 6;
  slope[0] = -v * v / 2;
  slope[1] = (3 * u - 4) * u / 2;
  slope[2] = -(3 * v - 4) * v / 2;
  slope[3] = u * u / 2;
  return piece;
}

static double line_at(const struct eo_trend *t, double time)
{
  return t->origin + t->rate * (time - t->start);
}

void eo_trend_add(struct eo_trend *t, double time, double angle)
{
  double value[4], slope[4], rest = angle - line_at(t, time);
  int piece = basis(t, time, value, slope);
  for (int i = 0; i < 4; i++) {
    t->coefficient[piece + i] += value[i] * rest;
    for (int j = i; j < 4; j++)
      t->band[(size_t)(piece + i) * 4 + (size_t)(j - i)] += value[i] * value[j];
  }
}

static void add_penalty(struct eo_trend *t)
{
  static const double third[4] = {-1, 3, -3, 1};
  double trace = 0;
  for (int i = 0; i < t->intervals + 3; i++)
    trace += t->band[4 * i];
  double weight = 1e-9 * trace / (t->intervals + 3);
  for (int k = 0; k < t->intervals; k++)
    for (int i = 0; i < 4; i++)
      for (int j = i; j < 4; j++)
        t->band[4 * (k + i) + (j - i)] += weight * third[i] * third[j];
}

/* Cholesky factor of a symmetric matrix with three upper bands, and both substitutions. */
static int solve_band(int n, double *band, double *x)
{
  for (int i = 0; i < n; i++) {
    double *row = band + 4 * (size_t)i, pivot = row[0];
    if (!(pivot > 0))
      return 1;
    for (int j = 1; j < 4 && i + j < n; j++) {
      double factor = row[j] / pivot;
      for (int k = j; k < 4 && i + k < n; k++)
        band[4 * (size_t)(i + j) + (size_t)(k - j)] -= factor * row[k];
      x[i + j] -= factor * x[i];
    }
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int j = 1; j < 4 && i + j < n; j++)
      x[i] -= band[4 * (size_t)i + (size_t)j] * x[i + j];
    x[i] /= band[4 * (size_t)i];
  }
  return 0;
}

enum eo_code eo_trend_finish(struct eo_trend *t, struct eo_error *error)
{
  add_penalty(t);
  if (solve_band(t->intervals + 3, t->band, t->coefficient))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The trend of the pinion angle has no solution.");
  free(t->band);
  t->band = NULL;
  return EO_OK;
}

double eo_trend_at(const struct eo_trend *t, double time, double *speed)
{
  double value[4], slope[4], sum = 0, rise = 0;
  int piece = basis(t, time, value, slope);
  for (int i = 0; i < 4; i++) {
    sum += value[i] * t->coefficient[piece + i];
    rise += slope[i] * t->coefficient[piece + i];
  }
  if (speed)
    *speed = t->rate + rise / t->step;
  return line_at(t, time) + sum;
}
