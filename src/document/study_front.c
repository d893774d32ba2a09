/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A Pareto front for spreadsheets. */
#include "document/study_result.h"

#include <math.h>
#include <string.h>

#include "format/json.h"
#include "format/text_table.h"

static const char *const sums[] = {"f1_um", "f2_N", "f3_m_per_s2", "J", "violation"},
                         *const marks[] = {"knee", "least_J"}, *const mark_keys[] = {"knee", "weighted"};
enum { SUMS = sizeof sums / sizeof *sums, MARKS = sizeof marks / sizeof *marks };

static void add_numbers(struct eo_text_table *sheet, const json_t *numbers)
{
  const json_t *number;
  size_t i;
  json_array_foreach((json_t *)numbers, i, number)
      eo_text_table_number(sheet, json_is_number(number) ? json_number_value(number) : NAN, NULL, 0);
}

static void add_point(struct eo_text_table *sheet, const json_t *point)
{
  add_numbers(sheet, json_object_get(point, "axes"));
  for (int k = 0; k < SUMS; k++)
    eo_text_table_number(sheet, eo_json_find_number(point, sums[k]), NULL, 0);
  for (int k = 0; k < MARKS; k++)
    eo_text_table_number(sheet, json_is_true(json_object_get(point, mark_keys[k])), NULL, 0);
  add_numbers(sheet, json_object_get(point, "values"));
}

bool eo_study_front_csv(const json_t *document, struct eo_text *text)
{
  const json_t *axes = json_object_get(document, "front_axes"), *front = json_object_get(document, "front"),
               *variables = json_object_get(document, "variables"), *row;
  const char *headings[EO_MAX_OBJECTIVES + SUMS + MARKS + EO_MAX_LISTED];
  struct eo_text_table sheet;
  int columns = 0;
  size_t i;
  if (!json_is_array(front) || json_array_size(axes) > EO_MAX_OBJECTIVES || json_array_size(variables) > EO_MAX_LISTED)
    return false;
  json_array_foreach((json_t *)axes, i, row) headings[columns++] = json_string_value(row);
  for (int k = 0; k < SUMS; k++)
    headings[columns++] = sums[k];
  for (int k = 0; k < MARKS; k++)
    headings[columns++] = marks[k];
  json_array_foreach((json_t *)variables, i, row) headings[columns++] = json_string_value(json_object_get(row, "name"));
  eo_text_table_init(&sheet, columns, headings);
  json_array_foreach((json_t *)front, i, row) add_point(&sheet, row);
  eo_text_table_csv(&sheet, text);
  eo_text_table_done(&sheet);
  return true;
}
