/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/design_sweep.h"

#include "numerics/periodic.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "design/design_grids.h"
#include "dynamics/speed_sweep.h"

/* What the speeds of one torque share. */
struct problem {
  struct eo_dynamics_parameters parameters;
  struct eo_vibration_case load; /* laws are those below */
  struct eo_law law[2];
  struct eo_impact impact[2];
  bool solvable; /* false: there is no mesh law */
};

/* One thread's own. */
struct worker {
  struct eo_design *design; /* with one load case */
  struct eo_evaluator *evaluator;
  struct eo_vibration_solver *solver;
  int model; /* problem whose model the solver holds; -1: none */
};

struct job {
  struct eo_sweep *sweep;
  const struct eo_pair *pair;
  const struct eo_design *design;
  const struct eo_design *step; /* [torques], where a number of the design varies; NULL: none does */
  int threads;
  struct worker *worker;      /* [threads] */
  struct problem *problem;    /* [variant][torque] */
  struct eo_vibration *alone; /* [variant][torque][speed]: every point on its own */
};

static enum eo_code check_axis(int count, const double *value, const char *what, struct eo_error *error)
{
  for (int i = 0; i < count; i++)
    if (!(value[i] > 0 && isfinite(value[i])))
      return eo_error_set(error, EO_ERROR_INPUT, "", "A %s must be positive; number %d of the sweep is %g.", what,
                          i + 1, value[i]);
    else if (i && !(value[i] > value[i - 1]))
      return eo_error_set(error, EO_ERROR_INPUT, "",
                          "Each %s of a sweep must be larger than the one before; number %d is not.", what, i + 1);
  return EO_OK;
}

static enum eo_code check_plan(const struct eo_sweep_plan *plan, struct eo_error *error)
{
  enum eo_code code = check_axis(plan->torques, plan->torque, "torque", error);
  if (!code)
    code = check_axis(plan->speeds, plan->speed, "speed", error);
  double points = fmax(fmax(plan->torques, plan->steps), 1) * fmax(plan->speeds, 1);
  if (!code && points > EO_SWEEP_MOST_POINTS)
    code = eo_error_set(error, EO_ERROR_INPUT, "", "%.0f points are more than a sweep may have (%d).", points,
                        EO_SWEEP_MOST_POINTS);
  return code;
}

static const struct eo_load_case *heaviest(const struct eo_design *design)
{
  int k = 0;
  for (int i = 1; i < design->load_cases; i++)
    if (design->load_case[i].share > design->load_case[k].share)
      k = i;
  return &design->load_case[k];
}

static double *copy_axis(int count, const double *value, const double *otherwise)
{
  double *copy = malloc((size_t)(count ? count : 1) * sizeof *copy);
  if (copy)
    memcpy(copy, count ? value : otherwise, (size_t)(count ? count : 1) * sizeof *copy);
  return copy;
}

static double *torques_of(const struct eo_sweep_plan *plan)
{
  double *torque = malloc((size_t)plan->steps * sizeof *torque);
  for (int k = 0; torque && k < plan->steps; k++)
    torque[k] = heaviest(&plan->step[k])->torque;
  return torque;
}

static enum eo_code make_sweep(struct eo_sweep *sweep, const struct eo_design *design, const struct eo_sweep_plan *plan,
                               struct eo_error *error)
{
  const struct eo_load_case *standard = heaviest(design);
  *sweep = (struct eo_sweep){.ends = design->gear_pair.ends,
                             .torques = plan->steps     ? plan->steps
                                        : plan->torques ? plan->torques
                                                        : 1,
                             .speeds = plan->speeds ? plan->speeds : 1};
  size_t torques = (size_t)sweep->torques, points = torques * (size_t)sweep->speeds;
  sweep->torque = plan->steps ? torques_of(plan) : copy_axis(plan->torques, plan->torque, &standard->torque);
  sweep->speed = copy_axis(plan->speeds, plan->speed, &standard->speed);
  sweep->value = plan->steps ? copy_axis(plan->steps, plan->value, NULL) : NULL;
  snprintf(sweep->key, sizeof sweep->key, "%s", plan->steps ? plan->key : "");
  bool made = sweep->torque && sweep->speed && (sweep->value || !plan->steps);
  for (int v = 0; v < EO_SWEEP_VARIANTS; v++) {
    sweep->at_torque[v] = calloc(torques, sizeof *sweep->at_torque[v]);
    made = made && sweep->at_torque[v];
    for (int d = 0; d < EO_SWEEP_DIRECTIONS; d++) {
      sweep->point[v][d] = calloc(points, sizeof *sweep->point[v][d]);
      made = made && sweep->point[v][d];
    }
  }
  return made ? EO_OK : eo_error_memory(error);
}

