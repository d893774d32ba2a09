/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reproduction as files, as one page, and in short. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "format/plot.h"
#include "format/text_table.h"
#include "document/made_check_document.h"
#include "reproduction/reproduction.h"

static const char *find_text(const json_t *value, const char *path)
{
  const char *text = json_string_value(eo_json_find(value, path));
  return text ? text : "";
}

static void add_verdict(struct eo_text_table *sheet, const json_t *row, const char *key)
{
  const json_t *value = json_object_get(row, key);
  eo_text_table_string(sheet, json_is_boolean(value) ? json_is_true(value) ? "yes" : "no" : "");
}

static void fill_comparisons(const json_t *document, struct eo_text_table *sheet, int digits)
{
  static const char *const headings[] = {"figure", "quantity",     "paper",        "ours",         "ours, secant law",
                                         "unit",   "trend agrees", "value agrees", "secant agrees"};
  const json_t *row;
  size_t i;
  eo_text_table_init(sheet, 9, headings);
  json_array_foreach(json_object_get(document, "comparisons"), i, row)
  {
    eo_text_table_string(sheet, find_text(row, "figure"));
    eo_text_table_string(sheet, find_text(row, "quantity"));
    eo_text_table_number(sheet, eo_json_find_number(row, "paper"), NULL, digits);
    eo_text_table_number(sheet, eo_json_find_number(row, "ours"), NULL, digits);
    eo_text_table_number(sheet, eo_json_find_number(row, "ours_secant_law"), NULL, digits);
    eo_text_table_string(sheet, find_text(row, "unit"));
    add_verdict(sheet, row, "trend_agrees");
    add_verdict(sheet, row, "value_agrees");
    add_verdict(sheet, row, "value_agrees_secant_law");
  }
}

static void fill_table_3(const json_t *document, struct eo_text_table *sheet, int digits)
{
  static const char *const headings[] = {"parameter",    "A, printed",       "A, ours",      "B left, printed",
                                         "B left, ours", "B right, printed", "B right, ours"};
  static const char *const keys[] = {"printed_case_a",   "ours_case_a",          "printed_case_b_left",
                                     "ours_case_b_left", "printed_case_b_right", "ours_case_b_right"};
  const json_t *row;
  size_t i;
  eo_text_table_init(sheet, 7, headings);
  json_array_foreach(json_object_get(document, "table_3"), i, row)
  {
    eo_text_table_string(sheet, find_text(row, "parameter"));
    for (int j = 0; j < 6; j++)
      eo_text_table_number(sheet, eo_json_find_number(row, keys[j]), NULL, digits);
  }
}

static void fill_results(const json_t *document, struct eo_text_table *sheet, int digits)
{
  static const char *const headings[] = {"design",         "mesh law", "PPLTE 621",   "828",      "1035 N m, um",
                                         "impact 621",     "828",      "1035 N m, N", "RMS 621",  "828",
                                         "1035 N m, m/s2", "f1, um",   "f2, N",       "f3, m/s2", "J"};
  static const char *const keys[] = {"peak_to_peak_um", "impact_N", "rms_m_per_s2"}, *const sums[] = {"f1_um", "f2_N",
                                                                                                      "f3_m_per_s2",
                                                                                                      "J"};
  const json_t *row;
  size_t i;
  eo_text_table_init(sheet, 15, headings);
  json_array_foreach(json_object_get(document, "results"), i, row)
  {
    eo_text_table_string(sheet, find_text(row, "design"));
    eo_text_table_string(sheet, find_text(row, "mesh_law"));
    for (int j = 0; j < 3; j++)
      for (size_t k = 0; k < 3; k++)
        eo_text_table_number(sheet, eo_json_find_number(json_array_get(json_object_get(row, "load_cases"), k), keys[j]),
                             NULL, digits);
    for (int j = 0; j < 4; j++)
      eo_text_table_number(sheet, eo_json_find_number(row, sums[j]), NULL, digits);
  }
}

