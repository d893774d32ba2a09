/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <math.h>
#include <string.h>

int eo_evaluator_stagger(const struct eo_design *design, int positions)
{
  return (int)lround(design->alignment.stagger * positions) % positions;
}

bool eo_reuse_same_flanks(const struct eo_modification *modification)
{
  const struct eo_flank_modification(*flank)[2] = modification->flank;
  return eo_modification_equal(&flank[EO_PINION][EO_LEFT], &flank[EO_PINION][EO_RIGHT]) &&
         eo_modification_equal(&flank[EO_GEAR][EO_LEFT], &flank[EO_GEAR][EO_RIGHT]);
}

int eo_reuse_stored_at(const struct eo_evaluator *evaluator, int end)
{
  return evaluator->result.equal_ends ? EO_LEFT : end;
}

/* Equal ends that run in step carry equal loads however the pinion is held. */
bool eo_reuse_shares_unevenly(const struct eo_evaluator *evaluator, const struct eo_design *design)
{
  bool in_step = eo_evaluator_stagger(design, evaluator->pair->grid->positions) == 0;
  return evaluator->result.ends == 2 && evaluator->axial_stiffness > 0 && !(evaluator->result.equal_ends && in_step);
}

bool eo_reuse_copies_left(const struct eo_evaluator *evaluator, const struct eo_design *design)
{
  return evaluator->result.equal_ends && !eo_reuse_shares_unevenly(evaluator, design);
}

static bool equal_ends(const struct eo_evaluator *evaluator, const struct eo_run *run)
{
  return evaluator->result.ends == 2 && eo_reuse_same_flanks(&run->design->modification) &&
         run->scenario.in_plane == 0 && run->scenario.out_of_plane == 0 && !evaluator->elastic_bodies;
}

static struct eo_end_key key_of(const struct eo_evaluator *evaluator, const struct eo_run *run, int end)
{
  const struct eo_modification *modification = &run->design->modification;
  struct eo_end_key key = {.flank = {modification->flank[EO_PINION][end], modification->flank[EO_GEAR][end]},
                           .in_plane = run->scenario.in_plane,
                           .out_of_plane = run->scenario.out_of_plane,
                           .compliance = run->scenario.compliance,
                           .cases = evaluator->result.cases};
  for (int k = 0; k < key.cases; k++)
    key.force[k] = evaluator->result.load_case[k].force;
  return key;
}

static bool differs_from_solved(const struct eo_end_key *key, const struct eo_end_key *solved)
{
  bool same = key->cases == solved->cases && key->in_plane == solved->in_plane &&
              key->out_of_plane == solved->out_of_plane && key->compliance == solved->compliance &&
              eo_modification_equal(&key->flank[EO_PINION], &solved->flank[EO_PINION]) &&
              eo_modification_equal(&key->flank[EO_GEAR], &solved->flank[EO_GEAR]);
  for (int k = 0; k < key->cases && same; k++)
    same = key->force[k] == solved->force[k];
  return !same;
}

/* An end is solved when it differs from what is stored, unless it is a copy. Stored are the loads of an end alone: what
   bodies or a held pinion make of them belongs to this run only, the root stress of it as well; and a copied end leaves
   its own gaps and field behind. */
void eo_reuse_compare(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  evaluator->result.equal_ends = equal_ends(evaluator, run);
  bool alone = !evaluator->elastic_bodies && !eo_reuse_shares_unevenly(evaluator, run->design);
  for (int end = 0; end < evaluator->result.ends; end++) {
    bool copied = end == EO_RIGHT && evaluator->result.equal_ends;
    struct eo_end_key key = key_of(evaluator, run, end);
    evaluator->needs_solving[end] = !copied && differs_from_solved(&key, &evaluator->solved_for[end]);
    evaluator->root_valid[end] = evaluator->root_valid[end] && alone && !copied && !evaluator->needs_solving[end];
    evaluator->solved_for[end] = key;
    if (copied || !alone)
      evaluator->solved_for[end].cases = 0;
  }
}

void eo_reuse_forget(struct eo_evaluator *evaluator)
{
  for (int end = 0; end < 2; end++) {
    evaluator->solved_for[end].cases = 0;
    evaluator->root_valid[end] = false;
  }
}
