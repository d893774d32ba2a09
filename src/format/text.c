/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/text.h"

#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/utf8.h"

static bool reserve(struct eo_text *text, size_t more)
{
  if (text->failed || more > SIZE_MAX / 4 || text->size > SIZE_MAX / 4) {
    text->failed = true;
    return false;
  }
  size_t needed = text->size + more + 1;
  if (needed <= text->capacity)
    return true;
  size_t capacity = text->capacity ? text->capacity : 256;
  while (capacity < needed)
    capacity *= 2;
  char *data = realloc(text->data, capacity);
  if (!data) {
    text->failed = true;
    return false;
  }
  text->data = data;
  text->capacity = capacity;
  return true;
}

char *eo_text_room(struct eo_text *text, size_t more)
{
  return reserve(text, more) ? text->data + text->size : NULL;
}

void eo_text_add_bytes(struct eo_text *text, const void *data, size_t size)
{
  if (!reserve(text, size))
    return;
  if (size)
    memcpy(text->data + text->size, data, size);
  text->size += size;
  text->data[text->size] = '\0';
}

void eo_text_add(struct eo_text *text, const char *string)
{
  eo_text_add_bytes(text, string, strlen(string));
}

static const char *entity(char c)
{
  switch (c) {
  case '&':
    return "&amp;";
  case '<':
    return "&lt;";
  case '>':
    return "&gt;";
  case '"':
    return "&quot;";
  default:
    return NULL;
  }
}

void eo_text_add_escaped(struct eo_text *text, const char *string)
{
  for (; *string; string++) {
    const char *instead = entity(*string);
    bool control = (unsigned char)*string < ' ' && *string != '\t' && *string != '\n';
    eo_text_add_bytes(text, instead ? instead : control ? " " : string, instead ? strlen(instead) : 1);
  }
}

void eo_text_print(struct eo_text *text, const char *format, ...)
{
  enum { USUAL = 100 };
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  bool usual = reserve(text, USUAL);
  int length = usual ? vsnprintf(text->data + text->size, USUAL + 1, format, arguments) : 0;
  if (length > USUAL && reserve(text, (size_t)length))
    vsnprintf(text->data + text->size, (size_t)length + 1, format, again);
  if (length > 0 && !text->failed)
    text->size += (size_t)length;
  va_end(again);
  va_end(arguments);
}

void eo_text_done(struct eo_text *text)
{
  if (!text)
    return;
  free(text->data);
  *text = (struct eo_text){0};
}

static enum eo_code read_stream(struct eo_text *text, FILE *stream, size_t limit, struct eo_error *error)
{
  char block[16384];
  size_t got;
  while ((got = fread(block, 1, sizeof block, stream)) > 0) {
    if (text->size + got > limit)
      return eo_error_set(error, EO_ERROR_INPUT, "", "The input is larger than the limit of %zu bytes.", limit);
    eo_text_add_bytes(text, block, got);
    if (text->failed)
      return eo_error_memory(error);
  }
  if (ferror(stream))
    return eo_error_set(error, EO_ERROR_INPUT, "", "The input cannot be read: %s.", strerror(errno));
  return EO_OK;
}

enum eo_code eo_text_read(struct eo_text *text, const char *path, size_t limit, struct eo_error *error)
{
  bool standard = strcmp(path, "-") == 0;
  FILE *stream = standard ? stdin : fopen(path, "rb");
  if (!stream)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The file cannot be opened: %s.", strerror(errno));
  struct eo_text read = {0};
  enum eo_code code = read_stream(&read, stream, limit, error);
  if (!standard)
    fclose(stream);
  if (code)
    eo_text_done(&read);
  else
    *text = read;
  return code;
}

enum eo_code eo_text_write(const struct eo_text *text, FILE *stream, const char *name, struct eo_error *error)
{
  if (text->failed)
    return eo_error_memory(error);
  errno = 0;
  bool written = fwrite(text->data ? text->data : "", 1, text->size, stream) == text->size;
  if (fflush(stream) != 0 || !written)
    return eo_error_set(error, EO_ERROR_FILE, "", "%.100s cannot be written: %s.", name,
                        errno ? strerror(errno) : "output was lost");
  return EO_OK;
}

static enum eo_code save_under(const struct eo_text *text, const char *temporary, const char *path,
                               struct eo_error *error)
{
  FILE *stream = fopen(temporary, "wbx");
  if (!stream)
    return eo_error_set(error, EO_ERROR_FILE, "", "%.100s cannot be written: %s.", path, strerror(errno));
  enum eo_code code = eo_text_write(text, stream, path, error);
  if (!code && fsync(fileno(stream)) != 0)
    code = eo_error_set(error, EO_ERROR_FILE, "", "%.100s cannot be written: %s.", path, strerror(errno));
  if (fclose(stream) != 0 && !code)
    code = eo_error_set(error, EO_ERROR_FILE, "", "%.100s cannot be written: %s.", path, strerror(errno));
  if (!code && rename(temporary, path) != 0)
    code = eo_error_set(error, EO_ERROR_FILE, "", "%.100s cannot be replaced: %s.", path, strerror(errno));
  if (code)
    unlink(temporary);
  return code;
}

enum eo_code eo_text_save(const struct eo_text *text, const char *path, struct eo_error *error)
{
  struct eo_text temporary = {0};
  eo_text_print(&temporary, "%s.%ld.part", path, (long)getpid());
  enum eo_code code = temporary.failed ? eo_error_memory(error) : save_under(text, temporary.data, path, error);
  eo_text_done(&temporary);
  return code;
}

void eo_text_clean(char *target, size_t size, const char *source)
{
  size_t length = strlen(source), used = 0, at = 0;
  bool whole = length < size;
  while (at < length) {
    bool control = (unsigned char)source[at] < 32 || source[at] == 127;
    size_t n = control ? 0 : eo_utf8_size(source + at, length - at);
    if (used + (n ? n : 1) > (whole ? size - 1 : size - 4))
      break;
    if (n)
      memcpy(target + used, source + at, n);
    else
      target[used] = '?';
    used += n ? n : 1;
    at += n ? n : 1;
  }
  strcpy(target + used, at < length ? "..." : "");
}
