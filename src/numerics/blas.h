/* BLAS on one thread: small products do not gain from more, and the same bytes come out on every machine load. */
#ifndef EASEOFF_NUMERICS_BLAS_H
#define EASEOFF_NUMERICS_BLAS_H

/* For the whole process, once; any thread may call it at any time. */
void eo_blas_single_thread(void);

#endif
