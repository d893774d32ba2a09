/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The single numbers of a result document by name: the path of their keys, "load_cases.1.lte.peak_to_peak_um", rows of
   lists and numbers of pairs counted from 1. The names come from the outlines that write the document, so they are
   known before anything is evaluated. */
#ifndef EASEOFF_DOCUMENT_RESULT_SCALARS_H
#define EASEOFF_DOCUMENT_RESULT_SCALARS_H

#include "document/result.h"

enum { EO_SCALAR_NAME = 160 };

struct eo_result_number {
  char name[EO_SCALAR_NAME];
  const char *unit; /* for people, "" without */
  const char *help;
};

struct eo_scalars {
  int count;
  struct eo_result_number *scalar; /* [count], in the order of the document; owned */
  int want;                        /* EO_WANT_... that they need */
  bool objectives;                 /* all of them stand in "objectives" */
};

/* What is taken where nobody chooses: objectives, and for each load case what they are made of. */
extern const char eo_scalars_usual[];

/* The numbers whose name fits one of the patterns, which are separated by commas; * stands for anything. ends, cases:
   of the design. Left out: the design itself and what repeats it, curves, times. Root stress is computed when a pattern
   names it ("*root_stress*") or takes it from the load cases; the rating when one of its numbers is taken. Errors:
   EO_ERROR_INPUT for a pattern that fits nothing, memory. */
enum eo_code eo_scalars_init(struct eo_scalars *scalars, const char *patterns, int cases, int ends,
                             struct eo_error *error);
void eo_scalars_done(struct eo_scalars *scalars);

/* value[count] in the units of their names, from the analysis' last run; NaN where there is no number. Errors: memory.
 */
enum eo_code eo_scalars_read(const struct eo_scalars *scalars, const struct eo_analysis *analysis,
                             const struct eo_design *design, double *value, struct eo_error *error);

/* The same from what a history keeps of a design and of the same design without modification, raw[cases] each; the
   scalars stand in "objectives" and the objective is not robust. */
enum eo_code eo_scalars_of_raw(const struct eo_scalars *scalars, const struct eo_design *design,
                               const struct eo_geometry *geometry, const struct eo_objective_case *raw,
                               const struct eo_objective_case *unmodified, double *value, struct eo_error *error);

#endif
