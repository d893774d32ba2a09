/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/zip_files.h"
#include "recording/source.h"

#include <archive.h>
#include <archive_entry.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* What an archive holds, by the names in it. */
struct contents {
  int files;
  bool workbook, opendocument, numpy;
  char name[EO_RECORDING_NAME * 2], list[160]; /* the last rig file; some names for people */
};

static enum eo_code damaged(struct eo_archive *archive)
{
  const char *why = archive_error_string(archive->handle);
  return eo_error_set(archive->error, EO_ERROR_INPUT, "", "The zip file cannot be read: %.120s.",
                      why ? why : "it is damaged");
}

enum eo_code eo_archive_visit(struct eo_archive *this_archive,
                              bool (*visit)(void *context, struct eo_archive *archive, const char *name), void *context)
{
  struct archive_entry *entry;
  enum eo_code code = EO_OK;
  this_archive->handle = archive_read_new();
  if (!this_archive->handle)
    return eo_error_memory(this_archive->error);
  archive_read_support_format_zip_seekable(this_archive->handle);
  if (archive_read_open_filename(this_archive->handle, this_archive->path, EO_ARCHIVE_PIECE) != ARCHIVE_OK)
    code = damaged(this_archive);
  for (bool more = true; !code && more;) {
    int state = archive_read_next_header(this_archive->handle, &entry);
    if (state == ARCHIVE_EOF)
      break;
    if (state != ARCHIVE_OK && state != ARCHIVE_WARN)
      code = damaged(this_archive);
    else if (archive_entry_filetype(entry) == AE_IFREG && archive_entry_pathname(entry)) {
      this_archive->error->code = EO_OK;
      more = visit(context, this_archive, archive_entry_pathname(entry));
      code = this_archive->error->code;
    }
  }
  archive_read_free(this_archive->handle);
  this_archive->handle = NULL;
  return code;
}

int64_t eo_archive_read(struct eo_archive *archive, void *bytes, size_t size)
{
  la_ssize_t got = archive_read_data(archive->handle, bytes, size);
  if (got < 0) {
    damaged(archive);
    return -1;
  }
  archive->taken += got;
  if (archive->taken > archive->limit ||
      (archive->taken > EO_SOURCE_FREE && archive->taken / EO_SOURCE_EXPANSION > archive->bytes)) {
    eo_error_set(archive->error, EO_ERROR_INPUT, "",
                 "The zip file grows to more than %lld MB; that is no table and no recording.",
                 (long long)(archive->taken >> 20));
    return -1;
  }
  return got;
}

/* Files that the makers of archives add by themselves. */
static bool is_by_the_way(const char *name)
{
  const char *base = strrchr(name, '/');
  base = base ? base + 1 : name;
  return *base == '.' || !strncmp(name, "__MACOSX/", 9) || !strcasecmp(base, "thumbs.db") ||
         !strcasecmp(base, "desktop.ini");
}

static bool look(void *context, struct eo_archive *archive, const char *name)
{
  struct contents *contents = context;
  size_t length = strlen(name);
  (void)archive;
  contents->workbook = contents->workbook || !strcmp(name, "xl/workbook.xml");
  contents->opendocument = contents->opendocument || !strcmp(name, "content.xml");
  if (is_by_the_way(name))
    return true;
  contents->numpy = contents->numpy || (length > 4 && !strcmp(name + length - 4, ".npy"));
  size_t used = strlen(contents->list);
  if (contents->files < 4)
    snprintf(contents->list + used, sizeof contents->list - used, "%s%.30s", used ? ", " : "", name);
  contents->files++;
  snprintf(contents->name, sizeof contents->name, "%s", name);
  return contents->files < 10000;
}

struct copy {
  const char *name;
  FILE *file;
};

static bool copy_file(void *context, struct eo_archive *archive, const char *name)
{
  const struct copy *copy = context;
  char *bytes = strcmp(name, copy->name) ? NULL : malloc(EO_ARCHIVE_PIECE);
  int64_t got = 1;
  if (!bytes)
    return true;
  while (got > 0 && (got = eo_archive_read(archive, bytes, EO_ARCHIVE_PIECE)) > 0)
    if (fwrite(bytes, 1, (size_t)got, copy->file) != (size_t)got) {
      eo_error_set(archive->error, EO_ERROR_FILE, "", "A temporary file could not be written: %s.", strerror(errno));
      got = -1;
    }
  free(bytes);
  return false;
}

static enum eo_code unpack(struct eo_archive *archive, FILE *file, char *name, size_t size)
{
  struct contents contents = {0};
  enum eo_code code = eo_archive_visit(archive, look, &contents);
  if (code)
    return code;
  if (contents.workbook)
    return eo_workbook_write(archive, file, name, size);
  if (contents.opendocument)
    return eo_opendocument_write(archive, file, name, size);
  if (contents.numpy)
    return eo_error_set(archive->error, EO_ERROR_INPUT, "",
                        "The file is a NumPy archive (.npz); save the arrays as text or .mat (numpy.savetxt, "
                        "scipy.io.savemat).");
  if (contents.files != 1)
    return eo_error_set(archive->error, EO_ERROR_INPUT, "",
                        "The zip file holds %d files (%s%s); upload the one with the recording, or zip it alone.",
                        contents.files, contents.list, contents.files > 4 ? ", ..." : "");
  snprintf(name, size, "%s", contents.name);
  struct copy copy = {contents.name, file};
  return eo_archive_visit(archive, copy_file, &copy);
}

enum eo_code eo_archive_unpack(const char *path, const struct eo_reader_options *options,
                               const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  struct stat state;
  struct eo_series series;
  char name[EO_RECORDING_NAME * 2] = "";
  FILE *file = fopen(options->unpack_to, "w");
  (void)notes;
  if (!file || stat(path, &state)) {
    if (file)
      fclose(file);
    return eo_error_set(error, EO_ERROR_FILE, "", "A temporary file could not be made in %.200s.", options->unpack_to);
  }
  struct eo_archive archive = {.path = path, .bytes = state.st_size, .limit = options->max_bytes, .error = error};
  enum eo_code code = unpack(&archive, file, name, sizeof name);
  if (fclose(file) && !code)
    code = eo_error_set(error, EO_ERROR_FILE, "", "A temporary file could not be written.");
  eo_series_init(&series, "", 0);
  snprintf(series.name, sizeof series.name, "%.63s", name);
  return code ? code : sink->begin(sink->context, &series, 1, error);
}
