/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/flank_amount.h"

#include <math.h>

#include "gear/modification.h"

double eo_flank_amount(const struct eo_design *design, const struct eo_geometry *geometry, int member, int end,
                       bool coast, double u, double y)
{
  struct eo_modification_shape shape;
  double slope[2], unused;
  if (coast) /* unmodified */
    return 0;
  eo_modification_init(&shape, geometry, member, &design->modification.flank[member][end]);
  return eo_modification_profile(&shape, u, slope) +
         eo_modification_lead(&shape, y / cos(geometry->helix_angle), &unused);
}
