/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "design/design.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "design/check.h"
#include "design/design_grids.h"
#include "gear/entry.h"
#include "gear/geometry.h"
#include "rating/gear_rating.h"
#include "rating/pair_dimensions.h"
#include "rating/thickness_allowance.h"

static void fill(double *value, double derived)
{
  if (isnan(*value))
    *value = derived;
}

double eo_alignment_axial_stiffness(const struct eo_alignment *alignment)
{
  return alignment->pinion_axial == EO_AXIAL_FIXED      ? INFINITY
         : alignment->pinion_axial == EO_AXIAL_FLOATING ? 0
                                                        : alignment->pinion_axial_stiffness;
}

/* The rack of both members is the pinion's where nobody states one. */
static void resolve_rack(struct eo_gear_pair *pair)
{
  struct eo_rack rack = eo_gear_pair_rack(pair, EO_PINION);
  fill(&pair->addendum_coefficient, rack.addendum_coefficient);
  fill(&pair->dedendum_coefficient, rack.dedendum_coefficient);
  fill(&pair->fillet_radius_coefficient, rack.fillet_radius_coefficient);
}

/* "cd25", or "25cd" as other drawings have it, with blanks and capitals: letters and tolerance. What is neither is left
   to the letters as a whole, to be refused. */
static int split_series(const struct eo_gear_pair *pair, char letters[sizeof pair->thickness_series])
{
  const char *text = pair->thickness_series;
  int tolerance = 0, end = 0;
  if (sscanf(text, " %7[a-zA-Z] %2d %n", letters, &tolerance, &end) < 2)
    sscanf(text, " %2d %7[a-zA-Z] %n", &tolerance, letters, &end);
  if (text[end])
    snprintf(letters, sizeof pair->thickness_series, "%s", text);
  for (char *c = letters; *c; c++)
    *c = (char)tolower((unsigned char)*c);
  return tolerance;
}

static enum eo_code settle_series(struct eo_gear_pair *pair, struct eo_error *error)
{
  char letters[sizeof pair->thickness_series] = "";
  if (!*pair->thickness_series)
    return EO_OK;
  int tolerance = split_series(pair, letters);
  for (int i = 0; i < 2; i++) {
    struct eo_thickness_allowance of;
    struct eo_error found;
    double diameter = pair->normal_module / cos(pair->helix_angle) * pair->teeth[i];
    if (eo_thickness_allowance(&of, letters, tolerance, diameter, &found))
      return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/thickness_series", "%.380s", found.text);
    fill(&pair->thickness_allowance[i][0], of.upper);
    fill(&pair->thickness_allowance[i][1], of.lower);
  }
  return EO_OK;
}

double eo_alignment_outwards(const struct eo_alignment *alignment)
{
  return alignment->apex == EO_APEX_LEADING ? -1 : 1;
}

/* + right-handed; 0: not stated. */
static double hand_of(const struct eo_gear_pair *pair)
{
  return !*pair->hand ? 0 : strcmp(pair->hand, "right") == 0 ? 1 : -1;
}

static void set_hand(struct eo_gear_pair *pair, double hand)
{
  snprintf(pair->hand, sizeof pair->hand, "%s", hand > 0 ? "right" : "left");
}

double eo_design_rotation(const struct eo_design *design)
{
  double hand = hand_of(&design->gear_pair);
  return hand == 0 ? -1 : -hand * eo_alignment_outwards(&design->alignment); /* theory (F9) */
}

void eo_design_settle_rotation(struct eo_gear_pair *pair, struct eo_alignment *alignment)
{
  double hand = hand_of(pair), rotation = strcmp(alignment->pinion_rotation, "clockwise") == 0 ? 1 : -1;
  if (!*alignment->pinion_rotation)
    return;
  if (hand == 0)
    set_hand(pair, -rotation * eo_alignment_outwards(alignment));
  else
    alignment->apex = hand * rotation > 0 ? EO_APEX_LEADING : EO_APEX_TRAILING; /* theory (F9) */
  *alignment->pinion_rotation = '\0';
}

