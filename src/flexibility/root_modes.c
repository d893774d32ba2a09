/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/root_modes.h"

#include "flexibility/flexibility_private.h"
#include "flexibility/root_field.h"
#include "numerics/dense.h"
#include "numerics/gram.h"
#include "numerics/lowrank.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Shapes of the stress, and what makes their coefficients of the loads on other teeth. */
struct shapes {
  int rank, stride; /* stride: rank, padded with zeros as the kernel wants it */
  float *passed;    /* [2 reach + 1][remote_rank][stride]: coefficients that `remote` makes, by distance */
  struct eo_root_field field;
};

struct eo_root_modes {
  const struct eo_flank_table *table;
  int reach; /* loads on pairs k - reach .. k + reach count */
  const struct eo_gram *gram;
  int member, length;                     /* length = nodes x EO_STRESSES */
  int remote_rank, remote_stride;         /* of the loads on other teeth; 0: they do not count */
  struct shapes shapes[EO_ROOT_CARRIERS]; /* [carrier]; those of the others alone are few */
  float *own;                             /* [flank.points][stride of EO_ROOT_ALL]: coefficients of the shapes */
  float *remote;                          /* [next.points][remote_stride] */
};

/* Influence rows below each other, Pa/N, from the root's first point on: those of the tooth itself, then those of the
   others from the pair furthest behind to the one furthest ahead. */
