/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything that is read off a periodic solution. */
#include <math.h>
#include <string.h>

#include "dynamics/vibration_private.h"
#include "numerics/fourier.h"

enum { MAX_TERMS = 1 + 2 * EO_MAX_HARMONICS };

static void series_of(int harmonics, const double complex *harmonic, double *series)
{
  series[0] = creal(harmonic[0]);
  for (int k = 1; k <= harmonics; k++) {
    series[2 * k - 1] = creal(harmonic[k]);
    series[2 * k] = -cimag(harmonic[k]);
  }
}

/* row . q_k */
static double complex along(const struct eo_spectrum *spectrum, const double *row, int k)
{
  const double complex *q = spectrum->freedom + (size_t)k * spectrum->freedoms;
  double complex sum = 0;
  for (int i = 0; i < spectrum->freedoms; i++)
    sum += row[i] * q[i];
  return sum;
}

static double complex freedom(const struct eo_spectrum *spectrum, int member, int end, enum eo_motion motion, int k)
{
  return spectrum->freedom[(size_t)k * spectrum->freedoms + eo_dynamics_freedom(spectrum->ends, member, end, motion)];
}

/* Spring and damper to ground at harmonic k. */
static double complex support(const struct eo_spectrum *spectrum, int member, int end, enum eo_motion motion,
                              double stiffness, double damping, int k)
{
  return (stiffness + I * k * spectrum->frequency * damping) * freedom(spectrum, member, end, motion, k);
}

void eo_vibration_orders(const struct eo_vibration_solver *solver, enum eo_channel channel, int end,
                         double complex *order)
{
  const struct eo_spectrum *spectrum = &solver->spectrum;
  const struct eo_dynamics_parameters *parameters = &solver->model.parameters;
  for (int k = 0; k <= spectrum->harmonics; k++) {
    double w2 = -pow(k * spectrum->frequency, 2);
    switch (channel) {
    case EO_CHANNEL_DEFLECTION:
      order[k] = spectrum->deflection[end][k];
      break;
    case EO_CHANNEL_FORCE:
      order[k] = spectrum->force[end][k];
      break;
    case EO_CHANNEL_NORMAL:
      order[k] = w2 * spectrum->deflection[end][k];
      break;
    case EO_CHANNEL_TRANSVERSE:
      order[k] = w2 * along(spectrum, solver->model.reading[EO_READING_TRANSVERSE][end], k);
      break;
    case EO_CHANNEL_ROTATIONAL:
      order[k] = w2 * along(spectrum, solver->model.reading[EO_READING_ROTATIONAL][end], k);
      break;
    case EO_CHANNEL_PINION_BEARING:
    case EO_CHANNEL_GEAR_BEARING: {
      int member = channel == EO_CHANNEL_PINION_BEARING ? EO_PINION : EO_GEAR;
      order[k] = support(spectrum, member, end, EO_MOTION_Y, parameters->bearing_stiffness[member],
                         parameters->bearing_damping[member], k);
      break;
    }
    case EO_CHANNEL_GEAR_THRUST:
      order[k] = support(spectrum, EO_GEAR, end, EO_MOTION_Z, parameters->gear_axial_stiffness[end],
                         parameters->gear_axial_damping[end], k);
      break;
    case EO_CHANNELS:
      order[k] = 0;
    }
  }
}

void eo_vibration_histories(const struct eo_vibration_solver *solver, int samples, double *const *const *history)
{
  int harmonics = solver->spectrum.harmonics, terms = eo_fourier_terms(harmonics), ends = solver->spectrum.ends;
  double complex order[1 + EO_MAX_HARMONICS];
  double series[2 * EO_CHANNELS][MAX_TERMS], basis[MAX_TERMS];
  for (int i = 0; i < ends * EO_CHANNELS; i++) {
    eo_vibration_orders(solver, (enum eo_channel)(i % EO_CHANNELS), i / EO_CHANNELS, order);
    series_of(harmonics, order, series[i]);
  }
  for (int j = 0; j < samples; j++) {
    eo_fourier_basis(harmonics, (double)j / samples, basis);
    for (int i = 0; i < ends * EO_CHANNELS; i++) {
      double value = series[i][0];
      for (int k = 1; k < terms; k += 2)
        value += series[i][k] * basis[k] + series[i][k + 1] * basis[k + 1];
      history[i / EO_CHANNELS][i % EO_CHANNELS][j] = value;
    }
  }
}

