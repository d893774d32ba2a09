/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/rig_answer.h"

#include <string.h>

#include "document/design_document.h"
#include "format/json.h"
#include "format/object.h"

#include <config.h>

enum eo_code eo_rig_measured_read(const char *summary, struct eo_measured *measured, struct eo_error *error)
{
  json_t *document = json_loads(summary, 0, NULL);
  enum eo_code code = eo_measured_decode(document, measured, error);
  json_decref(document);
  return code;
}

/* Takes the document over. */
static void write(struct eo_text *text, json_t *document)
{
  if (document)
    eo_json_write(text, document, EO_JSON_COMPACT);
  text->failed = text->failed || !document;
  json_decref(document);
}

static json_t *encode_ids(const struct eo_rig_selection *selection)
{
  struct eo_object list = {.json = json_array()};
  for (int i = 0; i < selection->count; i++)
    list.failed = json_array_append_new(list.json, json_integer(selection->id[i])) != 0 || list.failed;
  return eo_object_close(&list);
}

static const struct eo_outline_row left_out_rows[] = {
    EO_KEY("id", "integer", "number of the measurement", EO_AT(struct eo_left_out, id)),
    EO_KEY("reason", "text", "why it was left out, for people", EO_AT(struct eo_left_out, reason)),
};
static const struct eo_outline left_out_outline = EO_OUTLINE("LeftOut", left_out_rows);

static json_t *encode_left_out(const struct eo_rig_selection *selection)
{
  struct eo_object list = {.json = json_array()};
  for (int i = 0; i < selection->left_outs; i++)
    list.failed = json_array_append_new(list.json, eo_outline_encode(&left_out_outline, &selection->left_out[i])) !=
                      0 ||
                  list.failed;
  return eo_object_close(&list);
}

static const struct eo_outline_row comparison_rows[] = {
    EO_KEY("program", "text", "name and version"),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design that predicts"),
    EO_KEY("id", "[integer]", "numbers of the measurements, in the order of the columns"),
    EO_KEY("left_out", "[object]", "measurements that cannot be compared", .outline = &left_out_outline),
    {.outline = &eo_comparison_outline},
};
const struct eo_outline eo_rig_comparison_outline = EO_OUTLINE("Comparison", comparison_rows);

/* The numbers of the measurements beside the rows that stand for them. */
static json_t *encode_comparison(const struct eo_rig_selection *selection, const struct eo_comparison *comparison,
                                 const struct eo_measured *measured, const struct eo_design *design)
{
  char hash[EO_HASH_LENGTH + 1];
  struct eo_object object = eo_object_open();
  json_t *inner = eo_comparison_encode(comparison, measured), *reduction;
  size_t i;
  object.failed = object.failed || !inner;
  json_array_foreach(json_object_get(inner, "reductions"), i, reduction)
      eo_json_put(reduction, "id", json_integer(selection->id[comparison->reduction[i].modified]), &object.failed);
  eo_object_put(&object, "program", json_string(PACKAGE_STRING));
  eo_object_put(&object, "design_hash", eo_design_hash(design, hash, NULL) ? NULL : json_string(hash));
  eo_object_put(&object, "id", encode_ids(selection));
  eo_object_put(&object, "left_out", encode_left_out(selection));
  object.failed = json_object_update(object.json, inner) != 0 || object.failed;
  json_decref(inner);
  return eo_object_close(&object);
}

void eo_rig_comparison_write(const struct eo_rig_selection *selection, const struct eo_comparison *comparison,
                             const struct eo_measured *measured, const struct eo_design *design, struct eo_text *text)
{
  write(text, encode_comparison(selection, comparison, measured, design));
}

/* Sets in document what differs between two resolved designs, and nothing else: defaults that were not written stay
   unwritten. */
static bool overlay(json_t *document, const json_t *before, const json_t *after)
{
  const char *key;
  json_t *value;
  bool done = true;
  json_object_foreach((json_t *)after, key, value)
  {
    const json_t *old = json_object_get(before, key);
    if (json_equal(old, value))
      continue;
    json_t *inner = json_object_get(document, key);
    if (!json_is_object(value))
      done = json_object_set(document, key, value) == 0 && done;
    else {
      if (!json_is_object(inner))
        json_object_set_new(document, key, inner = json_object());
      done = overlay(inner, old, value) && done;
    }
  }
  return done;
}

static json_t *changed_design(const char *given, const struct eo_design *design, const struct eo_design *updated)
{
  json_t *document = json_loads(given, 0, NULL), *before = eo_design_encode(design), *after = eo_design_encode(updated);
  bool done = document && before && after && overlay(document, before, after);
  json_decref(before);
  json_decref(after);
  return done ? document : (json_decref(document), NULL);
}

static const struct eo_outline_row fit_rows[] = {
    {.outline = &eo_update_outline},
    EO_KEY("id", "[integer]", "numbers of the measurements used"),
    EO_KEY("left_out", "[object]", "measurements that were not, outliers too", .outline = &left_out_outline),
    EO_KEY("design", "object", "the design with the values found, as it was given but for them",
           .table = &eo_design_table, .name = "Design", .sparse = true),
};
const struct eo_outline eo_rig_fit_outline = EO_OUTLINE("Fit", fit_rows);

void eo_rig_fit_write(const struct eo_rig_selection *selection, const struct eo_update *update, const char *given,
                      const struct eo_design *design, const struct eo_design *updated, struct eo_text *text)
{
  struct eo_object object = {.json = eo_update_encode(update)};
  object.failed = !object.json;
  eo_object_put(&object, "id", encode_ids(selection));
  eo_object_put(&object, "left_out", encode_left_out(selection));
  eo_object_put(&object, "design", changed_design(given, design, updated));
  write(text, eo_object_close(&object));
}
