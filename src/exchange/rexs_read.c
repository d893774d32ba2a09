/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/rexs_read.h"

#include <archive.h>
#include <archive_entry.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "format/text.h"

enum {
  PIECE = 1 << 16,
  ENTRIES = 10000,      /* of an archive */
  EXPANSION = 200,      /* bytes out of one byte of the archive, */
  FREE_BYTES = 1 << 20, /* beyond the first of these */
};

bool eo_rexs_refuse(struct eo_rexs_problem *problem, const char *kind, int line, int column, const char *format, ...)
{
  char text[360], place[60] = "";
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (line > 0)
    snprintf(place, sizeof place, "line %d, column %d", line, column);
  problem->kind = kind;
  problem->line = line;
  problem->column = column;
  eo_error_set(&problem->error, EO_ERROR_INPUT, place, "%s", text);
  return false;
}

bool eo_rexs_refuse_many(struct eo_rexs_problem *problem, int line, int column, int limit)
{
  static const struct {
    int limit;
    const char *what;
  } many[] = {{EO_REXS_ATTRIBUTES, "attributes; leave out results that a design does not need"},
              {EO_REXS_COMPONENTS, "components"},
              {EO_REXS_RELATIONS, "relations"},
              {EO_REXS_LOAD_CASES, "load cases"},
              {EO_REXS_CELLS, "values in arrays"},
              {EO_REXS_REFERENCES, "references in a relation"}};
  size_t i = 0;
  while (i + 1 < sizeof many / sizeof *many && many[i].limit != limit)
    i++;
  return eo_rexs_refuse(problem, "too_large", line, column, "The file has more than %d %s.", limit, many[i].what);
}

static int base64_digit(char c)
{
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const char *at = c ? strchr(digits, c) : NULL;
  return at ? (int)(at - digits) : -1;
}

/* Bytes of the text; -1: it is no Base64. */
static long decode_base64(const char *text, unsigned char *bytes)
{
  uint32_t bits = 0;
  int held = 0;
  long count = 0;
  for (; *text && *text != '='; text++) {
    if (strchr(" \t\r\n", *text))
      continue;
    int digit = base64_digit(*text);
    if (digit < 0)
      return -1;
    bits = bits << 6 | (uint32_t)digit;
    held += 6;
    if (held >= 8) {
      held -= 8;
      bytes[count++] = (unsigned char)(bits >> held);
    }
  }
  return strspn(text, "= \t\r\n") == strlen(text) ? count : -1;
}

