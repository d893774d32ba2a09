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
#include "store/store.h"

struct eo_reproduction_plan {
  struct eo_store *store;                 /* borrowed, as all here */
  const char *cache_directory;            /* of the flexibility; NULL: none */
  int threads;                            /* 0: eo_parallel_cores() */
  bool quick;                             /* a tenth of the generations, a coarser sweep */
  const struct eo_resolution *resolution; /* in place of the default one; NULL: none */
  int generations;                        /* of fpga and ga in place of 200 (20 when quick); 0: those */
  int budget;                             /* of credibility-ga in place of 1000 (300 when quick); 0: that */
  int pairs;                              /* as made, in place of 1000 (100 when quick); 0: that */
  const struct eo_progress *progress;     /* may be NULL */
};

/* New document. EO_ERROR_CANCELLED when a stop was asked for; the history keeps what was computed. */
enum eo_code eo_reproduction_run(const struct eo_reproduction_plan *plan, json_t **document, struct eo_error *error);

/* Tables and figures as files of comma-separated values; one page that needs nothing else; a summary for people. */
void eo_reproduction_files(const json_t *document, struct eo_file_set *bundle);
void eo_reproduction_page(const json_t *document, struct eo_text *text);
void eo_reproduction_summary(const json_t *document, struct eo_text *text);

#endif
