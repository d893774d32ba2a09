/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two chains side by side: the face between them is eliminated. */
#include "flexibility/chain_private.h"

#include "numerics/hermitian.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void eo_chain_done(struct eo_chain *chain)
{
  free(chain->left);
  free(chain->right);
  free(chain->across);
  free(chain->body[0]);
  free(chain->body[1]);
  *chain = (struct eo_chain){0};
}

enum eo_code eo_chain_init(struct eo_chain *chain, size_t n, struct eo_error *error)
{
  *chain = (struct eo_chain){
      .left = malloc(sizeof(double) * n * n),
      .right = malloc(sizeof(double) * n * n),
      .across = malloc(sizeof(double) * n * n),
      .body = {calloc(EO_CHAIN_PATTERNS * n, sizeof(double)), calloc(EO_CHAIN_PATTERNS * n, sizeof(double))}};
  if (chain->left && chain->right && chain->across && chain->body[0] && chain->body[1])
    return EO_OK;
  eo_chain_done(chain);
  return eo_error_memory(error);
}

void eo_chain_turn(const struct eo_ring_tooth *tooth, int t, double turn[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS])
{
  double angle = 2 * M_PI * (double)(t % tooth->teeth) / tooth->teeth, c = cos(angle), s = sin(angle);
  const double value[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS] = {{1, 0, 0}, {0, c, -s}, {0, s, c}};
  memcpy(turn, value, sizeof value);
}

void eo_chain_turn_body(const struct eo_ring_tooth *tooth, int t, const double *body, double *out)
{
  double turn[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS];
  size_t n = (size_t)tooth->face;
  eo_chain_turn(tooth, t, turn);
  for (int a = 0; a < EO_CHAIN_PATTERNS; a++)
    for (size_t i = 0; i < n; i++)
      out[(size_t)a * n + i] = turn[0][a] * body[i] + turn[1][a] * body[n + i] + turn[2][a] * body[2 * n + i];
}

void eo_chain_add_moved(const struct eo_ring_tooth *tooth, int t,
                        const double moved[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS],
                        double sum[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS])
{
  double turn[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS];
  eo_chain_turn(tooth, t, turn);
  for (int a = 0; a < EO_CHAIN_PATTERNS; a++)
    for (int b = 0; b < EO_CHAIN_PATTERNS; b++)
      for (int c = 0; c < EO_CHAIN_PATTERNS; c++)
        for (int d = 0; d < EO_CHAIN_PATTERNS; d++)
          sum[a][b] += turn[c][a] * moved[c][d] * turn[d][b];
}

static void mirror(size_t n, double *matrix)
{
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < j; i++)
      matrix[j * n + i] = matrix[i * n + j];
}

static enum eo_code advance(struct eo_chain_work *work, struct eo_error *error)
{
  double fraction = work->first + (work->last - work->first) * ++work->step / work->steps;
  if (eo_progress_report(work->progress, work->what, fraction))
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "The preparation of the flexibility was stopped.");
  return EO_OK;
}

/* Scratch of one merge: K and its factor, A_LR L^-T, L^-1 B_LR, and the forces on the face before and after L^-1. */
struct scratch {
  double *matrix, *before, *after, *body, *solved;
  double *turned[2]; /* the second chain's forces on its left, its right face as the first sees the patterns */
};

static void scratch_done(struct scratch *scratch)
{
  free(scratch->matrix);
  free(scratch->before);
  free(scratch->after);
  free(scratch->body);
  free(scratch->solved);
  free(scratch->turned[0]);
  free(scratch->turned[1]);
}

static enum eo_code scratch_init(struct scratch *scratch, size_t n, struct eo_error *error)
{
  const size_t patterns = EO_CHAIN_PATTERNS * n;
  *scratch = (struct scratch){
      .matrix = malloc(sizeof(double) * n * n),
      .before = malloc(sizeof(double) * n * n),
      .after = malloc(sizeof(double) * n * n),
      .body = malloc(sizeof(double) * patterns),
      .solved = malloc(sizeof(double) * patterns),
      .turned = {malloc(sizeof(double) * patterns), malloc(sizeof(double) * patterns)},
  };
  return scratch->matrix && scratch->before && scratch->after && scratch->body && scratch->solved &&
                 scratch->turned[0] && scratch->turned[1]
             ? EO_OK
             : eo_error_memory(error);
}

