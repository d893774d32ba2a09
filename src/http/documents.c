/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/documents.h"

#include <stdlib.h>
#include <string.h>

#include "http/answers.h"
#include "format/object.h"
#include "document/examples.h"
#include "format/json.h"
#include "format/form.h"
#include "document/sweep_document.h"
#include "document/update_document.h"
#include "http/openapi.h"

/* Takes the document over. */
static enum eo_code put(struct eo_resource *resource, json_t *document, struct eo_error *error)
{
  struct eo_text text = {0};
  eo_json_write_new(&text, document, EO_JSON_COMPACT);
  eo_text_add(&text, "\n");
  enum eo_code code = eo_resource_init(resource, "application/json", &text, error);
  eo_text_done(&text);
  return code;
}

static enum eo_code put_examples(struct eo_documents *documents, struct eo_error *error)
{
  const struct eo_example *example;
  struct eo_object items = eo_list_open();
  enum eo_code code = EO_OK;
  struct eo_design design;
  for (int i = 0; !code && i < EO_MOST_EXAMPLES && (example = eo_example_at(i)); i++) {
    eo_list_add(&items, eo_outline_encode(&eo_outline_example, example));
    eo_example_build(example->name, &design);
    documents->example[i].name = example->name;
    code = put(&documents->example[i].resource, eo_design_encode(&design), error);
    documents->examples = i + 1;
  }
  const struct eo_listed_examples examples = {eo_object_close(&items)};
  json_t *list = eo_outline_encode(&eo_outline_examples, &examples);
  if (code)
    json_decref(list);
  return code ? code : put(&documents->list, list, error);
}

static enum eo_code put_all(struct eo_documents *documents, const struct eo_route *const *routes,
                            const struct eo_http_limits *http, const struct eo_service_limits *work,
                            struct eo_error *error)
{
  const struct eo_form form = {eo_table_fields(&eo_design_table), eo_table_fields(&eo_sweep_request_table),
                               eo_table_fields(&eo_update_table)};
  EO_TRY(put(&documents->schema, eo_outline_encode(&eo_outline_form, &form), error));
  EO_TRY(put(&documents->openapi, eo_openapi(routes, http, work), error));
  return put_examples(documents, error);
}

enum eo_code eo_documents_new(struct eo_documents **documents, const struct eo_route *const *routes,
                              const struct eo_http_limits *http, const struct eo_service_limits *work,
                              struct eo_error *error)
{
  struct eo_documents *made = calloc(1, sizeof *made);
  if (!made)
    return eo_error_memory(error);
  enum eo_code code = put_all(made, routes, http, work, error);
  if (code)
    eo_documents_free(made);
  else
    *documents = made;
  return code;
}

void eo_documents_free(struct eo_documents *documents)
{
  if (!documents)
    return;
  eo_resource_done(&documents->openapi);
  eo_resource_done(&documents->schema);
  eo_resource_done(&documents->list);
  for (int i = 0; i < documents->examples; i++)
    eo_resource_done(&documents->example[i].resource);
  free(documents);
}
