/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/fft.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_fft_complex.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

enum { MOST_SIZES = 16 }; /* beyond these a transform makes a table of its own */

struct eo_fft_tables {
  pthread_mutex_t adding;
  int sizes;
  gsl_fft_complex_wavetable *table[MOST_SIZES];
};

enum eo_code eo_fft_tables_new(struct eo_fft_tables **result, struct eo_error *error)
{
  struct eo_fft_tables *tables = calloc(1, sizeof *tables);
  if (!tables)
    return eo_error_memory(error);
  pthread_mutex_init(&tables->adding, NULL);
  *result = tables;
  return EO_OK;
}

void eo_fft_tables_free(struct eo_fft_tables *tables)
{
  if (!tables)
    return;
  for (int i = 0; i < tables->sizes; i++)
    gsl_fft_complex_wavetable_free(tables->table[i]);
  pthread_mutex_destroy(&tables->adding);
  free(tables);
}

/* Of this size, which stays as it is; NULL: there is none and no room. */
static gsl_fft_complex_wavetable *find_table(struct eo_fft_tables *tables, size_t n)
{
  gsl_fft_complex_wavetable *table = NULL;
  pthread_mutex_lock(&tables->adding);
  for (int i = 0; i < tables->sizes && !table; i++)
    table = tables->table[i]->n == n ? tables->table[i] : NULL;
  if (!table && tables->sizes < MOST_SIZES) {
    table = gsl_fft_complex_wavetable_alloc(n);
    tables->table[tables->sizes] = table;
    tables->sizes += table != NULL;
  }
  pthread_mutex_unlock(&tables->adding);
  return table;
}

enum eo_code eo_fft_forward(struct eo_fft_tables *tables, int n, double complex *x, struct eo_error *error)
{
  gsl_fft_complex_wavetable *kept = tables ? find_table(tables, (size_t)n) : NULL,
                            *own = kept ? NULL : gsl_fft_complex_wavetable_alloc((size_t)n), *table = kept ? kept : own;
  gsl_fft_complex_workspace *room = gsl_fft_complex_workspace_alloc((size_t)n);
  bool done = table && room && gsl_fft_complex_forward((double *)x, 1, (size_t)n, table, room) == GSL_SUCCESS;
  if (own)
    gsl_fft_complex_wavetable_free(own);
  if (room)
    gsl_fft_complex_workspace_free(room);
  return done ? EO_OK : eo_error_memory(error);
}

/* theory (P3) */
enum eo_code eo_fft_spectrum(struct eo_fft_tables *tables, int n, const double *value, double complex *line,
                             struct eo_error *error)
{
  double complex *x = malloc(sizeof *x * (size_t)n);
  if (!x)
    return eo_error_memory(error);
  for (int i = 0; i < n; i++)
    x[i] = value[i];
  enum eo_code code = eo_fft_forward(tables, n, x, error);
  for (int k = 0; k <= n / 2 && !code; k++)
    line[k] = x[k] * (k == 0 || 2 * k == n ? 1.0 : 2.0) / n;
  free(x);
  return code;
}
