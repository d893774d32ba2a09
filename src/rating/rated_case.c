/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One load case, and several as a spectrum. */
#include <math.h>

#include "rating/gear_rating.h"

static double larger(const double value[2])
{
  return fmax(value[0], value[1]);
}

static bool is_soft(enum eo_rating_material material)
{
  return material == EO_THROUGH_HARDENED_ALLOY || material == EO_THROUGH_HARDENED_CARBON || material == EO_STRUCTURAL;
}

/* y_alpha of f_pb, or y_f of f_falpha; unlike members: the mean. */
static double running_in(const struct eo_rating_basis *basis, double velocity, double deviation)
{
  double sum = 0;
  for (int i = 0; i < 2; i++)
    sum += eo_pitch_running_in(basis->input.rating->member[i].material, basis->strength[i].flank, velocity, deviation);
  return sum / 2;
}

/* F_t K_A K_gamma/b, and what it leaves of the stiffness. */
static void find_line_load(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis)
{
  rated_case->line_load = rated_case->tangential_force * basis->input.rating->application_factor *
                          rated_case->load.sharing / basis->pair.face_width;
  rated_case->light_load = eo_light_load_factor(rated_case->line_load);
}

static double profile_deviation(const struct eo_rating_basis *basis)
{
  return fmax(basis->tolerance[0].profile_form, basis->tolerance[1].profile_form);
}

/* K_V, method B. */
static enum eo_code find_dynamic(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis,
                                 struct eo_error *error)
{
  double relief = basis->input.tip_relief, pitch = larger(basis->base_pitch_tolerance);
  if (!(relief > 0))
    relief = (eo_running_in_relief(basis->strength[0].flank) + eo_running_in_relief(basis->strength[1].flank)) / 2;
  rated_case->resonance_ratio = rated_case->load.speed / (2 * M_PI) /
                                (basis->resonance_speed * sqrt(rated_case->light_load)); /* (6) */
  const struct eo_dynamic_input in = {
      .resonance_ratio = rated_case->resonance_ratio,
      .total_contact_ratio = basis->geometry.transverse_contact_ratio + basis->geometry.overlap_ratio,
      .single_stiffness = basis->stiffness.single * rated_case->light_load,
      .line_load = rated_case->line_load,
      .pitch_deviation = pitch,
      .profile_deviation = profile_deviation(basis),
      .pitch_running_in = running_in(basis, rated_case->velocity, pitch),
      .profile_running_in = running_in(basis, rated_case->velocity, profile_deviation(basis)),
      .tip_relief = relief,
      .grade = basis->input.rating->accuracy_grade};
  EO_TRY(eo_dynamic_factor(&rated_case->dynamic, &in, error));
  rated_case->method_c.dynamic = rated_case->dynamic.factor;
  return EO_OK;
}

/* f_sh from the pinion's bearings (7.6.2); the crossing of a pinion with two helices is that of the standard. */
static enum eo_code find_shaft_deviation(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis,
                                         double mean_load, struct eo_error *error)
{
  const struct eo_rating_input *in = &basis->input;
  const double stiffens = 1.15; /* d_1/d_sh */
  const struct eo_shaft_input shaft = {.arrangement = in->rating->arrangement,
                                       .stiffened = basis->geometry.reference_diameter[0] >=
                                                    stiffens * in->shaft_diameter,
                                       .double_helical = in->pair->ends == 2,
                                       .span = in->bearing_span,
                                       .offset = in->bearing_offset,
                                       .reference_diameter = basis->geometry.reference_diameter[0],
                                       .shaft_diameter = in->shaft_diameter,
                                       .face_width = basis->pair.face_width,
                                       .mean_load = mean_load,
                                       .power_share = 1};
  return eo_shaft_deviation(&rated_case->shaft_deviation, &shaft, error);
}

/* K_Hbeta, method C (7.6). */
static enum eo_code find_face(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis,
                              struct eo_error *error)
{
  const struct eo_rating_settings *settings = basis->input.rating;
  double b1, b2, load = rated_case->line_load * rated_case->method_c.dynamic, running = 0;
  EO_TRY(find_shaft_deviation(rated_case, basis, load, error));
  eo_helix_measure_factors(settings->helix_measure, &b1, &b2);
  double least = eo_least_deviation(load, fmax(basis->tolerance[0].helix_slope, basis->tolerance[1].helix_slope));
  rated_case->helix_deviation = eo_helix_deviation(rated_case->shaft_deviation, basis->mesh_deviation, b1, b2, least);
  for (int i = 0; i < 2; i++)
    running += eo_helix_running_in(settings->member[i].material, basis->strength[i].flank, rated_case->velocity,
                                   rated_case->helix_deviation);
  rated_case->helix_running_in = running / 2;
  rated_case->method_c.face = eo_face_load_factor(rated_case->helix_deviation - rated_case->helix_running_in,
                                                  basis->stiffness.mesh_beta * rated_case->light_load, load);
  return EO_OK;
}

