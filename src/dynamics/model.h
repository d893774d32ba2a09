/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equations of motion of the lumped model, theory (D1) and (D2), signs as doc/theory/paper.md has them: every spring,
   damper and mesh is one direction e of relative motion and adds k e e', c e e'. So K and C are symmetric and C is
   positive semi-definite. Coordinates: y_p1 z_p1 th_p1 [y_p2 z_p2 th_p2] y_g1 z_g1 th_g1 [y_g2 z_g2 th_g2] [th_driver]
   [th_load]. A rigid spring takes its direction e out of the motions there are. A machine turns against the mean
   rotation of the ends it is joined to, so that half the torque goes to each end; of unequal helices against that mean
   of theirs by which each has the torque that balances the thrusts. */
#ifndef EASEOFF_DYNAMICS_MODEL_H
#define EASEOFF_DYNAMICS_MODEL_H

#include "base/error.h"
#include "dynamics/oscillator.h"
#include "dynamics/parameters.h"

enum { EO_MAX_FREEDOMS = 14 };
enum eo_motion { EO_MOTION_Y = 0, EO_MOTION_Z = 1, EO_MOTION_ROTATION = 2 };

/* Three readings of one end's relative motion: X; y_p - y_g + R_p th_p - R_g th_g; R_p th_p - R_g th_g. */
enum eo_reading { EO_READING_NORMAL, EO_READING_TRANSVERSE, EO_READING_ROTATIONAL, EO_READINGS };

struct eo_dynamics_model {
  struct eo_dynamics_parameters parameters;
  int freedoms;                                        /* 6 per end, 1 per machine */
  int machine[2];                                      /* [member] freedom of the driver, of the load; -1: none */
  int zero_modes;                                      /* 3, 2 or 1 with two ends */
  int constraints;                                     /* directions that rigid springs take out */
  double mass[EO_MAX_FREEDOMS];                        /* diagonal */
  double stiffness[EO_MAX_FREEDOMS * EO_MAX_FREEDOMS]; /* [freedoms][freedoms], without the mesh */
  double damping[EO_MAX_FREEDOMS * EO_MAX_FREEDOMS];
  double reading[EO_READINGS][2][EO_MAX_FREEDOMS]; /* [reading][end]: rows; the normal ones are g_j = dX_j/dq */
  double theta_impact[2][EO_MAX_FREEDOMS];         /* h_j of the paper's form: theta only */
  /* q = basis r + zero z: mass-orthonormal, zero spans the motions in which no spring, damper or mesh takes part. The
     number of zero modes follows from the directions alone, whatever the stiffnesses. */
  double basis[EO_MAX_FREEDOMS * EO_MAX_COORDINATES]; /* [freedoms][oscillator.n] */
  double zero[EO_MAX_FREEDOMS * 3];                   /* [freedoms][zero_modes] */
  struct eo_oscillator oscillator;                    /* in r, for `torque` and `impact` as last set */
  double zero_mode_load; /* largest |load . zero| / (|load| |zero|) of the torques: zero but for roundoff */
};

/* Place of a motion in q: [member][end][motion]. */
static inline int eo_dynamics_freedom(int ends, int member, int end, enum eo_motion motion)
{
  return 3 * (ends * member + end) + (int)motion;
}

/* Errors: those of eo_dynamics_parameters_check(). */
enum eo_code eo_dynamics_model_init(struct eo_dynamics_model *model, const struct eo_dynamics_parameters *parameters,
                                    struct eo_error *error);

/* Sets the torque (total on the pinion, N m) and the way impacts act, both in model->oscillator. */
void eo_dynamics_model_load(struct eo_dynamics_model *model, double torque, enum eo_impact_in_dynamics impact);

/* Work of the mean impacts on the zero modes: with the paper's theta-only form the mean of W_1 - W_2 does work on the
   pinion's screw motion. Returns the generalised force on all of them together, N/sqrt(kg); it has no periodic response
   and is left out. */
double eo_dynamics_model_impact_drift(const struct eo_dynamics_model *model, const double mean[2]);

struct eo_dynamics_modes {
  int n; /* freedoms - zero modes - constraints */
  int zero_modes;
  double frequency[EO_MAX_COORDINATES];     /* undamped, Hz, ascending */
  double damping_ratio[EO_MAX_COORDINATES]; /* -Re(pole) / |pole| of the damped system; 1 and above: overdamped */
  double shape[EO_MAX_COORDINATES][EO_MAX_FREEDOMS]; /* [mode][freedom], unit modal mass */
  double complex pole[2 * EO_MAX_COORDINATES]; /* of the damped system, 1/s, by |pole|, conjugate pairs together */
};

/* The axial stiffness, N/m, that alone - everything else rigid - would make the ends share a load at rest as all
   springs of the model do together: the pinion's axial support and the gear's, the bearings and the torsion of the
   grooves. With P the mean of both ends, what the left one carries more is D = - s (X_L - X_R), and k = 4 s
   sin^2(beta_b). 0: each end carries P (floating pinion, ends not coupled in torsion, no helix, one end); INFINITY: X_L
   = X_R. */
double eo_dynamics_model_axial_stiffness(const struct eo_dynamics_model *model);

/* X'_L - X'_R, m per N of P', that bearings and grooves leave where the ends of unequal helices carry what balances
   their thrusts: bearings give by unlike forces, and one axial displacement is not the same rotation on both ends. 0
   where the axial stiffness is, and of equal helices. Sets the torque as eo_dynamics_model_load() does. */
double eo_dynamics_model_axial_rest(struct eo_dynamics_model *model);

/* Eigenfrequencies with a constant mesh stiffness per end (N/m, > 0) and the mesh damping of the parameters.
   Errors: EO_ERROR_INPUT (stiffness), EO_ERROR_MEMORY, EO_ERROR_NUMERIC. */
enum eo_code eo_dynamics_model_modes(const struct eo_dynamics_model *model, const double mesh_stiffness[2],
                                     struct eo_dynamics_modes *modes, struct eo_error *error);

/* Negative control: the pole with the largest real part when the groove springs and dampers carry the signs printed in
   (6) and (7), k_pz (z_p2 + z_p1), c_pz (z_p2' + z_p1') and - c_gz (z_g2' - z_g1'). Such a model flutters. Two ends
   only. Errors: EO_ERROR_INPUT, EO_ERROR_NUMERIC. */
enum eo_code eo_dynamics_model_printed_pole(const struct eo_dynamics_model *model, const double mesh_stiffness[2],
                                            double complex *pole, struct eo_error *error);

#endif
