#include "app/verify_dynamics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/verify_row.h"
#include "dynamics/sdof.h"
#include "dynamics/vibration.h"
#include "numerics/fourier.h"

enum { HARMONICS = 96, SAMPLES = 4096, MAX_ORDER = 256, NAME_LENGTH = 120 };

/* One number of an object; `missing` when the key is absent. Integers and reals both count. */
static double number(const json_t *object, const char *key, double missing)
{
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : missing;
}

/* key[i], or the key itself when it is a single number. */
static double entry(const json_t *object, const char *key, int i, double missing)
{
  const json_t *value = json_object_get(object, key);
  if (json_is_array(value))
    value = json_array_get(value, i);
  return json_is_number(value) ? json_number_value(value) : missing;
}

static enum eo_code wrong(struct eo_error *error, const char *pointer, const char *what)
{
  return eo_error_set(error, EO_ERROR_INPUT, pointer, "%s: %s.", pointer, what);
}

/* ---- laws ---- */

/* mean, a[], b[] of an object as series of the longest order given; returns the order, or -1. */
static int read_series(const json_t *object, const char *mean, const char *a, const char *b, double *series)
{
  const json_t *cosine = json_object_get(object, a), *sine = json_object_get(object, b);
  size_t order = json_array_size(cosine) > json_array_size(sine) ? json_array_size(cosine) : json_array_size(sine);
  if (order > MAX_ORDER || !json_is_number(json_object_get(object, mean)))
    return -1;
  memset(series, 0, sizeof *series * eo_fourier_terms(MAX_ORDER));
  series[0] = number(object, mean, 0);
  for (size_t k = 1; k <= order; k++) {
    series[2 * k - 1] = json_number_value(json_array_get(cosine, k - 1));
    series[2 * k] = json_number_value(json_array_get(sine, k - 1));
  }
  return (int)order;
}

static enum eo_code read_stiffness(const json_t *object, const char *pointer, double tau, struct eo_law *law, struct eo_error *error)
{
  double series[1 + 2 * MAX_ORDER];
  int order = read_series(object, "k0", "a", "b", series);
  if (order < 0)
    return wrong(error, pointer, "a stiffness law has k0, a[] and b[]");
  return eo_law_set_stiffness(law, order, series, tau, -tau, error);
}

static enum eo_code read_power(const json_t *object, const char *pointer, double tau, struct eo_law *law, struct eo_error *error)
{
  double coefficient[1 + 2 * MAX_ORDER], offset[1 + 2 * MAX_ORDER];
  const json_t *k = json_object_get(object, "K"), *e = json_object_get(object, "e");
  int order = json_is_object(k) ? read_series(k, "k0", "a", "b", coefficient) : read_series(object, "k0", "a", "b", coefficient);
  if (order < 0 && !json_is_object(k))
    order = read_series(object, "K0", "Ka", "Kb", coefficient);
  int offset_order = json_is_object(e) ? read_series(e, "k0", "a", "b", offset) : read_series(object, "e0", "ea", "eb", offset);
  if (offset_order < 0 && json_is_object(e))
    offset_order = read_series(e, "e0", "a", "b", offset);
  if (offset_order < 0 && !json_is_object(e) && !json_object_get(object, "e0")) {
    memset(offset, 0, sizeof offset);
    offset_order = 0;
  }
  if (order < 0 || offset_order < 0)
    return wrong(error, pointer, "a power law has p, the series K and the series e");
  return eo_law_set_power(law, order > offset_order ? order : offset_order, coefficient, offset,
                          number(object, "p", number(object, "exponent", NAN)), tau, error);
}

static int read_array(const json_t *array, double unit, int most, double *value)
{
  int n = (int)json_array_size(array);
  for (int i = 0; i < n && i < most; i++)
    value[i] = json_number_value(json_array_get(array, i)) * unit;
  return n <= most ? n : -1;
}

static enum eo_code read_table(const json_t *object, const char *pointer, double tau, struct eo_law *law, struct eo_error *error)
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

