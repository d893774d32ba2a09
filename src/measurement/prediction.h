/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What two encoders at one end of a design would measure: the mesh orders of the transmission error from the simulated
   vibration. */
#ifndef EASEOFF_MEASUREMENT_PREDICTION_H
#define EASEOFF_MEASUREMENT_PREDICTION_H

#include "evaluation/evaluator.h"
#include "measurement/transmission.h"

struct eo_rig_prediction {
  bool valid;           /* false: the loaded contact or the vibration did not converge; the numbers are then NaN */
  double torque, speed; /* N m, rad/s */
  int harmonics;
  double complex order[EO_MESH_ORDERS]; /* [harmonics] TE = Re sum order[h - 1] exp(2 pi i h phase), gear behind pinion
                                           as measured, m */
  double acceleration[EO_MESH_ORDERS];  /* [harmonics] amplitudes, m/s2 */
  double rms;                           /* rotational acceleration of those harmonics at the end, m/s2 */
  double peak_to_peak;                  /* of their TE, m */
};

/* design: resolved, served by the evaluator's pair; its load cases are replaced by one. unmodified: without its
   modification. end: EO_LEFT, EO_RIGHT (the left one with one end). harmonics: 1..EO_MESH_ORDERS, more than the
   resolution has are 0. Errors: those of eo_evaluator_run(). */
enum eo_code eo_prediction_run(struct eo_rig_prediction *prediction, struct eo_evaluator *evaluator,
                               const struct eo_design *design, bool unmodified, double torque, double speed, int end,
                               int harmonics, struct eo_error *error);

/* The pinion's share of a free torsional vibration, (I_g / r_g^2) / (I_p / r_p^2 + I_g / r_g^2). */
double eo_prediction_pinion_share(const struct eo_supports *supports, const struct eo_geometry *geometry);

#endif