/* K_Halpha, K_Falpha (method B) and K_Fbeta that belong to the K_V and K_Hbeta of f. */
static void complete_factors(struct eo_rated_factors *factors, const struct eo_rating_basis *basis,
                             const struct eo_rated_case *rated_case)
{
  const struct eo_rating_geometry *geometry = &basis->geometry;
  double pitch = larger(basis->base_pitch_tolerance);
  const struct eo_transverse_input in = {
      .transverse_contact_ratio = geometry->transverse_contact_ratio,
      .total_contact_ratio = geometry->transverse_contact_ratio + geometry->overlap_ratio,
      .contact_ratio_factor = eo_contact_ratio_factor(geometry->transverse_contact_ratio, geometry->overlap_ratio),
      .mesh_stiffness = basis->stiffness.mesh_alpha * rated_case->light_load,
      .pitch_deviation = pitch,
      .profile_deviation = profile_deviation(basis),
      .running_in = running_in(basis, rated_case->velocity, pitch),
      .line_load = rated_case->line_load * factors->dynamic * factors->face};
  struct eo_transverse_factor share = eo_transverse_factor(&in);
  factors->share = share.flank;
  factors->root_share = share.root;
  factors->root_face = eo_root_face_factor(factors->face, basis->width_over_depth);
}

/* What the contact analysis gives, where it gives more than the deviations that only the formulae hold: pitch and
   profile deviations are in K_V and K_Halpha of method B alone, so the larger of both counts. */
static void choose_factors(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis)
{
  rated_case->used = rated_case->method_c;
  if (basis->input.rating->load_factors == EO_FACTORS_STANDARD)
    return;
  if (rated_case->load.dynamic > rated_case->used.dynamic)
    rated_case->used.dynamic = rated_case->load.dynamic;
  if (!isnan(rated_case->load.face))
    rated_case->used.face = rated_case->load.face;
  complete_factors(&rated_case->used, basis, rated_case);
  if (rated_case->load.share > rated_case->used.share)
    rated_case->used.share = rated_case->load.share;
  if (rated_case->load.share > rated_case->used.root_share)
    rated_case->used.root_share = rated_case->load.share;
}

static enum eo_code find_factors(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis,
                                 struct eo_error *error)
{
  find_line_load(rated_case, basis);
  EO_TRY(find_dynamic(rated_case, basis, error));
  enum eo_code code = find_face(rated_case, basis, error);
  if (code && (basis->input.rating->load_factors == EO_FACTORS_STANDARD || isnan(rated_case->load.face)))
    return code;
  if (code) /* the bearings are beyond method C; the contact analysis does not need it */
    rated_case->shaft_deviation = rated_case->helix_deviation = rated_case->helix_running_in =
        rated_case->method_c.face = NAN;
  complete_factors(&rated_case->method_c, basis, rated_case);
  choose_factors(rated_case, basis);
  return EO_OK;
}

/* Z_W of a member: harder and smooth teeth work-harden soft ones. Brinell is taken as the Vickers number. */
static double work_hardening(const struct eo_rating_basis *basis, int i, double velocity)
{
  const struct eo_rating_member *member = basis->input.rating->member;
  bool soft = is_soft(member[i].material), mate_soft = is_soft(member[1 - i].material);
  double viscosity = 1e6 * basis->input.rating->lubricant.viscosity_40;
  if (soft && !mate_soft)
    return eo_work_hardening(basis->hardness[i],
                             eo_equivalent_roughness(member[1 - i].flank_roughness, member[i].flank_roughness,
                                                     basis->relative_curvature, velocity, viscosity));
  if (i == EO_GEAR && soft && mate_soft && member[0].material != EO_STRUCTURAL && member[1].material != EO_STRUCTURAL)
    return eo_work_hardening_soft_pair(basis->hardness[0], basis->hardness[1],
                                       (double)basis->pair.teeth[1] / basis->pair.teeth[0]);
  return 1;
}

/* The S-N line over the endurance strength with all influences: Z_L Z_v Z_R Z_W fade on the logarithms towards the
   static end (ISO 6336-2 11.3, 12), so the line through the faded points is the line of faded points. */
