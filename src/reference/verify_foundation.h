/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loaded contact on an uncoupled foundation, solved by the loaded contact of the program, for cases with closed-form
   answers. */
#ifndef EASEOFF_REFERENCE_VERIFY_FOUNDATION_H
#define EASEOFF_REFERENCE_VERIFY_FOUNDATION_H

#include "base/error.h"
#include "gear/geometry.h"

/* Load distribution factor K_H_beta = largest over mean line load of rigid faces that are misaligned by `misalignment`
   over the face width (m), on springs of `stiffness` per face width (Pa), under the mean load line_load per face width
   (N/m). */
enum eo_code eo_verify_load_distribution(double stiffness, double line_load, double misalignment, double *factor,
                                         struct eo_error *error);

/* Unmodified teeth on a uniform foundation: peak-to-peak of the loaded transmission error over the mesh cycle, m, and
   the relative variation of the total length of contact lines. */
enum eo_code eo_verify_overlap(const struct eo_geometry *geometry, double *peak_to_peak, double *length_variation,
                               struct eo_error *error);

#endif
