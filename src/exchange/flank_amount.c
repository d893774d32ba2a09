/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/flank_amount.h"

#include <math.h>
#include <string.h>

#include "document/flank_grid_document.h"
#include "gear/modification.h"

double eo_flank_amount(const struct eo_design *design, const struct eo_geometry *geometry, int member, int end,
                       bool coast, double u, double y)
{
  struct eo_modification_shape shape;
  struct eo_flank_spline *spline = NULL;
  if (eo_flank_shape(design, geometry, coast ? EO_COAST_FLANK : EO_DRIVE_FLANK, member, end, &shape, &spline))
    return NAN;
  double amount = eo_modification_at(&shape, u, coast ? -y : y);
  eo_flank_spline_free(spline);
  return amount;
}

double eo_relief_carry(const char *shape, double depth, double reference, double end)
{
  double ratio = end / reference;
  if (strcmp(shape, "linear") == 0)
    return depth * ratio;
  if (strcmp(shape, "parabolic") == 0)
    return depth * ratio * ratio;
  double radius = (reference * reference + depth * depth) / (2 * depth);
  return radius - sqrt(fmax(0, radius * radius - end * end));
}