/* Displacements q_k from those of the oscillator; the zero modes have no part in them. */
static void spread(struct eo_vibration_solver *solver, int k, const double complex *response)
{
  const struct eo_dynamics_model *model = &solver->model;
  int n = model->oscillator.n;
  double complex *q = solver->spectrum.freedom + (size_t)k * model->freedoms;
  for (int i = 0; i < model->freedoms; i++) {
    q[i] = 0;
    for (int j = 0; j < n; j++)
      q[i] += model->basis[i * n + j] * response[j];
  }
}

static double root_of_squares(int harmonics, const double complex *order)
{
  double sum = 0;
  for (int k = 1; k <= harmonics; k++)
    sum += (creal(order[k]) * creal(order[k]) + cimag(order[k]) * cimag(order[k])) / 2; /* theory (D5) */
  return sqrt(sum);
}

static void read_accelerations(const struct eo_vibration_solver *solver, struct eo_vibration *result)
{
  static const enum eo_channel channel[EO_READINGS] = {EO_CHANNEL_NORMAL, EO_CHANNEL_TRANSVERSE, EO_CHANNEL_ROTATIONAL};
  const struct eo_spectrum *spectrum = &solver->spectrum;
  int ends = spectrum->ends, harmonics = spectrum->harmonics;
  double complex order[1 + EO_MAX_HARMONICS], mean[1 + EO_MAX_HARMONICS];
  for (int reading = 0; reading < EO_READINGS; reading++) {
    memset(mean, 0, sizeof mean);
    for (int end = 0; end < ends; end++) {
      eo_vibration_orders(solver, channel[reading], end, order);
      result->rms[reading][end] = root_of_squares(harmonics, order);
      result->rms_pair[reading] += result->rms[reading][end] / ends;
      for (int k = 0; k <= harmonics; k++)
        mean[k] += order[k] / ends;
    }
    result->rms_of_mean[reading] = root_of_squares(harmonics, mean);
  }
  for (int i = 0; i < spectrum->freedoms; i++) {
    for (int k = 0; k <= harmonics; k++)
      order[k] = -pow(k * spectrum->frequency, 2) * spectrum->freedom[(size_t)k * spectrum->freedoms + i];
    result->freedom_rms[i] = root_of_squares(harmonics, order);
    result->freedom_mean[i] = creal(spectrum->freedom[i]);
  }
}

struct range {
  double mean, least, most;
};

static struct range range_of(int n, const double *sample)
{
  struct range range = {0, sample[0], sample[0]};
  for (int i = 0; i < n; i++) {
    range.mean += sample[i] / n;
    range.least = fmin(range.least, sample[i]);
    range.most = fmax(range.most, sample[i]);
  }
  return range;
}

/* Mean and largest size of a force given by its harmonics, on the grid of the solution. */
static void read_force(const struct eo_vibration_solver *solver, const struct eo_alternating *grid,
                       const double complex *order, double *mean, double *largest)
{
  double series[MAX_TERMS];
  series_of(solver->spectrum.harmonics, order, series);
  eo_alternating_synthesis(grid, series, grid->end[0].work);
  struct range range = range_of(grid->samples, grid->end[0].work);
  *mean = series[0];
  *largest = fmax(fabs(range.least), fabs(range.most));
}

/* Harmonic k of the axial force of the pinion on its support: that of the spring, or what a rigid one has to take up,
   the axial parts of mesh forces and consistent impacts. */
