/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/sparse.h"

#include "numerics/threads.h"

#include <cblas.h>
#include <cholmod.h>
#include <lapacke.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct eo_sparse_factor {
  cholmod_common common;
  const struct eo_sparse *matrix; /* borrowed, until factorised */
  cholmod_factor *pattern;        /* L, until factorised */
  int kept;
  int *keep;        /* [kept] */
  double *trailing; /* [kept][kept] by columns, lower triangle: L of the Schur complement in the order of keep */
  double entries;
};

/* METIS keeps a global random state and swaps signal handlers while it runs. */
static pthread_mutex_t metis_mutex = PTHREAD_MUTEX_INITIALIZER;

void eo_sparse_done(struct eo_sparse *matrix)
{
  if (!matrix)
    return;
  free(matrix->start);
  free(matrix->row);
  free(matrix->value);
  *matrix = (struct eo_sparse){0};
}

static enum eo_code solver_error(const cholmod_common *common, struct eo_error *error)
{
  if (common->status == CHOLMOD_OUT_OF_MEMORY)
    return eo_error_memory(error);
  if (common->status == CHOLMOD_TOO_LARGE)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The finite-element model is too large for the sparse solver.");
  return eo_error_set(error, EO_ERROR_NUMERIC, "", "The sparse solver failed (CHOLMOD status %d).", common->status);
}

static cholmod_sparse view_of(const struct eo_sparse *matrix)
{
  return (cholmod_sparse){.nrow = (size_t)matrix->n,
                          .ncol = (size_t)matrix->n,
                          .nzmax = (size_t)matrix->start[matrix->n],
                          .p = matrix->start,
                          .i = matrix->row,
                          .x = matrix->value,
                          .stype = -1,
                          .itype = CHOLMOD_INT,
                          .xtype = CHOLMOD_REAL,
                          .dtype = CHOLMOD_DOUBLE,
                          .sorted = 1,
                          .packed = 1};
}

/* Pattern of the groups: [groups + 1] starts and the rows of the strict lower triangle. */
static enum eo_code build_group_pattern(const struct eo_sparse *matrix, const int *group, int groups, int **start_out,
                                        int **row_out)
{
  int n = matrix->n, entries = matrix->start[n];
  int *first = calloc((size_t)groups + 1, sizeof *first), *member = malloc((size_t)(n + 1) * sizeof *member);
  int *mark = malloc((size_t)groups * sizeof *mark + 1), *start = calloc((size_t)groups + 1, sizeof *start);
  int *row = malloc((size_t)(entries + 1) * sizeof *row), filled = 0;
  enum eo_code code = EO_ERROR_MEMORY;
  if (!first || !member || !mark || !start || !row)
    goto out;
  for (int i = 0; i < n; i++)
    first[group[i] + 1]++;
  for (int g = 0; g < groups; g++)
    first[g + 1] += first[g];
  memcpy(start, first, ((size_t)groups + 1) * sizeof *start);
  for (int i = 0; i < n; i++)
    member[start[group[i]]++] = i;
  memset(start, 0, ((size_t)groups + 1) * sizeof *start);
  for (int g = 0; g < groups; g++)
    mark[g] = -1;
  for (int g = 0; g < groups; g++) {
    mark[g] = g;
    for (int k = first[g]; k < first[g + 1]; k++)
      for (int p = matrix->start[member[k]]; p < matrix->start[member[k] + 1]; p++) {
        int other = group[matrix->row[p]];
        if (other <= g || mark[other] == g)
          continue;
        mark[other] = g;
        row[filled++] = other;
      }
    start[g + 1] = filled;
  }
  *start_out = start;
  *row_out = row;
  start = row = NULL;
  code = EO_OK;
out:
  free(first);
  free(member);
  free(mark);
  free(start);
  free(row);
  return code;
}

/* Nested dissection of the groups; order[groups]. */
static enum eo_code order_groups(cholmod_common *common, const struct eo_sparse *matrix, const int *group, int groups,
                                 int *order, struct eo_error *error)
{
  int *start = NULL, *row = NULL;
  if (build_group_pattern(matrix, group, groups, &start, &row) != EO_OK)
    return eo_error_memory(error);
  cholmod_sparse pattern = {.nrow = (size_t)groups,
                            .ncol = (size_t)groups,
                            .nzmax = (size_t)start[groups],
                            .p = start,
                            .i = row,
                            .stype = -1,
                            .itype = CHOLMOD_INT,
                            .xtype = CHOLMOD_PATTERN,
                            .dtype = CHOLMOD_DOUBLE,
                            .sorted = 0,
                            .packed = 1};
  pthread_mutex_lock(&metis_mutex);
  int done = cholmod_metis(&pattern, NULL, 0, 1, order, common);
  pthread_mutex_unlock(&metis_mutex);
  free(start);
  free(row);
  return done ? EO_OK : solver_error(common, error);
}