/* The mean of both allowances of both members, normal to the flank: j_bn = -(A_sn1 + A_sn2) cos alpha_n (DIN 3967). */
static enum eo_code settle_allowances(struct eo_gear_pair *pair, struct eo_error *error)
{
  static const char *const key[2] = {"/gear_pair/pinion_thickness_allowance_um",
                                     "/gear_pair/gear_thickness_allowance_um"};
  double sum = 0;
  EO_TRY(settle_series(pair, error));
  for (int i = 0; i < 2; i++) {
    const double *allowance = pair->thickness_allowance[i];
    sum += allowance[0] + allowance[1];
    if (allowance[1] > allowance[0])
      return eo_error_set(error, EO_ERROR_INPUT, key[i],
                          "The lower allowance, %.6g um, is above the upper one, %.6g um: state [upper, lower].",
                          1e6 * allowance[1], 1e6 * allowance[0]);
  }
  if (isnan(pair->backlash) && !isnan(sum))
    pair->backlash = -sum / 2 * cos(pair->normal_pressure_angle);
  return EO_OK;
}

/* F_beta of the grade, of the member for which it is larger, m. */
static enum eo_code helix_tolerance(const struct eo_design *design, double *largest, struct eo_error *error)
{
  const struct eo_gear_pair *pair = &design->gear_pair;
  *largest = 0;
  for (int i = 0; i < 2; i++) {
    struct eo_flank_tolerance tolerance;
    struct eo_error found;
    const struct eo_tolerance_input in = {.reference_diameter = pair->normal_module / cos(pair->helix_angle) *
                                                                pair->teeth[i],
                                          .normal_module = pair->normal_module,
                                          .face_width = pair->face_width + eo_gear_pair_extra_width(pair, i),
                                          .teeth = pair->teeth[i],
                                          .grade = design->alignment.error_grade,
                                          .total_contact_ratio = NAN,
                                          .helix_angle = pair->helix_angle};
    if (eo_flank_tolerance(&tolerance, eo_rating_tolerance_edition(&design->rating), &in, &found))
      return eo_error_set(error, EO_ERROR_INPUT, "/alignment/shaft_error_grade",
                          "%.300s State the errors themselves instead.", found.text);
    *largest = fmax(*largest, tolerance.helix_total);
  }
  return EO_OK;
}

/* What a stated grade allows (ISO/TR 10064-3): f_Sigma_beta = 0.5 (L/b) F_beta out of plane and twice that in the plane
   of the axes over the bearing span L, so gamma = 0.5 F_beta/b and kappa = F_beta/b, with the signs by which both add
   up in the plane of action. */
static enum eo_code settle_errors(struct eo_design *design, struct eo_error *error)
{
  static const double SAME = 1e-6;
  struct eo_alignment *alignment = &design->alignment;
  double tolerance, width = design->gear_pair.face_width;
  if (!alignment->error_grade)
    return EO_OK;
  EO_TRY(helix_tolerance(design, &tolerance, error));
  const double follows[2] = {-tolerance / width, 0.5 * tolerance / width},
               deviation[2] = {alignment->deviation_in_plane, alignment->deviation_out_of_plane};
  double *const angle[2] = {&alignment->shaft_angle_in_plane, &alignment->shaft_angle_out_of_plane};
  for (int i = 0; i < 2; i++) {
    double stated = isnan(deviation[i]) ? *angle[i] : atan(deviation[i] / width);
    if (stated != 0 && !(fabs(stated - follows[i]) <= SAME * fabs(follows[i])))
      return eo_error_set(error, EO_ERROR_INPUT, "/alignment/shaft_error_grade",
                          "Grade %d makes the shaft angle error %s %.6g deg, but %.6g deg is stated: leave one of the "
                          "two out.",
                          alignment->error_grade, i ? "out of plane" : "in plane", follows[i] * 180 / M_PI,
                          stated * 180 / M_PI);
    *angle[i] = follows[i];
  }
  return EO_OK;
}

