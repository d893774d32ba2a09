/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "format/json.h"
#include "format/table.h"

static void describe_range(const struct eo_field *field, double low, double high, struct eo_text *text)
{
  const char *symbol = field->unit ? field->unit->symbol : "";
  if (isfinite(low) && isfinite(high))
    eo_text_print(text, "%.9g .. %.9g%s%s", low, high, *symbol ? " " : "", symbol);
  else
    eo_text_add(text, *symbol ? symbol : "number");
}

static void describe_choices(const struct eo_field *field, struct eo_text *text)
{
  for (int i = 0; field->choices[i]; i++)
    eo_text_print(text, "%s\"%s\"", i ? " | " : "", field->choices[i]);
}

static void describe_type(const struct eo_field *field, struct eo_text *text)
{
  switch (field->kind) {
  case EO_FIELD_NUMBER:
    describe_range(field, field->low, field->high, text);
    if (field->choices)
      eo_text_add(text, " | ");
    if (field->choices)
      describe_choices(field, text);
    break;
  case EO_FIELD_INTEGER:
  case EO_FIELD_SEED:
    eo_text_print(text, "whole number %.16g .. %.16g", field->low, field->high);
    break;
  case EO_FIELD_FLAG:
    eo_text_add(text, "true | false");
    break;
  case EO_FIELD_TEXT:
    if (field->choices)
      describe_choices(field, text);
    else
      eo_text_print(text, "string of at most %d bytes", field->count - 1);
    break;
  case EO_FIELD_CHOICE:
    describe_choices(field, text);
    break;
  case EO_FIELD_NUMBERS:
    eo_text_print(text, field->flags & EO_FIELD_ALONE ? "one number or %d, " : "%d numbers, ", field->count);
    describe_range(field, field->low, field->high, text);
    break;
  case EO_FIELD_SERIES:
    eo_text_add(text, field->unit || isfinite(field->series_low) ? "numbers, " : "numbers");
    if (field->unit || isfinite(field->series_low))
      describe_range(field, field->series_low, field->series_high, text);
    break;
  case EO_FIELD_MATRIX:
    eo_text_add(text, "rows of numbers, ");
    describe_range(field, field->series_low, field->series_high, text);
    break;
  case EO_FIELD_OBJECT:
  case EO_FIELD_DOCUMENT:
    eo_text_add(text, "object");
    break;
  case EO_FIELD_NAMES:
    eo_text_print(text, "one or %d names, or numbers %.0f .. %.0f", field->count, field->low, field->high);
    break;
  case EO_FIELD_LIST:
    eo_text_print(text, "array of %.0f .. %.0f objects", field->low, field->high);
    break;
  }
}

static void describe_default(const struct eo_field *field, struct eo_text *text)
{
  bool plain = field->kind == EO_FIELD_NUMBER || field->kind == EO_FIELD_INTEGER || field->kind == EO_FIELD_SEED;
  if (field->flags & EO_FIELD_REQUIRED) {
    eo_text_add(text, "; required");
    for (int i = 0; field->instead && field->instead[i]; i++)
      eo_text_print(text, "%s%s", i ? ", " : ", or ", field->instead[i]);
  } else if (field->flags & EO_FIELD_ENTRY)
    eo_text_print(text, "; another way to state %s", field->states);
  else if (field->derived)
    eo_text_print(text, "; default %s%s", field->flags & EO_FIELD_NULLABLE ? "null: " : "", field->derived);
  else if (plain)
    eo_text_print(text, "; default %.15g", field->fallback);
  else if (field->kind == EO_FIELD_FLAG)
    eo_text_print(text, "; default %s", field->fallback != 0 ? "true" : "false");
  else if (field->kind == EO_FIELD_CHOICE)
    eo_text_print(text, "; default \"%s\"", field->choices[(int)field->fallback]);
  else if (field->kind == EO_FIELD_TEXT)
    eo_text_print(text, "; default \"%s\"", field->fallback_text ? field->fallback_text : "");
  else if (field->kind == EO_FIELD_NUMBERS && field->fallbacks)
    for (int i = 0; i < field->count; i++)
      eo_text_print(text, "%s%.15g%s", i ? ", " : "; default [", field->fallbacks[i], i == field->count - 1 ? "]" : "");
  if (field->basis)
    eo_text_print(text, ", %s", field->basis);
}

/* Tables that were described already, and under which key. */
struct seen {
  int count;
  const struct eo_field *field[64];
};

static const struct eo_field *find_seen(const struct seen *seen, const struct eo_table *table)
{
  for (int i = 0; i < seen->count; i++)
    if (seen->field[i]->table == table)
      return seen->field[i];
  return NULL;
}

static void describe(const struct eo_table *table, bool output, int indent, struct seen *seen, struct eo_text *text)
{
  for (int i = 0; i < table->count; i++) {
    const struct eo_field *field = &table->field[i];
    eo_text_print(text, "%*s%-*s  %s (", indent, "", 44 - indent, field->key, field->help ? field->help : "");
    describe_type(field, text);
    const struct eo_field *before = field->table ? find_seen(seen, field->table) : NULL;
    if (before)
      eo_text_print(text, ", keys as in %s", before->key);
    if (!output)
      describe_default(field, text);
    eo_text_add(text, ")\n");
    if (!field->table || before)
      continue;
    if (seen->count < (int)(sizeof seen->field / sizeof seen->field[0]))
      seen->field[seen->count++] = field;
    describe(field->table, output, indent + 2, seen, text);
  }
}

void eo_table_describe(const struct eo_table *table, bool output, struct eo_text *text)
{
  struct seen seen = {0};
  describe(table, output, 2, &seen, text);
}
