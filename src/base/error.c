/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum eo_code eo_error_set(struct eo_error *error, enum eo_code code, const char *pointer, const char *format, ...)
{
  if (!error)
    return code;
  error->code = code;
  snprintf(error->pointer, sizeof error->pointer, "%s", pointer);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(error->text, sizeof error->text, format, arguments);
  va_end(arguments);
  return code;
}

enum eo_code eo_error_memory(struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_MEMORY, "", "Not enough memory.");
}
