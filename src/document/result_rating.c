/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rating of a result: every factor a reviewer follows, per load case, end and member; verdict and spectrum. Keys of
   factors and stresses are the symbols of ISO 6336. */
#include <math.h>

#include "document/result_rating_private.h"

/* Lists of sentences, by edition. */
static json_t *texts_of(const char *const *text)
{
  json_t *list = json_array();
  for (; *text && list; text++)
    if (json_array_append_new(list, json_string(*text)) != 0) {
      json_decref(list);
      return NULL;
    }
  return list;
}

static const char *const standards_2006[] = {
    "ISO 6336-1:2006 with corrigendum 1:2008: K_V method B, K_Hbeta method C, K_Halpha method B",
    "ISO 6336-2:2006 with corrigendum 1:2008: flank, method B; Z_beta = 1/sqrt(cos beta)",
    "ISO 6336-3:2006 with corrigendum 1:2008: root, method B",
    "ISO 6336-5: strengths by class, quality and hardness, as in its table 1 of 2016",
    "ISO 6336-6:2006: Miner's sum",
    "ISO 1328-1:1995: deviations by grade",
    NULL};
static const char *const standards_2019[] = {
    "ISO 6336-1:2019: K_V method B, K_Hbeta method C, K_Halpha method B",
    "ISO 6336-2:2019: flank, method B; f_ZCa = 1, the modification is verified by contact analysis",
    "ISO 6336-3:2019: root, method B, with f_eps",
    "ISO 6336-5:2016: strengths by class, quality and hardness",
    "ISO 6336-6:2019: Miner's sum",
    "ISO 1328-1:2013: deviations by tolerance class",
    NULL};

/* What no published report has confirmed and the standard's own text was not at hand for. */
static const char *const unchecked_2006[] = {
    "K_V at and above the main resonance (N above 0.85)",
    "the stiffness of the teeth below a specific load of 100 N/mm",
    "f_sh of method C and its constants K'; running-in of through hardened and nitrided teeth",
    "Z_W with R_zH above 3 um and of two through hardened members; fading of Z_L, Z_v, Z_R, Z_W towards the static end",
    "Y_drelT and Y_RrelT of other than case hardened teeth; Y_DT",
    "life lines with pitting allowed, of nitrided and of nitrocarburised teeth",
    "strengths of ISO 6336-5 (one source)",
    "ISO 6336 for double helical pairs: no published report; each end is rated with half the torque and its own share",
    "K_Hbeta from a contact analysis: the procedure of annex E is not public; the definition of 7.2 is followed",
    NULL};
static const char *const unchecked_2019[] = {
    "K_V at and above the main resonance (N above 0.85)",
    "the stiffness of the teeth below a specific load of 100 N/mm",
    "f_sh of method C and its constants K'; running-in of through hardened and nitrided teeth",
    "f_ZCa, f_eps and Y_beta of 2019 on helical pairs",
    "F_pT, F_alphaT, F_betaT and their parts of ISO 1328-1:2013 (one source)",
    "Z_W with R_zH above 3 um and of two through hardened members; fading of Z_L, Z_v, Z_R, Z_W towards the static end",
    "Y_drelT and Y_RrelT of other than case hardened teeth; Y_DT",
    "life lines with pitting allowed, of nitrided and of nitrocarburised teeth",
    "strengths of ISO 6336-5 (one source)",
    "ISO 6336 for double helical pairs: no published report; each end is rated with half the torque and its own share",
    "K_Hbeta from a contact analysis: the procedure of annex E is not public; the definition of 7.2 is followed",
    NULL};

/* Verdict: */

static bool passes(const struct eo_design_rating *rating)
{
  const struct eo_rating_settings *settings = rating->basis[EO_LEFT].input.rating;
  return rating->rated && fmin(rating->flank_safety, rating->flank_static) >= settings->flank_safety &&
         fmin(rating->root_safety, rating->root_static) >= settings->root_safety;
}

static json_t *write_passes(const void *source)
{
  const struct eo_design_rating *rating = source;
  return rating->rated ? json_boolean(passes(rating)) : json_null();
}

static json_t *write_least_flank(const void *source)
{
  return eo_json_quantity(((const struct eo_design_rating *)source)->basis[EO_LEFT].input.rating->flank_safety, NULL);
}

