/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_contact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/hertz.h"
#include "contact/iso6336.h"
#include "contact/unloaded.h"
#include "gear/names.h"
#include "reference/contact_case.h"

static enum eo_code check_macro(void *context, struct eo_case *macro, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  const struct eo_geometry *geometry = &contact_case->geometry;
  double relative = eo_case_relative_or(macro, "tol_rel", 1e-9);
  (void)error;
  eo_case_check_geometry(contact_case->v, eo_case_find(macro, "output"), geometry, 1e3, relative);
  struct eo_case *form = eo_case_find(macro, "fillet_form_radius"), *radius = eo_case_find(macro, "rho_n"),
                 *depth = eo_case_find(macro, "h_depth");
  if (form)
    eo_verify_list(contact_case->v, form, 2, geometry->form_radius, 1e3, relative, 0);
  for (int i = 0; i < eo_case_size(radius); i++) {
    struct eo_case *expected = eo_case_at(radius, i);
    double s = 1e-3 * eo_case_key_number(expected);
    eo_verify_number(contact_case->v, expected, 1e3 * eo_geometry_relative_radius(geometry, s), relative, 0);
  }
  for (int i = 0; i < eo_case_size(depth); i++) {
    double s = 1e-3 * eo_case_key_number(eo_case_at(depth, i));
    const double value[2] = {eo_geometry_depth(geometry, 0, s), eo_geometry_depth(geometry, 1, s)};
    eo_verify_list(contact_case->v, eo_case_at(depth, i), 2, value, 1e3, relative, 0);
  }
  return EO_OK;
}

static void name_shape(struct eo_contact_case *contact_case, const char *name, struct eo_case *where,
                       struct eo_modification_shape *shape)
{
  struct eo_flank_modification flank;
  eo_contact_case_modification(contact_case, name, where, &flank);
  eo_modification_init(shape, &contact_case->geometry, EO_PINION, &flank);
}

static double modification_at(const struct eo_contact_case *contact_case, const struct eo_modification_shape *shape,
                              struct eo_case *point)
{
  double place[2], slope[2], lead;
  if (eo_case_numbers(point, 2, 2, place) < 0)
    return NAN;
  return eo_modification_profile(shape, contact_case->geometry.rack_factor * 1e-3 * place[0], slope) +
         eo_modification_lead(shape, 1e-3 * place[1] / cos(contact_case->geometry.helix_angle), &lead);
}

static enum eo_code check_modification(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  struct eo_case *all = eo_case_find(block, "delta_um"), *points = all ? eo_case_need(block, "points") : NULL;
  double tolerance = eo_case_absolute_or(block, "tol_um", 1e-6);
  (void)error;
  for (int k = 0; k < eo_case_size(all); k++) {
    struct eo_case *expected = eo_case_at(all, k);
    struct eo_modification_shape shape;
    name_shape(contact_case, eo_case_key(expected), expected, &shape);
    eo_verify_size(contact_case->v, expected, eo_case_size(points));
    for (int i = 0; i < eo_case_size(points); i++)
      eo_verify_number(contact_case->v, eo_case_at(expected, i),
                       1e6 * modification_at(contact_case, &shape, eo_case_at(points, i)), 0, tolerance);
  }
  return EO_OK;
}

static enum eo_code check_surface(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  struct eo_modification_shape shape;
  struct eo_case *points = eo_case_need(block, "points");
  double tolerance = eo_case_absolute_or(block, "tol_mm", 1e-8);
  (void)error;
  name_shape(contact_case, eo_case_key(block) + strlen("exact_surface_"), block, &shape);
  for (int i = 0; i < eo_case_size(points) && !eo_case_faulty(block); i++) {
    struct eo_case *row = eo_case_at(points, i);
    struct eo_surface_point surface_point;
    eo_surface_evaluate(&contact_case->geometry, EO_PINION, &shape, 1e-3 * eo_case_number(row, "u"),
                        1e-3 * eo_case_number(row, "v"), &surface_point);
    eo_verify_list(contact_case->v, eo_case_need(row, "x"), 3, surface_point.position, 1e3, 0, tolerance);
    eo_verify_list(contact_case->v, eo_case_need(row, "n"), 3, surface_point.normal, 1, 0, tolerance);
  }
  return EO_OK;
}

