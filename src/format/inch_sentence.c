/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/inch_sentence.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/inch.h"

static const double PER_INCH = 25.4; /* mm in an inch, um in a thousandth of it */
enum { LEAST_DIGITS = 5, MOST_DIGITS = 15 };

static const struct length_unit {
  const char *metric, *inch;
} length_units[] = {{"mm", "in"}, {"um", "thou"}, {"\xc2\xb5m", "thou"}};

/* Between numbers that share the unit behind the last one: "0.5 .. 500 mm". */
static const char *const joints[] = {" .. ", " to ", " and ", " is outside "};

static bool is_of_word(char c)
{
  return isalnum((unsigned char)c) || c == '_';
}

/* Bytes of the number without its sign at the place; 0: there is none. digits: that count. */
static size_t number_length(const char *at, int *digits)
{
  size_t length = 0;
  bool any = false;
  *digits = 0;
  for (; isdigit((unsigned char)at[length]) || (at[length] == '.' && isdigit((unsigned char)at[length + 1])); length++)
    if (at[length] != '.' && (any = any || at[length] != '0'))
      ++*digits;
  if (length && at[length] == 'e') {
    size_t sign = at[length + 1] == '-' || at[length + 1] == '+', power = length + 1 + sign;
    if (isdigit((unsigned char)at[power])) {
      length = power;
      while (isdigit((unsigned char)at[length]))
        length++;
    }
  }
  return length;
}

/* The unit alone: no mm2, mm/s, mm^2, mm3. */
static const struct length_unit *unit_at(const char *at)
{
  static const char *const more[] = {"/", "^", "\xc2\xb2", "\xc2\xb3"};
  for (size_t i = 0; i < sizeof length_units / sizeof *length_units; i++) {
    const char *behind = at + strlen(length_units[i].metric);
    if (strncmp(at, length_units[i].metric, strlen(length_units[i].metric)) != 0 || is_of_word(*behind))
      continue;
    for (size_t k = 0; k < sizeof more / sizeof *more; k++)
      if (strncmp(behind, more[k], strlen(more[k])) == 0)
        return NULL;
    return &length_units[i];
  }
  return NULL;
}

/* Whether the number that ends at the place is a length: a unit follows it, or a joint and such a number. */
static bool is_length(const char *behind)
{
  int digits;
  if (*behind == ' ' && unit_at(behind + 1))
    return true;
  for (size_t i = 0; i < sizeof joints / sizeof *joints; i++) {
    size_t joint = strlen(joints[i]);
    if (strncmp(behind, joints[i], joint) == 0) {
      const char *next = behind + joint + (behind[joint] == '-');
      size_t length = number_length(next, &digits);
      return length && is_length(next + length);
    }
  }
  return false;
}

static void add_length(struct eo_text *text, const char *number, int digits)
{
  digits = digits < LEAST_DIGITS ? LEAST_DIGITS : digits > MOST_DIGITS ? MOST_DIGITS : digits;
  eo_text_print(text, "%.*g", digits, strtod(number, NULL) / PER_INCH);
}

void eo_inch_sentence(struct eo_text *text, const char *sentence)
{
  bool in_name = false, behind_length = false; /* the 2 of "A2", "1.2" of "v1.2" and "286-1" is no number */
  for (const char *at = sentence; *at;) {
    int digits = 0;
    char key[EO_INCH_KEY];
    size_t number = in_name ? 0 : number_length(at, &digits), taken = number;
    const struct length_unit *unit = behind_length && *at == ' ' ? unit_at(at + 1) : NULL;
    behind_length = number && is_length(at + number);
    while (!number && is_of_word(at[taken]))
      taken++;
    if (behind_length)
      add_length(text, at, digits);
    else if (unit)
      eo_text_print(text, " %s", unit->inch);
    else if (taken > number && eo_inch_key(at, taken, key))
      eo_text_add(text, key);
    else
      eo_text_add_bytes(text, at, taken ? taken : 1);
    at += unit ? 1 + strlen(unit->metric) : taken ? taken : 1;
    in_name = is_of_word(at[-1]) || ((number || in_name) && strchr(".-", at[-1]));
  }
}

void eo_inch_error(struct eo_error *error)
{
  struct eo_text text = {0};
  eo_inch_sentence(&text, error->text);
  if (text.data && !text.failed)
    snprintf(error->text, sizeof error->text, "%s", text.data);
  eo_text_done(&text);
}
