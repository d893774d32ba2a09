/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of studies: evaluated designs with the numbers that were chosen of their results, each once, and which of them a
   study has in which place. A row is never changed; its check sum is verified whenever it is read. Adding needs a
   transaction (eo_store_begin()). */
#ifndef EASEOFF_STORE_VARIANT_ROWS_H
#define EASEOFF_STORE_VARIANT_ROWS_H

#include "store/evaluations.h"

struct eo_stored_variant {
  int64_t id;         /* 0: it is not there */
  const char *design; /* hash of what was evaluated */
  int evaluator;      /* version of the model */
  int64_t columns;
  enum eo_evaluation_outcome outcome;
  char reason[EO_REASON_LENGTH]; /* one sentence, "" when converged */
  double cost;                   /* s of a processor */
  int numbers;
  double *number; /* [numbers], the caller's; NaN: none; all of a row that was refused */
  int ordinal;    /* of a study */
  bool reused;    /* known before the study asked */
};

/* The number of a list of columns (JSON array of names), added when it is new. */
enum eo_code eo_store_variant_columns(struct eo_store *store, const char *names, int64_t *id, struct eo_error *error);

/* Whether there is any row of an evaluator with these columns: else nothing needs to be looked up. */
enum eo_code eo_store_has_variants(struct eo_store *store, int evaluator, int64_t columns, bool *there,
                                   struct eo_error *error);

/* Looks up design, evaluator and columns of *row, numbers and the room for them are the caller's; the rest is filled,
   with id 0 when it is not there. */
enum eo_code eo_store_find_variant(struct eo_store *store, struct eo_stored_variant *row, struct eo_error *error);

/* Adds a row unless the design is there already: then *row becomes what is there. Sets row->id. */
enum eo_code eo_store_add_variant(struct eo_store *store, struct eo_stored_variant *row, struct eo_error *error);

/* Removes rows of other versions of the model than this one (0: of none) and, unused, those that no job has; in steps
   between which others can write. *removed counts on. */
enum eo_code eo_store_remove_variants(struct eo_store *store, int evaluator, bool unused, int64_t *removed,
                                      struct eo_error *error);

/* Mean time of the newest rows, s of a processor; NaN: there is none. */
enum eo_code eo_store_mean_cost(struct eo_store *store, double *seconds, struct eo_error *error);

/* Puts a row into its place of a study; what stands there stays. */
enum eo_code eo_store_log_variant(struct eo_store *store, int64_t job, int ordinal, int64_t row, bool reused,
                                  struct eo_error *error);

/* Places of a study that have a row, ascending; those of one place (ordinal >= 0) or all (-1). numbers: per row, or -1:
   numbers and check sums are not looked at (number NULL). row is borrowed. */
typedef enum eo_code eo_store_visit_variant(void *context, const struct eo_stored_variant *row, struct eo_error *error);
enum eo_code eo_store_each_variant(struct eo_store *store, int64_t job, int ordinal, int numbers,
                                   eo_store_visit_variant *visit, void *context, struct eo_error *error);

#endif
