/* A short notation for the JSON Schema of small documents, so that a reader sees the document and not the schema:

     { status 'ok|failing', uptime_s number, jobs {queued integer, running integer}, next text?, note? text, items
   [Job], best {...}? }

   text, number, integer, flag, any, 'one|of|these', [array], {object}, Name: another schema of the OpenAPI document.
   `?` after a type: or null; after a key: it may be missing. "..." as the last member: more keys may stand beside them;
   otherwise there are no others. */
#ifndef EASEOFF_HTTP_SHAPE_H
#define EASEOFF_HTTP_SHAPE_H

#include <jansson.h>

/* New JSON Schema; NULL without memory or when the notation is wrong. */
json_t *eo_shape_schema(const char *notation);

#endif
