/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/parameters.h"

#include <math.h>
#include <stdio.h>

/* One row per number to be checked: its key in the design's supports (of what it follows from, if it has none itself),
   what people call it, and what it must be. */
struct rule {
  const char *key, *name;
  double value;
  enum {
    NOT_NEGATIVE,
    POSITIVE,
    SPRING,
    SUPPORT
  } kind; /* SPRING: not negative, may be rigid; SUPPORT: also positive */
};

static enum eo_code check_rules(int n, const struct rule *rule, struct eo_error *error)
{
  for (int i = 0; i < n; i++) {
    char pointer[sizeof error->pointer];
    bool positive = rule[i].kind == POSITIVE || rule[i].kind == SUPPORT, rigid = rule[i].kind >= SPRING;
    if (!isnan(rule[i].value) && (!isinf(rule[i].value) || rigid) && rule[i].value >= 0 &&
        (!positive || rule[i].value > 0))
      continue;
    snprintf(pointer, sizeof pointer, "/supports/%s", rule[i].key);
    return eo_error_set(error, EO_ERROR_INPUT, pointer, "The %s must be a finite %s number, not %g.", rule[i].name,
                        positive ? "positive" : "non-negative", rule[i].value);
  }
  return EO_OK;
}

static enum eo_code check_dampers(const struct eo_dynamics_parameters *parameters, struct eo_error *error)
{
  static const char *const torsional[2] = {"/supports/pinion_groove_torsional_stiffness_Nm_per_rad",
                                           "/supports/gear_groove_torsional_stiffness_Nm_per_rad"};
  for (int m = 0; m < 2; m++)
    if (parameters->groove_torsional_stiffness[m] == 0 && parameters->groove_torsional_damping[m] > 0)
      return eo_error_set(error, EO_ERROR_INPUT, torsional[m], "A torsional damper between the ends needs its spring.");
  return EO_OK;
}

/* A machine and its spring come together; without a spring it would not be there, without inertia it would be a wall.
 */
static enum eo_code check_machines(const struct eo_dynamics_parameters *parameters, struct eo_error *error)
{
  static const char *const inertia[2] = {"/supports/driver_inertia_kg_m2", "/supports/load_inertia_kg_m2"},
                           *const stiffness[2] = {"/supports/driver_stiffness_Nm_per_rad",
                                                  "/supports/load_stiffness_Nm_per_rad"},
                           *const name[2] = {"driver", "load"};
  for (int m = 0; m < 2; m++) {
    if (parameters->machine_inertia[m] > 0 && parameters->machine_stiffness[m] == 0)
      return eo_error_set(error, EO_ERROR_INPUT, stiffness[m],
                          "The inertia of the %s needs the torsional stiffness between it and the gear pair.", name[m]);
    if (parameters->machine_inertia[m] == 0 && parameters->machine_stiffness[m] > 0)
      return eo_error_set(error, EO_ERROR_INPUT, inertia[m],
                          "The torsional stiffness towards the %s needs the inertia of the %s.", name[m], name[m]);
  }
  if (parameters->pinion_axial_stiffness == 0 && parameters->pinion_axial_damping > 0)
    return eo_error_set(error, EO_ERROR_INPUT, "/alignment/pinion_axial",
                        "An axial damper on the pinion needs its spring.");
  return EO_OK;
}

