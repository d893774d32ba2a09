/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables described for a form: what decode() accepts, field by field, nested tables in place. */
#ifndef EASEOFF_FORMAT_FORM_H
#define EASEOFF_FORMAT_FORM_H

#include <jansson.h>

#include "format/outline.h"

/* What does not apply to a field is left out. unit: suffix of the key; low, high: of a number, of each number, or of
   the number of rows; default: as the document would say it, null: see derived. */
extern const struct eo_outline eo_fields_outline; /* of a struct eo_table */

/* New; NULL without memory. */
json_t *eo_table_fields(const struct eo_table *table);

#endif
