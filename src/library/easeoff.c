/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "library/easeoff.h"

#include <stdlib.h>
#include <string.h>

#include "document/result.h"

#include <config.h>

/* A design and what it came to. The analysis borrows from the design, so they stay together and where they are. */
struct analysed {
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings; /* of reading it */
  struct eo_pair *pair;        /* NULL: the handle's serves it */
  struct eo_analysis *analysis;
};

struct easeoff {
  struct analysed *last;
  struct eo_pair *pair;
  char *cache; /* NULL: none */
};

static enum easeoff_status status_of(enum eo_code code)
{
  switch (code) {
  case EO_OK:
    return EASEOFF_OK;
  case EO_ERROR_INPUT:
    return EASEOFF_INPUT;
  case EO_ERROR_MEMORY:
    return EASEOFF_MEMORY;
  case EO_ERROR_NUMERIC:
    return EASEOFF_NUMERIC;
  case EO_ERROR_FILE:
  case EO_ERROR_CANCELLED:
  case EO_ERROR_FULL:
  case EO_ERROR_BUSY:
  case EO_ERROR_DAMAGED:
    break;
  }
  return EASEOFF_OTHER;
}

static enum easeoff_status tell(enum eo_code code, const struct eo_error *own, struct easeoff_error *error)
{
  enum easeoff_status status = status_of(code);
  if (!error)
    return status;
  *error = (struct easeoff_error){.status = status};
  if (code) {
    memcpy(error->pointer, own->pointer, sizeof error->pointer);
    memcpy(error->text, own->text, sizeof error->text);
  }
  return status;
}

/* A failed run has left the analysis without a last one, so each design has an analysis of its own. */
static enum eo_code renew(const struct easeoff *gear, const char *text, struct analysed *next, struct eo_error *error)
{
  struct eo_pair_options options = {.cache_directory = gear->cache};
  EO_TRY(eo_design_read(text, strlen(text), &next->design, &next->geometry, &next->warnings, error));
  if (!gear->pair || !eo_pair_serves(gear->pair, &next->design))
    EO_TRY(eo_pair_new(&next->pair, &next->design, &options, NULL, error));
  EO_TRY(eo_analysis_new(&next->analysis, next->pair ? next->pair : gear->pair, error));
  return eo_analysis_run(next->analysis, &next->design, EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES | EO_WANT_RATING,
                         error);
}

static void discard(struct analysed *analysed)
{
  if (!analysed)
    return;
  eo_analysis_free(analysed->analysis);
  free(analysed);
}

/* The last analysis borrows the last pair, so it goes first. */
static void take_over(struct easeoff *gear, struct analysed *next)
{
  discard(gear->last);
  gear->last = next;
  if (next->pair) {
    eo_pair_free(gear->pair);
    gear->pair = next->pair;
  }
}

enum easeoff_status easeoff_analyze(struct easeoff *gear, const char *design, struct easeoff_error *error)
{
  struct eo_error own;
  struct analysed *next = calloc(1, sizeof *next);
  enum eo_code code = next ? renew(gear, design, next, &own) : eo_error_memory(&own);
  if (!code)
    take_over(gear, next);
  else if (next) {
    struct eo_pair *pair = next->pair;
    discard(next);
    eo_pair_free(pair);
  }
  return tell(code, &own, error);
}

enum easeoff_status easeoff_new(struct easeoff **gear, const char *design, const char *cache,
                                struct easeoff_error *error)
{
  struct eo_error own;
  struct easeoff *made = calloc(1, sizeof *made);
  *gear = NULL;
  if (made && cache)
    made->cache = strdup(cache);
  if (!made || (cache && !made->cache)) {
    free(made);
    return tell(eo_error_memory(&own), &own, error);
  }
  enum easeoff_status status = easeoff_analyze(made, design, error);
  if (status)
    easeoff_free(made);
  else
    *gear = made;
  return status;
}

void easeoff_free(struct easeoff *gear)
{
  if (!gear)
    return;
  discard(gear->last);
  eo_pair_free(gear->pair);
  free(gear->cache);
  free(gear);
}

int easeoff_cases(const struct easeoff *gear)
{
  return gear->last->analysis->cases;
}

struct easeoff_case easeoff_case(const struct easeoff *gear, int number)
{
  const struct eo_evaluation *evaluation = gear->last->analysis->evaluation;
  const struct eo_case_result *result = &evaluation->load_case[number];
  const struct eo_objective_case *value = &evaluation->objective[number];
  return (struct easeoff_case){.torque = result->load_case.torque,
                               .speed = result->load_case.speed,
                               .mean = result->mean,
                               .peak_to_peak = value->peak_to_peak,
                               .transmission_error = result->transmission,
                               .positions = evaluation->positions,
                               .impact = value->impact,
                               .vibration = value->rms,
                               .contact_pressure = value->contact_pressure,
                               .root_stress = value->root_stress,
                               .converged = !value->failed};
}

double easeoff_objective(const struct easeoff *gear)
{
  return gear->last->analysis->value.objective;
}

char *easeoff_result(const struct easeoff *gear)
{
  struct eo_text text = {0};
  struct eo_error error;
  if (eo_result_write(gear->last->analysis, &gear->last->design, &gear->last->warnings, 0, &text, &error) ||
      text.failed) {
    eo_text_done(&text);
    return NULL;
  }
  return text.data;
}

const char *easeoff_version(void)
{
  return PACKAGE_VERSION;
}
