/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Properties of the motion: energy, power, both solvers with contact loss, convergence, both directions of a sweep, the
   same bytes from every thread. */
#include <pthread.h>
#include <string.h>

#include "support/dynamics-fixture.h"
#include "support/speed-sweep.h"
#include "support/tap.h"
#include "dynamics/continuation.h"
#include "dynamics/vibration_private.h"
#include "numerics/ode.h"

enum { HARMONICS = 32 };

static struct eo_vibration_solver *solver_for(const struct eo_dynamics_parameters *p, int harmonics, int samples)
{
  struct eo_vibration_solver *solver = NULL;
  struct eo_error error = {0};
  int failed = eo_vibration_new(&solver, harmonics, samples, &error) || eo_vibration_set_model(solver, p, &error);
  ok(!failed, "the solver of %d harmonics is made %s", harmonics, error.text);
  return solver;
}

struct free_run {
  const struct eo_oscillator *oscillator;
  const struct eo_cycle *cycle;
  int separated; /* accelerations computed with teeth apart */
};

static int free_motion(void *context, double t, const double *y, double *slope)
{
  struct free_run *run = context;
  int n = run->oscillator->n;
  struct eo_mesh_state mesh[2];
  memcpy(slope, y + n, sizeof *y * n);
  eo_oscillator_acceleration(run->oscillator, run->cycle, t, y, y + n, slope + n, mesh);
  run->separated += mesh[0].margin < 0;
  return 0;
}

static double energy_of(const struct eo_oscillator *o, const struct eo_law *law, double stiffness, const double *y)
{
  int n = o->n;
  double energy = 0;
  for (int i = 0; i < n; i++) {
    energy += y[n + i] * y[n + i] / 2 - o->load[i] * y[i];
    for (int j = 0; j < n; j++)
      energy += o->stiffness[i * n + j] * y[i] * y[j] / 2;
  }
  for (int end = 0; end < 2; end++) {
    double x = 0, gap;
    for (int i = 0; i < n; i++)
      x += o->mesh[end][i] * y[i];
    gap = x > law->front ? x - law->front : x < law->back ? x - law->back : 0;
    energy += stiffness * gap * gap / 2;
  }
  return energy;
}

/* Undamped, constant stiffness, thrown so hard that the teeth separate and meet the back flanks. */
static void energy(void)
{
  struct eo_dynamics_parameters p = paper_pair();
  struct eo_dynamics_model m;
  struct eo_law law = {0};
  const double stiffness = 1.1e9;
  double y[2 * EO_MAX_COORDINATES] = {0}, tolerance[2 * EO_MAX_COORDINATES], worst = 0;
  scale_damping(&p, 0);
  eo_dynamics_model_init(&m, &p, NULL);
  eo_dynamics_model_load(&m, 50, EO_IMPACT_NONE);
  eo_law_set_stiffness(&law, 0, &stiffness, 5e-6, -5e-6, NULL);
  struct eo_cycle cycle = {.frequency = 1, .law = {&law, &law}};
  struct free_run run = {&m.oscillator, &cycle, 0};
  int n = m.oscillator.n;
  for (int i = 0; i < n; i++) {
    y[n + i] = 0.03 * (m.oscillator.mesh[0][i] + 0.7 * m.oscillator.mesh[1][i]);
    tolerance[i] = 1e-17;
    tolerance[n + i] = 1e-13;
  }
  const struct eo_ode_problem problem = {free_motion, NULL, &run, 1e-11, tolerance, 0};
  struct eo_ode *ode = NULL;
  eo_ode_new(&ode, 2 * n, NULL);
  eo_ode_start(ode, &problem, 0, y, NULL);
  double kinetic = 0, first = energy_of(&m.oscillator, &law, stiffness, y);
  for (int i = 0; i < n; i++)
    kinetic += y[n + i] * y[n + i] / 2;
  for (int step = 1; step <= 100; step++) {
    eo_ode_advance(ode, 1e-4 * step, y, NULL);
    worst = fmax(worst, fabs(energy_of(&m.oscillator, &law, stiffness, y) - first) / kinetic);
  }
  ok(run.separated > 100, "teeth are apart in %d evaluations", run.separated);
  ok(worst < 1e-6, "undamped free vibration keeps its energy: %.2g of it lost or won", worst);
  eo_ode_free(ode);
  eo_law_done(&law);
}

