/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables: one table per struct says how its members stand in a JSON object. The same table decodes, encodes,
   checks ranges, fills in defaults and describes itself (the page's form, the API's description, --help). Units are
   converted here and nowhere else. */
#ifndef EASEOFF_FORMAT_TABLE_H
#define EASEOFF_FORMAT_TABLE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include <jansson.h>

#include "format/faults.h"
#include "format/text.h"
#include "format/unit.h"

enum eo_field_kind {
  EO_FIELD_NUMBER,   /* double */
  EO_FIELD_INTEGER,  /* int; null (when nullable) is 0 */
  EO_FIELD_SEED,     /* uint64_t, up to 2^53 - 1 so that every JSON reader keeps it */
  EO_FIELD_FLAG,     /* bool */
  EO_FIELD_TEXT,     /* char[count]; with choices: one of them */
  EO_FIELD_CHOICE,   /* an enum whose values are the indices of choices */
  EO_FIELD_NUMBERS,  /* double[count] */
  EO_FIELD_OBJECT,   /* a struct with its own table */
  EO_FIELD_LIST,     /* array of structs with their own table; the number of rows stands in an int at count_offset */
  EO_FIELD_SERIES,   /* struct eo_numbers */
  EO_FIELD_MATRIX,   /* struct eo_matrix */
  EO_FIELD_DOCUMENT, /* const json_t *: an object that somebody else reads, borrowed from what is decoded; NULL: absent
                      */
  EO_FIELD_NAMES,    /* char[count][room]: names; a whole number from low to high is one in digits */
};

enum {
  EO_FIELD_REQUIRED = 1,  /* no default */
  EO_FIELD_NULLABLE = 2,  /* null is allowed: NaN inside (OBJECT: see count_offset); `derived` says what it means */
  EO_FIELD_ASCENDING = 4, /* NUMBERS: strictly increasing */
  EO_FIELD_OMIT =
      8, /* OBJECT: left out of the encoded document while everything in it has its default; LIST: while empty */
  EO_FIELD_SOMETIMES = 16,  /* OBJECT: whoever encodes the document may take it out; said in the schema alone */
  EO_FIELD_WHOLE = 32,      /* NUMBER, SERIES: whole numbers alone */
  EO_FIELD_ENTRY = 64,      /* read and never written: another way to say what a key beside it holds */
  EO_FIELD_ELSEWHERE = 128, /* other code reads and writes it: here it is known and described alone */
  EO_FIELD_ALONE = 256,     /* NUMBERS, NAMES, nullable: one that is in no array stands for all numbers, for the first
                               name; null in an array is a number or a name that is not stated */
};

/* A list of numbers of any length. */
struct eo_numbers {
  int count;
  double *value; /* [count], owned by the struct the table fills: eo_table_done() frees it */
};

/* Numbers in rows of one length. */
struct eo_matrix {
  int rows, columns;
  double *value; /* [rows][columns], owned as in a list of numbers */
};

struct eo_table;

struct eo_field {
  const char *key;
  const char *alias;   /* another name under which the key is taken; NULL: none. Faults name the key */
  double alias_factor; /* NUMBER: times which a number under that name is taken; 0: as it is */
  enum eo_field_kind kind;
  unsigned flags;
  size_t offset;
  const struct eo_unit *unit; /* NULL: dimensionless */
  double low, high; /* inclusive, in the document's unit; of a LIST, SERIES or MATRIX: number of rows; see `series_*`;
                       TEXT: low is the least number of bytes */
  double fallback;  /* default in the document's unit; NaN: null. CHOICE: the index, FLAG: 0 or 1 */
  const double *fallbacks;    /* NUMBERS: [count]; NULL: null. NUMBER with choices: what each of them stands for */
  const double *usual;        /* NUMBERS: [count], what a form starts with and nothing assumes; NULL: none */
  const char *fallback_text;  /* TEXT */
  const char *const *choices; /* CHOICE, TEXT: ends with NULL. NUMBER: words that may stand for numbers */
  const char *document;       /* DOCUMENT: name of its schema */
  int count;                  /* NUMBERS, NAMES: how many; TEXT: bytes; LIST: capacity */
  int room;                   /* NAMES: bytes of each */
  size_t count_offset;        /* LIST: int, number of rows; nullable OBJECT: int, 1 when it is there, 0 for null */
  const void *rows;           /* LIST: default rows, [row_count] structs */
  int row_count;
  double series_low, series_high; /* SERIES: range of each number */
  const struct eo_table *table;   /* OBJECT, LIST */
  const char *elder_key;      /* CHOICE: a document that names this key but not the choice is older than the choice */
  int elder_choice;           /* and means this one */
  const char *derived;        /* what stands in place of null */
  const char *basis;          /* where a default that is a number comes from; NULL: it is the program's own */
  const char *below;          /* a sentence more for a number below its range; NULL: none */
  const char *states;         /* the key beside it that it states in another way; NULL: none */
  const char *const *instead; /* REQUIRED: keys beside it of which one may stand in its place; ends with NULL */
  const char *help;           /* one line for people */
};

