/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study loop: threads, history, interruption, other weights, bounds and variables, failures, and what the documents
   say. */
#include <math.h>

#include "base/parallel.h"
#include "document/search_space.h"
#include "evaluation/analysis.h"
#include "study/history_document.h"
#include "store/queue.h"
#include "support/study-fixture.h"
#include "support/tap.h"

static struct eo_pair *pair;
static struct eo_design design, other;
static struct eo_study_result result;

static struct eo_study_plan plan_of(const struct eo_design *of, struct eo_store *store)
{
  return (struct eo_study_plan){.design = of, .pair = pair, .store = store, .threads = 2};
}

/* One study in a folder; its lasting part (owned), *r the result. */
static char *run(const struct eo_study_plan *wanted, struct eo_study_result *r)
{
  struct eo_study_plan plan = *wanted;
  char *text = NULL;
  memset(&error, 0, sizeof error);
  if (!eo_store_open(&plan.store, folder, EO_STORE_WRITE, &error) && !eo_study_run(&plan, r, &error))
    text = lasting_part(&plan, r);
  if (!text)
    printf("# %s\n", error.text);
  eo_store_close(plan.store);
  return text;
}

static void test_threads(const char *algorithm)
{
  char *text[3];
  coarse_design(&design, algorithm, 60);
  complete(&design);
  for (int i = 0; i < 3; i++) {
    struct eo_study_plan plan = plan_of(&design, NULL);
    plan.threads = 1 << i;
    empty_folder();
    text[i] = run(&plan, &result);
    if (i < 2)
      eo_study_result_done(&result);
  }
  ok(text[0] && text[1] && text[2] && strcmp(text[0], text[1]) == 0 && strcmp(text[0], text[2]) == 0,
     "%s: 1, 2 and 4 threads give the same bytes", algorithm);
  ok(result.best.there && result.best.value.objective < 0.7 && result.computed == 60 && result.true_evaluations == 60 &&
         result.reused == 0,
     "%s: the search comes to J %.4g after %d evaluations", algorithm, result.best.value.objective, result.computed);
  eo_study_result_done(&result);
  struct eo_study_plan plan = plan_of(&design, NULL);
  char *again = run(&plan, &result);
  ok(again && strcmp(again, text[0]) == 0 && result.computed == 0 && result.resumed,
     "%s: a second search computes nothing and gives the same result", algorithm);
  eo_study_result_done(&result);
  free(again);
  for (int i = 0; i < 3; i++)
    free(text[i]);
}

/* Stops after a number of evaluations. */
static int stop_after(void *context, const struct eo_study_report *report)
{
  return report->true_evaluations >= *(int *)context;
}

static void test_cancel(void)
{
  struct eo_study_plan plan = plan_of(&design, NULL);
  coarse_design(&design, "credibility-ga", 80);
  complete(&design);
  empty_folder();
  char *whole = run(&plan, &result);
  eo_study_result_done(&result);
  empty_folder();
  int stop = 0, computed = 0, cuts = 0;
  char *text = NULL;
  for (; stop < 80; stop += 13) {
    struct eo_study_plan cut = plan;
    cut.watch = stop_after;
    cut.context = &stop;
    free(text);
    text = run(&cut, &result);
    computed += result.computed;
    cuts += result.stopped == EO_STOP_CANCELLED;
    eo_study_result_done(&result);
  }
  free(text);
  text = run(&plan, &result);
  computed += result.computed;
  ok(cuts == 7 && text && strcmp(text, whole) == 0,
     "a search that is stopped %d times gives the result of an undisturbed one", cuts);
  ok(computed == 80 && result.reused == 0, "a search with stops computes %d evaluations in all, none twice", computed);
  eo_study_result_done(&result);
  free(text);
  free(whole);
}

/* A study that knew the rows of another job, cut short: that job may be removed before it goes on. */
static void test_removed_job(const char *algorithm)
{
  struct eo_study_plan plan = plan_of(&other, NULL), cut;
  char *text[2] = {NULL, NULL};
  int64_t first = 0;
  coarse_design(&design, algorithm, 40);
  coarse_design(&other, algorithm, 90);
  complete(&design);
  complete(&other);
  for (int removed = 0; removed < 2; removed++) {
    struct eo_study_plan before = plan_of(&design, NULL);
    enum eo_job_outcome outcome = EO_JOB_OUTCOME_DONE;
    struct eo_store *store = NULL;
    empty_folder();
    free(run(&before, &result));
    first = result.job;
    eo_study_result_done(&result);
    cut = plan;
    cut.watch = stop_after;
    cut.context = &(int){50};
    free(run(&cut, &result));
    eo_study_result_done(&result);
    if (removed && (eo_store_open(&store, folder, EO_STORE_WRITE, &error) ||
                    eo_queue_remove(store, first, &outcome, &error) || outcome))
      printf("# it is not removed: %s\n", error.text);
    eo_store_close(store);
    text[removed] = run(&plan, &result);
    ok(result.resumed && result.imported == 40 && result.true_evaluations == 90,
       "%s: the search is taken up with %d rows of another job", algorithm, result.imported);
    eo_study_result_done(&result);
  }
  ok(text[0] && text[1] && strcmp(text[0], text[1]) == 0,
     "%s: the result is the same whether that job is still there or not", algorithm);
  free(text[0]);
  free(text[1]);
}

