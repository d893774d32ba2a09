/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
#include "exchange/rexs_model.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exchange/rexs_schema.h"

enum { BLOCK = 1 << 16 };

struct eo_rexs_block {
  struct eo_rexs_block *next;
  size_t used, size;
  max_align_t data[];
};

void eo_rexs_done(struct eo_rexs_model *model)
{
  while (model->block) {
    struct eo_rexs_block *next = model->block->next;
    free(model->block);
    model->block = next;
  }
  for (int i = 0; i < model->components; i++)
    free(model->component[i].attribute);
  for (int i = 0; i < model->load_cases; i++) {
    for (int k = 0; k < model->load_case[i].count; k++)
      free(model->load_case[i].component[k].attribute);
    free(model->load_case[i].component);
  }
  free(model->by_id);
  free(model->relation);
  free(model->component);
  free(model->load_case);
  memset(model, 0, sizeof *model);
}

void *eo_rexs_memory(struct eo_rexs_model *model, size_t size)
{
  const size_t grain = _Alignof(max_align_t);
  size = (size + grain - 1) / grain * grain;
  struct eo_rexs_block *block = model->block;
  if (!block || block->size - block->used < size) {
    size_t room = size > BLOCK ? size : BLOCK;
    block = malloc(sizeof *block + room);
    if (!block) {
      model->failed = true;
      return NULL;
    }
    block->next = model->block;
    block->used = 0;
    block->size = room;
    model->block = block;
  }
  void *memory = (char *)block->data + block->used;
  block->used += size;
  return memory;
}

const char *eo_rexs_text(struct eo_rexs_model *model, const char *text, size_t length)
{
  char *copy = length ? eo_rexs_memory(model, length + 1) : NULL;
  if (!copy)
    return "";
  memcpy(copy, text, length);
  copy[length] = '\0';
  return copy;
}

const char *eo_rexs_print(struct eo_rexs_model *model, const char *format, ...)
{
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  int length = vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return eo_rexs_text(model, text, length < 0 ? 0 : strlen(text));
}

/* The list with room for one more, or NULL. */
static void *grow(struct eo_rexs_model *model, void *list, int count, int *room, size_t size)
{
  if (count < *room)
    return list;
  int more = *room ? 2 * *room : 8;
  void *grown = realloc(list, (size_t)more * size);
  if (grown)
    *room = more;
  model->failed = model->failed || !grown;
  return grown;
}

/* The attributes of a component and the components of a load case grow by doubling too, at powers of two. */
static void *grow_by_count(struct eo_rexs_model *model, void *list, int count, size_t size)
{
  if (count && (count < 8 || (count & (count - 1))))
    return list;
  void *grown = realloc(list, (size_t)(count ? 2 * count : 8) * size);
  model->failed = model->failed || !grown;
  return grown;
}

struct eo_rexs_relation *eo_rexs_add_relation(struct eo_rexs_model *model)
{
  void *list = grow(model, model->relation, model->relations, &model->relations_room, sizeof *model->relation);
  if (!list)
    return NULL;
  model->relation = list;
  struct eo_rexs_relation *relation = &model->relation[model->relations++];
  *relation = (struct eo_rexs_relation){.type = ""};
  return relation;
}

struct eo_rexs_component *eo_rexs_add_component(struct eo_rexs_model *model)
{
  void *list = grow(model, model->component, model->components, &model->components_room, sizeof *model->component);
  if (!list)
    return NULL;
  model->component = list;
  struct eo_rexs_component *component = &model->component[model->components++];
  *component = (struct eo_rexs_component){.type = "", .name = ""};
  return component;
}

struct eo_rexs_load_case *eo_rexs_add_load_case(struct eo_rexs_model *model)
{
  void *list = grow(model, model->load_case, model->load_cases, &model->load_cases_room, sizeof *model->load_case);
  if (!list)
    return NULL;
  model->load_case = list;
  struct eo_rexs_load_case *load_case = &model->load_case[model->load_cases++];
  memset(load_case, 0, sizeof *load_case);
  return load_case;
}

struct eo_rexs_component *eo_rexs_add_varying(struct eo_rexs_model *model, struct eo_rexs_load_case *load_case)
{
  void *list = grow_by_count(model, load_case->component, load_case->count, sizeof *load_case->component);
  if (!list)
    return NULL;
  load_case->component = list;
  model->varying++;
  struct eo_rexs_component *component = &load_case->component[load_case->count++];
  *component = (struct eo_rexs_component){.type = "", .name = ""};
  return component;
}

struct eo_rexs_attribute *eo_rexs_add_attribute(struct eo_rexs_model *model, struct eo_rexs_component *component)
{
  void *list = grow_by_count(model, component->attribute, component->count, sizeof *component->attribute);
  if (!list)
    return NULL;
  component->attribute = list;
  model->attributes++;
  struct eo_rexs_attribute *attribute = &component->attribute[component->count++];
  *attribute = (struct eo_rexs_attribute){.id = "", .unit = "", .text = ""};
  return attribute;
}

static int compare_ids(const void *a, const void *b, void *context)
{
  const struct eo_rexs_model *model = context;
  int x = model->component[*(const int *)a].id, y = model->component[*(const int *)b].id;
  return (x > y) - (x < y);
}

void eo_rexs_index(struct eo_rexs_model *model)
{
  model->by_id = malloc(((size_t)model->components + 1) * sizeof *model->by_id);
  model->failed = model->failed || !model->by_id;
  for (int i = 0; i < model->components && model->by_id; i++)
    model->by_id[i] = i;
  if (model->by_id)
    qsort_r(model->by_id, (size_t)model->components, sizeof *model->by_id, compare_ids, model);
}

struct eo_rexs_component *eo_rexs_find(const struct eo_rexs_model *model, int id)
{
  if (model->by_id) {
    int low = 0, high = model->components;
    while (low < high) {
      int middle = (low + high) / 2;
      struct eo_rexs_component *component = &model->component[model->by_id[middle]];
      if (component->id == id)
        return component;
      if (component->id < id)
        low = middle + 1;
      else
        high = middle;
    }
    return NULL;
  }
  for (int i = 0; i < model->components; i++)
    if (model->component[i].id == id)
      return &model->component[i];
  return NULL;
}

const struct eo_rexs_attribute *eo_rexs_attribute(const struct eo_rexs_component *component, const char *id)
{
  for (int i = component ? component->count : 0; i-- > 0;)
    if (strcmp(eo_rexs_attribute_today(component->attribute[i].id), id) == 0)
      return &component->attribute[i];
  return NULL;
}

int eo_rexs_role(const struct eo_rexs_relation *relation, const char *role)
{
  for (int i = 0; i < relation->count; i++)
    if (strcmp(relation->reference[i].role, role) == 0)
      return relation->reference[i].id;
  return 0;
}

bool eo_rexs_is(const struct eo_rexs_component *component, const char *type)
{
  return component && strcmp(eo_rexs_type_today(component->type), type) == 0;
}

double eo_rexs_number(const char *text)
{
  char *end;
  size_t length = strlen(text);
  if (!length || strspn(text, "+-.0123456789eE") != length) /* neither hexadecimal nor words */
    return NAN;
  double value = strtod(text, &end);
  return *end || !isfinite(value) ? NAN : value;
}
