/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/sheet.h"

#include <stdio.h>
#include <string.h>

#include "format/plot.h"
#include "gear/names.h"
#include "report/page.h"

/* Heading of the values of an object that stands alone. */
static const char only[] = "value";

/* Ends and members of up to four objects that stand side by side. */
enum { MOST_COLUMNS = 4, SHORT_ARRAY = 3, NAME = 40 };

struct columns {
  int count;
  const json_t *object[MOST_COLUMNS];
  char name[MOST_COLUMNS][NAME];
};

const struct eo_outline *eo_sheet_part(const struct eo_outline *outline, const char *key)
{
  const struct eo_outline_row *row;
  for (int i = 0; (row = eo_outline_at(outline, i)); i++)
    if (row->key && strcmp(row->key, key) == 0)
      return row->outline;
  return NULL;
}

static bool is_listed(const char *key, const char *const *list)
{
  for (; list && *list; list++)
    if (strcmp(*list, key) == 0)
      return true;
  return false;
}

static bool is_side(const char *key)
{
  static const char *const sides[] = {"left", "right", "pinion", "gear", NULL};
  return is_listed(key, sides);
}

/* A number, word, text or flag, or an array of up to three numbers. */
static bool is_line(const json_t *value)
{
  if (json_is_array(value)) {
    size_t size = json_array_size(value);
    return size > 0 && size <= SHORT_ARRAY && json_is_number(json_array_get(value, 0));
  }
  return value && !json_is_object(value);
}

static void put_head(const struct eo_page *page, const struct columns *columns)
{
  eo_text_add(page->text, "<table><tr><th>quantity</th><th>key</th>");
  for (int i = 0; i < columns->count; i++) {
    eo_text_add(page->text, "<th class=\"n\">");
    eo_text_add_escaped(page->text, columns->name[i]);
    eo_text_add(page->text, "</th>");
  }
  eo_text_add(page->text, "<th>unit</th></tr>\n");
}

static void put_line(const struct eo_page *page, const struct eo_outline_row *row, const struct columns *columns)
{
  char spelt[EO_INCH_KEY];
  eo_text_add(page->text, "<tr><td>");
  eo_page_say(page, row->help);
  eo_text_print(page->text, "</td><td><code>%s</code></td>", eo_page_key(page, row->key, spelt));
  for (int i = 0; i < columns->count; i++) {
    eo_text_add(page->text, "<td class=\"n\">");
    eo_page_value(page, eo_page_member(page, columns->object[i], row->key));
    eo_text_add(page->text, "</td>");
  }
  eo_text_print(page->text, "<td>%s</td></tr>\n", eo_page_unit(page, row->unit));
}

static void put_lines(const struct eo_page *page, const struct eo_outline *outline, const struct columns *columns,
                      const char *const *skip)
{
  const struct eo_outline_row *row;
  bool open = false;
  for (int i = 0; (row = eo_outline_at(outline, i)); i++) {
    if (!row->key || is_listed(row->key, skip) || row->outline || row->table ||
        !is_line(eo_page_member(page, columns->object[0], row->key)))
      continue;
    if (!open)
      put_head(page, columns);
    open = true;
    put_line(page, row, columns);
  }
  if (open)
    eo_text_add(page->text, "</table>\n");
}

/* One number per end: a line of its table and no part of its own. */
static bool is_ends(const struct eo_outline *outline)
{
  const struct eo_outline_row *first = outline ? eo_outline_at(outline, 0) : NULL;
  return first && strcmp(first->key, "left") == 0 && strncmp(first->shape, "number", 6) == 0;
}

/* The ends that the first of these lines has, of each column. */
static void put_ends_head(const struct eo_page *page, const struct columns *columns, const char *key)
{
  eo_text_add(page->text, "<table><tr><th>quantity</th><th>key</th>");
  for (int i = 0; i < columns->count; i++)
    for (int end = 0; end < 2; end++)
      if (json_object_get(eo_page_member(page, columns->object[i], key), eo_end_name[end]))
        eo_text_print(page->text, "<th class=\"n\">%s</th>", eo_end_name[end]);
  eo_text_add(page->text, "<th>unit</th></tr>\n");
}

static void put_ends_line(const struct eo_page *page, const struct eo_outline_row *row, const struct columns *columns)
{
  char spelt[EO_INCH_KEY];
  eo_text_add(page->text, "<tr><td>");
  eo_page_say(page, row->help);
  eo_text_print(page->text, "</td><td><code>%s</code></td>", eo_page_key(page, row->key, spelt));
  for (int i = 0; i < columns->count; i++)
    for (int end = 0; end < 2; end++) {
      const json_t *object = eo_page_member(page, columns->object[i], row->key),
                   *value = json_object_get(object, eo_end_name[end]);
      if (!value)
        continue;
      eo_text_add(page->text, "<td class=\"n\">");
      eo_page_value(page, value);
      eo_text_add(page->text, "</td>");
    }
  eo_text_print(page->text, "<td>%s</td></tr>\n", eo_page_unit(page, eo_outline_at(row->outline, 0)->unit));
}

