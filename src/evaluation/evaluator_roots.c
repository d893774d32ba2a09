/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <stdlib.h>
#include <string.h>

/* At every position: the edge of a tip can touch at a single one, and makes the largest stress there. */
enum { ROOT_STEP = 1 };

/* Of as many ends as there are to compute. */
static enum eo_code make_loads(struct eo_evaluator *evaluator, int half, int ends, struct eo_error *error)
{
  if (!evaluator->root_loads[half])
    evaluator->root_loads[half] = calloc(2 * (size_t)evaluator->most_cases, sizeof **evaluator->root_loads);
  if (!evaluator->root_loads[half])
    return eo_error_memory(error);
  for (int i = 0; i < ends; i++)
    if (!evaluator->root_loads[half][i].force)
      EO_TRY(eo_root_loads_init(&evaluator->root_loads[half][i], eo_pair_half(evaluator->pair, half)->root, ROOT_STEP,
                                error));
  return EO_OK;
}

static enum eo_code make_workspaces(struct eo_evaluator *evaluator, int half, int teeth, struct eo_error *error)
{
  const struct eo_pair *pair = eo_pair_half(evaluator->pair, half);
  int ends = 2 * evaluator->most_cases < EO_ROOT_BATCH ? 2 * evaluator->most_cases : EO_ROOT_BATCH;
  for (int thread = 0; thread < evaluator->threads; thread++)
    if (!evaluator->root[thread][half])
      EO_TRY(eo_root_workspace_new(&evaluator->root[thread][half], pair->root, ends, error));
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

/* One tooth of a member under a group of ends. */
static void find_tooth(void *context, int thread, int piece)
{
  const struct eo_root_group *group = context;
  struct eo_roots *roots = group->roots;
  EO_TIMED(roots->milliseconds[thread]);
  const struct eo_root_half *half = &roots->half[group->half];
  int tooth = piece % half->teeth, member = piece / half->teeth;
  const struct eo_root_loads *loads[EO_ROOT_BATCH];
  struct eo_root_history *history[EO_ROOT_BATCH];
  struct eo_root_peak found[EO_ROOT_BATCH],
      *peak = roots->evaluator->peaks[group->half] + (member * half->teeth + tooth) * half->ends;
  for (int i = 0; i < group->ends; i++) {
    loads[i] = &roots->evaluator->root_loads[group->half][group->place[i]];
    history[i] = &group->end[i]->root[member];
  }
  eo_root_tooth_compute(roots->evaluator->root[thread][group->half], member, half->first_tooth + tooth, group->ends,
                        loads, history, found);
  for (int i = 0; i < group->ends; i++)
    peak[group->place[i]] = found[i];
}

static int place_of(const struct eo_root_half *half, const struct eo_end_result *end)
{
  int place = 0;
  while (place < half->ends && half->end[place] != end)
    place++;
  return place;
}

static void offer_group(struct eo_roots *roots, int number, int ends, const int *place)
{
  struct eo_evaluator *evaluator = roots->evaluator;
  struct eo_root_half *half = &roots->half[number];
  struct eo_root_group *group = &roots->group[atomic_fetch_add(&roots->groups, 1)];
  *group = (struct eo_root_group){.roots = roots, .half = number, .ends = ends};
  group->list = (struct eo_work_list){find_tooth, group, .pieces = 2 * half->teeth, .filler = true};
  for (int i = 0; i < ends; i++) {
    half->offered[place[i]] = true;
    group->place[i] = place[i];
    group->end[i] = half->end[place[i]];
    eo_root_loads_find(&evaluator->root_loads[number][place[i]], eo_pair_half(evaluator->pair, number)->root,
                       &group->end[i]->loaded);
  }
  eo_team_offer(roots->team, &group->list);
}

/* Those of the places that are not offered yet, in groups. */
static void offer_places(struct eo_roots *roots, int number, int count, const int *place)
{
  int waiting[EO_ROOT_BATCH], n = 0;
  for (int i = 0; i < count; i++) {
    if (!roots->half[number].offered[place[i]])
      waiting[n++] = place[i];
    if (n > 0 && (n == EO_ROOT_BATCH || i == count - 1)) {
      offer_group(roots, number, n, waiting);
      n = 0;
    }
  }
}

void eo_roots_offer(struct eo_roots *roots, int ends, struct eo_end_result *const *end)
{
  for (int number = 0; number < 2; number++) {
    int place[EO_MAX_LOAD_CASES * 2], count = 0;
    for (int i = 0; i < ends; i++) {
      place[count] = place_of(&roots->half[number], end[i]);
      count += place[count] < roots->half[number].ends;
    }
    offer_places(roots, number, count, place);
  }
}

void eo_roots_offer_rest(struct eo_roots *roots)
{
  for (int number = 0; number < 2; number++)
    eo_roots_offer(roots, roots->half[number].ends, roots->half[number].end);
}

enum eo_code eo_roots_begin(struct eo_roots *roots, struct eo_evaluator *evaluator, const struct eo_run *run,
                            struct eo_error *error)
{
  roots->wanted = run->root;
  if (!run->root)
    return EO_OK;
  roots->early = !evaluator->bodies_are_elastic && !eo_reuse_shares_unevenly(evaluator, run->design);
  roots->copies_left = eo_reuse_copies_left(evaluator, run->design);
  for (int half = 0; half < eo_pair_halves(evaluator->pair); half++) {
    int range[2];
    eo_contact_grid_pairs(eo_evaluator_grid(evaluator, half), range);
    roots->half[half].teeth = range[1] - range[0] + 1;
    roots->half[half].first_tooth = range[0];
    EO_TRY(make_workspaces(evaluator, half, roots->half[half].teeth, error));
  }
  list_ends(roots);
  for (int half = 0; half < eo_pair_halves(evaluator->pair); half++)
    EO_TRY(make_loads(evaluator, half, roots->half[half].ends, error));
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
  eo_team_settle(roots->team);
  finish_histories(roots);
  complete_histories(roots);
  for (int end = 0; end < evaluator->result.ends; end++)
    evaluator->root_valid[end] = eo_reuse_stored_at(evaluator, end) == end;
  evaluator->result.root_ms = roots->milliseconds[0] + roots->milliseconds[1];
}
