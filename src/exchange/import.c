/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/import.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "exchange/cells.h"
#include "exchange/table_import.h"
#include "format/object.h"

static const char *const flanks[] = {"stated", "left", "right", NULL};

static const struct eo_field options[] = {
    EO_INTEGER(struct eo_import_options, pair, "pair", 0, 100000, 0,
               "number of the pair, or of the design in a table; 0: the only one"),
    EO_FLAG(struct eo_import_options, transverse, "transverse", 0,
            "amounts of modifications stand in the transverse section, not normal to the flank"),
    EO_FLAG(struct eo_import_options, reversed, "reversed", 0,
            "a positive helix slope takes material off towards the datum face, not the other one"),
    EO_CHOICE(struct eo_import_options, flank, "flank", flanks, 0,
              "loaded flank of the driver, where the file leaves it open"),
};
const struct eo_table eo_import_options_table = EO_TABLE("import", struct eo_import_options, options);

static json_t *list_ids(int count, const int *id)
{
  struct eo_object list = eo_list_open();
  for (int i = 0; i < count; i++)
    eo_list_add(&list, json_integer(id[i]));
  return eo_object_close(&list);
}

static json_t *write_pinion(const void *source)
{
  const struct eo_import_pair *pair = source;
  return list_ids(pair->ends, pair->pinion);
}

static json_t *write_gear(const void *source)
{
  const struct eo_import_pair *pair = source;
  return list_ids(pair->ends, pair->gear);
}

static json_t *write_stages(const void *source)
{
  const struct eo_import_pair *pair = source;
  return list_ids(pair->stages, pair->stage);
}

static bool is_of_rexs(const void *source)
{
  return ((const struct eo_import_pair *)source)->ends != 0;
}

#define OF_PAIR(member) EO_AT(struct eo_import_pair, member)
static const struct eo_outline_row pair_rows[] = {
    EO_KEY("number", "integer", "by which it is chosen", OF_PAIR(number)),
    EO_KEY("label", "text", "for people", OF_PAIR(label)),
    EO_KEY("ends", "integer", "2: double helical", .when = "of a gear pair", OF_PAIR(ends), EO_FILLED),
    EO_KEY("pinion", "[integer]", "ids of the driving gears, left end first", .when = "of REXS", .there = is_of_rexs,
           .write = write_pinion),
    EO_KEY("gear", "[integer]", "ids of the driven gears", .when = "of REXS", .there = is_of_rexs, .write = write_gear),
    EO_KEY("stages", "[integer]", "ids of the stages", .when = "of REXS", .there = is_of_rexs, .write = write_stages),
    EO_KEY("importable", "flag", "it can be chosen", OF_PAIR(importable)),
    EO_KEY("remark", "text", "what is special about it, or why it cannot be chosen", .when = "where there is one",
           OF_PAIR(remark), EO_FILLED),
};
const struct eo_outline eo_import_pair_outline = EO_OUTLINE("ImportPair", pair_rows);

#define OF_FAULT(member) EO_AT(struct eo_import_fault, member)
static const struct eo_outline_row fault_rows[] = {
    EO_KEY("kind", "text", "a word for each kind of fault", OF_FAULT(kind)),
    EO_KEY("text", "text", "what is wrong and how it is mended, for people", OF_FAULT(text)),
    EO_KEY("relation", "text", "type and first component", .when = "of a relation", OF_FAULT(relation), EO_FILLED),
    EO_KEY("component", "integer", "id; of a relation the one that is not there",
           .when = "of a component or a relation", OF_FAULT(component), EO_IF(struct eo_import_fault, of_component)),
    EO_KEY("component_type", "text", "of it", .when = "of a component", OF_FAULT(component_type), EO_FILLED),
    EO_KEY("attribute", "text", "name", .when = "of an attribute", OF_FAULT(attribute), EO_FILLED),
    EO_KEY("line", "integer", "of the file", .when = "where it is known", OF_FAULT(line), EO_FILLED),
    EO_KEY("column", "integer", "of the file", .when = "where it is known", OF_FAULT(column), EO_FILLED),
    EO_KEY("pointer", "text", "JSON pointer in the file", .when = "of JSON", OF_FAULT(pointer), EO_FILLED),
    EO_KEY("key", "text", "JSON pointer in the design", .when = "of a pair that cannot be made", OF_FAULT(key),
           EO_FILLED),
};
const struct eo_outline eo_import_fault_outline = EO_OUTLINE("ImportFault", fault_rows);

