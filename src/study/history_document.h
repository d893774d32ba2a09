/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the data folder knows, as documents: problems, jobs, true rows, the path of a job. */
#ifndef EASEOFF_STUDY_HISTORY_DOCUMENT_H
#define EASEOFF_STUDY_HISTORY_DOCUMENT_H

#include <jansson.h>

#include "format/outline.h"
#include "format/text.h"
#include "store/store.h"

/* { "problems": [ { "id", "hash", "name", "evaluator", "evaluations", "failed", "cost_s", "created" } ],
     "jobs": [ { "id", "kind", "problem", "name", "algorithm", "state", "stopped", "true_evaluations", "individuals",
   "pfc_percent", "best_value", "has_result", "created", "updated" } ] } A job that was running when its process ended
   is "interrupted". */
extern const struct eo_outline eo_records_outline, eo_outline_problem_rows;
enum eo_code eo_records_list(struct eo_store *store, json_t **document, struct eo_error *error);

/* The result document of a job; EO_ERROR_INPUT when there is no such job or it has none yet. */
enum eo_code eo_records_result(struct eo_store *store, int64_t job, json_t **document, struct eo_error *error);

/* The true rows of a problem: { "problem": spec, "rows": [ { "id", "outcome", "reason", "cost_s", "modification",
   "scenarios": [ [ one object per load case ] ] } ] }; EO_ERROR_INPUT when there is no such problem. */
enum eo_code eo_records_rows(struct eo_store *store, int64_t problem, json_t **document, struct eo_error *error);

/* The same as comma-separated values: every parameter that any row changes, then the values of each load case of the
   first scenario. */
enum eo_code eo_records_rows_csv(const json_t *rows, struct eo_text *text, struct eo_error *error);

/* The path of a job as comma-separated values, by generation and individual: kind (computed, known, predicted),
   evaluation, fitness and credibility of predictions, and the point in the unit cube. */
enum eo_code eo_records_path_csv(struct eo_store *store, int64_t job, struct eo_text *text, struct eo_error *error);

#endif
