/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Backlash of an external pair from thickness allowances and centre distance (ISO 21771, DIN 3967). Neither heat nor
   runout nor bearing play is in it. Checked against published reports. Lengths in m, angles in rad. */
#ifndef EASEOFF_RATING_BACKLASH_H
#define EASEOFF_RATING_BACKLASH_H

#include "base/error.h"

struct eo_backlash_input {
  int teeth[2];
  double normal_module, normal_pressure_angle, helix_angle;
  double profile_shift[2];
  double centre_distance;           /* a, nominal */
  double allowance[2];              /* A_sn of both members, m */
  double centre_distance_allowance; /* A_a, + is further apart */
};

struct eo_backlash {
  double circumferential; /* j_wt at the working pitch circles, transverse */
  double normal;          /* j_bn = j_wt cos alpha_wt cos beta_b: the gap of a feeler gauge */
  double of_reference;    /* j_wt cos alpha_n cos beta, which some programs print as normal backlash */
  double radial;          /* j_r: a + A_a less the distance at which both flanks touch */
  double tight_distance;  /* that distance */
  double of_distance;     /* the part of A_a in j_wt: 2 A_a tan alpha_wt */
};

/* j_bn is linear in the allowances, as DIN 3967 has it; a nominal distance beyond the profile shifts adds its exact
   share. EO_ERROR_INPUT: a distance not above the sum of the base radii, shifts without a working pressure angle. */
enum eo_code eo_backlash(struct eo_backlash *backlash, const struct eo_backlash_input *input, struct eo_error *error);

#endif
