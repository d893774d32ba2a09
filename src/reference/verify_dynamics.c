/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kind "dynamics": the lumped model through the functions that analyse designs. Blocks, each optional and of any
   length: geometry (z1: pinion teeth; a whole pair is compared), defaults and torsional_coupling (parameters for the
   cases that carry none), law_NAME and table_NAME (what cases name), eigen[] (eigenfrequencies, damping ratios, number
   of zero modes), negative_control_literal_signs (the pole of the printed signs), dynamics[] (periodic responses; a
   case's law is a name, an object, or a pair [left, right] of them), sdof.cases[], sdof.folds (the single degree of
   freedom). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/sdof.h"
#include "dynamics/vibration.h"
#include "reference/case_pair.h"
#include "reference/verify_mesh.h"

enum { HARMONICS = 96, SAMPLES = 4096, NAME_LENGTH = 120, LARGEST_TEETH = 100000 };

/* How close the references were computed. */
static const double of_mean = 1e-5, of_frequency = 1e-6, of_damping = 2e-5, of_floquet = 1e-3;

struct dynamics {
  struct eo_case *file;
  struct eo_verification *v;
  struct eo_vibration_solver *solver;
  int teeth; /* of the pinion */
};

/* The value, or its element i when it is a list; NULL when there is none. */
static struct eo_case *entry(struct eo_case *value, int i)
{
  return eo_case_is_list(value) ? eo_case_at(value, i) : value;
}

static double entry_number(struct eo_case *object, const char *key, int i)
{
  struct eo_case *value = eo_case_need(object, key);
  return eo_case_is_list(value) ? eo_case_element(value, i) : eo_case_real(value);
}

/* The case's own parameters, or the file's. */
static void read_parameters(const struct dynamics *dynamics, struct eo_case *item,
                            struct eo_dynamics_parameters *parameters, double *tau)
{
  struct eo_case *given = eo_case_find(item, "params");
  eo_verify_read_parameters(given ? given : eo_case_need(dynamics->file, "defaults"), parameters, tau);
  eo_verify_couple(dynamics->file, item, parameters);
}

/* A block that describes the whole pair, in m and rad, is compared with our geometry; else it states the pinion's
 * teeth.
 */
static enum eo_code check_geometry(void *context, struct eo_case *block, struct eo_error *error)
{
  const struct dynamics *dynamics = context;
  struct eo_gear_pair pair = {.ends = 1, .backlash = 1e-4, .centre_distance = NAN, .tip_diameter = {NAN, NAN}};
  struct eo_geometry geometry;
  if (!eo_case_find(block, "mn"))
    return EO_OK;
  pair.addendum_coefficient = 1; /* the usual rack */
  pair.dedendum_coefficient = 1.25;
  pair.fillet_radius_coefficient = 0.38;
  pair.teeth[0] = dynamics->teeth;
  pair.teeth[1] = eo_case_whole(block, "z2", 1, LARGEST_TEETH);
  pair.normal_module = eo_case_number(block, "mn");
  pair.normal_pressure_angle = eo_case_number(block, "an");
  pair.helix_angle = eo_case_number(block, "beta");
  pair.face_width = eo_case_number(block, "b");
  pair.groove_width = eo_case_number_or(block, "groove", 0);
  enum eo_code code = eo_case_faulty(block) ? EO_OK : eo_geometry_init(&geometry, &pair, error);
  if (!code && !eo_case_faulty(block))
    eo_case_check_geometry(dynamics->v, block, &geometry, 1, 1e-9);
  return code;
}

static enum eo_code check_defaults(void *context, struct eo_case *block, struct eo_error *error)
{
  struct eo_dynamics_parameters parameters;
  double tau;
  (void)context;
  (void)error;
  eo_verify_read_parameters(block, &parameters, &tau);
  return EO_OK;
}

static enum eo_code check_coupling(void *context, struct eo_case *block, struct eo_error *error)
{
  (void)context;
  (void)error;
  eo_case_number(block, "kt_p");
  eo_case_number(block, "kt_g");
  return EO_OK;
}