static enum eo_code read_curve(const json_t *object, const char *pointer, double tau, struct eo_law *law, struct eo_error *error)
{
  double z[2 * MAX_ORDER], k[2 * MAX_ORDER], load = number(object, "P", NAN);
  int positions = read_array(json_object_get(object, "Z"), 1, 2 * MAX_ORDER, z), order = (int)number(object, "order", 10);
  if (positions < 2)
    return wrong(error, pointer, "a tangent or secant law has P and Z[positions]");
  if (!json_object_get(object, "kt"))
    return eo_law_set_secant(law, positions, z, load, number(object, "Zd", 0), order, -2 * tau, error);
  if (read_array(json_object_get(object, "kt"), 1, 2 * MAX_ORDER, k) != positions)
    return wrong(error, pointer, "Z and kt must be equally long");
  return eo_law_set_tangent(law, positions, z, k, load, order, -2 * tau, error);
}

/* A law by name (law_NAME, table_NAME) or given in place. */
static enum eo_code read_law(const json_t *cases, const json_t *law, double tau, struct eo_law *out, struct eo_error *error)
{
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
  if (json_object_get(object, "p") || json_object_get(object, "exponent"))
    return read_power(object, pointer, tau, out, error);
  if (json_is_array(json_array_get(json_object_get(object, "Z"), 0)))
    return read_table(object, pointer, tau, out, error);
  if (json_is_array(json_object_get(object, "Z")))
    return read_curve(object, pointer, tau, out, error);
  return read_stiffness(object, pointer, tau, out, error);
}

/* ---- parameters ---- */

static struct eo_dynamics_parameters read_parameters(const json_t *p)
{
  struct eo_dynamics_parameters out = {.ends = (int)number(p, "ends", 2), .base_helix_angle = number(p, "beta", NAN),
                                       .mesh_damping = number(p, "cm", NAN)};
  static const char *const key[][2] = {{"Rp", "Rg"},   {"mp", "mg"},     {"Ip", "Ig"},     {"kpy", "kgy"},   {"cpy", "cgy"},
                                       {"kg1z", "kg2z"}, {"cg1z", "cg2z"}, {"kpz", "kgz"},   {"cpz", "cgz"},   {"kt_p", "kt_g"},
                                       {"ct_p", "ct_g"}};
  double *const member[] = {out.base_radius,          out.mass,
                            out.inertia,              out.bearing_stiffness,
                            out.bearing_damping,      out.gear_axial_stiffness,
                            out.gear_axial_damping,   out.groove_axial_stiffness,
                            out.groove_axial_damping, out.groove_torsional_stiffness,
                            out.groove_torsional_damping};
  int n = sizeof key / sizeof *key;
  for (int i = 0; i < n; i++)
    for (int side = 0; side < 2; side++)
      member[i][side] = number(p, key[i][side], i >= n - 2 ? 0 : NAN);
  return out;
}

static void couple(const json_t *cases, const char *coupling, struct eo_dynamics_parameters *p)
{
  const json_t *torsion = json_object_get(cases, "torsional_coupling");
  static const char *const key[2] = {"kt_p", "kt_g"}, *const only[2] = {"pinion", "gear"};
  if (!coupling || !strcmp(coupling, "none"))
    return;
  for (int m = 0; m < 2; m++) {
    if (!strcmp(coupling, only[1 - m]))
      continue;
    p->groove_torsional_stiffness[m] = number(torsion, key[m], 0);
    p->groove_torsional_damping[m] = 2 * 0.02 * sqrt(p->groove_torsional_stiffness[m] * p->inertia[m] / 2);
  }
}

/* ---- eigenvalues ---- */

