/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/number.h"

#include <errno.h>
#include <stdlib.h>

bool eo_app_read_whole(const char *text, const char *option, int low, int high, int *value, struct eo_error *error)
{
  char *end;
  errno = 0;
  long number = strtol(text, &end, 10);
  if (*text && !*end && !errno && number >= low && number <= high) {
    *value = (int)number;
    return true;
  }
  eo_error_set(error, EO_ERROR_INPUT, "", "%s takes a whole number of %d .. %d, not \"%.40s\".", option, low, high,
               text);
  return false;
}
