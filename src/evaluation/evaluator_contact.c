/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include <string.h>

/* Forgets what belongs to the last run alone. */
static void clear_case(struct eo_case_result *load_case)
{
  load_case->body_iterations = 0;
  load_case->at_stop = false;
  for (int reading = 0; reading < EO_READINGS; reading++)
    load_case->band[reading][0] = load_case->band[reading][1] = NAN;
  for (int end = 0; end < 2; end++) {
    load_case->end[end].deflection = (struct eo_deflection){0};
    for (int member = 0; member < 2; member++)
      load_case->end[end].root[member].phases = 0;
  }
}

/* P = T / (ends r_b cos(beta_b)), normal to the flank; of unequal helices each end's own. */
void eo_evaluator_set_cases(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  const struct eo_geometry *geometry = &evaluator->pair->geometry;
  const struct eo_double_helix helix = eo_pair_double_helix(evaluator->pair);
  struct eo_evaluation *result = &evaluator->result;
  result->ends = run->design->gear_pair.ends;
  result->cases = run->design->load_cases;
  result->static_ms = result->impact_ms = result->dynamics_ms = result->root_ms = 0;
  result->solutions = 0;
  for (int k = 0; k < result->cases; k++) {
    struct eo_case_result *load_case = &result->load_case[k];
    load_case->load_case = run->design->load_case[k];
    /* theory (Y3) */
    load_case->force = load_case->load_case.torque /
                       (result->ends * geometry->base_radius[EO_PINION] * cos(geometry->base_helix_angle));
    for (int end = 0; end < 2; end++)
      load_case->end_force[end] = load_case->even_force[end] = eo_double_helix_load(&helix, end, load_case->force);
    clear_case(load_case);
  }
}

static void drop_bodies(struct eo_evaluator *evaluator)
{
  for (int inwards = 0; inwards < 2; inwards++) {
    eo_elastic_free(evaluator->elastic_bodies[inwards]);
    evaluator->elastic_bodies[inwards] = NULL;
  }
}

/* Makes the bodies' influence when the design asks for elastic bodies and they have changed, for each way in which eta
   runs. */
enum eo_code eo_evaluator_fit_bodies(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error)
{
  EO_TIMED(evaluator->result.static_ms);
  const struct eo_shafts *shafts = &run->design->shafts;
  const struct eo_pair *pair = evaluator->pair;
  const struct eo_contact_grid *const grid[2] = {eo_evaluator_grid(evaluator, EO_LEFT),
                                                 eo_evaluator_grid(evaluator, EO_RIGHT)};
  evaluator->bodies_are_elastic = shafts->enabled;
  if (!shafts->enabled)
    return EO_OK;
  if (!evaluator->gaps_on_bent_bodies.gap)
    EO_TRY(eo_loaded_gaps_init(&evaluator->gaps_on_bent_bodies, eo_evaluator_larger_grid(evaluator), error));
  if (!eo_shafts_equal(shafts, &evaluator->shafts))
    drop_bodies(evaluator);
  evaluator->shafts = *shafts;
  for (int m = 0; m < evaluator->meetings; m++) {
    bool inwards = evaluator->meeting[m]->running.inwards;
    if (!evaluator->elastic_bodies[inwards])
      EO_TRY(eo_elastic_new(&evaluator->elastic_bodies[inwards], grid, &pair->gear_pair, shafts, inwards, error));
  }
  return EO_OK;
}

/* A floating pinion passes a coupling's thrust on to the teeth, as far as both ends stay loaded. */
static enum eo_code share_thrust(struct eo_evaluator *evaluator, const struct eo_design *design, struct eo_error *error)
{
  struct eo_evaluation *result = &evaluator->result;
  const struct eo_double_helix helix = eo_pair_double_helix(evaluator->pair);
  for (int k = 0; k < result->cases; k++) {
    struct eo_case_result *load_case = &result->load_case[k];
    struct eo_axial_hold hold = eo_meeting_hold(evaluator, design, load_case);
    if (fabs(hold.shift) >= load_case->force)
      return eo_error_set(error, EO_ERROR_INPUT, "/alignment/coupling_thrust_N",
                          "A thrust of %.6g N takes all load off one end of the pinion at %.6g N m: at most %.6g N.",
                          design->alignment.coupling_thrust, load_case->load_case.torque,
                          2 * load_case->force * helix.lean[hold.shift > 0 ? EO_LEFT : EO_RIGHT]);
    if (hold.stiffness == 0) {
      load_case->end_force[EO_LEFT] = load_case->force + hold.shift;
      load_case->end_force[EO_RIGHT] = (load_case->force - hold.shift) * helix.scale[EO_RIGHT];
    }
  }
  return EO_OK;
}