static json_t *write_least_root(const void *source)
{
  return eo_json_quantity(((const struct eo_design_rating *)source)->basis[EO_LEFT].input.rating->root_safety, NULL);
}

static json_t *write_required_life(const void *source)
{
  return eo_json_quantity(((const struct eo_design_rating *)source)->time, &eo_unit_h);
}

#define OF_RATING(member) EO_AT(struct eo_design_rating, member)
static const struct eo_outline_row verdict_rows[] = {
    EO_KEY("passes", "flag?", "every safety reaches its minimum; null when it is not rated", .write = write_passes),
    EO_KEY("S_H", "number?", "least flank safety over members and ends, Miner over the required life",
           OF_RATING(flank_safety)),
    EO_KEY("S_Hmin", "number", "required", .write = write_least_flank),
    EO_KEY("S_F", "number?", "least root safety over members and ends, Miner over the required life",
           OF_RATING(root_safety)),
    EO_KEY("S_Fmin", "number", "required", .write = write_least_root),
    EO_KEY("S_H_static", "number?", "least static flank safety of the largest load", OF_RATING(flank_static)),
    EO_KEY("S_F_static", "number?", "least static root safety of the largest load", OF_RATING(root_static)),
    EO_KEY("life_h", "number?", "least life with S_Hmin and S_Fmin; null without end", .unit = &eo_unit_h,
           OF_RATING(life)),
    EO_KEY("required_life_h", "number", "hours of the load cases, or as stated for all of them", .unit = &eo_unit_h,
           .write = write_required_life),
};
static const struct eo_outline verdict = EO_OUTLINE("RatingVerdict", verdict_rows);

/* What no load changes: */

/* One member of the basis, flat. */
struct basis_member {
  double flank_limit, root_limit, hardness, shift, virtual_teeth;
  struct eo_tooth_root root;
  double rim;
  struct eo_root_influence influence;
  struct eo_flank_tolerance tolerance;
  double base_pitch;
};

#define OF_MEMBER(member) EO_AT(struct basis_member, member)
static const struct eo_outline_row basis_member_rows[] = {
    EO_KEY("sigma_Hlim_MPa", "number", "flank strength of the material", .unit = &eo_unit_MPa, OF_MEMBER(flank_limit)),
    EO_KEY("sigma_Flim_MPa", "number", "root strength of the material", .unit = &eo_unit_MPa, OF_MEMBER(root_limit)),
    EO_KEY("hardness_HV", "number?", "as stated or assumed", .unit = &eo_unit_HV, OF_MEMBER(hardness)),
    EO_KEY("z_n", "number", "teeth of the virtual spur gear", OF_MEMBER(virtual_teeth)),
    EO_KEY("x_form", "number", "shift behind the form factors: x_E, or x", OF_MEMBER(shift)),
    EO_KEY("s_Fn_over_mn", "number", "chord of the critical section", OF_MEMBER(root.chord)),
    EO_KEY("h_Fe_over_mn", "number", "bending arm", OF_MEMBER(root.arm)),
    EO_KEY("rho_F_over_mn", "number", "fillet radius there", OF_MEMBER(root.fillet_radius)),
    EO_KEY("alpha_Fen_deg", "number", "angle of the load", .unit = &eo_unit_deg, OF_MEMBER(root.load_angle)),
    EO_KEY("q_s", "number", "notch parameter", OF_MEMBER(root.notch)),
    EO_KEY("f_eps", "number", "load sharing of 2019; 1 with 2006", OF_MEMBER(root.load_share)),
    EO_KEY("Y_F", "number", "form factor, f_eps in it", OF_MEMBER(root.form_factor)),
    EO_KEY("Y_S", "number", "stress correction", OF_MEMBER(root.stress_correction)),
    EO_KEY("Y_beta", "number", "helix factor", OF_MEMBER(root.helix_factor)),
    EO_KEY("Y_B", "number", "rim factor", OF_MEMBER(rim)),
    EO_KEY("Y_DT", "number", "deep tooth factor", OF_MEMBER(root.deep_tooth)),
    EO_KEY("Y_drelT", "number", "notch sensitivity", OF_MEMBER(influence.notch)),
    EO_KEY("Y_RrelT", "number", "surface of the fillet", OF_MEMBER(influence.surface)),
    EO_KEY("Y_X", "number", "size", OF_MEMBER(influence.size)),
    EO_KEY("Y_M", "number", "mean stress, as stated", OF_MEMBER(influence.mean)),
    EO_KEY("f_pt_um", "number", "single pitch (2013: f_pT)", .unit = &eo_unit_um, OF_MEMBER(tolerance.single_pitch)),
    EO_KEY("F_p_um", "number", "total pitch", .unit = &eo_unit_um, OF_MEMBER(tolerance.total_pitch)),
    EO_KEY("f_falpha_um", "number", "profile form", .unit = &eo_unit_um, OF_MEMBER(tolerance.profile_form)),
    EO_KEY("f_Halpha_um", "number", "profile slope", .unit = &eo_unit_um, OF_MEMBER(tolerance.profile_slope)),
    EO_KEY("F_alpha_um", "number", "profile, total", .unit = &eo_unit_um, OF_MEMBER(tolerance.profile_total)),
    EO_KEY("f_fbeta_um", "number", "helix form", .unit = &eo_unit_um, OF_MEMBER(tolerance.helix_form)),
    EO_KEY("f_Hbeta_um", "number", "helix slope", .unit = &eo_unit_um, OF_MEMBER(tolerance.helix_slope)),
    EO_KEY("F_beta_um", "number", "helix, total", .unit = &eo_unit_um, OF_MEMBER(tolerance.helix_total)),
    EO_KEY("F_r_um", "number?", "runout; null where the edition states none", .unit = &eo_unit_um,
           OF_MEMBER(tolerance.runout)),
    EO_KEY("f_pb_um", "number", "base pitch", .unit = &eo_unit_um, OF_MEMBER(base_pitch)),
};
static const struct eo_outline basis_member = EO_OUTLINE("RatingMember", basis_member_rows);