static enum eo_code check_slice_gap(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  struct eo_modification_shape shape[2] = {0};
  struct eo_slice_gap *table = malloc(sizeof *table);
  struct eo_case *phase = eo_case_need(block, "c"), *exact = eo_case_need(block, "exact_um"),
                 *first = eo_case_find(block, "first_order_um");
  double tolerance = eo_case_absolute_or(block, "tol_um", 0.002), slope[2];
  if (!table)
    return eo_error_memory(error);
  name_shape(contact_case, eo_case_key(block) + strlen("slice_gap_"), block, &shape[EO_PINION]);
  eo_slice_gap_init(table, &contact_case->geometry, shape);
  eo_verify_size(contact_case->v, exact, eo_case_size(phase));
  if (first)
    eo_verify_size(contact_case->v, first, eo_case_size(phase));
  for (int i = 0; i < eo_case_size(phase) && !eo_case_faulty(block); i++) {
    double s = 1e-3 * eo_case_element(phase, i);
    eo_verify_number(contact_case->v, eo_case_at(exact, i), 1e6 * eo_slice_gap_at(table, s, NULL), 0, tolerance);
    eo_verify_number(contact_case->v, eo_case_at(first, i),
                     1e6 * eo_modification_profile(&shape[EO_PINION], contact_case->geometry.rack_factor * s, slope), 0,
                     tolerance);
  }
  free(table);
  return EO_OK;
}

enum { MOST_PHASES = 512 };

/* Transmission errors after the mean difference is taken out (the axial float does that), so one alone says nothing. */
static void compare_errors(struct eo_contact_case *contact_case, struct eo_case *expected, int n,
                           const struct eo_unloaded *got, double tolerance)
{
  double shift = 0, wanted[MOST_PHASES];
  if (!expected || eo_case_numbers(expected, n, MOST_PHASES, wanted) < 0)
    return;
  if (n < 2)
    eo_case_fault(expected, "At least 2 values are needed: their mean difference is taken out.");
  for (int i = 0; i < n; i++)
    shift += (1e6 * got[i].transmission_error - wanted[i]) / n;
  for (int i = 0; i < n; i++)
    eo_verify_number(contact_case->v, eo_case_at(expected, i), 1e6 * got[i].transmission_error - shift, 0, tolerance);
}

/* Where the teeth touch, within 0.05 mm; at an edge the place slides with the least change of the gap, and only the
   transmission error is compared. */
static void compare_places(struct eo_contact_case *contact_case, struct eo_case *item, int n,
                           const struct eo_unloaded *got)
{
  static const char *const keys[] = {"s", "eta"};
  const double tolerance = 0.05;
  for (int k = 0; k < 2; k++) {
    struct eo_case *expected = eo_case_find(item, keys[k]);
    if (expected)
      eo_verify_size(contact_case->v, expected, n);
    for (int i = 0; i < n && expected; i++)
      if (got[i].touch == EO_TOUCH_POINT)
        eo_verify_number(contact_case->v, eo_case_at(expected, i), 1e3 * (k ? got[i].eta : got[i].path), 0, tolerance);
      else
        eo_verify_uncompared(contact_case->v, eo_case_at(expected, i), "an edge touches there.");
  }
}

/* +1, "right": the right end; -1, "left". */
static int side_of(struct eo_case *item)
{
  struct eo_case *end = eo_case_find(item, "end");
  if (eo_case_is_text(end))
    return eo_case_choice(item, "end", eo_end_name, 1) == 0 ? EO_LEFT : EO_RIGHT;
  double sign = end ? eo_case_real(end) : 1;
  if (!isnan(sign) && fabs(sign) != 1)
    eo_case_fault(end, "An end is 1 (right) or -1 (left).");
  return sign < 0 ? EO_LEFT : EO_RIGHT;
}

