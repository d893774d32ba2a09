/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The documents of the API as JSON Schemas, "components" of OpenAPI: what comes in is described by the field tables of
   the routes, what goes out by outlines. */
#ifndef EASEOFF_HTTP_SCHEMAS_H
#define EASEOFF_HTTP_SCHEMAS_H

#include <jansson.h>

struct eo_route;

/* routes: NULL after the last table. NULL without memory. */
json_t *eo_openapi_schemas(const struct eo_route *const *routes);

#endif
