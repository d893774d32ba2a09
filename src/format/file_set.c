/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/file_set.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct eo_file_set_file *next_file(struct eo_file_set *bundle)
{
  if (bundle->count == bundle->capacity) {
    int capacity = bundle->capacity ? 2 * bundle->capacity : 16;
    struct eo_file_set_file *file = realloc(bundle->file, (size_t)capacity * sizeof *file);
    if (!file)
      return NULL;
    bundle->file = file;
    bundle->capacity = capacity;
  }
  return &bundle->file[bundle->count];
}

struct eo_text *eo_file_set_add(struct eo_file_set *bundle, const char *format, ...)
{
  struct eo_file_set_file *file = bundle->failed ? NULL : next_file(bundle);
  char name[200];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(name, sizeof name, format, arguments);
  va_end(arguments);
  char *copy = file ? strdup(name) : NULL;
  if (!copy) {
    bundle->failed = true;
    return NULL;
  }
  *file = (struct eo_file_set_file){.name = copy};
  bundle->count++;
  return &file->text;
}

void eo_file_set_done(struct eo_file_set *bundle)
{
  for (int i = 0; i < bundle->count; i++) {
    free(bundle->file[i].name);
    eo_text_done(&bundle->file[i].text);
  }
  free(bundle->file);
  *bundle = (struct eo_file_set){0};
}

/* DIRECTORY/NAME, or with the ending of a file in the making. */
static char *path_of(const char *directory, const char *name, bool temporary)
{
  struct eo_text path = {0};
  eo_text_print(&path, "%s/%s", directory, name);
  if (temporary)
    eo_text_print(&path, ".%ld.part", (long)getpid());
  if (path.failed)
    eo_text_done(&path);
  return path.data;
}

static enum eo_code write_one(const struct eo_text *text, const char *temporary, struct eo_error *error)
{
  FILE *stream = fopen(temporary, "wbx");
  if (!stream)
    return eo_error_set(error, EO_ERROR_FILE, "", "%.100s cannot be written: %s.", temporary, strerror(errno));
  enum eo_code code = eo_text_write(text, stream, temporary, error);
  if (!code && fsync(fileno(stream)) != 0)
    code = eo_error_set(error, EO_ERROR_FILE, "", "%.100s cannot be written: %s.", temporary, strerror(errno));
  if (fclose(stream) != 0 && !code)
    code = eo_error_set(error, EO_ERROR_FILE, "", "%.100s cannot be written: %s.", temporary, strerror(errno));
  return code;
}

static enum eo_code write_all(const struct eo_file_set *bundle, const char *directory, int *written,
                              struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (*written = 0; *written < bundle->count && !code;) {
    char *temporary = path_of(directory, bundle->file[*written].name, true);
    code = temporary ? write_one(&bundle->file[*written].text, temporary, error) : eo_error_memory(error);
    ++*written;
    free(temporary);
  }
  return code;
}

static enum eo_code rename_all(const struct eo_file_set *bundle, const char *directory, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int i = 0; i < bundle->count && !code; i++) {
    char *temporary = path_of(directory, bundle->file[i].name, true),
         *final = path_of(directory, bundle->file[i].name, false);
    if (!temporary || !final)
      code = eo_error_memory(error);
    else if (rename(temporary, final) != 0)
      code = eo_error_set(error, EO_ERROR_FILE, "", "%.100s cannot be replaced: %s.", final, strerror(errno));
    free(temporary);
    free(final);
  }
  return code;
}

static void remove_temporaries(const struct eo_file_set *bundle, const char *directory, int written)
{
  for (int i = 0; i < written; i++) {
    char *temporary = path_of(directory, bundle->file[i].name, true);
    if (temporary)
      unlink(temporary);
    free(temporary);
  }
}

enum eo_code eo_file_set_save(const struct eo_file_set *bundle, const char *directory, struct eo_error *error)
{
  int written = 0;
  for (int i = 0; i < bundle->count; i++)
    if (bundle->failed || bundle->file[i].text.failed)
      return eo_error_memory(error);
  bool made = mkdir(directory, 0777) == 0;
  if (!made && errno != EEXIST)
    return eo_error_set(error, EO_ERROR_FILE, "", "The directory %.100s cannot be made: %s.", directory,
                        strerror(errno));
  enum eo_code code = write_all(bundle, directory, &written, error);
  if (!code)
    code = rename_all(bundle, directory, error);
  if (code) {
    remove_temporaries(bundle, directory, written);
    if (made)
      rmdir(directory);
  }
  return code;
}