/* A list or document that the answer shares. */
#define SHARED(name)                                              \
  static json_t *write_##name(const void *source)                 \
  {                                                               \
    return json_incref(((const struct eo_import *)source)->name); \
  }
SHARED(not_used)
SHARED(refused)
SHARED(assumed)
SHARED(notes)

static json_t *write_design(const void *source)
{
  const struct eo_import *import = source;
  return import->design ? json_incref(import->design) : json_null();
}

static json_t *write_pair(const void *source)
{
  const struct eo_import *import = source;
  return import->taken ? json_integer(import->taken) : json_null();
}

static const struct eo_outline_row import_rows[] = {
    EO_KEY("format", "text", "of the file, with its version", EO_AT(struct eo_import, format)),
    EO_KEY("pairs", "[object]", "what can be chosen", .outline = &eo_import_pair_outline,
           EO_ROWS_AT(struct eo_import, pair, pairs)),
    EO_KEY("pair", "integer?", "number of the one that was read", .write = write_pair),
    EO_KEY("design", "object?", "what the file states of a design; null: see faults", .name = "Design",
           .write = write_design),
    EO_KEY("assumed", "[text]", "what the file leaves open, and what was taken", .write = write_assumed),
    EO_KEY("refused", "[text]", "modifications that a design cannot say; the rest was read", .write = write_refused),
    EO_KEY("not_used", "[text]", "what else the file states", .write = write_not_used),
    EO_KEY("notes", "[text]", "what was found in reading", .write = write_notes),
    EO_KEY("faults", "[object]", "what is wrong; nothing was read then", .outline = &eo_import_fault_outline,
           EO_ROWS_AT(struct eo_import, fault, faults)),
};
const struct eo_outline eo_import_outline = EO_OUTLINE("Import", import_rows);

json_t *eo_import_encode(const struct eo_import *import)
{
  return eo_outline_encode(&eo_import_outline, import);
}

