/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables of the gear pair, its material, alignment, supports and flank modifications. Ranges are in the
   document's units. */
#include "document/design_document.h"
#include "gear/names.h"

enum { TO_MM = 1000000 };

#define TIP                                                                                                      \
  "from addendum, profile shift and tip alteration; where that is not stated either, short enough to clear the " \
  "mate's fillet or undercut and at least 0.2 m_n thick"
#define NO_INTERNAL \
  "Internal gears (a negative number of teeth) and planetary stages are not modelled: both members are external."
static const char *const other_modules[] = {"transverse_module_mm", "normal_diametral_pitch_per_inch",
                                            "transverse_diametral_pitch_per_inch", NULL};

static const char *const own_widths[] = {"pinion_face_width_mm", "gear_face_width_mm", NULL};

#define OWN_WIDTH(member_)                                                                                             \
  "own face width of the " member_ " at one end, centred on its mate's: what is beyond the common width supports the " \
  "teeth and the root; modifications are laid out over the common width"

/* A coefficient of one member's basic rack. */
#define RACK(member, name, key_, low_, high_, help_) \
  EO_NUMBER_DERIVED(struct eo_gear_pair, rack[member].name, key_, NULL, low_, high_, "that of both members", help_)
#define ENTRY(name, key_, states_, unit_, low_, high_, help_) \
  EO_NUMBER_ENTRY(struct eo_gear_pair, entry.name, key_, states_, unit_, low_, high_, help_)

#define SPANNED(member, key_, help_)                                            \
  EO_INTEGER_DERIVED(struct eo_gear_pair, teeth_spanned[member], key_, 1, 1000, \
                     "those whose contact lies nearest to mid flank", help_)

