#include "reference/verify_contact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/case_pair.h"
#include "contact/hertz.h"
#include "contact/iso6336.h"
#include "contact/unloaded.h"

void eo_contact_case_modification(struct eo_contact_case *c, const char *name, struct eo_flank_modification *flank)
{
  const json_t *mods = json_object_get(json_object_get(c->file, "modification"), "mods");
  const json_t *block = name ? json_object_get(mods, name) : NULL;
  if (!block && name && strncmp(name, "unmod", 5) != 0)
    eo_verify_ignore(c->v, "modification \"%.40s\" is not in the file; taken as none", name);
  eo_case_modification(block, &c->design.gear_pair, flank);
}

static void check_relative(struct eo_verification *v, const char *label, const json_t *block, const char *key,
                           double value, double relative)
{
  double expected = eo_verify_number(block, key);
  if (!isnan(expected))
    eo_verify_add(v, label, key, value, expected, relative * fmax(fabs(expected), 1e-300));
}

static void check_macro(struct eo_contact_case *c)
{
  const json_t *macro = json_object_get(c->file, "macro"), *o = json_object_get(macro, "output"), *list;
  const struct eo_geometry *g = &c->geometry;
  double tolerance = eo_verify_number_or(macro, "tol_rel", 1e-9);
  const struct {
    const char *key;
    double value;
  } row[] = {{"mt", 1e3 * g->transverse_module},
             {"at", g->transverse_pressure_angle},
             {"bb", g->base_helix_angle},
             {"r1", 1e3 * g->reference_radius[0]},
             {"r2", 1e3 * g->reference_radius[1]},
             {"rb1", 1e3 * g->base_radius[0]},
             {"rb2", 1e3 * g->base_radius[1]},
             {"ra1", 1e3 * g->tip_radius[0]},
             {"ra2", 1e3 * g->tip_radius[1]},
             {"rf1", 1e3 * g->root_radius[0]},
             {"rf2", 1e3 * g->root_radius[1]},
             {"a", 1e3 * g->centre_distance},
             {"pbt", 1e3 * g->transverse_base_pitch},
             {"pbn", 1e3 * g->normal_base_pitch},
             {"sA", 1e3 * g->path_start},
             {"sE", 1e3 * g->path_end},
             {"eps_a", g->transverse_contact_ratio},
             {"eps_b", g->overlap_ratio},
             {"ku", g->rack_factor},
             {"u_bot", 1e3 * g->rack_bottom},
             {"u_tip", 1e3 * g->rack_top},
             {"T1C", 1e3 * g->tangent_length[0]},
             {"T2C", 1e3 * g->tangent_length[1]},
             {"awt", g->working_pressure_angle}};
  for (size_t i = 0; i < sizeof row / sizeof row[0]; i++)
    check_relative(c->v, "macro", o, row[i].key, row[i].value, tolerance);
  list = json_object_get(macro, "fillet_form_radius");
  for (size_t i = 0; i < json_array_size(list) && i < 2; i++)
    eo_verify_add(c->v, "macro", i ? "fillet_form_radius gear" : "fillet_form_radius pinion", 1e3 * g->form_radius[i],
                  eo_verify_at(list, i), tolerance * eo_verify_at(list, i));
  const char *key;
  json_t *value;
  json_object_foreach(json_object_get(macro, "rho_n"), key, value)
      eo_verify_add(c->v, "macro rho_n", key, 1e3 * eo_geometry_relative_radius(g, 1e-3 * atof(key)),
                    json_number_value(value), tolerance * json_number_value(value));
  json_object_foreach(json_object_get(macro, "h_depth"), key, value) for (int member = 0; member < 2; member++)
      eo_verify_add(c->v, "macro h_depth", key, 1e3 * eo_geometry_depth(g, member, 1e-3 * atof(key)),
                    eo_verify_at(value, (size_t)member), tolerance * eo_verify_at(value, (size_t)member));
}

