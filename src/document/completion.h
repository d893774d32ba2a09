/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A design made complete: every derived value, what stands on its drawing, and what was assumed. */
#ifndef EASEOFF_DOCUMENT_COMPLETION_H
#define EASEOFF_DOCUMENT_COMPLETION_H

#include <jansson.h>

#include "document/design_document.h"
#include "format/outline.h"

extern const struct eo_outline eo_outline_completion;
extern const struct eo_outline eo_outline_dimensions; /* of the pair, as a part of results too */

/* design: complete, of the geometry. New documents; NULL without memory. */
json_t *eo_completion_encode(const struct eo_design *design, const struct eo_geometry *geometry,
                             const struct eo_warnings *warnings);
json_t *eo_dimensions_encode(const struct eo_gear_pair *pair, const struct eo_geometry *geometry);

/* The completion for people, in mm or as eo_inch_from_mm() has it. */
void eo_completion_summary(const json_t *completion, struct eo_text *text);

#endif
