/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/root.h"

#include "numerics/dense.h"
#include "numerics/gram.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum eo_code eo_root_history_init(struct eo_root_history *history, const struct eo_contact_grid *grid,
                                  struct eo_error *error)
{
  int range[2];
  eo_contact_grid_pairs(grid, range);
  size_t most = ((size_t)range[1] - range[0] + 1) * grid->positions;
  *history = (struct eo_root_history){.phase = calloc(most, sizeof(double)), .stress = calloc(most, sizeof(double))};
  if (history->phase && history->stress)
    return EO_OK;
  eo_root_history_done(history);
  return eo_error_memory(error);
}

void eo_root_history_done(struct eo_root_history *history)
{
  free(history->phase);
  free(history->stress);
  *history = (struct eo_root_history){0};
}

void eo_root_find_largest(const struct eo_flexibility *flexibility, int member, int tooth, int n,
                          const struct eo_flank_point *point, const double *force, double *stress,
                          struct eo_root_place *place)
{
  struct eo_root root = eo_flexibility_root(flexibility, member);
  *place = (struct eo_root_place){0};
  eo_flexibility_root_stress(flexibility, member, tooth, n, point, force, 0, root.points, stress);
  for (int i = root.first; i < root.points; i++)
    for (int layer = 0; layer <= root.layers; layer++) {
      double s = eo_stress_principal(stress + (i * (root.layers + 1) + layer) * EO_STRESSES);
      if (s > place->stress)
        *place = (struct eo_root_place){s, root.arc[i], root.width * ((double)layer / root.layers - 0.5), i, layer};
    }
}

struct eo_root_tables {
  const struct eo_contact_grid *grid;
  struct eo_root_modes *modes[2]; /* [member] */
  int first_pair, pairs;
  int *present;     /* [pairs][2]: positions of the grid between which a pair can touch, the last one not among them */
  float *own[2];    /* [member]: [grid->points][stride] */
  float *remote[2]; /* [member]: [grid->points][remote stride]; NULL: loads on other teeth do not count */
};

static void find_present(struct eo_root_tables *tables)
{
  for (int j = 0; j < tables->grid->positions; j++) {
    const struct eo_contact_position *position = &tables->grid->position[j];
    for (int l = 0; l < position->lines; l++) {
      int *present = tables->present + 2 * (position->line[l].pair - tables->first_pair);
      present[0] = present[1] ? present[0] : j;
      present[1] = j + 1;
    }
  }
}

static void weigh_points(struct eo_root_tables *tables, int member)
{
  const struct eo_contact_grid *grid = tables->grid;
  const struct eo_root_modes *modes = tables->modes[member];
  size_t stride = (size_t)eo_root_modes_stride(modes, EO_ROOT_ALL), far = (size_t)eo_root_modes_remote_stride(modes);
  for (int j = 0; j < grid->positions; j++) {
    const struct eo_contact_position *position = &grid->position[j];
    for (int i = 0; i < position->points; i++) {
      size_t row = (size_t)position->first + (size_t)i;
      eo_root_modes_own(modes, &position->point[i], tables->own[member] + row * stride);
      if (far)
        eo_root_modes_remote(modes, &position->point[i], tables->remote[member] + row * far);
    }
  }
}

void eo_root_tables_free(struct eo_root_tables *tables)
{
  if (!tables)
    return;
  for (int member = 0; member < 2; member++) {
    free(tables->own[member]);
    free(tables->remote[member]);
  }
  free(tables->present);
  free(tables);
}

static int counted(const struct eo_root_tables *tables, int step)
{
  return (tables->grid->positions + step - 1) / step;
}

/* Where the loads of a pair are kept, by position. */
static float *remote_of(const struct eo_root_loads *loads, const struct eo_root_tables *tables, int member, int pair)
{
  size_t stride = (size_t)eo_root_modes_remote_stride(tables->modes[member]);
  return loads->remote[member] + (size_t)((pair - tables->first_pair) * counted(tables, loads->step)) * stride;
}

enum eo_code eo_root_loads_init(struct eo_root_loads *loads, const struct eo_root_tables *tables, int step,
                                struct eo_error *error)
{
  *loads = (struct eo_root_loads){.step = step};
  loads->force = calloc((size_t)tables->grid->points, sizeof *loads->force);
  bool complete = loads->force;
  for (int member = 0; member < 2; member++) {
    long stride = eo_root_modes_remote_stride(tables->modes[member]);
    loads->remote[member] = eo_gram_allocate((long)tables->pairs * counted(tables, step) * stride / 2 + 1);
    complete = complete && loads->remote[member];
  }
  if (complete)
    return EO_OK;
  eo_root_loads_done(loads);
  return eo_error_memory(error);
}

