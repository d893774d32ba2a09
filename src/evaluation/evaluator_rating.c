/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rating of every evaluation whose objective has a limit on it. */
#include <math.h>

#include "evaluation/design_rating.h"
#include "evaluation/evaluator_private.h"

enum eo_code eo_evaluator_lean(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error)
{
  if (!evaluator->rating)
    EO_TRY(eo_design_rating_new(&evaluator->rating, evaluator->most_cases, error));
  return eo_design_rating_lean(evaluator->rating, evaluator, run->design, &run->scenario, error);
}

/* What is not rated has no safety at all, so that a limit on it is not met. */
void eo_evaluator_rate(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  struct eo_design_rating *rating = evaluator->rating;
  struct eo_objective_case *first = &evaluator->result.objective[0];
  eo_design_rating_find(rating, evaluator->pair, run->design, &evaluator->result);
  first->flank_safety = rating->rated ? fmin(rating->flank_safety, rating->flank_static) : 0;
  first->root_safety = rating->rated ? fmin(rating->root_safety, rating->root_static) : 0;
  first->film_ratio = rating->film_ratio;
  first->contact_temperature = rating->contact_temperature;
}
