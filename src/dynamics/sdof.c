/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/sdof.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/continuation.h"
#include "dynamics/integration.h"
#include "dynamics/stability.h"
#include "numerics/fourier.h"

enum {
  HARMONICS = 40,
  TERMS = 1 + 2 * HARMONICS,
  SAMPLES = 2048,
  BRANCH_HARMONICS = 20,
  BRANCH_SAMPLES = 1024,
  LEAD_PERIODS = 3
};

static const double BELOW = 0.999;       /* of the frequency where a branch starts: the start lies inside */
static const double LONGEST_STEP = 0.04; /* along a branch: as of eo_branch_options */
static const double LOW = 0.2, HIGH = 3; /* frequencies, of the natural one, that a branch covers at least */

/* The oscillator, its law and the workspace. */
struct setup {
  struct eo_oscillator oscillator;
  struct eo_law law;
  struct eo_cycle cycle;
  struct eo_balance *balance;
};

static enum eo_code check_sdof(const struct eo_sdof *sdof, struct eo_error *error)
{
  if (!(sdof->damping >= 0 && isfinite(sdof->damping)))
    return eo_error_set(error, EO_ERROR_INPUT, "/z", "The damping must not be negative, but is %g.", sdof->damping);
  if (!(sdof->mean_force > 0 && isfinite(sdof->mean_force)))
    return eo_error_set(error, EO_ERROR_INPUT, "/Fm", "The mean force must be positive, not %g.", sdof->mean_force);
  if (!isfinite(sdof->alternating_force))
    return eo_error_set(error, EO_ERROR_INPUT, "/Fh", "The alternating force must be finite.");
  if (!(fabs(sdof->stiffness_share) < 1))
    return eo_error_set(error, EO_ERROR_INPUT, "/e", "The stiffness must stay positive: |e| < 1, not %g.",
                        sdof->stiffness_share);
  if (!(sdof->frequency > 0 && isfinite(sdof->frequency)))
    return eo_error_set(error, EO_ERROR_INPUT, "/W", "The frequency must be positive, not %g.", sdof->frequency);
  return EO_OK;
}

static enum eo_code make_setup(struct setup *setup, const struct eo_sdof *sdof, int harmonics, int samples,
                               struct eo_error *error)
{
  const double stiffness[3] = {1, sdof->stiffness_share, 0};
  enum eo_code code = check_sdof(sdof, error);
  *setup = (struct setup){0};
  if (!code)
    code = eo_law_set_stiffness(&setup->law, 1, stiffness, 1, -1, error);
  if (!code)
    code = eo_balance_new(&setup->balance, harmonics, samples, error);
  setup->oscillator = (struct eo_oscillator){.n = 1,
                                             .ends = 1,
                                             .damping = {2 * sdof->damping},
                                             .mesh = {{1}},
                                             .pulse = {{1}},
                                             .load = {sdof->mean_force},
                                             .shift = 1};
  setup->cycle = (struct eo_cycle){.frequency = sdof->frequency,
                                   .law = {&setup->law, &setup->law},
                                   .pulse = {{.shape = EO_PULSE_COSINE, .amplitude = -sdof->alternating_force}}};
  return code;
}

static void free_setup(struct setup *setup)
{
  eo_balance_free(setup->balance);
  eo_law_done(&setup->law);
}

static enum eo_code balance_at(struct setup *setup, bool warm, double *x, struct eo_balance_report *report,
                               struct eo_error *error)
{
  struct eo_harmonic harmonic[1 + HARMONICS];
  eo_condense(&setup->oscillator, setup->cycle.frequency, eo_balance_harmonics(setup->balance), false, harmonic);
  return eo_balance_solve(setup->balance, &setup->oscillator, harmonic, &setup->cycle, warm, x, report, error);
}

/* A few periods of time integration from the given state make the guess for Newton. */
static enum eo_code guess_from_state(struct setup *setup, const double state[2], double *x, struct eo_error *error)
{
  double acceleration[SAMPLES], deflection[SAMPLES];
  struct eo_mesh_state *mesh = malloc(sizeof *mesh * 2 * SAMPLES);
  if (!mesh)
    return eo_error_memory(error);
  const struct eo_integration_options options = {1e-9, 1e-12, LEAD_PERIODS, SAMPLES, 1};
  struct eo_integration run = {.acceleration = acceleration, .mesh = mesh};
  enum eo_code code = eo_integrate(&setup->oscillator, &setup->cycle, &options, state, &run, NULL, error);
  for (int i = 0; i < SAMPLES && !code; i++)
    deflection[i] = mesh[2 * i].deflection;
  if (!code)
    eo_fourier_series(SAMPLES, deflection, HARMONICS, x);
  free(mesh);
  return code;
}

