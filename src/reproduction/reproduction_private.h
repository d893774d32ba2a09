/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of the reproduction share. */
#ifndef EASEOFF_REPRODUCTION_REPRODUCTION_PRIVATE_H
#define EASEOFF_REPRODUCTION_REPRODUCTION_PRIVATE_H

#include "document/result_private.h"
#include "format/object.h"
#include "reproduction/reproduction.h"
#include "study/study.h"

enum { UNMODIFIED, PAPER_A, PAPER_B, OWN_A, OWN_B, VARIANTS };
enum { CASE_A, CASE_B, CASES };
enum { LAW_OURS, LAW_PAPER, LAWS }; /* tangent, secant */
enum { TORQUES = 3 };

extern const char *const eo_reproduction_variant[VARIANTS + 1]; /* ends with NULL */

struct reproduction {
  const struct eo_reproduction_plan *plan;
  const struct eo_pair *pair;
  struct eo_pair *own_pair; /* NULL: the plan has one; owned, as all below */
  struct eo_design *design[VARIANTS];
  json_t *result[VARIANTS]; /* analysis documents */
  struct eo_objective_case raw[LAWS][VARIANTS][TORQUES];
  struct eo_objective_value value[LAWS][VARIANTS];
  json_t *optimizations;     /* array */
  json_t *figures;           /* array */
  json_t *made;              /* designs side by side on pairs as made */
  double pfc[CASES];         /* of fpga, per cent; NaN: none */
  int evaluations[CASES][2]; /* true ones of fpga and ga */
  double rms_414[LAWS][2];   /* unmodified and case A, m/s2 */
  double speed_slope[2];     /* RMS at the highest over that at the lowest speed, unmodified and A */
  double speeds_better;      /* share of the speeds at which case A is quieter */
  double torques_better[2];  /* share of the torques with less LTE, less impact, case A */
};

/* Reports the work between two fractions; EO_ERROR_CANCELLED when a stop was asked for. */
enum eo_code eo_reproduction_report(const struct reproduction *reproduction, const char *what, double fraction,
                                    struct eo_error *error);

/* Both cases with each algorithm; fills design[OWN_A], design[OWN_B]. */
enum eo_code eo_reproduction_optimize(struct reproduction *reproduction, struct eo_error *error);

/* True evaluations of credibility-ga. */
int eo_reproduction_budget(const struct reproduction *reproduction);

/* The paper's optimum and ours on the same pairs as made, into made. */
enum eo_code eo_reproduction_made(struct reproduction *reproduction, struct eo_error *error);

/* Figures 8 to 12, 14, 15, 17 and 18. */
enum eo_code eo_reproduction_figures(struct reproduction *reproduction, struct eo_error *error);

/* A figure while its series come: begun, one series after the other, then added to the document. */
struct figure {
  const char *number, *title, *x_label, *y_label;
  bool from_zero;        /* the y axis */
  struct eo_object list; /* of series */
};
struct figure eo_reproduction_figure(const char *number, const char *title, const char *x_label, const char *y_label,
                                     bool from_zero);
void eo_reproduction_series(struct figure *figure, const char *name, int count, const double *x, const double *y,
                            bool dots); /* x, y: [count] */
/* So many of them, which are ended, whatever comes of it. */
enum eo_code eo_reproduction_add_figures(struct reproduction *reproduction, int count, struct figure *figure,
                                         struct eo_error *error);

json_t *eo_reproduction_table(const struct reproduction *reproduction); /* Table 3 */
json_t *eo_reproduction_comparisons(const struct reproduction *reproduction);
json_t *eo_reproduction_readings(void);

/* Rows of the document's arrays. */
extern const struct eo_outline eo_reproduction_parameter_outline;  /* of Table 3 */
extern const struct eo_outline eo_reproduction_comparison_outline; /* a printed number and ours */
extern const struct eo_outline eo_reproduction_run_outline;        /* an optimization */
extern const struct eo_outline eo_reproduction_figure_outline;
extern const struct eo_outline eo_reproduction_assumption_outline; /* one of the sensitivity */

/* One assumption changed at a time; NULL on failure, with the code. */
enum eo_code eo_reproduction_sensitivity(struct reproduction *reproduction, json_t **rows, struct eo_error *error);

#endif