enum eo_code eo_dynamics_parameters_check(const struct eo_dynamics_parameters *parameters, struct eo_error *error)
{
  if (parameters->ends != 1 && parameters->ends != 2)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/ends", "A gear has one or two ends, not %d.",
                        parameters->ends);
  if (!(parameters->base_radius[0] > 0 && parameters->base_radius[1] > 0 &&
        isfinite(parameters->base_radius[0] + parameters->base_radius[1])) ||
      !(fabs(parameters->base_helix_angle) < 1.5))
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair",
                        "Base radii %g and %g m with a base helix angle of %g rad make no gear pair.",
                        parameters->base_radius[0], parameters->base_radius[1], parameters->base_helix_angle);
  const struct rule rule[] = {
      {"pinion_mass_kg", "mass of the pinion", parameters->mass[0], POSITIVE},
      {"gear_mass_kg", "mass of the gear", parameters->mass[1], POSITIVE},
      {"pinion_inertia_kg_m2", "inertia of the pinion", parameters->inertia[0], POSITIVE},
      {"gear_inertia_kg_m2", "inertia of the gear", parameters->inertia[1], POSITIVE},
      {"pinion_bearing_stiffness_N_per_um", "pinion's bearing stiffness", parameters->bearing_stiffness[0], SUPPORT},
      {"gear_bearing_stiffness_N_per_um", "gear's bearing stiffness", parameters->bearing_stiffness[1], SUPPORT},
      {"bearing_damping_ratio", "pinion's bearing damping", parameters->bearing_damping[0], NOT_NEGATIVE},
      {"bearing_damping_ratio", "gear's bearing damping", parameters->bearing_damping[1], NOT_NEGATIVE},
      {"gear_axial_stiffness_left_N_per_um", "gear's axial stiffness on the left", parameters->gear_axial_stiffness[0],
       SUPPORT},
      {"bearing_damping_ratio", "gear's axial damping on the left", parameters->gear_axial_damping[0], NOT_NEGATIVE},
      {"pinion_groove_axial_stiffness_N_per_um", "pinion's axial stiffness", parameters->groove_axial_stiffness[0],
       POSITIVE},
      {"groove_damping_ratio", "pinion's axial damping", parameters->groove_axial_damping[0], NOT_NEGATIVE},
      {"mesh_damping_ratio", "mesh damping", parameters->mesh_damping, NOT_NEGATIVE},
      {"pinion_axial_stiffness_N_per_um", "stiffness of the pinion's axial bearing", parameters->pinion_axial_stiffness,
       SPRING},
      {"bearing_damping_ratio", "damping of the pinion's axial bearing", parameters->pinion_axial_damping,
       NOT_NEGATIVE},
      {"driver_inertia_kg_m2", "inertia of the driver", parameters->machine_inertia[0], NOT_NEGATIVE},
      {"load_inertia_kg_m2", "inertia of the load", parameters->machine_inertia[1], NOT_NEGATIVE},
      {"driver_stiffness_Nm_per_rad", "torsional stiffness towards the driver", parameters->machine_stiffness[0],
       NOT_NEGATIVE},
      {"load_stiffness_Nm_per_rad", "torsional stiffness towards the load", parameters->machine_stiffness[1],
       NOT_NEGATIVE},
      {"machine_damping_ratio", "torsional damping towards the driver", parameters->machine_damping[0], NOT_NEGATIVE},
      {"machine_damping_ratio", "torsional damping towards the load", parameters->machine_damping[1], NOT_NEGATIVE},
      /* from here on with two ends only */
      {"gear_axial_stiffness_right_N_per_um", "gear's axial stiffness on the right",
       parameters->gear_axial_stiffness[1], SUPPORT},
      {"bearing_damping_ratio", "gear's axial damping on the right", parameters->gear_axial_damping[1], NOT_NEGATIVE},
      {"gear_groove_axial_stiffness_N_per_um", "axial stiffness of the gear's groove",
       parameters->groove_axial_stiffness[1], POSITIVE},
      {"groove_damping_ratio", "axial damping of the gear's groove", parameters->groove_axial_damping[1], NOT_NEGATIVE},
      {"pinion_groove_torsional_stiffness_Nm_per_rad", "torsional stiffness of the pinion's groove",
       parameters->groove_torsional_stiffness[0], SPRING},
      {"gear_groove_torsional_stiffness_Nm_per_rad", "torsional stiffness of the gear's groove",
       parameters->groove_torsional_stiffness[1], SPRING},
      {"groove_damping_ratio", "torsional damping of the pinion's groove", parameters->groove_torsional_damping[0],
       NOT_NEGATIVE},
      {"groove_damping_ratio", "torsional damping of the gear's groove", parameters->groove_torsional_damping[1],
       NOT_NEGATIVE},
  };
  int all = sizeof rule / sizeof *rule;
  enum eo_code code = check_rules(parameters->ends == 2 ? all : all - 8, rule, error);
  if (!code)
    code = check_machines(parameters, error);
  return code || parameters->ends == 1 ? code : check_dampers(parameters, error);
}

/* Of one end; of ends that differ the mean. */
static double mean_end(double left, double right)
{
  return right > 0 ? (left + right) / 2 : left;
}

static double mean_mass(const struct eo_dynamics_parameters *parameters, int member)
{
  return mean_end(parameters->mass[member], parameters->right_mass[member]);
}

