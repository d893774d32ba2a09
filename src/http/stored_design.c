/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/stored_design.h"

#include <stdio.h>

#include "http/answers.h"
#include "http/http_private.h"

#define OF_ROW(member) EO_AT(struct eo_stored_design, member)
static const struct eo_outline_row listed_rows[] = {
    EO_KEY("id", "integer", "number of the design", OF_ROW(id)),
    EO_KEY("revision", "integer", "grows with each replacement", OF_ROW(revision)),
    EO_KEY("name", "text", "under which it is kept", OF_ROW(name)),
    EO_KEY("created", "text", "date and time, UTC", OF_ROW(created)),
    EO_KEY("updated", "text", "date and time, UTC", OF_ROW(updated)),
};
const struct eo_outline eo_outline_listed_design = EO_OUTLINE("ListedDesign", listed_rows);

static const struct eo_outline_row content_rows[] = {
    EO_KEY("design", "object", "as it came", .name = "Design", EO_AT(struct eo_stored_content, design)),
    EO_KEY("warnings", "[text]", "in plain words", EO_AT(struct eo_stored_content, warnings)),
};
const struct eo_outline eo_outline_stored_content = EO_OUTLINE(NULL, content_rows);
static const struct eo_outline_row stored_rows[] = {
    {.outline = &eo_outline_listed_design},
    {.outline = &eo_outline_stored_content},
};
const struct eo_outline eo_outline_stored_design = EO_OUTLINE("StoredDesign", stored_rows);

static void write_tag(const struct eo_stored_design *row, char tag[EO_TAG])
{
  snprintf(tag, EO_TAG, "%lld.%lld", (long long)row->id, (long long)row->revision);
}

enum eo_code eo_design_take(void *context, const struct eo_stored_design *row, struct eo_error *error)
{
  struct eo_found_design *found = context;
  found->id = row->id;
  write_tag(row, found->tag);
  found->revision = row->revision;
  found->head = eo_outline_encode(&eo_outline_listed_design, row);
  found->design = json_loads(row->document, 0, NULL);
  if (!found->design)
    found->design = json_null();
  return found->head ? EO_OK : eo_error_memory(error);
}

void eo_found_design_done(struct eo_found_design *found)
{
  json_decref(found->head);
  json_decref(found->design);
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
    good = eo_request_design(request, found.design, "", design, geometry, NULL);
  if (good && document)
    *document = json_incref(found.design);
  eo_found_design_done(&found);
  return good;
}
