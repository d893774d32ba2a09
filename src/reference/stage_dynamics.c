/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/stage.h"
#include "reference/stage_input.h"
#include "reference/stage_law.h"
#include "dynamics/vibration.h"

struct explicit_parameters {
  struct eo_dynamics_parameters of;
  double half_backlash, float_position;
  int fixed;
};

struct input {
  struct eo_design design;
  int has_pair, has_parameters, has_right_law, has_impact;
  struct explicit_parameters parameters;
  struct eo_stage_law law, right_law;
  double torque, speed;
  int pinion_teeth;
  double stagger;
  bool gated;
  struct impact {
    enum eo_impact_in_dynamics mode;
    double force[2], start[2], duration[2];
  } impact;
  struct eo_numbers axial_cosine, axial_sine;
  int harmonics;
  enum eo_solver solver;
};

#define SI(member_, key_, low_, high_, help_) \
  EO_NUMBER_REQUIRED(struct explicit_parameters, of.member_, key_, NULL, low_, high_, help_)
#define SI_OR(member_, key_, low_, high_, default_, help_) \
  EO_NUMBER(struct explicit_parameters, of.member_, key_, NULL, low_, high_, default_, help_)

static const struct eo_field parameters[] = {
    EO_INTEGER(struct explicit_parameters, of.ends, "ends", 1, 2, 2,
               "2: herringbone, 12 degrees of freedom; 1: single helical or spur, 6"),
    SI(base_radius[0], "Rp", 1e-4, 100, "base radius of the pinion, m"),
    SI(base_radius[1], "Rg", 1e-4, 100, "base radius of the gear, m"),
    SI(base_helix_angle, "beta", 0, 1.2, "base helix angle, rad"),
    SI_OR(right_base_helix_angle, "beta_right", 0, 1.2, 0,
          "of the right end where it differs, rad; 0: as the left one"),
    SI(mass[0], "mp", 1e-6, 1e7, "mass of one end of the pinion, kg"),
    SI(mass[1], "mg", 1e-6, 1e7, "of the gear, kg"),
    SI(inertia[0], "Ip", 1e-12, 1e8, "inertia of one end of the pinion, kg m2"),
    SI(inertia[1], "Ig", 1e-12, 1e8, "of the gear, kg m2"),
    SI(bearing_stiffness[0], "kpy", 1, 1e15, "transverse bearing stiffness of one end of the pinion, N/m"),
    SI(bearing_stiffness[1], "kgy", 1, 1e15, "of the gear, N/m"),
    SI(gear_axial_stiffness[0], "kg1z", 1, 1e15, "axial bearing stiffness at the gear's left end, N/m"),
    SI(gear_axial_stiffness[1], "kg2z", 1, 1e15, "at its right end, N/m"),
    SI(groove_axial_stiffness[0], "kpz", 1, 1e21, "between the pinion's ends (one end: to the ground), N/m"),
    SI(groove_axial_stiffness[1], "kgz", 1, 1e21, "between the gear's ends, N/m"),
    SI_OR(groove_torsional_stiffness[0], "kt_p", 0, 1e20, 0, "torsion between the pinion's ends, N m/rad"),
    SI_OR(groove_torsional_stiffness[1], "kt_g", 0, 1e20, 0, "between the gear's ends, N m/rad"),
    SI_OR(bearing_damping[0], "cpy", 0, 1e12, 0, "N s/m"),
    SI_OR(bearing_damping[1], "cgy", 0, 1e12, 0, "N s/m"),
    SI_OR(gear_axial_damping[0], "cg1z", 0, 1e12, 0, "N s/m"),
    SI_OR(gear_axial_damping[1], "cg2z", 0, 1e12, 0, "N s/m"),
    SI_OR(groove_axial_damping[0], "cpz", 0, 1e12, 0, "N s/m"),
    SI_OR(groove_axial_damping[1], "cgz", 0, 1e12, 0, "N s/m"),
    SI_OR(groove_torsional_damping[0], "ct_p", 0, 1e12, 0, "N m s/rad"),
    SI_OR(groove_torsional_damping[1], "ct_g", 0, 1e12, 0, "N m s/rad"),
    SI_OR(pinion_axial_stiffness, "ka", 0, 1e15, 0,
          "from the pinion's mean axial motion to the ground, N/m; 0: floating"),
    SI_OR(pinion_axial_damping, "ca", 0, 1e12, 0, "N s/m"),
    EO_FLAG(struct explicit_parameters, fixed, "axially_fixed", 0, "ka is infinite"),
    SI_OR(machine_inertia[0], "Jd", 0, 1e12, 0, "inertia of the driver, kg m2; 0: none"),
    SI_OR(machine_inertia[1], "Jl", 0, 1e12, 0, "of the load, kg m2"),
    SI_OR(machine_stiffness[0], "kt_d", 0, 1e20, 0, "torsion between driver and pinion, N m/rad"),
    SI_OR(machine_stiffness[1], "kt_l", 0, 1e20, 0, "between gear and load, N m/rad"),
    SI_OR(machine_damping[0], "ct_d", 0, 1e12, 0, "N m s/rad"),
    SI_OR(machine_damping[1], "ct_l", 0, 1e12, 0, "N m s/rad"),
    SI_OR(mesh_damping, "cm", 0, 1e12, 0, "mesh damping of one end along the normal, N s/m"),
    EO_NUMBER(struct explicit_parameters, half_backlash, "tau", NULL, 1e-9, 1, 5e-5, "half the normal backlash, m"),
    EO_NUMBER(struct explicit_parameters, float_position, "eps_z", NULL, -1, 1, 0,
              "constant axial float, m: drops out"),
};
static const struct eo_table parameters_table = EO_TABLE("parameters", struct explicit_parameters, parameters);

