/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two halves whose helices may differ, put on one footing (doc/theory/flank.md, Halves of their own helices). A load P
   of an end counts as P' = P / scale and an approach Z as Z' = Z scale: the same tangential force and the same
   rotation under the left end's base helix angle. So P'_L + P'_R = T/(r_b cos beta_bL), whatever each end carries, and
   a turn moves both Z' alike; of equal helices every number is that of one end, to the last bit. */
#ifndef EASEOFF_GEAR_DOUBLE_HELIX_H
#define EASEOFF_GEAR_DOUBLE_HELIX_H

#include <math.h>

/* [2] is [end]. */
struct eo_double_helix {
  double scale[2]; /* cos beta_bL / cos beta_b: 1 on the left */
  double lean[2];  /* axial part of P', and change of Z' per axial displacement: cos beta_bL tan beta_b */
  double share[2]; /* of the torque with a floating pinion, whose thrusts balance: 0.5 of equal helices; and the weight
                      of the end's Z' in the rotation of the pair */
};

/* From the base helix angles of both ends, rad. */
static inline struct eo_double_helix eo_double_helix_of(double left_base_helix_angle, double right_base_helix_angle)
{
  double ratio = cos(left_base_helix_angle) / cos(right_base_helix_angle), left = sin(left_base_helix_angle),
         right = sin(right_base_helix_angle) * ratio, sum = left + right;
  return (struct eo_double_helix){
      .scale = {1, ratio},
      .lean = {left, right},
      .share = {sum > 0 ? right / sum : 0.5, sum > 0 ? left / sum : 0.5}}; /* theory (F11) */
}

/* Both ends' lean together: what the axial force of the pinion changes by per N of P' that goes from one to the other.
 */
static inline double eo_double_helix_lean(const struct eo_double_helix *helix)
{
  return helix->lean[0] + helix->lean[1];
}

/* P of an end where both carry their shares; load: P' of each with equal shares. */
static inline double eo_double_helix_load(const struct eo_double_helix *helix, int end, double load)
{
  return load * (2 * helix->share[end]) * helix->scale[end];
}

#endif
