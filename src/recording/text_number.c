/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/text_number.h"
#include "base/decimal.h"
#include "recording/letters.h"
#include "recording/recorded_unit.h"
#include "recording/text_cell.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define LIST_WORDS "and|und|et|y|e|en"

static const char *skip_digits(const char *p, const char *end)
{
  while (p < end && isdigit((unsigned char)*p))
    p++;
  return p;
}

static const char *skip_blanks(const char *p, const char *end)
{
  while (p < end && (*p == ' ' || *p == '\t'))
    p++;
  return p;
}

static bool digit_at(const char *p, const char *end)
{
  return p < end && isdigit((unsigned char)*p);
}

/* Marks of thousands that cannot be anything else where the number stands: two of them or more, one before the other
   mark ("4.000,0"), or such as part no numbers. NULL: there are none. */
static const char *grouped_at(const struct eo_text_format *format, const char *p, const char *end, bool in_one_cell,
                              double *value)
{
  static const char points[] = ".,";
  int groups;
  for (const char *point = points; *point; point++) {
    const char *after = eo_text_grouped(p, end, *point, &groups, value), *mark = skip_digits(p + (*p == '-'), end);
    bool both = after && format->separator != ',' && memchr(p, '.', (size_t)(after - p)) &&
                memchr(p, ',', (size_t)(after - p));
    bool several = groups > 1 || both, cell = *mark != format->separator || in_one_cell;
    bool sure = *mark == ',' || *mark == '.' ? several && cell
                : *mark == ' '               ? (several && cell) || (in_one_cell && format->separator != ' ')
                                             : true;
    if (after && sure)
      return after;
  }
  return NULL;
}

/* "2^23", "2**23" */
static const char *power_at(const char *after, const char *end, double *value)
{
  size_t mark = after < end && *after == '^' ? 1 : end - after > 1 && !memcmp(after, "**", 2) ? 2 : 0;
  double exponent;
  if (!mark || !digit_at(after + mark, end))
    return after;
  after = eo_decimal_read(after + mark, '.', &exponent);
  *value = pow(*value, exponent);
  return after;
}

const char *eo_header_number_at(const struct eo_text_format *format, const char *p, const char *end, bool in_one_cell,
                                double *value)
{
  const char *after = grouped_at(format, p, end, in_one_cell, value);
  if (after)
    return after;
  after = eo_decimal_read(p, '.', value);
  if (after)
    after = power_at(after, end, value);
  if (!after || after >= end || *after != ',' || !isdigit((unsigned char)after[1]) ||
      memchr(p, '.', (size_t)(after - p)))
    return after;
  const char *group = skip_digits(after + 1, end);
  bool thousands = group - after == 4 && *value >= 1 && *value < 1000 && format->point == '.';
  if (format->separator == ',' && *value != 0 && !(thousands && in_one_cell))
    return after;
  if (!thousands)
    return eo_decimal_read(p, ',', value);
  double rest;
  after = eo_decimal_read(after + 1, '.', &rest);
  *value = *value * 1000 + rest;
  return after;
}

void eo_header_trim(char *to, size_t size, const char *from, const char *end)
{
  end = end < from ? from : end;
  while (from < end && strchr(" \t:=;,|\"", *from))
    from++;
  while (end > from && strchr(" \t:=;,|\"([{<", end[-1]))
    end--;
  snprintf(to, size, "%.*s", (int)((size_t)(end - from) < size ? (size_t)(end - from) : size - 1), from);
}

size_t eo_header_times(const char *p, const char *end)
{
  size_t mark = p < end && strchr("xX*", *p) ? 1 : end - p > 1 && !memcmp(p, "\xc3\x97", 2) ? 2 : 0;
  return mark && digit_at(p + mark, end) ? mark : 0;
}

/* A mark or a word that parts the numbers of a list, with the next of them behind it. */
static bool goes_on(const char *p, const char *end)
{
  const char *last = p;
  while (last < end && isalpha((unsigned char)*last))
    last++;
  if (last > p && !eo_letters_listed(p, (size_t)(last - p), LIST_WORDS))
    return false;
  if (last == p && (p == end || !strchr("/&+", *last++)))
    return false;
  return digit_at(skip_blanks(last, end), end);
}

bool eo_header_list_gap(const char *from, const char *to)
{
  char gap[8];
  eo_header_trim(gap, sizeof gap, from, to); /* commas, semicolons and bars go */
  bool mark = false;
  for (const char *p = from; p < to; p++)
    mark = mark || strchr(",;/&+|", *p);
  size_t length = strspn(gap, ")] ,;/&+|");
  return to > from && to - from < 8 && ((mark && !gap[length]) || eo_letters_listed(gap, strlen(gap), LIST_WORDS));
}

/* Bytes of the words at the beginning that are a unit of a rate or a time: of "kHz by rig 3" the first; 0: none is. */
static size_t sampling_unit(const char *words, size_t length)
{
  char unit[32];
  double factor;
  while (length) {
    snprintf(unit, sizeof unit, "%.*s", (int)(length < sizeof unit ? length : 0), words);
    enum eo_quantity quantity = eo_unit_find(unit, &factor);
    if (quantity == EO_QUANTITY_FREQUENCY || quantity == EO_QUANTITY_TIME)
      return length;
    while (length && words[length - 1] != ' ')
      length--;
    while (length && words[length - 1] == ' ')
      length--;
  }
  return 0;
}

const char *eo_header_unit(const char *number, const char *end, char *unit, size_t size)
{
  const char *p = number;
  while (p < end && strchr(" \t[(;,", *p) && *p)
    p++;
  p += p == number && end - p > 1 && *p == '-' && isalpha((unsigned char)p[1]); /* "23-bit" */
  *unit = '\0';
  if (p < end && (isdigit((unsigned char)*p) || strchr("+-.", *p) || goes_on(p, end) || eo_header_times(p, end)))
    return number;
  const char *last = p;
  while (last < end && !strchr("\t;,|)]\"=:", *last) &&
         !(last > p && (last[-1] == ' ' || *last == '/') && (goes_on(last, end) || eo_header_times(last, end))))
    last++;
  size_t length = (size_t)(last - p);
  while (length && p[length - 1] == ' ')
    length--;
  size_t known = sampling_unit(p, length);
  length = known ? known : length;
  snprintf(unit, size, "%.*s", (int)(length < size ? length : 0), p);
  return known ? p + known : last;
}
