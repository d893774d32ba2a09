/* SPDX-License-Identifier: GPL-3.0-or-later */
/* REXS as XML, by expat. A document type is refused before anything of it is read, so there are no entities but the
   five of XML itself, and nothing outside the file is opened. */
#include "exchange/rexs_read.h"

#include <expat.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "format/text.h"

enum { PIECE = 1 << 16, UNKNOWN_ELEMENTS = 8 };

enum element {
  NOTHING,
  MODEL,
  RELATIONS,
  RELATION,
  REF,
  COMPONENTS,
  COMPONENT,
  ATTRIBUTE,
  ARRAY,
  MATRIX,
  ROW,
  CELL,
  NEST,
  SPECTRUM,
  LOAD_CASE,
};

static const struct {
  const char *name;
  enum element element, within;
} elements[] = {
    {"model", MODEL, NOTHING},
    {"relations", RELATIONS, MODEL},
    {"relation", RELATION, RELATIONS},
    {"ref", REF, RELATION},
    {"components", COMPONENTS, MODEL},
    {"component", COMPONENT, COMPONENTS},
    {"component", COMPONENT, LOAD_CASE},
    {"attribute", ATTRIBUTE, COMPONENT},
    {"array", ARRAY, ATTRIBUTE},
    {"array", ARRAY, NEST},
    {"matrix", MATRIX, ATTRIBUTE},
    {"r", ROW, MATRIX},
    {"c", CELL, ARRAY},
    {"c", CELL, ROW},
    {"array_of_arrays", NEST, ATTRIBUTE},
    {"load_spectrum", SPECTRUM, MODEL},
    {"load_case", LOAD_CASE, SPECTRUM},
};

struct reader {
  XML_Parser parser;
  struct eo_rexs_model *model;
  struct eo_rexs_problem *problem;
  enum element stack[EO_REXS_DEPTH];
  int depth, skipped; /* skipped: depth within an element that is not known; 0: none */
  struct eo_rexs_relation *relation;
  struct eo_rexs_component *component;
  struct eo_rexs_attribute *attribute;
  struct eo_rexs_load_case *load_case;
  struct eo_text text; /* of the attribute or cell */
  double *cell;        /* of the attribute; owned while it is read */
  int cells, room;
  char code[16];
  bool stopped, seen_model;
};

static struct eo_rexs_place here(const struct reader *reader)
{
  return (struct eo_rexs_place){(int)XML_GetCurrentLineNumber(reader->parser),
                                (int)XML_GetCurrentColumnNumber(reader->parser) + 1, 0};
}

static void stop(struct reader *reader)
{
  reader->stopped = true;
  XML_StopParser(reader->parser, XML_FALSE);
}

static void refuse(struct reader *reader, const char *kind, const char *text)
{
  struct eo_rexs_place place = here(reader);
  if (!reader->stopped)
    eo_rexs_refuse(reader->problem, kind, place.line, place.column, "%s", text);
  stop(reader);
}

static void refuse_many(struct reader *reader, int limit)
{
  struct eo_rexs_place place = here(reader);
  if (!reader->stopped)
    eo_rexs_refuse_many(reader->problem, place.line, place.column, limit);
  stop(reader);
}

/* Names come with or without the prefix of a name space. */
static const char *local(const char *name)
{
  const char *colon = strrchr(name, ':');
  return colon ? colon + 1 : name;
}

static const char *given(const char **attributes, const char *name)
{
  for (; *attributes; attributes += 2)
    if (strcmp(local(attributes[0]), name) == 0)
      return attributes[1];
  return "";
}

static const char *kept(struct reader *reader, const char **attributes, const char *name)
{
  const char *text = given(attributes, name);
  return eo_rexs_text(reader->model, text, strlen(text));
}

static int whole(struct reader *reader, const char **attributes, const char *name, bool needed)
{
  const char *text = given(attributes, name);
  char *end;
  long value = strtol(text, &end, 10);
  if (!*text && !needed)
    return 0;
  if (!*text || *end || value < 0 || value > INT_MAX) {
    refuse(reader, "wrong_id", "A whole number from 0 is needed here as an id or order.");
    return 0;
  }
  return (int)value;
}

static void begin_ref(struct reader *reader, const char **attributes)
{
  if (!reader->relation)
    return;
  if (reader->relation->count >= EO_REXS_REFERENCES) {
    refuse_many(reader, EO_REXS_REFERENCES);
    return;
  }
  struct eo_rexs_reference *reference = &reader->relation->reference[reader->relation->count++];
  reference->id = whole(reader, attributes, "id", true);
  reference->role = kept(reader, attributes, "role");
  reference->hint = kept(reader, attributes, "hint");
}

static void begin_relation(struct reader *reader, const char **attributes)
{
  if (reader->model->relations >= EO_REXS_RELATIONS) {
    refuse_many(reader, EO_REXS_RELATIONS);
    return;
  }
  reader->relation = eo_rexs_add_relation(reader->model);
  if (!reader->relation)
    return;
  reader->relation->place = here(reader);
  reader->relation->id = whole(reader, attributes, "id", true);
  reader->relation->order = whole(reader, attributes, "order", false);
  reader->relation->type = kept(reader, attributes, "type");
}

