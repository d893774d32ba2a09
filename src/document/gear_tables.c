/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables of the gear pair, its material, alignment, supports and flank modifications. Ranges are in the
   document's units. */
#include "document/design_document.h"

enum { TO_MM = 1000000 };

static const struct eo_field gear_pair[] = {
    EO_INTEGER(struct eo_gear_pair, ends, "ends", 1, 2, 2,
               "2: herringbone; 1: single helical or spur (its only end is the left one)"),
    EO_INTEGER_REQUIRED(struct eo_gear_pair, teeth[EO_PINION], "pinion_teeth", 4, 2000,
                        "teeth of the pinion (driving)"),
    EO_INTEGER_REQUIRED(struct eo_gear_pair, teeth[EO_GEAR], "gear_teeth", 4, 2000, "teeth of the gear"),
    EO_NUMBER_REQUIRED(struct eo_gear_pair, normal_module, "normal_module_mm", &eo_unit_mm, 0.1, 100,
                       "normal module m_n"),
    EO_NUMBER(struct eo_gear_pair, normal_pressure_angle, "normal_pressure_angle_deg", &eo_unit_deg, 10, 35, 20,
              "normal pressure angle alpha_n"),
    EO_NUMBER_REQUIRED(struct eo_gear_pair, helix_angle, "helix_angle_deg", &eo_unit_deg, 0, 60,
                       "helix angle beta at the pitch cylinder; 0: spur"),
    EO_NUMBER_REQUIRED(struct eo_gear_pair, face_width, "face_width_mm", &eo_unit_mm, 0.5, 5000,
                       "face width of one end"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, groove_width, "groove_width_mm", &eo_unit_mm, 0, 5000,
                      "8 m_n with two ends, 0 with one", "tool withdrawal groove between the ends"),
    EO_NUMBER(struct eo_gear_pair, addendum_coefficient, "addendum_coefficient", NULL, 0.2, 2, 1,
              "addendum of the basic rack / m_n"),
    EO_NUMBER(struct eo_gear_pair, dedendum_coefficient, "dedendum_coefficient", NULL, 0.3, 3, 1.25,
              "dedendum of the basic rack / m_n, tip clearance included"),
    EO_NUMBER(struct eo_gear_pair, fillet_radius_coefficient, "fillet_radius_coefficient", NULL, 0.02, 0.8, 0.38,
              "root fillet radius of the basic rack / m_n"),
    EO_NUMBER(struct eo_gear_pair, profile_shift[EO_PINION], "pinion_profile_shift", NULL, -2, 2, 0,
              "profile shift coefficient x of the pinion"),
    EO_NUMBER(struct eo_gear_pair, profile_shift[EO_GEAR], "gear_profile_shift", NULL, -2, 2, 0,
              "profile shift coefficient x of the gear"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, centre_distance, "centre_distance_mm", &eo_unit_mm, 0.01, TO_MM,
                      "free of backlash for the profile shifts", "working centre distance"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, tip_diameter[EO_PINION], "pinion_tip_diameter_mm", &eo_unit_mm, 0.01, TO_MM,
                      "from addendum and profile shift", "tip diameter of the pinion"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, tip_diameter[EO_GEAR], "gear_tip_diameter_mm", &eo_unit_mm, 0.01, TO_MM,
                      "from addendum and profile shift", "tip diameter of the gear"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, bore[EO_PINION], "pinion_bore_mm", &eo_unit_mm, 0, TO_MM, "0: solid",
                      "bore diameter of the pinion"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, bore[EO_GEAR], "gear_bore_mm", &eo_unit_mm, 0, TO_MM,
                      "15 m_n, at most half the root diameter", "bore diameter of the gear"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, groove_diameter[EO_PINION], "pinion_groove_diameter_mm", &eo_unit_mm, 1e-3,
                      TO_MM, "root diameter - 2 mm, at least nine tenths of it",
                      "diameter of the pinion's body between its ends"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, groove_diameter[EO_GEAR], "gear_groove_diameter_mm", &eo_unit_mm, 1e-3,
                      TO_MM, "root diameter - 2 mm, at least nine tenths of it",
                      "diameter of the gear's body between its ends"),
    EO_NUMBER(struct eo_gear_pair, rim_thickness_coefficient, "rim_thickness_coefficient", NULL, 1, 20, 3.5,
              "rim below the root that flexes / m_n, of a sector or a held ring; a larger bore cuts it shorter"),
    EO_NUMBER(struct eo_gear_pair, backlash, "backlash_um", &eo_unit_um, 1, 10000, 100,
              "normal backlash at the reference centre distance"),
};

