/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/tolerance_document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/result_private.h"
#include "document/scatter_distance.h"
#include "document/scatter_distribution.h"
#include "evaluation/scatter_levels.h"
#include "format/json.h"
#include "format/object.h"
#include "format/text_table.h"

#include <config.h>

struct input {
  const char *key;
  char words[120];
  double nominal, mean, deviation;
};

static const struct eo_outline_row input_rows[] = {
    EO_KEY("key", "text", "what scatters", EO_AT(struct input, key)),
    EO_KEY("distribution", "text", "of the deviation, in words", EO_AT(struct input, words)),
    EO_KEY("nominal", "number", "in the unit of the key, as all below", EO_AT(struct input, nominal)),
    EO_KEY("mean", "number", "of the distribution", EO_AT(struct input, mean)),
    EO_KEY("deviation", "number", "standard deviation, of what is drawn", EO_AT(struct input, deviation)),
};
static const struct eo_outline input_outline = EO_OUTLINE("ScatterInput", input_rows);

static const struct eo_outline_row percentile_rows[] = {
    EO_KEY("percent", "number", "of the pairs that stay below, 0 .. 100", EO_AT(struct eo_report_percentile, percent)),
    EO_KEY("value", "number?",
           "in the unit of the number, by linear interpolation of the sorted values (type 7); null: no pair has one",
           EO_AT(struct eo_report_percentile, value)),
    EO_KEY("low", "number?", "95 % interval by the ranks, whatever the distribution; null: open",
           EO_AT(struct eo_report_percentile, low)),
    EO_KEY("high", "number?", "the other end", EO_AT(struct eo_report_percentile, high)),
};
const struct eo_outline eo_outline_percentile = EO_OUTLINE("MadePercentile", percentile_rows);

struct histogram {
  double least, largest;
  json_t *count;
};

static const struct eo_outline_row histogram_rows[] = {
    EO_KEY("least", "number", "least value", EO_AT(struct histogram, least)),
    EO_KEY("largest", "number", "largest value", EO_AT(struct histogram, largest)),
    EO_KEY("count", "[integer]", "pairs in equal parts of that range", EO_AT(struct histogram, count)),
};
static const struct eo_outline histogram_outline = EO_OUTLINE("ScatterHistogram", histogram_rows);

struct influence {
  const char *key;
  struct eo_report_influence found;
};

static const struct eo_outline_row influence_rows[] = {
    EO_KEY("key", "text", "of the input", EO_AT(struct influence, key)),
    EO_KEY("coefficient", "number?",
           "standardised regression: change in deviations of the output per deviation of the input",
           EO_AT(struct influence, found.coefficient)),
    EO_KEY("first", "number?", "first Sobol index of the surface: share of the variance that the input has alone",
           EO_AT(struct influence, found.first)),
    EO_KEY("total", "number?", "total Sobol index: with what it has in common with others",
           EO_AT(struct influence, found.total)),
};
static const struct eo_outline influence_outline = EO_OUTLINE("ScatterInfluence", influence_rows);

struct output {
  const char *key;
  int load_case, rows, full, largest;
  double nominal, mean, deviation, coarse_error, r2, r2_adjusted, q2, residual;
  struct eo_series mean_interval, deviation_interval;
  struct histogram histogram;
  json_t *percentiles, *influences;
};

