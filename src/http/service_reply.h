/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Between endpoints and the service: questions that are answered from its threads, and what its answers are as replies.
 */
#ifndef EASEOFF_HTTP_SERVICE_REPLY_H
#define EASEOFF_HTTP_SERVICE_REPLY_H

#include "http/request.h"
#include "service/service.h"

/* A question with what the headers say; its answer becomes the reply. */
struct eo_question eo_request_to_question(struct eo_request *request, const struct eo_design *design,
                                          const struct eo_warnings *warnings);

/* Reads Easeoff-Lane; false: the reply says what is wrong with it. */
bool eo_request_lane(struct eo_request *request, struct eo_question *question);

/* After asking (and eo_request_defer()): what was not accepted is answered here; nobody else will. */
void eo_reply_unless_accepted(struct eo_request *request, enum eo_code code, enum eo_admission admission, int64_t job,
                              const struct eo_error *error);

/* Hands work on the pair of a design to the service, which releases it in any case; its answer becomes the reply. */
void eo_request_compute(struct eo_request *request, const struct eo_design *design, const struct eo_work *work);

#endif
