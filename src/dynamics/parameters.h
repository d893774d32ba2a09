/* The numbers of the lumped model of paper Fig 4 and equations (3)-(10): two bodies (pinion, gear), one or two ends
   each, every end with transverse (y), axial (z) and rotational (th) freedom. */
#ifndef EASEOFF_DYNAMICS_PARAMETERS_H
#define EASEOFF_DYNAMICS_PARAMETERS_H

#include <stdbool.h>

#include "base/error.h"
#include "gear/geometry.h"

/* What a design says of bearings, bodies and damping. [2] is [member]. */
enum eo_torsional_coupling { EO_COUPLING_PAPER, EO_COUPLING_OFF, EO_COUPLING_ON };
enum eo_impact_in_dynamics { EO_IMPACT_NONE, EO_IMPACT_PAPER, EO_IMPACT_CONSISTENT };

struct eo_supports {
  double bearing_stiffness[2];                   /* k_py, k_gy per end, N/m */
  double gear_axial_stiffness[2];                /* k_g1z, k_g2z [end], N/m */
  double groove_axial_stiffness[2];              /* k_pz, k_gz, N/m; NaN: E A / L of the groove body */
  double groove_torsional_stiffness[2];          /* N m/rad; NaN: G J / L of the groove body */
  enum eo_torsional_coupling torsional_coupling; /* paper: off for equal ends, on when they differ */
  double mass[2];    /* of one end with half the groove, kg; NaN: solid of the pitch cylinder */
  double inertia[2]; /* likewise, kg m2 */
  double bearing_damping_ratio;
  double groove_damping_ratio;
  double mesh_damping_ratio;
  double mesh_damping_stiffness; /* k in c_m = 2 zeta sqrt(k m_e)/cos b, N/m; NaN: the mean mesh stiffness of the load
                                    case */
};

/* [2] is [member] unless it says [end]. SI. */
struct eo_dynamics_parameters {
  int ends;                   /* 2: herringbone, 12 degrees of freedom; 1: single helical or spur, 6 */
  double base_radius[2];      /* R_p, R_g, m */
  double base_helix_angle;    /* rad */
  double mass[2], inertia[2]; /* of one end with half the groove, kg, kg m2 */
  double bearing_stiffness[2], bearing_damping[2];       /* k_py, k_gy per end, N/m, N s/m */
  double gear_axial_stiffness[2], gear_axial_damping[2]; /* [end] k_g1z, k_g2z, gear to ground */
  double groove_axial_stiffness[2],
      groove_axial_damping[2]; /* k_pz, k_gz between the ends; with one end: pinion to ground */
  double groove_torsional_stiffness[2], groove_torsional_damping[2]; /* between the ends, N m/rad; 0: not coupled */
  double mesh_damping;                                               /* c_m, N s/m along the normal */
};

/* Refuses what is not finite, masses, inertias, radii, bearing and axial stiffnesses that are not positive, negative
   damping, and a damper without its spring (its place would not be determined). Pointers are those of the design's
   `supports`. */
enum eo_code eo_dynamics_parameters_check(const struct eo_dynamics_parameters *parameters, struct eo_error *error);

/* Parameters of a design. NaN members of supports take the defaults of the model: solids of the pitch cylinder with
   half the groove (bores taken out), groove springs E A / L and G J / L, damping c = 2 zeta sqrt(k m) at the bearings,
   2 zeta sqrt(k m / 2) in the groove, c_m = 2 zeta sqrt(k m_e) / cos(beta_b) with k the mesh_damping_stiffness of the
   supports or, when that is NaN, mean_mesh_stiffness (normal, one end, N/m). Torsional coupling follows supports:
   `paper` couples when ends_differ. A single helical pinion is held axially like its gear.
   Errors: EO_ERROR_INPUT with the key. */
enum eo_code eo_dynamics_parameters_init(struct eo_dynamics_parameters *parameters, const struct eo_geometry *geometry,
                                         const struct eo_gear_pair *pair, const struct eo_material *material,
                                         const struct eo_supports *supports, bool ends_differ,
                                         double mean_mesh_stiffness, struct eo_error *error);

/* Equivalent mass of the two inertias along the transverse line of action, m_e = J_p J_g / (J_p r_bg^2 + J_g r_bp^2),
   kg. */
double eo_dynamics_equivalent_mass(const struct eo_dynamics_parameters *parameters);

/* c_m = 2 zeta sqrt(k m_e) / cos(beta_b), N s/m, k normal. */
double eo_dynamics_mesh_damping(const struct eo_dynamics_parameters *parameters, double damping_ratio,
                                double stiffness);

/* Mean normal mesh force of one end that balances the torque (total, on the pinion), N. */
double eo_dynamics_mesh_load(const struct eo_dynamics_parameters *parameters, double torque);

#endif
