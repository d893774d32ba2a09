/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/job_document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/result_private.h"
#include "format/json.h"

void eo_job_live_done(struct eo_job_live *live)
{
  free(live->history);
  *live = (struct eo_job_live){0};
}

static double pfc_percent(int true_evaluations, int individuals)
{
  return individuals > 0 ? 100. * true_evaluations / individuals : NAN;
}

/* Behind the generation before it (NULL: the first); individuals: of this one, with the repeated ones. */
static void count_on(struct eo_job_generation *generation, const struct eo_job_generation *before, int individuals)
{
  generation->index = before ? before->index + 1 : 0;
  generation->true_so_far = (before ? before->true_so_far : 0) + generation->true_count;
  generation->individuals_so_far = (before ? before->individuals_so_far : 0) + individuals;
  generation->pfc_percent = pfc_percent(generation->true_so_far, generation->individuals_so_far);
}

static void take_point(struct eo_job_point *point, const struct eo_study_point *from)
{
  *point = (struct eo_job_point){
      .there = true, .has_modification = true, .value = from->value, .modification = from->modification};
}

/* Without memory the history ends early: it is there to be looked at. */
static void follow_generations(struct eo_job_live *live, const struct eo_study_report *report)
{
  if (report->generation > live->capacity) {
    int capacity = 2 * report->generation;
    struct eo_job_generation *more = realloc(live->history, sizeof *more * (size_t)capacity);
    if (!more)
      return;
    live->history = more;
    live->capacity = capacity;
  }
  for (int i = live->generations; i < report->generation; i++) {
    const struct eo_generation *generation = &report->history[i];
    live->history[i] = (struct eo_job_generation){.best = generation->best_value,
                                                  .mean = NAN,
                                                  .true_count = generation->true_count,
                                                  .predicted = generation->predicted_count};
    count_on(&live->history[i], i ? &live->history[i - 1] : NULL,
             generation->true_count + generation->predicted_count + generation->reused_count);
  }
  live->generations = report->generation;
}

void eo_job_live_follow(struct eo_job_live *live, const struct eo_study_report *report)
{
  live->state = EO_JOB_RUNNING;
  live->study = true;
  live->fraction = report->fraction;
  snprintf(live->what, sizeof live->what, "generation %d", report->generation + 1);
  live->generation = report->generation;
  live->true_evaluations = report->true_evaluations;
  live->predicted = report->predicted;
  live->reused = report->reused;
  live->individuals = report->individuals;
  live->seconds = report->seconds;
  live->seconds_left = report->seconds_left;
  if (!live->unmodified.there && report->unmodified->there)
    take_point(&live->unmodified, report->unmodified);
  if (report->best->there && (!live->best.there || live->best_evaluation != report->best->evaluation)) {
    take_point(&live->best, report->best);
    live->best_evaluation = report->best->evaluation;
  }
  follow_generations(live, report);
}

void eo_job_live_conclude(struct eo_job_live *live, const struct eo_study_result *result)
{
  live->generation = result->generations;
  live->true_evaluations = result->true_evaluations;
  live->predicted = result->predicted;
  live->reused = result->reused;
  live->individuals = result->individuals;
  live->seconds = result->seconds;
  live->seconds_left = result->stopped == EO_STOP_CANCELLED ? NAN : 0;
  if (result->best.there && live->best_evaluation != result->best.evaluation) {
    take_point(&live->best, &result->best);
    live->best_evaluation = result->best.evaluation;
  }
}

/* NaN: not known. */
struct progress {
  double fraction;
  char what[80];
  double generation, true_evaluations, predicted, reused, individuals, pfc_percent, seconds, seconds_left;
};

/* How much it took; the row of a job that ended says it too. */
#define ROW_TRUE_EVALUATIONS                                                        \
  EO_KEY("true_evaluations", "integer?", "by the model, or known from the history", \
         EO_AT(struct progress, true_evaluations))
#define ROW_INDIVIDUALS EO_KEY("individuals", "integer?", "fitness values needed", EO_AT(struct progress, individuals))
#define ROW_PFC \
  EO_KEY("pfc_percent", "number?", "true evaluations of the individuals, per cent", EO_AT(struct progress, pfc_percent))