static const struct eo_field gear_pair[] = {
    EO_INTEGER(struct eo_gear_pair, ends, "ends", 1, 2, 2,
               "2: herringbone; 1: single helical or spur (its only end is the left one)"),
    {.key = "pinion_teeth",
     .kind = EO_FIELD_INTEGER,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_gear_pair, teeth[EO_PINION]),
     .low = 4,
     .high = 2000,
     .fallback = NAN,
     .below = NO_INTERNAL,
     .help = "teeth of the pinion (driving)"},
    {.key = "gear_teeth",
     .kind = EO_FIELD_INTEGER,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_gear_pair, teeth[EO_GEAR]),
     .low = 4,
     .high = 2000,
     .fallback = NAN,
     .below = NO_INTERNAL,
     .help = "teeth of the gear"},
    {.key = "normal_module_mm",
     .kind = EO_FIELD_NUMBER,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_gear_pair, normal_module),
     .unit = &eo_unit_mm,
     .low = 0.1,
     .high = 100,
     .fallback = NAN,
     .instead = other_modules,
     .help = "normal module m_n"},
    ENTRY(transverse_module, "transverse_module_mm", "normal_module_mm", &eo_unit_mm, 0.1, 200,
          "transverse module m_t = m_n / cos beta"),
    ENTRY(normal_diametral_pitch, "normal_diametral_pitch_per_inch", "normal_module_mm", &eo_unit_per_inch, 0.254, 254,
          "normal diametral pitch: m_n = 25.4 mm / it"),
    ENTRY(transverse_diametral_pitch, "transverse_diametral_pitch_per_inch", "normal_module_mm", &eo_unit_per_inch,
          0.127, 254, "transverse diametral pitch: m_t = 25.4 mm / it"),
    {.key = "normal_pressure_angle_deg",
     .kind = EO_FIELD_NUMBER,
     .flags = EO_FIELD_NULLABLE,
     .offset = offsetof(struct eo_gear_pair, normal_pressure_angle),
     .unit = &eo_unit_deg,
     .low = 10,
     .high = 35,
     .fallback = NAN,
     .derived = "20 (ISO 53), or what the transverse pressure angle makes it",
     .help = "normal pressure angle alpha_n"},
    ENTRY(transverse_pressure_angle, "transverse_pressure_angle_deg", "normal_pressure_angle_deg", &eo_unit_deg, 10, 55,
          "transverse pressure angle at the reference cylinder: tan alpha_n = tan alpha_t cos beta"),
    {.key = "helix_angle_deg",
     .kind = EO_FIELD_NUMBER,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_gear_pair, helix_angle),
     .unit = &eo_unit_deg,
     .low = 0,
     .high = 60,
     .fallback = NAN,
     .below = "The angle has no sign here: state it without the sign and the hand as gear_pair.hand.",
     .help = "helix angle beta at the pitch cylinder; 0: spur"},
    EO_WORD_DERIVED(struct eo_gear_pair, hand, "hand", eo_end_name, 0, NULL,
                    "that of a pinion which turns counterclockwise, seen from its left end: right with the apex "
                    "trailing, left with the apex leading",
                    "hand of the helix of the pinion's left half (of its only one); its right half and the gear have "
                    "the other hand"),
    {.key = "face_width_mm",
     .kind = EO_FIELD_NUMBER,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct eo_gear_pair, face_width),
     .unit = &eo_unit_mm,
     .low = 0.5,
     .high = 5000,
     .fallback = NAN,
     .instead = own_widths,
     .help = "face width b of one end, common to both members"},
    EO_NUMBER_DERIVED(struct eo_gear_pair, member_width[EO_PINION], "pinion_face_width_mm", &eo_unit_mm, 0.5, 5000,
                      "the common face width", OWN_WIDTH("pinion")),
    EO_NUMBER_DERIVED(struct eo_gear_pair, member_width[EO_GEAR], "gear_face_width_mm", &eo_unit_mm, 0.5, 5000,
                      "the common face width", OWN_WIDTH("gear")),
    EO_NUMBER_DERIVED(struct eo_gear_pair, right_face_width, "right_face_width_mm", &eo_unit_mm, 0.5, 5000,
                      "that of the left end",
                      "face width of the right end where the halves are unequal; face_width_mm and the members' own "
                      "widths are those of the left one then, and what is beyond the common face is alike on both"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, right_helix_angle, "right_helix_angle_deg", &eo_unit_deg, 0.1, 60,
                      "that of the left end",
                      "helix angle of the right end where the halves differ; helix_angle_deg, normal module, normal "
                      "pressure angle and all coefficients are those of the left one then, and the halves share the "
                      "transverse section"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, groove_width, "groove_width_mm", &eo_unit_mm, 0, 5000,
                      "8 m_n with two ends, 0 with one", "tool withdrawal groove between the ends"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, addendum_coefficient, "addendum_coefficient", NULL, 0.2, 2,
                      "1, profile A of ISO 53", "addendum of the basic rack of both members / m_n"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, dedendum_coefficient, "dedendum_coefficient", NULL, 0.3, 3,
                      "1.25, profile A of ISO 53, or as deep as a rack of a larger pressure angle can be",
                      "dedendum of the basic rack of both members / m_n, tip clearance included"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, fillet_radius_coefficient, "fillet_radius_coefficient", NULL, 0.02, 0.8,
                      "0.38, profile A of ISO 53, or as round as the tip of the rack can be",
                      "root fillet radius of the basic rack of both members / m_n"),
    RACK(EO_PINION, addendum_coefficient, "pinion_addendum_coefficient", 0.2, 2, "addendum of the pinion's rack / m_n"),
    RACK(EO_GEAR, addendum_coefficient, "gear_addendum_coefficient", 0.2, 2, "addendum of the gear's rack / m_n"),
    RACK(EO_PINION, dedendum_coefficient, "pinion_dedendum_coefficient", 0.3, 3, "dedendum of the pinion's rack / m_n"),
    RACK(EO_GEAR, dedendum_coefficient, "gear_dedendum_coefficient", 0.3, 3, "dedendum of the gear's rack / m_n"),
    RACK(EO_PINION, fillet_radius_coefficient, "pinion_fillet_radius_coefficient", 0.02, 0.8,
         "root fillet radius of the pinion's rack / m_n"),
    RACK(EO_GEAR, fillet_radius_coefficient, "gear_fillet_radius_coefficient", 0.02, 0.8,
         "root fillet radius of the gear's rack / m_n"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, profile_shift[EO_PINION], "pinion_profile_shift", NULL, -5, 10,
                      "0, or what a stated gear shift leaves of the sum that the drawing implies",
                      "profile shift coefficient x of the pinion"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, profile_shift[EO_GEAR], "gear_profile_shift", NULL, -5, 10,
                      "free of backlash at the stated centre distance, working pressure angle or shift sum, else 0",
                      "profile shift coefficient x of the gear"),
    ENTRY(shift_length[EO_PINION], "pinion_profile_shift_mm", "pinion_profile_shift", &eo_unit_mm, -500, 1000,
          "profile shift x m_n of the pinion"),
    ENTRY(shift_length[EO_GEAR], "gear_profile_shift_mm", "gear_profile_shift", &eo_unit_mm, -500, 1000,
          "profile shift x m_n of the gear"),
    ENTRY(shift_sum, "profile_shift_sum", "centre_distance_mm", NULL, -10, 20,
          "sum of both profile shift coefficients"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, centre_distance, "centre_distance_mm", &eo_unit_mm, 0.01, TO_MM,
                      "free of backlash for the profile shifts", "working centre distance"),
    ENTRY(working_pressure_angle, "working_pressure_angle_deg", "centre_distance_mm", &eo_unit_deg, 2, 65,
          "transverse working pressure angle alpha_wt"),
    EO_NUMBER_DERIVED(
        struct eo_gear_pair, tip_alteration, "tip_alteration_coefficient", NULL, -2, 1,
        "the tips are shortened so that the clearance of the basic rack is kept at the centre distance, k "
        "m_n = a - a_d - m_n (x1 + x2), never above 0 (ISO 21771)",
        "tip alteration k: d_a = d + 2 m_n (x + h_aP + k)"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, tip_diameter[EO_PINION], "pinion_tip_diameter_mm", &eo_unit_mm, 0.01, TO_MM,
                      TIP, "tip diameter of the pinion"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, tip_diameter[EO_GEAR], "gear_tip_diameter_mm", &eo_unit_mm, 0.01, TO_MM, TIP,
                      "tip diameter of the gear"),
    ENTRY(addendum[EO_PINION], "pinion_addendum_mm", "pinion_tip_diameter_mm", &eo_unit_mm, -1000, 1000,
          "addendum of the pinion above its reference circle: d_a = d + 2 h_a"),
    ENTRY(addendum[EO_GEAR], "gear_addendum_mm", "gear_tip_diameter_mm", &eo_unit_mm, -1000, 1000,
          "addendum of the gear above its reference circle: d_a = d + 2 h_a"),
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
    EO_NUMBER_DERIVED(
        struct eo_gear_pair, backlash, "backlash_um", &eo_unit_um, 1, 10000,
        "the mean of stated thickness allowances, else 2/3 (0.06 mm + 0.0005 a + 0.03 m_n), the least that "
        "ISO/TR 10064-2 recommends",
        "normal backlash by thickness, at the centre distance that is free of backlash without it"),
    EO_NUMBER_BASED(struct eo_gear_pair, generating_offset[EO_PINION], "pinion_generating_offset", NULL, -3, 3, 0,
                    "the root of a tooth without thickness allowance",
                    "x_E - x of the pinion: its root is cut with the generating shift x_E"),
    ENTRY(generating_shift[EO_PINION], "pinion_generating_shift", "pinion_generating_offset", NULL, -8, 13,
          "generating profile shift x_E of the pinion, with which its root is cut"),
    EO_NUMBER_BASED(
        struct eo_gear_pair, protuberance[EO_PINION], "pinion_protuberance_um", &eo_unit_um, 0, 5000, 0,
        "a tool without protuberance",
        "protuberance of the tool that cuts the pinion, normal to its flank; what it has beyond the stock cuts "
        "into the fillet"),
    EO_NUMBER_BASED(struct eo_gear_pair, grinding_stock[EO_PINION], "pinion_grinding_stock_um", &eo_unit_um, 0, 5000, 0,
                    "flanks that are not ground", "stock left for grinding on each flank of the pinion, normal"),
    EO_NUMBER_BASED(struct eo_gear_pair, tip_chamfer[EO_PINION], "pinion_tip_chamfer_mm", &eo_unit_mm, 0, 100, 0,
                    "a sharp tip",
                    "radial height of a tip chamfer or rounding of the pinion: its flank ends that much below the tip"),
    EO_NUMBER_BASED(struct eo_gear_pair, generating_offset[EO_GEAR], "gear_generating_offset", NULL, -3, 3, 0,
                    "the root of a tooth without thickness allowance",
                    "x_E - x of the gear: its root is cut with the generating shift x_E"),
    ENTRY(generating_shift[EO_GEAR], "gear_generating_shift", "gear_generating_offset", NULL, -8, 13,
          "generating profile shift x_E of the gear, with which its root is cut"),
    EO_NUMBER_BASED(
        struct eo_gear_pair, protuberance[EO_GEAR], "gear_protuberance_um", &eo_unit_um, 0, 5000, 0,
        "a tool without protuberance",
        "protuberance of the tool that cuts the gear, normal to its flank; what it has beyond the stock cuts "
        "into the fillet"),
    EO_NUMBER_BASED(struct eo_gear_pair, grinding_stock[EO_GEAR], "gear_grinding_stock_um", &eo_unit_um, 0, 5000, 0,
                    "flanks that are not ground", "stock left for grinding on each flank of the gear, normal"),
    EO_NUMBER_BASED(struct eo_gear_pair, tip_chamfer[EO_GEAR], "gear_tip_chamfer_mm", &eo_unit_mm, 0, 100, 0,
                    "a sharp tip",
                    "radial height of a tip chamfer or rounding of the gear: its flank ends that much below the tip"),
    EO_TEXT_DERIVED(
        struct eo_gear_pair, thickness_series, "thickness_series", 3, "none: allowances or backlash",
        "tooth thickness allowances of both members by DIN 3967: series and tolerance, as \"cd25\" or \"25cd\""),
    EO_NUMBERS(struct eo_gear_pair, thickness_allowance[EO_PINION], "pinion_thickness_allowance_um", 2, &eo_unit_um,
               -20000, 0, EO_FIELD_NULLABLE, NULL, "of the series, else half of what makes the backlash",
               "[A_sne, A_sni] of the pinion: upper and lower allowance of the normal thickness"),
    EO_NUMBERS(struct eo_gear_pair, thickness_allowance[EO_GEAR], "gear_thickness_allowance_um", 2, &eo_unit_um, -20000,
               0, EO_FIELD_NULLABLE, NULL, "of the series, else half of what makes the backlash",
               "[A_sne, A_sni] of the gear: upper and lower allowance of the normal thickness"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, centre_distance_allowance, "centre_distance_allowance_um", &eo_unit_um, 0,
                      10000, "js7 of ISO 286-1, as DIN 3964 has it for usual drives",
                      "centre distance allowance, both ways"),
    SPANNED(EO_PINION, "pinion_teeth_spanned", "teeth that the span over the pinion takes"),
    SPANNED(EO_GEAR, "gear_teeth_spanned", "teeth that the span over the gear takes"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, measuring_ball[EO_PINION], "pinion_measuring_ball_mm", &eo_unit_mm, 0.01,
                      500, "the smallest usual one that touches near the reference circle and stands above the tip",
                      "diameter of balls or pins over which the pinion is measured"),
    EO_NUMBER_DERIVED(struct eo_gear_pair, measuring_ball[EO_GEAR], "gear_measuring_ball_mm", &eo_unit_mm, 0.01, 500,
                      "the smallest usual one that touches near the reference circle and stands above the tip",
                      "diameter of balls or pins over which the gear is measured"),
};

