/* The local law of line contact (Weber and Banaschek 1953) and its inverse: delta = K q (L - ln q).
   With x = L - ln q and t = L - ln(delta/K): x - ln x = t, x > 1 (q below the law's turning point), q = delta/(K x),
   dq/ddelta = 1/(K (x - 1)). x(t) is one universal function, tabulated with its slope x/(x - 1). From x = 2 on, where
   the contact is as wide as the tooth is thick and the law has lost its meaning, q goes on in a straight line, so that
   every load has its solution. */
#ifndef EASEOFF_CONTACT_LOCAL_INVERSE_H
#define EASEOFF_CONTACT_LOCAL_INVERSE_H

#include "base/error.h"

enum { EO_LOCAL_INVERSE_NODES = 4096 };
static const double EO_LOCAL_INVERSE_STRAIGHT = 2;             /* x from which the law is straight */
static const double EO_LOCAL_INVERSE_LOW = 1.3068528194400546; /* t there: 2 - ln 2 */

struct eo_local_inverse {
  double (*node)[2]; /* [EO_LOCAL_INVERSE_NODES], owned: x and step * dx/dt at t = EO_LOCAL_INVERSE_LOW + i step */
  double step;
};

enum eo_code eo_local_inverse_init(struct eo_local_inverse *inverse, struct eo_error *error);
void eo_local_inverse_done(struct eo_local_inverse *inverse);

/* x at t > EO_LOCAL_INVERSE_LOW, by iteration. */
double eo_local_inverse_root(double t);

/* The same from the table; beyond its end by iteration. */
static inline double eo_local_inverse_at(const struct eo_local_inverse *inverse, double t)
{
  double u = (t - EO_LOCAL_INVERSE_LOW) / inverse->step;
  if (!(u < EO_LOCAL_INVERSE_NODES - 1))
    return eo_local_inverse_root(t);
  int i = (int)u;
  const double *low = inverse->node[i], *high = inverse->node[i + 1];
  double r = u - i, l = 1 - r, difference = high[0] - low[0], a = low[1] - difference, b = difference - high[1];
  return low[0] * l + high[0] * r + r * l * (a * l + b * r);
}

#endif
