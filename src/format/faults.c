/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/faults.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "format/text.h"

static void add(struct eo_faults *faults, const char *pointer, const char *format, va_list arguments)
{
  if (faults->count < EO_MAX_FAULTS) {
    struct eo_error *fault = &faults->fault[faults->count];
    char text[2 * sizeof fault->text];
    vsnprintf(text, sizeof text, format, arguments);
    fault->code = EO_ERROR_INPUT;
    eo_text_clean(fault->pointer, sizeof fault->pointer, pointer);
    eo_text_clean(fault->text, sizeof fault->text, text);
  }
  faults->count++;
}

void eo_faults_add(struct eo_faults *faults, const char *pointer, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  add(faults, pointer, format, arguments);
  va_end(arguments);
}

void eo_faults_memory(struct eo_faults *faults)
{
  eo_error_memory(&faults->fault[0]);
  faults->count = faults->count ? faults->count : 1;
}

enum eo_code eo_faults_first(const struct eo_faults *faults, struct eo_error *error)
{
  if (!faults->count)
    return EO_OK;
  if (error)
    *error = faults->fault[0];
  return faults->fault[0].code;
}

static int put(char *pointer, int size, int length, char c)
{
  if (length < size - 1)
    pointer[length++] = c;
  return length;
}

static int put_path(const struct eo_path *path, char *pointer, int size)
{
  if (!path)
    return 0;
  int length = put(pointer, size, put_path(path->up, pointer, size), '/');
  char index[16];
  snprintf(index, sizeof index, "%d", path->index);
  for (const char *c = path->key ? path->key : index; *c; c++) {
    bool escaped = *c == '~' || *c == '/';
    length = put(pointer, size, length, escaped ? '~' : *c);
    if (escaped)
      length = put(pointer, size, length, *c == '~' ? '0' : '1');
  }
  return length;
}

void eo_path_pointer(const struct eo_path *path, char *pointer, int size)
{
  pointer[put_path(path, pointer, size)] = '\0';
}

void eo_faults_at(struct eo_faults *faults, const struct eo_path *path, const char *format, ...)
{
  char pointer[1024];
  eo_path_pointer(path, pointer, sizeof pointer);
  va_list arguments;
  va_start(arguments, format);
  add(faults, pointer, format, arguments);
  va_end(arguments);
}
