/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines and headers of universal files. */
#include "recording/uff.h"
#include "base/decimal.h"
#include "recording/recorded_unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

static enum eo_code fill(struct eo_uff_lines *lines, struct eo_error *error)
{
  int64_t left = lines->size - lines->at;
  lines->used = 0;
  lines->filled = left < (int64_t)sizeof lines->buffer ? (size_t)left : sizeof lines->buffer;
  return eo_bytes_read(lines->file, lines->at, lines->buffer, lines->filled, error);
}

bool eo_uff_next(struct eo_uff_lines *lines, struct eo_error *error, enum eo_code *code)
{
  lines->length = 0;
  *code = EO_OK;
  if (lines->at >= lines->size)
    return false;
  lines->number++;
  while (lines->at < lines->size) {
    if (lines->used == lines->filled && (*code = fill(lines, error)))
      return false;
    const char *from = lines->buffer + lines->used, *end = memchr(from, '\n', lines->filled - lines->used);
    size_t n = (end ? (size_t)(end - from) : lines->filled - lines->used);
    if (n > EO_UFF_LINE - lines->length) {
      *code = eo_error_set(error, EO_ERROR_INPUT, "", "UFF: line %lld is longer than %d characters.",
                           (long long)lines->number, EO_UFF_LINE);
      return false;
    }
    memcpy(lines->line + lines->length, from, n);
    lines->length += n;
    n += end != NULL;
    lines->used += n;
    lines->at += (int64_t)n;
    if (end)
      break;
  }
  if (lines->length && lines->line[lines->length - 1] == '\r')
    lines->length--;
  lines->line[lines->length] = '\0';
  return true;
}

void eo_uff_seek(struct eo_uff_lines *lines, int64_t at)
{
  lines->at = at;
  lines->used = lines->filled = 0;
}

bool eo_uff_is_end(const struct eo_uff_lines *lines)
{
  const char *p = lines->line;
  while (*p == ' ')
    p++;
  if (p[0] != '-' || p[1] != '1')
    return false;
  for (p += 2; *p == ' '; p++)
    ;
  return !*p;
}

/* The columns first .. first + width - 1 of the line, without blanks around; shorter lines have empty fields. */
static void field(const struct eo_uff_lines *lines, size_t first, size_t width, char *text)
{
  size_t end = first + width < lines->length ? first + width : lines->length;
  while (first < end && lines->line[first] == ' ')
    first++;
  while (end > first && lines->line[end - 1] == ' ')
    end--;
  size_t n = end > first ? end - first : 0;
  memcpy(text, lines->line + first, n);
  text[n] = '\0';
}

static int64_t integer_field(const struct eo_uff_lines *lines, size_t first, size_t width)
{
  char text[32];
  field(lines, first, width, text);
  return strtoll(text, NULL, 10);
}

static double number_field(const struct eo_uff_lines *lines, size_t first, size_t width)
{
  char text[32];
  double value = 0;
  field(lines, first, width, text);
  return eo_decimal_read(text, '.', &value) ? value : 0;
}

static void text_field(const struct eo_uff_lines *lines, size_t first, size_t width, char *text)
{
  field(lines, first, width, text);
  if (!strcasecmp(text, "NONE"))
    *text = '\0';
}

/* "    58b     1     2          11       40000 ...": byte order 1 is little-endian, floating point 2 is IEEE. */
static enum eo_code read_binary(const struct eo_uff_lines *lines, struct eo_uff_header *header, struct eo_error *error)
{
  int64_t order = integer_field(lines, 7, 6), floating = integer_field(lines, 13, 6);
  header->big = order == 2;
  header->bytes = integer_field(lines, 31, 12);
  if (order < 1 || order > 2 || floating != 2)
    return eo_error_set(
        error, EO_ERROR_INPUT, "",
        "UFF: the binary data set in line %lld has byte order %lld and number format %lld; only IEEE is read.",
        (long long)lines->number, (long long)order, (long long)floating);
  if (header->bytes < 0 || header->bytes > lines->size - lines->at)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "UFF: the binary data set in line %lld states %lld bytes of data; the file has %lld.",
                        (long long)lines->number, (long long)header->bytes, (long long)(lines->size - lines->at));
  return EO_OK;
}

/* The fields of record 7 by the blanks between them. */
static void read_fields(const struct eo_uff_lines *lines, struct eo_uff_header *header)
{
  double field[6] = {0};
  int n = 0;
  for (const char *p = lines->line; *p && n < 6; n++) {
    while (*p == ' ')
      p++;
    p = eo_decimal_read(p, '.', &field[n]);
    if (!p)
      break;
  }
  if (n < 5 || !(field[1] > 0) || field[1] > (double)lines->size)
    return;
  header->type = (int)field[0];
  header->count = (int64_t)field[1];
  header->even = field[2] == 1;
  header->start = field[3];
  header->increment = field[4];
}

static void read_record(const struct eo_uff_lines *lines, int record, struct eo_uff_header *header)
{
  switch (record) {
  case 1:
    text_field(lines, 0, 80, header->title);
    break;
  case 6:
    header->function = (int)integer_field(lines, 0, 5);
    header->node = (int)integer_field(lines, 41, 10);
    header->direction = (int)integer_field(lines, 51, 4);
    break;
  case 7:
    header->type = (int)integer_field(lines, 0, 10);
    header->count = integer_field(lines, 10, 10);
    header->even = integer_field(lines, 20, 10) == 1;
    header->start = number_field(lines, 30, 13);
    header->increment = number_field(lines, 43, 13);
    if (header->count <= 0) /* fields that were moved: their order tells them */
      read_fields(lines, header);
    break;
  case 8:
    header->abscissa = (int)integer_field(lines, 0, 10);
    text_field(lines, 47, 20, header->time_unit);
    if (eo_unit_find(header->time_unit, &header->time_scale) != EO_QUANTITY_TIME) {
      header->time_unit[0] = '\0';
      header->time_scale = 1;
    }
    break;
  case 9:
    text_field(lines, 26, 20, header->label);
    text_field(lines, 47, 20, header->unit);
    break;
  default:
    break;
  }
}

enum eo_code eo_uff_read_header(struct eo_uff_lines *lines, struct eo_uff_header *header, struct eo_error *error)
{
  memset(header, 0, sizeof *header);
  header->time_scale = 1;
  header->line = lines->number;
  header->binary = lines->length > 6 && (lines->line[6] | 0x20) == 'b';
  enum eo_code code = header->binary ? read_binary(lines, header, error) : EO_OK;
  for (int record = 1; !code && record <= 11; record++) {
    if (eo_uff_next(lines, error, &code))
      read_record(lines, record, header);
    else if (!code)
      code = eo_error_set(error, EO_ERROR_INPUT, "", "UFF: the file ends in line %lld, in the header of a data set.",
                          (long long)lines->number);
  }
  if (!code &&
      (header->count < 0 || header->count > lines->size || !isfinite(header->increment) || !isfinite(header->start)))
    code = eo_error_set(error, EO_ERROR_INPUT, "",
                        "UFF: the data set in line %lld states %lld values; the file has %lld bytes.",
                        (long long)header->line, (long long)header->count, (long long)lines->size);
  return code;
}
