/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper once more, on a coarse mesh and for three generations: the printed numbers, every figure with its data,
   files and page. */
#include <math.h>

#include "format/plot.h"
#include "reproduction/reproduction_job.h"
#include "store/queue.h"
#include "support/study-fixture.h"
#include "support/tap.h"

static struct eo_design design;
static struct eo_reproduction_order order = {.quick = true, .generations = 3, .true_evaluations = 40, .pairs = 5};

static json_t *run(int threads)
{
  struct eo_reproduction_plan plan = {.threads = threads, .order = order};
  json_t *document = NULL;
  if (eo_store_open(&plan.store, folder, EO_STORE_WRITE, &error) || eo_reproduction_run(&plan, &document, &error))
    printf("# %s\n", error.text);
  eo_store_close(plan.store);
  return document;
}

static enum eo_code take_result(void *context, const struct eo_stored_job *job, struct eo_error *fault)
{
  (void)fault;
  ok(job->state == EO_JOB_DONE, "the reproduction's job is done");
  eo_text_add(context, job->result);
  return EO_OK;
}

static void check_files(const struct eo_text *result)
{
  struct eo_file_set files = {0};
  bool good = !eo_reproduction_job_files(result, &files, &error) && files.count > 8;
  ok(good && strcmp(files.file[files.count - 1].name, "reproduction.html") == 0 &&
         strstr(files.file[files.count - 1].text.data, "</html>"),
     "the job's files are its tables and a page");
  eo_file_set_done(&files);
  const struct eo_text other = {.data = "[]", .size = 2};
  struct eo_file_set none = {0};
  ok(eo_reproduction_job_files(&other, &none, &error) == EO_ERROR_INPUT, "a document of another kind has no files");
  eo_file_set_done(&none);
}

/* What the server does with an order. */
static json_t *run_job(int threads)
{
  struct eo_store *store = NULL;
  struct eo_text spec = {0}, text = {0}, result = {0};
  struct eo_reproduction_job job = {.threads = threads};
  enum eo_job_outcome outcome = EO_JOB_OUTCOME_MISSING;
  json_t *document = NULL;
  eo_design_write(&design, &text);
  eo_reproduction_order_write(&order, &spec);
  const struct eo_queue_entry entry = {
      .kind = EO_JOB_REPRODUCE, .design = text.data, .spec = spec.data, .name = "", .algorithm = ""};
  enum eo_code code = eo_store_open(&store, folder, EO_STORE_WRITE, &error);
  job.store = store;
  if (!code)
    code = eo_queue_add(store, &entry, 9, &job.job, &outcome, &error);
  if (!code)
    code = eo_reproduction_job_run(&job, &error);
  if (!code)
    code = eo_queue_find(store, job.job, take_result, &result, &outcome, &error);
  if (!ok(!code, "a reproduction is put into the queue"))
    printf("# %s\n", error.text);
  else {
    check_files(&result);
    document = eo_json_parse(result.data, result.size, &error);
  }
  eo_store_close(store);
  eo_text_done(&spec);
  eo_text_done(&text);
  eo_text_done(&result);
  return document;
}

static bool equal_as_text(const json_t *one, const json_t *other)
{
  struct eo_text text[2] = {{0}, {0}};
  eo_json_write(&text[0], one, EO_JSON_COMPACT);
  eo_json_write(&text[1], other, EO_JSON_COMPACT);
  bool equal = !text[0].failed && text[0].size == text[1].size && memcmp(text[0].data, text[1].data, text[0].size) == 0;
  eo_text_done(&text[0]);
  eo_text_done(&text[1]);
  return equal;
}

static const json_t *find_row(const json_t *document, const char *list, const char *key, const char *value)
{
  const json_t *row;
  size_t i;
  json_array_foreach(json_object_get(document, list), i,
                     row) if (strcmp(json_string_value(json_object_get(row, key)), value) == 0) return row;
  return NULL;
}

