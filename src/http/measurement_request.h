/* What the endpoints about measurements share. */
#ifndef EASEOFF_HTTP_MEASUREMENT_REQUEST_H
#define EASEOFF_HTTP_MEASUREMENT_REQUEST_H

#include "http/request.h"
#include "store/measurements.h"

/* A stored design, read and completed; false: the reply says what is wrong, unless *missing. document (may be NULL): as
   it is stored, the caller's. */
bool eo_request_stored_design(struct eo_request *request, int64_t id, struct eo_design *design,
                              struct eo_geometry *geometry, json_t **document, bool *missing);

/* A measurement as a document. */
struct eo_found_measurement {
  struct eo_text text; /* owned */
  int64_t id;
  char tag[EO_TAG];
};

/* Visits a row; context: a struct eo_found_measurement. */
enum eo_code eo_measurement_take(void *context, const struct eo_stored_measurement *row, struct eo_error *error);

/* The handler of POST /measurements, on the thread that reads recordings, and the parts of its form. */
void eo_measurement_add(struct eo_request *request);
extern const struct eo_table eo_measurement_form;

void eo_reply_no_measurement(struct eo_request *request);

#endif
