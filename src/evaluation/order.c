/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"
#include "evaluation/objective_terms.h"

static const struct eo_scenario nominal_scenario = {NAN, NAN, 1, 1};

/* Fills in what a scenario leaves to the design. */
static struct eo_run run_of(const struct eo_evaluator *evaluator, const struct eo_design *design,
                            const struct eo_scenario *scenario, int want)
{
  struct eo_run run = {.design = design, .scenario = scenario ? *scenario : nominal_scenario, .want = want};
  if (isnan(run.scenario.in_plane))
    run.scenario.in_plane = design->alignment.shaft_angle_in_plane;
  if (isnan(run.scenario.out_of_plane))
    run.scenario.out_of_plane = design->alignment.shaft_angle_out_of_plane;
  run.root = evaluator->pair->root && !(want & EO_WANT_CONTACT_ALONE) &&
             (want & EO_WANT_ROOT || eo_objective_wants_root(&design->objective));
  run.rating = !(want & EO_WANT_CONTACT_ALONE) && eo_objective_wants_rating(&design->objective);
  return run;
}

struct ends {
  struct eo_evaluator *evaluator;
  const struct eo_run *run;
  eo_end_step *step;
};

static void take_end(void *context, int thread, int end)
{
  const struct ends *ends = context;
  (void)thread;
  ends->step(ends->evaluator, ends->run, end);
}

/* Takes each end through a step, two ends at once where there are two threads. */
static void each_end(struct eo_evaluator *evaluator, const struct eo_run *run, eo_end_step *step)
{
  EO_TIMED(evaluator->result.static_ms);
  struct ends ends = {.evaluator = evaluator, .run = run, .step = step};
  eo_team_do(run->team, &(struct eo_work_list){take_end, &ends, .pieces = evaluator->result.ends});
}

/* The order of one evaluation: the list in src/README.md, call by call. */
static enum eo_code follow_order(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error)
{
  /* P of every load case: the torque over the base radius, shared by the ends */
  eo_evaluator_set_cases(evaluator, run);
  /* which flanks meet in each, in which sense and under which alignment; splines of grids that have changed */
  EO_TRY(eo_evaluator_find_meetings(evaluator, run, error));
  /* elastic shafts and bodies, made anew when they have changed */
  EO_TRY(eo_evaluator_fit_bodies(evaluator, run, error));
  /* springs that hold both ends to one axial position of the pinion */
  EO_TRY(eo_evaluator_find_hold(evaluator, run, error));
  /* which ends differ from what the last run solved; the others are kept */
  eo_reuse_compare(evaluator, run);

  /* slice gap, lead, tip corners, misalignment of each end, both at once */
  each_end(evaluator, run, eo_end_set_fields);
  /* the gaps that they make at every point */
  eo_evaluator_set_gaps(evaluator, run);
  /* root stress, tooth by tooth: by whichever thread has nothing else to do once the loads of an end are there */
  EO_TRY(eo_roots_begin(run->roots, evaluator, run, error));
  /* loaded contact, each end alone: Z, k_tan, line loads at every position and P */
  eo_evaluator_solve_cases(evaluator, run);
  /* equal ends: the right one carries what the left one does */
  eo_evaluator_copy_equal_end(evaluator);
  /* elastic bodies: gaps and loads until they agree */
  eo_evaluator_bend_cases(evaluator, run);
  /* a held pinion: the ends share the torque as the springs have it */
  eo_evaluator_balance_cases(evaluator, run);
  /* all loads are what they are: the rest of the root stress */
  eo_roots_offer_rest(run->roots);
  /* first contact, secant stiffness, pressure, edge load, load over the face of each end */
  each_end(evaluator, run, eo_end_summarise);
  /* transmission error of the pair */
  eo_evaluator_summarise_pairs(evaluator, run);
  /* entering impact: first touch, speed, force */
  eo_evaluator_find_impacts(evaluator, run);
  /* contact alone ends here; it has no root stress */
  if (run->want & EO_WANT_CONTACT_ALONE)
    return EO_OK;
  /* Z and k_tan of every end as mesh laws of the dynamic model */
  EO_TRY(eo_evaluator_set_laws(evaluator, run, error));
  /* the periodic state of every load case, two at once */
  EO_TRY(eo_evaluator_find_vibrations(evaluator, run, error));
  /* natural frequencies at the mean mesh stiffness */
  EO_TRY(eo_evaluator_find_modes(evaluator, run, error));
  /* teeth that are left; histories of the root stress and their maxima */
  eo_roots_finish(run->roots);

  /* contact and vibration again at other compliances */
  EO_TRY(eo_evaluator_find_band(evaluator, run, error));
  /* raw numbers of every load case, which f1, f2, f3, J and the fitness are made of */
  eo_evaluator_collect_objectives(evaluator, run);
  return EO_OK;
}

/* One run; after an error nothing that is kept can be relied on. */
static enum eo_code follow(struct eo_evaluator *evaluator, const struct eo_design *design,
                           const struct eo_scenario *scenario, int want, const struct eo_evaluation **evaluation,
                           struct eo_error *error)
{
  struct eo_run run = run_of(evaluator, design, scenario, want);
  struct eo_roots roots = {.evaluator = evaluator, .team = evaluator->team};
  run.team = evaluator->team;
  run.roots = &roots;
  enum eo_code code = run.rating ? eo_evaluator_lean(evaluator, &run, error) : EO_OK;
  if (!code) {
    code = follow_order(evaluator, &run, error);
    eo_team_settle(evaluator->team);
  }
  if (!code && run.rating)
    eo_evaluator_rate(evaluator, &run);
  if (code)
    eo_reuse_forget(evaluator);
  else
    *evaluation = &evaluator->result;
  return code;
}

enum eo_code eo_evaluator_run(struct eo_evaluator *evaluator, const struct eo_design *design,
                              const struct eo_scenario *scenario, int want, const struct eo_evaluation **evaluation,
                              struct eo_error *error)
{
  return follow(evaluator, design, scenario, want, evaluation, error);
}

enum eo_code eo_evaluator_contact(struct eo_evaluator *evaluator, const struct eo_design *design,
                                  const struct eo_evaluation **evaluation, struct eo_error *error)
{
  return eo_evaluator_contact_at(evaluator, design, NULL, evaluation, error);
}

enum eo_code eo_evaluator_contact_at(struct eo_evaluator *evaluator, const struct eo_design *design,
                                     const struct eo_scenario *scenario, const struct eo_evaluation **evaluation,
                                     struct eo_error *error)
{
  return follow(evaluator, design, scenario, EO_WANT_CONTACT_ALONE, evaluation, error);
}
