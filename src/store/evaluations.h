/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The history: true evaluations, each once, raw values before weights. A row is never changed; its check sum is
   verified whenever it is read. Adding needs a transaction (eo_store_begin()). */
#ifndef EASEOFF_STORE_EVALUATIONS_H
#define EASEOFF_STORE_EVALUATIONS_H

#include "format/text.h"
#include "evaluation/objective.h"
#include "store/store.h"

#include <stdbool.h>

enum eo_evaluation_outcome {
  EO_EVALUATION_CONVERGED,
  EO_EVALUATION_NOT_CONVERGED, /* contact or vibration, at some load case */
  EO_EVALUATION_REFUSED,       /* the model does not take this modification */
};

enum { EO_REASON_LENGTH = 200 };

struct eo_stored_evaluation {
  int64_t id;               /* 0: not in the history */
  const char *modification; /* canonical JSON without defaults */
  enum eo_evaluation_outcome outcome;
  char reason[EO_REASON_LENGTH]; /* one sentence, "" when converged */
  double cost;                   /* time of one thread, s */
  int scenarios, cases;
  struct eo_objective_case *raw; /* [scenarios][cases]; NaN where there is no number */
};

struct eo_stored_problem {
  int64_t id;
  const char *hash;            /* SHA-256 of spec */
  const char *spec;            /* canonical JSON of all that an evaluation depends on but the modification */
  const char *name, *created;  /* for people */
  int evaluator;               /* version of the model */
  int scenarios, cases;        /* shape of its rows */
  int64_t evaluations, failed; /* rows, and those of them that did not converge */
  double cost;                 /* of all, s */
};

/* "converged", "not_converged", "refused" */
const char *eo_store_outcome_name(enum eo_evaluation_outcome outcome);
extern const char *const eo_store_outcomes[]; /* by number; ends with NULL */

/* The number of the problem with this hash, added when it is new: hash, spec, name, evaluator, scenarios and cases
   count. */
enum eo_code eo_store_find_problem(struct eo_store *store, const struct eo_stored_problem *problem, int64_t *id,
                                   struct eo_error *error);

/* Looks a modification up. row->scenarios, ->cases and ->raw (with room for them) are the caller's; the rest is filled,
   with row->id = 0 when it is not there. row->modification is not touched. */
enum eo_code eo_store_find_evaluation(struct eo_store *store, int64_t problem, const char *modification,
                                      struct eo_stored_evaluation *row, struct eo_error *error);

/* The row with a number; row->scenarios, ->cases and ->raw as above, but a row of a first look has fewer scenarios,
   which row->scenarios then says; the modification is appended to text. EO_ERROR_FILE when it is not there. */
enum eo_code eo_store_get_evaluation(struct eo_store *store, int64_t id, struct eo_stored_evaluation *row,
                                     struct eo_text *modification, struct eo_error *error);

/* Adds a row unless the modification is there already: then *row becomes what is there (somebody else was faster). Sets
   row->id. */
enum eo_code eo_store_add_evaluation(struct eo_store *store, int64_t problem, struct eo_stored_evaluation *row,
                                     struct eo_error *error);

/* Calls visit for the rows with number <= upto (0: all) in ascending order, until it returns an error. row is borrowed.
   x[size]: the point of the unit cube for which the row was computed, when that was in this space (NULL: none); else
   NULL. */
typedef enum eo_code eo_store_visit(void *context, const struct eo_stored_evaluation *row, const double *x, int size,
                                    struct eo_error *error);
enum eo_code eo_store_each_evaluation(struct eo_store *store, int64_t problem, int64_t upto, const char *space,
                                      int scenarios, int cases, eo_store_visit *visit, void *context,
                                      struct eo_error *error);

/* The largest number of a row so far. */
enum eo_code eo_store_last_evaluation(struct eo_store *store, int64_t *last, struct eo_error *error);

/* Problems in ascending order; the texts are borrowed. */
typedef enum eo_code eo_store_visit_problem(void *context, const struct eo_stored_problem *problem,
                                            struct eo_error *error);
enum eo_code eo_store_each_problem(struct eo_store *store, eo_store_visit_problem *visit, void *context,
                                   struct eo_error *error);

/* Removes a problem with its rows and jobs; rows whose check sum is wrong. *removed: how many. */
enum eo_code eo_store_remove_problem(struct eo_store *store, int64_t problem, int64_t *removed, struct eo_error *error);
/* Looks at every row: how many there are, how many do not have their sum. */
enum eo_code eo_store_count_damaged(struct eo_store *store, int64_t *rows, int64_t *wrong, struct eo_error *error);

/* Takes the rows away whose check sum is wrong; *removed: how many. */
enum eo_code eo_store_remove_damaged(struct eo_store *store, int64_t *removed, struct eo_error *error);

#endif
