/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of an outline (outline.h says what they are for). */
#ifndef EASEOFF_FORMAT_OUTLINE_ROW_H
#define EASEOFF_FORMAT_OUTLINE_ROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <jansson.h>

#include "format/table.h"

struct eo_outline;

/* Numbers that stand somewhere else, as the document has them: a curve, or the rows of a map. */
struct eo_series {
  const double *value; /* [rows][count]; NULL: left out, which is null */
  int rows;            /* 0: one array of numbers; else an array of so many of them */
  int count;
  int lag;      /* of a cycle: begins so many values before its first one */
  double scale; /* number in SI = value times this */
  int digits;   /* significant ones */
};

/* How a row's value lies in the struct that is written. */
enum eo_outline_member {
  EO_MEMBER_NONE,    /* `write` gives it */
  EO_MEMBER_NUMBER,  /* double */
  EO_MEMBER_INTEGER, /* int, or an enum; of a word its index */
  EO_MEMBER_LONG,    /* int64_t or uint64_t */
  EO_MEMBER_FLAG,    /* bool */
  EO_MEMBER_TEXT,    /* char[] */
  EO_MEMBER_STRING,  /* const char * */
  EO_MEMBER_PART,    /* a struct that the row's outline or table writes */
  EO_MEMBER_SERIES,  /* struct eo_series */
  EO_MEMBER_JSON,    /* json_t *: what another writer made, NULL without memory; taken over */
  EO_MEMBER_ROWS,    /* pointer to `stride` bytes each, as many as the int at count_offset says: an array */
};

struct eo_outline_row {
  const char *key; /* NULL: the rows of outline stand here, of the part at offset */
  const char *shape, *help;
  const struct eo_unit *unit;       /* NULL: dimensionless, or said in help */
  const char *when;                 /* NULL: the key is always there; else when it is */
  const struct eo_outline *outline; /* object */
  const struct eo_table *table;     /* object that a field table encodes */
  const char *name;                 /* of the table's schema, or of one that stands elsewhere */
  bool sparse;                      /* table: keys with their default may be missing */
  const char *const *words;         /* word: ends with NULL */
  enum eo_outline_member member;
  size_t offset, count_offset, stride;
  bool column; /* an array: the member at column_offset of each of the rows at offset */
  size_t column_offset;
  json_t *(*write)(const void *source); /* new; NULL without memory */
  bool (*there)(const void *source);    /* NULL: always; see `when` */
  bool optional;                        /* there only where the bool at option_offset is true; see `when` */
  size_t option_offset;
  bool filled;                       /* there only where its member says something; see `when` and EO_FILLED */
  bool (*known)(const void *source); /* number: false: it means nothing and is null; NULL: always known */
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
/* ... of a member; plain ones are told by their type. */
#define EO_KIND_OF(type, member_) \
  _Generic(((type *)0)->member_, double: EO_MEMBER_NUMBER, int: EO_MEMBER_INTEGER, unsigned: EO_MEMBER_INTEGER,     \
           long: EO_MEMBER_LONG, unsigned long: EO_MEMBER_LONG, bool: EO_MEMBER_FLAG, char *: EO_MEMBER_TEXT,       \
           const char *: EO_MEMBER_STRING,          \
           struct eo_series: EO_MEMBER_SERIES, json_t *: EO_MEMBER_JSON, default: EO_MEMBER_PART)
#define EO_AT(type, member_) .offset = offsetof(type, member_), .member = EO_KIND_OF(type, member_)
/* ... that is there where a flag of the struct says so. */
#define EO_IF(type, flag_) .optional = true, .option_offset = offsetof(type, flag_)
/* ... that is there where it says something: a text that is neither NULL nor empty, an integer that is not 0, an array
   with a row. */
#define EO_FILLED .filled = true
/* ... of an array that the struct points to. */
#define EO_ROWS_AT(type, member_, count)                                                              \
  .offset = offsetof(type, member_), .count_offset = offsetof(type, count), .member = EO_MEMBER_ROWS, \
  .stride = sizeof *((type *)0)->member_
/* ... of a member of each of these: a column. */
#define EO_COLUMN_AT(type, rows_, count, row_type, member_)                                                           \
  .offset = offsetof(type, rows_), .count_offset = offsetof(type, count), .column = true, .stride = sizeof(row_type), \
  .column_offset = offsetof(row_type, member_), .member = EO_KIND_OF(row_type, member_)
#define EO_OUTLINE(name_, rows)                                                \
  {                                                                            \
    .name = name_, .count = (int)(sizeof(rows) / sizeof(rows)[0]), .row = rows \
  }

/* Row number `index` with included rows counted in place; NULL behind the last. */
const struct eo_outline_row *eo_outline_at(const struct eo_outline *outline, int index);

#endif