void eo_root_loads_done(struct eo_root_loads *loads)
{
  free(loads->force);
  free(loads->remote[0]);
  free(loads->remote[1]);
  *loads = (struct eo_root_loads){0};
}

static void find_forces(float *force, const struct eo_contact_position *position, const double *line_load)
{
  for (int i = position->first; i < position->first + position->points; i++)
    force[i] = (float)(line_load[i] * position->length[i - position->first]);
}

static void find_remote(struct eo_root_loads *loads, const struct eo_root_tables *tables, int member)
{
  const struct eo_root_modes *modes = tables->modes[member];
  int stride = eo_root_modes_remote_stride(modes);
  for (int j = 0; j < tables->grid->positions; j += loads->step) {
    const struct eo_contact_position *position = &tables->grid->position[j];
    for (int l = 0; l < position->lines; l++) {
      const struct eo_contact_line *line = &position->line[l];
      int first = position->first + line->first;
      eo_root_modes_add(modes, 1, line->cells, loads->force + first, line->cells,
                        tables->remote[member] + (size_t)first * (size_t)stride, stride,
                        remote_of(loads, tables, member, line->pair) + (size_t)(j / loads->step) * (size_t)stride,
                        stride);
    }
  }
}

/* What the forces are to the roots of other teeth. */
static void pass_forces(struct eo_root_loads *loads, const struct eo_root_tables *tables)
{
  for (int member = 0; member < 2; member++) {
    size_t stride = (size_t)eo_root_modes_remote_stride(tables->modes[member]);
    memset(loads->remote[member], 0,
           sizeof(float) * (size_t)tables->pairs * (size_t)counted(tables, loads->step) * stride);
    if (stride)
      find_remote(loads, tables, member);
  }
}

void eo_root_loads_find(struct eo_root_loads *loads, const struct eo_root_tables *tables,
                        const struct eo_loaded_end *end)
{
  for (int j = 0; j < tables->grid->positions; j += loads->step)
    find_forces(loads->force, &tables->grid->position[j], end->line_load);
  pass_forces(loads, tables);
}

/* ROWS: stresses at a time, so that they stay in the cache until they are read; every kernel takes them in whole tiles.
 */
enum { MOST_TEETH = 64, ROWS = 72 };

struct eo_root_workspace {
  const struct eo_root_tables *tables;
  float *coefficient; /* [ends][positions][stride] */
  float *room;        /* [ROWS][room of the modes] */
  float *force;       /* [ends][most points of a position]: those of one line of contact */
};

enum eo_code eo_root_workspace_new(struct eo_root_workspace **result, const struct eo_root_tables *tables, int ends,
                                   struct eo_error *error)
{
  struct eo_root_workspace *ws = calloc(1, sizeof *ws);
  long stride = 1, length = 1, cells = 1;
  if (!ws)
    return eo_error_memory(error);
  ws->tables = tables;
  for (int member = 0; member < 2; member++) {
    long own = eo_root_modes_stride(tables->modes[member], EO_ROOT_ALL),
         all = eo_root_modes_room(tables->modes[member]);
    stride = own > stride ? own : stride;
    length = all > length ? all : length;
  }
  for (int j = 0; j < tables->grid->positions; j++)
    cells = tables->grid->position[j].points > cells ? tables->grid->position[j].points : cells;
  ws->coefficient = eo_gram_allocate((long)ends * tables->grid->positions * stride / 2 + 1);
  ws->room = eo_gram_allocate(ROWS * length / 2 + 1);
  ws->force = malloc(sizeof *ws->force * (size_t)ends * (size_t)cells);
  if (!ws->coefficient || !ws->room || !ws->force) {
    eo_root_workspace_free(ws);
    return eo_error_memory(error);
  }
  *result = ws;
  return EO_OK;
}

void eo_root_workspace_free(struct eo_root_workspace *ws)
{
  if (!ws)
    return;
  free(ws->coefficient);
  free(ws->room);
  free(ws->force);
  free(ws);
}

/* Positions of a tooth's mesh, first .. last - 1 of those that count, over which it may carry load itself, or others
   alone do; as coefficients of that. */
