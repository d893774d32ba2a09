/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/text_cell.h"
#include "base/decimal.h"
#include "recording/letters.h"
#include "recording/moment.h"
#include "recording/recording.h"
#include "recording/recorded_unit.h"
#include "recording/text_named.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const char *skip_blanks(const char *at, const char *end, char separator)
{
  while (at < end && *at != separator && eo_text_blank(*at))
    at++;
  return at;
}

/* Quotes inside a quoted cell are doubled; they stay doubled, since only names can hold them. */
static const char *closing_quote(const char *at, const char *end)
{
  for (; at < end; at++)
    if (*at == '"' && !(at + 1 < end && at[1] == '"'))
      return at;
    else if (*at == '"')
      at++;
  return end;
}

/* Runs of blanks separate, all of them or those wider than one. */
static bool is_run(char separator)
{
  return separator == ' ' || separator == EO_TEXT_WIDE;
}

static bool ends_cell(const char *at, const char *end, char separator)
{
  if (separator == EO_TEXT_WIDE)
    return *at == '\t' || (eo_text_blank(*at) && at + 1 < end && eo_text_blank(at[1]));
  return separator == ' ' ? eo_text_blank(*at) : *at == separator;
}

bool eo_text_next_cell(const char **at, const char *end, char separator, struct eo_cell *cell)
{
  if (!*at)
    return false;
  if (eo_text_is_named(separator))
    return eo_text_named_cell(at, end, separator == EO_TEXT_NAMED_COMMA, cell);
  cell->name = NULL;
  const char *p = is_run(separator) ? *at : skip_blanks(*at, end, separator);
  while (is_run(separator) && p < end && eo_text_blank(*p))
    p++;
  if (is_run(separator) && p == end)
    return false;
  cell->quoted = p < end && *p == '"';
  cell->text = p + cell->quoted;
  if (cell->quoted) {
    p = closing_quote(cell->text, end);
    cell->length = (size_t)(p - cell->text);
  }
  while (p < end && !ends_cell(p, end, separator))
    p++;
  if (!cell->quoted) {
    const char *last = p;
    while (last > cell->text && eo_text_blank(last[-1]))
      last--;
    cell->length = (size_t)(last - cell->text);
  }
  *at = p < end ? p + 1 : NULL;
  return true;
}

/* 1.#INF00, 1,#IND, 1.#QNAN; no 16#1A of a controller. */
static bool is_runtime_word(const char *text, size_t length)
{
  return length > 3 && text[0] == '1' && (text[1] == '.' || text[1] == ',') && text[2] == '#';
}

static bool means_nothing(const char *text, size_t length)
{
  static const char *const words[] = {"nan",  "-nan",     "+nan",      "n/a",      "na",       "#n/a", "null",
                                      "none", "-",        "--",        "---",      "*",        "inf",  "+inf",
                                      "-inf", "infinity", "-infinity", "nan(ind)", "-nan(ind)"};
  size_t sign = length > 0 && (*text == '-' || *text == '+');
  if (!length || is_runtime_word(text + sign, length - sign))
    return true;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (strlen(words[i]) == length && !strncasecmp(text, words[i], length))
      return true;
  return false;
}

/* A mark of thousands: the other one of point and comma, an apostrophe, an underscore, or a blank of any kind. Returns
   its bytes. */
static size_t group_mark(const char *at, const char *end, char point)
{
  static const char *const marks[] = {"'", "_", " ", "\xc2\xa0", "\xe2\x80\xaf", "\xe2\x80\x99", "\xa0"};
  if (at < end && *at == (point == '.' ? ',' : '.'))
    return 1;
  for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
    size_t n = strlen(marks[i]);
    if ((size_t)(end - at) > n && !memcmp(at, marks[i], n))
      return n;
  }
  return 0;
}

static size_t digits_at(const char *at, const char *end)
{
  size_t n = 0;
  while (at + n < end && at[n] >= '0' && at[n] <= '9')
    n++;
  return n;
}