static const struct eo_outline_row output_rows[] = {
    EO_KEY("key", "text", "what is counted; the unit stands in it", EO_AT(struct output, key)),
    EO_KEY("load_case", "integer", "from 1", EO_AT(struct output, load_case)),
    EO_KEY("rows", "integer", "pairs that have this number", EO_AT(struct output, rows)),
    EO_KEY("full_rows", "integer", "of them computed in full; the others are completed from the coarse grid",
           EO_AT(struct output, full)),
    EO_KEY(
        "coarse_error", "number?",
        "root mean square error of what the coarse grid says of pairs that are in full, each left out, in the output's "
        "unit; null: every pair is in full",
        EO_AT(struct output, coarse_error)),
    EO_KEY("nominal", "number?", "of the design as drawn", EO_AT(struct output, nominal)),
    EO_KEY("mean", "number", "over the pairs", EO_AT(struct output, mean)),
    EO_KEY("mean_interval", "[number]", "95 %, bootstrap", EO_AT(struct output, mean_interval)),
    EO_KEY("std", "number", "standard deviation", EO_AT(struct output, deviation)),
    EO_KEY("std_interval", "[number]", "95 %, bootstrap", EO_AT(struct output, deviation_interval)),
    EO_KEY("percentiles", "[object]", "of the pairs", .outline = &eo_outline_percentile,
           EO_AT(struct output, percentiles)),
    EO_KEY("histogram", "object", "25 parts", .outline = &histogram_outline, EO_AT(struct output, histogram)),
    EO_KEY("R2", "number?", "share of the variance that the linear regression explains", EO_AT(struct output, r2)),
    EO_KEY("R2_adjusted", "number?", "the same for the number of inputs", EO_AT(struct output, r2_adjusted)),
    EO_KEY("Q2", "number?", "of the quadratic surface, with each pair left out of its own fit: 1 carries all",
           EO_AT(struct output, q2)),
    EO_KEY("surface_error", "number?", "root mean square error of the surface, the same way, in the output's unit",
           EO_AT(struct output, residual)),
    EO_KEY("influences", "[object]", "inputs, those that decide first", .outline = &influence_outline,
           EO_AT(struct output, influences)),
    EO_KEY("largest_pair", "integer", "number of the pair with the largest value, of those in full, from 1",
           EO_AT(struct output, largest)),
};
static const struct eo_outline output_outline = EO_OUTLINE("ScatterOutput", output_rows);

struct yield {
  const char *output;
  double load_case, most, fraction;
  int inside, pairs;
  json_t *exact, *wilson;
};

static const struct eo_outline_row yield_rows[] = {
    EO_KEY("output", "text?", "null: all limits together", EO_AT(struct yield, output)),
    EO_KEY("load_case", "integer?", "null: every one", EO_AT(struct yield, load_case)),
    EO_KEY("at_most", "number?", "the limit", EO_AT(struct yield, most)),
    EO_KEY("inside", "integer", "pairs that meet it; without a number a pair does not", EO_AT(struct yield, inside)),
    EO_KEY("pairs", "integer", "of so many", EO_AT(struct yield, pairs)),
    EO_KEY("fraction", "number", "the yield", EO_AT(struct yield, fraction)),
    EO_KEY("clopper_pearson", "[number]", "95 % interval that never covers less", EO_AT(struct yield, exact)),
    EO_KEY("wilson", "[number]", "95 % interval, shorter", EO_AT(struct yield, wilson)),
};
static const struct eo_outline yield_outline = EO_OUTLINE("ScatterYield", yield_rows);

struct correlation {
  int load_case;
  json_t *keys, *pearson, *spearman;
};

static const struct eo_outline_row correlation_rows[] = {
    EO_KEY("load_case", "integer", "that with the largest share", EO_AT(struct correlation, load_case)),
    EO_KEY("keys", "[text]", "outputs", EO_AT(struct correlation, keys)),
    EO_KEY("pearson", "[[number?]]", "a row for each of them", EO_AT(struct correlation, pearson)),
    EO_KEY("spearman", "[[number?]]", "of ranks", EO_AT(struct correlation, spearman)),
};
static const struct eo_outline correlation_outline = EO_OUTLINE("ScatterCorrelation", correlation_rows);

struct worst {
  int pair;
  const char *output;
  struct eo_series inputs;
  json_t *design;
};

static const struct eo_outline_row worst_rows[] = {
    EO_KEY("pair", "integer", "from 1", EO_AT(struct worst, pair)),
    EO_KEY("output", "text", "the number by which it is the worst", EO_AT(struct worst, output)),
    EO_KEY("inputs", "[number]", "in the order of inputs, in the units of their keys", EO_AT(struct worst, inputs)),
    EO_KEY("design", "object", "this pair as a design", .table = &eo_design_table, .name = "ResolvedDesign",
           EO_AT(struct worst, design)),
};
static const struct eo_outline worst_outline = EO_OUTLINE("ScatterWorst", worst_rows);

