/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A running study of variants and its parts; see variant_study.h. */
#ifndef EASEOFF_VARIANTS_VARIANT_STUDY_PRIVATE_H
#define EASEOFF_VARIANTS_VARIANT_STUDY_PRIVATE_H

#include "store/jobs.h"
#include "store/variant_rows.h"
#include "variants/variant_study.h"

/* An answer that is not written yet. */
struct waiting_answer {
  int variant;
  struct eo_text bytes; /* owned */
};
enum { MOST_WAITING = 500 };

struct variant_study {
  const struct eo_variant_run *run;
  struct eo_variant_result *result;
  struct eo_stored_job job;
  struct eo_scalars scalars;
  int64_t columns;
  int *missing; /* [rows] variants that have no row yet, in the order of evaluation; owned */
  int missing_count;
  double *number;                       /* [scalars.count]; owned */
  double started, computing, committed; /* s of the clock */
  struct waiting_answer waiting[MOST_WAITING];
  int waiting_count;
  double waits_since;    /* s of the clock, the first of them */
  struct eo_error fault; /* of writing, where it could not be told at once */
  bool open;             /* a transaction is */
  int unsaved;           /* rows in it */
  /* The history of searches, where the study shares it: */
  bool shared;
  int64_t problem;
  struct eo_objective_case *raw, *unmodified; /* [cases]; owned */
};

/* Columns, job, which variants have no row yet. */
enum eo_code eo_variant_study_begin(struct variant_study *study, struct eo_error *error);

/* Gives what is known its place, and leaves the rest in s->missing. */
enum eo_code eo_variant_look_up(struct variant_study *study, struct eo_error *error);

/* A row for a variant, in the transaction that is open. */
enum eo_code eo_variant_keep(struct variant_study *study, int variant, struct eo_stored_variant *row, bool reused,
                             struct eo_error *error);

/* Opens a transaction when none is; commits when it has grown enough, or `now`. */
enum eo_code eo_variant_open(struct variant_study *study, struct eo_error *error);
enum eo_code eo_variant_commit(struct variant_study *study, bool now, struct eo_error *error);

/* Non-zero: stop. */
int eo_variant_report(struct variant_study *study, const char *what);

#endif
