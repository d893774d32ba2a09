/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stored designs as documents, and as designs. */
#ifndef EASEOFF_HTTP_STORED_DESIGN_H
#define EASEOFF_HTTP_STORED_DESIGN_H

#include "format/outline.h"
#include "http/request.h"
#include "store/designs.h"

/* A row on its way into a reply. */
struct eo_found_design {
  json_t *head;   /* as in a list; owned */
  json_t *design; /* owned */
  int64_t id, revision;
  char tag[EO_TAG];
};
void eo_found_design_done(struct eo_found_design *found);

/* What stands behind the head in the reply. */
struct eo_stored_content {
  json_t *design, *warnings;
};
extern const struct eo_outline eo_outline_stored_content;

/* Visits a row; context: a struct eo_found_design. */
enum eo_code eo_design_take(void *context, const struct eo_stored_design *row, struct eo_error *error);

/* A stored design, read and completed; false: the reply says what is wrong, unless *missing. document (may be NULL): as
   it is stored, the caller's. */
bool eo_request_stored_design(struct eo_request *request, int64_t id, struct eo_design *design,
                              struct eo_geometry *geometry, json_t **document, bool *missing);

#endif
