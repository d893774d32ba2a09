/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/global_minima.h"

#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 300, STEPS = 32 };
static const double ENOUGH = 1e-4; /* of the model: less tells no two minima apart */
static const double start_apart = 0.1, minimum_apart = 0.01, doubt_apart = 0.1; /* distances to keep, over sqrt n */

enum eo_code eo_global_minima_init(struct eo_global_minima *global, int variables, struct eo_error *error)
{
  const size_t n = (size_t)variables;
  *global = (struct eo_global_minima){.variables = variables};
  global->sample = malloc(SAMPLES * n * sizeof(double));
  global->score = malloc(SAMPLES * sizeof(double));
  global->minimum = malloc(EO_GLOBAL_STARTS * n * sizeof(double));
  return global->sample && global->score && global->minimum ? EO_OK : eo_error_memory(error);
}

void eo_global_minima_done(struct eo_global_minima *global)
{
  free(global->sample);
  free(global->score);
  free(global->minimum);
  *global = (struct eo_global_minima){0};
}

static bool is_apart(const double *points, int count, const double *x, int n, double distance)
{
  bool apart = true;
  for (int i = 0; i < count && apart; i++)
    apart = eo_unit_distance(points + (size_t)i * (size_t)n, x, n) > distance;
  return apart;
}

static bool is_barred(const struct eo_global_bars *bars, const double *x)
{
  bool barred = false;
  if (bars->count)
    eo_view_distance_visit(bars->distance, x);
  for (int i = 0; i < bars->count && !barred; i++)
    barred = eo_view_distance_from(bars->distance, bars->row[i]) < bars->radius;
  return barred;
}

/* The sample with the best score that is so far from all points; its score is taken. -1: none. */
static int take_sample(struct eo_global_minima *global, const double *points, int count, double distance)
{
  const int n = global->variables;
  for (;;) {
    int best = -1;
    for (int i = 0; i < SAMPLES; i++)
      if (global->score[i] > -INFINITY && (best < 0 || global->score[i] > global->score[best]))
        best = i;
    if (best < 0)
      return -1;
    global->score[best] = -INFINITY;
    if (is_apart(points, count, global->sample + (size_t)best * (size_t)n, n, distance))
      return best;
  }
}

/* Half of the samples are anywhere, half are near the best row in some variables. What is drawn lies evenly in the
   stretched cube, every second time in that of the variables. */
static void draw(struct eo_global_minima *global, const struct eo_cube_warp *warp, const double *best, uint64_t seed,
                 int batch)
{
  const int n = global->variables;
  for (int i = 0; i < SAMPLES; i++) {
    const struct eo_random random = eo_random_at(seed, EO_STREAM_GLOBAL, (uint64_t)batch, (uint64_t)i);
    double *x = global->sample + (size_t)i * (size_t)n;
    for (int k = 0; k < n; k++)
      x[k] = eo_random_unit(random, 2 * (uint64_t)k);
    if (i % 4 >= 2)
      eo_cube_warp_in(warp, x, x);
    for (int k = 0; k < n && i % 2 == 1; k++)
      x[k] = eo_random_unit(random, 2 * (uint64_t)k + 1) < 0.5 ? best[k] : x[k];
  }
}

/* Minima from the best row and from the samples that promise most, best first; returns how many. */
static int find_minima(struct eo_global_minima *global, struct eo_credibility_model *model,
                       const struct eo_global_bars *bars, const double *best)
{
  const int n = global->variables;
  double low[EO_MAX_VARIABLES], high[EO_MAX_VARIABLES], starts[EO_GLOBAL_STARTS * EO_MAX_VARIABLES];
  int count = 0;
  for (int k = 0; k < n; k++) {
    low[k] = 0;
    high[k] = 1;
  }
  memcpy(starts, best, (size_t)n * sizeof *best);
  for (count = 1; count < bars->starts; count++) {
    const int i = take_sample(global, starts, count, start_apart * sqrt(n));
    if (i < 0)
      break;
    memcpy(starts + (size_t)count * (size_t)n, global->sample + (size_t)i * (size_t)n, (size_t)n * sizeof *starts);
  }
  for (int i = 0; i < count; i++) {
    double *x = starts + (size_t)i * (size_t)n;
    const double value = eo_composite_minimise(&model->composite, low, high, STEPS, ENOUGH, x);
    int j = i;
    for (; j > 0 && global->value[j - 1] > value; j--) {
      global->value[j] = global->value[j - 1];
      memcpy(global->minimum + (size_t)j * (size_t)n, global->minimum + (size_t)(j - 1) * (size_t)n,
             (size_t)n * sizeof *x);
    }
    global->value[j] = value;
    memcpy(global->minimum + (size_t)j * (size_t)n, x, (size_t)n * sizeof *x);
  }
  return count;
}

int eo_global_minima_choose(struct eo_global_minima *global, struct eo_credibility_model *model,
                            const struct eo_archive *archive, const struct eo_global_bars *bars, int best, int batch,
                            int minima, double *chosen, int first, int count)
{
  const int n = global->variables;
  const double *centre = archive->x + (size_t)best * (size_t)n;
  draw(global, bars->distance->warp, centre, model->settings->seed, batch);
  for (int i = 0; i < SAMPLES; i++) {
    const double *x = global->sample + (size_t)i * (size_t)n;
    global->score[i] = is_barred(bars, x) ? -INFINITY : eo_credibility_predict(model, x);
  }
  const int found = model->fitted ? find_minima(global, model, bars, centre) : 0;
  int filled = first;
  for (int i = 0; i < found && filled < count && filled - first < minima; i++) {
    const double *x = global->minimum + (size_t)i * (size_t)n, apart = minimum_apart * sqrt(n);
    if (is_apart(archive->x, archive->count, x, n, apart) && is_apart(chosen, filled, x, n, apart) &&
        !is_barred(bars, x))
      memcpy(chosen + (size_t)filled++ * (size_t)n, x, (size_t)n * sizeof *x);
  }
  for (int i = 0; i < SAMPLES; i++) {
    const double *x = global->sample + (size_t)i * (size_t)n;
    global->score[i] = is_barred(bars, x) ? -INFINITY : eo_credibility_score(model, x);
  }
  while (filled < count) {
    const int i = take_sample(global, chosen, filled, doubt_apart * sqrt(n));
    if (i < 0)
      break;
    memcpy(chosen + (size_t)filled++ * (size_t)n, global->sample + (size_t)i * (size_t)n, (size_t)n * sizeof *chosen);
  }
  return filled;
}