/* Laws are read where they stand, so that one which no case names cannot be wrong unseen. */
static enum eo_code check_law(void *context, struct eo_case *block, struct eo_error *error)
{
  const struct dynamics *dynamics = context;
  struct eo_law law = {0};
  struct eo_case *defaults = eo_case_find(dynamics->file, "defaults");
  enum eo_code code = eo_verify_read_law(dynamics->file, block, eo_case_number_or(defaults, "tau", 0), &law, error);
  eo_law_done(&law);
  return code == EO_ERROR_INPUT ? (eo_case_fault(block, "%s", error->text), EO_OK) : code;
}

static enum eo_code check_modes(void *context, struct eo_case *item, struct eo_error *error)
{
  const struct dynamics *dynamics = context;
  struct eo_dynamics_model model;
  struct eo_dynamics_modes modes;
  struct eo_dynamics_parameters parameters;
  double tau;
  read_parameters(dynamics, item, &parameters, &tau);
  double km[2] = {entry_number(item, "km", 0), parameters.ends == 2 ? entry_number(item, "km", 1) : NAN};
  if (eo_case_faulty(item))
    return EO_OK;
  enum eo_code code = eo_dynamics_model_init(&model, &parameters, error);
  if (!code)
    code = eo_dynamics_model_modes(&model, km, &modes, error);
  if (code)
    return code;
  struct eo_case *ratio = eo_case_find(item, "damping_ratio");
  eo_verify_exact(dynamics->v, eo_case_find(item, "zero_modes"), modes.zero_modes);
  eo_verify_list(dynamics->v, eo_case_need(item, "freq_hz"), modes.n, modes.frequency, 1, of_frequency, 0);
  if (ratio)
    eo_verify_list(dynamics->v, ratio, modes.n, modes.damping_ratio, 1, of_damping, 0);
  return EO_OK;
}

/* The mesh stiffness of the block, or of the first case of eigen. imag_hz: the imaginary part over 2 pi. */
static enum eo_code check_printed_signs(void *context, struct eo_case *item, struct eo_error *error)
{
  const struct dynamics *dynamics = context;
  struct eo_case *other = eo_case_at(eo_case_find(dynamics->file, "eigen"), 0);
  struct eo_dynamics_model model;
  struct eo_dynamics_parameters parameters;
  double complex pole;
  double tau;
  read_parameters(dynamics, item, &parameters, &tau);
  struct eo_case *from = eo_case_find(item, "km") || !other ? item : other;
  double km[2] = {entry_number(from, "km", 0), parameters.ends == 2 ? entry_number(from, "km", 1) : NAN};
  if (eo_case_faulty(item))
    return EO_OK;
  enum eo_code code = eo_dynamics_model_init(&model, &parameters, error);
  if (!code)
    code = eo_dynamics_model_printed_pole(&model, km, &pole, error);
  if (code)
    return code;
  eo_verify_number(dynamics->v, eo_case_need(item, "max_real_pole_per_s"), creal(pole), of_frequency, 0);
  eo_verify_member(dynamics->v, item, "imag_hz", fabs(cimag(pole)) / (2 * M_PI), of_frequency, 0);
  return EO_OK;
}

struct verified {
  struct eo_verification *v;
  struct eo_case *expected;
  double relative; /* tolerance of an RMS */
};

/* What a reference may not have found, and states as null. */
static bool is_stated_absent(const struct verified *at, struct eo_case *expected)
{
  static const char *const keys[] = {"max_floquet", "time_domain_rms_n"};
  for (size_t i = 0; i < sizeof keys / sizeof *keys && eo_case_is_null(expected); i++)
    if (strcmp(eo_case_key(expected), keys[i]) == 0) {
      eo_verify_uncompared(at->v, expected, "the reference has none.");
      return true;
    }
  return false;
}

/* A number or a pair [left, right] under one key. */
static void compare(const struct verified *at, const char *key, const double *value, int ends, double relative,
                    double absolute)
{
  struct eo_case *expected = eo_case_find(at->expected, key);
  if (is_stated_absent(at, expected))
    return;
  if (eo_case_is_list(expected))
    eo_verify_list(at->v, expected, ends, value, 1, relative, absolute);
  else
    for (int end = 0; end < ends && expected; end++) /* one number stands for both ends */
      eo_verify_number(at->v, expected, value[end], relative, absolute);
}

