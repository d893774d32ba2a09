/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/case_file.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

struct eo_case {
  struct tree *tree;
  const json_t *json;
  struct eo_case *parent;
  struct eo_path path;    /* from the file's top, which has none */
  struct eo_case *member; /* [size]: members or elements */
  int size;
  bool read;
  bool lacking; /* a key was missing in this object */
};

struct tree {
  json_t *document;
  struct eo_faults faults;
  struct eo_case node[]; /* the file first */
};

enum { POINTER_SIZE = 160 };

static size_t members_of(const json_t *json)
{
  return json_is_object(json) ? json_object_size(json) : json_is_array(json) ? json_array_size(json) : 0;
}

static size_t count_nodes(const json_t *json)
{
  size_t count = 1, index;
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)json, key, value) count += count_nodes(value);
  json_array_foreach(json, index, value) count += count_nodes(value);
  return count;
}

static void fill(struct eo_case *node, struct eo_case **next)
{
  const json_t *json = node->json;
  size_t index;
  const char *key;
  json_t *value;
  node->size = (int)members_of(json);
  node->member = *next;
  *next += node->size;
  struct eo_case *member = node->member;
  const struct eo_path *up = node == node->tree->node ? NULL : &node->path;
  json_object_foreach((json_t *)json, key, value) *member++ =
      (struct eo_case){.tree = node->tree, .json = value, .parent = node, .path = {up, key, 0}};
  json_array_foreach(json, index, value) *member++ =
      (struct eo_case){.tree = node->tree, .json = value, .parent = node, .path = {up, NULL, (int)index}};
  for (int i = 0; i < node->size; i++)
    fill(&node->member[i], next);
}

struct eo_case *eo_case_open(json_t *document)
{
  struct tree *tree = document ? malloc(sizeof *tree + count_nodes(document) * sizeof *tree->node) : NULL;
  if (!tree) {
    json_decref(document);
    return NULL;
  }
  tree->document = document;
  tree->faults.count = 0;
  tree->node[0] = (struct eo_case){.tree = tree, .json = document, .read = true};
  struct eo_case *next = tree->node + 1;
  fill(tree->node, &next);
  return tree->node;
}

void eo_case_close(struct eo_case *file)
{
  if (!file)
    return;
  json_decref(file->tree->document);
  free(file->tree);
}

const struct eo_faults *eo_case_faults(const struct eo_case *value)
{
  return &value->tree->faults;
}

bool eo_case_faulty(const struct eo_case *value)
{
  return !value || value->tree->faults.count > 0;
}

void eo_case_pointer(const struct eo_case *value, char *pointer, int size)
{
  pointer[0] = '\0';
  if (value != value->tree->node)
    eo_path_pointer(&value->path, pointer, size);
}

void eo_case_fault(const struct eo_case *value, const char *format, ...)
{
  char pointer[POINTER_SIZE], text[400];
  va_list arguments;
  if (!value)
    return;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  eo_case_pointer(value, pointer, sizeof pointer);
  eo_faults_add(&value->tree->faults, pointer, "%s", text);
}

static struct eo_case *member_named(struct eo_case *object, const char *key)
{
  if (json_is_object(object->json))
    for (int i = 0; i < object->size; i++)
      if (strcmp(object->member[i].path.key, key) == 0)
        return &object->member[i];
  return NULL;
}

struct eo_case *eo_case_find(struct eo_case *object, const char *key)
{
  if (!object)
    return NULL;
  object->read = true;
  if (!json_is_object(object->json)) {
    eo_case_fault(object, "An object is expected here.");
    return NULL;
  }
  struct eo_case *member = member_named(object, key);
  if (member)
    member->read = true;
  return member;
}

struct eo_case *eo_case_need(struct eo_case *object, const char *key)
{
  struct eo_case *value = eo_case_find(object, key);
  if (value || !object || !json_is_object(object->json))
    return value;
  object->lacking = true;
  eo_case_fault(object, "The key \"%s\" is missing.", key);
  return NULL;
}

