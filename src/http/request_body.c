/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/request_body.h"

#include <stdlib.h>

#include "http/route.h"
#include "http/upload.h"

static bool decode(struct eo_request *request, const json_t *document, struct eo_faults *faults, void *order)
{
  eo_table_decode(request->route->order, document, NULL, order, faults);
  if (faults->count)
    eo_reply_faults(&request->reply, "", faults);
  return !faults->count;
}

/* Where there is a form, its parts; where the body may be left out, nothing in its place. */
static const json_t *find_document(struct eo_request *request, struct eo_faults *faults)
{
  if (request->upload)
    return request->document = eo_upload_document(request->upload, request->route->order, faults);
  if (request->route->takes_nothing && !request->body.size)
    return request->document = json_object();
  return eo_request_json(request);
}

bool eo_body_read(struct eo_request *request, void *order)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  const json_t *document = faults ? find_document(request, faults) : NULL;
  bool good = document && decode(request, document, faults, order);
  if (!document && !request->reply.status)
    eo_reply_no_memory(&request->reply);
  free(faults);
  return good;
}