/* Real and imaginary parts from the first harmonic on, to a thousandth of the largest. */
static void compare_harmonics(const struct verified *at, const char *key, const double complex *value)
{
  struct eo_case *expected = eo_case_find(at->expected, key);
  const double scale = 1e-3 * eo_case_largest(expected);
  if (eo_case_size(expected) > HARMONICS)
    eo_case_fault(expected, "At most %d harmonics are computed.", HARMONICS);
  for (int k = 0; k < eo_case_size(expected) && k < HARMONICS; k++) {
    const double part[2] = {creal(value[k + 1]), cimag(value[k + 1])};
    eo_verify_list(at->v, eo_case_at(expected, k), 2, part, 1, 0, scale);
  }
}

/* Motions y, z, theta in turn, to 1e-5 of the largest of their kind. */
static void compare_freedoms(const struct verified *at, const struct eo_vibration *vibration)
{
  enum { MOTIONS = 3 };
  struct eo_case *expected = eo_case_find(at->expected, "dof_acc_rms");
  const int freedoms = 2 * MOTIONS * vibration->ends;
  double largest[MOTIONS] = {0}, wanted[EO_MAX_FREEDOMS];
  if (!expected || eo_case_numbers(expected, freedoms, EO_MAX_FREEDOMS, wanted) < 0)
    return;
  for (int i = 0; i < freedoms; i++)
    largest[i % MOTIONS] = fmax(largest[i % MOTIONS], fabs(wanted[i]));
  for (int i = 0; i < freedoms; i++)
    eo_verify_number(at->v, eo_case_at(expected, i), vibration->freedom_rms[i], at->relative,
                     1e-5 * largest[i % MOTIONS]);
}

static void compare_statics(const struct verified *at, const struct eo_vibration *vibration)
{
  const double *q = vibration->freedom_mean;
  double apart = q[eo_dynamics_freedom(2, EO_PINION, 0, EO_MOTION_Z)] -
                 q[eo_dynamics_freedom(2, EO_PINION, 1, EO_MOTION_Z)];
  eo_verify_member(at->v, at->expected, "y_static_p1", q[eo_dynamics_freedom(2, EO_PINION, 0, EO_MOTION_Y)], of_mean,
                   0);
  eo_verify_member(at->v, at->expected, "y_static_g1", q[eo_dynamics_freedom(2, EO_GEAR, 0, EO_MOTION_Y)], of_mean, 0);
  eo_verify_member(at->v, at->expected, "z_p1_minus_z_p2", apart, of_mean, 0);
  eo_verify_member(at->v, at->expected, "z_static_g1", q[eo_dynamics_freedom(2, EO_GEAR, 0, EO_MOTION_Z)], of_mean, 0);
}

static void compare_response(const struct verified *at, const struct eo_vibration_solver *solver,
                             const struct eo_vibration *vibration)
{
  const struct eo_spectrum *spectrum = eo_vibration_spectrum(solver);
  const double load = fabs(vibration->force_mean[0]), rms = at->relative, least_force = 3e-4;
  int ends = vibration->ends;
  compare(at, "X_mean", vibration->deflection_mean, ends, of_mean, 0);
  compare(at, "rms_n", vibration->rms[EO_READING_NORMAL], ends, rms, 0);
  compare(at, "rms_t", vibration->rms[EO_READING_TRANSVERSE], ends, rms, 0);
  compare(at, "rms_rot", vibration->rms[EO_READING_ROTATIONAL], ends, rms, 0);
  compare(at, "time_domain_rms_n", vibration->rms[EO_READING_NORMAL], ends, rms, 0);
  eo_verify_member(at->v, at->expected, "rms_meanLR", vibration->rms_of_mean[EO_READING_NORMAL], rms, 0);
  compare(at, "F_mean", vibration->force_mean, ends, of_mean, 0);
  compare(at, "F_min", vibration->force_min, ends, 0, fmax(rms, least_force) * load);
  compare(at, "F_max", vibration->force_max, ends, 0, fmax(rms, least_force) * load);
  if (ends == 2)
    compare_statics(at, vibration);
  compare_harmonics(at, "X_harm_left", spectrum->deflection[0]);
  if (ends == 2)
    compare_harmonics(at, "X_harm_right", spectrum->deflection[1]);
  compare_freedoms(at, vibration);
}

