/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "service/rig_tasks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void eo_rig_pair_hash(const struct eo_geometry *geometry, char key[EO_HASH_LENGTH + 1])
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  for (int i = 0; i < 2; i++) {
    eo_hash_add_number(&hash, "teeth", geometry->teeth[i]);
    eo_hash_add_number(&hash, "base radius", geometry->base_radius[i]);
  }
  eo_hash_finish(&hash, key);
}

enum eo_code eo_rig_points_add(struct eo_rig_points *points, int64_t id, const char *summary, const char *pair,
                               struct eo_error *error)
{
  if (points->count == EO_MOST_MEASURED)
    return eo_error_set(error, EO_ERROR_INPUT, "", "At most %d measurements are compared at once.", EO_MOST_MEASURED);
  if (!points->point)
    points->point = calloc(EO_MOST_MEASURED, sizeof *points->point);
  char *text = strdup(summary);
  if (!points->point || !text) {
    free(text);
    return eo_error_memory(error);
  }
  struct eo_rig_point *point = &points->point[points->count++];
  point->id = id;
  point->summary = text;
  snprintf(point->pair, sizeof point->pair, "%s", pair);
  return EO_OK;
}

void eo_rig_points_done(struct eo_rig_points *points)
{
  for (int i = 0; i < points->count; i++)
    free(points->point[i].summary);
  free(points->point);
  *points = (struct eo_rig_points){0};
}

/* What was asked for; owned by the service. */
struct order {
  struct eo_rig_points points;
  bool csv;
  struct eo_update_settings settings;
  char *given; /* the design as it was given, JSON; owned */
  struct eo_rig_request rig;
};

/* What a computation works on. */
struct work {
  struct eo_measured *measured;      /* owned */
  struct eo_rig_selection selection; /* owned arrays, as long as there are measurements */
  struct eo_comparison comparison;
};

static void release(void *data)
{
  struct order *order = data;
  eo_rig_points_done(&order->points);
  free(order->given);
  free(order);
}

static enum eo_code make(struct eo_work *work, struct eo_rig_points *points, struct order **order,
                         struct eo_error *error)
{
  *order = calloc(1, sizeof **order);
  if (!*order) {
    if (points)
      eo_rig_points_done(points);
    return eo_error_memory(error);
  }
  if (points) {
    (*order)->points = *points;
    *points = (struct eo_rig_points){0};
  }
  work->data = *order;
  work->release = release;
  return EO_OK;
}

static void leave_out(struct work *work, int64_t id, const char *reason)
{
  struct eo_left_out *left_out = &work->selection.left_out[work->selection.left_outs++];
  left_out->id = id;
  snprintf(left_out->reason, sizeof left_out->reason, "%s", reason);
}

static void read_point(struct work *work, const struct eo_rig_point *point, const char *pair)
{
  struct eo_error error;
  struct eo_rig_selection *selection = &work->selection;
  if (strcmp(point->pair, pair) != 0)
    leave_out(work, point->id,
              "It was measured with other tooth numbers or base radii than the design has now; upload its file again.");
  else if (eo_rig_measured_read(point->summary, &work->measured[selection->count], &error))
    leave_out(work, point->id, error.text);
  else
    selection->id[selection->count++] = point->id;
}

static bool reserve(struct work *work, int count)
{
  size_t size = (size_t)count + 1;
  work->measured = calloc(size, sizeof *work->measured);
  work->selection.id = calloc(size, sizeof *work->selection.id);
  work->selection.left_out = calloc(size, sizeof *work->selection.left_out);
  return work->measured && work->selection.id && work->selection.left_out;
}

static enum eo_code compare(struct work *work, const struct order *order, const struct eo_pair *pair,
                            const struct eo_design *design, const struct eo_progress *progress, struct eo_error *error)
{
  char key[EO_HASH_LENGTH + 1];
  struct eo_evaluator *evaluator = NULL;
  if (!reserve(work, order->points.count))
    return eo_error_memory(error);
  eo_rig_pair_hash(&pair->geometry, key);
  for (int i = 0; i < order->points.count; i++)
    read_point(work, &order->points.point[i], key);
  EO_TRY(eo_evaluator_new(&evaluator, pair, 1, error));
  enum eo_code code = eo_comparison_run(&work->comparison, evaluator, design, work->selection.count, work->measured,
                                        progress, error);
  eo_evaluator_free(evaluator);
  return code;
}

