/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mesh laws and parameters of the lumped model in the way case files of kind "dynamics" write them.
   Laws: stiffness {k0, a, b}; power {p, K: {k0, a, b}, e: {k0, a, b}} or flat {p, k0, a, b, e0, ea, eb}; table {P, Z};
   tangent {P, Z, kt} and secant {P, Z, Zd}, Z and kt sampled over one cycle. SI. */
#ifndef EASEOFF_REFERENCE_VERIFY_MESH_H
#define EASEOFF_REFERENCE_VERIFY_MESH_H

#include "dynamics/law.h"
#include "dynamics/parameters.h"
#include "reference/verify.h"

/* A law given in place or by name: the file's key law_NAME or table_NAME. tau: half the backlash, m. What cannot be
   understood is a fault of the file. Errors: EO_ERROR_INPUT of the law, EO_ERROR_MEMORY. */
enum eo_code eo_verify_read_law(struct eo_case *file, struct eo_case *law, double tau, struct eo_law *out,
                                struct eo_error *error);

/* Damping and stiffness of the groove's torsion are 0 when absent; all else is needed. *tau: 0 when absent. */
void eo_verify_read_parameters(struct eo_case *params, struct eo_dynamics_parameters *out, double *tau);

/* A case's "coupling": adds the file's torsional_coupling to "pinion", "gear" or "both" members, where its parameters
   have none; "none" and no key change nothing. */
void eo_verify_couple(struct eo_case *file, struct eo_case *item, struct eo_dynamics_parameters *parameters);

#endif
