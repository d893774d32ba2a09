/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sheets of an Excel workbook, cell by cell (sheet_text.h settles which are written). Source: ECMA-376,
   SpreadsheetML: sheets in xl/worksheets/sheetN.xml, texts in xl/sharedStrings.xml, formats of cells in xl/styles.xml.
 */
#include "recording/zip_files.h"
#include "recording/sheet_text.h"

#include <ctype.h>
#include <expat.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FORMATS 4096             /* of cells that are remembered */
#define TEXTS ((size_t)64 << 20) /* bytes of shared texts at most */
#define VALUE \
  ((size_t)512 << 10) /* bytes of a cell's value at most: a grid of a flank as one list; longer texts are cut */

/* A sheet is called by its name in the book, which refers to its file by an identity. */
struct sheet {
  char name[EO_SHEET_NAME], id[64];
};

struct workbook {
  struct eo_archive *archive;
  struct eo_sheet_text out;
  /* shared texts, each ended by 0 */
  char *text;
  size_t text_used, text_room, *text_at;
  int texts, texts_room;
  /* formats: whether a number is a date */
  bool date[FORMATS], custom[FORMATS];
  int formats;
  bool in_formats;
  bool since_1904, failed, typed;                  /* typed: a part has a document type */
  struct sheet named[EO_SHEETS], filed[EO_SHEETS]; /* names of sheets; their files */
  int names, files;
  /* the cell or text that is being read */
  bool in_value, in_text, formula;
  char type[16], value[VALUE];
  size_t length;
  int column, style;
};

/* Names of XML come with or without the prefix of their name space. */
static const char *local(const char *name)
{
  const char *colon = strrchr(name, ':');
  return colon ? colon + 1 : name;
}

static const char *attribute(const char **attributes, const char *name)
{
  for (; *attributes; attributes += 2)
    if (!strcmp(local(attributes[0]), name))
      return attributes[1];
  return NULL;
}

static void XMLCALL take_characters(void *context, const char *text, int length)
{
  struct workbook *workbook = context;
  if (!workbook->in_value && !workbook->in_text)
    return;
  size_t n = (size_t)length < VALUE - 1 - workbook->length ? (size_t)length : VALUE - 1 - workbook->length;
  memcpy(workbook->value + workbook->length, text, n);
  workbook->length += n;
  workbook->value[workbook->length] = '\0';
}

static void keep_text(struct workbook *workbook)
{
  size_t size = workbook->length + 1;
  if (workbook->texts == workbook->texts_room) {
    int room = workbook->texts_room ? 2 * workbook->texts_room : 256;
    size_t *at = realloc(workbook->text_at, (size_t)room * sizeof *at);
    workbook->failed = workbook->failed || !at;
    if (!at)
      return;
    workbook->text_at = at;
    workbook->texts_room = room;
  }
  if (workbook->text_used + size > workbook->text_room) {
    size_t room = 2 * workbook->text_room + size + 4096;
    char *text = room <= TEXTS ? realloc(workbook->text, room) : NULL;
    workbook->failed = workbook->failed || !text;
    if (!text)
      return;
    workbook->text = text;
    workbook->text_room = room;
  }
  workbook->text_at[workbook->texts++] = workbook->text_used;
  memcpy(workbook->text + workbook->text_used, workbook->value, size);
  workbook->text_used += size;
}

static void XMLCALL begin_text(void *context, const char *name, const char **attributes)
{
  struct workbook *workbook = context;
  (void)attributes;
  if (!strcmp(local(name), "si"))
    workbook->length = 0, workbook->value[0] = '\0';
  workbook->in_text = !strcmp(local(name), "t");
}

static void XMLCALL end_text(void *context, const char *name)
{
  struct workbook *workbook = context;
  workbook->in_text = false;
  if (!strcmp(local(name), "si"))
    keep_text(workbook);
}

/* A format with letters of dates and times outside quotes and brackets shows numbers as dates. */
static bool shows_date(const char *code)
{
  bool quoted = false, bracket = false, date = false;
  for (; *code; code++) {
    quoted = *code == '"' ? !quoted : quoted;
    bracket = *code == '[' || (bracket && *code != ']');
    date = date || (!quoted && strchr("ymdhsYMDHS", *code) && (!bracket || strchr("hmsHMS", *code)));
    if (*code == '\\' && code[1])
      code++;
  }
  return date;
}

