/* `easeoff verify` for files of kind `contact` (geometry, modification, surfaces, gaps, unloaded and loaded contact,
   impact, flexibility of one gear pair, an independent computation) and `calculix` (three-dimensional contact finite
   elements). */
#ifndef EASEOFF_REFERENCE_VERIFY_CONTACT_H
#define EASEOFF_REFERENCE_VERIFY_CONTACT_H

#include "reference/verify.h"
#include "design/design.h"
#include "contact/loaded.h"

enum eo_code eo_verify_contact(const json_t *cases, struct eo_verification *verification, struct eo_error *error);
enum eo_code eo_verify_calculix(const json_t *cases, struct eo_verification *verification, struct eo_error *error);

/* A contact file and what its blocks share. */
struct eo_contact_case {
  const json_t *file;
  struct eo_verification *v;
  struct eo_design design; /* of macro.input */
  struct eo_geometry geometry;
};

/* The modification of that name in the file; "unmod" and unknown names are none (unknown ones are noted). */
void eo_contact_case_modification(struct eo_contact_case *c, const char *name, struct eo_flank_modification *flank);

/* The blocks with loaded contact: ltca_synthetic, impact, fe_bulk, ltca_table. */
enum eo_code eo_verify_contact_loaded(struct eo_contact_case *c, struct eo_error *error);

#endif