struct influence {
  int own, remote, others; /* rows: of the tooth itself, of one other tooth; how many others there are */
  int rows, length;
  double *row;                      /* [rows][length] */
  double *gram;                     /* [rows][rows]: their products, until the modes are found */
  double *others_gram;              /* those of the others alone, until then */
  double *far;                      /* [remote][remote]: products over all distances, until the numbers are found */
  double largest;                   /* of the products */
  double *factor[EO_ROOT_CARRIERS]; /* of what a carrier's rows are in its shapes: [its rows][stride] */
  int factor_stride[EO_ROOT_CARRIERS];
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

/* What is needed of the products once the modes have taken their place. */
static void copy_products(struct influence *influence)
{
  size_t n = (size_t)influence->remote, rows = (size_t)influence->rows, own = (size_t)influence->own;
  for (size_t i = 0; i < rows; i++)
    influence->largest = fmax(influence->largest, influence->gram[i * rows + i]);
  for (size_t i = own; i < rows; i++)
    memcpy(influence->others_gram + (i - own) * (rows - own), influence->gram + i * rows + own,
           sizeof *influence->gram * (rows - own));
  for (int other = 0; other < influence->others; other++) {
    size_t first = own + (size_t)other * n;
    for (size_t i = 0; i < n * n; i++)
      influence->far[i] += influence->gram[(first + i / n) * rows + first + i % n];
  }
}

static enum eo_code stack_rows(struct influence *influence, const struct eo_root_modes *modes, size_t skip,
                               struct eo_error *error)
{
  int others = 2 * modes->reach, own = modes->table->flank.points, remote = modes->table->next.points;
  size_t rows = (size_t)own + (size_t)others * (size_t)remote, length = (size_t)modes->length;
  *influence =
      (struct influence){.own = own, .remote = remote, .others = others, .rows = (int)rows, .length = modes->length};
  influence->row = malloc(sizeof(double) * rows * length);
  influence->gram = malloc(sizeof(double) * rows * rows);
  influence->others_gram = malloc(sizeof(double) * (rows - (size_t)own) * (rows - (size_t)own) + 1);
  influence->far = calloc((size_t)remote * (size_t)remote + 1, sizeof(double));
  if (!influence->row || !influence->gram || !influence->others_gram || !influence->far)
    return eo_error_memory(error);
  copy_rows(modes, 0, skip, influence->row);
  for (int i = 0; i < others; i++)
    copy_rows(modes, behind_or_ahead(modes, i), skip, influence->row + (size_t)(own + i * remote) * length);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, influence->rows, influence->rows, influence->length, 1,
              influence->row, influence->length, influence->row, influence->length, 0, influence->gram,
              influence->rows);
  copy_products(influence);
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

/* Of squares, of the largest influence there is; of the others less, since several carry at once. */
static const double TOLERANCE[EO_ROOT_CARRIERS] = {[EO_ROOT_ALL] = 3e-6, [EO_ROOT_OTHERS] = 3e-7};
static const double REMOTE_TOLERANCE = 1e-8; /* of the largest influence, as the others */
static const double MOST_LEFT_OUT = 0.5;     /* of what is taken apart: one shape stays, however small all are */

static int first_row(const struct influence *influence, enum eo_root_carriers carriers)
{
  return carriers == EO_ROOT_ALL ? 0 : influence->own;
}

static enum eo_code fit_shapes(struct eo_root_modes *modes, const struct influence *influence,
                               enum eo_root_carriers carriers, struct eo_error *error)
{
  struct shapes *shapes = &modes->shapes[carriers];
  size_t length = (size_t)modes->length, size = (size_t)shapes->rank * length;
  int first = first_row(influence, carriers);
  double *shape = malloc(sizeof *shape * size + 1);
  enum eo_code code = shape ? EO_OK : eo_error_memory(error);
  if (!code)
    code = fit(influence->rows - first, shapes->rank, influence->factor_stride[carriers], influence->factor[carriers],
               modes->length, modes->length, influence->row + (size_t)first * length, shape, error);
  if (!code)
    code = eo_root_field_init(&shapes->field, shapes->rank, modes->length / EO_STRESSES, shape, error);
  free(shape);
  return code;
}

/* gram: the products of the carriers' rows; destroyed. */
static enum eo_code find_shapes(struct eo_root_modes *modes, struct influence *influence,
                                enum eo_root_carriers carriers, double *gram, struct eo_error *error)
{
  struct shapes *shapes = &modes->shapes[carriers];
  int rows = influence->rows - first_row(influence, carriers);
  double most = 0;
  for (size_t i = 0; i < (size_t)rows; i++)
    most = fmax(most, gram[i * (size_t)rows + i]);
  EO_TRY(eo_lowrank_factor(rows, gram, fmin(TOLERANCE[carriers] * influence->largest / most, MOST_LEFT_OUT),
                           &shapes->rank, &influence->factor_stride[carriers], &influence->factor[carriers], error));
  shapes->stride = padded(shapes->rank);
  return fit_shapes(modes, influence, carriers, error);
}

/* What each distance makes of the remote numbers, in coefficients of the shapes. */
static enum eo_code fit_distances(struct eo_root_modes *modes, const struct influence *influence,
                                  enum eo_root_carriers carriers, int remote_stride, const double *remote,
                                  struct eo_error *error)
{
  struct shapes *shapes = &modes->shapes[carriers];
  int rank = modes->remote_rank, stride = influence->factor_stride[carriers],
      first = influence->own - first_row(influence, carriers);
  double *x = malloc(sizeof *x * (size_t)rank * (size_t)shapes->rank);
  shapes->passed = make_floats((2 * modes->reach + 1) * rank, shapes->stride);
  enum eo_code code = x && shapes->passed ? EO_OK : eo_error_memory(error);
  for (int other = 0; other < influence->others && !code; other++) {
    const double *of_other = influence->factor[carriers] + (size_t)(first + other * influence->remote) * (size_t)stride;
    int distance = behind_or_ahead(modes, other) + modes->reach;
    code = fit(influence->remote, rank, remote_stride, remote, shapes->rank, stride, of_other, x, error);
    for (int i = 0; i < rank * shapes->rank && !code; i++)
      shapes->passed[(size_t)(distance * rank + i / shapes->rank) * (size_t)shapes->stride + i % shapes->rank] =
          (float)x[i];
  }
  free(x);
  return code;
}

/* Numbers that tell the loads on other teeth apart as far as the shapes do: left out is as little. */
static enum eo_code find_remote(struct eo_root_modes *modes, const struct influence *influence, struct eo_error *error)
{
  size_t n = (size_t)influence->remote;
  double *remote = NULL, most = 0;
  int stride = 0;
  for (size_t i = 0; i < n; i++)
    most = fmax(most, influence->far[i * n + i]);
  enum eo_code code = eo_lowrank_factor((int)n, influence->far,
                                        fmin(REMOTE_TOLERANCE * influence->largest / most, MOST_LEFT_OUT),
                                        &modes->remote_rank, &stride, &remote, error);
  modes->remote_stride = padded(modes->remote_rank);
  if (!code)
    code = keep_rows(&modes->remote, (int)n, modes->remote_rank, stride, remote, modes->remote_stride, error);
  for (int carriers = 0; carriers < EO_ROOT_CARRIERS && !code; carriers++)
    code = fit_distances(modes, influence, (enum eo_root_carriers)carriers, stride, remote, error);
  free(remote);
  return code;
}

/* skip: stresses before the root's first point. */
static enum eo_code find_modes(struct eo_root_modes *modes, size_t skip, struct influence *influence,
                               struct eo_error *error)
{
  const struct shapes *shapes = &modes->shapes[EO_ROOT_ALL];
  EO_TRY(stack_rows(influence, modes, skip, error));
  EO_TRY(find_shapes(modes, influence, EO_ROOT_ALL, influence->gram, error));
  EO_TRY(keep_rows(&modes->own, influence->own, shapes->rank, influence->factor_stride[EO_ROOT_ALL],
                   influence->factor[EO_ROOT_ALL], shapes->stride, error));
  if (!modes->reach)
    return EO_OK;
  EO_TRY(find_shapes(modes, influence, EO_ROOT_OTHERS, influence->others_gram, error));
  return find_remote(modes, influence, error);
}

enum eo_code eo_root_modes_new(struct eo_root_modes **result, const struct eo_flexibility *flexibility, int member,
                               struct eo_error *error)
{
  struct eo_root root = eo_flexibility_root(flexibility, member);
  struct eo_root_modes *modes = calloc(1, sizeof *modes);
  struct influence influence = {0};
  if (!modes)
    return eo_error_memory(error);
  modes->table = &flexibility->table[member];
  modes->reach = flexibility->settings.neighbour_coupling ? modes->table->reach : 0;
  modes->gram = eo_gram_select();
  modes->member = member;
  modes->length = (root.points - root.first) * (root.layers + 1) * EO_STRESSES;
  enum eo_code code = find_modes(modes, (size_t)root.first * (root.layers + 1) * EO_STRESSES, &influence, error);
  free(influence.row);
  free(influence.gram);
  free(influence.others_gram);
  free(influence.far);
  for (int carriers = 0; carriers < EO_ROOT_CARRIERS; carriers++)
    free(influence.factor[carriers]);
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
  for (int carriers = 0; carriers < EO_ROOT_CARRIERS; carriers++) {
    free(modes->shapes[carriers].passed);
    eo_root_field_done(&modes->shapes[carriers].field);
  }
  free(modes);
}

int eo_root_modes_reach(const struct eo_root_modes *modes)
{
  return modes->reach;
}

int eo_root_modes_stride(const struct eo_root_modes *modes, enum eo_root_carriers carriers)
{
  return modes->shapes[carriers].stride;
}

int eo_root_modes_remote_stride(const struct eo_root_modes *modes)
{
  return modes->remote_stride;
}

int eo_root_modes_room(const struct eo_root_modes *modes)
{
  int all = modes->shapes[EO_ROOT_ALL].field.columns, others = modes->shapes[EO_ROOT_OTHERS].field.columns;
  return all > others ? all : others;
}

/* Of `count` times `rank` numbers the ones that the rows of vectors[rank][rank] make of them; the numbers lie a step
   apart. row[rank]: scratch. */
static void turn(int rank, const double *vectors, int count, int next, int step, float *number, double *row)
{
  for (int i = 0; i < count; i++, number += next) {
    for (int r = 0; r < rank; r++)
      row[r] = number[r * step];
    for (int r = 0; r < rank; r++)
      number[r * step] = (float)cblas_ddot(rank, vectors + r * rank, 1, row, 1);
  }
}

enum eo_code eo_root_modes_turn(struct eo_root_modes *modes, const double *moment, struct eo_error *error)
{
  struct shapes *shapes = &modes->shapes[EO_ROOT_ALL];
  int rank = shapes->rank, stride = shapes->stride;
  double *vectors = malloc(sizeof *vectors * (size_t)rank * (size_t)rank),
         *values = malloc(sizeof *values * (size_t)rank);
  enum eo_code code = vectors && values ? EO_OK : eo_error_memory(error);
  for (int i = 0; i < rank && !code; i++) /* minus: largest first */
    for (int k = 0; k < rank; k++)
      vectors[i * rank + k] = -moment[i < k ? i * stride + k : k * stride + i];
  if (!code && eo_dense_symmetric_eigen(rank, vectors, values))
    code = eo_error_set(error, EO_ERROR_NUMERIC, NULL, "the shapes of the root stress cannot be put in order");
  if (!code) {
    turn(rank, vectors, modes->table->flank.points, stride, 1, modes->own, values);
    if (shapes->passed)
      turn(rank, vectors, (2 * modes->reach + 1) * modes->remote_rank, stride, 1, shapes->passed, values);
    int span = shapes->field.columns / shapes->field.blocks;
    for (int block = 0; block < shapes->field.blocks; block++)
      turn(rank, vectors, span, 1, span, eo_root_field_block(&shapes->field, block), values);
    eo_root_field_bound(&shapes->field);
  }
  free(vectors);
  free(values);
  return code;
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
  weigh(&modes->table->flank, point->s[modes->member], point->eta, modes->shapes[EO_ROOT_ALL].stride, modes->own, own);
}

void eo_root_modes_remote(const struct eo_root_modes *modes, const struct eo_flank_point *point, float *remote)
{
  weigh(&modes->table->next, point->s[modes->member], point->eta, modes->remote_stride, modes->remote, remote);
}

void eo_root_modes_add(const struct eo_root_modes *modes, int loads, int n, const float *force, int force_stride,
                       const float *row, int stride, float *sum, int sum_stride)
{
  modes->gram->multiply(loads, n, stride, force, force_stride, row, stride, true, sum, sum_stride);
}

void eo_root_modes_pass(const struct eo_root_modes *modes, enum eo_root_carriers carriers, int ahead_by, int count,
                        const float *remote, float *coefficient)
{
  const struct shapes *shapes = &modes->shapes[carriers];
  long size = (long)modes->remote_rank * shapes->stride;
  int distance = ahead_by + modes->reach;
  modes->gram->multiply(count, modes->remote_rank, shapes->stride, remote, modes->remote_stride,
                        shapes->passed + distance * size, shapes->stride, true, coefficient, shapes->stride);
}

void eo_root_modes_find_largest(const struct eo_root_modes *modes, enum eo_root_carriers carriers, int count,
                                const float *coefficient, float *room, double *largest, int *node)
{
  const struct shapes *shapes = &modes->shapes[carriers];
  eo_root_field_find_largest(&shapes->field, modes->gram, count, coefficient, shapes->stride, room, largest, node);
}
