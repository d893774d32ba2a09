/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of an OpenDocument spreadsheet, cell by cell (sheet_text.h settles which are written). Source: OASIS
   OpenDocument 1.2, part 1: table:table, table:table-row, table:table-cell with office:value-type. */
#include "recording/zip_files.h"
#include "recording/sheet_text.h"

#include <expat.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define VALUE \
  ((size_t)512 << 10) /* bytes of a cell's value at most: a grid of a flank as one list; longer texts are cut */

struct document {
  struct eo_archive *archive;
  struct eo_sheet_text out;
  bool taken; /* the cells of the current table */
  bool failed, in_cell, in_paragraph, filled, formula;
  bool in_annotation; /* what somebody noted at the cell is none of its text */
  int column, repeat;
  long rows; /* like the current one, with it */
  char type[16], value[VALUE];
  size_t length;
};

static const char *attribute(const char **attributes, const char *name)
{
  for (; *attributes; attributes += 2)
    if (!strcmp(attributes[0], name))
      return attributes[1];
  return NULL;
}

static void XMLCALL take_characters(void *context, const char *text, int length)
{
  struct document *document = context;
  if (!document->in_cell || !document->in_paragraph)
    return;
  size_t n = (size_t)length < VALUE - 1 - document->length ? (size_t)length : VALUE - 1 - document->length;
  memcpy(document->value + document->length, text, n);
  document->length += n;
  document->value[document->length] = '\0';
}

/* A new paragraph or line, or a blank that is an element: a blank, unless nothing stands before it. */
static void take_gap(struct document *document)
{
  if (document->length && !document->filled && !document->in_annotation)
    take_characters(document, " ", 1);
}

static void set_value(struct document *document, const char *text)
{
  snprintf(document->value, sizeof document->value, "%s", text);
  document->length = strlen(document->value);
}

/* "PT08H59M59.5S" as seconds. */
static double duration(const char *text)
{
  double seconds = 0;
  for (const char *p = text; *p;) {
    char *end;
    double number = strtod(p, &end);
    if (end == p) {
      p++;
      continue;
    }
    seconds += number * (*end == 'H' ? 3600 : *end == 'M' ? 60 : *end == 'D' ? 86400 : 1);
    p = *end ? end + 1 : end;
  }
  return seconds;
}

static void begin_cell(struct document *document, const char **attributes)
{
  const char *type = attribute(attributes, "office:value-type"), *value = attribute(attributes, "office:value"),
             *date = attribute(attributes, "office:date-value"), *time = attribute(attributes, "office:time-value"),
             *repeat = attribute(attributes, "table:number-columns-repeated");
  document->in_cell = true;
  document->formula = attribute(attributes, "table:formula") != NULL;
  document->repeat = repeat ? (int)strtol(repeat, NULL, 10) : 1;
  document->repeat = document->repeat < 1 ? 1 : document->repeat;
  snprintf(document->type, sizeof document->type, "%s", type ? type : "");
  set_value(document, "");
  if (value)
    set_value(document, value);
  else if (date)
    set_value(document, date);
  else if (time) {
    char text[40];
    snprintf(text, sizeof text, "%.9f", duration(time));
    set_value(document, text);
  }
  document->filled = document->length > 0;
}

static void XMLCALL begin(void *context, const char *name, const char **attributes)
{
  struct document *document = context;
  if (!strcmp(name, "table:table")) {
    const char *label = attribute(attributes, "table:name");
    document->taken = eo_sheet_text_next(&document->out, label ? label : "");
  } else if (!strcmp(name, "table:table-row")) {
    const char *repeat = attribute(attributes, "table:number-rows-repeated");
    document->column = 0;
    document->rows = repeat ? strtol(repeat, NULL, 10) : 1;
  } else if (document->taken && (!strcmp(name, "table:table-cell") || !strcmp(name, "table:covered-table-cell"))) {
    begin_cell(document, attributes);
  } else if (!strcmp(name, "office:annotation")) {
    document->in_annotation = true;
  } else if (!strcmp(name, "text:p")) {
    document->in_paragraph = !document->filled && !document->in_annotation;
    take_gap(document);
  } else if (!strcmp(name, "text:line-break") || !strcmp(name, "text:tab") || !strcmp(name, "text:s")) {
    take_gap(document);
  }
}

static void end_cell(struct document *document)
{
  bool text = !*document->type || !strcmp(document->type, "string");
  document->in_cell = false;
  if (document->formula && strcmp(document->type, "string") != 0)
    eo_sheet_text_formula(&document->out, document->value);
  for (int i = 0; i < document->repeat && i < EO_SHEET_COLUMNS && document->length; i++)
    (text ? eo_sheet_text_cell : eo_sheet_text_number)(&document->out, document->column + i, document->value);
  document->column = document->column + document->repeat < 1 << 20 ? document->column + document->repeat : 1 << 20;
}

static void XMLCALL end(void *context, const char *name)
{
  struct document *document = context;
  if (!document->taken)
    return;
  if (!strcmp(name, "table:table-cell") || !strcmp(name, "table:covered-table-cell"))
    end_cell(document);
  else if (!strcmp(name, "table:table-row"))
    eo_sheet_text_row(&document->out, document->rows);
  else if (!strcmp(name, "office:annotation"))
    document->in_annotation = false;
  else if (!strcmp(name, "text:p"))
    document->in_paragraph = false;
}

static bool parse(void *context, struct eo_archive *archive, const char *name)
{
  struct document *document = context;
  if (!archive->flat && strcmp(name, "content.xml"))
    return true;
  XML_Parser parser = XML_ParserCreate(NULL);
  char *bytes = malloc(EO_ARCHIVE_PIECE);
  int64_t got = 1;
  document->failed = !parser || !bytes;
  document->taken = false;
  if (parser) {
    XML_SetUserData(parser, document);
    XML_SetElementHandler(parser, begin, end);
    XML_SetCharacterDataHandler(parser, take_characters);
  }
  while (!document->failed && got > 0 && (got = eo_archive_read(archive, bytes, EO_ARCHIVE_PIECE)) >= 0)
    if (XML_Parse(parser, bytes, (int)got, got == 0) != XML_STATUS_OK) {
      eo_error_set(archive->error, EO_ERROR_INPUT, "", "The spreadsheet is damaged: %s in line %lu of its content.",
                   XML_ErrorString(XML_GetErrorCode(parser)), (unsigned long)XML_GetCurrentLineNumber(parser));
      got = -1;
    }
  if (document->failed)
    eo_error_memory(archive->error);
  if (parser)
    XML_ParserFree(parser);
  free(bytes);
  return false;
}

enum eo_code eo_opendocument_write(struct eo_archive *archive, FILE *file, char *name, size_t size)
{
  struct document *document = calloc(1, sizeof *document);
  if (!document)
    return eo_error_memory(archive->error);
  document->archive = archive;
  document->out.file = file;
  enum eo_code code = eo_sheet_text_write(&document->out, archive, parse, document);
  snprintf(name, size, "%s", eo_sheet_text_name(&document->out));
  free(document);
  return code;
}
