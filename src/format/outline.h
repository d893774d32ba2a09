/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Outlines: what stands in a document that the program writes, one outline per object, its rows in the order of
   writing. A row says of which member of a struct its value is, or names the function that writes it; so the same row
   writes a key (eo_outline_encode()) and describes it in the API; there is no other way to write an answer that has an
   outline. A document that several threads write has an outline for each part, and one of all that includes them.

   shape: number, integer, flag, text, word (one of words), any, object (of outline, of table, or `name`), [array],
   {object whose keys are data}, one|or another; `?` behind any of them: or null. Numbers are written with
   EO_DIGITS_NUMBER digits in the row's unit, NaN as null; of an empty text? and a negative word? it is null too;
   `integer` of a double member is its whole number. A writer fills a struct of its own with what the rows name, numbers
   and curves and parts that others made, and has it written. */
#ifndef EASEOFF_FORMAT_OUTLINE_H
#define EASEOFF_FORMAT_OUTLINE_H

#include <jansson.h>

#include "format/outline_row.h"

struct eo_object;

/* A new object with every row of the outline that is there, from the struct it is about; NULL without memory, when a
   row says neither member nor function, and when one is not there that does not say `when` it is. */
json_t *eo_outline_encode(const struct eo_outline *outline, const void *source);

/* The same into an object that is open. */
void eo_outline_put(struct eo_object *object, const struct eo_outline *outline, const void *source);

/* One array of numbers; value NULL: left out. */
struct eo_series eo_series_of(int count, const double *value, int digits);

/* What an outline names of a document that has more; the result shares its values. New; NULL without memory, and when a
   row is missing that does not say `when` it is there. */
json_t *eo_outline_take(const struct eo_outline *outline, const json_t *document);

/* Adds the JSON Schema 2020-12 of the outline and of all below it to `schemas`, each under its name; objects below are
   "$ref" to
   "#/components/schemas/NAME". Schemas are open: more keys may come with later versions. A row's unit stands in
   "x-unit", as people write it. False without memory. */
bool eo_outline_add_schemas(const struct eo_outline *outline, json_t *schemas);

#endif