static void check_finite(const struct eo_vibration *r)
{
  const double *value = (const double *)&r->rms;
  int finite = 1;
  for (const double *end = (const double *)&r->contact_loss; value < end; value++)
    finite = finite && isfinite(*value);
  ok(finite && isfinite(r->power_supplied) && isfinite(r->residual), "every number of the result is finite");
}

/* Teeth driven apart at low torque by impacts, with the mesh damping acting always or only in contact. */
static void contact_loss(bool gated)
{
  const struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  struct eo_vibration balance, integration;
  stiffness_law(&law, 1);
  struct eo_vibration_solver *solver = solver_for(&p, 64, 2048);
  struct eo_vibration_case load = paper_case(&law, &law);
  load.torque = 16.56;
  load.speed = 3000 * M_PI / 30;
  load.gated = gated;
  load.impact = EO_IMPACT_PAPER;
  load.pulse[0] = load.pulse[1] = (struct eo_pulse){EO_PULSE_HALF_SINE, 300, 0, 0.1};
  int failed = eo_vibration_solve(solver, &load, EO_START_COLD, &balance, NULL);
  ok(!failed && balance.outcome == EO_VIBRATION_CONTACT_LOST, "contact is lost over %.3f of the cycle",
     balance.contact_loss[0]);
  check_finite(&balance);
  near(balance.power_supplied, balance.power_dissipated, 1e-6, "power supplied by the mesh is dissipated");
  ok(balance.power_dissipated > 0, "the mesh supplies power");
  double complex multiplier[2 * EO_MAX_COORDINATES];
  failed = eo_vibration_stability(solver, &load, multiplier, NULL);
  ok(!failed && cabs(multiplier[0]) < 1, "the state with lost contact is stable: %.4f", cabs(multiplier[0]));
  failed = eo_vibration_integrate(solver, &load, NULL, &integration, NULL, NULL);
  ok(!failed && integration.outcome == EO_VIBRATION_CONTACT_LOST, "time integration settles after %d periods",
     integration.periods);
  near(balance.rms[EO_READING_NORMAL][0], integration.rms[EO_READING_NORMAL][0], 1e-4,
       "normal acceleration, balance against integration");
  near(balance.rms[EO_READING_TRANSVERSE][0], integration.rms[EO_READING_TRANSVERSE][0], 1e-4,
       "transverse acceleration, balance against integration");
  near(balance.rms[EO_READING_ROTATIONAL][0], integration.rms[EO_READING_ROTATIONAL][0], 1e-4,
       "rotational acceleration, balance against integration");
  close_to(balance.contact_loss[0], integration.contact_loss[0], 1e-3, "share of the cycle out of contact");
  eo_vibration_free(solver);
  eo_law_done(&law);
}

static void power_in_contact(void)
{
  const struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  struct eo_vibration r;
  const double float_series[3] = {1e-5, 2e-7, 1e-7};
  stiffness_law(&law, 1);
  struct eo_vibration_solver *solver = solver_for(&p, HARMONICS, 0);
  struct eo_vibration_case load = paper_case(&law, &law);
  eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
  near(r.power_supplied, r.power_dissipated, 1e-6, "power supplied in full contact by harmonic balance");
  eo_vibration_integrate(solver, &load, NULL, &r, NULL, NULL);
  near(r.power_supplied, r.power_dissipated, 1e-6, "power supplied in full contact by time integration");
  load.impact = EO_IMPACT_PAPER;
  load.pulse[0] = (struct eo_pulse){EO_PULSE_HALF_SINE, 300, 0.7, 0.1};
  load.pulse[1] = (struct eo_pulse){EO_PULSE_HALF_SINE, 500, 0.2, 0.15};
  load.axial_order = 1;
  load.axial_motion = float_series;
  eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
  near(r.power_supplied, r.power_dissipated, 1e-6, "power supplied under unequal impacts and prescribed float");
  ok(r.impact_drift > 1, "the mean difference of the impacts is reported: %.3g", r.impact_drift);
  struct eo_vibration t;
  eo_vibration_integrate(solver, &load, NULL, &t, NULL, NULL);
  for (int end = 0; end < 2; end++)
    for (int reading = 0; reading < EO_READINGS; reading++)
      near(r.rms[reading][end], t.rms[reading][end], 4e-4,
           "RMS under impacts and float, 32 harmonics against integration");
  eo_vibration_free(solver);
  eo_law_done(&law);
}

