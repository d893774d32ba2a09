/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A gear pair as its drawing states it, and its material. */
#ifndef EASEOFF_GEAR_GEAR_PAIR_H
#define EASEOFF_GEAR_GEAR_PAIR_H

#include <stdbool.h>

enum { EO_PINION = 0, EO_GEAR = 1 };
enum { EO_LEFT = 0, EO_RIGHT = 1 };

/* What a drawing may state in place of a member of struct eo_gear_pair; NaN: not stated. eo_gear_pair_settle()
   (gear/entry.h) puts the member itself in its place and NaN here. */
struct eo_gear_entry {
  double transverse_module;                                  /* m_t, m */
  double normal_diametral_pitch, transverse_diametral_pitch; /* 1/m_n, 1/m_t, 1/m */
  double transverse_pressure_angle;                          /* alpha_t, rad */
  double shift_sum;                                          /* x1 + x2 */
  double working_pressure_angle;                             /* alpha_wt, rad */
  double shift_length[2];                                    /* [member] x m_n, m */
  double generating_shift[2];                                /* [member] x_E */
  double addendum[2];                                        /* [member] h_a above the reference circle, m */
};

/* A number the user may leave out (JSON null) is NaN here until eo_design_resolve() (design/) puts the derived default
   in its place, whose rule stands where it is computed and in the help of its row (document/gear_tables.c). [2] is
   [member]: pinion, gear. */
struct eo_gear_pair {
  int ends;                     /* 2: herringbone; 1: single helical or spur */
  int teeth[2];                 /* [member]: pinion, gear */
  double normal_module;         /* m_n, m */
  double normal_pressure_angle; /* alpha_n, rad; NaN: 20 deg (settled) */
  double helix_angle;           /* beta at the pitch cylinder, rad, >= 0 */
  char hand[8];                 /* of the pinion's left half, "left" or "right"; the other half's and the gear's follow;
                                   "": eo_design_resolve() */
  double face_width;           /* b of one end, common to both members, m; NaN: what their own widths share (settled) */
  double member_width[2];      /* b of one member's own face at one end, m, centred on the mate's; NaN: face_width */
  double right_face_width;     /* b of the right end, m; NaN: face_width, which is that of the left one then */
  double right_helix_angle;    /* beta of the right half, rad; NaN: helix_angle, which is that of the left one then. The
                                  halves share the transverse section: m_t, alpha_t and every radial length */
  double groove_width;         /* tool withdrawal groove between the ends, m; NaN: derived */
  double addendum_coefficient; /* h_aP*; NaN, of all three: profile A of ISO 53 */
  double dedendum_coefficient; /* h_fP* = h_aP* + c* */
  double fillet_radius_coefficient; /* rho_fP* of the basic rack */
  struct eo_rack {                  /* what one member's basic rack has otherwise; not above 0, or NaN: as above */
    double addendum_coefficient, dedendum_coefficient, fillet_radius_coefficient;
  } rack[2];
  double profile_shift[2];   /* x; NaN: of the gear what the centre distance asks for, else 0 (settled) */
  double centre_distance;    /* working centre distance a_w, m; NaN: without backlash for the given profile shift */
  double tip_alteration;     /* k of d_a = d + 2 m_n (x + h_aP* + k); NaN: derived */
  double tip_diameter[2];    /* d_a, m; NaN: derived */
  double bore[2];            /* bore diameter, m, 0: solid; NaN: derived */
  double groove_diameter[2]; /* body diameter between the ends, m; NaN: derived */
  double rim_thickness_coefficient; /* rim below the root that flexes, times m_n; a larger bore cuts it shorter.
                                       Of a sector and a ring that is held */
  double backlash;                  /* 2 tau, normal, m; NaN: eo_gear_pair_backlash() */
  double generating_offset[2];      /* x_E - x: the root is cut with the shift x_E; 0: without thickness allowance */
  double protuberance[2];           /* of the cutting tool beyond its flank, m */
  double grinding_stock[2];         /* left on each flank by it, normal, m */
  double tip_chamfer[2];    /* radial height of a tip chamfer or rounding: the flank ends that much below d_a/2, m */
  char thickness_series[8]; /* of DIN 3967, as "cd25"; "": the allowances are stated, or follow from the backlash */
  double thickness_allowance[2][2]; /* [member] A_sne, A_sni, normal at the reference cylinder, m, <= 0; NaN: of the
                                       series, else what makes the backlash, half on each member */
  double centre_distance_allowance; /* +- A_a, m; NaN: js7 */
  int teeth_spanned[2];             /* k of the span; 0: nearest to mid flank */
  double measuring_ball[2];         /* D_M, m; NaN: of the usual ones the smallest that fits */
  struct eo_gear_entry entry;
};

