/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kind "gear-public": designs as drawings and reports state them, each in a file beside this one (or in the case
   itself, with changes to it), completed by the rules that every command uses; what a source prints beside what comes
   out. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/iso6336.h"
#include "document/design_document.h"
#include "evaluation/analysis.h"
#include "format/json.h"
#include "numerics/periodic.h"
#include "rating/pair_dimensions.h"
#include "reference/verify.h"

enum { FILE_BYTES = 1 << 20 };
static const double DEGREE = M_PI / 180;

struct gear_case {
  struct eo_verification *v;
  struct eo_case *expected;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_pair_dimensions dimensions;
};

/* Printed numbers: three units of the last digit, since what they were computed from was printed too. */
static double printed(struct eo_case *value)
{
  static const double UNITS = 6; /* halves */
  double largest = 0;
  for (int i = 0; i < eo_case_size(value); i++) {
    const json_t *number = eo_case_json(eo_case_peek(value, i));
    largest = fmax(largest, json_is_number(number) ? eo_verify_rounding(json_number_value(number)) : 0);
  }
  const json_t *own = eo_case_json(value);
  return UNITS * (json_is_number(own) ? eo_verify_rounding(json_number_value(own)) : largest);
}

static void one(struct gear_case *gear_case, const char *key, double value)
{
  struct eo_case *expected = eo_case_find(gear_case->expected, key);
  eo_verify_number(gear_case->v, expected, value, 0, expected ? printed(expected) : 0);
}

/* What of a case's numbers its design has: a name that says "(given here: the pinion's)" leaves the gear's out. */
static bool gives_pinion_alone(const struct gear_case *gear_case)
{
  return strstr(gear_case->design.name, "given here: the pinion's") != NULL;
}

/* [pinion, gear] */
static void two(struct gear_case *gear_case, const char *key, const double *value, double unit)
{
  struct eo_case *expected = eo_case_find(gear_case->expected, key);
  if (expected && gives_pinion_alone(gear_case)) {
    eo_verify_number(gear_case->v, eo_case_at(expected, EO_PINION), value[EO_PINION] * unit, 0, printed(expected));
    eo_verify_uncompared(gear_case->v, eo_case_at(expected, EO_GEAR), "the design gives the pinion's side alone");
  } else if (expected)
    eo_verify_list(gear_case->v, expected, 2, value, unit, 0, printed(expected));
}

static void two_of(struct gear_case *gear_case, const char *key, double pinion, double gear)
{
  const double value[2] = {pinion, gear};
  two(gear_case, key, value, 1);
}

static double roll_angle(const struct eo_geometry *geometry, int i, double radius)
{
  return sqrt(radius * radius - geometry->base_radius[i] * geometry->base_radius[i]) / geometry->base_radius[i] /
         DEGREE;
}

static void check_circles(struct gear_case *gear_case)
{
  const struct eo_geometry *geometry = &gear_case->geometry;
  two(gear_case, "base_diameter_mm", geometry->base_radius, 2e3);
  two(gear_case, "tip_diameter_mm", geometry->tip_radius, 2e3);
  two(gear_case, "tip_radius_mm", geometry->tip_radius, 1e3);
  two(gear_case, "root_diameter_mm", geometry->root_radius, 2e3);
  two(gear_case, "form_diameter_mm", geometry->form_radius, 2e3);
  two(gear_case, "active_start_diameter_mm", geometry->start_radius, 2e3);
  two_of(gear_case, "roll_angle_active_start_deg", roll_angle(geometry, 0, geometry->start_radius[0]),
         roll_angle(geometry, 1, geometry->start_radius[1]));
  two_of(gear_case, "roll_angle_tip_deg", roll_angle(geometry, 0, geometry->tip_radius[0]),
         roll_angle(geometry, 1, geometry->tip_radius[1]));
}

/* The members' own, where the design states them. */
static void check_widths(struct gear_case *gear_case)
{
  struct eo_case *expected = eo_case_find(gear_case->expected, "face_widths_mm");
  const struct eo_geometry *geometry = &gear_case->geometry;
  if (expected && geometry->member_width[0] == geometry->face_width &&
      geometry->member_width[1] == geometry->face_width)
    eo_verify_uncompared(gear_case->v, expected, "the design has the common width alone");
  else
    two(gear_case, "face_widths_mm", geometry->member_width, 1e3);
}

