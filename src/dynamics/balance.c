/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/balance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/dense.h"
#include "numerics/fourier.h"
#include "numerics/nonlinear.h"

enum { MAX_ITERATIONS = 60, MIN_SAMPLES = 256, SAMPLES_PER_HARMONIC = 16 };
static const double tolerance = 1e-10, acceptable = 1e-7, step_tolerance = 1e-14, sound = 1e-8;

struct eo_balance {
  int harmonics, terms; /* terms = 1 + 2 harmonics */
  struct eo_alternating *coarse, *fine;
  struct eo_nonlinear *newton[2]; /* for one and two ends, made when first needed */
  /* The system being solved. */
  int ends; /* 1 when mirror ends are solved as one */
  bool attached;
  struct eo_alternating *grid;
  const struct eo_cycle *cycle;
  double complex (*stiffness)[2][2]; /* [1 + harmonics] */
  double *load;                      /* [2][terms] right-hand side */
  double *force;                     /* [2][terms] scratch */
  double *jacobian;                  /* [2 terms][2 terms] */
  double *scale;                     /* [2][2 terms] of the unknowns and of the equations */
  double *residual;                  /* [2 terms] */
  double *noted;                     /* [2 terms] where KINSOL has asked for the residual last */
  int *pivot;
};

enum eo_code eo_balance_new(struct eo_balance **workspace, int harmonics, int samples, struct eo_error *error)
{
  if (harmonics < 1 || harmonics > EO_MAX_HARMONICS)
    return eo_error_set(error, EO_ERROR_INPUT, "/resolution/harmonics",
                        "The harmonic balance takes 1 to %d harmonics, not %d.", EO_MAX_HARMONICS, harmonics);
  int fine = samples ? samples : SAMPLES_PER_HARMONIC * harmonics, coarse = MIN_SAMPLES;
  if (fine < MIN_SAMPLES && !samples)
    fine = MIN_SAMPLES;
  while (coarse < 4 * harmonics)
    coarse *= 2;
  struct eo_balance *balance = calloc(1, sizeof *balance);
  if (!balance)
    return eo_error_memory(error);
  balance->harmonics = harmonics;
  int n = balance->terms = eo_fourier_terms(harmonics);
  balance->stiffness = malloc(sizeof *balance->stiffness * (1 + harmonics));
  balance->load = malloc(sizeof *balance->load * 2 * n);
  balance->force = malloc(sizeof *balance->force * 2 * n);
  balance->residual = malloc(sizeof *balance->residual * 2 * n);
  balance->noted = malloc(sizeof *balance->noted * 2 * n);
  balance->scale = malloc(sizeof *balance->scale * 4 * n);
  balance->jacobian = malloc(sizeof *balance->jacobian * 4 * n * n);
  balance->pivot = malloc(sizeof *balance->pivot * 2 * n);
  enum eo_code code = EO_OK;
  if (!balance->stiffness || !balance->load || !balance->force || !balance->residual || !balance->noted ||
      !balance->scale || !balance->jacobian || !balance->pivot)
    code = eo_error_memory(error);
  if (!code)
    code = eo_alternating_new(&balance->coarse, harmonics, coarse, error);
  if (!code)
    code = eo_alternating_new(&balance->fine, harmonics, fine, error);
  if (code) {
    eo_balance_free(balance);
    return code;
  }
  *workspace = balance;
  return EO_OK;
}

void eo_balance_free(struct eo_balance *balance)
{
  if (!balance)
    return;
  eo_alternating_free(balance->coarse);
  eo_alternating_free(balance->fine);
  eo_nonlinear_free(balance->newton[0]);
  eo_nonlinear_free(balance->newton[1]);
  free(balance->stiffness);
  free(balance->load);
  free(balance->force);
  free(balance->residual);
  free(balance->noted);
  free(balance->scale);
  free(balance->jacobian);
  free(balance->pivot);
  free(balance);
}

int eo_balance_harmonics(const struct eo_balance *workspace)
{
  return workspace->harmonics;
}
const struct eo_alternating *eo_balance_grid(const struct eo_balance *workspace)
{
  return workspace->fine;
}

double complex eo_motion_harmonic(const struct eo_cycle *cycle, int end, int k)
{
  if (!cycle->motion[end] || k < 1 || k > cycle->motion_order)
    return 0;
  return eo_series_harmonic(cycle->motion[end], k);
}

double eo_motion_acceleration(const struct eo_cycle *cycle, int end, double phase)
{
  double acceleration = 0;
  for (int k = 1; cycle->motion[end] && k <= cycle->motion_order; k++)
    acceleration -= pow(k * cycle->frequency, 2) *
                    creal(eo_motion_harmonic(cycle, end, k) * cexp(2 * M_PI * I * k * phase));
  return acceleration;
}