static void check_modification(struct eo_contact_case *c)
{
  const json_t *block = json_object_get(c->file, "modification"), *points = json_object_get(block, "points");
  double tolerance = eo_verify_number_or(block, "tol_um", 1e-6);
  const char *name;
  json_t *expected;
  json_object_foreach(json_object_get(block, "delta_um"), name, expected)
  {
    struct eo_flank_modification flank;
    struct eo_modification_shape shape;
    char label[80], quantity[60];
    eo_contact_case_modification(c, name, &flank);
    eo_modification_init(&shape, &c->geometry, EO_PINION, &flank);
    snprintf(label, sizeof label, "modification %.40s", name);
    for (size_t i = 0; i < json_array_size(points); i++) {
      double s = 1e-3 * eo_verify_at(json_array_get(points, i), 0),
             eta = 1e-3 * eo_verify_at(json_array_get(points, i), 1), slope[2], lead;
      double value = eo_modification_profile(&shape, c->geometry.rack_factor * s, slope) +
                     eo_modification_lead(&shape, eta / cos(c->geometry.helix_angle), &lead);
      snprintf(quantity, sizeof quantity, "delta_um at s %g, eta %g", 1e3 * s, 1e3 * eta);
      eo_verify_add(c->v, label, quantity, 1e6 * value, eo_verify_at(expected, i), tolerance);
    }
  }
}

static void check_surface(struct eo_contact_case *c, const char *name, const json_t *block)
{
  struct eo_flank_modification flank;
  struct eo_modification_shape shape;
  size_t index;
  json_t *row;
  double tolerance = eo_verify_number_or(block, "tol_mm", 1e-8);
  char label[80], quantity[60];
  eo_contact_case_modification(c, name, &flank);
  eo_modification_init(&shape, &c->geometry, EO_PINION, &flank);
  snprintf(label, sizeof label, "exact surface %.40s", name);
  json_array_foreach(json_object_get(block, "points"), index, row)
  {
    struct eo_surface_point p;
    double u = eo_verify_number(row, "u"), v = eo_verify_number(row, "v");
    eo_surface_evaluate(&c->geometry, EO_PINION, &shape, 1e-3 * u, 1e-3 * v, &p);
    for (int k = 0; k < 3; k++) {
      snprintf(quantity, sizeof quantity, "x[%d] mm at u %g, v %g", k, u, v);
      eo_verify_add(c->v, label, quantity, 1e3 * p.position[k], eo_verify_element(row, "x", k), tolerance);
      snprintf(quantity, sizeof quantity, "n[%d] at u %g, v %g", k, u, v);
      eo_verify_add(c->v, label, quantity, p.normal[k], eo_verify_element(row, "n", k), tolerance);
    }
  }
}

static void check_slice_gap(struct eo_contact_case *c, const char *name, const json_t *block)
{
  struct eo_flank_modification flank;
  struct eo_modification_shape shape[2] = {{0}, {0}};
  struct eo_slice_gap *table = malloc(sizeof *table);
  const json_t *phase = json_object_get(block, "c"), *exact = json_object_get(block, "exact_um");
  double tolerance = eo_verify_number_or(block, "tol_um", 0.002);
  char label[80], quantity[60];
  eo_contact_case_modification(c, name, &flank);
  eo_modification_init(&shape[EO_PINION], &c->geometry, EO_PINION, &flank);
  snprintf(label, sizeof label, "slice gap %.40s", name);
  if (table)
    eo_slice_gap_init(table, &c->geometry, shape);
  for (size_t i = 0; table && i < json_array_size(phase); i++) {
    snprintf(quantity, sizeof quantity, "gap_um at c %g", eo_verify_at(phase, i));
    eo_verify_add(c->v, label, quantity, 1e6 * eo_slice_gap_at(table, 1e-3 * eo_verify_at(phase, i), NULL),
                  eo_verify_at(exact, i), tolerance);
  }
  free(table);
}

/* Transmission errors after the mean difference is taken out (the axial float does that). */
static void compare_errors(struct eo_contact_case *c, const char *label, const char *what, const json_t *expected,
                           const struct eo_unloaded *got, double tolerance)
{
  size_t n = json_array_size(expected);
  double shift = 0;
  for (size_t i = 0; i < n; i++)
    shift += (1e6 * got[i].transmission_error - eo_verify_at(expected, i)) / (double)n;
  for (size_t i = 0; i < n; i++) {
    char quantity[60];
    snprintf(quantity, sizeof quantity, "%s [%zu]", what, i);
    eo_verify_add(c->v, label, quantity, 1e6 * got[i].transmission_error - shift, eo_verify_at(expected, i), tolerance);
  }
}