static void check_pair(struct gear_case *gear_case)
{
  const struct eo_geometry *geometry = &gear_case->geometry;
  double reference = geometry->reference_radius[0] + geometry->reference_radius[1];
  double sum = geometry->profile_shift[0] + geometry->profile_shift[1];
  one(gear_case, "centre_distance_mm", 1e3 * geometry->centre_distance);
  one(gear_case, "working_pressure_angle_deg", geometry->working_pressure_angle / DEGREE);
  one(gear_case, "transverse_contact_ratio", geometry->transverse_contact_ratio);
  one(gear_case, "overlap_ratio", geometry->overlap_ratio);
  one(gear_case, "tip_clearance_mm", 1e3 * geometry->tip_clearance[EO_GEAR]);
  one(gear_case, "tip_alteration_mm", 1e3 * (geometry->centre_distance - reference - sum * geometry->normal_module));
  two(gear_case, "profile_shift", geometry->profile_shift, 1);
  check_widths(gear_case);
  one(gear_case, "normal_module_mm", 1e3 * geometry->normal_module);
  one(gear_case, "normal_pressure_angle_deg", geometry->normal_pressure_angle / DEGREE);
  if (gear_case->design.load_cases > 0)
    one(gear_case, "torque_Nm", gear_case->design.load_case[0].torque);
}

static void check_path(struct gear_case *gear_case)
{
  const struct eo_geometry *geometry = &gear_case->geometry;
  struct eo_case *path = eo_case_find(gear_case->expected, "path_mm"), *outer = gear_case->expected;
  if (!path)
    return;
  gear_case->expected = path;
  one(gear_case, "AC", -1e3 * geometry->path_start);
  one(gear_case, "AE", 1e3 * (geometry->path_end - geometry->path_start));
  one(gear_case, "T1T2", 1e3 * (geometry->tangent_length[0] + geometry->tangent_length[1]));
  gear_case->expected = outer;
}

/* Both limits of a thing that has allowances, [[lower, upper] of the pinion, of the gear]. */
static void limits(struct gear_case *gear_case, const char *key, const double *pinion, const double *gear, int first)
{
  struct eo_case *expected = eo_case_find(gear_case->expected, key);
  const double *const value[2] = {pinion, gear};
  for (int i = 0; expected && i < 2; i++) {
    struct eo_case *row = eo_case_at(expected, i);
    const double pair[2] = {value[i][first], value[i][EO_UPPER + EO_LOWER - first]};
    eo_verify_list(gear_case->v, row, 2, pair, 1e3, 0, printed(row));
  }
}

static void check_dimensions(struct gear_case *gear_case)
{
  const struct eo_member_dimensions *dimensions = &gear_case->dimensions.member[EO_PINION],
                                    *member_dimensions = &gear_case->dimensions.member[EO_GEAR];
  two_of(gear_case, "teeth_spanned", dimensions->teeth_spanned, member_dimensions->teeth_spanned);
  two_of(gear_case, "base_tangent_length_mm", 1e3 * dimensions->span[EO_NOMINAL],
         1e3 * member_dimensions->span[EO_NOMINAL]);
  limits(gear_case, "base_tangent_length_with_allowance_mm", dimensions->span, member_dimensions->span, EO_LOWER);
  two_of(gear_case, "ball_diameter_mm", 1e3 * dimensions->ball, 1e3 * member_dimensions->ball);
  two_of(gear_case, "over_two_balls_mm", 1e3 * dimensions->over_two_balls[EO_NOMINAL],
         1e3 * member_dimensions->over_two_balls[EO_NOMINAL]);
  two_of(gear_case, "normal_tooth_thickness_mm", 1e3 * dimensions->normal_thickness[EO_NOMINAL],
         1e3 * member_dimensions->normal_thickness[EO_NOMINAL]);
  limits(gear_case, "thickness_allowance_mm", dimensions->allowance, member_dimensions->allowance, EO_UPPER);
  /* the program of this source prints j_wt cos alpha_n cos beta as normal backlash */
  two_of(gear_case, "normal_backlash_mm", 1e3 * gear_case->dimensions.smallest.of_reference,
         1e3 * gear_case->dimensions.largest.of_reference);
  one(gear_case, "centre_distance_allowance_mm", 1e3 * gear_case->dimensions.centre_distance_allowance);
}

