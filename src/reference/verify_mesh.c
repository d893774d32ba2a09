#include "reference/verify_mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/fourier.h"

enum { MAX_ORDER = 256, NAME_LENGTH = 120 };

static enum eo_code wrong(struct eo_error *error, const char *pointer, const char *what)
{
  return eo_error_set(error, EO_ERROR_INPUT, pointer, "%s: %s.", pointer, what);
}

/* mean, a[], b[] of an object as series of the longest order given; returns the order, or -1. */
static int read_series(const json_t *object, const char *mean, const char *a, const char *b, double *series)
{
  const json_t *cosine = json_object_get(object, a), *sine = json_object_get(object, b);
  size_t order = json_array_size(cosine) > json_array_size(sine) ? json_array_size(cosine) : json_array_size(sine);
  if (order > MAX_ORDER || !json_is_number(json_object_get(object, mean)))
    return -1;
  memset(series, 0, sizeof *series * eo_fourier_terms(MAX_ORDER));
  series[0] = eo_verify_number_or(object, mean, 0);
  for (size_t k = 1; k <= order; k++) {
    series[2 * k - 1] = json_number_value(json_array_get(cosine, k - 1));
    series[2 * k] = json_number_value(json_array_get(sine, k - 1));
  }
  return (int)order;
}

static enum eo_code read_stiffness(const json_t *object, const char *pointer, double tau, struct eo_law *law,
                                   struct eo_error *error)
{
  double series[1 + 2 * MAX_ORDER];
  int order = read_series(object, "k0", "a", "b", series);
  if (order < 0)
    return wrong(error, pointer, "a stiffness law has k0, a[] and b[]");
  return eo_law_set_stiffness(law, order, series, tau, -tau, error);
}

static enum eo_code read_power(const json_t *object, const char *pointer, double tau, struct eo_law *law,
                               struct eo_error *error)
{
  double coefficient[1 + 2 * MAX_ORDER], offset[1 + 2 * MAX_ORDER];
  const json_t *k = json_object_get(object, "K"), *e = json_object_get(object, "e");
  int order = json_is_object(k) ? read_series(k, "k0", "a", "b", coefficient)
                                : read_series(object, "k0", "a", "b", coefficient);
  if (order < 0 && !json_is_object(k))
    order = read_series(object, "K0", "Ka", "Kb", coefficient);
  int offset_order = json_is_object(e) ? read_series(e, "k0", "a", "b", offset)
                                       : read_series(object, "e0", "ea", "eb", offset);
  if (offset_order < 0 && json_is_object(e))
    offset_order = read_series(e, "e0", "a", "b", offset);
  if (offset_order < 0 && !json_is_object(e) && !json_object_get(object, "e0")) {
    memset(offset, 0, sizeof offset);
    offset_order = 0;
  }
  if (order < 0 || offset_order < 0)
    return wrong(error, pointer, "a power law has p, the series K and the series e");
  return eo_law_set_power(law, order > offset_order ? order : offset_order, coefficient, offset,
                          eo_verify_number_or(object, "p", eo_verify_number_or(object, "exponent", NAN)), tau, error);
}

static int read_array(const json_t *array, double unit, int most, double *value)
{
  int n = (int)json_array_size(array);
  for (int i = 0; i < n && i < most; i++)
    value[i] = json_number_value(json_array_get(array, i)) * unit;
  return n <= most ? n : -1;
}

static enum eo_code read_table(const json_t *object, const char *pointer, double tau, struct eo_law *law,
                               struct eo_error *error)
{
  const json_t *z = json_object_get(object, "Z"), *p = json_object_get(object, "P");
  int rows = (int)json_array_size(p), positions = (int)json_array_size(json_array_get(z, 0));
  if (rows < 2 || (int)json_array_size(z) != rows || positions < 1 || positions > 2 * MAX_ORDER)
    return wrong(error, pointer, "a table has loads P[n] and deflections Z[n][positions]");
  double *load = malloc(sizeof *load * rows * (1 + (size_t)positions));
  if (!load)
    return eo_error_memory(error);
  double *deflection = load + rows;
  enum eo_code code = EO_OK;
  read_array(p, 1, rows, load);
  for (int i = 0; i < rows && !code; i++)
    if (read_array(json_array_get(z, i), 1, positions, deflection + (size_t)i * positions) != positions)
      code = wrong(error, pointer, "all rows of Z must be equally long");
  if (!code)
    code = eo_law_set_table(law, rows, positions, load, deflection, positions / 2, tau, error);
  free(load);
  return code;
}

