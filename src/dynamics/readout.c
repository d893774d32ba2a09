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

void eo_vibration_orders(const struct eo_vibration_solver *s, enum eo_channel channel, int end, double complex *order)
{
  const struct eo_spectrum *spectrum = &s->spectrum;
  const struct eo_dynamics_parameters *p = &s->model.parameters;
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
      order[k] = w2 * along(spectrum, s->model.reading[EO_READING_TRANSVERSE][end], k);
      break;
    case EO_CHANNEL_ROTATIONAL:
      order[k] = w2 * along(spectrum, s->model.reading[EO_READING_ROTATIONAL][end], k);
      break;
    case EO_CHANNEL_PINION_BEARING:
    case EO_CHANNEL_GEAR_BEARING: {
      int member = channel == EO_CHANNEL_PINION_BEARING ? EO_PINION : EO_GEAR;
      order[k] = support(spectrum, member, end, EO_MOTION_Y, p->bearing_stiffness[member], p->bearing_damping[member],
                         k);
      break;
    }
    case EO_CHANNEL_GEAR_THRUST:
      order[k] = support(spectrum, EO_GEAR, end, EO_MOTION_Z, p->gear_axial_stiffness[end], p->gear_axial_damping[end],
                         k);
      break;
    case EO_CHANNELS:
      order[k] = 0;
    }
  }
}