static void test_reuse(void)
{
  struct eo_study_plan plan = plan_of(&design, NULL);
  empty_folder();
  coarse_design(&design, "ga", 60);
  complete(&design);
  free(run(&plan, &result));
  struct eo_modification best = result.best.modification;
  double sum = result.best.value.sums.f[0];
  eo_study_result_done(&result);

  /* other weights: the same points, no evaluation */
  design.objective.weight[0] = 0.8;
  design.load_case[0].share = 0.4;
  design.load_case[1].share = 0.3;
  design.optimization.search.true_evaluations = 40; /* the first generation of 20 does not depend on values */
  plan.fresh = true;
  free(run(&plan, &result));
  ok(result.reused >= 20 && result.reused + result.computed == 40,
     "other weights and shares weigh anew what is known of %d of 40", result.reused);
  ok(fabs(result.unmodified.value.objective - 1.4) < 1e-12, "J of the unmodified pair is the sum of the weights");
  eo_study_result_done(&result);

  /* told of earlier rows, a search starts at the best of them */
  coarse_design(&design, "credibility-ga", 8);
  complete(&design);
  plan.fresh = false;
  free(run(&plan, &result));
  ok(result.imported >= 60 && result.imported <= 100 && result.best.there && result.best.value.sums.f[0] <= sum * 1.2,
     "%d rows of earlier searches are imported", result.imported);
  ok(result.computed == 8, "the budget is spent on new rows");
  eo_study_result_done(&result);

  /* a stop while these are read, which takes long where there are many */
  struct eo_study_plan cut = plan;
  design.optimization.search.true_evaluations = 9;
  cut.watch = stop_after;
  cut.context = &(int){0};
  free(run(&cut, &result));
  ok(result.stopped == EO_STOP_CANCELLED && result.imported < 32 && result.computed == 0,
     "a stop is heard after %d rows of earlier searches", result.imported);
  eo_study_result_done(&result);
  free(run(&plan, &result));
  ok(result.resumed && result.imported >= 60 && result.computed == 9,
     "the search goes on with all %d rows of earlier searches", result.imported);
  eo_study_result_done(&result);

  /* another space: both ends apart; the rows with equal ends lie in it */
  design.optimization.variables = EO_VARIABLES_PER_END;
  complete(&design);
  free(run(&plan, &result));
  ok(result.space.count == 10 && result.imported >= 60, "case B imports the %d rows of case A", result.imported);
  eo_study_result_done(&result);

  /* other supports: nothing may be used */
  coarse_design(&design, "ga", 20);
  design.supports.mesh_damping_ratio = 0.08;
  complete(&design);
  free(run(&plan, &result));
  ok(result.imported == 0 && result.reused == 0 && result.computed == 20, "a search of another problem shares nothing");
  eo_study_result_done(&result);
  ok(best.flank[EO_PINION][EO_LEFT].tip_relief == best.flank[EO_PINION][EO_RIGHT].tip_relief,
     "variables that are shared have one value");
}