static void put_ends(const struct eo_page *page, const struct eo_outline *outline, const struct columns *columns,
                     const char *const *skip)
{
  const struct eo_outline_row *row;
  bool open = false;
  for (int i = 0; (row = eo_outline_at(outline, i)); i++) {
    if (!row->key || is_listed(row->key, skip) || !is_ends(row->outline) ||
        !json_is_object(eo_page_member(page, columns->object[0], row->key)))
      continue;
    if (!open)
      put_ends_head(page, columns, row->key);
    open = true;
    put_ends_line(page, row, columns);
  }
  if (open)
    eo_text_add(page->text, "</table>\n");
}

/* Whether anything of an object is no curve. */
static bool has_lines(const struct eo_page *page, const struct eo_outline *outline, const json_t *object)
{
  const struct eo_outline_row *row;
  for (int i = 0; (row = eo_outline_at(outline, i)); i++) {
    const json_t *value = row->key ? eo_page_member(page, object, row->key) : NULL;
    if (value && (row->outline ? json_is_array(value) || has_lines(page, row->outline, value) : is_line(value)))
      return true;
  }
  return false;
}

/* "left", "left pinion", ... of what stands in a column of the object around it. */
static void add_column(struct columns *columns, const json_t *object, const char *outer, const char *key)
{
  if (!json_is_object(object) || columns->count == MOST_COLUMNS)
    return;
  bool plain = !*outer || strcmp(outer, only) == 0;
  snprintf(columns->name[columns->count], NAME, "%s%s%s", plain && *key ? "" : outer, plain || !*key ? "" : " ", key);
  columns->object[columns->count++] = object;
}

static void put_objects(const struct eo_page *page, const struct eo_outline *outline, const struct columns *columns,
                        int level, const char *const *skip);

/* The rows left and right, or pinion and gear, of one outline as columns of one table. */
static void put_sides(const struct eo_page *page, const struct eo_outline *outline, const struct eo_outline *part,
                      const struct columns *columns, int level)
{
  const struct eo_outline_row *row;
  struct columns inner = {0};
  for (int i = 0; i < columns->count; i++)
    for (int j = 0; (row = eo_outline_at(outline, j)); j++)
      if (row->key && row->outline == part && is_side(row->key))
        add_column(&inner, eo_page_member(page, columns->object[i], row->key), columns->name[i], row->key);
  if (inner.count)
    put_objects(page, part, &inner, level, NULL);
}

static void put_part_heading(const struct eo_page *page, const struct eo_outline_row *row, int level)
{
  eo_text_print(page->text, "<h%d>", level);
  eo_page_say(page, row->help);
  eo_text_print(page->text, " <code>%s</code></h%d>\n", row->key, level);
}

/* Each object of a list under a heading of its own, named by its number. */
static void put_list(const struct eo_page *page, const struct eo_outline_row *row, const json_t *list, int level)
{
  for (size_t i = 0; i < json_array_size(list); i++) {
    struct columns one = {.count = 1, .object = {json_array_get(list, i)}, .name = {"value"}};
    const json_t *torque = json_object_get(one.object[0], "torque_Nm"),
                 *speed = json_object_get(one.object[0], "speed_rpm");
    eo_text_print(page->text, "<h%d>%zu", level, i + 1);
    if (torque && speed)
      eo_text_print(page->text, ": %.6g N m, %.6g rpm", json_number_value(torque), json_number_value(speed));
    eo_text_print(page->text, " <code>%s/%zu</code></h%d>\n", row->key, i, level);
    put_objects(page, row->outline, &one, level < 4 ? level + 1 : level, NULL);
  }
}

static bool any_lines(const struct eo_page *page, const struct columns *columns, const struct eo_outline_row *row)
{
  for (int i = 0; i < columns->count; i++) {
    const json_t *object = eo_page_member(page, columns->object[i], row->key);
    if (json_is_object(object) && has_lines(page, row->outline, object))
      return true;
  }
  return false;
}

static void put_part(const struct eo_page *page, const struct eo_outline_row *row, const struct columns *columns,
                     int level)
{
  struct columns inner = {0};
  for (int i = 0; i < columns->count; i++)
    add_column(&inner, eo_page_member(page, columns->object[i], row->key), columns->name[i], "");
  put_part_heading(page, row, level);
  put_objects(page, row->outline, &inner, level < 4 ? level + 1 : level, NULL);
}

static void put_objects(const struct eo_page *page, const struct eo_outline *outline, const struct columns *columns,
                        int level, const char *const *skip)
{
  const struct eo_outline_row *row;
  const struct eo_outline *done = NULL; /* sides that stand in a table already */
  put_lines(page, outline, columns, skip);
  put_ends(page, outline, columns, skip);
  for (int i = 0; (row = eo_outline_at(outline, i)); i++) {
    const json_t *first = row->key ? eo_page_member(page, columns->object[0], row->key) : NULL;
    if (!row->key || !row->outline || is_ends(row->outline) || is_listed(row->key, skip))
      continue;
    if (is_side(row->key) && row->outline != done) {
      done = row->outline;
      put_sides(page, outline, row->outline, columns, level);
    } else if (!is_side(row->key) && json_is_array(first))
      put_list(page, row, first, level);
    else if (!is_side(row->key) && any_lines(page, columns, row))
      put_part(page, row, columns, level);
  }
}

