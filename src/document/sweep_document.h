/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep as a request and as a document. The terminal and the server use this and nothing else.

   Document: program, design, design_hash, torque_Nm and speed_rpm (the axes), vary (what varies in place of the torque,
   null: nothing; then torque_Nm has the torque of each step), modified and unmodified, eigenfrequencies
   (damped modes of the design over torque), crossings (speeds at which mesh orders meet them), warnings. modified and
   unmodified hold by_torque  static columns over torque_Nm points     columns over all points, torque by torque: entry
   i * (number of speeds) + j belongs to torque i and speed j; the branch that an upward sweep meets down       the same
   columns as a downward sweep meets them; null when both are the same everywhere Numbers of the vibration are null
   where no periodic state was found; with one end there is no `right`. */
#ifndef EASEOFF_DOCUMENT_SWEEP_DOCUMENT_H
#define EASEOFF_DOCUMENT_SWEEP_DOCUMENT_H

#include <jansson.h>

#include "document/design_document.h"
#include "format/outline.h"
#include "format/text.h"
#include "evaluation/design_sweep.h"

enum { EO_SWEEP_MOST_STEPS = 2000, EO_SWEEP_MOST_VALUES = 200 };

/* One axis of a request, in the document's unit: {"from": A, "to": B, "points": N}. from NaN: the axis was not asked
   for. */
struct eo_sweep_range {
  double from, to; /* to NaN: from */
  int points;      /* 0: 2 when to differs from from, else 1 */
};

/* A number of the design in place of the torque, by its name in a study; in the document's unit. */
struct eo_sweep_vary {
  char key[EO_SWEEP_KEY]; /* "": none */
  struct eo_sweep_range range;
};

struct eo_sweep_request {
  struct eo_sweep_range torque, speed; /* N m, rpm */
  struct eo_sweep_vary vary;
};
extern const struct eo_table eo_sweep_request_table; /* keys torque_Nm, speed_rpm and vary */
extern const struct eo_table eo_sweep_torque_table, eo_sweep_speed_table, eo_sweep_vary_table; /* of one each */

/* The points of a request, owned; SI. */
struct eo_sweep_axes {
  int torques, speeds; /* 0: not asked for */
  double *torque, *speed;
  int steps; /* values of another number; 0: none */
  char key[EO_SWEEP_KEY];
  double *value;          /* [steps], as the document has it */
  char *base;             /* the design as it was stated, JSON; owned; needed where there are steps */
  struct eo_design *step; /* [steps], owned: eo_sweep_steps_init(), variants/; NULL until then */
};

/* Equidistant in the document's unit. Errors: EO_ERROR_INPUT with the pointer of the axis (descending, one point for
   two ends, several for one, too many, no axis at all, a torque beside another number), EO_ERROR_MEMORY. */
enum eo_code eo_sweep_axes_init(struct eo_sweep_axes *axes, const struct eo_sweep_request *request,
                                struct eo_error *error);
void eo_sweep_axes_done(struct eo_sweep_axes *axes);

extern const struct eo_outline eo_sweep_outline;

/* New document; warnings may be NULL. NULL without memory. */
json_t *eo_sweep_encode(const struct eo_sweep *sweep, const struct eo_design *design,
                        const struct eo_warnings *warnings);

/* The same as compact JSON, appended; without memory the text has failed. */
void eo_sweep_write(const struct eo_sweep *sweep, const struct eo_design *design, const struct eo_warnings *warnings,
                    struct eo_text *text);

/* For people: a line per point, eigenfrequencies and where mesh orders meet them. */
void eo_sweep_summary(const struct eo_sweep *sweep, const struct eo_design *design, const struct eo_warnings *warnings,
                      struct eo_text *text);

/* One line per point with every column of the document, CSV. */
void eo_sweep_csv(const struct eo_sweep *sweep, struct eo_text *text);

#endif
