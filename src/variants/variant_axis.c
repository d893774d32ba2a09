/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_axis.h"
#include "format/json.h"
#include "gear/names.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Names: */

/* Rows of a list, or ends, that a `*` or `both` in a name stands for; 0: it stands for nothing. */
static int count_choices(const char *before, const struct eo_design *design)
{
  if (strcmp(before, "load_cases.") == 0)
    return design->load_cases;
  if (strcmp(before, "modification.pinion.") == 0 || strcmp(before, "modification.gear.") == 0)
    return design->gear_pair.ends;
  return 0;
}

static bool add_path(struct eo_variant_axis *axis, const char *path)
{
  char(*more)[EO_KEY_PATH] = realloc(axis->path, sizeof *more * (size_t)(axis->paths + 1));
  if (!more)
    return false;
  axis->path = more;
  snprintf(axis->path[axis->paths++], EO_KEY_PATH, "%s", path);
  return true;
}

/* One name without wildcards; false: it is no key, which is told. */
static bool add_key(struct eo_variant_axis *axis, const char *name, const char *pointer, struct eo_faults *faults)
{
  struct eo_design_key key, other;
  if (!eo_design_key_find(&key, name, 0, 2)) {
    eo_faults_add(faults, pointer, "\"%.100s\" is neither a key of a design nor a symbol that is known here.", name);
    return false;
  }
  if (key.of_member && eo_design_key_find(&other, name, 1, 2)) {
    eo_faults_add(faults, pointer, "\"%.80s\" is of which member? Write %.100s or %.100s.", name, key.path[0],
                  other.path[0]);
    return false;
  }
  for (int i = 0; i < key.paths; i++)
    if (!add_path(axis, key.path[i]))
      return false;
  axis->field = axis->field ? axis->field : key.field;
  return true;
}

static bool add_name(struct eo_variant_axis *axis, const char *name, const struct eo_design *design,
                     const char *pointer, struct eo_faults *faults)
{
  static const char *const wild[] = {".*.", ".both."};
  char before[EO_KEY_PATH], path[EO_KEY_PATH + 16];
  for (int w = 0; w < 2; w++) {
    const char *at = strstr(name, wild[w]);
    if (!at)
      continue;
    snprintf(before, sizeof before, "%.*s.", (int)(at - name), name);
    int count = count_choices(before, design);
    for (int i = 0; i < count; i++) {
      bool of_case = strcmp(before, "load_cases.") == 0;
      if (of_case)
        snprintf(path, sizeof path, "%s%d.%s", before, i + 1, at + strlen(wild[w]));
      else
        snprintf(path, sizeof path, "%s%s.%s", before, eo_end_name[i], at + strlen(wild[w]));
      if (!add_key(axis, path, pointer, faults))
        return false;
    }
    if (!count)
      eo_faults_add(faults, pointer,
                    "\"%.100s\": * stands for load cases (load_cases.*.torque_Nm) or for both ends "
                    "(modification.pinion.*.tip_relief_um).",
                    name);
    return count > 0;
  }
  return add_key(axis, name, pointer, faults);
}

static bool starts_with(const char *text, const char *start)
{
  return strncmp(text, start, strlen(start)) == 0;
}

void eo_variant_axis_name(struct eo_variant_axis *axis, const char *name, const struct eo_design *design,
                          const char *pointer, struct eo_faults *faults)
{
  char part[EO_KEY_PATH], unit[40] = "";
  size_t length = strcspn(name, "[");
  axis->factor = 1;
  snprintf(axis->name, sizeof axis->name, "%s", name);
  if (name[length]) {
    snprintf(unit, sizeof unit, "%.*s", (int)strcspn(name + length + 1, "]"), name + length + 1);
    while (length && name[length - 1] == ' ')
      length--;
  }
  for (size_t at = 0; at < length;) {
    size_t size = strcspn(name + at, "+[");
    size = at + size > length ? length - at : size;
    snprintf(part, sizeof part, "%.*s", (int)size, name + at);
    if (!add_name(axis, part, design, pointer, faults))
      return;
    at += size + (name[at + size] == '+');
  }
  if (!axis->paths)
    eo_faults_add(faults, pointer, "A key is missing.");
  else if (*unit && !eo_design_key_convert(axis->field, unit, &axis->factor))
    eo_faults_add(faults, pointer, "The unit \"%.20s\" is not one of %.100s.", unit, axis->path[0]);
  for (int i = 0; i < axis->paths; i++)
    axis->of_pair = axis->of_pair || starts_with(axis->path[i], "gear_pair.") ||
                    starts_with(axis->path[i], "material.") || starts_with(axis->path[i], "resolution.");
}

void eo_variant_axis_done(struct eo_variant_axis *axis)
{
  json_decref(axis->levels);
  free(axis->path);
  *axis = (struct eo_variant_axis){0};
}

/* Values: */

