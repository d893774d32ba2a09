/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/credibility_model.h"

#include "optimizer/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"

static const double ridge = 1e-9;

enum eo_code eo_credibility_model_init(struct eo_credibility_model *model, const struct eo_optimizer_settings *settings,
                                       const struct eo_anatomy *anatomy, struct eo_error *error)
{
  const size_t n = (size_t)settings->variables, rows = (size_t)settings->model_rows;
  *model = (struct eo_credibility_model){.settings = settings};
  model->rows = malloc(rows * sizeof(int));
  model->x = malloc(rows * n * sizeof(double));
  model->y = malloc(rows * sizeof(double));
  model->sorted = malloc(rows * sizeof(double));
  if (!model->rows || !model->x || !model->y || !model->sorted)
    return eo_error_memory(error);
  return eo_composite_init(&model->composite, anatomy, settings->variables, settings->model_rows, EO_TAIL_LINEAR,
                           error);
}

void eo_credibility_model_done(struct eo_credibility_model *model)
{
  free(model->rows);
  free(model->x);
  free(model->y);
  free(model->sorted);
  free(model->ranked);
  free(model->used);
  eo_composite_done(&model->composite);
}

static int compare_ranked(const void *a, const void *b)
{
  const struct eo_ranked_row *ranked_row = a, *this_row = b;
  return ranked_row->key != this_row->key ? (ranked_row->key > this_row->key) - (ranked_row->key < this_row->key)
                                          : ranked_row->row - this_row->row;
}

enum eo_code eo_credibility_model_reserve(struct eo_credibility_model *model, int rows, struct eo_error *error)
{
  if (rows <= model->ranked_capacity)
    return EO_OK;
  const size_t capacity = 2 * (size_t)rows;
  struct eo_ranked_row *ranked = realloc(model->ranked, capacity * sizeof *ranked);
  if (ranked)
    model->ranked = ranked;
  bool *used = realloc(model->used, capacity * sizeof *used);
  if (used)
    model->used = used;
  if (!ranked || !used)
    return eo_error_memory(error);
  model->ranked_capacity = (int)capacity;
  return EO_OK;
}

static const double *row_x(const struct eo_archive *archive, int row, int n)
{
  return archive->x + (size_t)row * n;
}

enum ranking { RANK_BY_VALUE, RANK_BY_AGE, RANK_BY_DISTANCE };

/* Appends the best `share` unused rows by the given ranking. */
static int take_rows(struct eo_credibility_model *model, const struct eo_archive *archive, enum ranking ranking,
                     const double *centre, int taken, int share)
{
  const int n = model->settings->variables;
  int count = 0;
  for (int row = 0; row < archive->count; row++) {
    if (model->used[row] || !eo_composite_takes(&model->composite, archive, row))
      continue;
    const double key = ranking == RANK_BY_VALUE ? archive->value[row]
                       : ranking == RANK_BY_AGE ? -row
                                                : eo_unit_distance(row_x(archive, row, n), centre, n);
    model->ranked[count++] = (struct eo_ranked_row){key, row};
  }
  qsort(model->ranked, (size_t)count, sizeof *model->ranked, compare_ranked);
  for (int i = 0; i < share && i < count; i++) {
    model->used[model->ranked[i].row] = true;
    model->rows[taken++] = model->ranked[i].row;
  }
  return taken;
}

static int gather_rows(struct eo_credibility_model *model, const struct eo_archive *archive, const double *centre)
{
  const int limit = model->settings->model_rows;
  memset(model->used, 0, (size_t)archive->count * sizeof *model->used);
  int taken = take_rows(model, archive, RANK_BY_VALUE, centre, 0, limit / 3);
  taken = take_rows(model, archive, RANK_BY_AGE, centre, taken, limit / 3);
  return take_rows(model, archive, RANK_BY_DISTANCE, centre, taken, limit - taken);
}

void eo_credibility_model_fit(struct eo_credibility_model *model, const struct eo_archive *archive,
                              const double *centre)
{
  const int n = model->settings->variables, count = gather_rows(model, archive, centre);
  model->fitted = false;
  if (count < n + 3)
    return;
  for (int j = 0; j < count; j++) {
    memcpy(model->x + (size_t)j * n, row_x(archive, model->rows[j], n), (size_t)n * sizeof(double));
    model->sorted[j] = model->y[j] = archive->value[model->rows[j]];
  }
  eo_sort_numbers(count, model->sorted);
  const double median = model->sorted[count / 2];
  model->spread = median - model->sorted[0];
  for (int j = 0; j < count && model->composite.anatomy->parts == 0; j++)
    model->y[j] = fmin(model->y[j], median);
  if (!(model->spread > 0))
    return;
  const struct eo_composite_rows rows = {archive, count, model->rows, model->x, model->y, 0, 1, model->spread};
  model->fitted = eo_composite_fit(&model->composite, EO_TAIL_LINEAR, ridge, &rows);
  if (model->fitted)
    eo_surrogate_set_scale(&model->composite.surrogate, model->composite.residual, model->spread);
}

double eo_credibility_predict(struct eo_credibility_model *model, const double *x)
{
  if (!model->fitted)
    return 0;
  return -eo_composite_value(&model->composite, x);
}

double eo_credibility_score(struct eo_credibility_model *model, const double *x)
{
  const double value = eo_credibility_predict(model, x);
  if (!model->fitted)
    return 0;
  const double length = model->settings->credibility_length * sqrt(model->settings->variables);
  const double doubt = 1 - eo_surrogate_credibility(&model->composite.surrogate, length);
  return value - model->settings->exploration * model->spread * doubt;
}