static void read_response(const double *x, const struct eo_alternating *grid, struct eo_sdof_response *response)
{
  const struct eo_time_end *time_end = &grid->end[0];
  double least = time_end->x[0], most = time_end->x[0], square = 0;
  for (int i = 0; i < grid->samples; i++) {
    least = fmin(least, time_end->x[i]);
    most = fmax(most, time_end->x[i]);
    if (time_end->x[i] < -1)
      response->back_contact = true;
  }
  for (int i = 1; i < eo_fourier_terms(grid->harmonics); i++)
    square += x[i] * x[i] / 2;
  response->mean = x[0];
  response->rms = sqrt(square);
  response->peak_to_peak = most - least;
  response->amplitude[0] = hypot(x[1], x[2]);
  response->amplitude[1] = hypot(x[3], x[4]);
  response->contact_loss = eo_alternating_loss(grid, 0);
}

/* Newton from x, then the reading and the stability of what it found. */
static enum eo_code finish(struct setup *setup, bool warm, double *x, struct eo_sdof_response *response,
                           struct eo_error *error)
{
  struct eo_balance_report report;
  double complex multiplier[2];
  enum eo_code code = balance_at(setup, warm, x, &report, error);
  *response = (struct eo_sdof_response){0};
  if (code || !report.converged)
    return code;
  response->converged = true;
  read_response(x, report.grid, response);
  code = eo_floquet(&setup->oscillator, &setup->cycle, HARMONICS, x, multiplier, error);
  response->floquet = code ? 0 : cabs(multiplier[0]);
  return code;
}

/* All passages of the branch through one frequency. */
struct passages {
  double frequency;
  int count;
  double before, x_before[TERMS]; /* the point visited last */
  double x[EO_SDOF_MAX_FOLDS][TERMS];
  int terms;
};

static int note_passage(void *context, const struct eo_branch_point *point)
{
  struct passages *passages = context;
  double now = point->frequency;
  if (passages->before > 0 && (passages->before - passages->frequency) * (now - passages->frequency) <= 0 &&
      now != passages->before && passages->count < EO_SDOF_MAX_FOLDS) {
    double share = (passages->frequency - passages->before) / (now - passages->before);
    for (int i = 0; i < passages->terms; i++)
      passages->x[passages->count][i] = passages->x_before[i] + share * (point->x[i] - passages->x_before[i]);
    passages->count++;
  }
  passages->before = now;
  memcpy(passages->x_before, point->x, sizeof *passages->x_before * passages->terms);
  return 0;
}

static enum eo_code follow_from(struct setup *setup, const struct eo_sdof *sdof, double low, double high,
                                eo_branch_visit *visit, void *context, struct eo_error *error)
{
  struct eo_balance_report report;
  struct eo_branch_options options = eo_branch_defaults;
  enum eo_branch_end end;
  double x[2 * TERMS];
  EO_TRY(balance_at(setup, false, x, &report, error));
  if (!report.converged)
    return eo_error_set(error, EO_ERROR_NUMERIC, "",
                        "No periodic response was found at the frequency %g where the branch starts.", low);
  options.low = low * BELOW;
  options.high = high;
  options.size = sdof->mean_force;
  options.longest_step = LONGEST_STEP;
  return eo_branch_follow(setup->balance, &setup->oscillator, &setup->cycle, x, 1, &options, visit, context, &end,
                          error);
}

/* The branch starts where the response is small: at low frequency the alternating force vanishes. */
static enum eo_code follow(const struct eo_sdof *sdof, double low, double high, eo_branch_visit *visit, void *context,
                           struct eo_error *error)
{
  struct setup setup;
  struct eo_sdof at = *sdof;
  at.frequency = low;
  enum eo_code code = make_setup(&setup, &at, BRANCH_HARMONICS, BRANCH_SAMPLES, error);
  if (!code)
    code = follow_from(&setup, sdof, low, high, visit, context, error);
  free_setup(&setup);
  return code;
}

