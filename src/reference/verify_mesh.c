/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/fourier.h"

enum { MAX_ORDER = 256, MAX_POSITIONS = 2 * MAX_ORDER, TERMS = 1 + 2 * MAX_ORDER, NAME_LENGTH = 120 };

/* mean, a[], b[] of an object as a series of the longest order given; returns the order. */
static int read_series(struct eo_case *object, const char *mean, const char *a, const char *b, double series[TERMS])
{
  struct eo_case *cosine = eo_case_find(object, a), *sine = eo_case_find(object, b);
  double value[2][MAX_ORDER] = {{0}, {0}};
  int cosines = cosine ? eo_case_numbers(cosine, -1, MAX_ORDER, value[0]) : 0,
      sines = sine ? eo_case_numbers(sine, -1, MAX_ORDER, value[1]) : 0;
  int order = cosines > sines ? cosines : sines;
  memset(series, 0, TERMS * sizeof *series);
  series[0] = eo_case_number(object, mean);
  for (int k = 1; k <= order; k++) {
    series[2 * k - 1] = value[0][k - 1];
    series[2 * k] = value[1][k - 1];
  }
  return order < 0 ? 0 : order;
}

static enum eo_code read_stiffness(struct eo_case *object, double tau, struct eo_law *law, struct eo_error *error)
{
  double series[TERMS];
  int order = read_series(object, "k0", "a", "b", series);
  return eo_case_faulty(object) ? EO_OK : eo_law_set_stiffness(law, order, series, tau, -tau, error);
}

/* {p, K: {k0, a, b}, e: {k0 or e0, a, b}}, or flat with k0 or K0 and e0, ea, eb; no e: 0. */
static enum eo_code read_power(struct eo_case *object, double tau, struct eo_law *law, struct eo_error *error)
{
  double coefficient[TERMS], offset[TERMS] = {0};
  struct eo_case *this_case = eo_case_find(object, "K"), *the_case = eo_case_find(object, "e");
  int order = 0, offset_order = 0;
  if (this_case)
    order = read_series(this_case, "k0", "a", "b", coefficient);
  else if (eo_case_find(object, "K0"))
    order = read_series(object, "K0", "Ka", "Kb", coefficient);
  else
    order = read_series(object, "k0", "a", "b", coefficient);
  if (the_case)
    offset_order = read_series(the_case, eo_case_find(the_case, "e0") ? "e0" : "k0", "a", "b", offset);
  else if (eo_case_find(object, "e0"))
    offset_order = read_series(object, "e0", "ea", "eb", offset);
  double power = eo_case_number(object, eo_case_find(object, "exponent") ? "exponent" : "p");
  return eo_case_faulty(object) ? EO_OK
                                : eo_law_set_power(law, order > offset_order ? order : offset_order, coefficient,
                                                   offset, power, tau, error);
}

/* Loads P[n] and deflections Z[n][positions]. */
static enum eo_code read_table(struct eo_case *object, double tau, struct eo_law *law, struct eo_error *error)
{
  struct eo_case *this_case = eo_case_need(object, "Z"), *the_case = eo_case_need(object, "P");
  int rows = eo_case_size(the_case), positions = eo_case_size(eo_case_at(this_case, 0));
  if (the_case && (rows < 2 || eo_case_size(this_case) != rows || positions < 1 || positions > MAX_POSITIONS))
    eo_case_fault(object, "A table has loads P[n] and deflections Z[n][positions].");
  if (eo_case_faulty(object))
    return EO_OK;
  double *load = malloc(sizeof *load * (size_t)rows * (1 + (size_t)positions));
  if (!load)
    return eo_error_memory(error);
  double *deflection = load + rows;
  eo_case_numbers(the_case, rows, rows, load);
  for (int i = 0; i < rows; i++)
    eo_case_numbers(eo_case_at(this_case, i), positions, positions, deflection + (size_t)i * positions);
  enum eo_code code = eo_case_faulty(object)
                          ? EO_OK
                          : eo_law_set_table(law, rows, positions, load, deflection, positions / 2, tau, error);
  free(load);
  return code;
}

/* A tangent {P, Z, kt} or secant {P, Z, Zd} law over one cycle. */
static enum eo_code read_curve(struct eo_case *object, double tau, struct eo_law *law, struct eo_error *error)
{
  double z[MAX_POSITIONS], k[MAX_POSITIONS], load = eo_case_number(object, "P");
  struct eo_case *tangent = eo_case_find(object, "kt");
  int positions = eo_case_numbers(eo_case_need(object, "Z"), -1, MAX_POSITIONS, z),
      order = eo_case_whole_or(object, "order", 0, MAX_ORDER, 10);
  if (tangent)
    eo_case_numbers(tangent, positions, MAX_POSITIONS, k);
  double datum = tangent ? 0 : eo_case_number_or(object, "Zd", 0);
  if (positions >= 0 && positions < 2)
    eo_case_fault(object, "A tangent or secant law has P and Z[positions].");
  if (eo_case_faulty(object))
    return EO_OK;
  return tangent ? eo_law_set_tangent(law, positions, z, k, load, order, -2 * tau, error)
                 : eo_law_set_secant(law, positions, z, load, datum, order, -2 * tau, error);
}

