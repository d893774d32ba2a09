/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loaded contact of both ends on bodies that twist and bend (contact/shaft.h). At every mesh position the gaps are
   those of the rigid bodies plus the deflection d under the present flank loads,  d = S f(d),  both ends together: the
   ends feel each other through the bodies.

   Newton on d: at constant end load the contact answers a change of its gaps by f' = -H, H symmetric positive
   semi-definite (the problem is the minimum of a convex function), and S is nearly V V' with a few modes V, so
       correction = r - V (I + V'H V)^-1 (H V)' r,   r = S f(d) - d ;
   what V leaves out is small enough for plain iteration. With an axially held pinion the shift of load between the ends
   is one unknown more. Ends when no gap is off by more than a hundredth of a nanometre.

   The tangent stiffness stays that of the teeth at these gaps: the bodies' own compliance belongs to the dynamics,
   where they move. */
#ifndef EASEOFF_CONTACT_ELASTIC_H
#define EASEOFF_CONTACT_ELASTIC_H

#include "contact/loaded.h"
#include "contact/shaft.h"

/* The bodies of one design on the grids of its ends, and scratch of one thread. */
struct eo_elastic;

/* The grids [end] are borrowed and have as many positions; inwards: see eo_shaft_influence_init(). */
enum eo_code eo_elastic_new(struct eo_elastic **elastic, const struct eo_contact_grid *const grid[2],
                            const struct eo_gear_pair *pair, const struct eo_shafts *shafts, bool inwards,
                            struct eo_error *error);
void eo_elastic_free(struct eo_elastic *elastic);

struct eo_elastic_case {
  double load;               /* P' per end, normal, N */
  double compliance_factor;  /* of the teeth, as in eo_loaded_solve(); the bodies stay as they are */
  struct eo_axial_hold hold; /* of the pinion; stiffness 0: floating */
  int stagger;               /* positions by which the right end lags */
};

struct eo_elastic_report {
  struct eo_deflection mean[2]; /* [end] over the mesh cycle */
  double change;                /* largest departure of a position's deflection from the mean anywhere on a flank, m */
  int most_iterations, iterations; /* the most at one position, and of all of them */
  int failures;                    /* positions that did not converge */
};

/* workspace[2]: of the ends, may be one. gaps[ends]: of rigid bodies. result[ends]: of eo_loaded_solve() for the same
   load on them; becomes that on elastic bodies. */
void eo_elastic_solve(struct eo_elastic *elastic, struct eo_loaded_workspace *const workspace[2],
                      const struct eo_loaded_gaps *gaps, const struct eo_elastic_case *load,
                      struct eo_loaded_end *result, struct eo_elastic_report *report);

/* The gaps of one end on bodies that stay as the given loads bend them: bent [grid->points], m. */
void eo_elastic_gaps(struct eo_elastic *elastic, const struct eo_loaded_gaps *gaps, int stagger,
                     const struct eo_loaded_end *result, int end, double *bent);

#endif
