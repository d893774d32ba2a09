/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Field tables of the rating. */
#include "document/design_document.h"

static const char *const editions[] = {"2006", "2019", NULL};
static const char *const sources[] = {"computed", "standard", NULL};
static const char *const shifts[] = {"generated", "nominal", NULL};
static const char *const arrangements[] = {"a", "b", "c", "d", "e", NULL};
static const char *const measures[] = {
    "as_is", "crowned_half_mesh", "crowned_half_both", "corrected", "corrected_crowned", "end_relief", NULL};
static const char *const materials[] = {"case_hardened",
                                        "flame_hardened",
                                        "through_hardened_alloy",
                                        "through_hardened_carbon",
                                        "structural",
                                        "nitrided_nitriding_steel",
                                        "nitrided_through_hardening_steel",
                                        "nitrocarburised",
                                        NULL};
static const char *const qualities[] = {"ML", "MQ", "ME", NULL};
static const char *const cores[] = {"25HRC_low", "25HRC", "30HRC", NULL};

#define MEMBER(member, key, unit, low, high, fallback, help) \
  EO_NUMBER(struct eo_rating_member, member, key, unit, low, high, fallback, help)
#define MEMBER_DERIVED(member, key, unit, low, high, derived, help) \
  EO_NUMBER_DERIVED(struct eo_rating_member, member, key, unit, low, high, derived, help)

static const struct eo_field member[] = {
    EO_CHOICE(struct eo_rating_member, material, "material_class", materials, EO_CASE_HARDENED, "class of ISO 6336-5"),
    EO_CHOICE(struct eo_rating_member, quality, "material_quality", qualities, EO_QUALITY_MQ, "of ISO 6336-5"),
    EO_CHOICE(struct eo_rating_member, core, "core", cores, EO_CORE_25HRC_LOW,
              "core of case hardened MQ: at least 25 HRC with the lower hardenability, 25 HRC, or 30 HRC"),
    MEMBER_DERIVED(hardness, "hardness_HV", &eo_unit_HV, 50, 1200, "the lowest of the class in ISO 6336-5",
                   "of the flank"),
    MEMBER_DERIVED(flank_limit, "flank_limit_MPa", &eo_unit_MPa, 50, 5000, "ISO 6336-5, by class, quality, hardness",
                   "sigma_Hlim"),
    MEMBER_DERIVED(root_limit, "root_limit_MPa", &eo_unit_MPa, 20, 3000, "ISO 6336-5, by class, quality, hardness",
                   "sigma_Flim, of the test gear: sigma_FE = 2 sigma_Flim"),
    MEMBER_DERIVED(proof_stress, "proof_stress_MPa", &eo_unit_MPa, 50, 5000, "not known",
                   "sigma_0.2; through hardened and structural steel need it for Y_drelT"),
    MEMBER(flank_roughness, "flank_roughness_Rz_um", &eo_unit_um, 0.1, 200, 4.8, "R_z of the flank"),
    MEMBER(root_roughness, "root_roughness_Rz_um", &eo_unit_um, 0.1, 200, 20, "R_z of the fillet"),
    MEMBER(meshes_per_turn, "meshes_per_turn", NULL, 1, 20, 1, "load cycles of a tooth per turn"),
    MEMBER(mean_stress, "mean_stress_factor", NULL, 0.3, 1, 1,
           "Y_M: 1 pulsating, 0.7 an idler that bends both ways, 0.9 occasional reversal"),
};
const struct eo_table eo_rating_member_table = EO_TABLE("a member's rating", struct eo_rating_member, member);

#define OIL(member, key, unit, low, high, fallback, help) \
  EO_NUMBER(struct eo_lubricant, member, key, unit, low, high, fallback, help)

static const struct eo_field lubricant[] = {
    OIL(viscosity_40, "viscosity_40_mm2_per_s", &eo_unit_mm2_per_s, 5, 5000, 220, "kinematic, at 40 degrees Celsius"),
    OIL(viscosity_100, "viscosity_100_mm2_per_s", &eo_unit_mm2_per_s, 1.5, 500, 19,
        "kinematic, at 100 degrees Celsius"),
    OIL(density, "density_kg_per_m3", &eo_unit_kg_per_m3, 500, 1500, 870, "at the temperature of the teeth"),
    OIL(pressure_viscosity, "pressure_viscosity_per_GPa", &eo_unit_per_GPa, 1, 60, 20,
        "pressure-viscosity coefficient alpha"),
    OIL(tooth_temperature, "tooth_temperature_C", &eo_unit_C, -40, 250, 70, "of the flanks before the flash"),
    OIL(friction, "friction_coefficient", NULL, 1e-3, 0.5, 0.05, "the same over the whole mesh"),
};
const struct eo_table eo_lubricant_table = EO_TABLE("lubricant", struct eo_lubricant, lubricant);