/* The prescribed float enters by its change only: a constant drops out. */
static void constant_float_drops_out(void)
{
  const struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  struct eo_vibration still, shifted, moving;
  const double constant[3] = {3e-5, 0, 0}, wave[3] = {0, 1e-6, 0};
  stiffness_law(&law, 1);
  struct eo_vibration_solver *solver = solver_for(&p, HARMONICS, 0);
  struct eo_vibration_case load = paper_case(&law, &law);
  eo_vibration_solve(solver, &load, EO_START_COLD, &still, NULL);
  load.axial_order = 1;
  load.axial_motion = constant;
  eo_vibration_solve(solver, &load, EO_START_COLD, &shifted, NULL);
  load.axial_motion = wave;
  eo_vibration_solve(solver, &load, EO_START_COLD, &moving, NULL);
  near(shifted.rms_pair[0], still.rms_pair[0], 1e-9, "RMS under a constant axial float, which changes nothing");
  ok(fabs(moving.rms[0][0] / still.rms[0][0] - 1) > 1e-3, "a moving float changes the RMS: %.4f against %.4f",
     moving.rms[0][0], still.rms[0][0]);
  ok((moving.rms[0][0] > still.rms[0][0]) != (moving.rms[0][1] > still.rms[0][1]),
     "a moving float acts in opposite senses at the two ends");
  eo_vibration_free(solver);
  eo_law_done(&law);
}

static void convergence(void)
{
  const struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  stiffness_law(&law, 1);
  double error_before = INFINITY, reference = 0;
  static const int harmonics[] = {64, 4, 6, 9, 24};
  for (int i = 0; i < 5; i++) {
    struct eo_vibration r;
    struct eo_vibration_case load = paper_case(&law, &law);
    struct eo_vibration_solver *solver = solver_for(&p, harmonics[i], 0);
    eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
    double error = fabs(r.rms_pair[0] / reference - 1);
    if (i == 0)
      reference = r.rms_pair[0];
    else
      ok(error <= error_before, "with %d harmonics the RMS is off by %.2g", harmonics[i], error);
    error_before = i == 0 ? INFINITY : fmax(error, 1e-10);
    eo_vibration_free(solver);
  }
  ok(error_before <= 1e-9, "the default of 24 harmonics is enough for the stiffness law");
  eo_law_done(&law);
}

/* Both ends equal but staggered by half a period: the right end does what the left did half a period before. */
static void stagger(void)
{
  const struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  struct eo_vibration r;
  double complex left[1 + HARMONICS], right[1 + HARMONICS];
  double worst = 0;
  stiffness_law(&law, 1);
  struct eo_vibration_solver *solver = solver_for(&p, HARMONICS, 0);
  struct eo_vibration_case load = paper_case(&law, &law);
  load.phase_right = 0.5;
  eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
  eo_vibration_orders(solver, EO_CHANNEL_NORMAL, 0, left);
  eo_vibration_orders(solver, EO_CHANNEL_NORMAL, 1, right);
  for (int k = 1; k <= HARMONICS; k++)
    worst = fmax(worst, cabs(right[k] - left[k] * (k % 2 ? -1 : 1)) / r.rms[0][0]);
  ok(worst < 1e-9, "a stagger of half a pitch mirrors the motion in time (%g)", worst);
  ok(r.rms_of_mean[0] < 0.8 * r.rms_pair[0], "odd harmonics cancel in the mean of both ends: %.2f of %.2f",
     r.rms_of_mean[0], r.rms_pair[0]);
  eo_vibration_free(solver);
  eo_law_done(&law);
}

