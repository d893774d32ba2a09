/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/completion.h"

#include <string.h>

#include "document/assumption.h"
#include "document/geometry_table.h"
#include "format/object.h"
#include "format/text_table.h"

struct completion {
  bool uneven, two_helices; /* halves that differ; in their helices */
  json_t *design, *geometry[2], *dimensions[2], *assumed, *warnings, *findings;
};

static const struct eo_outline_row completion_rows[] = {
    EO_KEY("design", "object", "with every default resolved", .table = &eo_design_table, .name = "ResolvedDesign",
           EO_AT(struct completion, design)),
    EO_KEY("geometry", "object", "macro-geometry", .table = &eo_geometry_table, .name = "Geometry",
           EO_AT(struct completion, geometry[EO_LEFT])),
    EO_KEY("right_geometry", "object?", "the same of the right end", .table = &eo_geometry_table, .name = "Geometry",
           .when = "with halves of unequal width or helix", EO_AT(struct completion, geometry[EO_RIGHT]),
           EO_IF(struct completion, uneven)),
    EO_KEY("dimensions", "object", "what is measured on the members and between them",
           .outline = &eo_outline_dimensions, EO_AT(struct completion, dimensions[EO_LEFT])),
    EO_KEY("right_dimensions", "object?", "the same of the right end", .outline = &eo_outline_dimensions,
           .when = "with halves of unequal helix", EO_AT(struct completion, dimensions[EO_RIGHT]),
           EO_IF(struct completion, two_helices)),
    EO_KEY("assumed", "[object]", "what the design does not state, the value taken, and by which rule",
           .outline = &eo_outline_assumption, EO_AT(struct completion, assumed)),
    EO_KEY("warnings", "[text]", "in plain words", EO_AT(struct completion, warnings)),
    EO_KEY("findings", "[object]", "those of them that belong to a field of the design", .outline = &eo_outline_finding,
           EO_AT(struct completion, findings)),
};
const struct eo_outline eo_outline_completion = EO_OUTLINE("Completion", completion_rows);

json_t *eo_completion_encode(const struct eo_design *design, const struct eo_geometry *geometry,
                             const struct eo_warnings *warnings)
{
  const struct eo_gear_pair *pair = &design->gear_pair, right = eo_gear_pair_half(pair, EO_RIGHT);
  const struct eo_geometry half = eo_geometry_of_half(geometry, pair, EO_RIGHT);
  bool uneven = eo_gear_pair_is_uneven(pair), two_helices = eo_gear_pair_has_two_helices(pair);
  const struct completion view = {
      .uneven = uneven,
      .two_helices = two_helices,
      .design = eo_design_encode(design),
      .geometry = {eo_table_encode(&eo_geometry_table, geometry),
                   uneven ? eo_table_encode(&eo_geometry_table, &half) : NULL},
      .dimensions = {eo_dimensions_encode(pair, geometry), two_helices ? eo_dimensions_encode(&right, &half) : NULL},
      .assumed = eo_assumptions_encode(design, true),
      .warnings = eo_warnings_encode(warnings),
      .findings = eo_design_findings(warnings)};
  return eo_outline_encode(&eo_outline_completion, &view);
}

/* How the key's unit reads. */
struct shown_unit {
  const char *suffix; /* of the key */
  const char *symbol;
};
static const struct shown_unit shown_units[] = {{"_N_per_um", "N/um"}, {"_mm", "mm"},   {"_um", "um"}, {"_in", "in"},
                                                {"_thou", "thou"},     {"_deg", "deg"}, {"_kg", "kg"}, {"", ""}};

static bool ends_with(const char *key, const char *suffix)
{
  size_t whole = strlen(key), length = strlen(suffix);
  return whole >= length && strcmp(key + whole - length, suffix) == 0;
}

static const struct shown_unit *unit_of(const char *key)
{
  const struct shown_unit *unit = shown_units;
  while (!ends_with(key, unit->suffix))
    unit++;
  return unit;
}

static void print_value(const json_t *value, struct eo_text *text)
{
  const json_t *element;
  size_t i;
  if (json_is_number(value))
    eo_text_print(text, "%.9g", json_number_value(value));
  else if (json_is_string(value))
    eo_text_add(text, json_string_value(value));
  else if (json_is_boolean(value))
    eo_text_add(text, json_is_true(value) ? "yes" : "no");
  else if (json_is_array(value))
    json_array_foreach(value, i, element)
    {
      eo_text_add(text, i ? "  " : "");
      print_value(element, text);
    }
  else
    eo_text_add(text, json_is_null(value) ? "-" : "unmodified");
}

static void add_row(struct eo_text_table *sheet, const char *key, const json_t *value, const char *rule)
{
  const struct shown_unit *unit = unit_of(key);
  struct eo_text text = {0};
  print_value(value, &text);
  eo_text_table_string(sheet, key);
  eo_text_table_string(sheet, text.data ? text.data : "");
  eo_text_table_string(sheet, unit->symbol);
  if (rule)
    eo_text_table_string(sheet, rule);
  eo_text_done(&text);
}

/* The members of an object, one a line; objects in it under their own heading. */
static void print_object(const json_t *object, const char *title, struct eo_text *text)
{
  static const char *const headings[] = {"", "", ""};
  struct eo_text_table sheet;
  const char *key;
  json_t *value;
  eo_text_table_init(&sheet, 3, headings);
  json_object_foreach((json_t *)object, key, value)
  {
    if (!json_is_object(value))
      add_row(&sheet, key, value, NULL);
  }
  eo_text_print(text, "\n%s\n", title);
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
  json_object_foreach((json_t *)object, key, value)
  {
    if (json_is_object(value))
      print_object(value, key, text);
  }
}

static void print_assumed(const json_t *list, struct eo_text *text)
{
  static const char *const headings[] = {"key", "value", "", "rule"};
  struct eo_text_table sheet;
  const json_t *row;
  size_t i;
  eo_text_table_init(&sheet, 4, headings);
  json_array_foreach(list, i, row)
  {
    add_row(&sheet, json_string_value(json_object_get(row, "key")), json_object_get(row, "value"),
            json_string_value(json_object_get(row, "rule")));
  }
  eo_text_print(text, "\nassumed: not stated by the design, %zu values\n", json_array_size(list));
  eo_text_table_print(&sheet, 2, text);
  eo_text_table_done(&sheet);
}

void eo_completion_summary(const json_t *completion, struct eo_text *text)
{
  const json_t *warnings = json_object_get(completion, "warnings"), *row;
  const char *name = json_string_value(json_object_get(json_object_get(completion, "design"), "name"));
  size_t i;
  eo_text_print(text, "%s\n", name && *name ? name : "unnamed design");
  print_object(json_object_get(completion, "geometry"), "geometry", text);
  if (json_object_get(completion, "right_geometry"))
    print_object(json_object_get(completion, "right_geometry"), "geometry of the right end", text);
  print_object(json_object_get(completion, "dimensions"),
               "dimensions; of three numbers: nominal, with the upper, with the lower allowance", text);
  if (json_object_get(completion, "right_dimensions"))
    print_object(json_object_get(completion, "right_dimensions"), "dimensions of the right end", text);
  print_assumed(json_object_get(completion, "assumed"), text);
  if (json_array_size(warnings))
    eo_text_add(text, "\nnotes\n");
  json_array_foreach(warnings, i, row) eo_text_print(text, "  %s\n", json_string_value(row));
}
