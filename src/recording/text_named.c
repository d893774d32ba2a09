/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/text_named.h"
#include "recording/recorded_unit.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#define LONGEST 63           /* bytes of a name */
#define ENDS ",;|\t\r{}[]\"" /* of a name; a value may hold commas */

static bool is_blank(char c)
{
  return c == ' ' || c == '\t' || c == '\r';
}

static bool is_one_of(char c, const char *set)
{
  return c && strchr(set, c);
}

static bool begins_name(const char *at, const char *end)
{
  return at < end && (isalpha((unsigned char)*at) || *at == '_' || (unsigned char)*at >= 0x80);
}

static const char *skip_blanks(const char *at, const char *end)
{
  while (at < end && is_blank(*at))
    at++;
  return at;
}

static bool is_mark(const char *at, const char *end)
{
  return at < end && (*at == '=' || *at == ':');
}

/* Behind the last byte of a word: letters, digits and what stands in names without blanks. */
static const char *word_end(const char *at, const char *end)
{
  while (at < end && *at != ' ' && !is_mark(at, end) && !is_one_of(*at, ENDS))
    at++;
  return at;
}

/* Digits alone, with a mark behind them: the end of "Channel 1:". */
static bool is_last_number(const char *at, const char *end)
{
  while (at < end && isdigit((unsigned char)*at))
    at++;
  return is_mark(skip_blanks(at, end), end);
}

/* Where the mark of a name that begins here stands; NULL where none does. Words of a name go on over blanks, numbers
   end it, and the value of "Sample 17: pinion=12.3" is no name. */
static const char *mark_of(const char *at, const char *end)
{
  const char *p = at;
  if (!begins_name(at, end))
    return NULL;
  end = end - at > LONGEST + 1 ? at + LONGEST + 1 : end;
  for (;;) {
    p = word_end(p, end);
    while (p < end && *p == '"') /* of a name in quotes */
      p++;
    const char *next = skip_blanks(p, end);
    if (is_mark(next, end)) {
      const char *value = skip_blanks(next + 1, end);
      bool name = begins_name(value, end) && is_mark(skip_blanks(word_end(value, end), end), end);
      return name ? NULL : next;
    }
    if (next == p || !(begins_name(next, end) || (next < end && is_one_of(*next, "(/")) || is_last_number(next, end)))
      return NULL;
    p = next;
    p += is_one_of(*p, "(/");
  }
}

/* A known unit behind a value, with one blank or more before it; returns its end, or at. */
static const char *unit_behind(const char *at, const char *end)
{
  char unit[24];
  double factor;
  const char *first = skip_blanks(at, end), *last = word_end(first, end);
  size_t length = (size_t)(last - first);
  if (first == at || !length || length >= sizeof unit || is_mark(skip_blanks(last, end), end) ||
      isdigit((unsigned char)*first))
    return at;
  memcpy(unit, first, length);
  unit[length] = '\0';
  return eo_unit_find(unit, &factor) == EO_QUANTITY_NONE ? at : last;
}

/* The comma stands between two digits. */
static bool in_number(const char *at, const char *first, const char *end)
{
  return at > first && at + 1 < end && isdigit((unsigned char)at[-1]) && isdigit((unsigned char)at[1]);
}

static const char *take_value(const char *at, const char *end, struct eo_cell *cell)
{
  const char *p = at = skip_blanks(at, end);
  cell->quoted = p < end && *p == '"';
  if (cell->quoted) {
    cell->text = ++p;
    while (p < end && *p != '"')
      p++;
    cell->length = (size_t)(p - cell->text);
    return p;
  }
  while (p < end && is_one_of(*p, "[{("))
    at = ++p;
  while (p < end && *p != ' ' && !is_one_of(*p, ";|\t\r{}[]\"") && (*p != ',' || in_number(p, at, end)))
    p++;
  p = p > at ? unit_behind(p, end) : p;
  cell->text = at;
  cell->length = (size_t)(p - at);
  return p;
}

/* A word or number without a name, without what surrounds it: "->", "[0.5]", "(12345)". */
static const char *take_plain(const char *at, const char *end, bool comma, struct eo_cell *cell)
{
  const char *p = at, *last;
  while (p < end && *p != ' ' && !is_one_of(*p, ";|\t\r{}[]\"") && (*p != ',' || (comma && in_number(p, at, end))))
    p++;
  for (last = p; last > at && is_one_of(last[-1], ">)-=:<("); last--)
    ;
  cell->text = at;
  cell->length = (size_t)(last - at);
  return p;
}

bool eo_text_named_cell(const char **at, const char *end, bool comma, struct eo_cell *cell)
{
  const char *p = *at;
  memset(cell, 0, sizeof *cell);
  while (p && p < end) {
    while (p < end && (is_blank(*p) || is_one_of(*p, ",;|{}[]\"(>")))
      p++;
    const char *mark = mark_of(p, end);
    if (mark) {
      const char *last = mark;
      while (last > p && (is_blank(last[-1]) || last[-1] == '"'))
        last--;
      cell->name = p;
      cell->name_length = (size_t)(last - p);
      *at = take_value(mark + 1, end, cell);
      return true;
    }
    p = p < end ? take_plain(p, end, comma, cell) : p;
    *at = p;
    if (cell->length)
      return true;
  }
  *at = NULL;
  return false;
}

uint64_t eo_text_name_key(const struct eo_cell *cell)
{
  uint64_t key = 14695981039346656037u; /* FNV-1a */
  for (size_t i = 0; i < cell->name_length; i++)
    key = (key ^ (unsigned char)cell->name[i]) * 1099511628211u;
  return cell->name ? key | 1 : 0;
}
