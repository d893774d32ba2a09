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

/* F_t K_A K_gamma/b. */
static double line_load(const struct eo_rating_basis *basis, const struct eo_rated_case *c)
{
  return c->tangential_force * basis->input.rating->application_factor * c->load.sharing / basis->pair.face_width;
}

static double profile_deviation(const struct eo_rating_basis *basis)
{
  return fmax(basis->tolerance[0].profile_form, basis->tolerance[1].profile_form);
}

/* K_V, method B. */
static enum eo_code find_dynamic(struct eo_rated_case *c, const struct eo_rating_basis *basis, struct eo_error *error)
{
  double relief = basis->input.tip_relief, pitch = larger(basis->base_pitch_tolerance);
  if (!(relief > 0))
    relief = (eo_running_in_relief(basis->strength[0].flank) + eo_running_in_relief(basis->strength[1].flank)) / 2;
  c->resonance_ratio = c->load.speed / (2 * M_PI) / basis->resonance_speed;
  const struct eo_dynamic_input in = {.resonance_ratio = c->resonance_ratio,
                                      .total_contact_ratio = basis->geometry.transverse_contact_ratio +
                                                             basis->geometry.overlap_ratio,
                                      .single_stiffness = basis->stiffness.single,
                                      .line_load = line_load(basis, c),
                                      .pitch_deviation = pitch,
                                      .profile_deviation = profile_deviation(basis),
                                      .pitch_running_in = running_in(basis, c->velocity, pitch),
                                      .profile_running_in = running_in(basis, c->velocity, profile_deviation(basis)),
                                      .tip_relief = relief,
                                      .grade = basis->input.rating->accuracy_grade};
  EO_TRY(eo_dynamic_factor(&c->dynamic, &in, error));
  c->method_c.dynamic = c->dynamic.factor;
  return EO_OK;
}

/* f_sh from the pinion's bearings (7.6.2); the crossing of a pinion with two helices is that of the standard. */
static enum eo_code find_shaft_deviation(struct eo_rated_case *c, const struct eo_rating_basis *basis, double mean_load,
                                         struct eo_error *error)
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
  return eo_shaft_deviation(&c->shaft_deviation, &shaft, error);
}

/* K_Hbeta, method C (7.6). */
static enum eo_code find_face(struct eo_rated_case *c, const struct eo_rating_basis *basis, struct eo_error *error)
{
  const struct eo_rating_settings *r = basis->input.rating;
  double b1, b2, load = line_load(basis, c) * c->method_c.dynamic, running = 0;
  EO_TRY(find_shaft_deviation(c, basis, load, error));
  eo_helix_measure_factors(r->helix_measure, &b1, &b2);
  double least = eo_least_deviation(load, fmax(basis->tolerance[0].helix_slope, basis->tolerance[1].helix_slope));
  c->helix_deviation = eo_helix_deviation(c->shaft_deviation, basis->mesh_deviation, b1, b2, least);
  for (int i = 0; i < 2; i++)
    running += eo_helix_running_in(r->member[i].material, basis->strength[i].flank, c->velocity, c->helix_deviation);
  c->helix_running_in = running / 2;
  c->method_c.face = eo_face_load_factor(c->helix_deviation - c->helix_running_in, basis->stiffness.mesh_beta, load);
  return EO_OK;
}

/* K_Halpha, K_Falpha (method B) and K_Fbeta that belong to the K_V and K_Hbeta of f. */
static void complete_factors(struct eo_rated_factors *f, const struct eo_rating_basis *basis,
                             const struct eo_rated_case *c)
{
  const struct eo_rating_geometry *g = &basis->geometry;
  double pitch = larger(basis->base_pitch_tolerance);
  const struct eo_transverse_input in = {
      .transverse_contact_ratio = g->transverse_contact_ratio,
      .total_contact_ratio = g->transverse_contact_ratio + g->overlap_ratio,
      .contact_ratio_factor = eo_contact_ratio_factor(g->transverse_contact_ratio, g->overlap_ratio),
      .mesh_stiffness = basis->stiffness.mesh_alpha,
      .pitch_deviation = pitch,
      .profile_deviation = profile_deviation(basis),
      .running_in = running_in(basis, c->velocity, pitch),
      .line_load = line_load(basis, c) * f->dynamic * f->face};
  struct eo_transverse_factor share = eo_transverse_factor(&in);
  f->share = share.flank;
  f->root_share = share.root;
  f->root_face = eo_root_face_factor(f->face, basis->width_over_depth);
}

/* What the contact analysis gives, where it gives more than the deviations that only the formulae hold: pitch and
   profile deviations are in K_V and K_Halpha of method B alone, so the larger of both counts. */
