/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/known_law.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "tolerance/statistics.h"

const double eo_index_tolerance = 0.005;

/* Percentiles within four standard errors sqrt(p (1 - p)/N)/density of independent samples, which evenly spread points
   must keep as well. */
static void check_percentiles(const struct eo_known_law *known, struct eo_case *rows, const double *sorted)
{
  for (int i = 0; i < eo_case_size(rows); i++) {
    struct eo_case *row = eo_case_at(rows, i);
    double percent = eo_case_number(row, "percent"), density = eo_case_number(row, "density"), p = percent / 100;
    double spread = sqrt(p * (1 - p)) / density;
    eo_verify_member(known->v, row, "value", eo_percentile(known->points, sorted, percent), 0,
                     4 * spread / sqrt(known->points) + known->resolution);
    eo_verify_member(known->v, row, "standard_error_1000", spread / sqrt(1000), 2e-3, 2e-5);
  }
}

enum eo_code eo_verify_law(const struct eo_known_law *known, struct eo_case *block, struct eo_error *error)
{
  struct eo_summary summary = eo_summary_of(known->points, known->value);
  double *sorted = malloc(sizeof *sorted * (size_t)known->points), fourth = 0;
  if (!sorted)
    return eo_error_memory(error);
  for (int i = 0; i < known->points; i++)
    fourth += pow((known->value[i] - summary.mean) / summary.deviation, 4) / known->points;
  memcpy(sorted, known->value, sizeof *sorted * (size_t)known->points);
  eo_sort_numbers(known->points, sorted);
  double root = sqrt(known->points);
  eo_verify_member(known->v, block, "mean", summary.mean, 0, 4 * summary.deviation / root + known->resolution);
  eo_verify_member(known->v, block, "std", summary.deviation, 0,
                   4 * summary.deviation * sqrt(fmax(fourth, 3) - 1) / (2 * root) + known->resolution);
  check_percentiles(known, eo_case_find(block, "percentiles"), sorted);
  free(sorted);
  return EO_OK;
}
