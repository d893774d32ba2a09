/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh law of one end: the normal force of the teeth as a function of the deflection X and the mesh phase, without
   the mesh damping. Everything that depends on the phase is a Fourier series, so a law is as smooth in phase as its
   order. */
#ifndef EASEOFF_DYNAMICS_LAW_H
#define EASEOFF_DYNAMICS_LAW_H

#include "base/error.h"

#include <stdbool.h>

enum eo_law_kind {
  EO_MESH_STIFFNESS, /* F = k(phi) (X - front) while X > front: the secant law, theory (L1); rows: k */
  EO_MESH_POWER,     /* F = K(phi) (X - front - e(phi))^exponent; rows: K, e */
  EO_MESH_TABLE,     /* F piecewise linear through (Z_i(phi) + front, load_i), 0 below the first load; rows: Z_i */
  EO_MESH_TANGENT, /* F = P + k_tan(phi) (X - front - Z(phi)), 0 where that is negative: the teeth part; rows: Z, k_tan
                    */
};

/* The back flanks touch where X < back. The stiffness law uses k(phi) there, the others back_stiffness
   (0: they never touch): the coast flanks' own static curve is not computed, so a constant stands for it. */
struct eo_law {
  enum eo_law_kind kind;
  int rows, order;
  double *series; /* [rows][1 + 2 order], SI; owned */
  double *load;   /* [rows] of the table law, N, ascending; owned */
  int capacity;   /* numbers that fit into series; load holds as many */
  double front;   /* deflection at which unmodified front flanks touch, m: + tau when X counts from mid-backlash, 0 from
                     contact */
  double back;    /* deflection below which the back flanks touch, m: - tau or - 2 tau */
  double back_stiffness; /* N/m */
  double exponent;       /* of the power law, >= 1 */
  double nominal;        /* P of the tangent law, N */
};

/* Force and slope at one deflection. Contact is where margin > 0: the penetration of the flank nearer to touching, m.
 */
struct eo_mesh_force {
  double force;        /* N, negative on the back flanks */
  double slope;        /* dF/dX, N/m */
  double margin;       /* m */
  double margin_slope; /* d margin / dX: +1 front, -1 back */
};

/* All zero is a valid empty law. The set functions copy their arrays, reuse the law's memory when it is large enough
   and leave it untouched on error. Errors: EO_ERROR_INPUT (order, rows, signs, values that are not finite),
   EO_ERROR_MEMORY. */
void eo_law_done(struct eo_law *law); /* NULL is fine */

/* F = k f(X) with the backlash function between back and front. k: series of the given order, positive at every phase.
 */
enum eo_code eo_law_set_stiffness(struct eo_law *law, int order, const double *k, double front, double back,
                                  struct eo_error *error);

/* coefficient, offset: series of the given order. */
enum eo_code eo_law_set_power(struct eo_law *law, int order, const double *coefficient, const double *offset,
                              double exponent, double front, struct eo_error *error);

/* deflection[rows][positions] at equidistant phases, m; load[rows] ascending, N; at least two rows. Every row is
   interpolated by its Fourier series up to the given order (at most positions / 2, the Nyquist term as a cosine). */
enum eo_code eo_law_set_table(struct eo_law *law, int rows, int positions, const double *load, const double *deflection,
                              int order, double front, struct eo_error *error);

/* deflection[positions] Z at the load, m; tangent[positions] k_tan, N/m; both cut off at the given order; nominal load
   P > 0; back: X below which the back flanks touch with the mean tangent stiffness (- 2 tau). */
enum eo_code eo_law_set_tangent(struct eo_law *law, int positions, const double *deflection, const double *tangent,
                                double nominal, int order, double back, struct eo_error *error);

/* Back flanks of a power or table law (its set function leaves it without): they touch where X < back, with a constant
   stiffness > 0. Errors: EO_ERROR_INPUT. */
enum eo_code eo_law_set_back(struct eo_law *law, double back, double stiffness, struct eo_error *error);

/* Secant law k_m = P / (Z - datum) of the same arrays, X counted from the datum (first contact anywhere on the flank).
 */
enum eo_code eo_law_set_secant(struct eo_law *law, int positions, const double *deflection, double nominal,
                               double datum, int order, double back, struct eo_error *error);

/* The law of a cycle that runs the other way: F(X, -phi). */
void eo_law_reverse(struct eo_law *law);

/* The same law in memory of its own. Errors: EO_ERROR_MEMORY. */
enum eo_code eo_law_copy(struct eo_law *law, const struct eo_law *source, struct eo_error *error);

/* Values of the rows at one phase, row[rows]; law->rows numbers. */
void eo_law_rows(const struct eo_law *law, double phase, double *row);

/* The force at deflection x where the rows have the given values. With attached != 0 the first branch of the law is
   continued beyond separation (the linear law of teeth that stay in contact). */
struct eo_mesh_force eo_law_force(const struct eo_law *law, const double *row, double x, int attached);

/* Non-zero when F is affine in X while the teeth stay in contact. */
int eo_law_is_affine(const struct eo_law *law);

/* Deflection at which rows of these values carry the load > 0: the static guess, m. */
double eo_law_deflection(const struct eo_law *law, const double *row, double load);

/* Whether the front flanks of a table law touch above the deflection x, m, at every one of 256 equidistant phases and
   from contact on. */
bool eo_law_touches_above(const struct eo_law *law, double x);

/* Non-zero when the two laws are the same function. */
int eo_law_equal(const struct eo_law *a, const struct eo_law *b);

#endif
