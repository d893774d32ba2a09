/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The OpenAPI 3.1 document, made from the table of routes, the field tables and the shapes of the smaller documents. */
#ifndef EASEOFF_HTTP_OPENAPI_H
#define EASEOFF_HTTP_OPENAPI_H

#include <jansson.h>

#include "http/limits.h"
#include "service/service_limits.h"

struct eo_route;

/* routes: NULL after the last table; http, work: what this server allows. NULL without memory. */
json_t *eo_openapi(const struct eo_route *const *routes, const struct eo_http_limits *http,
                   const struct eo_service_limits *work);

#endif
