/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is measured on both members and between them as an export. */
#ifndef EASEOFF_DOCUMENT_DIMENSIONS_EXPORT_H
#define EASEOFF_DOCUMENT_DIMENSIONS_EXPORT_H

#include "design/design.h"
#include "format/text.h"
#include "gear/geometry.h"

/* A row for each value with its symbol and unit, where it differs one for each limit of the tooth thickness; what has
   no value says why. */
void eo_dimensions_csv(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text);

#endif
