/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stored designs. The revision is the entity tag, so that nobody overwrites what he has not seen. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "http/request_body.h"
#include "format/object.h"
#include "format/list_page.h"
#include "http/answers.h"
#include "http/stored_design.h"
#include "http/route.h"
#include "http/http_private.h"
#include "store/designs.h"

enum { MOST_DESIGNS = 100000, MOST_LISTED = 200 };

static void reply_missing(struct eo_request *request)
{
  eo_reply_problem(&request->reply, 404, NULL, "There is no design with this number.");
}

static void reply_found(struct eo_request *request, unsigned status, const struct eo_found_design *found,
                        const struct eo_warnings *warnings)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; warnings && i < warnings->count; i++)
    eo_list_add(&list, json_string(warnings->text[i]));
  const struct eo_stored_content content = {json_incref(found->design), eo_object_close(&list)};
  json_t *document = json_incref(found->head), *behind = eo_outline_encode(&eo_outline_stored_content, &content);
  if (!behind || json_object_update(document, behind)) {
    json_decref(document);
    document = NULL;
  }
  json_decref(behind);
  eo_reply_json(&request->reply, status, document);
  snprintf(request->reply.tag, sizeof request->reply.tag, "%s", found->tag);
  request->reply.revalidate = true;
}

static void get_one(struct eo_request *request)
{
  struct eo_found_design found = {0};
  struct eo_error error;
  enum eo_design_outcome outcome;
  int64_t id;
  if (!eo_request_id_at(request, 0, &id))
    return;
  if (eo_store_find_design(request->store, id, eo_design_take, &found, &outcome, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_DESIGN_MISSING)
    reply_missing(request);
  else if (!eo_request_unchanged(request, found.tag))
    reply_found(request, 200, &found, NULL);
  eo_found_design_done(&found);
}

struct page {
  json_t *items;
  int limit;
  int64_t last;
  bool more;
};

static const struct eo_outline_row designs_rows[] = {
    EO_PAGE_ROWS("newest first", .outline = &eo_outline_listed_design),
};
const struct eo_outline eo_outline_designs = EO_OUTLINE("Designs", designs_rows);

static enum eo_code visit_listed(void *context, const struct eo_stored_design *row, struct eo_error *error)
{
  struct page *page = context;
  if ((int)json_array_size(page->items) == page->limit) {
    page->more = true;
    return EO_OK;
  }
  page->last = row->id;
  return json_array_append_new(page->items, eo_outline_encode(&eo_outline_listed_design, row)) ? eo_error_memory(error)
                                                                                               : EO_OK;
}

static void list(struct eo_request *request)
{
  struct eo_error error;
  struct page page = {.items = json_array(), .limit = (int)eo_route_number(request, "limit")};
  int64_t before = (int64_t)eo_route_number(request, "cursor");
  if (eo_store_list_designs(request->store, before, page.limit + 1, visit_listed, &page, &error)) {
    json_decref(page.items);
    eo_reply_error(&request->reply, "", &error);
    return;
  }
  eo_reply_json(&request->reply, 200, eo_page_encode(&eo_outline_designs, page.items, page.more, page.last));
}

/* A body is a design, or a design with a name. */
struct order {
  char name[EO_NAME_LENGTH];
  const json_t *design;
};
static const struct eo_field order_fields[] = {
    EO_TEXT_DERIVED(struct order, name, "name", 1, "that of the design", "under which it is kept"),
    EO_DOCUMENT(struct order, design, "design", "Design", EO_FIELD_REQUIRED, "what is kept"),
};
static const struct eo_table order_table = EO_TABLE("a design with its name", struct order, order_fields);

/* What is to be kept. */
struct given {
  char name[EO_NAME_LENGTH];
  char *text; /* JSON as it came, owned: defaults that change later are not frozen into it */
  struct eo_warnings warnings;
};

static bool read_order(struct eo_request *request, bool named, struct order *order)
{
  *order = (struct order){.design = eo_request_json(request)};
  return named ? eo_body_read(request, order) : order->design != NULL;
}

static bool read_given(struct eo_request *request, struct given *given)
{
  struct order order;
  struct eo_design design;
  struct eo_geometry geometry;
  bool named = json_object_get(eo_request_json(request), "design");
  if (!read_order(request, named, &order) ||
      !eo_request_design(request, order.design, named ? "/design" : "", &design, &geometry, &given->warnings))
    return false;
  snprintf(given->name, sizeof given->name, "%s", *order.name ? order.name : *design.name ? design.name : "unnamed");
  given->text = json_dumps(order.design, JSON_COMPACT);
  if (!given->text)
    eo_reply_no_memory(&request->reply);
  return given->text != NULL;
}

static void add(struct eo_request *request)
{
  struct given given = {0};
  struct eo_found_design found = {0};
  struct eo_error error;
  enum eo_design_outcome outcome;
  if (!read_given(request, &given))
    return;
  if (eo_store_add_design(request->store, given.name, given.text, MOST_DESIGNS, eo_design_take, &found, &outcome,
                          &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_DESIGN_FULL)
    eo_reply_problem(&request->reply, 507, "full", "%d designs are stored already.", MOST_DESIGNS);
  else {
    reply_found(request, 201, &found, &given.warnings);
    snprintf(request->reply.location, sizeof request->reply.location, EO_API "/designs/%lld", (long long)found.id);
  }
  eo_found_design_done(&found);
  free(given.text);
}

/* The revision that If-Match names: 0 for "*", -1 for one that this design never has; false: the reply asks for the
   header. */
static bool read_expected(struct eo_request *request, int64_t id, bool required, int64_t *expected)
{
  const char *header = eo_request_header(request, "If-Match");
  struct eo_found_design found = {0};
  struct eo_error error;
  enum eo_design_outcome outcome;
  *expected = 0;
  if (!header && required)
    eo_reply_problem(&request->reply, 428, NULL,
                     "Say with If-Match which version is to be replaced (the ETag of the design, or *).");
  if (!header)
    return !required;
  if (eo_store_find_design(request->store, id, eo_design_take, &found, &outcome, &error)) {
    eo_reply_error(&request->reply, "", &error);
    return false;
  }
  if (strcmp(header, "*") != 0 && outcome == EO_DESIGN_DONE)
    *expected = eo_field_lists_tag(header, found.tag, false) ? found.revision : -1;
  eo_found_design_done(&found);
  return true;
}

static void reply_stale(struct eo_request *request)
{
  eo_reply_problem(&request->reply, 412, "stale", "The design has changed since that version.");
}

static void replace(struct eo_request *request)
{
  struct given given = {0};
  struct eo_found_design found = {0};
  struct eo_error error;
  enum eo_design_outcome outcome;
  int64_t id, expected;
  if (!eo_request_id_at(request, 0, &id) || !read_expected(request, id, true, &expected) ||
      !read_given(request, &given))
    return;
  if (eo_store_change_design(request->store, id, expected, given.name, given.text, eo_design_take, &found, &outcome,
                             &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_DESIGN_MISSING)
    reply_missing(request);
  else if (outcome == EO_DESIGN_STALE)
    reply_stale(request);
  else
    reply_found(request, 200, &found, &given.warnings);
  eo_found_design_done(&found);
  free(given.text);
}

static void take_out(struct eo_request *request)
{
  struct eo_error error;
  enum eo_design_outcome outcome;
  int64_t id, expected;
  if (!eo_request_id_at(request, 0, &id) || !read_expected(request, id, false, &expected))
    return;
  if (eo_store_remove_design(request->store, id, expected, &outcome, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (outcome == EO_DESIGN_MISSING)
    reply_missing(request);
  else if (outcome == EO_DESIGN_STALE)
    reply_stale(request);
  else if (outcome == EO_DESIGN_USED)
    eo_reply_problem(&request->reply, 409, "in-use", "Measurements belong to this design; remove them first.");
  else
    eo_reply_empty(&request->reply, 204);
}

const struct eo_route eo_routes_designs[] = {{.method = EO_GET,
                                              .pattern = "/designs",
                                              .handle = list,
                                              .name = "listDesigns",
                                              .summary = "Stored designs, newest first.",
                                              .gives = "200 Designs",
                                              .query = {{"limit", 1, MOST_LISTED, 50, NULL, "most items"},
                                                        {"cursor", 1, 9e15, 0, NULL, "`next` of the page before"}}},
                                             {.method = EO_POST,
                                              .pattern = "/designs",
                                              .handle = add,
                                              .name = "addDesign",
                                              .summary = "Stores a design, alone or with a name.",
                                              .takes = "Design|NamedDesign",
                                              .order = &order_table,
                                              .gives = "201 StoredDesign",
                                              .rate = EO_RATE_QUESTION},
                                             {.method = EO_GET,
                                              .pattern = "/designs/{id}",
                                              .handle = get_one,
                                              .name = "getDesign",
                                              .summary = "A stored design as it came.",
                                              .gives = "200 StoredDesign",
                                              .headers = "If-None-Match"},
                                             {.method = EO_PUT,
                                              .pattern = "/designs/{id}",
                                              .handle = replace,
                                              .name = "replaceDesign",
                                              .summary = "Replaces a stored design.",
                                              .takes = "Design|NamedDesign",
                                              .order = &order_table,
                                              .gives = "200 StoredDesign",
                                              .headers = "If-Match",
                                              .rate = EO_RATE_QUESTION},
                                             {.method = EO_DELETE,
                                              .pattern = "/designs/{id}",
                                              .handle = take_out,
                                              .name = "removeDesign",
                                              .summary = "Removes a stored design.",
                                              .gives = "204 -",
                                              .headers = "If-Match"},
                                             {0}};
