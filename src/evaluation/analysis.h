/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One analysis: a design and the same design without modification on one prepared pair, down to J and the fitness. The
   terminal and the server call this; optimizers work with evaluators alone. One per thread. */
#ifndef EASEOFF_EVALUATION_ANALYSIS_H
#define EASEOFF_EVALUATION_ANALYSIS_H

#include "evaluation/design_rating.h"
#include "evaluation/evaluator.h"
#include "evaluation/pitch_analysis.h"

struct eo_analysis {
  const struct eo_pair *pair;               /* borrowed */
  struct eo_evaluator *evaluator;           /* owned; NULL before the first run */
  const struct eo_evaluation *evaluation;   /* of the design at its nominal alignment; valid until the next run */
  struct eo_design_rating *rating;          /* owned; NULL unless EO_WANT_RATING was ever asked for */
  struct eo_evaluator *leaning;             /* owned, of the rating: keeps what the evaluator has solved */
  struct eo_pitch_analysis pitch;           /* owned; no cases unless the last run was asked for it */
  int cases, scenarios, want;               /* of the last run; want: as asked for */
  bool root;                                /* root stresses are there */
  struct eo_objective_case *unmodified;     /* [cases], without modification, nominal */
  struct eo_objective_case *raw;            /* [scenarios][cases], of the design: what J is made of */
  struct eo_objective_case *raw_unmodified; /* [scenarios][cases] */
  struct eo_objective_value value, unmodified_value;
  double rating_ms;                /* of the rating, beside these: */
  double unmodified_ms, design_ms; /* wall time; unmodified_ms is 0 when it was known from the run before */
  struct eo_design *known;         /* owned: the design without modification that the unmodified values belong to */
  int most_cases, most_scenarios;
  bool known_root;
  int threads; /* that one run may use: 1 or 2; may be set between runs, the numbers do not depend on it */
  const struct eo_progress *progress; /* borrowed; NULL: nobody watches. Single teeth alone ask it, the rest of a run is
                                         over before it would */
};

/* pair: borrowed for as long as the analysis lives. One thread at a time. Errors: memory. */
enum eo_code eo_analysis_new(struct eo_analysis **analysis, const struct eo_pair *pair, struct eo_error *error);
void eo_analysis_free(struct eo_analysis *analysis);

/* design: resolved, served by the pair (see eo_pair_serves()). want: EO_WANT_..., for the design; the unmodified pair
   gets its root stress when the design does. What the last run found out about the unmodified pair is used again while
   nothing but the modification, the name and the optimization changes; the numbers are the same either way. Errors:
   those of eo_evaluator_run(), cancelled. */
enum eo_code eo_analysis_run(struct eo_analysis *analysis, const struct eo_design *design, int want,
                             struct eo_error *error);

#endif
