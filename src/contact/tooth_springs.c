/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/tooth_springs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/hunting_private.h"
#include "contact/tooth_spring.h"

/* Loads at which a position is solved in full, as shares of P: a pair of teeth far ahead of the others carries more
   than all of them do at P, one far behind nothing. MOST: pairs at once that teeth of a ring are coupled over, and
   more. */
enum { LEVELS = EO_TOOTH_KNOTS - 1, OWN = 1, MOST = 32 };
static const double LEVEL[LEVELS] = {0.35, 1, 1.9, 3.2};

struct place {
  int pairs, first; /* first: number of the first pair */
  struct eo_tooth_spring spring[MOST];
  double bend[MOST][MOST];     /* m/N of one pair by another's load; 0 on the diagonal */
  double load[MOST], approach; /* of the instant that was solved last */
};

struct sketch {
  const struct eo_hunting_input *input;
  int places, step;       /* of a mesh cycle, step of the grid's positions apart */
  int lines, teeth[2];    /* pairs at most */
  int failures;           /* places whose full contact did not converge */
  struct place *place[2]; /* [end]: [places] */
  double *off[2];         /* [end]: behind spring.off */
};

/* Full contact of one position, summed by pairs of teeth. */
struct level {
  double approach, load[MOST], pressure[MOST];
};

/* What fitting an end takes. */
struct fit {
  const struct eo_hunting_input *input;
  int end;
  struct eo_loaded_workspace *workspace;
  struct eo_loaded_end solved;
  struct level level[LEVELS];
  double touch[MOST]; /* least gap of a pair, m; INFINITY: it is not there */
  double *weight;     /* [points of a position] share of its pair's load */
  double *mode[MOST]; /* [most_rank] of a load of 1 N on a pair */
};

static void number_pairs(struct place *place, const struct eo_contact_position *position)
{
  int last = position->line[0].pair;
  place->first = last;
  for (int l = 1; l < position->lines; l++) {
    place->first = position->line[l].pair < place->first ? position->line[l].pair : place->first;
    last = position->line[l].pair > last ? position->line[l].pair : last;
  }
  place->pairs = last - place->first + 1;
}

static void sum_pairs(const struct fit *fit, const struct place *place, int j, struct level *level)
{
  const struct eo_contact_grid *grid = fit->input->grid[fit->end];
  const struct eo_contact_position *position = &grid->position[j];
  *level = (struct level){.approach = fit->solved.approach[j]};
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    int k = line->pair - place->first;
    for (int i = line->first; i < line->first + line->cells; i++) {
      double q = fit->solved.line_load[position->first + i];
      level->load[k] += q * position->length[i];
      if (q > 0)
        level->pressure[k] = fmax(level->pressure[k], eo_loaded_pressure(grid, q, position->radius[i]));
    }
  }
}

/* Where on its flanks a pair carries: as at this load, evenly where it carries nothing. */
static void weigh(struct fit *fit, const struct place *place, int j, const struct level *level)
{
  const struct eo_contact_position *position = &fit->input->grid[fit->end]->position[j];
  int cells[MOST] = {0};
  for (int l = 0; l < position->lines; l++)
    cells[position->line[l].pair - place->first] += position->line[l].cells;
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    int k = line->pair - place->first;
    for (int i = line->first; i < line->first + line->cells; i++)
      fit->weight[i] = level->load[k] > 0
                           ? fit->solved.line_load[position->first + i] * position->length[i] / level->load[k]
                           : 1. / cells[k];
  }
}

/* Bulk compliance between pairs, and their least gaps. */
static void find_bends(struct fit *fit, struct place *place, int j)
{
  const struct eo_contact_position *position = &fit->input->grid[fit->end]->position[j];
  const double *gap = fit->input->gap[fit->end] + position->first;
  for (int k = 0; k < place->pairs; k++) {
    memset(fit->mode[k], 0, sizeof(double) * (size_t)position->rank);
    fit->touch[k] = INFINITY;
  }
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    int k = line->pair - place->first;
    for (int i = line->first; i < line->first + line->cells; i++) {
      const float *row = position->factor + (size_t)i * (size_t)position->stride;
      fit->touch[k] = fmin(fit->touch[k], gap[i]);
      for (int r = 0; r < position->rank; r++)
        fit->mode[k][r] += fit->weight[i] * (double)row[r];
    }
  }
  for (int k = 0; k < place->pairs; k++)
    for (int l = 0; l < k; l++) {
      double sum = 0;
      for (int r = 0; r < position->rank; r++)
        sum += fit->mode[k][r] * fit->mode[l][r];
      place->bend[k][l] = place->bend[l][k] = fit->input->compliance_factor * sum;
    }
}