static void put_harmonic(double *series, int k, double complex value)
{
  if (k == 0)
    series[0] = creal(value);
  else {
    series[2 * k - 1] = creal(value);
    series[2 * k] = -cimag(value);
  }
}

/* Right-hand side at harmonic k of one end. */
static double complex load_harmonic(const struct eo_oscillator *oscillator, const struct eo_harmonic *harmonic,
                                    const struct eo_cycle *cycle, int end, int k)
{
  double complex load = harmonic->load[end];
  for (int j = 0; j < oscillator->ends; j++)
    load += harmonic->stiffness[end][j] * eo_motion_harmonic(cycle, j, k) -
            harmonic->transfer[end][j] * eo_pulse_harmonic(&cycle->pulse[j], cycle->frequency, cycle->shift[j], k);
  return load;
}

static bool equal_pulses(const struct eo_pulse *a, const struct eo_pulse *b)
{
  return a->shape == b->shape && a->amplitude == b->amplitude && a->start == b->start && a->duration == b->duration;
}

static bool mirror_ends(const struct eo_oscillator *oscillator, const struct eo_cycle *cycle)
{
  return oscillator->ends == 2 && oscillator->symmetric && cycle->shift[0] == cycle->shift[1] && !cycle->motion[0] &&
         !cycle->motion[1] && equal_pulses(&cycle->pulse[0], &cycle->pulse[1]) &&
         eo_law_equal(cycle->law[0], cycle->law[1]);
}

static void assemble(struct eo_balance *balance, const struct eo_oscillator *oscillator,
                     const struct eo_harmonic *harmonic, const struct eo_cycle *cycle, bool mirror)
{
  balance->cycle = cycle;
  balance->ends = mirror ? 1 : oscillator->ends;
  for (int k = 0; k <= balance->harmonics; k++) {
    const struct eo_harmonic *this_harmonic = harmonic + k;
    memcpy(balance->stiffness[k], this_harmonic->stiffness, sizeof this_harmonic->stiffness);
    if (mirror)
      balance->stiffness[k][0][0] += this_harmonic->stiffness[0][1];
    for (int end = 0; end < balance->ends; end++)
      put_harmonic(balance->load + end * balance->terms, k, load_harmonic(oscillator, this_harmonic, cycle, end, k));
  }
}

static double mean_load(const struct eo_balance *balance)
{
  double largest = 0;
  for (int end = 0; end < balance->ends; end++)
    largest = fmax(largest, fabs(balance->load[end * balance->terms]));
  for (int i = 0; i < balance->ends * balance->terms && largest == 0; i++)
    largest = fmax(largest, fabs(balance->load[i]));
  return largest > 0 ? largest : 1;
}

/* result += S x - load */
static void add_linear_part(const struct eo_balance *balance, const double *x, double *result)
{
  int n = balance->terms;
  for (int i = 0; i < balance->ends * n; i++)
    result[i] -= balance->load[i];
  for (int k = 0; k <= balance->harmonics; k++)
    for (int i = 0; i < balance->ends; i++)
      for (int j = 0; j < balance->ends; j++) {
        double complex product = balance->stiffness[k][i][j] * eo_series_harmonic(x + j * n, k);
        if (k == 0)
          result[i * n] += creal(product);
        else {
          result[i * n + 2 * k - 1] += creal(product);
          result[i * n + 2 * k] -= cimag(product);
        }
      }
}

static int balance_residual(void *context, const double *x, double *residual)
{
  struct eo_balance *balance = context;
  for (int end = 0; end < balance->ends; end++)
    eo_alternating_force(balance->grid, end, balance->cycle, x + end * balance->terms, balance->attached,
                         residual + end * balance->terms);
  add_linear_part(balance, x, residual);
  return 0;
}

/* dS x / dx: every harmonic couples its cosine and sine. */
static void add_linear_jacobian(const struct eo_balance *balance, double *jacobian)
{
  int n = balance->terms, all = balance->ends * n;
  for (int k = 0; k <= balance->harmonics; k++)
    for (int i = 0; i < balance->ends; i++)
      for (int j = 0; j < balance->ends; j++) {
        double re = creal(balance->stiffness[k][i][j]), im = cimag(balance->stiffness[k][i][j]);
        if (k == 0) {
          jacobian[(size_t)(i * n) * all + j * n] += re;
          continue;
        }
        double *cosine = jacobian + (size_t)(i * n + 2 * k - 1) * all + j * n + 2 * k - 1, *sine = cosine + all;
        cosine[0] += re;
        cosine[1] += im;
        sine[0] -= im;
        sine[1] += re;
      }
}