/* The unknowns in the order of their groups, the kept ones last and in their own order; work[n + groups + 1]. */
static void spread_order(const struct eo_sparse_factor *factor, int n, const int *group, int groups, const int *order,
                         int *work, int *permutation)
{
  int *place = work, *next = work + n;
  memset(next, 0, ((size_t)groups + 1) * sizeof *next);
  for (int i = 0; i < n; i++)
    place[i] = 0;
  for (int k = 0; k < factor->kept; k++)
    place[factor->keep[k]] = 1;
  int *position = permutation; /* borrowed as the rank of a group while counting */
  for (int q = 0; q < groups; q++)
    position[order[q]] = q;
  for (int i = 0; i < n; i++)
    if (!place[i])
      next[position[group[i]] + 1]++;
  for (int q = 0; q < groups; q++)
    next[q + 1] += next[q];
  for (int i = 0; i < n; i++)
    place[i] = place[i] ? -1 : next[position[group[i]]]++;
  for (int i = 0; i < n; i++)
    if (place[i] >= 0)
      permutation[place[i]] = i;
  for (int k = 0; k < factor->kept; k++)
    permutation[n - factor->kept + k] = factor->keep[k];
}

enum eo_code eo_sparse_analyse(const struct eo_sparse *matrix, const int *group, int groups, const int *keep, int kept,
                               struct eo_sparse_factor **factor_out, struct eo_error *error)
{
  eo_threads_limit();
  int n = matrix->n;
  struct eo_sparse_factor *factor = calloc(1, sizeof *factor);
  int *order = malloc(((size_t)groups + 1) * sizeof *order),
      *permutation = malloc(((size_t)n + 1) * sizeof *permutation);
  int *work = malloc(((size_t)n + (size_t)groups + 1) * sizeof *work);
  enum eo_code code = EO_ERROR_MEMORY;
  if (!factor)
    goto out;
  cholmod_start(&factor->common);
  cholmod_common *common = &factor->common;
  common->print = 0;
  common->supernodal = CHOLMOD_SUPERNODAL;
  common->final_ll = 1;
  common->nmethods = 1;
  common->method[0].ordering = CHOLMOD_GIVEN;
  factor->matrix = matrix;
  factor->kept = kept;
  factor->keep = malloc(((size_t)kept + 1) * sizeof *keep);
  if (!order || !permutation || !work || !factor->keep)
    goto out;
  memcpy(factor->keep, keep, (size_t)kept * sizeof *keep);
  code = order_groups(common, matrix, group, groups, order, error);
  if (code != EO_OK)
    goto out;
  spread_order(factor, n, group, groups, order, work, permutation);
  cholmod_sparse view = view_of(matrix);
  factor->pattern = cholmod_analyze_p(&view, permutation, NULL, 0, common);
  if (!factor->pattern)
    code = solver_error(common, error);
out:
  if (code == EO_ERROR_MEMORY)
    eo_error_memory(error);
  free(order);
  free(permutation);
  free(work);
  if (code == EO_OK)
    *factor_out = factor;
  else
    eo_sparse_factor_free(factor);
  return code;
}

/* Copies the last columns of the supernodal L, in the order in which CHOLMOD left them. */
static void copy_trailing(const cholmod_factor *pattern, int n, int kept, double *trailing)
{
  const int *column = pattern->super, *index = pattern->pi, *offset = pattern->px, *rows = pattern->s;
  const double *value = pattern->x;
  int first = n - kept;
  for (int super = 0; super < (int)pattern->nsuper; super++) {
    int height = index[super + 1] - index[super];
    for (int c = column[super] < first ? first : column[super]; c < column[super + 1]; c++) {
      const double *source = value + offset[super] + (size_t)(c - column[super]) * (size_t)height;
      for (int r = 0; r < height; r++)
        if (rows[index[super] + r] >= c)
          trailing[(size_t)(c - first) * (size_t)kept + (size_t)(rows[index[super] + r] - first)] = source[r];
    }
  }
}

/* OpenBLAS lets NaN through without a word. */
static int pivots_are_good(const double *trailing, size_t kept)
{
  for (size_t k = 0; k < kept; k++)
    if (!(trailing[k * kept + k] > 0 && trailing[k * kept + k] < INFINITY))
      return 0;
  return 1;
}

/* The kept unknowns are one clique once all others are gone, so the post-ordering leaves them last and in order. */
static int order_was_kept(const struct eo_sparse_factor *factor)
{
  const int *permutation = factor->pattern->Perm;
  for (int k = 0; k < factor->kept; k++)
    if (permutation[factor->matrix->n - factor->kept + k] != factor->keep[k])
      return 0;
  return 1;
}