/* ISO 6336-1 and -3 by the functions that the results use. */
static void check_standard(struct gear_case *gear_case)
{
  static const double WITHIN = 2e-3; /* "all within 0.2 %" of the comparison that the rows keep */
  const struct eo_gear_pair *pair = &gear_case->design.gear_pair;
  struct eo_iso_root root[2];
  struct eo_case *stress = eo_case_find(gear_case->expected, "root_stress_nominal_MPa");
  for (int i = 0; i < 2; i++)
    eo_iso_root(&root[i], &gear_case->geometry, i, pair->bore[i],
                gear_case->design.load_case[0].torque / pair->ends * pair->teeth[i] / pair->teeth[0]);
  const double nominal[2] = {root[0].stress / 1e6, root[1].stress / 1e6};
  if (stress)
    eo_verify_list(gear_case->v, stress, 2, nominal, 1, WITHIN, 0);
  two_of(gear_case, "form_factor", root[0].form_factor, root[1].form_factor);
  two_of(gear_case, "stress_correction", root[0].stress_correction, root[1].stress_correction);
}

static void check_stiffness(struct gear_case *gear_case)
{
  static const double WITHIN = 2e-3;
  const struct eo_geometry *geometry = &gear_case->geometry;
  if (!eo_case_find(gear_case->expected, "c_single"))
    return;
  struct eo_iso_stiffness iso;
  const struct eo_iso_stiffness_input input = {
      .teeth = {geometry->teeth[0], geometry->teeth[1]},
      .virtual_teeth = EO_ISO_VIRTUAL_EXACT,
      .normal_pressure_angle = geometry->normal_pressure_angle,
      .helix_angle = geometry->helix_angle,
      .profile_shift = {geometry->profile_shift[0], geometry->profile_shift[1]},
      .dedendum_coefficient = (geometry->dedendum[0] + geometry->dedendum[1]) / 2 / geometry->normal_module,
      .transverse_contact_ratio = geometry->transverse_contact_ratio,
      .blank_factor = eo_case_number(gear_case->expected, "blank_factor"),
      .theory_factor = 0.8,
      .youngs_modulus = gear_case->design.material.youngs_modulus};
  eo_iso_stiffness(&iso, &input);
  eo_verify_member(gear_case->v, gear_case->expected, "c_single", 1e-9 * iso.single, WITHIN, 0);
  eo_verify_member(gear_case->v, gear_case->expected, "c_gamma_alpha", 1e-9 * iso.mesh_alpha, WITHIN, 0);
  eo_verify_member(gear_case->v, gear_case->expected, "c_gamma_beta", 1e-9 * iso.mesh_beta, WITHIN, 0);
}

static enum eo_code compare_analysis(struct gear_case *gear_case, struct eo_analysis *analysis, struct eo_case *ripple,
                                     struct eo_case *stiffness, struct eo_error *error)
{
  EO_TRY(eo_analysis_run(analysis, &gear_case->design, 0, error));
  const struct eo_evaluation *evaluation = analysis->evaluation;
  eo_verify_number(gear_case->v, ripple, 1e6 * evaluation->objective[0].peak_to_peak,
                   eo_case_relative_or(gear_case->expected, "peak_to_peak_tolerance", 0.05), 0);
  eo_verify_number(gear_case->v, stiffness,
                   1e-6 * eo_periodic_mean(evaluation->positions, evaluation->load_case[0].end[EO_LEFT].stiffness),
                   eo_case_relative_or(gear_case->expected, "tolerance", 0.05), 0);
  return EO_OK;
}

/* A whole analysis, where what it gives is expected. */
static enum eo_code check_analysis(struct gear_case *gear_case, struct eo_error *error)
{
  struct eo_case *ripple = eo_case_find(gear_case->expected, "peak_to_peak_um"),
                 *stiffness = eo_case_find(gear_case->expected, "mesh_stiffness_N_per_um");
  struct eo_pair *pair = NULL;
  struct eo_analysis *analysis = NULL;
  const struct eo_pair_options options = {0};
  if (!ripple && !stiffness)
    return EO_OK;
  EO_TRY(eo_pair_new(&pair, &gear_case->design, &options, NULL, error));
  enum eo_code code = eo_analysis_new(&analysis, pair, error);
  if (!code)
    code = compare_analysis(gear_case, analysis, ripple, stiffness, error);
  eo_analysis_free(analysis);
  eo_pair_free(pair);
  return code;
}

/* Changes of a design: objects are entered, all else replaces what is there. */
static void change(json_t *design, const json_t *changes)
{
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)changes, key, value)
  {
    json_t *own = json_object_get(design, key);
    if (json_is_object(own) && json_is_object(value))
      change(own, value);
    else
      json_object_set(design, key, value);
  }
}