static void XMLCALL begin_style(void *context, const char *name, const char **attributes)
{
  struct workbook *workbook = context;
  const char *id = attribute(attributes, "numFmtId"), *code = attribute(attributes, "formatCode");
  long number = id ? strtol(id, NULL, 10) : 0;
  if (!strcmp(local(name), "cellXfs"))
    workbook->in_formats = true;
  else if (!strcmp(local(name), "numFmt") && code && number >= 0 && number < FORMATS)
    workbook->custom[number] = shows_date(code);
  else if (!strcmp(local(name), "xf") && workbook->in_formats && workbook->formats < FORMATS)
    workbook->date[workbook->formats++] = (number >= 14 && number <= 22) || (number >= 45 && number <= 47) ||
                                          (number >= 0 && number < FORMATS && workbook->custom[number]);
}

static void XMLCALL end_style(void *context, const char *name)
{
  struct workbook *workbook = context;
  if (!strcmp(local(name), "cellXfs"))
    workbook->in_formats = false;
}

static void keep_sheet(struct sheet *sheet, const char *name, const char *id)
{
  snprintf(sheet->name, sizeof sheet->name, "%s", name ? name : "");
  snprintf(sheet->id, sizeof sheet->id, "%s", id ? id : "");
}

static bool is_true(const char *value)
{
  return !strcmp(value, "1") || !strcmp(value, "true");
}

static void XMLCALL begin_book(void *context, const char *name, const char **attributes)
{
  struct workbook *workbook = context;
  const char *since = attribute(attributes, "date1904"), *full = attribute(attributes, "fullCalcOnLoad");
  if (!strcmp(local(name), "workbookPr") && since)
    workbook->since_1904 = is_true(since);
  if (!strcmp(local(name), "calcPr") && full)
    workbook->out.recalculated = is_true(full);
  if (!strcmp(local(name), "sheet") && workbook->names < EO_SHEETS)
    keep_sheet(&workbook->named[workbook->names++], attribute(attributes, "name"), attribute(attributes, "id"));
}

static void XMLCALL begin_relation(void *context, const char *name, const char **attributes)
{
  struct workbook *workbook = context;
  const char *target = attribute(attributes, "Target");
  if (!strcmp(local(name), "Relationship") && target && strstr(target, "worksheets/") && workbook->files < EO_SHEETS)
    keep_sheet(&workbook->filed[workbook->files++], strrchr(target, '/') + 1, attribute(attributes, "Id"));
}

/* What the book calls the sheet in this file; the file where it says nothing. */
static const char *name_of(const struct workbook *workbook, const char *file)
{
  const char *base = strrchr(file, '/') + 1;
  for (int f = 0; f < workbook->files; f++)
    for (int n = 0; n < workbook->names && !strcmp(workbook->filed[f].name, base); n++)
      if (!strcmp(workbook->named[n].id, workbook->filed[f].id))
        return workbook->named[n].name;
  return base;
}

static void XMLCALL end_nothing(void *context, const char *name)
{
  (void)context;
  (void)name;
}

/* "AB12" is column 27, from 0. */
static int column_of(const char *reference)
{
  int column = 0;
  for (; isalpha((unsigned char)*reference); reference++)
    column = column < 100000 ? column * 26 + (toupper((unsigned char)*reference) - 'A' + 1) : column;
  return column - 1;
}

static void XMLCALL begin_cell(void *context, const char *name, const char **attributes)
{
  struct workbook *workbook = context;
  const char *element = local(name);
  if (!strcmp(element, "c")) {
    const char *reference = attribute(attributes, "r"), *type = attribute(attributes, "t"),
               *style = attribute(attributes, "s");
    workbook->column = reference ? column_of(reference) : workbook->column + 1;
    workbook->style = style ? (int)strtol(style, NULL, 10) : 0;
    snprintf(workbook->type, sizeof workbook->type, "%s", type ? type : "n");
    workbook->length = 0;
    workbook->value[0] = '\0';
    workbook->formula = false;
  } else if (!strcmp(element, "row")) {
    workbook->column = -1;
  }
  workbook->formula = workbook->formula || !strcmp(element, "f");
  workbook->in_value = !strcmp(element, "v");
  workbook->in_text = !strcmp(element, "t");
}

/* Days since the end of 1899 as a date, a fraction of a day as a time. */
static void write_date(struct workbook *workbook, double days)
{
  if (days >= 1)
    eo_sheet_text_moment(&workbook->out, workbook->column, days - 25569 + (workbook->since_1904 ? 1462 : 0));
  else
    eo_sheet_text_time(&workbook->out, workbook->column, days);
}

