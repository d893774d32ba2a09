/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "reference/stage.h"
#include "reference/stage_input.h"
#include "dynamics/sdof.h"

struct input {
  struct eo_sdof sdof;
  enum eo_sdof_start start;
  double state[2];
  int wants_folds;
  struct range {
    double from, to;
  } range;
};

static const char *const starts[] = {"state", "low", "high", NULL};

static const struct eo_field range[] = {
    EO_NUMBER(struct range, from, "from", NULL, 1e-3, 1e3, 0.3, "lowest W"),
    EO_NUMBER(struct range, to, "to", NULL, 1e-3, 1e3, 3, "highest W"),
};
static const struct eo_table range_table = EO_TABLE("a range of frequencies", struct range, range);

static const double rest[2] = {0, 0};
static const struct eo_field input[] = {
    EO_NUMBER_REQUIRED(struct input, sdof.damping, "damping_ratio", NULL, 0, 10,
                       "z of x\" + 2 z x' + (1 + e cos W t) f(x) = F_m + F_h W^2 cos W t"),
    EO_NUMBER_REQUIRED(struct input, sdof.mean_force, "mean_force", NULL, 1e-9, 1e9,
                       "F_m; half the backlash and the mean stiffness are 1"),
    EO_NUMBER(struct input, sdof.alternating_force, "alternating_force", NULL, -1e9, 1e9, 0, "F_h"),
    EO_NUMBER(struct input, sdof.stiffness_share, "stiffness_share", NULL, -0.99, 0.99, 0, "e"),
    EO_NUMBER_REQUIRED(struct input, sdof.frequency, "frequency", NULL, 1e-3, 1e3, "W, 1: the linear eigenfrequency"),
    EO_CHOICE(struct input, start, "start", starts, EO_SDOF_LOW,
              "the state that a given start leads to, or the stable one with the smallest or largest swing"),
    EO_NUMBERS(struct input, state, "state", 2, NULL, -1e6, 1e6, 0, rest, NULL, "x, x' at t = 0, with start \"state\""),
    EO_OPTIONAL(struct input, range, wants_folds, "folds", &range_table, "not looked for",
                "follow the branch upwards and report where it turns"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

struct output {
  struct eo_sdof_response response;
  int followed;
  struct folds {
    struct eo_numbers up, down;
    double contact_lost;
  } folds;
  struct eo_numbers grazing;
};

static const struct eo_field folds[] = {
    EO_OUT_SERIES(struct folds, up, "jump_up", NULL,
                  "where the branch turns back on the way up: an upward sweep jumps"),
    EO_OUT_SERIES(struct folds, down, "jump_down", NULL, "where it turns again: a downward sweep jumps"),
    EO_NUMBER_DERIVED(struct folds, contact_lost, "contact_lost", NULL, -INFINITY, INFINITY, "nowhere",
                      "where it first leaves full contact"),
};
static const struct eo_table folds_table = EO_TABLE("folds", struct folds, folds);

static const struct eo_field output[] = {
    EO_FLAG(struct output, response.converged, "converged", 0, "a periodic state was found"),
    EO_OUT(struct output, response.mean, "mean", NULL, "of x"),
    EO_OUT(struct output, response.rms, "rms", NULL, "of x without its mean"),
    EO_OUT(struct output, response.peak_to_peak, "peak_to_peak", NULL, "of x"),
    EO_OUT_PAIR(struct output, response.amplitude, "amplitude", NULL, "of the first and second harmonic of x"),
    EO_OUT(struct output, response.contact_loss, "contact_loss", NULL, "share of the period out of contact"),
    EO_FLAG(struct output, response.back_contact, "back_contact", 0, "the other flanks touch"),
    EO_OUT(struct output, response.floquet, "largest_multiplier", NULL,
           "size of the largest Floquet multiplier; stable below 1"),
    EO_OPTIONAL(struct output, folds, followed, "folds", &folds_table, "not looked for",
                "frequencies at which the branch turns"),
    EO_OUT_SERIES(struct output, grazing, "grazing", NULL,
                  "e = 0: frequencies at which the linear response just leaves contact"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

static enum eo_code find_folds(const struct input *given, struct folds *found, struct eo_error *error)
{
  struct eo_sdof_folds sdof_folds;
  int count[2] = {0, 0};
  if (!(given->range.from < given->range.to))
    return eo_error_set(error, EO_ERROR_INPUT, "/folds", "The range of frequencies ends at %g, not above its start %g.",
                        given->range.to, given->range.from);
  enum eo_code code = eo_sdof_folds(&given->sdof, given->range.from, given->range.to, &sdof_folds, error);
  if (!code)
    code = eo_stage_columns(1, &found->up, sdof_folds.count, error);
  if (!code)
    code = eo_stage_columns(1, &found->down, sdof_folds.count, error);
  for (int i = 0; i < sdof_folds.count && !code; i++)
    (sdof_folds.going_up[i] ? &found->up : &found->down)->value[count[!sdof_folds.going_up[i]]++] =
        sdof_folds.frequency[i];
  if (code)
    return code;
  found->up.count = count[0];
  found->down.count = count[1];
  found->contact_lost = sdof_folds.contact_lost;
  return EO_OK;
}

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  double grazing[2];
  enum eo_code code = eo_sdof_solve(&given->sdof, given->start, given->state, &found->response, error);
  if (!code)
    code = eo_stage_copy(&found->grazing, given->sdof.stiffness_share == 0 ? eo_sdof_grazing(&given->sdof, grazing) : 0,
                         grazing, error);
  if (!code && given->wants_folds) {
    found->followed = 1;
    code = find_folds(given, &found->folds, error);
  }
  return code;
}

const struct eo_stage eo_stage_sdof = {
    .name = "sdof",
    .summary = "a single degree of freedom with backlash: the classical test of the solvers",
    .input = &input_table,
    .output = &output_table,
    .run = run};
