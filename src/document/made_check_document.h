/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Designs side by side on the same pairs as made, as a document and for people. */
#ifndef EASEOFF_DOCUMENT_MADE_CHECK_DOCUMENT_H
#define EASEOFF_DOCUMENT_MADE_CHECK_DOCUMENT_H

#include <jansson.h>

#include "design/design.h"
#include "format/outline.h"
#include "format/text.h"
#include "format/text_table.h"

/* J, f1, f2, f3 and the objective's terms of a pair. */
enum { EO_MADE_SUMS = 4, EO_MADE_NUMBERS = EO_MADE_SUMS + EO_MAX_OBJECTIVE_TERMS, EO_MADE_DESIGNS = 4 };

/* Design 0 is the unmodified pair. */
struct eo_made_check {
  int designs, pairs, numbers, skipped; /* skipped: pairs that the search has seen */
  double *value; /* [designs][pairs][numbers]; f in SI, J of a pair in that of the unmodified pair as made alike; NaN:
                    it did not converge; owned, as below */
  bool *worse;   /* [designs][pairs]: in swing, impact or vibration at some load case, than the unmodified pair */
  char name[EO_MADE_DESIGNS + 1][64];
};

void eo_made_check_done(struct eo_made_check *check);

extern const struct eo_outline eo_made_check_outline;
/* New document; NULL without memory. design: whose objective has the terms. */
json_t *eo_made_check_encode(const struct eo_made_check *check, const struct eo_design *design);

/* Rows of mean and percentiles, design by design; of the shares that are worse. */
void eo_made_check_table(const json_t *document, int digits, struct eo_text_table *sheet);
void eo_made_check_shares(const json_t *document, struct eo_text_table *sheet);
/* For people: percentiles of J and the shares that are worse, design by design. */
void eo_made_check_summary(const json_t *document, struct eo_text *text);

#endif
