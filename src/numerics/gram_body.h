/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernel for one width of vectors, compiled once per version: the file that includes this one says
   VERSION, NAME        what the version is called
   TARGET               what the processor must have
   WIDTH                doubles in a vector; there are twice as many floats in one
   SPLAT, SPLAT_FLOAT   a vector of equal numbers
   WIDEN                WIDTH floats of the memory as doubles
   MADD, MADD_FLOAT     a b + c
   ANY, ANY_FLOAT       a lane of the mask is set, of doubles and of floats
   APPLY_ROWS           rows of a product with a vector at a time
   GATHER_UNITS         sets of eight sums over points at a time
   TILE_ROWS, TILE_LANES  rows and vectors of a product of matrices at a time
   FEW_LANES            vectors at a time of the few rows that are left
   so that the sums of an inner loop stay in registers. Every sum is taken in the same order whatever the width, so
   versions that round alike (avx2 and avx512: MADD rounds once) give the same bytes. */
#include "numerics/gram_private.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum {
  UNIT = 8,
  PARTS = UNIT / WIDTH,
  PARTS_OF_FOUR = WIDTH / 4,
  FLOATS = 2 * WIDTH,
  PIVOTS = 4,
  SOLVE_LANES = WIDTH == 8 ? 3 : 6,
  FEW_ROWS = 3, /* one end under as many torques */
  ROW_LANES = 6
};

/* A pivot above it is infinite, but for rounding. */
static const float LARGEST_PIVOT = 3e38f;

typedef double lane __attribute__((vector_size(8 * WIDTH), aligned(8 * WIDTH), may_alias));
typedef float float_lane __attribute__((vector_size(8 * WIDTH), aligned(8 * WIDTH), may_alias));
#if WIDTH > 2
typedef double four __attribute__((vector_size(32), may_alias));
#endif
typedef double pair __attribute__((vector_size(16), may_alias));
typedef float quad __attribute__((vector_size(16), aligned(16), may_alias));

/* clang unrolls by its own lights and warns where a request cannot be met. */
#ifdef __clang__
#define UNROLL
#else
#define UNROLL _Pragma("GCC unroll 16")
#endif

#define INLINE TARGET static inline __attribute__((always_inline))

/* Eight partial sums to two. */
INLINE pair fold(const lane part[PARTS])
{
#if WIDTH == 2
  return (part[0] + part[2]) + (part[1] + part[3]);
#else
#if WIDTH == 8
  four sum = __builtin_shufflevector(part[0], part[0], 0, 1, 2, 3) +
             __builtin_shufflevector(part[0], part[0], 4, 5, 6, 7);
#else
  four sum = part[0] + part[1];
#endif
  return __builtin_shufflevector(sum, sum, 0, 1) + __builtin_shufflevector(sum, sum, 2, 3);
#endif
}

INLINE void apply_rows(int rows, int units, int stride, const float *f, const double *x, double *product)
{
  lane sum[APPLY_ROWS][PARTS];
  UNROLL
  for (int r = 0; r < rows; r++) {
    UNROLL
    for (int p = 0; p < PARTS; p++)
      sum[r][p] = (lane){0};
  }
  for (int k = 0; k < units * UNIT; k += UNIT) {
    UNROLL
    for (int p = 0; p < PARTS; p++) {
      lane v = *(const lane *)(x + k + p * WIDTH);
      UNROLL
      for (int r = 0; r < rows; r++)
        sum[r][p] = MADD(WIDEN(f + (long)r * stride + k + p * WIDTH), v, sum[r][p]);
    }
  }
  UNROLL
  for (int r = 0; r < rows; r += 2) {
    pair a = fold(sum[r]), b = fold(sum[r + 1 < rows ? r + 1 : r]);
    pair both = __builtin_shufflevector(a, b, 0, 2) + __builtin_shufflevector(a, b, 1, 3);
    product[r] = both[0];
    if (r + 1 < rows)
      product[r + 1] = both[1];
  }
}