/* The file's law of that name; NULL with a fault when there is none. */
static struct eo_case *named_law(struct eo_case *file, struct eo_case *law)
{
  const char *name = eo_case_text(law);
  struct eo_case *found = NULL;
  char key[NAME_LENGTH];
  for (int i = 0; i < 2 && !found; i++) {
    snprintf(key, sizeof key, i ? "table_%.100s" : "law_%.100s", name);
    found = eo_case_find(file, key);
  }
  if (!found)
    eo_case_fault(law, "There is no law_%.60s and no table_%.60s in the file.", name, name);
  return found;
}

enum eo_code eo_verify_read_law(struct eo_case *file, struct eo_case *law, double tau, struct eo_law *out,
                                struct eo_error *error)
{
  struct eo_case *object = eo_case_is_text(law) ? named_law(file, law) : law;
  struct eo_case *curve = object ? eo_case_find(object, "Z") : NULL;
  if (!object || eo_case_faulty(object))
    return EO_OK;
  if (eo_case_find(object, "p") || eo_case_find(object, "exponent"))
    return read_power(object, tau, out, error);
  if (curve && eo_case_is_list(eo_case_at(curve, 0)))
    return read_table(object, tau, out, error);
  return curve ? read_curve(object, tau, out, error) : read_stiffness(object, tau, out, error);
}

void eo_verify_read_parameters(struct eo_case *params, struct eo_dynamics_parameters *out, double *tau)
{
  static const char *const pair[][2] = {{"Rp", "Rg"},   {"mp", "mg"},     {"Ip", "Ig"},     {"kpy", "kgy"},
                                        {"cpy", "cgy"}, {"kg1z", "kg2z"}, {"cg1z", "cg2z"}, {"kpz", "kgz"},
                                        {"cpz", "cgz"}, {"kt_p", "kt_g"}, {"ct_p", "ct_g"}};
  enum { PAIRS = sizeof pair / sizeof *pair, COUPLINGS = 2 };
  *out = (struct eo_dynamics_parameters){.ends = eo_case_whole_or(params, "ends", 1, 2, 2),
                                         .base_helix_angle = eo_case_number(params, "beta"),
                                         .pinion_axial_stiffness = eo_case_number_or(params, "ka", 0),
                                         .pinion_axial_damping = eo_case_number_or(params, "ca", 0),
                                         .mesh_damping = eo_case_number(params, "cm")};
  double *const member[PAIRS] = {out->base_radius,
                                 out->mass,
                                 out->inertia,
                                 out->bearing_stiffness,
                                 out->bearing_damping,
                                 out->gear_axial_stiffness,
                                 out->gear_axial_damping,
                                 out->groove_axial_stiffness,
                                 out->groove_axial_damping,
                                 out->groove_torsional_stiffness,
                                 out->groove_torsional_damping};
  for (int i = 0; i < PAIRS; i++)
    for (int side = 0; side < 2; side++)
      member[i][side] = i >= PAIRS - COUPLINGS ? eo_case_number_or(params, pair[i][side], 0)
                                               : eo_case_number(params, pair[i][side]);
  *tau = eo_case_number_or(params, "tau", 0);
  eo_case_number_or(params, "eps_z", 0); /* a constant axial float of the pinion: the float itself absorbs it */
}

void eo_verify_couple(struct eo_case *file, struct eo_case *item, struct eo_dynamics_parameters *parameters)
{
  static const char *const key[2] = {"kt_p", "kt_g"}, *const words[] = {"none", "pinion", "gear", "both", "on", NULL};
  const double damping_ratio = 0.02;
  int members = eo_case_choice(item, "coupling", words, 0);
  struct eo_case *torsion = members > 0 ? eo_case_need(file, "torsional_coupling") : NULL;
  if (!torsion)
    return;
  for (int m = 0; m < 2; m++) {
    double stiffness = eo_case_number(torsion, key[m]);
    bool coupled = members > 2 || members == m + 1;
    if (!coupled || parameters->groove_torsional_stiffness[m] != 0)
      continue;
    parameters->groove_torsional_stiffness[m] = stiffness;
    parameters->groove_torsional_damping[m] = 2 * damping_ratio * sqrt(stiffness * parameters->inertia[m] / 2);
  }
}
