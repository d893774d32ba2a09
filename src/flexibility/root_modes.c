/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/root_modes.h"

#include "flexibility/prepared.h"
#include "numerics/gram.h"
#include "numerics/lowrank.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct eo_root_modes {
  const struct eo_flank_table *table;
  int reach; /* loads on pairs k - reach .. k + reach count */
  const struct eo_gram *gram;
  int member, rank, length;       /* length = nodes x EO_STRESSES */
  int rank_stride, shape_stride;  /* rank and length, padded with zeros as the kernel wants them */
  int remote_rank, remote_stride; /* of the loads on other teeth; 0: they do not count */
  float *own;                     /* [flank.points][rank_stride]: coefficients of the shapes */
  float *remote;                  /* [next.points][remote_stride] */
  float *passed;                  /* [2 reach + 1][remote_rank][rank_stride]: those that `remote` makes, by distance */
  float *shape;                   /* [rank][shape_stride]: [EO_STRESSES][nodes] */
};

/* Influence rows below each other, Pa/N, from the root's first point on: those of the tooth itself, then those of the
   others from the pair furthest behind to the one furthest ahead. */
struct influence {
  int own, remote, others; /* rows: of the tooth itself, of one other tooth; how many others there are */
  int rows, length;
  double *row;  /* [rows][length] */
  double *gram; /* [rows][rows]: their products */
};

static int behind_or_ahead(const struct eo_root_modes *modes, int other)
{
  return other < modes->reach ? other - modes->reach : other - modes->reach + 1;
}

static void copy_rows(const struct eo_root_modes *modes, int ahead_by, size_t skip, double *to)
{
  const struct eo_grid *grid;
  const double *row = eo_flank_table_stress(modes->table, ahead_by, &grid) + skip;
  for (int i = 0; i < grid->points; i++, to += modes->length, row += modes->table->stresses)
    memcpy(to, row, sizeof *to * (size_t)modes->length);
}

static enum eo_code stack_rows(struct influence *influence, const struct eo_root_modes *modes, size_t skip,
                               struct eo_error *error)
{
  int others = 2 * modes->reach, own = modes->table->flank.points, remote = modes->table->next.points;
  size_t rows = (size_t)own + (size_t)others * (size_t)remote, length = (size_t)modes->length;
  *influence = (struct influence){own, remote, others, (int)rows, modes->length, NULL, NULL};
  influence->row = malloc(sizeof(double) * rows * length);
  influence->gram = malloc(sizeof(double) * rows * rows);
  if (!influence->row || !influence->gram)
    return eo_error_memory(error);
  copy_rows(modes, 0, skip, influence->row);
  for (int i = 0; i < others; i++)
    copy_rows(modes, behind_or_ahead(modes, i), skip, influence->row + (size_t)(own + i * remote) * length);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, influence->rows, influence->rows, influence->length, 1,
              influence->row, influence->length, influence->row, influence->length, 0, influence->gram,
              influence->rows);
  return EO_OK;
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

static enum eo_code keep_rows(float **kept, int rows, int columns, int from_stride, const double *from, int stride,
                              struct eo_error *error)
{
  *kept = make_floats(rows, stride);
  for (int i = 0; *kept && i < rows; i++)
    for (int r = 0; r < columns; r++)
      (*kept)[i * stride + r] = (float)from[i * from_stride + r];
  return *kept ? EO_OK : eo_error_memory(error);
}

/* x[rank][columns] with factor[rows][stride] x = rhs[rows][rhs_stride] in the least-squares sense: (factor' factor) x =
   factor' rhs. */
static enum eo_code fit(int rows, int rank, int stride, const double *factor, int columns, int rhs_stride,
                        const double *rhs, double *x, struct eo_error *error)
{
  double *normal = malloc(sizeof *normal * (size_t)rank * (size_t)rank);
  if (!normal)
    return eo_error_memory(error);
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, columns, rows, 1, factor, stride, rhs, rhs_stride, 0, x,
              columns);
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, rank, rank, rows, 1, factor, stride, factor, stride, 0, normal,
              rank);
  enum eo_code code = eo_lowrank_solve(rank, normal, columns, x, error);
  free(normal);
  return code;
}