/* Section 5.4 prints 18.98, 27.22, 12.08 and 14.16, 25.15, 13.10 %. */
static void test_printed(const json_t *document)
{
  static const struct {
    const char *quantity;
    double paper, tolerance;
  } row[] = {{"reduction of RMS, Table 3, case A, 621 N m", 18.98, 0.006},
             {"reduction of RMS, Table 3, case A, 828 N m", 27.22, 0.006},
             {"reduction of RMS, Table 3, case A, 1035 N m", 12.08, 0.006},
             {"reduction of RMS, Table 3, case B, 621 N m", 14.16, 0.006},
             {"reduction of RMS, Table 3, case B, 828 N m", 25.15, 0.006},
             {"reduction of RMS, Table 3, case B, 1035 N m", 13.10, 0.006},
             {"PFC of fpga, case A", 39.67, 0},
             {"PFC of fpga, case B", 33.25, 0}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    close_to(eo_json_find_number(find_row(document, "comparisons", "quantity", row[i].quantity), "paper"), row[i].paper,
             row[i].tolerance, row[i].quantity);
}

/* A verdict follows from the numbers beside it. */
static void test_verdicts(const json_t *document)
{
  const json_t *row;
  size_t i;
  int wrong = 0, judged = 0;
  json_array_foreach(json_object_get(document, "comparisons"), i, row)
  {
    double paper = eo_json_find_number(row, "paper"), ours = eo_json_find_number(row, "ours");
    const json_t *value = json_object_get(row, "value_agrees");
    bool percent = strcmp(json_string_value(json_object_get(row, "unit")), "%") == 0;
    if (isnan(paper) || isnan(ours)) {
      wrong += !json_is_null(value);
      continue;
    }
    judged++;
    wrong += json_is_true(value) != (percent ? fabs(ours - paper) <= 10 : fabs(ours / paper - 1) < 0.1);
  }
  ok(judged >= 20 && !wrong, "%d numbers are judged by what stands beside them", judged);
}

static void test_figures(const json_t *document)
{
  static const char *const numbers[] = {"8", "9", "10", "11", "12", "13", "14", "15", "17", "18"};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
    const json_t *figure = find_row(document, "figures", "number", numbers[i]), *series;
    size_t j;
    int bad = 0, points = 0;
    json_array_foreach(json_object_get(figure, "series"), j, series)
    {
      const json_t *x = json_object_get(series, "x"), *y = json_object_get(series, "y");
      bad += json_array_size(x) == 0 || json_array_size(x) != json_array_size(y);
      for (size_t k = 0; k < json_array_size(y); k++)
        points += json_is_number(json_array_get(y, k));
    }
    ok(figure && !bad && points > 5, "figure %s has %d points", numbers[i], points);
  }
  const json_t *figure = find_row(document, "figures", "number", "17");
  const json_t *x = json_object_get(json_array_get(json_object_get(figure, "series"), 0), "x");
  bool there = false;
  for (size_t k = 0; k < json_array_size(x); k++)
    there = there || json_number_value(json_array_get(x, k)) == 414;
  ok(there, "414 N m is among the torques of figure 17");
}

/* The same numbers reached in two ways: the analyses and the sweep. */
static void test_agreement(const json_t *document)
{
  const json_t *results = json_object_get(document, "results"), *figure = find_row(document, "figures", "number", "8");
  const json_t *series = json_array_get(json_object_get(figure, "series"), 1), *x = json_object_get(series, "x");
  double at_828 = NAN;
  for (size_t k = 0; k < json_array_size(x); k++)
    if (json_number_value(json_array_get(x, k)) == 828)
      at_828 = json_number_value(json_array_get(json_object_get(series, "y"), k));
  near(at_828,
       eo_json_find_number(json_array_get(json_object_get(json_array_get(results, 1), "load_cases"), 1),
                           "peak_to_peak_um"),
       1e-6, "case A at 828 N m in figure 8 over that in the table, um");
  const json_t *base = json_array_get(json_object_get(document, "sensitivity"), 0);
  near(
      json_number_value(json_array_get(json_object_get(base, "rms_case_a_m_per_s2"), 2)),
      eo_json_find_number(json_array_get(json_object_get(json_array_get(results, 1), "load_cases"), 2), "rms_m_per_s2"),
      1e-10, "first row of the assumptions over that of the table, m/s2");
}

