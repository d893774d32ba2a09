/* Outlines: what stands in a document that code writes. One outline per object, beside the function that writes it, its
   rows in the order of writing. The writer opens the object with its outline (object.h) and can then put nothing
   that is not in it, nor leave out what is; the API's description comes from the same rows.

   shape: the short notation of http/shape.h without names: number, integer, flag, text, word (one of words), object (of
   outline or table), [array], one|or another; `?` behind any of them: or null. */
#ifndef EASEOFF_FORMAT_OUTLINE_H
#define EASEOFF_FORMAT_OUTLINE_H

#include <stdbool.h>

#include <jansson.h>

#include "format/table.h"

struct eo_outline;

struct eo_outline_row {
  const char *key; /* NULL: the rows of outline stand here */
  const char *shape, *help;
  const struct eo_unit *unit;       /* NULL: dimensionless, or said in help */
  const char *when;                 /* NULL: the key is always there; else when it is */
  const struct eo_outline *outline; /* object */
  const struct eo_table *table;     /* object that a field table encodes */
  const char *name;                 /* of the table's schema */
  bool sparse;                      /* table: keys with their default may be missing */
  const char *const *words;         /* word: ends with NULL */
};

struct eo_outline {
  const char *name; /* of its schema */
  int count;
  const struct eo_outline_row *row;
};
/* A row: key, shape, help, and what else there is, as .unit = ... */
#define EO_KEY(key_, shape_, ...)                     \
  {                                                   \
    .key = key_, .shape = shape_, .help = __VA_ARGS__ \
  }
#define EO_OUTLINE(name_, rows)                                                \
  {                                                                            \
    .name = name_, .count = (int)(sizeof(rows) / sizeof(rows)[0]), .row = rows \
  }

/* Row number `index` with included rows counted in place; NULL behind the last. */
const struct eo_outline_row *eo_outline_at(const struct eo_outline *outline, int index);

/* What an outline names of a document that has more; the result shares its values. New; NULL without memory. */
json_t *eo_outline_take(const struct eo_outline *outline, const json_t *document);

/* Adds the JSON Schema 2020-12 of the outline and of all below it to `schemas`, each under its name; objects below are
   "$ref" to
   "#/components/schemas/NAME". Schemas are open: more keys may come with later versions. A row's unit stands in
   "x-unit", as people write it. False without memory. */
bool eo_outline_add_schemas(const struct eo_outline *outline, json_t *schemas);

#endif