static void read_impact(struct eo_case *impact, struct eo_vibration_case *load)
{
  static const char *const modes[] = {"paper", "consistent", NULL};
  if (!impact)
    return;
  if (!eo_case_need(impact, "mode"))
    return;
  load->impact = eo_case_choice(impact, "mode", modes, 0) == 0 ? EO_IMPACT_PAPER : EO_IMPACT_CONSISTENT;
  for (int end = 0; end < 2; end++)
    load->pulse[end] = (struct eo_pulse){.shape = EO_PULSE_HALF_SINE,
                                         .amplitude = entry_number(impact, "A", end),
                                         .start = eo_case_find(impact, "start") ? entry_number(impact, "start", end)
                                                                                : 0,
                                         .duration = entry_number(impact, "d", end)};
}

/* The response by harmonic balance. Where teeth separate several states may exist: an unstable one is replaced by the
   one that time integration settles to. */
static enum eo_code solve_stable(struct eo_vibration_solver *solver, const struct eo_vibration_case *load,
                                 struct eo_vibration *vibration, double *floquet, struct eo_error *error)
{
  double complex multiplier[2 * EO_MAX_COORDINATES];
  *floquet = NAN;
  enum eo_code code = eo_vibration_solve(solver, load, EO_START_COLD, vibration, error);
  if (code || vibration->outcome == EO_VIBRATION_NOT_CONVERGED)
    return code;
  code = eo_vibration_stability(solver, load, multiplier, error);
  if (code)
    return code;
  *floquet = cabs(multiplier[0]);
  if (*floquet > 1 + 1e-6)
    code = eo_vibration_integrate(solver, load, NULL, vibration, NULL, error);
  return code;
}

static struct eo_vibration_case read_case(const struct dynamics *dynamics, struct eo_case *item,
                                          const struct eo_law law[2])
{
  return (struct eo_vibration_case){.torque = eo_case_number(item, "T"),
                                    .speed = eo_case_number(item, "rpm") * M_PI / 30,
                                    .pinion_teeth = eo_case_whole_or(item, "z1", 1, LARGEST_TEETH, dynamics->teeth),
                                    .law = {&law[0], &law[1]},
                                    .phase_right = eo_case_number_or(item, "shift_right", 0),
                                    .gated = eo_case_flag_or(item, "gate", false)};
}

static enum eo_code solve_case(const struct dynamics *dynamics, struct eo_case *item, struct eo_law law[2],
                               struct eo_vibration *vibration, double *floquet, struct eo_error *error)
{
  struct eo_case *laws = eo_case_need(item, "law");
  struct eo_dynamics_parameters parameters;
  double tau;
  read_parameters(dynamics, item, &parameters, &tau);
  struct eo_vibration_case load = read_case(dynamics, item, law);
  read_impact(eo_case_given(item, "impact"), &load);
  if (eo_case_is_list(laws) && eo_case_size(laws) != 2)
    eo_case_fault(laws, "A law, or a pair [left, right] of laws, is expected here.");
  if (eo_case_faulty(item))
    return EO_OK;
  enum eo_code code = eo_vibration_set_model(dynamics->solver, &parameters, error);
  for (int end = 0; end < 2 && !code; end++)
    code = eo_verify_read_law(dynamics->file, entry(laws, end), tau, &law[end], error);
  return code || eo_case_faulty(item) ? code : solve_stable(dynamics->solver, &load, vibration, floquet, error);
}

