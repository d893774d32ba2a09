/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of an inverse through the Schur complement, against a dense inverse; matrices that must be refused. */
#include "numerics/sparse.h"
#include "support/tap.h"

#include <lapacke.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

/* A chain of blocks of three unknowns on a grid of `side` x `side` nodes: the Laplacian of the grid, coupled between
   directions. */
enum { SIDE = 9, NODES = SIDE * SIDE, N = 3 * NODES, KEPT = 20, LOADED = 8 };

static double entry(int row, int column, double shift)
{
  int a = row / 3, b = column / 3, dx = abs(a % SIDE - b % SIDE), dy = abs(a / SIDE - b / SIDE);
  double link = row % 3 == column % 3 ? 1 : 0.2;
  if (a == b)
    return row == column ? 4 + shift + 0.01 * a : 0.5;
  return dx + dy == 1 ? -link : 0;
}

static void fill(struct eo_sparse *matrix, int *group, double shift)
{
  int filled = 0;
  *matrix = (struct eo_sparse){.n = N,
                               .start = malloc((N + 1) * sizeof(int)),
                               .row = malloc(N * 20 * sizeof(int)),
                               .value = malloc(N * 20 * sizeof(double))};
  for (int j = 0; j < N; j++) {
    group[j] = j / 3;
    matrix->start[j] = filled;
    for (int i = j; i < N; i++)
      if (entry(i, j, shift) != 0) {
        matrix->row[filled] = i;
        matrix->value[filled++] = entry(i, j, shift);
      }
  }
  matrix->start[N] = filled;
}

static enum eo_code invert(double shift, const int *keep, double *inverse, struct eo_error *error)
{
  struct eo_sparse matrix;
  struct eo_sparse_factor *factor = NULL;
  static __thread int group[N];
  fill(&matrix, group, shift);
  enum eo_code code = eo_sparse_analyse(&matrix, group, NODES, keep, KEPT, &factor, error);
  if (!code)
    code = eo_sparse_factorise(factor, error);
  if (!code)
    code = eo_sparse_inverse(factor, LOADED, inverse, error);
  eo_sparse_factor_free(factor);
  eo_sparse_done(&matrix);
  return code;
}

static void choose(int *keep)
{
  for (int k = 0; k < KEPT; k++)
    keep[k] = (k * 37 + 5) % N;
}

struct run {
  double inverse[LOADED * KEPT];
  enum eo_code code;
};

static void *run_thread(void *context)
{
  struct run *run = context;
  int keep[KEPT];
  choose(keep);
  for (int i = 0; i < 5; i++)
    run->code = invert(3, keep, run->inverse, NULL);
  return NULL;
}

static void on_signal(int number)
{
  (void)number;
}

static void check_threads(void)
{
  enum { THREADS = 4 };
  static struct run run[THREADS];
  pthread_t thread[THREADS];
  struct sigaction action = {.sa_handler = on_signal}, after;
  sigaction(SIGTERM, &action, NULL);
  for (int i = 0; i < THREADS; i++)
    pthread_create(&thread[i], NULL, run_thread, &run[i]);
  int same = 1;
  for (int i = 0; i < THREADS; i++) {
    pthread_join(thread[i], NULL);
    same = same && !run[i].code && !memcmp(run[i].inverse, run[0].inverse, sizeof run[0].inverse);
  }
  ok(same, "%d threads at once find the same bits", THREADS);
  sigaction(SIGTERM, NULL, &after);
  ok(after.sa_handler == on_signal, "the handler of SIGTERM is still ours");
}

int main(void)
{
  static double dense[N * N], inverse[LOADED * KEPT];
  int keep[KEPT], pivot[N];
  struct eo_error error = {0};
  choose(keep);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      dense[i * N + j] = entry(i, j, 3);
  LAPACKE_dgetrf(LAPACK_ROW_MAJOR, N, N, dense, N, pivot);
  LAPACKE_dgetri(LAPACK_ROW_MAJOR, N, dense, N, pivot);
  ok(invert(3, keep, inverse, &error) == EO_OK, "the grid is solved");
  double worst = 0;
  for (int j = 0; j < LOADED; j++)
    for (int k = 0; k < KEPT; k++)
      worst = fmax(worst, fabs(inverse[j * KEPT + k] - dense[keep[k] * N + keep[KEPT - LOADED + j]]));
  ok(worst < 1e-13, "the inverse of the grid is that of the dense matrix: %.2e", worst);
  ok(invert(-6, keep, inverse, &error) == EO_ERROR_NUMERIC && strstr(error.text, "positive definite"),
     "an indefinite matrix is refused: %s", error.text);
  ok(invert(NAN, keep, inverse, &error) == EO_ERROR_NUMERIC, "NaN is refused: %s", error.text);
  check_threads();
  double small[9] = {2, 1, 0, 1, 2, 0, 0, 0, 5}, low, high;
  ok(!eo_symmetric_extremes(3, small, &low, &high, &error), "the eigenvalues of a small matrix are found");
  close_to(low, 1, 1e-14, "smallest eigenvalue of a small matrix");
  close_to(high, 5, 1e-14, "largest eigenvalue of a small matrix");
  return tap_done();
}
