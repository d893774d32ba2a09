/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The true rows of a running study, in the order the optimizer has them. */
#ifndef EASEOFF_STUDY_STUDY_ROWS_H
#define EASEOFF_STUDY_STUDY_ROWS_H

#include "document/study_result.h"
#include "optimizer/settings.h"
#include "store/evaluations.h"

struct eo_row_data {
  struct eo_study_point point;
  struct eo_text text; /* the modification as the history knows it */
  enum eo_evaluation_outcome outcome;
  char reason[EO_REASON_LENGTH];
  double cost;                /* s */
  bool computed;              /* by this process, and not saved yet */
  int states;                 /* scenarios whose raw values are there, from the first on */
  bool whole;                 /* told with all of them; else with the first pairs alone: study_race.c */
  double rest;                /* whole, in a race: rank over all less that over the first pairs */
  double x[EO_MAX_VARIABLES]; /* in the unit cube */
};

struct eo_rows {
  int count, capacity, values; /* values: raw ones of a row, [scenarios][cases] */
  struct eo_row_data **row;    /* [capacity], each owned: a row stays where it is while more are added */
};

/* Adds a row for a modification, its text written and its raw values zero. ends: of the pair. */
enum eo_code eo_rows_add(struct eo_rows *rows, const struct eo_modification *modification, int ends,
                         struct eo_row_data **row, struct eo_error *error);

/* Takes out the rows from first on. */
void eo_rows_drop(struct eo_rows *rows, int first);
void eo_rows_done(struct eo_rows *rows);

/* Row 0..count - 1; its address holds while rows are added. */
static inline struct eo_row_data *eo_rows_at(const struct eo_rows *rows, int index)
{
  return rows->row[index];
}

#endif
