/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/table_export.h"

#include <archive.h>
#include <archive_entry.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exchange/design_keys.h"
#include "format/digits.h"
#include "format/json.h"

/* A value of the document: where it stands and what it is. */
struct leaf {
  char path[EO_KEY_PATH], name[EO_KEY_PATH];
  int member; /* -1: of both */
  const json_t *value;
};

struct leaves {
  struct leaf *leaf; /* owned */
  int count, room;
  bool failed;
};

static void add_leaf(struct leaves *leaves, const char *path, const json_t *value)
{
  if (leaves->count == leaves->room) {
    int room = leaves->room ? 2 * leaves->room : 256;
    struct leaf *grown = realloc(leaves->leaf, (size_t)room * sizeof *grown);
    leaves->failed = leaves->failed || !grown;
    if (!grown)
      return;
    leaves->leaf = grown;
    leaves->room = room;
  }
  struct leaf *leaf = &leaves->leaf[leaves->count++];
  snprintf(leaf->path, sizeof leaf->path, "%s", path);
  eo_design_key_name(path, leaf->name, &leaf->member);
  leaf->value = value;
}

/* Lists of objects go row by row, lists of numbers stay one cell. */
static void collect(struct leaves *leaves, const char *path, const json_t *value)
{
  char deeper[EO_KEY_PATH];
  struct eo_design_key found;
  const char *key;
  json_t *part;
  size_t i;
  if (json_is_object(value)) {
    json_object_foreach((json_t *)value, key, part)
    {
      snprintf(deeper, sizeof deeper, "%s%s%s", path, *path ? "." : "", key);
      collect(leaves, deeper, part);
    }
  } else if (json_is_object(json_array_get(value, 0))) {
    json_array_foreach(value, i, part)
    {
      snprintf(deeper, sizeof deeper, "%s.%zu", path, i + 1);
      collect(leaves, deeper, part);
    }
  } else if (!json_is_null(value) || eo_design_key_find(&found, path, 0, 2)) /* null of an object: it is not there */
    add_leaf(leaves, path, value);
}

static void put_quoted(struct eo_text *text, const char *string)
{
  if (!strpbrk(string, ";\"\n\r,") && *string != ' ') {
    eo_text_add(text, string);
    return;
  }
  eo_text_add(text, "\"");
  for (const char *c = string; *c; c++)
    eo_text_add_bytes(text, *c == '"' ? "\"\"" : *c == '\n' || *c == '\r' ? " " : c, *c == '"' ? 2 : 1);
  eo_text_add(text, "\"");
}

/* What a cell says; owned by the caller, NULL without memory. */
static char *cell_text(const json_t *value, bool comma)
{
  char number[40];
  if (json_is_string(value))
    return strdup(json_string_value(value));
  if (json_is_array(value))
    return json_dumps(value, JSON_COMPACT);
  if (json_is_boolean(value))
    return strdup(json_is_true(value) ? "true" : "false");
  if (json_is_integer(value))
    snprintf(number, sizeof number, "%lld", (long long)json_integer_value(value));
  else if (json_is_number(value)) {
    eo_digits_write(number, sizeof number, json_number_value(value));
    for (char *c = number; *c && comma; c++)
      *c = *c == '.' ? ',' : *c;
  } else
    return strdup("null");
  return strdup(number);
}

/* The unit is the end of the key. */
static const char *unit_of(const struct leaf *leaf)
{
  struct eo_design_key key;
  return eo_design_key_find(&key, leaf->path, 0, 2) ? eo_design_key_unit(key.field) : "";
}

/* Rows of a block: */

enum { KEY, PINION, GEAR, UNIT, COLUMNS };

typedef void row_writer(void *context, const char *const cell[COLUMNS], bool number);

/* The twin of a member's value, if it comes later; its row is written with the first. */
static const struct leaf *twin_of(const struct leaves *leaves, int from, bool *done)
{
  const struct leaf *leaf = &leaves->leaf[from];
  for (int i = 0; i < leaves->count && leaf->member >= 0; i++)
    if (i != from && leaves->leaf[i].member == !leaf->member && strcmp(leaves->leaf[i].name, leaf->name) == 0) {
      done[i] = true;
      return &leaves->leaf[i];
    }
  return NULL;
}

