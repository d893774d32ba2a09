/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study as it is asked for: which numbers of a design take which values. The same document comes by REST, stands in a
   STUDY.json, and is made of the options of the terminal. */
#ifndef EASEOFF_VARIANTS_VARIANT_ORDER_H
#define EASEOFF_VARIANTS_VARIANT_ORDER_H

#include <stdint.h>

#include <jansson.h>

#include "format/table.h"

enum {
  EO_STUDY_AXES = 32,
  EO_STUDY_MOST_ROWS = 10000000,
  EO_STUDY_MOST_LEVELS = 100000,
  EO_STUDY_BYTES = 64 << 20, /* largest document, with its table */
};

enum eo_study_sampling { EO_STUDY_FACTORIAL, EO_STUDY_LATIN, EO_STUDY_SOBOL };
extern const char *const eo_study_samplings[]; /* by number; ends with NULL */

/* One thing that varies. */
struct eo_study_axis {
  char key[400];
  struct eo_numbers values; /* none: a range or words */
  char words[400];
  double from, to; /* NaN: no range */
  int points;      /* 0: 2 */
};

struct eo_study_order {
  char name[200];
  const json_t *design; /* borrowed from the document */
  int axes;
  struct eo_study_axis axis[EO_STUDY_AXES];
  int sampling; /* enum eo_study_sampling */
  int samples;
  uint64_t seed;
  char columns[2000];
};

extern const struct eo_table eo_study_order_table;

/* Reads a document: *order, and *table: its key "table" (a text of comma-separated values; NULL: none), borrowed.
   eo_study_order_done() in any case. False with faults. */
bool eo_study_order_decode(const json_t *document, struct eo_study_order *order, const char **table,
                           struct eo_faults *faults);
void eo_study_order_done(struct eo_study_order *order);

#endif