static double number_at(const unsigned char *bytes, size_t size, bool whole)
{
  uint64_t bits = 0;
  for (size_t i = size; i-- > 0;)
    bits = bits << 8 | bytes[i];
  if (whole)
    return (double)(int32_t)(uint32_t)bits;
  if (size == 4) {
    uint32_t half = (uint32_t)bits;
    float value;
    memcpy(&value, &half, sizeof value);
    return (double)value;
  }
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

int eo_rexs_decode_numbers(struct eo_rexs_model *model, const char *text, const char *code, double **value)
{
  bool whole = strcmp(code, "int32") == 0;
  size_t size = whole || strcmp(code, "float32") == 0 ? 4 : strcmp(code, "float64") == 0 ? 8 : 0;
  unsigned char *bytes = size ? malloc(strlen(text) + 1) : NULL;
  model->failed = model->failed || (size && !bytes);
  if (!bytes)
    return -1;
  long count = decode_base64(text, bytes);
  int numbers = count >= 0 && (size_t)count % size == 0 && (size_t)count / size <= EO_REXS_CELLS
                    ? (int)((size_t)count / size)
                    : -1;
  *value = numbers > 0 ? eo_rexs_memory(model, (size_t)numbers * sizeof **value) : NULL;
  for (int i = 0; i < numbers && *value; i++)
    (*value)[i] = number_at(bytes + (size_t)i * size, size, whole);
  free(bytes);
  return numbers > 0 && !*value ? -1 : numbers;
}

static bool read_bytes(struct eo_rexs_model *model, const char *bytes, size_t size, struct eo_rexs_problem *problem)
{
  static const char mark[] = "\xEF\xBB\xBF";
  size_t skip = size >= 3 && memcmp(bytes, mark, 3) == 0 ? 3 : 0;
  if (size > EO_REXS_BYTES)
    return eo_rexs_refuse(problem, "too_large", 0, 0, "The file has more than %zu MB; that is no model.",
                          EO_REXS_BYTES >> 20);
  while (skip < size && strchr(" \t\r\n", bytes[skip]) && bytes[skip])
    skip++;
  if (skip < size && bytes[skip] == '{')
    return eo_rexs_read_json(model, bytes + skip, size - skip, problem);
  return eo_rexs_read_xml(model, bytes, size, problem);
}

/* Archives: */

static bool ends_like_rexs(const char *name)
{
  static const char *const endings[] = {".rexs", ".rexsj"};
  const char *dot = strrchr(name, '.');
  for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
    if (strcasecmp(dot, endings[i]) == 0)
      return true;
  return false;
}

static bool damaged(struct archive *archive, struct eo_rexs_problem *problem)
{
  const char *why = archive_error_string(archive);
  return eo_rexs_refuse(problem, "damaged_archive", 0, 0, "The zip archive cannot be read: %.120s.",
                        why ? why : "it is damaged");
}

static bool unpack(struct archive *archive, size_t packed, struct eo_text *text, struct eo_rexs_problem *problem)
{
  la_ssize_t got;
  char *room;
  while ((room = eo_text_room(text, PIECE)) && (got = archive_read_data(archive, room, PIECE)) > 0) {
    text->size += (size_t)got;
    if (text->size > EO_REXS_BYTES || (text->size > FREE_BYTES && text->size / EXPANSION > packed))
      return eo_rexs_refuse(problem, "too_large", 0, 0,
                            "The archive grows to more than %zu MB out of %zu KB; that is no model.", text->size >> 20,
                            packed >> 10);
  }
  if (!room) {
    eo_error_memory(&problem->error);
    return false;
  }
  return got < 0 ? damaged(archive, problem) : true;
}

static bool find_model(struct archive *archive, size_t packed, struct eo_text *text, struct eo_rexs_problem *problem)
{
  struct archive_entry *entry;
  for (int i = 0; i < ENTRIES; i++) {
    int state = archive_read_next_header(archive, &entry);
    if (state == ARCHIVE_EOF)
      break;
    if (state != ARCHIVE_OK && state != ARCHIVE_WARN)
      return damaged(archive, problem);
    const char *name = archive_entry_pathname(entry);
    if (name && archive_entry_filetype(entry) == AE_IFREG && ends_like_rexs(name))
      return unpack(archive, packed, text, problem);
  }
  return eo_rexs_refuse(problem, "no_model_in_archive", 0, 0,
                        "The archive holds no model: no file in it ends with .rexs or .rexsj.");
}

static bool read_archive(struct eo_rexs_model *model, const char *bytes, size_t size, struct eo_rexs_problem *problem)
{
  struct archive *archive = archive_read_new();
  struct eo_text text = {0};
  if (!archive) {
    eo_error_memory(&problem->error);
    return false;
  }
  archive_read_support_format_zip_seekable(archive);
  bool good = archive_read_open_memory(archive, bytes, size) == ARCHIVE_OK ? find_model(archive, size, &text, problem)
                                                                           : damaged(archive, problem);
  archive_read_free(archive);
  good = good && read_bytes(model, text.size ? text.data : "", text.size, problem);
  eo_text_done(&text);
  return good;
}

bool eo_rexs_read(struct eo_rexs_model *model, const char *bytes, size_t size, struct eo_rexs_problem *problem)
{
  memset(problem, 0, sizeof *problem);
  bool archive = size > 4 && memcmp(bytes, "PK", 2) == 0;
  bool good = archive ? read_archive(model, bytes, size, problem) : read_bytes(model, bytes, size, problem);
  if (good)
    eo_rexs_index(model);
  if (good && model->failed) {
    eo_error_memory(&problem->error);
    good = false;
  }
  return good;
}