static const struct eo_field material[] = {
    EO_NUMBER_BASED(struct eo_material, youngs_modulus, "youngs_modulus_GPa", &eo_unit_GPa, 0.1, 1000, 206,
                    "steel, ISO 6336-1", "Young's modulus of both members, or of the pinion"),
    EO_NUMBER_BASED(struct eo_material, poissons_ratio, "poissons_ratio", NULL, 0, 0.49, 0.3, "steel, ISO 6336-2",
                    "Poisson's ratio of both members, or of the pinion"),
    EO_NUMBER_BASED(struct eo_material, density, "density_kg_per_m3", &eo_unit_kg_per_m3, 100, 25000, 7850, "steel",
                    "density of both members, or of the pinion"),
    EO_NUMBER_DERIVED(struct eo_material, gear_youngs_modulus, "gear_youngs_modulus_GPa", &eo_unit_GPa, 0.1, 1000,
                      "that of both members", "Young's modulus of the gear"),
    EO_NUMBER_DERIVED(struct eo_material, gear_poissons_ratio, "gear_poissons_ratio", NULL, 0, 0.49,
                      "that of both members", "Poisson's ratio of the gear"),
    EO_NUMBER_DERIVED(struct eo_material, gear_density, "gear_density_kg_per_m3", &eo_unit_kg_per_m3, 100, 25000,
                      "that of both members", "density of the gear"),
};

