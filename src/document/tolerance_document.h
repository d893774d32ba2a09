/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tolerance analysis as a document, for people and as a table of pairs. */
#ifndef EASEOFF_DOCUMENT_TOLERANCE_DOCUMENT_H
#define EASEOFF_DOCUMENT_TOLERANCE_DOCUMENT_H

#include "document/scatter_document.h"
#include "evaluation/design_scatter.h"
#include "tolerance/interval.h"
#include "tolerance/output_report.h"

/* A share of the pairs with its 95 % interval (Clopper and Pearson; Wilson's beside it). */
struct eo_yield_row {
  char output[EO_SCATTER_NAME]; /* "" for all limits together */
  int load_case;                /* from 1; 0: every one */
  double most;
  int inside, pairs;
  double fraction;
  struct eo_share_interval exact, wilson;
};

struct eo_tolerance_case {
  const struct eo_scalar *scalar;
  int load_case;
  double nominal;
  struct eo_output_report report;
};

/* What a run comes to. */
struct eo_tolerance_report {
  const struct eo_design *design;   /* borrowed, complete */
  const struct eo_scatter *scatter; /* borrowed */
  const struct eo_scatter_run *run; /* borrowed */
  bool assumed;                     /* class 5 was taken because nothing was stated */
  bool stopped;                     /* the run is what was there at a stop: evaluation/scatter_tally.h */
  int outputs;
  struct eo_tolerance_case *output; /* [outputs] that any pair has; owned */
  int yields;
  struct eo_yield_row yield[EO_MAX_TOLERANCE_LIMITS + 1]; /* the last one: all limits together */
  int failed;                     /* pairs without a transmission error: contact did not converge */
  int worst;                      /* pair: the farthest beyond its limits, without limits the largest swing */
  char worst_of[EO_SCATTER_NAME]; /* by which number */
  double worst_compliance;        /* its factor, which no design states */
  struct eo_design worst_design;  /* it, as a complete design; the compliance stays nominal */
};

/* Errors: EO_ERROR_INPUT (a limit on no output, on a load case that is not there), cancelled, memory. Who makes one of
   a run that was stopped says so in it. eo_tolerance_report_free() accepts NULL. */
enum eo_code eo_tolerance_report_new(struct eo_tolerance_report **report, const struct eo_design *design,
                                     const struct eo_scatter *scatter, const struct eo_scatter_run *run, bool assumed,
                                     const struct eo_progress *progress, struct eo_error *error);
void eo_tolerance_report_free(struct eo_tolerance_report *report);

extern const struct eo_outline eo_tolerance_outline;
extern const struct eo_outline eo_outline_percentile; /* of a struct eo_report_percentile */

/* New document; NULL without memory. warnings may be NULL. */
json_t *eo_tolerance_encode(const struct eo_tolerance_report *report, const struct eo_warnings *warnings);
void eo_tolerance_write(const struct eo_tolerance_report *report, const struct eo_warnings *warnings,
                        struct eo_text *text);

/* For people. */
void eo_tolerance_summary(const struct eo_tolerance_report *report, const struct eo_warnings *warnings,
                          struct eo_text *text);

/* What is to be said where pairs were not computed in full: how many, and how far off the others are; false: all were.
 */
enum { EO_COMPLETION_NOTE = 480 };
bool eo_tolerance_completion_note(const struct eo_tolerance_report *report, char note[EO_COMPLETION_NOTE]);

/* What is to be said where the run was stopped: of how many pairs the numbers are; false: of all that were asked for.
 */
enum { EO_STOPPED_NOTE = 240 };
bool eo_tolerance_stopped_note(const struct eo_tolerance_report *report, char note[EO_STOPPED_NOTE]);

/* A line for each pair that is in full: number, inputs, outputs. */
void eo_tolerance_csv(const struct eo_tolerance_report *report, struct eo_text *text);

/* What can be told before any pair is computed. Errors: EO_ERROR_INPUT (a limit on no output, on a load case that is
   not there). */
enum eo_code eo_tolerance_check_limits(const struct eo_design *design, struct eo_error *error);

/* Bytes that rows and statistics of the pairs take at their most crowded moment. */
double eo_tolerance_memory(const struct eo_design *design, const struct eo_scatter *scatter);

/* What a block asks for. */
struct eo_scatter_plan eo_tolerance_plan(const struct eo_tolerance_settings *settings);

#endif