struct tolerance {
  const char *program;
  char hash[EO_HASH_LENGTH + 1];
  int pairs, full, failed, bounded;
  json_t *design, *inputs, *outputs, *yields, *correlation, *worst, *warnings;
};

static const struct eo_outline_row tolerance_rows[] = {
    EO_KEY("program", "text", "name and version", EO_AT(struct tolerance, program)),
    EO_KEY("design", "object", "with every default resolved", .table = &eo_design_table, .name = "ResolvedDesign",
           EO_AT(struct tolerance, design)),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design", EO_AT(struct tolerance, hash)),
    EO_KEY("pairs", "integer", "drawn; after a stop fewer than design/tolerance/pairs", EO_AT(struct tolerance, pairs)),
    EO_KEY("full_pairs", "integer",
           "of them computed in full; the others on a coarse grid and completed, with what that leaves open in every "
           "interval",
           EO_AT(struct tolerance, full)),
    EO_KEY("failed", "integer", "of them without a converged contact at the first load case",
           EO_AT(struct tolerance, failed)),
    EO_KEY("bounded", "integer", "drawn values that met a bound of their key and were put there",
           EO_AT(struct tolerance, bounded)),
    EO_KEY("inputs", "[object]", "what scatters", .outline = &input_outline, EO_AT(struct tolerance, inputs)),
    EO_KEY("outputs", "[object]", "numbers of every load case", .outline = &output_outline,
           EO_AT(struct tolerance, outputs)),
    EO_KEY("yields", "[object]", "against the limits; the last row: all of them", .outline = &yield_outline,
           EO_AT(struct tolerance, yields)),
    EO_KEY("correlation", "object", "between the numbers of one load case", .outline = &correlation_outline,
           EO_AT(struct tolerance, correlation)),
    EO_KEY("worst", "object", "the worst pair, of those in full", .outline = &worst_outline,
           EO_AT(struct tolerance, worst)),
    EO_KEY("warnings", "[text]", "in plain words", EO_AT(struct tolerance, warnings)),
};
const struct eo_outline eo_tolerance_outline = EO_OUTLINE("Tolerance", tolerance_rows);

static json_t *number(double value)
{
  return eo_json_quantity(value, NULL);
}

static json_t *two(double from, double to)
{
  const double both[2] = {from, to};
  return eo_json_reals(2, both, 1, NULL, EO_DIGITS_NUMBER);
}

static json_t *encode_inputs(const struct eo_tolerance_report *report)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < report->scatter->inputs; i++) {
    const struct eo_scatter_input *found = &report->scatter->input[i];
    struct eo_moments moments = eo_scatter_moments(report->scatter, i);
    struct input view = {
        .key = found->key, .nominal = found->nominal, .mean = moments.mean, .deviation = moments.deviation};
    eo_scatter_words(found, view.words, sizeof view.words);
    eo_list_add(&list, eo_outline_encode(&input_outline, &view));
  }
  return eo_object_close(&list);
}

static json_t *encode_percentiles(const struct eo_output_report *report)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < EO_REPORT_PERCENTS; i++)
    eo_list_add(&list, eo_outline_encode(&eo_outline_percentile, &report->percentile[i]));
  return eo_object_close(&list);
}

static struct histogram find_histogram(const struct eo_output_report *report)
{
  struct eo_object counts = eo_list_open();
  for (int i = 0; i < EO_REPORT_BINS; i++)
    eo_list_add(&counts, json_integer(report->count[i]));
  return (struct histogram){report->summary.least, report->summary.largest, eo_object_close(&counts)};
}

static json_t *encode_influences(const struct eo_tolerance_report *report, const struct eo_output_report *output_report)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < output_report->inputs; i++) {
    const struct eo_report_influence *found = &output_report->influence[i];
    const struct influence view = {report->scatter->input[found->input].key, *found};
    eo_list_add(&list, eo_outline_encode(&influence_outline, &view));
  }
  return eo_object_close(&list);
}

