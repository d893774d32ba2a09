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

static void refuse(struct reader *r, const char *kind, const char *text)
{
  if (!r->stopped)
    eo_rexs_refuse(r->problem, kind, (int)XML_GetCurrentLineNumber(r->parser),
                   (int)XML_GetCurrentColumnNumber(r->parser) + 1, "%s", text);
  r->stopped = true;
  XML_StopParser(r->parser, XML_FALSE);
}

static struct eo_rexs_place here(const struct reader *r)
{
  return (struct eo_rexs_place){(int)XML_GetCurrentLineNumber(r->parser),
                                (int)XML_GetCurrentColumnNumber(r->parser) + 1, 0};
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

static const char *kept(struct reader *r, const char **attributes, const char *name)
{
  const char *text = given(attributes, name);
  return eo_rexs_text(r->model, text, strlen(text));
}

static int whole(struct reader *r, const char **attributes, const char *name, bool needed)
{
  const char *text = given(attributes, name);
  char *end;
  long value = strtol(text, &end, 10);
  if (!*text && !needed)
    return 0;
  if (!*text || *end || value < 0 || value > INT_MAX) {
    refuse(r, "wrong_id", "A whole number from 0 is needed here as an id or order.");
    return 0;
  }
  return (int)value;
}

static void begin_ref(struct reader *r, const char **attributes)
{
  if (!r->relation)
    return;
  if (r->relation->count >= EO_REXS_REFERENCES) {
    refuse(r, "too_large", "A relation has more than 12 references; no relation of REXS has so many.");
    return;
  }
  struct eo_rexs_reference *reference = &r->relation->reference[r->relation->count++];
  reference->id = whole(r, attributes, "id", true);
  reference->role = kept(r, attributes, "role");
  reference->hint = kept(r, attributes, "hint");
}

static void begin_relation(struct reader *r, const char **attributes)
{
  if (r->model->relations >= EO_REXS_RELATIONS) {
    refuse(r, "too_large", "The file has more than 40000 relations.");
    return;
  }
  r->relation = eo_rexs_add_relation(r->model);
  if (!r->relation)
    return;
  r->relation->place = here(r);
  r->relation->id = whole(r, attributes, "id", true);
  r->relation->order = whole(r, attributes, "order", false);
  r->relation->type = kept(r, attributes, "type");
}

static void begin_component(struct reader *r, const char **attributes)
{
  if (r->model->components + r->model->varying >= EO_REXS_COMPONENTS) {
    refuse(r, "too_large", "The file has more than 20000 components.");
    return;
  }
  r->component = r->load_case ? eo_rexs_add_varying(r->model, r->load_case) : eo_rexs_add_component(r->model);
  if (!r->component)
    return;
  r->component->place = here(r);
  r->component->id = whole(r, attributes, "id", true);
  r->component->type = kept(r, attributes, "type");
  r->component->name = kept(r, attributes, "name");
}

static void begin_attribute(struct reader *r, const char **attributes)
{
  if (r->model->attributes >= EO_REXS_ATTRIBUTES) {
    refuse(r, "too_large", "The file has more than 200000 attributes; leave out results that a design does not need.");
    return;
  }
  r->attribute = r->component ? eo_rexs_add_attribute(r->model, r->component) : NULL;
  r->text.size = 0;
  r->cells = 0;
  if (!r->attribute)
    return;
  r->attribute->place = here(r);
  r->attribute->id = kept(r, attributes, "id");
  r->attribute->unit = kept(r, attributes, "unit");
}

static void begin_known(struct reader *r, enum element element, const char **attributes)
{
  struct eo_rexs_model *model = r->model;
  switch (element) {
  case MODEL:
    r->seen_model = true;
    model->version = kept(r, attributes, "version");
    model->application = kept(r, attributes, "applicationId");
    model->application_version = kept(r, attributes, "applicationVersion");
    model->date = kept(r, attributes, "date");
    break;
  case RELATION:
    begin_relation(r, attributes);
    break;
  case REF:
    begin_ref(r, attributes);
    break;
  case LOAD_CASE:
    if (model->load_cases >= EO_REXS_LOAD_CASES) {
      refuse(r, "too_large", "The file has more than 2000 load cases.");
      break;
    }
    r->load_case = eo_rexs_add_load_case(model);
    if (r->load_case)
      r->load_case->id = whole(r, attributes, "id", false);
    break;
  case COMPONENT:
    begin_component(r, attributes);
    break;
  case ATTRIBUTE:
    begin_attribute(r, attributes);
    break;
  case ARRAY:
  case MATRIX:
    snprintf(r->code, sizeof r->code, "%s", given(attributes, "code"));
    if (r->attribute)
      r->attribute->shape = element == ARRAY && r->stack[r->depth - 2] == ATTRIBUTE ? EO_REXS_ARRAY : EO_REXS_NESTED;
    r->text.size = 0;
    break;
  case CELL:
    r->text.size = 0;
    break;
  default:
    break;
  }
}

static void XMLCALL begin(void *context, const char *name, const char **attributes)
{
  struct reader *r = context;
  if (r->stopped)
    return;
  if (r->depth >= EO_REXS_DEPTH) {
    refuse(r, "too_deep", "Elements stand in elements more than 16 deep; a REXS file never does that.");
    return;
  }
  enum element within = r->depth ? r->stack[r->depth - 1] : NOTHING, element = NOTHING;
  for (size_t i = 0; i < sizeof elements / sizeof *elements && !element; i++)
    if (elements[i].within == within && strcmp(local(name), elements[i].name) == 0)
      element = elements[i].element;
  if (!r->depth && element != MODEL) {
    refuse(r, "not_rexs", "The file is XML but no REXS file: its outermost element is not \"model\".");
    return;
  }
  r->stack[r->depth++] = r->skipped ? NOTHING : element;
  if (!element && !r->skipped)
    r->skipped = r->depth;
  if (!r->skipped)
    begin_known(r, element, attributes);
}

/* The text without blanks around it, in the model's memory. */
static const char *trimmed(struct reader *r)
{
  static const char blank[] = " \t\r\n";
  const char *text = r->text.size ? r->text.data : "";
  size_t length = r->text.size;
  while (length && strchr(blank, text[length - 1]))
    length--;
  size_t skip = 0;
  while (skip < length && strchr(blank, text[skip]))
    skip++;
  return eo_rexs_text(r->model, text + skip, length - skip);
}

static void add_cell(struct reader *r)
{
  if (r->model->cells >= EO_REXS_CELLS) {
    refuse(r, "too_large", "The arrays of the file hold more than 4000000 values.");
    return;
  }
  if (r->cells == r->room) {
    int room = r->room ? 2 * r->room : 64;
    double *grown = realloc(r->cell, (size_t)room * sizeof *grown);
    if (!grown) {
      r->model->failed = true;
      return;
    }
    r->cell = grown;
    r->room = room;
  }
  char text[64];
  size_t length = 0;
  for (size_t i = 0; i < r->text.size && length + 1 < sizeof text; i++)
    if (!strchr(" \t\r\n", r->text.data[i]))
      text[length++] = r->text.data[i];
  text[length] = '\0';
  r->cell[r->cells++] = eo_rexs_number(text);
  r->model->cells++;
}

static void end_attribute(struct reader *r)
{
  struct eo_rexs_attribute *a = r->attribute;
  if (a && a->shape == EO_REXS_SCALAR)
    a->text = trimmed(r);
  else if (a && r->cells) {
    double *value = eo_rexs_memory(r->model, (size_t)r->cells * sizeof *value);
    if (value) {
      memcpy(value, r->cell, (size_t)r->cells * sizeof *value);
      a->value = value;
      a->count = r->cells;
    }
  }
  r->attribute = NULL;
  r->text.size = 0;
}

static void end_array(struct reader *r)
{
  double *value;
  if (!*r->code || !r->attribute)
    return;
  int count = eo_rexs_decode_numbers(r->model, trimmed(r), r->code, &value);
  if (count < 0 || r->model->cells + count > EO_REXS_CELLS) {
    refuse(r, "wrong_code", "An array is not Base64 of int32, float32 or float64, or holds too many numbers.");
    return;
  }
  r->model->cells += count;
  r->attribute->value = value;
  r->attribute->count = count;
  r->code[0] = '\0';
  r->text.size = 0;
}

static void XMLCALL end(void *context, const char *name)
{
  struct reader *r = context;
  (void)name;
  if (r->stopped || !r->depth)
    return;
  bool known = !r->skipped;
  if (r->skipped == r->depth)
    r->skipped = 0;
  enum element element = r->stack[--r->depth];
  if (!known)
    return;
  if (element == CELL)
    add_cell(r);
  else if (element == ARRAY || element == MATRIX)
    end_array(r);
  else if (element == ATTRIBUTE)
    end_attribute(r);
  else if (element == COMPONENT)
    r->component = NULL;
  else if (element == RELATION)
    r->relation = NULL;
  else if (element == LOAD_CASE)
    r->load_case = NULL;
}

static void XMLCALL take_characters(void *context, const char *text, int length)
{
  struct reader *r = context;
  if (r->attribute && !r->skipped)
    eo_text_add_bytes(&r->text, text, (size_t)length);
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

static bool parse(struct reader *r, const char *bytes, size_t size)
{
  for (size_t at = 0; at < size && !r->stopped; at += PIECE) {
    size_t piece = size - at < PIECE ? size - at : PIECE;
    if (XML_Parse(r->parser, bytes + at, (int)piece, at + piece == size) == XML_STATUS_OK)
      continue;
    if (!r->stopped)
      eo_rexs_refuse(r->problem, "not_well_formed", (int)XML_GetCurrentLineNumber(r->parser),
                     (int)XML_GetCurrentColumnNumber(r->parser) + 1,
                     "The XML is not well-formed: %s; the file is damaged or was cut off.",
                     XML_ErrorString(XML_GetErrorCode(r->parser)));
    r->stopped = true;
  }
  return !r->stopped;
}

bool eo_rexs_read_xml(struct eo_rexs_model *model, const char *bytes, size_t size, struct eo_rexs_problem *problem)
{
  struct reader r = {.model = model, .problem = problem, .parser = XML_ParserCreate(NULL)};
  if (!r.parser) {
    eo_error_memory(&problem->error);
    return false;
  }
  XML_SetUserData(r.parser, &r);
  XML_SetElementHandler(r.parser, begin, end);
  XML_SetCharacterDataHandler(r.parser, take_characters);
  XML_SetStartDoctypeDeclHandler(r.parser, take_doctype);
  bool good = parse(&r, bytes, size);
  model->failed = model->failed || r.text.failed;
  if (good && model->failed) {
    eo_error_memory(&problem->error);
    good = false;
  }
  if (good && !r.seen_model)
    good = eo_rexs_refuse(problem, "not_well_formed", 1, 1, "The file is empty.");
  XML_ParserFree(r.parser);
  eo_text_done(&r.text);
  free(r.cell);
  return good;
}
