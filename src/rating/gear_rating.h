/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rating of one end of a pair by ISO 6336: from geometry, settings and loads to safeties, damage and life. Every
   number that a reviewer needs to follow it stays in the structs. The end of a herringbone pair is rated as a pair of
   its own with half the torque: b = b_B, K_gamma for its share of the load. SI units. */
#ifndef EASEOFF_RATING_GEAR_RATING_H
#define EASEOFF_RATING_GEAR_RATING_H

#include "contact/iso6336.h"
#include "gear/geometry.h"
#include "rating/flank_tolerance.h"
#include "rating/life.h"
#include "rating/rating_settings.h"
#include "rating/root_rating.h"

/* What the rating needs of a pair beside its settings. */
struct eo_rating_input {
  const struct eo_geometry *geometry;      /* borrowed, as all here */
  const struct eo_gear_pair *pair;         /* resolved */
  const struct eo_material *material;      /* of both members */
  const struct eo_rating_settings *rating; /* */
  double thickness_allowance[2];           /* A_sne, m, <= 0: x_E */
  double tip_relief;                       /* C_a, m; 0: none is specified */
  double bearing_span, bearing_offset;     /* l, s of the pinion, m */
  double shaft_diameter;                   /* d_sh of the pinion, m */
};

/* What no load changes. */
struct eo_rating_basis {
  struct eo_rating_input input;
  struct eo_rating_pair pair;
  struct eo_rating_geometry geometry;
  struct eo_iso_stiffness stiffness;      /* from 100 N/mm on; a load case has what a light load leaves of it */
  struct eo_flank_tolerance tolerance[2]; /* [member] */
  double base_pitch_tolerance[2];         /* f_pb */
  double reduced_mass;                    /* kg/m */
  double resonance_speed;                 /* n_E1, 1/s, of that stiffness */
  double mesh_deviation;                  /* f_ma */
  struct eo_strength strength[2];
  double hardness[2];                    /* HV, as stated or assumed */
  double width_over_depth;               /* b/h, smaller of both */
  double relative_curvature;             /* rho_red, of Z_R and Z_W */
  struct eo_tooth_root root[2];          /* at 1 N */
  double rim_factor[2];                  /* Y_B */
  struct eo_root_influence endurance[2]; /* Y of endurance; life 1 */
  struct eo_life_line flank_life[2], root_life[2];
};

/* EO_ERROR_INPUT with a sentence where ISO 6336 (or what is kept of it here) does not rate such a pair. */
enum eo_code eo_rating_basis_init(struct eo_rating_basis *basis, const struct eo_rating_input *input,
                                  struct eo_error *error);

/* One load case at one end. */
struct eo_rating_load {
  double torque;  /* on the pinion, of this end with an even share, N m */
  double speed;   /* of the pinion, rad/s */
  double time;    /* of the required life, s */
  int side;       /* which flank of the teeth carries, 0 or 1: damage of one side is none of the other */
  double sharing; /* K_gamma */
  /* of the contact analysis; NaN: not known */
  double dynamic;           /* largest dynamic over static mesh force */
  double face;              /* K_Hbeta with the worse direction of f_ma */
  double share;             /* K_Halpha of the nominal flanks */
  double pressure, root[2]; /* largest contact pressure, root stress [member], Pa */
};

struct eo_rated_factors {
  double dynamic, face, share;  /* K_V, K_Hbeta, K_Halpha */
  double root_face, root_share; /* K_Fbeta, K_Falpha */
};

struct eo_rated_case {
  struct eo_rating_load load;
  double tangential_force; /* F_t */
  double velocity;         /* at the reference cylinder, m/s */
  struct eo_dynamic_factor dynamic;
  double line_load;                                          /* w = F_t K_A K_gamma/b */
  double light_load;                                         /* of c', c_gamma: below 1 where w is small */
  double resonance_ratio;                                    /* N */
  double shaft_deviation, helix_deviation, helix_running_in; /* f_sh, F_beta_x, y_beta */
  struct eo_rated_factors method_c;                          /* K_V method B, K_Hbeta method C, K_Halpha method B */
  struct eo_rated_factors used;                              /* what rates */
  struct eo_contact_stress contact;
  double root_nominal[2], root_stress[2]; /* sigma_F0 (with Y_B), sigma_F */
  struct eo_flank_influence influence[2];
  double cycles[2];                             /* N_L over the required life */
  double flank_endurance[2], root_endurance[2]; /* strength at the knee with all influences, Pa */
  struct eo_life_line flank_line[2];            /* over flank_endurance: the influences fade towards the static end */
  double flank_life_factor[2], root_life_factor[2]; /* Z_NT, Y_NT at `cycles` */
  double flank_permissible[2], root_permissible[2]; /* sigma_HG, sigma_FG at `cycles`, without S_min */
  double flank_safety[2], root_safety[2];           /* of this load case alone over its own cycles */
  /* Beside the formulae (method A): the local stresses of the analysis times sqrt(K_A K_V) and K_A K_V, without
     K_Hbeta, K_Halpha, Z_eps, Y_eps, which they hold already; they do not rate. */
  double local_flank, local_root[2];
  double local_flank_safety[2], local_root_safety[2];
  double flank_static[2], root_static[2]; /* static strength over its stress */
};

/* Load factors, stresses, what is permissible and safeties of one load case by the basis. Errors: EO_ERROR_INPUT where
   the load or the pair lies outside what the standard rates. */
enum eo_code eo_rated_case_find(struct eo_rated_case *rated, const struct eo_rating_basis *basis,
                                const struct eo_rating_load *load, struct eo_error *error);

/* The load cases as a spectrum (ISO 6336-6), of one member. */
struct eo_rated_side {
  double safety;        /* S that makes the damage sum 1 over the required life */
  double damage;        /* sum at S = 1 */
  double life;          /* s, until the sum at S = 1 is 1; INFINITY without damage */
  double life_at_least; /* the same at S_min: what may be signed */
  double static_safety; /* of the largest stress */
};
struct eo_rated_spectrum {
  struct eo_rated_side flank[2], root[2]; /* [member] */
};
void eo_rated_spectrum_find(struct eo_rated_spectrum *spectrum, const struct eo_rating_basis *basis, int cases,
                            const struct eo_rated_case *rated);

/* The edition of ISO 1328-1 that belongs to that of ISO 6336: a rating never mixes them. */
enum eo_tolerance_edition eo_rating_tolerance_edition(const struct eo_rating_settings *rating);

#endif