/* A key that is refused with its reason. */
struct eo_refused_key {
  const char *key, *text;
};

struct eo_table {
  const char *name;                     /* for people */
  const struct eo_refused_key *refused; /* ends with a key NULL; NULL: none */
  size_t size;                          /* of the struct */
  int count;                            /* iterate: for (int i = 0; i < table->count; i++) table->field[i] */
  const struct eo_field *field;
};

/* Sets every member that has a default; required numbers become NaN or 0. */
void eo_table_defaults(const struct eo_table *table, void *target);

/* Fills *target from a JSON object: absent keys take their default, everything that is wrong is added to faults with
   its place below `path` (NULL: the top). On any fault *target is valid but meaningless. SERIES members are allocated.
 */
void eo_table_decode(const struct eo_table *table, const json_t *object, const struct eo_path *path, void *target,
                     struct eo_faults *faults);

/* New JSON object with every key in the order of the table; NULL without memory. */
json_t *eo_table_encode(const struct eo_table *table, const void *source);

/* Moves every number to the nearest one the document can express, so that decode(encode(x)) is x bit for bit. */
void eo_table_round_to_document(const struct eo_table *table, void *target);

/* Frees SERIES and MATRIX members, in the rows of lists too. */
void eo_table_done(const struct eo_table *table, void *target);

/* Adds one line per key to the text: path, type, unit, range, default, help; nested tables follow indented, each once.
   With output set, defaults are left out. */
void eo_table_describe(const struct eo_table *table, bool output, struct eo_text *text);

/* The ways to write a row of a table. low and high are inclusive and in the document's unit. */
#define EO_NUMBER(type, member, key_, unit_, low_, high_, fallback_, help_)                                            \
  {                                                                                                                    \
    .key = key_, .kind = EO_FIELD_NUMBER, .offset = offsetof(type, member), .unit = unit_, .low = low_, .high = high_, \
    .fallback = fallback_, .help = help_                                                                               \
  }
/* ... whose default comes from somewhere. */
#define EO_NUMBER_BASED(type, member, key_, unit_, low_, high_, fallback_, basis_, help_)                              \
  {                                                                                                                    \
    .key = key_, .kind = EO_FIELD_NUMBER, .offset = offsetof(type, member), .unit = unit_, .low = low_, .high = high_, \
    .fallback = fallback_, .basis = basis_, .help = help_                                                              \
  }
#define EO_NUMBER_REQUIRED(type, member, key_, unit_, low_, high_, help_)                                              \
  {                                                                                                                    \
    .key = key_, .kind = EO_FIELD_NUMBER, .flags = EO_FIELD_REQUIRED, .offset = offsetof(type, member), .unit = unit_, \
    .low = low_, .high = high_, .fallback = NAN, .help = help_                                                         \
  }
#define EO_NUMBER_DERIVED(type, member, key_, unit_, low_, high_, derived_, help_)                                     \
  {                                                                                                                    \
    .key = key_, .kind = EO_FIELD_NUMBER, .flags = EO_FIELD_NULLABLE, .offset = offsetof(type, member), .unit = unit_, \
    .low = low_, .high = high_, .fallback = NAN, .derived = derived_, .help = help_                                    \
  }