static double mean_inertia(const struct eo_dynamics_parameters *parameters, int member)
{
  return mean_end(parameters->inertia[member], parameters->right_inertia[member]);
}

double eo_dynamics_equivalent_mass(const struct eo_dynamics_parameters *parameters)
{
  const double *r = parameters->base_radius,
               j[2] = {mean_inertia(parameters, EO_PINION), mean_inertia(parameters, EO_GEAR)};
  return j[0] * j[1] / (j[0] * r[1] * r[1] + j[1] * r[0] * r[0]);
}

/* c_m = 2 zeta sqrt(k m_e) / cos(beta_b), N s/m, k normal; 1/cos(beta_b) of ends that differ: the mean. */
static double mesh_damping(const struct eo_dynamics_parameters *parameters, double damping_ratio, double stiffness)
{
  double left = cos(parameters->base_helix_angle), right = cos(eo_dynamics_base_helix_angle(parameters, EO_RIGHT));
  /* theory (D3) */
  return 2 * damping_ratio * sqrt(stiffness * eo_dynamics_equivalent_mass(parameters)) /
         (left == right ? left : 2 / (1 / left + 1 / right));
}

double eo_dynamics_base_helix_angle(const struct eo_dynamics_parameters *parameters, int end)
{
  return end == EO_RIGHT && parameters->ends == 2 && parameters->right_base_helix_angle > 0
             ? parameters->right_base_helix_angle
             : parameters->base_helix_angle;
}

struct eo_double_helix eo_dynamics_double_helix(const struct eo_dynamics_parameters *parameters)
{
  return eo_double_helix_of(parameters->base_helix_angle, eo_dynamics_base_helix_angle(parameters, EO_RIGHT));
}

double eo_dynamics_mesh_load(const struct eo_dynamics_parameters *parameters, double torque, int end)
{
  const struct eo_double_helix helix = eo_dynamics_double_helix(parameters);
  double even = torque / (parameters->ends * parameters->base_radius[EO_PINION] * cos(parameters->base_helix_angle));
  return eo_double_helix_load(&helix, end, even);
}

static double or_default(double given, double otherwise)
{
  return isnan(given) ? otherwise : given;
}

/* c = 2 zeta sqrt(k m); none on a rigid support. */
static double damper(double zeta, double stiffness, double mass)
{
  return isinf(stiffness) ? 0 : 2 * zeta * sqrt(stiffness * mass);
}

static void set_bearings(struct eo_dynamics_parameters *parameters, const struct eo_supports *supports)
{
  double zeta = supports->bearing_damping_ratio;
  for (int i = 0; i < 2; i++) {
    parameters->bearing_stiffness[i] = supports->bearing_stiffness[i];
    parameters->bearing_damping[i] = damper(zeta, parameters->bearing_stiffness[i], mean_mass(parameters, i));
    parameters->gear_axial_stiffness[i] = supports->gear_axial_stiffness[i];
    parameters->gear_axial_damping[i] = damper(zeta, parameters->gear_axial_stiffness[i],
                                               mean_mass(parameters, EO_GEAR));
  }
}

/* With one end the pinion's thrust bearing stands where the groove's spring stands with two. */
static enum eo_code set_single_axial(struct eo_dynamics_parameters *parameters, double held,
                                     const struct eo_supports *supports, struct eo_error *error)
{
  double groove = supports->groove_axial_stiffness[EO_PINION];
  if (held > 0 && !isnan(groove))
    return eo_error_set(error, EO_ERROR_INPUT, "/supports/pinion_groove_axial_stiffness_N_per_um",
                        "A pair with one end has no groove; /alignment/pinion_axial already says how the pinion is "
                        "held: leave this key out.");
  parameters->groove_axial_stiffness[EO_PINION] = held > 0 && isfinite(held)
                                                      ? held
                                                      : or_default(groove, parameters->gear_axial_stiffness[0]);
  parameters->groove_axial_damping[EO_PINION] = damper(
      supports->bearing_damping_ratio, parameters->groove_axial_stiffness[EO_PINION], parameters->mass[EO_PINION]);
  parameters->pinion_axial_stiffness = isinf(held) ? held : 0;
  return EO_OK;
}

static void set_pinion_axial(struct eo_dynamics_parameters *parameters, double held, const struct eo_supports *supports)
{
  parameters->pinion_axial_stiffness = held;
  parameters->pinion_axial_damping = damper(supports->bearing_damping_ratio, parameters->pinion_axial_stiffness,
                                            2 * mean_mass(parameters, EO_PINION));
}