static json_t *encode_output(const struct eo_tolerance_report *report, const struct eo_tolerance_case *tolerance_case)
{
  const struct eo_output_report *found = &tolerance_case->report;
  const struct output view = {
      .key = tolerance_case->scalar->key,
      .load_case = tolerance_case->load_case + 1,
      .rows = found->rows,
      .full = found->full,
      .coarse_error = found->coarse_error,
      .nominal = tolerance_case->nominal,
      .mean = found->summary.mean,
      .mean_interval = eo_series_of(2, found->mean_interval, EO_DIGITS_NUMBER),
      .deviation = found->summary.deviation,
      .deviation_interval = eo_series_of(2, found->deviation_interval, EO_DIGITS_NUMBER),
      .percentiles = encode_percentiles(found),
      .histogram = find_histogram(found),
      .r2 = found->r2,
      .r2_adjusted = found->r2_adjusted,
      .q2 = found->q2,
      .residual = found->residual,
      .influences = encode_influences(report, found),
      .largest = found->largest + 1,
  };
  return eo_outline_encode(&output_outline, &view);
}

static json_t *encode_outputs(const struct eo_tolerance_report *report)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < report->outputs; i++)
    eo_list_add(&list, encode_output(report, &report->output[i]));
  return eo_object_close(&list);
}

static json_t *encode_yields(const struct eo_tolerance_report *report)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < report->yields; i++) {
    const struct eo_yield_row *found = &report->yield[i];
    const struct yield view = {.output = found->output,
                               .load_case = found->load_case ? (double)found->load_case : NAN,
                               .most = found->most,
                               .inside = found->inside,
                               .pairs = found->pairs,
                               .fraction = found->fraction,
                               .exact = two(found->exact.low, found->exact.high),
                               .wilson = two(found->wilson.low, found->wilson.high)};
    eo_list_add(&list, eo_outline_encode(&yield_outline, &view));
  }
  return eo_object_close(&list);
}

static int heaviest(const struct eo_design *design)
{
  int best = 0;
  for (int k = 1; k < design->load_cases; k++)
    best = design->load_case[k].share > design->load_case[best].share ? k : best;
  return best;
}

/* Columns of one load case that vary and that every pair has: values, then ranks. Returns how many. */
static int collect_columns(const struct eo_tolerance_report *report, int load_case, int *of, double *column)
{
  const struct eo_scatter_run *run = report->run;
  size_t n = (size_t)run->pairs;
  int count = 0;
  for (int i = 0; i < report->outputs; i++) {
    const struct eo_tolerance_case *tolerance_case = &report->output[i];
    if (tolerance_case->load_case != load_case || !tolerance_case->report.varies ||
        tolerance_case->report.rows < run->pairs)
      continue;
    int place = eo_scalar_find(tolerance_case->scalar->key) * run->cases + load_case;
    for (size_t row = 0; row < n; row++)
      column[(size_t)count * n + row] = run->output[row * (size_t)run->outputs + (size_t)place];
    of[count++] = i;
  }
  return count;
}

static json_t *encode_matrix(int count, int n, const double *column)
{
  struct eo_object rows = eo_list_open();
  for (int i = 0; i < count; i++) {
    struct eo_object row = eo_list_open();
    for (int j = 0; j < count; j++)
      eo_list_add(&row, number(eo_correlation(n, column + (size_t)i * (size_t)n, column + (size_t)j * (size_t)n)));
    eo_list_add(&rows, eo_object_close(&row));
  }
  return eo_object_close(&rows);
}

/* of[outputs + 1], column[2 (outputs + 1) pairs]: working space */
static json_t *correlate(const struct eo_tolerance_report *report, int *of, double *column)
{
  int load_case = heaviest(report->design), n = report->run->pairs,
      count = collect_columns(report, load_case, of, column);
  double *rank = column + (size_t)count * (size_t)n;
  struct eo_object keys = eo_list_open();
  for (int i = 0; i < count; i++) {
    eo_list_add(&keys, json_string(report->output[of[i]].scalar->key));
    keys.failed |= eo_ranks(n, column + (size_t)i * (size_t)n, rank + (size_t)i * (size_t)n, NULL) != EO_OK;
  }
  const struct correlation view = {load_case + 1, eo_object_close(&keys), encode_matrix(count, n, column),
                                   encode_matrix(count, n, rank)};
  return eo_outline_encode(&correlation_outline, &view);
}