/* Of the forces last evaluated. jacobian is zero on entry. */
static void fill_jacobian(struct eo_balance *balance, double *jacobian)
{
  int n = balance->terms, all = balance->ends * n;
  for (int end = 0; end < balance->ends; end++)
    eo_alternating_jacobian(balance->grid, end, balance->cycle, balance->attached, all,
                            jacobian + (size_t)(end * n) * all + end * n);
  add_linear_jacobian(balance, jacobian);
}

static int balance_jacobian(void *context, const double *x, double *jacobian)
{
  struct eo_balance *balance = context;
  int code = balance_residual(balance, x, balance->residual);
  fill_jacobian(balance, jacobian);
  return code;
}

/* For KINSOL, which asks for it where it has asked for the residual last: the forces are there already. */
static int noted_residual(void *context, const double *x, double *residual)
{
  struct eo_balance *balance = context;
  memcpy(balance->noted, x, sizeof *x * balance->ends * balance->terms);
  return balance_residual(balance, x, residual);
}

static int noted_jacobian(void *context, const double *x, double *jacobian)
{
  struct eo_balance *balance = context;
  if (memcmp(balance->noted, x, sizeof *x * balance->ends * balance->terms) != 0)
    return balance_jacobian(balance, x, jacobian);
  fill_jacobian(balance, jacobian);
  return 0;
}

static enum eo_code use_grid(struct eo_balance *balance, struct eo_alternating *grid, bool attached,
                             struct eo_error *error)
{
  enum eo_code code = EO_OK;
  balance->grid = grid;
  balance->attached = attached;
  for (int end = 0; end < balance->ends && !code; end++)
    code = eo_alternating_prepare(grid, end, balance->cycle->law[end], balance->cycle->shift[end], error);
  return code;
}

/* The deflection that carries the mean load at every sample's law: the static curve, as a series. */
static void static_guess(struct eo_balance *balance, double *x)
{
  struct eo_alternating *alternating = balance->grid;
  for (int end = 0; end < balance->ends; end++) {
    struct eo_time_end *time_end = &alternating->end[end];
    double load = fmax(balance->load[end * balance->terms], 0);
    for (int i = 0; i < alternating->samples; i++)
      time_end->x[i] = eo_law_deflection(balance->cycle->law[end], time_end->row + (size_t)i * time_end->rows, load);
    eo_fourier_series(alternating->samples, time_end->x, balance->harmonics, x + end * balance->terms);
  }
}

static bool in_contact(const struct eo_balance *balance)
{
  for (int end = 0; end < balance->ends; end++)
    for (int i = 0; i < balance->grid->samples; i++)
      if (!(balance->grid->end[end].margin[i] > 0))
        return false;
  return true;
}

static double largest_residual(struct eo_balance *balance, const double *x)
{
  double largest = 0;
  balance_residual(balance, x, balance->residual);
  for (int i = 0; i < balance->ends * balance->terms; i++)
    largest = fmax(largest, fabs(balance->residual[i]));
  return largest / mean_load(balance);
}

/* Takes one Newton step with the factored Jacobian; returns its size against that of x. */
static double step(struct eo_balance *balance, double *x)
{
  int all = balance->ends * balance->terms;
  double change = 0, size = 0;
  eo_dense_substitute(all, balance->jacobian, balance->pivot, 1, balance->residual);
  for (int i = 0; i < all; i++) {
    x[i] -= balance->residual[i];
    change = fmax(change, fabs(balance->residual[i]));
    size = fmax(size, fabs(x[i]));
  }
  return size > 0 ? change / size : 0;
}

/* Two Newton steps from zero with the teeth held together: the first solves an affine law, the second refines it and
   tells whether the matrix is so nearly singular (an undamped resonance) that the solution means nothing. Returns
   whether it is sound. */
static bool solve_linear(struct eo_balance *balance, double *x)
{
  int all = balance->ends * balance->terms;
  memset(x, 0, sizeof *x * all);
  memset(balance->jacobian, 0, sizeof *balance->jacobian * all * all);
  balance_jacobian(balance, x, balance->jacobian);
  if (eo_dense_factor(all, balance->jacobian, balance->pivot))
    return false;
  step(balance, x);
  balance_residual(balance, x, balance->residual);
  return step(balance, x) < sound;
}