/* The reported optimum analysed on its own gives the numbers that were reported. */
static void test_truth(void)
{
  struct eo_study_plan plan = plan_of(&design, NULL);
  struct eo_analysis *analysis = NULL;
  empty_folder();
  coarse_design(&design, "fpga", 0);
  design.optimization.search.generations = 6;
  complete(&design);
  char *text = run(&plan, &result);
  ok(result.predicted > 0 && result.individuals == result.true_evaluations + result.predicted + result.repeated,
     "fpga predicts %d of %d individuals", result.predicted, result.individuals);
  json_t *document = text ? json_loads(text, 0, NULL) : NULL;
  const json_t *reported = eo_json_find(document, "best/result/design");
  struct eo_faults *faults = calloc(1, sizeof *faults);
  bool decoded = faults && eo_design_decode(reported, &other, NULL, faults);
  bool good = decoded && complete(&other) && !eo_analysis_new(&analysis, pair, &error) &&
              !eo_analysis_run(analysis, &other, 0, &error);
  ok(good && analysis->value.objective == result.best.value.objective &&
         analysis->value.sums.f[2] == result.best.value.sums.f[2],
     "the optimum read back from its document and analysed: J %.17g", good ? analysis->value.objective : NAN);
  ok(good && eo_json_find_number(document, "best/result/objectives/J") ==
                 eo_json_find_number(document, "best/objectives/J"),
     "the optimum read back has the J of its own result");
  double pfc = eo_json_find_number(document, "pfc_percent");
  ok(fabs(pfc - 100. * result.true_evaluations / result.individuals) < 1e-9, "PFC is %.3g %%", pfc);
  const json_t *generations = json_object_get(document, "generations");
  double before = INFINITY;
  int worse = 0, sum = 0;
  for (size_t i = 0; i < json_array_size(generations); i++) {
    const json_t *g = json_array_get(generations, i);
    worse += eo_json_find_number(g, "best") > before;
    before = eo_json_find_number(g, "best");
    sum += (int)eo_json_find_number(g, "true");
  }
  ok(json_array_size(generations) == 6 && !worse && sum == result.true_evaluations &&
         before == eo_json_find_number(document, "best/objectives/J"),
     "true evaluations add up over the generations, and the best never gets worse");
  eo_analysis_free(analysis);
  eo_study_result_done(&result);
  json_decref(document);
  free(faults);
  free(text);
}

static void test_front(void)
{
  struct eo_study_plan plan = plan_of(&design, NULL);
  empty_folder();
  coarse_design(&design, "nsga2", 96);
  complete(&design);
  free(run(&plan, &result));
  int dominated = 0;
  for (int i = 0; i < result.front_count; i++)
    for (int j = 0; j < result.front_count; j++) {
      const double *a = result.front[i].value.sums.f, *b = result.front[j].value.sums.f;
      dominated += a[0] <= b[0] && a[1] <= b[1] && a[2] <= b[2] && (a[0] < b[0] || a[1] < b[1] || a[2] < b[2]);
    }
  ok(result.front_count > 3 && !dominated && result.knee >= 0 && result.weighted >= 0,
     "nsga2 finds a front of %d true rows, none dominated", result.front_count);
  eo_study_result_done(&result);
}

/* The nominal pair against the pairs as made: a front of two axes. */
static void test_robust_front(void)
{
  struct eo_study_plan plan = plan_of(&design, NULL);
  empty_folder();
  coarse_design(&design, "nsga2", 60);
  design.objective.robust = EO_ROBUST_PERCENTILE;
  design.objective.scatter_pairs = 3;
  design.objective.check_pairs = 0;
  design.optimization.front = EO_FRONT_NOMINAL_AND_ROBUST;
  complete(&design);
  free(run(&plan, &result));
  int dominated = 0;
  for (int i = 0; i < result.front_count; i++)
    for (int j = 0; j < result.front_count; j++) {
      const struct eo_objective_value *a = &result.front[i].value, *b = &result.front[j].value;
      dominated += a->nominal <= b->nominal && a->objective <= b->objective &&
                   (a->nominal < b->nominal || a->objective < b->objective);
    }
  ok(result.front_count > 1 && !dominated && result.scenarios == 4,
     "nsga2 finds %d true rows between the nominal and the robust J, none dominated", result.front_count);
  eo_study_result_done(&result);
}

/* Most flanks are looked at with the first pairs alone: the same bytes for any number of threads and once more, the
   best one is known over all pairs, and the second looks cost less than the first. */
static void test_race(void)
{
  char *text[2];
  coarse_design(&design, "credibility-ga", 80);
  design.objective.robust = EO_ROBUST_PERCENTILE;
  design.objective.scatter_pairs = 8;
  design.objective.check_pairs = 6;
  complete(&design);
  for (int i = 0; i < 2; i++) {
    struct eo_study_plan plan = plan_of(&design, NULL);
    plan.threads = 1 + 2 * i;
    empty_folder();
    text[i] = run(&plan, &result);
    if (i == 0)
      eo_study_result_done(&result);
  }
  ok(text[0] && text[1] && strcmp(text[0], text[1]) == 0, "a race over pairs gives the same bytes for 1 and 3 threads");
  int first = design.objective.first_pairs, looked = first * result.true_evaluations,
      more = (design.objective.scatter_pairs - first) * result.whole;
  ok(first == 2 && result.whole < 40 && more < looked && 2 * more > looked,
     "%d of %d flanks were looked at with all pairs: %d and %d evaluations of a pair", result.whole,
     result.true_evaluations, looked, more);
  int there = 0;
  for (int i = 0; i < result.scenarios * result.cases; i++)
    there += isfinite(result.best.raw[i].rms);
  ok(result.best.there && there == result.scenarios * result.cases && result.best.value.objective < 1,
     "the best flank, J %.3f, is known over all of its pairs", result.best.value.objective);
  eo_study_result_done(&result);
  struct eo_study_plan plan = plan_of(&design, NULL);
  char *again = run(&plan, &result);
  ok(again && strcmp(again, text[0]) == 0 && result.computed == 0, "a second race computes nothing");
  json_t *document = again ? json_loads(again, 0, NULL) : NULL;
  const json_t *check = json_object_get(document, "check");
  ok(json_integer_value(json_object_get(check, "pairs")) == 6 &&
         json_array_size(json_object_get(check, "designs")) == 2,
     "the race's result is checked on six other pairs beside the unmodified pair");
  json_decref(document);
  eo_study_result_done(&result);
  free(again);
  free(text[0]);
  free(text[1]);
}