static const struct eo_outline_row count_rows[] = {ROW_TRUE_EVALUATIONS, ROW_INDIVIDUALS, ROW_PFC};
static const struct eo_outline count_outline = EO_OUTLINE("JobCounts", count_rows);

static const struct eo_outline_row progress_rows[] = {
    EO_KEY("fraction", "number?", "0..1 of what the job does now: preparing, then optimizing",
           EO_AT(struct progress, fraction)),
    EO_KEY("what", "text", "what it does now, for people", EO_AT(struct progress, what)),
    EO_KEY("generation", "integer?", "of an optimization; null, as all below, while it is not known",
           EO_AT(struct progress, generation)),
    ROW_TRUE_EVALUATIONS,
    EO_KEY("predicted", "integer?", "individuals whose fitness was predicted", EO_AT(struct progress, predicted)),
    EO_KEY("reused", "integer?", "true evaluations that the history knew", EO_AT(struct progress, reused)),
    ROW_INDIVIDUALS,
    ROW_PFC,
    EO_KEY("seconds", "number?", "since it was begun, s", EO_AT(struct progress, seconds)),
    EO_KEY("seconds_left", "number?", "estimated, s", EO_AT(struct progress, seconds_left)),
};
static const struct eo_outline progress_outline = EO_OUTLINE("JobProgress", progress_rows);

static struct progress progress_of(const struct eo_job_live *live)
{
  struct progress progress = {.fraction = live->fraction,
                              .generation = NAN,
                              .true_evaluations = NAN,
                              .predicted = NAN,
                              .reused = NAN,
                              .individuals = NAN,
                              .pfc_percent = NAN,
                              .seconds = NAN,
                              .seconds_left = NAN};
  snprintf(progress.what, sizeof progress.what, "%s", live->what);
  if (!live->study)
    return progress;
  progress.generation = live->generation;
  progress.true_evaluations = live->true_evaluations;
  progress.predicted = live->predicted;
  progress.reused = live->reused;
  progress.individuals = live->individuals;
  progress.pfc_percent = pfc_percent(live->true_evaluations, live->individuals);
  progress.seconds = live->seconds;
  progress.seconds_left = live->seconds_left;
  return progress;
}

static json_t *write_modification(const void *source)
{
  const struct eo_job_point *point = source;
  return point->has_modification ? eo_table_encode(&eo_modification_table, &point->modification) : json_null();
}

static const struct eo_outline_row point_rows[] = {
    {.outline = &eo_outline_value, .offset = offsetof(struct eo_job_point, value)},
    EO_KEY("modification", "object?", "as a design takes it; null of a job of which the history alone is known",
           .table = &eo_modification_table, .name = "Modification", .write = write_modification),
};
static const struct eo_outline point_outline = EO_OUTLINE("JobPoint", point_rows);

/* What is kept with a job. */
struct kept {
  struct progress progress;
  struct eo_job_point best, unmodified;
};

static json_t *encode_point(const struct eo_job_point *point)
{
  return point->there ? eo_outline_encode(&point_outline, point) : json_null();
}

static json_t *write_best(const void *source)
{
  return encode_point(&((const struct kept *)source)->best);
}

static json_t *write_unmodified(const void *source)
{
  return encode_point(&((const struct kept *)source)->unmodified);
}

static const struct eo_outline_row kept_rows[] = {
    EO_KEY("progress", "object", "how far it is", EO_AT(struct kept, progress), .outline = &progress_outline),
    EO_KEY("best", "object?", "best so far", .outline = &point_outline, .write = write_best),
    EO_KEY("unmodified", "object?", "the pair without its modification", .outline = &point_outline,
           .write = write_unmodified),
};
static const struct eo_outline kept_outline = EO_OUTLINE("JobKept", kept_rows);

static json_t *encode_live(const struct eo_job_live *live)
{
  const struct kept kept = {progress_of(live), live->best, live->unmodified};
  return eo_outline_encode(&kept_outline, &kept);
}

