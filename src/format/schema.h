/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables described for programs: the page's form and the API's description. Both say what decode() accepts and
   encode() writes. */
#ifndef EASEOFF_FORMAT_SCHEMA_H
#define EASEOFF_FORMAT_SCHEMA_H

#include <jansson.h>

#include "format/table.h"

/* { "name", "fields": [ { "key", "kind": "number|integer|flag|text|choice|numbers|limit|object|list|series|seed",
   "unit", "symbol", "low", "high", "default", "choices", "count", "help", "required", "nullable", "derived", "fields" }
   ] }. unit: suffix of the key; low, high: of a number, of each number, or of the number of rows (series: number_low,
   number_high of each number); what does not apply is left out. default: as the document would say it, null: see
   derived. NULL without memory. */
json_t *eo_table_fields(const struct eo_table *table);

/* JSON Schema 2020-12 of the same object. input: absent keys take their default, unknown ones are faults; else an
   encoded object, all keys there and required. Nested tables are written out in place; a unit stands in "x-unit". NULL
   without memory. */
json_t *eo_table_json_schema(const struct eo_table *table, bool input);

#endif
