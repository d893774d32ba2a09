/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a search found, for the terminal. */
#include "document/study_result.h"

#include <string.h>
#include <math.h>

#include "format/json.h"
#include "format/text_table.h"

static const char *find_text(const json_t *value, const char *path)
{
  const char *text = json_string_value(eo_json_find(value, path));
  return text ? text : "";
}

static void print_variables(const json_t *document, struct eo_text *text)
{
  static const char *const headings[] = {"variable", "lowest", "highest", "best"};
  const json_t *row;
  size_t i;
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 4, headings);
  json_array_foreach(json_object_get(document, "variables"), i, row)
  {
    eo_text_table_string(&sheet, find_text(row, "name"));
    for (size_t j = 0; j < 2; j++)
      eo_text_table_number(&sheet, json_number_value(json_array_get(json_object_get(row, "bounds"), j)), NULL, 5);
    eo_text_table_number(&sheet, eo_json_find_number(row, "best"), NULL, 5);
  }
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  eo_text_add(text, "\n");
}

static void add_reduction(struct eo_text_table *sheet, double before, double after)
{
  char change[40] = "";
  double percent = 100 * (1 - after / before);
  if (isfinite(percent))
    snprintf(change, sizeof change, "%.*f %%", fabs(percent) < 9.95 ? 1 : 0, percent);
  eo_text_table_string(sheet, change);
}

static const struct quantity {
  const char *key, *name, *unit;
} sums[] = {{"f1_um", "f1", "um"}, {"f2_N", "f2", "N"}, {"f3_m_per_s2", "f3", "m/s2"}, {"J", "J", ""}},
  per_case[] = {{"peak_to_peak_um", "peak-to-peak loaded TE", "um"},
                {"impact_N", "entering impact", "N"},
                {"rms_m_per_s2", "vibration, RMS normal", "m/s2"},
                {"contact_pressure_MPa", "contact pressure", "MPa"},
                {"root_stress_MPa", "root stress", "MPa"}};

static void add_rows(struct eo_text_table *sheet, const struct quantity *quantity, size_t count, const json_t *before,
                     const json_t *after)
{
  for (size_t i = 0; i < count; i++) {
    double a = eo_json_find_number(before, quantity[i].key), b = eo_json_find_number(after, quantity[i].key);
    eo_text_table_string(sheet, quantity[i].name);
    eo_text_table_string(sheet, quantity[i].unit);
    eo_text_table_number(sheet, a, NULL, 4);
    eo_text_table_number(sheet, b, NULL, 4);
    add_reduction(sheet, a, b);
  }
}

static void print_comparison(const struct quantity *quantity, size_t count, const json_t *before, const json_t *after,
                             struct eo_text *text)
{
  static const char *const headings[] = {"", "", "unmodified", "optimum", "reduction"};
  struct eo_text_table sheet;
  eo_text_table_init(&sheet, 5, headings);
  add_rows(&sheet, quantity, count, before, after);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  eo_text_add(text, "\n");
}

static void print_cases(const json_t *document, struct eo_text *text)
{
  const json_t *after = eo_json_find(document, "best/result/objectives/load_cases"), *row;
  const json_t *before = eo_json_find(document, "best/result/objectives/unmodified/load_cases");
  size_t k;
  json_array_foreach((json_t *)after, k, row)
  {
    eo_text_print(text, "%.6g N m, %.6g rpm\n", eo_json_find_number(row, "torque_Nm"),
                  eo_json_find_number(row, "speed_rpm"));
    print_comparison(per_case, sizeof per_case / sizeof *per_case, json_array_get(before, k), row, text);
  }
}