void eo_vibration_histories(const struct eo_vibration_solver *s, int samples, double *const *const *history)
{
  int harmonics = s->spectrum.harmonics, terms = eo_fourier_terms(harmonics), ends = s->spectrum.ends;
  double complex order[1 + EO_MAX_HARMONICS];
  double series[2 * EO_CHANNELS][MAX_TERMS], basis[MAX_TERMS];
  for (int i = 0; i < ends * EO_CHANNELS; i++) {
    eo_vibration_orders(s, (enum eo_channel)(i % EO_CHANNELS), i / EO_CHANNELS, order);
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
static void spread(struct eo_vibration_solver *s, int k, const double complex *response)
{
  const struct eo_dynamics_model *m = &s->model;
  int n = m->oscillator.n;
  double complex *q = s->spectrum.freedom + (size_t)k * m->freedoms;
  for (int i = 0; i < m->freedoms; i++) {
    q[i] = 0;
    for (int j = 0; j < n; j++)
      q[i] += m->basis[i * n + j] * response[j];
  }
}

static double root_of_squares(int harmonics, const double complex *order)
{
  double sum = 0;
  for (int k = 1; k <= harmonics; k++)
    sum += (creal(order[k]) * creal(order[k]) + cimag(order[k]) * cimag(order[k])) / 2; /* theory (D5) */
  return sqrt(sum);
}

static void read_accelerations(const struct eo_vibration_solver *s, struct eo_vibration *result)
{
  static const enum eo_channel channel[EO_READINGS] = {EO_CHANNEL_NORMAL, EO_CHANNEL_TRANSVERSE, EO_CHANNEL_ROTATIONAL};
  const struct eo_spectrum *spectrum = &s->spectrum;
  int ends = spectrum->ends, harmonics = spectrum->harmonics;
  double complex order[1 + EO_MAX_HARMONICS], mean[1 + EO_MAX_HARMONICS];
  for (int reading = 0; reading < EO_READINGS; reading++) {
    memset(mean, 0, sizeof mean);
    for (int end = 0; end < ends; end++) {
      eo_vibration_orders(s, channel[reading], end, order);
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
  struct range r = {0, sample[0], sample[0]};
  for (int i = 0; i < n; i++) {
    r.mean += sample[i] / n;
    r.least = fmin(r.least, sample[i]);
    r.most = fmax(r.most, sample[i]);
  }
  return r;
}

/* Mean and largest size of a force given by its harmonics, on the grid of the solution. */
static void read_force(const struct eo_vibration_solver *s, const struct eo_alternating *grid,
                       const double complex *order, double *mean, double *largest)
{
  double series[MAX_TERMS];
  series_of(s->spectrum.harmonics, order, series);
  eo_alternating_synthesis(grid, series, grid->end[0].work);
  struct range r = range_of(grid->samples, grid->end[0].work);
  *mean = series[0];
  *largest = fmax(fabs(r.least), fabs(r.most));
}

/* Harmonic k of the axial force of the pinion on its support: that of the spring, or what a rigid one has to take up,
   the axial parts of mesh forces and consistent impacts. */
static double complex pinion_thrust(const struct eo_vibration_solver *s, const struct eo_cycle *cycle, int k)
{
  const struct eo_dynamics_parameters *p = &s->model.parameters;
  const struct eo_spectrum *spectrum = &s->spectrum;
  double complex force = 0, z = 0;
  for (int end = 0; end < p->ends; end++) {
    int freedom_z = eo_dynamics_freedom(p->ends, EO_PINION, end, EO_MOTION_Z);
    double lean = s->model.reading[EO_READING_NORMAL][end][freedom_z];
    force -= lean * spectrum->force[end][k];
    if (s->condensed_impact == EO_IMPACT_CONSISTENT)
      force -= lean / cos(p->base_helix_angle) *
               eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, cycle->shift[end], k);
    z += freedom(spectrum, EO_PINION, end, EO_MOTION_Z, k) / p->ends;
  }
  if (isinf(p->pinion_axial_stiffness))
    return force;
  double ground = p->ends == 1 ? p->groove_axial_stiffness[0] : 0,
         damper = p->ends == 1 ? p->groove_axial_damping[0] : 0;
  return (p->pinion_axial_stiffness + ground + I * k * spectrum->frequency * (p->pinion_axial_damping + damper)) * z;
}

static void read_bearings(const struct eo_vibration_solver *s, const struct eo_cycle *cycle,
                          const struct eo_alternating *grid, struct eo_vibration *result)
{
  double complex order[1 + EO_MAX_HARMONICS];
  for (int end = 0; end < s->spectrum.ends; end++) {
    for (int member = 0; member < 2; member++) {
      eo_vibration_orders(s, member == EO_PINION ? EO_CHANNEL_PINION_BEARING : EO_CHANNEL_GEAR_BEARING, end, order);
      read_force(s, grid, order, &result->bearing_force_mean[member][end], &result->bearing_force_max[member][end]);
    }
    eo_vibration_orders(s, EO_CHANNEL_GEAR_THRUST, end, order);
    read_force(s, grid, order, &result->axial_force_mean[end], &result->axial_force_max[end]);
  }
  for (int k = 0; k <= s->spectrum.harmonics; k++)
    order[k] = pinion_thrust(s, cycle, k);
  read_force(s, grid, order, &result->pinion_thrust_mean, &result->pinion_thrust_max);
}

/* Power of the damping outside the meshes at harmonic k of the oscillator's response. */
static double dissipation(const struct eo_oscillator *o, double w, const double complex *response)
{
  double sum = 0;
  for (int i = 0; i < o->n; i++)
    for (int j = 0; j < o->n; j++)
      sum += o->damping[i * o->n + j] * creal(response[i] * conj(response[j]));
  return w * w * sum / 2;
}

/* Mean of W times the velocity at which it acts, harmonic k. */
static double impact_power(const struct eo_oscillator *o, double w, const double complex *response,
                           const double complex impact[2])
{
  double sum = 0;
  for (int end = 0; end < o->ends; end++) {
    double complex velocity = 0;
    for (int i = 0; i < o->n; i++)
      velocity += I * w * o->pulse[end][i] * response[i];
    sum += creal(impact[end] * conj(velocity)) / 2;
  }
  return sum;
}

/* Fills the spectrum from the deflections in s->x and the forces on the grid, and the power outside the meshes. */
static void fill_spectrum(struct eo_vibration_solver *s, const struct eo_cycle *cycle,
                          const struct eo_balance_report *report, struct eo_vibration *result)
{
  const struct eo_oscillator *o = &s->model.oscillator;
  int terms = eo_fourier_terms(s->harmonics);
  double force[2][MAX_TERMS];
  for (int end = 0; end < o->ends; end++)
    eo_alternating_transform(report->grid, terms, report->grid->end[end % report->ends].force, force[end]);
  for (int k = 0; k <= s->harmonics; k++) {
    double complex f[2] = {0}, x[2] = {0}, w[2] = {0}, response[EO_MAX_COORDINATES];
    for (int end = 0; end < o->ends; end++) {
      s->spectrum.force[end][k] = f[end] = eo_series_harmonic(force[end], k);
      s->spectrum.deflection[end][k] = eo_series_harmonic(s->x + end * terms, k);
      double complex motion = eo_motion_harmonic(cycle, end, k);
      x[end] = s->spectrum.deflection[end][k] - motion;
      w[end] = eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, cycle->shift[end], k);
      result->power_supplied += creal(f[end] * conj(I * k * cycle->frequency * motion)) / 2;
    }
    eo_condensed_response(o, s->harmonic, k, f, x, w, response);
    spread(s, k, response);
    result->power_dissipated += dissipation(o, k * cycle->frequency, response);
    result->power_supplied -= impact_power(o, k * cycle->frequency, response, w);
  }
}

static void read_mesh(const struct eo_vibration_solver *s, const struct eo_alternating *grid, int from,
                      const struct eo_cycle *cycle, int end, double load, struct eo_vibration *result)
{
  const struct eo_time_end *e = &grid->end[from];
  for (int i = 0; i < grid->samples; i++)
    e->work[i] = e->elastic[i] + (cycle->gated && e->margin[i] <= 0 ? 0 : cycle->mesh_damping * e->v[i]);
  struct range force = range_of(grid->samples, e->work), x = range_of(grid->samples, e->x);
  result->force_mean[end] = creal(s->spectrum.force[end][0]);
  result->force_min[end] = force.least;
  result->force_max[end] = force.most;
  result->dynamic_factor[end] = force.most / load;
  result->deflection_mean[end] = x.mean;
  result->deflection_swing[end] = x.most - x.least;
  result->contact_loss[end] = eo_alternating_loss(grid, from);
  for (int i = 0; i < grid->samples; i++) {
    if (e->margin[i] > 0 && e->margin_slope[i] < 0)
      result->back_contact = true;
    result->power_supplied -= e->weight[i] * e->elastic[i] * e->v[i] / grid->samples;
    result->power_dissipated += cycle->mesh_damping * e->gate[i] * e->v[i] * e->v[i] / grid->samples;
  }
}

static void set_outcome(const struct eo_vibration_solver *s, bool found, struct eo_vibration *result)
{
  bool lost = false;
  for (int end = 0; end < s->spectrum.ends; end++)
    lost = lost || result->contact_loss[end] > 0;
  result->outcome = !found ? EO_VIBRATION_NOT_CONVERGED : lost ? EO_VIBRATION_CONTACT_LOST : EO_VIBRATION_CONVERGED;
}

static void begin_result(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                         const struct eo_cycle *cycle, struct eo_vibration *result)
{
  s->spectrum.harmonics = s->harmonics;
  s->spectrum.ends = s->model.parameters.ends;
  s->spectrum.freedoms = s->model.freedoms;
  s->spectrum.frequency = cycle->frequency;
  *result = (struct eo_vibration){.ends = s->spectrum.ends,
                                  .harmonics = s->harmonics,
                                  .frequency = cycle->frequency,
                                  .repeat = 1,
                                  .multiplier = NAN};
  if (load->impact == EO_IMPACT_PAPER) {
    double mean[2] = {0};
    for (int end = 0; end < s->spectrum.ends; end++)
      mean[end] = creal(eo_pulse_harmonic(&cycle->pulse[end], cycle->frequency, 0, 0));
    result->impact_drift = eo_dynamics_model_impact_drift(&s->model, mean);
  }
}

void eo_vibration_read_balance(struct eo_vibration_solver *s, const struct eo_vibration_case *load,
                               const struct eo_cycle *cycle, const struct eo_balance_report *report,
                               struct eo_vibration *result)
{
  begin_result(s, load, cycle, result);
  result->iterations = report->iterations;
  result->residual = isfinite(report->residual) ? report->residual : -1;
  if (!report->converged) {
    memset(s->spectrum.deflection[0], 0, sizeof *s->spectrum.freedom * (4 + EO_MAX_FREEDOMS) * (1 + s->harmonics));
    result->outcome = EO_VIBRATION_NOT_CONVERGED;
    return;
  }
  fill_spectrum(s, cycle, report, result);
  for (int end = 0; end < s->spectrum.ends; end++)
    read_mesh(s, report->grid, end % report->ends, cycle, end,
              eo_dynamics_mesh_load(&s->model.parameters, load->torque), result);
  read_accelerations(s, result);
  read_bearings(s, cycle, report->grid, result);
  set_outcome(s, true, result);
}