static json_t *encode_basis_member(const struct eo_rating_basis *basis, int i)
{
  const struct eo_geometry *geometry = basis->input.geometry;
  double thinning = basis->input.rating->root_shift == EO_ROOT_SHIFT_NOMINAL ? 0 : basis->input.thickness_allowance[i];
  const struct basis_member member = {.flank_limit = basis->strength[i].flank,
                                      .root_limit = basis->strength[i].root,
                                      .hardness = basis->hardness[i],
                                      .shift = geometry->profile_shift[i] +
                                               thinning /
                                                   (2 * geometry->normal_module * tan(geometry->normal_pressure_angle)),
                                      .virtual_teeth = basis->geometry.virtual_teeth[i],
                                      .root = basis->root[i],
                                      .rim = basis->rim_factor[i],
                                      .influence = basis->endurance[i],
                                      .tolerance = basis->tolerance[i],
                                      .base_pitch = basis->base_pitch_tolerance[i]};
  return eo_outline_encode(&basis_member, &member);
}

static json_t *write_basis_pinion(const void *source)
{
  return encode_basis_member(source, EO_PINION);
}

static json_t *write_basis_gear(const void *source)
{
  return encode_basis_member(source, EO_GEAR);
}

static json_t *write_basis_width(const void *source)
{
  return eo_json_quantity(((const struct eo_rating_basis *)source)->pair.face_width, &eo_unit_mm);
}

static json_t *write_total_ratio(const void *source)
{
  const struct eo_rating_geometry *geometry = &((const struct eo_rating_basis *)source)->geometry;
  return eo_json_quantity(geometry->transverse_contact_ratio + geometry->overlap_ratio, NULL);
}

static json_t *write_resonance(const void *source)
{
  return eo_json_quantity(2 * M_PI * ((const struct eo_rating_basis *)source)->resonance_speed, &eo_unit_rpm);
}