/* What the front is over, point by point. */
static void print_front(const json_t *document, struct eo_text *text)
{
  const json_t *axes = json_object_get(document, "front_axes"), *front = json_object_get(document, "front"), *point;
  size_t count = json_array_size(axes), i;
  const char *headings[EO_MAX_OBJECTIVES + 3] = {""};
  struct eo_text_table sheet;
  for (i = 0; i < count && i < EO_MAX_OBJECTIVES; i++)
    headings[i + 1] = json_string_value(json_array_get(axes, i));
  headings[count + 1] = "J";
  headings[count + 2] = "violation";
  eo_text_print(text, "Pareto front, %zu points:\n", json_array_size(front));
  eo_text_table_init(&sheet, (int)count + 3, headings);
  json_array_foreach((json_t *)front, i, point)
  {
    bool knee = json_is_true(json_object_get(point, "knee")),
         weighted = json_is_true(json_object_get(point, "weighted"));
    eo_text_table_string(&sheet, weighted ? "least J" : knee ? "knee" : "");
    for (size_t k = 0; k < count; k++)
      eo_text_table_number(&sheet, json_number_value(json_array_get(json_object_get(point, "axes"), k)), NULL, 4);
    eo_text_table_number(&sheet, eo_json_find_number(point, "J"), NULL, 4);
    eo_text_table_number(&sheet, eo_json_find_number(point, "violation"), NULL, 4);
  }
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  eo_text_add(text, "\n");
}

static void print_effort(const json_t *document, struct eo_text *text)
{
  eo_text_print(text,
                "%s: %.0f true evaluations of %.0f individuals (PFC %.1f %%), %.0f of them known from the history, "
                "%.0f failed; %.0f earlier rows imported\n",
                find_text(document, "algorithm"), eo_json_find_number(document, "true_evaluations"),
                eo_json_find_number(document, "individuals"), eo_json_find_number(document, "pfc_percent"),
                eo_json_find_number(document, "reused_evaluations"),
                eo_json_find_number(document, "failed_evaluations"), eo_json_find_number(document, "imported_rows"));
  eo_text_print(text,
                "Job %.0f%s, %.0f evaluations computed now in %.1f s on %.0f threads (model %.1f s, optimizer %.1f s, "
                "history %.1f s); stopped: %s\n",
                eo_json_find_number(document, "run/job"),
                json_is_true(eo_json_find(document, "run/taken_up")) ? ", taken up" : "",
                eo_json_find_number(document, "run/computed_evaluations"), eo_json_find_number(document, "run/wall_s"),
                eo_json_find_number(document, "run/threads"), eo_json_find_number(document, "run/model_s"),
                eo_json_find_number(document, "run/optimizer_s"), eo_json_find_number(document, "run/history_s"),
                find_text(document, "stopped"));
}

static const char violated[] = "Constraints are violated by";

/* But for what stands above them. */
static void print_notes(const json_t *warnings, struct eo_text *text)
{
  const json_t *row;
  size_t i;
  json_array_foreach((json_t *)warnings, i, row)
  {
    if (strncmp(json_string_value(row), violated, sizeof violated - 1) != 0)
      eo_text_print(text, "Note: %s\n", json_string_value(row));
  }
}

void eo_study_result_summary(const json_t *document, struct eo_text *text)
{
  char name[200];
  const json_t *best = json_object_get(document, "best"), *front = json_object_get(document, "front");
  eo_text_clean(name, sizeof name, find_text(document, "design/name"));
  eo_text_print(text, "%s%s", name, *name ? "\n" : "");
  print_variables(document, text);
  if (json_is_null(best))
    eo_text_add(text, "No evaluation has given a value yet.\n\n");
  else {
    print_comparison(sums, sizeof sums / sizeof *sums, json_object_get(document, "unmodified"),
                     json_object_get(best, "objectives"), text);
    print_cases(document, text);
  }
  if (eo_json_find_number(best, "objectives/violation") > 0)
    eo_text_print(text, "%s %.4g in sum.\n", violated, eo_json_find_number(best, "objectives/violation"));
  if (front)
    print_front(document, text);
  if (json_object_get(document, "check"))
    eo_made_check_summary(json_object_get(document, "check"), text);
  print_effort(document, text);
  print_notes(json_object_get(document, "warnings"), text);
  print_notes(eo_json_find(best, "result/warnings"), text);
}
