/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of a document as tables: meaning, key, values, unit, from the outline or field table that the part is written
   by, so that no word or unit stands here again. Ends and members stand side by side. Curves, maps and histories are
   left out: they are figures. */
#ifndef EASEOFF_REPORT_SHEET_H
#define EASEOFF_REPORT_SHEET_H

#include <jansson.h>

#include "document/assumption.h"
#include "format/outline.h"
#include "format/table.h"
#include "report/page.h"

/* An object that the outline writes, with all below it; level: of headings for parts. skip: keys that are left out
   here, ends with NULL; may be NULL. */
void eo_sheet_outline(const struct eo_page *page, const struct eo_outline *outline, const json_t *object, int level,
                      const char *const *skip);

/* Which keys the user stated. */
struct eo_sheet_source {
  const struct eo_design *design; /* borrowed */
  const json_t *assumed;          /* keys that were not stated, {key, value, rule}, key a JSON pointer; borrowed */
};

/* An object that the field table encodes. source: NULL: what is stated is not said. path: of the object, "" at the top.
 */
void eo_sheet_table(const struct eo_page *page, const struct eo_table *table, const json_t *object, const char *path,
                    const struct eo_sheet_source *source);

/* The same with a heading and a table for each group of keys. */
void eo_sheet_groups(const struct eo_page *page, const struct eo_table *table, const json_t *object,
                     const struct eo_sheet_source *source);

/* The outline behind a key of an outline; NULL: there is none. */
const struct eo_outline *eo_sheet_part(const struct eo_outline *outline, const char *key);

#endif
