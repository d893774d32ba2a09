/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/cell_number.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool eo_cell_has_decimal(const char *cell, char sign)
{
  if (strspn(cell, "+-0123456789.,eE") != strlen(cell))
    return false;
  for (const char *at = cell; (at = strchr(at, sign)); at++)
    if (at > cell && isdigit((unsigned char)at[-1]) && isdigit((unsigned char)at[1]))
      return true;
  return false;
}

double eo_cell_sexagesimal(const char *cell)
{
  double part[3] = {0}, value;
  int count = 0;
  const char *at = cell + (*cell == '-');
  while (*at && count < 3) {
    char *end;
    if (!isdigit((unsigned char)*at))
      return NAN;
    part[count++] = strtod(at, &end);
    at = end;
    while (*at && !isdigit((unsigned char)*at)) {
      if (!strchr(" '\"", *at) && strncmp(at, "°", 2) != 0 && (unsigned char)*at != 0xB0)
        return NAN;
      at++;
    }
  }
  value = part[0] + part[1] / 60 + part[2] / 3600;
  return count < 2 || *at || part[1] >= 60 || part[2] >= 60 ? NAN : *cell == '-' ? -value : value;
}

double eo_cell_number(const char *cell, bool comma)
{
  char text[80], *end;
  size_t length = strlen(cell);
  if (length >= sizeof text || strspn(cell, "+-.,0123456789eE") != length || !length)
    return NAN;
  snprintf(text, sizeof text, "%s", cell);
  for (char *c = text; *c && comma; c++)
    *c = *c == ',' ? '.' : *c;
  double value = strtod(text, &end);
  return *end || !isfinite(value) ? NAN : value;
}
