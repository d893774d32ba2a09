#include "contact/local_inverse.h"

#include <math.h>
#include <stdlib.h>

static const double HIGH = 84.0; /* t at the end of the table */

double eo_local_inverse_root(double t)
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
  inverse->node = malloc(sizeof *inverse->node * EO_LOCAL_INVERSE_NODES);
  if (!inverse->node)
    return eo_error_memory(error);
  inverse->step = (HIGH - EO_LOCAL_INVERSE_LOW) / (EO_LOCAL_INVERSE_NODES - 1);
  for (int i = 0; i < EO_LOCAL_INVERSE_NODES; i++) {
    double x = eo_local_inverse_root(EO_LOCAL_INVERSE_LOW + i * inverse->step);
    inverse->node[i][0] = x;
    inverse->node[i][1] = inverse->step * x / (x - 1);
  }
  return EO_OK;
}

void eo_local_inverse_done(struct eo_local_inverse *inverse)
{
  free(inverse->node);
  inverse->node = NULL;
}
