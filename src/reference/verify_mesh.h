/* Mesh laws and parameters of the lumped model in the way case files of kind "dynamics" write them.
   Laws: stiffness {k0, a, b}; power {p, K: {k0, a, b}, e: {k0, a, b}} or flat {p, k0, a, b, e0, ea, eb}; table {P, Z};
   tangent {P, Z, kt} and secant {P, Z, Zd}, Z and kt sampled over one cycle. SI. */
#ifndef EASEOFF_REFERENCE_VERIFY_MESH_H
#define EASEOFF_REFERENCE_VERIFY_MESH_H

#include "reference/verify.h"
#include "dynamics/law.h"
#include "dynamics/parameters.h"

/* A law given in place or by name: the file's key law_NAME or table_NAME. tau: half the backlash, m.
   Errors: EO_ERROR_INPUT with a pointer into the file, EO_ERROR_MEMORY. */
enum eo_code eo_verify_read_law(struct eo_verification *verification, const json_t *cases, const json_t *law,
                                double tau, struct eo_law *out, struct eo_error *error);

/* What is not there is NaN, torsional coupling 0. name: of the case, for keys that nobody knows. */
struct eo_dynamics_parameters eo_verify_read_parameters(struct eo_verification *verification, const char *name,
                                                        const json_t *params);

/* Adds the file's torsional_coupling to "pinion", "gear" or both members (any other word), where its parameters
   have none; "none" and NULL change nothing. */
void eo_verify_couple(const json_t *cases, const char *coupling, struct eo_dynamics_parameters *parameters);

#endif
