/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A study as the document that is kept with its job. */
#include "study/study.h"

#include <stdlib.h>

#include "format/json.h"
#include "design/design_grids.h"
#include "document/result.h"
#include "evaluation/analysis.h"
#include "store/jobs.h"
#include "study/made_check.h"

/* The design with the best modification; false when there is none. */
static bool best_design(const struct eo_study_plan *plan, const struct eo_study_result *result, struct eo_design *best)
{
  *best = *plan->design;
  best->modification = result->best.there ? result->best.modification : result->unmodified.modification;
  return result->best.there;
}

static enum eo_code analyse(const struct eo_study_plan *plan, const struct eo_design *design, json_t **document,
                            struct eo_error *error)
{
  struct eo_analysis *analysis = NULL;
  enum eo_code code = eo_analysis_new(&analysis, plan->pair, error);
  if (!code)
    code = eo_analysis_run(analysis, design, EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES | EO_WANT_RATING, error);
  if (!code && !(*document = eo_result_encode(analysis, design, NULL)))
    code = eo_error_memory(error);
  eo_analysis_free(analysis);
  return code;
}

/* What a search over pairs as made found, and the flank it began with where there is one, on other pairs. */
static enum eo_code check(const struct eo_study_plan *plan, struct eo_study_result *result, struct eo_error *error)
{
  const struct eo_design *design = plan->design;
  struct eo_made_plan made = {.design = design,
                              .pair = plan->pair,
                              .designs = 1,
                              .modification = {&result->best.modification, &design->modification},
                              .name = {"found", "as designed"},
                              .pairs = design->objective.check_pairs,
                              .threads = plan->threads};
  made.designs += !eo_design_is_unmodified(design);
  result->check = (struct eo_made_check){0};
  if (!result->best.there || result->stopped == EO_STOP_CANCELLED || design->drawn.pairs == 0 || made.pairs == 0)
    return EO_OK;
  return eo_made_check_run(&result->check, &made, error);
}

static enum eo_code keep(struct eo_store *store, int64_t job, const json_t *document, struct eo_error *error)
{
  struct eo_text text = {0};
  eo_json_write(&text, document, EO_JSON_COMPACT);
  enum eo_code code = text.failed ? eo_error_memory(error) : eo_store_keep_result(store, job, text.data, error);
  eo_text_done(&text);
  return code;
}

/* What a document is made from. */
struct making {
  json_t *analysis;              /* of the best design; NULL: there is none */
  struct eo_study_result result; /* with a check of its own */
  struct eo_design *best;
};

static enum eo_code make(const struct eo_study_plan *plan, const struct eo_study_result *result,
                         const struct eo_warnings *warnings, struct making *making, json_t **document,
                         struct eo_error *error)
{
  if (!making->best)
    return eo_error_memory(error);
  if (best_design(plan, result, making->best))
    EO_TRY(analyse(plan, making->best, &making->analysis, error));
  EO_TRY(check(plan, &making->result, error));
  *document = eo_study_result_encode(&making->result, plan->design, making->analysis, warnings);
  return *document ? keep(plan->store, result->job, *document, error) : eo_error_memory(error);
}

enum eo_code eo_study_document(const struct eo_study_plan *plan, const struct eo_study_result *result,
                               const struct eo_warnings *warnings, json_t **document, struct eo_error *error)
{
  json_t *made = NULL;
  struct making making = {.result = *result, .best = malloc(sizeof *making.best)};
  enum eo_code code = make(plan, result, warnings, &making, &made, error);
  if (document)
    *document = made;
  else
    json_decref(made);
  eo_made_check_done(&making.result.check);
  json_decref(making.analysis);
  free(making.best);
  return code;
}
