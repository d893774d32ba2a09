/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/gear_rating.h"

#include <math.h>

/* What the rating assumes where a member states none: hardness, HV, of the class. */
static double class_hardness(enum eo_rating_material material)
{
  static const double lowest[] = {
      [EO_CASE_HARDENED] = 660,           [EO_FLAME_HARDENED] = 500, [EO_THROUGH_HARDENED_ALLOY] = 200,
      [EO_THROUGH_HARDENED_CARBON] = 135, [EO_STRUCTURAL] = NAN,     [EO_NITRIDED_NITRIDING_STEEL] = 650,
      [EO_NITRIDED_THROUGH_STEEL] = 450,  [EO_NITROCARBURISED] = 300};
  return lowest[material];
}

static void set_pair(struct eo_rating_pair *pair, const struct eo_geometry *geometry)
{
  *pair = (struct eo_rating_pair){.normal_module = geometry->normal_module,
                                  .normal_pressure_angle = geometry->normal_pressure_angle,
                                  .helix_angle = geometry->helix_angle,
                                  .face_width = geometry->face_width,
                                  .centre_distance = geometry->centre_distance};
  for (int i = 0; i < 2; i++) {
    pair->teeth[i] = geometry->teeth[i];
    pair->tip_diameter[i] = 2 * geometry->tip_radius[i];
  }
}

/* ISO 6336-1 9.3 with solid discs and C_M = 0.8, the nominal shifts. */
static void set_stiffness(struct eo_rating_basis *basis)
{
  const struct eo_geometry *geometry = basis->input.geometry;
  const struct eo_iso_stiffness_input input = {
      .teeth = {geometry->teeth[0], geometry->teeth[1]},
      .virtual_teeth = EO_ISO_VIRTUAL_EXACT,
      .normal_pressure_angle = geometry->normal_pressure_angle,
      .helix_angle = geometry->helix_angle,
      .profile_shift = {geometry->profile_shift[0], geometry->profile_shift[1]},
      .dedendum_coefficient = (geometry->dedendum[EO_PINION] + geometry->dedendum[EO_GEAR]) /
                              (2 * geometry->normal_module), /* C_B: the mean */
      .transverse_contact_ratio = basis->geometry.transverse_contact_ratio,
      .blank_factor = 1,
      .theory_factor = 0.8,
      .youngs_modulus = eo_material_mean_modulus(basis->input.material)};
  eo_iso_stiffness(&basis->stiffness, &input);
}

/* Rims down to the bore: (30), (6) of ISO 6336-1. */
static void set_resonance(struct eo_rating_basis *basis)
{
  const struct eo_geometry *geometry = basis->input.geometry;
  struct eo_wheel_blank blank[2];
  for (int i = 0; i < 2; i++)
    blank[i] = (struct eo_wheel_blank){.tip_diameter = 2 * geometry->tip_radius[i],
                                       .root_diameter = 2 * geometry->root_radius[i],
                                       .base_diameter = 2 * geometry->base_radius[i],
                                       .bore = basis->input.pair->bore[i],
                                       .density = eo_material_of(basis->input.material, i).density};
  basis->reduced_mass = eo_reduced_mass(blank, (double)geometry->teeth[1] / geometry->teeth[0]);
  basis->resonance_speed = eo_resonance_speed(geometry->teeth[0], basis->stiffness.mesh_alpha, basis->reduced_mass);
}

enum eo_tolerance_edition eo_rating_tolerance_edition(const struct eo_rating_settings *rating)
{
  return rating->edition == EO_ISO6336_2019 ? EO_ISO1328_2013 : EO_ISO1328_1995;
}

static enum eo_code set_tolerances(struct eo_rating_basis *basis, struct eo_error *error)
{
  const struct eo_rating_settings *settings = basis->input.rating;
  enum eo_tolerance_edition edition = eo_rating_tolerance_edition(settings);
  for (int i = 0; i < 2; i++) {
    struct eo_tolerance_input in = {.reference_diameter = basis->geometry.reference_diameter[i],
                                    .normal_module = basis->pair.normal_module,
                                    .face_width = basis->input.geometry->member_width[i],
                                    .teeth = basis->pair.teeth[i],
                                    .grade = settings->accuracy_grade,
                                    .total_contact_ratio = basis->geometry.transverse_contact_ratio +
                                                           basis->geometry.overlap_ratio,
                                    .helix_angle = basis->pair.helix_angle};
    EO_TRY(eo_flank_tolerance(&basis->tolerance[i], edition, &in, error));
    basis->base_pitch_tolerance[i] = eo_base_pitch_tolerance(basis->tolerance[i].single_pitch,
                                                             basis->geometry.transverse_pressure_angle);
  }
  basis->mesh_deviation = eo_mesh_deviation(basis->tolerance[0].helix_slope, basis->tolerance[1].helix_slope);
  return EO_OK;
}