static double bent(const struct place *place, int k, const double *load)
{
  double sum = 0;
  for (int l = 0; l < place->pairs; l++)
    sum += place->bend[k][l] * load[l];
  return sum;
}

/* usual: stiffness of a pair that does not touch at any level, N/m. */
static void fit_spring(const struct fit *fit, const struct place *place, int k, double usual,
                       struct eo_tooth_spring *spring)
{
  int first = 0;
  while (first < LEVELS && !(fit->level[first].load[k] > 0))
    first++;
  double touch = fit->touch[k];
  if (first < LEVELS) {
    const struct level *level = &fit->level[first];
    double own = level->approach - bent(place, k, level->load);
    touch = touch < own ? touch : own - level->load[k] / usual;
  }
  eo_tooth_spring_add(spring, touch, 0, 0);
  for (int m = first; m < LEVELS; m++)
    eo_tooth_spring_add(spring, fit->level[m].approach - bent(place, k, fit->level[m].load), fit->level[m].load[k],
                        fit->level[m].pressure[k]);
  if (spring->knots == 1)
    eo_tooth_spring_add(spring, touch + 1e-6, 1e-6 * usual, 0);
  eo_tooth_spring_settle(spring);
}

/* Stiffness of the pairs from touch to the largest load. */
static double usual_stiffness(const struct fit *fit, const struct place *place)
{
  const struct level *level = &fit->level[LEVELS - 1];
  double load = 0, approach = 0;
  for (int k = 0; k < place->pairs; k++)
    if (level->load[k] > 0 && level->approach > fit->touch[k]) {
      load += level->load[k];
      approach += level->approach - fit->touch[k];
    }
  return load / approach;
}

static bool any_form(const struct eo_tooth_deviation *tooth, int teeth)
{
  bool any = false;
  for (int i = 0; i < teeth; i++)
    any = any || tooth[i].profile_slope != 0 || tooth[i].helix_slope != 0 || tooth[i].profile_crowning != 0 ||
          tooth[i].lead_crowning != 0;
  return any;
}

/* What 1 m of each deviation of a member's tooth adds to the gap of a pair, where that carries. */
static struct eo_tooth_deviation unit_gaps(const struct fit *fit, int j, int pair, int member, bool formed)
{
  static const struct eo_tooth_deviation UNIT[] = {
      {.index = 1}, {.profile_slope = 1}, {.helix_slope = 1}, {.profile_crowning = 1}, {.lead_crowning = 1}};
  const struct eo_contact_grid *grid = fit->input->grid[fit->end];
  const struct eo_contact_position *position = &grid->position[j];
  double sum[5] = {0};
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    for (int i = line->first; line->pair == pair && i < line->first + line->cells; i++)
      for (int term = 0; term < 5 && (formed || (term == 0 && sum[0] == 0)); term++) {
        const struct eo_tooth_deviation *tooth[2] = {NULL, NULL};
        tooth[member] = &UNIT[term];
        double gap = eo_hunting_gap(&grid->geometry, &position->point[i], fit->input->inwards, tooth);
        sum[term] = term == 0 ? gap : sum[term] + fit->weight[i] * gap;
      }
  }
  return (struct eo_tooth_deviation){sum[0], sum[1], sum[2], sum[3], sum[4]};
}

static void fill_offsets(const struct fit *fit, int j, int pair, int member, int teeth, double *off)
{
  const struct eo_tooth_deviation *tooth = fit->input->tooth[fit->end][member];
  struct eo_tooth_deviation unit = unit_gaps(fit, j, pair, member, any_form(tooth, teeth));
  for (int i = 0; i < teeth; i++)
    off[i] = unit.index * tooth[i].index + unit.profile_slope * tooth[i].profile_slope +
             unit.helix_slope * tooth[i].helix_slope + unit.profile_crowning * tooth[i].profile_crowning +
             unit.lead_crowning * tooth[i].lead_crowning;
}

/* Solves a position at every level, and makes its springs of that. off: where the offsets of its teeth go on. */
static double *fit_place(struct fit *fit, struct sketch *sketch, int at, double *off)
{
  const struct eo_hunting_input *input = sketch->input;
  struct place *place = &sketch->place[fit->end][at];
  int j = at * sketch->step;
  const struct eo_contact_position *position = &input->grid[fit->end]->position[j];
  number_pairs(place, position);
  memset(fit->solved.line_load + position->first, 0, sizeof(double) * (size_t)position->points);
  for (int m = 0; m < LEVELS; m++) {
    eo_loaded_resolve(fit->workspace, input->grid[fit->end], input->gap[fit->end], input->compliance_factor, j,
                      LEVEL[m] * input->load[fit->end], &fit->solved);
    sum_pairs(fit, place, j, &fit->level[m]);
    if (m == OWN)
      weigh(fit, place, j, &fit->level[m]);
  }
  find_bends(fit, place, j);
  double usual = usual_stiffness(fit, place);
  for (int k = 0; k < place->pairs; k++) {
    struct eo_tooth_spring *spring = &place->spring[k];
    if (isinf(fit->touch[k]))
      continue;
    fit_spring(fit, place, k, usual, spring);
    for (int member = 0; member < 2 && input->tooth[fit->end][member]; member++) {
      int teeth = sketch->teeth[member];
      fill_offsets(fit, j, place->first + k, member, teeth, off);
      spring->off[member] = off;
      off += teeth;
    }
  }
  memcpy(place->load, fit->level[OWN].load, sizeof place->load);
  place->approach = fit->level[OWN].approach;
  return off;
}