static const char *const axial[] = {"floating", "fixed", "spring", "stops", NULL};
static const char *const apex[] = {"trailing", "leading", NULL};
static const char *const rotations[] = {"clockwise", "counterclockwise", NULL};

/* An angle as a deviation: it states the angle, and stays in the document beside it. */
#define DEVIATION(member, key_, states_, derived_, help_)                                                              \
  {                                                                                                                    \
    .key = key_, .kind = EO_FIELD_NUMBER, .flags = EO_FIELD_NULLABLE, .offset = offsetof(struct eo_alignment, member), \
    .unit = &eo_unit_um, .low = -1e5, .high = 1e5, .fallback = NAN, .derived = derived_, .states = states_,            \
    .help = help_                                                                                                      \
  }

#define ALIGNED(limit) \
  "aligned: no error is assumed; with shaft_error_grade the limit of ISO/TR 10064-3, " limit " (both add up)"

static const struct eo_field alignment[] = {
    EO_NUMBER_BASED(struct eo_alignment, shaft_angle_in_plane, "shaft_angle_error_in_plane_deg", &eo_unit_deg, -2, 2, 0,
                    ALIGNED("- F_beta / b"),
                    "shaft angle error in the plane of the axes, pivot in the middle of the groove"),
    EO_NUMBER_BASED(struct eo_alignment, shaft_angle_out_of_plane, "shaft_angle_error_out_of_plane_deg", &eo_unit_deg,
                    -2, 2, 0, ALIGNED("F_beta / (2 b)"), "shaft angle error out of the plane of the axes"),
    EO_CHOICE(
        struct eo_alignment, pinion_axial, "pinion_axial", axial, EO_AXIAL_FLOATING,
        "how the pinion is held along its axis, in contact and vibration alike; with one end \"floating\" means held "
        "like the gear"),
    EO_NUMBER_DERIVED(struct eo_alignment, pinion_axial_stiffness, "pinion_axial_stiffness_N_per_um", &eo_unit_N_per_um,
                      1e-3, 1e6, "that of the gear's left end",
                      "from the pinion's mean axial motion to the ground, used with \"spring\""),
    EO_NUMBER(struct eo_alignment, stagger, "stagger", NULL, 0, 1, 0,
              "right end behind the left, in transverse base pitches"),
    DEVIATION(deviation_in_plane, "shaft_angle_error_in_plane_um", "shaft_angle_error_in_plane_deg",
              "as shaft_angle_error_in_plane_deg says",
              "the error in the plane of the axes as a deviation over the face width of one end (f_Sigma_delta)"),
    DEVIATION(deviation_out_of_plane, "shaft_angle_error_out_of_plane_um", "shaft_angle_error_out_of_plane_deg",
              "as shaft_angle_error_out_of_plane_deg says",
              "the error out of that plane as a deviation over the face width of one end (f_Sigma_beta)"),
    EO_INTEGER_DERIVED(
        struct eo_alignment, error_grade, "shaft_error_grade", 1, 11, "the errors are stated",
        "grade or class of ISO 1328-1, in the edition that belongs to the rating's, whose F_beta limits both shaft "
        "angle errors: f_Sigma_beta = L/(2 b) F_beta, f_Sigma_delta twice that over the bearing span L"),
    EO_NUMBER(struct eo_alignment, pinion_axial_clearance, "pinion_axial_clearance_um", &eo_unit_um, 0, 1e5, 200,
              "whole play of the pinion between its stops, half to each side of where its apex meets the gear's, used "
              "with \"stops\"; at a stop pinion_axial_stiffness_N_per_um holds it"),
    EO_NUMBER(struct eo_alignment, coupling_thrust, "coupling_thrust_N", &eo_unit_N, -1e7, 1e7, 0,
              "axial force of the coupling on the pinion, + to the right"),
    EO_NUMBER(struct eo_alignment, apex_offset[EO_PINION], "pinion_apex_offset_um", &eo_unit_um, -1e4, 1e4, 0,
              "how far the pinion's right end stands away from its left one beyond the nominal distance"),
    EO_NUMBER(struct eo_alignment, apex_offset[EO_GEAR], "gear_apex_offset_um", &eo_unit_um, -1e4, 1e4, 0,
              "how far the gear's right end stands away from its left one beyond the nominal distance"),
    EO_NUMBER(
        struct eo_alignment, centre_distance_deviation, "centre_distance_deviation_um", &eo_unit_um, -5000, 5000, 0,
        "how much further apart the axes of the same two gears stand than the centre distance that they are drawn "
        "for: working pressure angle, path of contact and backlash follow, the flanks stay"),
    EO_CHOICE(struct eo_alignment, apex, "apex", apex, EO_APEX_TRAILING,
              "where the helices of both ends would meet, running ahead on the drive flanks: trailing, the outer face "
              "ends meet first, or leading, those at the groove; of one end: trailing, its left face meets first, or "
              "leading, its right one"),
    EO_WORD_DERIVED(struct eo_alignment, pinion_rotation, "pinion_rotation", rotations, EO_FIELD_ENTRY, "apex", NULL,
                    "which way the pinion turns when the design runs ahead, seen from its left end: with the hand it "
                    "says whether the apex trails or leads; without it, which hand the apex asks for"),
};