void eo_job_live_write(const struct eo_job_live *live, struct eo_text *text)
{
  eo_json_write_new(text, encode_live(live), EO_JSON_COMPACT);
}

/* Of a terminal's job, or one that was not begun: what the table's columns tell. */
static json_t *encode_columns(const struct eo_stored_job *job)
{
  const struct eo_job_live live = {.fraction = job->state == EO_JOB_DONE     ? 1
                                               : job->state == EO_JOB_QUEUED ? 0
                                                                             : NAN,
                                   .study = job->true_evaluations > 0,
                                   .true_evaluations = job->true_evaluations,
                                   .individuals = job->individuals,
                                   .seconds = NAN,
                                   .seconds_left = NAN};
  struct kept kept = {
      .progress = progress_of(&live),
      .best = {.there = isfinite(job->best_value),
               .value = {.sums.failed = true, .objective = job->best_value, .fitness = NAN, .violation = NAN}}};
  kept.progress.generation = kept.progress.predicted = kept.progress.reused = NAN;
  return eo_outline_encode(&kept_outline, &kept);
}

/* The row of a study that ended says how much it took; what was noted of it may be older when the process ended before
   the last note. */
static void put_counts(json_t *progress, const struct eo_stored_job *job)
{
  if (!progress || job->individuals <= 0 || (job->state != EO_JOB_DONE && job->state != EO_JOB_CANCELLED))
    return;
  const struct progress took = {.true_evaluations = job->true_evaluations,
                                .individuals = job->individuals,
                                .pfc_percent = pfc_percent(job->true_evaluations, job->individuals)};
  json_t *counts = eo_outline_encode(&count_outline, &took);
  json_object_update(progress, counts);
  json_decref(counts);
}

static const struct eo_outline_row error_rows[] = {
    EO_KEY("detail", "text", "why it failed, for people", EO_AT(struct eo_error, text)),
    EO_KEY("pointer", "text", "to the key of the design that is to blame, or empty", EO_AT(struct eo_error, pointer)),
};
static const struct eo_outline error_outline = EO_OUTLINE("JobError", error_rows);

/* What names files of this machine is not for those who read the job. */
void eo_job_error_write(const struct eo_error *error, struct eo_text *text)
{
  struct eo_error shown = *error;
  if (error->code == EO_ERROR_FILE || error->code == EO_ERROR_FULL || error->code == EO_ERROR_BUSY ||
      error->code == EO_ERROR_DAMAGED) /* their sentences name files of this machine */
    snprintf(shown.text, sizeof shown.text, "The server's data cannot be read or written.");
  eo_json_write_new(text, eo_outline_encode(&error_outline, &shown), EO_JSON_COMPACT);
}

enum { TEXTS = 10 };

/* The texts of a row that a view keeps. */
static void list_texts(struct eo_stored_job *row, const char **text[TEXTS])
{
  const char **const all[TEXTS] = {&row->design,  &row->name,  &row->algorithm, &row->stopped, &row->created,
                                   &row->updated, &row->error, &row->progress,  &row->started, &row->finished};
  memcpy(text, all, sizeof all);
}

enum eo_code eo_job_view_init(struct eo_job_view *view, const struct eo_stored_job *row, const struct eo_job_live *live,
                              bool with_design, struct eo_error *error)
{
  const char **text[TEXTS];
  size_t size = 0, at = 0;
  *view = (struct eo_job_view){.row = *row};
  view->row.pair = view->row.study = view->row.space = "";
  view->row.result = *row->result ? "{}" : "";
  if (!with_design)
    view->row.design = "";
  list_texts(&view->row, text);
  for (int i = 0; i < TEXTS; i++)
    size += strlen(*text[i]) + 1;
  view->texts = malloc(size);
  if (!view->texts) {
    *view = (struct eo_job_view){0};
    return eo_error_memory(error);
  }
  for (int i = 0; i < TEXTS; i++) {
    size_t length = strlen(*text[i]) + 1;
    *text[i] = memcpy(view->texts + at, *text[i], length);
    at += length;
  }
  if (live)
    view->live = *live;
  view->live.history = NULL;
  view->live.generations = view->live.capacity = 0;
  return EO_OK;
}

