/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/backlash.h"

#include <math.h>

#include "gear/entry.h"
#include "gear/geometry.h"

/* inv alpha = inv alpha_t + (2 tan alpha_n sum x + sum A_sn/m_n)/sum z: where the (thinned) teeth touch on both flanks
   (ISO 21771). */
static double tight_involute(const struct eo_backlash_input *in, double transverse, double allowance)
{
  double shift = in->profile_shift[0] + in->profile_shift[1];
  return eo_geometry_involute_function(transverse) +
         (2 * tan(in->normal_pressure_angle) * shift + allowance / in->normal_module) / (in->teeth[0] + in->teeth[1]);
}

enum eo_code eo_backlash(struct eo_backlash *backlash, const struct eo_backlash_input *in, struct eo_error *error)
{
  double transverse = atan(tan(in->normal_pressure_angle) / cos(in->helix_angle));
  double base_helix = asin(sin(in->helix_angle) * cos(in->normal_pressure_angle));
  double base = in->normal_module / cos(in->helix_angle) * (in->teeth[0] + in->teeth[1]) / 2 * cos(transverse);
  double allowance = in->allowance[0] + in->allowance[1];
  double unthinned = tight_involute(in, transverse, 0), thinned = tight_involute(in, transverse, allowance);
  EO_TRY(eo_geometry_check_distance(in->centre_distance, base, "/centre_distance_mm", error));
  if (!(thinned > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/x",
                        "Profile shifts and allowances are so negative that both flanks never touch.");
  double working = acos(base / in->centre_distance);
  double beyond = 2 * base * cos(base_helix) * (eo_geometry_involute_function(working) - unthinned);
  backlash->normal = -allowance * cos(in->normal_pressure_angle) +
                     2 * in->centre_distance_allowance * sin(working) * cos(base_helix) + beyond; /* DIN 3967 */
  backlash->circumferential = backlash->normal / (cos(working) * cos(base_helix));
  backlash->of_reference = backlash->circumferential * cos(in->normal_pressure_angle) * cos(in->helix_angle);
  backlash->of_distance = 2 * in->centre_distance_allowance * tan(working);
  backlash->tight_distance = base / cos(eo_geometry_involute_inverse(thinned));
  backlash->radial = in->centre_distance + in->centre_distance_allowance - backlash->tight_distance;
  return EO_OK;
}
