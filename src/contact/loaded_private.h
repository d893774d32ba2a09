/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The workspace of loaded contact, shared by the files that make it and work in it. */
#ifndef EASEOFF_CONTACT_LOADED_PRIVATE_H
#define EASEOFF_CONTACT_LOADED_PRIVATE_H

#include "contact/loaded.h"
#include "numerics/dense.h"
#include "numerics/gram.h"
#include "numerics/local_inverse.h"

#include <stdbool.h>

struct eo_loaded_workspace {
  struct eo_local_inverse inverse;
  const struct eo_gram *gram;
  bool partial;              /* cells may touch in part */
  double *load, *rate, *gap; /* [most_points]: p, dp/dg, scaled gaps */
  double *bend, *correction; /* [most_points]: deflection by the modes, and by what they leave of the compliance */
  double *local, *spread;    /* [most_points]: local approach g, and half its change over the cell */
  double *mode, *trial;      /* [most_rank + 1]: a and Z */
  double *residual, *step, *tangent; /* [most_rank + 1] */
  float *matrix, *packed, *blend;    /* scratch of the kernel; matrix: minus the inverse of Newton's */
  /* [most_points], [most_rank + 1]: g and (a, Z) over a change of the load: value, slope, half the curvature */
  double *course[3], *modal_course[3];
};

/* The problem of one position in units of the unscaled compliance: gaps and approach are divided by the compliance
   factor. */
struct eo_loaded_problem {
  const struct eo_contact_position *position;
  const double *gap; /* [points] */
  double force;      /* P */
  double within;     /* what the approach may be off, m */
};

/* fmax() without its rules for NaN, which loops over points would pay for. */
static inline double eo_loaded_larger(double a, double b)
{
  return a > b ? a : b;
}

/* In loaded.c. */

/* Loads and their rates at ws->local; the residual of the rank + 1 equations at (a, Z). */
void eo_loaded_carry(struct eo_loaded_workspace *ws, const struct eo_contact_position *position, const double *mode,
                     double force);

/* ws->bend = F a. */
void eo_loaded_bend(struct eo_loaded_workspace *ws, const struct eo_contact_position *position, const double *mode);

/* Half the change of the local approach over each cell, from its neighbours on the line; returns its largest change. */
double eo_loaded_spread_cells(struct eo_loaded_workspace *ws, const struct eo_contact_position *position);

/* Deflection of the present loads by the part of the compliance that the modes leave out, into ws->correction; returns
   its largest change. */
double eo_loaded_blend(struct eo_loaded_workspace *ws, const struct eo_contact_position *position);

/* The inverse of Newton's matrix at the present rates; false: it is not positive definite. */
bool eo_loaded_factorise(struct eo_loaded_workspace *ws, const struct eo_contact_position *position);

/* ws->step from ws->residual with the last matrix. */
void eo_loaded_newton_step(struct eo_loaded_workspace *ws, const struct eo_contact_position *position);

/* How far a step goes, m: sqrt(r'H^-1 r dZ/dP), the approach that stores as much energy; at least that of the step. */
double eo_loaded_step_length(const struct eo_loaded_workspace *ws, const struct eo_contact_position *position);

/* Newton on the convex function of (a, Z) from ws->mode, with its deflection in ws->bend. Leaves the loads, the inverse
   of the last matrix and (a, Z) of the solution; returns whether it converged. */
bool eo_loaded_newton(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem);

/* In loaded_response.c. */

/* ws->tangent = d(a, Z)/dP, unscaled, from the last factorisation: some nanometres of approach from the solution. */
void eo_loaded_follow(struct eo_loaded_workspace *ws, const struct eo_contact_position *position);

/* dZ/dP of the solution, unscaled. Leaves d(a, Z)/dP. Overwrites the loads and the correction. */
double eo_loaded_tangent(struct eo_loaded_workspace *ws, const struct eo_contact_position *position);

/* Z at the neighbouring loads, [EO_LOADED_NEARBY], of the solution whose tangent was found last. */
void eo_loaded_go_around(struct eo_loaded_workspace *ws, const struct eo_loaded_problem *problem, double factor,
                         double *nearby);

#endif