#define OF_BASIS(member) EO_AT(struct eo_rating_basis, member)
static const struct eo_outline_row basis_rows[] = {
    EO_KEY("b_mm", "number", "face width that is rated: of one end", .unit = &eo_unit_mm, .write = write_basis_width),
    EO_KEY("eps_alpha", "number", "transverse contact ratio", OF_BASIS(geometry.transverse_contact_ratio)),
    EO_KEY("eps_beta", "number", "overlap ratio of one end", OF_BASIS(geometry.overlap_ratio)),
    EO_KEY("eps_gamma", "number", "total contact ratio", .write = write_total_ratio),
    EO_KEY("c_single_N_per_mm_um", "number",
           "c' from 100 N/mm of specific load on, solid discs, C_M = 0.8, z_n = z/(cos^2 beta_b cos beta)",
           .unit = &eo_unit_N_per_mm_um, OF_BASIS(stiffness.single)),
    EO_KEY("c_gamma_alpha_N_per_mm_um", "number", "mesh stiffness of K_V and K_Halpha, likewise",
           .unit = &eo_unit_N_per_mm_um, OF_BASIS(stiffness.mesh_alpha)),
    EO_KEY("c_gamma_beta_N_per_mm_um", "number", "mesh stiffness of K_Hbeta, likewise", .unit = &eo_unit_N_per_mm_um,
           OF_BASIS(stiffness.mesh_beta)),
    EO_KEY("m_red_kg_per_m", "number", "reduced mass per face width, rims down to the bores", OF_BASIS(reduced_mass)),
    EO_KEY("n_E1_rpm", "number", "resonance speed of the pinion, likewise", .unit = &eo_unit_rpm,
           .write = write_resonance),
    EO_KEY("f_ma_um", "number", "mesh misalignment: root of the sum of squares of both helix slope tolerances",
           .unit = &eo_unit_um, OF_BASIS(mesh_deviation)),
    EO_KEY("rho_red_mm", "number", "relative curvature radius of Z_R and Z_W", .unit = &eo_unit_mm,
           OF_BASIS(relative_curvature)),
    EO_KEY("b_over_h", "number", "of K_Fbeta, the smaller of both members", OF_BASIS(width_over_depth)),
    EO_KEY("pinion", "object", "pinion", .outline = &basis_member, .write = write_basis_pinion),
    EO_KEY("gear", "object", "gear", .outline = &basis_member, .write = write_basis_gear),
};
static const struct eo_outline basis = EO_OUTLINE("RatingBasis", basis_rows);

/* Spectrum: */

#define OF_SIDE(member) EO_AT(struct eo_rated_side, member)
static const struct eo_outline_row side_rows[] = {
    EO_KEY("S", "number?", "factor on all stresses that makes Miner's sum 1 over the required life; null without end",
           OF_SIDE(safety)),
    EO_KEY("damage", "number", "Miner's sum over the required life at S = 1", OF_SIDE(damage)),
    EO_KEY("life_h", "number?", "until Miner's sum is 1; null without end", .unit = &eo_unit_h, OF_SIDE(life)),
    EO_KEY("life_at_S_min_h", "number?", "the same with the required safety", .unit = &eo_unit_h,
           OF_SIDE(life_at_least)),
    EO_KEY("S_static", "number?", "static strength over the largest stress", OF_SIDE(static_safety)),
};
static const struct eo_outline side = EO_OUTLINE("RatedSide", side_rows);

/* One member of a spectrum. */
struct spectrum_member {
  struct eo_rated_side flank, root;
};
static const struct eo_outline_row spectrum_member_rows[] = {
    EO_KEY("flank", "object", "flank", .outline = &side, EO_AT(struct spectrum_member, flank)),
    EO_KEY("root", "object", "root", .outline = &side, EO_AT(struct spectrum_member, root)),
};
static const struct eo_outline spectrum_member = EO_OUTLINE("RatedSpectrumMember", spectrum_member_rows);

struct spectrum {
  bool two;
  struct spectrum_end {
    struct spectrum_member member[2];
  } end[2];
};

static const struct eo_outline_row spectrum_end_rows[] = {
    EO_KEY("pinion", "object", "pinion", .outline = &spectrum_member, EO_AT(struct spectrum_end, member[EO_PINION])),
    EO_KEY("gear", "object", "gear", .outline = &spectrum_member, EO_AT(struct spectrum_end, member[EO_GEAR])),
};
static const struct eo_outline spectrum_end = EO_OUTLINE("RatedSpectrumEnd", spectrum_end_rows);