static enum eo_code verify_modes(const json_t *cases, const json_t *item, const char *name, json_t *rows, struct eo_error *error)
{
  struct eo_dynamics_model model;
  struct eo_dynamics_modes modes;
  const json_t *given = json_object_get(item, "params");
  struct eo_dynamics_parameters p = read_parameters(given ? given : json_object_get(cases, "defaults"));
  couple(cases, json_string_value(json_object_get(item, "coupling")), &p);
  double km[2] = {entry(item, "km", 0, NAN), entry(item, "km", json_is_array(json_object_get(item, "km")), NAN)};
  enum eo_code code = eo_dynamics_model_init(&model, &p, error);
  if (!code)
    code = eo_dynamics_model_modes(&model, km, &modes, error);
  if (code)
    return code;
  const json_t *frequency = json_object_get(item, "freq_hz"), *ratio = json_object_get(item, "damping_ratio");
  if (json_object_get(item, "zero_modes"))
    eo_verify_row(rows, name, "zero_modes", modes.zero_modes, number(item, "zero_modes", NAN), 0);
  eo_verify_row(rows, name, "number of frequencies", modes.n, (double)json_array_size(frequency), 0);
  for (int i = 0; i < modes.n; i++) {
    char quantity[NAME_LENGTH];
    double expected = json_number_value(json_array_get(frequency, i)), damping = json_number_value(json_array_get(ratio, i));
    snprintf(quantity, sizeof quantity, "freq_hz[%d]", i);
    eo_verify_row(rows, name, quantity, modes.frequency[i], expected, 1e-6 * expected);
    snprintf(quantity, sizeof quantity, "damping_ratio[%d]", i);
    if (i < (int)json_array_size(ratio))
      eo_verify_row(rows, name, quantity, modes.damping_ratio[i], damping, 2e-5 * damping);
  }
  return EO_OK;
}

static enum eo_code verify_printed_signs(const json_t *cases, const json_t *item, json_t *rows, struct eo_error *error)
{
  const char *name = "negative_control_literal_signs";
  struct eo_dynamics_model model;
  const json_t *given = json_object_get(item, "params");
  struct eo_dynamics_parameters p = read_parameters(given ? given : json_object_get(cases, "defaults"));
  double complex pole;
  double km = number(item, "km", number(json_array_get(json_object_get(cases, "eigen"), 0), "km", 1.1e9));
  enum eo_code code = eo_dynamics_model_init(&model, &p, error);
  if (!code)
    code = eo_dynamics_model_printed_pole(&model, (double[]){km, km}, &pole, error);
  if (code)
    return code;
  double real = number(item, "max_real_pole_per_s", NAN), imaginary = number(item, "imag_hz", NAN);
  eo_verify_row(rows, name, "max_real_pole_per_s", creal(pole), real, 1e-6 * fabs(real));
  if (isfinite(imaginary)) /* given as angular frequency or in Hz: the reference's figure is the imaginary part over 2 pi */
    eo_verify_row(rows, name, "imag_hz", fabs(cimag(pole)) / (2 * M_PI), imaginary, 1e-6 * fabs(imaginary));
  return EO_OK;
}

/* ---- periodic responses ---- */

struct verified {
  json_t *rows;
  const char *name;
  const json_t *expected;
  double relative; /* tolerance of an RMS */
};

/* A number or a pair [left, right] under one key. */
static void compare(const struct verified *v, const char *key, const double *value, int ends, double relative, double floor)
{
  const json_t *expected = json_object_get(v->expected, key);
  if (!expected || json_is_null(expected))
    return;
  for (int end = 0; end < ends; end++) {
    char quantity[NAME_LENGTH];
    double e = entry(v->expected, key, end, NAN);
    if (json_is_array(expected))
      snprintf(quantity, sizeof quantity, "%s[%d]", key, end);
    else
      snprintf(quantity, sizeof quantity, "%s", key);
    eo_verify_row(v->rows, v->name, quantity, value[end], e, fmax(relative * fabs(e), floor));
  }
}

static void compare_harmonics(const struct verified *v, const char *key, const double complex *value)
{
  const json_t *expected = json_object_get(v->expected, key);
  double largest = 0;
  size_t k;
  json_t *pair;
  json_array_foreach(expected, k, pair)
    largest = fmax(largest, hypot(json_number_value(json_array_get(pair, 0)), json_number_value(json_array_get(pair, 1))));
  json_array_foreach(expected, k, pair) {
    if (k + 1 > HARMONICS)
      break;
    for (int part = 0; part < 2; part++) {
      char quantity[NAME_LENGTH];
      snprintf(quantity, sizeof quantity, "%s[%zu].%s", key, k, part ? "im" : "re");
      double found = part ? cimag(value[k + 1]) : creal(value[k + 1]);
      eo_verify_row(v->rows, v->name, quantity, found, json_number_value(json_array_get(pair, part)), 1e-3 * largest);
    }
  }
}