static void begin_component(struct reader *reader, const char **attributes)
{
  if (reader->model->components + reader->model->varying >= EO_REXS_COMPONENTS) {
    refuse_many(reader, EO_REXS_COMPONENTS);
    return;
  }
  reader->component = reader->load_case ? eo_rexs_add_varying(reader->model, reader->load_case)
                                        : eo_rexs_add_component(reader->model);
  if (!reader->component)
    return;
  reader->component->place = here(reader);
  reader->component->id = whole(reader, attributes, "id", true);
  reader->component->type = kept(reader, attributes, "type");
  reader->component->name = kept(reader, attributes, "name");
}

static void begin_attribute(struct reader *reader, const char **attributes)
{
  if (reader->model->attributes >= EO_REXS_ATTRIBUTES) {
    refuse_many(reader, EO_REXS_ATTRIBUTES);
    return;
  }
  reader->attribute = reader->component ? eo_rexs_add_attribute(reader->model, reader->component) : NULL;
  reader->text.size = 0;
  reader->cells = 0;
  if (!reader->attribute)
    return;
  reader->attribute->place = here(reader);
  reader->attribute->id = kept(reader, attributes, "id");
  reader->attribute->unit = kept(reader, attributes, "unit");
}

static void begin_known(struct reader *reader, enum element element, const char **attributes)
{
  struct eo_rexs_model *model = reader->model;
  switch (element) {
  case MODEL:
    reader->seen_model = true;
    model->version = kept(reader, attributes, "version");
    model->application = kept(reader, attributes, "applicationId");
    model->application_version = kept(reader, attributes, "applicationVersion");
    model->date = kept(reader, attributes, "date");
    break;
  case RELATION:
    begin_relation(reader, attributes);
    break;
  case REF:
    begin_ref(reader, attributes);
    break;
  case LOAD_CASE:
    if (model->load_cases >= EO_REXS_LOAD_CASES) {
      refuse_many(reader, EO_REXS_LOAD_CASES);
      break;
    }
    reader->load_case = eo_rexs_add_load_case(model);
    if (reader->load_case)
      reader->load_case->id = whole(reader, attributes, "id", false);
    break;
  case COMPONENT:
    begin_component(reader, attributes);
    break;
  case ATTRIBUTE:
    begin_attribute(reader, attributes);
    break;
  case ARRAY:
  case MATRIX:
    snprintf(reader->code, sizeof reader->code, "%s", given(attributes, "code"));
    if (reader->attribute)
      reader->attribute->shape = element == ARRAY && reader->stack[reader->depth - 2] == ATTRIBUTE ? EO_REXS_ARRAY
                                                                                                   : EO_REXS_NESTED;
    reader->text.size = 0;
    break;
  case CELL:
    reader->text.size = 0;
    break;
  default:
    break;
  }
}

static void XMLCALL begin(void *context, const char *name, const char **attributes)
{
  struct reader *reader = context;
  if (reader->stopped)
    return;
  if (reader->depth >= EO_REXS_DEPTH) {
    char text[100];
    snprintf(text, sizeof text, "Elements stand in elements more than %d deep; a REXS file never does that.",
             EO_REXS_DEPTH);
    refuse(reader, "too_deep", text);
    return;
  }
  enum element within = reader->depth ? reader->stack[reader->depth - 1] : NOTHING, element = NOTHING;
  for (size_t i = 0; i < sizeof elements / sizeof *elements && !element; i++)
    if (elements[i].within == within && strcmp(local(name), elements[i].name) == 0)
      element = elements[i].element;
  if (!reader->depth && element != MODEL) {
    refuse(reader, "not_rexs", "The file is XML but no REXS file: its outermost element is not \"model\".");
    return;
  }
  reader->stack[reader->depth++] = reader->skipped ? NOTHING : element;
  if (!element && !reader->skipped)
    reader->skipped = reader->depth;
  if (!reader->skipped)
    begin_known(reader, element, attributes);
}

/* The text without blanks around it, in the model's memory. */
static const char *trimmed(struct reader *reader)
{
  static const char blank[] = " \t\r\n";
  const char *text = reader->text.size ? reader->text.data : "";
  size_t length = reader->text.size;
  while (length && strchr(blank, text[length - 1]))
    length--;
  size_t skip = 0;
  while (skip < length && strchr(blank, text[skip]))
    skip++;
  return eo_rexs_text(reader->model, text + skip, length - skip);
}