TARGET static void apply(int rows, int columns, int stride, const float *f, const double *x, double *product)
{
  int units = (columns + UNIT - 1) / UNIT, i = 0;
  for (; i + APPLY_ROWS <= rows; i += APPLY_ROWS)
    apply_rows(APPLY_ROWS, units, stride, f + (long)i * stride, x, product + i);
  for (; i < rows; i++)
    apply_rows(1, units, stride, f + (long)i * stride, x, product + i);
}

INLINE void gather_units(int units, int rows, int stride, const float *f, const double *load, double *x)
{
  lane sum[GATHER_UNITS * PARTS];
  UNROLL
  for (int k = 0; k < units * PARTS; k++)
    sum[k] = *(const lane *)(x + k * WIDTH);
  for (int i = 0; i < rows; i++) {
    if (load[i] == 0)
      continue;
    lane less = SPLAT(-load[i]);
    UNROLL
    for (int k = 0; k < units * PARTS; k++)
      sum[k] = MADD(WIDEN(f + (long)i * stride + k * WIDTH), less, sum[k]);
  }
  UNROLL
  for (int k = 0; k < units * PARTS; k++)
    *(lane *)(x + k * WIDTH) = sum[k];
}

TARGET static void gather(int rows, int columns, int stride, const float *f, const double *load, double *x)
{
  int units = (columns + UNIT - 1) / UNIT, first = 0;
  for (; first + GATHER_UNITS <= units; first += GATHER_UNITS)
    gather_units(GATHER_UNITS, rows, stride, f + first * UNIT, load, x + first * UNIT);
  f += first * UNIT;
  x += first * UNIT;
  switch (units - first) { /* known counts, so that the sums find their registers */
  case 5:
    gather_units(GATHER_UNITS < 5 ? GATHER_UNITS : 5, rows, stride, f, load, x);
    break;
  case 4:
    gather_units(GATHER_UNITS < 4 ? GATHER_UNITS : 4, rows, stride, f, load, x);
    break;
  case 3:
    gather_units(3, rows, stride, f, load, x);
    break;
  case 2:
    gather_units(2, rows, stride, f, load, x);
    break;
  case 1:
    gather_units(1, rows, stride, f, load, x);
    break;
  default:
    break;
  }
}

TARGET static void blend(int rows, int stride, const float *f, const double *load, float *sum)
{
  enum { LANES = EO_GRAM_FLOATS / FLOATS < 8 ? EO_GRAM_FLOATS / FLOATS : 8 };
  for (int column = 0; column < stride; column += LANES * FLOATS) {
    float_lane part[LANES];
    memset(part, 0, sizeof part);
    for (int i = 0; i < rows; i++) {
      if (load[i] == 0)
        continue;
      float_lane factor = SPLAT_FLOAT((float)load[i]);
      const float *row = f + (long)i * stride + column;
      UNROLL
      for (int k = 0; k < LANES; k++)
        part[k] = MADD_FLOAT(factor, *(const float_lane *)(row + k * FLOATS), part[k]);
    }
    memcpy(sum + column, part, sizeof part);
  }
}

/* c = a b, or c += a b, over `rows` rows and `lanes` vectors of columns; the sums stay in registers over all of b's
   rows. a_row, a_column: from one number of a to the next in its column and in its row. */
INLINE void multiply_tile(int rows, int lanes, int inner, const float *a, int a_row, int a_column, const float *b,
                          int b_stride, bool add, float *c, int c_stride)
{
  float_lane sum[TILE_ROWS][ROW_LANES];
  UNROLL
  for (int r = 0; r < rows; r++) {
    UNROLL
    for (int l = 0; l < lanes; l++)
      sum[r][l] = add ? *(const float_lane *)(c + (long)r * c_stride + l * FLOATS) : (float_lane){0};
  }
  for (int k = 0; k < inner; k++) {
    float_lane right[ROW_LANES];
    UNROLL
    for (int l = 0; l < lanes; l++)
      right[l] = *(const float_lane *)(b + (long)k * b_stride + l * FLOATS);
    UNROLL
    for (int r = 0; r < rows; r++) {
      float_lane left = SPLAT_FLOAT(a[(long)r * a_row + (long)k * a_column]);
      UNROLL
      for (int l = 0; l < lanes; l++)
        sum[r][l] = MADD_FLOAT(left, right[l], sum[r][l]);
    }
  }
  UNROLL
  for (int r = 0; r < rows; r++)
    UNROLL
  for (int l = 0; l < lanes; l++)
    *(float_lane *)(c + (long)r * c_stride + l * FLOATS) = sum[r][l];
}

