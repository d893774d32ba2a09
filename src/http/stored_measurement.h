/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stored measurements as documents: written as text, since their results are kept as text. */
#ifndef EASEOFF_HTTP_STORED_MEASUREMENT_H
#define EASEOFF_HTTP_STORED_MEASUREMENT_H

#include "http/reply.h"
#include "store/measurements.h"

/* Appends what is known of its storage and the document, a JSON object: its result or the summary. */
void eo_stored_measurement_write(const struct eo_stored_measurement *row, const char *document, struct eo_text *text);

/* A measurement as a document. */
struct eo_found_measurement {
  struct eo_text text; /* owned */
  int64_t id;
  char tag[EO_TAG];
};

/* Visits a row; context: a struct eo_found_measurement. */
enum eo_code eo_measurement_take(void *context, const struct eo_stored_measurement *row, struct eo_error *error);

void eo_reply_no_measurement(struct eo_reply *reply);

#endif
