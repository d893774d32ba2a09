/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/form.h"

#include <math.h>

#include "format/json.h"
#include "format/object.h"
#include "format/schema_private.h"

static const char *const kinds[] = {
    [EO_FIELD_NUMBER] = "number",   [EO_FIELD_INTEGER] = "integer", [EO_FIELD_SEED] = "seed",
    [EO_FIELD_FLAG] = "flag",       [EO_FIELD_TEXT] = "text",       [EO_FIELD_CHOICE] = "choice",
    [EO_FIELD_NUMBERS] = "numbers", [EO_FIELD_OBJECT] = "object",   [EO_FIELD_LIST] = "list",
    [EO_FIELD_SERIES] = "series",   [EO_FIELD_MATRIX] = "matrix",   [EO_FIELD_DOCUMENT] = "document",
    [EO_FIELD_NAMES] = "names",     [EO_FIELD_NAMES + 1] = NULL,
};

/* A field as it is written. Ends of ranges: NAN where there is none. */
struct view {
  const struct eo_field *field;
  const json_t *defaults;
  const char *key, *unit, *symbol, *help, *derived, *basis, *entry; /* NULL: it does not apply */
  int kind, count;
  double low, high, number_low, number_high;
  bool counted, required, nullable;
};

#define BOUND(name)                                              \
  static bool has_##name(const void *source)                     \
  {                                                              \
    return isfinite(((const struct view *)source)->name);        \
  }                                                              \
  static json_t *write_##name(const void *source)                \
  {                                                              \
    return eo_schema_bound(((const struct view *)source)->name); \
  }
BOUND(low)
BOUND(high)
BOUND(number_low)
BOUND(number_high)

static bool has_default(const void *source)
{
  return eo_schema_has_default(((const struct view *)source)->field);
}

static json_t *write_default(const void *source)
{
  const struct view *view = source;
  return eo_schema_default(view->field, view->defaults);
}

static bool has_usual(const void *source)
{
  return ((const struct view *)source)->field->usual != NULL;
}

static json_t *write_usual(const void *source)
{
  const struct eo_field *field = ((const struct view *)source)->field;
  return eo_json_reals(field->count, field->usual, 1, NULL, EO_DIGITS_NUMBER);
}

static bool has_choices(const void *source)
{
  return ((const struct view *)source)->field->choices != NULL;
}

static json_t *write_choices(const void *source)
{
  return eo_schema_texts(((const struct view *)source)->field->choices);
}

static bool has_instead(const void *source)
{
  return ((const struct view *)source)->field->instead != NULL;
}

static json_t *write_instead(const void *source)
{
  return eo_schema_texts(((const struct view *)source)->field->instead);
}

static bool has_fields(const void *source)
{
  return ((const struct view *)source)->field->table != NULL;
}

static json_t *list_fields(const void *source);

static json_t *write_fields(const void *source)
{
  return list_fields(((const struct view *)source)->field->table);
}

