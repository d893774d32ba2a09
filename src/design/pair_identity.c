/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "design/pair_identity.h"

#include <math.h>

/* One row for each member: what it is called in the key, and its value. */
#define PAIR_MEMBERS(ROW)                                                                  \
  ROW("ends", pair->ends)                                                                  \
  ROW("pinion_teeth", pair->teeth[EO_PINION])                                              \
  ROW("gear_teeth", pair->teeth[EO_GEAR])                                                  \
  ROW("normal_module", pair->normal_module)                                                \
  ROW("normal_pressure_angle", pair->normal_pressure_angle)                                \
  ROW("helix_angle", pair->helix_angle)                                                    \
  ROW("face_width", pair->face_width)                                                      \
  ROW("pinion_face_width", pair->member_width[EO_PINION])                                  \
  ROW("gear_face_width", pair->member_width[EO_GEAR])                                      \
  ROW("right_face_width", pair->right_face_width)                                          \
  ROW("right_helix_angle", pair->right_helix_angle)                                        \
  ROW("groove_width", pair->groove_width)                                                  \
  ROW("addendum_coefficient", pair->addendum_coefficient)                                  \
  ROW("dedendum_coefficient", pair->dedendum_coefficient)                                  \
  ROW("fillet_radius_coefficient", pair->fillet_radius_coefficient)                        \
  ROW("pinion_addendum_coefficient", pair->rack[EO_PINION].addendum_coefficient)           \
  ROW("pinion_dedendum_coefficient", pair->rack[EO_PINION].dedendum_coefficient)           \
  ROW("pinion_fillet_radius_coefficient", pair->rack[EO_PINION].fillet_radius_coefficient) \
  ROW("gear_addendum_coefficient", pair->rack[EO_GEAR].addendum_coefficient)               \
  ROW("gear_dedendum_coefficient", pair->rack[EO_GEAR].dedendum_coefficient)               \
  ROW("gear_fillet_radius_coefficient", pair->rack[EO_GEAR].fillet_radius_coefficient)     \
  ROW("pinion_generating_offset", pair->generating_offset[EO_PINION])                      \
  ROW("pinion_protuberance", pair->protuberance[EO_PINION])                                \
  ROW("pinion_grinding_stock", pair->grinding_stock[EO_PINION])                            \
  ROW("pinion_tip_chamfer", pair->tip_chamfer[EO_PINION])                                  \
  ROW("gear_generating_offset", pair->generating_offset[EO_GEAR])                          \
  ROW("gear_protuberance", pair->protuberance[EO_GEAR])                                    \
  ROW("gear_grinding_stock", pair->grinding_stock[EO_GEAR])                                \
  ROW("gear_tip_chamfer", pair->tip_chamfer[EO_GEAR])                                      \
  ROW("pinion_profile_shift", pair->profile_shift[EO_PINION])                              \
  ROW("gear_profile_shift", pair->profile_shift[EO_GEAR])                                  \
  ROW("centre_distance", pair->centre_distance)                                            \
  ROW("pinion_tip_diameter", pair->tip_diameter[EO_PINION])                                \
  ROW("gear_tip_diameter", pair->tip_diameter[EO_GEAR])                                    \
  ROW("pinion_bore", pair->bore[EO_PINION])                                                \
  ROW("gear_bore", pair->bore[EO_GEAR])                                                    \
  ROW("pinion_groove_diameter", pair->groove_diameter[EO_PINION])                          \
  ROW("gear_groove_diameter", pair->groove_diameter[EO_GEAR])                              \
  ROW("rim_thickness_coefficient", pair->rim_thickness_coefficient)                        \
  ROW("backlash", pair->backlash)                                                          \
  ROW("youngs_modulus", material->youngs_modulus)                                          \
  ROW("poissons_ratio", material->poissons_ratio)                                          \
  ROW("gear_youngs_modulus", material->gear_youngs_modulus)                                \
  ROW("gear_poissons_ratio", material->gear_poissons_ratio)                                \
  ROW("gear_density", material->gear_density)                                              \
  ROW("density", material->density)                                                        \
  ROW("positions", resolution->positions)                                                  \
  ROW("cells_per_line", resolution->cells_per_line)                                        \
  ROW("tip_edge_contact", resolution->tip_edge_contact)                                    \
  ROW("body", resolution->elements.body)                                                   \
  ROW("body_support", resolution->elements.support)                                        \
  ROW("sector_teeth", resolution->elements.sector_teeth)                                   \
  ROW("neighbour_coupling", resolution->elements.neighbour_coupling)                       \
  ROW("layers", resolution->elements.layers)                                               \
  ROW("flank_rows", resolution->elements.flank_rows)                                       \
  ROW("fillet_elements", resolution->elements.fillet_elements)                             \
  ROW("impact_patch", resolution->impact_patch)                                            \
  ROW("centre_distance_deviation", deviation)

#define NAME(name, value) name,
#define VALUE(name, value) value,

static const char *const names[] = {PAIR_MEMBERS(NAME)};
_Static_assert(sizeof names / sizeof *names == EO_PAIR_MEMBERS, "one value for each name");

struct eo_pair_identity eo_pair_identity_of(const struct eo_gear_pair *pair, const struct eo_material *material,
                                            const struct eo_resolution *resolution, double deviation)
{
  return (struct eo_pair_identity){{PAIR_MEMBERS(VALUE)}};
}

struct eo_pair_identity eo_pair_identity_of_design(const struct eo_design *design)
{
  return eo_pair_identity_of(&design->gear_pair, &design->material, &design->resolution,
                             design->alignment.centre_distance_deviation);
}

bool eo_pair_identity_equal(const struct eo_pair_identity *a, const struct eo_pair_identity *b)
{
  for (int i = 0; i < EO_PAIR_MEMBERS; i++)
    if (a->value[i] != b->value[i] && !(isnan(a->value[i]) && isnan(b->value[i])))
      return false;
  return true;
}

void eo_pair_identity_key(const struct eo_pair_identity *identity, char key[EO_HASH_LENGTH + 1])
{
  struct eo_hash hash;
  eo_hash_init(&hash);
  for (int i = 0; i < EO_PAIR_MEMBERS; i++)
    eo_hash_add_number(&hash, names[i], identity->value[i]);
  eo_hash_finish(&hash, key);
}
