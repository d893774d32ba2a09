/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table that the paper did not print: its optimum, ours and one that a search over pairs as made found, on the same
   pairs as made. Not one flank is made as it is designed; class 5 of ISO 1328-1 says how far off it may be. */
#include "reproduction/reproduction_private.h"

#include <math.h>
#include <stdlib.h>

#include "study/made_check.h"

enum { CLASS = 5, SEEN = 8 };                                  /* of the flanks; pairs that the search looks at */
static const double FIRST = 0.85, SEARCHED = 0.9, LAST = 0.95; /* of the whole work */

struct watched {
  const struct reproduction *reproduction;
  double from, to;
};

static int watch_search(void *context, const struct eo_study_report *report)
{
  const struct watched *watched = context;
  return eo_progress_report(watched->reproduction->plan->progress, "case A over pairs as made",
                            watched->from + (watched->to - watched->from) * report->fraction);
}

static int watch_pairs(void *context, const char *what, double fraction)
{
  const struct watched *watched = context;
  return eo_progress_report(watched->reproduction->plan->progress, what,
                            watched->from + (watched->to - watched->from) * fraction);
}

/* The paper's pair and weights; what 95 % of the pairs of class 5 stay below. */
static enum eo_code set_up(const struct reproduction *reproduction, struct eo_design *design, struct eo_error *error)
{
  struct eo_geometry geometry;
  *design = *reproduction->design[UNMODIFIED];
  design->tolerance.preset = EO_SCATTER_ISO_CLASS;
  design->tolerance.grade = CLASS;
  design->objective.robust = EO_ROBUST_PERCENTILE;
  design->objective.scatter_pairs = SEEN;
  design->objective.first_pairs = 0;
  design->optimization.search.algorithm = EO_CREDIBILITY_GA;
  design->optimization.search.true_evaluations = eo_reproduction_budget(reproduction);
  return eo_design_complete(design, &geometry, error);
}

static enum eo_code search(const struct reproduction *reproduction, const struct eo_design *design,
                           struct eo_modification *found, struct eo_error *error)
{
  struct watched watched = {reproduction, FIRST, SEARCHED};
  const struct eo_study_plan plan = {.design = design,
                                     .pair = reproduction->pair,
                                     .store = reproduction->plan->store,
                                     .threads = reproduction->plan->threads,
                                     .fresh = true,
                                     .watch = watch_search,
                                     .context = &watched};
  struct eo_study_result result;
  enum eo_code code = eo_study_run(&plan, &result, error);
  if (!code && result.stopped == EO_STOP_CANCELLED)
    code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
  *found = result.best.there ? result.best.modification : reproduction->design[UNMODIFIED]->modification;
  eo_study_result_done(&result);
  return code;
}

static enum eo_code compare(const struct reproduction *reproduction, const struct eo_design *design,
                            const struct eo_modification *found, json_t **document, struct eo_error *error)
{
  struct watched watched = {reproduction, SEARCHED, LAST};
  const struct eo_progress progress = {watch_pairs, &watched};
  const struct eo_made_plan plan = {.design = design,
                                    .pair = reproduction->pair,
                                    .designs = 4,
                                    .modification = {&reproduction->design[PAPER_A]->modification,
                                                     &reproduction->design[PAPER_B]->modification,
                                                     &reproduction->design[OWN_A]->modification, found},
                                    .name = {eo_reproduction_variant[PAPER_A], eo_reproduction_variant[PAPER_B],
                                             eo_reproduction_variant[OWN_A], "found over pairs as made, case A"},
                                    .pairs = reproduction->plan->order.pairs > 0 ? reproduction->plan->order.pairs
                                             : reproduction->plan->order.quick   ? 100
                                                                                 : 1000,
                                    .threads = reproduction->plan->threads,
                                    .progress = &progress};
  struct eo_made_check check;
  enum eo_code code = eo_made_check_run(&check, &plan, error);
  if (!code && !(*document = eo_made_check_encode(&check, design)))
    code = eo_error_memory(error);
  eo_made_check_done(&check);
  return code;
}

enum eo_code eo_reproduction_made(struct reproduction *reproduction, struct eo_error *error)
{
  struct eo_modification found;
  struct eo_design *design = malloc(sizeof *design);
  enum eo_code code = design ? set_up(reproduction, design, error) : eo_error_memory(error);
  if (!code)
    code = search(reproduction, design, &found, error);
  if (!code)
    code = compare(reproduction, design, &found, &reproduction->made, error);
  free(design);
  return code;
}
