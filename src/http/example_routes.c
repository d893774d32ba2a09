/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Designs to start from. */
#include <string.h>

#include "http/documents.h"
#include "http/route.h"
#include "http/http_private.h"

static void list_examples(struct eo_request *request)
{
  eo_request_resource(request, &request->http->documents->list);
}

static void get_example(struct eo_request *request)
{
  const struct eo_documents *documents = request->http->documents;
  for (int i = 0; i < documents->examples; i++)
    if (strcmp(documents->example[i].name, request->argument[0]) == 0) {
      eo_request_resource(request, &documents->example[i].resource);
      return;
    }
  eo_reply_problem(&request->reply, 404, NULL, "There is no example of this name; " EO_API "/examples lists them.");
}

const struct eo_route eo_routes_examples[] = {
    {.method = EO_GET,
     .pattern = "/examples",
     .handle = list_examples,
     .name = "listExamples",
     .summary = "The designs to start from.",
     .gives = "200 Examples",
     .headers = "If-None-Match"},
    {.method = EO_GET,
     .pattern = "/examples/{name}",
     .handle = get_example,
     .name = "getExample",
     .summary = "A design to start from, with every key; null where the value is derived from the others.",
     .gives = "200 Design",
     .headers = "If-None-Match"},
    {0}};
