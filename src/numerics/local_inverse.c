/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numerics/local_inverse.h"

#include <math.h>
#include <stdlib.h>

/* x of x - ln x = t, the larger one, by Newton. */
static double root(double t)
{
  double x = t + log(t) + 0.5;
  for (int i = 0; i < 60; i++) {
    double step = (x - log(x) - t) / (1 - 1 / x);
    x = fmax(x - step, 1 + (x - 1) / 8);
    if (fabs(step) < 1e-15 * x)
      break;
  }
  return x;
}

enum eo_code eo_local_inverse_init(struct eo_local_inverse *inverse, struct eo_error *error)
{
  enum { NODES = EO_LOCAL_INVERSE_CELLS + 1 };
  static const double HIGHEST = 0.3; /* beyond the last cell that is read, below the turning point e^-1 */
  inverse->node = calloc((size_t)EO_LOCAL_INVERSE_OCTAVES * NODES, sizeof *inverse->node);
  if (!inverse->node)
    return eo_error_memory(error);
  for (int i = 0; i < EO_LOCAL_INVERSE_OCTAVES * NODES; i++) {
    double octave = ldexp(EO_LOCAL_INVERSE_LEAST, i / NODES), width = octave / EO_LOCAL_INVERSE_CELLS,
           u = octave + i % NODES * width;
    if (u > HIGHEST)
      break;
    double x = root(-log(u));
    inverse->node[i][0] = u / x; /* = e^-x */
    inverse->node[i][1] = width / (x - 1);
  }
  return EO_OK;
}

void eo_local_inverse_done(struct eo_local_inverse *inverse)
{
  free(inverse->node);
  inverse->node = NULL;
}
