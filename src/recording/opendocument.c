/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest table of an OpenDocument spreadsheet, or all large ones, as text with tabs. Source: OASIS
   OpenDocument 1.2, part 1: table:table, table:table-row, table:table-cell with office:value-type. */
#include "recording/zip_files.h"
#include "recording/sheet_text.h"

#include <expat.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define VALUE \
  ((size_t)512 << 10) /* bytes of a cell's value at most: a grid of a flank as one list; longer texts are cut */

enum { TABLES = 64 /* that are told apart */ };

struct document {
  struct eo_archive *archive;
  struct eo_sheet_text out;
  int table, best;              /* number of the current table, of the one with most numbers */
  int64_t numbers, most;        /* of the current table, of the best one */
  int64_t of_table[TABLES + 1]; /* numbers in each */
  int tables;                   /* nearly as large as the best */
  char name[64], best_name[64];
  bool writing, failed, in_cell, in_paragraph, filled;
  int column, repeat;
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

/* Whether the current table is written: the best one, or one of several that are nearly as large. */
static bool is_written(const struct document *document)
{
  bool large = document->archive->tables && document->table <= TABLES &&
               document->of_table[document->table] > document->most / EO_ARCHIVE_SHARE;
  return document->writing && (document->table == document->best || large);
}

static void begin_cell(struct document *document, const char **attributes)
{
  const char *type = attribute(attributes, "office:value-type"), *value = attribute(attributes, "office:value"),
             *date = attribute(attributes, "office:date-value"), *time = attribute(attributes, "office:time-value"),
             *repeat = attribute(attributes, "table:number-columns-repeated");
  document->in_cell = true;
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
    document->table++;
    document->numbers = 0;
    snprintf(document->name, sizeof document->name, "%s", label ? label : "");
    if (document->tables > 1 && is_written(document)) {
      char title[80];
      snprintf(title, sizeof title, "Sheet: %s", document->name);
      eo_sheet_text_cell(&document->out, 0, title);
      eo_sheet_text_row(&document->out);
    }
  } else if (!strcmp(name, "table:table-row")) {
    document->column = 0;
  } else if (!strcmp(name, "table:table-cell") || !strcmp(name, "table:covered-table-cell")) {
    begin_cell(document, attributes);
  } else if (!strcmp(name, "text:p")) {
    document->in_paragraph = !document->filled;
  }
}

static void end_cell(struct document *document)
{
  bool number = !strcmp(document->type, "float") || !strcmp(document->type, "percentage");
  document->in_cell = false;
  document->numbers += number;
  for (int i = 0; i < document->repeat && i < EO_SHEET_COLUMNS && document->length; i++)
    if (is_written(document))
      eo_sheet_text_cell(&document->out, document->column + i, document->value);
  document->column = document->column + document->repeat < 1 << 20 ? document->column + document->repeat : 1 << 20;
}

static void end_table(struct document *document)
{
  if (document->table <= TABLES)
    document->of_table[document->table] = document->numbers;
  if (document->numbers <= document->most)
    return;
  document->most = document->numbers;
  document->best = document->table;
  memcpy(document->best_name, document->name, sizeof document->name);
}

static void XMLCALL end(void *context, const char *name)
{
  struct document *document = context;
  if (!strcmp(name, "table:table-cell") || !strcmp(name, "table:covered-table-cell"))
    end_cell(document);
  else if (!strcmp(name, "table:table-row") && is_written(document))
    eo_sheet_text_row(&document->out);
  else if (!strcmp(name, "text:p"))
    document->in_paragraph = false;
  else if (!strcmp(name, "table:table") && !document->writing)
    end_table(document);
}

static bool parse(void *context, struct eo_archive *archive, const char *name)
{
  struct document *document = context;
  if (strcmp(name, "content.xml"))
    return true;
  XML_Parser parser = XML_ParserCreate(NULL);
  char *bytes = malloc(EO_ARCHIVE_PIECE);
  int64_t got = 1;
  document->failed = !parser || !bytes;
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
  enum eo_code code = eo_archive_visit(archive, parse, document);
  if (!code && !document->most)
    code = eo_error_set(archive->error, EO_ERROR_INPUT, "", "No table of the spreadsheet holds numbers.");
  if (!code) {
    for (int i = 1; i <= TABLES && archive->tables; i++)
      document->tables += document->of_table[i] > document->most / EO_ARCHIVE_SHARE;
    document->writing = true;
    document->table = 0;
    code = eo_archive_visit(archive, parse, document);
  }
  snprintf(name, size, "%s", document->best_name);
  free(document);
  return code;
}
