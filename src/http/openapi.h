/* The OpenAPI 3.1 document, made from the table of routes, the field tables and the shapes of the smaller documents. */
#ifndef EASEOFF_HTTP_OPENAPI_H
#define EASEOFF_HTTP_OPENAPI_H

#include <jansson.h>

/* NULL without memory. */
json_t *eo_openapi(void);

/* "components": the schemas. */
json_t *eo_openapi_schemas(void);

#endif
