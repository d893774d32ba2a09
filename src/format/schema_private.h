/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the form and the JSON Schema of a field table say in common. */
#ifndef EASEOFF_FORMAT_SCHEMA_PRIVATE_H
#define EASEOFF_FORMAT_SCHEMA_PRIVATE_H

#include <stdbool.h>

#include <jansson.h>

#include "format/table.h"

/* What the document says where every key is absent: the defaults, as the tables themselves write them. New; NULL
   without memory. */
json_t *eo_schema_defaults(const struct eo_table *table);

/* Whether a document may leave the key out, and what then holds can be written down. */
bool eo_schema_has_default(const struct eo_field *field);

/* Of these; null for what is read and never written. New; NULL without memory. */
json_t *eo_schema_default(const struct eo_field *field, const json_t *defaults);

/* A finite end of a range: a whole number reads 17, not 17.0. New; NULL without memory. */
json_t *eo_schema_bound(double bound);

/* text: ends with NULL. New; NULL without memory. */
json_t *eo_schema_texts(const char *const *text);

#endif
