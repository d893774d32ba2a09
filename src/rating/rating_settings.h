/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a user states for the rating of a pair: standard, materials, quality, life, lubricant. A part of the design. A
   number that may be left out is NaN until the rating takes its derived value. SI units. */
#ifndef EASEOFF_RATING_RATING_SETTINGS_H
#define EASEOFF_RATING_RATING_SETTINGS_H

#include <stdbool.h>

#include "rating/flank_rating.h"
#include "rating/load_factors.h"
#include "rating/material_class.h"

/* Where K_V, K_Hbeta and K_Halpha come from: from the contact analysis (and never less than method B where that holds
   deviations which the analysis does not), or from the formulae alone. */
enum eo_load_factor_source { EO_FACTORS_COMPUTED, EO_FACTORS_STANDARD };

/* The shift behind the form factors: that of the tooth as cut with its upper allowance (x_E), or the nominal x. */
enum eo_root_shift { EO_ROOT_SHIFT_GENERATED, EO_ROOT_SHIFT_NOMINAL };

/* One member. */
struct eo_rating_member {
  enum eo_rating_material material;
  enum eo_material_quality quality;
  enum eo_core core;
  double hardness;        /* HV; NaN: the lowest of its class in ISO 6336-5 */
  double flank_limit;     /* sigma_Hlim, Pa; NaN: ISO 6336-5 */
  double root_limit;      /* sigma_Flim, Pa; NaN: ISO 6336-5 */
  double proof_stress;    /* sigma_0.2, Pa; NaN: not known; of through hardened and structural steel alone */
  double flank_roughness; /* R_z, m */
  double root_roughness;  /* R_z of the fillet, m */
  double meshes_per_turn;
  double mean_stress; /* Y_M */
};

struct eo_lubricant {
  double viscosity_40, viscosity_100; /* kinematic, m2/s */
  double density;                     /* kg/m3, at the temperature of the teeth */
  double pressure_viscosity;          /* alpha, 1/Pa */
  double tooth_temperature;           /* of the flanks before the flash, degrees Celsius */
  double friction;                    /* coefficient, the same everywhere */
};

struct eo_rating_settings {
  enum eo_rating_edition edition; /* EO_ISO6336_2006 or _2019 */
  enum eo_load_factor_source load_factors;
  enum eo_root_shift root_shift;
  int accuracy_grade;        /* grade of ISO 1328-1:1995 with 2006, tolerance class of ISO 1328-1:2013 with 2019 */
  double application_factor; /* K_A */
  double required_life;      /* s */
  double flank_safety, root_safety; /* S_Hmin, S_Fmin */
  bool some_pitting;
  double long_life; /* Z_NT and Y_NT at 1e10 cycles */
  enum eo_bearing_arrangement arrangement;
  enum eo_helix_measure helix_measure; /* of method C */
  struct eo_rating_member member[2];
  struct eo_lubricant lubricant;
  double thermal_conductivity; /* of the teeth, W/(m K) */
  double specific_heat;        /* J/(kg K) */
};

#endif
