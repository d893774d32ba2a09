/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
#include "exchange/import.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "exchange/table_import.h"

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

static const struct eo_outline_row pair_rows[] = {
    EO_KEY("number", "integer", "by which it is chosen"),
    EO_KEY("label", "text", "for people"),
    EO_KEY("ends", "integer", "2: double helical", .when = "of a gear pair"),
    EO_KEY("pinion", "[integer]", "ids of the driving gears, left end first", .when = "of REXS"),
    EO_KEY("gear", "[integer]", "ids of the driven gears", .when = "of REXS"),
    EO_KEY("stages", "[integer]", "ids of the stages", .when = "of REXS"),
    EO_KEY("importable", "flag", "it can be chosen"),
    EO_KEY("remark", "text", "what is special about it, or why it cannot be chosen", .when = "where there is one"),
};
static const struct eo_outline pair_outline = EO_OUTLINE("ImportPair", pair_rows);

static const struct eo_outline_row fault_rows[] = {
    EO_KEY("kind", "text", "a word for each kind of fault"),
    EO_KEY("text", "text", "what is wrong and how it is mended, for people"),
    EO_KEY("component", "integer", "id", .when = "of a component"),
    EO_KEY("component_type", "text", "of it", .when = "of a component"),
    EO_KEY("attribute", "text", "name", .when = "of an attribute"),
    EO_KEY("relation", "text", "type and first component", .when = "of a relation"),
    EO_KEY("line", "integer", "of the file", .when = "where it is known"),
    EO_KEY("column", "integer", "of the file", .when = "where it is known"),
    EO_KEY("pointer", "text", "JSON pointer in the file", .when = "of JSON"),
};
static const struct eo_outline fault_outline = EO_OUTLINE("ImportFault", fault_rows);

/* A list or document that the answer shares. */
#define SHARED(name)                                              \
  static json_t *write_##name(const void *source)                 \
  {                                                               \
    return json_incref(((const struct eo_import *)source)->name); \
  }
SHARED(pairs)
SHARED(not_used)
SHARED(refused)
SHARED(assumed)
SHARED(notes)
SHARED(faults)

static json_t *write_design(const void *source)
{
  const struct eo_import *import = source;
  return import->design ? json_incref(import->design) : json_null();
}

static json_t *write_pair(const void *source)
{
  const struct eo_import *import = source;
  return import->pair ? json_integer(import->pair) : json_null();
}

static const struct eo_outline_row import_rows[] = {
    EO_KEY("format", "text", "of the file, with its version", EO_AT(struct eo_import, format)),
    EO_KEY("pairs", "[object]", "what can be chosen", .outline = &pair_outline, .write = write_pairs),
    EO_KEY("pair", "integer?", "number of the one that was read", .write = write_pair),
    EO_KEY("design", "object?", "what the file states of a design; null: see faults", .name = "Design",
           .write = write_design),
    EO_KEY("assumed", "[text]", "what the file leaves open, and what was taken", .write = write_assumed),
    EO_KEY("refused", "[text]", "modifications that a design cannot say; the rest was read", .write = write_refused),
    EO_KEY("not_used", "[text]", "what the file states besides", .write = write_not_used),
    EO_KEY("notes", "[text]", "what was found in reading", .write = write_notes),
    EO_KEY("faults", "[object]", "what is wrong; nothing was read then", .outline = &fault_outline,
           .write = write_faults),
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

json_t *eo_import_fault(struct eo_import *import, const char *kind, const char *format, ...)
{
  char text[400], clean[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  eo_text_clean(clean, sizeof clean, text);
  json_t *fault = json_pack("{s:s, s:s}", "kind", kind, "text", clean);
  import->failed = json_array_append_new(import->faults, fault) != 0 || import->failed;
  return import->failed ? NULL : fault;
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
  for (int i = 0; !import->failed && i < faults->count && i < EO_MAX_FAULTS; i++)
    eo_import_say(import, import->notes, "To be stated or mended before an analysis: %s: %s", faults->fault[i].pointer,
                  faults->fault[i].text);
  free(faults);
  free(design);
}

void eo_import_done(struct eo_import *import)
{
  json_t **const list[] = {&import->pairs,   &import->design, &import->not_used, &import->refused,
                           &import->assumed, &import->notes,  &import->faults};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    json_decref(*list[i]);
    *list[i] = NULL;
  }
}

bool eo_import_begin(struct eo_import *import)
{
  memset(import, 0, sizeof *import);
  json_t **const list[] = {&import->pairs,   &import->not_used, &import->refused,
                           &import->assumed, &import->notes,    &import->faults};
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
  static const char sheet[] = "xl/workbook.xml", mark[] = "\xEF\xBB\xBF";
  size_t at = size >= 3 && memcmp(bytes, mark, 3) == 0 ? 3 : 0;
  while (at < size && strchr(" \t\r\n", bytes[at]) && bytes[at])
    at++;
  bool zip = size > 4 && memcmp(bytes, "PK", 2) == 0;
  bool workbook = zip && memmem(bytes, size, sheet, sizeof sheet - 1);
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
  if (json_array_size(import->faults) > 0) {
    json_decref(import->design);
    import->design = NULL;
  }
  if (import->design && !import->failed)
    tell_what_is_left(import);
  return import->failed ? eo_error_memory(error) : EO_OK;
}
