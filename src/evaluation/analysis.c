#include "evaluation/analysis.h"

#include "base/clock.h"
#include "gear/modification.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum eo_code eo_analysis_new(struct eo_analysis **result, const struct eo_pair *pair, struct eo_error *error)
{
  struct eo_analysis *a = calloc(1, sizeof *a);
  if (!a || !(a->known = calloc(1, sizeof *a->known))) {
    free(a);
    return eo_error_memory(error);
  }
  a->pair = pair;
  a->threads = 1;
  *result = a;
  return EO_OK;
}

void eo_analysis_free(struct eo_analysis *a)
{
  if (!a)
    return;
  eo_evaluator_free(a->evaluator);
  free(a->unmodified);
  free(a->raw);
  free(a->raw_unmodified);
  free(a->known);
  free(a);
}

/* Makes room, forgetting what is known when it has to grow. */
static enum eo_code fit(struct eo_analysis *a, int cases, int scenarios, struct eo_error *error)
{
  if (a->evaluator && cases <= a->most_cases && scenarios <= a->most_scenarios)
    return EO_OK;
  size_t n = (size_t)cases, all = n * (size_t)scenarios;
  eo_evaluator_free(a->evaluator);
  free(a->unmodified);
  free(a->raw);
  free(a->raw_unmodified);
  a->evaluator = NULL;
  a->evaluation = NULL;
  a->most_cases = cases;
  a->most_scenarios = scenarios;
  memset(a->known, 0, sizeof *a->known);
  a->unmodified = calloc(n, sizeof *a->unmodified);
  a->raw = calloc(all, sizeof *a->raw);
  a->raw_unmodified = calloc(all, sizeof *a->raw_unmodified);
  if (!a->unmodified || !a->raw || !a->raw_unmodified)
    return eo_error_memory(error);
  return eo_evaluator_new(&a->evaluator, a->pair, cases, error);
}

/* The same design without modification; what the evaluation does not look at is blank, so that it can be compared. */
static void strip(struct eo_design *bare, const struct eo_design *design)
{
  memcpy(bare, design, sizeof *bare);
  memset(bare->name, 0, sizeof bare->name);
  memset(&bare->optimization, 0, sizeof bare->optimization);
  memset(&bare->modification, 0, sizeof bare->modification);
}

static bool is_unmodified(const struct eo_design *design)
{
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < design->gear_pair.ends; end++)
      if (!eo_modification_is_none(&design->modification.flank[member][end]))
        return false;
  return true;
}

static bool is_robust(const struct eo_design *design)
{
  return design->objective.robust != EO_ROBUST_OFF && design->objective.scenarios > 0;
}

static enum eo_code find_unmodified(struct eo_analysis *a, const struct eo_design *bare, int want,
                                    struct eo_error *error)
{
  const struct eo_evaluation *r;
  size_t bytes = sizeof *a->raw * (size_t)a->cases;
  enum eo_code code = eo_evaluator_run(a->evaluator, bare, NULL, want & EO_WANT_ROOT, &r, error);
  if (code)
    return code;
  memcpy(a->unmodified, r->objective, bytes);
  if (is_robust(bare))
    return eo_evaluator_raw(a->evaluator, bare, a->raw_unmodified, error);
  memcpy(a->raw_unmodified, a->unmodified, bytes);
  return EO_OK;
}

static enum eo_code find_design(struct eo_analysis *a, const struct eo_design *design, int want, struct eo_error *error)
{
  enum eo_code code = is_robust(design) ? eo_evaluator_raw(a->evaluator, design, a->raw, error) : EO_OK;
  if (!code)
    code = eo_evaluator_run(a->evaluator, design, NULL, want, &a->evaluation, error);
  if (!code && !is_robust(design))
    memcpy(a->raw, a->evaluation->objective, sizeof *a->raw * (size_t)a->cases);
  return code;
}

/* An unmodified design is its own reference. */
static void copy_reference(struct eo_analysis *a)
{
  size_t bytes = sizeof *a->raw * (size_t)a->cases;
  memcpy(a->unmodified, a->evaluation->objective, bytes);
  memcpy(a->raw_unmodified, a->raw, bytes * (size_t)a->scenarios);
}

/* A reference found with root stress is told without it to who did not ask: an answer does not show what was asked
   before. */
static void forget_root(struct eo_analysis *a)
{
  for (int k = 0; k < a->cases; k++)
    a->unmodified[k].root_stress = NAN;
  for (int k = 0; k < a->cases * a->scenarios; k++)
    a->raw_unmodified[k].root_stress = NAN;
  a->known_root = false;
}

static enum eo_code run_both(struct eo_analysis *a, const struct eo_design *design, const struct eo_design *bare,
                             int want, struct eo_error *error)
{
  bool own_reference = is_unmodified(design),
       known = a->known_root >= a->root && memcmp(a->known, bare, sizeof *bare) == 0;
  double start = eo_clock_milliseconds();
  if (known && a->known_root && !a->root)
    forget_root(a);
  enum eo_code code = known || own_reference ? EO_OK : find_unmodified(a, bare, want, error);
  a->unmodified_ms = known || own_reference ? 0 : eo_clock_milliseconds() - start;
  start = eo_clock_milliseconds();
  if (!code)
    code = find_design(a, design, want, error);
  a->design_ms = eo_clock_milliseconds() - start;
  if (code) {
    memset(a->known, 0, sizeof *a->known);
    return code;
  }
  if (own_reference)
    copy_reference(a);
  if (!known) {
    memcpy(a->known, bare, sizeof *bare);
    a->known_root = a->root;
  }
  eo_evaluator_combine(design, &a->pair->geometry, a->raw, a->raw_unmodified, &a->value);
  eo_evaluator_combine(bare, &a->pair->geometry, a->raw_unmodified, a->raw_unmodified, &a->unmodified_value);
  return EO_OK;
}

enum eo_code eo_analysis_run(struct eo_analysis *a, const struct eo_design *design, int want, struct eo_error *error)
{
  struct eo_design *bare = malloc(sizeof *bare);
  if (!bare)
    return eo_error_memory(error);
  strip(bare, design);
  a->cases = design->load_cases;
  a->scenarios = eo_evaluator_scenarios(design);
  a->want = want;
  a->root = a->pair->flexibility && (want & EO_WANT_ROOT || !isnan(design->objective.root_stress));
  enum eo_code code = fit(a, a->cases, a->scenarios, error);
  if (!code)
    code = eo_evaluator_use_threads(a->evaluator, a->threads, error);
  if (!code)
    code = run_both(a, design, bare, want, error);
  free(bare);
  return code;
}