static const struct eo_field material[] = {
    EO_NUMBER(struct eo_material, youngs_modulus, "youngs_modulus_GPa", &eo_unit_GPa, 0.1, 1000, 206,
              "Young's modulus of both members"),
    EO_NUMBER(struct eo_material, poissons_ratio, "poissons_ratio", NULL, 0, 0.49, 0.3, "Poisson's ratio"),
    EO_NUMBER(struct eo_material, density, "density_kg_per_m3", &eo_unit_kg_per_m3, 100, 25000, 7850, "density"),
};

static const char *const axial[] = {"floating", "fixed", "spring", NULL};

static const struct eo_field alignment[] = {
    EO_NUMBER(struct eo_alignment, shaft_angle_in_plane, "shaft_angle_error_in_plane_deg", &eo_unit_deg, -2, 2, 0.1,
              "shaft angle error in the plane of the axes, pivot in the middle of the groove"),
    EO_NUMBER(struct eo_alignment, shaft_angle_out_of_plane, "shaft_angle_error_out_of_plane_deg", &eo_unit_deg, -2, 2,
              0, "shaft angle error out of the plane of the axes"),
    EO_CHOICE(
        struct eo_alignment, pinion_axial, "pinion_axial", axial, EO_AXIAL_FLOATING,
        "how the pinion is held along its axis, in contact and vibration alike; with one end \"floating\" means held "
        "like the gear"),
    EO_NUMBER(struct eo_alignment, pinion_axial_stiffness, "pinion_axial_stiffness_N_per_um", &eo_unit_N_per_um, 1e-3,
              1e6, 200, "from the pinion's mean axial motion to the ground, used with \"spring\""),
    EO_NUMBER(struct eo_alignment, stagger, "stagger", NULL, 0, 1, 0,
              "right end behind the left, in transverse base pitches"),
};

static const char *const coupling[] = {"paper", "off", "on", NULL};