struct stretch {
  int first, last;
  enum eo_root_carriers carriers;
};

/* stretch[3]: before, while and after the tooth can touch. */
static void find_stretches(const struct eo_root_tables *tables, int tooth, int step, struct stretch *stretch)
{
  const int *present = tables->present + 2 * (tooth - tables->first_pair);
  int count = counted(tables, step), first = (present[0] + step - 1) / step, last = (present[1] + step - 1) / step;
  stretch[0] = (struct stretch){0, first, EO_ROOT_OTHERS};
  stretch[1] = (struct stretch){first, last, EO_ROOT_ALL};
  stretch[2] = (struct stretch){last, count, EO_ROOT_OTHERS};
}

/* The forces of a line of contact under the loads of all ends, one after the other. */
static void gather_line(struct eo_root_workspace *ws, int first, int cells, int ends,
                        const struct eo_root_loads *const *loads)
{
  for (int e = 0; e < ends; e++)
    memcpy(ws->force + (size_t)e * (size_t)cells, loads[e]->force + first, sizeof *ws->force * (size_t)cells);
}

/* What the tooth itself carries, of all ends at a position at once: they read the same rows.
   coefficient[ends][positions of the stretch][stride]. */
static void add_own(struct eo_root_workspace *ws, int member, int tooth, const struct stretch *stretch, int ends,
                    const struct eo_root_loads *const *loads)
{
  const struct eo_root_tables *tables = ws->tables;
  const struct eo_root_modes *modes = tables->modes[member];
  int stride = eo_root_modes_stride(modes, EO_ROOT_ALL), step = loads[0]->step, rows = stretch->last - stretch->first;
  for (int j = 0; j < rows; j++) {
    const struct eo_contact_position *position = &tables->grid->position[(stretch->first + j) * step];
    for (int l = 0; l < position->lines; l++) {
      const struct eo_contact_line *line = &position->line[l];
      int first = position->first + line->first;
      if (line->pair != tooth)
        continue;
      gather_line(ws, first, line->cells, ends, loads);
      eo_root_modes_add(modes, ends, line->cells, ws->force, line->cells,
                        tables->own[member] + (size_t)first * (size_t)stride, stride,
                        ws->coefficient + (size_t)j * (size_t)stride, rows * stride);
    }
  }
}

/* What the others carry, each while it can touch. */
static void add_others(struct eo_root_workspace *ws, int member, int tooth, const struct stretch *stretch, int ends,
                       const struct eo_root_loads *const *loads)
{
  const struct eo_root_tables *tables = ws->tables;
  const struct eo_root_modes *modes = tables->modes[member];
  int reach = eo_root_modes_reach(modes), step = loads[0]->step, rows = stretch->last - stretch->first;
  size_t stride = (size_t)eo_root_modes_stride(modes, stretch->carriers),
         far = (size_t)eo_root_modes_remote_stride(modes);
  for (int pair = tables->first_pair; pair < tables->first_pair + tables->pairs; pair++) {
    const int *present = tables->present + 2 * (pair - tables->first_pair);
    int first = (present[0] + step - 1) / step, last = (present[1] + step - 1) / step;
    first = first > stretch->first ? first : stretch->first;
    last = last < stretch->last ? last : stretch->last;
    for (int e = 0; e < ends && first < last && pair != tooth && abs(pair - tooth) <= reach; e++)
      eo_root_modes_pass(modes, stretch->carriers, pair - tooth, last - first,
                         remote_of(loads[e], tables, member, pair) + (size_t)first * far,
                         ws->coefficient + (size_t)(e * rows + first - stretch->first) * stride);
  }
}

/* The coefficients of a stretch under the loads of all ends. */
static void add_up(struct eo_root_workspace *ws, int member, int tooth, const struct stretch *stretch, int ends,
                   const struct eo_root_loads *const *loads)
{
  size_t stride = (size_t)eo_root_modes_stride(ws->tables->modes[member], stretch->carriers),
         rows = (size_t)(stretch->last - stretch->first);
  memset(ws->coefficient, 0, sizeof *ws->coefficient * (size_t)ends * rows * stride);
  if (stretch->carriers == EO_ROOT_ALL)
    add_own(ws, member, tooth, stretch, ends, loads);
  add_others(ws, member, tooth, stretch, ends, loads);
}

