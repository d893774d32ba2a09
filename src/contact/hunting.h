/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loaded contact over whole revolutions: every tooth with its own deviations, over the hunting period of
   lcm(z_1, z_2) mesh cycles after which the same teeth meet again (doc/theory/single-teeth.md).

   Pair m is the one whose contact line stands at the roll C - m p_bt; in mesh cycle n (C = n p_bt + c) the line k of
   the contact grid is pair m = n - k. Its teeth are m mod z_1 of the pinion and m mod z_2 of the gear. Compliance and
   gaps of the flanks are those of one cycle; from cycle to cycle only what the deviations of the teeth add to the gaps
   changes. Cycles are computed in blocks of fixed size, each from a start of its own, so the results are the same bytes
   for any number of threads. */
#ifndef EASEOFF_CONTACT_HUNTING_H
#define EASEOFF_CONTACT_HUNTING_H

#include "contact/loaded.h"
#include "contact/root.h"

/* What one flank of one tooth is off, beside what all flanks have. */
struct eo_tooth_deviation {
  double index;         /* F, m, on the arc of the reference circle, transverse, + displaced towards the mate */
  double profile_slope; /* C_Halpha, m, + takes more off at the tip */
  double helix_slope;   /* C_Hbeta, m, over the face width, + takes more off at positive y */
  double profile_crowning, lead_crowning; /* C_alpha as a barrel, C_beta, m, + takes off at both ends */
};

/* Whether any tooth of a table has more than an index deviation; NULL has none. */
bool eo_tooth_any_form(const struct eo_tooth_deviation *tooth, int teeth);

enum { EO_HUNTING_MOST_INSTANTS = 1 << 19 };

/* lcm(z_1, z_2), mesh cycles. */
int eo_hunting_cycles(const int teeth[2]);

/* [2] is [end] where nothing else is said. */
struct eo_hunting_input {
  int ends;
  const struct eo_contact_grid *grid[2];        /* borrowed; both with as many positions */
  const double *gap[2];                         /* [grid->points] of one cycle, m; borrowed */
  const struct eo_loaded_end *alike[2];         /* contact with teeth alike, from which eo_hunting_follow() begins;
                                                   borrowed; NULL: it is solved from cold */
  const struct eo_tooth_deviation *tooth[2][2]; /* [end][member]: [teeth], in the order in which they come into mesh as
                                                   C grows; NULL: without deviations */
  bool inwards;                                 /* eta runs against y */
  int positions;                                /* of a mesh cycle: a divisor of the grid's */
  int stagger;                                  /* of these positions, by which the right end lags */
  double compliance_factor;                     /* as in eo_loaded_solve() */
  double load[2];                               /* P of each end, N */
  double shared_load;                           /* P per end of a held pinion, N */
  struct eo_axial_hold hold;
  const struct eo_root_tables *root[2];     /* [end]; NULL: no root stress */
  struct eo_loaded_workspace *workspace[2]; /* [end] lent to eo_hunting_follow(), of the grid; NULL: it makes one */
  int threads;
};

/* Where something is largest. */
struct eo_hunting_place {
  double value;                   /* N, Pa */
  int end, cycle, position, line; /* of the grid's pairs; cycle and position: of the end's own phase */
  int tooth[2];                   /* [member] as the tables count */
};

struct eo_hunting {
  int ends, cycles, positions, instants; /* instants = cycles positions */
  int lines, first_line;                 /* pairs that can touch: first_line .. first_line + lines - 1 */
  int teeth[2];
  double *load[2];     /* [end]: [instants] at the instants of the left end, so with the stagger in it, N */
  double *approach[2]; /* Z, m, normal */
  double *tangent[2];  /* k_tan, N/m */
  float *pair_load[2]; /* [instants][lines], N */
  struct eo_hunting_place *tooth_load[2][2]; /* [end][member]: [teeth] the largest that each tooth carries */
  struct eo_hunting_place *tooth_stress[2];  /* [member]: [ends][teeth] root stress; NULL: not asked for. position and
                                                line: of the cycle alone, not kept: 0 */
  struct eo_hunting_place most_load[2], most_pressure[2]; /* [end] of a pair of teeth; at a point */
  struct eo_hunting_place most_stress[2];                 /* [member] */
  int failures;                                           /* instants that did not converge */
  int alone; /* instants, of both ends, at which one pair carries all of P */
};

/* Errors: memory, cancelled; EO_ERROR_INPUT: the period has more than EO_HUNTING_MOST_INSTANTS instants.
   eo_hunting_done() also after an error. */
enum eo_code eo_hunting_run(struct eo_hunting *hunting, const struct eo_hunting_input *input,
                            const struct eo_progress *progress, struct eo_error *error);
void eo_hunting_done(struct eo_hunting *hunting);

/* What the deviations of a pair of teeth add to the gap at a point, m, normal: (P1) and, of slopes to first order,
   (P2). tooth: [member], NULL: none. */
double eo_hunting_gap(const struct eo_geometry *geometry, const struct eo_flank_point *point, bool inwards,
                      const struct eo_tooth_deviation *const tooth[2]);

#endif