static void test_output(const json_t *document)
{
  struct eo_text page = {0}, summary = {0};
  struct eo_file_set bundle = {0};
  eo_reproduction_page(document, &page);
  eo_reproduction_summary(document, &summary);
  eo_reproduction_files(document, &bundle);
  ok(!page.failed && strstr(page.data, "</html>") && !strstr(page.data, "http://") == !strstr(page.data, "xmlns") &&
         !strstr(page.data, "src="),
     "the page needs nothing from elsewhere");
  int svg = 0;
  for (const char *c = page.data; (c = strstr(c, "<svg")); c++)
    svg++;
  ok(svg == (int)json_array_size(json_object_get(document, "figures")), "the page has %d plots", svg);
  ok(!strstr(page.data, "nan") && !strstr(page.data, "inf\""), "the page lacks none of its numbers");
  ok(!bundle.failed && bundle.count == 7 + svg, "the reproduction has %d files of comma-separated values",
     bundle.count);
  ok(!summary.failed && strstr(summary.data, "trends and"), "the reproduction has a summary");
  eo_text_done(&page);
  eo_text_done(&summary);
  eo_file_set_done(&bundle);
}

/* The designs on the same pairs as made. */
static void test_made(const json_t *document)
{
  const json_t *made = json_object_get(document, "as_made"), *designs = json_object_get(made, "designs");
  ok(json_integer_value(json_object_get(made, "pairs")) == 5 && json_array_size(designs) == 5,
     "four designs stand beside the unmodified pair on five pairs as made");
  const json_t *bare = json_array_get(json_object_get(json_array_get(designs, 0), "numbers"), 0);
  near(eo_json_find_number(bare, "mean"), 1, 1e-12, "J of the unmodified pair in every pair as made");
  ok(eo_json_find_number(bare, "deviation") < 1e-12 &&
         eo_json_find_number(json_array_get(designs, 0), "worse_J/fraction") == 0,
     "the unmodified pair is never worse than itself");
}

static void test_plot(void)
{
  const double x[] = {0, 1, 2, 3}, y[] = {1e-9, NAN, 3e-9, 4e-9}, same[] = {5, 5, 5, 5}, none[] = {NAN, NAN, NAN, NAN};
  struct eo_plot plot = {
      .title = "a < b & \"c\"", .x_label = "x", .y_label = "y", .series = 1, .line = {{"one", 4, x, y, false}}};
  struct eo_text text = {0};
  eo_plot_svg(&plot, &text);
  ok(strstr(text.data, "a &lt; b &amp; &quot;c&quot;") && !strstr(text.data, "nan"),
     "a plot with a gap and marks in its title is drawn");
  int moves = 0;
  for (const char *c = strstr(text.data, "d=\""); c && *c && *c != '/'; c++)
    moves += *c == 'M';
  ok(moves == 2, "the line of a plot is interrupted where there is no point");
  eo_text_done(&text);
  plot.line[0].y = same;
  eo_plot_svg(&plot, &text);
  ok(!strstr(text.data, "nan") && !strstr(text.data, "inf"), "a plot of a constant has numbers alone");
  eo_text_done(&text);
  plot.line[0].y = none;
  eo_plot_svg(&plot, &text);
  ok(!strstr(text.data, "nan") && !strstr(text.data, "inf"), "a plot of nothing has numbers alone");
  eo_text_done(&text);
}

int main(void)
{
  if (!make_folder())
    return 99;
  coarse_design(&design, "ga", 1);
  order.resolution = design.resolution;
  json_t *document = run(1);
  if (!ok(document != NULL, "the reproduction runs"))
    return tap_done();
  test_printed(document);
  test_verdicts(document);
  test_figures(document);
  test_agreement(document);
  test_made(document);
  test_output(document);
  test_plot();
  json_t *again = run_job(2);
  json_object_del(document, "run");
  json_object_del(again, "run");
  ok(equal_as_text(document, again), "a queued job with another number of threads gives the same document");
  json_decref(document);
  json_decref(again);
  empty_folder();
  rmdir(folder);
  return tap_done();
}