static enum eo_code solve_by_branch(const struct eo_sdof *sdof, enum eo_sdof_start start, struct setup *setup,
                                    struct eo_sdof_response *response, struct eo_error *error)
{
  struct passages *passages = calloc(1, sizeof *passages);
  if (!passages)
    return eo_error_memory(error);
  passages->frequency = sdof->frequency;
  passages->terms = 1 + 2 * BRANCH_HARMONICS;
  enum eo_code code = follow(sdof, fmin(LOW, 0.5 * sdof->frequency), fmax(HIGH, 2 * sdof->frequency), note_passage,
                             passages, error);
  *response = (struct eo_sdof_response){0};
  for (int i = 0; i < passages->count && !code; i++) {
    struct eo_sdof_response sdof_response;
    code = finish(setup, true, passages->x[i], &sdof_response, error);
    bool better = !response->converged ||
                  (start == EO_SDOF_LOW ? sdof_response.rms < response->rms : sdof_response.rms > response->rms);
    if (!code && sdof_response.converged && sdof_response.floquet < 1 && better)
      *response = sdof_response;
  }
  free(passages);
  return code;
}

static enum eo_code solve(struct setup *setup, const struct eo_sdof *sdof, enum eo_sdof_start start,
                          const double state[2], struct eo_sdof_response *response, struct eo_error *error)
{
  double x[2 * TERMS] = {0};
  if (start != EO_SDOF_STATE)
    return solve_by_branch(sdof, start, setup, response, error);
  EO_TRY(guess_from_state(setup, state, x, error));
  return finish(setup, true, x, response, error);
}

enum eo_code eo_sdof_solve(const struct eo_sdof *sdof, enum eo_sdof_start start, const double state[2],
                           struct eo_sdof_response *response, struct eo_error *error)
{
  struct setup setup;
  struct eo_sdof_response found = {0};
  enum eo_code code = make_setup(&setup, sdof, HARMONICS, SAMPLES, error);
  if (!code)
    code = solve(&setup, sdof, start, state, &found, error);
  free_setup(&setup);
  EO_TRY(code);
  *response = found;
  return EO_OK;
}

/* What the visitor remembers between two points. */
struct fold_search {
  struct eo_sdof_folds found;
  double before, margin_before; /* frequency and least margin of the point visited last */
};

/* Folds, and the frequency at which the least margin first passes zero. */
static int note_fold(void *context, const struct eo_branch_point *point)
{
  struct fold_search *search = context;
  struct eo_sdof_folds *folds = &search->found;
  const struct eo_time_end *time_end = &point->grid->end[0];
  double margin = time_end->margin[0];
  for (int i = 1; i < point->grid->samples; i++)
    margin = fmin(margin, time_end->margin[i]);
  if (isnan(folds->contact_lost) && search->before > 0 && search->margin_before > 0 && margin <= 0)
    folds->contact_lost = search->before + (point->frequency - search->before) * search->margin_before /
                                               (search->margin_before - margin);
  search->before = point->frequency;
  search->margin_before = margin;
  if (point->fold && folds->count < EO_SDOF_MAX_FOLDS) {
    folds->frequency[folds->count] = point->frequency;
    folds->going_up[folds->count++] = point->direction < 0;
  }
  return 0;
}

enum eo_code eo_sdof_folds(const struct eo_sdof *sdof, double low, double high, struct eo_sdof_folds *folds,
                           struct eo_error *error)
{
  struct fold_search search = {.found = {.contact_lost = NAN}};
  enum eo_code code = follow(sdof, low, high, note_fold, &search, error);
  if (!code)
    *folds = search.found;
  return code;
}

int eo_sdof_grazing(const struct eo_sdof *sdof, double frequency[2])
{
  /* With u = W^2: (1 - (F_h / F_m)^2) u^2 + (4 z^2 - 2) u + 1 = 0. */
  double a = 1 - pow(sdof->alternating_force / sdof->mean_force, 2), b = 4 * sdof->damping * sdof->damping - 2;
  double discriminant = b * b - 4 * a;
  int count = 0;
  if (discriminant < 0)
    return 0;
  double q = -0.5 * (b - sqrt(discriminant));
  double root[2] = {1 / q, a != 0 ? q / a : INFINITY};
  for (int i = 0; i < 2; i++)
    if (root[i] > 0 && isfinite(root[i]))
      frequency[count++] = sqrt(root[i]);
  return count;
}
