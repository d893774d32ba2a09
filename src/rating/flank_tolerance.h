/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flank tolerances of cylindrical gears: ISO 1328-1:1995 by accuracy grade and ISO 1328-1:2013 by tolerance class. The
   classes of 2013 are not the grades of 1995; nothing here converts one into the other. Lengths in m.

   Checked against numbers of published reports: all of 1995 (composite deviations f_i', F_i': 3 gears), f_pT of 2013.
   Unchecked (one freely published text, no report): F_pT, F_alpha, F_beta and their parts of 2013, and the tolerances
   of the axes (ISO/TR 10064-3). */
#ifndef EASEOFF_RATING_FLANK_TOLERANCE_H
#define EASEOFF_RATING_FLANK_TOLERANCE_H

#include "base/error.h"

/* The exact values instead of the geometric means of the ranges are allowed by 5.3 of 1995; some programs take them. */
enum eo_tolerance_edition { EO_ISO1328_1995, EO_ISO1328_1995_EXACT, EO_ISO1328_2013 };

struct eo_tolerance_input {
  double reference_diameter;  /* d, 5 .. 10000 mm; 2013: .. 15000 mm */
  double normal_module;       /* m_n, 0.5 .. 70 mm */
  double face_width;          /* b, 4 .. 1000 mm; 2013: .. 1200 mm */
  int teeth;                  /* z, from 5; 0: not known, then F_pk is NaN */
  int grade;                  /* 1995: 0 .. 12; 2013: class 1 .. 11 */
  double total_contact_ratio; /* eps_gamma of the pair; NaN: not known, then f_i', F_i' are NaN */
  double helix_angle;         /* beta, rad; 2013: up to 45 degrees */
};

/* Rounded as the standard prints them. What an edition does not state (or an input it lacks) is NaN. */
struct eo_flank_tolerance {
  double single_pitch;                               /* f_pt, f_pT */
  double cumulative_pitch;                           /* F_pk over k = whole part of z/8 pitches */
  double total_pitch;                                /* F_p, F_pT */
  double profile_total, profile_form, profile_slope; /* F_alpha, f_falpha, f_Halpha (and their 2013 names with T) */
  double helix_total, helix_form, helix_slope;       /* F_beta, f_fbeta, f_Hbeta */
  double runout;                                     /* F_r */
  double tooth_composite, total_composite;           /* f_i', F_i' */
};

/* EO_ERROR_INPUT where a value lies outside the edition's range; the text names value, range and remedy. */
enum eo_code eo_flank_tolerance(struct eo_flank_tolerance *tolerance, enum eo_tolerance_edition edition,
                                const struct eo_tolerance_input *input, struct eo_error *error);

/* The standard's rounding of a tolerance in m: from 10 um on whole um, from 5 um on halves, below tenths. */
double eo_tolerance_round(double tolerance);

/* f_pb = f_pt cos alpha_t with the rounded f_pt (ISO 6336-1), m. */
double eo_base_pitch_tolerance(double single_pitch, double transverse_pressure_angle);

/* Recommended parallelism of the axes by ISO/TR 10064-3, m: in the plane of the axes f_Sigma_delta, out of it
   f_Sigma_beta; bearing span l over the face width b. Unchecked. */
struct eo_axis_tolerance {
  double in_plane, out_of_plane;
};
struct eo_axis_tolerance eo_axis_tolerance(double helix_total, double span_over_width);

#endif