void eo_job_view_done(struct eo_job_view *view)
{
  free(view->texts);
  *view = (struct eo_job_view){0};
}

/* What the document is about. */
struct source {
  struct eo_stored_job row;
  enum eo_job_state state;
  bool stopping, has_result;
  const json_t *kept, *fault, *design; /* NULL: none */
};

static json_t *share(const json_t *value)
{
  return value ? json_incref((json_t *)value) : json_null();
}

static json_t *write_kept_progress(const void *source)
{
  return share(json_object_get(((const struct source *)source)->kept, "progress"));
}

static json_t *write_kept_best(const void *source)
{
  return share(json_object_get(((const struct source *)source)->kept, "best"));
}

static json_t *write_kept_unmodified(const void *source)
{
  return share(json_object_get(((const struct source *)source)->kept, "unmodified"));
}

static json_t *write_fault(const void *source)
{
  return share(((const struct source *)source)->fault);
}

static json_t *write_design(const void *source)
{
  return share(((const struct source *)source)->design);
}

static bool has_design(const void *source)
{
  return ((const struct source *)source)->design;
}

#define AT_ROW(member) EO_AT(struct source, row.member)
static const struct eo_outline_row job_rows[] = {
    EO_KEY("id", "integer", "number of the job", AT_ROW(id)),
    EO_KEY("kind", "word", "what it does", .words = eo_store_job_kinds, AT_ROW(kind)),
    EO_KEY("name", "text", "of the design", AT_ROW(name)),
    EO_KEY("algorithm", "text?", "of an optimization", AT_ROW(algorithm)),
    EO_KEY("state", "word", "preparing: the gear pair, before the optimization", .words = eo_store_job_states,
           EO_AT(struct source, state)),
    EO_KEY("stopping", "flag", "somebody asked it to end", EO_AT(struct source, stopping)),
    EO_KEY("stopped", "word?", "why it ended", .words = eo_study_stops, AT_ROW(stopped)),
    EO_KEY("has_result", "flag", "there is a result to get", EO_AT(struct source, has_result)),
    EO_KEY("priority", "integer", "-10..10; higher is earlier", AT_ROW(priority)),
    EO_KEY("fresh", "flag", "the algorithm knew no earlier rows", AT_ROW(fresh)),
    EO_KEY("attempts", "integer", "how often it was begun", AT_ROW(attempts)),
    EO_KEY("created", "text", "date and time, UTC", AT_ROW(created)),
    EO_KEY("started", "text?", "date and time, UTC", AT_ROW(started)),
    EO_KEY("finished", "text?", "date and time, UTC", AT_ROW(finished)),
    EO_KEY("updated", "text", "date and time, UTC", AT_ROW(updated)),
    EO_KEY("progress", "object", "how far it is", .outline = &progress_outline, .write = write_kept_progress),
    EO_KEY("best", "object?", "best so far", .outline = &point_outline, .write = write_kept_best),
    EO_KEY("unmodified", "object?", "the pair without its modification", .outline = &point_outline,
           .write = write_kept_unmodified),
    EO_KEY("error", "object?", "of a failed job", .outline = &error_outline, .write = write_fault),
    EO_KEY("design", "object", "with every default resolved", .when = "when one job is asked for",
           .table = &eo_design_table, .name = "ResolvedDesign", .write = write_design, .there = has_design),
};
const struct eo_outline eo_job_outline = EO_OUTLINE("Job", job_rows);

static json_t *parse(const char *text)
{
  return *text ? json_loads(text, JSON_DECODE_ANY, NULL) : NULL;
}

/* What is known of the job beyond its row, live or as it was noted. */
static json_t *find_kept(const struct eo_stored_job *row, const struct eo_job_live *live)
{
  if (live)
    return encode_live(live);
  json_t *kept = parse(row->progress);
  if (!kept)
    kept = encode_columns(row);
  put_counts(json_object_get(kept, "progress"), row);
  return kept;
}