static void set_machines(struct eo_dynamics_parameters *parameters, const struct eo_supports *supports)
{
  for (int m = 0; m < 2; m++) {
    double own = parameters->ends * mean_inertia(parameters, m), machine = supports->machine_inertia[m];
    parameters->machine_inertia[m] = machine;
    parameters->machine_stiffness[m] = supports->machine_stiffness[m];
    if (machine > 0)
      parameters->machine_damping[m] = damper(supports->machine_damping_ratio, parameters->machine_stiffness[m],
                                              own * machine / (own + machine));
  }
}

static void set_groove(struct eo_dynamics_parameters *parameters, const struct eo_supports *supports, bool coupled)
{
  double zeta = supports->groove_damping_ratio;
  for (int m = 0; m < 2; m++) {
    parameters->groove_axial_stiffness[m] = supports->groove_axial_stiffness[m];
    parameters->groove_axial_damping[m] = 2 * zeta *
                                          sqrt(parameters->groove_axial_stiffness[m] * mean_mass(parameters, m) / 2);
    if (!coupled)
      continue;
    parameters->groove_torsional_stiffness[m] = supports->groove_torsional_stiffness[m];
    parameters->groove_torsional_damping[m] = damper(zeta, parameters->groove_torsional_stiffness[m],
                                                     mean_inertia(parameters, m) / 2);
  }
}

/* A root is drawn of it; all else that makes no equations is seen in the parameters. */
static enum eo_code check_damping_stiffness(double stiffness, struct eo_error *error)
{
  const struct rule rule = {"mesh_damping_stiffness_N_per_um", "mesh stiffness that sets the mesh damping", stiffness,
                            POSITIVE};
  return check_rules(1, &rule, error);
}

enum eo_code eo_dynamics_parameters_init(struct eo_dynamics_parameters *parameters, const struct eo_geometry *geometry,
                                         int ends, double held, const struct eo_supports *supports, bool ends_differ,
                                         double mean_mesh_stiffness, struct eo_error *error)
{
  double damping_stiffness = or_default(supports->mesh_damping_stiffness, mean_mesh_stiffness);
  enum eo_code code = check_damping_stiffness(damping_stiffness, error);
  if (code)
    return code;
  struct eo_dynamics_parameters dynamics_parameters = {
      .ends = ends,
      .base_helix_angle = geometry->base_helix_angle,
      .right_base_helix_angle = ends == 2 ? supports->right_base_helix_angle : 0};
  dynamics_parameters.base_radius[0] = geometry->base_radius[0];
  dynamics_parameters.base_radius[1] = geometry->base_radius[1];
  for (int m = 0; m < 2; m++) {
    dynamics_parameters.mass[m] = supports->mass[m];
    dynamics_parameters.inertia[m] = supports->inertia[m];
    dynamics_parameters.right_mass[m] = ends == 2 ? supports->right_mass[m] : 0;
    dynamics_parameters.right_inertia[m] = ends == 2 ? supports->right_inertia[m] : 0;
  }
  set_bearings(&dynamics_parameters, supports);
  bool coupled = supports->torsional_coupling == EO_COUPLING_ON ||
                 (supports->torsional_coupling == EO_COUPLING_PAPER && (ends_differ || held > 0));
  set_machines(&dynamics_parameters, supports);
  if (ends == 1)
    code = set_single_axial(&dynamics_parameters, held, supports, error);
  else {
    set_groove(&dynamics_parameters, supports, coupled);
    set_pinion_axial(&dynamics_parameters, held, supports);
  }
  if (code)
    return code;
  dynamics_parameters.mesh_damping = mesh_damping(&dynamics_parameters, supports->mesh_damping_ratio,
                                                  damping_stiffness);
  if ((code = eo_dynamics_parameters_check(&dynamics_parameters, error)))
    return code;
  *parameters = dynamics_parameters;
  return EO_OK;
}

void eo_supports_make_rigid(struct eo_supports *supports)
{
  for (int i = 0; i < 2; i++)
    supports->bearing_stiffness[i] = supports->gear_axial_stiffness[i] = supports->groove_torsional_stiffness[i] =
        INFINITY;
  supports->torsional_coupling = EO_COUPLING_ON;
}
