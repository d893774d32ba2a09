/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/hunting_private.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"

/* EO_HUNTING_BLOCK: cycles that one thread goes through from a start of its own; EO_HUNTING_BEFORE: instants that a
 * start goes on from. */

static int common_divisor(int a, int b)
{
  while (b) {
    int rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

int eo_hunting_cycles(const int teeth[2])
{
  return teeth[0] / common_divisor(teeth[0], teeth[1]) * teeth[1];
}

/* The remainder of the floored quotient, 0 .. by - 1. */
static int wrap(int number, int by)
{
  int rest = number % by;
  return rest < 0 ? rest + by : rest;
}

static int floored(int number, int by)
{
  return (number - wrap(number, by)) / by;
}

/* theory (P2): C_Halpha xi/2 + C_Hbeta zeta/2 + C_alpha xi^2 + C_beta zeta^2 of one member. */
static double form_at(const struct eo_geometry *geometry, const struct eo_flank_point *point, bool inwards, int member,
                      const struct eo_tooth_deviation *tooth)
{
  double start = eo_geometry_drawn_path(geometry, EO_GEAR, geometry->path_start), /* where the gear's tip meets */
      end = eo_geometry_drawn_path(geometry, EO_PINION, geometry->path_end), middle = (start + end) / 2,
         half = (end - start) / 2, xi = eo_geometry_own_path(member, point->s[member] - middle) / half,
         zeta = (inwards ? -2 : 2) * point->eta / geometry->face_width;
  return (tooth->profile_slope * xi + tooth->helix_slope * zeta) / 2 + tooth->profile_crowning * xi * xi +
         tooth->lead_crowning * zeta * zeta;
}

/* normal: of an index deviation. */
static double gap_at(const struct eo_geometry *geometry, double normal, const struct eo_flank_point *point,
                     bool inwards, const struct eo_tooth_deviation *const tooth[2])
{
  double gap = 0;
  for (int member = 0; member < 2; member++)
    if (tooth[member])
      /* theory (P1) */
      gap += form_at(geometry, point, inwards, member, tooth[member]) - tooth[member]->index * normal;
  return gap;
}

static double normal_of(const struct eo_geometry *geometry)
{
  return cos(geometry->transverse_pressure_angle) * cos(geometry->base_helix_angle);
}

double eo_hunting_gap(const struct eo_geometry *geometry, const struct eo_flank_point *point, bool inwards,
                      const struct eo_tooth_deviation *const tooth[2])
{
  return gap_at(geometry, normal_of(geometry), point, inwards, tooth);
}

static bool tooth_has_form(const struct eo_tooth_deviation *tooth)
{
  return tooth && (tooth->profile_slope != 0 || tooth->helix_slope != 0 || tooth->profile_crowning != 0 ||
                   tooth->lead_crowning != 0);
}

bool eo_tooth_any_form(const struct eo_tooth_deviation *tooth, int teeth)
{
  bool any = false;
  for (int i = 0; i < teeth && tooth && !any; i++)
    any = tooth_has_form(&tooth[i]);
  return any;
}

/* The teeth of a pair of an end. */
static void teeth_of(const struct eo_hunt *hunt, int end, int pair, const struct eo_tooth_deviation *tooth[2])
{
  for (int member = 0; member < 2; member++) {
    const struct eo_tooth_deviation *table = hunt->input->tooth[end][member];
    tooth[member] = table ? &table[wrap(pair, hunt->result->teeth[member])] : NULL;
  }
}

/* Gaps of one position in a cycle; those of a line whose teeth have no form of their own are off by one number. */
static void set_gaps(const struct eo_hunt *hunt, struct eo_hunting_walker *walker, int end, int cycle, int j)
{
  const struct eo_contact_grid *grid = hunt->input->grid[end];
  double normal = normal_of(&grid->geometry);
  const struct eo_contact_position *position = &grid->position[j];
  const double *gap = hunt->input->gap[end] + position->first;
  for (int l = 0; l < position->lines; l++) {
    const struct eo_contact_line *line = &position->line[l];
    const struct eo_tooth_deviation *tooth[2];
    teeth_of(hunt, end, cycle - line->pair, tooth);
    bool formed = tooth_has_form(tooth[0]) || tooth_has_form(tooth[1]);
    double off = gap_at(&grid->geometry, normal, &position->point[line->first], hunt->input->inwards, tooth);
    for (int i = line->first; i < line->first + line->cells; i++) {
      if (formed)
        off = gap_at(&grid->geometry, normal, &position->point[i], hunt->input->inwards, tooth);
      walker->gap[end][position->first + i] = gap[i] + off;
    }
  }
}

/* What the line of the same teeth carried at a position `cycles` before this one's; NULL where it was not there. */
static const double *carried_by(const struct eo_contact_position *position, const struct eo_contact_line *line,
                                int cycles, const struct eo_loaded_end *solved)
{
  for (int i = 0; i < position->lines; i++)
    if (position->line[i].pair == line->pair - cycles && position->line[i].kind == line->kind &&
        position->line[i].cells == line->cells)
      return solved->line_load + position->first + position->line[i].first;
  return NULL;
}

/* Puts a start in the place of a solution: what the lines of the same teeth carried goes on as it did,
   q = 3 q1 - 3 q2 + q3; zero loads with nothing before, which eo_loaded_resolve() starts from cold. before: instants of
   this block that are solved. */
static void guess(const struct eo_hunt *hunt, struct eo_loaded_end *solved, int end, int j, int before)
{
  const struct eo_contact_grid *grid = hunt->input->grid[end];
  const struct eo_contact_position *position = &grid->position[j], *back[EO_HUNTING_BEFORE];
  int cycles[EO_HUNTING_BEFORE], known = before < EO_HUNTING_BEFORE ? before : EO_HUNTING_BEFORE;
  double z[EO_HUNTING_BEFORE] = {0};
  for (int i = 0; i < known; i++) {
    int at = j - (i + 1) * hunt->step;
    cycles[i] = at < 0;
    back[i] = &grid->position[wrap(at, grid->positions)];
    z[i] = solved->approach[wrap(at, grid->positions)];
  }
  memset(solved->line_load + position->first, 0, sizeof *solved->line_load * (size_t)position->points);
  for (int l = 0; l < position->lines; l++) {
    const double *q[EO_HUNTING_BEFORE] = {NULL};
    for (int i = 0; i < known; i++)
      q[i] = carried_by(back[i], &position->line[l], cycles[i], solved);
    double *load = solved->line_load + position->first + position->line[l].first;
    for (int i = 0; q[0] && i < position->line[l].cells; i++)
      load[i] = fmax(0, q[1] && q[2] ? 3 * (q[0][i] - q[1][i]) + q[2][i] : q[1] ? 2 * q[0][i] - q[1][i] : q[0][i]);
  }
  solved->approach[j] = known > 2 ? 3 * (z[0] - z[1]) + z[2] : known == 2 ? 2 * z[0] - z[1] : z[0];
}

static void solve_end(const struct eo_hunt *hunt, struct eo_hunting_walker *walker, int end, int instant, int before)
{
  const struct eo_contact_grid *grid = hunt->input->grid[end];
  int at = end == EO_RIGHT ? instant - hunt->input->stagger : instant, positions = hunt->result->positions,
      j = wrap(at, positions) * hunt->step;
  set_gaps(hunt, walker, end, floored(at, positions), j);
  guess(hunt, &walker->solved[end], end, j, before);
  eo_loaded_resolve(walker->loaded[end], grid, walker->gap[end], hunt->input->compliance_factor, j,
                    hunt->input->load[end], &walker->solved[end]);
}

static void balance(const struct eo_hunt *hunt, struct eo_hunting_walker *walker, int instant)
{
  const struct eo_hunting_input *input = hunt->input;
  int positions = hunt->result->positions,
      at[2] = {wrap(instant, positions) * hunt->step, wrap(instant - input->stagger, positions) * hunt->step};
  struct eo_loaded_gaps gaps[2] = {{.gap = walker->gap[EO_LEFT]}, {.gap = walker->gap[EO_RIGHT]}};
  const struct eo_loaded_half half[2] = {{walker->loaded[EO_LEFT], input->grid[EO_LEFT], &gaps[EO_LEFT]},
                                         {walker->loaded[EO_RIGHT], input->grid[EO_RIGHT], &gaps[EO_RIGHT]}};
  walker->solved[EO_LEFT].failures += !eo_loaded_balance_position(half, input->compliance_factor, &input->hold, at,
                                                                  input->shared_load, walker->solved);
}

/* The larger, of equal ones the earlier: whatever the order in which they are seen, the same is left. */
static void raise_to(struct eo_hunting_place *place, const struct eo_hunting_place *seen)
{
  int later = seen->cycle - place->cycle;
  later = later ? later : seen->position - place->position;
  later = later ? later : seen->end - place->end;
  later = later ? later : seen->line - place->line;
  if (seen->value > place->value || (seen->value > 0 && seen->value == place->value && later < 0))
    *place = *seen;
}

/* Loads of the pairs of one end at an instant, and the largest ones. */
static void read_end(const struct eo_hunt *hunt, const struct eo_hunting_walker *walker, struct eo_hunting_find *find,
                     int end, int instant)
{
  struct eo_hunting *hunting = hunt->result;
  const struct eo_contact_grid *grid = hunt->input->grid[end];
  const struct eo_loaded_end *solved = &walker->solved[end];
  int at = end == EO_RIGHT ? instant - hunt->input->stagger : instant, position = wrap(at, hunting->positions),
      cycle = floored(at, hunting->positions), j = position * hunt->step, carrying = 0;
  const struct eo_contact_position *contact_position = &grid->position[j];
  float *pair_load = hunting->pair_load[end] + (size_t)instant * (size_t)hunting->lines;
  hunting->load[end][instant] = solved->load[j];
  hunting->approach[end][instant] = solved->approach[j];
  hunting->tangent[end][instant] = solved->tangent[j];
  for (int k = hunting->first_line; k < hunting->first_line + hunting->lines; k++) {
    struct eo_hunting_place load = {.end = end, .cycle = wrap(cycle, hunting->cycles), .position = position, .line = k},
                            pressure = load;
    for (int member = 0; member < 2; member++)
      load.tooth[member] = pressure.tooth[member] = wrap(cycle - k, hunting->teeth[member]);
    for (int l = 0; l < contact_position->lines; l++)
      for (int i = contact_position->line[l].first;
           contact_position->line[l].pair == k && i < contact_position->line[l].first + contact_position->line[l].cells;
           i++) {
        double q = solved->line_load[contact_position->first + i];
        load.value += q * contact_position->length[i];
        if (q > 0)
          pressure.value = fmax(pressure.value, eo_loaded_pressure(grid, q, contact_position->radius[i]));
      }
    pair_load[k - hunting->first_line] = (float)load.value;
    carrying += load.value > 0;
    raise_to(&find->most_load[end], &load);
    raise_to(&find->most_pressure[end], &pressure);
    for (int member = 0; member < 2; member++)
      raise_to(&find->tooth_load[end][member][load.tooth[member]], &load);
  }
  find->alone += carrying == 1;
}

/* Root stress of every tooth in mesh over the positions of a cycle of the end's own phase, which are there. */
static void read_roots(const struct eo_hunt *hunt, struct eo_hunting_walker *walker, struct eo_hunting_find *find,
                       int end, int cycle)
{
  struct eo_hunting *hunting = hunt->result;
  int half = walker->root[EO_RIGHT] && end == EO_RIGHT, range[2];
  const struct eo_root_loads *loads = &walker->root_loads[half];
  struct eo_root_history *history = &walker->history[half];
  eo_contact_grid_pairs(hunt->input->grid[end], range);
  eo_root_loads_find(&walker->root_loads[half], hunt->input->root[half], &walker->solved[end]);
  for (int member = 0; member < 2; member++)
    for (int k = range[0]; k <= range[1]; k++) {
      struct eo_root_peak peak;
      eo_root_tooth_compute(walker->root[half], member, k, 1, &loads, &history, &peak);
      struct eo_hunting_place place = {
          .value = peak.stress, .end = end, .cycle = wrap(cycle, hunting->cycles), .line = k};
      for (int i = 0; i < 2; i++)
        place.tooth[i] = wrap(cycle - k, hunting->teeth[i]);
      raise_to(&find->most_stress[member], &place);
      raise_to(&find->tooth_stress[member][end * hunting->teeth[member] + place.tooth[member]], &place);
    }
}

static void solve_instant(const struct eo_hunt *hunt, struct eo_hunting_walker *walker, int instant, int before)
{
  for (int end = 0; end < hunt->input->ends; end++)
    solve_end(hunt, walker, end, instant, before);
  if (hunt->input->ends == 2 && hunt->input->hold.stiffness > 0 && hunt->input->grid[0]->geometry.base_helix_angle != 0)
    balance(hunt, walker, instant);
}

static void read_instant(const struct eo_hunt *hunt, struct eo_hunting_walker *walker, int instant)
{
  int positions = hunt->result->positions;
  for (int end = 0; end < hunt->input->ends; end++) {
    int at = end == EO_RIGHT ? instant - hunt->input->stagger : instant;
    read_end(hunt, walker, &walker->find, end, instant);
    if (walker->root[EO_LEFT] && wrap(at, positions) == positions - 1)
      read_roots(hunt, walker, &walker->find, end, floored(at, positions));
  }
}

/* A block of cycles. A cycle of a lagging right end that began in the block before is solved once more, so that its
   roots see all of it. */
static enum eo_code pass_block(void *context, int thread, int item, struct eo_error *error)
{
  const struct eo_hunt *hunt = context;
  struct eo_hunting_walker *walker = &hunt->walker[thread];
  int positions = hunt->result->positions, first = item * EO_HUNTING_BLOCK * positions,
      last = first + EO_HUNTING_BLOCK * positions,
      ahead = walker->root[EO_LEFT] && hunt->input->ends == 2 && hunt->input->stagger ? positions : 0;
  (void)error;
  last = last < hunt->result->instants ? last : hunt->result->instants;
  for (int i = first - ahead; i < last; i++) {
    if (i == first)
      walker->solved[0].failures = walker->solved[1].failures = 0;
    solve_instant(hunt, walker, i, i - first + ahead);
    if (i >= first)
      read_instant(hunt, walker, i);
  }
  walker->find.failures += walker->solved[0].failures + walker->solved[1].failures;
  return EO_OK;
}

/* What each thread found. */
static void gather(struct eo_hunt *hunt)
{
  struct eo_hunting *hunting = hunt->result;
  for (int thread = 0; thread < hunt->input->threads; thread++) {
    const struct eo_hunting_find *find = &hunt->walker[thread].find;
    hunting->failures += find->failures;
    hunting->alone += find->alone;
    for (int end = 0; end < hunting->ends; end++) {
      raise_to(&hunting->most_load[end], &find->most_load[end]);
      raise_to(&hunting->most_pressure[end], &find->most_pressure[end]);
    }
    for (int member = 0; member < 2; member++) {
      raise_to(&hunting->most_stress[member], &find->most_stress[member]);
      for (int end = 0; end < hunting->ends; end++)
        for (int i = 0; i < hunting->teeth[member]; i++)
          raise_to(&hunting->tooth_load[end][member][i], &find->tooth_load[end][member][i]);
      for (int i = 0; hunting->tooth_stress[member] && i < hunting->ends * hunting->teeth[member]; i++)
        raise_to(&hunting->tooth_stress[member][i], &find->tooth_stress[member][i]);
    }
  }
}

enum eo_code eo_hunting_run(struct eo_hunting *hunting, const struct eo_hunting_input *input,
                            const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_hunt hunt;
  enum eo_code code = eo_hunt_begin(&hunt, hunting, input, error);
  const struct eo_parallel parallel = {.threads = input->threads,
                                       .work = pass_block,
                                       .context = &hunt,
                                       .progress = progress,
                                       .what = "contact over the hunting period",
                                       .last = 1};
  if (!code)
    code = eo_parallel_run(&parallel, (hunting->cycles + EO_HUNTING_BLOCK - 1) / EO_HUNTING_BLOCK, error);
  if (!code)
    gather(&hunt);
  eo_hunt_end(&hunt);
  return code;
}