struct eo_case *eo_case_given(struct eo_case *object, const char *key)
{
  struct eo_case *value = eo_case_find(object, key);
  return value && json_is_null(value->json) ? NULL : value;
}

const char *eo_case_peek_text(struct eo_case *object, const char *key)
{
  return eo_case_is_text(member_named(object, key)) ? eo_case_word_given(object, key) : NULL;
}

int eo_case_size(const struct eo_case *value)
{
  return value ? value->size : 0;
}

struct eo_case *eo_case_at(struct eo_case *value, int index)
{
  if (!value)
    return NULL;
  value->read = true;
  if (index < 0 || index >= value->size)
    return NULL;
  value->member[index].read = true;
  return &value->member[index];
}

struct eo_case *eo_case_parent(const struct eo_case *value)
{
  return value->parent;
}

int eo_case_index(const struct eo_case *value)
{
  return value->path.index;
}

struct eo_case *eo_case_peek(const struct eo_case *value, int index)
{
  return index >= 0 && index < eo_case_size(value) ? &value->member[index] : NULL;
}

const char *eo_case_key(const struct eo_case *value)
{
  return value ? value->path.key : NULL;
}

const json_t *eo_case_json(const struct eo_case *value)
{
  return value ? value->json : NULL;
}

bool eo_case_is_object(const struct eo_case *value)
{
  return value && json_is_object(value->json);
}

bool eo_case_is_list(const struct eo_case *value)
{
  return value && json_is_array(value->json);
}

bool eo_case_is_text(const struct eo_case *value)
{
  return value && json_is_string(value->json);
}

bool eo_case_is_null(const struct eo_case *value)
{
  return value && json_is_null(value->json);
}

double eo_case_real(struct eo_case *value)
{
  if (!value)
    return NAN;
  value->read = true;
  if (json_is_number(value->json))
    return json_number_value(value->json);
  eo_case_fault(value, "A number is expected here.");
  return NAN;
}

const char *eo_case_text(struct eo_case *value)
{
  if (!value)
    return NULL;
  value->read = true;
  if (!json_is_string(value->json))
    eo_case_fault(value, "A text is expected here.");
  return json_string_value(value->json);
}

bool eo_case_flag(struct eo_case *value)
{
  if (!value)
    return false;
  value->read = true;
  if (!json_is_boolean(value->json))
    eo_case_fault(value, "true or false is expected here.");
  return json_is_true(value->json);
}

double eo_case_element(struct eo_case *list, int index)
{
  if (list && (!json_is_array(list->json) || index >= list->size)) {
    eo_case_fault(list, "A list of at least %d numbers is expected here.", index + 1);
    return NAN;
  }
  return eo_case_real(eo_case_at(list, index));
}

double eo_case_number(struct eo_case *object, const char *key)
{
  return eo_case_real(eo_case_need(object, key));
}

double eo_case_number_or(struct eo_case *object, const char *key, double missing)
{
  struct eo_case *value = eo_case_find(object, key);
  return value ? eo_case_real(value) : missing;
}

static int whole_of(struct eo_case *value, int low, int high)
{
  double number = eo_case_real(value);
  if (isnan(number))
    return low;
  if (number >= low && number <= high && number == floor(number))
    return (int)number;
  eo_case_fault(value, "A whole number of %d .. %d is expected here.", low, high);
  return low;
}

int eo_case_whole(struct eo_case *object, const char *key, int low, int high)
{
  return whole_of(eo_case_need(object, key), low, high);
}

int eo_case_whole_or(struct eo_case *object, const char *key, int low, int high, int missing)
{
  struct eo_case *value = eo_case_find(object, key);
  return value ? whole_of(value, low, high) : missing;
}

bool eo_case_flag_or(struct eo_case *object, const char *key, bool missing)
{
  struct eo_case *value = eo_case_find(object, key);
  return value ? eo_case_flag(value) : missing;
}