static void single_end(void)
{
  struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  struct eo_vibration r, t;
  p.ends = 1;
  p.groove_axial_stiffness[0] = 2e8;
  p.groove_axial_damping[0] = 3000;
  stiffness_law(&law, 1);
  struct eo_vibration_solver *solver = solver_for(&p, HARMONICS, 0);
  struct eo_vibration_case load = paper_case(&law, NULL);
  load.torque = 414;
  int failed = eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
  ok(!failed && r.outcome == EO_VIBRATION_CONVERGED, "a single helical pair vibrates at %.3f m/s2", r.rms_pair[0]);
  eo_vibration_integrate(solver, &load, NULL, &t, NULL, NULL);
  near(r.rms_pair[0], t.rms_pair[0], 1e-4, "RMS of a single helical pair, balance against integration");
  near(r.axial_force_mean[0], 414 / p.base_radius[0] * tan(p.base_helix_angle), 1e-9,
       "gear thrust of a single helical pair, F_t tan(beta_b)");
  near(r.bearing_force_mean[EO_PINION][0], -414 / p.base_radius[0], 1e-9, "load of its pinion bearing, F_t");
  eo_vibration_free(solver);
  eo_law_done(&law);
}

enum { SPEEDS = 60 };
struct sweep_run {
  struct eo_vibration up[SPEEDS], down[SPEEDS];
};

static void *run_sweep(void *context)
{
  struct sweep_run *run = context;
  struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  struct eo_vibration_solver *solver = NULL;
  double speed[SPEEDS];
  scale_damping(&p, 0.2);
  stiffness_law(&law, 3);
  for (int i = 0; i < SPEEDS; i++)
    speed[i] = (9000 + 100.0 * i) * M_PI / 30;
  struct eo_vibration_case load = paper_case(&law, &law);
  if (eo_vibration_new(&solver, 16, 0, NULL) || eo_vibration_set_model(solver, &p, NULL) ||
      !sweep_speeds(solver, &load, SPEEDS, speed, run->up, run->down))
    memset(run, 0, sizeof *run);
  eo_vibration_free(solver);
  eo_law_done(&law);
  return NULL;
}

static void sweeps(void)
{
  static struct sweep_run alone, together[2];
  pthread_t thread[2];
  int bistable = 0, lost = 0, unsteady = 0;
  run_sweep(&alone);
  for (int i = 0; i < 2; i++)
    pthread_create(&thread[i], NULL, run_sweep, &together[i]);
  for (int i = 0; i < 2; i++)
    pthread_join(thread[i], NULL);
  for (int i = 0; i < SPEEDS; i++) {
    lost += alone.down[i].outcome == EO_VIBRATION_CONTACT_LOST;
    bistable += alone.down[i].rms_pair[0] > 1.5 * alone.up[i].rms_pair[0];
    for (int down = 0; down < 2; down++) {
      const struct eo_vibration *r = down ? &alone.down[i] : &alone.up[i];
      /* Stable by its multiplier, or found by time integration (16 harmonics of a hard impact leave 1.05 unsure). */
      unsteady += r->outcome == EO_VIBRATION_CONTACT_LOST && r->states == 0 && !(r->multiplier <= 1);
    }
  }
  ok(unsteady == 0, "where teeth separate, states that no motion keeps to: %d", unsteady);
  /* How far a sweep keeps to the upper state where its multiplier is about 1 is decided by rounding: 10 to 15 speeds.
   */
  ok(lost > 20 && bistable > 5, "teeth separate at %d speeds, two states exist at %d of them", lost, bistable);
  ok(!memcmp(&alone, &together[0], sizeof alone) && !memcmp(&alone, &together[1], sizeof alone),
     "two threads give the same bytes as one");
}

struct branch_state {
  double speed; /* of the pinion, rad/s */
  bool fold;    /* the branch turns here */
};

struct branch_record {
  int teeth, capacity, count;
  struct branch_state *point;
};

static int note_point(void *context, const struct eo_branch_point *branch_point)
{
  struct branch_record *record = context;
  record->point[record->count++] = (struct branch_state){.speed = branch_point->frequency / record->teeth,
                                                         .fold = branch_point->fold};
  return record->count >= record->capacity;
}

/* Follows the branch through the solution at load->speed upwards and through folds, up to `high`, rad/s, or as far as
   there is room for points. Their number; 0: there is no branch. */