static void compare_freedoms(const struct verified *v, const struct eo_vibration *r)
{
  const json_t *expected = json_object_get(v->expected, "dof_acc_rms");
  size_t i;
  json_t *value;
  double largest[3] = {0};
  json_array_foreach(expected, i, value)
    largest[i % 3] = fmax(largest[i % 3], json_number_value(value));
  json_array_foreach(expected, i, value) {
    char quantity[NAME_LENGTH];
    snprintf(quantity, sizeof quantity, "dof_acc_rms[%zu]", i);
    if (i < EO_MAX_FREEDOMS)
      eo_verify_row(v->rows, v->name, quantity, r->freedom_rms[i], json_number_value(value),
                    fmax(v->relative * json_number_value(value), 1e-5 * largest[i % 3]));
  }
}

static void compare_response(const struct verified *v, const struct eo_vibration_solver *solver, const struct eo_vibration *r)
{
  const struct eo_spectrum *s = eo_vibration_spectrum(solver);
  int ends = r->ends;
  double load = fabs(r->force_mean[0]), rms = v->relative;
  compare(v, "X_mean", r->deflection_mean, ends, 1e-5, 0);
  compare(v, "rms_n", r->rms[EO_READING_NORMAL], ends, rms, 0);
  compare(v, "rms_t", r->rms[EO_READING_TRANSVERSE], ends, rms, 0);
  compare(v, "rms_rot", r->rms[EO_READING_ROTATIONAL], ends, rms, 0);
  compare(v, "time_domain_rms_n", r->rms[EO_READING_NORMAL], ends, rms, 0);
  compare(v, "rms_meanLR", r->rms_of_mean, 1, rms, 0);
  compare(v, "F_mean", r->force_mean, ends, 1e-5, 0);
  compare(v, "F_min", r->force_min, ends, 0, fmax(rms, 3e-4) * load);
  compare(v, "F_max", r->force_max, ends, 0, fmax(rms, 3e-4) * load);
  if (ends == 2) {
    const double *q = r->freedom_mean;
    double apart = q[eo_dynamics_freedom(2, EO_PINION, 0, EO_MOTION_Z)] - q[eo_dynamics_freedom(2, EO_PINION, 1, EO_MOTION_Z)];
    compare(v, "y_static_p1", &q[eo_dynamics_freedom(2, EO_PINION, 0, EO_MOTION_Y)], 1, 1e-5, 0);
    compare(v, "y_static_g1", &q[eo_dynamics_freedom(2, EO_GEAR, 0, EO_MOTION_Y)], 1, 1e-5, 0);
    compare(v, "z_p1_minus_z_p2", &apart, 1, 1e-5, 0);
    compare(v, "z_static_g1", &q[eo_dynamics_freedom(2, EO_GEAR, 0, EO_MOTION_Z)], 1, 1e-5, 0);
  }
  compare_harmonics(v, "X_harm_left", s->deflection[0]);
  if (ends == 2)
    compare_harmonics(v, "X_harm_right", s->deflection[1]);
  compare_freedoms(v, r);
}

static enum eo_code read_impact(const json_t *impact, struct eo_vibration_case *load, struct eo_error *error)
{
  if (!json_is_object(impact))
    return EO_OK;
  const char *mode = json_string_value(json_object_get(impact, "mode"));
  if (!mode || (strcmp(mode, "paper") && strcmp(mode, "consistent")))
    return wrong(error, "/dynamics/impact/mode", "an impact acts as \"paper\" or \"consistent\"");
  load->impact = !strcmp(mode, "paper") ? EO_IMPACT_PAPER : EO_IMPACT_CONSISTENT;
  for (int end = 0; end < 2; end++)
    load->pulse[end] = (struct eo_pulse){.shape = EO_PULSE_HALF_SINE, .amplitude = entry(impact, "A", end, NAN),
                                         .start = entry(impact, "start", end, 0), .duration = entry(impact, "d", end, NAN)};
  return EO_OK;
}

/* The response by harmonic balance. Where teeth separate several states may exist: an unstable one is replaced by the one that
   time integration settles to. */
