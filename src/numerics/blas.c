#include "numerics/blas.h"

#include <cblas.h>
#include <pthread.h>

static pthread_once_t once = PTHREAD_ONCE_INIT;

static void set_threads(void)
{
  openblas_set_num_threads(1);
}

void eo_blas_single_thread(void)
{
  pthread_once(&once, set_threads);
}
