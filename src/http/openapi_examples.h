/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Examples of bodies and answers in the API's description. The tests send each body, and hold each answer against what
   the server then says. */
#ifndef EASEOFF_HTTP_OPENAPI_EXAMPLES_H
#define EASEOFF_HTTP_OPENAPI_EXAMPLES_H

#include <jansson.h>

#include "http/route.h"

/* A body that the operation takes; NULL: there is none in JSON, or no memory. */
json_t *eo_openapi_body_example(const struct eo_route *route);

/* An answer of this schema, NULL: none is short enough to be one. */
json_t *eo_openapi_answer_example(const char *schema, size_t length);

#endif