/* How stiffly the ends are held to one axial position of the pinion: the springs of the dynamic model at rest, so that
   the loads here and the mean forces of the vibration are the same. Elastic bodies twist in the gaps already: their
   grooves count as rigid here. */
enum eo_code eo_evaluator_find_hold(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error)
{
  const struct eo_design *design = run->design;
  struct eo_dynamics_parameters parameters;
  struct eo_dynamics_model model;
  evaluator->axial_stiffness = evaluator->axial_rest = 0;
  if (design->gear_pair.ends == 1 || eo_alignment_axial_stiffness(&design->alignment) == 0)
    return share_thrust(evaluator, design, error);
  EO_TRY(eo_evaluator_parameters(evaluator, design, 1, true, &parameters, error));
  for (int member = 0; member < 2; member++)
    if (design->shafts.enabled && parameters.groove_torsional_stiffness[member] > 0) {
      parameters.groove_torsional_stiffness[member] = INFINITY;
      parameters.groove_torsional_damping[member] = 0;
    }
  EO_TRY(eo_dynamics_model_init(&model, &parameters, error));
  evaluator->axial_stiffness = eo_dynamics_model_axial_stiffness(&model);
  evaluator->axial_rest = eo_dynamics_model_axial_rest(&model);
  return share_thrust(evaluator, design, error);
}

void eo_end_set_fields(struct eo_evaluator *evaluator, const struct eo_run *run, int end)
{
  if (!evaluator->needs_solving[end])
    return;
  for (int m = 0; m < evaluator->meetings; m++) {
    struct eo_meeting *meeting = evaluator->meeting[m];
    const enum eo_flank_side side = meeting->running.flank;
    const struct eo_flank_spline *const spline[2] = {evaluator->spline[side][EO_PINION][end],
                                                     evaluator->spline[side][EO_GEAR][end]};
    eo_meeting_field_init(&meeting->field[end], eo_pair_half(evaluator->pair, end), run->design, spline,
                          &meeting->running, end);
    meeting->datum[end] = eo_gap_field_datum(&meeting->field[end]);
    meeting->incoming[end].known = 0;
  }
}

enum { GAP_PARTS = 4 }; /* of the mesh cycle, so that two threads share the gaps of one end */

struct gap_parts {
  const struct eo_evaluator *evaluator;
  int count;
  struct {
    struct eo_meeting *meeting;
    int end;
  } of[2 * EO_MAX_LOAD_CASES];
};

static void set_part(void *context, int thread, int piece)
{
  const struct gap_parts *parts = context;
  struct eo_meeting *meeting = parts->of[piece / GAP_PARTS].meeting;
  int end = parts->of[piece / GAP_PARTS].end, part = piece % GAP_PARTS;
  const struct eo_contact_grid *grid = eo_evaluator_grid(parts->evaluator, end);
  (void)thread;
  eo_loaded_gaps_set_some(&meeting->gaps[end], grid, &meeting->field[end], grid->positions * part / GAP_PARTS,
                          grid->positions * (part + 1) / GAP_PARTS);
}

void eo_evaluator_set_gaps(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  struct gap_parts parts = {.evaluator = evaluator};
  EO_TIMED(evaluator->result.static_ms);
  for (int end = 0; end < evaluator->result.ends; end++)
    for (int m = 0; m < evaluator->meetings && evaluator->needs_solving[end]; m++) {
      parts.of[parts.count].meeting = evaluator->meeting[m];
      parts.of[parts.count++].end = end;
    }
  eo_team_do(run->team, &(struct eo_work_list){set_part, &parts, .pieces = parts.count * GAP_PARTS});
}

/* Solutions in batches: one thread's share of those that stand together and have the same gaps. */
struct batches {
  struct eo_evaluator *evaluator;
  const struct eo_run *run;
  const struct eo_solution *solution;
  int solutions, most; /* most: in a batch */
};

/* Where the batch that begins at `first` ends. */
static int end_of_batch(const struct batches *batches, int first)
{
  int last = first + 1;
  while (last < batches->solutions && last < first + batches->most &&
         batches->solution[last].gaps == batches->solution[first].gaps)
    last++;
  return last;
}

