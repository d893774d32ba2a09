/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <math.h>
#include <string.h>

/* On the coast flanks phases grow the other way round the shafts. */
int eo_evaluator_stagger_of(const struct eo_pair *pair, const struct eo_design *design,
                            const struct eo_running *running, int positions)
{
  int behind = (int)lround(design->alignment.stagger * positions) % positions;
  int ahead = (int)lround((double)pair->ahead[running->inwards] * positions / pair->grid->positions);
  if (running->flank == EO_COAST_FLANK)
    behind = -behind;
  behind = (behind - ahead) % positions;
  return behind < 0 ? behind + positions : behind;
}

int eo_evaluator_stagger(const struct eo_pair *pair, const struct eo_design *design, const struct eo_running *running)
{
  return eo_evaluator_stagger_of(pair, design, running, pair->grid->positions);
}

bool eo_reuse_same_flanks(const struct eo_design *design)
{
  const struct eo_modification *modification = &design->modification;
  bool same = true;
  for (int member = 0; member < 2 && same; member++) {
    same = eo_modification_equal(&modification->flank[member][EO_LEFT], &modification->flank[member][EO_RIGHT]) &&
           eo_modification_equal(&modification->coast[member][EO_LEFT], &modification->coast[member][EO_RIGHT]);
    for (int side = 0; side < 2 && same; side++) {
      struct eo_flank_grid left = eo_flank_grid_at(&design->grids, (enum eo_flank_side)side, member, EO_LEFT),
                           right = eo_flank_grid_at(&design->grids, (enum eo_flank_side)side, member, EO_RIGHT);
      same = eo_flank_grid_equal(&left, &right);
    }
  }
  return same;
}

int eo_reuse_stored_at(const struct eo_evaluator *evaluator, int end)
{
  return evaluator->result.equal_ends ? EO_LEFT : end;
}

/* Equal ends that run in step, without a thrust, carry equal loads however the pinion is held. */
bool eo_reuse_shares_unevenly(const struct eo_evaluator *evaluator, const struct eo_design *design)
{
  const struct eo_running drive = {.flank = EO_DRIVE_FLANK};
  bool in_step = eo_evaluator_stagger(evaluator->pair, design, &drive) == 0 &&
                 (design->alignment.coupling_thrust == 0 || design->alignment.pinion_axial == EO_AXIAL_FIXED);
  return evaluator->result.ends == 2 && evaluator->axial_stiffness > 0 && !(evaluator->result.equal_ends && in_step);
}

bool eo_reuse_copies_left(const struct eo_evaluator *evaluator, const struct eo_design *design)
{
  return evaluator->result.equal_ends && !eo_reuse_shares_unevenly(evaluator, design);
}

static bool equal_ends(const struct eo_evaluator *evaluator, const struct eo_run *run)
{
  const double *offset = run->design->alignment.apex_offset;
  bool equal = evaluator->result.ends == 2 && !evaluator->pair->right && eo_reuse_same_flanks(run->design) &&
               !evaluator->bodies_are_elastic && offset[EO_PINION] == offset[EO_GEAR];
  for (int k = 0; k < evaluator->result.cases && equal; k++) {
    const struct eo_case_result *case_result = &evaluator->result.load_case[k];
    equal = case_result->running.in_plane == 0 && case_result->running.out_of_plane == 0 &&
            case_result->end_force[EO_LEFT] == case_result->end_force[EO_RIGHT];
  }
  return equal;
}

static struct eo_end_key key_of(const struct eo_evaluator *evaluator, const struct eo_run *run, int end)
{
  const struct eo_modification *modification = &run->design->modification;
  const double *offset = run->design->alignment.apex_offset;
  struct eo_end_key key = {.offset = end == EO_LEFT ? 0 : offset[EO_PINION] - offset[EO_GEAR],
                           .compliance = run->scenario.compliance,
                           .around = !(run->want & EO_WANT_CONTACT_ALONE) &&
                                     eo_evaluator_wants_around(evaluator, run->design),
                           .cases = evaluator->result.cases};
  for (int member = 0; member < 2; member++) {
    key.flank[EO_DRIVE_FLANK][member] = modification->flank[member][end];
    key.flank[EO_COAST_FLANK][member] = modification->coast[member][end];
  }
  for (int k = 0; k < key.cases; k++) {
    key.running[k] = evaluator->result.load_case[k].running;
    key.force[k] = evaluator->result.load_case[k].end_force[end];
  }
  return key;
}

static bool same_running(const struct eo_running *a, const struct eo_running *b)
{
  return a->flank == b->flank && a->backwards == b->backwards && a->inwards == b->inwards &&
         a->in_plane == b->in_plane && a->out_of_plane == b->out_of_plane;
}

static bool differs_from_solved(const struct eo_end_key *key, const struct eo_end_key *solved)
{
  bool same = key->cases == solved->cases && key->offset == solved->offset && key->compliance == solved->compliance &&
              key->around <= solved->around;
  for (int i = 0; i < 4 && same; i++)
    same = eo_modification_equal(&key->flank[i / 2][i % 2], &solved->flank[i / 2][i % 2]);
  for (int k = 0; k < key->cases && same; k++)
    same = key->force[k] == solved->force[k] && same_running(&key->running[k], &solved->running[k]);
  return !same;
}

/* The mesh laws of an end belong to no loads. */
static void forget_laws(struct eo_evaluator *evaluator, int end)
{
  for (int k = 0; k < evaluator->most_cases; k++)
    evaluator->law_of[k][end] = (struct eo_law_key){0};
}

/* An end is solved when it differs from what is stored, unless it is a copy. Stored are the loads of an end alone: what
   bodies or a held pinion make of them belongs to this run only, the root stress and the mesh laws of it as well; and a
   copied end leaves its own gaps and field behind. */
void eo_reuse_compare(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  evaluator->result.equal_ends = equal_ends(evaluator, run);
  evaluator->result.torsion_left_out = evaluator->result.ends == 2 && !evaluator->result.equal_ends &&
                                       !evaluator->pair->right && eo_reuse_same_flanks(run->design) &&
                                       run->design->supports.torsional_coupling == EO_COUPLING_PAPER &&
                                       eo_alignment_axial_stiffness(&run->design->alignment) == 0;
  bool alone = !evaluator->bodies_are_elastic && !eo_reuse_shares_unevenly(evaluator, run->design);
  for (int end = 0; end < evaluator->result.ends; end++) {
    bool copied = end == EO_RIGHT && evaluator->result.equal_ends;
    struct eo_end_key key = key_of(evaluator, run, end);
    evaluator->needs_solving[end] = !copied && differs_from_solved(&key, &evaluator->solved_for[end]);
    evaluator->kept[end] = alone && !copied && !evaluator->needs_solving[end];
    evaluator->root_valid[end] = evaluator->root_valid[end] && evaluator->kept[end];
    if (!alone || copied || evaluator->needs_solving[end])
      forget_laws(evaluator, end);
    key.around = key.around || (!evaluator->needs_solving[end] && evaluator->solved_for[end].around);
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
    forget_laws(evaluator, end);
  }
}
