/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every version of the kernel that this processor can run, on the sizes of loaded contact (110 points, 36 modes) and of
   root stress, in Gflop/s of processor time beside the matrix library's product in the same run. */
#include "numerics/gram.h"
#include "numerics/threads.h"

#include <cblas.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROWS = 110, MODES = 36, STRIDE = 48, FLOATS = 128, N = MODES + 1, TEETH = 192, SHAPES = 40, NODES = 1536 };

static struct data {
  float *f, *rest, *packed, *matrix, *fresh, *sum, *load, *shape, *stress;
  double *x, *weight, *product, *b;
} data;

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static float *make_floats(int count)
{
  float *memory = (float *)eo_gram_allocate(count / 2);
  for (int i = 0; memory && i < count; i++)
    memory[i] = 1e-2f * (float)((i * 7919) % 101 - 50);
  return memory;
}

static double *make_doubles(int count)
{
  double *memory = eo_gram_allocate(count);
  for (int i = 0; memory && i < count; i++)
    memory[i] = 0.5 + 1e-2 * ((i * 7919) % 101);
  return memory;
}

static void make_data(void)
{
  int width = eo_gram_width(MODES);
  data = (struct data){.f = make_floats(ROWS * STRIDE),
                       .rest = make_floats(ROWS * FLOATS),
                       .packed = make_floats(ROWS * width),
                       .matrix = make_floats(width * width),
                       .fresh = make_floats(width * width),
                       .sum = make_floats(FLOATS),
                       .load = make_floats(TEETH * SHAPES),
                       .shape = make_floats(SHAPES * NODES),
                       .stress = make_floats(TEETH * NODES),
                       .x = make_doubles(STRIDE),
                       .weight = make_doubles(ROWS),
                       .product = make_doubles(ROWS),
                       .b = make_doubles(STRIDE)};
  for (int i = 0; i < ROWS; i++)
    memset(data.f + i * STRIDE + MODES, 0, sizeof *data.f * (STRIDE - MODES));
  eo_gram_version(0)->assemble(ROWS, MODES, STRIDE, data.f, data.weight, data.packed, data.fresh);
}

static void run_apply(const struct eo_gram *gram)
{
  gram->apply(ROWS, MODES, STRIDE, data.f, data.x, data.product);
}
static void run_gather(const struct eo_gram *gram)
{
  gram->gather(ROWS, MODES, STRIDE, data.f, data.weight, data.x);
}
static void run_blend(const struct eo_gram *gram)
{
  gram->blend(ROWS, FLOATS, data.rest, data.weight, data.sum);
}
static void run_assemble(const struct eo_gram *gram)
{
  gram->assemble(ROWS, MODES, STRIDE, data.f, data.weight, data.packed, data.matrix);
}
static void run_invert(const struct eo_gram *gram)
{
  memcpy(data.matrix, data.fresh, sizeof *data.matrix * (size_t)(eo_gram_width(MODES) * eo_gram_width(MODES)));
  gram->invert(N, data.matrix);
}
static void run_solve(const struct eo_gram *gram)
{
  gram->solve(N, data.fresh, data.b, data.b);
  data.b[0] = 1;
}
static void run_multiply(const struct eo_gram *gram)
{
  gram->multiply(TEETH, SHAPES, NODES, data.load, SHAPES, data.shape, NODES, false, data.stress, NODES);
}
static void run_library(const struct eo_gram *gram)
{
  enum { SIZE = 512 };
  static double a[SIZE * SIZE], b[SIZE * SIZE], c[SIZE * SIZE];
  (void)gram;
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, SIZE, SIZE, SIZE, 1, a, SIZE, b, SIZE, 0, c, SIZE);
}

/* flop: multiplications and additions that the result needs, symmetry used */
static const struct kernel {
  const char *what;
  void (*run)(const struct eo_gram *gram);
  double flop;
} kernels[] = {{"apply", run_apply, 2. * ROWS *MODES},
               {"gather", run_gather, 2. * ROWS *MODES},
               {"blend", run_blend, 2. * ROWS *FLOATS},
               {"assemble", run_assemble, 1. * ROWS *N *N},
               {"invert", run_invert, 1. * N *N *N},
               {"solve", run_solve, 2. * N *N},
               {"multiply", run_multiply, 2. * TEETH *SHAPES *NODES}};

/* The best of some runs of about 2 ms. */
static double rate(const struct kernel *kernel, const struct eo_gram *gram)
{
  enum { RUNS = 15 };
  double best = 0;
  int count = 1 + (int)(2e7 / kernel->flop);
  for (int run = 0; run < RUNS; run++) {
    double start = now();
    for (int i = 0; i < count; i++)
      kernel->run(gram);
    double found = 1e-9 * count * kernel->flop / (now() - start);
    best = found > best ? found : best;
  }
  return best;
}

int main(void)
{
  static const struct kernel library = {"dgemm", run_library, 2. * 512 * 512 * 512};
  eo_threads_limit();
  make_data();
  printf("Gflop/s of the kernel (%d points, %d modes); dgemm of 512 rows: %.1f\n%8s", ROWS, MODES, rate(&library, NULL),
         "");
  for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++)
    printf(" %9s", kernels[k].what);
  printf("\n");
  for (int version = 0; eo_gram_version(version); version++) {
    printf("%8s", eo_gram_version(version)->name);
    for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++)
      printf(" %9.1f", rate(&kernels[k], eo_gram_version(version)));
    printf("\n");
  }
  return 0;
}
