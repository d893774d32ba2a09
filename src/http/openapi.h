/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The OpenAPI 3.1 document, made from the table of routes, the field tables and the shapes of the smaller documents. */
#ifndef EASEOFF_HTTP_OPENAPI_H
#define EASEOFF_HTTP_OPENAPI_H

#include <jansson.h>

struct eo_route;

/* routes: NULL after the last table. NULL without memory. */
json_t *eo_openapi(const struct eo_route *const *routes);

#endif
