/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a design's user did not state, the value that was taken, and by which rule: the one list of a result. */
#ifndef EASEOFF_DOCUMENT_ASSUMPTION_H
#define EASEOFF_DOCUMENT_ASSUMPTION_H

#include <jansson.h>

#include "document/design_document.h"
#include "format/outline.h"

/* Of one assumption. */
extern const struct eo_outline eo_outline_assumption;

/* Notes in design->stated which keys a document states; a null is no statement. */
void eo_assumptions_note(const json_t *document, struct eo_design *design);

/* The keys of gear pair, material, alignment, supports, elastic shafts, resolution and rating that are not stated, in
   the order of the document, and what else was taken where nothing is said: flanks, shares. design: complete.
   rating: with the keys of that block. New array; NULL without memory. */
json_t *eo_assumptions_encode(const struct eo_design *design, bool rating);

/* Whether the list above would name the key with this pointer if it were not stated. */
bool eo_assumptions_cover(const struct eo_design *design, const char *pointer);

#endif
