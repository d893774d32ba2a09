/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loaded contact over the mesh cycle (doc/theory/loaded-contact.md): exact complementarity with the nonlinear local
   part, both ends.

   Per end and mesh position, points i with loads p >= 0 and clearances d >= 0, p.d = 0, sum p = P:
       sum_j C_ij p_j + delta_H(p_i) + w_i = Z + d_i .
   With C = factor factor' and a = factor' p the local approach g_i = Z - w_i - factor_i a fixes every load by itself:
   p_i is the inverse of the local law at g_i where g_i > 0, else 0. So the complementarity holds by construction and
   what is left is the minimum of a convex function of (a, Z): rank + 1 smooth equations, Newton with a symmetric
   positive definite matrix. The matrix is in single precision and stays as it is near the solution; the equations, in
   double precision, hold until nothing moves by more than a thousandth of a nanometre. dP/dZ is the tangent stiffness.

   Partial cells (struct eo_contact_grid_settings): over a cell g changes by 2 e, taken from its neighbours on the line;
   where it changes sign the law is applied to the mean of its positive part, (g + e)^2 / (4 e) for |g| < e. Away from
   the ends of the contact nothing differs, and the loads become smooth functions of load and phase. */
#ifndef EASEOFF_CONTACT_LOADED_H
#define EASEOFF_CONTACT_LOADED_H

#include "contact/field.h"
#include "contact/grid.h"
#include "gear/double_helix.h"

#include <stdbool.h>

/* Gaps of one end at all points of a grid, from one gap field. */
struct eo_loaded_gaps {
  double *gap;      /* [grid->points], m */
  double *unloaded; /* [positions]: Z0, the approach at first contact, m */
};

/* Room for a grid, unset. Errors: memory. */
enum eo_code eo_loaded_gaps_init(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid,
                                 struct eo_error *error);
void eo_loaded_gaps_done(struct eo_loaded_gaps *gaps);
/* Gaps at all points, and Z0 of all positions. */
void eo_loaded_gaps_set(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid,
                        const struct eo_gap_field *field);
/* Of positions first <= j < last alone, which do not depend on the others. */
void eo_loaded_gaps_set_some(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid,
                             const struct eo_gap_field *field, int first, int last);

/* Loads about P, as shares of it, at which Z is known where that was asked for. */
enum { EO_LOADED_NEARBY = 4 };
static const double EO_LOADED_NEARBY_SHARE[EO_LOADED_NEARBY] = {0.84, 0.92, 1.08, 1.16};

/* One end under one load. */
struct eo_loaded_end {
  double *load;      /* [positions]: P of the end, N (equal but for axially held pinions) */
  double *approach;  /* [positions]: Z, m, normal; the loaded transmission error is Z / cos(beta_b) */
  double *tangent;   /* [positions]: k_tan = dP/dZ, N/m */
  double *line_load; /* [grid->points]: q, N/m, load per length of contact line */
  double *nearby;    /* [positions][EO_LOADED_NEARBY]: Z, m, at the loads about P; where they are asked for */
  bool around;       /* they are asked for */
  int failures;      /* positions that did not converge: 0 in a sound result */
};

/* Room for the positions and points of a grid, zero. Errors: memory. */
enum eo_code eo_loaded_end_init(struct eo_loaded_end *end, const struct eo_contact_grid *grid, struct eo_error *error);
void eo_loaded_end_done(struct eo_loaded_end *end);

/* Scratch of one thread. */
struct eo_loaded_workspace;
enum eo_code eo_loaded_workspace_new(struct eo_loaded_workspace **workspace, const struct eo_contact_grid *grid,
                                     struct eo_error *error);
void eo_loaded_workspace_free(struct eo_loaded_workspace *workspace);

/* One end, every position, several loads P (normal force per end, N, > 0): result[loads]. compliance_factor scales bulk
   and local compliance (1: as it is). The floating pinion and the single helical pair. A load's result does not depend
   on the other loads, nor on what the workspace was used for before. */
void eo_loaded_solve(struct eo_loaded_workspace *workspace, const struct eo_contact_grid *grid,
                     const struct eo_loaded_gaps *gaps, double compliance_factor, int loads, const double *load,
                     struct eo_loaded_end *result);

/* Both ends' helices; P' and Z' below are loads and approaches on their common footing, which equal helices have
   anyway: gear/double_helix.h. */
struct eo_double_helix eo_contact_double_helix(const struct eo_contact_grid *left, const struct eo_contact_grid *right);