static const struct eo_field rating[] = {
    EO_CHOICE(struct eo_rating_settings, edition, "edition", editions, EO_ISO6336_2006,
              "of ISO 6336-1, -2, -3, -6: 2006 with the corrigenda of 2008 and ISO 1328-1:1995, or 2019 and ISO "
              "1328-1:2013"),
    EO_CHOICE(struct eo_rating_settings, load_factors, "load_factors", sources, EO_FACTORS_COMPUTED,
              "computed: K_Hbeta from the contact analysis with the helix slope tolerances laid on in the worse "
              "direction, K_V and K_Halpha the larger of analysis and method B; standard: methods B and C alone"),
    EO_CHOICE(struct eo_rating_settings, root_shift, "root_shift", shifts, EO_ROOT_SHIFT_GENERATED,
              "behind the form factors: x_E of the tooth cut with the upper allowance, or the nominal x"),
    EO_INTEGER(struct eo_rating_settings, accuracy_grade, "accuracy_grade", 1, 11, 6,
               "grade of ISO 1328-1:1995 with edition 2006, tolerance class of ISO 1328-1:2013 with 2019; they are not "
               "the same"),
    EO_NUMBER(struct eo_rating_settings, application_factor, "application_factor", NULL, 0.1, 10, 1,
              "K_A; 1 where the load cases are the loads"),
    EO_NUMBER(struct eo_rating_settings, required_life, "required_life_h", &eo_unit_h, 0.01, 1e7, 20000,
              "operating time of all load cases together, where they do not state their hours"),
    EO_NUMBER(struct eo_rating_settings, flank_safety, "flank_safety_min", NULL, 0.1, 10, 1,
              "S_Hmin, agreed between maker and user"),
    EO_NUMBER(struct eo_rating_settings, root_safety, "root_safety_min", NULL, 0.1, 10, 1.4,
              "S_Fmin, agreed between maker and user"),
    EO_FLAG(struct eo_rating_settings, some_pitting, "some_pitting_allowed", 0, "of the life factor Z_NT"),
    EO_NUMBER(struct eo_rating_settings, long_life, "long_life_factor", NULL, 0.85, 1, 0.85,
              "Z_NT and Y_NT at 1e10 cycles; 1 with optimum material, lubrication and experience"),
    EO_CHOICE(struct eo_rating_settings, arrangement, "bearing_arrangement", arrangements, EO_ARRANGEMENT_A,
              "of the pinion, figure 13 of ISO 6336-1, for method C"),
    EO_CHOICE(struct eo_rating_settings, helix_measure, "helix_measure", measures, EO_HELIX_AS_IS,
              "what is done to the helix, for method C: nothing, crowning of half f_ma or half of f_ma + f_sh, a "
              "correction for the computed deflection, both, or end relief"),
    EO_OBJECT(struct eo_rating_settings, member[EO_PINION], "pinion", &eo_rating_member_table,
              "material of the pinion"),
    EO_OBJECT(struct eo_rating_settings, member[EO_GEAR], "gear", &eo_rating_member_table, "material of the gear"),
    EO_OBJECT(struct eo_rating_settings, lubricant, "lubricant", &eo_lubricant_table, "oil between the flanks"),
    EO_NUMBER(struct eo_rating_settings, thermal_conductivity, "thermal_conductivity_W_per_m_K", &eo_unit_W_per_m_K, 1,
              500, 45, "of the teeth"),
    EO_NUMBER(struct eo_rating_settings, specific_heat, "specific_heat_J_per_kg_K", &eo_unit_J_per_kg_K, 100, 2000, 460,
              "of the teeth"),
};
const struct eo_table eo_rating_table = EO_TABLE("rating", struct eo_rating_settings, rating);