/* A seventh of all points fails: outcomes, kept and never the optimum. The history is filled before the search with
   rows as a model would have left them that did not converge. */
static void test_failures(void)
{
  struct eo_study_plan plan = plan_of(&design, NULL);
  empty_folder();
  coarse_design(&design, "ga", 40);
  complete(&design);
  free(run(&plan, &result));
  int64_t best = result.best.evaluation;
  double value = result.best.rank;
  eo_study_result_done(&result);
  json_t *rows = NULL;
  struct eo_store *store = NULL, *second = NULL;
  char first[200];
  bool good = !eo_store_open(&store, folder, EO_STORE_WRITE, &error) && !eo_records_rows(store, 1, &rows, &error);
  snprintf(first, sizeof first, "%s", folder);
  /* the same rows into a second folder, the best one as failed */
  good = good && make_folder() && !eo_store_open(&second, folder, EO_STORE_WRITE, &error);
  eo_store_close(second);
  eo_store_close(store);
  struct eo_text text = {0};
  ok(good && !eo_records_rows_csv(rows, &text, &error) && strstr(text.data, "pinion/left/tip_relief_um") != NULL,
     "the rows are written as comma-separated values");
  eo_text_done(&text);
  struct eo_text spec = {0};
  char hash[EO_HASH_LENGTH + 1];
  int64_t problem;
  good = good && !eo_design_problem(&design, &spec, hash, &error) &&
         !eo_store_open(&second, folder, EO_STORE_WRITE, &error) && !eo_store_begin(second, &error);
  const struct eo_stored_problem p = {
      .hash = hash, .spec = spec.data, .name = "", .evaluator = EO_EVALUATOR_VERSION, .scenarios = 1, .cases = 3};
  good = good && !eo_store_find_problem(second, &p, &problem, &error);
  for (size_t i = 0; good && i < json_array_size(json_object_get(rows, "rows")); i++) {
    const json_t *row = json_array_get(json_object_get(rows, "rows"), i);
    if (json_integer_value(json_object_get(row, "id")) != best)
      continue;
    struct eo_objective_case raw[3] = {
        {.failed = true}, {.peak_to_peak = 1e-9, .impact = 1, .rms = 1}, {.failed = true}};
    struct eo_text modification = {0};
    eo_json_write(&modification, json_object_get(row, "modification"), EO_JSON_CANONICAL);
    struct eo_stored_evaluation e = {.modification = modification.data,
                                     .outcome = EO_EVALUATION_NOT_CONVERGED,
                                     .reason = "Made up.",
                                     .scenarios = 1,
                                     .cases = 3,
                                     .raw = raw};
    good = !eo_store_add_evaluation(second, problem, &e, &error);
    eo_text_done(&modification);
  }
  good = good && !eo_store_commit(second, &error);
  eo_store_close(second);
  plan.fresh = true;
  free(run(&plan, &result));
  ok(good && result.failed == 1 && result.reused == 1, "a failed row is found again and not evaluated once more");
  ok(result.best.there && result.best.rank > value && result.best.evaluation != 1,
     "a failed row is never the optimum: %.4g instead of %.4g", result.best.rank, value);
  eo_study_result_done(&result);
  empty_folder();
  rmdir(folder);
  snprintf(folder, sizeof folder, "%s", first);
  eo_text_done(&spec);
  json_decref(rows);
}

static void test_constraints(void)
{
  struct eo_study_plan plan = plan_of(&design, NULL);
  empty_folder();
  coarse_design(&design, "credibility-ga", 60);
  complete(&design);
  free(run(&plan, &result));
  double pressure = 0;
  for (int k = 0; k < 3; k++)
    pressure = fmax(pressure, result.best.raw[k].contact_pressure);
  eo_study_result_done(&result);
  design.objective.contact_pressure = 0.97 * pressure;
  complete(&design);
  free(run(&plan, &result));
  double held = 0;
  for (int k = 0; k < 3; k++)
    held = fmax(held, result.best.raw[k].contact_pressure);
  /* The objective is no measure: twice the evaluations may well find a better flank under the constraint. */
  ok(result.imported >= 60 && result.best.value.violation == 0 && held <= 0.97 * pressure,
     "a constraint is weighed anew over %d known rows and held: %.4g of %.4g MPa", result.imported, held / 1e6,
     0.97 * pressure / 1e6);
  eo_study_result_done(&result);
}

