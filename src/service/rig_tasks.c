#include "service/rig_tasks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"

#include <config.h>

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

/* ---- measurements on their way ---- */

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
  json_t *stored;
  struct eo_rig_request rig;
};

/* What a computation works on. */
struct work {
  int count;
  struct eo_measured *measured; /* owned, [count] */
  json_t *ids, *left_out;       /* owned arrays */
  struct eo_comparison comparison;
};

static void release(void *data)
{
  struct order *order = data;
  eo_rig_points_done(&order->points);
  json_decref(order->stored);
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

/* ---- comparison ---- */

static void leave_out(struct work *w, int64_t id, const char *reason)
{
  json_array_append_new(w->left_out, json_pack("{s:I, s:s}", "id", (json_int_t)id, "reason", reason));
}

static void read_point(struct work *w, const struct eo_rig_point *point, const char *pair)
{
  struct eo_error error;
  json_t *summary = json_loads(point->summary, 0, NULL);
  if (strcmp(point->pair, pair) != 0)
    leave_out(w, point->id,
              "It was measured with other tooth numbers or base radii than the design has now; upload its file again.");
  else if (eo_measured_decode(summary, &w->measured[w->count], &error))
    leave_out(w, point->id, error.text);
  else {
    w->count++;
    json_array_append_new(w->ids, json_integer(point->id));
  }
  json_decref(summary);
}

static enum eo_code compare(struct work *w, const struct order *order, const struct eo_pair *pair,
                            const struct eo_design *design, const struct eo_progress *progress, struct eo_error *error)
{
  char key[EO_HASH_LENGTH + 1];
  struct eo_evaluator *evaluator = NULL;
  w->measured = calloc((size_t)order->points.count + 1, sizeof *w->measured);
  w->ids = json_array();
  w->left_out = json_array();
  if (!w->measured || !w->ids || !w->left_out)
    return eo_error_memory(error);
  eo_rig_pair_hash(&pair->geometry, key);
  for (int i = 0; i < order->points.count; i++)
    read_point(w, &order->points.point[i], key);
  enum eo_code code = eo_evaluator_new(&evaluator, pair, 1, error);
  if (!code)
    code = eo_comparison_run(&w->comparison, evaluator, design, w->count, w->measured, progress, error);
  eo_evaluator_free(evaluator);
  return code;
}

static void work_done(struct work *w)
{
  eo_comparison_done(&w->comparison);
  free(w->measured);
  json_decref(w->ids);
  json_decref(w->left_out);
}

static enum eo_code write(json_t *document, bool failed, struct eo_text *text, struct eo_error *error)
{
  if (document && !failed)
    eo_json_write(text, document, EO_JSON_COMPACT);
  json_decref(document);
  return document && !failed ? EO_OK : eo_error_memory(error);
}

static const struct eo_outline_row left_out_rows[] = {
    EO_KEY("id", "integer", "number of the measurement"),
    EO_KEY("reason", "text", "why it was left out, for people"),
};
static const struct eo_outline left_out_outline = EO_OUTLINE("LeftOut", left_out_rows);

static const struct eo_outline_row comparison_rows[] = {
    EO_KEY("program", "text", "name and version"),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design that predicts"),
    EO_KEY("id", "[integer]", "numbers of the measurements, in the order of the columns"),
    EO_KEY("left_out", "[object]", "measurements that cannot be compared", .outline = &left_out_outline),
    {.outline = &eo_comparison_outline},
};
const struct eo_outline eo_rig_comparison_outline = EO_OUTLINE("Comparison", comparison_rows);

/* The numbers of the measurements beside the rows that stand for them. */
static json_t *encode_comparison(const struct work *w, const struct eo_design *design)
{
  char hash[EO_HASH_LENGTH + 1];
  json_t *document = json_object(), *inner = eo_comparison_encode(&w->comparison, w->measured);
  json_t *reduction;
  size_t i;
  bool failed = !inner;
  json_array_foreach(json_object_get(inner, "reductions"), i, reduction) eo_json_put(
      reduction, "id", json_incref(json_array_get(w->ids, (size_t)w->comparison.reduction[i].modified)), &failed);
  eo_json_put(document, "program", json_string(PACKAGE_STRING), &failed);
  eo_json_put(document, "design_hash", eo_design_hash(design, hash, NULL) ? NULL : json_string(hash), &failed);
  eo_json_put(document, "id", json_incref(w->ids), &failed);
  eo_json_put(document, "left_out", json_incref(w->left_out), &failed);
  failed = json_object_update(document, inner) != 0 || failed;
  json_decref(inner);
  return failed ? (json_decref(document), NULL) : document;
}

static enum eo_code run_comparison(void *data, const struct eo_pair *pair, const struct eo_design *design,
                                   const struct eo_progress *progress, struct eo_text *text, struct eo_error *error)
{
  const struct order *order = data;
  struct work w = {0};
  enum eo_code code = compare(&w, order, pair, design, progress, error);
  if (!code && order->csv)
    eo_comparison_csv(&w.comparison, w.measured, text);
  else if (!code)
    code = write(encode_comparison(&w, design), false, text, error);
  work_done(&w);
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

/* ---- fit ---- */

/* Sets in document what differs between two resolved designs, and nothing else: defaults that were not written stay
   unwritten. */
static bool overlay(json_t *document, const json_t *before, const json_t *after)
{
  const char *key;
  json_t *value;
  bool done = true;
  json_object_foreach((json_t *)after, key, value)
  {
    const json_t *old = json_object_get(before, key);
    if (json_equal(old, value))
      continue;
    json_t *inner = json_object_get(document, key);
    if (!json_is_object(value))
      done = json_object_set(document, key, value) == 0 && done;
    else {
      if (!json_is_object(inner))
        json_object_set_new(document, key, inner = json_object());
      done = overlay(inner, old, value) && done;
    }
  }
  return done;
}

static json_t *changed_design(const json_t *stored, const struct eo_design *design, const struct eo_design *updated)
{
  json_t *document = json_deep_copy(stored), *before = eo_design_encode(design), *after = eo_design_encode(updated);
  bool done = document && before && after && overlay(document, before, after);
  json_decref(before);
  json_decref(after);
  return done ? document : (json_decref(document), NULL);
}

static void drop_outliers(struct work *w)
{
  int kept = 0;
  json_t *ids = json_array();
  for (int i = 0; i < w->count; i++) {
    json_t *id = json_array_get(w->ids, (size_t)i);
    if (w->comparison.point[i].outlier)
      leave_out(w, json_integer_value(id), w->comparison.point[i].reason);
    else {
      w->measured[kept++] = w->measured[i];
      json_array_append(ids, id);
    }
  }
  w->count = kept;
  json_decref(w->ids);
  w->ids = ids;
}

static const struct eo_outline_row fit_rows[] = {
    {.outline = &eo_update_outline},
    EO_KEY("id", "[integer]", "numbers of the measurements used"),
    EO_KEY("left_out", "[object]", "measurements that were not, outliers too", .outline = &left_out_outline),
    EO_KEY("design", "object", "the design with the values found, as it was given but for them",
           .table = &eo_design_table, .name = "Design", .sparse = true),
};
const struct eo_outline eo_rig_fit_outline = EO_OUTLINE("Fit", fit_rows);

static enum eo_code run_fit(void *data, const struct eo_pair *pair, const struct eo_design *design,
                            const struct eo_progress *progress, struct eo_text *text, struct eo_error *error)
{
  const struct order *order = data;
  struct work w = {0};
  struct eo_update update;
  struct eo_design updated;
  enum eo_code code = compare(&w, order, pair, design, progress, error);
  if (!code) {
    drop_outliers(&w);
    code = eo_update_run(&update, pair, design, w.count, w.measured, &order->settings, &updated, progress, error);
  }
  if (!code) {
    json_t *document = eo_update_encode(&update);
    bool failed = !document;
    eo_json_put(document, "id", json_incref(w.ids), &failed);
    eo_json_put(document, "left_out", json_incref(w.left_out), &failed);
    eo_json_put(document, "design", changed_design(order->stored, design, &updated), &failed);
    code = write(document, failed, text, error);
  }
  work_done(&w);
  return code;
}

enum eo_code eo_rig_fit(struct eo_work *work, struct eo_rig_points *points, const struct eo_update_settings *settings,
                        const json_t *stored, struct eo_error *error)
{
  struct order *order;
  enum eo_code code = make(work, points, &order, error);
  if (code)
    return code;
  order->settings = *settings;
  order->stored = json_deep_copy(stored);
  work->run = run_fit;
  return EO_OK;
}

/* ---- synthetic recording ---- */

static enum eo_code respond(struct eo_rig_request *rig, const struct eo_pair *pair, const struct eo_design *design,
                            struct eo_error *error)
{
  struct eo_evaluator *evaluator = NULL;
  struct eo_rig_prediction prediction;
  enum eo_code code = eo_evaluator_new(&evaluator, pair, 1, error);
  if (!code)
    code = eo_prediction_run(&prediction, evaluator, design, rig->unmodified, rig->torque, rig->speed, rig->end,
                             rig->harmonics, error);
  if (!code && !prediction.valid)
    code = eo_error_set(error, EO_ERROR_INPUT, "", "The design has no periodic vibration at %g N m and %g rpm.",
                        rig->torque, rig->speed * 30 / M_PI);
  eo_evaluator_free(evaluator);
  if (code)
    return code;
  eo_rig_set_pair(rig, &pair->geometry, &design->supports, &prediction);
  code = eo_synthetic_check(&rig->synthetic, error);
  if (!code && eo_synthetic_rows(&rig->synthetic) > EO_RIG_MOST_ROWS)
    code = eo_error_set(error, EO_ERROR_INPUT, "", "The recording would have %lld rows; %d are the most here.",
                        (long long)eo_synthetic_rows(&rig->synthetic), EO_RIG_MOST_ROWS);
  return code;
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
