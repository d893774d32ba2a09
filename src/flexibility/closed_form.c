/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/closed_form.h"

#include <math.h>
#include <stddef.h>

static double profile(const struct eo_closed_form *form, const struct eo_flank_point *point)
{
  double s = (point->s[0] + point->s[1]) / 2 - form->centre;
  return 1 + form->linear * fabs(s) + form->quadratic * s * s;
}

void eo_closed_form_kernel(const void *context, int n, const struct eo_flank_point *point, double *compliance)
{
  const struct eo_closed_form *form = context;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double distance = fabs(point[i].eta - point[j].eta) / form->length;
      compliance[(size_t)i * (size_t)n + (size_t)j] = point[i].pair != point[j].pair
                                                          ? 0
                                                          : form->compliance * exp(-distance) *
                                                                profile(form, &point[i]) * profile(form, &point[j]);
    }
}