static enum eo_code fit_shapes(struct eo_root_modes *modes, const struct influence *influence, int stride,
                               const double *factor, struct eo_error *error)
{
  int rank = modes->rank;
  size_t length = (size_t)modes->length, size = (size_t)rank * length;
  double *shape = malloc(sizeof *shape * size);
  modes->shape_stride = padded(modes->length);
  modes->shape = make_floats(rank, modes->shape_stride);
  enum eo_code code = shape && modes->shape ? EO_OK : eo_error_memory(error);
  if (!code)
    code = fit(influence->rows, rank, stride, factor, modes->length, modes->length, influence->row, shape, error);
  for (size_t i = 0; !code && i < size; i++) {
    size_t row = i / length, node = i % length / EO_STRESSES, part = i % EO_STRESSES;
    modes->shape[row * (size_t)modes->shape_stride + part * (length / EO_STRESSES) + node] = (float)shape[i];
  }
  free(shape);
  return code;
}

/* Of squares, of the largest influence there is. */
static const double TOLERANCE = 3e-6;

static double largest_diagonal(const struct influence *influence)
{
  double largest = 0;
  for (size_t i = 0, n = (size_t)influence->rows; i < n; i++)
    largest = fmax(largest, influence->gram[i * n + i]);
  return largest;
}

/* gram[remote][remote]: products of the influences that a point of another tooth has, over all distances. */
static void add_remote_products(const struct influence *influence, double *gram)
{
  size_t n = (size_t)influence->remote, rows = (size_t)influence->rows;
  memset(gram, 0, sizeof *gram * n * n);
  for (int other = 0; other < influence->others; other++) {
    size_t first = (size_t)influence->own + (size_t)other * n;
    for (size_t i = 0; i < n * n; i++)
      gram[i] += influence->gram[(first + i / n) * rows + first + i % n];
  }
}

/* What each distance makes of the remote numbers, in coefficients of the shapes: factor[rows][stride]. */
static enum eo_code fit_distances(struct eo_root_modes *modes, const struct influence *influence, int remote_stride,
                                  const double *remote, int stride, const double *factor, struct eo_error *error)
{
  int rank = modes->remote_rank;
  double *x = malloc(sizeof *x * (size_t)rank * (size_t)modes->rank);
  modes->passed = make_floats((2 * modes->reach + 1) * rank, modes->rank_stride);
  enum eo_code code = x && modes->passed ? EO_OK : eo_error_memory(error);
  for (int other = 0; other < influence->others && !code; other++) {
    const double *of_other = factor + (size_t)(influence->own + other * influence->remote) * (size_t)stride;
    int distance = behind_or_ahead(modes, other) + modes->reach;
    code = fit(influence->remote, rank, remote_stride, remote, modes->rank, stride, of_other, x, error);
    for (int i = 0; i < rank * modes->rank && !code; i++)
      modes->passed[(size_t)(distance * rank + i / modes->rank) * (size_t)modes->rank_stride + i % modes->rank] =
          (float)x[i];
  }
  free(x);
  return code;
}

/* Numbers that tell the loads on other teeth apart as far as the shapes do: left out is as little. largest: of the
   products of all influences. */
static enum eo_code find_remote(struct eo_root_modes *modes, const struct influence *influence, double largest,
                                int stride, const double *factor, struct eo_error *error)
{
  size_t n = (size_t)influence->remote;
  double *gram = malloc(sizeof *gram * n * n), *remote = NULL, most = 0;
  int remote_stride = 0;
  if (!gram)
    return eo_error_memory(error);
  add_remote_products(influence, gram);
  for (size_t i = 0; i < n; i++)
    most = fmax(most, gram[i * n + i]);
  enum eo_code code = eo_lowrank_factor((int)n, gram, fmin(1e-8 * largest / most, 0.5), &modes->remote_rank,
                                        &remote_stride, &remote, error);
  modes->remote_stride = padded(modes->remote_rank);
  if (!code)
    code = keep_rows(&modes->remote, (int)n, modes->remote_rank, remote_stride, remote, modes->remote_stride, error);
  if (!code)
    code = fit_distances(modes, influence, remote_stride, remote, stride, factor, error);
  free(gram);
  free(remote);
  return code;
}

