/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/rexs_build.h"

#include <archive.h>
#include <archive_entry.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "exchange/rexs_schema.h"
#include "format/digits.h"
#include "format/json.h"

/* XML: */

static void put_member(struct eo_text *text, const char *name, const char *value)
{
  eo_text_print(text, " %s=\"", name);
  eo_text_add_escaped(text, value);
  eo_text_add(text, "\"");
}

static const char *hint_of(const struct eo_rexs_model *model, int id)
{
  const struct eo_rexs_component *component = eo_rexs_find(model, id);
  return component ? component->type : "";
}

static void write_relation(const struct eo_rexs_model *model, const struct eo_rexs_relation *relation,
                           struct eo_text *text)
{
  eo_text_print(text, "    <relation id=\"%d\"", relation->id);
  put_member(text, "type", relation->type);
  if (relation->order)
    eo_text_print(text, " order=\"%d\"", relation->order);
  eo_text_add(text, ">\n");
  for (int i = 0; i < relation->count; i++) {
    eo_text_print(text, "      <ref id=\"%d\"", relation->reference[i].id);
    put_member(text, "role", relation->reference[i].role);
    put_member(text, "hint", hint_of(model, relation->reference[i].id));
    eo_text_add(text, "/>\n");
  }
  eo_text_add(text, "    </relation>\n");
}

static void write_attribute(const struct eo_rexs_attribute *attribute, const char *indent, struct eo_text *text)
{
  char number[40];
  eo_text_print(text, "%s<attribute", indent);
  put_member(text, "id", attribute->id);
  put_member(text, "unit", attribute->unit);
  eo_text_add(text, ">");
  if (attribute->shape == EO_REXS_SCALAR)
    eo_text_add_escaped(text, attribute->text);
  else {
    eo_text_add(text, "<array>");
    for (int i = 0; i < attribute->count; i++) {
      eo_digits_write(number, sizeof number, attribute->value[i] + 0.0);
      eo_text_print(text, "<c>%s</c>", number);
    }
    eo_text_add(text, "</array>");
  }
  eo_text_add(text, "</attribute>\n");
}

static void write_component(const struct eo_rexs_component *component, const char *indent, struct eo_text *text)
{
  char deeper[20];
  snprintf(deeper, sizeof deeper, "%s  ", indent);
  eo_text_print(text, "%s<component id=\"%d\"", indent, component->id);
  put_member(text, "type", component->type);
  if (*component->name)
    put_member(text, "name", component->name);
  eo_text_add(text, ">\n");
  for (int i = 0; i < component->count; i++)
    write_attribute(&component->attribute[i], deeper, text);
  eo_text_print(text, "%s</component>\n", indent);
}

