#include "service/job_document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "document/result_private.h"

void eo_job_live_done(struct eo_job_live *live)
{
  json_decref(live->best);
  json_decref(live->unmodified);
  free(live->history);
  *live = (struct eo_job_live){0};
}

/* ---- what a study reports ---- */

static const struct eo_outline_row best_rows[] = {
    {.outline = &eo_outline_value},
    EO_KEY("modification", "object?", "as a design takes it; null of a job of which the history alone is known",
           .table = &eo_modification_table, .name = "Modification"),
};
static const struct eo_outline best_outline = EO_OUTLINE("JobPoint", best_rows);

static json_t *encode_point(const struct eo_study_point *point)
{
  struct eo_object o = eo_object_open_as(&best_outline);
  eo_outline_put(&o, &eo_outline_value, &point->value);
  eo_object_put(&o, "modification", eo_table_encode(&eo_modification_table, &point->modification));
  return eo_object_close(&o);
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
    const struct eo_generation *g = &report->history[i];
    live->history[i] = (struct eo_job_generation){g->best_value, g->true_count, g->predicted_count,
                                                  g->true_count + g->predicted_count + g->reused_count};
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
  if (!live->unmodified && report->unmodified->there)
    live->unmodified = encode_point(report->unmodified);
  if (report->best->there && (!live->best || live->best_evaluation != report->best->evaluation)) {
    json_decref(live->best);
    live->best = encode_point(report->best);
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
    json_decref(live->best);
    live->best = encode_point(&result->best);
    live->best_evaluation = result->best.evaluation;
  }
}

/* ---- documents ---- */

static double pfc_percent(int true_evaluations, int individuals)
{
  return individuals > 0 ? 100. * true_evaluations / individuals : NAN;
}

static json_t *whole(bool known, int value)
{
  return known ? json_integer(value) : json_null();
}

static const struct eo_outline_row progress_rows[] = {
    EO_KEY("fraction", "number?", "0..1 of what the job does now: preparing, then optimizing"),
    EO_KEY("what", "text", "what it does now, for people"),
    EO_KEY("generation", "integer?", "of an optimization; null, as all below, while it is not known"),
    EO_KEY("true_evaluations", "integer?", "by the model, or known from the history"),
    EO_KEY("predicted", "integer?", "individuals whose fitness was predicted"),
    EO_KEY("reused", "integer?", "true evaluations that the history knew"),
    EO_KEY("individuals", "integer?", "fitness values needed"),
    EO_KEY("pfc_percent", "number?", "true evaluations of the individuals, per cent"),
    EO_KEY("seconds", "number?", "since it was begun, s"),
    EO_KEY("seconds_left", "number?", "estimated, s"),
};
static const struct eo_outline progress_outline = EO_OUTLINE("JobProgress", progress_rows);

static json_t *encode_progress(const struct eo_job_live *live)
{
  struct eo_object o = eo_object_open_as(&progress_outline);
  bool known = live->study;
  eo_object_put_number(&o, "fraction", live->fraction);
  eo_object_put(&o, "what", json_string(live->what));
  eo_object_put(&o, "generation", whole(known, live->generation));
  eo_object_put(&o, "true_evaluations", whole(known, live->true_evaluations));
  eo_object_put(&o, "predicted", whole(known, live->predicted));
  eo_object_put(&o, "reused", whole(known, live->reused));
  eo_object_put(&o, "individuals", whole(known, live->individuals));
  eo_object_put_number(&o, "pfc_percent", known ? pfc_percent(live->true_evaluations, live->individuals) : NAN);
  eo_object_put_number(&o, "seconds", known ? live->seconds : NAN);
  eo_object_put_number(&o, "seconds_left", known ? live->seconds_left : NAN);
  return eo_object_close(&o);
}

json_t *eo_job_live_encode(const struct eo_job_live *live)
{
  struct eo_object o = eo_object_open();
  eo_object_put(&o, "progress", encode_progress(live));
  eo_object_put(&o, "best", live->best ? json_deep_copy(live->best) : json_null());
  eo_object_put(&o, "unmodified", live->unmodified ? json_deep_copy(live->unmodified) : json_null());
  return eo_object_close(&o);
}

static json_t *parse(const char *text)
{
  return *text ? json_loads(text, JSON_DECODE_ANY, NULL) : NULL;
}