static int trace_branch(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, double high,
                        int capacity, struct branch_state *point, enum eo_branch_end *end)
{
  struct eo_vibration start;
  struct eo_cycle cycle;
  if (eo_vibration_solve(solver, load, EO_START_COLD, &start, NULL) ||
      eo_vibration_prepare(solver, load, &cycle, NULL) || start.outcome == EO_VIBRATION_NOT_CONVERGED)
    return 0;
  struct branch_record record = {load->pinion_teeth, capacity, 0, point};
  struct eo_branch_options options = eo_branch_defaults;
  options.low = load->speed * load->pinion_teeth * (1 - 1e-12);
  options.high = high * load->pinion_teeth * (1 + 1e-12);
  options.max_points = capacity;
  options.size = fmax(start.deflection_swing[0], start.force_mean[0] / solver->model.oscillator.shift);
  bool failed = eo_branch_follow(solver->balance, &solver->model.oscillator, &cycle, solver->x, 1, &options, note_point,
                                 &record, end, NULL);
  solver->solved = false;
  return failed ? 0 : record.count;
}

static void trace(void)
{
  static struct branch_state point[2000];
  struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  int folds = 0;
  enum eo_branch_end end = EO_BRANCH_LIMIT;
  double up = 0, down = INFINITY;
  scale_damping(&p, 0.2);
  stiffness_law(&law, 3);
  struct eo_vibration_solver *solver = solver_for(&p, 12, 0);
  struct eo_vibration_case load = paper_case(&law, &law);
  load.speed = 9000 * M_PI / 30;
  int count = trace_branch(solver, &load, 15000 * M_PI / 30, 2000, point, &end);
  ok(count > 0 && end == EO_BRANCH_LIMIT, "the branch is traced to its end over %d points", count);
  for (int i = 0; i < count; i++) {
    folds += point[i].fold;
    up = point[i].fold ? fmax(up, point[i].speed) : up;
    down = point[i].fold ? fmin(down, point[i].speed) : down;
  }
  ok(folds >= 2 && folds % 2 == 0 && up > down * 1.1, "%d folds between %.0f and %.0f rpm", folds, down * 30 / M_PI,
     up * 30 / M_PI);
  load.speed = up * 1.002;
  struct eo_vibration r;
  eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
  ok(r.outcome == EO_VIBRATION_CONTACT_LOST, "just above the upper fold only the separated state is left");
  load.speed = down * 0.99;
  eo_vibration_solve(solver, &load, EO_START_COLD, &r, NULL);
  ok(r.outcome == EO_VIBRATION_CONVERGED, "below the lower fold only the state of full contact is left");
  eo_vibration_free(solver);
  eo_law_done(&law);
}

/* N/m. In time the pinion rings on such a spring in millions of steps: the balance alone goes so far, and a fixed one
   is integrated. */
static const double NEARLY_FIXED = 1e16;

static double held_rms(double stiffness, struct eo_vibration *r)
{
  struct eo_dynamics_parameters p = paper_pair();
  struct eo_law left = {0}, right = {0};
  p.groove_torsional_stiffness[0] = 1.2e7;
  p.groove_torsional_stiffness[1] = 8.4e8;
  p.pinion_axial_stiffness = stiffness;
  stiffness_law(&left, 1);
  stiffness_law(&right, 0.5);
  struct eo_vibration_solver *solver = solver_for(&p, HARMONICS, 0);
  struct eo_vibration_case load = paper_case(&left, &right);
  load.phase_right = 0.2;
  eo_vibration_solve(solver, &load, EO_START_COLD, r, NULL);
  if (stiffness != NEARLY_FIXED) {
    struct eo_vibration t;
    eo_vibration_integrate(solver, &load, NULL, &t, NULL, NULL);
    near(r->rms_pair[0], t.rms_pair[0], 1e-4, "RMS of a held pinion, balance against integration");
    near(r->pinion_thrust_max, t.pinion_thrust_max, 1e-3, "thrust of a held pinion, balance against integration");
  }
  eo_vibration_free(solver);
  eo_law_done(&left);
  eo_law_done(&right);
  return r->rms_pair[0];
}