static struct eo_life_line faded(const struct eo_life_line *line, double influences)
{
  struct eo_life_line result = *line;
  for (int i = 0; i < line->count; i++)
    result.factor[i] *= pow(influences, eo_life_share(line, line->cycles[i]) - 1);
  return result;
}

static void find_flank_strength(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis, int i)
{
  const struct eo_rating_settings *settings = basis->input.rating;
  double softer = fmin(basis->strength[0].flank, basis->strength[1].flank);
  const double roughness[2] = {settings->member[0].flank_roughness, settings->member[1].flank_roughness};
  struct eo_flank_influence *influence = &rated_case->influence[i];
  *influence =
      (struct eo_flank_influence){.lubricant = eo_lubricant_factor(softer, 1e6 * settings->lubricant.viscosity_40),
                                  .velocity = eo_velocity_factor(softer, rated_case->velocity),
                                  .roughness = eo_roughness_factor(softer, roughness, basis->relative_curvature),
                                  .work_hardening = work_hardening(basis, i, rated_case->velocity),
                                  .size = 1};
  rated_case->flank_endurance[i] = eo_flank_strength(basis->strength[i].flank, 1, 1, influence);
  rated_case->flank_line[i] = faded(&basis->flank_life[i], influence->lubricant * influence->velocity *
                                                               influence->roughness * influence->work_hardening);
  rated_case->flank_life_factor[i] = eo_life_factor(&basis->flank_life[i], rated_case->cycles[i]);
  rated_case->flank_permissible[i] = rated_case->flank_endurance[i] *
                                     eo_life_factor(&rated_case->flank_line[i], rated_case->cycles[i]);
  rated_case->flank_safety[i] = rated_case->flank_permissible[i] / rated_case->contact.stress[i];
  rated_case->flank_static[i] = rated_case->flank_endurance[i] * rated_case->flank_line[i].factor[0] /
                                rated_case->contact.stress[i];
}

static void find_root_strength(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis, int i)
{
  const double doubled = 2; /* Y_ST */
  const struct eo_rated_factors *factors = &rated_case->used;
  rated_case->root_nominal[i] = basis->root[i].nominal * basis->rim_factor[i] * rated_case->tangential_force;
  rated_case->root_stress[i] = rated_case->root_nominal[i] * basis->input.rating->application_factor *
                               rated_case->load.sharing * factors->dynamic * factors->root_face * factors->root_share;
  rated_case->root_endurance[i] = eo_root_strength(doubled * basis->strength[i].root, &basis->endurance[i]);
  rated_case->root_life_factor[i] = eo_life_factor(&basis->root_life[i], rated_case->cycles[i]);
  rated_case->root_permissible[i] = rated_case->root_endurance[i] * rated_case->root_life_factor[i];
  rated_case->root_safety[i] = rated_case->root_permissible[i] / rated_case->root_stress[i];
  rated_case->root_static[i] = rated_case->root_endurance[i] * basis->root_life[i].factor[0] /
                               rated_case->root_stress[i];
}

/* Local stresses of the analysis against the same limits. */
static void find_local(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis)
{
  double load = basis->input.rating->application_factor * rated_case->used.dynamic;
  rated_case->local_flank = rated_case->load.pressure * sqrt(load);
  for (int i = 0; i < 2; i++) {
    rated_case->local_root[i] = rated_case->load.root[i] * load;
    rated_case->local_flank_safety[i] = rated_case->flank_permissible[i] / rated_case->local_flank;
    rated_case->local_root_safety[i] = rated_case->root_permissible[i] / rated_case->local_root[i];
  }
}

enum eo_code eo_rated_case_find(struct eo_rated_case *rated_case, const struct eo_rating_basis *basis,
                                const struct eo_rating_load *load, struct eo_error *error)
{
  const struct eo_rating_settings *settings = basis->input.rating;
  const struct eo_material pinion = eo_material_of(basis->input.material, EO_PINION),
                           gear = eo_material_of(basis->input.material, EO_GEAR);
  *rated_case = (struct eo_rated_case){.load = *load};
  rated_case->tangential_force = 2 * load->torque / basis->geometry.reference_diameter[0];
  rated_case->velocity = load->speed * basis->geometry.reference_diameter[0] / 2;
  EO_TRY(find_factors(rated_case, basis, error));
  const struct eo_contact_input contact = {
      .edition = settings->edition,
      .proof = EO_PROOF_ANALYSIS,
      .tangential_force = rated_case->tangential_force,
      .load_factor = settings->application_factor * load->sharing * rated_case->used.dynamic * rated_case->used.face *
                     rated_case->used.share,
      .elastic = {{pinion.youngs_modulus, gear.youngs_modulus}, {pinion.poissons_ratio, gear.poissons_ratio}}};
  EO_TRY(eo_contact_stress(&rated_case->contact, &basis->pair, &basis->geometry, &contact, error));
  for (int i = 0; i < 2; i++) {
    double turns = load->speed / (2 * M_PI) * load->time * basis->pair.teeth[0] / basis->pair.teeth[i];
    rated_case->cycles[i] = turns * settings->member[i].meshes_per_turn;
    find_flank_strength(rated_case, basis, i);
    find_root_strength(rated_case, basis, i);
  }
  find_local(rated_case, basis);
  return EO_OK;
}