static void work_done(struct work *work)
{
  eo_comparison_done(&work->comparison);
  free(work->measured);
  free(work->selection.id);
  free(work->selection.left_out);
}

static enum eo_code run_comparison(void *data, const struct eo_pair *pair, const struct eo_design *design,
                                   const struct eo_progress *progress, struct eo_text *text, struct eo_error *error)
{
  const struct order *order = data;
  struct work work = {0};
  enum eo_code code = compare(&work, order, pair, design, progress, error);
  if (!code && order->csv)
    eo_comparison_csv(&work.comparison, work.measured, text);
  else if (!code)
    eo_rig_comparison_write(&work.selection, &work.comparison, work.measured, design, text);
  work_done(&work);
  return code;
}

enum eo_code eo_rig_comparison(struct eo_work *work, struct eo_rig_points *points, bool csv, struct eo_error *error)
{
  struct order *order;
  enum eo_code code = make(work, points, &order, error);
  if (code)
    return code;
  order->csv = csv;
  work->run = run_comparison;
  return EO_OK;
}

static void drop_outliers(struct work *work)
{
  struct eo_rig_selection *selection = &work->selection;
  int kept = 0;
  for (int i = 0; i < selection->count; i++) {
    if (work->comparison.point[i].outlier) {
      leave_out(work, selection->id[i], work->comparison.point[i].reason);
      continue;
    }
    work->measured[kept] = work->measured[i];
    selection->id[kept++] = selection->id[i];
  }
  selection->count = kept;
}

static enum eo_code run_fit(void *data, const struct eo_pair *pair, const struct eo_design *design,
                            const struct eo_progress *progress, struct eo_text *text, struct eo_error *error)
{
  const struct order *order = data;
  struct work work = {0};
  struct eo_update update;
  struct eo_design updated;
  enum eo_code code = compare(&work, order, pair, design, progress, error);
  if (!code) {
    drop_outliers(&work);
    code = eo_update_run(&update, pair, design, work.selection.count, work.measured, &order->settings, &updated,
                         progress, error);
  }
  if (!code)
    eo_rig_fit_write(&work.selection, &update, order->given, design, &updated, text);
  work_done(&work);
  return code;
}

enum eo_code eo_rig_fit(struct eo_work *work, struct eo_rig_points *points, const struct eo_update_settings *settings,
                        const char *given, struct eo_error *error)
{
  struct order *order;
  enum eo_code code = make(work, points, &order, error);
  if (code)
    return code;
  order->settings = *settings;
  order->given = strdup(given);
  work->run = run_fit;
  if (order->given)
    return EO_OK;
  release(order);
  return eo_error_memory(error);
}

static enum eo_code respond(struct eo_rig_request *rig, const struct eo_pair *pair, const struct eo_design *design,
                            struct eo_error *error)
{
  struct eo_rig_prediction prediction;
  EO_TRY(eo_rig_predict(rig, pair, design, &prediction, error));
  eo_rig_set_pair(rig, &pair->geometry, &design->supports, &prediction);
  EO_TRY(eo_synthetic_check(&rig->synthetic, error));
  return eo_synthetic_rows(&rig->synthetic) <= EO_RIG_MOST_ROWS
             ? EO_OK
             : eo_error_set(error, EO_ERROR_INPUT, "", "The recording would have %lld rows; %d are the most here.",
                            (long long)eo_synthetic_rows(&rig->synthetic), EO_RIG_MOST_ROWS);
}

static enum eo_code run_recording(void *data, const struct eo_pair *pair, const struct eo_design *design,
                                  const struct eo_progress *progress, struct eo_text *text, struct eo_error *error)
{
  struct order *order = data;
  char *bytes = NULL;
  size_t size = 0;
  FILE *stream;
  enum eo_code code = respond(&order->rig, pair, design, error);
  if (code)
    return code;
  stream = open_memstream(&bytes, &size);
  code = stream ? eo_rig_write(&order->rig, progress, stream, error) : eo_error_memory(error);
  if (stream && fclose(stream) && !code)
    code = eo_error_memory(error);
  if (code)
    free(bytes);
  else
    *text = (struct eo_text){.data = bytes, .size = size, .capacity = size};
  return code;
}

enum eo_code eo_rig_recording(struct eo_work *work, const struct eo_rig_request *request, struct eo_error *error)
{
  struct order *order;
  enum eo_code code = make(work, NULL, &order, error);
  if (code)
    return code;
  order->rig = *request;
  work->run = run_recording;
  return EO_OK;
}