/* Of a terminal's job, or one that was not begun: what the table's columns tell. */
static json_t *encode_columns(const struct eo_stored_job *job)
{
  struct eo_job_live live = {.fraction = job->state == EO_JOB_DONE     ? 1
                                         : job->state == EO_JOB_QUEUED ? 0
                                                                       : NAN,
                             .study = job->true_evaluations > 0,
                             .true_evaluations = job->true_evaluations,
                             .individuals = job->individuals,
                             .seconds = NAN,
                             .seconds_left = NAN};
  json_t *document = eo_job_live_encode(&live);
  json_t *progress = json_object_get(document, "progress");
  struct eo_object best = eo_object_open_as(&best_outline);
  for (const char *const *key = (const char *const[]){"generation", "predicted", "reused", NULL}; *key && progress;
       key++)
    json_object_set_new(progress, *key, json_null());
  eo_outline_put(&best, &eo_outline_value,
                 &(struct eo_objective_value){
                     .sums.failed = true, .objective = job->best_value, .fitness = NAN, .violation = NAN});
  eo_object_put(&best, "modification", json_null());
  json_t *value = eo_object_close(&best);
  if (isfinite(job->best_value) && value)
    json_object_set(document, "best", value);
  json_decref(value);
  return document;
}

/* The row of a study that ended says how much it took; what was noted of it may be older when the process ended before
   the last note. */
static void put_counts(json_t *progress, const struct eo_stored_job *job)
{
  if (!progress || job->individuals <= 0 || (job->state != EO_JOB_DONE && job->state != EO_JOB_CANCELLED))
    return;
  json_object_set_new(progress, "true_evaluations", json_integer(job->true_evaluations));
  json_object_set_new(progress, "individuals", json_integer(job->individuals));
  json_object_set_new(progress, "pfc_percent",
                      eo_json_quantity(pfc_percent(job->true_evaluations, job->individuals), NULL));
}

static json_t *text_or_null(const char *text)
{
  return *text ? json_string(text) : json_null();
}

static const struct eo_outline_row error_rows[] = {
    EO_KEY("detail", "text", "why it failed, for people"),
    EO_KEY("pointer", "text", "to the key of the design that is to blame, or empty"),
};
static const struct eo_outline error_outline = EO_OUTLINE("JobError", error_rows);

/* What names files of this machine is not for those who read the job. */
json_t *eo_job_error_encode(const struct eo_error *error)
{
  struct eo_object o = eo_object_open_as(&error_outline);
  eo_object_put(
      &o, "detail",
      json_string(error->code == EO_ERROR_FILE ? "The server's data cannot be read or written." : error->text));
  eo_object_put(&o, "pointer", json_string(error->pointer));
  return eo_object_close(&o);
}

static const struct eo_outline_row job_rows[] = {
    EO_KEY("id", "integer", "number of the job"),
    EO_KEY("kind", "word", "what it does", .words = eo_store_job_kinds),
    EO_KEY("name", "text", "of the design"),
    EO_KEY("algorithm", "text?", "of an optimization"),
    EO_KEY("state", "word", "preparing: the gear pair, before the optimization", .words = eo_store_job_states),
    EO_KEY("stopping", "flag", "somebody asked it to end"),
    EO_KEY("stopped", "word?", "why it ended", .words = eo_study_stops),
    EO_KEY("has_result", "flag", "there is a result to get"),
    EO_KEY("priority", "integer", "-10..10; higher is earlier"),
    EO_KEY("fresh", "flag", "the algorithm knew no earlier rows"),
    EO_KEY("attempts", "integer", "how often it was begun"),
    EO_KEY("created", "text", "date and time, UTC"),
    EO_KEY("started", "text?", "date and time, UTC"),
    EO_KEY("finished", "text?", "date and time, UTC"),
    EO_KEY("updated", "text", "date and time, UTC"),
    EO_KEY("progress", "object", "how far it is", .outline = &progress_outline),
    EO_KEY("best", "object?", "best so far", .outline = &best_outline),
    EO_KEY("unmodified", "object?", "the pair without its modification", .outline = &best_outline),
    EO_KEY("error", "object?", "of a failed job", .outline = &error_outline),
    EO_KEY("design", "object", "with every default resolved", .when = "when one job is asked for",
           .table = &eo_design_table, .name = "ResolvedDesign"),
};
const struct eo_outline eo_job_outline = EO_OUTLINE("Job", job_rows);