static void take_cell(struct workbook *workbook)
{
  bool number = !strcmp(workbook->type, "n") || !strcmp(workbook->type, "b"), shared = !strcmp(workbook->type, "s");
  long index = shared ? strtol(workbook->value, NULL, 10) : 0;
  if (workbook->formula && number)
    eo_sheet_text_formula(&workbook->out, workbook->value);
  if (!workbook->length || !strcmp(workbook->type, "e"))
    return;
  if (number && workbook->style >= 0 && workbook->style < workbook->formats && workbook->date[workbook->style])
    write_date(workbook, strtod(workbook->value, NULL));
  else if (number)
    eo_sheet_text_number(&workbook->out, workbook->column, workbook->value);
  else if (shared && index >= 0 && index < workbook->texts)
    eo_sheet_text_cell(&workbook->out, workbook->column, workbook->text + workbook->text_at[index]);
  else if (!shared)
    eo_sheet_text_cell(&workbook->out, workbook->column, workbook->value);
}

static void XMLCALL end_cell(void *context, const char *name)
{
  struct workbook *workbook = context;
  const char *element = local(name);
  workbook->in_value = workbook->in_text = false;
  if (!strcmp(element, "c"))
    take_cell(workbook);
  else if (!strcmp(element, "row"))
    eo_sheet_text_row(&workbook->out, 1);
}

static void take_doctype(void *context, const char *name, const char *system, const char *public, int subset)
{
  struct workbook *workbook = context;
  (void)name;
  (void)system;
  (void)public;
  (void)subset;
  workbook->typed = true;
}

static bool parse(struct workbook *workbook, XML_StartElementHandler begin, XML_EndElementHandler end)
{
  XML_Parser parser = XML_ParserCreate(NULL);
  char *bytes = malloc(EO_ARCHIVE_PIECE);
  int64_t got = 1;
  workbook->failed = workbook->failed || !parser || !bytes;
  if (parser) {
    XML_SetUserData(parser, workbook);
    XML_SetElementHandler(parser, begin, end);
    XML_SetCharacterDataHandler(parser, take_characters);
    XML_SetStartDoctypeDeclHandler(parser, take_doctype);
  }
  while (!workbook->failed && got > 0 && (got = eo_archive_read(workbook->archive, bytes, EO_ARCHIVE_PIECE)) >= 0)
    if (XML_Parse(parser, bytes, (int)got, got == 0) != XML_STATUS_OK || workbook->typed) {
      if (workbook->typed)
        eo_error_set(workbook->archive->error, EO_ERROR_INPUT, "",
                     "A part of the workbook has a document type (<!DOCTYPE ...>), which can hold entities; a workbook "
                     "has none, so it is refused: save it again in a spreadsheet program.");
      else
        eo_error_set(workbook->archive->error, EO_ERROR_INPUT, "",
                     "The workbook is damaged: %s in line %lu of one of its parts.",
                     XML_ErrorString(XML_GetErrorCode(parser)), (unsigned long)XML_GetCurrentLineNumber(parser));
      got = -1;
    }
  if (workbook->failed)
    eo_error_memory(workbook->archive->error);
  if (parser)
    XML_ParserFree(parser);
  free(bytes);
  return !workbook->failed && got == 0;
}

static bool is_sheet(const char *name)
{
  return !strncmp(name, "xl/worksheets/", 14) && strchr(name + 14, '/') == NULL && strstr(name, ".xml");
}

/* What holds for all sheets, wherever it stands in the archive. */
static bool read_book(void *context, struct eo_archive *archive, const char *name)
{
  struct workbook *workbook = context;
  (void)archive;
  if (!strcmp(name, "xl/sharedStrings.xml"))
    return parse(workbook, begin_text, end_text);
  if (!strcmp(name, "xl/styles.xml"))
    return parse(workbook, begin_style, end_style);
  if (!strcmp(name, "xl/workbook.xml"))
    return parse(workbook, begin_book, end_nothing);
  if (!strcmp(name, "xl/_rels/workbook.xml.rels"))
    return parse(workbook, begin_relation, end_nothing);
  return true;
}

static bool read_sheet(void *context, struct eo_archive *archive, const char *name)
{
  struct workbook *workbook = context;
  (void)archive;
  if (!is_sheet(name) || !eo_sheet_text_next(&workbook->out, name_of(workbook, name)))
    return true;
  return parse(workbook, begin_cell, end_cell);
}

static enum eo_code read_all(struct workbook *workbook)
{
  struct eo_archive *archive = workbook->archive;
  EO_TRY(eo_archive_visit(archive, read_book, workbook));
  return eo_sheet_text_write(&workbook->out, archive, read_sheet, workbook);
}

enum eo_code eo_workbook_write(struct eo_archive *archive, FILE *file, char *name, size_t size)
{
  struct workbook *workbook = calloc(1, sizeof *workbook);
  if (!workbook)
    return eo_error_memory(archive->error);
  workbook->archive = archive;
  workbook->out.file = file;
  enum eo_code code = read_all(workbook);
  snprintf(name, size, "%s", eo_sheet_text_name(&workbook->out));
  free(workbook->text);
  free(workbook->text_at);
  free(workbook);
  return code;
}