static enum eo_code check_unloaded(struct eo_contact_case *c, const json_t *item, struct eo_error *error)
{
  enum { MOST = 512 };
  struct eo_flank_modification flank, none = {0};
  struct eo_alignment alignment;
  struct eo_corner_gap corner[2];
  struct eo_gap_field *field = malloc(sizeof *field);
  struct eo_unloaded exact[MOST], least[MOST];
  double phase[MOST], tolerance = eo_verify_number_or(item, "tol_um", 0.04);
  const json_t *list = json_object_get(item, "phase");
  const char *label = json_string_value(json_object_get(item, "name")),
             *end = json_string_value(json_object_get(item, "end"));
  int n = (int)json_array_size(list);
  label = label ? label : "unloaded contact";
  if (!field)
    return eo_error_memory(error);
  for (int i = 0; i < n && i < MOST; i++)
    phase[i] = 1e-3 * eo_verify_at(list, (size_t)i);
  eo_contact_case_modification(c, json_string_value(json_object_get(item, "mod")), &flank);
  eo_case_misalignment(json_object_get(item, "mis"), &alignment);
  int side = (end && strcmp(end, "left") == 0) || eo_verify_number_or(item, "end", 1) < 0 ? EO_LEFT : EO_RIGHT;
  double sign = side == EO_LEFT ? -1 : 1;
  eo_corner_gap_init(corner, &c->geometry);
  eo_gap_field_init(field, &c->geometry, &flank, &none, side, alignment.shaft_angle_in_plane,
                    alignment.shaft_angle_out_of_plane, 0, corner);
  struct eo_shaft_errors errors = {sign * alignment.shaft_angle_in_plane, sign * alignment.shaft_angle_out_of_plane, 0};
  enum eo_code code = n > MOST ? eo_error_set(error, EO_ERROR_INPUT, "/unloaded_tca", "More than %d phases.", MOST)
                               : eo_unloaded_exact(field, &errors, n, phase, exact, error);
  if (!code) {
    eo_unloaded_minimum(field, n, phase, least);
    compare_errors(c, label, "TE_exact_um", json_object_get(item, "TE_exact_um"), exact, tolerance);
    compare_errors(c, label, "TE_mingap_um", json_object_get(item, "TE_mingap_um"), least, tolerance);
    for (int i = 0; i < n; i++) {
      char quantity[60];
      double s = eo_verify_at(json_object_get(item, "s"), (size_t)i),
             eta = eo_verify_at(json_object_get(item, "eta"), (size_t)i);
      snprintf(quantity, sizeof quantity, "s mm [%d]", i);
      if (!isnan(s) && exact[i].touch == EO_TOUCH_POINT)
        eo_verify_add(c->v, label, quantity, 1e3 * exact[i].path, s, 0.05);
      snprintf(quantity, sizeof quantity, "eta mm [%d]", i);
      if (!isnan(eta) && exact[i].touch == EO_TOUCH_POINT)
        eo_verify_add(c->v, label, quantity, 1e3 * exact[i].eta, eta, 0.05);
    }
  }
  free(field);
  return code;
}

static void check_hertz(struct eo_contact_case *c, const json_t *block)
{
  const json_t *q = json_object_get(block, "q"), *s = json_object_get(block, "s"),
               *expected = json_object_get(block, "delta_um");
  double relative = eo_verify_number_or(block, "tol_rel", 1e-6);
  for (size_t i = 0; i < json_array_size(q); i++)
    for (size_t j = 0; j < json_array_size(s); j++) {
      struct eo_local_law law;
      double place = 1e-3 * eo_verify_at(s, j),
             depth[2] = {eo_geometry_depth(&c->geometry, 0, place), eo_geometry_depth(&c->geometry, 1, place)};
      double wanted = eo_verify_at(json_array_get(expected, i), j);
      char quantity[60];
      eo_local_law_init(&law, c->design.material.youngs_modulus, c->design.material.poissons_ratio,
                        eo_geometry_relative_radius(&c->geometry, place), depth);
      snprintf(quantity, sizeof quantity, "delta_um at q %g, s %g", eo_verify_at(q, i), eo_verify_at(s, j));
      eo_verify_add(c->v, "hertz", quantity, 1e6 * eo_local_law_approach(&law, 1e3 * eo_verify_at(q, i)), wanted,
                    relative * fabs(wanted));
    }
}

