/* The documents of the API as JSON Schemas, "components" of OpenAPI: what comes in is described by the field tables of
   the routes, what the floors above write by their outlines, the rest stands in schemas.c in the short notation of
   shape.h. */
#ifndef EASEOFF_HTTP_SCHEMAS_H
#define EASEOFF_HTTP_SCHEMAS_H

#include <jansson.h>

struct eo_route;

/* routes: NULL after the last table. NULL without memory. */
json_t *eo_openapi_schemas(const struct eo_route *const *routes);

#endif