/* One class of a spectrum: its stress over its own endurance strength, with the line that belongs to it. */
struct load_class {
  const struct eo_life_line *line;
  double ratio, cycles;
};
typedef struct load_class class_of(const struct eo_rating_basis *basis, const struct eo_rated_case *c, int member);

static struct load_class flank_class(const struct eo_rating_basis *basis, const struct eo_rated_case *rated_case,
                                     int member)
{
  (void)basis;
  return (struct load_class){&rated_case->flank_line[member],
                             rated_case->contact.stress[member] / rated_case->flank_endurance[member],
                             rated_case->cycles[member]};
}

static struct load_class root_class(const struct eo_rating_basis *basis, const struct eo_rated_case *rated_case,
                                    int member)
{
  return (struct load_class){&basis->root_life[member],
                             rated_case->root_stress[member] / rated_case->root_endurance[member],
                             rated_case->cycles[member]};
}

/* The classes of one side of a member's teeth: damage of one side is none of the other. */
struct spectrum {
  const struct eo_rating_basis *basis;
  int cases;
  const struct eo_rated_case *rated; /* [cases] */
  int member, side;
  class_of *find;
};

/* Miner's sum with all stresses times a safety. */
static double damage(const struct spectrum *spectrum, double safety)
{
  double sum = 0;
  for (int k = 0; k < spectrum->cases; k++) {
    struct load_class class = spectrum->find(spectrum->basis, &spectrum->rated[k], spectrum->member);
    if (spectrum->rated[k].load.side == spectrum->side && class.ratio > 0 && class.cycles > 0)
      sum += class.cycles / eo_life_cycles(class.line, safety * class.ratio);
  }
  return sum;
}

/* Bisection on the logarithm. */
static double spectrum_safety(const struct spectrum *spectrum)
{
  enum { HALVINGS = 60 };
  double low = log(1e-6), high = log(1e6);
  if (!(damage(spectrum, exp(high)) > 1))
    return INFINITY;
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (low + high) / 2;
    if (damage(spectrum, exp(middle)) > 1)
      high = middle;
    else
      low = middle;
  }
  return exp((low + high) / 2);
}

static double static_safety(const struct spectrum *spectrum)
{
  double least = INFINITY;
  for (int k = 0; k < spectrum->cases; k++) {
    struct load_class class = spectrum->find(spectrum->basis, &spectrum->rated[k], spectrum->member);
    least = fmin(least, class.line->factor[0] / class.ratio);
  }
  return least;
}

/* The worse of both sides. least: S_min. */
static struct eo_rated_side side_of(struct spectrum spectrum, double least)
{
  double time = 0;
  for (int k = 0; k < spectrum.cases; k++)
    time += spectrum.rated[k].load.time;
  struct eo_rated_side worse = {.safety = INFINITY, .life = INFINITY, .life_at_least = INFINITY};
  worse.static_safety = static_safety(&spectrum);
  for (spectrum.side = 0; spectrum.side < 2; spectrum.side++) {
    double sum = damage(&spectrum, 1);
    worse.safety = fmin(worse.safety, spectrum_safety(&spectrum));
    worse.damage = fmax(worse.damage, sum);
    worse.life = fmin(worse.life, time / sum);
    worse.life_at_least = fmin(worse.life_at_least, time / damage(&spectrum, least));
  }
  return worse;
}

void eo_rated_spectrum_find(struct eo_rated_spectrum *spectrum, const struct eo_rating_basis *basis, int cases,
                            const struct eo_rated_case *rated)
{
  const struct eo_rating_settings *settings = basis->input.rating;
  struct spectrum this_spectrum = {.basis = basis, .cases = cases, .rated = rated};
  for (this_spectrum.member = 0; this_spectrum.member < 2; this_spectrum.member++) {
    this_spectrum.find = flank_class;
    spectrum->flank[this_spectrum.member] = side_of(this_spectrum, settings->flank_safety);
    this_spectrum.find = root_class;
    spectrum->root[this_spectrum.member] = side_of(this_spectrum, settings->root_safety);
  }
}