static const struct eo_field supports[] = {
    EO_NUMBER(struct eo_supports, bearing_stiffness[EO_PINION], "pinion_bearing_stiffness_N_per_um", &eo_unit_N_per_um,
              1e-3, 1e6, 800, "transverse, per end of the pinion (k_py)"),
    EO_NUMBER(struct eo_supports, bearing_stiffness[EO_GEAR], "gear_bearing_stiffness_N_per_um", &eo_unit_N_per_um,
              1e-3, 1e6, 1000, "transverse, per end of the gear (k_gy)"),
    EO_NUMBER(struct eo_supports, gear_axial_stiffness[EO_LEFT], "gear_axial_stiffness_left_N_per_um",
              &eo_unit_N_per_um, 1e-3, 1e6, 200, "axial bearing stiffness at the gear's left end (k_g1z)"),
    EO_NUMBER(struct eo_supports, gear_axial_stiffness[EO_RIGHT], "gear_axial_stiffness_right_N_per_um",
              &eo_unit_N_per_um, 1e-3, 1e6, 200, "axial bearing stiffness at the gear's right end (k_g2z)"),
    EO_NUMBER_DERIVED(struct eo_supports, groove_axial_stiffness[EO_PINION], "pinion_groove_axial_stiffness_N_per_um",
                      &eo_unit_N_per_um, 1e-6, 1e15, "E A / L of the groove body", "between the pinion's ends (k_pz)"),
    EO_NUMBER_DERIVED(struct eo_supports, groove_axial_stiffness[EO_GEAR], "gear_groove_axial_stiffness_N_per_um",
                      &eo_unit_N_per_um, 1e-6, 1e15, "E A / L of the groove body", "between the gear's ends (k_gz)"),
    EO_NUMBER_DERIVED(struct eo_supports, groove_torsional_stiffness[EO_PINION],
                      "pinion_groove_torsional_stiffness_Nm_per_rad", &eo_unit_Nm_per_rad, 1e-9, 1e20,
                      "G J / L of the groove body", "between the pinion's ends"),
    EO_NUMBER_DERIVED(struct eo_supports, groove_torsional_stiffness[EO_GEAR],
                      "gear_groove_torsional_stiffness_Nm_per_rad", &eo_unit_Nm_per_rad, 1e-9, 1e20,
                      "G J / L of the groove body", "between the gear's ends"),
    EO_CHOICE(
        struct eo_supports, torsional_coupling, "torsional_coupling", coupling, EO_COUPLING_PAPER,
        "of the ends through the groove; \"paper\": off for equal ends, on when they differ or the pinion is held"),
    EO_NUMBER_DERIVED(struct eo_supports, mass[EO_PINION], "pinion_mass_kg", &eo_unit_kg, 1e-6, 1e7,
                      "solid of the pitch cylinder", "of one end of the pinion with half the groove"),
    EO_NUMBER_DERIVED(struct eo_supports, mass[EO_GEAR], "gear_mass_kg", &eo_unit_kg, 1e-6, 1e7,
                      "solid of the pitch cylinder", "of one end of the gear with half the groove"),
    EO_NUMBER_DERIVED(struct eo_supports, inertia[EO_PINION], "pinion_inertia_kg_m2", &eo_unit_kg_m2, 1e-12, 1e8,
                      "solid of the pitch cylinder", "of one end of the pinion with half the groove"),
    EO_NUMBER_DERIVED(struct eo_supports, inertia[EO_GEAR], "gear_inertia_kg_m2", &eo_unit_kg_m2, 1e-12, 1e8,
                      "solid of the pitch cylinder", "of one end of the gear with half the groove"),
    EO_NUMBER(struct eo_supports, bearing_damping_ratio, "bearing_damping_ratio", NULL, 0, 1, 0.05, "of the bearings"),
    EO_NUMBER(struct eo_supports, groove_damping_ratio, "groove_damping_ratio", NULL, 0, 1, 0.02, "of the groove"),
    EO_NUMBER(struct eo_supports, mesh_damping_ratio, "mesh_damping_ratio", NULL, 0, 1, 0.07, "of the mesh"),
    EO_NUMBER_DERIVED(struct eo_supports, mesh_damping_stiffness, "mesh_damping_stiffness_N_per_um", &eo_unit_N_per_um,
                      1e-3, 1e6, "mean mesh stiffness of the load case",
                      "k in the mesh damping 2 zeta sqrt(k m_e)/cos beta_b"),
    EO_NUMBER(struct eo_supports, machine_inertia[EO_PINION], "driver_inertia_kg_m2", &eo_unit_kg_m2, 0, 1e9, 0,
              "of the machine that drives the pinion, on the pinion's shaft; 0: none, the torque is constant"),
    EO_NUMBER(struct eo_supports, machine_stiffness[EO_PINION], "driver_stiffness_Nm_per_rad", &eo_unit_Nm_per_rad, 0,
              1e20, 0, "torsion of shaft and coupling between driver and pinion; needed with driver_inertia_kg_m2"),
    EO_NUMBER(struct eo_supports, machine_inertia[EO_GEAR], "load_inertia_kg_m2", &eo_unit_kg_m2, 0, 1e9, 0,
              "of the machine that the gear drives, on the gear's shaft; 0: none, the torque is constant"),
    EO_NUMBER(struct eo_supports, machine_stiffness[EO_GEAR], "load_stiffness_Nm_per_rad", &eo_unit_Nm_per_rad, 0, 1e20,
              0, "torsion of shaft and coupling between gear and load; needed with load_inertia_kg_m2"),
    EO_NUMBER(struct eo_supports, machine_damping_ratio, "machine_damping_ratio", NULL, 0, 1, 0.02,
              "of the torsion towards driver and load"),
};