json_t *eo_job_view_encode(const struct eo_job_view *view)
{
  const struct eo_stored_job *row = &view->row;
  const struct eo_job_live *live = view->live.id ? &view->live : NULL;
  json_t *kept = find_kept(row, live), *fault = parse(row->error), *design = parse(row->design);
  struct source source = {.row = *row,
                          .state = live ? live->state : row->state,
                          .stopping = row->stop &&
                                      (live || row->state == EO_JOB_PREPARING || row->state == EO_JOB_RUNNING),
                          .has_result = !live && *row->result,
                          .kept = kept,
                          .fault = fault,
                          .design = design};
  if (live)
    source.row.finished = "";
  json_t *document = eo_outline_encode(&eo_job_outline, &source);
  json_decref(kept);
  json_decref(fault);
  json_decref(design);
  return document;
}

void eo_job_view_write(const struct eo_job_view *view, struct eo_text *text)
{
  eo_json_write_new(text, eo_job_view_encode(view), EO_JSON_COMPACT);
}

enum eo_code eo_job_convergence_copy(struct eo_job_convergence *convergence, const struct eo_job_live *live,
                                     struct eo_error *error)
{
  size_t size = sizeof *convergence->generation * (size_t)live->generations;
  *convergence = (struct eo_job_convergence){live->generations, malloc(size + 1)};
  if (!convergence->generation) {
    convergence->count = 0;
    return eo_error_memory(error);
  }
  if (size)
    memcpy(convergence->generation, live->history, size);
  return EO_OK;
}

static void read_generation(struct eo_job_generation *generation, const struct eo_job_generation *before,
                            const json_t *value)
{
  *generation = (struct eo_job_generation){.best = eo_json_find_number(value, "best"),
                                           .mean = eo_json_find_number(value, "mean"),
                                           .true_count = (int)eo_json_find_number(value, "true"),
                                           .predicted = (int)eo_json_find_number(value, "predicted")};
  count_on(generation, before,
           generation->true_count + generation->predicted + (int)eo_json_find_number(value, "repeated"));
}

enum eo_code eo_job_convergence_read(struct eo_job_convergence *convergence, const char *result, struct eo_error *error)
{
  json_t *document = parse(result);
  const json_t *generations = json_object_get(document, "generations");
  int count = (int)json_array_size(generations);
  *convergence = (struct eo_job_convergence){count, calloc((size_t)count + 1, sizeof *convergence->generation)};
  if (!convergence->generation)
    convergence->count = 0;
  for (int i = 0; i < convergence->count; i++)
    read_generation(&convergence->generation[i], i ? &convergence->generation[i - 1] : NULL,
                    json_array_get(generations, (size_t)i));
  json_decref(document);
  return convergence->generation ? EO_OK : eo_error_memory(error);
}

void eo_job_convergence_done(struct eo_job_convergence *convergence)
{
  free(convergence->generation);
  *convergence = (struct eo_job_convergence){0};
}

#define COLUMN(member) EO_COLUMN_AT(struct eo_job_convergence, generation, count, struct eo_job_generation, member)
static const struct eo_outline_row generation_rows[] = {
    EO_KEY("generation", "[integer]", "from 0", COLUMN(index)),
    EO_KEY("best", "[number?]", "J and penalties of the best so far", COLUMN(best)),
    EO_KEY("mean", "[number?]", "of the generation's true evaluations; null while the job runs", COLUMN(mean)),
    EO_KEY("true_evaluations", "[integer]", "of the generation, by the model or known from the history",
           COLUMN(true_count)),
    EO_KEY("predicted", "[integer]", "individuals of the generation whose fitness was predicted", COLUMN(predicted)),
    EO_KEY("pfc_percent", "[number?]", "true evaluations of all individuals so far, per cent", COLUMN(pfc_percent)),
};
const struct eo_outline eo_job_generations_outline = EO_OUTLINE("Generations", generation_rows);

json_t *eo_job_convergence_encode(const struct eo_job_convergence *convergence)
{
  return eo_outline_encode(&eo_job_generations_outline, convergence);
}