const char *eo_case_word(struct eo_case *object, const char *key)
{
  return eo_case_text(eo_case_need(object, key));
}

const char *eo_case_word_given(struct eo_case *object, const char *key)
{
  return eo_case_text(eo_case_find(object, key));
}

int eo_case_choice(struct eo_case *object, const char *key, const char *const *words, int missing)
{
  struct eo_case *value = eo_case_find(object, key);
  const char *text = eo_case_text(value);
  char known[200] = "";
  if (!value)
    return missing;
  for (int i = 0; words[i]; i++) {
    if (text && strcmp(text, words[i]) == 0)
      return i;
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", words[i]);
  }
  if (text)
    eo_case_fault(value, "\"%.40s\" is none of %s.", text, known);
  return -1;
}

static double tolerance_or(struct eo_case *object, const char *key, double missing, double below)
{
  struct eo_case *value = eo_case_find(object, key);
  double tolerance = value ? eo_case_real(value) : missing;
  if (value && !isnan(tolerance) && !(tolerance > 0 && tolerance < below))
    eo_case_fault(value, "A tolerance is above 0%s.", below < INFINITY ? " and, relative as it is, below 1" : "");
  return tolerance;
}

double eo_case_relative_or(struct eo_case *object, const char *key, double missing)
{
  return tolerance_or(object, key, missing, 1);
}

double eo_case_absolute_or(struct eo_case *object, const char *key, double missing)
{
  return tolerance_or(object, key, missing, INFINITY);
}

int eo_case_numbers(struct eo_case *list, int count, int most, double *number)
{
  if (!list)
    return -1;
  list->read = true;
  if (!json_is_array(list->json) || list->size > most || (count >= 0 && list->size != count)) {
    if (count >= 0)
      eo_case_fault(list, "A list of %d numbers is expected here.", count);
    else
      eo_case_fault(list, "A list of at most %d numbers is expected here.", most);
    return -1;
  }
  bool whole = true;
  for (int i = 0; i < list->size; i++) {
    number[i] = eo_case_real(eo_case_at(list, i));
    whole = whole && !isnan(number[i]);
  }
  return whole ? list->size : -1;
}

double eo_case_largest(struct eo_case *list)
{
  double largest = list && json_is_number(list->json) ? fabs(json_number_value(list->json)) : 0;
  for (int i = 0; i < eo_case_size(list); i++)
    largest = fmax(largest, eo_case_largest(&list->member[i]));
  return largest;
}

void eo_case_skip(struct eo_case *value)
{
  if (!value)
    return;
  value->read = true;
  for (int i = 0; i < value->size; i++)
    eo_case_skip(&value->member[i]);
}

void eo_case_remark(struct eo_case *object, const char *key)
{
  struct eo_case *value = eo_case_find(object, key);
  if (!eo_case_is_list(value)) {
    eo_case_text(value);
    return;
  }
  for (int i = 0; i < value->size; i++)
    eo_case_text(eo_case_at(value, i));
}

bool eo_case_is_commentary(const char *key)
{
  static const char *const words[] = {"about",   "what",  "note",        "notes",       "source",
                                      "remarks", "units", "conventions", "uncertainty", "mesh"};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (strcmp(key, words[i]) == 0)
      return true;
  return strncmp(key, "reference_", strlen("reference_")) == 0;
}

static void sweep(struct eo_case *value, bool only_beside_missing)
{
  bool tell = !only_beside_missing || value->lacking;
  for (int i = 0; i < value->size; i++) {
    struct eo_case *member = &value->member[i];
    bool commentary = member->path.key && eo_case_is_commentary(member->path.key);
    if (member->read && !commentary)
      sweep(member, only_beside_missing);
    else if (!commentary && tell) {
      member->read = true; /* told once */
      eo_case_fault(member, member->path.key ? "This key is not known here." : "Nothing reads this element.");
    }
  }
}

void eo_case_sweep(struct eo_case *value)
{
  sweep(value, eo_case_faulty(value));
}
