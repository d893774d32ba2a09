/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a job stands in a SELECT, for this floor alone. */
#ifndef EASEOFF_STORE_JOB_ROW_H
#define EASEOFF_STORE_JOB_ROW_H

#include "store/jobs.h"
#include "store/statement.h"

/* The columns in the order eo_job_row_read() expects; design, spec and result as SQL expressions. */
#define EO_JOB_COLUMNS(design, spec, result)                                                     \
  "id, problem, study, space, " design                                                           \
  ", name, algorithm, fresh, import_upto, state, stopped, true_evaluations, individuals, best, " \
  "best_value, " result                                                                          \
  ", created, updated, kind, pair, served, priority, stop, attempts, error, progress, started, finished, " spec

#define EO_NOW "strftime('%Y-%m-%dT%H:%M:%fZ', 'now')"

/* Texts are borrowed until the next step. */
struct eo_stored_job eo_job_row_read(const struct eo_statement *statement);

#endif