const char *eo_text_grouped(const char *at, const char *end, char point, int *groups, double *value)
{
  char plain[64];
  size_t n = 0, length, mark = 0;
  *groups = 0;
  if (at < end && (*at == '-' || *at == '+'))
    plain[n++] = *at++;
  length = digits_at(at, end);
  if (length < 1 || length > 3 || *at == '0' || !(mark = group_mark(at + length, end, point)))
    return NULL;
  const char *first = at + length;
  memcpy(plain + n, at, length);
  n += length;
  for (at = first; n + 4 < sizeof plain && (size_t)(end - at) > mark && !memcmp(at, first, mark); at += mark + 3) {
    size_t digits = digits_at(at + mark, end);
    if (digits != 3 && digits > 0)
      return NULL;
    if (!digits)
      break;
    memcpy(plain + n, at + mark, 3);
    n += 3;
    ++*groups;
  }
  size_t left = (size_t)(end - at), room = sizeof plain - n - 1;
  memcpy(plain + n, at, left < room ? left : room);
  plain[n + (left < room ? left : room)] = '\0';
  const char *last = *groups ? eo_decimal_read(plain, point, value) : NULL;
  return last ? at + (last - plain - (ptrdiff_t)n) : NULL;
}

static enum eo_cell_kind grouped_value(const struct eo_cell *cell, char point, double *value)
{
  int groups;
  const char *end = cell->text + cell->length;
  if (eo_text_grouped(cell->text, end, point, &groups, value) != end || !isfinite(*value))
    return EO_CELL_TEXT;
  return memchr(cell->text, point, cell->length) ? EO_CELL_NUMBER : EO_CELL_GROUPED;
}

bool eo_text_cell_hex(const struct eo_cell *cell, double *value)
{
  const char *at = cell->text, *end = at + cell->length;
  uint64_t number = 0;
  int digits = 0;
  if (end - at > 2 && at[0] == '0' && (at[1] | 0x20) == 'x')
    at += 2;
  else if (end - at > 2 && at[0] == '&' && (at[1] | 0x20) == 'h')
    at += 2;
  else if (end - at > 3 && !memcmp(at, "16#", 3))
    at += 3;
  else if (end - at > 1 && (*at == '$' || *at == '#'))
    at++;
  else if (end - at > 1 && (end[-1] | 0x20) == 'h')
    end--;
  for (; at < end && isxdigit((unsigned char)*at) && digits < 16; at++, digits++)
    number = number << 4 | (uint64_t)(*at <= '9' ? *at - '0' : (*at | 0x20) - 'a' + 10);
  *value = (double)number;
  return at == end && digits > 0;
}

bool eo_text_cell_level(const struct eo_cell *cell, double *value)
{
  bool high = eo_letters_listed(cell->text, cell->length, "high|hi|h|true|on|ein|wahr|hoch|vrai|verdadero|vero"),
       low = eo_letters_listed(cell->text, cell->length, "low|lo|l|false|off|aus|falsch|tief|niedrig|faux|falso");
  *value = high;
  return high || low;
}

/* Without a mark only digits with a letter among them are hexadecimal, and only when they begin with a digit or are
   long. */
static bool looks_hexadecimal(const struct eo_cell *cell)
{
  double value;
  bool letter = false, digit = false;
  for (size_t i = 0; i < cell->length; i++) {
    letter = letter || isalpha((unsigned char)cell->text[i]);
    digit = digit || isdigit((unsigned char)cell->text[i]);
  }
  return letter && digit && cell->length >= 4 && eo_text_cell_hex(cell, &value);
}

static bool is_marked_hexadecimal(const struct eo_cell *cell)
{
  return cell->length > 2 && ((cell->text[0] == '0' && (cell->text[1] | 0x20) == 'x') || cell->text[0] == '&' ||
                              !memcmp(cell->text, "16#", 3));
}

/* One of the marks, separated by blanks, the longest first; returns its bytes, 0: none is there. */
static size_t mark_at(const char *at, const char *end, const char *marks)
{
  for (const char *p = marks; *p;) {
    size_t n = strcspn(p, " ");
    if ((size_t)(end - at) >= n && !strncasecmp(at, p, n))
      return n;
    p += n + (p[n] == ' ');
  }
  return 0;
}

/* Digits with a decimal point at most, since "12d34" is no power of ten here; returns their end. */
static const char *part_at(const char *at, const char *end, char point, double *value)
{
  char digits[32];
  size_t n = digits_at(at, end);
  if (n > 0 && at + n < end && at[n] == point)
    n += 1 + digits_at(at + n + 1, end);
  if (!n || n >= sizeof digits)
    return at;
  memcpy(digits, at, n);
  digits[n] = '\0';
  return eo_decimal_read(digits, point, value) ? at + n : at;
}