/* Rules of eo_design_resolve(). */
#define SEAT                                                                                                         \
  "10 kN/um per metre of bearing seat: a medium roller bearing and its housing; seat 0.8 of the pinion's body, the " \
  "gear's thicker by the cube root of the gear ratio"
#define AXIAL "0.2 of the gear's transverse bearing stiffness"

static const char *const coupling[] = {"paper", "off", "on", NULL};

static const struct eo_field supports[] = {
    EO_NUMBER_DERIVED(struct eo_supports, bearing_stiffness[EO_PINION], "pinion_bearing_stiffness_N_per_um",
                      &eo_unit_N_per_um, 1e-3, 1e6, SEAT, "transverse, per end of the pinion (k_py)"),
    EO_NUMBER_DERIVED(struct eo_supports, bearing_stiffness[EO_GEAR], "gear_bearing_stiffness_N_per_um",
                      &eo_unit_N_per_um, 1e-3, 1e6, SEAT, "transverse, per end of the gear (k_gy)"),
    EO_NUMBER_DERIVED(struct eo_supports, gear_axial_stiffness[EO_LEFT], "gear_axial_stiffness_left_N_per_um",
                      &eo_unit_N_per_um, 1e-3, 1e6, AXIAL, "axial bearing stiffness at the gear's left end (k_g1z)"),
    EO_NUMBER_DERIVED(struct eo_supports, gear_axial_stiffness[EO_RIGHT], "gear_axial_stiffness_right_N_per_um",
                      &eo_unit_N_per_um, 1e-3, 1e6, AXIAL, "axial bearing stiffness at the gear's right end (k_g2z)"),
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
    EO_CHOICE(struct eo_shafts, drive_side[EO_PINION], "pinion_drive_side", eo_end_name, EO_DRIVE_LEFT,
              "where torque enters the pinion"),
    EO_CHOICE(struct eo_shafts, drive_side[EO_GEAR], "gear_drive_side", eo_end_name, EO_DRIVE_LEFT,
              "where torque leaves the gear"),
};

