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

static void one(struct gear_case *c, const char *key, double value)
{
  struct eo_case *expected = eo_case_find(c->expected, key);
  eo_verify_number(c->v, expected, value, 0, expected ? printed(expected) : 0);
}

/* What of a case's numbers its design has: a name that says "(given here: the pinion's)" leaves the gear's out. */
static bool gives_pinion_alone(const struct gear_case *c)
{
  return strstr(c->design.name, "given here: the pinion's") != NULL;
}

/* [pinion, gear] */
static void two(struct gear_case *c, const char *key, const double *value, double unit)
{
  struct eo_case *expected = eo_case_find(c->expected, key);
  if (expected && gives_pinion_alone(c)) {
    eo_verify_number(c->v, eo_case_at(expected, EO_PINION), value[EO_PINION] * unit, 0, printed(expected));
    eo_verify_uncompared(c->v, eo_case_at(expected, EO_GEAR), "the design gives the pinion's side alone");
  } else if (expected)
    eo_verify_list(c->v, expected, 2, value, unit, 0, printed(expected));
}

static void two_of(struct gear_case *c, const char *key, double pinion, double gear)
{
  const double value[2] = {pinion, gear};
  two(c, key, value, 1);
}

static double roll_angle(const struct eo_geometry *g, int i, double radius)
{
  return sqrt(radius * radius - g->base_radius[i] * g->base_radius[i]) / g->base_radius[i] / DEGREE;
}

static void check_circles(struct gear_case *c)
{
  const struct eo_geometry *g = &c->geometry;
  two(c, "base_diameter_mm", g->base_radius, 2e3);
  two(c, "tip_diameter_mm", g->tip_radius, 2e3);
  two(c, "tip_radius_mm", g->tip_radius, 1e3);
  two(c, "root_diameter_mm", g->root_radius, 2e3);
  two(c, "form_diameter_mm", g->form_radius, 2e3);
  two(c, "active_start_diameter_mm", g->start_radius, 2e3);
  two_of(c, "roll_angle_active_start_deg", roll_angle(g, 0, g->start_radius[0]), roll_angle(g, 1, g->start_radius[1]));
  two_of(c, "roll_angle_tip_deg", roll_angle(g, 0, g->tip_radius[0]), roll_angle(g, 1, g->tip_radius[1]));
}

/* The members' own, where the design states them. */
static void check_widths(struct gear_case *c)
{
  struct eo_case *expected = eo_case_find(c->expected, "face_widths_mm");
  const struct eo_geometry *g = &c->geometry;
  if (expected && g->member_width[0] == g->face_width && g->member_width[1] == g->face_width)
    eo_verify_uncompared(c->v, expected, "the design has the common width alone");
  else
    two(c, "face_widths_mm", g->member_width, 1e3);
}

static void check_pair(struct gear_case *c)
{
  const struct eo_geometry *g = &c->geometry;
  double reference = g->reference_radius[0] + g->reference_radius[1];
  double sum = g->profile_shift[0] + g->profile_shift[1];
  one(c, "centre_distance_mm", 1e3 * g->centre_distance);
  one(c, "working_pressure_angle_deg", g->working_pressure_angle / DEGREE);
  one(c, "transverse_contact_ratio", g->transverse_contact_ratio);
  one(c, "overlap_ratio", g->overlap_ratio);
  one(c, "tip_clearance_mm", 1e3 * g->tip_clearance[EO_GEAR]);
  one(c, "tip_alteration_mm", 1e3 * (g->centre_distance - reference - sum * g->normal_module));
  two(c, "profile_shift", g->profile_shift, 1);
  check_widths(c);
  one(c, "normal_module_mm", 1e3 * g->normal_module);
  one(c, "normal_pressure_angle_deg", g->normal_pressure_angle / DEGREE);
  if (c->design.load_cases > 0)
    one(c, "torque_Nm", c->design.load_case[0].torque);
}

static void check_path(struct gear_case *c)
{
  const struct eo_geometry *g = &c->geometry;
  struct eo_case *path = eo_case_find(c->expected, "path_mm"), *outer = c->expected;
  if (!path)
    return;
  c->expected = path;
  one(c, "AC", -1e3 * g->path_start);
  one(c, "AE", 1e3 * (g->path_end - g->path_start));
  one(c, "T1T2", 1e3 * (g->tangent_length[0] + g->tangent_length[1]));
  c->expected = outer;
}

/* Both limits of a thing that has allowances, [[lower, upper] of the pinion, of the gear]. */
static void limits(struct gear_case *c, const char *key, const double *pinion, const double *gear, int first)
{
  struct eo_case *expected = eo_case_find(c->expected, key);
  const double *const value[2] = {pinion, gear};
  for (int i = 0; expected && i < 2; i++) {
    struct eo_case *row = eo_case_at(expected, i);
    const double pair[2] = {value[i][first], value[i][EO_UPPER + EO_LOWER - first]};
    eo_verify_list(c->v, row, 2, pair, 1e3, 0, printed(row));
  }
}

