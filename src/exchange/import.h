/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of other programs read into a design: REXS and tables. The answer is a document: what the file holds, the
   design, and by name everything that was not used, refused or assumed; or what is wrong with it, and where. */
#ifndef EASEOFF_EXCHANGE_IMPORT_H
#define EASEOFF_EXCHANGE_IMPORT_H

#include <stdbool.h>
#include <stddef.h>

#include <jansson.h>

#include "base/error.h"
#include "format/outline.h"
#include "format/table.h"

/* What the user says about the file. */
struct eo_import_options {
  int pair;        /* number of the pair, or of the row of a table, from 1; 0: the only one */
  bool transverse; /* amounts of modifications stand in the transverse section; else normal to the flank */
  bool reversed;   /* a positive helix slope takes material off towards the datum face */
  int flank; /* of the driver that is loaded, where the file leaves it open: 0 as the file says, 1 left, 2 right */
};
extern const struct eo_table eo_import_options_table;

/* What can be chosen: a gear pair of a model, or a design of a table. */
struct eo_import_pair {
  int number; /* from 1 */
  char label[160], remark[160];
  bool importable;
  int ends;                         /* 2: double helical; 0: of a table, and so are the next */
  int pinion[2], gear[2], stage[2]; /* ids; gears: [ends] */
  int stages;
};

/* What is wrong. The texts are owned. */
struct eo_import_fault {
  const char *kind;     /* a word for each; literal */
  const char *text;     /* a sentence */
  const char *relation; /* this and the next texts: NULL where there is none */
  bool of_component;    /* the next is one */
  int component;        /* id */
  const char *component_type, *attribute;
  int line, column;    /* from 1; 0: not known */
  const char *pointer; /* of a file in JSON: where it stands */
  const char *key;     /* of the design: where it would stand */
};
extern const struct eo_outline eo_import_pair_outline, eo_import_fault_outline;

struct eo_import {
  char format[60]; /* "REXS 1.7 (XML)", "" when it is not known */
  int taken;       /* number of the pair that was read; 0: none */
  int pairs, faults;
  struct eo_import_pair *pair;                  /* [pairs], owned */
  struct eo_import_fault *fault;                /* [faults], owned; with one of them there is no design */
  json_t *design;                               /* what the file states of a design, as a document; NULL: none */
  json_t *not_used, *refused, *assumed, *notes; /* texts */
  bool failed;                                  /* an allocation failed */
};
extern const struct eo_outline eo_import_outline;

/* Reads a file of any kind that is known, told by its content. Fills the answer, with faults where the file is wrong;
   release with eo_import_done(). Errors: memory. */
enum eo_code eo_import_read(struct eo_import *import, const char *bytes, size_t size,
                            const struct eo_import_options *options, struct eo_error *error);
void eo_import_done(struct eo_import *import);

/* The answer as a document; NULL without memory. */
json_t *eo_import_encode(const struct eo_import *import);

/* For the readers: an empty answer; false: no memory. */
bool eo_import_begin(struct eo_import *import);

/* An entry of a list of texts. */
void eo_import_say(struct eo_import *import, json_t *list, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* A fault, with its place when that is known; the next one moves it. NULL without memory. kind: a literal. */
struct eo_import_fault *eo_import_fault(struct eo_import *import, const char *kind, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* A text for it, fit for people; NULL without memory, and then the import has failed. */
const char *eo_import_text(struct eo_import *import, const char *text);
/* A pair or design that can be chosen, with its number; the next one moves it. NULL without memory. */
struct eo_import_pair *eo_import_list(struct eo_import *import);
/* True when the table has the key. */
bool eo_import_has_key(const struct eo_table *table, const char *key);

/* The readers. */
void eo_import_rexs(struct eo_import *import, const char *bytes, size_t size, const struct eo_import_options *options);

#endif
