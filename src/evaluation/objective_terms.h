/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Terms and limits of the objective beyond f1, f2, f3: any number of evaluation/scalar.h, of one state of the pair or
   as a percentile over the states of a robust objective. */
#ifndef EASEOFF_EVALUATION_OBJECTIVE_TERMS_H
#define EASEOFF_EVALUATION_OBJECTIVE_TERMS_H

#include "evaluation/objective.h"

/* Errors: EO_ERROR_INPUT with the key (nothing to minimise, a load case or an end that is not there, a percentile of
   one state, axes of a front that the objective does not have). */
enum eo_code eo_objective_check(const struct eo_design *design, struct eo_error *error);

/* Whether raw values have to hold their numbers, and whether one of these is the root stress. */
bool eo_objective_wants_scalars(const struct eo_objective *objective);
bool eo_objective_wants_root(const struct eo_objective *objective);

/* False: a number that a term or a limit asks for is not there. */
bool eo_objective_has_scalars(const struct eo_objective *objective, int cases, const struct eo_objective_case *value);

/* Fills value->term, and adds to J the terms, to the violation the limits, that are no percentiles: of one state.
   before: the unmodified pair in the same state. */
void eo_objective_add_terms(const struct eo_objective *objective, int cases, const struct eo_load_case *load_case,
                            const struct eo_objective_case *of, const struct eo_objective_case *before,
                            struct eo_objective_value *value);

/* The same of those that are percentiles, over states: of[states][cases], before likewise. */
void eo_objective_add_percentiles(const struct eo_objective *objective, int states, int cases,
                                  const struct eo_load_case *load_case, const struct eo_objective_case *of,
                                  const struct eo_objective_case *before, struct eo_objective_value *value);

/* What a Pareto front is over: axis[design->optimization.search.objectives]. before: of the unmodified pair. */
void eo_front_values(const struct eo_design *design, const struct eo_objective_value *value,
                     const struct eo_objective_value *before, double *axis);
/* Their names for people: "J of the nominal pair". */
void eo_front_axis_name(const struct eo_design *design, int axis, char *name, size_t size);

/* By how much of a limit a value exceeds it; 0: it does not, or the limit is NaN. */
double eo_objective_excess(double limit, double value);

#endif