static void check_dimensions(struct gear_case *c)
{
  const struct eo_member_dimensions *p = &c->dimensions.member[EO_PINION], *g = &c->dimensions.member[EO_GEAR];
  two_of(c, "teeth_spanned", p->teeth_spanned, g->teeth_spanned);
  two_of(c, "base_tangent_length_mm", 1e3 * p->span[EO_NOMINAL], 1e3 * g->span[EO_NOMINAL]);
  limits(c, "base_tangent_length_with_allowance_mm", p->span, g->span, EO_LOWER);
  two_of(c, "ball_diameter_mm", 1e3 * p->ball, 1e3 * g->ball);
  two_of(c, "over_two_balls_mm", 1e3 * p->over_two_balls[EO_NOMINAL], 1e3 * g->over_two_balls[EO_NOMINAL]);
  two_of(c, "normal_tooth_thickness_mm", 1e3 * p->normal_thickness[EO_NOMINAL], 1e3 * g->normal_thickness[EO_NOMINAL]);
  limits(c, "thickness_allowance_mm", p->allowance, g->allowance, EO_UPPER);
  /* the program of this source prints j_wt cos alpha_n cos beta as normal backlash */
  two_of(c, "normal_backlash_mm", 1e3 * c->dimensions.smallest.of_reference, 1e3 * c->dimensions.largest.of_reference);
  one(c, "centre_distance_allowance_mm", 1e3 * c->dimensions.centre_distance_allowance);
}

/* ISO 6336-1 and -3 by the functions that the results use. */
static void check_standard(struct gear_case *c)
{
  static const double WITHIN = 2e-3; /* "all within 0.2 %" of the comparison that the rows keep */
  const struct eo_gear_pair *pair = &c->design.gear_pair;
  struct eo_iso_root root[2];
  struct eo_case *stress = eo_case_find(c->expected, "root_stress_nominal_MPa");
  for (int i = 0; i < 2; i++)
    eo_iso_root(&root[i], &c->geometry, i, pair->bore[i],
                c->design.load_case[0].torque / pair->ends * pair->teeth[i] / pair->teeth[0]);
  const double nominal[2] = {root[0].stress / 1e6, root[1].stress / 1e6};
  if (stress)
    eo_verify_list(c->v, stress, 2, nominal, 1, WITHIN, 0);
  two_of(c, "form_factor", root[0].form_factor, root[1].form_factor);
  two_of(c, "stress_correction", root[0].stress_correction, root[1].stress_correction);
}

static void check_stiffness(struct gear_case *c)
{
  static const double WITHIN = 2e-3;
  const struct eo_geometry *g = &c->geometry;
  if (!eo_case_find(c->expected, "c_single"))
    return;
  struct eo_iso_stiffness iso;
  const struct eo_iso_stiffness_input input = {.teeth = {g->teeth[0], g->teeth[1]},
                                               .virtual_teeth = EO_ISO_VIRTUAL_EXACT,
                                               .normal_pressure_angle = g->normal_pressure_angle,
                                               .helix_angle = g->helix_angle,
                                               .profile_shift = {g->profile_shift[0], g->profile_shift[1]},
                                               .dedendum_coefficient = (g->dedendum[0] + g->dedendum[1]) / 2 /
                                                                       g->normal_module,
                                               .transverse_contact_ratio = g->transverse_contact_ratio,
                                               .blank_factor = eo_case_number(c->expected, "blank_factor"),
                                               .theory_factor = 0.8,
                                               .youngs_modulus = c->design.material.youngs_modulus};
  eo_iso_stiffness(&iso, &input);
  eo_verify_member(c->v, c->expected, "c_single", 1e-9 * iso.single, WITHIN, 0);
  eo_verify_member(c->v, c->expected, "c_gamma_alpha", 1e-9 * iso.mesh_alpha, WITHIN, 0);
  eo_verify_member(c->v, c->expected, "c_gamma_beta", 1e-9 * iso.mesh_beta, WITHIN, 0);
}

static double mean(const double *value, int count)
{
  double sum = 0;
  for (int i = 0; i < count; i++)
    sum += value[i];
  return sum / count;
}

