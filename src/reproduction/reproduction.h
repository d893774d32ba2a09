/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper once more: its gear pair unmodified, with Table 3 as given, and with our own optimizations of its two
   cases; every table and the data of every figure with the printed numbers beside ours, and what our assumptions do to
   them.

   Document: program, quick, design (the paper's pair, every default resolved), table_3 (rows: parameter; printed and
   our own), optimizations (case, algorithm, J, PFC, true evaluations, ...), figures (number, title, x, series),
   comparisons (figure, quantity, paper, ours, with the paper's mesh law; whether trend and value agree), sensitivity
   (one assumption changed at a time), as_made (the designs and one found over pairs as made, on the same 1000 pairs of
   class 5), readings (what the paper leaves open and what was assumed), run.

   A figure: { "number", "title", "x_label", "y_label", "from_zero", "series": [ { "name", "dots", "x": [..], "y": [..]
   } ] }. */
#ifndef EASEOFF_REPRODUCTION_REPRODUCTION_H
#define EASEOFF_REPRODUCTION_REPRODUCTION_H

#include <jansson.h>

#include "base/progress.h"
#include "format/file_set.h"
#include "design/design.h"
#include "evaluation/design_scatter.h"
#include "format/outline.h"
#include "store/store.h"

/* How thoroughly. */
struct eo_reproduction_order {
  bool quick;           /* a tenth of the generations, a coarser sweep */
  int generations;      /* of fpga and ga in place of 200 (20 when quick); 0: those */
  int true_evaluations; /* of credibility-ga in place of 1000 (300 when quick); 0: that */
  int pairs;            /* as made, in place of 1000 (100 when quick); 0: that */
  struct eo_resolution resolution;
};
extern const struct eo_table eo_reproduction_order_table;

struct eo_reproduction_plan {
  struct eo_store *store;      /* borrowed, as all here */
  const struct eo_pair *pair;  /* of eo_reproduction_design(); NULL: prepared here */
  const char *cache_directory; /* of the flexibility that is prepared here; NULL: none */
  int threads;                 /* 0: eo_parallel_cores() */
  struct eo_reproduction_order order;
  const struct eo_progress *progress; /* may be NULL */
};

/* The paper's pair, complete. Errors: of the resolution. */
enum eo_code eo_reproduction_design(const struct eo_reproduction_order *order, struct eo_design *design,
                                    struct eo_error *error);

extern const struct eo_outline eo_reproduction_outline;

/* New document. EO_ERROR_CANCELLED when a stop was asked for; the history keeps what was computed. */
enum eo_code eo_reproduction_run(const struct eo_reproduction_plan *plan, json_t **document, struct eo_error *error);

/* Tables and figures as files of comma-separated values; one page that needs nothing else; a summary for people. */
void eo_reproduction_files(const json_t *document, struct eo_file_set *bundle);
void eo_reproduction_page(const json_t *document, struct eo_text *text);
void eo_reproduction_summary(const json_t *document, struct eo_text *text);

#endif