/* As stated, or by class and hardness from ISO 6336-5. */
static enum eo_code set_strength(struct eo_rating_basis *basis, int i, struct eo_error *error)
{
  const struct eo_rating_member *member = &basis->input.rating->member[i];
  struct eo_strength *strength = &basis->strength[i];
  basis->hardness[i] = isnan(member->hardness) ? class_hardness(member->material) : member->hardness;
  if (isnan(member->flank_limit) || isnan(member->root_limit))
    EO_TRY(eo_material_strength(strength, member->material, member->quality, member->core, basis->hardness[i], error));
  strength->flank = isnan(member->flank_limit) ? strength->flank : member->flank_limit;
  strength->root = isnan(member->root_limit) ? strength->root : member->root_limit;
  return EO_OK;
}

/* b of a root: of a wider member at most one module more than the common face on each side (ISO 6336-3 5.2.2). */
static double root_face_width(const struct eo_geometry *geometry, int i)
{
  return fmin(geometry->member_width[i], geometry->face_width + 2 * geometry->normal_module);
}

/* Form, stress, notch, surface and size of one root; Y_B of the rim down to the bore. */
static enum eo_code set_root(struct eo_rating_basis *basis, int i, struct eo_error *error)
{
  const struct eo_rating_settings *settings = basis->input.rating;
  const struct eo_rating_member *member = &settings->member[i];
  const struct eo_geometry *geometry = basis->input.geometry;
  double thinning = settings->root_shift == EO_ROOT_SHIFT_NOMINAL ? 0 : basis->input.thickness_allowance[i];
  struct eo_tooth_root_input in = {
      .edition = settings->edition,
      .generating_shift = geometry->profile_shift[i] +
                          thinning / (2 * geometry->normal_module * tan(geometry->normal_pressure_angle)),
      .dedendum_coefficient = geometry->dedendum[i] / geometry->normal_module,
      .fillet_radius_coefficient = geometry->fillet_radius[i] / geometry->normal_module,
      .tangential_force = 1,
      .face_width = root_face_width(geometry, i),
      .grade = settings->accuracy_grade};
  EO_TRY(eo_tooth_root(&basis->root[i], &basis->pair, &basis->geometry, i, &in, error));
  double depth = geometry->tip_radius[i] - geometry->root_radius[i],
         rim = geometry->root_radius[i] - basis->input.pair->bore[i] / 2;
  EO_TRY(eo_rim_factor(&basis->rim_factor[i], rim / depth, error));
  struct eo_root_influence *influence = &basis->endurance[i];
  influence->life = 1;
  influence->mean = member->mean_stress;
  influence->surface = eo_root_surface_factor(member->material, member->root_roughness);
  influence->size = eo_root_size_factor(member->material, geometry->normal_module);
  return eo_notch_sensitivity(&influence->notch, member->material, basis->root[i].notch, member->proof_stress, error);
}

enum eo_code eo_rating_basis_init(struct eo_rating_basis *basis, const struct eo_rating_input *input,
                                  struct eo_error *error)
{
  const struct eo_geometry *geometry = input->geometry;
  const struct eo_rating_settings *settings = input->rating;
  *basis = (struct eo_rating_basis){.input = *input};
  set_pair(&basis->pair, geometry);
  EO_TRY(eo_rating_geometry(&basis->geometry, &basis->pair, error));
  set_stiffness(basis);
  set_resonance(basis);
  EO_TRY(set_tolerances(basis, error));
  basis->relative_curvature = eo_relative_curvature(basis->geometry.base_diameter,
                                                    basis->geometry.working_pressure_angle);
  basis->width_over_depth = INFINITY;
  for (int i = 0; i < 2; i++) {
    EO_TRY(set_strength(basis, i, error));
    EO_TRY(set_root(basis, i, error));
    basis->flank_life[i] = eo_life_flank(settings->member[i].material, settings->some_pitting, settings->long_life);
    basis->root_life[i] = eo_life_root(settings->member[i].material, settings->long_life);
    basis->width_over_depth = fmin(basis->width_over_depth,
                                   geometry->member_width[i] / (geometry->tip_radius[i] - geometry->root_radius[i]));
  }
  return EO_OK;
}
