/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What J is made of, for a search that models the parts: of every load case (and scenario) the transmission error whose
   range is f1's, the impacts whose largest is f2's, and the RMS. */
#ifndef EASEOFF_EVALUATION_OBJECTIVE_ANATOMY_H
#define EASEOFF_EVALUATION_OBJECTIVE_ANATOMY_H

#include "evaluation/objective.h"
#include "optimizer/anatomy.h"

/* Of eo_evaluator_combine() for this design, but for penalties. unmodified: [scenarios][cases]. Without parts where the
   value is no sum over them: the worst of several scenarios. anatomy->group is the caller's to free. */
enum eo_code eo_objective_anatomy(const struct eo_design *design, int scenarios,
                                  const struct eo_objective_case *unmodified, struct eo_anatomy *anatomy,
                                  struct eo_error *error);

/* parts[anatomy.parts] from raw[rows], rows: scenarios times cases. */
void eo_objective_parts(const struct eo_objective_case *raw, int rows, double *parts);

#endif
