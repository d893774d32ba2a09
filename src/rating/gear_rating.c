/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rating/gear_rating.h"

#include <math.h>

double eo_rating_hardness(enum eo_rating_material material)
{
  static const double lowest[] = {
      [EO_CASE_HARDENED] = 660,           [EO_FLAME_HARDENED] = 500, [EO_THROUGH_HARDENED_ALLOY] = 200,
      [EO_THROUGH_HARDENED_CARBON] = 135, [EO_STRUCTURAL] = NAN,     [EO_NITRIDED_NITRIDING_STEEL] = 650,
      [EO_NITRIDED_THROUGH_STEEL] = 450,  [EO_NITROCARBURISED] = 300};
  return lowest[material];
}

static void set_pair(struct eo_rating_pair *pair, const struct eo_geometry *g)
{
  *pair = (struct eo_rating_pair){.normal_module = g->normal_module,
                                  .normal_pressure_angle = g->normal_pressure_angle,
                                  .helix_angle = g->helix_angle,
                                  .face_width = g->face_width,
                                  .centre_distance = g->centre_distance};
  for (int i = 0; i < 2; i++) {
    pair->teeth[i] = g->teeth[i];
    pair->tip_diameter[i] = 2 * g->tip_radius[i];
  }
}

/* ISO 6336-1 9.3 with solid discs and C_M = 0.8, the nominal shifts. */
static void set_stiffness(struct eo_rating_basis *basis)
{
  const struct eo_geometry *g = basis->input.geometry;
  const struct eo_iso_stiffness_input input = {.teeth = {g->teeth[0], g->teeth[1]},
                                               .virtual_teeth = EO_ISO_VIRTUAL_EXACT,
                                               .normal_pressure_angle = g->normal_pressure_angle,
                                               .helix_angle = g->helix_angle,
                                               .profile_shift = {g->profile_shift[0], g->profile_shift[1]},
                                               .dedendum_coefficient = (g->dedendum[EO_PINION] + g->dedendum[EO_GEAR]) /
                                                                       (2 * g->normal_module), /* C_B: the mean */
                                               .transverse_contact_ratio = basis->geometry.transverse_contact_ratio,
                                               .blank_factor = 1,
                                               .theory_factor = 0.8,
                                               .youngs_modulus = eo_material_mean_modulus(basis->input.material)};
  eo_iso_stiffness(&basis->stiffness, &input);
}

/* Rims down to the bore: (30), (6) of ISO 6336-1. */
static void set_resonance(struct eo_rating_basis *basis)
{
  const struct eo_geometry *g = basis->input.geometry;
  struct eo_wheel_blank blank[2];
  for (int i = 0; i < 2; i++)
    blank[i] = (struct eo_wheel_blank){.tip_diameter = 2 * g->tip_radius[i],
                                       .root_diameter = 2 * g->root_radius[i],
                                       .base_diameter = 2 * g->base_radius[i],
                                       .bore = basis->input.pair->bore[i],
                                       .density = eo_material_of(basis->input.material, i).density};
  basis->reduced_mass = eo_reduced_mass(blank, (double)g->teeth[1] / g->teeth[0]);
  basis->resonance_speed = eo_resonance_speed(g->teeth[0], basis->stiffness.mesh_alpha, basis->reduced_mass);
}

enum eo_tolerance_edition eo_rating_tolerance_edition(const struct eo_rating_settings *rating)
{
  return rating->edition == EO_ISO6336_2019 ? EO_ISO1328_2013 : EO_ISO1328_1995;
}

static enum eo_code set_tolerances(struct eo_rating_basis *basis, struct eo_error *error)
{
  const struct eo_rating_settings *r = basis->input.rating;
  enum eo_tolerance_edition edition = eo_rating_tolerance_edition(r);
  for (int i = 0; i < 2; i++) {
    struct eo_tolerance_input in = {.reference_diameter = basis->geometry.reference_diameter[i],
                                    .normal_module = basis->pair.normal_module,
                                    .face_width = basis->input.geometry->member_width[i],
                                    .teeth = basis->pair.teeth[i],
                                    .grade = r->accuracy_grade,
                                    .total_contact_ratio = basis->geometry.transverse_contact_ratio +
                                                           basis->geometry.overlap_ratio};
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
  const struct eo_rating_member *m = &basis->input.rating->member[i];
  struct eo_strength *s = &basis->strength[i];
  basis->hardness[i] = isnan(m->hardness) ? eo_rating_hardness(m->material) : m->hardness;
  if (isnan(m->flank_limit) || isnan(m->root_limit))
    EO_TRY(eo_material_strength(s, m->material, m->quality, m->core, basis->hardness[i], error));
  s->flank = isnan(m->flank_limit) ? s->flank : m->flank_limit;
  s->root = isnan(m->root_limit) ? s->root : m->root_limit;
  return EO_OK;
}

/* b of a root: of a wider member at most one module more than the common face on each side (ISO 6336-3 5.2.2). */
static double root_face_width(const struct eo_geometry *g, int i)
{
  return fmin(g->member_width[i], g->face_width + 2 * g->normal_module);
}

/* Form, stress, notch, surface and size of one root; Y_B of the rim down to the bore. */
static enum eo_code set_root(struct eo_rating_basis *basis, int i, struct eo_error *error)
{
  const struct eo_rating_settings *r = basis->input.rating;
  const struct eo_rating_member *m = &r->member[i];
  const struct eo_geometry *g = basis->input.geometry;
  double thinning = r->root_shift == EO_ROOT_SHIFT_NOMINAL ? 0 : basis->input.thickness_allowance[i];
  struct eo_tooth_root_input in = {
      .edition = r->edition,
      .generating_shift = g->profile_shift[i] + thinning / (2 * g->normal_module * tan(g->normal_pressure_angle)),
      .dedendum_coefficient = g->dedendum[i] / g->normal_module,
      .fillet_radius_coefficient = g->fillet_radius[i] / g->normal_module,
      .tangential_force = 1,
      .face_width = root_face_width(g, i),
      .grade = r->accuracy_grade};
  EO_TRY(eo_tooth_root(&basis->root[i], &basis->pair, &basis->geometry, i, &in, error));
  double depth = g->tip_radius[i] - g->root_radius[i], rim = g->root_radius[i] - basis->input.pair->bore[i] / 2;
  EO_TRY(eo_rim_factor(&basis->rim_factor[i], rim / depth, error));
  struct eo_root_influence *y = &basis->endurance[i];
  y->life = 1;
  y->mean = m->mean_stress;
  y->surface = eo_root_surface_factor(m->material, m->root_roughness);
  y->size = eo_root_size_factor(m->material, g->normal_module);
  return eo_notch_sensitivity(&y->notch, m->material, basis->root[i].notch, m->proof_stress, error);
}

enum eo_code eo_rating_basis_init(struct eo_rating_basis *basis, const struct eo_rating_input *input,
                                  struct eo_error *error)
{
  const struct eo_geometry *g = input->geometry;
  const struct eo_rating_settings *r = input->rating;
  *basis = (struct eo_rating_basis){.input = *input};
  set_pair(&basis->pair, g);
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
    basis->flank_life[i] = eo_life_flank(r->member[i].material, r->some_pitting, r->long_life);
    basis->root_life[i] = eo_life_root(r->member[i].material, r->long_life);
    basis->width_over_depth = fmin(basis->width_over_depth,
                                   g->member_width[i] / (g->tip_radius[i] - g->root_radius[i]));
  }
  return EO_OK;
}