static enum eo_code with_list(int count, const struct eo_listed_variable *list)
{
  coarse_design(&design, "ga", 20);
  design.optimization.variables = EO_VARIABLES_LISTED;
  design.optimization.listed = count;
  memcpy(design.optimization.list, list, sizeof *list * (size_t)count);
  memset(&error, 0, sizeof error);
  return complete(&design) ? EO_OK : error.code;
}

static int parameter(const char *key)
{
  int i = 0;
  while (eo_variable_parameters[i] && strcmp(eo_variable_parameters[i], key) != 0)
    i++;
  return i;
}

static void refuse(const char *what, const char *pointer, int count, const struct eo_listed_variable *list)
{
  enum eo_code code = with_list(count, list);
  ok(code == EO_ERROR_INPUT && strcmp(error.pointer, pointer) == 0, "the search refuses %s: %s: %s", what,
     error.pointer, error.text);
}

static struct eo_listed_variable knots_of(int row, int column, double low, double high)
{
  return (struct eo_listed_variable){.member = EO_PINION,
                                     .end = EO_BOTH_ENDS,
                                     .parameter = parameter("grid_um"),
                                     .bounds = {low, high},
                                     .row = row,
                                     .column = column,
                                     .of_grid = true};
}

/* A flat grid of 3 x 4 on both ends of the pinion; row 2 is 1 um. */
static bool with_knots(int count, const struct eo_listed_variable *list)
{
  static const double u[3] = {-5e-3, 0, 5e-3}, y[4] = {-27e-3, -9e-3, 9e-3, 27e-3},
                      delta[12] = {0, 0, 0, 0, 1e-6, 1e-6, 1e-6, 1e-6};
  const struct eo_flank_grid grid = {.u_knots = 3, .y_knots = 4, .u = u, .y = y, .delta = delta};
  coarse_design(&design, "ga", 40);
  design.optimization.variables = EO_VARIABLES_LISTED;
  design.optimization.listed = count;
  memcpy(design.optimization.list, list, sizeof *list * (size_t)count);
  for (int end = 0; end < 2; end++)
    eo_flank_grids_put(&design.grids, EO_DRIVE_FLANK, EO_PINION, end, &grid, &error);
  memset(&error, 0, sizeof error);
  return complete(&design);
}

/* J of a document as whoever opens it has it. */
static double opened_value(const json_t *document)
{
  static struct eo_design opened;
  static struct eo_faults found;
  struct eo_geometry geometry;
  struct eo_analysis *analysis = NULL;
  double value = NAN;
  memset(&found, 0, sizeof found);
  if (eo_design_decode(document, &opened, NULL, &found) && !eo_design_complete(&opened, &geometry, &error) &&
      !eo_analysis_new(&analysis, pair, &error) && !eo_analysis_run(analysis, &opened, 0, &error))
    value = analysis->value.objective;
  eo_analysis_free(analysis);
  return value;
}

/* What a search over grid numbers found, without the search. */
/* A helix slope of one end makes something worse at one of the load cases, which weighs more than what it improves. */
static void test_unmodified_best(void)
{
  struct eo_listed_variable slope = {EO_PINION, EO_LEFT, parameter("helix_slope_um"), {-40, 40}, 0, 0, 0, false};
  struct eo_study_plan plan = plan_of(&design, NULL);
  const double least[2] = {-40, 5};
  for (int within = 1; within >= 0; within--) {
    empty_folder();
    slope.bounds.low = least[!within];
    with_list(1, &slope);
    design.objective.no_worse_than_unmodified = true;
    design.objective.penalty = 1e6;
    char *text = run(&plan, &result);
    bool same = result.best.there && result.best.evaluation == result.unmodified.evaluation,
         says = text && strstr(text, "No flank of the search is fitter than the unmodified pair");
    ok(text && same == within && says == within && (result.best.rank > result.unmodified.rank) != within,
       "J and penalties of the best are %.3g, the unmodified pair %s", result.best.rank,
       within ? "lies within the bounds" : "does not");
    ok(text && (strstr(text, "Constraints are violated by") != NULL) != within, "the warnings say what is violated");
    eo_study_result_done(&result);
    free(text);
  }
}