static void held_limits(void)
{
  struct eo_vibration floating, soft, middle, stiff, fixed;
  double f = held_rms(0, &floating), s = held_rms(1e-3, &soft), m = held_rms(3e8, &middle),
         h = held_rms(NEARLY_FIXED, &stiff), x = held_rms(INFINITY, &fixed);
  near(s, f, 1e-9, "RMS for k_a towards 0, that of a floating pinion");
  near(h, x, 1e-6, "RMS for k_a towards infinity, that of a fixed pinion");
  near(stiff.pinion_thrust_mean, fixed.pinion_thrust_mean, 1e-6,
       "thrust for k_a towards infinity, that of a fixed pinion");
  ok(fabs(m / f - 1) > 1e-2 && fabs(m / x - 1) > 1e-2, "a spring between both gives another RMS: %.3f, %.3f, %.3f m/s2",
     f, m, x);
  ok(floating.pinion_thrust_max == 0, "a floating pinion has no thrust");
}

/* Where the balance finds a state that is not stable: what motion settles to, integrated here once more from elsewhere.
 */
static void doubled(void)
{
  const struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  struct eo_vibration r, balance;
  stiffness_law(&law, 1);
  struct eo_vibration_solver *solver = solver_for(&p, 24, 0);
  struct eo_vibration_case load = paper_case(&law, &law);
  load.torque = 12.8;
  load.speed = 4882.8125 * M_PI / 30;
  load.impact = EO_IMPACT_PAPER;
  load.pulse[0] = load.pulse[1] = (struct eo_pulse){EO_PULSE_HALF_SINE, 300, 0, 0.1};
  eo_vibration_solve(solver, &load, EO_START_COLD, &balance, NULL);
  int failed = eo_vibration_settle(solver, &load, &r, NULL);
  ok(!failed && balance.outcome == EO_VIBRATION_CONTACT_LOST && r.unstable > 1.1,
     "the state of the balance is not stable (%.3f)", r.unstable);
  ok(r.outcome == EO_VIBRATION_CONTACT_LOST && r.repeat > 1 && r.states >= 1, "the motion repeats after %d periods",
     r.repeat);
  ok(fabs(r.rms_pair[0] / balance.rms_pair[0] - 1) > 1e-3 && r.state[0].rms[0] == r.rms_pair[0],
     "the motion that repeats has %.3f m/s2, and the state of the balance %.3f", r.rms_pair[0], balance.rms_pair[0]);
  const struct eo_integration_options options = {1e-9, 1e-6, 1000, 2048, 4};
  struct eo_vibration again;
  eo_vibration_integrate(solver, &load, &options, &again, NULL, NULL);
  near(r.rms_pair[0], again.rms_pair[0], 1e-3, "RMS against a finer integration from the static start");
  ok(again.repeat > 1, "the finer integration repeats after %d periods", again.repeat);
  eo_vibration_free(solver);
  eo_law_done(&law);
}

/* Teeth in contact: the quick multiplier against the full one, and nothing else changes. */
static void settled_in_contact(void)
{
  struct eo_dynamics_parameters p = paper_pair();
  struct eo_law law = {0};
  struct eo_vibration r, plain;
  double complex multiplier[2 * EO_MAX_COORDINATES];
  scale_damping(&p, 0.2);
  stiffness_law(&law, 3);
  struct eo_vibration_solver *solver = solver_for(&p, 24, 0);
  for (int i = 0; i < 3; i++) {
    struct eo_vibration_case load = paper_case(&law, &law);
    load.speed = (i == 0 ? 700 : i == 1 ? 2300 : 6000) * M_PI / 30;
    eo_vibration_settle(solver, &load, &r, NULL);
    eo_vibration_solve(solver, &load, EO_START_COLD, &plain, NULL);
    eo_vibration_stability(solver, &load, multiplier, NULL);
    ok(plain.outcome == EO_VIBRATION_CONVERGED && r.rms_pair[0] == plain.rms_pair[0] && r.periods == 0,
       "a solution in contact is that of the balance, without integration");
    near(r.multiplier, cabs(multiplier[0]), 1e-4, "multipliers by kicks against those by Runge-Kutta");
  }
  eo_vibration_free(solver);
  eo_law_done(&law);
}

int main(void)
{
  held_limits();
  doubled();
  settled_in_contact();
  energy();
  power_in_contact();
  contact_loss(false);
  contact_loss(true);
  constant_float_drops_out();
  convergence();
  stagger();
  single_end();
  sweeps();
  trace();
  return tap_done();
}
