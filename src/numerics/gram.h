/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The small dense kernel of loaded contact and root stress, for matrices of a few dozen columns where a general library
   spends its time on being general: products with F, Newton's matrix H = I + F' W F bordered by one row, its inverse,
   and a product of matrices whose rows do not depend on each other. Vector code, compiled for the instruction sets a
   processor may have. F and H are in single precision: what is solved for is told by residuals in double precision, to
   which H only shows the way. */
#ifndef EASEOFF_NUMERICS_GRAM_H
#define EASEOFF_NUMERICS_GRAM_H

#include <stdbool.h>

enum {
  EO_GRAM_LANE = 16,           /* floats: strides are multiples of it */
  EO_GRAM_FLOATS = 64,         /* the same for the matrix of blend */
  EO_GRAM_COLUMNS = 16,        /* the same for the product of matrices */
  EO_GRAM_ALIGN = 64,          /* of all arrays, bytes */
  EO_GRAM_MOST_COLUMNS = 2032, /* of F */
};

/* Rows and columns of the arrays that hold H of size columns + 1. */
static inline int eo_gram_width(int columns)
{
  return (columns + EO_GRAM_LANE) / EO_GRAM_LANE * EO_GRAM_LANE;
}

/* Of a point: strength w(per_depth g), w by the table of numerics/local_inverse.h. */
struct eo_line_law {
  const double (*node)[2]; /* eo_local_inverse's */
  const double *per_depth, *strength;
};

/* All arrays aligned to EO_GRAM_ALIGN, row-major. F: f[rows][stride], stride a multiple of EO_GRAM_LANE, zero behind
   its columns. */
struct eo_gram {
  const char *name; /* "avx512", "avx2" or "plain" */
  /* product[rows] = F x, x[stride]. */
  void (*apply)(int rows, int columns, int stride, const float *f, const double *x, double *product);
  /* x[stride] -= F' load, rows with load 0 skipped; what lies behind the columns stays. */
  void (*gather)(int rows, int columns, int stride, const float *f, const double *load, double *x);
  /* sum[stride] = sum_i load[i] rows[i][stride] in single precision; stride a multiple of EO_GRAM_FLOATS; rows with
     load 0 skipped. */
  void (*blend)(int rows, int stride, const float *f, const double *load, float *sum);
  /* H = [I + F'WF, -F'W1; -1'WF, 1'W1] of size n = columns + 1 from the rows with weight > 0:
     matrix[width][width], identity behind H; width: eo_gram_width(columns). packed: scratch
     [rows][width]. */
  void (*assemble)(int rows, int columns, int stride, const float *f, const double *weight, float *packed,
                   float *matrix);
  /* In place: minus the inverse of the symmetric matrix of size n; false when it is not positive definite, as far as
     single precision can tell. */
  bool (*invert)(int n, float *matrix);
  /* x[n] = H^-1 b[n] with what invert left, to some digits of single precision. */
  void (*solve)(int n, const float *inverse, const double *b, double *x);
  /* c[rows][columns] = a[rows][inner] b[inner][columns], or c += a b, in single precision; rows a_stride, b_stride and
     c_stride apart; columns, b_stride and c_stride multiples of EO_GRAM_COLUMNS. A row of c comes from its row of a
     alone, to the last bit, whatever the number of rows. */
  void (*multiply)(int rows, int inner, int columns, const float *a, int a_stride, const float *b, int b_stride,
                   bool add, float *c, int c_stride);
  /* The first of the blocks first .. blocks - 1 of EO_GRAM_COLUMNS plane stresses in which a larger principal one may
     pass `largest`, 0 or more, else `blocks`. stress[blocks][3][EO_GRAM_COLUMNS]: s, t, u, each uncertain by no more
     than left times rest[blocks][EO_GRAM_COLUMNS]. */
  int (*find_passing)(int first, int blocks, const float *stress, float left, const float *rest, float largest);
  /* The loads of a line contact and their rates, load[points] and rate[points], from the local approach and half its
     change over each cell, local[points] and spread[points], which lie in aligned arrays; law as eo_line_law says.
     Returns the sum of the loads, in the order of the points. Every version gives the same bytes. */
  double (*carry)(int points, const struct eo_line_law *law, const double *local, const double *spread, double *load,
                  double *rate);
};

/* The fastest version for this processor. */
const struct eo_gram *eo_gram_select(void);

/* Every version this processor can run, fastest first; NULL after the last. One version gives the same bytes whatever
   was asked before; two may round differently (with and without a fused multiply-add). On a GNU C library a version is
   left out when the environment says so at the start of the process: GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F, or
   -AVX512F,-AVX2 (CONTRIBUTING.md). */
const struct eo_gram *eo_gram_version(int index);

/* Memory for count doubles, or twice as many floats, aligned and zero; free() it. NULL without memory. */
void *eo_gram_allocate(long count);

#endif