/* A response that was not found fails, unless the case says that there is none. */
static void compare_outcome(const struct dynamics *dynamics, struct eo_case *expected,
                            const struct eo_vibration *vibration, double floquet)
{
  const struct verified at = {dynamics->v, expected, fmax(10 * eo_case_number_or(expected, "rel_unc", 0), 1e-4)};
  bool found = vibration->outcome != EO_VIBRATION_NOT_CONVERGED, wanted = eo_case_flag_or(expected, "converged", true);
  if (at.relative >= 1)
    eo_case_fault(eo_case_find(expected, "rel_unc"), "An uncertainty is below 0.1.");
  if (!found && wanted) {
    eo_verify_diverged(dynamics->v, expected);
    return;
  }
  eo_verify_exact(dynamics->v, eo_case_find(expected, "converged"), found);
  if (!found)
    return;
  compare_response(&at, dynamics->solver, vibration);
  struct eo_case *multiplier = eo_case_find(expected, "max_floquet");
  if (!is_stated_absent(&at, multiplier))
    eo_verify_number(dynamics->v, multiplier, floquet, of_floquet, 0);
}

static enum eo_code check_response(void *context, struct eo_case *item, struct eo_error *error)
{
  const struct dynamics *dynamics = context;
  struct eo_law law[2] = {{0}, {0}};
  struct eo_vibration vibration;
  double floquet = NAN;
  struct eo_case *expected = eo_case_need(item, "expected");
  enum eo_code code = solve_case(dynamics, item, law, &vibration, &floquet, error);
  if (!code && !eo_case_faulty(item))
    compare_outcome(dynamics, expected, &vibration, floquet);
  eo_law_done(&law[0]);
  eo_law_done(&law[1]);
  return code;
}

static enum eo_code check_responses(void *context, struct eo_case *items, struct eo_error *error)
{
  struct dynamics *dynamics = context;
  enum eo_code code = eo_vibration_new(&dynamics->solver, HARMONICS, SAMPLES, error);
  if (!code)
    code = eo_verify_each(dynamics->v, items, check_response, dynamics, error);
  eo_vibration_free(dynamics->solver);
  return code;
}

static struct eo_sdof read_sdof(struct eo_case *item)
{
  return (struct eo_sdof){.damping = eo_case_number(item, "z"),
                          .mean_force = eo_case_number(item, "Fm"),
                          .alternating_force = eo_case_number(item, "Fh"),
                          .stiffness_share = eo_case_number_or(item, "e", 0),
                          .frequency = eo_case_number(item, "W")};
}

static void compare_single(const struct verified *at, const struct eo_sdof_response *response)
{
  const double second = fmax(1e-3 * response->amplitude[0], at->relative * response->amplitude[1]), of_loss = 1e-3;
  eo_verify_member(at->v, at->expected, "mean", response->mean, of_mean, 0);
  eo_verify_member(at->v, at->expected, "rms", response->rms, at->relative, 0);
  eo_verify_member(at->v, at->expected, "pp", response->peak_to_peak, at->relative, 0);
  eo_verify_member(at->v, at->expected, "h1", response->amplitude[0], at->relative, 0);
  eo_verify_member(at->v, at->expected, "h2", response->amplitude[1], 0, second);
  eo_verify_member(at->v, at->expected, "contact_loss_fraction", response->contact_loss, 0, of_loss);
  eo_verify_member(at->v, at->expected, "max_floquet", response->floquet, of_floquet, 0);
  eo_verify_exact(at->v, eo_case_find(at->expected, "back_contact"), response->back_contact);
}

