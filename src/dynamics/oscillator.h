/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The form in which an oscillator with gear meshes reaches the solvers: coordinates r with unit mass,
     r" + C r' + K r + sum_j mesh_j F_j(X_j, X_j', phi) + sum_j pulse_j W_j(phi) = load,   X_j = mesh_j . r +
   motion_j(phi). The twelve degrees of freedom without their zero modes are one case, the single degree of freedom
   another. */
#ifndef EASEOFF_DYNAMICS_OSCILLATOR_H
#define EASEOFF_DYNAMICS_OSCILLATOR_H

#include <complex.h>
#include <stdbool.h>

#include "dynamics/law.h"

enum { EO_MAX_COORDINATES = 13, EO_MAX_HARMONICS = 256 };

struct eo_oscillator {
  int n;                                                     /* coordinates, 1..EO_MAX_COORDINATES */
  int ends;                                                  /* meshes, 1 or 2 */
  double stiffness[EO_MAX_COORDINATES * EO_MAX_COORDINATES]; /* [n][n], without the mesh, 1/s2 */
  double damping[EO_MAX_COORDINATES * EO_MAX_COORDINATES];   /* [n][n], 1/s */
  double mesh[2][EO_MAX_COORDINATES];                        /* dX_j/dr */
  double pulse[2][EO_MAX_COORDINATES];                       /* through which W_j acts */
  double load[EO_MAX_COORDINATES];                           /* constant loads */
  double shift; /* stiffness added in the meshes while condensing, N/m, > 0: any value of a sensible size gives the same
                   result */
  bool symmetric; /* both ends are mirror images of each other */
};

/* A periodic force W(phi). */
enum eo_pulse_shape { EO_PULSE_NONE, EO_PULSE_HALF_SINE, EO_PULSE_COSINE };
struct eo_pulse {
  enum eo_pulse_shape shape;
  double amplitude; /* N; the cosine's is multiplied by frequency^2 (an unbalance or base motion) */
  double start;     /* phase at which the half sine begins */
  double duration;  /* of the half sine, in mesh periods, 0 < d <= 1 */
};

/* What acts over one mesh cycle; phi = frequency t / (2 pi). */
struct eo_cycle {
  double frequency;            /* angular mesh frequency, rad/s, > 0 */
  const struct eo_law *law[2]; /* borrowed */
  double shift[2];             /* end j's law and pulse are taken at phi + shift[j] */
  double mesh_damping;         /* c_m, N s/m: c_m X' is part of F */
  bool gated;                  /* c_m X' acts only in contact */
  struct eo_pulse pulse[2];
  int motion_order;        /* prescribed motion added to the deflections at phi, for instance sin(beta_b) eps_z(phi) */
  const double *motion[2]; /* [1 + 2 order] Fourier series, m; its mean is ignored; NULL: none */
};

/* W(phi), and its complex harmonic k: W = W_0 + Re sum_k W_k exp(2 pi i k phi). */
double eo_pulse_value(const struct eo_pulse *pulse, double frequency, double phase);
double complex eo_pulse_harmonic(const struct eo_pulse *pulse, double frequency, double shift, int k);

#endif
