/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/objective_anatomy.h"

#include <stdlib.h>
#include <string.h>

enum { GROUPS = 3, ENDS = 2 };

/* The derivative of J to a value of objective i at one load case: (O1) and (O2) of doc/theory. */
static double weight_of(const struct eo_objective *objective, const struct eo_objective_sums *before, int i,
                        double share, int cases)
{
  const double scale = objective->normalise == EO_NORMALISE_NONE ? 1 : before->f[i];
  return scale > 0 ? objective->weight[i] * share / cases / scale : 0;
}

enum eo_code eo_objective_anatomy(const struct eo_design *design, int scenarios,
                                  const struct eo_objective_case *unmodified, struct eo_anatomy *anatomy,
                                  struct eo_error *error)
{
  const int cases = design->load_cases, rows = scenarios * cases;
  *anatomy = (struct eo_anatomy){0};
  if (scenarios > 1 && design->objective.robust == EO_ROBUST_WORST)
    return EO_OK;
  anatomy->group = malloc((size_t)(GROUPS * rows) * sizeof *anatomy->group);
  if (!anatomy->group)
    return eo_error_memory(error);
  struct eo_part_group *group = anatomy->group;
  for (int row = 0; row < rows; row++) {
    struct eo_objective_sums before;
    eo_objective_sum(cases, design->load_case, unmodified + row / cases * cases, &before);
    const double share = design->load_case[row % cases].share / scenarios;
    *group++ = (struct eo_part_group){EO_PART_RANGE, EO_OBJECTIVE_SAMPLES,
                                      weight_of(&design->objective, &before, 0, share, cases)};
    *group++ = (struct eo_part_group){EO_PART_LARGEST, ENDS, weight_of(&design->objective, &before, 1, share, cases)};
    *group++ = (struct eo_part_group){EO_PART_LARGEST, 1, weight_of(&design->objective, &before, 2, share, cases)};
  }
  anatomy->groups = GROUPS * rows;
  anatomy->parts = (EO_OBJECTIVE_SAMPLES + ENDS + 1) * rows;
  return EO_OK;
}

void eo_objective_parts(const struct eo_objective_case *raw, int rows, double *parts)
{
  for (int row = 0; row < rows; row++) {
    memcpy(parts, raw[row].transmission, sizeof raw->transmission);
    parts += EO_OBJECTIVE_SAMPLES;
    for (int end = 0; end < ENDS; end++)
      *parts++ = raw[row].end_impact[end];
    *parts++ = raw[row].rms;
  }
}
