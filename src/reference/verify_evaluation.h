/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `easeoff verify` for files of kind `evaluation`: modification -> loaded contact -> impact -> vibration of whole gear
   pairs, with the finite-element or the closed-form compliance the file states, against an independent computation; and
   its stage arrays through the dynamics alone. */
#ifndef EASEOFF_REFERENCE_VERIFY_EVALUATION_H
#define EASEOFF_REFERENCE_VERIFY_EVALUATION_H

#include "design/design.h"
#include "reference/verify.h"

enum eo_code eo_verify_evaluation(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* The stage arrays of a case through the dynamics alone, against what `out` of it expects. */
enum eo_code eo_verify_stage_arrays(struct eo_verification *verification, struct eo_case *out, struct eo_case *item,
                                    const struct eo_geometry *geometry, const struct eo_design *design,
                                    struct eo_error *error);

#endif
