/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Facts that a file states as text. */
#include "base/decimal.h"
#include "recording/stated.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* "4,000" is four or four thousand: neither is taken. */
static bool is_ambiguous(const char *text)
{
  const char *comma = strchr(text, ',');
  size_t whole = strspn(text, "0123456789");
  return comma && comma == text + whole && whole > 0 && whole < 4 && *text != '0' && !strchr(text, '.') &&
         strspn(comma + 1, "0123456789") == 3;
}

bool eo_stated_read_number(const char *text, double *number, char *unit, size_t size)
{
  text += strspn(text, " ");
  *unit = '\0';
  if (is_ambiguous(text))
    return false;
  const char *after = eo_decimal_read(text, strchr(text, ',') && !strchr(text, '.') ? ',' : '.', number);
  if (!after || (*after && strchr(":-./", *after))) /* a date, a time of day, an address */
    return false;
  after += strspn(after, " ");
  size_t length = strcspn(after, ",;");
  snprintf(unit, size, "%.*s", (int)(length < size ? length : 0), after);
  return !isdigit((unsigned char)*after);
}

bool eo_stated_moment(const char *key, const char *text, struct eo_moment *moment)
{
  size_t length = strlen(text);
  while (length && isspace((unsigned char)text[length - 1]))
    length--;
  /* When a file or a channel was created is when it was written, not when its first value was taken. */
  return strcasecmp(key, "created") != 0 && eo_stated_begin(key) && eo_moment_read(text, length, moment);
}
