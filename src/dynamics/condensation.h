/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The oscillator seen from its meshes at the harmonics of one speed: with D = K - (k w)^2 + i k w C,
     S_k X_k + F_k = P_k - T_k W_k,   S_k = (mesh' D^-1 mesh)^-1,   T_k = S_k mesh' D^-1 pulse,
   computed with the meshes stiffened by `shift` so that harmonic 0 exists although rigid rolling is free. */
#ifndef EASEOFF_DYNAMICS_CONDENSATION_H
#define EASEOFF_DYNAMICS_CONDENSATION_H

#include <complex.h>

#include "dynamics/oscillator.h"

struct eo_harmonic {
  double complex stiffness[2][2];                       /* S, N/m */
  double complex transfer[2][2];                        /* T: impact at end j felt by mesh i */
  double complex load[2];                               /* P, harmonic 0 only, N */
  double complex stiffness_slope[2][2];                 /* dS/dw */
  double complex transfer_slope[2][2];                  /* dT/dw */
  double complex mesh_response[2][EO_MAX_COORDINATES];  /* columns of (D + shift)^-1 mesh */
  double complex pulse_response[2][EO_MAX_COORDINATES]; /* columns of (D + shift)^-1 pulse */
  double load_response[EO_MAX_COORDINATES];             /* (D + shift)^-1 load, harmonic 0 only */
  double shift;                                         /* stiffness actually added in the meshes, N/m */
};

/* Fills harmonic[0..harmonics] at the angular frequency w > 0, with the slopes if asked for (else zero). */
void eo_condense(const struct eo_oscillator *oscillator, double frequency, int harmonics, bool slopes,
                 struct eo_harmonic *harmonic);

/* Response r_k of the coordinates to mesh forces F_k at deflections X_k (without prescribed motion) and impacts W_k. */
void eo_condensed_response(const struct eo_oscillator *oscillator, const struct eo_harmonic *harmonic, int k,
                           const double complex force[2], const double complex deflection[2],
                           const double complex impact[2], double complex *response);

#endif