/* Eliminates the face between the two chains; out: fresh. */
static void combine(int n, const struct eo_chain *a, const struct eo_chain *b, struct scratch *scratch,
                    struct eo_chain *out)
{
  size_t size = (size_t)n * (size_t)n;
  memcpy(scratch->before, a->across, size * sizeof *scratch->before);
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, n, n, 1, scratch->matrix, n,
              scratch->before, n);
  memcpy(scratch->after, b->across, size * sizeof *scratch->after);
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n, n, 1, scratch->matrix, n,
              scratch->after, n);
  memcpy(scratch->solved, scratch->body, EO_CHAIN_PATTERNS * (size_t)n * sizeof *scratch->solved);
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n, EO_CHAIN_PATTERNS, 1,
              scratch->matrix, n, scratch->solved, n);
  memcpy(out->left, a->left, size * sizeof *out->left);
  memcpy(out->right, b->right, size * sizeof *out->right);
  memcpy(out->body[0], a->body[0], EO_CHAIN_PATTERNS * (size_t)n * sizeof(double));
  memcpy(out->body[1], scratch->turned[1], EO_CHAIN_PATTERNS * (size_t)n * sizeof(double));
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, n, n, -1, scratch->before, n, 1, out->left, n); /* theory (B8) */
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, n, -1, scratch->after, n, 1, out->right, n);
  mirror((size_t)n, out->left);
  mirror((size_t)n, out->right);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, n, n, -1, scratch->before, n, scratch->after, n, 0,
              out->across, n);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, EO_CHAIN_PATTERNS, n, -1, scratch->before, n,
              scratch->solved, n, 1, out->body[0], n);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, EO_CHAIN_PATTERNS, n, -1, scratch->after, n, scratch->solved,
              n, 1, out->body[1], n);
}

static enum eo_code merge(struct eo_chain_work *work, const struct eo_chain *a, const struct eo_chain *b,
                          struct scratch *scratch, struct eo_chain *out, struct eo_error *error)
{
  const struct eo_ring_tooth *tooth = work->tooth;
  int n = tooth->face;
  EO_TRY(scratch_init(scratch, (size_t)n, error));
  EO_TRY(eo_chain_init(out, (size_t)n, error));
  for (size_t i = 0; i < (size_t)n * (size_t)n; i++)
    scratch->matrix[i] = a->right[i] + b->left[i];
  for (int side = 0; side < 2; side++)
    eo_chain_turn_body(tooth, a->teeth, b->body[side], scratch->turned[side]);
  for (size_t i = 0; i < EO_CHAIN_PATTERNS * (size_t)n; i++)
    scratch->body[i] = a->body[1][i] + scratch->turned[0][i];
  if (eo_symmetric_factor(n, scratch->matrix))
    return eo_error_set(error, EO_ERROR_NUMERIC, "", "The stiffness of a chain of %d teeth is not positive definite.",
                        a->teeth + b->teeth);
  combine(n, a, b, scratch, out);
  out->teeth = a->teeth + b->teeth;
  memcpy(out->moved, a->moved, sizeof out->moved);
  eo_chain_add_moved(tooth, a->teeth, (const double(*)[EO_CHAIN_PATTERNS])b->moved, out->moved);
  for (int p = 0; p < EO_CHAIN_PATTERNS; p++)
    for (int q = 0; q < EO_CHAIN_PATTERNS; q++)
      out->moved[p][q] += cblas_ddot(n, scratch->solved + (size_t)p * (size_t)n, 1,
                                     scratch->solved + (size_t)q * (size_t)n, 1);
  return advance(work, error);
}

enum eo_code eo_chain_merge(struct eo_chain_work *work, const struct eo_chain *a, const struct eo_chain *b,
                            struct eo_chain *out, struct eo_chain_join *join, struct eo_error *error)
{
  struct scratch scratch;
  *out = (struct eo_chain){0};
  enum eo_code code = merge(work, a, b, &scratch, out, error);
  if (!code && join) {
    join->factor = scratch.matrix;
    join->body = scratch.body;
    scratch.matrix = scratch.body = NULL;
  }
  scratch_done(&scratch);
  return code;
}