/* ... for some values of which there are words. */
#define EO_NUMBER_WORDED(type, member, key_, unit_, low_, high_, words_, numbers_, derived_, help_)                    \
  {                                                                                                                    \
    .key = key_, .kind = EO_FIELD_NUMBER, .flags = EO_FIELD_NULLABLE, .offset = offsetof(type, member), .unit = unit_, \
    .low = low_, .high = high_, .fallback = NAN, .choices = words_, .fallbacks = numbers_, .derived = derived_,        \
    .help = help_                                                                                                      \
  }
/* Another way to say what a key beside it holds. */
#define EO_NUMBER_ENTRY(type, member, key_, states_, unit_, low_, high_, help_)                   \
  {                                                                                               \
    .key = key_, .kind = EO_FIELD_NUMBER, .flags = EO_FIELD_NULLABLE | EO_FIELD_ENTRY,            \
    .offset = offsetof(type, member), .unit = unit_, .low = low_, .high = high_, .fallback = NAN, \
    .derived = "not stated", .states = states_, .help = help_                                     \
  }
#define EO_INTEGER(type, member, key_, low_, high_, fallback_, help_)                                    \
  {                                                                                                      \
    .key = key_, .kind = EO_FIELD_INTEGER, .offset = offsetof(type, member), .low = low_, .high = high_, \
    .fallback = fallback_, .help = help_                                                                 \
  }
#define EO_INTEGER_REQUIRED(type, member, key_, low_, high_, help_)                                                   \
  {                                                                                                                   \
    .key = key_, .kind = EO_FIELD_INTEGER, .flags = EO_FIELD_REQUIRED, .offset = offsetof(type, member), .low = low_, \
    .high = high_, .fallback = NAN, .help = help_                                                                     \
  }
#define EO_INTEGER_DERIVED(type, member, key_, low_, high_, derived_, help_)                                          \
  {                                                                                                                   \
    .key = key_, .kind = EO_FIELD_INTEGER, .flags = EO_FIELD_NULLABLE, .offset = offsetof(type, member), .low = low_, \
    .high = high_, .fallback = NAN, .derived = derived_, .help = help_                                                \
  }
#define EO_FLAG(type, member, key_, fallback_, help_)                                                          \
  {                                                                                                            \
    .key = key_, .kind = EO_FIELD_FLAG, .offset = offsetof(type, member), .fallback = fallback_, .help = help_ \
  }
#define EO_CHOICE(type, member, key_, choices_, fallback_, help_)                                \
  {                                                                                              \
    .key = key_, .kind = EO_FIELD_CHOICE, .offset = offsetof(type, member), .choices = choices_, \
    .fallback = fallback_, .help = help_                                                         \
  }
#define EO_NUMBERS(type, member, key_, count_, unit_, low_, high_, flags_, fallbacks_, derived_, help_)      \
  {                                                                                                          \
    .key = key_, .kind = EO_FIELD_NUMBERS, .flags = flags_, .offset = offsetof(type, member), .unit = unit_, \
    .low = low_, .high = high_, .count = count_, .fallbacks = fallbacks_, .derived = derived_, .help = help_ \
  }
#define EO_OBJECT(type, member, key_, table_, help_)                                                       \
  {                                                                                                        \
    .key = key_, .kind = EO_FIELD_OBJECT, .offset = offsetof(type, member), .table = table_, .help = help_ \
  }
/* An object that may be left out or null: the int `present` tells. */
#define EO_OPTIONAL(type, member, present, key_, table_, derived_, help_)                               \
  {                                                                                                     \
    .key = key_, .kind = EO_FIELD_OBJECT, .flags = EO_FIELD_NULLABLE, .offset = offsetof(type, member), \
    .count_offset = offsetof(type, present), .table = table_, .derived = derived_, .help = help_        \
  }
/* A group of keys whose members stand in the surrounding struct itself. */
#define EO_GROUP(key_, table_, help_)                                    \
  {                                                                      \
    .key = key_, .kind = EO_FIELD_OBJECT, .table = table_, .help = help_ \
  }
