/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A race over pairs as made: every flank is looked at with the first pairs, the best of each batch go on to all of
   them, so many that the second looks cost less than the first (one bracket of Li et al. 2018, Hyperband, with two
   rungs). The pairs are the same for every flank, so the first ones tell which of two is the better; what they do not
   tell, the rest between the rank over all and that over the first, changes slowly from flank to flank and is taken
   from the nearest whole row. A row of the first look is told behind the best whole one and never is the result. */
#include "study/study_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum eo_code eo_race_begin(struct study *study, struct eo_error *error)
{
  const struct eo_design *design = study->plan->design;
  struct race *race = &study->race;
  race->best = INFINITY;
  if (design->objective.robust == EO_ROBUST_OFF || design->drawn.pairs == 0 ||
      design->objective.first_pairs >= design->drawn.pairs)
    return EO_OK;
  race->first = design->objective.first_pairs;
  race->design = malloc(sizeof *race->design);
  if (!race->design)
    return eo_error_memory(error);
  *race->design = *design;
  race->design->drawn.first = race->first;
  return eo_design_problem(race->design, &race->spec, race->hash, error);
}

void eo_race_end(struct study *study)
{
  free(study->race.design);
  eo_text_done(&study->race.spec);
}

static double distance(const struct study *study, const struct eo_row_data *a, const struct eo_row_data *b)
{
  double sum = 0;
  for (int i = 0; i < study->result->space.count; i++)
    sum += (a->x[i] - b->x[i]) * (a->x[i] - b->x[i]);
  return sum;
}

/* Of the nearest whole row that has one; 0 while there is none. */
static double nearest_rest(const struct study *study, const struct eo_row_data *row)
{
  double least = INFINITY, rest = 0;
  for (int i = 0; i < study->row.count; i++) {
    const struct eo_row_data *other = eo_rows_at(&study->row, i);
    double away = other->whole && isfinite(other->rest) ? distance(study, row, other) : INFINITY;
    if (away < least) {
      least = away;
      rest = other->rest;
    }
  }
  return rest;
}

/* theory (O7): so many whole rows that all but the first look of them costs less than the first looks do. */
static int allowed(const struct race *race, int scenarios)
{
  return (race->first * race->asked + scenarios - 1) / scenarios - race->whole;
}

void eo_race_choose(struct study *study)
{
  struct race *race = &study->race;
  race->asked += study->batch.count;
  study->missing_count = 0;
  study->target = study->result->scenarios;
  for (int left = allowed(race, study->target); left > 0; left--) {
    struct eo_row_data *best = NULL;
    double least = INFINITY;
    int place = 0;
    for (int i = study->told; i < study->told + study->batch.count; i++) {
      struct eo_row_data *row = eo_rows_at(&study->row, i);
      if (row->whole)
        continue;
      eo_study_weigh_over(study, race->first, &row->point);
      double likely = row->point.there ? row->point.rank + nearest_rest(study, row) : INFINITY;
      if (likely < least) {
        least = likely;
        best = row;
        place = i;
      }
    }
    if (!best)
      break;
    best->whole = true;
    best->rest = NAN;
    race->whole++;
    if (best->states < study->target)
      study->missing[study->missing_count++] = place;
  }
}

void eo_race_settle(struct study *study, struct eo_row_data *row)
{
  struct race *race = &study->race;
  if (!race->first) {
    eo_study_weigh(study, &row->point);
    return;
  }
  eo_study_weigh_over(study, race->first, &row->point);
  if (!row->whole)
    return;
  double first = row->point.rank;
  eo_study_weigh(study, &row->point);
  row->rest = row->point.rank - first;
  if (row->point.there)
    race->best = fmin(race->best, row->point.rank);
}

double eo_race_value(const struct study *study, const struct eo_row_data *row)
{
  if (!study->race.first || row->whole)
    return row->point.rank;
  double likely = row->point.rank + nearest_rest(study, row);
  return fmax(likely, nextafter(study->race.best, INFINITY));
}