enum eo_code eo_design_settle(struct eo_design *design, struct eo_error *error)
{
  eo_design_settle_rotation(&design->gear_pair, &design->alignment);
  EO_TRY(eo_gear_pair_settle(&design->gear_pair, error));
  EO_TRY(settle_errors(design, error));
  return settle_allowances(&design->gear_pair, error);
}

/* What no series and no allowance says: the backlash, half from each member or what the other leaves of it. */
static void resolve_allowances(struct eo_gear_pair *pair)
{
  double sum = -pair->backlash / cos(pair->normal_pressure_angle);
  for (int i = 0; i < 2; i++) {
    const double *other = pair->thickness_allowance[1 - i];
    double own = isnan(other[0]) ? sum / 2 : fmin(0, sum - (other[0] + other[1]) / 2);
    for (int k = 0; k < 2; k++)
      fill(&pair->thickness_allowance[i][k], own);
  }
}

static int usual_driver(const struct eo_design *design)
{
  for (int k = 0; k < design->load_cases; k++)
    if (design->load_case[k].driver != EO_GEAR)
      return EO_PINION;
  return design->load_cases ? EO_GEAR : EO_PINION;
}

/* The flank that carries a load case. */
static enum eo_flank_side flank_of(const struct eo_design *design, int load_case)
{
  const struct eo_load_case *this_case = &design->load_case[load_case];
  return (this_case->direction == EO_ASTERN) != (this_case->driver != usual_driver(design)) ? EO_COAST_FLANK
                                                                                            : EO_DRIVE_FLANK;
}

struct eo_running eo_design_running(const struct eo_design *design, int load_case)
{
  const struct eo_load_case *this_case = &design->load_case[load_case];
  const struct eo_alignment *alignment = &design->alignment;
  struct eo_running running = {.flank = this_case->flank,
                               .backwards = this_case->driver == EO_GEAR,
                               .inwards = (this_case->flank == EO_COAST_FLANK) != (alignment->apex == EO_APEX_LEADING),
                               .in_plane = alignment->shaft_angle_in_plane,
                               .out_of_plane = alignment->shaft_angle_out_of_plane};
  if (this_case->has_alignment && !isnan(this_case->alignment.in_plane))
    running.in_plane = this_case->alignment.in_plane;
  if (this_case->has_alignment && !isnan(this_case->alignment.out_of_plane))
    running.out_of_plane = this_case->alignment.out_of_plane;
  return running;
}

double eo_design_right_lag(const struct eo_design *design, const struct eo_geometry *geometry)
{
  double lead = eo_geometry_right_lead(geometry, &design->gear_pair) / geometry->transverse_base_pitch;
  return lead == 0 ? design->alignment.stagger
                   : design->alignment.stagger - eo_alignment_outwards(&design->alignment) * lead;
}

static void resolve_gear_pair(struct eo_gear_pair *pair, const struct eo_geometry *geometry)
{
  fill(&pair->groove_width, pair->ends == 2 ? 8 * pair->normal_module : 0);
  fill(&pair->centre_distance, geometry->centre_distance);
  fill(&pair->backlash, geometry->stated_backlash);
  for (int i = 0; i < 2; i++) {
    double root = 2 * geometry->root_radius[i];
    pair->rack[i] = eo_gear_pair_rack(pair, i);
    fill(&pair->tip_diameter[i], 2 * geometry->tip_radius[i]);
    fill(&pair->bore[i], i == EO_PINION ? 0 : fmin(15 * pair->normal_module, root / 2));
    fill(&pair->groove_diameter[i], fmax(root - 2e-3, 0.9 * root));
  }
  resolve_rack(pair);
  resolve_allowances(pair);
  fill(&pair->centre_distance_allowance, eo_centre_distance_allowance(pair->centre_distance));
}