static void fit_done(struct fit *fit)
{
  eo_loaded_workspace_free(fit->workspace);
  eo_loaded_end_done(&fit->solved);
  free(fit->weight);
  free(fit->mode[0]);
  *fit = (struct fit){.input = fit->input};
}

static enum eo_code fit_begin(struct fit *fit, const struct eo_contact_grid *grid, struct eo_error *error)
{
  EO_TRY(eo_loaded_workspace_new(&fit->workspace, grid, error));
  EO_TRY(eo_loaded_end_init(&fit->solved, grid, error));
  fit->weight = malloc(sizeof(double) * (size_t)grid->most_points);
  fit->mode[0] = malloc(sizeof(double) * MOST * (size_t)(grid->most_rank + 1));
  if (!fit->weight || !fit->mode[0])
    return eo_error_memory(error);
  for (int k = 1; k < MOST; k++)
    fit->mode[k] = fit->mode[k - 1] + grid->most_rank + 1;
  return EO_OK;
}

/* One fit serves both ends where they have one grid. */
static enum eo_code fit_end(struct sketch *sketch, struct fit *fit, int end, struct eo_error *error)
{
  const struct eo_contact_grid *grid = sketch->input->grid[end];
  if (!fit->workspace || grid != sketch->input->grid[fit->end]) {
    fit_done(fit);
    EO_TRY(fit_begin(fit, grid, error));
  }
  fit->end = end;
  double *off = sketch->off[end];
  for (int at = 0; at < sketch->places; at++)
    off = fit_place(fit, sketch, at, off);
  sketch->failures += fit->solved.failures;
  fit->solved.failures = 0;
  return EO_OK;
}

/* x = A^-1 b of two right sides, A positive definite; A and b are lost. */
static void solve(int n, double a[MOST][MOST], double b[2][MOST])
{
  for (int i = 0; i < n; i++) {
    double over = 1 / a[i][i];
    for (int j = i + 1; j < n; j++) {
      double share = a[j][i] * over;
      for (int k = i + 1; k <= j; k++)
        a[j][k] -= share * a[k][i];
      b[0][j] -= share * b[0][i];
      b[1][j] -= share * b[1][i];
    }
  }
  for (int i = n - 1; i >= 0; i--)
    for (int r = 0; r < 2; r++) {
      for (int k = i + 1; k < n; k++)
        b[r][i] -= a[k][i] * b[r][k];
      b[r][i] /= a[i][i];
    }
}

/* One step of Newton, or a part of it, towards loads that sum to P, theory (P6); returns by how much the approach would
   move. */
static double step(struct place *place, const double *off, double force, double part, double *tangent)
{
  double a[MOST][MOST], b[2][MOST], total = 0, answer = 0, rest = 0;
  int active[MOST], n = 0;
  for (int k = 0; k < place->pairs; k++) {
    double stiffness, load = eo_tooth_spring_carry(&place->spring[k],
                                                   place->approach - off[k] - bent(place, k, place->load), &stiffness);
    if (!(stiffness > 0)) {
      place->load[k] = load;
      continue;
    }
    b[0][n] = (load - place->load[k]) / stiffness;
    b[1][n] = 1;
    a[n][n] = 1 / stiffness;
    for (int l = 0; l < n; l++)
      a[n][l] = place->bend[k][active[l]];
    active[n++] = k;
  }
  for (int k = 0; k < place->pairs; k++)
    total += place->load[k];
  solve(n, a, b);
  for (int i = 0; i < n; i++) {
    rest += b[0][i];
    answer += b[1][i];
  }
  double moved = n > 0 ? (force - total - rest) / answer : 1e-6;
  for (int i = 0; i < n; i++)
    place->load[active[i]] += part * (b[0][i] + moved * b[1][i]);
  place->approach += part * moved;
  *tangent = answer;
  return moved;
}

static int wrap(int number, int by)
{
  int rest = number % by;
  return rest < 0 ? rest + by : rest;
}