void eo_sheet_outline(const struct eo_page *page, const struct eo_outline *outline, const json_t *object, int level,
                      const char *const *skip)
{
  const struct columns one = {.count = 1, .object = {object}, .name = {"value"}};
  if (outline && json_is_object(object))
    put_objects(page, outline, &one, level, skip);
}

/* The rule by which a key got its value; NULL: the user stated it. */
static const char *rule_of(const json_t *assumed, const char *path)
{
  for (size_t i = 0; i < json_array_size(assumed); i++) {
    const json_t *entry = json_array_get(assumed, i);
    const char *key = json_string_value(json_object_get(entry, "key"));
    if (key && strcmp(key, path) == 0) {
      const char *rule = json_string_value(json_object_get(entry, "rule"));
      return rule ? rule : "";
    }
  }
  return NULL;
}

static void put_field(const struct eo_page *page, const struct eo_field *field, const json_t *value, const char *path,
                      const struct eo_sheet_source *source)
{
  char spelt[EO_INCH_KEY];
  const char *shown = eo_page_key(page, path, spelt), *rule = source ? rule_of(source->assumed, shown) : NULL;
  eo_text_add(page->text, "<tr><td>");
  eo_page_say(page, field->help ? field->help : "");
  eo_text_print(page->text, "</td><td><code>%s</code></td><td class=\"n\">", shown);
  eo_page_value(page, value);
  eo_text_print(page->text, "</td><td>%s</td>", eo_page_unit(page, field->unit));
  if (rule) {
    eo_text_add(page->text, "<td class=\"assumed\">assumed: ");
    eo_page_say(page, rule);
    eo_text_add(page->text, "</td>");
  } else if (source)
    eo_text_print(page->text, "<td>%s</td>",
                  !json_is_null(value) && eo_assumptions_cover(source->design, path) ? "stated" : "");
  eo_text_add(page->text, "</tr>\n");
}

static void put_fields(const struct eo_page *page, const struct eo_table *table, const json_t *object, const char *path,
                       const struct eo_sheet_source *source);

/* One key, with all below it. */
static void put_key(const struct eo_page *page, const struct eo_field *field, const json_t *value, const char *path,
                    const struct eo_sheet_source *source)
{
  char place[300];
  snprintf(place, sizeof place, "%s/%s", path, field->key);
  if (field->kind == EO_FIELD_LIST)
    for (size_t i = 0; i < json_array_size(value); i++) {
      char row[340];
      snprintf(row, sizeof row, "%s/%zu", place, i);
      put_fields(page, field->table, json_array_get(value, i), row, source);
    }
  else if (field->kind == EO_FIELD_OBJECT)
    put_fields(page, field->table, value, place, source);
  else
    put_field(page, field, value, place, source);
}

static void put_fields(const struct eo_page *page, const struct eo_table *table, const json_t *object, const char *path,
                       const struct eo_sheet_source *source)
{
  for (int i = 0; i < table->count; i++) {
    const json_t *value = eo_page_member(page, object, table->field[i].key);
    if (value)
      put_key(page, &table->field[i], value, path, source);
  }
}

static void put_fields_head(const struct eo_page *page, const struct eo_sheet_source *source)
{
  eo_text_print(page->text, "<table><tr><th>quantity</th><th>key</th><th class=\"n\">value</th><th>unit</th>%s</tr>\n",
                source ? "<th>stated or assumed</th>" : "");
}

void eo_sheet_table(const struct eo_page *page, const struct eo_table *table, const json_t *object, const char *path,
                    const struct eo_sheet_source *source)
{
  put_fields_head(page, source);
  put_fields(page, table, object, path, source);
  eo_text_add(page->text, "</table>\n");
}

static bool is_group(const struct eo_field *field)
{
  return field->kind == EO_FIELD_OBJECT || field->kind == EO_FIELD_LIST;
}

void eo_sheet_groups(const struct eo_page *page, const struct eo_table *table, const json_t *object,
                     const struct eo_sheet_source *source)
{
  put_fields_head(page, source);
  for (int i = 0; i < table->count; i++)
    if (!is_group(&table->field[i]) && eo_page_member(page, object, table->field[i].key))
      put_key(page, &table->field[i], eo_page_member(page, object, table->field[i].key), "", source);
  eo_text_add(page->text, "</table>\n");
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    const json_t *value = eo_page_member(page, object, field->key);
    if (!is_group(field) || !value)
      continue;
    eo_text_add(page->text, "<h3>");
    eo_page_say(page, field->help);
    eo_text_print(page->text, " <code>%s</code></h3>\n", field->key);
    put_fields_head(page, source);
    put_key(page, field, value, "", source);
    eo_text_add(page->text, "</table>\n");
  }
}
