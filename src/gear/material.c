/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "gear/gear_pair.h"

struct eo_material eo_material_of(const struct eo_material *material, int member)
{
  struct eo_material own = {material->youngs_modulus, material->poissons_ratio, material->density, NAN, NAN, NAN};
  if (member == EO_PINION)
    return own;
  bool other = material->gear_youngs_modulus > 0;
  if (other)
    own.youngs_modulus = material->gear_youngs_modulus;
  if (material->gear_poissons_ratio > 0 || (other && material->gear_poissons_ratio == 0))
    own.poissons_ratio = material->gear_poissons_ratio;
  if (material->gear_density > 0)
    own.density = material->gear_density;
  return own;
}

bool eo_material_is_one(const struct eo_material *material)
{
  struct eo_material pinion = eo_material_of(material, EO_PINION), gear = eo_material_of(material, EO_GEAR);
  return pinion.youngs_modulus == gear.youngs_modulus && pinion.poissons_ratio == gear.poissons_ratio &&
         pinion.density == gear.density;
}

static double plane_compliance(const struct eo_material *material)
{
  return (1 - material->poissons_ratio * material->poissons_ratio) / material->youngs_modulus;
}

double eo_material_contact_modulus(const struct eo_material *material)
{
  struct eo_material pinion = eo_material_of(material, EO_PINION), gear = eo_material_of(material, EO_GEAR);
  if (eo_material_is_one(material))
    return pinion.youngs_modulus;
  return 2 * (1 - pinion.poissons_ratio * pinion.poissons_ratio) /
         (plane_compliance(&pinion) + plane_compliance(&gear));
}

double eo_material_mean_modulus(const struct eo_material *material)
{
  double pinion = eo_material_of(material, EO_PINION).youngs_modulus,
         gear = eo_material_of(material, EO_GEAR).youngs_modulus;
  return pinion == gear ? pinion : 2 * pinion * gear / (pinion + gear);
}
