/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/fft.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_fft_complex.h>
#include <stdbool.h>
#include <stdlib.h>

enum eo_code eo_fft_forward(int n, double complex *x, struct eo_error *error)
{
  gsl_fft_complex_wavetable *table = gsl_fft_complex_wavetable_alloc((size_t)n);
  gsl_fft_complex_workspace *room = gsl_fft_complex_workspace_alloc((size_t)n);
  bool done = table && room && gsl_fft_complex_forward((double *)x, 1, (size_t)n, table, room) == GSL_SUCCESS;
  if (table)
    gsl_fft_complex_wavetable_free(table);
  if (room)
    gsl_fft_complex_workspace_free(room);
  return done ? EO_OK : eo_error_memory(error);
}

/* theory (P3) */
enum eo_code eo_fft_spectrum(int n, const double *value, double complex *line, struct eo_error *error)
{
  double complex *x = malloc(sizeof *x * (size_t)n);
  if (!x)
    return eo_error_memory(error);
  for (int i = 0; i < n; i++)
    x[i] = value[i];
  enum eo_code code = eo_fft_forward(n, x, error);
  for (int k = 0; k <= n / 2 && !code; k++)
    line[k] = x[k] * (k == 0 || 2 * k == n ? 1.0 : 2.0) / n;
  free(x);
  return code;
}
