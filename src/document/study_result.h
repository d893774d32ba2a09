/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an optimization gives: plain values, and the document that the terminal and the server show.

   Top level: program, design (every default resolved), job, algorithm, seed, variables (name, bounds, unmodified and
   best value), best { modification, objectives, reductions_percent (per load case), result: the result document of the
   best design }, unmodified, individuals, true_evaluations (fitness values that needed the model), reused_evaluations
   (those of them that the history knew before the study asked), failed_evaluations, predicted_individuals,
   repeated_individuals (equal to an earlier one), imported_rows, pfc_percent, generations [best, mean, true, predicted
   ...], front (nsga2), stopped, warnings, run (with best/result/timing_ms the only part that differs between two runs,
   or between a run and the same run interrupted and taken up). */
#ifndef EASEOFF_DOCUMENT_STUDY_RESULT_H
#define EASEOFF_DOCUMENT_STUDY_RESULT_H

#include <jansson.h>

#include "document/design_document.h"
#include "document/made_check_document.h"
#include "format/outline.h"
#include "document/search_space.h"
#include "evaluation/objective.h"

enum eo_study_stop { EO_STOP_BUDGET, EO_STOP_CONVERGED, EO_STOP_CANCELLED };

/* One true row. */
struct eo_study_point {
  bool there;         /* false: nothing was evaluated yet */
  int64_t evaluation; /* its number in the history */
  struct eo_modification modification;
  struct eo_objective_value value; /* with the weights of this study */
  double rank;                     /* what was minimised: J + penalties */
  struct eo_objective_case *raw;   /* [scenarios][cases]; owned */
};

/* One generation (ga, fpga), batch (credibility-ga) or cycle (nsga2). */
struct eo_study_generation {
  int true_count, predicted_count, repeated_count; /* repeated: equal to an individual evaluated before */
  int history_rows, epoch;
  double best, mean; /* of J + penalties: so far; of this generation's true rows that converged */
};

struct eo_study_result {
  int64_t job;
  bool resumed;
  enum eo_study_stop stopped;
  struct eo_study_space space;
  int scenarios, cases;
  struct eo_study_point unmodified, best;
  int individuals, true_evaluations, predicted, repeated;
  int reused, failed,
      imported; /* true evaluations the history knew before; that did not converge; rows known at the start */
  int computed; /* by this process */
  int generations;
  struct eo_study_generation *generation; /* [generations]; owned, as all below */
  int whole;                       /* rows told with all pairs as made; the others with the first of them alone */
  int front_count, knee, weighted; /* nsga2; indices into front, -1: none */
  struct eo_study_point *front;    /* [front_count], without raw values */
  struct eo_made_check check;      /* of what was found; pairs 0: none */
  double seconds;                  /* wall */
  double model_seconds;            /* of it, while the model computed */
  double store_seconds, optimizer_seconds;
  int threads;
};

void eo_study_result_done(struct eo_study_result *result);

/* "budget", "converged", "cancelled" */
const char *eo_study_stop_name(enum eo_study_stop stop);
extern const char *const eo_study_stops[]; /* by number; ends with NULL */

extern const struct eo_outline eo_study_outline;

/* New document. analysis: result document of the best design (borrowed; NULL: none); warnings may be NULL. NULL without
   memory. */
json_t *eo_study_result_encode(const struct eo_study_result *result, const struct eo_design *design,
                               const json_t *analysis, const struct eo_warnings *warnings);

/* For people: variables, objectives and load cases unmodified and optimal, what it took. */
void eo_study_result_summary(const json_t *document, struct eo_text *text);

/* The front of such a document as CSV: the axes, f1 to f3, J, the violation, which point is the knee and which has the
   least J, and the variables. False: it has none. */
bool eo_study_front_csv(const json_t *document, struct eo_text *text);

#endif