static enum eo_code check_sdof(void *context, struct eo_case *item, struct eo_error *error)
{
  static const char *const branches[] = {"lo", "hi", NULL};
  const struct dynamics *dynamics = context;
  const struct eo_sdof sdof = read_sdof(item);
  struct eo_sdof_response response;
  struct eo_case *state = eo_case_find(item, "x0"), *expected = eo_case_need(item, "expected");
  double x0[2] = {0, 0};
  enum eo_sdof_start start = eo_case_choice(item, "branch", branches, 0) == 1 ? EO_SDOF_HIGH : EO_SDOF_LOW;
  if (state && eo_case_numbers(state, 2, 2, x0) == 2)
    start = EO_SDOF_STATE;
  if (eo_case_faulty(item))
    return EO_OK;
  enum eo_code code = eo_sdof_solve(&sdof, start, x0, &response, error);
  if (code)
    return code;
  const struct verified at = {dynamics->v, expected, fmax(10 * eo_case_number_or(expected, "rel_unc", 0), 1e-4)};
  if (at.relative >= 1)
    eo_case_fault(eo_case_find(expected, "rel_unc"), "An uncertainty is below 0.1.");
  if (response.converged)
    compare_single(&at, &response);
  else
    eo_verify_diverged(dynamics->v, expected);
  return EO_OK;
}

/* The first case called SDOF-FAMILY-... */
static struct eo_case *case_of_family(struct eo_case *cases, const char *family)
{
  char prefix[NAME_LENGTH];
  snprintf(prefix, sizeof prefix, "SDOF-%s-", family);
  for (int i = 0; i < eo_case_size(cases); i++) {
    const char *id = eo_case_word_given(eo_case_at(cases, i), "id");
    if (id && strncmp(id, prefix, strlen(prefix)) == 0)
      return eo_case_at(cases, i);
  }
  return NULL;
}

/* Folds of a family of cases; "up" is where an upward sweep leaves the state without contact loss, "down" where a
   downward sweep falls back to it. */
static enum eo_code check_folds(void *context, struct eo_case *expected, struct eo_error *error)
{
  const struct dynamics *dynamics = context;
  const double slowest = 0.3, fastest = 3, tolerance = 2e-3;
  struct eo_case *item = case_of_family(eo_case_find(eo_case_find(dynamics->file, "sdof"), "cases"),
                                        eo_case_key(expected));
  if (!item) {
    eo_case_fault(expected, "No case belongs to these folds.");
    return EO_OK;
  }
  const struct eo_sdof model = read_sdof(item);
  struct eo_sdof_folds folds;
  enum eo_code code = eo_sdof_folds(&model, slowest, fastest, &folds, error);
  if (code)
    return code;
  int down = 0;
  while (down < folds.count && folds.going_up[down])
    down++;
  eo_verify_member(dynamics->v, expected, "up", folds.contact_lost, 0, tolerance);
  eo_verify_member(dynamics->v, expected, "down", down < folds.count ? folds.frequency[down] : NAN, 0, tolerance);
  return EO_OK;
}

static enum eo_code check_single(void *context, struct eo_case *block, struct eo_error *error)
{
  struct dynamics *dynamics = context;
  eo_case_remark(block, "equation");
  eo_case_remark(block, "analytic_A");
  enum eo_code code = eo_verify_each(dynamics->v, eo_case_find(block, "cases"), check_sdof, dynamics, error);
  return code ? code : eo_verify_each(dynamics->v, eo_case_find(block, "folds"), check_folds, dynamics, error);
}

static const struct eo_verify_block blocks[] = {
    {"geometry", EO_BLOCK_EITHER, check_geometry},
    {"defaults", EO_BLOCK_EITHER, check_defaults},
    {"inertia_assumption", EO_BLOCK_REMARKS, NULL},
    {"torsional_coupling", EO_BLOCK_EITHER, check_coupling},
    {"law_*", EO_BLOCK_EITHER, check_law},
    {"table_*", EO_BLOCK_EITHER, check_law},
    {"eigen", EO_BLOCK_EACH, check_modes},
    {"negative_control_literal_signs", EO_BLOCK_WHOLE, check_printed_signs},
    {"dynamics", EO_BLOCK_WHOLE, check_responses},
    {"sdof", EO_BLOCK_WHOLE, check_single},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_dynamics(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  enum { USUAL_TEETH = 17 };
  struct eo_case *geometry = eo_case_find(file, "geometry");
  struct dynamics dynamics = {.file = file,
                              .v = verification,
                              .teeth = geometry ? eo_case_whole(geometry, "z1", 1, LARGEST_TEETH) : USUAL_TEETH};
  return eo_verify_blocks(verification, file, blocks, &dynamics, error);
}