static const char *const side[] = {"left", "right", NULL};

static const struct eo_field shafts[] = {
    EO_FLAG(struct eo_shafts, enabled, "enabled", 0,
            "torsional wind-up and bending of both bodies, iterated with the load distribution"),
    EO_NUMBER_DERIVED(struct eo_shafts, bearing_position[EO_PINION][EO_LEFT], "pinion_left_bearing_mm", &eo_unit_mm,
                      -TO_MM, TO_MM, "half a face width outside the face end",
                      "simple support, from the middle of the groove (of the face, with one end), + to the right"),
    EO_NUMBER_DERIVED(struct eo_shafts, bearing_position[EO_PINION][EO_RIGHT], "pinion_right_bearing_mm", &eo_unit_mm,
                      -TO_MM, TO_MM, "half a face width outside the face end",
                      "simple support, from the middle of the groove (of the face, with one end), + to the right"),
    EO_NUMBER_DERIVED(struct eo_shafts, bearing_position[EO_GEAR][EO_LEFT], "gear_left_bearing_mm", &eo_unit_mm, -TO_MM,
                      TO_MM, "half a face width outside the face end",
                      "simple support, from the middle of the groove (of the face, with one end), + to the right"),
    EO_NUMBER_DERIVED(struct eo_shafts, bearing_position[EO_GEAR][EO_RIGHT], "gear_right_bearing_mm", &eo_unit_mm,
                      -TO_MM, TO_MM, "half a face width outside the face end",
                      "simple support, from the middle of the groove (of the face, with one end), + to the right"),
    EO_NUMBER_DERIVED(struct eo_shafts, shaft_diameter[EO_PINION], "pinion_shaft_diameter_mm", &eo_unit_mm, 1e-3, TO_MM,
                      "0.8 of the groove diameter, at least midway from the bore to it",
                      "outside the toothed body; the bore runs through"),
    EO_NUMBER_DERIVED(struct eo_shafts, shaft_diameter[EO_GEAR], "gear_shaft_diameter_mm", &eo_unit_mm, 1e-3, TO_MM,
                      "0.8 of the groove diameter, at least midway from the bore to it",
                      "outside the toothed body; the bore runs through"),
    EO_CHOICE(struct eo_shafts, drive_side[EO_PINION], "pinion_drive_side", side, EO_DRIVE_LEFT,
              "where torque enters the pinion"),
    EO_CHOICE(struct eo_shafts, drive_side[EO_GEAR], "gear_drive_side", side, EO_DRIVE_LEFT,
              "where torque leaves the gear"),
};

static const char *const relief_shape[] = {"parabolic", "linear", "circular", NULL};

