/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measurements of one design beside what the model says at their torque and their measured speed, theory (M4) and
   (M5): rotational acceleration at the end where the encoders sit, the same mesh orders on both sides. */
#ifndef EASEOFF_MEASUREMENT_COMPARISON_H
#define EASEOFF_MEASUREMENT_COMPARISON_H

#include "measurement/prediction.h"

/* What is kept of a measurement. */
struct eo_measured {
  char name[120];
  bool unmodified;      /* label: the pair without, or with the modification of the design */
  double torque, speed; /* N m; measured, rad/s */
  int end;
  int harmonics;
  struct eo_order_line order[EO_MESH_ORDERS]; /* [harmonics] */
  double rms, rms_sigma;                      /* m/s2 */
  int warnings;                               /* findings of the recording that cast doubt on it */
};

struct eo_compared {
  struct eo_rig_prediction prediction;
  double ratio; /* measured over predicted RMS; NaN without prediction */
  double shift; /* mesh phase, 0..1, by which the predicted curve lies nearest to the measured one: the encoders' zero
                   is arbitrary */
  double likeness; /* correlation of both curves then, -1..1 */
  bool outlier;
  char reason[240]; /* why, a sentence; "" */
};

/* A modified measurement beside the mean of the unmodified ones at the same torque (1 %) and speed (2 %). Reductions in
   parts of the unmodified RMS. */
struct eo_reduction {
  int modified;   /* index of the measurement */
  int unmodified; /* how many it is compared with */
  double torque, speed;
  double measured, measured_sigma, predicted;
};

enum { EO_MOST_MEASURED = 256 };

struct eo_comparison {
  int count;
  struct eo_compared *point; /* owned, [count], in the order of the measurements */
  int reductions;
  struct eo_reduction *reduction; /* owned, [reductions] */
  double ratio;                   /* median of measured over predicted RMS; NaN without any */
  double spread;                  /* robust relative standard deviation about it */
};

/* design: resolved, served by the evaluator's pair. measured[count] with count up to EO_MOST_MEASURED. Errors:
   EO_ERROR_INPUT (more), those of eo_prediction_run(), cancelled. eo_comparison_done() also after an error. */
enum eo_code eo_comparison_run(struct eo_comparison *comparison, struct eo_evaluator *evaluator,
                               const struct eo_design *design, int count, const struct eo_measured *measured,
                               const struct eo_progress *progress, struct eo_error *error);
void eo_comparison_done(struct eo_comparison *comparison);

/* Takes over what a comparison needs from a result. */
void eo_measured_take(struct eo_measured *measured, const struct eo_transmission *transmission,
                      const struct eo_findings *findings);

/* TE curves over mesh phase 0..1 in points[count]: measured, and predicted moved by the shift, m. */
void eo_comparison_curves(const struct eo_measured *measured, const struct eo_compared *compared, int count,
                          double *measured_curve, double *predicted_curve);

#endif
