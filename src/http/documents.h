/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Documents that do not change while the server runs: OpenAPI, the field tables for the form, the examples. */
#ifndef EASEOFF_HTTP_DOCUMENTS_H
#define EASEOFF_HTTP_DOCUMENTS_H

#include "http/limits.h"
#include "http/resource.h"
#include "service/service_limits.h"

struct eo_route;

enum { EO_MOST_EXAMPLES = 16 };

struct eo_documents {
  struct eo_resource openapi, schema, list;
  int examples;
  struct eo_document_example {
    const char *name;
    struct eo_resource resource;
  } example[EO_MOST_EXAMPLES];
};

/* routes: what OpenAPI describes, NULL after the last table; http, work: what this server allows. Errors: memory. */
enum eo_code eo_documents_new(struct eo_documents **documents, const struct eo_route *const *routes,
                              const struct eo_http_limits *http, const struct eo_service_limits *work,
                              struct eo_error *error);
void eo_documents_free(struct eo_documents *documents);

#endif
