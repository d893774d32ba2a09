/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/load_bow.h"

#include <math.h>

enum { OWN = EO_LOADED_NEARBY / 2, LAST = EO_LOADED_NEARBY };

/* The slope of the load itself is known; those of its neighbours are those of parabolas, and on the outside the change
   goes on in proportion. None is so steep that Z would not grow all the way (Fritsch and Carlson 1980). */
static void set_slopes(struct eo_load_bow *bow, double own)
{
  double secant[LAST];
  for (int i = 0; i < LAST; i++)
    secant[i] = (bow->z[i + 1] - bow->z[i]) / (bow->x[i + 1] - bow->x[i]);
  for (int i = 1; i < LAST; i++) {
    double before = bow->x[i] - bow->x[i - 1], behind = bow->x[i + 1] - bow->x[i],
           slope = i == OWN ? own : (secant[i - 1] * behind + secant[i] * before) / (before + behind);
    bow->slope[i] = fmin(slope, 3 * fmin(secant[i - 1], secant[i]));
  }
  bow->slope[0] = secant[0] * fmin(3, secant[0] / bow->slope[1]);
  bow->slope[LAST] = secant[LAST - 1] * fmin(3, secant[LAST - 1] / bow->slope[LAST - 1]);
}

void eo_load_bow_init(struct eo_load_bow *bow, const struct eo_loaded_end *loaded, int j)
{
  const double *nearby = loaded->nearby + j * EO_LOADED_NEARBY;
  for (int i = 0; i < EO_LOADED_NEARBY; i++) {
    int node = i < OWN ? i : i + 1;
    bow->x[node] = EO_LOADED_NEARBY_SHARE[i] - 1;
    bow->z[node] = nearby[i];
  }
  bow->x[OWN] = 0;
  bow->z[OWN] = loaded->approach[j];
  set_slopes(bow, loaded->load[j] / loaded->tangent[j]);
}

double eo_load_bow_at(const struct eo_load_bow *bow, double x)
{
  int i = 0;
  while (i < LAST && x > bow->x[i + 1])
    i++;
  if (x <= bow->x[0] || i == LAST)
    return bow->z[i] + (x - bow->x[i]) * bow->slope[i];
  /* theory (L4) */
  double width = bow->x[i + 1] - bow->x[i], t = (x - bow->x[i]) / width, s = 1 - t;
  return (1 + 2 * t) * s * s * bow->z[i] + t * t * (1 + 2 * s) * bow->z[i + 1] +
         width * t * s * (s * bow->slope[i] - t * bow->slope[i + 1]);
}
