/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/threads.h"

#include <cblas.h>
#include <dlfcn.h>
#include <pthread.h>
#include <stddef.h>

static pthread_once_t blas_once = PTHREAD_ONCE_INIT;

static void set_blas_threads(void)
{
  openblas_set_num_threads(1);
}

/* The nesting limit is the one OpenMP setting that wins over a fixed number of threads in a loop; it belongs to the
   calling thread. */
void eo_threads_limit(void)
{
  pthread_once(&blas_once, set_blas_threads);
  void (*set_levels)(int) = (void (*)(int))dlsym(RTLD_DEFAULT, "omp_set_max_active_levels");
  if (set_levels)
    set_levels(0);
}