/* Solid pitch cylinder of one end and half the groove body, less the bore: m and J per density. */
static void cylinder(const struct eo_gear_pair *pair, int i, double pitch_radius, double *volume, double *polar)
{
  double width = pair->face_width + eo_gear_pair_extra_width(pair, i);
  double groove = pair->ends == 2 ? eo_gear_pair_groove_width(pair, i) / 2 : 0, body = pair->groove_diameter[i] / 2,
         bore = pair->bore[i] / 2;
  *volume = pitch_radius * pitch_radius * width + body * body * groove - bore * bore * (width + groove);
  *polar = pow(pitch_radius, 4) * width + pow(body, 4) * groove - pow(bore, 4) * (width + groove);
}

/* A right end of another width is heavier or lighter as the cylinders are, also where the left one's mass is stated. */
static void resolve_inertia(struct eo_supports *supports, const struct eo_gear_pair *pair, double density, int i,
                            double pitch_radius)
{
  double volume[2], polar[2];
  cylinder(pair, i, pitch_radius, &volume[EO_LEFT], &polar[EO_LEFT]);
  fill(&supports->mass[i], density * M_PI * volume[EO_LEFT]);
  fill(&supports->inertia[i], density * M_PI / 2 * polar[EO_LEFT]);
  supports->right_mass[i] = supports->right_inertia[i] = 0;
  supports->right_base_helix_angle = 0;
  if (!eo_gear_pair_is_uneven(pair))
    return;
  const struct eo_gear_pair right = eo_gear_pair_half(pair, EO_RIGHT);
  if (eo_gear_pair_has_two_helices(pair))
    supports->right_base_helix_angle = asin(sin(right.helix_angle) * cos(right.normal_pressure_angle));
  cylinder(&right, i, pitch_radius, &volume[EO_RIGHT], &polar[EO_RIGHT]);
  supports->right_mass[i] = supports->mass[i] * volume[EO_RIGHT] / volume[EO_LEFT];
  supports->right_inertia[i] = supports->inertia[i] * polar[EO_RIGHT] / polar[EO_LEFT];
}

/* Bearings grow with the shaft they carry. 1e10 N/m2 of seat diameter: a cylindrical roller bearing of medium series by
   Palmgren's line contact has about twice that, housing and seat take the other half; bearings of published gearboxes
   lie around it from 10 N/um (small rotors) to 10 kN/um (wind turbines). Seats of equal torsional stress grow with the
   cube root of the torque. Axially a fifth, as a locating bearing's thrust part. */
static void resolve_bearings(struct eo_supports *supports, const struct eo_gear_pair *pair)
{
  static const double PER_SEAT = 1e10, SEAT = 0.8, AXIAL = 0.2;
  double pinion = SEAT * pair->groove_diameter[EO_PINION];
  double gear = fmin(pinion * cbrt((double)pair->teeth[EO_GEAR] / pair->teeth[EO_PINION]),
                     SEAT * pair->groove_diameter[EO_GEAR]);
  fill(&supports->bearing_stiffness[EO_PINION], PER_SEAT * pinion);
  fill(&supports->bearing_stiffness[EO_GEAR], PER_SEAT * gear);
  for (int end = 0; end < 2; end++)
    fill(&supports->gear_axial_stiffness[end], AXIAL * supports->bearing_stiffness[EO_GEAR]);
}

static void resolve_resolution(struct eo_resolution *resolution, const struct eo_gear_pair *pair,
                               const struct eo_geometry *geometry)
{
  enum { USUAL_HARMONICS = 16 };
  if (!resolution->cells_per_line)
    resolution->cells_per_line = eo_resolution_usual_cells(resolution, geometry);
  fill(&resolution->impact_patch, fmin(5 * pair->normal_module / 6, pair->face_width));
  if (!resolution->te_harmonics)
    resolution->te_harmonics = resolution->positions < 2 * USUAL_HARMONICS ? resolution->positions / 2
                                                                           : USUAL_HARMONICS;
}

