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
  struct eo_balance *w = calloc(1, sizeof *w);
  if (!w)
    return eo_error_memory(error);
  w->harmonics = harmonics;
  int n = w->terms = eo_fourier_terms(harmonics);
  w->stiffness = malloc(sizeof *w->stiffness * (1 + harmonics));
  w->load = malloc(sizeof *w->load * 2 * n);
  w->force = malloc(sizeof *w->force * 2 * n);
  w->residual = malloc(sizeof *w->residual * 2 * n);
  w->scale = malloc(sizeof *w->scale * 4 * n);
  w->jacobian = malloc(sizeof *w->jacobian * 4 * n * n);
  w->pivot = malloc(sizeof *w->pivot * 2 * n);
  enum eo_code code = EO_OK;
  if (!w->stiffness || !w->load || !w->force || !w->residual || !w->scale || !w->jacobian || !w->pivot)
    code = eo_error_memory(error);
  if (!code)
    code = eo_alternating_new(&w->coarse, harmonics, coarse, error);
  if (!code)
    code = eo_alternating_new(&w->fine, harmonics, fine, error);
  if (code) {
    eo_balance_free(w);
    return code;
  }
  *workspace = w;
  return EO_OK;
}

void eo_balance_free(struct eo_balance *w)
{
  if (!w)
    return;
  eo_alternating_free(w->coarse);
  eo_alternating_free(w->fine);
  eo_nonlinear_free(w->newton[0]);
  eo_nonlinear_free(w->newton[1]);
  free(w->stiffness);
  free(w->load);
  free(w->force);
  free(w->residual);
  free(w->scale);
  free(w->jacobian);
  free(w->pivot);
  free(w);
}

