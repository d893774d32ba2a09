/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/evaluator_private.h"

#include "numerics/periodic.h"

/* A half sine from the first touch, as long as the impact, at most a mesh period. */
void eo_evaluator_pulses(const struct eo_pair *pair, const struct eo_impact *impact, double speed,
                         struct eo_pulse *pulse)
{
  double period = 2 * M_PI / (speed * pair->geometry.teeth[EO_PINION]);
  for (int end = 0; end < pair->gear_pair.ends; end++) {
    pulse[end] = (struct eo_pulse){.shape = EO_PULSE_NONE};
    if (impact[end].touched && impact[end].force > 0)
      pulse[end] = (struct eo_pulse){.shape = EO_PULSE_HALF_SINE,
                                     .amplitude = impact[end].force,
                                     .start = impact[end].start,
                                     .duration = fmin(1, impact[end].duration / period)};
  }
}

/* An end that carries nothing somewhere in the cycle has no mesh law about its load: only the table knows how it comes
   into contact. */
static bool carries_throughout(const struct eo_loaded_end *end, int positions, bool by_table)
{
  bool carries = true;
  if (by_table)
    return eo_periodic_mean(positions, end->tangent) > 0;
  for (int j = 0; j < positions; j++)
    carries = carries && end->load[j] > 0;
  return carries;
}

/* Torque, speed and impacts of a load case for the equations of motion. */
static struct eo_vibration_case loads_of(const struct eo_evaluator *evaluator, const struct eo_run *run,
                                         const struct eo_case_result *load_case)
{
  const struct eo_running *running = &load_case->running;
  double stagger = run->design->alignment.stagger,
         behind = (running->flank == EO_COAST_FLANK ? -stagger : stagger) -
                  (double)evaluator->pair->ahead[running->inwards] / evaluator->result.positions;
  struct eo_vibration_case load = {.torque = load_case->load_case.torque,
                                   .speed = load_case->load_case.speed * run->scenario.speed,
                                   .pinion_teeth = evaluator->pair->geometry.teeth[EO_PINION],
                                   .phase_right = running->backwards ? behind : -behind,
                                   .gated = true,
                                   .impact = run->design->resolution.impact_in_dynamics};
  const struct eo_impact impact[2] = {load_case->end[EO_LEFT].impact, load_case->end[EO_RIGHT].impact};
  if (load.impact != EO_IMPACT_NONE)
    eo_evaluator_pulses(evaluator->pair, impact, load.speed, load.pulse);
  return load;
}

/* Mesh stiffness of an end, mean over the cycle and the ends. */
static double mean_stiffness(const struct eo_evaluator *evaluator, const struct eo_loaded_end *const loaded[2])
{
  double left = eo_periodic_mean(evaluator->result.positions, loaded[EO_LEFT]->tangent);
  if (evaluator->result.ends == 1)
    return left;
  return (left + eo_periodic_mean(evaluator->result.positions, loaded[EO_RIGHT]->tangent)) / 2;
}

/* The laws of both ends; *lawful: false where an end has none. */
static enum eo_code set_laws_of_ends(struct eo_evaluator *evaluator, const struct eo_run *run, int k,
                                     const struct eo_dynamics_parameters *parameters,
                                     const struct eo_loaded_end *const loaded[2], struct eo_vibration_case *load,
                                     bool *lawful, struct eo_error *error)
{
  int ends = evaluator->result.ends, n = evaluator->result.positions;
  bool by_table = eo_evaluator_law_is_table(evaluator, run->design, parameters);
  *lawful = carries_throughout(loaded[0], n, by_table) && carries_throughout(loaded[ends - 1], n, by_table);
  for (int end = 0; end < ends && *lawful; end++) {
    struct eo_law_request request = {&evaluator->result.load_case[k], parameters, loaded[end], end};
    load->law[end] = &evaluator->law[k][end];
    enum eo_code code = eo_evaluator_set_law(evaluator, run, &request, &evaluator->law[k][end], error);
    *lawful = code != EO_ERROR_INPUT;
    if (code && *lawful)
      return code;
  }
  return EO_OK;
}

/* What the equations of motion of a load case need, from its loads[end] at the compliance of the run. */
static enum eo_code set_problem(struct eo_evaluator *evaluator, const struct eo_run *run, int k,
                                const struct eo_loaded_end *const loaded[2], struct eo_error *error)
{
  struct eo_case_result *load_case = &evaluator->result.load_case[k];
  struct eo_vibration_problem problem = {.load = loads_of(evaluator, run, load_case)};
  bool held = load_case->at_stop || run->design->alignment.pinion_axial != EO_AXIAL_STOPS;
  EO_TRY(eo_evaluator_parameters(evaluator, run->design, mean_stiffness(evaluator, loaded), held, &problem.parameters,
                                 error));
  load_case->law_reach = eo_evaluator_law_reach(evaluator, run->design, &problem.parameters);
  EO_TRY(set_laws_of_ends(evaluator, run, k, &problem.parameters, loaded, &problem.load, &problem.solvable, error));
  evaluator->problem[k] = problem;
  return EO_OK;
}