/* How much wider a member's own face is than the common one, m; half of it stands beyond either end of the contact. */
static inline double eo_gear_pair_extra_width(const struct eo_gear_pair *pair, int member)
{
  return pair->member_width[member] > 0 ? pair->member_width[member] - pair->face_width : 0;
}

/* b of an end, common to both members, m. */
static inline double eo_gear_pair_face_width(const struct eo_gear_pair *pair, int end)
{
  return end == EO_RIGHT && pair->right_face_width > 0 ? pair->right_face_width : pair->face_width;
}

/* The halves of a herringbone pair differ in their helices. */
static inline bool eo_gear_pair_has_two_helices(const struct eo_gear_pair *pair)
{
  return pair->ends == 2 && pair->right_helix_angle > 0 && pair->right_helix_angle != pair->helix_angle;
}

/* The halves of a herringbone pair differ in their faces or helices. */
static inline bool eo_gear_pair_is_uneven(const struct eo_gear_pair *pair)
{
  return (pair->ends == 2 && pair->right_face_width > 0 && pair->right_face_width != pair->face_width) ||
         eo_gear_pair_has_two_helices(pair);
}

/* Mid face of an end from the middle of the groove, m, outwards; 0 of a pair with one end. */
static inline double eo_gear_pair_mid_face(const struct eo_gear_pair *pair, int end)
{
  return pair->ends == 2 ? (pair->groove_width + eo_gear_pair_face_width(pair, end)) / 2 : 0;
}

/* One half as a pair whose halves are both like it; what is beyond the common face is as wide on both halves. With a
   helix of its own it has its own m_n and alpha_n, and the coefficients by which every length in the transverse section
   stays what it is on the other half; of a resolved pair the tips and the backlash stay to the last bit. */
struct eo_gear_pair eo_gear_pair_half(const struct eo_gear_pair *pair, int end);

/* The groove between the two ends of a member, m. */
static inline double eo_gear_pair_groove_width(const struct eo_gear_pair *pair, int member)
{
  return pair->groove_width - eo_gear_pair_extra_width(pair, member);
}

/* The member's own basic rack; alpha_n must be settled. */
struct eo_rack eo_gear_pair_rack(const struct eo_gear_pair *pair, int member);

/* Of both members; what the gear has otherwise stands beside it. */
struct eo_material {
  double youngs_modulus; /* Pa */
  double poissons_ratio;
  double density;             /* kg/m3 */
  double gear_youngs_modulus; /* of the gear; not above 0, of the density too, or NaN: as above */
  double gear_poissons_ratio; /* below 0 or NaN, or 0 beside no gear_youngs_modulus: as above */
  double gear_density;
};

/* One member's material, with nothing beside it. */
struct eo_material eo_material_of(const struct eo_material *material, int member);
/* Both members are of the same. */
bool eo_material_is_one(const struct eo_material *material);
/* The modulus with which both members, at the pinion's Poisson's ratio, would touch as they do (Hertz): (1 - nu^2)/E is
   the mean of both; and 2 E_1 E_2/(E_1 + E_2) of ISO 6336-1. */
double eo_material_contact_modulus(const struct eo_material *material);
double eo_material_mean_modulus(const struct eo_material *material);

#endif