/* skip: stresses before the root's first point. */
static enum eo_code find_modes(struct eo_root_modes *modes, size_t skip, struct influence *influence, double **factor,
                               struct eo_error *error)
{
  int stride = 0;
  EO_TRY(stack_rows(influence, modes, skip, error));
  double largest = largest_diagonal(influence);
  EO_TRY(eo_lowrank_factor(influence->rows, influence->gram, TOLERANCE, &modes->rank, &stride, factor, error));
  modes->rank_stride = padded(modes->rank);
  EO_TRY(fit_shapes(modes, influence, stride, *factor, error));
  EO_TRY(keep_rows(&modes->own, influence->own, modes->rank, stride, *factor, modes->rank_stride, error));
  return modes->reach ? find_remote(modes, influence, largest, stride, *factor, error) : EO_OK;
}

enum eo_code eo_root_modes_new(struct eo_root_modes **result, const struct eo_flexibility *flexibility, int member,
                               struct eo_error *error)
{
  struct eo_root root = eo_flexibility_root(flexibility, member);
  struct eo_root_modes *modes = calloc(1, sizeof *modes);
  struct influence influence = {0};
  double *factor = NULL;
  if (!modes)
    return eo_error_memory(error);
  modes->table = &flexibility->table[member];
  modes->reach = flexibility->settings.neighbour_coupling ? modes->table->reach : 0;
  modes->gram = eo_gram_select();
  modes->member = member;
  modes->length = (root.points - root.first) * (root.layers + 1) * EO_STRESSES;
  enum eo_code code = find_modes(modes, (size_t)root.first * (root.layers + 1) * EO_STRESSES, &influence, &factor,
                                 error);
  free(influence.row);
  free(influence.gram);
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
  free(modes->own);
  free(modes->remote);
  free(modes->passed);
  free(modes->shape);
  free(modes);
}

int eo_root_modes_reach(const struct eo_root_modes *modes)
{
  return modes->reach;
}

int eo_root_modes_stride(const struct eo_root_modes *modes)
{
  return modes->rank_stride;
}

int eo_root_modes_remote_stride(const struct eo_root_modes *modes)
{
  return modes->remote_stride;
}

int eo_root_modes_stress_stride(const struct eo_root_modes *modes)
{
  return modes->shape_stride;
}

int eo_root_modes_nodes(const struct eo_root_modes *modes)
{
  return modes->length / EO_STRESSES;
}

/* row[stride]: the sixteen rows of from[][stride] that count at a point, by their weights. */
static void weigh(const struct eo_grid *grid, double s, double eta, int stride, const float *from, float *row)
{
  struct eo_grid_weights at;
  eo_grid_weights(grid, s, eta, &at);
  for (int i = 0; i < stride; i++) {
    double sum = 0;
    for (int r = 0; r < EO_SPLINE_WIDTH; r++)
      for (int l = 0; l < EO_SPLINE_WIDTH; l++)
        sum += at.weight[EO_SPLINE_WIDTH * r + l] * (double)from[(at.first + r * grid->eta.count + l) * stride + i];
    row[i] = (float)sum;
  }
}

void eo_root_modes_own(const struct eo_root_modes *modes, const struct eo_flank_point *point, float *own)
{
  weigh(&modes->table->flank, point->s[modes->member], point->eta, modes->rank_stride, modes->own, own);
}

void eo_root_modes_remote(const struct eo_root_modes *modes, const struct eo_flank_point *point, float *remote)
{
  weigh(&modes->table->next, point->s[modes->member], point->eta, modes->remote_stride, modes->remote, remote);
}

void eo_root_modes_add(const struct eo_root_modes *modes, int n, const float *force, const float *row, int stride,
                       float *sum)
{
  modes->gram->multiply(1, n, stride, force, n, row, stride, true, sum, stride);
}

void eo_root_modes_pass(const struct eo_root_modes *modes, int ahead_by, int count, const float *remote,
                        float *coefficient)
{
  long size = (long)modes->remote_rank * modes->rank_stride;
  int distance = ahead_by + modes->reach;
  modes->gram->multiply(count, modes->remote_rank, modes->rank_stride, remote, modes->remote_stride,
                        modes->passed + distance * size, modes->rank_stride, true, coefficient, modes->rank_stride);
}

void eo_root_modes_stress(const struct eo_root_modes *modes, int count, const float *coefficient, float *stress)
{
  modes->gram->multiply(count, modes->rank, modes->shape_stride, coefficient, modes->rank_stride, modes->shape,
                        modes->shape_stride, false, stress, modes->shape_stride);
}