static double complex pinion_thrust(const struct eo_vibration_solver *solver, const struct eo_cycle *cycle, int k)
{
  const struct eo_dynamics_parameters *parameters = &solver->model.parameters;
  const struct eo_spectrum *spectrum = &solver->spectrum;
  double complex force = 0, z = 0;
  for (int end = 0; end < parameters->ends; end++) {
    int freedom_z = eo_dynamics_freedom(parameters->ends, EO_PINION, end, EO_MOTION_Z);
    double lean = solver->model.reading[EO_READING_NORMAL][end][freedom_z];
    force -= lean * spectrum->force[end][k];
    if (solver->condensed_impact == EO_IMPACT_CONSISTENT)
      force -= lean / cos(eo_dynamics_base_helix_angle(parameters, end)) *
               eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, cycle->shift[end], k);
    z += freedom(spectrum, EO_PINION, end, EO_MOTION_Z, k) / parameters->ends;
  }
  if (isinf(parameters->pinion_axial_stiffness))
    return force;
  double ground = parameters->ends == 1 ? parameters->groove_axial_stiffness[0] : 0,
         damper = parameters->ends == 1 ? parameters->groove_axial_damping[0] : 0;
  return (parameters->pinion_axial_stiffness + ground +
          I * k * spectrum->frequency * (parameters->pinion_axial_damping + damper)) *
         z;
}

static void read_bearings(const struct eo_vibration_solver *solver, const struct eo_cycle *cycle,
                          const struct eo_alternating *grid, struct eo_vibration *result)
{
  double complex order[1 + EO_MAX_HARMONICS];
  for (int end = 0; end < solver->spectrum.ends; end++) {
    for (int member = 0; member < 2; member++) {
      eo_vibration_orders(solver, member == EO_PINION ? EO_CHANNEL_PINION_BEARING : EO_CHANNEL_GEAR_BEARING, end,
                          order);
      read_force(solver, grid, order, &result->bearing_force_mean[member][end],
                 &result->bearing_force_max[member][end]);
    }
    eo_vibration_orders(solver, EO_CHANNEL_GEAR_THRUST, end, order);
    read_force(solver, grid, order, &result->axial_force_mean[end], &result->axial_force_max[end]);
  }
  for (int k = 0; k <= solver->spectrum.harmonics; k++)
    order[k] = pinion_thrust(solver, cycle, k);
  read_force(solver, grid, order, &result->pinion_thrust_mean, &result->pinion_thrust_max);
}

/* Power of the damping outside the meshes at harmonic k of the oscillator's response. */
static double dissipation(const struct eo_oscillator *oscillator, double w, const double complex *response)
{
  double sum = 0;
  for (int i = 0; i < oscillator->n; i++)
    for (int j = 0; j < oscillator->n; j++)
      sum += oscillator->damping[i * oscillator->n + j] * creal(response[i] * conj(response[j]));
  return w * w * sum / 2;
}

/* Mean of W times the velocity at which it acts, harmonic k. */
static double impact_power(const struct eo_oscillator *oscillator, double w, const double complex *response,
                           const double complex impact[2])
{
  double sum = 0;
  for (int end = 0; end < oscillator->ends; end++) {
    double complex velocity = 0;
    for (int i = 0; i < oscillator->n; i++)
      velocity += I * w * oscillator->pulse[end][i] * response[i];
    sum += creal(impact[end] * conj(velocity)) / 2;
  }
  return sum;
}

/* Fills the spectrum from the deflections in s->x and the forces on the grid, and the power outside the meshes. */
static void fill_spectrum(struct eo_vibration_solver *solver, const struct eo_cycle *cycle,
                          const struct eo_balance_report *report, struct eo_vibration *result)
{
  const struct eo_oscillator *oscillator = &solver->model.oscillator;
  int terms = eo_fourier_terms(solver->harmonics);
  double force[2][MAX_TERMS];
  for (int end = 0; end < oscillator->ends; end++)
    eo_alternating_transform(report->grid, terms, report->grid->end[end % report->ends].force, force[end]);
  for (int k = 0; k <= solver->harmonics; k++) {
    double complex f[2] = {0}, x[2] = {0}, w[2] = {0}, response[EO_MAX_COORDINATES];
    for (int end = 0; end < oscillator->ends; end++) {
      solver->spectrum.force[end][k] = f[end] = eo_series_harmonic(force[end], k);
      solver->spectrum.deflection[end][k] = eo_series_harmonic(solver->x + end * terms, k);
      double complex motion = eo_motion_harmonic(cycle, end, k);
      x[end] = solver->spectrum.deflection[end][k] - motion;
      w[end] = eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, cycle->shift[end], k);
      result->power_supplied += creal(f[end] * conj(I * k * cycle->frequency * motion)) / 2;
    }
    eo_condensed_response(oscillator, solver->harmonic, k, f, x, w, response);
    spread(solver, k, response);
    result->power_dissipated += dissipation(oscillator, k * cycle->frequency, response);
    result->power_supplied -= impact_power(oscillator, k * cycle->frequency, response, w);
  }
}