/* Those of a batch whose loads are what they are in the end: their root stress may begin. */
static void offer_roots(const struct batches *batches, int first, int last)
{
  struct eo_end_result *owner[EO_EVALUATOR_BATCH];
  int count = 0;
  for (int i = first; i < last && batches->run->roots->early; i++)
    if (batches->solution[i].owner)
      owner[count++] = batches->solution[i].owner;
  eo_roots_offer(batches->run->roots, count, owner);
}

static void solve_batch(void *context, int thread, int batch)
{
  const struct batches *batches = context;
  struct eo_loaded_end loaded[EO_EVALUATOR_BATCH];
  double load[EO_EVALUATOR_BATCH] = {0};
  int first = 0, last = end_of_batch(batches, 0);
  for (int i = 0; i < batch; i++) {
    first = last;
    last = end_of_batch(batches, first);
  }
  for (int i = first; i < last; i++) {
    load[i - first] = batches->solution[i].load;
    loaded[i - first] = *batches->solution[i].result;
  }
  int end = batches->solution[first].end;
  eo_loaded_solve(eo_evaluator_workspace(batches->evaluator, thread, end), eo_evaluator_grid(batches->evaluator, end),
                  batches->solution[first].gaps, batches->run->scenario.compliance, last - first, load, loaded);
  for (int i = first; i < last; i++)
    batches->solution[i].result->failures = loaded[i - first].failures;
  offer_roots(batches, first, last);
}

void eo_evaluator_solve(struct eo_evaluator *evaluator, const struct eo_run *run, int solutions,
                        const struct eo_solution *solution)
{
  int share = (solutions + evaluator->threads - 1) / evaluator->threads, count = 0;
  struct batches batches = {evaluator, run, solution, solutions,
                            share < EO_EVALUATOR_BATCH ? share : EO_EVALUATOR_BATCH};
  for (int first = 0; first < solutions; first = end_of_batch(&batches, first))
    count++;
  eo_team_do(run->team, &(struct eo_work_list){solve_batch, &batches, .pieces = count});
  evaluator->result.solutions += solutions;
}

void eo_evaluator_solve_cases(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  struct eo_evaluation *result = &evaluator->result;
  struct eo_solution solution[2 * EO_MAX_LOAD_CASES];
  int solutions = 0;
  EO_TIMED(result->static_ms);
  for (int end = 0; end < result->ends; end++)
    for (int m = 0; m < evaluator->meetings && evaluator->needs_solving[end]; m++)
      for (int k = 0; k < result->cases; k++)
        if (evaluator->meeting_of[k] == m) {
          struct eo_end_result *owner = &result->load_case[k].end[end];
          struct eo_loaded_end *loaded = &owner->loaded;
          loaded->around = evaluator->solved_for[end].around && !evaluator->bodies_are_elastic;
          solution[solutions++] = (struct eo_solution){end, &evaluator->meeting[m]->gaps[end],
                                                       result->load_case[k].end_force[end], loaded, owner};
        }
  eo_evaluator_solve(evaluator, run, solutions, solution);
}

static void copy_loads(const struct eo_contact_grid *grid, struct eo_loaded_end *to, const struct eo_loaded_end *from)
{
  size_t n = (size_t)grid->positions;
  memcpy(to->load, from->load, n * sizeof(double));
  memcpy(to->approach, from->approach, n * sizeof(double));
  memcpy(to->tangent, from->tangent, n * sizeof(double));
  memcpy(to->nearby, from->nearby, n * EO_LOADED_NEARBY * sizeof(double));
  memcpy(to->line_load, from->line_load, (size_t)grid->points * sizeof(double));
  to->failures = from->failures;
}

void eo_evaluator_copy_equal_end(struct eo_evaluator *evaluator)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->static_ms);
  for (int k = 0; k < result->cases && result->equal_ends; k++)
    copy_loads(evaluator->pair->grid, &result->load_case[k].end[EO_RIGHT].loaded,
               &result->load_case[k].end[EO_LEFT].loaded);
}

/* The loads about that of an end, on bodies that stay as they are. */
static void find_around(struct eo_evaluator *evaluator, const struct eo_run *run,
                        const struct eo_case_result *load_case, struct eo_loaded_end both[2], int end)
{
  double *gap = evaluator->gaps_on_bent_bodies.gap;
  eo_elastic_gaps(eo_meeting_bodies(evaluator, &load_case->running), eo_meeting_of(evaluator, load_case)->gaps,
                  eo_evaluator_stagger(evaluator->pair, run->design, &load_case->running), both, end, gap);
  eo_loaded_find_nearby(eo_evaluator_workspace(evaluator, 0, end), eo_evaluator_grid(evaluator, end), gap,
                        run->scenario.compliance, &both[end]);
}

