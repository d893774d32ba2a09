/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables described for programs: what decode() accepts and encode() writes. form.h describes them for the page.
 */
#ifndef EASEOFF_FORMAT_SCHEMA_H
#define EASEOFF_FORMAT_SCHEMA_H

#include <jansson.h>

#include "format/table.h"

/* JSON Schema 2020-12 of the same object. input: absent keys take their default, unknown ones are faults; else an
   encoded object, all keys there and required. Nested tables are written out in place; a unit stands in "x-unit". NULL
   without memory. */
json_t *eo_table_json_schema(const struct eo_table *table, bool input);

#endif
