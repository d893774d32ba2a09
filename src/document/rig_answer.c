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

static json_t *encode_ids(const struct eo_rig_selection *selection)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < selection->count; i++)
    eo_list_add(&list, json_integer(selection->id[i]));
  return eo_object_close(&list);
}

static const struct eo_outline_row left_out_rows[] = {
    EO_KEY("id", "integer", "number of the measurement", EO_AT(struct eo_left_out, id)),
    EO_KEY("reason", "text", "why it was left out, for people", EO_AT(struct eo_left_out, reason)),
};
static const struct eo_outline left_out_outline = EO_OUTLINE("LeftOut", left_out_rows);

static json_t *encode_left_out(const struct eo_rig_selection *selection)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < selection->left_outs; i++)
    eo_list_add(&list, eo_outline_encode(&left_out_outline, &selection->left_out[i]));
  return eo_object_close(&list);
}

/* What stands before a comparison. */
struct comparison_head {
  const char *program;
  char design_hash[EO_HASH_LENGTH + 1];
  json_t *ids, *left_out;
};
#define OF_HEAD(member) EO_AT(struct comparison_head, member)
static const struct eo_outline_row head_rows[] = {
    EO_KEY("program", "text", "name and version", OF_HEAD(program)),
    EO_KEY("design_hash", "text", "SHA-256 of the canonical design that predicts", OF_HEAD(design_hash)),
    EO_KEY("id", "[integer]", "numbers of the measurements, in the order of the columns", OF_HEAD(ids)),
    EO_KEY("left_out", "[object]", "measurements that cannot be compared", .outline = &left_out_outline,
           OF_HEAD(left_out)),
};
static const struct eo_outline head_outline = EO_OUTLINE(NULL, head_rows);
static const struct eo_outline_row comparison_rows[] = {
    {.outline = &head_outline},
    {.outline = &eo_comparison_outline},
};
const struct eo_outline eo_rig_comparison_outline = EO_OUTLINE("Comparison", comparison_rows);

/* Takes both; NULL when one is. */
static json_t *unite(json_t *first, json_t *second)
{
  bool good = first && second && json_object_update(first, second) == 0;
  json_decref(second);
  return good ? first : (json_decref(first), NULL);
}

static json_t *encode_comparison(const struct eo_rig_selection *selection, const struct eo_comparison *comparison,
                                 const struct eo_measured *measured, const struct eo_design *design)
{
  struct comparison_head head = {.program = PACKAGE_STRING};
  if (eo_design_hash(design, head.design_hash, NULL))
    return NULL;
  head.ids = encode_ids(selection);
  head.left_out = encode_left_out(selection);
  return unite(eo_outline_encode(&head_outline, &head), eo_comparison_encode(comparison, measured, selection->id));
}

void eo_rig_comparison_write(const struct eo_rig_selection *selection, const struct eo_comparison *comparison,
                             const struct eo_measured *measured, const struct eo_design *design, struct eo_text *text)
{
  eo_json_write_new(text, encode_comparison(selection, comparison, measured, design), EO_JSON_COMPACT);
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

/* What stands behind a fit. */
struct fit_tail {
  json_t *ids, *left_out, *design;
};
#define OF_TAIL(member) EO_AT(struct fit_tail, member)
static const struct eo_outline_row tail_rows[] = {
    EO_KEY("id", "[integer]", "numbers of the measurements used", OF_TAIL(ids)),
    EO_KEY("left_out", "[object]", "measurements that were not, outliers too", .outline = &left_out_outline,
           OF_TAIL(left_out)),
    EO_KEY("design", "object", "the design with the values found, as it was given but for them",
           .table = &eo_design_table, .name = "Design", .sparse = true, OF_TAIL(design)),
};
static const struct eo_outline tail_outline = EO_OUTLINE(NULL, tail_rows);
static const struct eo_outline_row fit_rows[] = {
    {.outline = &eo_update_outline},
    {.outline = &tail_outline},
};
const struct eo_outline eo_rig_fit_outline = EO_OUTLINE("Fit", fit_rows);

void eo_rig_fit_write(const struct eo_rig_selection *selection, const struct eo_update *update, const char *given,
                      const struct eo_design *design, const struct eo_design *updated, struct eo_text *text)
{
  const struct fit_tail tail = {encode_ids(selection), encode_left_out(selection),
                                changed_design(given, design, updated)};
  eo_json_write_new(text, unite(eo_update_encode(update), eo_outline_encode(&tail_outline, &tail)), EO_JSON_COMPACT);
}
