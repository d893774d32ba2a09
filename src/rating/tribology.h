/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sliding, flash temperature and film thickness of loaded flanks, from open formulae:
   flash temperature after Blok (1937) for two equal bodies and a semi-elliptic heat source, film thickness of line
   contact after Dowson and Higginson (1966), isothermal and fully flooded, viscosity over temperature after Walther
   (ASTM D341). ISO/TS 6336-20 to -22 are not public: no safety against scuffing or micropitting of theirs is given. The
   friction coefficient is a stated number. Tip edges have no film of their own and count in the power loss alone. */
#ifndef EASEOFF_RATING_TRIBOLOGY_H
#define EASEOFF_RATING_TRIBOLOGY_H

#include "contact/loaded.h"
#include "rating/rating_settings.h"

/* One mesh at one speed. */
struct eo_tribology_state {
  const struct eo_geometry *geometry; /* borrowed */
  double speed[2];                    /* [member] rad/s */
  double viscosity;                   /* dynamic, of the oil at the temperature of the teeth, Pa s */
  double pressure_viscosity;          /* 1/Pa */
  double friction;
  double tooth_temperature; /* degrees Celsius */
  double youngs_modulus, poissons_ratio;
  double thermal_contact; /* B_M = sqrt(conductivity density specific heat), N/(m K s^0.5) */
  double roughness;       /* R_q of both flanks together, m */
};

/* Kinematic viscosity, m2/s, at a temperature, degrees Celsius, by the line through 40 and 100 degrees:
   log log (nu + 0.7) straight over log T, nu in mm2/s. */
double eo_walther_viscosity(double viscosity_40, double viscosity_100, double temperature);

/* geometry: borrowed. Oil and roughness are the rating's; pinion_speed: rad/s. */
void eo_tribology_state_init(struct eo_tribology_state *state, const struct eo_geometry *geometry,
                             const struct eo_material *material, const struct eo_rating_settings *rating,
                             double pinion_speed);

/* At path coordinate s under a line load q, N/m, > 0. */
struct eo_tribology_point {
  double sliding;    /* v_1 - v_2, m/s: + where the pinion's flank is faster */
  double flash;      /* K above the teeth */
  double film;       /* least film thickness, m; 0 where nothing rolls */
  double film_ratio; /* over the roughness */
};
struct eo_tribology_point eo_tribology_at(const struct eo_tribology_state *state, double s, double line_load);

/* One end over the mesh cycle. */
struct eo_tribology {
  double sliding;             /* largest amount where there is load, m/s */
  double flash;               /* largest, K */
  double contact_temperature; /* teeth and largest flash, degrees Celsius */
  double film, film_ratio;    /* least */
  double power_loss;          /* friction of the mesh, mean over the mesh cycle, W */
};
/* *tribology over the loaded points of an end; where nothing is loaded the film is infinite and all else 0. */
void eo_tribology_find(struct eo_tribology *tribology, const struct eo_tribology_state *state,
                       const struct eo_contact_grid *grid, const struct eo_loaded_end *end);

#endif