static void resolve_groove(struct eo_supports *supports, const struct eo_gear_pair *pair,
                           const struct eo_material *both, int i)
{
  const struct eo_material own = eo_material_of(both, i), *material = &own;
  double body = pair->groove_diameter[i] / 2, bore = pair->bore[i] / 2, length = eo_gear_pair_groove_width(pair, i);
  double shear_modulus = material->youngs_modulus / (2 * (1 + material->poissons_ratio));
  fill(&supports->groove_axial_stiffness[i], material->youngs_modulus * M_PI * (body * body - bore * bore) / length);
  fill(&supports->groove_torsional_stiffness[i], shear_modulus * M_PI / 2 * (pow(body, 4) - pow(bore, 4)) / length);
}

static void resolve_shafts(struct eo_shafts *shafts, const struct eo_gear_pair *pair)
{
  double outside[2];
  for (int end = 0; end < 2; end++)
    outside[end] = pair->ends == 2 ? pair->groove_width / 2 + 1.5 * eo_gear_pair_face_width(pair, end)
                                   : pair->face_width;
  for (int i = 0; i < 2; i++) {
    double beyond = eo_gear_pair_extra_width(pair, i) / 2;
    fill(&shafts->bearing_position[i][EO_LEFT], -(outside[EO_LEFT] + beyond));
    fill(&shafts->bearing_position[i][EO_RIGHT], outside[EO_RIGHT] + beyond);
    fill(&shafts->shaft_diameter[i],
         fmax(0.8 * pair->groove_diameter[i], (pair->groove_diameter[i] + pair->bore[i]) / 2));
  }
}

static void add_scenario(struct eo_objective *objective, double in_plane, double out_of_plane, double compliance,
                         double speed)
{
  objective->scenario[objective->scenarios++] = (struct eo_scenario){in_plane, out_of_plane, compliance, speed};
}

static void resolve_scenarios(struct eo_objective *objective, const struct eo_alignment *alignment)
{
  double in = alignment->shaft_angle_in_plane, out = alignment->shaft_angle_out_of_plane;
  /* Of the misalignment, and rad at least; of the compliance; of the speed. */
  static const double MISALIGNED = 0.2, LEAST = 0.01 * M_PI / 180, SOFTER = 0.1, FASTER = 0.05;
  double step = fmax(MISALIGNED * fabs(in), LEAST);
  for (int i = 0; i < objective->scenarios; i++) {
    fill(&objective->scenario[i].in_plane, in);
    fill(&objective->scenario[i].out_of_plane, out);
  }
  if (objective->robust == EO_ROBUST_OFF || objective->scenarios || objective->scatter_pairs)
    return;
  add_scenario(objective, in, out, 1, 1);
  for (int sign = -1; sign <= 1; sign += 2) {
    add_scenario(objective, in + sign * step, out, 1, 1);
    add_scenario(objective, in, out, 1 + SOFTER * sign, 1);
    add_scenario(objective, in, out, 1, 1 + FASTER * sign);
  }
}

static void resolve_amount(struct eo_range *range, double most)
{
  fill(&range->low, 0);
  fill(&range->high, most);
}

static void resolve_start_range(struct eo_range *range, double active, double module)
{
  double high = 0.9 * active;
  fill(&range->high, high);
  fill(&range->low, fmin(0.05 * module, 0.5 * range->high));
}

/* The paper's five parameters of a flank, once or at each end, or those of the list. */
static int count_variables(const struct eo_optimization *optimization, int ends)
{
  switch (optimization->variables) {
  case EO_VARIABLES_SHARED:
    return 5;
  case EO_VARIABLES_PER_END:
    return 5 * ends;
  case EO_VARIABLES_LISTED:
    break;
  }
  return optimization->listed;
}

static int count_axes(const struct eo_design *design)
{
  switch (design->optimization.front) {
  case EO_FRONT_NOMINAL_AND_ROBUST:
    return 2;
  case EO_FRONT_TERMS:
    return design->objective.terms > 0 ? design->objective.terms : 1;
  case EO_FRONT_OBJECTIVES:
    break;
  }
  return 3;
}

