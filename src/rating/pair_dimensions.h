/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is measured on both members of a pair and between them: thickness with its allowances, span, balls, circles,
   backlash (ISO 21771, DIN 3960, DIN 3967). Lengths in m. */
#ifndef EASEOFF_RATING_PAIR_DIMENSIONS_H
#define EASEOFF_RATING_PAIR_DIMENSIONS_H

#include "gear/geometry.h"
#include "rating/backlash.h"
#include "rating/tooth_dimensions.h"

/* Nominal, with the upper and with the lower thickness allowance. */
enum eo_measured { EO_NOMINAL, EO_UPPER, EO_LOWER, EO_MEASURED };

struct eo_member_dimensions {
  double reference_diameter, base_diameter, tip_diameter;
  double root_diameter[EO_MEASURED];    /* d_f of the tooth that is cut */
  double form_diameter[EO_MEASURED];    /* d_Ff */
  double active_start_diameter;         /* d_Nf */
  double allowance[EO_MEASURED];        /* A_sn; 0, A_sne, A_sni */
  double generating_shift[EO_MEASURED]; /* x, x_E */
  double normal_thickness[EO_MEASURED]; /* s_n at the reference cylinder */
  struct eo_tooth_chord chord[EO_MEASURED];
  double tip_thickness; /* s_an, normal, without allowance */
  int teeth_spanned;    /* k; 0: no span, for the reason in span_reason */
  double span[EO_MEASURED];
  char span_reason[200];
  double ball; /* D_M; NaN: none, for the reason in ball_reason */
  double over_one_ball[EO_MEASURED], over_two_balls[EO_MEASURED], over_pins[EO_MEASURED];
  char ball_reason[200];
};

struct eo_pair_dimensions {
  struct eo_member_dimensions member[2];
  double centre_distance_allowance;           /* +- A_a */
  struct eo_backlash smallest, mean, largest; /* A_sne with -A_a, the mean allowances at the nominal distance, A_sni
                                                 with +A_a */
};

/* pair: resolved, of the geometry. What cannot be measured is NaN, with its reason where there is one to tell. */
void eo_pair_dimensions_init(struct eo_pair_dimensions *dimensions, const struct eo_gear_pair *pair,
                             const struct eo_geometry *geometry);

/* js7 of a nominal distance (ISO 286-1, IT7/2), m; above 3150 mm in proportion. DIN 3964 takes it for usual drives. */
double eo_centre_distance_allowance(double centre_distance);

#endif
