#include "numerics/gram.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double lane __attribute__((vector_size(64), aligned(64), may_alias));

typedef float float_lane __attribute__((vector_size(64), aligned(64), may_alias));

#define INLINE static inline __attribute__((always_inline))

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
INLINE void tile(int points, int stride, const double *plain, const double *weighted, int row, int column, double *matrix, int ld)
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

/* Column by column: the entries below a pivot are independent dot products with the pivot's row, four at a time. That row is copied with
   zeros behind the pivot, so that whole lanes can be used; what lies right of the diagonal ends as zero. */
INLINE bool factor_body(int n, int stride, double *matrix)
{
  enum { MOST_LANES = 256 };
  int ld = stride + EO_GRAM_LANE;
  lane pivot[MOST_LANES];
  for (int j = 0; j < n; j++) {
    double *row = matrix + (long)j * ld;
    int lanes = (j + EO_GRAM_LANE - 1) / EO_GRAM_LANE;
    for (int k = j + 1; k < (j / EO_GRAM_LANE + 1) * EO_GRAM_LANE; k++)
      row[k] = 0;
    memcpy(pivot, row, sizeof(double) * (size_t)j);
    memset((double *)pivot + j, 0, sizeof(double) * (size_t)(lanes * EO_GRAM_LANE - j));
    lane square = {0};
    for (int k = 0; k < lanes; k++)
      square += pivot[k] * pivot[k];
    double rest = row[j] - sum_lane(&square);
    if (!(rest > 0))
      return false;
    row[j] = sqrt(rest);
    double scale = 1 / row[j];
    int i = j + 1;
    for (; i + 4 <= n; i += 4) {
      lane sum[4] = {{0}, {0}, {0}, {0}};
      const lane *at = (const lane *)(matrix + (long)i * ld);
      int step = ld / EO_GRAM_LANE;
      for (int k = 0; k < lanes; k++)
        for (int m = 0; m < 4; m++)
          sum[m] += at[m * step + k] * pivot[k];
      for (int m = 0; m < 4; m++)
        matrix[(long)(i + m) * ld + j] = (matrix[(long)(i + m) * ld + j] - sum_lane(&sum[m])) * scale;
    }
    for (; i < n; i++) {
      lane sum = {0};
      const lane *at = (const lane *)(matrix + (long)i * ld);
      for (int k = 0; k < lanes; k++)
        sum += at[k] * pivot[k];
      matrix[(long)i * ld + j] = (matrix[(long)i * ld + j] - sum_lane(&sum)) * scale;
    }
  }
  return true;
}

/* x is padded with zeros to whole lanes, the rows of the factor are zero right of the diagonal. */
INLINE void solve_body(int n, int stride, const double *matrix, double *x)
{
  int ld = stride + EO_GRAM_LANE;
  lane *vector = (lane *)x;
  for (int i = n; i < ld; i++)
    x[i] = 0;
  for (int i = 0; i < n; i++) {
    const double *row = matrix + (long)i * ld;
    lane sum = {0};
    double mine = x[i];
    x[i] = 0;
    for (int k = 0; k <= i / EO_GRAM_LANE; k++)
      sum += ((const lane *)row)[k] * vector[k];
    x[i] = (mine - sum_lane(&sum)) / row[i];
  }
  for (int i = n - 1; i >= 0; i--) {
    const double *row = matrix + (long)i * ld;
    double mine = x[i] / row[i];
    for (int k = 0; k <= i / EO_GRAM_LANE; k++)
      vector[k] -= mine * ((const lane *)row)[k];
    x[i] = mine;
  }
}

#define VERSION(name, target_)                                                                                                        \
  target_ static void apply_##name(int rows, int stride, const double *f, const double *x, double *product)                           \
  {                                                                                                                                   \
    apply_body(rows, stride, f, x, product);                                                                                          \
  }                                                                                                                                   \
  target_ static void gather_##name(int rows, int stride, const double *f, const double *load, double *x)                             \
  {                                                                                                                                   \
    gather_body(rows, stride, f, load, x);                                                                                            \
  }                                                                                                                                   \
  target_ static void assemble_##name(int rows, int stride, const double *f, const double *weight, double *packed, double *matrix)    \
  {                                                                                                                                   \
    assemble_body(rows, stride, f, weight, packed, matrix);                                                                           \
  }                                                                                                                                   \
  target_ static void blend_##name(int rows, int stride, const float *f, const double *load, float *sum)                             \
  {                                                                                                                                   \
    blend_body(rows, stride, f, load, sum);                                                                                           \
  }                                                                                                                                   \
  target_ static bool factor_##name(int n, int stride, double *matrix)                                                                \
  {                                                                                                                                   \
    return factor_body(n, stride, matrix);                                                                                            \
  }                                                                                                                                   \
  target_ static void solve_##name(int n, int stride, const double *matrix, double *x)                                                \
  {                                                                                                                                   \
    solve_body(n, stride, matrix, x);                                                                                                 \
  }                                                                                                                                   \
  static const struct eo_gram version_##name = {apply_##name, gather_##name, assemble_##name, blend_##name, factor_##name, solve_##name};

VERSION(plain, )
#if defined(__x86_64__)
VERSION(avx2, __attribute__((target("avx2,fma"))))
VERSION(avx512, __attribute__((target("avx512f,avx512dq,avx512vl,fma"))))
#endif

const struct eo_gram *eo_gram_version(int index)
{
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") && index-- == 0)
    return &version_avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && index-- == 0)
    return &version_avx2;
#endif
  return index == 0 ? &version_plain : NULL;
}

const struct eo_gram *eo_gram_select(void)
{
  return eo_gram_version(0);
}

double *eo_gram_allocate(long count)
{
  size_t bytes = ((size_t)(count > 0 ? count : 1) * sizeof(double) + EO_GRAM_ALIGN - 1) / EO_GRAM_ALIGN * EO_GRAM_ALIGN;
  double *memory = aligned_alloc(EO_GRAM_ALIGN, bytes);
  if (memory)
    memset(memory, 0, bytes);
  return memory;
}