/* A front needs the values themselves of all that it is made of. */
static void resolve_first_pairs(struct eo_design *design)
{
  enum { USUAL = 2, FEW = 4 };
  struct eo_objective *objective = &design->objective;
  if (objective->robust == EO_ROBUST_OFF || objective->scatter_pairs == 0 || objective->first_pairs > 0)
    return;
  bool all = objective->scatter_pairs <= FEW || design->optimization.search.algorithm == EO_NSGA2;
  objective->first_pairs = all ? objective->scatter_pairs : USUAL;
}

static void resolve_optimization(struct eo_optimization *optimization, const struct eo_gear_pair *pair,
                                 const struct eo_geometry *geometry)
{
  optimization->search.variables = count_variables(optimization, pair->ends);
  optimization->search.share_radius = eo_optimizer_share_radius(&optimization->search);
  resolve_amount(&optimization->tip_relief, 0.02 * pair->normal_module);
  resolve_amount(&optimization->root_relief, 0.02 * pair->normal_module);
  resolve_amount(&optimization->lead_crowning, 40e-6);
  resolve_start_range(&optimization->tip_relief_start, geometry->rack_top, pair->normal_module);
  resolve_start_range(&optimization->root_relief_start, -geometry->rack_bottom, pair->normal_module);
}

/* An angle stated as a deviation over the face width. */
static void resolve_angle(double *angle, double deviation, double face_width)
{
  if (!isnan(deviation))
    *angle = atan(deviation / face_width);
}

static void resolve_alignment(struct eo_design *design, double face_width)
{
  struct eo_alignment *alignment = &design->alignment;
  resolve_angle(&alignment->shaft_angle_in_plane, alignment->deviation_in_plane, face_width);
  resolve_angle(&alignment->shaft_angle_out_of_plane, alignment->deviation_out_of_plane, face_width);
  for (int k = 0; k < design->load_cases; k++) {
    struct eo_case_alignment *own = &design->load_case[k].alignment;
    design->load_case[k].flank = flank_of(design, k);
    if (design->load_case[k].has_alignment) {
      resolve_angle(&own->in_plane, own->deviation_in_plane, face_width);
      resolve_angle(&own->out_of_plane, own->deviation_out_of_plane, face_width);
    }
  }
}

static void resolve_material(struct eo_material *material)
{
  struct eo_material gear = eo_material_of(material, EO_GEAR);
  material->gear_youngs_modulus = gear.youngs_modulus;
  material->gear_poissons_ratio = gear.poissons_ratio;
  material->gear_density = gear.density;
}

void eo_design_resolve(struct eo_design *design, const struct eo_geometry *geometry)
{
  resolve_alignment(design, geometry->face_width);
  if (!*design->gear_pair.hand && geometry->helix_angle > 0)
    set_hand(&design->gear_pair, eo_alignment_outwards(&design->alignment)); /* theory (F9) */
  resolve_gear_pair(&design->gear_pair, geometry);
  resolve_material(&design->material);
  for (int i = 0; i < 2; i++) {
    resolve_inertia(&design->supports, &design->gear_pair, eo_material_of(&design->material, i).density, i,
                    geometry->reference_radius[i]);
    if (design->gear_pair.ends == 2 && design->gear_pair.groove_width > 0)
      resolve_groove(&design->supports, &design->gear_pair, &design->material, i);
  }
  resolve_bearings(&design->supports, &design->gear_pair);
  fill(&design->alignment.pinion_axial_stiffness, design->supports.gear_axial_stiffness[EO_LEFT]);
  resolve_shafts(&design->shafts, &design->gear_pair);
  resolve_resolution(&design->resolution, &design->gear_pair, geometry);
  if (design->pitch.stated && design->pitch.positions == 0)
    design->pitch.positions = eo_pitch_usual_positions(design->resolution.positions);
  resolve_scenarios(&design->objective, &design->alignment);
  resolve_first_pairs(design);
  design->optimization.search.objectives = count_axes(design);
  resolve_optimization(&design->optimization, &design->gear_pair, geometry);
  eo_design_resolve_grids(design);
}