/* How the pinion is held along its axis. A force A on it moves P'_L - P to the shift at which the teeth alone carry it;
   between stops it floats. */
struct eo_axial_hold {
  double stiffness; /* of the axial support, N/m: 0 floating, INFINITY fixed (one Z' for both ends) */
  double shift;     /* P'_L - P of a floating pinion, N: A / (lean of both ends), with the sign of A's axis as eta runs,
                       and what unequal helices part by themselves */
  double rest;      /* Z'_L - Z'_R at that shift, m: what bearings leave of unequal helices, 0 otherwise */
  double play;      /* of Z'_L - Z'_R to either side before a stop is met: mean lean times the clearance, m; 0: none */
};

/* What is left of Z'_L - Z'_R beyond the play, m. */
double eo_axial_beyond_play(const struct eo_axial_hold *hold, double apart);

/* What one end is solved on; halves that differ have grids of their own, with as many positions. Borrowed. */
struct eo_loaded_half {
  struct eo_loaded_workspace *workspace;
  const struct eo_contact_grid *grid;
  const struct eo_loaded_gaps *gaps;
};

/* Both ends of an axially held pinion: P'_L + P'_R = 2 load. A displacement z towards + loads the left end less and the
   right end more: Z'_L = Z_m + lean_L z, Z'_R = Z_m - lean_R z. stagger: positions by which the right end lags.
   Works on results of eo_loaded_solve() for the same load. An end that does not touch although the other one carries
   2 load has load, tangent and line loads 0, and the approach that the axial condition gives it. */
void eo_loaded_balance(const struct eo_loaded_half half[2], double compliance_factor, const struct eo_axial_hold *hold,
                       int stagger, double load, struct eo_loaded_end result[2]);

/* The same at one position of each end, at[end], for a stiffness above 0 and teeth with a helix; false: it did not
   converge. */
bool eo_loaded_balance_position(const struct eo_loaded_half half[2], double compliance_factor,
                                const struct eo_axial_hold *hold, const int at[2], double load,
                                struct eo_loaded_end result[2]);

/* Position j of one end again, at gaps [grid->points] and a load that may have changed a little, from the result it has
   there. */
void eo_loaded_resolve(struct eo_loaded_workspace *workspace, const struct eo_contact_grid *grid, const double *gap,
                       double compliance_factor, int j, double load, struct eo_loaded_end *result);

/* The same within so much, m, of the approach; eo_loaded_resolve() is within EO_LOADED_WITHIN. */
static const double EO_LOADED_WITHIN = 1e-12;
void eo_loaded_resolve_within(struct eo_loaded_workspace *workspace, const struct eo_contact_grid *grid,
                              const double *gap, double compliance_factor, int j, double load, double within,
                              struct eo_loaded_end *result);

/* Every position again at its own load, and Z at the loads about it, of a result at these gaps. */
void eo_loaded_find_nearby(struct eo_loaded_workspace *workspace, const struct eo_contact_grid *grid, const double *gap,
                           double compliance_factor, struct eo_loaded_end *result);

/* What each point of the position solved last takes of 1 N more, [points]; and so the change of Z with its gap. */
void eo_loaded_last_shares(const struct eo_loaded_workspace *workspace, const struct eo_contact_position *position,
                           double *share);

/* How far each point of the position solved last reaches into contact, [points], m: below 0 what it would have to move
   towards the mate before it touches. */
void eo_loaded_last_reach(const struct eo_loaded_workspace *workspace, const struct eo_contact_position *position,
                          double compliance_factor, double *reach);

/* Makes Newton's matrix of the position solved last at its solution, for the answers below. */
void eo_loaded_prepare_response(struct eo_loaded_workspace *workspace, const struct eo_contact_position *position);

/* How the position solved last answers, once they are prepared: the change of its loads, N, and of its approach, m, per
   unit of a change of its gaps [points], m, at constant load P; or, with change NULL, per N of P. Within some
   thousandths. */
double eo_loaded_response(struct eo_loaded_workspace *workspace, const struct eo_contact_position *position,
                          double compliance_factor, const double *change, double *load_change);

/* First contact of the unloaded flanks over the mesh cycle: Z0 [positions], m. gap [grid->points]: the gaps at the
   points where they are known, else NULL, which takes longer. */
void eo_loaded_first_contact(const struct eo_contact_grid *grid, const struct eo_gap_field *field, const double *gap,
                             double *unloaded);

/* Peak Hertz pressure of line contact, Pa, at line load q, N/m, and relative radius, m. */
double eo_loaded_pressure(const struct eo_contact_grid *grid, double line_load, double radius);

#endif