static const struct eo_refused_key not_modelled[] = {
    {"planets",
     "Planetary stages are not modelled: enter sun and planet, or planet and planet, as a pair of their own."},
    {"planet_count", "Planetary stages are not modelled: enter sun and planet as a pair of its own."},
    {"number_of_planets", "Planetary stages are not modelled: enter sun and planet as a pair of its own."},
    {"sun_teeth", "Planetary stages are not modelled: enter sun and planet as a pair of its own."},
    {"planet_teeth", "Planetary stages are not modelled: enter sun and planet as a pair of its own."},
    {"ring_teeth", "Internal gears are not modelled: both members are external."},
    {"internal", "Internal gears are not modelled: both members are external."},
    {NULL, NULL}};
const struct eo_table eo_gear_pair_table = {.name = "gear_pair",
                                            .refused = not_modelled,
                                            .size = sizeof(struct eo_gear_pair),
                                            .count = (int)(sizeof gear_pair / sizeof *gear_pair),
                                            .field = gear_pair};
const struct eo_table eo_material_table = EO_TABLE("material", struct eo_material, material);
const struct eo_table eo_alignment_table = EO_TABLE("alignment", struct eo_alignment, alignment);
const struct eo_table eo_supports_table = EO_TABLE("supports", struct eo_supports, supports);
const struct eo_table eo_shafts_table = EO_TABLE("shafts", struct eo_shafts, shafts);
