/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Harmonic balance condensed on the deflections of the meshes: find X with S X + F(X) = P - T W + S motion, harmonic by
   harmonic. Teeth that stay in contact under an affine law need one linear solve; everything else goes to Newton with
   the analytic Jacobian (KINSOL) on a finer time grid. Mirror ends with equal laws are solved as one. */
#ifndef EASEOFF_DYNAMICS_BALANCE_H
#define EASEOFF_DYNAMICS_BALANCE_H

#include "base/error.h"
#include "dynamics/alternating.h"
#include "dynamics/condensation.h"

struct eo_balance; /* workspace; one thread at a time */

struct eo_balance_report {
  bool converged;
  bool linear;     /* the teeth stay in contact under an affine law: the solution is exact up to truncation */
  int iterations;  /* of Newton's method, 0 for a linear solve */
  double residual; /* largest harmonic of the force balance left over / mean load */
  const struct eo_alternating
      *grid; /* the time grid on which the solution was found: forces, contact; until the next solve */
  int ends;  /* ends on that grid: 1 when mirror ends were solved as one */
};

/* harmonics 1..EO_MAX_HARMONICS; samples of the fine grid, > 2 harmonics (0: 16 per harmonic, at least 256).
   Errors: EO_ERROR_INPUT, EO_ERROR_MEMORY. */
enum eo_code eo_balance_new(struct eo_balance **workspace, int harmonics, int samples, struct eo_error *error);
void eo_balance_free(struct eo_balance *workspace); /* NULL is fine */
int eo_balance_harmonics(const struct eo_balance *workspace);

/* Solves at the frequency of the cycle, for which harmonic[0..harmonics] was condensed. x[2][1 + 2 harmonics] holds the
   deflections, m: the result, and with warm the guess as well (no linear solve is tried then). Not converging is an
   outcome. Errors: EO_ERROR_MEMORY. */
enum eo_code eo_balance_solve(struct eo_balance *workspace, const struct eo_oscillator *oscillator,
                              const struct eo_harmonic *harmonic, const struct eo_cycle *cycle, bool warm, double *x,
                              struct eo_balance_report *report, struct eo_error *error);

/* Residual of the balance, its Jacobian and its slope with frequency at x, for continuation; both ends are always kept.
   `harmonic` must carry slopes. residual[n], jacobian[n][n], slope[n] with n = ends (1 + 2 harmonics); scaled by the
   mean load. */
enum eo_code eo_balance_linearise(struct eo_balance *workspace, const struct eo_oscillator *oscillator,
                                  const struct eo_harmonic *harmonic, const struct eo_cycle *cycle, const double *x,
                                  double *residual, double *jacobian, double *slope, struct eo_error *error);

/* The fine time grid after eo_balance_linearise(). */
const struct eo_alternating *eo_balance_grid(const struct eo_balance *workspace);

/* Harmonic k of the prescribed motion of an end, without its mean. */
double complex eo_motion_harmonic(const struct eo_cycle *cycle, int end, int k);
double eo_motion_acceleration(const struct eo_cycle *cycle, int end, double phase);

/* Complex harmonics X_0..X_n of a series (X = X_0 + Re sum X_k exp(2 pi i k phi)), and back. */
static inline double complex eo_series_harmonic(const double *series, int k)
{
  return k ? series[2 * k - 1] - I * series[2 * k] : series[0];
}

#endif