static void test_opened(json_t *document)
{
  json_object_del(document, "optimization");
  near(opened_value(document), result.best.value.objective, 1e-12,
       "J of the best design opened again, over that of the search");
  for (int end = 0; end < 2; end++) {
    static const char *const name[2] = {"left", "right"};
    json_t *flank = json_object_get(eo_json_find(document, "modification/pinion"), name[end]);
    json_object_set_new(json_object_get(flank, "grid"), "kind", json_string("measured"));
  }
  near(opened_value(document), 1, 1e-12, "J of a pair that is measured so");
}

static void test_grid_search(void)
{
  const struct eo_listed_variable list[3] = {knots_of(1, 0, 0, 30), knots_of(3, 0, 0, 30), knots_of(2, 4, -5, 10)};
  ok(with_knots(3, list), "rows and a knot of a grid are variables %s", error.text);
  struct eo_study_plan plan = plan_of(&design, NULL);
  empty_folder();
  free(run(&plan, &result));
  char name[80];
  eo_study_variable_name(&result.space.variable[2], name, sizeof name);
  ok(strcmp(name, "pinion/both/grid_um[u2 y4]") == 0, "a variable of a grid has its name: %s", name);
  double start[3], x[3];
  ok(eo_study_space_locate(&result.space, &design.modification, &design.modification, start) && start[0] == 0 &&
         fabs(start[2] - 6. / 15) < 1e-12,
     "the grid itself is the start of a search over it");
  ok(result.best.there && result.best.value.objective < 0.9 * result.unmodified.value.objective,
     "a search over the grid improves the pair: J %.3g of %.3g", result.best.value.objective,
     result.unmodified.value.objective);
  static struct eo_design best, opened;
  static struct eo_faults found;
  struct eo_geometry geometry;
  best = design;
  best.modification = result.best.modification;
  json_t *document = eo_design_encode(&best);
  const json_t *grid = eo_json_find(document, "modification/pinion/right/grid/delta_um"),
               *row = json_array_get(grid, 0);
  double of_row = eo_study_variable_value(&result.space.variable[0], &best.modification);
  ok(json_number_value(json_array_get(row, 0)) == of_row && json_number_value(json_array_get(row, 3)) == of_row &&
         json_number_value(json_array_get(json_array_get(grid, 1), 0)) == 1,
     "the best is a design with that grid: row 1 at %.4g um", of_row);
  ok(eo_design_decode(document, &opened, NULL, &found) && !eo_design_complete(&opened, &geometry, &error) &&
         eo_json_find(document, "modification/pinion/right/grid_nodes") == NULL,
     "the best design over a grid opens as one");
  ok(eo_study_space_locate(&result.space, &design.modification, &best.modification, x),
     "a row of the best design is in the space");
  struct eo_text text = {0};
  static struct eo_modification read;
  ok(!eo_modification_write(&best.modification, 2, &text, &error) && !eo_modification_read(text.data, &read, &error) &&
         eo_modification_equal(&read.flank[EO_PINION][EO_LEFT], &best.modification.flank[EO_PINION][EO_LEFT]),
     "a modification over a grid is written as text and read again: %.120s", text.data ? text.data : "");
  eo_text_done(&text);
  test_opened(document);
  json_decref(document);
  eo_study_result_done(&result);
}

/* A search may change what is designed, and what nobody called anything. */
static void test_grid_kinds(void)
{
  const struct eo_listed_variable row = knots_of(1, 0, 0, 30);
  struct eo_study_space space;
  ok(with_knots(1, &row) && design.grids.place[EO_DRIVE_FLANK][EO_PINION][0].kind == EO_GRID_DESIGNED,
     "a grid whose numbers vary is designed");
  for (int kind = EO_GRID_MEASURED; kind <= EO_GRID_DESIGNED; kind++) {
    struct eo_design stated = design;
    for (int end = 0; end < 2; end++) {
      struct eo_grid_place *place = &stated.grids.place[EO_DRIVE_FLANK][EO_PINION][end];
      place->kind = (enum eo_grid_kind)kind;
      place->kind_stated = true;
    }
    memset(&error, 0, sizeof error);
    bool good = complete(&stated) && !eo_study_space_init(&space, &stated, &pair->geometry, &error);
    ok(good == (kind == EO_GRID_DESIGNED) &&
           (good || strcmp(error.pointer, "/optimization/variable_list/0/parameter") == 0),
       "%s: the grid is judged by that: %s", kind ? "stated as designed" : "stated as measured, it does not vary",
       error.text);
  }
}

static void refuse_knots(const char *what, const char *pointer, int count, const struct eo_listed_variable *list)
{
  ok(!with_knots(count, list) && strcmp(error.pointer, pointer) == 0, "the search refuses %s: %s: %s", what,
     error.pointer, error.text);
}