static void choose_factors(struct eo_rated_case *c, const struct eo_rating_basis *basis)
{
  c->used = c->method_c;
  if (basis->input.rating->load_factors == EO_FACTORS_STANDARD)
    return;
  if (c->load.dynamic > c->used.dynamic)
    c->used.dynamic = c->load.dynamic;
  if (!isnan(c->load.face))
    c->used.face = c->load.face;
  complete_factors(&c->used, basis, c);
  if (c->load.share > c->used.share)
    c->used.share = c->load.share;
  if (c->load.share > c->used.root_share)
    c->used.root_share = c->load.share;
}

static enum eo_code find_factors(struct eo_rated_case *c, const struct eo_rating_basis *basis, struct eo_error *error)
{
  EO_TRY(find_dynamic(c, basis, error));
  enum eo_code code = find_face(c, basis, error);
  if (code && (basis->input.rating->load_factors == EO_FACTORS_STANDARD || isnan(c->load.face)))
    return code;
  if (code) /* the bearings are beyond method C; the contact analysis does not need it */
    c->shaft_deviation = c->helix_deviation = c->helix_running_in = c->method_c.face = NAN;
  complete_factors(&c->method_c, basis, c);
  choose_factors(c, basis);
  return EO_OK;
}

/* Z_W of a member: harder and smooth teeth work-harden soft ones. Brinell is taken as the Vickers number. */
static double work_hardening(const struct eo_rating_basis *basis, int i, double velocity)
{
  const struct eo_rating_member *m = basis->input.rating->member;
  bool soft = is_soft(m[i].material), mate_soft = is_soft(m[1 - i].material);
  double viscosity = 1e6 * basis->input.rating->lubricant.viscosity_40;
  if (soft && !mate_soft)
    return eo_work_hardening(basis->hardness[i],
                             eo_equivalent_roughness(m[1 - i].flank_roughness, m[i].flank_roughness,
                                                     basis->relative_curvature, velocity, viscosity));
  if (i == EO_GEAR && soft && mate_soft && m[0].material != EO_STRUCTURAL && m[1].material != EO_STRUCTURAL)
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

static void find_flank_strength(struct eo_rated_case *c, const struct eo_rating_basis *basis, int i)
{
  const struct eo_rating_settings *r = basis->input.rating;
  double softer = fmin(basis->strength[0].flank, basis->strength[1].flank);
  const double roughness[2] = {r->member[0].flank_roughness, r->member[1].flank_roughness};
  struct eo_flank_influence *z = &c->influence[i];
  *z = (struct eo_flank_influence){.lubricant = eo_lubricant_factor(softer, 1e6 * r->lubricant.viscosity_40),
                                   .velocity = eo_velocity_factor(softer, c->velocity),
                                   .roughness = eo_roughness_factor(softer, roughness, basis->relative_curvature),
                                   .work_hardening = work_hardening(basis, i, c->velocity),
                                   .size = 1};
  c->flank_endurance[i] = eo_flank_strength(basis->strength[i].flank, 1, 1, z);
  c->flank_line[i] = faded(&basis->flank_life[i], z->lubricant * z->velocity * z->roughness * z->work_hardening);
  c->flank_life_factor[i] = eo_life_factor(&basis->flank_life[i], c->cycles[i]);
  c->flank_permissible[i] = c->flank_endurance[i] * eo_life_factor(&c->flank_line[i], c->cycles[i]);
  c->flank_safety[i] = c->flank_permissible[i] / c->contact.stress[i];
  c->flank_static[i] = c->flank_endurance[i] * c->flank_line[i].factor[0] / c->contact.stress[i];
}

static void find_root_strength(struct eo_rated_case *c, const struct eo_rating_basis *basis, int i)
{
  const double doubled = 2; /* Y_ST */
  const struct eo_rated_factors *k = &c->used;
  c->root_nominal[i] = basis->root[i].nominal * basis->rim_factor[i] * c->tangential_force;
  c->root_stress[i] = c->root_nominal[i] * basis->input.rating->application_factor * c->load.sharing * k->dynamic *
                      k->root_face * k->root_share;
  c->root_endurance[i] = eo_root_strength(doubled * basis->strength[i].root, &basis->endurance[i]);
  c->root_life_factor[i] = eo_life_factor(&basis->root_life[i], c->cycles[i]);
  c->root_permissible[i] = c->root_endurance[i] * c->root_life_factor[i];
  c->root_safety[i] = c->root_permissible[i] / c->root_stress[i];
  c->root_static[i] = c->root_endurance[i] * basis->root_life[i].factor[0] / c->root_stress[i];
}

/* Local stresses of the analysis against the same limits. */
static void find_local(struct eo_rated_case *c, const struct eo_rating_basis *basis)
{
  double load = basis->input.rating->application_factor * c->used.dynamic;
  c->local_flank = c->load.pressure * sqrt(load);
  for (int i = 0; i < 2; i++) {
    c->local_root[i] = c->load.root[i] * load;
    c->local_flank_safety[i] = c->flank_permissible[i] / c->local_flank;
    c->local_root_safety[i] = c->root_permissible[i] / c->local_root[i];
  }
}

enum eo_code eo_rated_case_find(struct eo_rated_case *c, const struct eo_rating_basis *basis,
                                const struct eo_rating_load *load, struct eo_error *error)
{
  const struct eo_rating_settings *r = basis->input.rating;
  const struct eo_material pinion = eo_material_of(basis->input.material, EO_PINION),
                           gear = eo_material_of(basis->input.material, EO_GEAR);
  *c = (struct eo_rated_case){.load = *load};
  c->tangential_force = 2 * load->torque / basis->geometry.reference_diameter[0];
  c->velocity = load->speed * basis->geometry.reference_diameter[0] / 2;
  EO_TRY(find_factors(c, basis, error));
  const struct eo_contact_input contact = {
      .edition = r->edition,
      .proof = EO_PROOF_ANALYSIS,
      .tangential_force = c->tangential_force,
      .load_factor = r->application_factor * load->sharing * c->used.dynamic * c->used.face * c->used.share,
      .elastic = {{pinion.youngs_modulus, gear.youngs_modulus}, {pinion.poissons_ratio, gear.poissons_ratio}}};
  EO_TRY(eo_contact_stress(&c->contact, &basis->pair, &basis->geometry, &contact, error));
  for (int i = 0; i < 2; i++) {
    double turns = load->speed / (2 * M_PI) * load->time * basis->pair.teeth[0] / basis->pair.teeth[i];
    c->cycles[i] = turns * r->member[i].meshes_per_turn;
    find_flank_strength(c, basis, i);
    find_root_strength(c, basis, i);
  }
  find_local(c, basis);
  return EO_OK;
}

/* One class of a spectrum: its stress over its own endurance strength, with the line that belongs to it. */
struct load_class {
  const struct eo_life_line *line;
  double ratio, cycles;
};
typedef struct load_class class_of(const struct eo_rating_basis *basis, const struct eo_rated_case *c, int member);

static struct load_class flank_class(const struct eo_rating_basis *basis, const struct eo_rated_case *c, int member)
{
  (void)basis;
  return (struct load_class){&c->flank_line[member], c->contact.stress[member] / c->flank_endurance[member],
                             c->cycles[member]};
}

static struct load_class root_class(const struct eo_rating_basis *basis, const struct eo_rated_case *c, int member)
{
  return (struct load_class){&basis->root_life[member], c->root_stress[member] / c->root_endurance[member],
                             c->cycles[member]};
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
static double damage(const struct spectrum *s, double safety)
{
  double sum = 0;
  for (int k = 0; k < s->cases; k++) {
    struct load_class class = s->find(s->basis, &s->rated[k], s->member);
    if (s->rated[k].load.side == s->side && class.ratio > 0 && class.cycles > 0)
      sum += class.cycles / eo_life_cycles(class.line, safety * class.ratio);
  }
  return sum;
}

/* Bisection on the logarithm, as eo_life_safety() does for one line. */
static double spectrum_safety(const struct spectrum *s)
{
  enum { HALVINGS = 60 };
  double low = log(1e-6), high = log(1e6);
  if (!(damage(s, exp(high)) > 1))
    return INFINITY;
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (low + high) / 2;
    if (damage(s, exp(middle)) > 1)
      high = middle;
    else
      low = middle;
  }
  return exp((low + high) / 2);
}

static double static_safety(const struct spectrum *s)
{
  double least = INFINITY;
  for (int k = 0; k < s->cases; k++) {
    struct load_class class = s->find(s->basis, &s->rated[k], s->member);
    least = fmin(least, class.line->factor[0] / class.ratio);
  }
  return least;
}

/* The worse of both sides. least: S_min. */
static struct eo_rated_side side_of(struct spectrum s, double least)
{
  double time = 0;
  for (int k = 0; k < s.cases; k++)
    time += s.rated[k].load.time;
  struct eo_rated_side worse = {.safety = INFINITY, .life = INFINITY, .life_at_least = INFINITY};
  worse.static_safety = static_safety(&s);
  for (s.side = 0; s.side < 2; s.side++) {
    double sum = damage(&s, 1);
    worse.safety = fmin(worse.safety, spectrum_safety(&s));
    worse.damage = fmax(worse.damage, sum);
    worse.life = fmin(worse.life, time / sum);
    worse.life_at_least = fmin(worse.life_at_least, time / damage(&s, least));
  }
  return worse;
}

void eo_rated_spectrum_find(struct eo_rated_spectrum *spectrum, const struct eo_rating_basis *basis, int cases,
                            const struct eo_rated_case *rated)
{
  const struct eo_rating_settings *r = basis->input.rating;
  struct spectrum s = {.basis = basis, .cases = cases, .rated = rated};
  for (s.member = 0; s.member < 2; s.member++) {
    s.find = flank_class;
    spectrum->flank[s.member] = side_of(s, r->flank_safety);
    s.find = root_class;
    spectrum->root[s.member] = side_of(s, r->root_safety);
  }
}
