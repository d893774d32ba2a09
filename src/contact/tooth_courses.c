/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/tooth_courses.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/hunting_private.h"
#include "contact/tooth_courses_private.h"

/* What a solution may be off where few are made, m: a hundredth of what is between them. */
static const double ROUGHLY = 1e-10;

static int wrap(int number, int by)
{
  int rest = number % by;
  return rest < 0 ? rest + by : rest;
}

static void raise_to(struct eo_hunting_place *most, int end, double value)
{
  if (value > most->value)
    *most = (struct eo_hunting_place){.value = value, .end = end};
}

static void look_at(const struct eo_follow *follow, const struct eo_course_state *state, struct eo_hunting *hunting)
{
  for (int k = 0; k < follow->place.pairs; k++) {
    raise_to(&hunting->most_load[follow->end], follow->end, state->load[k]);
    if (state->square[k] > hunting->most_pressure[follow->end].value * hunting->most_pressure[follow->end].value)
      raise_to(&hunting->most_pressure[follow->end], follow->end, sqrt(state->square[k]));
  }
}

/* Two pairs carry most at the ends of what is between them. */
static void look_along(const struct eo_follow *follow, struct eo_hunting *hunting)
{
  const struct eo_follow_place *place = &follow->place;
  look_at(follow, &place->alike, hunting);
  for (int i = 0; place->courses == 1 && i < place->course[0].nodes; i++)
    look_at(follow, &place->course[0].state[i], hunting);
}

/* The instants at which the end is at this place by its own phase. */
static void pass(const struct eo_follow *follow, int at, struct eo_hunting *hunting, bool loads)
{
  const struct eo_hunting_input *input = follow->input;
  int end = follow->end, every = follow->places / hunting->positions, position = at / every,
      stagger = end == EO_RIGHT ? input->stagger * hunting->positions / input->positions : 0,
      first = wrap(position + stagger, hunting->positions), ahead = (first - stagger - position) / hunting->positions;
  bool each = loads && follow->place.courses > 1;
  if (at % every != 0)
    return;
  for (int cycle = 0; cycle < hunting->cycles; cycle++) {
    int instant = cycle * hunting->positions + first;
    struct eo_course_state state;
    eo_follow_find(follow, wrap(cycle + ahead, follow->cycles), each, &state);
    hunting->load[end][instant] = input->load[end];
    hunting->approach[end][instant] = state.approach;
    hunting->tangent[end][instant] = fmax(0, state.tangent);
    if (each)
      look_at(follow, &state, hunting);
  }
  if (loads)
    look_along(follow, hunting);
}

static double *make_numbers(int count, bool *complete)
{
  double *number = calloc((size_t)count, sizeof *number);
  *complete = *complete && number;
  return number;
}

static bool make_result(struct eo_hunting *hunting)
{
  bool complete = true;
  hunting->instants = hunting->cycles * hunting->positions;
  for (int end = 0; end < hunting->ends; end++) {
    hunting->load[end] = make_numbers(hunting->instants, &complete);
    hunting->approach[end] = make_numbers(hunting->instants, &complete);
    hunting->tangent[end] = make_numbers(hunting->instants, &complete);
  }
  return complete;
}

static enum eo_code make_room(struct eo_follow *follow, struct eo_hunting *period, struct eo_hunting *stretch,
                              int stretch_cycles, struct eo_error *error)
{
  const struct eo_hunting_input *input = follow->input;
  EO_TRY(eo_hunting_count(period, input, error));
  if (period->lines > EO_COURSE_PAIRS)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair", "More than %d pairs of teeth are in contact at once.",
                        EO_COURSE_PAIRS);
  *stretch = *period;
  stretch->cycles = stretch_cycles;
  stretch->positions = stretch_cycles > 0 ? input->grid[EO_LEFT]->positions : 0;
  follow->places = stretch_cycles > 0 ? stretch->positions : period->positions;
  follow->step = input->grid[EO_LEFT]->positions / follow->places;
  follow->cycles = period->cycles;
  follow->lines = period->lines;
  follow->first_line = period->first_line;
  memcpy(follow->teeth, period->teeth, sizeof follow->teeth);
  bool complete = make_result(period);
  complete = make_result(stretch) && complete;
  follow->apart = make_numbers(period->lines * period->cycles, &complete);
  for (int member = 0; member < 2; member++)
    follow->off[member] = make_numbers(period->teeth[member], &complete);
  return complete ? EO_OK : eo_error_memory(error);
}

static void grid_done(struct eo_follow *follow)
{
  eo_loaded_workspace_free(follow->own);
  eo_loaded_end_done(&follow->solved);
  eo_trails_done(follow);
  free(follow->gap);
  free(follow->start);
  free(follow->weight);
  free(follow->share);
  free(follow->reach);
  follow->workspace = follow->own = NULL;
}

static enum eo_code grid_begin(struct eo_follow *follow, struct eo_error *error)
{
  const struct eo_contact_grid *grid = follow->input->grid[follow->end];
  bool complete = true;
  follow->gap = make_numbers(grid->points, &complete);
  follow->start = make_numbers(grid->most_points, &complete);
  follow->weight = make_numbers(grid->most_points, &complete);
  follow->share = make_numbers(grid->most_points, &complete);
  follow->reach = make_numbers(grid->most_points, &complete);
  complete = eo_trails_init(follow, grid->most_points) && complete;
  follow->workspace = follow->input->workspace[follow->end];
  if (!follow->workspace)
    EO_TRY(eo_loaded_workspace_new(&follow->own, grid, error));
  follow->workspace = follow->own ? follow->own : follow->workspace;
  EO_TRY(eo_loaded_end_init(&follow->solved, grid, error));
  return complete ? EO_OK : eo_error_memory(error);
}

/* One workspace serves both ends where they have one grid. */
static enum eo_code follow_end(struct eo_follow *follow, int end, struct eo_hunting *period, struct eo_hunting *stretch,
                               struct eo_error *error)
{
  bool anew = !follow->workspace || follow->input->grid[end] != follow->input->grid[follow->end];
  follow->end = end;
  if (anew) {
    grid_done(follow);
    EO_TRY(grid_begin(follow, error));
  }
  eo_trails_forget(follow);
  memset(follow->apart_known, 0, sizeof follow->apart_known);
  follow->formed = false;
  for (int member = 0; member < 2; member++)
    if (follow->input->tooth[end][member])
      follow->formed = follow->formed || eo_tooth_any_form(follow->input->tooth[end][member], follow->teeth[member]);
  for (int at = 0; at < follow->places; at++) {
    eo_follow_prepare(follow, at);
    pass(follow, at, period, true);
    if (stretch->cycles > 0)
      pass(follow, at, stretch, false);
  }
  period->failures += follow->solved.failures;
  follow->solved.failures = 0;
  return EO_OK;
}

enum eo_code eo_hunting_follow(struct eo_hunting *period, struct eo_hunting *stretch, int stretch_cycles, double within,
                               const struct eo_hunting_input *input, struct eo_error *error)
{
  struct eo_follow *follow = calloc(1, sizeof *follow);
  if (!follow)
    return eo_error_memory(error);
  follow->input = input;
  follow->within = within;
  follow->settled = isfinite(within) ? EO_LOADED_WITHIN : ROUGHLY;
  enum eo_code code = make_room(follow, period, stretch, stretch_cycles, error);
  for (int end = 0; end < input->ends && !code; end++)
    code = follow_end(follow, end, period, stretch, error);
  grid_done(follow);
  free(follow->apart);
  free(follow->off[EO_PINION]);
  free(follow->off[EO_GEAR]);
  free(follow);
  return code;
}