/* `rows` rows of A'A from `row` on over `lanes` vectors of columns from `column` on. */
INLINE void square_tile(int rows, int lanes, int points, int stride, const float *a, int row, int column, float *matrix)
{
  multiply_tile(rows, lanes, points, a + row, 1, stride, a + column, stride, false,
                matrix + (long)row * stride + column, stride);
}

/* The rows with a weight, times its root; -1 stands behind the columns of f. Returns their number. */
INLINE int pack(int rows, int columns, int stride, const float *f, int width, const double *weight, float *packed)
{
  int points = 0;
  for (int i = 0; i < rows; i++) {
    if (!(weight[i] > 0))
      continue;
    float root = (float)sqrt(weight[i]), *to = packed + (long)points++ * width;
    float_lane factor = SPLAT_FLOAT(root);
    for (int k = 0; k < stride; k += FLOATS)
      *(float_lane *)(to + k) = factor * *(const float_lane *)(f + (long)i * stride + k);
    for (int k = stride; k < width; k++)
      to[k] = 0;
    to[columns] = -root;
  }
  return points;
}

/* The lower triangle comes from the tiles, which also reach across the diagonal; the rest is its mirror image. Rows and
   columns behind the matrix are those of the identity. */
TARGET static void assemble(int rows, int columns, int stride, const float *f, const double *weight, float *packed,
                            float *matrix)
{
  int n = columns + 1, width = eo_gram_width(columns);
  int points = pack(rows, columns, stride, f, width, weight, packed);
  for (int first = 0; first < n; first += TILE_ROWS) {
    int column = 0, row = first + TILE_ROWS <= width ? first : width - TILE_ROWS, last = row + TILE_ROWS;
    for (; column + (TILE_LANES - 1) * FLOATS < last && column + TILE_LANES * FLOATS <= width;
         column += TILE_LANES * FLOATS)
      square_tile(TILE_ROWS, TILE_LANES, points, width, packed, row, column, matrix);
    for (; column < last; column += FLOATS)
      square_tile(TILE_ROWS, 1, points, width, packed, row, column, matrix);
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++)
      matrix[(long)j * width + i] = matrix[(long)i * width + j];
  for (int i = 0; i < columns; i++)
    matrix[(long)i * (width + 1)] += 1;
  for (int i = n; i < width; i++) {
    memset(matrix + (long)i * width, 0, sizeof *matrix * (size_t)width);
    for (int j = 0; j < n; j++)
      matrix[(long)j * width + i] = 0;
    matrix[(long)i * (width + 1)] = 1;
  }
}

/* The inverse of a symmetric block, pivot by pivot; false unless it is positive definite. */
INLINE bool invert_block(float block[PIVOTS][PIVOTS])
{
  UNROLL
  for (int k = 0; k < PIVOTS; k++) {
    float pivot = block[k][k];
    if (!(pivot > 0) || pivot > LARGEST_PIVOT)
      return false;
    float scale = 1 / pivot, row[PIVOTS];
    UNROLL
    for (int j = 0; j < PIVOTS; j++)
      row[j] = scale * block[k][j];
    UNROLL
    for (int i = 0; i < PIVOTS; i++) {
      float factor = block[i][k];
      UNROLL
      for (int j = 0; j < PIVOTS; j++)
        block[i][j] = i == k ? j == k ? -scale : row[j] : j == k ? row[i] : block[i][j] - factor * row[j];
    }
  }
  return true;
}

/* Sweeps the matrix by blocks of pivots K: with D = A_KK and R = D^-1 A_K, A_ij -= A_iK R_j for the others, A_K = R,
   A_iK = R_i', A_KK = -D^-1. It stays symmetric, and ends as minus the inverse (Goodnight, A tutorial on the sweep
   operator, 1979). */
