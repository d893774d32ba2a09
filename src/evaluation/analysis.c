/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/analysis.h"

#include "base/clock.h"
#include "design/design_grids.h"
#include "evaluation/objective_terms.h"
#include "evaluation/scalar.h"
#include "gear/modification.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum eo_code eo_analysis_new(struct eo_analysis **result, const struct eo_pair *pair, struct eo_error *error)
{
  struct eo_analysis *analysis = calloc(1, sizeof *analysis);
  if (!analysis || !(analysis->known = calloc(1, sizeof *analysis->known))) {
    free(analysis);
    return eo_error_memory(error);
  }
  analysis->pair = pair;
  analysis->threads = 1;
  *result = analysis;
  return EO_OK;
}

static void forget_rating(struct eo_analysis *analysis)
{
  eo_design_rating_free(analysis->rating);
  eo_evaluator_free(analysis->leaning);
  analysis->rating = NULL;
  analysis->leaning = NULL;
}

void eo_analysis_free(struct eo_analysis *analysis)
{
  if (!analysis)
    return;
  eo_evaluator_free(analysis->evaluator);
  forget_rating(analysis);
  eo_pitch_analysis_done(&analysis->pitch);
  free(analysis->unmodified);
  free(analysis->raw);
  free(analysis->raw_unmodified);
  free(analysis->known);
  free(analysis);
}

/* Makes room, forgetting what is known when it has to grow. */
static enum eo_code fit(struct eo_analysis *analysis, int cases, int scenarios, struct eo_error *error)
{
  if (analysis->evaluator && cases <= analysis->most_cases && scenarios <= analysis->most_scenarios)
    return EO_OK;
  size_t n = (size_t)cases, all = n * (size_t)scenarios;
  eo_evaluator_free(analysis->evaluator);
  forget_rating(analysis);
  free(analysis->unmodified);
  free(analysis->raw);
  free(analysis->raw_unmodified);
  analysis->evaluator = NULL;
  analysis->evaluation = NULL;
  analysis->most_cases = cases;
  analysis->most_scenarios = scenarios;
  memset(analysis->known, 0, sizeof *analysis->known);
  analysis->unmodified = calloc(n, sizeof *analysis->unmodified);
  analysis->raw = calloc(all, sizeof *analysis->raw);
  analysis->raw_unmodified = calloc(all, sizeof *analysis->raw_unmodified);
  if (!analysis->unmodified || !analysis->raw || !analysis->raw_unmodified)
    return eo_error_memory(error);
  return eo_evaluator_new(&analysis->evaluator, analysis->pair, cases, error);
}

/* Numbers of designed grids, of which the pair without modification has nothing: those of another design are no other
   reference. */
static void blank_designed(struct eo_flank_grids *grids)
{
  for (int i = 0; i < 8; i++) {
    const struct eo_grid_place *place = &grids->place[i / 4][i / 2 % 2][i % 2];
    size_t size = (size_t)place->u_knots * (size_t)place->y_knots;
    if (size && place->kind == EO_GRID_DESIGNED)
      memset(grids->number + place->first + place->u_knots + place->y_knots, 0, sizeof(double) * size);
  }
}

/* The same design without its modification; what the evaluation does not look at is blank, so that it can be compared.
 */
static void strip(struct eo_design *bare, const struct eo_design *design)
{
  memcpy(bare, design, sizeof *bare);
  memset(bare->name, 0, sizeof bare->name);
  memset(&bare->optimization, 0, sizeof bare->optimization);
  bare->optimization.front = design->optimization.front; /* whether the nominal pair stands beside the others */
  bare->optimization.search.algorithm = design->optimization.search.algorithm;
  memset(&bare->rating, 0, sizeof bare->rating);
  memset(&bare->pitch, 0, sizeof bare->pitch);
  memset(&bare->tolerance, 0, sizeof bare->tolerance);
  bare->modification = eo_design_unmodified(design);
  blank_designed(&bare->grids);
}

static bool is_robust(const struct eo_design *design)
{
  return eo_design_scenarios(design) > 1;
}

static enum eo_code find_unmodified(struct eo_analysis *analysis, const struct eo_design *bare, int want,
                                    struct eo_error *error)
{
  const struct eo_evaluation *evaluation;
  size_t bytes = sizeof *analysis->raw * (size_t)analysis->cases;
  EO_TIMED(analysis->unmodified_ms);
  EO_TRY(eo_evaluator_run(analysis->evaluator, bare, NULL, want & EO_WANT_ROOT, &evaluation, error));
  memcpy(analysis->unmodified, evaluation->objective, bytes);
  if (is_robust(bare))
    return eo_evaluator_raw(analysis->evaluator, bare, analysis->raw_unmodified, error);
  memcpy(analysis->raw_unmodified, analysis->unmodified, bytes);
  return EO_OK;
}

