/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is said of one recording: by the options of `easeoff measure`, by a row of its list, by the form of an upload.
   Key, unit, range and default stand in one list of rows, of which each of the three takes its own. */
#ifndef EASEOFF_DOCUMENT_MEASURE_ORDER_H
#define EASEOFF_DOCUMENT_MEASURE_ORDER_H

#include <stdint.h>

#include "document/measure_file.h"
#include "format/table.h"

enum eo_run_up { EO_RUN_UP_LEFT_OUT, EO_RUN_UP_INCLUDED };
enum { EO_MEASURE_MODIFIED, EO_MEASURE_UNMODIFIED }; /* label */
extern const char *const eo_measure_label[3];        /* of these, then NULL */

struct eo_measure_order {
  uint64_t design; /* of an upload: number of the stored design */
  char file[4096]; /* of a row of a list: relative to the list */
  int label, end;
  double torque, speed; /* N m and rad/s, NaN: not stated */
  int harmonics;        /* 0: 8 */
  int part;             /* 0: the one with the most turns */
  int run_up;           /* enum eo_run_up */
  double from, to;      /* s, to NaN: the end */
  const json_t *layout; /* borrowed from what was decoded; NULL: to be found */
};

struct eo_measure_list {
  int count;
  struct eo_measure_order row[EO_MOST_MEASURED];
};

extern const struct eo_table eo_measure_form_table; /* design, label and what they have in common */
extern const struct eo_table eo_measure_option_table;
extern const struct eo_table eo_measure_list_table; /* of a struct eo_measure_list */

/* A stretch that ends before it begins is a fault, at `path` of the order. */
void eo_measure_order_check(const struct eo_measure_order *order, const struct eo_path *path, struct eo_faults *faults);

/* What the order says, and the speeds of the design's load cases, into *request. */
void eo_measure_order_take(const struct eo_measure_order *order, const struct eo_design *design,
                           struct eo_measure_request *request);

#endif
