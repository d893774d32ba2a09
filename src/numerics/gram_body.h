/* The kernel for one width of vectors, compiled once per version: the file that includes this one says how many doubles
   a lane holds (WIDTH), what the processor must have (TARGET), the product with a sum (FUSED and FUSED_FLOAT: a b + c)
   and how many rows and lanes of a product of matrices its registers hold (TILE_ROWS, TILE_LANES). What a result is
   made of and in which order does not depend on the width, but for the sums over one row (sum_lane). */
#include "numerics/gram_private.h"

#include <math.h>
#include <string.h>

typedef double lane __attribute__((vector_size(64), aligned(64), may_alias));
typedef float float_lane __attribute__((vector_size(64), aligned(64), may_alias));
typedef float narrow __attribute__((vector_size(8 * WIDTH), aligned(8 * WIDTH), may_alias));
enum { FLOATS = 2 * WIDTH };

/* clang unrolls by its own lights and warns where a request cannot be met. */
#ifdef __clang__
#define UNROLL
#else
#define UNROLL _Pragma("GCC unroll 8")
#endif

#define INLINE TARGET static inline __attribute__((always_inline))

INLINE double sum_lane(const lane *vector)
{
  lane v = *vector;
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

INLINE void apply_body(int rows, int stride, const double *f, const double *x, double *product)
{
  int lanes = stride / EO_GRAM_LANE;
  const lane *vector = (const lane *)x;
  for (int i = 0; i < rows; i++) {
    const lane *row = (const lane *)(f + (long)i * stride);
    lane sum = {0};
    for (int k = 0; k < lanes; k++)
      sum += row[k] * vector[k];
    product[i] = sum_lane(&sum);
  }
}

INLINE void gather_body(int rows, int stride, const double *f, const double *load, double *x)
{
  int lanes = stride / EO_GRAM_LANE;
  lane *vector = (lane *)x;
  for (int i = 0; i < rows; i++) {
    if (load[i] == 0)
      continue;
    const lane *row = (const lane *)(f + (long)i * stride);
    for (int k = 0; k < lanes; k++)
      vector[k] -= load[i] * row[k];
  }
}

/* Four rows of the product at once over one lane of columns; the sums stay in registers over all points. */
INLINE void tile(int points, int stride, const double *plain, const double *weighted, int row, int column,
                 double *matrix, int ld)
{
  lane sum[4] = {{0}, {0}, {0}, {0}};
  for (int i = 0; i < points; i++) {
    const double *w = weighted + (long)i * stride + row;
    lane f = *(const lane *)(plain + (long)i * stride + column);
    sum[0] += w[0] * f;
    sum[1] += w[1] * f;
    sum[2] += w[2] * f;
    sum[3] += w[3] * f;
  }
  for (int k = 0; k < 4; k++)
    *(lane *)(matrix + (long)(row + k) * ld + column) = sum[k];
}

INLINE void assemble_body(int rows, int stride, const double *f, const double *weight, double *packed, double *matrix)
{
  int ld = stride + EO_GRAM_LANE, points = 0, lanes = stride / EO_GRAM_LANE;
  double *plain = packed, *weighted = packed + (long)rows * stride, total = 0;
  lane *last = (lane *)(matrix + (long)stride * ld);
  memset(last, 0, sizeof(double) * (size_t)ld);
  for (int i = 0; i < rows; i++) {
    if (weight[i] <= 0)
      continue;
    const lane *from = (const lane *)(f + (long)i * stride);
    lane *a = (lane *)(plain + (long)points * stride), *b = (lane *)(weighted + (long)points * stride);
    for (int k = 0; k < lanes; k++) {
      a[k] = from[k];
      b[k] = weight[i] * from[k];
      last[k] -= b[k];
    }
    total += weight[i];
    points++;
  }
  for (int row = 0; row < stride; row += 4)
    for (int column = 0; column <= row; column += EO_GRAM_LANE)
      tile(points, stride, plain, weighted, row, column, matrix, ld);
  for (int j = 0; j < stride; j++)
    matrix[(long)j * (ld + 1)] += 1;
  matrix[(long)stride * (ld + 1)] = total;
}

INLINE void blend_body(int rows, int stride, const float *f, const double *load, float *sum)
{
  for (int column = 0; column < stride; column += EO_GRAM_FLOATS) {
    float_lane part[4] = {{0}, {0}, {0}, {0}};
    for (int i = 0; i < rows; i++) {
      const float_lane *row = (const float_lane *)(f + (long)i * stride + column);
      float factor = (float)load[i];
      if (factor == 0)
        continue;
      for (int k = 0; k < 4; k++)
        part[k] += factor * row[k];
    }
    memcpy(sum + column, part, sizeof part);
  }
}

enum { LANE = EO_GRAM_LANE };

/* Factors the lower triangle of a diagonal block of n <= LANE rows, row-major with leading dimension ld, and writes
   inverse[p]: row p of the transposed inverse of its factor, zero where there is none. What lies right of the diagonal
   ends as zero. */
INLINE bool factor_diagonal(int n, int ld, double *block, lane inverse[LANE])
{
  double l[LANE][LANE] __attribute__((aligned(EO_GRAM_ALIGN))) = {{0}}, scale[LANE] = {0};
  for (int i = 0; i < n; i++)
    for (int k = 0; k <= i; k++)
      l[i][k] = block[(long)i * ld + k];
  UNROLL
  for (int j = 0; j < n; j++) {
    if (!(l[j][j] > 0))
      return false;
    l[j][j] = sqrt(l[j][j]);
    scale[j] = 1 / l[j][j];
    UNROLL
    for (int i = j + 1; i < n; i++)
      l[i][j] *= scale[j];
    UNROLL
    for (int k = j + 1; k < n; k++)
      UNROLL
    for (int i = k; i < n; i++)
      l[i][k] -= l[i][j] * l[k][j];
  }
  for (int i = 0; i < n; i++)
    *(lane *)(block + (long)i * ld) = *(const lane *)l[i];
  /* L^-1 by rows: e_i less what the rows above take, over the diagonal; then transposed. */
  lane rows[LANE] = {{0}};
  UNROLL
  for (int i = 0; i < n; i++) {
    lane sum = {0};
    sum[i] = 1;
    UNROLL
    for (int k = 0; k < i; k++)
      sum -= l[i][k] * rows[k];
    rows[i] = sum * scale[i];
  }
  for (int p = 0; p < LANE; p++)
    for (int i = 0; i < LANE; i++)
      inverse[p][i] = rows[i][p];
  return true;
}

/* Block column by block column, each as wide as a lane: the diagonal block, the rows below it through its inverse, and
   what they take from the columns to their right. across: the rows below as columns, [n][LANE]. */
INLINE bool factor_body(int n, int stride, double *matrix)
{
  enum { MOST_ROWS = 2048 };
  int ld = stride + LANE;
  double across[MOST_ROWS][LANE] __attribute__((aligned(EO_GRAM_ALIGN)));
  for (int first = 0; first < n; first += LANE) {
    lane inverse[LANE];
    int below = first + LANE;
    double *diagonal = matrix + (long)first * (ld + 1);
    if (!(below <= n ? factor_diagonal(LANE, ld, diagonal, inverse)
                     : factor_diagonal(n - first, ld, diagonal, inverse)))
      return false;
    for (int i = below; i < n; i++) {
      double *row = matrix + (long)i * ld + first;
      lane sum = {0};
      for (int p = 0; p < LANE; p++)
        sum += row[p] * inverse[p];
      *(lane *)row = sum;
      for (int p = 0; p < LANE; p++)
        across[i / LANE * LANE + p][i % LANE] = sum[p];
    }
    for (int i = below; i < n; i++) {
      const double *row = matrix + (long)i * ld + first;
      for (int column = below; column <= i; column += LANE) {
        lane *target = (lane *)(matrix + (long)i * ld + column), sum = *target;
        for (int p = 0; p < LANE; p++)
          sum -= row[p] * *(const lane *)across[column + p];
        *target = sum;
      }
    }
  }
  return true;
}

/* Rows of one diagonal block of the factor against part: L y = part. */
INLINE void solve_forward(int rows, int ld, const double *diagonal, double *part)
{
  double scale[LANE] = {0};
  for (int i = 0; i < rows; i++)
    scale[i] = 1 / diagonal[(long)i * (ld + 1)];
  UNROLL
  for (int i = 0; i < rows; i++) {
    part[i] *= scale[i];
    UNROLL
    for (int k = i + 1; k < rows; k++)
      part[k] -= diagonal[(long)k * ld + i] * part[i];
  }
}

/* The same with the transpose: L' y = part. */
INLINE void solve_backward(int rows, int ld, const double *diagonal, double *part)
{
  double scale[LANE] = {0};
  for (int i = 0; i < rows; i++)
    scale[i] = 1 / diagonal[(long)i * (ld + 1)];
  UNROLL
  for (int i = rows - 1; i >= 0; i--) {
    part[i] *= scale[i];
    UNROLL
    for (int k = 0; k < i; k++)
      part[k] -= diagonal[(long)i * ld + k] * part[i];
  }
}

/* x is padded with zeros to whole lanes, the rows of the factor are zero right of the diagonal. A block of rows as wide
   as a lane takes in the blocks before it at once; only the small triangle on the diagonal goes row by row. */
INLINE void solve_body(int n, int stride, const double *matrix, double *x)
{
  int ld = stride + LANE, whole = n / LANE, left = n % LANE;
  lane *vector = (lane *)x;
  for (int i = n; i < ld; i++)
    x[i] = 0;
  for (int b = 0; b <= whole; b++) {
    const double *diagonal = matrix + (long)b * LANE * (ld + 1);
    double part[LANE];
    for (int i = 0; i < (b < whole ? LANE : left); i++) {
      const lane *row = (const lane *)(matrix + (long)(b * LANE + i) * ld);
      lane sum = {0};
      for (int k = 0; k < b; k++)
        sum += row[k] * vector[k];
      part[i] = x[b * LANE + i] - sum_lane(&sum);
    }
    if (b < whole)
      solve_forward(LANE, ld, diagonal, part);
    else
      solve_forward(left, ld, diagonal, part);
    memcpy(x + b * LANE, part, sizeof *part * (size_t)(b < whole ? LANE : left));
  }
  for (int b = whole; b >= 0; b--) {
    const double *diagonal = matrix + (long)b * LANE * (ld + 1);
    double *part = x + b * LANE;
    if (b < whole)
      solve_backward(LANE, ld, diagonal, part);
    else
      solve_backward(left, ld, diagonal, part);
    for (int i = 0; i < (b < whole ? LANE : left); i++)
      for (int k = 0; k < b; k++)
        vector[k] -= part[i] * ((const lane *)(matrix + (long)(b * LANE + i) * ld))[k];
  }
}

/* c = a b, or c += a b, over `rows` rows and `lanes` lanes of columns; the sums stay in registers over all of b's rows.
 */
INLINE void multiply_tile(int rows, int lanes, int inner, const float *a, int a_stride, const float *b, int b_stride,
                          bool add, float *c, int c_stride)
{
  narrow sum[TILE_ROWS][TILE_LANES];
  UNROLL
  for (int r = 0; r < rows; r++)
    UNROLL
  for (int l = 0; l < lanes; l++)
    sum[r][l] = add ? *(const narrow *)(c + (long)r * c_stride + l * FLOATS) : (narrow){0};
  for (int k = 0; k < inner; k++) {
    narrow from[TILE_LANES];
    UNROLL
    for (int l = 0; l < lanes; l++)
      from[l] = *(const narrow *)(b + (long)k * b_stride + l * FLOATS);
    UNROLL
    for (int r = 0; r < rows; r++)
      UNROLL
    for (int l = 0; l < lanes; l++)
      sum[r][l] = FUSED_FLOAT(a[(long)r * a_stride + k], from[l], sum[r][l]);
  }
  UNROLL
  for (int r = 0; r < rows; r++)
    UNROLL
  for (int l = 0; l < lanes; l++)
    *(narrow *)(c + (long)r * c_stride + l * FLOATS) = sum[r][l];
}

/* Strips of columns, so that b's strip stays in the cache while all rows pass over it. Every number of c is one sum in
   the order of b's rows, whatever tile it falls into. */
TARGET static void multiply(int rows, int inner, int columns, const float *a, int a_stride, const float *b,
                            int b_stride, bool add, float *c, int c_stride)
{
  enum { STRIP = TILE_LANES * FLOATS };
  for (int column = 0; column < columns; column += STRIP) {
    const float *from = b + column;
    float *to = c + column;
    int row = 0;
    bool whole = column + STRIP <= columns;
    for (; whole && row + TILE_ROWS <= rows; row += TILE_ROWS)
      multiply_tile(TILE_ROWS, TILE_LANES, inner, a + (long)row * a_stride, a_stride, from, b_stride, add,
                    to + (long)row * c_stride, c_stride);
    for (; whole && row < rows; row++)
      multiply_tile(1, TILE_LANES, inner, a + (long)row * a_stride, a_stride, from, b_stride, add,
                    to + (long)row * c_stride, c_stride);
    for (; row < rows; row++)
      for (int left = 0; left < columns - column; left += FLOATS)
        multiply_tile(1, 1, inner, a + (long)row * a_stride, a_stride, from + left, b_stride, add,
                      to + (long)row * c_stride + left, c_stride);
  }
}

TARGET static void apply(int rows, int stride, const double *f, const double *x, double *product)
{
  apply_body(rows, stride, f, x, product);
}
TARGET static void gather(int rows, int stride, const double *f, const double *load, double *x)
{
  gather_body(rows, stride, f, load, x);
}
TARGET static void assemble(int rows, int stride, const double *f, const double *weight, double *packed, double *matrix)
{
  assemble_body(rows, stride, f, weight, packed, matrix);
}
TARGET static void blend(int rows, int stride, const float *f, const double *load, float *sum)
{
  blend_body(rows, stride, f, load, sum);
}
TARGET static bool factor(int n, int stride, double *matrix)
{
  return factor_body(n, stride, matrix);
}
TARGET static void solve(int n, int stride, const double *matrix, double *x)
{
  solve_body(n, stride, matrix, x);
}

const struct eo_gram VERSION = {NAME, apply, gather, assemble, blend, factor, solve, multiply};