INLINE void sweep(int first, int n, int width, float block[PIVOTS][PIVOTS], float *matrix, float *kept, float *rows)
{
  memcpy(kept, matrix + (long)first * width, sizeof *kept * PIVOTS * (size_t)width);
  for (int c = 0; c < n; c += FLOATS) {
    UNROLL
    for (int a = 0; a < PIVOTS; a++) {
      float_lane sum = {0};
      UNROLL
      for (int b = 0; b < PIVOTS; b++)
        sum = MADD_FLOAT(SPLAT_FLOAT(-block[a][b]), *(const float_lane *)(kept + b * width + c), sum);
      *(float_lane *)(rows + a * width + c) = sum;
    }
  }
  for (int i = 0; i < n; i++) {
    if (i >= first && i < first + PIVOTS)
      continue;
    float *row = matrix + (long)i * width;
    float_lane factor[PIVOTS];
    UNROLL
    for (int b = 0; b < PIVOTS; b++)
      factor[b] = SPLAT_FLOAT(-kept[b * width + i]);
    for (int c = 0; c < n; c += FLOATS) {
      float_lane sum = *(const float_lane *)(row + c);
      UNROLL
      for (int b = 0; b < PIVOTS; b++)
        sum = MADD_FLOAT(factor[b], *(const float_lane *)(rows + b * width + c), sum);
      *(float_lane *)(row + c) = sum;
    }
    *(quad *)(row + first) = (quad){rows[i], rows[width + i], rows[2 * width + i], rows[3 * width + i]};
  }
  for (int a = 0; a < PIVOTS; a++) /* what stands behind the matrix stays */
    memcpy(matrix + (long)(first + a) * width, rows + a * width, sizeof *rows * (size_t)n);
  for (int a = 0; a < PIVOTS; a++)
    for (int b = 0; b < PIVOTS; b++)
      matrix[(long)(first + a) * width + first + b] = block[a][b];
}

TARGET static bool invert(int n, float *matrix)
{
  enum { MOST = EO_GRAM_MOST_COLUMNS + EO_GRAM_LANE };
  float kept[PIVOTS * MOST] __attribute__((aligned(EO_GRAM_ALIGN))),
      rows[PIVOTS * MOST] __attribute__((aligned(EO_GRAM_ALIGN)));
  int width = eo_gram_width(n - 1), whole = (n + PIVOTS - 1) / PIVOTS * PIVOTS;
  for (int first = 0; first < n; first += PIVOTS) {
    float block[PIVOTS][PIVOTS];
    for (int a = 0; a < PIVOTS; a++)
      memcpy(block[a], matrix + (long)(first + a) * width + first, sizeof block[a]);
    if (!invert_block(block))
      return false;
    sweep(first, whole, width, block, matrix, kept, rows);
  }
  return true;
}

INLINE void solve_lanes(int lanes, int n, int width, const float *inverse, const double *b, float *x)
{
  float_lane sum[SOLVE_LANES];
  memset(sum, 0, sizeof sum);
  for (int k = 0; k < n; k++) {
    float_lane factor = SPLAT_FLOAT((float)-b[k]);
    UNROLL
    for (int l = 0; l < lanes; l++)
      sum[l] = MADD_FLOAT(factor, *(const float_lane *)(inverse + (long)k * width + l * FLOATS), sum[l]);
  }
  memcpy(x, sum, sizeof *sum * (size_t)lanes);
}

TARGET static void solve(int n, const float *inverse, const double *b, double *x)
{
  enum { MOST = EO_GRAM_MOST_COLUMNS + EO_GRAM_LANE };
  float sum[MOST] __attribute__((aligned(EO_GRAM_ALIGN)));
  int width = eo_gram_width(n - 1), column = 0;
  for (; column + SOLVE_LANES * FLOATS <= width; column += SOLVE_LANES * FLOATS)
    solve_lanes(SOLVE_LANES, n, width, inverse + column, b, sum + column);
  for (; column < n; column += FLOATS)
    solve_lanes(1, n, width, inverse + column, b, sum + column);
  for (int k = 0; k < n; k++)
    x[k] = (double)sum[k];
}