void eo_sweep_done(struct eo_sweep *sweep)
{
  if (!sweep)
    return;
  free(sweep->torque);
  free(sweep->speed);
  free(sweep->value);
  free(sweep->crossing);
  for (int v = 0; v < EO_SWEEP_VARIANTS; v++) {
    free(sweep->at_torque[v]);
    for (int d = 0; d < EO_SWEEP_DIRECTIONS; d++)
      free(sweep->point[v][d]);
  }
  *sweep = (struct eo_sweep){0};
}

/* sound: the loaded contact converged; where it did not, everything built on it means nothing. */
static void read_point(struct eo_sweep_point *sweep_point, const struct eo_vibration *vibration, bool sound)
{
  bool found = sound && vibration->outcome != EO_VIBRATION_NOT_CONVERGED;
  sweep_point->outcome = sound ? vibration->outcome : EO_VIBRATION_NOT_CONVERGED;
  sweep_point->back_contact = found && vibration->back_contact;
  for (int end = 0; end < 2 && !sound; end++)
    sweep_point->impact[end] = NAN;
  for (int reading = 0; reading < EO_READINGS; reading++) {
    sweep_point->rms_pair[reading] = found ? vibration->rms_pair[reading] : NAN;
    sweep_point->rms_of_mean[reading] = found ? vibration->rms_of_mean[reading] : NAN;
    for (int end = 0; end < 2; end++)
      sweep_point->rms[reading][end] = found ? vibration->rms[reading][end] : NAN;
  }
  for (int end = 0; end < 2; end++) {
    sweep_point->dynamic_factor[end] = found ? vibration->dynamic_factor[end] : NAN;
    sweep_point->contact_loss[end] = found ? vibration->contact_loss[end] : NAN;
  }
}

static enum eo_code read_torque(struct eo_sweep_torque *torque, const struct eo_evaluation *evaluation,
                                const struct eo_dynamics_parameters *parameters, struct eo_error *error)
{
  const struct eo_case_result *case_result = &evaluation->load_case[0];
  struct eo_dynamics_model model;
  double known = case_result->contact_failures ? NAN : 1;
  torque->peak_to_peak = known * case_result->peak_to_peak;
  torque->mean = known * case_result->mean;
  torque->contact_failures = case_result->contact_failures;
  for (int end = 0; end < 2; end++) {
    const struct eo_end_result *from = &case_result->end[end < evaluation->ends ? end : 0];
    torque->stiffness[end] = known * eo_periodic_mean(evaluation->positions, from->stiffness);
    torque->tangent[end] = known * eo_periodic_mean(evaluation->positions, from->loaded.tangent);
    torque->max_pressure[end] = known * from->max_pressure;
    torque->max_line_load[end] = known * from->max_line_load;
    torque->edge_share[end] = known * from->edge_share;
  }
  if (case_result->contact_failures)
    return EO_OK;
  enum eo_code code = eo_dynamics_model_init(&model, parameters, error);
  return code ? code : eo_dynamics_model_modes(&model, torque->tangent, &torque->modes, error);
}

static enum eo_code keep_problem(struct problem *problem, const struct eo_evaluator *evaluator,
                                 const struct eo_evaluation *evaluation, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  problem->solvable = eo_evaluator_vibration(evaluator, 0, &problem->parameters, &problem->load);
  for (int end = 0; end < evaluation->ends && !code; end++) {
    problem->impact[end] = evaluation->load_case[0].end[end].impact;
    if (problem->solvable)
      code = eo_law_copy(&problem->law[end], problem->load.law[end], error);
    problem->load.law[end] = &problem->law[end];
  }
  return code;
}

