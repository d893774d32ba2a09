/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flank tolerances by ISO 1328-1 as an export: edition and grade of the rating. */
#ifndef EASEOFF_DOCUMENT_TOLERANCE_EXPORT_H
#define EASEOFF_DOCUMENT_TOLERANCE_EXPORT_H

#include "design/design.h"
#include "format/text.h"
#include "gear/geometry.h"

/* A row for each quantity of each member; what has no value says why. */
void eo_tolerances_csv(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text);

#endif
