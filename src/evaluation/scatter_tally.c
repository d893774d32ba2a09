/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/scatter_tally.h"

#include <stdlib.h>
#include <string.h>

#include "evaluation/scatter_levels.h"

enum eo_code eo_scatter_tally_init(struct eo_scatter_tally *tally, int pairs, const struct eo_scatter_log *log,
                                   struct eo_error *error)
{
  *tally = (struct eo_scatter_tally){.log = *log, .pairs = pairs, .there = calloc((size_t)pairs, sizeof *tally->there)};
  return tally->there ? EO_OK : eo_error_memory(error);
}

void eo_scatter_tally_done(struct eo_scatter_tally *tally)
{
  free(tally->there);
  tally->there = NULL;
}

static bool ask(const struct eo_scatter_tally *tally, int pair, double *output)
{
  return tally->log.find && tally->log.find(tally->log.context, pair, output);
}

/* Each pair is asked for and kept by one thread. */
static bool find(void *context, int pair, double *output)
{
  struct eo_scatter_tally *tally = context;
  tally->there[pair] = ask(tally, pair, output);
  return tally->there[pair];
}

static enum eo_code keep(void *context, int pair, const double *output, double cost, struct eo_error *error)
{
  struct eo_scatter_tally *tally = context;
  tally->there[pair] = true;
  return tally->log.keep ? tally->log.keep(tally->log.context, pair, output, cost, error) : EO_OK;
}

struct eo_scatter_log eo_scatter_tally_log(struct eo_scatter_tally *tally)
{
  return (struct eo_scatter_log){find, keep, tally};
}

/* Pairs in full are computed after all coarse rows are there. */
static enum eo_code complete(const struct eo_scatter_tally *tally, const struct eo_design *design,
                             struct eo_scatter_run *run, struct eo_error *error)
{
  const struct eo_completion completion = eo_scatter_completion(run, design);
  memcpy(run->full, tally->there, sizeof *run->full * (size_t)run->pairs);
  for (int i = 0; i < run->outputs; i++)
    EO_TRY(eo_completion_fill(&completion, i, &run->completed[i], error));
  return EO_OK;
}

enum eo_code eo_scatter_tally_settle(const struct eo_scatter_tally *tally, const struct eo_design *design,
                                     struct eo_scatter_run *run, int *full, struct eo_error *error)
{
  int there = 0;
  *full = 0;
  for (int i = 0; i < tally->pairs; i++)
    there += tally->there[i];
  if (there == 0) /* the design itself, which is evaluated before any pair, may be missing too */
    return EO_OK;
  if (run->coarse) {
    *full = there;
    return there >= EO_SCATTER_FEWEST ? complete(tally, design, run, error) : EO_OK;
  }
  while (*full < tally->pairs &&
         (tally->there[*full] || ask(tally, *full, run->output + (size_t)*full * (size_t)run->outputs)))
    ++*full;
  run->pairs = *full;
  return EO_OK;
}