static enum eo_code make_worker(struct job *job, struct worker *worker, struct eo_error *error)
{
  if (worker->design)
    return EO_OK;
  enum eo_code code = eo_evaluator_new(&worker->evaluator, job->pair, 1, error);
  if (!code)
    code = eo_vibration_new(&worker->solver, job->design->resolution.harmonics, 0, error);
  if (code)
    return code;
  worker->model = -1;
  worker->design = malloc(sizeof *worker->design);
  if (!worker->design)
    return eo_error_memory(error);
  *worker->design = *job->design;
  worker->design->load_cases = 1;
  return EO_OK;
}

static enum eo_code solve_torque(void *context, int thread, int item, struct eo_error *error)
{
  struct job *job = context;
  struct eo_sweep *sweep = job->sweep;
  struct worker *worker = &job->worker[thread];
  const struct eo_evaluation *evaluation;
  int variant = item / sweep->torques, k = item % sweep->torques;
  const struct eo_design *design = job->step ? &job->step[k] : job->design;
  enum eo_code code = make_worker(job, worker, error);
  if (code)
    return code;
  if (job->step) {
    *worker->design = *design;
    worker->design->load_cases = 1;
  }
  worker->design->load_case[0] = *heaviest(design); /* its direction, driver and alignment */
  worker->design->load_case[0].torque = sweep->torque[k];
  worker->design->load_case[0].speed = sweep->speed[0];
  worker->design->load_case[0].share = 1;
  worker->design->modification = variant == EO_SWEEP_UNMODIFIED ? eo_design_unmodified(design) : design->modification;
  code = eo_evaluator_run(worker->evaluator, worker->design, NULL, 0, &evaluation, error);
  if (!code)
    code = keep_problem(&job->problem[item], worker->evaluator, evaluation, error);
  if (!code)
    code = read_torque(&sweep->at_torque[variant][k], evaluation, &job->problem[item].parameters, error);
  if (code)
    return code;
  job->alone[(size_t)item * (size_t)sweep->speeds] = evaluation->load_case[0].vibration;
  return EO_OK;
}

static struct eo_vibration_case case_at(const struct job *job, const struct problem *problem, double speed,
                                        double impact[2])
{
  struct eo_vibration_case load = problem->load;
  struct eo_impact strike[2] = {problem->impact[0], problem->impact[1]};
  load.speed = speed;
  for (int end = 0; end < job->sweep->ends; end++) {
    eo_impact_strike(&strike[end], eo_pair_half(job->pair, end)->grid, &eo_pair_half(job->pair, end)->impact, speed, 1);
    if (impact)
      impact[end] = strike[end].touched ? strike[end].force : 0;
  }
  if (load.impact != EO_IMPACT_NONE)
    eo_evaluator_pulses(job->pair, strike, speed, load.pulse);
  return load;
}

static enum eo_code take_model(struct job *job, struct worker *worker, int problem, struct eo_error *error)
{
  enum eo_code code = make_worker(job, worker, error);
  if (!code && worker->model != problem)
    code = eo_vibration_set_model(worker->solver, &job->problem[problem].parameters, error);
  if (!code)
    worker->model = problem;
  return code;
}

/* The first speed of each torque is known from the evaluation. */
static enum eo_code solve_speed(void *context, int thread, int item, struct eo_error *error)
{
  struct job *job = context;
  struct worker *worker = &job->worker[thread];
  int others = job->sweep->speeds - 1, problem = item / others, j = 1 + item % others;
  struct eo_vibration *result = &job->alone[(size_t)problem * (size_t)job->sweep->speeds + (size_t)j];
  if (!job->problem[problem].solvable) {
    result->outcome = EO_VIBRATION_NOT_CONVERGED;
    return EO_OK;
  }
  enum eo_code code = take_model(job, worker, problem, error);
  if (code)
    return code;
  struct eo_vibration_case load = case_at(job, &job->problem[problem], job->sweep->speed[j], NULL);
  return job->design->resolution.solver == EO_SOLVER_TIME_INTEGRATION
             ? eo_vibration_integrate(worker->solver, &load, NULL, result, NULL, error)
             : eo_vibration_solve(worker->solver, &load, EO_START_COLD, result, error);
}