static enum eo_code read_curve(const json_t *object, const char *pointer, double tau, struct eo_law *law,
                               struct eo_error *error)
{
  double z[2 * MAX_ORDER], k[2 * MAX_ORDER], load = eo_verify_number_or(object, "P", NAN);
  int positions = read_array(json_object_get(object, "Z"), 1, 2 * MAX_ORDER, z),
      order = (int)eo_verify_number_or(object, "order", 10);
  if (positions < 2)
    return wrong(error, pointer, "a tangent or secant law has P and Z[positions]");
  if (!json_object_get(object, "kt"))
    return eo_law_set_secant(law, positions, z, load, eo_verify_number_or(object, "Zd", 0), order, -2 * tau, error);
  if (read_array(json_object_get(object, "kt"), 1, 2 * MAX_ORDER, k) != positions)
    return wrong(error, pointer, "Z and kt must be equally long");
  return eo_law_set_tangent(law, positions, z, k, load, order, -2 * tau, error);
}

enum eo_code eo_verify_read_law(struct eo_verification *v, const json_t *cases, const json_t *law, double tau,
                                struct eo_law *out, struct eo_error *error)
{
  static const char *const known[] = {"k0", "a",  "b", "p", "exponent", "K",  "K0",    "Ka",    "Kb",   "e", "e0",
                                      "ea", "eb", "P", "Z", "kt",       "Zd", "order", "about", "note", NULL};
  char pointer[NAME_LENGTH] = "/law";
  const json_t *object = law;
  if (json_is_string(law)) {
    snprintf(pointer, sizeof pointer, "/law_%s", json_string_value(law));
    object = json_object_get(cases, pointer + 1);
    if (!object) {
      snprintf(pointer, sizeof pointer, "/table_%s", json_string_value(law));
      object = json_object_get(cases, pointer + 1);
    }
  }
  if (!json_is_object(object))
    return wrong(error, pointer, "there is no such law");
  eo_verify_unknown(v, pointer + 1, object, known);
  if (json_object_get(object, "p") || json_object_get(object, "exponent"))
    return read_power(object, pointer, tau, out, error);
  if (json_is_array(json_array_get(json_object_get(object, "Z"), 0)))
    return read_table(object, pointer, tau, out, error);
  if (json_is_array(json_object_get(object, "Z")))
    return read_curve(object, pointer, tau, out, error);
  return read_stiffness(object, pointer, tau, out, error);
}

struct eo_dynamics_parameters eo_verify_read_parameters(struct eo_verification *v, const char *name,
                                                        const json_t *params)
{
  struct eo_dynamics_parameters out = {.ends = eo_verify_number_or(params, "ends", 2) == 1 ? 1 : 2,
                                       .base_helix_angle = eo_verify_number(params, "beta"),
                                       .mesh_damping = eo_verify_number(params, "cm")};
  static const char *const pair[][2] = {{"Rp", "Rg"},   {"mp", "mg"},     {"Ip", "Ig"},     {"kpy", "kgy"},
                                        {"cpy", "cgy"}, {"kg1z", "kg2z"}, {"cg1z", "cg2z"}, {"kpz", "kgz"},
                                        {"cpz", "cgz"}, {"kt_p", "kt_g"}, {"ct_p", "ct_g"}};
  static const char *const single[] = {"ends", "beta", "cm", "tau", "eps_z", NULL};
  enum { PAIRS = sizeof pair / sizeof *pair, COUPLINGS = 2 };
  double *const member[PAIRS] = {out.base_radius,
                                 out.mass,
                                 out.inertia,
                                 out.bearing_stiffness,
                                 out.bearing_damping,
                                 out.gear_axial_stiffness,
                                 out.gear_axial_damping,
                                 out.groove_axial_stiffness,
                                 out.groove_axial_damping,
                                 out.groove_torsional_stiffness,
                                 out.groove_torsional_damping};
  const char *known[2 * PAIRS + sizeof single / sizeof *single];
  for (int i = 0; i < PAIRS; i++)
    for (int side = 0; side < 2; side++) {
      member[i][side] = eo_verify_number_or(params, pair[i][side], i >= PAIRS - COUPLINGS ? 0 : NAN);
      known[2 * i + side] = pair[i][side];
    }
  memcpy(known + 2 * PAIRS, single, sizeof single);
  eo_verify_unknown(v, name, params, known);
  return out;
}

void eo_verify_couple(const json_t *cases, const char *coupling, struct eo_dynamics_parameters *p)
{
  const json_t *torsion = json_object_get(cases, "torsional_coupling");
  static const char *const key[2] = {"kt_p", "kt_g"}, *const only[2] = {"pinion", "gear"};
  if (!coupling || !strcmp(coupling, "none") || !torsion)
    return;
  for (int m = 0; m < 2; m++) {
    if (!strcmp(coupling, only[1 - m]) || p->groove_torsional_stiffness[m] != 0)
      continue;
    p->groove_torsional_stiffness[m] = eo_verify_number_or(torsion, key[m], 0);
    p->groove_torsional_damping[m] = 2 * 0.02 * sqrt(p->groove_torsional_stiffness[m] * p->inertia[m] / 2);
  }
}
