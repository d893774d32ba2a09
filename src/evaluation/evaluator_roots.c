/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <stdlib.h>
#include <string.h>

/* STEP: every other position, the stress is a smooth function of the phase. BATCH: ends at a time, so that the stresses
   of a tooth stay in the cache. */
enum { ROOT_STEP = 2, ROOT_BATCH = 8 };

static enum eo_code make_workspaces(struct eo_evaluator *evaluator, int half, int teeth, struct eo_error *error)
{
  const struct eo_pair *pair = eo_pair_half(evaluator->pair, half);
  const struct eo_root_modes *const modes[2] = {pair->root[0], pair->root[1]};
  int ends = 2 * evaluator->most_cases < ROOT_BATCH ? 2 * evaluator->most_cases : ROOT_BATCH;
  for (int thread = 0; thread < evaluator->threads; thread++)
    if (!evaluator->root[thread][half])
      EO_TRY(eo_root_workspace_new(&evaluator->root[thread][half], pair->grid, modes, ROOT_STEP, ends, error));
  if (!evaluator->peaks[half])
    evaluator->peaks[half] = malloc(sizeof **evaluator->peaks * (size_t)teeth * 4 * (size_t)evaluator->most_cases);
  return evaluator->peaks[half] ? EO_OK : eo_error_memory(error);
}

/* Ends whose root stress is neither valid from the last run nor that of the left one. */
static void list_ends(struct eo_roots *roots)
{
  struct eo_evaluator *evaluator = roots->evaluator;
  for (int k = 0; k < evaluator->result.cases; k++)
    for (int end = 0; end < evaluator->result.ends; end++)
      if (!evaluator->root_valid[end] && !(end == EO_RIGHT && roots->copies_left)) {
        struct eo_root_half *half = &roots->half[eo_evaluator_half(evaluator, end)];
        half->end[half->ends++] = &evaluator->result.load_case[k].end[end];
      }
}

/* One tooth of a member under a batch of ends. */
static void find_tooth(const struct eo_roots *roots, int thread, int number, int piece)
{
  const struct eo_root_half *half = &roots->half[number];
  int tooth = piece % half->teeth, member = piece / half->teeth % 2;
  int first = piece / half->teeth / 2 * ROOT_BATCH;
  int count = half->ends - first < ROOT_BATCH ? half->ends - first : ROOT_BATCH;
  const struct eo_loaded_end *loaded[ROOT_BATCH];
  struct eo_root_history *history[ROOT_BATCH];
  for (int i = 0; i < count; i++) {
    loaded[i] = &half->end[first + i]->loaded;
    history[i] = &half->end[first + i]->root[member];
  }
  eo_root_tooth_compute(roots->evaluator->root[thread][number], member, half->first_tooth + tooth, count, loaded,
                        history, roots->evaluator->peaks[number] + (member * half->teeth + tooth) * half->ends + first);
}

static int pieces_of(const struct eo_root_half *half)
{
  int batches = (half->ends + ROOT_BATCH - 1) / ROOT_BATCH;
  return batches * 2 * half->teeth;
}

/* Takes teeth until none is left. */
static void find_teeth(void *context, int thread)
{
  struct eo_roots *roots = context;
  EO_TIMED(roots->milliseconds[thread]);
  int left = pieces_of(&roots->half[0]), pieces = left + pieces_of(&roots->half[1]);
  for (int piece; (piece = atomic_fetch_add(&roots->next, 1)) < pieces;)
    find_tooth(roots, thread, piece >= left, piece >= left ? piece - left : piece);
}

enum eo_code eo_roots_begin(struct eo_roots *roots, struct eo_evaluator *evaluator, const struct eo_run *run,
                            struct eo_error *error)
{
  *roots = (struct eo_roots){.evaluator = evaluator,
                             .wanted = run->root,
                             .copies_left = eo_reuse_copies_left(evaluator, run->design),
                             .beside = {.work = find_teeth, .context = roots}};
  if (!run->root)
    return EO_OK;
  for (int half = 0; half < eo_pair_halves(evaluator->pair); half++) {
    int range[2];
    eo_contact_grid_pairs(eo_evaluator_grid(evaluator, half), range);
    roots->half[half].teeth = range[1] - range[0] + 1;
    roots->half[half].first_tooth = range[0];
    EO_TRY(make_workspaces(evaluator, half, roots->half[half].teeth, error));
  }
  list_ends(roots);
  eo_beside_start(&roots->beside, evaluator->threads);
  return EO_OK;
}

static void copy_history(const struct eo_root_history *from, struct eo_root_history *to)
{
  memcpy(to->phase, from->phase, sizeof *to->phase * (size_t)from->phases);
  memcpy(to->stress, from->stress, sizeof *to->stress * (size_t)from->phases);
  to->maximum = from->maximum;
  to->arc = from->arc;
  to->eta = from->eta;
}

/* The maximum of each history that was computed, and where it is. */
static void finish_histories(const struct eo_roots *roots)
{
  const struct eo_evaluator *evaluator = roots->evaluator;
  for (int k = 0; k < 4; k++) {
    int number = k / 2, member = k % 2;
    const struct eo_root_half *half = &roots->half[number];
    if (half->ends == 0)
      continue;
    const struct eo_pair *pair = eo_pair_half(evaluator->pair, number);
    struct eo_root root = eo_flexibility_root(pair->flexibility, member);
    for (int i = 0; i < half->ends; i++)
      eo_root_history_finish(&half->end[i]->root[member], &root, pair->grid, ROOT_STEP,
                             evaluator->peaks[number] + member * half->teeth * half->ends + i, half->ends);
  }
}

/* Ends that had none to compute: copies of the left one's, and those that are as they were (set_cases() hid them). */
static void complete_histories(const struct eo_roots *roots)
{
  struct eo_evaluation *result = &roots->evaluator->result;
  int steps = (result->positions + ROOT_STEP - 1) / ROOT_STEP;
  for (int k = 0; k < result->cases; k++)
    for (int member = 0; member < 2; member++)
      for (int end = 0; end < result->ends; end++) {
        struct eo_root_history *history = &result->load_case[k].end[end].root[member];
        if (end == EO_RIGHT && roots->copies_left)
          copy_history(&result->load_case[k].end[EO_LEFT].root[member], history);
        history->phases = roots->half[eo_evaluator_half(roots->evaluator, end)].teeth * steps;
      }
}

void eo_roots_finish(struct eo_roots *roots)
{
  struct eo_evaluator *evaluator = roots->evaluator;
  if (!roots->wanted)
    return;
  eo_beside_finish(&roots->beside);
  finish_histories(roots);
  complete_histories(roots);
  for (int end = 0; end < evaluator->result.ends; end++)
    evaluator->root_valid[end] = eo_reuse_stored_at(evaluator, end) == end;
  evaluator->result.root_ms = roots->milliseconds[0] + roots->milliseconds[1];
}
