/* SPDX-License-Identifier: GPL-3.0-or-later */
/* REXS as JSON: {"model": {..}}; an attribute carries its value under the name of its type. */
#include "exchange/rexs_read.h"

#include <jansson.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#include "format/digits.h"
#include "format/json.h"

struct reader {
  struct eo_rexs_model *model;
  struct eo_rexs_problem *problem;
};

static const char *kept(struct reader *reader, const json_t *object, const char *key)
{
  const json_t *value = json_object_get(object, key);
  return json_is_string(value) ? eo_rexs_text(reader->model, json_string_value(value), json_string_length(value)) : "";
}

/* An id, as a number or as digits in quotes. */
static bool whole(struct reader *reader, const json_t *object, const char *key, bool needed, int *id)
{
  const json_t *value = json_object_get(object, key);
  double number = json_is_string(value) ? eo_rexs_number(json_string_value(value)) : json_number_value(value);
  *id = 0;
  if (!value && !needed)
    return true;
  if (!value || !(number >= 0 && number <= INT_MAX) || number != (double)(int)number)
    return eo_rexs_refuse(reader->problem, "wrong_id", 0, 0,
                          "\"%s\" is not a whole number from 0 somewhere in the model.", key);
  *id = (int)number;
  return true;
}

static bool read_cells(struct reader *reader, struct eo_rexs_attribute *attribute, const json_t *list)
{
  size_t count = json_array_size(list), used = 0;
  for (size_t i = 0; i < json_array_size(list); i++)
    if (json_is_array(json_array_get(list, i)))
      count += json_array_size(json_array_get(list, i));
  if (count + (size_t)reader->model->cells > EO_REXS_CELLS)
    return eo_rexs_refuse_many(reader->problem, 0, 0, EO_REXS_CELLS);
  double *value = count ? eo_rexs_memory(reader->model, count * sizeof *value) : NULL;
  for (size_t i = 0; value && i < json_array_size(list); i++) {
    const json_t *cell = json_array_get(list, i);
    if (json_is_array(cell))
      attribute->shape = EO_REXS_NESTED;
    for (size_t k = 0; json_is_array(cell) && k < json_array_size(cell); k++) {
      const json_t *inner = json_array_get(cell, k);
      value[used++] = json_is_number(inner) ? json_number_value(inner) : NAN;
    }
    if (!json_is_array(cell))
      value[used++] = json_is_number(cell) ? json_number_value(cell) : NAN;
  }
  attribute->value = value;
  attribute->count = (int)used;
  reader->model->cells += (int)used;
  return true;
}

/* {"code": "float64", "value": "..."}: Base64. */
static bool read_coded(struct reader *reader, struct eo_rexs_attribute *attribute, const json_t *coded)
{
  const char *code = json_string_value(json_object_get(coded, "code")),
             *text = json_string_value(json_object_get(coded, "value"));
  double *value = NULL;
  int count = code && text ? eo_rexs_decode_numbers(reader->model, text, code, &value) : -1;
  if (count < 0 || reader->model->cells + count > EO_REXS_CELLS)
    return eo_rexs_refuse(reader->problem, "wrong_code", 0, 0,
                          "An array is not Base64 of int32, float32 or float64, or holds too many numbers.");
  attribute->value = value;
  attribute->count = count;
  reader->model->cells += count;
  return true;
}

static bool read_value(struct reader *reader, struct eo_rexs_attribute *attribute, const json_t *value)
{
  char number[40];
  attribute->shape = json_is_array(value) || json_is_object(value) ? EO_REXS_ARRAY : EO_REXS_SCALAR;
  if (json_is_array(value))
    return read_cells(reader, attribute, value);
  if (json_is_object(value))
    return read_coded(reader, attribute, value);
  if (json_is_string(value))
    attribute->text = eo_rexs_text(reader->model, json_string_value(value), json_string_length(value));
  else if (json_is_boolean(value))
    attribute->text = json_is_true(value) ? "true" : "false";
  else if (json_is_number(value)) {
    int length = eo_digits_write(number, sizeof number, json_number_value(value));
    attribute->text = eo_rexs_text(reader->model, number, (size_t)length);
  }
  return true;
}

static bool read_attribute(struct reader *reader, struct eo_rexs_component *component, const json_t *object, int index)
{
  const char *key;
  json_t *value;
  if (reader->model->attributes >= EO_REXS_ATTRIBUTES)
    return eo_rexs_refuse_many(reader->problem, 0, 0, EO_REXS_ATTRIBUTES);
  struct eo_rexs_attribute *attribute = eo_rexs_add_attribute(reader->model, component);
  if (!attribute)
    return false;
  attribute->id = kept(reader, object, "id");
  attribute->unit = kept(reader, object, "unit");
  attribute->place.index = index;
  json_object_foreach((json_t *)object, key, value)
  {
    if (strcmp(key, "id") != 0 && strcmp(key, "unit") != 0 && !read_value(reader, attribute, value))
      return false;
  }
  return true;
}