static void write_xml(const struct eo_rexs_model *model, struct eo_text *text)
{
  eo_text_add(text, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model");
  put_member(text, "version", model->version);
  put_member(text, "applicationId", model->application);
  put_member(text, "applicationVersion", model->application_version);
  put_member(text, "date", model->date);
  put_member(text, "applicationLanguage", "en");
  eo_text_add(text, ">\n  <relations>\n");
  for (int i = 0; i < model->relations; i++)
    write_relation(model, &model->relation[i], text);
  eo_text_add(text, "  </relations>\n  <components>\n");
  for (int i = 0; i < model->components; i++)
    write_component(&model->component[i], "    ", text);
  eo_text_add(text, "  </components>\n");
  if (model->load_cases)
    eo_text_add(text, "  <load_spectrum id=\"1\">\n");
  for (int i = 0; i < model->load_cases; i++) {
    eo_text_print(text, "    <load_case id=\"%d\">\n", model->load_case[i].id);
    for (int k = 0; k < model->load_case[i].count; k++)
      write_component(&model->load_case[i].component[k], "      ", text);
    eo_text_add(text, "    </load_case>\n");
  }
  if (model->load_cases)
    eo_text_add(text, "  </load_spectrum>\n");
  eo_text_add(text, "</model>\n");
}

/* JSON: */

static json_t *attribute_value(const struct eo_rexs_attribute *attribute, const char **type)
{
  static const char *const types[] = {[EO_REXS_NUMBER] = "floating_point",
                                      [EO_REXS_WHOLE] = "integer",
                                      [EO_REXS_FLAG] = "boolean",
                                      [EO_REXS_WORD] = "enum",
                                      [EO_REXS_STRING] = "string",
                                      [EO_REXS_COMPONENT] = "reference_component",
                                      [EO_REXS_NUMBERS] = "floating_point_array"};
  const struct eo_rexs_rule *rule = eo_rexs_rule_of(attribute->id);
  enum eo_rexs_type kind = rule ? rule->type : EO_REXS_STRING;
  *type = types[kind];
  if (attribute->shape != EO_REXS_SCALAR)
    return eo_json_reals(attribute->count, attribute->value, 1, NULL, 0);
  switch (kind) {
  case EO_REXS_NUMBER:
    return json_real(eo_rexs_number(attribute->text));
  case EO_REXS_WHOLE:
  case EO_REXS_COMPONENT:
    return eo_json_whole(eo_rexs_number(attribute->text));
  case EO_REXS_FLAG:
    return json_boolean(strcmp(attribute->text, "true") == 0);
  default:
    return json_string(attribute->text);
  }
}

static json_t *component_value(const struct eo_rexs_component *component)
{
  json_t *list = json_array(), *object = json_pack("{s:i, s:s}", "id", component->id, "type", component->type);
  if (*component->name)
    json_object_set_new(object, "name", json_string(component->name));
  for (int i = 0; i < component->count; i++) {
    const char *type;
    json_t *value = attribute_value(&component->attribute[i], &type);
    json_array_append_new(list, json_pack("{s:s, s:s, s:o}", "id", component->attribute[i].id, "unit",
                                          component->attribute[i].unit, type, value));
  }
  json_object_set_new(object, "attributes", list);
  return object;
}

static json_t *relation_value(const struct eo_rexs_model *model, const struct eo_rexs_relation *relation)
{
  json_t *list = json_array(), *object = json_pack("{s:i, s:s}", "id", relation->id, "type", relation->type);
  if (relation->order)
    json_object_set_new(object, "order", json_integer(relation->order));
  for (int i = 0; i < relation->count; i++)
    json_array_append_new(list,
                          json_pack("{s:i, s:s, s:s}", "id", relation->reference[i].id, "role",
                                    relation->reference[i].role, "hint", hint_of(model, relation->reference[i].id)));
  json_object_set_new(object, "refs", list);
  return object;
}

static void write_json(const struct eo_rexs_model *model, struct eo_text *text)
{
  json_t *relations = json_array(), *components = json_array(), *cases = json_array();
  for (int i = 0; i < model->relations; i++)
    json_array_append_new(relations, relation_value(model, &model->relation[i]));
  for (int i = 0; i < model->components; i++)
    json_array_append_new(components, component_value(&model->component[i]));
  for (int i = 0; i < model->load_cases; i++) {
    json_t *varying = json_array();
    for (int k = 0; k < model->load_case[i].count; k++)
      json_array_append_new(varying, component_value(&model->load_case[i].component[k]));
    json_array_append_new(cases, json_pack("{s:i, s:o}", "id", model->load_case[i].id, "components", varying));
  }
  json_t *document = json_pack(
      "{s:{s:s, s:s, s:s, s:s, s:s, s:o, s:o, s:{s:i, s:o}}}", "model", "version", model->version, "applicationId",
      model->application, "applicationVersion", model->application_version, "date", model->date, "applicationLanguage",
      "en", "relations", relations, "components", components, "load_spectrum", "id", 1, "load_cases", cases);
  eo_json_write_new(text, document, EO_JSON_PRETTY);
}

/* Zip: one entry, by libarchive. */
static void write_zip(const struct eo_rexs_model *model, struct eo_text *text)
{
  struct eo_text xml = {0};
  write_xml(model, &xml);
  size_t room = xml.size + 4096, used = 0;
  char *bytes = malloc(room);
  struct archive *archive = archive_write_new();
  struct archive_entry *entry = archive_entry_new();
  bool good = bytes && archive && entry && !xml.failed && archive_write_set_format_zip(archive) == ARCHIVE_OK &&
              archive_write_set_bytes_in_last_block(archive, 1) == ARCHIVE_OK &&
              archive_write_open_memory(archive, bytes, room, &used) == ARCHIVE_OK;
  if (good) {
    archive_entry_set_pathname(entry, "model.rexs");
    archive_entry_set_size(entry, (la_int64_t)xml.size);
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    good = archive_write_header(archive, entry) == ARCHIVE_OK &&
           archive_write_data(archive, xml.data, xml.size) == (la_ssize_t)xml.size;
  }
  if (entry)
    archive_entry_free(entry);
  good = archive && archive_write_free(archive) == ARCHIVE_OK && good;
  if (good)
    eo_text_add_bytes(text, bytes, used);
  text->failed = text->failed || !good;
  free(bytes);
  eo_text_done(&xml);
}

void eo_rexs_write(const struct eo_rexs_model *model, enum eo_rexs_form form, struct eo_text *text)
{
  if (form == EO_REXS_XML)
    write_xml(model, text);
  else if (form == EO_REXS_JSON)
    write_json(model, text);
  else
    write_zip(model, text);
  text->failed = text->failed || model->failed;
}