static void fill_optimizations(const json_t *document, struct eo_text_table *sheet, int digits)
{
  static const char *const headings[] = {"case", "algorithm", "J", "true evaluations", "individuals", "PFC, %"};
  static const char *const keys[] = {"J", "true_evaluations", "individuals", "pfc_percent"};
  const json_t *row;
  size_t i;
  eo_text_table_init(sheet, 6, headings);
  json_array_foreach(json_object_get(document, "optimizations"), i, row)
  {
    eo_text_table_string(sheet, find_text(row, "case"));
    eo_text_table_string(sheet, find_text(row, "algorithm"));
    for (int j = 0; j < 4; j++)
      eo_text_table_number(sheet, eo_json_find_number(row, keys[j]), NULL, j == 1 || j == 2 ? 0 : digits);
  }
}

static void fill_sensitivity(const json_t *document, struct eo_text_table *sheet, int digits)
{
  static const char *const headings[] = {"assumption",
                                         "value",
                                         "RMS unmodified 621",
                                         "828",
                                         "1035",
                                         "RMS case A 621",
                                         "828",
                                         "1035",
                                         "less RMS 621, %",
                                         "828",
                                         "1035",
                                         "less LTE 828, %",
                                         "impact unmodified 828, N",
                                         "impact case A 828, N",
                                         "J case A"};
  static const char *const keys[] = {"rms_unmodified_m_per_s2", "rms_case_a_m_per_s2", "rms_reduction_percent"},
                           *const at_828[] = {"lte_reduction_percent", "impact_unmodified_N", "impact_case_a_N"};
  const json_t *row;
  size_t i;
  eo_text_table_init(sheet, 15, headings);
  json_array_foreach(json_object_get(document, "sensitivity"), i, row)
  {
    eo_text_table_string(sheet, find_text(row, "assumption"));
    eo_text_table_string(sheet, find_text(row, "value"));
    for (int j = 0; j < 3; j++)
      for (size_t k = 0; k < 3; k++) {
        const json_t *number = json_array_get(json_object_get(row, keys[j]), k);
        eo_text_table_number(sheet, json_is_number(number) ? json_number_value(number) : NAN, NULL, digits);
      }
    for (int j = 0; j < 3; j++)
      eo_text_table_number(sheet, json_number_value(json_array_get(json_object_get(row, at_828[j]), 1)), NULL, digits);
    eo_text_table_number(sheet, eo_json_find_number(row, "J_case_a"), NULL, digits);
  }
}

static void fill_made(const json_t *document, struct eo_text_table *sheet, int digits)
{
  eo_made_check_table(json_object_get(document, "as_made"), digits, sheet);
}

static void fill_worse(const json_t *document, struct eo_text_table *sheet, int digits)
{
  (void)digits;
  eo_made_check_shares(json_object_get(document, "as_made"), sheet);
}

static const struct table {
  const char *file, *title;
  void (*fill)(const json_t *document, struct eo_text_table *sheet, int digits);
} tables[] = {
    {"comparisons.csv", "The paper's numbers and ours", fill_comparisons},
    {"table-3.csv", "Table 3: parameters of the optimal modification", fill_table_3},
    {"results.csv", "Every design at the three torques", fill_results},
    {"optimizations.csv", "Our optimizations", fill_optimizations},
    {"as-made.csv", "The designs as they are made: the same pairs of class 5 of ISO 1328-1 for each", fill_made},
    {"as-made-worse.csv", "... and how many of these pairs are worse than the unmodified pair made alike", fill_worse},
    {"sensitivity.csv", "What the assumptions do: one changed at a time", fill_sensitivity},
};
enum { TABLES = sizeof tables / sizeof tables[0] };

static void file_name(const char *number, char *name, size_t size)
{
  snprintf(name, size, "figure-%s.csv", number);
  for (char *c = name; *c; c++)
    if (*c == ' ')
      *c = '-';
}

/* Long form: series, x, y; curves of one figure may have different points. */
static void write_figure(const json_t *figure, struct eo_text *text)
{
  const char *const headings[] = {"series", find_text(figure, "x_label"), find_text(figure, "y_label")};
  const json_t *series;
  size_t i;
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 3, headings);
  json_array_foreach(json_object_get(figure, "series"), i,
                     series) for (size_t j = 0; j < json_array_size(json_object_get(series, "x")); j++)
  {
    const json_t *value = json_array_get(json_object_get(series, "y"), j);
    eo_text_table_string(&sheet, find_text(series, "name"));
    eo_text_table_number(&sheet, json_number_value(json_array_get(json_object_get(series, "x"), j)), NULL, 0);
    eo_text_table_number(&sheet, json_is_number(value) ? json_number_value(value) : NAN, NULL, 0);
  }
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
}

