/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `easeoff verify` for files of kind `contact` (geometry, modification, surfaces, gaps, unloaded and loaded contact,
   impact, flexibility of one gear pair, an independent computation) and `calculix` (three-dimensional contact finite
   elements). */
#ifndef EASEOFF_REFERENCE_VERIFY_CONTACT_H
#define EASEOFF_REFERENCE_VERIFY_CONTACT_H

#include "reference/verify.h"

enum eo_code eo_verify_contact(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);
enum eo_code eo_verify_calculix(struct eo_case *file, struct eo_verification *verification, struct eo_error *error);

/* Blocks with loaded contact. context: struct eo_contact_case. */
eo_verify_function eo_verify_contact_synthetic, eo_verify_contact_impact, eo_verify_contact_bulk,
    eo_verify_contact_table;

#endif