static enum eo_code solve_stable(struct eo_vibration_solver *solver, const struct eo_vibration_case *load, struct eo_vibration *r,
                                 double *floquet, struct eo_error *error)
{
  double complex multiplier[2 * EO_MAX_COORDINATES];
  *floquet = NAN;
  enum eo_code code = eo_vibration_solve(solver, load, EO_START_COLD, r, error);
  if (code || r->outcome == EO_VIBRATION_NOT_CONVERGED)
    return code;
  code = eo_vibration_stability(solver, load, multiplier, error);
  if (code)
    return code;
  *floquet = cabs(multiplier[0]);
  if (*floquet > 1 + 1e-6)
    code = eo_vibration_integrate(solver, load, NULL, r, NULL, error);
  return code;
}

static enum eo_code verify_response(const json_t *cases, const json_t *item, const char *name, struct eo_vibration_solver *solver,
                                    json_t *rows, struct eo_error *error)
{
  struct eo_law law[2] = {{0}, {0}};
  struct eo_vibration r;
  double floquet;
  const json_t *given = json_object_get(item, "params"), *expected = json_object_get(item, "expected"), *laws = json_object_get(item, "law");
  const json_t *params = given ? given : json_object_get(cases, "defaults");
  struct eo_dynamics_parameters p = read_parameters(params);
  struct eo_vibration_case load = {.torque = number(item, "T", NAN), .speed = number(item, "rpm", NAN) * M_PI / 30,
                                   .pinion_teeth = (int)number(item, "z1", number(json_object_get(cases, "geometry"), "z1", 17)),
                                   .law = {&law[0], &law[1]}, .phase_right = number(item, "shift_right", 0),
                                   .gated = json_is_true(json_object_get(item, "gate"))};
  enum eo_code code = eo_vibration_set_model(solver, &p, error);
  for (int end = 0; end < 2 && !code; end++)
    code = read_law(cases, json_is_array(laws) ? json_array_get(laws, end) : laws, number(params, "tau", 0), &law[end], error);
  if (!code)
    code = read_impact(json_object_get(item, "impact"), &load, error);
  if (!code)
    code = solve_stable(solver, &load, &r, &floquet, error);
  if (!code) {
    bool found = r.outcome != EO_VIBRATION_NOT_CONVERGED;
    const struct verified v = {rows, name, expected, fmax(10 * number(expected, "rel_unc", 0), 1e-4)};
    eo_verify_row(rows, name, "converged", found, json_is_false(json_object_get(expected, "converged")) ? 0 : 1, 0);
    if (found) {
      compare_response(&v, solver, &r);
      compare(&v, "max_floquet", &floquet, 1, 1e-3, 0);
    }
  }
  eo_law_done(&law[0]);
  eo_law_done(&law[1]);
  return code;
}

/* ---- single degree of freedom ---- */

static struct eo_sdof read_sdof(const json_t *item)
{
  return (struct eo_sdof){.damping = number(item, "z", NAN), .mean_force = number(item, "Fm", NAN),
                          .alternating_force = number(item, "Fh", NAN), .stiffness_share = number(item, "e", 0),
                          .frequency = number(item, "W", NAN)};
}

static enum eo_code verify_sdof(const json_t *item, const char *name, json_t *rows, struct eo_error *error)
{
  struct eo_sdof_response r;
  const struct eo_sdof sdof = read_sdof(item);
  const json_t *state = json_object_get(item, "x0"), *expected = json_object_get(item, "expected");
  const char *branch = json_string_value(json_object_get(item, "branch"));
  const double x0[2] = {json_number_value(json_array_get(state, 0)), json_number_value(json_array_get(state, 1))};
  enum eo_sdof_start start = state ? EO_SDOF_STATE : branch && !strcmp(branch, "hi") ? EO_SDOF_HIGH : EO_SDOF_LOW;
  enum eo_code code = eo_sdof_solve(&sdof, start, x0, &r, error);
  if (code)
    return code;
  const struct verified v = {rows, name, expected, fmax(10 * number(expected, "rel_unc", 0), 1e-4)};
  double back = r.back_contact;
  eo_verify_row(rows, name, "converged", r.converged, 1, 0);
  compare(&v, "mean", &r.mean, 1, 1e-5, 0);
  compare(&v, "rms", &r.rms, 1, v.relative, 0);
  compare(&v, "pp", &r.peak_to_peak, 1, v.relative, 0);
  compare(&v, "h1", &r.amplitude[0], 1, v.relative, 0);
  compare(&v, "h2", &r.amplitude[1], 1, 0, fmax(1e-3 * r.amplitude[0], v.relative * r.amplitude[1]));
  compare(&v, "contact_loss_fraction", &r.contact_loss, 1, 0, 1e-3);
  compare(&v, "max_floquet", &r.floquet, 1, 1e-3, 0);
  if (json_is_boolean(json_object_get(expected, "back_contact")))
    eo_verify_row(rows, name, "back_contact", back, json_is_true(json_object_get(expected, "back_contact")), 0);
  return EO_OK;
}