enum eo_code eo_sparse_factorise(struct eo_sparse_factor *factor, struct eo_error *error)
{
  eo_threads_limit();
  cholmod_common *common = &factor->common;
  cholmod_sparse view = view_of(factor->matrix);
  size_t kept = (size_t)factor->kept;
  if (!cholmod_factorize(&view, factor->pattern, common) && common->status != CHOLMOD_NOT_POSDEF)
    return solver_error(common, error);
  if (common->status == CHOLMOD_NOT_POSDEF || factor->pattern->minor < factor->pattern->n)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The stiffness matrix is not positive definite.");
  if (!order_was_kept(factor))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The stiffness matrix falls into separate parts.");
  factor->trailing = calloc(kept * kept + 1, sizeof *factor->trailing);
  if (!factor->trailing)
    return eo_error_memory(error);
  copy_trailing(factor->pattern, factor->matrix->n, factor->kept, factor->trailing);
  factor->entries = (double)factor->pattern->xsize;
  cholmod_free_factor(&factor->pattern, common);
  factor->matrix = NULL;
  if (!pivots_are_good(factor->trailing, kept))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The stiffness matrix holds numbers that are not finite.");
  return EO_OK;
}

enum eo_code eo_sparse_inverse(const struct eo_sparse_factor *factor, int loaded, double *inverse,
                               struct eo_error *error)
{
  int kept = factor->kept, first = kept - loaded;
  size_t height = (size_t)kept;
  if (!factor->trailing || loaded < 0 || loaded > kept)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The sparse solver was asked for more than it kept.");
  memset(inverse, 0, (size_t)loaded * height * sizeof *inverse);
  for (int j = 0; j < loaded; j++)
    inverse[(size_t)j * height + (size_t)(first + j)] = 1;
  /* L y = e touches only the rows from the first loaded unknown on. */
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, loaded, loaded, 1,
              factor->trailing + (size_t)first * height + (size_t)first, kept, inverse + first, kept);
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, kept, loaded, 1, factor->trailing, kept,
              inverse, kept);
  return EO_OK;
}

/* Unit loads on the last `loaded` of the first `inner` kept unknowns, solved with L_ii alone:
 * compliance[loaded][inner].
 */
static void solve_inner(const struct eo_sparse_factor *factor, int inner, int loaded, double *compliance)
{
  const double *trailing = factor->trailing;
  size_t height = (size_t)factor->kept, first = (size_t)(inner - loaded);
  memset(compliance, 0, (size_t)loaded * (size_t)inner * sizeof *compliance);
  for (size_t j = 0; j < (size_t)loaded; j++)
    compliance[j * (size_t)inner + first + j] = 1;
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, loaded, loaded, 1,
              trailing + first * height + first, factor->kept, compliance + first, inner);
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, inner, loaded, 1, trailing, factor->kept,
              compliance, inner);
}

enum eo_code eo_sparse_condense(const struct eo_sparse_factor *factor, int inner, int loaded, double *compliance,
                                double *influence, double *stiffness, struct eo_error *error)
{
  int outer = factor->kept - inner;
  size_t height = (size_t)factor->kept, rest = (size_t)outer;
  if (!factor->trailing || loaded < 0 || loaded > inner || outer < 0)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The sparse solver was asked for more than it kept.");
  const double *corner = factor->trailing + (size_t)inner * height + (size_t)inner;
  solve_inner(factor, inner, loaded, compliance);
  for (size_t j = 0; j < (size_t)inner; j++)
    memcpy(influence + j * rest, factor->trailing + j * height + (size_t)inner, rest * sizeof *influence);
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, outer, inner, 1, factor->trailing,
              factor->kept, influence, outer);
  for (size_t j = 0; j < rest; j++) {
    memset(stiffness + j * rest, 0, j * sizeof *stiffness);
    memcpy(stiffness + j * rest + j, corner + j * height + j, (rest - j) * sizeof *stiffness);
  }
  cblas_dtrmm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, outer, outer, 1, corner, factor->kept,
              stiffness, outer);
  for (size_t i = 0; i < rest; i++)
    for (size_t j = 0; j < i; j++)
      stiffness[i * rest + j] = stiffness[j * rest + i] = 0.5 * (stiffness[i * rest + j] + stiffness[j * rest + i]);
  return EO_OK;
}

double eo_sparse_entries(const struct eo_sparse_factor *factor)
{
  return factor->entries;
}

size_t eo_sparse_peak_memory(const struct eo_sparse_factor *factor)
{
  return factor->common.memory_usage;
}

void eo_sparse_factor_free(struct eo_sparse_factor *factor)
{
  if (!factor)
    return;
  if (factor->pattern)
    cholmod_free_factor(&factor->pattern, &factor->common);
  cholmod_finish(&factor->common);
  free(factor->keep);
  free(factor->trailing);
  free(factor);
}

enum eo_code eo_symmetric_extremes(int n, double *matrix, double *smallest, double *largest, struct eo_error *error)
{
  eo_threads_limit();
  double *value = malloc(((size_t)n + 1) * sizeof *value);
  if (!value)
    return eo_error_memory(error);
  int info = LAPACKE_dsyevd(LAPACK_ROW_MAJOR, 'N', 'U', n, matrix, n, value);
  if (!info) {
    *smallest = value[0];
    *largest = value[n - 1];
  }
  free(value);
  if (info)
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The eigenvalues of a compliance matrix did not converge.");
  return EO_OK;
}