static void test_grid_refusals(void)
{
  const struct eo_listed_variable crossing[2] = {knots_of(1, 0, 0, 30), knots_of(0, 2, 0, 30)},
                                  row = knots_of(4, 0, 0, 30), column = knots_of(0, 5, 0, 30),
                                  unbounded = knots_of(1, 1, NAN, NAN);
  struct eo_listed_variable twisted = {.member = EO_PINION,
                                       .end = EO_BOTH_ENDS,
                                       .parameter = parameter("twist_um"),
                                       .bounds = {0, 5},
                                       .row = 1},
                            bare = knots_of(1, 0, 0, 30);
  bare.member = EO_GEAR;
  refuse_knots("a knot in two variables", "/optimization/variable_list/1", 2, crossing);
  refuse_knots("a row that is not there", "/optimization/variable_list/0/row", 1, &row);
  refuse_knots("a column that is not there", "/optimization/variable_list/0/column", 1, &column);
  refuse_knots("no bounds", "/optimization/variable_list/0/bounds", 1, &unbounded);
  refuse_knots("a row of what is no grid", "/optimization/variable_list/0/row", 1, &twisted);
  refuse_knots("a flank without a grid", "/optimization/variable_list/0/parameter", 1, &bare);
}

static void test_variables(void)
{
  const int tip = parameter("tip_relief_um"), slope = parameter("helix_slope_um"),
            start = parameter("tip_relief_start_mm");
  const int end = parameter("leading_end_relief_um"), length = parameter("leading_end_relief_length_mm");
  const struct eo_range open = {NAN, NAN};
  struct eo_listed_variable three[] = {{EO_PINION, EO_BOTH_ENDS, tip, open, 0, 0, 0, false},
                                       {EO_GEAR, EO_LEFT, slope, {-5, 10}, 0, 0, 0, false},
                                       {EO_GEAR, EO_RIGHT, slope, {-10, 5}, 0, 0, 0, false}};
  ok(with_list(3, three) == EO_OK, "a list of tip relief of the pinion and lead slope of each gear end is taken %s",
     error.text);
  design.modification.flank[EO_PINION][EO_LEFT].tip_relief_start =
      design.modification.flank[EO_PINION][EO_RIGHT].tip_relief_start = 1e-3;
  struct eo_study_plan plan = plan_of(&design, NULL);
  empty_folder();
  free(run(&plan, &result));
  const struct eo_flank_modification *gear = result.best.modification.flank[EO_GEAR],
                                     *pinion = result.best.modification.flank[EO_PINION];
  ok(result.space.count == 3 && pinion[0].tip_relief == pinion[1].tip_relief && pinion[0].tip_relief_start == 1e-3 &&
         gear[0].helix_slope != gear[1].helix_slope && gear[0].helix_slope >= -5e-6 && gear[1].helix_slope <= 5e-6,
     "a search over a list varies its variables, and the rest stays");
  struct eo_modification applied;
  double x[3] = {0.123456789, 1, 0}, back[3];
  eo_study_space_apply(&result.space, &design.modification, x, &applied);
  ok(eo_study_space_locate(&result.space, &design.modification, &applied, back) && fabs(back[0] - x[0]) < 1e-15 &&
         back[1] == 1 && back[2] == 0,
     "a point of a listed space is found again");
  ok(applied.flank[EO_GEAR][0].helix_slope == 10e-6 && applied.flank[EO_GEAR][1].helix_slope == -10e-6,
     "the bounds of a listed space are reached exactly");
  applied.flank[EO_PINION][0].root_relief = 1e-6;
  ok(!eo_study_space_locate(&result.space, &design.modification, &applied, back),
     "a modification with another rest is not in the space");
  struct eo_text text = {0};
  ok(!eo_modification_write(&applied, 2, &text, &error) &&
         !eo_modification_read(text.data, &design.modification, &error) &&
         memcmp(&design.modification.flank[1], &applied.flank[1], sizeof applied.flank[1]) == 0,
     "a modification is written as text and read again: %s", text.data ? text.data : "");
  eo_text_done(&text);
  eo_study_result_done(&result);

  struct eo_listed_variable twice[] = {{EO_PINION, EO_BOTH_ENDS, tip, open, 0, 0, 0, false},
                                       {EO_PINION, EO_RIGHT, tip, {0, 10}, 0, 0, 0, false}};
  refuse("the same parameter twice", "/optimization/variable_list/1", 2, twice);
  struct eo_listed_variable unbounded = {EO_PINION, EO_BOTH_ENDS, slope, open, 0, 0, 0, false};
  refuse("no bounds", "/optimization/variable_list/0/bounds", 1, &unbounded);
  struct eo_listed_variable fixed = {EO_PINION, EO_BOTH_ENDS, slope, {5, 5}, 0, 0, 0, false};
  refuse("a fixed variable", "/optimization/variable_list/0/bounds", 1, &fixed);
  struct eo_listed_variable negative = {EO_PINION, EO_BOTH_ENDS, tip, {-1, 5}, 0, 0, 0, false};
  refuse("bounds outside the parameter's range", "/optimization/variable_list/0/bounds", 1, &negative);
  struct eo_listed_variable late[] = {{EO_PINION, EO_BOTH_ENDS, tip, open, 0, 0, 0, false},
                                      {EO_PINION, EO_BOTH_ENDS, start, {1, 5.5}, 0, 0, 0, false}};
  refuse("a relief that may start outside the active flank", "/optimization/variable_list", 2, late);
  struct eo_listed_variable gain = {EO_PINION, EO_BOTH_ENDS, parameter("grid_gain"), {-1, 1}, 0, 0, 0, false};
  refuse("the gain of a grid that is not there", "/optimization/variable_list/0/parameter", 1, &gain);
  static const double knots[2] = {-2e-3, 2e-3}, delta[4] = {1e-6, 2e-6, 0, 1e-6};
  const struct eo_flank_grid grid = {.u_knots = 2, .y_knots = 2, .u = knots, .y = knots, .delta = delta};
  struct eo_design with_grid = design;
  struct eo_study_space gains;
  with_grid.optimization.variables = EO_VARIABLES_LISTED;
  with_grid.optimization.listed = 1;
  with_grid.optimization.list[0] = gain;
  for (int k = 0; k < 2; k++)
    eo_flank_grids_put(&with_grid.grids, EO_DRIVE_FLANK, EO_PINION, k, &grid, &error);
  double scale = 0.75;
  struct eo_modification gained;
  ok(complete(&with_grid) && !eo_study_space_init(&gains, &with_grid, &pair->geometry, &error),
     "the gain of a grid that is there is taken %s", error.text);
  eo_study_space_apply(&gains, &with_grid.modification, &scale, &gained);
  ok(gained.flank[EO_PINION][0].grid_gain == 0.5 && gained.flank[EO_PINION][1].grid_gain == 0.5,
     "a search over a gain lays on more or less of the grid");
  struct eo_listed_variable endless = {EO_PINION, EO_LEFT, end, {0, 10}, 0, 0, 0, false};
  refuse("an end relief without a length", "/optimization/variable_list", 1, &endless);
  struct eo_listed_variable zero[] = {{EO_PINION, EO_LEFT, end, {0, 10}, 0, 0, 0, false},
                                      {EO_PINION, EO_LEFT, length, {0, 10}, 0, 0, 0, false}};
  refuse("an end relief whose length may vanish", "/optimization/variable_list", 2, zero);
  struct eo_listed_variable good[] = {{EO_PINION, EO_LEFT, end, {0, 10}, 0, 0, 0, false},
                                      {EO_PINION, EO_LEFT, length, {1, 10}, 0, 0, 0, false}};
  ok(with_list(2, good) == EO_OK, "an end relief with a length is taken");
  refuse("no variable", "/optimization/variable_list", 0, good);
  with_list(1, good);
  design.optimization.variables = EO_VARIABLES_SHARED;
  ok(!complete(&design) && strcmp(error.pointer, "/optimization/variable_list") == 0,
     "a list beside a preset is refused: %s", error.text);
  struct eo_listed_variable right = {EO_PINION, EO_RIGHT, tip, open, 0, 0, 0, false};
  coarse_design(&design, "ga", 20);
  design.gear_pair.ends = 1;
  design.gear_pair.groove_width = NAN;
  design.optimization.variables = EO_VARIABLES_LISTED;
  design.optimization.list[0] = right;
  design.optimization.listed = 1;
  ok(!complete(&design) && strcmp(error.pointer, "/optimization/variable_list/0/end") == 0,
     "the right end of a pair that has one is refused: %s", error.text);
}

int main(void)
{
  if (!make_folder() || !(pair = coarse_pair()))
    return 99;
  for (int i = 0; i < EO_ALGORITHMS; i++)
    test_threads(eo_optimizer_algorithm_name(i));
  test_cancel();
  test_removed_job("ga");
  test_removed_job("credibility-ga");
  test_reuse();
  test_truth();
  test_front();
  test_robust_front();
  test_race();
  test_failures();
  test_constraints();
  test_unmodified_best();
  test_grid_search();
  test_grid_kinds();
  test_grid_refusals();
  test_variables();
  empty_folder();
  rmdir(folder);
  eo_pair_free(pair);
  return tap_done();
}