int eo_balance_harmonics(const struct eo_balance *workspace)
{
  return workspace->harmonics;
}
int eo_balance_samples(const struct eo_balance *workspace)
{
  return workspace->fine->samples;
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
static double complex load_harmonic(const struct eo_oscillator *o, const struct eo_harmonic *h,
                                    const struct eo_cycle *cycle, int end, int k)
{
  double complex load = h->load[end];
  for (int j = 0; j < o->ends; j++)
    load += h->stiffness[end][j] * eo_motion_harmonic(cycle, j, k) -
            h->transfer[end][j] * eo_pulse_harmonic(&cycle->pulse[j], cycle->frequency, cycle->shift[j], k);
  return load;
}

static bool equal_pulses(const struct eo_pulse *a, const struct eo_pulse *b)
{
  return a->shape == b->shape && a->amplitude == b->amplitude && a->start == b->start && a->duration == b->duration;
}

static bool mirror_ends(const struct eo_oscillator *o, const struct eo_cycle *cycle)
{
  return o->ends == 2 && o->symmetric && cycle->shift[0] == cycle->shift[1] && !cycle->motion[0] && !cycle->motion[1] &&
         equal_pulses(&cycle->pulse[0], &cycle->pulse[1]) && eo_law_equal(cycle->law[0], cycle->law[1]);
}

static void assemble(struct eo_balance *w, const struct eo_oscillator *o, const struct eo_harmonic *harmonic,
                     const struct eo_cycle *cycle, bool mirror)
{
  w->cycle = cycle;
  w->ends = mirror ? 1 : o->ends;
  for (int k = 0; k <= w->harmonics; k++) {
    const struct eo_harmonic *h = harmonic + k;
    memcpy(w->stiffness[k], h->stiffness, sizeof h->stiffness);
    if (mirror)
      w->stiffness[k][0][0] += h->stiffness[0][1];
    for (int end = 0; end < w->ends; end++)
      put_harmonic(w->load + end * w->terms, k, load_harmonic(o, h, cycle, end, k));
  }
}

static double mean_load(const struct eo_balance *w)
{
  double largest = 0;
  for (int end = 0; end < w->ends; end++)
    largest = fmax(largest, fabs(w->load[end * w->terms]));
  for (int i = 0; i < w->ends * w->terms && largest == 0; i++)
    largest = fmax(largest, fabs(w->load[i]));
  return largest > 0 ? largest : 1;
}

/* result += S x - load */
static void add_linear_part(const struct eo_balance *w, const double *x, double *result)
{
  int n = w->terms;
  for (int i = 0; i < w->ends * n; i++)
    result[i] -= w->load[i];
  for (int k = 0; k <= w->harmonics; k++)
    for (int i = 0; i < w->ends; i++)
      for (int j = 0; j < w->ends; j++) {
        double complex product = w->stiffness[k][i][j] * eo_series_harmonic(x + j * n, k);
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
  struct eo_balance *w = context;
  for (int end = 0; end < w->ends; end++)
    eo_alternating_force(w->grid, end, w->cycle, x + end * w->terms, w->attached, residual + end * w->terms);
  add_linear_part(w, x, residual);
  return 0;
}

/* dS x / dx: every harmonic couples its cosine and sine. */
static void add_linear_jacobian(const struct eo_balance *w, double *jacobian)
{
  int n = w->terms, all = w->ends * n;
  for (int k = 0; k <= w->harmonics; k++)
    for (int i = 0; i < w->ends; i++)
      for (int j = 0; j < w->ends; j++) {
        double re = creal(w->stiffness[k][i][j]), im = cimag(w->stiffness[k][i][j]);
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
static void fill_jacobian(struct eo_balance *w, double *jacobian)
{
  int n = w->terms, all = w->ends * n;
  for (int end = 0; end < w->ends; end++)
    eo_alternating_jacobian(w->grid, end, w->cycle, w->attached, all, jacobian + (size_t)(end * n) * all + end * n);
  add_linear_jacobian(w, jacobian);
}

static int balance_jacobian(void *context, const double *x, double *jacobian)
{
  struct eo_balance *w = context;
  int code = balance_residual(w, x, w->residual);
  fill_jacobian(w, jacobian);
  return code;
}

static enum eo_code use_grid(struct eo_balance *w, struct eo_alternating *grid, bool attached, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  w->grid = grid;
  w->attached = attached;
  for (int end = 0; end < w->ends && !code; end++)
    code = eo_alternating_prepare(grid, end, w->cycle->law[end], w->cycle->shift[end], error);
  return code;
}

/* The deflection that carries the mean load at every sample's law: the static curve, as a series. */
static void static_guess(struct eo_balance *w, double *x)
{
  struct eo_alternating *g = w->grid;
  for (int end = 0; end < w->ends; end++) {
    struct eo_time_end *e = &g->end[end];
    double load = fmax(w->load[end * w->terms], 0);
    for (int i = 0; i < g->samples; i++)
      e->x[i] = eo_law_deflection(w->cycle->law[end], e->row + (size_t)i * e->rows, load);
    eo_fourier_series(g->samples, e->x, w->harmonics, x + end * w->terms);
  }
}

static bool in_contact(const struct eo_balance *w)
{
  for (int end = 0; end < w->ends; end++)
    for (int i = 0; i < w->grid->samples; i++)
      if (!(w->grid->end[end].margin[i] > 0))
        return false;
  return true;
}

static double largest_residual(struct eo_balance *w, const double *x)
{
  double largest = 0;
  balance_residual(w, x, w->residual);
  for (int i = 0; i < w->ends * w->terms; i++)
    largest = fmax(largest, fabs(w->residual[i]));
  return largest / mean_load(w);
}

/* Takes one Newton step with the factored Jacobian; returns its size against that of x. */
static double step(struct eo_balance *w, double *x)
{
  int all = w->ends * w->terms;
  double change = 0, size = 0;
  eo_dense_substitute(all, w->jacobian, w->pivot, 1, w->residual);
  for (int i = 0; i < all; i++) {
    x[i] -= w->residual[i];
    change = fmax(change, fabs(w->residual[i]));
    size = fmax(size, fabs(x[i]));
  }
  return size > 0 ? change / size : 0;
}

/* Two Newton steps from zero with the teeth held together: the first solves an affine law, the second refines it and
   tells whether the matrix is so nearly singular (an undamped resonance) that the solution means nothing. Returns
   whether it is sound. */
static bool solve_linear(struct eo_balance *w, double *x)
{
  int all = w->ends * w->terms;
  memset(x, 0, sizeof *x * all);
  memset(w->jacobian, 0, sizeof *w->jacobian * all * all);
  balance_jacobian(w, x, w->jacobian);
  if (eo_dense_factor(all, w->jacobian, w->pivot))
    return false;
  step(w, x);
  balance_residual(w, x, w->residual);
  return step(w, x) < sound;
}

static enum eo_code solve_nonlinear(struct eo_balance *w, double *x, struct eo_balance_report *report,
                                    struct eo_error *error)
{
  enum eo_code code = EO_OK;
  int all = w->ends * w->terms;
  if (!w->newton[w->ends - 1])
    code = eo_nonlinear_new(&w->newton[w->ends - 1], all, error);
  if (code)
    return code;
  double load = mean_load(w), size = 0;
  for (int end = 0; end < w->ends; end++)
    size = fmax(size, fabs(x[end * w->terms]));
  for (int i = 0; i < all; i++) {
    w->scale[i] = size > 0 ? size : 1;
    w->scale[all + i] = load;
  }
  const struct eo_nonlinear_problem problem = {balance_residual, balance_jacobian, w};
  const struct eo_nonlinear_options options = {.x_scale = w->scale,
                                               .residual_scale = w->scale + all,
                                               .residual_tolerance = tolerance,
                                               .step_tolerance = step_tolerance,
                                               .max_iterations = MAX_ITERATIONS};
  struct eo_nonlinear_report found;
  code = eo_nonlinear_solve(w->newton[w->ends - 1], &problem, &options, x, &found, error);
  report->iterations = found.iterations;
  report->residual = found.residual;
  report->converged = found.residual <= acceptable;
  return code;
}

static void copy_mirror(struct eo_balance *w, const struct eo_oscillator *o, double *x)
{
  if (w->ends < o->ends)
    memcpy(x + w->terms, x, sizeof *x * w->terms);
}

enum eo_code eo_balance_solve(struct eo_balance *w, const struct eo_oscillator *oscillator,
                              const struct eo_harmonic *harmonic, const struct eo_cycle *cycle, bool warm, double *x,
                              struct eo_balance_report *report, struct eo_error *error)
{
  assemble(w, oscillator, harmonic, cycle, mirror_ends(oscillator, cycle));
  bool guessed = warm,
       affine = eo_law_is_affine(cycle->law[0]) && (oscillator->ends == 1 || eo_law_is_affine(cycle->law[1]));
  *report = (struct eo_balance_report){.ends = w->ends};
  enum eo_code code = EO_OK;
  if (!warm && affine) {
    if ((code = use_grid(w, w->coarse, true, error)))
      return code;
    guessed = solve_linear(w, x);
    if (guessed) {
      report->residual = largest_residual(w, x);
      report->converged = report->linear = in_contact(w) && report->residual <= acceptable;
      report->grid = w->grid;
    }
  }
  if (!report->converged) {
    if ((code = use_grid(w, w->fine, false, error)))
      return code;
    if (!guessed)
      static_guess(w, x);
    code = solve_nonlinear(w, x, report, error);
    report->grid = w->grid;
  }
  copy_mirror(w, oscillator, x);
  return code;
}

/* Slope of the linear part with frequency: S' x - load', motion and impacts included. */
static void add_frequency_slope(struct eo_balance *w, const struct eo_oscillator *o, const struct eo_harmonic *harmonic,
                                const double *x, double *slope)
{
  const struct eo_cycle *cycle = w->cycle;
  int n = w->terms;
  for (int k = 0; k <= w->harmonics; k++)
    for (int i = 0; i < o->ends; i++) {
      const struct eo_harmonic *h = harmonic + k;
      double complex change = 0;
      for (int j = 0; j < o->ends; j++) {
        const struct eo_pulse *pulse = &cycle->pulse[j];
        double complex impact = eo_pulse_harmonic(pulse, cycle->frequency, cycle->shift[j], k);
        change += h->stiffness_slope[i][j] * (eo_series_harmonic(x + j * n, k) - eo_motion_harmonic(cycle, j, k));
        change += h->transfer_slope[i][j] * impact;
        if (pulse->shape == EO_PULSE_COSINE)
          change += h->transfer[i][j] * impact * 2 / cycle->frequency;
      }
      if (k == 0)
        slope[i * n] += creal(change);
      else {
        slope[i * n + 2 * k - 1] += creal(change);
        slope[i * n + 2 * k] -= cimag(change);
      }
    }
}

enum eo_code eo_balance_linearise(struct eo_balance *w, const struct eo_oscillator *oscillator,
                                  const struct eo_harmonic *harmonic, const struct eo_cycle *cycle, const double *x,
                                  double *residual, double *jacobian, double *slope, struct eo_error *error)
{
  assemble(w, oscillator, harmonic, cycle, false);
  enum eo_code code = use_grid(w, w->fine, false, error);
  if (code)
    return code;
  int n = w->terms, all = w->ends * n;
  double load = mean_load(w);
  balance_residual(w, x, residual);
  memset(jacobian, 0, sizeof *jacobian * all * all);
  fill_jacobian(w, jacobian);
  for (int end = 0; end < w->ends; end++)
    eo_alternating_frequency_slope(w->grid, end, cycle, slope + end * n);
  add_frequency_slope(w, oscillator, harmonic, x, slope);
  for (int i = 0; i < all; i++) {
    residual[i] /= load;
    slope[i] /= load;
  }
  for (size_t i = 0; i < (size_t)all * all; i++)
    jacobian[i] /= load;
  return EO_OK;
}