void eo_import_say(struct eo_import *import, json_t *list, const char *format, ...)
{
  char text[400], clean[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  eo_text_clean(clean, sizeof clean, text);
  for (size_t i = 0; i < json_array_size(list); i++)
    if (strcmp(json_string_value(json_array_get(list, i)), clean) == 0)
      return;
  import->failed = json_array_append_new(list, json_string(clean)) != 0 || import->failed;
}

const char *eo_import_text(struct eo_import *import, const char *text)
{
  char clean[400];
  eo_text_clean(clean, sizeof clean, text);
  const char *kept = strdup(clean);
  import->failed = import->failed || !kept;
  return kept;
}

/* Room for one more than `count`: doubled where it is full, at every power of two. NULL: none, and all stays. */
static void *grow(void *rows, int count, size_t size)
{
  return count & (count - 1) ? rows : realloc(rows, (count ? 2 * (size_t)count : 1) * size);
}

struct eo_import_pair *eo_import_list(struct eo_import *import)
{
  struct eo_import_pair *pair = grow(import->pair, import->pairs, sizeof *pair);
  if (!pair) {
    import->failed = true;
    return NULL;
  }
  import->pair = pair;
  pair += import->pairs++;
  *pair = (struct eo_import_pair){.number = import->pairs};
  return pair;
}

struct eo_import_fault *eo_import_fault(struct eo_import *import, const char *kind, const char *format, ...)
{
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  struct eo_import_fault *fault = grow(import->fault, import->faults, sizeof *fault);
  if (!fault) {
    import->failed = true;
    return NULL;
  }
  import->fault = fault;
  fault += import->faults++;
  *fault = (struct eo_import_fault){.kind = kind, .text = eo_import_text(import, text)};
  return fault;
}

bool eo_import_has_key(const struct eo_table *table, const char *key)
{
  for (int i = 0; i < table->count; i++)
    if (strcmp(table->field[i].key, key) == 0)
      return true;
  return false;
}

/* What keeps the design from being analysed as it is: a key that the file does not state, a number out of range. */
static void tell_what_is_left(struct eo_import *import)
{
  struct eo_faults *faults = calloc(1, sizeof *faults);
  struct eo_design *design = calloc(1, sizeof *design);
  import->failed = import->failed || !faults || !design;
  if (!import->failed)
    eo_design_decode(import->design, design, NULL, faults);
  import->failed = import->failed || eo_faults_first(faults, NULL) == EO_ERROR_MEMORY;
  for (int i = 0; !import->failed && i < faults->count && i < EO_MAX_FAULTS; i++)
    eo_import_say(import, import->notes, "To be stated or mended before an analysis: %s: %s", faults->fault[i].pointer,
                  faults->fault[i].text);
  free(faults);
  free(design);
}

static void release(struct eo_import_fault *fault)
{
  const char *const text[] = {fault->text,      fault->relation, fault->component_type,
                              fault->attribute, fault->pointer,  fault->key};
  for (size_t i = 0; i < sizeof text / sizeof *text; i++)
    free((char *)text[i]);
}

void eo_import_done(struct eo_import *import)
{
  json_t **const list[] = {&import->design, &import->not_used, &import->refused, &import->assumed, &import->notes};
  for (int i = 0; i < import->faults; i++)
    release(&import->fault[i]);
  free(import->fault);
  free(import->pair);
  import->fault = NULL;
  import->pair = NULL;
  import->faults = import->pairs = 0;
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    json_decref(*list[i]);
    *list[i] = NULL;
  }
}

bool eo_import_begin(struct eo_import *import)
{
  memset(import, 0, sizeof *import);
  json_t **const list[] = {&import->not_used, &import->refused, &import->assumed, &import->notes};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    *list[i] = json_array();
    import->failed = import->failed || !*list[i];
  }
  return !import->failed;
}

/* By the first bytes: XML and JSON are models, a zip archive is one too unless a workbook stands in it, all else is a
   table. */
static void read_any(struct eo_import *import, const char *bytes, size_t size, const struct eo_import_options *options_)
{
  static const char mark[] = "\xEF\xBB\xBF";
  size_t at = size >= 3 && memcmp(bytes, mark, 3) == 0 ? 3 : 0;
  while (at < size && strchr(" \t\r\n", bytes[at]) && bytes[at])
    at++;
  bool zip = size > 4 && memcmp(bytes, "PK", 2) == 0;
  bool workbook = eo_cells_kind_of(bytes, size) != EO_CELLS_NONE;
  bool wide = size >= 2 && (unsigned char)bytes[0] >= 0xFE; /* two bytes a character: XML is, or a table */
  at = wide ? (bytes[2 * (size > 2)] ? 2 : 3) : at;
  bool model = at >= size || bytes[at] == '<' || bytes[at] == '{';
  if (workbook || (!zip && !model))
    eo_import_table(import, bytes, size, workbook, options_);
  else
    eo_import_rexs(import, bytes, size, options_);
}

enum eo_code eo_import_read(struct eo_import *import, const char *bytes, size_t size,
                            const struct eo_import_options *options_, struct eo_error *error)
{
  eo_import_begin(import);
  if (!import->failed)
    read_any(import, bytes, size, options_);
  if (import->faults > 0) {
    json_decref(import->design);
    import->design = NULL;
  }
  if (import->design && !import->failed)
    tell_what_is_left(import);
  return import->failed ? eo_error_memory(error) : EO_OK;
}
