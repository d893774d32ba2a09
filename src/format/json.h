/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON text in and out, on top of jansson (RFC 8259). Reading is strict: bounded size and depth, no duplicate keys,
   every number a finite double or a 64 bit integer. Writing gives the shortest decimals that read back as the same
   doubles. */
#ifndef EASEOFF_FORMAT_JSON_H
#define EASEOFF_FORMAT_JSON_H

#include <jansson.h>

#include "base/error.h"
#include "format/text.h"
#include "format/unit.h"

enum { EO_JSON_DEPTH = 32 };                                              /* brackets within brackets */
enum { EO_JSON_DESIGN_BYTES = 1 << 20, EO_JSON_CASES_BYTES = 256 << 20 }; /* largest design, largest case file */

/* Parses size bytes whose top is an object. NULL with *error filled (line and column in the text) when it is not JSON.
   The caller owns the result. */
json_t *eo_json_parse(const char *data, size_t size, struct eo_error *error);

/* Reads and parses a file, "-" for standard input. */
json_t *eo_json_load(const char *path, size_t limit, struct eo_error *error);

enum eo_json_style {
  EO_JSON_PRETTY,    /* two spaces, in the order of insertion, short values on one line, newline at the end */
  EO_JSON_COMPACT,   /* no spaces, in the order of insertion */
  EO_JSON_CANONICAL, /* no spaces, keys sorted by their bytes: for hashes */
};
/* Adds a value to the text, which fails without memory. NaN and infinity do not occur in JSON values. */
void eo_json_write(struct eo_text *text, const json_t *value, enum eo_json_style style);

/* The same of a value that is taken over; NULL: there was no memory for it, and the text has failed. */
void eo_json_write_new(struct eo_text *text, json_t *value, enum eo_json_style style);

/* New values in the document's unit (NULL: dimensionless); what is not finite becomes null. */
json_t *eo_json_real(double value, const struct eo_unit *unit);

/* A value that should be whole: an integer where it is one that a double holds exactly, else as it is, for whoever
   reads it to refuse. NULL without memory and for what is not finite. */
json_t *eo_json_whole(double value);
/* digits: significant digits kept, for curves that people and pages read; 0 keeps all. stride: between values. With
   EO_DIGITS_READY the array as text already, which eo_json_write() alone understands: for who only writes it, at a
   fifth of the time. */
enum { EO_DIGITS_READY = 1 << 8 };
json_t *eo_json_reals(int count, const double *value, int stride, const struct eo_unit *unit, int digits);

/* What stands at a path of keys, "lte/pair_um": borrowed; NULL when it is not there. */
const json_t *eo_json_find(const json_t *value, const char *path);
/* The number there; NaN when there is none. */
double eo_json_find_number(const json_t *value, const char *path);

/* Sets object[key], a key of the program's own in UTF-8, and takes the value over; a NULL value or a failed insertion
   sets *failed (may be set before). */
void eo_json_put(json_t *object, const char *key, json_t *value, bool *failed);
/* Appends a new value to the array, which it returns; NULL, and both let go, when either is NULL or there is no memory.
 */
json_t *eo_json_append(json_t *array, json_t *value);

#endif
