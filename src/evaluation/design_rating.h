/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rating of a design beside its evaluation: the load distribution with the helix slope tolerances laid on, the
   factors of ISO 6336 per load case, end and member, the load cases as a spectrum, and the tribology of every end. */
#ifndef EASEOFF_EVALUATION_DESIGN_RATING_H
#define EASEOFF_EVALUATION_DESIGN_RATING_H

#include "evaluation/evaluator.h"
#include "rating/gear_rating.h"
#include "rating/tribology.h"

/* K_Hbeta of one end at one load case. */
struct eo_face_factors {
  double nominal;    /* of the flanks and the alignment as designed */
  double leaning[2]; /* with f_ma laid on as a helix slope of the pinion, in each direction */
  double worse;      /* the larger of these two */
};

struct eo_case_rating {
  struct eo_face_factors face[2];   /* [end] */
  double sharing[2];                /* [end] K_gamma: its mean load over that of an even share */
  struct eo_rated_case end[2];      /* [end]; meaningless unless the design is rated */
  struct eo_tribology tribology[2]; /* [end] */
};

struct eo_design_rating {
  bool rated;             /* false: `reason` says why ISO 6336 gives no rating; tribology is there all the same */
  struct eo_error reason; /* with the pointer of the key */
  int ends, cases, most_cases;
  double share[2];                  /* [end] of the torque, as both stand even: a half each of equal helices */
  struct eo_rating_basis basis[2];  /* [end] alike but for the faces of halves of unequal width */
  struct eo_case_rating *load_case; /* [cases] */
  struct eo_rated_spectrum end[2];
  /* What decides: least S_H and S_F of the spectrum, and of the static strength, over members and ends. */
  double flank_safety, root_safety, flank_static, root_static;
  double time;                            /* s: of all load cases, hours as stated or the required life */
  double life;                            /* s: least life at S_min */
  double film_ratio, contact_temperature; /* least and largest over load cases and ends */
};

/* Room for so many load cases. Errors: memory. */
enum eo_code eo_design_rating_new(struct eo_design_rating **rating, int most_cases, struct eo_error *error);
void eo_design_rating_free(struct eo_design_rating *rating);

/* scenario: NULL for the nominal alignment. First: the load distribution with f_ma laid on, two contact analyses on an
   evaluator whose own result is lost. Errors: of the evaluator. A pair that ISO 6336 does not rate gets nominal
   distributions alone. */
enum eo_code eo_design_rating_lean(struct eo_design_rating *rating, struct eo_evaluator *evaluator,
                                   const struct eo_design *design, const struct eo_scenario *scenario,
                                   struct eo_error *error);

/* Then: from the evaluation of the design at its nominal alignment. */
void eo_design_rating_find(struct eo_design_rating *rating, const struct eo_pair *pair, const struct eo_design *design,
                           const struct eo_evaluation *evaluation);

#endif