static enum eo_code solve_nonlinear(struct eo_balance *balance, double *x, struct eo_balance_report *report,
                                    struct eo_error *error)
{
  enum eo_code code = EO_OK;
  int all = balance->ends * balance->terms;
  if (!balance->newton[balance->ends - 1])
    code = eo_nonlinear_new(&balance->newton[balance->ends - 1], all, error);
  if (code)
    return code;
  double load = mean_load(balance), size = 0;
  for (int end = 0; end < balance->ends; end++)
    size = fmax(size, fabs(x[end * balance->terms]));
  for (int i = 0; i < all; i++) {
    balance->scale[i] = size > 0 ? size : 1;
    balance->scale[all + i] = load;
  }
  const struct eo_nonlinear_problem problem = {noted_residual, noted_jacobian, balance};
  const struct eo_nonlinear_options options = {.x_scale = balance->scale,
                                               .residual_scale = balance->scale + all,
                                               .residual_tolerance = tolerance,
                                               .step_tolerance = step_tolerance,
                                               .max_iterations = MAX_ITERATIONS};
  struct eo_nonlinear_report found;
  code = eo_nonlinear_solve(balance->newton[balance->ends - 1], &problem, &options, x, &found, error);
  report->iterations = found.iterations;
  report->residual = found.residual;
  report->converged = found.residual <= acceptable;
  return code;
}

static void copy_mirror(struct eo_balance *balance, const struct eo_oscillator *oscillator, double *x)
{
  if (balance->ends < oscillator->ends)
    memcpy(x + balance->terms, x, sizeof *x * balance->terms);
}

enum eo_code eo_balance_solve(struct eo_balance *balance, const struct eo_oscillator *oscillator,
                              const struct eo_harmonic *harmonic, const struct eo_cycle *cycle, bool warm, double *x,
                              struct eo_balance_report *report, struct eo_error *error)
{
  assemble(balance, oscillator, harmonic, cycle, mirror_ends(oscillator, cycle));
  bool guessed = warm,
       affine = eo_law_is_affine(cycle->law[0]) && (oscillator->ends == 1 || eo_law_is_affine(cycle->law[1]));
  *report = (struct eo_balance_report){.ends = balance->ends};
  enum eo_code code = EO_OK;
  if (!warm && affine) {
    if ((code = use_grid(balance, balance->coarse, true, error)))
      return code;
    guessed = solve_linear(balance, x);
    if (guessed) {
      report->residual = largest_residual(balance, x);
      report->converged = report->linear = in_contact(balance) && report->residual <= acceptable;
      report->grid = balance->grid;
    }
  }
  if (!report->converged) {
    if ((code = use_grid(balance, balance->fine, false, error)))
      return code;
    if (!guessed)
      static_guess(balance, x);
    code = solve_nonlinear(balance, x, report, error);
    report->grid = balance->grid;
  }
  copy_mirror(balance, oscillator, x);
  return code;
}

/* Slope of the linear part with frequency: S' x - load', motion and impacts included. */
static void add_frequency_slope(struct eo_balance *balance, const struct eo_oscillator *oscillator,
                                const struct eo_harmonic *harmonic, const double *x, double *slope)
{
  const struct eo_cycle *cycle = balance->cycle;
  int n = balance->terms;
  for (int k = 0; k <= balance->harmonics; k++)
    for (int i = 0; i < oscillator->ends; i++) {
      const struct eo_harmonic *this_harmonic = harmonic + k;
      double complex change = 0;
      for (int j = 0; j < oscillator->ends; j++) {
        const struct eo_pulse *pulse = &cycle->pulse[j];
        double complex impact = eo_pulse_harmonic(pulse, cycle->frequency, cycle->shift[j], k);
        change += this_harmonic->stiffness_slope[i][j] *
                  (eo_series_harmonic(x + j * n, k) - eo_motion_harmonic(cycle, j, k));
        change += this_harmonic->transfer_slope[i][j] * impact;
        if (pulse->shape == EO_PULSE_COSINE)
          change += this_harmonic->transfer[i][j] * impact * 2 / cycle->frequency;
      }
      if (k == 0)
        slope[i * n] += creal(change);
      else {
        slope[i * n + 2 * k - 1] += creal(change);
        slope[i * n + 2 * k] -= cimag(change);
      }
    }
}

enum eo_code eo_balance_linearise(struct eo_balance *balance, const struct eo_oscillator *oscillator,
                                  const struct eo_harmonic *harmonic, const struct eo_cycle *cycle, const double *x,
                                  double *residual, double *jacobian, double *slope, struct eo_error *error)
{
  assemble(balance, oscillator, harmonic, cycle, false);
  enum eo_code code = use_grid(balance, balance->fine, false, error);
  if (code)
    return code;
  int n = balance->terms, all = balance->ends * n;
  double load = mean_load(balance);
  balance_residual(balance, x, residual);
  memset(jacobian, 0, sizeof *jacobian * all * all);
  fill_jacobian(balance, jacobian);
  for (int end = 0; end < balance->ends; end++)
    eo_alternating_frequency_slope(balance->grid, end, cycle, slope + end * n);
  add_frequency_slope(balance, oscillator, harmonic, x, slope);
  for (int i = 0; i < all; i++) {
    residual[i] /= load;
    slope[i] /= load;
  }
  for (size_t i = 0; i < (size_t)all * all; i++)
    jacobian[i] /= load;
  return EO_OK;
}