static void check_iso_stiffness(struct eo_contact_case *c, const json_t *block)
{
  const struct eo_geometry *g = &c->geometry;
  struct eo_iso_stiffness plain, corrected;
  struct eo_iso_stiffness_input input = {.teeth = {g->teeth[0], g->teeth[1]},
                                         .virtual_teeth = EO_ISO_VIRTUAL_CUBED,
                                         .normal_pressure_angle = g->normal_pressure_angle,
                                         .helix_angle = g->helix_angle,
                                         .profile_shift = {g->profile_shift[0], g->profile_shift[1]},
                                         .dedendum_coefficient = c->design.gear_pair.dedendum_coefficient,
                                         .transverse_contact_ratio = g->transverse_contact_ratio,
                                         .blank_factor = 1,
                                         .theory_factor = 1,
                                         .youngs_modulus = c->design.material.youngs_modulus};
  double relative = 1e-3;
  eo_iso_stiffness(&plain, &input);
  input.theory_factor = 0.8;
  eo_iso_stiffness(&corrected, &input);
  check_relative(c->v, "iso6336_1", block, "qprime", 1e9 * plain.flexibility, relative);
  check_relative(c->v, "iso6336_1", block, "cth", 1e-9 * plain.theoretical, relative);
  check_relative(c->v, "iso6336_1", block, "CB", plain.rack_factor, relative);
  check_relative(c->v, "iso6336_1", block, "c_noCM", 1e-9 * plain.single, relative);
  check_relative(c->v, "iso6336_1", block, "c", 1e-9 * corrected.single, relative);
  check_relative(c->v, "iso6336_1", block, "cgamma_noCM", 1e-9 * plain.mesh_alpha, relative);
  check_relative(c->v, "iso6336_1", block, "cgamma", 1e-9 * corrected.mesh_alpha, relative);
}

/* The block's name carries the torque: iso6336_3_pinion_828. */
static void check_iso_root(struct eo_contact_case *c, const char *name, const json_t *block)
{
  int member = strstr(name, "gear") ? EO_GEAR : EO_PINION;
  const char *last = strrchr(name, '_');
  double torque = last ? atof(last + 1) : 0, relative = 5e-3;
  struct eo_iso_root root;
  if (member == EO_GEAR)
    torque *= (double)c->geometry.teeth[1] / c->geometry.teeth[0];
  eo_iso_root(&root, &c->geometry, member, 0, torque / 2);
  check_relative(c->v, name, block, "zn", root.virtual_teeth, relative);
  check_relative(c->v, name, block, "YF", root.form_factor, relative);
  check_relative(c->v, name, block, "YS", root.stress_correction, relative);
  check_relative(c->v, name, block, "Yb", root.helix_factor, relative);
  check_relative(c->v, name, block, "sF", root.chord / c->geometry.normal_module, relative);
  check_relative(c->v, name, block, "hF", root.arm / c->geometry.normal_module, relative);
  check_relative(c->v, name, block, "rF", root.fillet_radius / c->geometry.normal_module, relative);
  check_relative(c->v, name, block, "sigmaF0", 1e-6 * root.stress, relative);
}

static enum eo_code check_blocks(struct eo_contact_case *c, struct eo_error *error)
{
  const char *key;
  json_t *block, *item;
  size_t index;
  enum eo_code code = EO_OK;
  check_macro(c);
  check_modification(c);
  json_object_foreach((json_t *)c->file, key, block)
  {
    if (strncmp(key, "exact_surface_", 14) == 0)
      check_surface(c, key + 14, block);
    else if (strncmp(key, "slice_gap_", 10) == 0)
      check_slice_gap(c, key + 10, block);
    else if (strcmp(key, "hertz") == 0)
      check_hertz(c, block);
    else if (strcmp(key, "iso6336_1") == 0)
      check_iso_stiffness(c, block);
    else if (strncmp(key, "iso6336_3_", 10) == 0)
      check_iso_root(c, key, block);
  }
  json_array_foreach(json_object_get(c->file, "unloaded_tca"), index, item) if (!code)
      code = check_unloaded(c, item, error);
  return code ? code : eo_verify_contact_loaded(c, error);
}

enum eo_code eo_verify_contact(const json_t *file, struct eo_verification *v, struct eo_error *error)
{
  struct eo_contact_case *c = calloc(1, sizeof *c);
  if (!c)
    return eo_error_memory(error);
  c->file = file;
  c->v = v;
  enum eo_code code = eo_case_design(json_object_get(json_object_get(file, "macro"), "input"), &c->design, error);
  if (!code)
    code = eo_geometry_init(&c->geometry, &c->design.gear_pair, error);
  if (!code)
    eo_design_resolve(&c->design, &c->geometry);
  if (!code)
    code = check_blocks(c, error);
  free(c);
  return code;
}
