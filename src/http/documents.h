/* Documents that do not change while the server runs: OpenAPI, the field tables for the form, the examples. */
#ifndef EASEOFF_HTTP_DOCUMENTS_H
#define EASEOFF_HTTP_DOCUMENTS_H

#include "http/resource.h"

enum { EO_MOST_EXAMPLES = 16 };

struct eo_documents {
  struct eo_resource openapi, schema, list;
  int examples;
  struct eo_document_example {
    const char *name;
    struct eo_resource resource;
  } example[EO_MOST_EXAMPLES];
};

enum eo_code eo_documents_new(struct eo_documents **documents, struct eo_error *error);
void eo_documents_free(struct eo_documents *documents);

#endif
