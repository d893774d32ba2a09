/* The small dense kernel of loaded contact: H = D + F' W F bordered by one row, its Cholesky factor and solves, for
   matrices of a few dozen rows where a general library spends its time on being general. Vector code, compiled for the
   instruction sets a processor may have. */
#ifndef EASEOFF_NUMERICS_GRAM_H
#define EASEOFF_NUMERICS_GRAM_H

#include <stdbool.h>

enum {
  EO_GRAM_LANE = 8,
  EO_GRAM_FLOATS = 64,
  EO_GRAM_COLUMNS = 16,
  EO_GRAM_ALIGN = 64
}; /* strides are multiples of the lane (doubles), arrays aligned to 64 bytes */

/* All arrays aligned to EO_GRAM_ALIGN; stride a multiple of EO_GRAM_LANE; a matrix has stride + EO_GRAM_LANE rows and
   as many columns, row-major. */
struct eo_gram {
  const char *name; /* "avx512", "avx2" or "plain" */
  /* product[rows] = F x: f[rows][stride], x[stride]. */
  void (*apply)(int rows, int stride, const double *f, const double *x, double *product);
  /* x[stride] -= F' load, rows with load 0 skipped. */
  void (*gather)(int rows, int stride, const double *f, const double *load, double *x);
  /* Lower triangle of [I + F'WF, .; -1'WF, 1'W1] of size stride + 1 from the rows with weight > 0. packed: scratch
     [2][rows][stride]. */
  void (*assemble)(int rows, int stride, const double *f, const double *weight, double *packed, double *matrix);
  /* sum[stride] = sum_i load[i] rows[i][stride] in single precision; stride a multiple of EO_GRAM_FLOATS; rows with
     load 0 skipped. */
  void (*blend)(int rows, int stride, const float *f, const double *load, float *sum);
  /* In place, lower triangle, size n <= stride + 1 <= 2048; false when not positive definite. */
  bool (*factor)(int n, int stride, double *matrix);
  /* Solves L L' x = b in place; x[stride + EO_GRAM_LANE], what lies behind n is set to zero. */
  void (*solve)(int n, int stride, const double *matrix, double *x);
  /* c[rows][columns] = a[rows][inner] b[inner][columns], or c += a b, in single precision; rows a_stride, b_stride and
     c_stride apart; columns, b_stride and c_stride multiples of EO_GRAM_COLUMNS. A row of c comes from its row of a
     alone, to the last bit, whatever the number of rows. */
  void (*multiply)(int rows, int inner, int columns, const float *a, int a_stride, const float *b, int b_stride,
                   bool add, float *c, int c_stride);
};

/* The fastest version for this processor. */
const struct eo_gram *eo_gram_select(void);

/* Every version this processor can run, fastest first; NULL after the last. One version gives the same bytes whatever
   was asked before; two may round differently (with and without a fused multiply-add). On a GNU C library a version is
   left out when the environment says so at the start of the process: GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F, or
   -AVX512F,-AVX2 (CONTRIBUTING.md). */
const struct eo_gram *eo_gram_version(int index);

/* Memory for count doubles, aligned; free() it. NULL without memory. */
double *eo_gram_allocate(long count);

#endif