static enum eo_code find_design(struct eo_analysis *analysis, const struct eo_design *design, int want,
                                struct eo_error *error)
{
  EO_TIMED(analysis->design_ms);
  if (is_robust(design))
    EO_TRY(eo_evaluator_raw(analysis->evaluator, design, analysis->raw, error));
  EO_TRY(eo_evaluator_run(analysis->evaluator, design, NULL, want, &analysis->evaluation, error));
  if (!is_robust(design))
    memcpy(analysis->raw, analysis->evaluation->objective, sizeof *analysis->raw * (size_t)analysis->cases);
  return EO_OK;
}

/* After the design's own run, on an evaluator beside it: what that one has solved stays for the next question. */
static enum eo_code find_rating(struct eo_analysis *analysis, const struct eo_design *design, struct eo_error *error)
{
  EO_TIMED(analysis->rating_ms);
  if (!analysis->leaning)
    EO_TRY(eo_evaluator_new(&analysis->leaning, analysis->pair, analysis->most_cases, error));
  if (!analysis->rating)
    EO_TRY(eo_design_rating_new(&analysis->rating, analysis->most_cases, error));
  EO_TRY(eo_evaluator_use_threads(analysis->leaning, analysis->threads, error));
  EO_TRY(eo_design_rating_lean(analysis->rating, analysis->leaning, design, NULL, error));
  eo_design_rating_find(analysis->rating, analysis->pair, design, analysis->evaluation);
  return EO_OK;
}

/* An unmodified design is its own reference. */
static void copy_reference(struct eo_analysis *analysis)
{
  size_t bytes = sizeof *analysis->raw * (size_t)analysis->cases;
  memcpy(analysis->unmodified, analysis->evaluation->objective, bytes);
  memcpy(analysis->raw_unmodified, analysis->raw, bytes * (size_t)analysis->scenarios);
}

/* A reference found with root stress is told without it to who did not ask: an answer does not show what was asked
   before. */
static void forget_root(struct eo_analysis *analysis)
{
  int root = eo_scalar_find("root_stress_MPa");
  for (int k = 0; k < analysis->cases; k++)
    analysis->unmodified[k].root_stress = analysis->unmodified[k].scalar[root] = NAN;
  for (int k = 0; k < analysis->cases * analysis->scenarios; k++)
    analysis->raw_unmodified[k].root_stress = analysis->raw_unmodified[k].scalar[root] = NAN;
  analysis->known_root = false;
}

/* The reference and the design; what is known of the reference is used again. */
static enum eo_code run_both(struct eo_analysis *analysis, const struct eo_design *design, const struct eo_design *bare,
                             int want, struct eo_error *error)
{
  bool own_reference = eo_design_is_unmodified(design);
  bool known = analysis->known_root >= analysis->root && memcmp(analysis->known, bare, sizeof *bare) == 0;
  analysis->unmodified_ms = analysis->design_ms = analysis->rating_ms = 0;
  if (known && analysis->known_root && !analysis->root)
    forget_root(analysis);
  if (!known && !own_reference)
    EO_TRY(find_unmodified(analysis, bare, want, error));
  EO_TRY(find_design(analysis, design, want, error));
  eo_pitch_analysis_done(&analysis->pitch);
  if (want & EO_WANT_PITCH && design->pitch.stated)
    EO_TRY(eo_pitch_analysis_run(&analysis->pitch, analysis->evaluator,
                                 &(struct eo_pitch_question){.design = design,
                                                             .compliance_factor = 1,
                                                             .speed_factor = 1,
                                                             .root = want & EO_WANT_ROOT,
                                                             .vibration = true,
                                                             .threads = analysis->threads,
                                                             .progress = analysis->progress},
                                 error));
  if (want & EO_WANT_RATING)
    EO_TRY(find_rating(analysis, design, error));
  if (own_reference)
    copy_reference(analysis);
  if (!known) {
    memcpy(analysis->known, bare, sizeof *bare);
    analysis->known_root = analysis->root;
  }
  eo_evaluator_combine(design, &analysis->pair->geometry, analysis->raw, analysis->raw_unmodified, &analysis->value);
  eo_evaluator_combine(bare, &analysis->pair->geometry, analysis->raw_unmodified, analysis->raw_unmodified,
                       &analysis->unmodified_value);
  return EO_OK;
}

enum eo_code eo_analysis_run(struct eo_analysis *analysis, const struct eo_design *design, int want,
                             struct eo_error *error)
{
  struct eo_design *bare = malloc(sizeof *bare);
  if (!bare)
    return eo_error_memory(error);
  strip(bare, design);
  analysis->cases = design->load_cases;
  analysis->scenarios = eo_evaluator_scenarios(design);
  analysis->want = want;
  analysis->root = analysis->pair->flexibility && (want & EO_WANT_ROOT || eo_objective_wants_root(&design->objective));
  enum eo_code code = fit(analysis, analysis->cases, analysis->scenarios, error);
  if (!code)
    code = eo_evaluator_use_threads(analysis->evaluator, analysis->threads, error);
  if (!code)
    code = run_both(analysis, design, bare, want, error);
  if (code)
    memset(analysis->known, 0, sizeof *analysis->known);
  free(bare);
  return code;
}