static bool is_whole(const struct eo_variant_axis *axis)
{
  return axis->field->kind == EO_FIELD_INTEGER || axis->field->kind == EO_FIELD_SEED;
}

static json_t *number(const struct eo_variant_axis *axis, double value)
{
  return is_whole(axis) ? eo_json_whole(value) : json_real(value);
}

static bool is_word(const struct eo_variant_axis *axis)
{
  return axis->field->kind == EO_FIELD_CHOICE || axis->field->kind == EO_FIELD_TEXT ||
         axis->field->kind == EO_FIELD_FLAG;
}

json_t *eo_variant_axis_read(const struct eo_variant_axis *axis, const char *cell)
{
  char *end;
  if (axis->field->kind == EO_FIELD_FLAG)
    return strcmp(cell, "true") == 0 || strcmp(cell, "false") == 0 ? json_boolean(*cell == 't') : NULL;
  if (is_word(axis))
    return json_string(cell);
  double value = strtod(cell, &end);
  return *cell && !*end && isfinite(value) ? number(axis, value) : NULL;
}

static void read_words(struct eo_variant_axis *axis, const char *words, const char *pointer, struct eo_faults *faults)
{
  char cell[100];
  for (const char *at = words; *at;) {
    size_t size = strcspn(at, ",");
    snprintf(cell, sizeof cell, "%.*s", (int)size, at);
    json_t *value = eo_variant_axis_read(axis, cell);
    if (!value)
      eo_faults_add(faults, pointer, "\"%.60s\" is no value of %.100s.", cell, axis->path[0]);
    else
      json_array_append_new(axis->levels, value);
    at += size + (at[size] == ',');
  }
}

static void check_range(struct eo_variant_axis *axis, const struct eo_study_axis *asked,
                        enum eo_study_sampling sampling, const char *pointer, struct eo_faults *faults)
{
  axis->from = asked->from;
  axis->to = isnan(asked->to) ? asked->from : asked->to;
  axis->points = asked->points ? asked->points : axis->to > axis->from ? 2 : 1;
  if (is_word(axis))
    eo_faults_add(faults, pointer, "%.100s takes words, not a range.", axis->path[0]);
  else if (axis->to < axis->from)
    eo_faults_add(faults, pointer, "The range ends at %.9g, below its start %.9g.", axis->to, axis->from);
  else if ((axis->to > axis->from) != (axis->points > 1) && sampling == EO_STUDY_FACTORIAL)
    eo_faults_add(faults, pointer, "%d points from %.9g to %.9g are no range.", axis->points, axis->from, axis->to);
  else if (is_whole(axis) && (axis->from != floor(axis->from) || axis->to != floor(axis->to)))
    eo_faults_add(faults, pointer, "%.100s takes whole numbers.", axis->path[0]);
}

void eo_variant_axis_fill(struct eo_variant_axis *axis, const struct eo_study_axis *asked,
                          enum eo_study_sampling sampling, const char *pointer, struct eo_faults *faults)
{
  int ways = (asked->values.count > 0) + (*asked->words != '\0') + !isnan(asked->from);
  if (!axis->paths)
    return; /* told already */
  if (ways != 1) {
    eo_faults_add(faults, pointer, "%.100s takes values, words or a range: one of them.", axis->path[0]);
    return;
  }
  if (!isnan(asked->from)) {
    check_range(axis, asked, sampling, pointer, faults);
    return;
  }
  axis->levels = json_array();
  if (*asked->words)
    read_words(axis, asked->words, pointer, faults);
  else if (is_word(axis))
    eo_faults_add(faults, pointer, "%.100s takes words, not numbers.", axis->path[0]);
  for (int i = 0; i < asked->values.count && !is_word(axis); i++)
    json_array_append_new(axis->levels, number(axis, asked->values.value[i]));
}

int eo_variant_axis_count(const struct eo_variant_axis *axis)
{
  return axis->levels ? (int)json_array_size(axis->levels) : axis->points;
}

/* What people can read: a sample needs no more. */
static double shorten(double value)
{
  char text[40];
  snprintf(text, sizeof text, "%.9g", value);
  return strtod(text, NULL);
}

json_t *eo_variant_axis_level(const struct eo_variant_axis *axis, int level)
{
  if (axis->levels)
    return json_incref(json_array_get(axis->levels, (size_t)level));
  double share = axis->points > 1 ? (double)level / (axis->points - 1) : 0;
  double value = level == axis->points - 1 ? axis->to : shorten(axis->from + share * (axis->to - axis->from));
  return number(axis, is_whole(axis) ? round(value) : value);
}

json_t *eo_variant_axis_at(const struct eo_variant_axis *axis, double x)
{
  if (axis->levels)
    return eo_variant_axis_level(axis, (int)(x * (double)json_array_size(axis->levels)));
  if (is_whole(axis))
    return number(axis, axis->from + floor(x * (axis->to - axis->from + 1)));
  return number(axis, shorten(axis->from + x * (axis->to - axis->from)));
}