static void each_row(const json_t *document, bool comma, row_writer *write, void *context, bool *failed)
{
  static const char *const header[COLUMNS] = {"key", "pinion", "gear", "unit"};
  struct leaves leaves = {0};
  collect(&leaves, "", document);
  bool *done = calloc((size_t)leaves.count + 1, sizeof *done);
  *failed = *failed || leaves.failed || !done;
  write(context, header, false);
  for (int i = 0; i < leaves.count && done; i++) {
    const struct leaf *leaf = &leaves.leaf[i], *twin = done[i] ? NULL : twin_of(&leaves, i, done);
    if (done[i])
      continue;
    bool second = leaf->member == 1;
    char *value[2] = {NULL, NULL};
    value[second] = cell_text(leaf->value, comma);
    value[!second] = twin ? cell_text(twin->value, comma) : strdup("");
    const char *const cell[COLUMNS] = {leaf->name, value[0], value[1], unit_of(leaf)};
    *failed = *failed || !value[0] || !value[1];
    if (value[0] && value[1])
      write(context, cell, json_is_number(leaf->value));
    free(value[0]);
    free(value[1]);
  }
  free(done);
  free(leaves.leaf);
}

static void write_line(void *context, const char *const cell[COLUMNS], bool number)
{
  struct eo_text *text = context;
  (void)number;
  for (int i = 0; i < COLUMNS; i++) {
    eo_text_add(text, i ? ";" : "");
    put_quoted(text, cell[i]);
  }
  eo_text_add(text, "\r\n");
}

/* One row per design; the columns are the keys of all of them. */
static void write_rows(const json_t *const *documents, int count, struct eo_text *text)
{
  struct leaves columns = {0}, leaves;
  for (int i = 0; i < count; i++) {
    leaves = (struct leaves){0};
    collect(&leaves, "", documents[i]);
    for (int k = 0; k < leaves.count; k++) {
      bool known = false;
      for (int c = 0; c < columns.count && !known; c++)
        known = strcmp(columns.leaf[c].path, leaves.leaf[k].path) == 0;
      if (!known)
        add_leaf(&columns, leaves.leaf[k].path, NULL);
    }
    text->failed = text->failed || leaves.failed || columns.failed;
    free(leaves.leaf);
  }
  for (int c = 0; c < columns.count; c++) {
    eo_text_add(text, c ? ";" : "");
    put_quoted(text, columns.leaf[c].path);
  }
  eo_text_add(text, "\r\n");
  for (int i = 0; i < count; i++) {
    leaves = (struct leaves){0};
    collect(&leaves, "", documents[i]);
    for (int c = 0; c < columns.count; c++) {
      eo_text_add(text, c ? ";" : "");
      for (int k = 0; k < leaves.count; k++)
        if (strcmp(leaves.leaf[k].path, columns.leaf[c].path) == 0) {
          char *value = cell_text(leaves.leaf[k].value, false);
          text->failed = text->failed || !value;
          put_quoted(text, value ? value : "");
          free(value);
        }
    }
    eo_text_add(text, "\r\n");
    free(leaves.leaf);
  }
  free(columns.leaf);
}

/* Workbooks (ECMA-376): */

static void write_sheet_row(void *context, const char *const cell[COLUMNS], bool number)
{
  struct eo_text *text = context;
  eo_text_add(text, "<row>");
  for (int i = 0; i < COLUMNS; i++) {
    char *end;
    bool is_number = number && (i == PINION || i == GEAR) && *cell[i] && (strtod(cell[i], &end), !*end);
    eo_text_add(text, is_number ? "<c><v>" : "<c t=\"inlineStr\"><is><t>");
    eo_text_add_escaped(text, cell[i]);
    eo_text_add(text, is_number ? "</v></c>" : "</t></is></c>");
  }
  eo_text_add(text, "</row>");
}

