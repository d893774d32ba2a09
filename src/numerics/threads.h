/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threads of the libraries below: none. Parallel work is ours alone (both members of a pair, candidates of a
   generation), so that a result does not depend on the machine and a busy one is not made busier. */
#ifndef EASEOFF_NUMERICS_THREADS_H
#define EASEOFF_NUMERICS_THREADS_H

#include "base/error.h"

/* BLAS works with one thread from here on, in the whole process; OpenMP loops (CHOLMOD's ask for four, whatever
   OMP_NUM_THREADS says) run on the calling thread when that thread calls them. Cheap; called by main() and by every
   thread that uses numerics/sparse. */
void eo_threads_limit(void);

/* The kernels that the BLAS chose for this processor, "Haswell": two kinds may round differently. */
const char *eo_threads_blas_kernel(void);

/* Takes the rooms that BLAS works in, one for each of so many threads that call it at once, and gives them back to it:
   it keeps them, and never asks for memory again. OpenBLAS that does not get such a room asks for ever. Errors:
   EO_ERROR_MEMORY. */
enum eo_code eo_threads_reserve(int threads, struct eo_error *error);

#endif
