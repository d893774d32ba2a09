/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/root_modes.h"

#include "flexibility/prepared.h"
#include "numerics/gram.h"
#include "numerics/lowrank.h"

#include <cblas.h>
#include <stdlib.h>
#include <string.h>

struct eo_root_modes {
  const struct eo_flank_table *table;
  int reach; /* loads on pairs k - reach .. k + reach count */
  const struct eo_gram *gram;
  int member, rank, length;                      /* length = nodes x EO_STRESSES */
  int rank_stride, shape_stride;                 /* rank and length, padded with zeros as the kernel wants them */
  int slots, slot[2 * EO_FLEXIBILITY_REACH + 2]; /* grid points of loads on pair k - reach .. k + reach, and where each
                                                    begins; at last their end */
  float *coefficient;                            /* [slots][rank_stride] */
  float *shape;                                  /* [rank][shape_stride]: [EO_STRESSES][nodes] */
};

static const struct eo_grid *grid_of(const struct eo_root_modes *modes, int ahead_by)
{
  return ahead_by == 0 ? &modes->table->flank : &modes->table->next;
}

static void count_slots(struct eo_root_modes *modes)
{
  for (int part = 0; part <= 2 * modes->reach; part++) {
    modes->slot[part] = modes->slots;
    modes->slots += grid_of(modes, part - modes->reach)->points;
  }
  modes->slot[2 * modes->reach + 1] = modes->slots;
}

/* All influence rows below each other: [slots][length], Pa/N, from the root's first point on. */
static double *stack_rows(const struct eo_root_modes *modes, size_t skip)
{
  double *stack = malloc(sizeof *stack * (size_t)modes->slots * (size_t)modes->length), *to = stack;
  for (int ahead = -modes->reach; stack && ahead <= modes->reach; ahead++) {
    const struct eo_grid *grid;
    const double *row = eo_flank_table_stress(modes->table, ahead, &grid) + skip;
    for (int i = 0; i < grid->points; i++, to += modes->length, row += modes->table->stresses)
      memcpy(to, row, sizeof *to * (size_t)modes->length);
  }
  return stack;
}

static int padded(int count)
{
  return (count + EO_GRAM_COLUMNS - 1) / EO_GRAM_COLUMNS * EO_GRAM_COLUMNS;
}

/* Zeros; NULL without memory. */
static float *make_floats(int rows, int stride)
{
  return eo_gram_allocate(((long)rows * stride + 1) / 2);
}

/* stack = factor x shape in the least-squares sense: (factor' factor) shape = factor' stack. */
static enum eo_code fit_shapes(struct eo_root_modes *modes, int rows, int stride, const double *factor,
                               const double *stack, struct eo_error *error)
{
  int rank = modes->rank;
  size_t length = (size_t)modes->length, size = (size_t)rank * length;
  double *normal = malloc(sizeof *normal * (size_t)rank * (size_t)rank), *shape = malloc(sizeof *shape * size);
  modes->shape_stride = padded(modes->length);
  modes->shape = make_floats(rank, modes->shape_stride);
  enum eo_code code = normal && shape && modes->shape ? EO_OK : eo_error_memory(error);
  if (!code) {
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, modes->length, rows, 1, factor, stride, stack,
                modes->length, 0, shape, modes->length);
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, rank, rows, 1, factor, stride, factor, stride, 0, normal,
                rank);
    code = eo_lowrank_solve(rank, normal, modes->length, shape, error);
  }
  for (size_t i = 0; !code && i < size; i++) {
    size_t row = i / length, node = i % length / EO_STRESSES, part = i % EO_STRESSES;
    modes->shape[row * (size_t)modes->shape_stride + part * (length / EO_STRESSES) + node] = (float)shape[i];
  }
  free(normal);
  free(shape);
  return code;
}

static enum eo_code keep_coefficients(struct eo_root_modes *modes, int stride, const double *factor,
                                      struct eo_error *error)
{
  modes->rank_stride = padded(modes->rank);
  modes->coefficient = make_floats(modes->slots, modes->rank_stride);
  for (int i = 0; modes->coefficient && i < modes->slots; i++)
    for (int r = 0; r < modes->rank; r++)
      modes->coefficient[i * modes->rank_stride + r] = (float)factor[i * stride + r];
  return modes->coefficient ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_root_modes_new(struct eo_root_modes **result, const struct eo_flexibility *flexibility, int member,
                               struct eo_error *error)
{
  static const double TOLERANCE = 3e-6; /* of squares */
  struct eo_root root = eo_flexibility_root(flexibility, member);
  struct eo_root_modes *modes = calloc(1, sizeof *modes);
  if (!modes)
    return eo_error_memory(error);
  modes->table = &flexibility->table[member];
  modes->reach = flexibility->settings.neighbour_coupling ? modes->table->reach : 0;
  modes->gram = eo_gram_select();
  modes->member = member;
  modes->length = (root.points - root.first) * (root.layers + 1) * EO_STRESSES;
  count_slots(modes);
  int rows = modes->slots, stride = 0;
  double *stack = stack_rows(modes, (size_t)root.first * (root.layers + 1) * EO_STRESSES), *factor = NULL;
  double *gram = malloc(sizeof *gram * (size_t)rows * (size_t)rows);
  enum eo_code code = stack && gram ? EO_OK : eo_error_memory(error);
  if (!code) {
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, rows, modes->length, 1, stack, modes->length, stack,
                modes->length, 0, gram, rows);
    code = eo_lowrank_factor(rows, gram, TOLERANCE, &modes->rank, &stride, &factor, error);
  }
  if (!code)
    code = fit_shapes(modes, rows, stride, factor, stack, error);
  if (!code)
    code = keep_coefficients(modes, stride, factor, error);
  free(stack);
  free(gram);
  free(factor);
  if (code)
    eo_root_modes_free(modes);
  else
    *result = modes;
  return code;
}