bool eo_text_cell_sexagesimal(const struct eo_cell *cell, char point, bool colons, double *value)
{
  static const char *const marks[3] = {"deg \xc2\xb0 \xc2\xba \xcb\x9a \xb0 \xba d",
                                       "min '' \xe2\x80\xb2 \xe2\x80\x99 \xc2\xb4 \xb4 m '",
                                       "sec \"\" '' \xe2\x80\xb3 \xe2\x80\x9d \xe2\x80\xb2\xe2\x80\xb2 s \""};
  const char *at = cell->text, *end = at + cell->length;
  bool negative = at < end && *at == '-';
  double sum = 0, unit = 1;
  int parts = 0;
  for (at += at < end && (*at == '-' || *at == '+'); at < end && parts < 3; parts++, unit *= 60) {
    double number = 0;
    const char *last = part_at(at, end, point, &number);
    if (last == at || (parts > 0 && number >= 60))
      return false;
    size_t mark = mark_at(last, end, marks[parts]);
    mark = colons && !mark && last < end && *last == ':' ? 1 : mark;
    if (last + mark < end && (!mark || number != floor(number))) /* only the last part may be broken */
      return false;
    if (!mark && (!parts || !colons) && parts < 2)
      return false;
    sum += number / unit;
    at = skip_blanks(last + mark, end, '\0');
  }
  *value = negative ? -sum : sum;
  return at == end && parts > 1;
}

void eo_text_cell_copy(char *to, size_t size, const struct eo_cell *cell)
{
  snprintf(to, size, "%.*s", (int)(cell->length < size ? cell->length : size - 1), cell->text);
}

void eo_text_cell_unit(const struct eo_cell *cell, char point, char *unit, int size)
{
  double value, factor;
  const char *end = cell->text + cell->length, *at = eo_decimal_read(cell->text, point, &value);
  *unit = '\0';
  if (eo_text_cell_sexagesimal(cell, point, false, &value)) {
    snprintf(unit, (size_t)size, "deg");
    return;
  }
  if (!at || at >= end || end - at >= size)
    return;
  while (at < end && eo_text_blank(*at))
    at++;
  snprintf(unit, (size_t)size, "%.*s", (int)(end - at), at);
  if (eo_unit_find(unit, &factor) == EO_QUANTITY_NONE || (*at >= '0' && *at <= '9'))
    *unit = '\0';
}

/* Three parts between colons that are no time of day: with a sign, or of more hours than those have. */
static bool is_arc(const struct eo_cell *cell, char point, double *value)
{
  int colons = 0;
  for (size_t i = 0; i < cell->length; i++)
    colons += cell->text[i] == ':';
  return colons == 2 && eo_text_cell_sexagesimal(cell, point, true, value);
}

enum eo_cell_kind eo_text_cell_value(const struct eo_cell *cell, char point, double *value)
{
  double number;
  char unit[EO_RECORDING_UNIT];
  const char *end = cell->length ? eo_decimal_read(cell->text, point, &number) : NULL;
  if (end == cell->text + cell->length) {
    *value = number;
    return EO_CELL_NUMBER;
  }
  *value = NAN;
  if (means_nothing(cell->text, cell->length))
    return EO_CELL_MISSING;
  if (is_marked_hexadecimal(cell) && eo_text_cell_hex(cell, value))
    return EO_CELL_NUMBER;
  if (eo_text_cell_sexagesimal(cell, point, false, value))
    return EO_CELL_UNIT;
  *value = NAN;
  struct eo_moment moment;
  if (cell->length < 64 && eo_moment_read(cell->text, cell->length, &moment))
    return EO_CELL_MOMENT;
  if (is_arc(cell, point, value))
    return EO_CELL_ARC;
  *value = NAN;
  enum eo_cell_kind kind = grouped_value(cell, point, value);
  if (kind != EO_CELL_TEXT)
    return kind;
  if (looks_hexadecimal(cell))
    return EO_CELL_HEX;
  eo_text_cell_unit(cell, point, unit, (int)sizeof unit);
  *value = *unit ? number : NAN;
  return *unit ? EO_CELL_UNIT : EO_CELL_TEXT;
}

const char *eo_text_comment(const char *line, const char *end, char separator)
{
  const char *p = skip_blanks(line, end, '\0');
  if (p == end)
    return NULL;
  if (*p == '#' || *p == '%' || (*p == ';' && separator != ';'))
    while (p < end && (*p == '#' || *p == '%' || *p == ';'))
      p++;
  else if (p + 1 < end && p[0] == '/' && p[1] == '/')
    p += 2;
  else
    return NULL;
  return p;
}

bool eo_text_empty(const char *line, const char *end)
{
  return skip_blanks(line, end, '\0') == end;
}
