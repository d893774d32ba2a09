/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the service computes from stored measurements, as documents: the comparison and the fit with the numbers of the
   measurements they are about. */
#ifndef EASEOFF_DOCUMENT_RIG_ANSWER_H
#define EASEOFF_DOCUMENT_RIG_ANSWER_H

#include <stdint.h>

#include "document/measurement_document.h"
#include "document/update_document.h"

/* A measurement that cannot be compared. */
struct eo_left_out {
  int64_t id;
  char reason[sizeof((struct eo_error *)0)->text];
};

/* Which measurements an answer is about, in its order, and which it leaves out. */
struct eo_rig_selection {
  int count, left_outs;
  int64_t *id;                  /* [count] */
  struct eo_left_out *left_out; /* [left_outs] */
};

/* Reads what is kept of a measurement for comparisons. Errors: as eo_measured_decode(). */
enum eo_code eo_rig_measured_read(const char *summary, struct eo_measured *measured, struct eo_error *error);

/* The document of eo_comparison_encode() with "program", "design_hash", the numbers as "id", and "left_out" [{id,
   reason}]; that of eo_update_encode() with "id", "left_out" and "design": the document `given` with the values found.
   Compact JSON, appended; without memory the text has failed. */
extern const struct eo_outline eo_rig_comparison_outline, eo_rig_fit_outline;
void eo_rig_comparison_write(const struct eo_rig_selection *selection, const struct eo_comparison *comparison,
                             const struct eo_measured *measured, const struct eo_design *design, struct eo_text *text);
void eo_rig_fit_write(const struct eo_rig_selection *selection, const struct eo_update *update, const char *given,
                      const struct eo_design *design, const struct eo_design *updated, struct eo_text *text);

#endif
