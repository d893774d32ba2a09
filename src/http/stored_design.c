/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/stored_design.h"

#include <stdio.h>

#include "http/http_private.h"

json_t *eo_stored_design_encode(const struct eo_stored_design *row)
{
  return json_pack("{s:I, s:I, s:s, s:s, s:s}", "id", (json_int_t)row->id, "revision", (json_int_t)row->revision,
                   "name", row->name, "created", row->created, "updated", row->updated);
}

static void write_tag(const struct eo_stored_design *row, char tag[EO_TAG])
{
  snprintf(tag, EO_TAG, "%lld.%lld", (long long)row->id, (long long)row->revision);
}

enum eo_code eo_design_take(void *context, const struct eo_stored_design *row, struct eo_error *error)
{
  struct eo_found_design *found = context;
  found->id = row->id;
  write_tag(row, found->tag);
  found->document = eo_stored_design_encode(row);
  json_t *design = json_loads(row->document, 0, NULL);
  return json_object_set_new(found->document, "design", design ? design : json_null()) ? eo_error_memory(error) : EO_OK;
}

bool eo_request_stored_design(struct eo_request *request, int64_t id, struct eo_design *design,
                              struct eo_geometry *geometry, json_t **document, bool *missing)
{
  struct eo_found_design found = {0};
  struct eo_error error;
  enum eo_design_outcome outcome;
  bool good = false;
  *missing = false;
  if (eo_store_find_design(request->store, id, eo_design_take, &found, &outcome, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_DESIGN_MISSING)
    *missing = true;
  else
    good = eo_request_design(request, json_object_get(found.document, "design"), "", design, geometry, NULL);
  if (good && document)
    *document = json_incref(json_object_get(found.document, "design"));
  json_decref(found.document);
  return good;
}