static void read_mesh(const struct eo_vibration_solver *solver, const struct eo_alternating *grid, int from,
                      const struct eo_cycle *cycle, int end, double load, struct eo_vibration *result)
{
  const struct eo_time_end *time_end = &grid->end[from];
  for (int i = 0; i < grid->samples; i++)
    time_end->work[i] = time_end->elastic[i] +
                        (cycle->gated && time_end->margin[i] <= 0 ? 0 : cycle->mesh_damping * time_end->v[i]);
  struct range force = range_of(grid->samples, time_end->work), range = range_of(grid->samples, time_end->x);
  result->force_mean[end] = creal(solver->spectrum.force[end][0]);
  result->force_min[end] = force.least;
  result->force_max[end] = force.most;
  result->dynamic_factor[end] = force.most / load;
  result->deflection_mean[end] = range.mean;
  result->deflection_swing[end] = range.most - range.least;
  result->contact_loss[end] = eo_alternating_loss(grid, from);
  for (int i = 0; i < grid->samples; i++) {
    if (time_end->margin[i] > 0 && time_end->margin_slope[i] < 0)
      result->back_contact = true;
    result->power_supplied -= time_end->weight[i] * time_end->elastic[i] * time_end->v[i] / grid->samples;
    result->power_dissipated += cycle->mesh_damping * time_end->gate[i] * time_end->v[i] * time_end->v[i] /
                                grid->samples;
  }
}

static void set_outcome(const struct eo_vibration_solver *solver, bool found, struct eo_vibration *result)
{
  bool lost = false;
  for (int end = 0; end < solver->spectrum.ends; end++)
    lost = lost || result->contact_loss[end] > 0;
  result->outcome = !found ? EO_VIBRATION_NOT_CONVERGED : lost ? EO_VIBRATION_CONTACT_LOST : EO_VIBRATION_CONVERGED;
}

static void begin_result(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                         const struct eo_cycle *cycle, struct eo_vibration *result)
{
  solver->spectrum.harmonics = solver->harmonics;
  solver->spectrum.ends = solver->model.parameters.ends;
  solver->spectrum.freedoms = solver->model.freedoms;
  solver->spectrum.frequency = cycle->frequency;
  *result = (struct eo_vibration){.ends = solver->spectrum.ends,
                                  .harmonics = solver->harmonics,
                                  .frequency = cycle->frequency,
                                  .repeat = 1,
                                  .multiplier = NAN};
  if (load->impact == EO_IMPACT_PAPER) {
    double mean[2] = {0};
    for (int end = 0; end < solver->spectrum.ends; end++)
      mean[end] = creal(eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, 0, 0));
    result->impact_drift = eo_dynamics_model_impact_drift(&solver->model, mean);
  }
}

void eo_vibration_read_balance(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                               const struct eo_cycle *cycle, const struct eo_balance_report *report,
                               struct eo_vibration *result)
{
  begin_result(solver, load, cycle, result);
  result->iterations = report->iterations;
  result->residual = isfinite(report->residual) ? report->residual : -1;
  if (!report->converged) {
    memset(solver->spectrum.deflection[0], 0,
           sizeof *solver->spectrum.freedom * (4 + EO_MAX_FREEDOMS) * (1 + solver->harmonics));
    result->outcome = EO_VIBRATION_NOT_CONVERGED;
    return;
  }
  fill_spectrum(solver, cycle, report, result);
  for (int end = 0; end < solver->spectrum.ends; end++)
    read_mesh(solver, report->grid, end % report->ends, cycle, end,
              eo_dynamics_mesh_load(&solver->model.parameters, load->torque, end), result);
  read_accelerations(solver, result);
  read_bearings(solver, cycle, report->grid, result);
  set_outcome(solver, true, result);
}