/* A solution that failed to converge on elastic bodies is counted at the left end. */
void eo_evaluator_bend_bodies(struct eo_evaluator *evaluator, const struct eo_run *run,
                              const struct eo_case_result *load_case, struct eo_loaded_end both[2],
                              struct eo_elastic_report *report)
{
  const struct eo_running *running = &load_case->running;
  struct eo_elastic_case load = {load_case->force, run->scenario.compliance,
                                 eo_meeting_hold(evaluator, run->design, load_case),
                                 eo_evaluator_stagger(evaluator->pair, run->design, running)};
  struct eo_loaded_workspace *const workspace[2] = {eo_evaluator_workspace(evaluator, 0, EO_LEFT),
                                                    eo_evaluator_workspace(evaluator, 0, EO_RIGHT)};
  eo_elastic_solve(eo_meeting_bodies(evaluator, running), workspace, eo_meeting_of(evaluator, load_case)->gaps, &load,
                   both, report);
  both[EO_LEFT].failures += report->failures;
  for (int end = 0; end < 2; end++)
    if (evaluator->solved_for[end].around)
      find_around(evaluator, run, load_case, both, end);
}

void eo_evaluator_bend_cases(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->static_ms);
  if (!evaluator->bodies_are_elastic)
    return;
  for (int k = 0; k < result->cases; k++) {
    struct eo_case_result *load_case = &result->load_case[k];
    struct eo_loaded_end both[2] = {load_case->end[EO_LEFT].loaded, load_case->end[EO_RIGHT].loaded};
    struct eo_elastic_report report;
    eo_evaluator_bend_bodies(evaluator, run, load_case, both, &report);
    load_case->body_iterations = report.most_iterations;
    for (int end = 0; end < result->ends; end++) {
      load_case->end[end].loaded.failures = both[end].failures;
      load_case->end[end].deflection = report.mean[end];
    }
  }
}

/* Both ends of one load case from what they are alone; on elastic bodies the springs have had their say already. */
static void balance_case(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_case_result *load_case)
{
  const struct eo_meeting *meeting = eo_meeting_of(evaluator, load_case);
  const struct eo_loaded_half half[2] = {
      {eo_evaluator_workspace(evaluator, 0, EO_LEFT), eo_evaluator_grid(evaluator, EO_LEFT), &meeting->gaps[EO_LEFT]},
      {eo_evaluator_workspace(evaluator, 0, EO_RIGHT), eo_evaluator_grid(evaluator, EO_RIGHT),
       &meeting->gaps[eo_reuse_stored_at(evaluator, EO_RIGHT)]}};
  struct eo_loaded_end both[2] = {load_case->end[EO_LEFT].loaded, load_case->end[EO_RIGHT].loaded};
  struct eo_axial_hold hold = eo_meeting_hold(evaluator, run->design, load_case);
  int stagger = eo_evaluator_stagger(evaluator->pair, run->design, &load_case->running);
  eo_loaded_balance(half, run->scenario.compliance, &hold, stagger, load_case->force, both);
  for (int end = 0; end < 2; end++)
    load_case->end[end].loaded.failures = both[end].failures;
}

/* Whether a pinion with play is at a stop, on the mean over the mesh cycle. */
static bool is_at_stop(const struct eo_evaluator *evaluator, const struct eo_run *run,
                       const struct eo_case_result *load_case)
{
  struct eo_axial_hold hold = eo_meeting_hold(evaluator, run->design, load_case);
  double scale = eo_pair_double_helix(evaluator->pair).scale[EO_RIGHT],
         apart = -hold.rest * evaluator->result.positions;
  for (int j = 0; j < evaluator->result.positions && hold.play > 0; j++)
    apart += load_case->end[EO_LEFT].loaded.approach[j] - load_case->end[EO_RIGHT].loaded.approach[j] * scale;
  return hold.play > 0 && fabs(apart) >= hold.play * evaluator->result.positions;
}

void eo_evaluator_balance_cases(struct eo_evaluator *evaluator, const struct eo_run *run)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->static_ms);
  bool rigid = !evaluator->bodies_are_elastic && eo_reuse_shares_unevenly(evaluator, run->design);
  for (int k = 0; k < result->cases; k++) {
    if (rigid)
      balance_case(evaluator, run, &result->load_case[k]);
    result->load_case[k].at_stop = result->ends == 2 && is_at_stop(evaluator, run, &result->load_case[k]);
  }
}
