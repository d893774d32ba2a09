/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/rexs_build.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "exchange/rexs_schema.h"
#include "format/digits.h"
#include "format/json.h"

int eo_rexs_build(struct eo_rexs_builder *builder, int id, const char *type, const char *name)
{
  struct eo_rexs_component *component = eo_rexs_add_component(builder->model);
  if (component) {
    component->id = id;
    component->type = eo_rexs_type_in(type, builder->version);
    component->name = eo_rexs_text(builder->model, name, strlen(name));
  }
  return id;
}

/* The component that attributes go to. */
static struct eo_rexs_component *current(struct eo_rexs_builder *builder)
{
  struct eo_rexs_model *model = builder->model;
  if (model->load_cases && model->load_case[model->load_cases - 1].count)
    return &model->load_case[model->load_cases - 1].component[model->load_case[model->load_cases - 1].count - 1];
  return model->components ? &model->component[model->components - 1] : NULL;
}

static struct eo_rexs_attribute *put(struct eo_rexs_builder *builder, const char *id)
{
  const struct eo_rexs_rule *rule = eo_rexs_rule_of(id);
  struct eo_rexs_component *component = current(builder);
  bool old_name = strcmp(eo_rexs_attribute_in(id, builder->version), id) != 0;
  if (!rule || !component || (rule->since > builder->version && !old_name))
    return NULL;
  struct eo_rexs_attribute *attribute = eo_rexs_add_attribute(builder->model, component);
  if (attribute) {
    attribute->id = eo_rexs_attribute_in(id, builder->version);
    attribute->unit = eo_rexs_unit_in(rule->unit, builder->version);
  }
  return attribute;
}

static const char *number_text(struct eo_rexs_model *model, double value)
{
  char text[40];
  int length = eo_digits_write(text, sizeof text, value + 0.0);
  return eo_rexs_text(model, text, (size_t)length);
}

void eo_rexs_build_number(struct eo_rexs_builder *builder, const char *attribute, double value)
{
  struct eo_rexs_attribute *rexs_attribute = isnan(value) ? NULL : put(builder, attribute);
  if (rexs_attribute)
    rexs_attribute->text = number_text(builder->model, value);
}

void eo_rexs_build_whole(struct eo_rexs_builder *builder, const char *attribute, int value)
{
  struct eo_rexs_attribute *rexs_attribute = put(builder, attribute);
  if (rexs_attribute)
    rexs_attribute->text = eo_rexs_print(builder->model, "%d", value);
}

void eo_rexs_build_flag(struct eo_rexs_builder *builder, const char *attribute, bool value)
{
  eo_rexs_build_word(builder, attribute, value ? "true" : "false");
}

void eo_rexs_build_word(struct eo_rexs_builder *builder, const char *attribute, const char *value)
{
  struct eo_rexs_attribute *rexs_attribute = put(builder, attribute);
  if (rexs_attribute)
    rexs_attribute->text = eo_rexs_text(builder->model, value, strlen(value));
}

void eo_rexs_build_numbers(struct eo_rexs_builder *builder, const char *attribute, int count, const double *value)
{
  struct eo_rexs_attribute *rexs_attribute = put(builder, attribute);
  double *copy = rexs_attribute ? eo_rexs_memory(builder->model, (size_t)count * sizeof *copy) : NULL;
  if (!copy)
    return;
  memcpy(copy, value, (size_t)count * sizeof *copy);
  rexs_attribute->shape = EO_REXS_ARRAY;
  rexs_attribute->value = copy;
  rexs_attribute->count = count;
}

void eo_rexs_relate(struct eo_rexs_builder *builder, const char *type, int order, ...)
{
  struct eo_rexs_relation *relation = eo_rexs_add_relation(builder->model);
  const char *role;
  va_list arguments;
  if (!relation)
    return;
  relation->id = builder->model->relations;
  relation->type = type;
  relation->order = order;
  va_start(arguments, order);
  while ((role = va_arg(arguments, const char *)) && relation->count < EO_REXS_REFERENCES) {
    struct eo_rexs_reference *reference = &relation->reference[relation->count++];
    reference->role = role;
    reference->id = va_arg(arguments, int);
    reference->hint = "";
  }
  va_end(arguments);
}

void eo_rexs_build_load_case(struct eo_rexs_builder *builder, int id)
{
  struct eo_rexs_load_case *load_case = eo_rexs_add_load_case(builder->model);
  if (load_case)
    load_case->id = id;
}

void eo_rexs_vary_one(struct eo_rexs_builder *builder, int id, const char *type)
{
  struct eo_rexs_model *model = builder->model;
  struct eo_rexs_component *component = model->load_cases
                                            ? eo_rexs_add_varying(model, &model->load_case[model->load_cases - 1])
                                            : NULL;
  if (component) {
    component->id = id;
    component->type = eo_rexs_type_in(type, builder->version);
  }
}
