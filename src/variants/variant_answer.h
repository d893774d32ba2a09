/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the evaluation of one variant gives, as it travels between processes. */
#ifndef EASEOFF_VARIANTS_VARIANT_ANSWER_H
#define EASEOFF_VARIANTS_VARIANT_ANSWER_H

#include "evaluation/objective.h"
#include "format/text.h"
#include "store/evaluations.h"

struct eo_variant_answer {
  enum eo_evaluation_outcome outcome;
  char reason[EO_REASON_LENGTH]; /* one sentence, "" when converged */
  double cost;                   /* s of the processor, without the preparation of its pair */
  int numbers, cases;
  const double *number;                /* [numbers], of the chosen columns; NaN: none */
  const struct eo_objective_case *raw; /* [cases], nominal, for the history */
  const char *modification;            /* canonical JSON without defaults; "": refused */
};

/* Appends it; without memory the text has failed. */
void eo_variant_answer_write(const struct eo_variant_answer *answer, struct eo_text *text);

/* The way back, all of it in `room` (freed by the caller). False: it is no answer, or no memory. */
bool eo_variant_answer_read(struct eo_variant_answer *answer, const char *bytes, size_t size, void **room);

#endif