#define OF_FIELD(member) EO_AT(struct view, member)
#define APPLIES .when = "where it applies"
static const struct eo_outline_row field_rows[] = {
    EO_KEY("key", "text", "of the document", OF_FIELD(key)),
    EO_KEY("kind", "word", "of its value", .words = kinds, OF_FIELD(kind)),
    EO_KEY("unit", "text", "suffix of the key", APPLIES, OF_FIELD(unit), EO_FILLED),
    EO_KEY("symbol", "text", "of the unit", APPLIES, OF_FIELD(symbol), EO_FILLED),
    EO_KEY("low", "number", "lowest", APPLIES, .there = has_low, .write = write_low),
    EO_KEY("high", "number", "highest", APPLIES, .there = has_high, .write = write_high),
    EO_KEY("number_low", "number", "lowest of each number", APPLIES, .there = has_number_low,
           .write = write_number_low),
    EO_KEY("number_high", "number", "highest of each number", APPLIES, .there = has_number_high,
           .write = write_number_high),
    EO_KEY("count", "integer", "how many", APPLIES, OF_FIELD(count), EO_IF(struct view, counted)),
    EO_KEY("default", "any", "as the document says it", APPLIES, .there = has_default, .write = write_default),
    EO_KEY("usual", "[number]", "what a form starts with; nothing assumes it",
           .when = "where there is no default to start with", .there = has_usual, .write = write_usual),
    EO_KEY("choices", "[text]", "one of these", APPLIES, .there = has_choices, .write = write_choices),
    EO_KEY("help", "text", "one line for people", APPLIES, OF_FIELD(help), EO_FILLED),
    EO_KEY("required", "flag", "there is no default", OF_FIELD(required)),
    EO_KEY("nullable", "flag", "null is allowed", OF_FIELD(nullable)),
    EO_KEY("derived", "text", "what null means", APPLIES, OF_FIELD(derived), EO_FILLED),
    EO_KEY("basis", "text", "where a default that is a number comes from", .when = "where it is not the program's own",
           OF_FIELD(basis), EO_FILLED),
    EO_KEY("entry", "text", "the key of the same object that it is another way to state; read and never written",
           .when = "where it is", OF_FIELD(entry), EO_FILLED),
    EO_KEY("instead", "[text]", "keys of the same object of which one may stand in the place of a required one",
           .when = "where there are", .there = has_instead, .write = write_instead),
    EO_KEY("fields", "[object]", "of the object, or of each row", APPLIES, .name = "Field", .there = has_fields,
           .write = write_fields),
};
static const struct eo_outline field_outline = EO_OUTLINE("Field", field_rows);

static const struct eo_outline_row fields_rows[] = {
    EO_KEY("name", "text", "for people", EO_AT(struct eo_table, name)),
    EO_KEY("fields", "[object]", "in the order of the document", .outline = &field_outline, .write = list_fields),
};
const struct eo_outline eo_fields_outline = EO_OUTLINE("Fields", fields_rows);

/* Of a number, of each number, of the number of rows; of a series and a matrix each number has its own. */
static void put_range(struct view *view, const struct eo_field *field)
{
  switch (field->kind) {
  case EO_FIELD_SERIES:
  case EO_FIELD_MATRIX:
    view->number_low = field->series_low;
    view->number_high = field->series_high;
    break;
  case EO_FIELD_NUMBER:
  case EO_FIELD_INTEGER:
  case EO_FIELD_SEED:
  case EO_FIELD_NUMBERS:
  case EO_FIELD_LIST:
    break;
  default:
    return;
  }
  view->low = field->low;
  view->high = field->high;
}

static json_t *encode_field(const struct eo_field *field, const json_t *defaults)
{
  struct view view = {.field = field,
                      .defaults = defaults,
                      .key = field->key,
                      .kind = (int)field->kind,
                      .help = field->help,
                      .derived = field->derived,
                      .basis = field->basis,
                      .entry = field->flags & EO_FIELD_ENTRY ? field->states : NULL,
                      .low = NAN,
                      .high = NAN,
                      .number_low = NAN,
                      .number_high = NAN,
                      .count = field->kind == EO_FIELD_TEXT ? field->count - 1 : field->count,
                      .counted = field->kind == EO_FIELD_NUMBERS || field->kind == EO_FIELD_LIST ||
                                 field->kind == EO_FIELD_TEXT,
                      .required = field->flags & EO_FIELD_REQUIRED,
                      .nullable = field->flags & EO_FIELD_NULLABLE};
  if (field->unit) {
    view.unit = field->unit->suffix;
    view.symbol = field->unit->symbol;
  }
  put_range(&view, field);
  return eo_outline_encode(&field_outline, &view);
}

/* source: a struct eo_table */
static json_t *list_fields(const void *source)
{
  const struct eo_table *table = source;
  struct eo_object list = eo_list_open();
  json_t *defaults = eo_schema_defaults(table);
  list.failed = list.failed || !defaults;
  for (int i = 0; i < table->count && !list.failed; i++)
    eo_list_add(&list, encode_field(&table->field[i], defaults));
  json_decref(defaults);
  return eo_object_close(&list);
}

json_t *eo_table_fields(const struct eo_table *table)
{
  return eo_outline_encode(&eo_fields_outline, table);
}