static void add_cell(struct reader *reader)
{
  if (reader->model->cells >= EO_REXS_CELLS) {
    refuse_many(reader, EO_REXS_CELLS);
    return;
  }
  if (reader->cells == reader->room) {
    int room = reader->room ? 2 * reader->room : 64;
    double *grown = realloc(reader->cell, (size_t)room * sizeof *grown);
    if (!grown) {
      reader->model->failed = true;
      return;
    }
    reader->cell = grown;
    reader->room = room;
  }
  char text[64];
  size_t length = 0;
  for (size_t i = 0; i < reader->text.size && length + 1 < sizeof text; i++)
    if (!strchr(" \t\r\n", reader->text.data[i]))
      text[length++] = reader->text.data[i];
  text[length] = '\0';
  reader->cell[reader->cells++] = eo_rexs_number(text);
  reader->model->cells++;
}

static void end_attribute(struct reader *reader)
{
  struct eo_rexs_attribute *attribute = reader->attribute;
  if (attribute && attribute->shape == EO_REXS_SCALAR)
    attribute->text = trimmed(reader);
  else if (attribute && reader->cells) {
    double *value = eo_rexs_memory(reader->model, (size_t)reader->cells * sizeof *value);
    if (value) {
      memcpy(value, reader->cell, (size_t)reader->cells * sizeof *value);
      attribute->value = value;
      attribute->count = reader->cells;
    }
  }
  reader->attribute = NULL;
  reader->text.size = 0;
}

static void end_array(struct reader *reader)
{
  double *value;
  if (!*reader->code || !reader->attribute)
    return;
  int count = eo_rexs_decode_numbers(reader->model, trimmed(reader), reader->code, &value);
  if (count < 0 || reader->model->cells + count > EO_REXS_CELLS) {
    refuse(reader, "wrong_code", "An array is not Base64 of int32, float32 or float64, or holds too many numbers.");
    return;
  }
  reader->model->cells += count;
  reader->attribute->value = value;
  reader->attribute->count = count;
  reader->code[0] = '\0';
  reader->text.size = 0;
}

static void XMLCALL end(void *context, const char *name)
{
  struct reader *reader = context;
  (void)name;
  if (reader->stopped || !reader->depth)
    return;
  bool known = !reader->skipped;
  if (reader->skipped == reader->depth)
    reader->skipped = 0;
  enum element element = reader->stack[--reader->depth];
  if (!known)
    return;
  if (element == CELL)
    add_cell(reader);
  else if (element == ARRAY || element == MATRIX)
    end_array(reader);
  else if (element == ATTRIBUTE)
    end_attribute(reader);
  else if (element == COMPONENT)
    reader->component = NULL;
  else if (element == RELATION)
    reader->relation = NULL;
  else if (element == LOAD_CASE)
    reader->load_case = NULL;
}

static void XMLCALL take_characters(void *context, const char *text, int length)
{
  struct reader *reader = context;
  if (reader->attribute && !reader->skipped)
    eo_text_add_bytes(&reader->text, text, (size_t)length);
}

static void XMLCALL take_doctype(void *context, const char *name, const char *system, const char *public, int subset)
{
  (void)name;
  (void)system;
  (void)public;
  (void)subset;
  refuse(context, "document_type",
         "The file has a document type (<!DOCTYPE ...>), which can hold entities; REXS has none, so it is refused "
         "unread. Take the line out.");
}

static bool parse(struct reader *reader, const char *bytes, size_t size)
{
  for (size_t at = 0; at < size && !reader->stopped; at += PIECE) {
    size_t piece = size - at < PIECE ? size - at : PIECE;
    if (XML_Parse(reader->parser, bytes + at, (int)piece, at + piece == size) == XML_STATUS_OK)
      continue;
    if (!reader->stopped)
      eo_rexs_refuse(reader->problem, "not_well_formed", (int)XML_GetCurrentLineNumber(reader->parser),
                     (int)XML_GetCurrentColumnNumber(reader->parser) + 1,
                     "The XML is not well-formed: %s; the file is damaged or was cut off.",
                     XML_ErrorString(XML_GetErrorCode(reader->parser)));
    reader->stopped = true;
  }
  return !reader->stopped;
}

bool eo_rexs_read_xml(struct eo_rexs_model *model, const char *bytes, size_t size, struct eo_rexs_problem *problem)
{
  struct reader reader = {.model = model, .problem = problem, .parser = XML_ParserCreate(NULL)};
  if (!reader.parser) {
    eo_error_memory(&problem->error);
    return false;
  }
  XML_SetUserData(reader.parser, &reader);
  XML_SetElementHandler(reader.parser, begin, end);
  XML_SetCharacterDataHandler(reader.parser, take_characters);
  XML_SetStartDoctypeDeclHandler(reader.parser, take_doctype);
  bool good = parse(&reader, bytes, size);
  model->failed = model->failed || reader.text.failed;
  if (good && model->failed) {
    eo_error_memory(&problem->error);
    good = false;
  }
  if (good && !reader.seen_model)
    good = eo_rexs_refuse(problem, "not_well_formed", 1, 1, "The file is empty.");
  XML_ParserFree(reader.parser);
  eo_text_done(&reader.text);
  free(reader.cell);
  return good;
}
