/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Transmission error of two measured angles, TE = r_b,gear phi_gear - r_b,pinion phi_pinion (transverse, along the line
   of action; theory (M1): with the radii exchanged, a plausible signal, for 17:44 two to three times too
   large), and what least squares on its samples tell: drift, shaft orders and mesh orders together, over the measured
   angle of the pinion. Accelerations are (h z omega)^2 times the amplitudes, omega the mean speed of the rows that were
   used: nothing is differentiated. Where the speed changes, the mean amplitudes stand for all of it and the tracks tell
   what each stretch has at its own speed. */
#ifndef EASEOFF_MEASUREMENT_TRANSMISSION_H
#define EASEOFF_MEASUREMENT_TRANSMISSION_H

#include "measurement/angles.h"
#include "measurement/orders.h"

enum { EO_USUAL_ORDERS = 8 }; /* of the mesh */

struct eo_transmission_settings {
  int teeth[2];
  double base_radius[2]; /* m */
  int harmonics;         /* mesh orders, 1..EO_MESH_ORDERS; 0: EO_USUAL_ORDERS */
  struct eo_part_choice part;
};

/* Chooses the rows and fits everything above. Findings are added: too short, unsteady, sample rate, resolution, level
   steps; after a refusal the result is empty. Errors: memory, files, cancelled. eo_transmission_done() also after an
   error. */
enum eo_code eo_transmission_measure(struct eo_transmission *result, const struct eo_angles *angles,
                                     const struct eo_transmission_settings *settings, struct eo_findings *findings,
                                     const struct eo_progress *progress, struct eo_error *error);
#endif
