/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/tolerance_document.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/result_private.h"
#include "format/json.h"
#include "format/object.h"
#include "format/text_table.h"

#include <config.h>

static const struct eo_outline_row input_rows[] = {
    EO_KEY("key", "text", "what scatters"),
    EO_KEY("distribution", "text", "of the deviation, in words"),
    EO_KEY("nominal", "number", "in the unit of the key, as all below"),
    EO_KEY("mean", "number", "of the distribution"),
    EO_KEY("deviation", "number", "standard deviation, of what is drawn"),
};
static const struct eo_outline input_outline = EO_OUTLINE("ScatterInput", input_rows);

static const struct eo_outline_row percentile_rows[] = {
    EO_KEY("percent", "number", "0 .. 100"),
    EO_KEY("value", "number", "by linear interpolation of the sorted values (type 7)"),
    EO_KEY("low", "number?", "95 % interval by the ranks, whatever the distribution; null: open"),
    EO_KEY("high", "number?", "the other end"),
};
static const struct eo_outline percentile_outline = EO_OUTLINE("ScatterPercentile", percentile_rows);

static const struct eo_outline_row histogram_rows[] = {
    EO_KEY("least", "number", "least value"),
    EO_KEY("largest", "number", "largest value"),
    EO_KEY("count", "[integer]", "pairs in equal parts of that range"),
};
static const struct eo_outline histogram_outline = EO_OUTLINE("ScatterHistogram", histogram_rows);

static const struct eo_outline_row influence_rows[] = {
    EO_KEY("key", "text", "of the input"),
    EO_KEY("coefficient", "number?",
           "standardised regression: change in deviations of the output per deviation of the input"),
    EO_KEY("first", "number?", "first Sobol index of the surface: share of the variance that the input has alone"),
    EO_KEY("total", "number?", "total Sobol index: with what it has in common with others"),
};
static const struct eo_outline influence_outline = EO_OUTLINE("ScatterInfluence", influence_rows);

static const struct eo_outline_row output_rows[] = {
    EO_KEY("key", "text", "what is counted; the unit stands in it"),
    EO_KEY("load_case", "integer", "from 1"),
    EO_KEY("rows", "integer", "pairs that have this number"),
    EO_KEY("nominal", "number?", "of the design as drawn"),
    EO_KEY("mean", "number", "over the pairs"),
    EO_KEY("mean_interval", "[number]", "95 %, bootstrap"),
    EO_KEY("std", "number", "standard deviation"),
    EO_KEY("std_interval", "[number]", "95 %, bootstrap"),
    EO_KEY("percentiles", "[object]", "of the pairs", .outline = &percentile_outline),
    EO_KEY("histogram", "object", "25 parts", .outline = &histogram_outline),
    EO_KEY("R2", "number?", "share of the variance that the linear regression explains"),
    EO_KEY("R2_adjusted", "number?", "the same for the number of inputs"),
    EO_KEY("Q2", "number?", "of the quadratic surface, with each pair left out of its own fit: 1 carries all"),
    EO_KEY("surface_error", "number?", "root mean square error of the surface, the same way, in the output's unit"),
    EO_KEY("influences", "[object]", "inputs, those that decide first", .outline = &influence_outline),
    EO_KEY("largest_pair", "integer", "number of the pair with the largest value, from 1"),
};
static const struct eo_outline output_outline = EO_OUTLINE("ScatterOutput", output_rows);

static const struct eo_outline_row yield_rows[] = {
    EO_KEY("output", "text?", "null: all limits together"),
    EO_KEY("load_case", "integer?", "null: every one"),
    EO_KEY("at_most", "number?", "the limit"),
    EO_KEY("inside", "integer", "pairs that meet it; without a number a pair does not"),
    EO_KEY("pairs", "integer", "of so many"),
    EO_KEY("fraction", "number", "the yield"),
    EO_KEY("clopper_pearson", "[number]", "95 % interval that never covers less"),
    EO_KEY("wilson", "[number]", "95 % interval, shorter"),
};
static const struct eo_outline yield_outline = EO_OUTLINE("ScatterYield", yield_rows);