static json_t *encode_correlation(const struct eo_tolerance_report *report)
{
  size_t most = (size_t)report->outputs + 1;
  double *column = malloc(sizeof *column * most * (size_t)report->run->pairs * 2);
  int *of = malloc(sizeof *of * most);
  json_t *encoded = column && of ? correlate(report, of, column) : NULL;
  free(column);
  free(of);
  return encoded;
}

static json_t *encode_worst(const struct eo_tolerance_report *report)
{
  const struct eo_scatter_run *run = report->run;
  const double *inputs = run->input + (size_t)report->worst * (size_t)run->inputs;
  const struct worst view = {report->worst + 1, report->worst_of, eo_series_of(run->inputs, inputs, EO_DIGITS_NUMBER),
                             eo_design_encode(&report->worst_design)};
  return eo_outline_encode(&worst_outline, &view);
}

static const char assumed_text[] =
    "Nothing is stated about the gears as made: class 5 of ISO 1328-1:2013 is taken, the tolerance as 2 sigma.";

enum { MOST_NOTES = 5 };

/* What is to be said of the run itself; returns how many notes. */
static int write_notes(const struct eo_tolerance_report *report, char note[MOST_NOTES][EO_COMPLETION_NOTE])
{
  int notes = eo_tolerance_stopped_note(report, note[0]);
  if (report->assumed)
    snprintf(note[notes++], sizeof *note, "%s", assumed_text);
  notes += eo_tolerance_completion_note(report, note[notes]);
  if (eo_scatter_distance_step(report->scatter) > 0)
    snprintf(note[notes++], sizeof *note,
             "The centre distance is drawn in steps of %.3g um, each prepared once; the numbers of a pair are those at "
             "the distance that is stated for it.",
             eo_scatter_distance_step(report->scatter));
  if (report->worst_compliance != 1)
    snprintf(note[notes++], sizeof *note,
             "The worst pair has the compliance_factor %.6g, which no design states: analysed as a design it has the "
             "nominal compliance, and other numbers than here.",
             report->worst_compliance);
  return notes;
}

static json_t *encode_warnings(const struct eo_tolerance_report *report, const struct eo_warnings *warnings)
{
  struct eo_object list = eo_list_open();
  char note[MOST_NOTES][EO_COMPLETION_NOTE];
  int notes = write_notes(report, note);
  for (int i = 0; i < notes; i++)
    eo_list_add(&list, json_string(note[i]));
  for (int i = 0; warnings && i < warnings->count; i++)
    eo_list_add(&list, json_string(warnings->text[i]));
  return eo_object_close(&list);
}

json_t *eo_tolerance_encode(const struct eo_tolerance_report *report, const struct eo_warnings *warnings)
{
  struct tolerance view = {.program = PACKAGE_STRING,
                           .pairs = report->run->pairs,
                           .full = eo_scatter_full_pairs(report->run),
                           .failed = report->failed,
                           .bounded = report->run->bounded};
  if (eo_design_hash(report->design, view.hash, NULL))
    return NULL;
  view.design = eo_design_encode(report->design);
  view.inputs = encode_inputs(report);
  view.outputs = encode_outputs(report);
  view.yields = encode_yields(report);
  view.correlation = encode_correlation(report);
  view.worst = encode_worst(report);
  view.warnings = encode_warnings(report, warnings);
  return eo_outline_encode(&eo_tolerance_outline, &view);
}

void eo_tolerance_write(const struct eo_tolerance_report *report, const struct eo_warnings *warnings,
                        struct eo_text *text)
{
  json_t *document = eo_tolerance_encode(report, warnings);
  if (document)
    eo_json_write(text, document, EO_JSON_COMPACT);
  text->failed = text->failed || !document;
  json_decref(document);
}

/* Few pairs leave an end open. */
static void put_interval(char *words, size_t size, double low, double high)
{
  char first[32] = "open", last[32] = "open";
  if (isfinite(low))
    snprintf(first, sizeof first, "%.4g", low);
  if (isfinite(high))
    snprintf(last, sizeof last, "%.4g", high);
  snprintf(words, size, "%s .. %s", first, last);
}