static bool add_file(struct archive *archive, const char *name, const char *bytes, size_t size)
{
  struct archive_entry *entry = archive_entry_new();
  if (!entry)
    return false;
  archive_entry_set_pathname(entry, name);
  archive_entry_set_size(entry, (la_int64_t)size);
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_entry_set_perm(entry, 0644);
  bool good = archive_write_header(archive, entry) == ARCHIVE_OK &&
              archive_write_data(archive, bytes, size) == (la_ssize_t)size;
  archive_entry_free(entry);
  return good;
}

static bool add_parts(struct archive *archive, const struct eo_text *sheet)
{
#define XML "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n"
#define OFFICE "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
#define PACKAGE "http://schemas.openxmlformats.org/package/2006"
#define MAIN "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
#define TYPE "application/vnd.openxmlformats-officedocument.spreadsheetml."
  static const struct {
    const char *name, *text;
  } parts[] = {
      {"[Content_Types].xml",
       XML "<Types xmlns=\"" PACKAGE "/content-types\"><Default Extension=\"rels\" ContentType=\""
           "application/vnd.openxmlformats-package.relationships+xml\"/><Default "
           "Extension=\"xml\" ContentType=\"application/xml\"/><Override "
           "PartName=\"/xl/workbook.xml\" ContentType=\"" TYPE "sheet.main+xml\"/><Override "
           "PartName=\"/xl/worksheets/sheet1.xml\" ContentType=\"" TYPE "worksheet+xml\"/></Types>"},
      {"_rels/.rels", XML "<Relationships xmlns=\"" PACKAGE "/relationships\"><Relationship Id=\"rId1\" Type=\"" OFFICE
                          "/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>"},
      {"xl/workbook.xml", XML "<workbook xmlns=\"" MAIN "\" xmlns:r=\"" OFFICE
                              "\"><sheets><sheet name=\"designs\" sheetId=\"1\" r:id=\"rId1\"/></sheets></workbook>"},
      {"xl/_rels/workbook.xml.rels",
       XML "<Relationships xmlns=\"" PACKAGE "/relationships\"><Relationship Id=\"rId1\" "
           "Type=\"" OFFICE "/worksheet\" Target=\"worksheets/sheet1.xml\"/></Relationships>"},
  };
  struct eo_text text = {0};
  bool good = true;
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
    good = good && add_file(archive, parts[i].name, parts[i].text, strlen(parts[i].text));
  eo_text_add(&text, XML "<worksheet xmlns=\"" MAIN "\"><sheetData>");
  eo_text_add_bytes(&text, sheet->data ? sheet->data : "", sheet->size);
  eo_text_add(&text, "</sheetData></worksheet>");
  good = good && !text.failed && add_file(archive, "xl/worksheets/sheet1.xml", text.data, text.size);
  eo_text_done(&text);
  return good;
}

static void write_workbook(const struct eo_text *sheet, struct eo_text *text)
{
  size_t room = sheet->size + 65536, used = 0;
  char *bytes = malloc(room);
  struct archive *archive = archive_write_new();
  bool good = bytes && archive && !sheet->failed && archive_write_set_format_zip(archive) == ARCHIVE_OK &&
              archive_write_set_bytes_in_last_block(archive, 1) == ARCHIVE_OK &&
              archive_write_open_memory(archive, bytes, room, &used) == ARCHIVE_OK && add_parts(archive, sheet);
  good = archive && archive_write_free(archive) == ARCHIVE_OK && good;
  if (good)
    eo_text_add_bytes(text, bytes, used);
  text->failed = text->failed || !good;
  free(bytes);
}

void eo_table_write(const json_t *const *documents, int count, enum eo_table_layout layout, struct eo_text *text)
{
  static const char mark[] = "\xEF\xBB\xBF";
  struct eo_text sheet = {0};
  bool failed = false, workbook = layout == EO_TABLE_WORKBOOK;
  if (!workbook)
    eo_text_add(text, mark);
  if (layout == EO_TABLE_ROWS)
    write_rows(documents, count, text);
  else
    for (int i = 0; i < count; i++)
      each_row(documents[i], layout == EO_TABLE_COMMA, workbook ? write_sheet_row : write_line,
               workbook ? &sheet : text, &failed);
  if (workbook)
    write_workbook(&sheet, text);
  text->failed = text->failed || failed;
  eo_text_done(&sheet);
}