void eo_reproduction_files(const json_t *document, struct eo_file_set *bundle)
{
  const json_t *figure;
  size_t i;
  for (i = 0; i < TABLES; i++) {
    struct eo_text *text = eo_file_set_add(bundle, "%s", tables[i].file);
    struct eo_text_table sheet;
    if (!text)
      return;
    tables[i].fill(document, &sheet, 0);
    eo_text_table_csv(&sheet, text);
    eo_text_table_done(&sheet);
  }
  json_array_foreach(json_object_get(document, "figures"), i, figure)
  {
    char name[60];
    file_name(find_text(figure, "number"), name, sizeof name);
    struct eo_text *text = eo_file_set_add(bundle, "%s", name);
    if (!text)
      return;
    write_figure(figure, text);
  }
}

static const char style[] =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;color:#111;background:#fff}"
    "h1{font-size:1.6em}h2{margin-top:2em;border-bottom:1px solid #ccc}table{border-collapse:collapse;font-size:13px}"
    "th,td{padding:2px 8px;border-bottom:1px solid "
    "#ddd;text-align:right}th{text-align:left;vertical-align:bottom}td.text{text-align:left}"
    ".wide{overflow-x:auto}.figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(420px,1fr));gap:1em}"
    "figure{margin:0}svg{width:100%;height:auto}"
    "td.no{font-weight:bold}@media print{.figures{grid-template-columns:1fr 1fr}}";

static void write_table(const struct eo_text_table *sheet, struct eo_text *text)
{
  eo_text_add(text, "<div class=\"wide\"><table>\n<tr>");
  for (int i = 0; i < sheet->cells; i++) {
    const struct eo_cell *cell = &sheet->cell[i];
    bool head = i < sheet->columns;
    if (i && i % sheet->columns == 0)
      eo_text_add(text, "</tr>\n<tr>");
    eo_text_add(text, head                            ? "<th>"
                      : cell->number                  ? "<td>"
                      : strcmp(cell->text, "no") == 0 ? "<td class=\"text no\">"
                                                      : "<td class=\"text\">");
    eo_text_add_escaped(text, cell->text);
    eo_text_add(text, head ? "</th>" : "</td>");
  }
  eo_text_add(text, "</tr>\n</table></div>\n");
  text->failed |= sheet->failed;
}

/* Columns of a series; *store is owned by the caller. */
static bool read_series(const json_t *series, struct eo_plot_series *line, double **store)
{
  size_t count = json_array_size(json_object_get(series, "x"));
  double *x = *store = malloc((2 * count + 1) * sizeof *x);
  if (!x)
    return false;
  double *y = x + count;
  for (size_t j = 0; j < count; j++) {
    const json_t *number = json_array_get(json_object_get(series, "y"), j);
    x[j] = json_number_value(json_array_get(json_object_get(series, "x"), j));
    y[j] = json_is_number(number) ? json_number_value(number) : NAN;
  }
  *line = (struct eo_plot_series){find_text(series, "name"), (int)count, x, y,
                                  json_is_true(json_object_get(series, "dots"))};
  return true;
}

static void write_plot(const json_t *figure, struct eo_text *text)
{
  char title[160];
  double *store[EO_PLOT_SERIES] = {NULL};
  const json_t *series;
  size_t i;
  snprintf(title, sizeof title, "Fig. %.8s: %.140s", find_text(figure, "number"), find_text(figure, "title"));
  struct eo_plot plot = {.title = title,
                         .x_label = find_text(figure, "x_label"),
                         .y_label = find_text(figure, "y_label"),
                         .from_zero = json_is_true(json_object_get(figure, "from_zero"))};
  json_array_foreach(json_object_get(figure, "series"), i,
                     series) if (plot.series < EO_PLOT_SERIES &&
                                 read_series(series, &plot.line[plot.series], &store[plot.series])) plot.series++;
  eo_text_add(text, "<figure>");
  eo_plot_svg(&plot, text);
  eo_text_add(text, "</figure>\n");
  for (int j = 0; j < EO_PLOT_SERIES; j++)
    free(store[j]);
}