static const struct eo_outline_row correlation_rows[] = {
    EO_KEY("load_case", "integer", "that with the largest share"),
    EO_KEY("keys", "[text]", "outputs"),
    EO_KEY("pearson", "[[number?]]", "a row for each of them"),
    EO_KEY("spearman", "[[number?]]", "of ranks"),
};
static const struct eo_outline correlation_outline = EO_OUTLINE("ScatterCorrelation", correlation_rows);

static const struct eo_outline_row worst_rows[] = {
    EO_KEY("pair", "integer", "from 1"),
    EO_KEY("output", "text", "the number by which it is the worst"),
    EO_KEY("inputs", "[number]", "in the order of inputs, in the units of their keys"),
    EO_KEY("design", "object", "this pair as a design", .table = &eo_design_table, .name = "ResolvedDesign"),
};
static const struct eo_outline worst_outline = EO_OUTLINE("ScatterWorst", worst_rows);

static const struct eo_outline_row tolerance_rows[] = {
    EO_KEY("program", "text", "name and version"),
    EO_KEY("design", "object", "with every default resolved", .table = &eo_design_table, .name = "ResolvedDesign"),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design"),
    EO_KEY("pairs", "integer", "drawn"),
    EO_KEY("failed", "integer", "of them without a converged contact at the first load case"),
    EO_KEY("bounded", "integer", "drawn values that met a bound of their key and were put there"),
    EO_KEY("inputs", "[object]", "what scatters", .outline = &input_outline),
    EO_KEY("outputs", "[object]", "numbers of every load case", .outline = &output_outline),
    EO_KEY("yields", "[object]", "against the limits; the last row: all of them", .outline = &yield_outline),
    EO_KEY("correlation", "object", "between the numbers of one load case", .outline = &correlation_outline),
    EO_KEY("worst", "object", "the worst pair", .outline = &worst_outline),
    EO_KEY("warnings", "[text]", "in plain words"),
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

/* Appends; false, and the list is gone, without memory. */
static bool append(json_t **list, json_t *value)
{
  if (*list && json_array_append_new(*list, value) == 0)
    return true;
  json_decref(*list);
  *list = NULL;
  return false;
}

static json_t *encode_inputs(const struct eo_tolerance_report *report)
{
  json_t *list = json_array();
  for (int i = 0; i < report->scatter->inputs; i++) {
    const struct eo_scatter_input *input = &report->scatter->input[i];
    struct eo_moments moments = eo_scatter_moments(report->scatter, i);
    struct eo_object object = eo_object_open_as(&input_outline);
    char words[120];
    eo_scatter_words(input, words, sizeof words);
    eo_object_put(&object, "key", json_string(input->key));
    eo_object_put(&object, "distribution", json_string(words));
    eo_object_put(&object, "nominal", number(input->nominal));
    eo_object_put(&object, "mean", number(moments.mean));
    eo_object_put(&object, "deviation", number(moments.deviation));
    if (!append(&list, eo_object_close(&object)))
      break;
  }
  return list;
}

static json_t *encode_percentiles(const struct eo_output_report *report)
{
  json_t *list = json_array();
  for (int i = 0; i < EO_REPORT_PERCENTS; i++) {
    const struct eo_report_percentile *percentile = &report->percentile[i];
    struct eo_object object = eo_object_open_as(&percentile_outline);
    eo_object_put(&object, "percent", number(percentile->percent));
    eo_object_put(&object, "value", number(percentile->value));
    eo_object_put(&object, "low", number(percentile->low));
    eo_object_put(&object, "high", number(percentile->high));
    if (!append(&list, eo_object_close(&object)))
      break;
  }
  return list;
}

static json_t *encode_histogram(const struct eo_output_report *report)
{
  struct eo_object object = eo_object_open_as(&histogram_outline);
  json_t *counts = json_array();
  for (int i = 0; i < EO_REPORT_BINS; i++)
    if (!append(&counts, json_integer(report->count[i])))
      break;
  eo_object_put(&object, "least", number(report->summary.least));
  eo_object_put(&object, "largest", number(report->summary.largest));
  eo_object_put(&object, "count", counts);
  return eo_object_close(&object);
}

static json_t *encode_influences(const struct eo_tolerance_report *report, const struct eo_output_report *output_report)
{
  json_t *list = json_array();
  for (int i = 0; i < output_report->inputs; i++) {
    const struct eo_report_influence *influence = &output_report->influence[i];
    struct eo_object object = eo_object_open_as(&influence_outline);
    eo_object_put(&object, "key", json_string(report->scatter->input[influence->input].key));
    eo_object_put(&object, "coefficient", number(influence->coefficient));
    eo_object_put(&object, "first", number(influence->first));
    eo_object_put(&object, "total", number(influence->total));
    if (!append(&list, eo_object_close(&object)))
      break;
  }
  return list;
}

static json_t *encode_output(const struct eo_tolerance_report *report, const struct eo_tolerance_case *tolerance_case)
{
  const struct eo_output_report *output_report = &tolerance_case->report;
  struct eo_object object = eo_object_open_as(&output_outline);
  eo_object_put(&object, "key", json_string(tolerance_case->scalar->key));
  eo_object_put(&object, "load_case", json_integer(tolerance_case->load_case + 1));
  eo_object_put(&object, "rows", json_integer(output_report->rows));
  eo_object_put(&object, "nominal", number(tolerance_case->nominal));
  eo_object_put(&object, "mean", number(output_report->summary.mean));
  eo_object_put(&object, "mean_interval", two(output_report->mean_interval[0], output_report->mean_interval[1]));
  eo_object_put(&object, "std", number(output_report->summary.deviation));
  eo_object_put(&object, "std_interval",
                two(output_report->deviation_interval[0], output_report->deviation_interval[1]));
  eo_object_put(&object, "percentiles", encode_percentiles(output_report));
  eo_object_put(&object, "histogram", encode_histogram(output_report));
  eo_object_put(&object, "R2", number(output_report->r2));
  eo_object_put(&object, "R2_adjusted", number(output_report->r2_adjusted));
  eo_object_put(&object, "Q2", number(output_report->q2));
  eo_object_put(&object, "surface_error", number(output_report->residual));
  eo_object_put(&object, "influences", encode_influences(report, output_report));
  eo_object_put(&object, "largest_pair", json_integer(output_report->largest + 1));
  return eo_object_close(&object);
}

static json_t *encode_outputs(const struct eo_tolerance_report *report)
{
  json_t *list = json_array();
  for (int i = 0; i < report->outputs; i++)
    if (!append(&list, encode_output(report, &report->output[i])))
      break;
  return list;
}

static json_t *encode_yields(const struct eo_tolerance_report *report)
{
  json_t *list = json_array();
  for (int i = 0; i < report->yields; i++) {
    const struct eo_yield_row *row = &report->yield[i];
    struct eo_object object = eo_object_open_as(&yield_outline);
    eo_object_put(&object, "output", *row->output ? json_string(row->output) : json_null());
    eo_object_put(&object, "load_case", row->load_case ? json_integer(row->load_case) : json_null());
    eo_object_put(&object, "at_most", number(row->most));
    eo_object_put(&object, "inside", json_integer(row->inside));
    eo_object_put(&object, "pairs", json_integer(row->pairs));
    eo_object_put(&object, "fraction", number(row->fraction));
    eo_object_put(&object, "clopper_pearson", two(row->exact.low, row->exact.high));
    eo_object_put(&object, "wilson", two(row->wilson.low, row->wilson.high));
    if (!append(&list, eo_object_close(&object)))
      break;
  }
  return list;
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
  json_t *rows = json_array();
  for (int i = 0; i < count; i++) {
    json_t *row = json_array();
    for (int j = 0; j < count && row; j++)
      append(&row, number(eo_correlation(n, column + (size_t)i * (size_t)n, column + (size_t)j * (size_t)n)));
    if (!append(&rows, row))
      break;
  }
  return rows;
}

static json_t *encode_correlation(const struct eo_tolerance_report *report)
{
  int load_case = heaviest(report->design), n = report->run->pairs, count, *of;
  size_t most = (size_t)report->outputs + 1;
  double *column = malloc(sizeof *column * most * (size_t)n * 2);
  struct eo_object object = eo_object_open_as(&correlation_outline);
  json_t *keys = json_array();
  of = malloc(sizeof *of * most);
  object.failed = object.failed || !column || !of;
  count = object.failed ? 0 : collect_columns(report, load_case, of, column);
  double *rank = column ? column + (size_t)count * (size_t)n : NULL;
  for (int i = 0; i < count; i++) {
    append(&keys, json_string(report->output[of[i]].scalar->key));
    object.failed |= eo_ranks(n, column + (size_t)i * (size_t)n, rank + (size_t)i * (size_t)n, NULL) != EO_OK;
  }
  eo_object_put(&object, "load_case", json_integer(load_case + 1));
  eo_object_put(&object, "keys", keys);
  eo_object_put(&object, "pearson", encode_matrix(count, n, column));
  eo_object_put(&object, "spearman", encode_matrix(count, n, rank));
  free(column);
  free(of);
  return eo_object_close(&object);
}

static json_t *encode_worst(const struct eo_tolerance_report *report)
{
  const struct eo_scatter_run *run = report->run;
  struct eo_object object = eo_object_open_as(&worst_outline);
  eo_object_put(&object, "pair", json_integer(report->worst + 1));
  eo_object_put(&object, "output", json_string(report->worst_of));
  eo_object_put(
      &object, "inputs",
      eo_json_reals(run->inputs, run->input + (size_t)report->worst * (size_t)run->inputs, 1, NULL, EO_DIGITS_NUMBER));
  eo_object_put(&object, "design", eo_design_encode(&report->worst_design));
  return eo_object_close(&object);
}

static const char assumed_text[] =
    "Nothing is stated about the gears as made: class 5 of ISO 1328-1:2013 is taken, the tolerance as 2 sigma.";

static json_t *encode_warnings(const struct eo_tolerance_report *report, const struct eo_warnings *warnings)
{
  json_t *list = json_array();
  if (report->assumed)
    append(&list, json_string(assumed_text));
  for (int i = 0; warnings && i < warnings->count && list; i++)
    append(&list, json_string(warnings->text[i]));
  return list;
}

json_t *eo_tolerance_encode(const struct eo_tolerance_report *report, const struct eo_warnings *warnings)
{
  char hash[EO_HASH_LENGTH + 1];
  struct eo_object object = eo_object_open_as(&eo_tolerance_outline);
  eo_object_put(&object, "program", json_string(PACKAGE_STRING));
  eo_object_put(&object, "design", eo_design_encode(report->design));
  eo_object_put(&object, "design_hash", eo_design_hash(report->design, hash, NULL) ? NULL : json_string(hash));
  eo_object_put(&object, "pairs", json_integer(report->run->pairs));
  eo_object_put(&object, "failed", json_integer(report->failed));
  eo_object_put(&object, "bounded", json_integer(report->run->bounded));
  eo_object_put(&object, "inputs", encode_inputs(report));
  eo_object_put(&object, "outputs", encode_outputs(report));
  eo_object_put(&object, "yields", encode_yields(report));
  eo_object_put(&object, "correlation", encode_correlation(report));
  eo_object_put(&object, "worst", encode_worst(report));
  eo_object_put(&object, "warnings", encode_warnings(report, warnings));
  return eo_object_close(&object);
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
  snprintf(words, sizeof words, "%.4g .. %.4g", output_report->percentile[7].low, output_report->percentile[7].high);
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
  if (report->assumed)
    eo_text_print(text, "note: %s\n", assumed_text);
  for (int i = 0; warnings && i < warnings->count; i++)
    eo_text_print(text, "note: %s\n", warnings->text[i]);
}

void eo_tolerance_csv(const struct eo_tolerance_report *report, struct eo_text *text)
{
  const struct eo_scatter_run *run = report->run;
  eo_text_add(text, "pair");
  for (int i = 0; i < run->inputs; i++)
    eo_text_print(text, ",%s", report->scatter->input[i].key);
  for (int i = 0; i < run->outputs; i++)
    eo_text_print(text, ",load_cases.%d.%s", i % run->cases + 1, eo_scalar_at(i / run->cases)->key);
  eo_text_add(text, "\r\n");
  for (int pair = 0; pair < run->pairs; pair++) {
    eo_text_print(text, "%d", pair + 1);
    for (int i = 0; i < run->inputs; i++)
      eo_text_print(text, ",%.12g", run->input[(size_t)pair * (size_t)run->inputs + (size_t)i]);
    for (int i = 0; i < run->outputs; i++) {
      double value = run->output[(size_t)pair * (size_t)run->outputs + (size_t)i];
      if (isfinite(value))
        eo_text_print(text, ",%.12g", value);
      else
        eo_text_add(text, ",");
    }
    eo_text_add(text, "\r\n");
  }
}