/* A whole analysis, where what it gives is expected. */
static enum eo_code check_analysis(struct gear_case *c, struct eo_error *error)
{
  struct eo_case *ripple = eo_case_find(c->expected, "peak_to_peak_um"),
                 *stiffness = eo_case_find(c->expected, "mesh_stiffness_N_per_um");
  struct eo_pair *pair = NULL;
  struct eo_analysis *analysis = NULL;
  const struct eo_pair_options options = {0};
  if (!ripple && !stiffness)
    return EO_OK;
  enum eo_code code = eo_pair_new(&pair, &c->design, &options, NULL, error);
  if (!code)
    code = eo_analysis_new(&analysis, pair, error);
  if (!code)
    code = eo_analysis_run(analysis, &c->design, 0, error);
  if (!code) {
    const struct eo_evaluation *e = analysis->evaluation;
    eo_verify_number(c->v, ripple, 1e6 * e->objective[0].peak_to_peak,
                     eo_case_relative_or(c->expected, "peak_to_peak_tolerance", 0.05), 0);
    eo_verify_number(c->v, stiffness, 1e-6 * mean(e->load_case[0].end[EO_LEFT].stiffness, e->positions),
                     eo_case_relative_or(c->expected, "tolerance", 0.05), 0);
  }
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
static json_t *design_of(struct gear_case *c, struct eo_case *item)
{
  struct eo_case *given = eo_case_find(item, "design"), *changes = eo_case_find(item, "changes");
  struct eo_error error;
  json_t *design = NULL;
  if (eo_case_is_text(given)) {
    char *path = eo_verify_path(c->v, eo_case_text(given));
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

static enum eo_code complete(struct gear_case *c, const json_t *document, struct eo_error *error)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  if (!faults)
    return eo_error_memory(error);
  enum eo_code code = eo_design_decode(document, &c->design, NULL, faults) ? EO_OK : eo_faults_first(faults, error);
  free(faults);
  if (!code)
    code = eo_design_complete(&c->design, &c->geometry, error);
  if (!code)
    eo_pair_dimensions_init(&c->dimensions, &c->design.gear_pair, &c->geometry);
  return code;
}

static enum eo_code check_numbers(struct gear_case *c, struct eo_error *error)
{
  check_circles(c);
  check_pair(c);
  check_path(c);
  check_dimensions(c);
  check_stiffness(c);
  check_standard(c);
  return check_analysis(c, error);
}

/* A design that is to be refused: `refused` is the key at which. */
static bool check_refusal(struct gear_case *c, enum eo_code code, const struct eo_error *error)
{
  struct eo_case *refused = eo_case_find(c->expected, "refused");
  if (!refused)
    return false;
  const char *key = eo_case_text(refused);
  eo_verify_fact(c->v, refused, "refused at this key", code == EO_ERROR_INPUT && strcmp(error->pointer, key) == 0);
  return true;
}

/* Numbers of a case that has no design, or one that is refused. */
static void pass_over(struct gear_case *c, const char *why)
{
  for (int i = 0; i < eo_case_size(c->expected); i++)
    if (!eo_case_is_text(eo_case_peek(c->expected, i)))
      eo_verify_uncompared(c->v, eo_case_at(c->expected, i), why);
}

static enum eo_code check_case(void *context, struct eo_case *item, struct eo_error *error)
{
  struct gear_case *c = context;
  static const char *const remarks[] = {"id", "kind", "now", NULL};
  for (int i = 0; remarks[i]; i++)
    eo_case_remark(item, remarks[i]);
  c->expected = eo_case_need(item, "expected");
  eo_case_remark(c->expected, "text");
  json_t *document = design_of(c, item);
  if (!document || eo_case_faulty(item)) {
    pass_over(c, "the case has no design");
    json_decref(document);
    return EO_OK;
  }
  struct eo_error found = {0};
  enum eo_code code = complete(c, document, &found);
  json_decref(document);
  if (code && code != EO_ERROR_INPUT)
    return *error = found, code;
  if (check_refusal(c, code, &found))
    return EO_OK;
  eo_verify_fact(c->v, item, "completed, or refused at a key with a reason", !code || (*found.pointer && *found.text));
  if (code)
    eo_verify_note(c->v, "%s: refused: %s: %s", eo_case_word(item, "id"), found.pointer, found.text);
  if (!code)
    code = check_numbers(c, error);
  else
    pass_over(c, "the design is refused");
  return code == EO_ERROR_INPUT ? EO_OK : code;
}

enum eo_code eo_verify_gear(struct eo_case *file, struct eo_verification *v, struct eo_error *error)
{
  struct gear_case *c = calloc(1, sizeof *c);
  if (!c)
    return eo_error_memory(error);
  c->v = v;
  struct eo_case *cases = eo_case_need(file, "cases");
  enum eo_code code = EO_OK;
  for (int i = 0; i < eo_case_size(cases) && !code; i++)
    code = check_case(c, eo_case_at(cases, i), error);
  free(c);
  return code;
}
