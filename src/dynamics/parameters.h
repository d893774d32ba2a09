/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of the lumped model, theory (D1) to (D3): two bodies (pinion, gear), one or two ends
   each, every end with transverse (y), axial (z) and rotational (th) freedom; beyond them, where asked for, the
   machine that drives the pinion and the one that loads the gear, each with its rotation. */
#ifndef EASEOFF_DYNAMICS_PARAMETERS_H
#define EASEOFF_DYNAMICS_PARAMETERS_H

#include <stdbool.h>

#include "base/error.h"
#include "gear/double_helix.h"
#include "gear/geometry.h"

/* What a design says of bearings, bodies and damping. [2] is [member]. */
enum eo_torsional_coupling { EO_COUPLING_PAPER, EO_COUPLING_OFF, EO_COUPLING_ON };
enum eo_impact_in_dynamics { EO_IMPACT_NONE, EO_IMPACT_PAPER, EO_IMPACT_CONSISTENT };

struct eo_supports {
  double bearing_stiffness[2];                   /* k_py, k_gy per end, N/m; NaN: derived */
  double gear_axial_stiffness[2];                /* k_g1z, k_g2z [end], N/m; NaN: derived */
  double groove_axial_stiffness[2];              /* k_pz, k_gz, N/m; NaN: derived */
  double groove_torsional_stiffness[2];          /* N m/rad; NaN: derived */
  enum eo_torsional_coupling torsional_coupling; /* paper: off for equal ends, on when they differ or
                                                    pinion held */
  double mass[2];                                /* of one end with half the groove, kg; NaN: derived */
  double inertia[2];                             /* likewise, kg m2 */
  double right_mass[2], right_inertia[2]; /* of the right end of halves of unequal width; not above 0: as the left one
                                           */
  double right_base_helix_angle; /* of the right end of halves of unequal helix, rad; not above 0: as the left one */
  double bearing_damping_ratio;
  double groove_damping_ratio;
  double mesh_damping_ratio;
  double mesh_damping_stiffness; /* k in c_m = 2 zeta sqrt(k m_e)/cos b, N/m; NaN: derived of each load case */
  double machine_inertia[2];     /* of the driver on the pinion's shaft, of the load on the gear's, each on its own
                                    shaft, kg m2; 0: none */
  double machine_stiffness[2];   /* of the shaft and coupling between it and the gear, N m/rad; 0: none */
  double machine_damping_ratio;
};

/* Bearings and grooves that do not give: what is left of the model's springs is the pinion's axial support. */
void eo_supports_make_rigid(struct eo_supports *supports);

/* [2] is [member] unless it says [end]. SI. A stiffness may be INFINITY where it says so: the motion is then left out,
   and the damper with it. */
struct eo_dynamics_parameters {
  int ends;                               /* 2: herringbone, 12 degrees of freedom; 1: single helical or spur, 6 */
  double base_radius[2];                  /* R_p, R_g, m */
  double base_helix_angle;                /* rad */
  double mass[2], inertia[2];             /* of one end with half the groove, kg, kg m2 */
  double right_mass[2], right_inertia[2]; /* of the right end where it differs; not above 0: as the left one */
  double right_base_helix_angle;          /* likewise, rad */
  double bearing_stiffness[2], bearing_damping[2];       /* k_py, k_gy per end, N/m, N s/m; may be INFINITY */
  double gear_axial_stiffness[2], gear_axial_damping[2]; /* [end] k_g1z, k_g2z, gear to ground; may be INFINITY */
  double groove_axial_stiffness[2],
      groove_axial_damping[2]; /* k_pz, k_gz between the ends; with one end: pinion to ground */
  double groove_torsional_stiffness[2], groove_torsional_damping[2]; /* between the ends, N m/rad; 0: not coupled; may
                                                                        be INFINITY */
  double pinion_axial_stiffness, pinion_axial_damping; /* k_a: from the pinion's mean axial motion, (z_p1 + z_p2)/2 or
                                                          z_p1 with one end, to ground, N/m; 0: floating; INFINITY:
                                                          fixed */
  double machine_inertia[2]; /* of the driver on the pinion's shaft and the load on the gear's, kg m2; 0: none */
  double machine_stiffness[2], machine_damping[2]; /* torsion between the machine and the mean rotation of the ends,
                                                      through which all of the torque goes, N m/rad, N m s/rad */
  double mesh_damping;                             /* c_m, N s/m along the normal */
};

/* Refuses what makes no equations of motion, whoever states it (the ranges of a design's supports stand in
   document/gear_tables.c): what is not finite (but for springs that may be rigid), masses, inertias, radii, bearing and
   axial stiffnesses that are not positive, negative damping, a damper without its spring (its place would not be
   determined), and a machine without its spring or a spring without its machine. Pointers are those of the design's
   `supports`. */
enum eo_code eo_dynamics_parameters_check(const struct eo_dynamics_parameters *parameters, struct eo_error *error);

/* Parameters of a design whose supports are resolved (eo_design_resolve(), design/): masses, inertias and the springs
   of the groove that are used must be numbers here. Damping is c = 2 zeta sqrt(k m) at the bearings, 2 zeta sqrt(k m /
   2) in the groove, 2 zeta sqrt(k_a 2 m) at the axial support of the whole pinion, 2 zeta sqrt(k J) with the reduced
   inertia 1/J = 1/J_machine + 1/(J of both ends) at a machine (m, J, m_e of ends that differ: the mean), c_m = 2 zeta
   sqrt(k m_e) / cos(beta_b) with k the mesh_damping_stiffness of the supports or, when that is NaN, mean_mesh_stiffness
   (normal, one end, N/m). Torsional coupling follows supports: `paper` couples when ends_differ or the pinion is held
   along its axis, since what one end carries more than the other can only come through the groove. pinion_axial:
   stiffness with which the pinion is held, N/m, 0: floating, INFINITY: fixed; with one end a pinion that is said to
   float is held like its gear (without a bearing its thrust would carry it away). Errors: EO_ERROR_INPUT with the key.
 */
enum eo_code eo_dynamics_parameters_init(struct eo_dynamics_parameters *parameters, const struct eo_geometry *geometry,
                                         int ends, double pinion_axial, const struct eo_supports *supports,
                                         bool ends_differ, double mean_mesh_stiffness, struct eo_error *error);

/* Equivalent mass of the two inertias along the transverse line of action, m_e = J_p J_g / (J_p r_bg^2 + J_g r_bp^2),
   kg. */
double eo_dynamics_equivalent_mass(const struct eo_dynamics_parameters *parameters);

/* beta_b of an end, rad, and both on one footing. */
double eo_dynamics_base_helix_angle(const struct eo_dynamics_parameters *parameters, int end);
struct eo_double_helix eo_dynamics_double_helix(const struct eo_dynamics_parameters *parameters);

/* Mean normal mesh force of one end that balances the torque (total, on the pinion), N; of unequal helices with the
   thrusts of a floating pinion in balance. */
double eo_dynamics_mesh_load(const struct eo_dynamics_parameters *parameters, double torque, int end);

#endif