/* Solves a place with the teeth of a cycle; false: it did not settle. */
static bool settle(const struct sketch *sketch, struct place *place, int cycle, double force, double *tangent)
{
  enum { STEPS = 60, WHOLE = 12 };    /* steps that go to and fro between knots are halved */
  static const double SETTLED = 1e-9; /* m; Newton's next step would be smaller by far */
  double off[MOST], moved = INFINITY;
  for (int k = 0; k < place->pairs; k++) {
    const struct eo_tooth_spring *spring = &place->spring[k];
    off[k] = 0;
    for (int member = 0; member < 2; member++)
      if (spring->off[member])
        off[k] += spring->off[member][wrap(cycle - place->first - k, sketch->teeth[member])];
  }
  for (int i = 0; i < STEPS && fabs(moved) > SETTLED; i++)
    moved = step(place, off, force, i < WHOLE ? 1 : 0.5, tangent);
  return fabs(moved) <= SETTLED;
}

static void raise_load(struct eo_hunting_place *most, int end, double load)
{
  if (load > most->value)
    *most = (struct eo_hunting_place){.value = load, .end = end};
}

static void find_most(const struct sketch *sketch, int end, struct eo_hunting *hunting)
{
  for (int at = 0; at < sketch->places; at++)
    for (int k = 0; k < sketch->place[end][at].pairs; k++) {
      const struct eo_tooth_spring *spring = &sketch->place[end][at].spring[k];
      if (spring->knots == 0 || !(spring->most > 0))
        continue;
      raise_load(&hunting->most_load[end], end, spring->most);
      raise_load(&hunting->most_pressure[end], end, eo_tooth_spring_pressure(spring, spring->most));
    }
}

/* The instants of one end, by its own phase, at every so many of the places. */
static void pass(struct sketch *sketch, int end, struct eo_hunting *hunting)
{
  const struct eo_hunting_input *input = sketch->input;
  int stagger = end == EO_RIGHT ? input->stagger * hunting->positions / input->positions : 0,
      every = sketch->places / hunting->positions;
  double force = input->load[end];
  for (int instant = 0; instant < hunting->instants; instant++) {
    int position = wrap(instant - stagger, hunting->positions),
        cycle = (instant - stagger - position) / hunting->positions;
    struct place *place = &sketch->place[end][position * every];
    hunting->failures += !settle(sketch, place, cycle, force, &hunting->tangent[end][instant]);
    hunting->load[end][instant] = force;
    hunting->approach[end][instant] = place->approach;
    for (int k = 0; k < place->pairs; k++)
      place->spring[k].most = fmax(place->spring[k].most, place->load[k]);
  }
  find_most(sketch, end, hunting);
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

static enum eo_code make_room(struct sketch *sketch, struct eo_hunting *period, struct eo_hunting *stretch,
                              int stretch_cycles, struct eo_error *error)
{
  const struct eo_hunting_input *input = sketch->input;
  bool complete = true;
  EO_TRY(eo_hunting_count(period, input, error));
  if (period->lines > MOST)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair", "More than %d pairs of teeth are in contact at once.",
                        MOST);
  *stretch = *period;
  stretch->cycles = stretch_cycles;
  stretch->positions = stretch_cycles > 0 ? input->grid[EO_LEFT]->positions : 0;
  sketch->places = stretch_cycles > 0 ? stretch->positions : period->positions;
  sketch->step = input->grid[EO_LEFT]->positions / sketch->places;
  sketch->lines = period->lines;
  memcpy(sketch->teeth, period->teeth, sizeof sketch->teeth);
  for (int end = 0; end < input->ends; end++) {
    sketch->off[end] = make_numbers(sketch->places * sketch->lines * (sketch->teeth[0] + sketch->teeth[1]), &complete);
    sketch->place[end] = calloc((size_t)sketch->places, sizeof *sketch->place[end]);
    complete = complete && sketch->place[end];
  }
  complete = make_result(period) && make_result(stretch) && complete;
  return complete ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_hunting_sketch(struct eo_hunting *period, struct eo_hunting *stretch, int stretch_cycles,
                               const struct eo_hunting_input *input, struct eo_error *error)
{
  struct sketch sketch = {.input = input};
  struct fit fit = {.input = input};
  enum eo_code code = make_room(&sketch, period, stretch, stretch_cycles, error);
  for (int end = 0; end < input->ends && !code; end++) {
    code = fit_end(&sketch, &fit, end, error);
    if (code)
      break;
    pass(&sketch, end, period);
    if (stretch_cycles > 0)
      pass(&sketch, end, stretch);
  }
  period->failures += sketch.failures;
  fit_done(&fit);
  for (int end = 0; end < 2; end++) {
    free(sketch.place[end]);
    free(sketch.off[end]);
  }
  return code;
}
