/* What the endpoints about measurements share. */
#ifndef EASEOFF_HTTP_MEASUREMENT_H
#define EASEOFF_HTTP_MEASUREMENT_H

#include "http/request.h"

/* A stored design, read and completed; false: the reply says what is wrong, unless *missing. document (may be NULL): as it is stored, the
   caller's. */
bool eo_request_stored_design(struct eo_request *request, int64_t id, struct eo_design *design, struct eo_geometry *geometry, json_t **document,
                              bool *missing);

void eo_reply_no_measurement(struct eo_request *request);

#endif
