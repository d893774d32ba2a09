/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every format a design is exported in: those of document/, and those of this room. */
#ifndef EASEOFF_EXCHANGE_EXPORTS_H
#define EASEOFF_EXCHANGE_EXPORTS_H

#include <jansson.h>

#include "document/design_export.h"

/* NULL after the last; NULL: there is none of this name. */
const struct eo_export *eo_exports_at(int index);
const struct eo_export *eo_exports_find(const char *name);

/* What a reader of the file has to know and would find in its comments alone, a line each: where a face is further off
   than the format promises. Nothing where there is nothing to say. */
void eo_exports_tell(const struct eo_export *format, const struct eo_text *file, struct eo_text *notes);

/* Several designs in one file, of the formats that are tables. documents: [count] of eo_design_encode(). Errors:
   EO_ERROR_INPUT for another format. */
enum eo_code eo_exports_write_many(const struct eo_export *format, const json_t *const *documents, int count,
                                   struct eo_text *text, struct eo_error *error);

#endif
