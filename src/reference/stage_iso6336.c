/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/stage.h"
#include "contact/iso6336.h"
#include "document/design_document.h"
#include "gear/entry.h"

struct input {
  struct eo_gear_pair gear_pair;
  struct eo_material material;
  double torque, blank_factor;
  enum eo_iso_virtual virtual_teeth;
};

static const char *const virtual_teeth[] = {"cos_cubed", "base_helix", NULL};

static const struct eo_field input[] = {
    EO_OBJECT(struct input, gear_pair, "gear_pair", &eo_gear_pair_table, "as in a design document"),
    EO_OBJECT(struct input, material, "material", &eo_material_table, "as in a design document"),
    EO_NUMBER(struct input, torque, "torque_Nm", &eo_unit_Nm, 1e-3, 1e8, 1, "on the pinion shaft, all ends together"),
    EO_NUMBER(struct input, blank_factor, "blank_factor", NULL, 0.1, 1, 1, "C_R; 1: solid discs"),
    EO_CHOICE(struct input, virtual_teeth, "virtual_teeth", virtual_teeth, EO_ISO_VIRTUAL_CUBED,
              "for the stiffness: z/cos^3 beta (ISO 6336-1) or z/(cos^2 beta_b cos beta)"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

struct output {
  struct eo_iso_stiffness uncorrected, corrected;
  struct eo_iso_root root[2];
};

static const struct eo_field stiffness[] = {
    EO_OUT_PAIR(struct eo_iso_stiffness, virtual_teeth, "virtual_teeth", NULL, "[pinion, gear] z_n"),
    EO_OUT(struct eo_iso_stiffness, flexibility, "flexibility_um_mm_per_N", &eo_unit_um_mm_per_N, "q'"),
    EO_OUT(struct eo_iso_stiffness, theoretical, "theoretical_N_per_mm_um", &eo_unit_N_per_mm_um, "c'_th"),
    EO_OUT(struct eo_iso_stiffness, rack_factor, "rack_factor", NULL, "C_B"),
    EO_OUT(struct eo_iso_stiffness, single, "single_N_per_mm_um", &eo_unit_N_per_mm_um,
           "c': one pair of teeth, transverse, per face width"),
    EO_OUT(struct eo_iso_stiffness, mesh_alpha, "mesh_alpha_N_per_mm_um", &eo_unit_N_per_mm_um,
           "c_gamma_alpha: mean of the mesh"),
    EO_OUT(struct eo_iso_stiffness, mesh_beta, "mesh_beta_N_per_mm_um", &eo_unit_N_per_mm_um,
           "c_gamma_beta, for load distribution over the face"),
};
static const struct eo_table stiffness_table = EO_TABLE("stiffness", struct eo_iso_stiffness, stiffness);

static const struct eo_field root[] = {
    EO_OUT(struct eo_iso_root, virtual_teeth, "virtual_teeth", NULL, "z_n"),
    EO_OUT(struct eo_iso_root, tangential_force, "tangential_force_N", &eo_unit_N,
           "F_t at the reference cylinder of one end"),
    EO_OUT(struct eo_iso_root, chord, "chord_mm", &eo_unit_mm, "s_Fn"),
    EO_OUT(struct eo_iso_root, arm, "arm_mm", &eo_unit_mm, "h_Fe"),
    EO_OUT(struct eo_iso_root, fillet_radius, "fillet_radius_mm", &eo_unit_mm, "rho_F"),
    EO_OUT(struct eo_iso_root, form_factor, "form_factor", NULL, "Y_F"),
    EO_OUT(struct eo_iso_root, stress_correction, "stress_correction", NULL, "Y_S"),
    EO_OUT(struct eo_iso_root, helix_factor, "helix_factor", NULL, "Y_beta"),
    EO_OUT(struct eo_iso_root, rim_factor, "rim_factor", NULL, "Y_B"),
    EO_OUT(struct eo_iso_root, stress, "stress_MPa", &eo_unit_MPa, "sigma_F0, nominal"),
};
static const struct eo_table root_table = EO_TABLE("root", struct eo_iso_root, root);

static const struct eo_field output[] = {
    EO_OBJECT(struct output, corrected, "stiffness", &stiffness_table, "ISO 6336-1 method B, with C_M = 0.8"),
    EO_OBJECT(struct output, uncorrected, "stiffness_without_correction", &stiffness_table,
              "the same with C_M = 1: what a computation should give"),
    EO_OBJECT(struct output, root[EO_PINION], "pinion_root", &root_table, "ISO 6336-3 method B"),
    EO_OBJECT(struct output, root[EO_GEAR], "gear_root", &root_table, "ISO 6336-3 method B"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  struct eo_design design = {.gear_pair = given->gear_pair, .material = given->material};
  const struct eo_gear_pair *pair = &design.gear_pair;
  struct eo_geometry geometry;
  enum eo_code code = eo_gear_pair_settle(&design.gear_pair, error);
  if (!code)
    code = eo_geometry_init(&geometry, pair, error);
  if (code)
    return code;
  eo_design_resolve(&design, &geometry);
  struct eo_iso_stiffness_input rack = {.teeth = {pair->teeth[0], pair->teeth[1]},
                                        .virtual_teeth = given->virtual_teeth,
                                        .normal_pressure_angle = pair->normal_pressure_angle,
                                        .helix_angle = pair->helix_angle,
                                        .profile_shift = {pair->profile_shift[0], pair->profile_shift[1]},
                                        .dedendum_coefficient = pair->dedendum_coefficient,
                                        .transverse_contact_ratio = geometry.transverse_contact_ratio,
                                        .blank_factor = given->blank_factor,
                                        .theory_factor = 0.8,
                                        .youngs_modulus = given->material.youngs_modulus};
  eo_iso_stiffness(&found->corrected, &rack);
  rack.theory_factor = 1;
  eo_iso_stiffness(&found->uncorrected, &rack);
  for (int i = 0; i < 2; i++)
    eo_iso_root(&found->root[i], &geometry, i, design.gear_pair.bore[i],
                given->torque / pair->ends * pair->teeth[i] / pair->teeth[0]);
  return EO_OK;
}

const struct eo_stage eo_stage_iso6336 = {
    "iso6336", "the standard's estimates: mesh stiffness and nominal root stress", &input_table, &output_table, false,
    run};
