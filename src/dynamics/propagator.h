/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact motion of the oscillator over one step while its meshes keep a constant stiffness: what integrators and
   multipliers take between two kicks. */
#ifndef EASEOFF_DYNAMICS_PROPAGATOR_H
#define EASEOFF_DYNAMICS_PROPAGATOR_H

#include "dynamics/oscillator.h"

/* propagator[2 n][2 n] = exp([0 rate; -K/rate -C] step): of positions, and of velocities over `rate`, 1/s, over the
   time `step`, s. K and C with the meshes, mean[end] N/m and mesh_damping N s/m each. */
void eo_propagator_fill(const struct eo_oscillator *oscillator, double mesh_damping, const double mean[2], double rate,
                        double step, double *propagator);

/* Angular frequency of the meshes alone, all their stiffness together, rad/s. */
double eo_propagator_mesh_rate(const struct eo_oscillator *oscillator, const double mean[2]);

#endif
