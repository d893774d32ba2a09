#include "recording/text_cell.h"
#include "recording/decimal.h"

#include <math.h>
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

static bool ends_cell(char c, char separator)
{
  return separator == ' ' ? eo_text_blank(c) : c == separator;
}

bool eo_text_next_cell(const char **at, const char *end, char separator, struct eo_cell *cell)
{
  if (!*at)
    return false;
  const char *p = separator == ' ' ? *at : skip_blanks(*at, end, separator);
  while (separator == ' ' && p < end && eo_text_blank(*p))
    p++;
  if (separator == ' ' && p == end)
    return false;
  cell->quoted = p < end && *p == '"';
  cell->text = p + cell->quoted;
  if (cell->quoted) {
    p = closing_quote(cell->text, end);
    cell->length = (size_t)(p - cell->text);
  }
  while (p < end && !ends_cell(*p, separator))
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

static bool means_nothing(const char *text, size_t length)
{
  static const char *const words[] = {"nan",  "-nan",     "+nan",      "n/a",      "na",       "#n/a", "null",
                                      "none", "-",        "--",        "---",      "*",        "inf",  "+inf",
                                      "-inf", "infinity", "-infinity", "nan(ind)", "-nan(ind)"};
  if (!length)
    return true;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (strlen(words[i]) == length && !strncasecmp(text, words[i], length))
      return true;
  return false;
}

enum eo_cell_kind eo_text_cell_value(const struct eo_cell *cell, char point, double *value)
{
  double number;
  if (cell->length && eo_decimal_read(cell->text, point, &number) == cell->text + cell->length) {
    *value = number;
    return EO_CELL_NUMBER;
  }
  *value = NAN;
  return means_nothing(cell->text, cell->length) ? EO_CELL_MISSING : EO_CELL_TEXT;
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
