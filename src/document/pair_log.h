/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of a tolerance analysis as they come, in a file that a later run goes on from. */
#ifndef EASEOFF_DOCUMENT_PAIR_LOG_H
#define EASEOFF_DOCUMENT_PAIR_LOG_H

#include "document/design_document.h"
#include "evaluation/design_scatter.h"

struct eo_pair_log;

/* What the rows of pairs belong to: the design with its scatter. How many pairs are asked for does not change a pair,
   but for Latin points; nor do limits. Errors: memory. */
enum eo_code eo_pair_log_hash(const struct eo_design *design, char hash[EO_HASH_LENGTH + 1], struct eo_error *error);

/* Opens or makes the file. What it holds of the same design, scatter and program counts as known; a row that was cut
   off is not. Errors: EO_ERROR_INPUT (another file, or one of another design), file, memory. outputs: numbers of a row.
 */
enum eo_code eo_pair_log_open(struct eo_pair_log **log, const char *path, const struct eo_design *design, int outputs,
                              struct eo_error *error);
/* NULL is fine. */
void eo_pair_log_close(struct eo_pair_log *log);

/* For a run. */
struct eo_scatter_log eo_pair_log_of(struct eo_pair_log *log);

#endif