enum eo_code eo_evaluator_set_laws(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->dynamics_ms);
  for (int k = 0; k < result->cases; k++) {
    struct eo_case_result *load_case = &result->load_case[k];
    const struct eo_loaded_end *const loaded[2] = {&load_case->end[0].loaded, &load_case->end[1].loaded};
    evaluator->problem[k].solvable = false;
    load_case->law_reach = INFINITY;
    if (load_case->contact_failures == 0)
      EO_TRY(set_problem(evaluator, run, k, loaded, error));
  }
  return EO_OK;
}

/* Makes a solver of a thread for the harmonics of the design when it has another number. */
static enum eo_code fit_solver(struct eo_evaluator *evaluator, int thread, int harmonics, struct eo_error *error)
{
  struct eo_vibration_solver *solver;
  if (evaluator->vibration[thread] && evaluator->vibration_harmonics[thread] == harmonics)
    return EO_OK;
  EO_TRY(eo_vibration_new(&solver, harmonics, 0, error));
  eo_vibration_free(evaluator->vibration[thread]);
  evaluator->vibration[thread] = solver;
  evaluator->vibration_harmonics[thread] = harmonics;
  return EO_OK;
}

/* The periodic state of a load case whose contact has converged; without a mesh law there is none. */
static enum eo_code settle(const struct eo_evaluator *evaluator, const struct eo_run *run, int thread, int k,
                           struct eo_vibration *vibration, struct eo_error *error)
{
  const struct eo_vibration_problem *problem = &evaluator->problem[k];
  struct eo_vibration_solver *solver = evaluator->vibration[thread];
  *vibration =
      (struct eo_vibration){.outcome = EO_VIBRATION_NOT_CONVERGED, .ends = evaluator->result.ends, .multiplier = NAN};
  EO_TRY(eo_vibration_set_model(solver, &problem->parameters, error));
  if (!problem->solvable)
    return EO_OK;
  return run->design->resolution.solver == EO_SOLVER_TIME_INTEGRATION
             ? eo_vibration_settle_integrated(solver, &problem->load, vibration, error)
             : eo_vibration_settle(solver, &problem->load, vibration, error);
}

static void read_curves(const struct eo_evaluator *evaluator, int thread, struct eo_case_result *load_case)
{
  double *const *const curve[] = {load_case->end[EO_LEFT].curve, load_case->end[EO_RIGHT].curve};
  eo_vibration_histories(evaluator->vibration[thread], EO_EVALUATOR_SAMPLES, curve);
  for (int end = 0; end < evaluator->result.ends; end++)
    for (int channel = 0; channel < EO_CURVE_CHANNELS; channel++)
      eo_vibration_orders(evaluator->vibration[thread], (enum eo_channel)channel, end,
                          load_case->end[end].order[channel]);
}

static enum eo_code find_vibration(struct eo_evaluator *evaluator, const struct eo_run *run, int thread, int k,
                                   struct eo_error *error)
{
  struct eo_evaluation *result = &evaluator->result;
  struct eo_case_result *load_case = &result->load_case[k];
  load_case->vibration =
      (struct eo_vibration){.outcome = EO_VIBRATION_NOT_CONVERGED, .ends = result->ends, .multiplier = NAN};
  EO_TRY(fit_solver(evaluator, thread, run->design->resolution.harmonics, error));
  if (load_case->contact_failures == 0)
    EO_TRY(settle(evaluator, run, thread, k, &load_case->vibration, error));
  load_case->dynamic_force_factor = 1;
  for (int end = 0; end < result->ends; end++)
    load_case->dynamic_force_factor = fmax(load_case->dynamic_force_factor, load_case->vibration.dynamic_factor[end]);
  if (run->want & EO_WANT_CURVES && load_case->vibration.outcome != EO_VIBRATION_NOT_CONVERGED)
    read_curves(evaluator, thread, load_case);
  return EO_OK;
}

/* Load cases on their way to their vibration. */
struct settling {
  struct eo_evaluator *evaluator;
  const struct eo_run *run;
  struct {
    int load_case; /* the first that failed */
    struct eo_error error;
  } failed[2]; /* [thread] */
};

static void settle_case(void *context, int thread, int k)
{
  struct settling *settling = context;
  struct eo_error error;
  enum eo_code code = find_vibration(settling->evaluator, settling->run, thread, k, &error);
  if (!code || settling->failed[thread].load_case <= k)
    return;
  settling->failed[thread].load_case = k;
  settling->failed[thread].error = error;
  settling->failed[thread].error.code = code;
}