static bool separates(const struct job *job, const struct eo_vibration *alone)
{
  bool lost = false;
  for (int j = 0; j < job->sweep->speeds; j++)
    lost = lost || alone[j].outcome == EO_VIBRATION_CONTACT_LOST;
  return lost && job->design->resolution.solver != EO_SOLVER_TIME_INTEGRATION;
}

/* load, followed: [speeds], room to work. */
static enum eo_code follow_branch(struct job *job, struct worker *worker, int item, struct eo_vibration_case *load,
                                  struct eo_vibration *followed, struct eo_error *error)
{
  struct eo_sweep *sweep = job->sweep;
  int problem = item / EO_SWEEP_DIRECTIONS, direction = item % EO_SWEEP_DIRECTIONS;
  size_t speeds = (size_t)sweep->speeds, first = (size_t)(problem % sweep->torques) * speeds;
  const struct eo_vibration *alone = job->alone + (size_t)problem * speeds;
  struct eo_sweep_point *point = sweep->point[problem / sweep->torques][direction] + first;
  bool sound = sweep->at_torque[problem / sweep->torques][problem % sweep->torques].contact_failures == 0,
       follow = separates(job, alone);
  for (int j = 0; j < sweep->speeds; j++)
    load[j] = case_at(job, &job->problem[problem], sweep->speed[j], point[j].impact);
  if (follow) {
    EO_TRY(take_model(job, worker, problem, error));
    EO_TRY(eo_vibration_follow(worker->solver, sweep->speeds, load, alone, direction == EO_SWEEP_UP ? +1 : -1, followed,
                               error));
  }
  for (int j = 0; j < sweep->speeds; j++)
    read_point(&point[j], follow ? &followed[j] : &alone[j], sound);
  return EO_OK;
}

static enum eo_code solve_branch(void *context, int thread, int item, struct eo_error *error)
{
  struct job *job = context;
  size_t speeds = (size_t)job->sweep->speeds;
  struct eo_vibration_case *load = calloc(speeds, sizeof *load);
  struct eo_vibration *followed = calloc(speeds, sizeof *followed);
  enum eo_code code = load && followed ? follow_branch(job, &job->worker[thread], item, load, followed, error)
                                       : eo_error_memory(error);
  free(load);
  free(followed);
  return code;
}

static enum eo_code make_job(struct job *job, struct eo_error *error)
{
  size_t problems = (size_t)EO_SWEEP_VARIANTS * job->sweep->torques;
  job->worker = calloc((size_t)job->threads, sizeof *job->worker);
  job->problem = calloc(problems, sizeof *job->problem);
  job->alone = calloc(problems * (size_t)job->sweep->speeds, sizeof *job->alone);
  return job->worker && job->problem && job->alone ? EO_OK : eo_error_memory(error);
}

static void done_job(struct job *job)
{
  for (int i = 0; job->worker && i < job->threads; i++) {
    eo_evaluator_free(job->worker[i].evaluator);
    eo_vibration_free(job->worker[i].solver);
    free(job->worker[i].design);
  }
  for (int i = 0; job->problem && i < EO_SWEEP_VARIANTS * job->sweep->torques; i++)
    for (int end = 0; end < 2; end++)
      eo_law_done(&job->problem[i].law[end]);
  free(job->worker);
  free(job->problem);
  free(job->alone);
}

static enum eo_code run_job(struct job *job, const struct eo_progress *progress, struct eo_error *error)
{
  enum { TORQUE_COST = 20, BRANCH_SHARE = 4 }; /* in vibrations of one speed */
  const struct eo_sweep *sweep = job->sweep;
  int problems = EO_SWEEP_VARIANTS * sweep->torques;
  double torques = TORQUE_COST * problems, speeds = (double)problems * sweep->speeds,
         all = torques + speeds + speeds / BRANCH_SHARE;
  struct eo_parallel parallel = {.threads = job->threads,
                                 .work = solve_torque,
                                 .context = job,
                                 .progress = progress,
                                 .what = "loaded contact",
                                 .first = 0,
                                 .last = torques / all};
  enum eo_code code = eo_parallel_run(&parallel, problems, error);
  parallel.first = parallel.last;
  parallel.last = (torques + speeds) / all;
  parallel.work = solve_speed;
  parallel.what = "vibration";
  if (!code)
    code = eo_parallel_run(&parallel, problems * (sweep->speeds - 1), error);
  parallel.first = parallel.last;
  parallel.last = 1;
  parallel.work = solve_branch;
  parallel.what = "branches";
  return code ? code : eo_parallel_run(&parallel, problems * EO_SWEEP_DIRECTIONS, error);
}

