/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stored measurements as documents: what is known of their storage, and what was measured, which is kept as text. */
#ifndef EASEOFF_HTTP_STORED_MEASUREMENT_H
#define EASEOFF_HTTP_STORED_MEASUREMENT_H

#include "http/reply.h"
#include "store/measurements.h"

/* As it stands in a list, with the summary. New; NULL without memory. */
json_t *eo_listed_measurement_encode(const struct eo_stored_measurement *row);

/* A measurement as a document, with its result. */
struct eo_found_measurement {
  struct eo_text text; /* owned */
  int64_t id;
  char tag[EO_TAG];
};

/* Visits a row; context: a struct eo_found_measurement. */
enum eo_code eo_measurement_take(void *context, const struct eo_stored_measurement *row, struct eo_error *error);

/* 404: there is no such recording. */
void eo_reply_no_measurement(struct eo_reply *reply);

#endif