static enum eo_code check_unloaded(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  struct eo_flank_modification flank, none = {0};
  struct eo_alignment alignment;
  struct eo_corner_gap corner[2];
  struct eo_unloaded exact[MOST_PHASES], least[MOST_PHASES];
  double phase[MOST_PHASES], tolerance = eo_case_absolute_or(item, "tol_um", 0.04);
  int n = eo_case_numbers(eo_case_need(item, "phase"), -1, MOST_PHASES, phase), side = side_of(item);
  double sign = side == EO_LEFT ? -1 : 1;
  eo_contact_case_modification(contact_case, eo_case_word(item, "mod"), eo_case_find(item, "mod"), &flank);
  eo_case_misalignment(eo_case_need(item, "mis"), &alignment);
  if (eo_case_faulty(item))
    return EO_OK;
  struct eo_gap_field *field = malloc(sizeof *field);
  if (!field)
    return eo_error_memory(error);
  for (int i = 0; i < n; i++)
    phase[i] *= 1e-3;
  eo_corner_gap_init(corner, &contact_case->geometry);
  corner[0].rule = corner[1].rule = contact_case->tilt_rule;
  eo_gap_field_init(field, &contact_case->geometry, &flank, &none, side, alignment.shaft_angle_in_plane,
                    alignment.shaft_angle_out_of_plane, 0, corner);
  struct eo_shaft_errors errors = {sign * alignment.shaft_angle_in_plane, sign * alignment.shaft_angle_out_of_plane, 0};
  enum eo_code code = eo_unloaded_exact(field, &errors, n, phase, exact, error);
  if (!code) {
    eo_unloaded_minimum(field, n, phase, least);
    compare_errors(contact_case, eo_case_need(item, "TE_exact_um"), n, exact, tolerance);
    compare_errors(contact_case, eo_case_find(item, "TE_mingap_um"), n, least, tolerance);
    compare_places(contact_case, item, n, exact);
  }
  free(field);
  return code;
}

static enum eo_code check_hertz(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  struct eo_case *this_case = eo_case_need(block, "q"), *the_case = eo_case_need(block, "s"),
                 *expected = eo_case_need(block, "delta_um");
  double relative = eo_case_relative_or(block, "tol_rel", 1e-6);
  (void)error;
  eo_verify_size(contact_case->v, expected, eo_case_size(this_case));
  for (int i = 0; i < eo_case_size(this_case); i++) {
    double load = 1e3 * eo_case_element(this_case, i);
    eo_verify_size(contact_case->v, eo_case_at(expected, i), eo_case_size(the_case));
    for (int j = 0; j < eo_case_size(the_case); j++) {
      struct eo_local_law law;
      double place = 1e-3 * eo_case_element(the_case, j),
             depth[2] = {eo_geometry_depth(&contact_case->geometry, 0, place),
                         eo_geometry_depth(&contact_case->geometry, 1, place)};
      eo_local_law_init(&law, contact_case->design.material.youngs_modulus,
                        contact_case->design.material.poissons_ratio,
                        eo_geometry_relative_radius(&contact_case->geometry, place), depth);
      eo_verify_number(contact_case->v, eo_case_at(eo_case_at(expected, i), j), 1e6 * eo_local_law_approach(&law, load),
                       relative, 0);
    }
  }
  return EO_OK;
}

static enum eo_code check_iso_stiffness(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  const struct eo_geometry *geometry = &contact_case->geometry;
  struct eo_iso_stiffness plain, corrected;
  struct eo_iso_stiffness_input input = {.teeth = {geometry->teeth[0], geometry->teeth[1]},
                                         .virtual_teeth = EO_ISO_VIRTUAL_CUBED,
                                         .normal_pressure_angle = geometry->normal_pressure_angle,
                                         .helix_angle = geometry->helix_angle,
                                         .profile_shift = {geometry->profile_shift[0], geometry->profile_shift[1]},
                                         .dedendum_coefficient = contact_case->design.gear_pair.dedendum_coefficient,
                                         .transverse_contact_ratio = geometry->transverse_contact_ratio,
                                         .blank_factor = 1,
                                         .theory_factor = 1,
                                         .youngs_modulus = contact_case->design.material.youngs_modulus};
  const double relative = 1e-3;
  (void)error;
  eo_iso_stiffness(&plain, &input);
  input.theory_factor = 0.8;
  eo_iso_stiffness(&corrected, &input);
  eo_verify_member(contact_case->v, block, "qprime", 1e9 * plain.flexibility, relative, 0);
  eo_verify_member(contact_case->v, block, "cth", 1e-9 * plain.theoretical, relative, 0);
  eo_verify_member(contact_case->v, block, "CB", plain.rack_factor, relative, 0);
  eo_verify_member(contact_case->v, block, "c_noCM", 1e-9 * plain.single, relative, 0);
  eo_verify_member(contact_case->v, block, "c", 1e-9 * corrected.single, relative, 0);
  eo_verify_member(contact_case->v, block, "cgamma_noCM", 1e-9 * plain.mesh_alpha, relative, 0);
  eo_verify_member(contact_case->v, block, "cgamma", 1e-9 * corrected.mesh_alpha, relative, 0);
  return EO_OK;
}