/* Folds of the family whose cases are called SDOF-FAMILY-...; "up" is where an upward sweep leaves the state without contact
   loss, "down" where a downward sweep falls back to it. */
static enum eo_code verify_folds(const json_t *sdof, const char *family, const json_t *expected, json_t *rows, struct eo_error *error)
{
  char prefix[NAME_LENGTH], name[NAME_LENGTH];
  const json_t *item = NULL;
  size_t i;
  json_t *each;
  snprintf(prefix, sizeof prefix, "SDOF-%s-", family);
  snprintf(name, sizeof name, "folds.%s", family);
  json_array_foreach(json_object_get(sdof, "cases"), i, each)
    if (!item && !strncmp(json_string_value(json_object_get(each, "id")) ? json_string_value(json_object_get(each, "id")) : "", prefix, strlen(prefix)))
      item = each;
  if (!item)
    return wrong(error, "/sdof/folds", "no case belongs to these folds");
  const struct eo_sdof model = read_sdof(item);
  struct eo_sdof_folds folds;
  enum eo_code code = eo_sdof_folds(&model, 0.3, 3, &folds, error);
  if (code)
    return code;
  eo_verify_row(rows, name, "up", folds.contact_lost, number(expected, "up", NAN), 2e-3);
  for (int f = 0; f < folds.count; f++)
    if (!folds.going_up[f]) {
      eo_verify_row(rows, name, "down", folds.frequency[f], number(expected, "down", NAN), 2e-3);
      break;
    }
  return EO_OK;
}

/* ---- the file ---- */

static const char *name_of(const json_t *item, const char *block, size_t i, char buffer[NAME_LENGTH])
{
  const char *id = json_string_value(json_object_get(item, "id"));
  if (id)
    return id;
  snprintf(buffer, NAME_LENGTH, "%s[%zu]", block, i);
  return buffer;
}

static enum eo_code verify_responses(const json_t *cases, json_t *rows, struct eo_error *error)
{
  char buffer[NAME_LENGTH];
  struct eo_vibration_solver *solver = NULL;
  enum eo_code code = eo_vibration_new(&solver, HARMONICS, SAMPLES, error);
  size_t i;
  json_t *item;
  json_array_foreach(json_object_get(cases, "dynamics"), i, item) {
    if (code)
      break;
    code = verify_response(cases, item, name_of(item, "dynamics", i, buffer), solver, rows, error);
  }
  eo_vibration_free(solver);
  return code;
}

enum eo_code eo_verify_dynamics(const json_t *cases, json_t *rows, struct eo_error *error)
{
  char buffer[NAME_LENGTH];
  enum eo_code code = EO_OK;
  size_t i;
  json_t *item;
  const char *key;
  const json_t *control = json_object_get(cases, "negative_control_literal_signs"), *sdof = json_object_get(cases, "sdof");
  json_array_foreach(json_object_get(cases, "eigen"), i, item)
    if (!code)
      code = verify_modes(cases, item, name_of(item, "eigen", i, buffer), rows, error);
  if (!code && control)
    code = verify_printed_signs(cases, control, rows, error);
  if (!code)
    code = verify_responses(cases, rows, error);
  json_array_foreach(json_object_get(sdof, "cases"), i, item)
    if (!code)
      code = verify_sdof(item, name_of(item, "sdof", i, buffer), rows, error);
  json_object_foreach(json_object_get((json_t *)sdof, "folds"), key, item)
    if (!code)
      code = verify_folds(sdof, key, item, rows, error);
  return code;
}
