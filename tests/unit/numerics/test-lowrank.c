/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Low-rank factor: remainders, exact ranks, refusals. */
#include "base/random.h"
#include "numerics/gram.h"
#include "numerics/lowrank.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

enum { N = 60 };

static double original[N * N], work[N * N];

/* A smooth kernel such as that of a tooth: its eigenvalues fall off geometrically. */
static void smooth(void)
{
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      original[i * N + j] = 1e-9 * exp(-pow((i - j) / 12.0, 2));
}

/* rank vectors of random numbers. */
static void random_rank(int rank)
{
  memset(original, 0, sizeof original);
  for (int k = 0; k < rank; k++)
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++)
        original[i * N + j] += (eo_random_unit(eo_random_at(3, 0, (uint64_t)k, (uint64_t)i), 0) - 0.5) *
                               (eo_random_unit(eo_random_at(3, 0, (uint64_t)k, (uint64_t)j), 0) - 0.5);
}

/* Largest diagonal entry of the remainder and largest entry beside it, over the largest diagonal entry of the matrix.
 */
static void remainder_of(const double *factor, int stride, double *diagonal, double *beside)
{
  double largest = 0;
  *diagonal = *beside = 0;
  for (int i = 0; i < N; i++)
    largest = fmax(largest, original[i * (N + 1)]);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      double rest = original[i * N + j];
      for (int k = 0; k < stride; k++)
        rest -= factor[i * stride + k] * factor[j * stride + k];
      if (i == j)
        *diagonal = fmax(*diagonal, fabs(rest) / largest);
      else
        *beside = fmax(*beside, fabs(rest) / largest);
    }
}

static int factor_rank(double tolerance)
{
  int rank = -1, stride = 0;
  double *factor = NULL, diagonal, beside;
  struct eo_error error;
  memcpy(work, original, sizeof work);
  enum eo_code code = eo_lowrank_factor(N, work, tolerance, &rank, &stride, &factor, &error);
  ok(code == EO_OK, "a matrix is factored to %.0e: rank %d", tolerance, rank);
  ok(stride % EO_GRAM_LANE == 0 && stride >= rank && stride - rank < EO_GRAM_LANE + (rank == 0),
     "the stride of the factor is %d", stride);
  remainder_of(factor, stride, &diagonal, &beside);
  ok(diagonal <= tolerance * (1 + 1e-9) + 1e-15 && beside <= diagonal + 1e-15,
     "the factor leaves %.1e on the diagonal, %.1e beside it", diagonal, beside);
  bool padded = true;
  for (int i = 0; i < N; i++)
    for (int k = rank; k < stride; k++)
      padded = padded && factor[i * stride + k] == 0;
  ok(padded, "the factor's rows are padded with zeros");
  free(factor);
  return rank;
}

static void refused(double value, int row, const char *what)
{
  int rank, stride;
  double *factor = NULL;
  struct eo_error error;
  smooth();
  memcpy(work, original, sizeof work);
  work[row * (N + 1)] = value;
  ok(eo_lowrank_factor(N, work, 1e-3, &rank, &stride, &factor, &error) == EO_ERROR_NUMERIC && !factor, "%s is refused",
     what);
}

int main(void)
{
  smooth();
  int coarse = factor_rank(1e-2), fine = factor_rank(1e-6);
  ok(coarse < fine && fine < N, "a finer tolerance takes more modes: %d < %d", coarse, fine);
  random_rank(5);
  ok(factor_rank(1e-10) == 5, "a matrix of rank 5 has rank 5");
  random_rank(17);
  ok(factor_rank(1e-10) == 17, "a matrix of rank 17 has rank 17");
  memset(original, 0, sizeof original);
  ok(factor_rank(1e-3) == 0, "a matrix of zeros has rank 0");
  refused(NAN, 3, "NaN on the diagonal");
  refused(INFINITY, 3, "an infinite entry");
  refused(-1e-12, N - 1, "a negative diagonal entry");
  return tap_done();
}
