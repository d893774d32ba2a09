/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/geometry_table.h"

#include "gear/geometry.h"

#define ONE(member, key, unit, help) EO_OUT(struct eo_geometry, member, key, unit, help)
#define TWO(member, key, unit, help) EO_OUT_PAIR(struct eo_geometry, member, key, unit, "[pinion, gear] " help)

static const struct eo_field geometry[] = {
    EO_INTEGER(struct eo_geometry, teeth[EO_PINION], "pinion_teeth", 0, INFINITY, 0, "z_1"),
    EO_INTEGER(struct eo_geometry, teeth[EO_GEAR], "gear_teeth", 0, INFINITY, 0, "z_2"),
    ONE(normal_module, "normal_module_mm", &eo_unit_mm, "m_n"),
    ONE(transverse_module, "transverse_module_mm", &eo_unit_mm, "m_t"),
    ONE(normal_pressure_angle, "normal_pressure_angle_deg", &eo_unit_deg, "alpha_n"),
    ONE(transverse_pressure_angle, "transverse_pressure_angle_deg", &eo_unit_deg, "alpha_t"),
    ONE(working_pressure_angle, "working_pressure_angle_deg", &eo_unit_deg, "alpha_wt, transverse"),
    ONE(helix_angle, "helix_angle_deg", &eo_unit_deg, "beta"),
    ONE(base_helix_angle, "base_helix_angle_deg", &eo_unit_deg, "beta_b"),
    ONE(face_width, "face_width_mm", &eo_unit_mm, "b of one end, common to both members"),
    TWO(member_width, "member_face_width_mm", &eo_unit_mm, "own face width of one end"),
    TWO(reference_radius, "reference_radius_mm", &eo_unit_mm, "r"),
    TWO(working_radius, "working_radius_mm", &eo_unit_mm, "r_w"),
    TWO(base_radius, "base_radius_mm", &eo_unit_mm, "r_b"),
    TWO(tip_radius, "tip_radius_mm", &eo_unit_mm, "r_a"),
    TWO(tip_form_radius, "tip_form_radius_mm", &eo_unit_mm, "r_Fa: where a tip chamfer ends the flank"),
    TWO(root_radius, "root_radius_mm", &eo_unit_mm, "r_f"),
    TWO(form_radius, "form_radius_mm", &eo_unit_mm, "r_Ff: fillet meets involute"),
    TWO(start_radius, "active_start_radius_mm", &eo_unit_mm, "where the active profile starts"),
    TWO(profile_shift, "profile_shift", NULL, "x"),
    TWO(generating_shift, "generating_shift", NULL, "x_E: with which the root is cut"),
    TWO(residual_undercut, "residual_undercut_um", &eo_unit_um, "s_pr: protuberance beyond the grinding stock"),
    ONE(centre_distance, "centre_distance_mm", &eo_unit_mm, "a_w"),
    ONE(transverse_base_pitch, "transverse_base_pitch_mm", &eo_unit_mm, "p_bt"),
    ONE(normal_base_pitch, "normal_base_pitch_mm", &eo_unit_mm, "p_bn"),
    TWO(tangent_length, "tangent_length_mm", &eo_unit_mm,
        "from the base circle to the pitch point along the line of action"),
    ONE(path_start, "path_start_mm", &eo_unit_mm, "s_A: contact starts at the gear's tip"),
    ONE(path_end, "path_end_mm", &eo_unit_mm, "s_E: contact ends at the pinion's tip"),
    ONE(transverse_contact_ratio, "transverse_contact_ratio", NULL, "eps_alpha"),
    ONE(overlap_ratio, "overlap_ratio", NULL, "eps_beta"),
    ONE(rack_factor, "rack_factor", NULL, "k_u = u / s: profile coordinate of modifications per path of contact"),
    TWO(rack_offset, "rack_offset_mm", &eo_unit_mm, "generating rack coordinate of the pitch point"),
    ONE(rack_bottom, "rack_bottom_mm", &eo_unit_mm, "u_A of the pinion; the gear's tip side ends at - u_A"),
    ONE(rack_top, "rack_top_mm", &eo_unit_mm, "u_E of the pinion; the gear's root side ends at - u_E"),
    TWO(tip_thickness, "tip_thickness_mm", &eo_unit_mm, "transverse arc at the tip"),
    TWO(tip_clearance, "tip_clearance_mm", &eo_unit_mm, "from the tip to the other member's root"),
    ONE(normal_backlash, "normal_backlash_um", &eo_unit_um, "as stated, and what the centre distance adds"),
};

const struct eo_table eo_geometry_table = EO_TABLE("geometry", struct eo_geometry, geometry);
