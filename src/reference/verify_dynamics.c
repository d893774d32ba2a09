/* Kind "dynamics": the lumped model through the functions that analyse designs. Blocks, each optional and of any
   length: geometry.z1                  pinion teeth (17 when missing) defaults, torsional_coupling parameters for the
   cases that carry none law_NAME, table_NAME         laws and tables that cases name eigen[] eigenfrequencies, damping
   ratios, number of zero modes negative_control_literal_signs  the pole of the printed signs dynamics[] periodic
   responses; a case's law is a name, an object, or a pair [left, right] of them sdof.cases[], sdof.folds     the single
   degree of freedom */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/verify_mesh.h"
#include "dynamics/sdof.h"
#include "dynamics/vibration.h"

enum { HARMONICS = 96, SAMPLES = 4096, NAME_LENGTH = 120 };

/* key[i], or the key itself when it is a single number; NaN when there is none. */
static double entry(const json_t *object, const char *key, int i)
{
  const json_t *value = json_object_get(object, key);
  if (json_is_array(value))
    value = json_array_get(value, (size_t)i);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

static double entry_or(const json_t *object, const char *key, int i, double missing)
{
  return json_object_get(object, key) ? entry(object, key, i) : missing;
}

static enum eo_code wrong(struct eo_error *error, const char *pointer, const char *what)
{
  return eo_error_set(error, EO_ERROR_INPUT, pointer, "%s: %s.", pointer, what);
}

static struct eo_dynamics_parameters parameters_of(struct eo_verification *v, const json_t *cases, const json_t *item,
                                                   const char *name)
{
  const json_t *given = json_object_get(item, "params");
  struct eo_dynamics_parameters p = eo_verify_read_parameters(v, name,
                                                              given ? given : json_object_get(cases, "defaults"));
  eo_verify_couple(cases, json_string_value(json_object_get(item, "coupling")), &p);
  return p;
}

/* ---- eigenvalues ---- */

static enum eo_code verify_modes(const json_t *cases, const json_t *item, const char *name, struct eo_verification *v,
                                 struct eo_error *error)
{
  struct eo_dynamics_model model;
  struct eo_dynamics_modes modes;
  static const char *const known[] = {"id", "about",      "note",    "params",        "coupling",
                                      "km", "zero_modes", "freq_hz", "damping_ratio", NULL};
  struct eo_dynamics_parameters p = parameters_of(v, cases, item, name);
  double km[2] = {entry(item, "km", 0), entry(item, "km", 1)};
  eo_verify_unknown(v, name, item, known);
  enum eo_code code = eo_dynamics_model_init(&model, &p, error);
  if (!code)
    code = eo_dynamics_model_modes(&model, km, &modes, error);
  if (code)
    return code;
  const json_t *frequency = json_object_get(item, "freq_hz"), *ratio = json_object_get(item, "damping_ratio");
  if (json_object_get(item, "zero_modes"))
    eo_verify_add(v, name, "zero_modes", modes.zero_modes, eo_verify_number(item, "zero_modes"), 0);
  eo_verify_add(v, name, "number of frequencies", modes.n, (double)json_array_size(frequency), 0);
  for (int i = 0; i < modes.n; i++) {
    char quantity[NAME_LENGTH];
    double expected = json_number_value(json_array_get(frequency, i)),
           damping = json_number_value(json_array_get(ratio, i));
    snprintf(quantity, sizeof quantity, "freq_hz[%d]", i);
    eo_verify_add(v, name, quantity, modes.frequency[i], expected, 1e-6 * expected);
    snprintf(quantity, sizeof quantity, "damping_ratio[%d]", i);
    if (i < (int)json_array_size(ratio))
      eo_verify_add(v, name, quantity, modes.damping_ratio[i], damping, 2e-5 * damping);
  }
  return EO_OK;
}

static enum eo_code verify_printed_signs(const json_t *cases, const json_t *item, struct eo_verification *v,
                                         struct eo_error *error)
{
  const char *name = "negative_control_literal_signs";
  struct eo_dynamics_model model;
  static const char *const known[] = {"id",      "about", "note", "params", "coupling", "km", "max_real_pole_per_s",
                                      "imag_hz", NULL};
  struct eo_dynamics_parameters p = parameters_of(v, cases, item, name);
  double complex pole;
  eo_verify_unknown(v, name, item, known);
  double km = eo_verify_number_or(item, "km",
                                  eo_verify_number_or(json_array_get(json_object_get(cases, "eigen"), 0), "km", 1.1e9));
  enum eo_code code = eo_dynamics_model_init(&model, &p, error);
  if (!code)
    code = eo_dynamics_model_printed_pole(&model, (double[]){km, km}, &pole, error);
  if (code)
    return code;
  double real = eo_verify_number(item, "max_real_pole_per_s"), imaginary = eo_verify_number(item, "imag_hz");
  eo_verify_add(v, name, "max_real_pole_per_s", creal(pole), real, 1e-6 * fabs(real));
  if (isfinite(
          imaginary)) /* given as angular frequency or in Hz: the reference's figure is the imaginary part over 2 pi */
    eo_verify_add(v, name, "imag_hz", fabs(cimag(pole)) / (2 * M_PI), imaginary, 1e-6 * fabs(imaginary));
  return EO_OK;
}

/* ---- periodic responses ---- */

struct verified {
  struct eo_verification *to;
  const char *name;
  const json_t *expected;
  double relative; /* tolerance of an RMS */
};

/* A number or a pair [left, right] under one key. */
static void compare(const struct verified *v, const char *key, const double *value, int ends, double relative,
                    double floor)
{
  const json_t *expected = json_object_get(v->expected, key);
  if (!expected || json_is_null(expected))
    return;
  for (int end = 0; end < ends; end++) {
    char quantity[NAME_LENGTH];
    double e = entry(v->expected, key, end);
    if (json_is_array(expected))
      snprintf(quantity, sizeof quantity, "%s[%d]", key, end);
    else
      snprintf(quantity, sizeof quantity, "%s", key);
    eo_verify_add(v->to, v->name, quantity, value[end], e, fmax(relative * fabs(e), floor));
  }
}

static void compare_harmonics(const struct verified *v, const char *key, const double complex *value)
{
  const json_t *expected = json_object_get(v->expected, key);
  double largest = 0;
  size_t k;
  json_t *pair;
  json_array_foreach(expected, k, pair) largest =
      fmax(largest, hypot(json_number_value(json_array_get(pair, 0)), json_number_value(json_array_get(pair, 1))));
  json_array_foreach(expected, k, pair)
  {
    if (k + 1 > HARMONICS)
      break;
    for (int part = 0; part < 2; part++) {
      char quantity[NAME_LENGTH];
      snprintf(quantity, sizeof quantity, "%s[%zu].%s", key, k, part ? "im" : "re");
      double found = part ? cimag(value[k + 1]) : creal(value[k + 1]);
      eo_verify_add(v->to, v->name, quantity, found, json_number_value(json_array_get(pair, part)), 1e-3 * largest);
    }
  }
}

static void compare_freedoms(const struct verified *v, const struct eo_vibration *r)
{
  const json_t *expected = json_object_get(v->expected, "dof_acc_rms");
  size_t i;
  json_t *value;
  double largest[3] = {0};
  json_array_foreach(expected, i, value) largest[i % 3] = fmax(largest[i % 3], json_number_value(value));
  json_array_foreach(expected, i, value)
  {
    char quantity[NAME_LENGTH];
    snprintf(quantity, sizeof quantity, "dof_acc_rms[%zu]", i);
    if (i < EO_MAX_FREEDOMS)
      eo_verify_add(v->to, v->name, quantity, r->freedom_rms[i], json_number_value(value),
                    fmax(v->relative * json_number_value(value), 1e-5 * largest[i % 3]));
  }
}

static void compare_response(const struct verified *v, const struct eo_vibration_solver *solver,
                             const struct eo_vibration *r)
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
    double apart = q[eo_dynamics_freedom(2, EO_PINION, 0, EO_MOTION_Z)] -
                   q[eo_dynamics_freedom(2, EO_PINION, 1, EO_MOTION_Z)];
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

static enum eo_code read_impact(const json_t *impact, const struct verified *at, struct eo_vibration_case *load,
                                struct eo_error *error)
{
  static const char *const known[] = {"mode", "A", "start", "d", "about", "note", NULL};
  if (!json_is_object(impact))
    return EO_OK;
  const char *mode = json_string_value(json_object_get(impact, "mode"));
  if (!mode || (strcmp(mode, "paper") && strcmp(mode, "consistent")))
    return wrong(error, "/dynamics/impact/mode", "an impact acts as \"paper\" or \"consistent\"");
  eo_verify_unknown(at->to, at->name, impact, known);
  load->impact = !strcmp(mode, "paper") ? EO_IMPACT_PAPER : EO_IMPACT_CONSISTENT;
  for (int end = 0; end < 2; end++)
    load->pulse[end] = (struct eo_pulse){.shape = EO_PULSE_HALF_SINE,
                                         .amplitude = entry(impact, "A", end),
                                         .start = entry_or(impact, "start", end, 0),
                                         .duration = entry(impact, "d", end)};
  return EO_OK;
}

/* The response by harmonic balance. Where teeth separate several states may exist: an unstable one is replaced by the
   one that time integration settles to. */
static enum eo_code solve_stable(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                 struct eo_vibration *r, double *floquet, struct eo_error *error)
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

static struct eo_vibration_case read_case(const json_t *cases, const json_t *item, const struct eo_law law[2])
{
  double teeth = eo_verify_number_or(item, "z1", eo_verify_number_or(json_object_get(cases, "geometry"), "z1", 17));
  return (struct eo_vibration_case){.torque = eo_verify_number(item, "T"),
                                    .speed = eo_verify_number(item, "rpm") * M_PI / 30,
                                    .pinion_teeth = teeth >= 1 && teeth < 1e6 ? (int)teeth : 0,
                                    .law = {&law[0], &law[1]},
                                    .phase_right = eo_verify_number_or(item, "shift_right", 0),
                                    .gated = json_is_true(json_object_get(item, "gate"))};
}

static enum eo_code solve_case(const struct verified *at, const json_t *cases, const json_t *item,
                               struct eo_vibration_solver *solver, struct eo_law law[2], struct eo_vibration *r,
                               double *floquet, struct eo_error *error)
{
  const json_t *given = json_object_get(item, "params"), *laws = json_object_get(item, "law");
  double tau = eo_verify_number_or(given ? given : json_object_get(cases, "defaults"), "tau", 0);
  struct eo_dynamics_parameters p = parameters_of(at->to, cases, item, at->name);
  struct eo_vibration_case load = read_case(cases, item, law);
  enum eo_code code = eo_vibration_set_model(solver, &p, error);
  for (int end = 0; end < 2 && !code; end++)
    code = eo_verify_read_law(at->to, cases, json_is_array(laws) ? json_array_get(laws, (size_t)end) : laws, tau,
                              &law[end], error);
  if (!code)
    code = read_impact(json_object_get(item, "impact"), at, &load, error);
  return code ? code : solve_stable(solver, &load, r, floquet, error);
}

static enum eo_code verify_response(const json_t *cases, const json_t *item, const char *name,
                                    struct eo_vibration_solver *solver, struct eo_verification *v,
                                    struct eo_error *error)
{
  static const char *const known[] = {"id",  "about", "note", "params",      "coupling", "law",      "T",
                                      "rpm", "z1",    "gate", "shift_right", "impact",   "expected", NULL};
  static const char *const answers[] = {
      "converged",   "X_mean",  "X_harm_left",       "X_harm_right", "rms_n",
      "rms_t",       "rms_rot", "rms_meanLR",        "dof_acc_rms",  "F_mean",
      "F_min",       "F_max",   "y_static_p1",       "y_static_g1",  "z_p1_minus_z_p2",
      "z_static_g1", "rel_unc", "time_domain_rms_n", "max_floquet",  NULL};
  struct eo_law law[2] = {{0}, {0}};
  struct eo_vibration r;
  double floquet;
  const json_t *expected = json_object_get(item, "expected");
  const struct verified at = {v, name, expected, fmax(10 * eo_verify_number_or(expected, "rel_unc", 0), 1e-4)};
  eo_verify_unknown(v, name, item, known);
  eo_verify_unknown(v, name, expected, answers);
  enum eo_code code = solve_case(&at, cases, item, solver, law, &r, &floquet, error);
  if (!code) {
    bool found = r.outcome != EO_VIBRATION_NOT_CONVERGED;
    eo_verify_add(v, name, "converged", found, json_is_false(json_object_get(expected, "converged")) ? 0 : 1, 0);
    if (found) {
      compare_response(&at, solver, &r);
      compare(&at, "max_floquet", &floquet, 1, 1e-3, 0);
    }
  }
  eo_law_done(&law[0]);
  eo_law_done(&law[1]);
  return code;
}

/* ---- single degree of freedom ---- */

static struct eo_sdof read_sdof(const json_t *item)
{
  return (struct eo_sdof){.damping = eo_verify_number(item, "z"),
                          .mean_force = eo_verify_number(item, "Fm"),
                          .alternating_force = eo_verify_number(item, "Fh"),
                          .stiffness_share = eo_verify_number_or(item, "e", 0),
                          .frequency = eo_verify_number(item, "W")};
}

static enum eo_code verify_sdof(const json_t *item, const char *name, struct eo_verification *v, struct eo_error *error)
{
  static const char *const known[] = {"id", "about", "note",   "z",  "Fm",       "Fh",
                                      "e",  "W",     "branch", "x0", "expected", NULL};
  static const char *const answers[] = {"mean",         "rms",         "pp",      "h1", "h2", "contact_loss_fraction",
                                        "back_contact", "max_floquet", "rel_unc", NULL};
  struct eo_sdof_response r;
  const struct eo_sdof sdof = read_sdof(item);
  const json_t *state = json_object_get(item, "x0"), *expected = json_object_get(item, "expected");
  const char *branch = json_string_value(json_object_get(item, "branch"));
  const double x0[2] = {json_number_value(json_array_get(state, 0)), json_number_value(json_array_get(state, 1))};
  enum eo_sdof_start start = state ? EO_SDOF_STATE : branch && !strcmp(branch, "hi") ? EO_SDOF_HIGH : EO_SDOF_LOW;
  eo_verify_unknown(v, name, item, known);
  eo_verify_unknown(v, name, expected, answers);
  enum eo_code code = eo_sdof_solve(&sdof, start, x0, &r, error);
  if (code)
    return code;
  const struct verified at = {v, name, expected, fmax(10 * eo_verify_number_or(expected, "rel_unc", 0), 1e-4)};
  eo_verify_add(v, name, "converged", r.converged, 1, 0);
  compare(&at, "mean", &r.mean, 1, 1e-5, 0);
  compare(&at, "rms", &r.rms, 1, at.relative, 0);
  compare(&at, "pp", &r.peak_to_peak, 1, at.relative, 0);
  compare(&at, "h1", &r.amplitude[0], 1, at.relative, 0);
  compare(&at, "h2", &r.amplitude[1], 1, 0, fmax(1e-3 * r.amplitude[0], at.relative * r.amplitude[1]));
  compare(&at, "contact_loss_fraction", &r.contact_loss, 1, 0, 1e-3);
  compare(&at, "max_floquet", &r.floquet, 1, 1e-3, 0);
  if (json_is_boolean(json_object_get(expected, "back_contact")))
    eo_verify_add(v, name, "back_contact", r.back_contact, json_is_true(json_object_get(expected, "back_contact")), 0);
  return EO_OK;
}

/* The first case called SDOF-FAMILY-... */
static const json_t *case_of_family(const json_t *sdof, const char *family)
{
  char prefix[NAME_LENGTH];
  size_t i;
  json_t *item;
  snprintf(prefix, sizeof prefix, "SDOF-%s-", family);
  json_array_foreach(json_object_get(sdof, "cases"), i, item)
  {
    const char *id = json_string_value(json_object_get(item, "id"));
    if (id && !strncmp(id, prefix, strlen(prefix)))
      return item;
  }
  return NULL;
}

/* Folds of a family of cases; "up" is where an upward sweep leaves the state without contact loss, "down" where a
   downward sweep falls back to it. */
static enum eo_code verify_folds(const json_t *sdof, const char *family, const json_t *expected, const char *name,
                                 struct eo_verification *v, struct eo_error *error)
{
  static const char *const known[] = {"up", "down", "about", "note", NULL};
  const json_t *item = case_of_family(sdof, family);
  if (!item)
    return wrong(error, "/sdof/folds", "no case belongs to these folds");
  const struct eo_sdof model = read_sdof(item);
  struct eo_sdof_folds folds;
  enum eo_code code = eo_sdof_folds(&model, 0.3, 3, &folds, error);
  if (code)
    return code;
  eo_verify_unknown(v, name, expected, known);
  if (json_object_get(expected, "up"))
    eo_verify_add(v, name, "up", folds.contact_lost, eo_verify_number(expected, "up"), 2e-3);
  int down = 0;
  while (down < folds.count && folds.going_up[down])
    down++;
  if (json_object_get(expected, "down"))
    eo_verify_add(v, name, "down", down < folds.count ? folds.frequency[down] : NAN, eo_verify_number(expected, "down"),
                  2e-3);
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

/* A case that cannot be computed is a failed check of its own; the others still count. */
static enum eo_code settle(struct eo_verification *v, const char *name, enum eo_code code, const struct eo_error *error)
{
  if (code != EO_ERROR_INPUT && code != EO_ERROR_NUMERIC)
    return code;
  eo_verify_broken(v, name, error);
  return EO_OK;
}

static enum eo_code verify_responses(const json_t *cases, struct eo_verification *v, struct eo_error *error)
{
  char buffer[NAME_LENGTH];
  struct eo_vibration_solver *solver = NULL;
  enum eo_code code = eo_vibration_new(&solver, HARMONICS, SAMPLES, error);
  size_t i;
  json_t *item;
  json_array_foreach(json_object_get(cases, "dynamics"), i, item)
  {
    const char *name = name_of(item, "dynamics", i, buffer);
    if (!code)
      code = settle(v, name, verify_response(cases, item, name, solver, v, error), error);
  }
  eo_vibration_free(solver);
  return code;
}

static enum eo_code verify_single(const json_t *sdof, struct eo_verification *v, struct eo_error *error)
{
  static const char *const known[] = {"equation", "note", "about", "cases", "analytic_A", "folds", NULL};
  char buffer[NAME_LENGTH];
  enum eo_code code = EO_OK;
  size_t i;
  json_t *item;
  const char *family;
  json_array_foreach(json_object_get(sdof, "cases"), i, item)
  {
    const char *name = name_of(item, "sdof", i, buffer);
    if (!code)
      code = settle(v, name, verify_sdof(item, name, v, error), error);
  }
  json_object_foreach(json_object_get(sdof, "folds"), family, item)
  {
    snprintf(buffer, sizeof buffer, "folds.%s", family);
    if (!code)
      code = settle(v, buffer, verify_folds(sdof, family, item, buffer, v, error), error);
  }
  eo_verify_unknown(v, "sdof", sdof, known);
  return code;
}

/* Keys of the file that nobody reads; law_NAME and table_NAME are read by the cases that name them. */
static void note_unknown(const json_t *cases, struct eo_verification *v)
{
  static const char *const known[] = {"kind",
                                      "about",
                                      "conventions",
                                      "geometry",
                                      "defaults",
                                      "inertia_assumption",
                                      "torsional_coupling",
                                      "negative_control_literal_signs",
                                      "eigen",
                                      "dynamics",
                                      "sdof",
                                      "note",
                                      "source",
                                      NULL};
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)cases, key, value)
  {
    bool found = !strncmp(key, "law_", 4) || !strncmp(key, "table_", 6);
    for (int i = 0; known[i] && !found; i++)
      found = !strcmp(known[i], key);
    if (!found)
      eo_verify_ignore(v, "\"%s\" is not a block of this kind", key);
  }
}

enum eo_code eo_verify_dynamics(const json_t *cases, struct eo_verification *v, struct eo_error *error)
{
  char buffer[NAME_LENGTH];
  enum eo_code code = EO_OK;
  size_t i;
  json_t *item;
  const json_t *control = json_object_get(cases, "negative_control_literal_signs");
  json_array_foreach(json_object_get(cases, "eigen"), i, item)
  {
    const char *name = name_of(item, "eigen", i, buffer);
    if (!code)
      code = settle(v, name, verify_modes(cases, item, name, v, error), error);
  }
  if (!code && control)
    code = settle(v, "negative_control_literal_signs", verify_printed_signs(cases, control, v, error), error);
  if (!code)
    code = verify_responses(cases, v, error);
  if (!code)
    code = verify_single(json_object_get(cases, "sdof"), v, error);
  note_unknown(cases, v);
  return code;
}
