/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stored designs as documents, and as designs. */
#ifndef EASEOFF_HTTP_STORED_DESIGN_H
#define EASEOFF_HTTP_STORED_DESIGN_H

#include "http/request.h"
#include "store/designs.h"

/* Without the design: a row of a list. */
json_t *eo_stored_design_encode(const struct eo_stored_design *row);

/* A row on its way into a reply. */
struct eo_found_design {
  json_t *document; /* owned; with the design */
  int64_t id;
  char tag[EO_TAG];
};

/* Visits a row; context: a struct eo_found_design. */
enum eo_code eo_design_take(void *context, const struct eo_stored_design *row, struct eo_error *error);

/* A stored design, read and completed; false: the reply says what is wrong, unless *missing. document (may be NULL): as
   it is stored, the caller's. */
bool eo_request_stored_design(struct eo_request *request, int64_t id, struct eo_design *design,
                              struct eo_geometry *geometry, json_t **document, bool *missing);

#endif
