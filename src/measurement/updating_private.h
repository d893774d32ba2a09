/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fit of inputs from the inside: updating.c evaluates, updating_search.c looks for minima, updating_profile.c says
   how far the data let an input go. Everything happens in the unit cube of the ranges. */
#ifndef EASEOFF_MEASUREMENT_UPDATING_PRIVATE_H
#define EASEOFF_MEASUREMENT_UPDATING_PRIVATE_H

#include "measurement/updating.h"

enum { EO_FIT_EVALUATORS = 8 };

struct eo_fit {
  const struct eo_design *design;
  const struct eo_measured *measured;
  const struct eo_update_settings *settings;
  const struct eo_progress *progress;
  struct eo_pair pair; /* with an impact patch of its own */
  int evaluators;
  struct eo_evaluator *evaluator[EO_FIT_EVALUATORS]; /* on it, one for each loaded contact: supports and damping leave
                                                        it as it was, and then it is not solved again */
  struct eo_design trial;
  int with[EO_MOST_MEASURED];  /* evaluator of each place in the order */
  int order[EO_MOST_MEASURED]; /* measurements with the same loaded contact after each other: the evaluator solves it
                                  once */
  int count, residuals, evaluations;
  double model_error; /* in parts of the measured RMS */
  const char *stage;  /* for progress: what, and from which to which part of all */
  double from, to;
  int begun, expected; /* evaluations when the stage began, and in it */
  double *predicted;   /* owned, [residuals]: accelerations of the last evaluation, 0 where no state was found */
};

/* A place where the misfit has a minimum. */
struct eo_minimum {
  double x[EO_UNKNOWNS];
  double square; /* sum of the squared residuals */
  bool converged;
};

struct eo_minima {
  int count; /* the lowest first */
  struct eo_minimum minimum[EO_UPDATE_MINIMA];
};

/* The residuals at x[unknowns]: (measured - predicted) / standard deviation. */
enum eo_code eo_fit_residuals(void *context, const double *x, double *residual, struct eo_error *error);
void eo_fit_begin(struct eo_fit *fit, const char *stage, double from, double to, int expected);
void eo_fit_set_trial(struct eo_fit *fit, const double *x);
double eo_fit_from_unit(const struct eo_update_range *range, double x);
double eo_fit_to_unit(const struct eo_update_range *range, double value);

/* Points spread over all ranges; from the promising ones downhill. minima: none within a thousandth of another. before:
   sum of the squared residuals of the design as it is. Errors: of the evaluation, memory, cancelled. */
enum eo_code eo_fit_search(struct eo_fit *fit, int starts, struct eo_minima *minima, double *before,
                           struct eo_error *error);

/* Downhill again from every minimum with the model error of now. */
enum eo_code eo_fit_refine(struct eo_fit *fit, struct eo_minima *minima, struct eo_error *error);

/* How far unknown i may go from a minimum while the sum of squares, least over all other unknowns, stays below `limit`:
   reach[2] in the unit cube. */
enum eo_code eo_fit_profile(struct eo_fit *fit, const struct eo_minimum *minimum, int i, double sigma, double limit,
                            double reach[2], struct eo_error *error);

#endif