static void print_output(const struct eo_tolerance_report *report, const struct eo_tolerance_case *tolerance_case,
                         struct eo_text_table *sheet)
{
  static const int shown[] = {1, 4, 6, 7, 8}; /* 5, 50, 90, 95, 99 % */
  const struct eo_output_report *output_report = &tolerance_case->report;
  char words[200];
  (void)report;
  eo_text_table_string(sheet, tolerance_case->scalar->key);
  eo_text_table_number(sheet, tolerance_case->load_case + 1, NULL, 3);
  eo_text_table_number(sheet, tolerance_case->nominal, NULL, 4);
  eo_text_table_number(sheet, output_report->summary.mean, NULL, 4);
  eo_text_table_number(sheet, output_report->summary.deviation, NULL, 3);
  for (size_t i = 0; i < sizeof shown / sizeof *shown; i++)
    eo_text_table_number(sheet, output_report->percentile[shown[i]].value, NULL, 4);
  put_interval(words, sizeof words, output_report->percentile[7].low, output_report->percentile[7].high);
  eo_text_table_string(sheet, words);
  eo_text_table_number(sheet, output_report->r2, NULL, 2);
  eo_text_table_number(sheet, output_report->q2, NULL, 2);
  eo_text_table_string(sheet,
                       output_report->varies ? report->scatter->input[output_report->influence[0].input].key : "");
}

static void print_yields(const struct eo_tolerance_report *report, struct eo_text *text)
{
  if (report->yields)
    eo_text_print(text, "\nYield, with its 95 %% interval (Clopper and Pearson)\n");
  for (int i = 0; i < report->yields; i++) {
    const struct eo_yield_row *row = &report->yield[i];
    char what[160];
    if (*row->output)
      snprintf(what, sizeof what, "%.60s at most %.6g", row->output, row->most);
    else
      snprintf(what, sizeof what, "all limits");
    eo_text_print(text, "  %-48s %6.2f %%   %.2f .. %.2f %%   %d of %d\n", what, 100 * row->fraction,
                  100 * row->exact.low, 100 * row->exact.high, row->inside, row->pairs);
  }
}

static void print_inputs(const struct eo_tolerance_report *report, struct eo_text *text)
{
  eo_text_print(text, "%d pairs of %d inputs\n", report->run->pairs, report->scatter->inputs);
  for (int i = 0; i < report->scatter->inputs; i++) {
    char words[120];
    eo_scatter_words(&report->scatter->input[i], words, sizeof words);
    eo_text_print(text, "  %-56s %10.6g  %s\n", report->scatter->input[i].key, report->scatter->input[i].nominal,
                  words);
  }
}

void eo_tolerance_summary(const struct eo_tolerance_report *report, const struct eo_warnings *warnings,
                          struct eo_text *text)
{
  static const char *const heading[] = {"output", "case", "nominal", "mean",         "std", "5 %", "50 %",
                                        "90 %",   "95 %", "99 %",    "95 % lies in", "R2",  "Q2",  "decides most"};
  enum { COLUMNS = sizeof heading / sizeof *heading };
  struct eo_text_table sheet;
  char note[MOST_NOTES][EO_COMPLETION_NOTE];
  int notes = write_notes(report, note);
  print_inputs(report, text);
  eo_text_add(text, "\n");
  eo_text_table_init(&sheet, COLUMNS, heading);
  for (int i = 0; i < report->outputs; i++)
    print_output(report, &report->output[i], &sheet);
  eo_text_table_print(&sheet, 0, text);
  eo_text_table_done(&sheet);
  print_yields(report, text);
  eo_text_print(text, "\nWorst pair: number %d, by %s.\n", report->worst + 1, report->worst_of);
  if (report->failed)
    eo_text_print(text, "%d pairs have no converged contact; they count as bad.\n", report->failed);
  if (report->run->bounded)
    eo_text_print(text, "%d drawn values met a bound of their key and were put there.\n", report->run->bounded);
  for (int i = 0; i < notes; i++)
    eo_text_print(text, "note: %s\n", note[i]);
  for (int i = 0; warnings && i < warnings->count; i++)
    eo_text_print(text, "note: %s\n", warnings->text[i]);
}