/* Largest stress, and its node, at `rows` positions. */
static void read_rows(struct eo_root_workspace *ws, int member, enum eo_root_carriers carriers, int rows,
                      const float *coefficient, double *stress, struct eo_root_peak *peak)
{
  int node[ROWS];
  eo_root_modes_find_largest(ws->tables->modes[member], carriers, rows, coefficient, ws->room, stress, node);
  for (int j = 0; j < rows; j++)
    if (stress[j] > peak->stress)
      *peak = (struct eo_root_peak){stress[j], node[j]};
}

/* A stretch of a tooth whose histories begin at `start`. */
static void compute_stretch(struct eo_root_workspace *ws, int member, int tooth, const struct stretch *stretch,
                            int ends, const struct eo_root_loads *const *loads, struct eo_root_history *const *history,
                            int start, struct eo_root_peak *peak)
{
  size_t stride = (size_t)eo_root_modes_stride(ws->tables->modes[member], stretch->carriers);
  int rows = stretch->last - stretch->first;
  add_up(ws, member, tooth, stretch, ends, loads);
  for (int e = 0; e < ends; e++)
    for (int j = 0; j < rows; j += ROWS)
      read_rows(ws, member, stretch->carriers, rows - j < ROWS ? rows - j : ROWS,
                ws->coefficient + (size_t)(e * rows + j) * stride, history[e]->stress + start + stretch->first + j,
                &peak[e]);
}

void eo_root_tooth_compute(struct eo_root_workspace *ws, int member, int tooth, int ends,
                           const struct eo_root_loads *const *loads, struct eo_root_history *const *history,
                           struct eo_root_peak *peak)
{
  const struct eo_root_tables *tables = ws->tables;
  const struct eo_contact_grid *grid = tables->grid;
  int step = loads[0]->step, count = counted(tables, step), start = (tooth - tables->first_pair) * count;
  struct stretch stretch[3];
  for (int e = 0; e < ends; e++) {
    peak[e] = (struct eo_root_peak){0};
    for (int j = 0; j < count; j++) {
      history[e]->phase[start + j] = grid->position[j * step].phase / grid->geometry.transverse_base_pitch + tooth;
      history[e]->stress[start + j] = 0; /* of others that do not count */
    }
  }
  find_stretches(tables, tooth, step, stretch);
  for (int i = 0; i < 3; i++)
    if (stretch[i].first < stretch[i].last && eo_root_modes_stride(tables->modes[member], stretch[i].carriers) > 0)
      compute_stretch(ws, member, tooth, &stretch[i], ends, loads, history, start, peak);
}

void eo_root_history_finish(struct eo_root_history *history, const struct eo_root *root,
                            const struct eo_contact_grid *grid, int step, const struct eo_root_peak *peak, int stride)
{
  int range[2];
  eo_contact_grid_pairs(grid, range);
  history->phases = (range[1] - range[0] + 1) * ((grid->positions + step - 1) / step);
  history->maximum = history->arc = history->eta = 0;
  for (int tooth = 0; tooth <= range[1] - range[0]; tooth++) {
    const struct eo_root_peak *root_peak = &peak[tooth * stride];
    if (root_peak->stress <= history->maximum)
      continue;
    history->maximum = root_peak->stress;
    history->arc = root->arc[root->first + root_peak->node / (root->layers + 1)];
    history->eta = root->width * ((double)(root_peak->node % (root->layers + 1)) / root->layers - 0.5);
  }
}

void eo_root_history_compute(struct eo_root_history *history, struct eo_root_workspace *ws, const struct eo_root *root,
                             int member, const struct eo_root_loads *loads)
{
  const struct eo_root_tables *tables = ws->tables;
  struct eo_root_peak peak[MOST_TEETH];
  for (int i = 0; i < tables->pairs; i++)
    eo_root_tooth_compute(ws, member, tables->first_pair + i, 1, &loads, &history, &peak[i]);
  eo_root_history_finish(history, root, tables->grid, loads->step, peak, 1);
}

enum { WAVES = 4 }; /* more, or all alike, prune no more of the search; the constant load alone a third less */

/* A line load that is a wave over the face, of amplitude 1 N/m. */
static void make_wave(struct eo_root_loads *loads, const struct eo_root_tables *tables, int wave)
{
  for (int j = 0; j < tables->grid->positions; j++) {
    const struct eo_contact_position *position = &tables->grid->position[j];
    for (int i = 0; i < position->points; i++)
      loads->force[position->first + i] =
          (float)(position->length[i] *
                  cos(wave * M_PI * (position->point[i].eta / tables->grid->geometry.face_width + 0.5)));
  }
  pass_forces(loads, tables);
}