static void write_list(const json_t *items, struct eo_text *text)
{
  const json_t *item;
  size_t i;
  eo_text_add(text, "<ul>\n");
  json_array_foreach((json_t *)items, i, item)
  {
    eo_text_add(text, "<li>");
    eo_text_add_escaped(text, json_string_value(item) ? json_string_value(item) : "");
    eo_text_add(text, "</li>\n");
  }
  eo_text_add(text, "</ul>\n");
}

static void count_verdicts(const json_t *document, const char *key, int *yes, int *all)
{
  const json_t *row;
  size_t i;
  *yes = *all = 0;
  json_array_foreach(json_object_get(document, "comparisons"), i, row)
  {
    *yes += json_is_true(json_object_get(row, key));
    *all += json_is_boolean(json_object_get(row, key));
  }
}

static void write_verdict(const json_t *document, struct eo_text *text)
{
  int trends[2], values[2], secant[2];
  count_verdicts(document, "trend_agrees", &trends[0], &trends[1]);
  count_verdicts(document, "value_agrees", &values[0], &values[1]);
  count_verdicts(document, "value_agrees_secant_law", &secant[0], &secant[1]);
  eo_text_print(text, "%d of %d trends and %d of %d numbers of the paper agree; with the paper's mesh law %d of %d",
                trends[0], trends[1], values[0], values[1], secant[0], secant[1]);
}

void eo_reproduction_page(const json_t *document, struct eo_text *text)
{
  const json_t *figure;
  size_t i;
  eo_text_print(text,
                "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
                "content=\"width=device-width\">"
                "<title>The paper and ours</title><link rel=\"icon\" href=\"data:,\"><style>%s</style></head><body>\n",
                style);
  eo_text_add(text, "<h1>Optimum microgeometry modifications of herringbone gear, reproduced</h1>\n<p>");
  eo_text_add_escaped(text, find_text(document, "program"));
  eo_text_add(text, "; the paper: doi.org/10.21595/jve.2016.17179. ");
  write_verdict(document, text);
  eo_text_print(text, ".%s</p>\n",
                json_is_true(json_object_get(document, "quick")) ? " Quick run: a tenth of the paper's generations."
                                                                 : "");
  for (i = 0; i < TABLES; i++) {
    struct eo_text_table sheet;
    tables[i].fill(document, &sheet, 4);
    eo_text_print(text, "<h2>%s</h2>\n", tables[i].title);
    write_table(&sheet, text);
    eo_text_table_done(&sheet);
  }
  eo_text_add(text, "<h2>Figures</h2>\n<div class=\"figures\">\n");
  json_array_foreach(json_object_get(document, "figures"), i, figure) write_plot(figure, text);
  eo_text_add(text, "</div>\n<h2>How the paper was read</h2>\n");
  write_list(json_object_get(document, "readings"), text);
  eo_text_add(text, "</body></html>\n");
}

void eo_reproduction_summary(const json_t *document, struct eo_text *text)
{
  const json_t *item;
  size_t i;
  for (i = 0; i < TABLES; i++) {
    struct eo_text_table sheet;
    eo_text_print(text, "%s\n", tables[i].title);
    tables[i].fill(document, &sheet, 4);
    eo_text_table_print(&sheet, 2, text);
    eo_text_table_done(&sheet);
    eo_text_add(text, "\n");
  }
  write_verdict(document, text);
  eo_text_print(text, ".\n\nFigures (curves in --json, --csv and --html):");
  json_array_foreach(json_object_get(document, "figures"), i, item)
      eo_text_print(text, " %s", find_text(item, "number"));
  eo_text_add(text, "\n\n");
  json_array_foreach(json_object_get(document, "readings"), i, item)
      eo_text_print(text, "Read: %s\n", json_string_value(item));
}