/* Member and torque of a block called iso6336_3_pinion_828; false with a fault when its name says neither. */
static bool read_root_name(struct eo_case *block, int *member, double *torque)
{
  static const char *const names[2] = {"iso6336_3_pinion_", "iso6336_3_gear_"};
  const char *key = eo_case_key(block);
  char *end = NULL;
  for (*member = EO_PINION; *member <= EO_GEAR; ++*member)
    if (strncmp(key, names[*member], strlen(names[*member])) == 0) {
      *torque = strtod(key + strlen(names[*member]), &end);
      break;
    }
  if (end && !*end && *torque > 0 && isfinite(*torque))
    return true;
  eo_case_fault(block, "The name says member and torque in N m, like iso6336_3_pinion_828.");
  return false;
}

static enum eo_code check_iso_root(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_contact_case *contact_case = context;
  const double relative = 5e-3, module = contact_case->geometry.normal_module;
  int member;
  double torque = 0;
  struct eo_iso_root root;
  (void)error;
  if (!read_root_name(block, &member, &torque))
    return EO_OK;
  if (member == EO_GEAR)
    torque *= (double)contact_case->geometry.teeth[1] / contact_case->geometry.teeth[0];
  eo_iso_root(&root, &contact_case->geometry, member, 0, torque / 2);
  eo_verify_member(contact_case->v, block, "zn", root.virtual_teeth, relative, 0);
  eo_verify_member(contact_case->v, block, "YF", root.form_factor, relative, 0);
  eo_verify_member(contact_case->v, block, "YS", root.stress_correction, relative, 0);
  eo_verify_member(contact_case->v, block, "Yb", root.helix_factor, relative, 0);
  eo_verify_member(contact_case->v, block, "sF", root.chord / module, relative, 0);
  eo_verify_member(contact_case->v, block, "hF", root.arm / module, relative, 0);
  eo_verify_member(contact_case->v, block, "rF", root.fillet_radius / module, relative, 0);
  eo_verify_member(contact_case->v, block, "sigmaF0", 1e-6 * root.stress, relative, 0);
  return EO_OK;
}

static const struct eo_verify_block blocks[] = {
    {"macro", EO_BLOCK_EITHER, check_macro},
    {"modification", EO_BLOCK_EITHER, check_modification},
    {"exact_surface_*", EO_BLOCK_WHOLE, check_surface},
    {"slice_gap_*", EO_BLOCK_WHOLE, check_slice_gap},
    {"unloaded_tca", EO_BLOCK_EACH, check_unloaded},
    {"hertz", EO_BLOCK_WHOLE, check_hertz},
    {"ltca_synthetic", EO_BLOCK_WHOLE, eo_verify_contact_synthetic},
    {"impact", EO_BLOCK_WHOLE, eo_verify_contact_impact},
    {"iso6336_1", EO_BLOCK_WHOLE, check_iso_stiffness},
    {"iso6336_3_*", EO_BLOCK_WHOLE, check_iso_root},
    {"fe_bulk", EO_BLOCK_WHOLE, eo_verify_contact_bulk},
    {"ltca_table", EO_BLOCK_WHOLE, eo_verify_contact_table},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_contact(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  struct eo_contact_case *contact_case = calloc(1, sizeof *contact_case);
  if (!contact_case)
    return eo_error_memory(error);
  enum eo_code code = eo_contact_case_init(contact_case, file, verification, error);
  if (!code && !eo_case_faulty(file))
    code = eo_verify_blocks(verification, file, blocks, contact_case, error);
  eo_contact_case_done(contact_case);
  free(contact_case);
  return code;
}