/* What flanks carry is smooth for the most part: the second moment, of coefficients, of a constant line load and of
   waves over the face, longer ones larger. moment[stride][stride]; wide[positions][stride]: scratch. */
static void add_waves(struct eo_root_workspace *ws, struct eo_root_loads *loads, int member, double *wide,
                      double *moment)
{
  const struct eo_root_tables *tables = ws->tables;
  const struct eo_root_loads *load = loads;
  int stride = eo_root_modes_stride(tables->modes[member], EO_ROOT_ALL);
  for (int wave = 0; wave < WAVES; wave++) {
    make_wave(loads, tables, wave);
    for (int tooth = tables->first_pair; tooth < tables->first_pair + tables->pairs; tooth++) {
      struct stretch stretch[3];
      find_stretches(tables, tooth, loads->step, stretch);
      int rows = stretch[1].last - stretch[1].first;
      add_up(ws, member, tooth, &stretch[1], 1, &load);
      for (int i = 0; i < rows * stride; i++)
        wide[i] = (double)ws->coefficient[i] / (1 + wave);
      eo_dense_add_gram(rows, stride, wide, moment);
    }
  }
}

static enum eo_code turn_modes(struct eo_root_tables *tables, struct eo_root_workspace *ws, struct eo_root_loads *loads,
                               int member, struct eo_error *error)
{
  struct eo_root_modes *modes = tables->modes[member];
  size_t stride = (size_t)eo_root_modes_stride(modes, EO_ROOT_ALL);
  double *wide = malloc(sizeof *wide * (size_t)tables->grid->positions * stride),
         *moment = calloc(stride * stride, sizeof *moment);
  enum eo_code code = wide && moment ? EO_OK : eo_error_memory(error);
  if (!code) {
    add_waves(ws, loads, member, wide, moment);
    code = eo_root_modes_turn(modes, moment, error);
  }
  free(wide);
  free(moment);
  return code;
}

static enum eo_code turn_both(struct eo_root_tables *tables, struct eo_error *error)
{
  struct eo_root_workspace *ws = NULL;
  struct eo_root_loads loads = {0};
  enum eo_code code = eo_root_workspace_new(&ws, tables, 1, error);
  if (!code)
    code = eo_root_loads_init(&loads, tables, 1, error);
  for (int member = 0; member < 2 && !code; member++)
    code = turn_modes(tables, ws, &loads, member, error);
  eo_root_workspace_free(ws);
  eo_root_loads_done(&loads);
  return code;
}

static enum eo_code fill_tables(struct eo_root_tables *tables, struct eo_error *error)
{
  int range[2];
  eo_contact_grid_pairs(tables->grid, range);
  tables->first_pair = range[0];
  tables->pairs = range[1] - range[0] + 1;
  tables->present = calloc((size_t)tables->pairs, sizeof *tables->present * 2);
  if (!tables->present)
    return eo_error_memory(error);
  find_present(tables);
  for (int member = 0; member < 2; member++) {
    long points = tables->grid->points, stride = eo_root_modes_stride(tables->modes[member], EO_ROOT_ALL),
         far = eo_root_modes_remote_stride(tables->modes[member]);
    tables->own[member] = eo_gram_allocate((points * stride + 1) / 2);
    tables->remote[member] = far ? eo_gram_allocate((points * far + 1) / 2) : NULL;
    if (!tables->own[member] || (far && !tables->remote[member]))
      return eo_error_memory(error);
    weigh_points(tables, member);
  }
  EO_TRY(turn_both(tables, error));
  weigh_points(tables, EO_PINION);
  weigh_points(tables, EO_GEAR);
  return EO_OK;
}

enum eo_code eo_root_tables_new(struct eo_root_tables **result, const struct eo_contact_grid *grid,
                                struct eo_root_modes *const modes[2], struct eo_error *error)
{
  struct eo_root_tables *tables = calloc(1, sizeof *tables);
  if (!tables)
    return eo_error_memory(error);
  tables->grid = grid;
  tables->modes[EO_PINION] = modes[EO_PINION];
  tables->modes[EO_GEAR] = modes[EO_GEAR];
  enum eo_code code = fill_tables(tables, error);
  if (code)
    eo_root_tables_free(tables);
  else
    *result = tables;
  return code;
}