/* The design of a case: an object in it or the name of a file, with its changes. NULL: a fault, or none is given. */
static json_t *design_of(struct gear_case *gear_case, struct eo_case *item)
{
  struct eo_case *given = eo_case_find(item, "design"), *changes = eo_case_find(item, "changes");
  struct eo_error error;
  json_t *design = NULL;
  if (eo_case_is_text(given)) {
    char *path = eo_verify_path(gear_case->v, eo_case_text(given));
    design = path ? eo_json_load(path, FILE_BYTES, &error) : NULL;
    if (!design)
      eo_case_fault(given, "%s", path ? error.text : "There is not enough memory.");
    free(path);
  } else if (given)
    design = json_deep_copy(eo_case_json(given));
  eo_case_skip(given);
  eo_case_skip(changes);
  if (design)
    change(design, eo_case_json(changes));
  return design;
}

static enum eo_code complete(struct gear_case *gear_case, const json_t *document, struct eo_error *error)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  if (!faults)
    return eo_error_memory(error);
  enum eo_code code = eo_design_decode(document, &gear_case->design, NULL, faults) ? EO_OK
                                                                                   : eo_faults_first(faults, error);
  free(faults);
  if (!code)
    code = eo_design_complete(&gear_case->design, &gear_case->geometry, error);
  if (!code)
    eo_pair_dimensions_init(&gear_case->dimensions, &gear_case->design.gear_pair, &gear_case->geometry);
  return code;
}

static enum eo_code check_numbers(struct gear_case *gear_case, struct eo_error *error)
{
  check_circles(gear_case);
  check_pair(gear_case);
  check_path(gear_case);
  check_dimensions(gear_case);
  check_stiffness(gear_case);
  check_standard(gear_case);
  return check_analysis(gear_case, error);
}

/* A design that is to be refused: `refused` is the key at which. */
static bool check_refusal(struct gear_case *gear_case, enum eo_code code, const struct eo_error *error)
{
  struct eo_case *refused = eo_case_find(gear_case->expected, "refused");
  if (!refused)
    return false;
  const char *key = eo_case_text(refused);
  eo_verify_fact(gear_case->v, refused, "refused at this key",
                 code == EO_ERROR_INPUT && strcmp(error->pointer, key) == 0);
  return true;
}

/* Numbers of a case that has no design, or one that is refused. */
static void pass_over(struct gear_case *gear_case, const char *why)
{
  for (int i = 0; i < eo_case_size(gear_case->expected); i++)
    if (!eo_case_is_text(eo_case_peek(gear_case->expected, i)))
      eo_verify_uncompared(gear_case->v, eo_case_at(gear_case->expected, i), why);
}

static enum eo_code check_case(void *context, struct eo_case *item, struct eo_error *error)
{
  struct gear_case *gear_case = context;
  static const char *const remarks[] = {"id", "kind", "now", NULL};
  for (int i = 0; remarks[i]; i++)
    eo_case_remark(item, remarks[i]);
  gear_case->expected = eo_case_need(item, "expected");
  eo_case_remark(gear_case->expected, "text");
  json_t *document = design_of(gear_case, item);
  if (!document || eo_case_faulty(item)) {
    pass_over(gear_case, "the case has no design");
    json_decref(document);
    return EO_OK;
  }
  struct eo_error found = {0};
  enum eo_code code = complete(gear_case, document, &found);
  json_decref(document);
  if (code && code != EO_ERROR_INPUT)
    return *error = found, code;
  if (check_refusal(gear_case, code, &found))
    return EO_OK;
  eo_verify_fact(gear_case->v, item, "completed, or refused at a key with a reason",
                 !code || (*found.pointer && *found.text));
  if (code)
    eo_verify_note(gear_case->v, "%s: refused: %s: %s", eo_case_word(item, "id"), found.pointer, found.text);
  if (!code)
    code = check_numbers(gear_case, error);
  else
    pass_over(gear_case, "the design is refused");
  return code == EO_ERROR_INPUT ? EO_OK : code;
}

enum eo_code eo_verify_gear(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  struct gear_case *gear_case = calloc(1, sizeof *gear_case);
  if (!gear_case)
    return eo_error_memory(error);
  gear_case->v = verification;
  struct eo_case *cases = eo_case_need(file, "cases");
  enum eo_code code = EO_OK;
  for (int i = 0; i < eo_case_size(cases) && !code; i++)
    code = check_case(gear_case, eo_case_at(cases, i), error);
  free(gear_case);
  return code;
}
