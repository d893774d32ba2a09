/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rating of one load case: factors of the contact analysis and the vibration, stresses and safeties of every end
   and member. */
#include "document/result_rating_private.h"

#define OF_FACTORS(member) EO_AT(struct eo_rated_factors, member)
static const struct eo_outline_row factor_rows[] = {
    EO_KEY("K_V", "number?", "dynamic factor", OF_FACTORS(dynamic)),
    EO_KEY("K_Hbeta", "number?", "face load factor, flank", OF_FACTORS(face)),
    EO_KEY("K_Halpha", "number?", "transverse load factor, flank", OF_FACTORS(share)),
    EO_KEY("K_Fbeta", "number?", "face load factor, root", OF_FACTORS(root_face)),
    EO_KEY("K_Falpha", "number?", "transverse load factor, root", OF_FACTORS(root_share)),
};
static const struct eo_outline factors = EO_OUTLINE("LoadFactors", factor_rows);

/* Factors of the contact analysis and the vibration. */
struct computed {
  double dynamic, face, share;
  struct eo_series leaning;
};

#define OF_COMPUTED(name) EO_AT(struct computed, name)
static const struct eo_outline_row computed_rows[] = {
    EO_KEY("K_V", "number?", "largest dynamic over static mesh force of the vibration; null without a periodic one",
           OF_COMPUTED(dynamic)),
    EO_KEY("K_Hbeta", "number?", "of the load distribution as designed", OF_COMPUTED(face)),
    EO_KEY("K_Hbeta_tolerances", "[number?]", "with f_ma laid on in each direction", OF_COMPUTED(leaning)),
    EO_KEY("K_Halpha", "number?", "of the load distribution as designed, without pitch deviations", OF_COMPUTED(share)),
};
static const struct eo_outline computed = EO_OUTLINE("ComputedLoadFactors", computed_rows);

/* One member under one load case, flat. */
struct rated_member {
  double single, cycles;
  struct eo_flank_influence z;
  double flank_life, stress, permissible, safety, flank_static;
  double local_stress, local_safety, local_root, local_root_safety;
  double root_life, root_nominal, root_stress, root_permissible, root_safety, root_static;
};

#define OF_RATED(member) EO_AT(struct rated_member, member)
static const struct eo_outline_row rated_member_rows[] = {
    EO_KEY("N_L", "number", "load cycles of this load case over the required life", OF_RATED(cycles)),
    EO_KEY("Z_BD", "number", "Z_B of the pinion, Z_D of the gear", OF_RATED(single)),
    EO_KEY("Z_NT", "number", "life factor, flank", OF_RATED(flank_life)),
    EO_KEY("Z_L", "number", "lubricant", OF_RATED(z.lubricant)),
    EO_KEY("Z_v", "number", "velocity", OF_RATED(z.velocity)),
    EO_KEY("Z_R", "number", "roughness", OF_RATED(z.roughness)),
    EO_KEY("Z_W", "number", "work hardening", OF_RATED(z.work_hardening)),
    EO_KEY("Z_X", "number", "size", OF_RATED(z.size)),
    EO_KEY("sigma_H_MPa", "number", "contact stress", .unit = &eo_unit_MPa, OF_RATED(stress)),
    EO_KEY("sigma_HG_MPa", "number", "limit at N_L, without S_Hmin", .unit = &eo_unit_MPa, OF_RATED(permissible)),
    EO_KEY("S_H", "number", "flank safety of this load case alone over its own cycles", OF_RATED(safety)),
    EO_KEY("S_H_static", "number", "flank, against the static strength", OF_RATED(flank_static)),
    EO_KEY("sigma_H_local_MPa", "number?",
           "for comparison, method A: largest pressure of the analysis as designed, without tolerances, tip edges "
           "included, times sqrt(K_A K_V); does not rate",
           .unit = &eo_unit_MPa, OF_RATED(local_stress)),
    EO_KEY("S_H_local", "number?", "limit at N_L over it", OF_RATED(local_safety)),
    EO_KEY("Y_NT", "number", "life factor, root", OF_RATED(root_life)),
    EO_KEY("sigma_F0_MPa", "number", "nominal root stress", .unit = &eo_unit_MPa, OF_RATED(root_nominal)),
    EO_KEY("sigma_F_MPa", "number", "root stress", .unit = &eo_unit_MPa, OF_RATED(root_stress)),
    EO_KEY("sigma_FG_MPa", "number", "limit at N_L, without S_Fmin", .unit = &eo_unit_MPa, OF_RATED(root_permissible)),
    EO_KEY("S_F", "number", "root safety of this load case alone over its own cycles", OF_RATED(root_safety)),
    EO_KEY("S_F_static", "number", "root, against the static strength", OF_RATED(root_static)),
    EO_KEY("sigma_F_local_MPa", "number?",
           "for comparison, method A: largest root stress of the analysis as designed, without tolerances, times K_A "
           "K_V; does "
           "not rate; null without root stress",
           .unit = &eo_unit_MPa, OF_RATED(local_root)),
    EO_KEY("S_F_local", "number?", "limit at N_L over it", OF_RATED(local_root_safety)),
};
static const struct eo_outline rated_member = EO_OUTLINE("RatedMember", rated_member_rows);

static struct rated_member find_member(const struct eo_rated_case *this_case, int i)
{
  return (struct rated_member){.single = this_case->contact.single_contact[i],
                               .cycles = this_case->cycles[i],
                               .z = this_case->influence[i],
                               .flank_life = this_case->flank_life_factor[i],
                               .stress = this_case->contact.stress[i],
                               .permissible = this_case->flank_permissible[i],
                               .safety = this_case->flank_safety[i],
                               .flank_static = this_case->flank_static[i],
                               .local_stress = this_case->local_flank,
                               .local_safety = this_case->local_flank_safety[i],
                               .local_root = this_case->local_root[i],
                               .local_root_safety = this_case->local_root_safety[i],
                               .root_life = this_case->root_life_factor[i],
                               .root_nominal = this_case->root_nominal[i],
                               .root_stress = this_case->root_stress[i],
                               .root_permissible = this_case->root_permissible[i],
                               .root_safety = this_case->root_safety[i],
                               .root_static = this_case->root_static[i]};
}