static bool read_component(struct reader *reader, struct eo_rexs_component *component, const json_t *object, int index)
{
  const json_t *attributes = json_object_get(object, "attributes");
  if (!component || !whole(reader, object, "id", true, &component->id))
    return false;
  component->type = kept(reader, object, "type");
  component->name = kept(reader, object, "name");
  component->place.index = index;
  for (size_t i = 0; i < json_array_size(attributes); i++)
    if (!read_attribute(reader, component, json_array_get(attributes, i), (int)i))
      return false;
  return true;
}

static bool read_relation(struct reader *reader, const json_t *object, int index)
{
  const json_t *references = json_object_get(object, "refs");
  if (reader->model->relations >= EO_REXS_RELATIONS)
    return eo_rexs_refuse_many(reader->problem, 0, 0, EO_REXS_RELATIONS);
  if (json_array_size(references) > EO_REXS_REFERENCES)
    return eo_rexs_refuse_many(reader->problem, 0, 0, EO_REXS_REFERENCES);
  struct eo_rexs_relation *relation = eo_rexs_add_relation(reader->model);
  if (!relation)
    return false;
  relation->place.index = index;
  relation->type = kept(reader, object, "type");
  if (!whole(reader, object, "id", true, &relation->id) || !whole(reader, object, "order", false, &relation->order))
    return false;
  for (size_t i = 0; i < json_array_size(references); i++) {
    const json_t *reference = json_array_get(references, i);
    struct eo_rexs_reference *to = &relation->reference[relation->count++];
    to->role = kept(reader, reference, "role");
    to->hint = kept(reader, reference, "hint");
    if (!whole(reader, reference, "id", true, &to->id))
      return false;
  }
  return true;
}

static bool read_load_case(struct reader *reader, const json_t *object)
{
  const json_t *components = json_object_get(object, "components");
  if (reader->model->load_cases >= EO_REXS_LOAD_CASES)
    return eo_rexs_refuse_many(reader->problem, 0, 0, EO_REXS_LOAD_CASES);
  if (json_array_size(components) + (size_t)reader->model->varying > EO_REXS_COMPONENTS)
    return eo_rexs_refuse_many(reader->problem, 0, 0, EO_REXS_COMPONENTS);
  struct eo_rexs_load_case *load_case = eo_rexs_add_load_case(reader->model);
  if (!load_case || !whole(reader, object, "id", false, &load_case->id))
    return false;
  for (size_t i = 0; i < json_array_size(components); i++)
    if (!read_component(reader, eo_rexs_add_varying(reader->model, load_case), json_array_get(components, i), (int)i))
      return false;
  return true;
}

/* One spectrum, or a list of them. */
static bool read_spectrum(struct reader *reader, const json_t *spectrum)
{
  const json_t *cases = json_object_get(spectrum, "load_cases");
  for (size_t i = 0; i < json_array_size(spectrum); i++)
    if (!read_spectrum(reader, json_array_get(spectrum, i)))
      return false;
  for (size_t i = 0; i < json_array_size(cases); i++)
    if (!read_load_case(reader, json_array_get(cases, i)))
      return false;
  return true;
}

static bool read_model(struct reader *reader, const json_t *top)
{
  const json_t *relations = json_object_get(top, "relations"), *components = json_object_get(top, "components");
  reader->model->json = true;
  reader->model->version = kept(reader, top, "version");
  reader->model->application = kept(reader, top, "applicationId");
  reader->model->application_version = kept(reader, top, "applicationVersion");
  reader->model->date = kept(reader, top, "date");
  if (json_array_size(components) > EO_REXS_COMPONENTS)
    return eo_rexs_refuse_many(reader->problem, 0, 0, EO_REXS_COMPONENTS);
  for (size_t i = 0; i < json_array_size(relations); i++)
    if (!read_relation(reader, json_array_get(relations, i), (int)i))
      return false;
  for (size_t i = 0; i < json_array_size(components); i++)
    if (!read_component(reader, eo_rexs_add_component(reader->model), json_array_get(components, i), (int)i))
      return false;
  return read_spectrum(reader, json_object_get(top, "load_spectrum"));
}

bool eo_rexs_read_json(struct eo_rexs_model *model, const char *bytes, size_t size, struct eo_rexs_problem *problem)
{
  struct reader reader = {model, problem};
  struct eo_error error;
  json_t *document = eo_json_parse(bytes, size, &error);
  if (!document)
    return eo_rexs_refuse(problem, "not_well_formed", 0, 0, "%s", error.text);
  const json_t *top = json_object_get(document, "model");
  bool good = json_is_object(top) ? read_model(&reader, top)
                                  : eo_rexs_refuse(problem, "not_rexs", 0, 0,
                                                   "The file is JSON but no REXS file: it has no \"model\".");
  if (!good && !problem->error.code)
    model->failed = true;
  json_decref(document);
  if (model->failed)
    eo_error_memory(&problem->error);
  return good && !model->failed;
}
