/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/threads.h"

#include <cblas.h>
#include <dlfcn.h>
#include <pthread.h>
#include <stddef.h>
#include <sys/mman.h>

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

const char *eo_threads_blas_kernel(void)
{
  return openblas_get_corename();
}

/* What one room may take: 32 to 128 MB of addresses, by the processor (OpenBLAS's BUFFER_SIZE), of which what is used
   becomes memory. */
#define ROOM ((size_t)160 << 20)

/* OpenBLAS's own, in no header but exported since its beginning; absent in another BLAS, which then needs none. */
typedef void *alloc_function(int);
typedef void free_function(void *);

enum eo_code eo_threads_reserve(int threads, struct eo_error *error)
{
  enum { MOST = 128 };
  void *room[MOST];
  alloc_function *take = (alloc_function *)dlsym(RTLD_DEFAULT, "blas_memory_alloc");
  free_function *give = (free_function *)dlsym(RTLD_DEFAULT, "blas_memory_free");
  int count = threads < MOST ? threads : MOST;
  if (!take || !give || count < 1)
    return EO_OK;
  /* the question that OpenBLAS would ask without an end, asked once */
  size_t size = ROOM * (size_t)count;
  void *test = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (test == MAP_FAILED)
    return eo_error_set(error, EO_ERROR_MEMORY, "",
                        "Not enough memory: %d threads need %zu MB of addresses for linear algebra.", count,
                        size >> 20);
  munmap(test, size);
  for (int i = 0; i < count; i++)
    room[i] = take(0);
  for (int i = 0; i < count; i++)
    give(room[i]);
  return EO_OK;
}