void eo_root_modes_free(struct eo_root_modes *modes)
{
  if (!modes)
    return;
  free(modes->coefficient);
  free(modes->shape);
  free(modes);
}

int eo_root_modes_rank_stride(const struct eo_root_modes *modes)
{
  return modes->rank_stride;
}

int eo_root_modes_stress_stride(const struct eo_root_modes *modes)
{
  return modes->shape_stride;
}

int eo_root_modes_nodes(const struct eo_root_modes *modes)
{
  return modes->length / EO_STRESSES;
}

int eo_root_modes_slots(const struct eo_root_modes *modes)
{
  return modes->slots;
}

static bool is_loaded(int n, int sets, const double *force)
{
  for (int set = 0; set < sets; set++)
    if (force[set * n] != 0)
      return true;
  return false;
}

void eo_root_modes_weigh(const struct eo_root_modes *modes, const struct eo_flank_point *point,
                         struct eo_root_weights *weights)
{
  for (int ahead = 0; ahead <= (modes->reach ? 1 : 0); ahead++) {
    const struct eo_grid *grid = grid_of(modes, ahead);
    int row, layer;
    eo_spline_weights(&grid->s, point->s[modes->member], &row, weights->across[ahead]);
    eo_spline_weights(&grid->eta, point->eta, &layer, weights->along[ahead]);
    weights->first[ahead] = row * grid->eta.count + layer;
  }
}

uint64_t eo_root_modes_add(const struct eo_root_modes *modes, int pair, int n, const struct eo_flank_point *point,
                           const struct eo_root_weights *weights, int sets, const double *force, float *load)
{
  uint64_t touched = 0;
  for (int j = 0; j < n; j++) {
    int ahead = point[j].pair - pair;
    if (abs(ahead) > modes->reach || !is_loaded(n, sets, force + j))
      continue;
    int columns = grid_of(modes, ahead)->eta.count;
    const double *across = weights[j].across[ahead != 0], *along = weights[j].along[ahead != 0];
    touched |= (uint64_t)1 << (ahead + modes->reach);
    for (int set = 0; set < sets; set++) {
      double f = force[set * n + j];
      float *to = load + set * modes->slots + modes->slot[ahead + modes->reach] + weights[j].first[ahead != 0];
      for (int r = 0; f != 0 && r < EO_SPLINE_WIDTH; r++)
        for (int l = 0; l < EO_SPLINE_WIDTH; l++)
          to[r * columns + l] += (float)(f * (across[r] * along[l]));
    }
  }
  return touched;
}

/* Adds what one part of the loads gives at positions first .. last - 1. */
static void add_part(const struct eo_root_modes *modes, int part, int first, int last, int sets, const float *load,
                     float *scratch)
{
  int slots = modes->slot[part + 1] - modes->slot[part], row = first * sets;
  modes->gram->multiply((last - first) * sets, slots, modes->rank_stride,
                        load + (size_t)row * (size_t)modes->slots + modes->slot[part], modes->slots,
                        modes->coefficient + (size_t)modes->slot[part] * (size_t)modes->rank_stride, modes->rank_stride,
                        true, scratch + (size_t)row * (size_t)modes->rank_stride, modes->rank_stride);
}

/* The end of the run of positions from `first` on that are loaded in one of the parts, or in none of them. */
static int run_end(int first, int count, const uint64_t *touched, uint64_t parts)
{
  bool loaded = touched[first] & parts;
  int last = first + 1;
  while (last < count && !(touched[last] & parts) == !loaded)
    last++;
  return last;
}

/* Run by run of positions: a tooth is loaded during a part of the cycle, and each part of the loads during less. What
   is left out is zero, and a row of a product does not depend on the others: so it does not matter which load sets are
   asked for together. */
void eo_root_modes_stress(const struct eo_root_modes *modes, int count, int sets, const float *load,
                          const uint64_t *touched, float *scratch, float *stress)
{
  size_t rank = (size_t)modes->rank_stride, stride = (size_t)modes->shape_stride;
  memset(scratch, 0, sizeof *scratch * (size_t)(count * sets) * rank);
  for (int part = 0; part <= 2 * modes->reach; part++)
    for (int first = 0, last; first < count; first = last) {
      last = run_end(first, count, touched, (uint64_t)1 << part);
      if (touched[first] & (uint64_t)1 << part)
        add_part(modes, part, first, last, sets, load, scratch);
    }
  for (int first = 0, last; first < count; first = last) {
    size_t row = (size_t)first * sets;
    last = run_end(first, count, touched, ~(uint64_t)0);
    if (touched[first])
      modes->gram->multiply((last - first) * sets, modes->rank, modes->shape_stride, scratch + row * rank,
                            modes->rank_stride, modes->shape, modes->shape_stride, false, stress + row * stride,
                            modes->shape_stride);
  }
}