static const struct eo_field flank[] = {
    EO_CHOICE(struct eo_flank_modification, shape, "relief_shape", relief_shape, EO_RELIEF_PARABOLIC,
              "of tip and root relief"),
    EO_NUMBER(struct eo_flank_modification, tip_relief, "tip_relief_um", &eo_unit_um, 0, 1000, 0,
              "at the tip end of the active profile, normal (d_tr)"),
    EO_NUMBER(struct eo_flank_modification, tip_relief_start, "tip_relief_start_mm", &eo_unit_mm, 0, 200, 0,
              "distance of its start from the pitch point along the rack profile (u_ts)"),
    EO_NUMBER(struct eo_flank_modification, root_relief, "root_relief_um", &eo_unit_um, 0, 1000, 0,
              "at the root end of the active profile, normal (d_br)"),
    EO_NUMBER(struct eo_flank_modification, root_relief_start, "root_relief_start_mm", &eo_unit_mm, 0, 200, 0,
              "distance of its start from the pitch point along the rack profile (u_bs)"),
    EO_NUMBER(struct eo_flank_modification, profile_crowning, "profile_crowning_per_mm", &eo_unit_per_mm, -1, 1, 0,
              "coefficient a_m of the parabola a_m u^2 between the starts"),
    EO_NUMBER(struct eo_flank_modification, lead_crowning, "lead_crowning_um", &eo_unit_um, -1000, 1000, 0,
              "at the face ends: a_l (b/(2 cos beta))^2"),
    EO_NUMBER(struct eo_flank_modification, lead_slope, "lead_slope_um", &eo_unit_um, -1000, 1000, 0,
              "at the face end that meets first, minus as much at the other (b_l)"),
    EO_NUMBER(struct eo_flank_modification, lead_offset, "lead_offset_um", &eo_unit_um, -1000, 1000, 0,
              "over the whole flank (c_l)"),
    EO_NUMBER(struct eo_flank_modification, end_relief[1], "leading_end_relief_um", &eo_unit_um, 0, 1000, 0,
              "at the face end that meets first, parabolic"),
    EO_NUMBER(struct eo_flank_modification, end_relief_length[1], "leading_end_relief_length_mm", &eo_unit_mm, 0, 5000,
              0, "axial, from that face end"),
    EO_NUMBER(struct eo_flank_modification, end_relief[0], "trailing_end_relief_um", &eo_unit_um, 0, 1000, 0,
              "at the face end that meets last, parabolic"),
    EO_NUMBER(struct eo_flank_modification, end_relief_length[0], "trailing_end_relief_length_mm", &eo_unit_mm, 0, 5000,
              0, "axial, from that face end"),
};

const struct eo_table eo_gear_pair_table = EO_TABLE("gear_pair", struct eo_gear_pair, gear_pair);
const struct eo_table eo_material_table = EO_TABLE("material", struct eo_material, material);
const struct eo_table eo_alignment_table = EO_TABLE("alignment", struct eo_alignment, alignment);
const struct eo_table eo_supports_table = EO_TABLE("supports", struct eo_supports, supports);
const struct eo_table eo_shafts_table = EO_TABLE("shafts", struct eo_shafts, shafts);
const struct eo_table eo_flank_modification_table = EO_TABLE("a flank's modification", struct eo_flank_modification,
                                                             flank);

/* One member: its left and right flank. */
struct member_flanks {
  struct eo_flank_modification flank[2];
};
static const struct eo_field member_flanks[] = {
    EO_OBJECT(struct member_flanks, flank[EO_LEFT], "left", &eo_flank_modification_table,
              "left end; absent: unmodified"),
    {.key = "right",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_SOMETIMES,
     .offset = offsetof(struct member_flanks, flank[EO_RIGHT]),
     .table = &eo_flank_modification_table,
     .help = "right end; absent: unmodified"},
};
const struct eo_table eo_member_modification_table = EO_TABLE("a member's modification", struct member_flanks,
                                                              member_flanks);

static const struct eo_field modification[] = {
    EO_OBJECT(struct eo_modification, flank[EO_PINION], "pinion", &eo_member_modification_table, "the pinion's flanks"),
    {.key = "gear",
     .kind = EO_FIELD_OBJECT,
     .flags = EO_FIELD_OMIT,
     .offset = offsetof(struct eo_modification, flank[EO_GEAR]),
     .table = &eo_member_modification_table,
     .help = "the gear's flanks; absent: unmodified"},
};
const struct eo_table eo_modification_table = EO_TABLE("modification", struct eo_modification, modification);