static const char *const ranges[] = {"subcritical", "main_resonance", "between", "supercritical", NULL};

/* One end under one load case. */
struct rated_end {
  struct eo_rated_case found;
  int range;
  struct computed computed;
  struct rated_member member[2];
};

#define OF_END(name) EO_AT(struct rated_end, name)
static const struct eo_outline_row rated_end_rows[] = {
    EO_KEY("F_t_N", "number", "tangential force at the reference cylinder, even share of the ends", .unit = &eo_unit_N,
           OF_END(found.tangential_force)),
    EO_KEY("v_m_per_s", "number", "at the reference cylinder", .unit = &eo_unit_m_per_s, OF_END(found.velocity)),
    EO_KEY("K_gamma", "number", "this end's mean load over that of an even share", OF_END(found.load.sharing)),
    EO_KEY("w_N_per_mm", "number", "specific load F_t K_A K_gamma/b", .unit = &eo_unit_N_per_mm,
           OF_END(found.line_load)),
    EO_KEY(
        "light_load", "number",
        "what c' and c_gamma of the pair are multiplied with, n_E1 with its root: (w/100)^0.25 below 100 N/mm, else 1",
        OF_END(found.light_load)),
    EO_KEY("N", "number", "speed over n_E1 of this load", OF_END(found.resonance_ratio)),
    EO_KEY("speed_range", "word", "of K_V", .words = ranges, OF_END(range)),
    EO_KEY("f_sh_um", "number?", "deflection of the pinion shaft, method C; null when it does not apply",
           .unit = &eo_unit_um, OF_END(found.shaft_deviation)),
    EO_KEY("F_beta_x_um", "number?", "helix deviation before running in, method C", .unit = &eo_unit_um,
           OF_END(found.helix_deviation)),
    EO_KEY("y_beta_um", "number?", "what running in takes off, method C", .unit = &eo_unit_um,
           OF_END(found.helix_running_in)),
    EO_KEY("method_c", "object", "K_V method B, K_Hbeta method C, K_Halpha method B", .outline = &factors,
           OF_END(found.method_c)),
    EO_KEY("computed", "object", "of the contact analysis and the vibration", .outline = &computed, OF_END(computed)),
    EO_KEY("used", "object", "what rates", .outline = &factors, OF_END(found.used)),
    EO_KEY("Z_H", "number", "zone", OF_END(found.contact.zone)),
    EO_KEY("Z_E_sqrt_MPa", "number", "elasticity", .unit = &eo_unit_sqrt_MPa, OF_END(found.contact.elasticity)),
    EO_KEY("Z_eps", "number", "contact ratio", OF_END(found.contact.contact_ratio)),
    EO_KEY("Z_beta", "number", "helix", OF_END(found.contact.helix)),
    EO_KEY("sigma_H0_MPa", "number", "nominal contact stress", .unit = &eo_unit_MPa, OF_END(found.contact.nominal)),
    EO_KEY("pinion", "object", "pinion", .outline = &rated_member, OF_END(member[EO_PINION])),
    EO_KEY("gear", "object", "gear", .outline = &rated_member, OF_END(member[EO_GEAR])),
};
static const struct eo_outline rated_end = EO_OUTLINE("RatedEnd", rated_end_rows);

static void find_rated_end(const struct eo_rated_case *found, const struct eo_face_factors *face,
                           struct rated_end *view)
{
  *view = (struct rated_end){.found = *found,
                             .range = (int)found->dynamic.range,
                             .computed = {found->load.dynamic, face->nominal, found->load.share,
                                          eo_series_of(2, face->leaning, EO_DIGITS_NUMBER)}};
  for (int member = 0; member < 2; member++)
    view->member[member] = find_member(found, member);
}

/* All ends under one load case. */
struct rated_case {
  bool two;
  double torque, speed, time;
  struct rated_end end[2];
};

#define OF_CASE(name) EO_AT(struct rated_case, name)
static const struct eo_outline_row rated_case_rows[] = {
    EO_KEY("torque_Nm", "number", "on the pinion shaft", .unit = &eo_unit_Nm, OF_CASE(torque)),
    EO_KEY("speed_rpm", "number", "of the pinion", .unit = &eo_unit_rpm, OF_CASE(speed)),
    EO_KEY("time_h", "number", "of the required life", .unit = &eo_unit_h, OF_CASE(time)),
    EO_KEY("left", "object", "left end", .outline = &rated_end, OF_CASE(end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &rated_end, OF_CASE(end[EO_RIGHT]),
           EO_IF(struct rated_case, two)),
};
const struct eo_outline eo_outline_rated_case = EO_OUTLINE("RatedLoadCase", rated_case_rows);

json_t *eo_result_rated_case(const struct eo_result_source *source, int k)
{
  const struct eo_case_rating *rating = &source->analysis->rating->load_case[k];
  const struct eo_load_case *load_case = &source->evaluation->load_case[k].load_case;
  struct rated_case view = {.two = source->ends == 2,
                            .torque = load_case->torque,
                            .speed = load_case->speed,
                            .time = rating->end[0].load.time};
  for (int end = 0; end < source->ends; end++)
    find_rated_end(&rating->end[end], &rating->face[end], &view.end[end]);
  return eo_outline_encode(&eo_outline_rated_case, &view);
}