/* Fewer rows than a tile has: more vectors of columns at a time, as a sum has to wait for the one before it. */
INLINE void multiply_rows(int rows, int lanes, int inner, int columns, const float *a, int a_stride, const float *b,
                          int b_stride, bool add, float *c, int c_stride)
{
  int column = 0;
  for (; column + lanes * FLOATS <= columns; column += lanes * FLOATS)
    multiply_tile(rows, lanes, inner, a, a_stride, 1, b + column, b_stride, add, c + column, c_stride);
  for (; column + lanes / 2 * FLOATS <= columns; column += lanes / 2 * FLOATS)
    multiply_tile(rows, lanes / 2, inner, a, a_stride, 1, b + column, b_stride, add, c + column, c_stride);
  for (; column < columns; column += FLOATS)
    multiply_tile(rows, 1, inner, a, a_stride, 1, b + column, b_stride, add, c + column, c_stride);
}

/* Strips of columns, so that b's strip stays in the cache while all rows pass over it. Every number of c is one sum in
   the order of b's rows, whatever tile it falls into. */
TARGET static void multiply(int rows, int inner, int columns, const float *a, int a_stride, const float *b,
                            int b_stride, bool add, float *c, int c_stride)
{
  enum { STRIP = TILE_LANES * FLOATS };
  int tiled = rows / TILE_ROWS * TILE_ROWS, whole = columns / STRIP * STRIP;
  for (int column = 0; column < whole; column += STRIP)
    for (int row = 0; row < tiled; row += TILE_ROWS)
      multiply_tile(TILE_ROWS, TILE_LANES, inner, a + (long)row * a_stride, a_stride, 1, b + column, b_stride, add,
                    c + (long)row * c_stride + column, c_stride);
  for (int column = whole; column < columns; column += FLOATS)
    for (int row = 0; row < tiled; row += TILE_ROWS)
      multiply_tile(TILE_ROWS, 1, inner, a + (long)row * a_stride, a_stride, 1, b + column, b_stride, add,
                    c + (long)row * c_stride + column, c_stride);
  int row = tiled;
  for (; row + FEW_ROWS <= rows; row += FEW_ROWS)
    multiply_rows(FEW_ROWS, FEW_LANES, inner, columns, a + (long)row * a_stride, a_stride, b, b_stride, add,
                  c + (long)row * c_stride, c_stride);
  for (; row < rows; row++)
    multiply_rows(1, ROW_LANES, inner, columns, a + (long)row * a_stride, a_stride, b, b_stride, add,
                  c + (long)row * c_stride, c_stride);
}

/* s + t + sqrt((s - t)^2 + 4 u^2) > 2 largest, without the root; what is not a number passes. */
TARGET static int find_passing(int first, int blocks, const float *stress, float left, const float *rest, float largest)
{
  typedef int32_t float_mask __attribute__((vector_size(8 * WIDTH), may_alias));
  float_lane come = SPLAT_FLOAT(left), most = SPLAT_FLOAT(largest), zero = {0};
  for (int block = first; block < blocks; block++) {
    const float *at = stress + 3L * EO_GRAM_COLUMNS * block;
    float_mask any = {0};
    UNROLL
    for (int i = 0; i < EO_GRAM_COLUMNS; i += FLOATS) {
      float_lane s = *(const float_lane *)(at + i), t = *(const float_lane *)(at + EO_GRAM_COLUMNS + i),
                 u = *(const float_lane *)(at + 2 * EO_GRAM_COLUMNS + i),
                 least = most - come * *(const float_lane *)(rest + (long)EO_GRAM_COLUMNS * block + i),
                 difference = s - t, room = least + least - (s + t);
      any |= ~((float_mask)(room >= zero) & (float_mask)(difference * difference + 4 * (u * u) <= room * room));
    }
    if (ANY_FLOAT(any))
      return block;
  }
  return blocks;
}

#include "numerics/gram_carry.h"

const struct eo_gram VERSION = {NAME, apply, gather, blend, assemble, invert, solve, multiply, find_passing, carry};