static const struct eo_outline_row spectrum_rows[] = {
    EO_KEY("left", "object", "left end", .outline = &spectrum_end, EO_AT(struct spectrum, end[EO_LEFT])),
    EO_KEY("right", "object", "right end", .when = EO_TWO_ENDS, .outline = &spectrum_end,
           EO_AT(struct spectrum, end[EO_RIGHT]), EO_IF(struct spectrum, two)),
};
static const struct eo_outline spectrum = EO_OUTLINE("RatedSpectrum", spectrum_rows);

static json_t *encode_spectrum(const struct eo_result_source *source)
{
  struct spectrum view = {.two = source->ends == 2};
  for (int end = 0; end < source->ends; end++) {
    const struct eo_rated_spectrum *found = &source->analysis->rating->end[end];
    for (int member = 0; member < 2; member++)
      view.end[end].member[member] = (struct spectrum_member){found->flank[member], found->root[member]};
  }
  return eo_outline_encode(&spectrum, &view);
}

/* All: */

static const char *const outcomes[] = {"rated", "not_rated", NULL};

struct rating {
  bool uneven;
  int outcome;
  const char *reason; /* "": rated */
  json_t *settings, *standards, *unchecked, *verdict, *basis[2], *cases, *spectrum;
};

#define OF_DOCUMENT(name) EO_AT(struct rating, name)
static const struct eo_outline_row rating_rows[] = {
    EO_KEY("outcome", "word", "not_rated: ISO 6336 does not rate such a pair, or an input is missing",
           .words = outcomes, OF_DOCUMENT(outcome)),
    EO_KEY("reason", "text?", "of not_rated, for people", OF_DOCUMENT(reason)),
    EO_KEY("settings", "object", "what it goes by, with every default", .table = &eo_rating_table,
           .name = "RatingSettings", OF_DOCUMENT(settings)),
    EO_KEY("standards", "[text]", "with their editions and methods", OF_DOCUMENT(standards)),
    EO_KEY("unchecked", "[text]", "what no published report has confirmed", OF_DOCUMENT(unchecked)),
    EO_KEY("verdict", "object", "what may be signed", .outline = &verdict, OF_DOCUMENT(verdict)),
    EO_KEY("pair", "object?", "what no load changes; null when it is not rated", .outline = &basis,
           OF_DOCUMENT(basis[EO_LEFT])),
    EO_KEY("right_pair", "object?", "the same of the right end", .outline = &basis, .when = EO_UNEVEN,
           OF_DOCUMENT(basis[EO_RIGHT]), EO_IF(struct rating, uneven)),
    EO_KEY("load_cases", "[object]?", "in the order of the design; null when it is not rated",
           .outline = &eo_outline_rated_case, OF_DOCUMENT(cases)),
    EO_KEY("spectrum", "object?", "all load cases together, ISO 6336-6; null when it is not rated",
           .outline = &spectrum, OF_DOCUMENT(spectrum)),
};
const struct eo_outline eo_outline_rating = EO_OUTLINE("Rating", rating_rows);

static json_t *encode_cases(const struct eo_result_source *source)
{
  struct eo_object cases = eo_list_open();
  for (int k = 0; k < source->evaluation->cases; k++)
    eo_list_add(&cases, eo_result_rated_case(source, k));
  return eo_object_close(&cases);
}

json_t *eo_result_rating(const struct eo_result_source *source)
{
  const struct eo_design_rating *rating = source->analysis->rating;
  if (!(source->analysis->want & EO_WANT_RATING))
    return json_null();
  bool new = source->design->rating.edition == EO_ISO6336_2019;
  bool rated = rating->rated;
  struct rating view = {.uneven = source->pair->right,
                        .outcome = rated ? 0 : 1,
                        .reason = rated ? "" : rating->reason.text,
                        .settings = eo_table_encode(&eo_rating_table, &source->design->rating),
                        .standards = texts_of(new ? standards_2019 : standards_2006),
                        .unchecked = texts_of(new ? unchecked_2019 : unchecked_2006),
                        .verdict = eo_outline_encode(&verdict, rating),
                        .cases = rated ? encode_cases(source) : json_null(),
                        .spectrum = rated ? encode_spectrum(source) : json_null()};
  for (int half = 0; half < eo_pair_halves(source->pair); half++)
    view.basis[half] = rated ? eo_outline_encode(&basis, &rating->basis[half]) : json_null();
  return eo_outline_encode(&eo_outline_rating, &view);
}