/* More than the residual of the harmonic balance leaves open. */
static bool differ(const struct eo_sweep_point *a, const struct eo_sweep_point *b)
{
  static const double CLOSE = 1e-6;
  double up = a->rms_pair[EO_READING_NORMAL], down = b->rms_pair[EO_READING_NORMAL];
  return a->outcome != b->outcome || fabs(up - down) > CLOSE * fmax(up, down);
}

/* Where one direction found no periodic state and the other did, the other's is a state of that speed too. */
static void compare_branches(struct eo_sweep *sweep)
{
  for (int v = 0; v < EO_SWEEP_VARIANTS; v++)
    for (int i = 0; i < sweep->torques * sweep->speeds; i++) {
      struct eo_sweep_point *up = &sweep->point[v][EO_SWEEP_UP][i], *down = &sweep->point[v][EO_SWEEP_DOWN][i];
      if (up->outcome == EO_VIBRATION_NOT_CONVERGED)
        *up = *down;
      else if (down->outcome == EO_VIBRATION_NOT_CONVERGED)
        *down = *up;
      sweep->branches[v] = sweep->branches[v] || differ(up, down);
    }
}

static bool crosses(const struct eo_sweep *sweep, int torque, int mode, int order, int teeth,
                    struct eo_sweep_crossing *crossing)
{
  double frequency = sweep->at_torque[EO_SWEEP_DESIGN][torque].modes.frequency[mode];
  *crossing = (struct eo_sweep_crossing){torque, mode, order, frequency, 2 * M_PI * frequency / (order * teeth)};
  return crossing->speed >= sweep->speed[0] && crossing->speed <= sweep->speed[sweep->speeds - 1];
}

static enum eo_code find_crossings(struct eo_sweep *sweep, int teeth, int orders, struct eo_error *error)
{
  sweep->crossing = malloc((size_t)(sweep->torques * EO_MAX_COORDINATES * orders) * sizeof *sweep->crossing);
  if (!sweep->crossing)
    return eo_error_memory(error);
  for (int k = 0; k < sweep->torques; k++)
    for (int mode = 0; mode < sweep->at_torque[EO_SWEEP_DESIGN][k].modes.n; mode++)
      for (int order = 1; order <= orders; order++)
        sweep->crossings += crosses(sweep, k, mode, order, teeth, &sweep->crossing[sweep->crossings]);
  return EO_OK;
}

static enum eo_code fill_sweep(struct job *job, const struct eo_sweep_plan *plan, const struct eo_progress *progress,
                               struct eo_error *error)
{
  const struct eo_design *design = job->design;
  EO_TRY(make_sweep(job->sweep, design, plan, error));
  EO_TRY(make_job(job, error));
  EO_TRY(run_job(job, progress, error));
  EO_TRY(find_crossings(job->sweep, job->pair->geometry.teeth[EO_PINION], design->resolution.te_harmonics, error));
  compare_branches(job->sweep);
  return EO_OK;
}

enum eo_code eo_sweep_run(struct eo_sweep *sweep, const struct eo_pair *pair, const struct eo_design *design,
                          const struct eo_sweep_plan *plan, const struct eo_progress *progress, struct eo_error *error)
{
  struct job job = {.sweep = sweep, .pair = pair, .design = design, .step = plan->steps ? plan->step : NULL};
  *sweep = (struct eo_sweep){0};
  EO_TRY(check_plan(plan, error));
  job.threads = plan->threads < 1                ? eo_parallel_cores()
                : plan->threads > EO_MAX_THREADS ? EO_MAX_THREADS
                                                 : plan->threads;
  enum eo_code code = fill_sweep(&job, plan, progress, error);
  done_job(&job);
  return code;
}