json_t *eo_job_encode(const struct eo_stored_job *job, const struct eo_job_live *live, bool with_design)
{
  struct eo_object o = eo_object_open_as(&eo_job_outline);
  json_t *kept = live ? eo_job_live_encode(live) : parse(job->progress), *fault = parse(job->error),
         *design = with_design ? parse(job->design) : NULL;
  if (!kept)
    kept = encode_columns(job);
  if (!live)
    put_counts(json_object_get(kept, "progress"), job);
  eo_object_put(&o, "id", json_integer(job->id));
  eo_object_put(&o, "kind", json_string(eo_store_job_kind_name(job->kind)));
  eo_object_put(&o, "name", json_string(job->name));
  eo_object_put(&o, "algorithm", text_or_null(job->algorithm));
  eo_object_put(&o, "state", json_string(eo_store_job_state_name(live ? live->state : job->state)));
  eo_object_put(&o, "stopping",
                json_boolean(job->stop && (live || job->state == EO_JOB_PREPARING || job->state == EO_JOB_RUNNING)));
  eo_object_put(&o, "stopped", text_or_null(job->stopped));
  eo_object_put(&o, "has_result", json_boolean(!live && *job->result));
  eo_object_put(&o, "priority", json_integer(job->priority));
  eo_object_put(&o, "fresh", json_boolean(job->fresh));
  eo_object_put(&o, "attempts", json_integer(job->attempts));
  eo_object_put(&o, "created", json_string(job->created));
  eo_object_put(&o, "started", text_or_null(job->started));
  eo_object_put(&o, "finished", live ? json_null() : text_or_null(job->finished));
  eo_object_put(&o, "updated", json_string(job->updated));
  for (const char *const *key = (const char *const[]){"progress", "best", "unmodified", NULL}; *key; key++) {
    json_t *value = json_object_get(kept, *key);
    eo_object_put(&o, *key, value ? json_incref(value) : json_null());
  }
  eo_object_put(&o, "error", fault ? json_incref(fault) : json_null());
  if (with_design)
    eo_object_put(&o, "design", design ? json_incref(design) : NULL);
  json_decref(kept);
  json_decref(fault);
  json_decref(design);
  return eo_object_close(&o);
}

/* ---- convergence ---- */

static const struct eo_outline_row generation_rows[] = {
    EO_KEY("generation", "[integer]", "from 0"),
    EO_KEY("best", "[number?]", "J and penalties of the best so far"),
    EO_KEY("mean", "[number?]", "of the generation's true evaluations; null while the job runs"),
    EO_KEY("true_evaluations", "[integer]", "of the generation, by the model or known from the history"),
    EO_KEY("predicted", "[integer]", "individuals of the generation whose fitness was predicted"),
    EO_KEY("pfc_percent", "[number?]", "true evaluations of all individuals so far, per cent"),
};
const struct eo_outline eo_job_generations_outline = EO_OUTLINE("Generations", generation_rows);

enum { GENERATION, BEST, MEAN, TRUE_EVALUATIONS, PREDICTED, PFC, COLUMNS };

struct columns {
  json_t *array[COLUMNS];
  bool failed;
};

static struct columns open_columns(void)
{
  struct columns c = {0};
  for (int i = 0; i < COLUMNS; i++)
    c.failed |= !(c.array[i] = json_array());
  return c;
}

static void add(struct columns *c, int column, json_t *value)
{
  c->failed = json_array_append_new(c->array[column], value) != 0 || c->failed;
}

static json_t *close_columns(struct columns *c)
{
  struct eo_object o = eo_object_open_as(&eo_job_generations_outline);
  o.failed = o.failed || c->failed;
  for (int i = 0; i < COLUMNS; i++)
    eo_object_put(&o, generation_rows[i].key, c->array[i]);
  return eo_object_close(&o);
}

json_t *eo_job_live_generations(const struct eo_job_live *live)
{
  struct columns c = open_columns();
  int evaluated = 0, individuals = 0;
  for (int i = 0; i < live->generations; i++) {
    const struct eo_job_generation *g = &live->history[i];
    evaluated += g->true_count;
    individuals += g->individuals;
    add(&c, GENERATION, json_integer(i));
    add(&c, BEST, eo_json_quantity(g->best, NULL));
    add(&c, MEAN, json_null());
    add(&c, TRUE_EVALUATIONS, json_integer(g->true_count));
    add(&c, PREDICTED, json_integer(g->predicted));
    add(&c, PFC, eo_json_quantity(pfc_percent(evaluated, individuals), NULL));
  }
  return close_columns(&c);
}

json_t *eo_job_result_generations(const json_t *result)
{
  struct columns c = open_columns();
  double evaluated = 0, individuals = 0;
  size_t i;
  json_t *g;
  json_array_foreach(json_object_get(result, "generations"), i, g)
  {
    evaluated += eo_json_find_number(g, "true");
    individuals += eo_json_find_number(g, "true") + eo_json_find_number(g, "predicted") +
                   eo_json_find_number(g, "repeated");
    add(&c, GENERATION, json_integer((json_int_t)i));
    add(&c, BEST, json_incref(json_object_get(g, "best")));
    add(&c, MEAN, json_incref(json_object_get(g, "mean")));
    add(&c, TRUE_EVALUATIONS, json_incref(json_object_get(g, "true")));
    add(&c, PREDICTED, json_incref(json_object_get(g, "predicted")));
    add(&c, PFC, eo_json_quantity(100 * evaluated / individuals, NULL));
  }
  return close_columns(&c);
}
