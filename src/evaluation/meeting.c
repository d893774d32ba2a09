/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the teeth of a load case meet: which flanks, in which sense, under which alignment. Load cases that meet alike
   share their gaps. */
#include "evaluation/evaluator_private.h"

#include <stdlib.h>

/* The errors of a load case: its own ones move with those of a scenario. */
static double error_of(double own, double nominal, double scenario)
{
  return own == nominal ? scenario : own + (scenario - nominal);
}

static struct eo_running running_of(const struct eo_run *run, int k)
{
  const struct eo_alignment *alignment = &run->design->alignment;
  struct eo_running running = eo_design_running(run->design, k);
  running.in_plane = error_of(running.in_plane, alignment->shaft_angle_in_plane, run->scenario.in_plane);
  running.out_of_plane = error_of(running.out_of_plane, alignment->shaft_angle_out_of_plane,
                                  run->scenario.out_of_plane);
  return running;
}

/* Gaps do not know in which sense they are passed. */
static bool meet_alike(const struct eo_running *a, const struct eo_running *b)
{
  return a->flank == b->flank && a->inwards == b->inwards && a->in_plane == b->in_plane &&
         a->out_of_plane == b->out_of_plane;
}

static enum eo_code add_meeting(struct eo_evaluator *evaluator, const struct eo_running *running,
                                struct eo_error *error)
{
  struct eo_meeting **place = &evaluator->meeting[evaluator->meetings];
  if (!*place) {
    *place = calloc(1, sizeof **place);
    if (!*place)
      return eo_error_memory(error);
    for (int end = 0; end < 2; end++)
      EO_TRY(eo_loaded_gaps_init(&(*place)->gaps[end], eo_evaluator_grid(evaluator, end), error));
  }
  (*place)->running = *running;
  evaluator->meetings++;
  return EO_OK;
}

static enum eo_code fit_splines(struct eo_evaluator *evaluator, const struct eo_design *design, struct eo_error *error)
{
  const struct eo_flank_grids *grids = &design->grids;
  if (eo_modification_has_nodes(&design->modification)) {
    evaluator->laid_grids = *grids;
    eo_modification_lay_nodes(&design->modification, &evaluator->laid_grids);
    grids = &evaluator->laid_grids;
  }
  if (eo_flank_grids_equal(grids, &evaluator->grids))
    return EO_OK;
  eo_reuse_forget(evaluator);
  evaluator->grids = (struct eo_flank_grids){0};
  for (int i = 0; i < 8; i++) {
    struct eo_flank_spline **spline = &evaluator->spline[i / 4][i / 2 % 2][i % 2];
    struct eo_flank_grid grid = eo_flank_grid_at(grids, (enum eo_flank_side)(i / 4), i / 2 % 2, i % 2);
    eo_flank_spline_free(*spline);
    *spline = NULL;
    if (grid.u_knots)
      EO_TRY(eo_flank_spline_new(spline, &grid, error));
  }
  evaluator->grids = *grids;
  return EO_OK;
}

enum eo_code eo_evaluator_find_meetings(struct eo_evaluator *evaluator, const struct eo_run *run,
                                        struct eo_error *error)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->static_ms);
  evaluator->meetings = 0;
  for (int k = 0; k < result->cases; k++) {
    struct eo_running running = running_of(run, k);
    int m = 0;
    while (m < evaluator->meetings && !meet_alike(&running, &evaluator->meeting[m]->running))
      m++;
    if (m == evaluator->meetings)
      EO_TRY(add_meeting(evaluator, &running, error));
    evaluator->meeting_of[k] = m;
    result->load_case[k].running = running;
  }
  return fit_splines(evaluator, run->design, error);
}

struct eo_meeting *eo_meeting_of(const struct eo_evaluator *evaluator, const struct eo_case_result *load_case)
{
  return evaluator->meeting[evaluator->meeting_of[load_case - evaluator->result.load_case]];
}

struct eo_axial_hold eo_meeting_hold(const struct eo_evaluator *evaluator, const struct eo_design *design,
                                     const struct eo_case_result *load_case)
{
  struct eo_axial_hold hold = eo_meeting_axial_hold(evaluator->pair, design, &load_case->running, load_case->force,
                                                    evaluator->axial_stiffness);
  hold.rest = load_case->force * evaluator->axial_rest;
  return hold;
}

struct eo_elastic *eo_meeting_bodies(const struct eo_evaluator *evaluator, const struct eo_running *running)
{
  return evaluator->bodies_are_elastic ? evaluator->elastic_bodies[running->inwards] : NULL;
}

void eo_meetings_done(struct eo_evaluator *evaluator)
{
  for (int m = 0; m < EO_MAX_LOAD_CASES; m++)
    if (evaluator->meeting[m]) {
      for (int end = 0; end < 2; end++)
        eo_loaded_gaps_done(&evaluator->meeting[m]->gaps[end]);
      free(evaluator->meeting[m]);
    }
  for (int i = 0; i < 8; i++)
    eo_flank_spline_free(evaluator->spline[i / 4][i / 2 % 2][i % 2]);
  for (int inwards = 0; inwards < 2; inwards++)
    eo_elastic_free(evaluator->elastic_bodies[inwards]);
}
