/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/root.h"

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

enum { MOST_TEETH = 64 };

struct eo_root_workspace {
  const struct eo_contact_grid *grid;
  const struct eo_root_modes *modes[2]; /* [member] */
  int step, count;                      /* positions that count */
  struct eo_root_weights *weights[2];   /* [member]: [grid->points], of the positions that count */
  double *force;                        /* [ends][most points] */
  float *load;                          /* [positions][ends][slots] */
  float *scratch;                       /* [positions][ends][rank stride] */
  float *stress;                        /* [positions][ends][stress stride] */
  uint64_t *touched;                    /* [positions]: see eo_root_modes_add() */
};

/* NULL without memory. */
static struct eo_root_weights *weigh_points(const struct eo_contact_grid *grid, const struct eo_root_modes *modes,
                                            int step)
{
  struct eo_root_weights *weights = malloc(sizeof *weights * (size_t)grid->points);
  for (int j = 0; weights && j < grid->positions; j += step) {
    const struct eo_contact_position *position = &grid->position[j];
    for (int i = 0; i < position->points; i++)
      eo_root_modes_weigh(modes, &position->point[i], &weights[position->first + i]);
  }
  return weights;
}

enum eo_code eo_root_workspace_new(struct eo_root_workspace **result, const struct eo_contact_grid *grid,
                                   const struct eo_root_modes *const modes[2], int step, int ends,
                                   struct eo_error *error)
{
  struct eo_root_workspace *ws = calloc(1, sizeof *ws);
  size_t rank = 1, length = 1, slots = 1;
  if (!ws)
    return eo_error_memory(error);
  ws->grid = grid;
  ws->step = step;
  ws->count = (grid->positions + step - 1) / step;
  for (int member = 0; member < 2; member++) {
    size_t r = (size_t)eo_root_modes_rank_stride(modes[member]), m = (size_t)eo_root_modes_stress_stride(modes[member]);
    rank = r > rank ? r : rank;
    length = m > length ? m : length;
    m = (size_t)eo_root_modes_slots(modes[member]);
    slots = m > slots ? m : slots;
    ws->modes[member] = modes[member];
    ws->weights[member] = weigh_points(grid, modes[member], step);
  }
  size_t rows = (size_t)ws->count * (size_t)ends;
  ws->force = malloc(sizeof(double) * (size_t)grid->most_points * (size_t)ends);
  ws->load = malloc(sizeof *ws->load * rows * slots);
  ws->scratch = eo_gram_allocate((long)(rows * rank / 2));
  ws->stress = eo_gram_allocate((long)(rows * length / 2));
  ws->touched = malloc(sizeof *ws->touched * (size_t)ws->count);
  if (!ws->weights[0] || !ws->weights[1] || !ws->force || !ws->load || !ws->scratch || !ws->stress || !ws->touched) {
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
  free(ws->weights[0]);
  free(ws->weights[1]);
  free(ws->force);
  free(ws->load);
  free(ws->scratch);
  free(ws->stress);
  free(ws->touched);
  free(ws);
}

/* Whether the larger principal stress (s + t + sqrt((s - t)^2 + 4 u^2))/2 passes the largest so far. */
static inline bool passes(float s, float t, float u, float largest)
{
  float sum = s + t, room = 2 * largest - sum, difference = s - t, square = difference * difference + 4 * u * u;
  return !(room >= 0 && square <= room * room);
}

enum { LANE = 4, BLOCK = 4 * LANE };
typedef float lane __attribute__((vector_size(4 * LANE), aligned(4), may_alias));
typedef int lane_mask __attribute__((vector_size(4 * LANE)));

/* Whether any of a block of nodes does. */
static inline bool any_passes(const float *s, const float *t, const float *u, float largest)
{
  lane_mask none = ~(lane_mask){0};
  for (int i = 0; i < BLOCK; i += LANE) {
    lane a = *(const lane *)(s + i), b = *(const lane *)(t + i), shear = *(const lane *)(u + i);
    lane sum = a + b, room = 2 * largest - sum, difference = a - b,
         square = difference * difference + 4 * shear * shear;
    none &= (room >= 0) & (square <= room * room);
  }
  return !(none[0] & none[1] & none[2] & none[3]);
}

/* stress[EO_STRESSES][nodes]; the root is taken only where it raises the largest so far. */
static double largest_principal(int nodes, const float *stress, int *where)
{
  const float *s = stress, *t = stress + nodes, *u = stress + 2 * nodes;
  float largest = 0;
  for (int first = 0; first < nodes; first += BLOCK) {
    int last = first + BLOCK < nodes ? first + BLOCK : nodes;
    if (last - first == BLOCK && !any_passes(s + first, t + first, u + first, largest))
      continue;
    for (int i = first; i < last; i++) {
      if (!passes(s[i], t[i], u[i], largest))
        continue;
      float difference = s[i] - t[i];
      largest = (s[i] + t[i] + sqrtf(difference * difference + 4 * u[i] * u[i])) / 2; /* theory (B11) */
      *where = i;
    }
  }
  return largest;
}

/* Loads of every step-th position on the teeth around one tooth: load[count][ends][slots]. */
static void collect(struct eo_root_workspace *ws, int member, int tooth, int ends,
                    const struct eo_loaded_end *const *end)
{
  const struct eo_root_modes *modes = ws->modes[member];
  int slots = eo_root_modes_slots(modes);
  memset(ws->load, 0, sizeof *ws->load * (size_t)ends * (size_t)ws->count * (size_t)slots);
  for (int j = 0; j < ws->count; j++) {
    const struct eo_contact_position *position = &ws->grid->position[j * ws->step];
    for (int e = 0; e < ends; e++)
      for (int i = 0; i < position->points; i++)
        ws->force[e * position->points + i] = end[e]->line_load[position->first + i] * position->length[i];
    ws->touched[j] = eo_root_modes_add(modes, tooth, position->points, position->point,
                                       ws->weights[member] + position->first, ends, ws->force,
                                       ws->load + (size_t)(j * ends) * (size_t)slots);
  }
}

void eo_root_tooth_compute(struct eo_root_workspace *ws, int member, int tooth, int ends,
                           const struct eo_loaded_end *const *end, struct eo_root_history *const *history,
                           struct eo_root_peak *peak)
{
  const struct eo_contact_grid *grid = ws->grid;
  const struct eo_root_modes *modes = ws->modes[member];
  int range[2], nodes = eo_root_modes_nodes(modes), stride = eo_root_modes_stress_stride(modes);
  eo_contact_grid_pairs(grid, range);
  int first = (tooth - range[0]) * ws->count;
  collect(ws, member, tooth, ends, end);
  eo_root_modes_stress(modes, ws->count, ends, ws->load, ws->touched, ws->scratch, ws->stress);
  for (int e = 0; e < ends; e++) {
    peak[e] = (struct eo_root_peak){0};
    for (int j = 0; j < ws->count; j++) {
      int node = 0;
      const float *stress = ws->stress + (size_t)(j * ends + e) * (size_t)stride;
      double s = ws->touched[j] ? largest_principal(nodes, stress, &node) : 0;
      history[e]->phase[first + j] = grid->position[j * ws->step].phase / grid->geometry.transverse_base_pitch + tooth;
      history[e]->stress[first + j] = s;
      if (s > peak[e].stress)
        peak[e] = (struct eo_root_peak){s, node};
    }
  }
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
                             int member, const struct eo_loaded_end *end)
{
  struct eo_root_peak peak[MOST_TEETH];
  int range[2];
  eo_contact_grid_pairs(ws->grid, range);
  for (int tooth = range[0]; tooth <= range[1]; tooth++)
    eo_root_tooth_compute(ws, member, tooth, 1, &end, &history, &peak[tooth - range[0]]);
  eo_root_history_finish(history, root, ws->grid, ws->step, peak, 1);
}