static const char *const modes[] = {"none", "paper", "consistent", NULL};
static const char *const solvers[] = {"harmonic_balance", "time_integration", NULL};
static const double at_once[2] = {0, 0};

static const struct eo_field impact[] = {
    EO_CHOICE(struct impact, mode, "mode", modes, EO_IMPACT_CONSISTENT,
              "on the rotations alone, or with the mesh force's direction"),
    EO_NUMBERS(struct impact, force, "force_N", 2, &eo_unit_N, 0, 1e12, EO_FIELD_REQUIRED, NULL, NULL,
               "[left, right] height of the half sine, along the transverse line of action"),
    EO_NUMBERS(struct impact, start, "start", 2, NULL, 0, 1, 0, at_once, NULL, "[left, right] phase of the mesh cycle"),
    EO_NUMBERS(struct impact, duration, "duration", 2, NULL, 1e-6, 1, EO_FIELD_REQUIRED, NULL, NULL,
               "[left, right] in mesh periods"),
};
static const struct eo_table impact_table = EO_TABLE("impact", struct impact, impact);

static const struct eo_field input[] = {
    EO_OPTIONAL(struct input, design.gear_pair, has_pair, "gear_pair", &eo_gear_pair_table, "params are needed",
                "as in a design document: the parameters are derived from it"),
    EO_OBJECT(struct input, design.material, "material", &eo_material_table, "with gear_pair, as in a design document"),
    EO_OBJECT(
        struct input, design.alignment, "alignment", &eo_alignment_table,
        "with gear_pair, as in a design document: how the pinion is held along its axis; the laws contain the rest"),
    EO_OBJECT(struct input, design.supports, "supports", &eo_supports_table,
              "with gear_pair, as in a design document; ends differ when law_right is given"),
    EO_OPTIONAL(struct input, parameters, has_parameters, "params", &parameters_table, "derived from gear_pair",
                "the parameters themselves, in SI"),
    EO_OBJECT(struct input, law, "law", &eo_stage_law_table, "mesh law of both ends, or of the left one"),
    EO_OPTIONAL(struct input, right_law, has_right_law, "law_right", &eo_stage_law_table, "as law",
                "mesh law of the right end"),
    EO_NUMBER_REQUIRED(struct input, torque, "torque_Nm", &eo_unit_Nm, 1e-3, 1e8, "total on the pinion"),
    EO_NUMBER_REQUIRED(struct input, speed, "speed_rpm", &eo_unit_rpm, 0.1, 1e6, "of the pinion"),
    EO_INTEGER_DERIVED(struct input, pinion_teeth, "pinion_teeth", 1, 2000, "of gear_pair",
                       "mesh cycles per turn; needed with params"),
    EO_NUMBER(struct input, stagger, "stagger", NULL, -1, 1, 0, "right end behind the left, in mesh cycles"),
    EO_FLAG(struct input, gated, "damping_in_contact_only", 1, "no mesh damping while the teeth are apart"),
    EO_OPTIONAL(struct input, impact, has_impact, "impact", &impact_table, "none", "entering impacts"),
    EO_SERIES(struct input, axial_cosine, "axial_float_cosine_um", &eo_unit_um, EO_MAX_HARMONICS, -1e6, 1e6, 0,
              "prescribed axial float of the pinion: coefficients of cos(2 pi n phi)"),
    EO_SERIES(struct input, axial_sine, "axial_float_sine_um", &eo_unit_um, EO_MAX_HARMONICS, -1e6, 1e6, 0,
              "of sin(2 pi n phi)"),
    EO_INTEGER(struct input, harmonics, "harmonics", 1, EO_MAX_HARMONICS, 24, "mesh harmonics of the response"),
    EO_CHOICE(struct input, solver, "solver", solvers, EO_SOLVER_HARMONIC_BALANCE, "of the equations of motion"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

struct spectrum {
  struct eo_numbers deflection_real, deflection_imaginary, acceleration;
};

struct output {
  struct explicit_parameters parameters;
  struct eo_vibration r;
  enum eo_vibration_outcome outcome;
  int two;
  struct spectrum left, right;
  int repeat, states;
  struct eo_vibration_state state[EO_MAX_STATES];
  double stiffness[2], multiplier, unstable;
  struct eo_numbers frequency, damping_ratio;
  struct eo_numbers freedom_rms;
};

static const struct eo_field readings[] = {
    EO_OUT_PAIR(struct eo_vibration, rms[EO_READING_NORMAL], "normal", &eo_unit_m_per_s2, "[left, right] X\""),
    EO_OUT_PAIR(struct eo_vibration, rms[EO_READING_TRANSVERSE], "transverse", &eo_unit_m_per_s2,
                "[left, right] with the motion of the bearings"),
    EO_OUT_PAIR(struct eo_vibration, rms[EO_READING_ROTATIONAL], "rotational", &eo_unit_m_per_s2,
                "[left, right] what encoders see"),
};
static const struct eo_table readings_table = EO_TABLE("accelerations", struct eo_vibration, readings);

static const struct eo_field pair_readings[] = {
    EO_OUT(struct eo_vibration, rms_pair[EO_READING_NORMAL], "normal", &eo_unit_m_per_s2, "mean of the ends' RMS"),
    EO_OUT(struct eo_vibration, rms_pair[EO_READING_TRANSVERSE], "transverse", &eo_unit_m_per_s2,
           "mean of the ends' RMS"),
    EO_OUT(struct eo_vibration, rms_pair[EO_READING_ROTATIONAL], "rotational", &eo_unit_m_per_s2,
           "mean of the ends' RMS"),
    EO_OUT(struct eo_vibration, rms_of_mean[EO_READING_NORMAL], "normal_of_mean", &eo_unit_m_per_s2,
           "RMS of the ends' mean"),
};
static const struct eo_table pair_readings_table = EO_TABLE("accelerations of the pair", struct eo_vibration,
                                                            pair_readings);

static const struct eo_field spectrum[] = {
    EO_OUT_SERIES(struct spectrum, deflection_real, "deflection_real_um", &eo_unit_um,
                  "X = mean + Re sum X_n exp(2 pi i n phi), n = 1..: real parts"),
    EO_OUT_SERIES(struct spectrum, deflection_imaginary, "deflection_imaginary_um", &eo_unit_um, "imaginary parts"),
    EO_OUT_SERIES(struct spectrum, acceleration, "acceleration_m_per_s2", &eo_unit_m_per_s2, "amplitudes of X\""),
};
static const struct eo_table spectrum_table = EO_TABLE("harmonics", struct spectrum, spectrum);

static const char *const outcomes[] = {"converged", "contact_lost", "not_converged", NULL};

static const struct eo_field state_rms[] = {
    EO_OUT(struct eo_vibration_state, rms[EO_READING_NORMAL], "normal", &eo_unit_m_per_s2, "along the normal"),
    EO_OUT(struct eo_vibration_state, rms[EO_READING_TRANSVERSE], "transverse", &eo_unit_m_per_s2,
           "along the line of action"),
    EO_OUT(struct eo_vibration_state, rms[EO_READING_ROTATIONAL], "rotational", &eo_unit_m_per_s2,
           "of the rotations, on the base circles"),
};
static const struct eo_table state_rms_table = EO_TABLE("RMS of a state", struct eo_vibration_state, state_rms);

static const struct eo_field state_fields[] = {
    EO_INTEGER(struct eo_vibration_state, repeat, "mesh_periods", 1, 4, 1, "after which the motion repeats"),
    EO_GROUP("rms_m_per_s2", &state_rms_table, "RMS of the pair"),
    EO_OUT(struct eo_vibration_state, contact_loss, "contact_loss", NULL, "share of the cycle, worse end"),
    EO_NUMBER_DERIVED(struct eo_vibration_state, multiplier, "largest_multiplier", NULL, -INFINITY, INFINITY,
                      "not computed", "size of the largest Floquet multiplier"),
};
static const struct eo_table state_table = EO_TABLE("a stable state", struct eo_vibration_state, state_fields);

static const struct eo_field output[] = {
    EO_CHOICE(struct output, outcome, "outcome", outcomes, 0,
              "not_converged: no stable periodic state was found, and its numbers are 0"),
    EO_OBJECT(struct output, r, "rms_m_per_s2", &readings_table, "accelerations over a mesh period"),
    EO_OBJECT(struct output, r, "rms_pair_m_per_s2", &pair_readings_table, "of the pair"),
    EO_OUT_PAIR(struct output, r.deflection_mean, "deflection_mean_um", &eo_unit_um,
                "[left, right] X, along the normal"),
    EO_OUT_PAIR(struct output, r.deflection_swing, "deflection_swing_um", &eo_unit_um, "[left, right] peak to peak"),
    EO_OUT_PAIR(struct output, r.force_mean, "mesh_force_mean_N", &eo_unit_N, "[left, right] normal, damping included"),
    EO_OUT_PAIR(struct output, r.force_min, "mesh_force_min_N", &eo_unit_N, "[left, right]"),
    EO_OUT_PAIR(struct output, r.force_max, "mesh_force_max_N", &eo_unit_N, "[left, right]"),
    EO_OUT_PAIR(struct output, r.dynamic_factor, "dynamic_factor", NULL, "[left, right] largest over mean mesh force"),
    EO_OUT_PAIR(struct output, r.contact_loss, "contact_loss", NULL, "[left, right] share of the cycle out of contact"),
    EO_FLAG(struct output, r.back_contact, "back_contact", 0, "back flanks touch"),
    EO_OUT_PAIR(struct output, r.bearing_force_max[0], "pinion_bearing_force_max_N", &eo_unit_N,
                "[left, right] radial"),
    EO_OUT_PAIR(struct output, r.bearing_force_max[1], "gear_bearing_force_max_N", &eo_unit_N, "[left, right] radial"),
    EO_OUT_SERIES(
        struct output, freedom_rms, "freedom_rms", NULL,
        "accelerations of y, z (m/s2) and theta (rad/s2): pinion left, right, gear left, right; then theta of "
        "driver and load where there are any"),
    EO_OBJECT(struct output, left, "left", &spectrum_table, "harmonics of the left end"),
    EO_OPTIONAL(struct output, right, two, "right", &spectrum_table, "the pair has one end", "of the right end"),
    EO_OUT(struct output, r.residual, "residual", NULL,
           "of the force balance over the load; of time integration: change over the last period"),
    EO_OUT(struct output, r.power_supplied, "power_supplied_W", NULL, "by the varying mesh to the vibration"),
    EO_OUT(struct output, r.power_dissipated, "power_dissipated_W", NULL, "in mesh, bearings and groove"),
    EO_INTEGER(struct output, repeat, "mesh_periods", 0, 4, 1, "after which the motion repeats"),
    EO_NUMBER_DERIVED(struct output, multiplier, "largest_multiplier", NULL, -INFINITY, INFINITY, "not computed",
                      "size of the largest Floquet multiplier: stable below 1"),
    EO_NUMBER_DERIVED(struct output, unstable, "unstable_multiplier", NULL, -INFINITY, INFINITY, "there was none",
                      "of a periodic state that was left because a disturbance of it grows"),
    EO_LIST(struct output, state, states, "stable_states", &state_table, 0, EO_MAX_STATES,
            "found where contact is lost, the loudest first: the numbers above are its own"),
    EO_OUT(struct output, r.pinion_thrust_mean, "pinion_thrust_mean_N", &eo_unit_N,
           "of the pinion's axial support, + to the right"),
    EO_OUT(struct output, r.pinion_thrust_max, "pinion_thrust_max_N", &eo_unit_N, "largest size of it"),
    EO_OUT_PAIR(struct output, stiffness, "mean_stiffness_N_per_um", &eo_unit_N_per_um,
                "[left, right] dF/dX under the load, mean over the cycle"),
    EO_OUT_SERIES(struct output, frequency, "eigenfrequencies_Hz", &eo_unit_Hz,
                  "undamped, with the mean stiffness; rigid motions left out"),
    EO_OUT_SERIES(struct output, damping_ratio, "damping_ratios", NULL, "of the same modes"),
    EO_OBJECT(struct output, parameters, "params", &parameters_table, "the parameters used, SI"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

/* A vibration problem under construction. */
struct problem {
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_law law[2];
  struct eo_vibration_case load;
  double axial[1 + 2 * EO_MAX_HARMONICS];
};

static enum eo_code check_source(const struct input *given, struct eo_error *error)
{
  if (!given->has_parameters && !given->has_pair)
    return eo_error_set(error, EO_ERROR_INPUT, "/params", "Either params or gear_pair is needed.");
  if (given->has_parameters && given->has_pair)
    return eo_error_set(error, EO_ERROR_INPUT, "/params",
                        "Parameters are given by params or by gear_pair, not by both.");
  if (!given->pinion_teeth && !given->has_pair)
    return eo_error_set(error, EO_ERROR_INPUT, "/pinion_teeth",
                        "With params the number of teeth is needed: it makes the mesh frequency.");
  return EO_OK;
}

/* load: [end]. */
static enum eo_code make_laws(struct problem *problem, const struct input *given, const double load[2], double backlash,
                              double stiffness[2], struct eo_error *error)
{
  enum eo_code code = eo_stage_law_make(&problem->law[0], &given->law, load[0], backlash, "/law", error);
  if (!code && (given->has_right_law || load[1] != load[0]))
    code = eo_stage_law_make(&problem->law[1], given->has_right_law ? &given->right_law : &given->law, load[1],
                             backlash, "/law_right", error);
  else if (!code)
    code = eo_law_copy(&problem->law[1], &problem->law[0], error);
  for (int end = 0; end < 2 && !code; end++)
    stiffness[end] = eo_stage_law_stiffness(&problem->law[end], load[end]);
  return code;
}

/* Laws and parameters, given or derived. */
static enum eo_code make_model(struct problem *problem, const struct input *given, struct output *found,
                               struct eo_error *error)
{
  struct explicit_parameters *explicit_parameters = &found->parameters;
  enum eo_code code = EO_OK;
  double load[2];
  if (given->has_parameters) {
    *explicit_parameters = given->parameters;
    if (explicit_parameters->fixed)
      explicit_parameters->of.pinion_axial_stiffness = INFINITY;
    for (int end = 0; end < 2; end++)
      load[end] = eo_dynamics_mesh_load(&explicit_parameters->of, given->torque, end);
    return make_laws(problem, given, load, 2 * explicit_parameters->half_backlash, found->stiffness, error);
  }
  problem->design = given->design;
  code = eo_design_complete(&problem->design, &problem->geometry, error);
  if (code)
    return code;
  int ends = problem->design.gear_pair.ends;
  const struct eo_dynamics_parameters helices = {
      .ends = ends,
      .base_radius = {problem->geometry.base_radius[0], problem->geometry.base_radius[1]},
      .base_helix_angle = problem->geometry.base_helix_angle,
      .right_base_helix_angle = problem->design.supports.right_base_helix_angle};
  for (int end = 0; end < 2; end++)
    load[end] = eo_dynamics_mesh_load(&helices, given->torque, end);
  explicit_parameters->half_backlash = problem->design.gear_pair.backlash / 2;
  code = make_laws(problem, given, load, problem->design.gear_pair.backlash, found->stiffness, error);
  double mean = ends == 2 ? (found->stiffness[0] + found->stiffness[1]) / 2 : found->stiffness[0];
  return code ? code
              : eo_dynamics_parameters_init(&explicit_parameters->of, &problem->geometry, ends,
                                            eo_alignment_axial_stiffness(&problem->design.alignment),
                                            &problem->design.supports, given->has_right_law, mean, error);
}

static void make_load(struct problem *problem, const struct input *given)
{
  int cosines = given->axial_cosine.count, sines = given->axial_sine.count;
  problem->load = (struct eo_vibration_case){
      .torque = given->torque,
      .speed = given->speed,
      .pinion_teeth = given->pinion_teeth ? given->pinion_teeth : given->design.gear_pair.teeth[EO_PINION],
      .law = {&problem->law[0], &problem->law[1]},
      .phase_right = -given->stagger,
      .gated = given->gated,
      .axial_order = cosines > sines ? cosines : sines,
      .axial_motion = problem->axial};
  for (int n = 0; n < cosines; n++)
    problem->axial[2 * n + 1] = given->axial_cosine.value[n];
  for (int n = 0; n < sines; n++)
    problem->axial[2 * n + 2] = given->axial_sine.value[n];
  if (!given->has_impact)
    return;
  problem->load.impact = given->impact.mode;
  for (int end = 0; end < 2; end++)
    problem->load.pulse[end] = (struct eo_pulse){EO_PULSE_HALF_SINE, given->impact.force[end], given->impact.start[end],
                                                 given->impact.duration[end]};
}

static enum eo_code read_spectrum(struct spectrum *out, const struct eo_vibration_solver *solver, int end,
                                  struct eo_error *error)
{
  const struct eo_spectrum *this_spectrum = eo_vibration_spectrum(solver);
  enum eo_code code = eo_stage_columns(3, &out->deflection_real, this_spectrum->harmonics, error);
  for (int n = 0; n < this_spectrum->harmonics && !code; n++) {
    double complex x = this_spectrum->deflection[end][n + 1];
    out->deflection_real.value[n] = creal(x);
    out->deflection_imaginary.value[n] = cimag(x);
    out->acceleration.value[n] = cabs(x) * pow((n + 1) * this_spectrum->frequency, 2);
  }
  return code;
}

static enum eo_code read_modes(struct output *found, const struct eo_dynamics_model *model, struct eo_error *error)
{
  struct eo_dynamics_modes dynamics_modes;
  enum eo_code code = eo_dynamics_model_modes(model, found->stiffness, &dynamics_modes, error);
  if (!code)
    code = eo_stage_copy(&found->frequency, dynamics_modes.n, dynamics_modes.frequency, error);
  return code ? code : eo_stage_copy(&found->damping_ratio, dynamics_modes.n, dynamics_modes.damping_ratio, error);
}

static enum eo_code solve(struct problem *problem, const struct input *given, struct eo_vibration_solver *solver,
                          struct output *found, struct eo_error *error)
{
  bool integrate = given->solver == EO_SOLVER_TIME_INTEGRATION;
  enum eo_code code = eo_vibration_set_model(solver, &found->parameters.of, error);
  if (!code)
    code = integrate ? eo_vibration_settle_integrated(solver, &problem->load, &found->r, error)
                     : eo_vibration_settle(solver, &problem->load, &found->r, error);
  if (code)
    return code;
  found->outcome = found->r.outcome;
  found->two = found->r.ends == 2;
  found->repeat = found->r.repeat;
  found->multiplier = found->r.multiplier;
  found->unstable = found->r.unstable > 0 ? found->r.unstable : NAN;
  found->states = found->r.states;
  memcpy(found->state, found->r.state, sizeof found->state);
  for (int end = 0; end < found->r.ends && !code; end++)
    code = read_spectrum(end ? &found->right : &found->left, solver, end, error);
  if (!code)
    code = eo_stage_copy(&found->freedom_rms, eo_vibration_model(solver)->freedoms, found->r.freedom_rms, error);
  return code ? code : read_modes(found, eo_vibration_model(solver), error);
}

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  struct eo_vibration_solver *solver = NULL;
  enum eo_code code = check_source(given, error);
  if (code)
    return code;
  struct problem *problem = calloc(1, sizeof *problem);
  code = problem ? make_model(problem, given, found, error) : eo_error_memory(error);
  if (!code)
    code = eo_vibration_new(&solver, given->harmonics, 0, error);
  if (!code) {
    make_load(problem, given);
    code = solve(problem, given, solver, found, error);
  }
  if (isinf(found->parameters.of.pinion_axial_stiffness)) { /* the output says it with the flag */
    found->parameters.fixed = 1;
    found->parameters.of.pinion_axial_stiffness = 0;
  }
  eo_vibration_free(solver);
  for (int end = 0; problem && end < 2; end++)
    eo_law_done(&problem->law[end]);
  free(problem);
  return code;
}

const struct eo_stage eo_stage_dynamics = {
    .name = "dynamics",
    .summary = "the periodic vibration of the lumped model under given mesh laws",
    .input = &input_table,
    .output = &output_table,
    .has_design = true,
    .run = run};
