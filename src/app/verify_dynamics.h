/* `easeoff verify` for files of kind `dynamics`: every block of such a file through the dynamics floor.
   Understood blocks, each optional, with any number of entries:
     geometry.z1                  pinion teeth (17 when missing)
     defaults, torsional_coupling parameters for the blocks that carry none
     law_NAME, table_NAME         laws and tables that cases name
     eigen[]                      eigenfrequencies, damping ratios, number of zero modes
     negative_control_literal_signs  the pole of the printed signs
     dynamics[]                   periodic responses
     sdof.cases[], sdof.folds     the single degree of freedom
   Laws: stiffness {k0, a, b}; power {p, K: {k0, a, b}, e: {k0, a, b}} or flat {p, k0, a, b, e0, ea, eb}; table {P, Z};
   tangent {P, Z, kt} and secant {P, Z, Zd}, Z and kt sampled over one cycle. A case's law is a name, an object, or a pair
   [left, right] of them. */
#ifndef EASEOFF_APP_VERIFY_DYNAMICS_H
#define EASEOFF_APP_VERIFY_DYNAMICS_H

#include <jansson.h>

#include "base/error.h"

/* Appends to rows (an array) one object {case, quantity, value, expected, tolerance, pass} per expected number; value is null
   when there is none (not converged). Errors: EO_ERROR_INPUT with a pointer into the file, EO_ERROR_MEMORY, EO_ERROR_NUMERIC. */
enum eo_code eo_verify_dynamics(const json_t *cases, json_t *rows, struct eo_error *error);

#endif