enum eo_code eo_evaluator_find_vibrations(struct eo_evaluator *evaluator, const struct eo_run *run,
                                          struct eo_error *error)
{
  struct eo_evaluation *result = &evaluator->result;
  int none = result->cases;
  struct settling settling = {evaluator, run, .failed = {{.load_case = none}, {.load_case = none}}};
  EO_TIMED(result->dynamics_ms);
  EO_TRY(fit_solver(evaluator, 0, run->design->resolution.harmonics, error));
  eo_team_do(run->team, &(struct eo_work_list){settle_case, &settling, .pieces = result->cases});
  result->harmonics = run->design->resolution.harmonics;
  int thread = settling.failed[1].load_case < settling.failed[0].load_case;
  if (settling.failed[thread].load_case == none)
    return EO_OK;
  *error = settling.failed[thread].error;
  return error->code;
}

static const struct eo_case_result *heaviest_case(const struct eo_evaluation *result)
{
  const struct eo_case_result *heaviest = &result->load_case[0];
  for (int k = 1; k < result->cases; k++)
    if (result->load_case[k].load_case.share > heaviest->load_case.share)
      heaviest = &result->load_case[k];
  return heaviest;
}

/* With the mean mesh stiffness of the heaviest share; none where an end carries nothing. */
enum eo_code eo_evaluator_find_modes(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error)
{
  struct eo_evaluation *result = &evaluator->result;
  EO_TIMED(result->dynamics_ms);
  if (!(run->want & EO_WANT_CURVES))
    return EO_OK;
  const struct eo_case_result *heaviest = heaviest_case(result);
  bool elastic = heaviest->contact_failures == 0;
  double stiffness[2];
  for (int end = 0; end < 2; end++) {
    stiffness[end] = eo_periodic_mean(result->positions, heaviest->end[end < result->ends ? end : 0].loaded.tangent);
    elastic = elastic && stiffness[end] > 0;
  }
  result->modes = (struct eo_dynamics_modes){0};
  if (!elastic)
    return EO_OK;
  int last = result->cases - 1; /* whose mesh damping they have */
  while (result->load_case[last].contact_failures > 0)
    last--;
  EO_TRY(eo_vibration_set_model(evaluator->vibration[0], &evaluator->problem[last].parameters, error));
  return eo_dynamics_model_modes(eo_vibration_model(evaluator->vibration[0]), stiffness, &result->modes, error);
}

/* Loads of both ends of a load case at the compliance of the run: loaded[end] points to them. */
static void load_spare_ends(struct eo_evaluator *evaluator, const struct eo_run *run,
                            const struct eo_case_result *load_case, const struct eo_loaded_end *loaded[2])
{
  struct eo_loaded_end *spare = evaluator->spare;
  for (int end = 0; end < evaluator->result.ends; end++) {
    int stored = eo_reuse_stored_at(evaluator, end);
    loaded[end] = &spare[stored];
    spare[stored].around = evaluator->solved_for[stored].around && !evaluator->bodies_are_elastic;
    if (stored == end)
      eo_loaded_solve(eo_evaluator_workspace(evaluator, 0, end), eo_evaluator_grid(evaluator, end),
                      &eo_meeting_of(evaluator, load_case)->gaps[end], run->scenario.compliance, 1,
                      &load_case->end_force[end], &spare[end]);
  }
  if (evaluator->bodies_are_elastic)
    eo_evaluator_bend_bodies(evaluator, run, load_case, spare, &(struct eo_elastic_report){0});
}

/* RMS at 0.9 and 1.1 times the compliance: contact and vibration again. */
static enum eo_code find_band_of(struct eo_evaluator *evaluator, const struct eo_run *run, int k,
                                 struct eo_error *error)
{
  static const double BAND[2] = {0.9, 1.1};
  struct eo_case_result *load_case = &evaluator->result.load_case[k];
  for (int side = 0; side < 2; side++) {
    struct eo_vibration vibration;
    struct eo_run scaled = *run;
    const struct eo_loaded_end *loaded[2] = {&evaluator->spare[EO_LEFT], &evaluator->spare[EO_RIGHT]};
    scaled.scenario.compliance *= BAND[side];
    load_spare_ends(evaluator, &scaled, load_case, loaded);
    EO_TRY(set_problem(evaluator, &scaled, k, loaded, error));
    EO_TRY(settle(evaluator, &scaled, 0, k, &vibration, error));
    for (int reading = 0; reading < EO_READINGS; reading++)
      load_case->band[reading][side] = vibration.outcome == EO_VIBRATION_NOT_CONVERGED ? NAN
                                                                                       : vibration.rms_pair[reading];
  }
  return EO_OK;
}

enum eo_code eo_evaluator_find_band(struct eo_evaluator *evaluator, const struct eo_run *run, struct eo_error *error)
{
  for (int k = 0; k < evaluator->result.cases; k++)
    if (run->want & EO_WANT_BAND && evaluator->result.load_case[k].contact_failures == 0)
      EO_TRY(find_band_of(evaluator, run, k, error));
  return EO_OK;
}

bool eo_evaluator_vibration(const struct eo_evaluator *evaluator, int load_case,
                            struct eo_dynamics_parameters *parameters, struct eo_vibration_case *load)
{
  *parameters = evaluator->problem[load_case].parameters;
  *load = evaluator->problem[load_case].load;
  return evaluator->problem[load_case].solvable;
}