#define EO_LIST(type, member, rows, key_, table_, low_, capacity_, help_)                                              \
  {                                                                                                                    \
    .key = key_, .kind = EO_FIELD_LIST, .flags = (low_) > 0 ? EO_FIELD_REQUIRED : 0, .offset = offsetof(type, member), \
    .low = low_, .high = capacity_, .count = capacity_, .count_offset = offsetof(type, rows), .table = table_,         \
    .help = help_                                                                                                      \
  }
#define EO_TEXT(type, member, key_, help_)                                                                    \
  {                                                                                                           \
    .key = key_, .kind = EO_FIELD_TEXT, .offset = offsetof(type, member), .count = sizeof((type *)0)->member, \
    .help = help_                                                                                             \
  }
/* A text of low_ bytes or more; null, or absent: "". */
#define EO_TEXT_DERIVED(type, member, key_, low_, derived_, help_)                                                 \
  {                                                                                                                \
    .key = key_, .kind = EO_FIELD_TEXT, .flags = EO_FIELD_NULLABLE, .offset = offsetof(type, member), .low = low_, \
    .count = sizeof((type *)0)->member, .derived = derived_, .help = help_                                         \
  }
/* One of the words; null, or absent: "". flags: EO_FIELD_ENTRY states the key states_. */
#define EO_WORD_DERIVED(type, member, key_, choices_, flags_, states_, derived_, help_)                            \
  {                                                                                                                \
    .key = key_, .kind = EO_FIELD_TEXT, .flags = EO_FIELD_NULLABLE | (flags_), .offset = offsetof(type, member),   \
    .count = sizeof((type *)0)->member, .choices = choices_, .states = states_, .derived = derived_, .help = help_ \
  }
/* One name, or as many as the member has. */
#define EO_NAMES(type, member, key_, high_, derived_, help_)                                              \
  {                                                                                                       \
    .key = key_, .kind = EO_FIELD_NAMES, .flags = EO_FIELD_NULLABLE | EO_FIELD_ALONE,                     \
    .offset = offsetof(type, member), .low = 1, .high = high_, .room = sizeof((type *)0)->member[0],      \
    .count = sizeof((type *)0)->member / sizeof((type *)0)->member[0], .derived = derived_, .help = help_ \
  }
/* An object of its own, which the schema names. */
#define EO_DOCUMENT(type, member, key_, document_, flags_, help_)                                                     \
  {                                                                                                                   \
    .key = key_, .kind = EO_FIELD_DOCUMENT, .flags = flags_, .offset = offsetof(type, member), .document = document_, \
    .help = help_                                                                                                     \
  }
/* Rows of one length, up to most_ of them and most_ numbers each. */
#define EO_MATRIX(type, member, key_, unit_, most_, low_, high_, help_)                                             \
  {                                                                                                                 \
    .key = key_, .kind = EO_FIELD_MATRIX, .offset = offsetof(type, member), .unit = unit_, .low = 0, .high = most_, \
    .series_low = low_, .series_high = high_, .help = help_                                                         \
  }
#define EO_SERIES(type, member, key_, unit_, most_, low_, high_, flags_, help_)                                       \
  {                                                                                                                   \
    .key = key_, .kind = EO_FIELD_SERIES, .flags = flags_, .offset = offsetof(type, member), .unit = unit_, .low = 0, \
    .high = most_, .series_low = low_, .series_high = high_, .help = help_                                            \
  }
/* Rows of output tables: no range. */
#define EO_OUT(type, member, key_, unit_, help_) EO_NUMBER(type, member, key_, unit_, -INFINITY, INFINITY, NAN, help_)
#define EO_OUT_PAIR(type, member, key_, unit_, help_) \
  EO_NUMBERS(type, member, key_, 2, unit_, -INFINITY, INFINITY, 0, NULL, NULL, help_)
#define EO_OUT_SERIES(type, member, key_, unit_, help_) \
  EO_SERIES(type, member, key_, unit_, 1e9, -INFINITY, INFINITY, 0, help_)
#define EO_TABLE(name_, type, fields)                                                                        \
  {                                                                                                          \
    .name = name_, .size = sizeof(type), .count = (int)(sizeof(fields) / sizeof(fields)[0]), .field = fields \
  }

#endif
