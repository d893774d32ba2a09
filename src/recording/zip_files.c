/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* memmem */
#include "recording/zip_files.h"
#include "recording/source.h"
#include "recording/tables.h"

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
  bool workbook, binary, opendocument, numpy;
  struct eo_series file[EO_TABLES]; /* names of rig files, the ends of long ones */
};

static enum eo_code damaged(struct eo_archive *archive)
{
  const char *why = archive_error_string(archive->handle);
  return eo_error_set(archive->error, EO_ERROR_INPUT, "", "The archive cannot be read: %.120s.",
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
  archive_read_support_format_tar(this_archive->handle);
  if (this_archive->flat)
    archive_read_support_format_raw(this_archive->handle);
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
                 "The archive grows to more than %lld MB; that is no table and no recording.",
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
  contents->workbook = contents->workbook || !strcmp(name, "xl/workbook.xml");
  contents->binary = contents->binary || !strcmp(name, "xl/workbook.bin");
  contents->opendocument = contents->opendocument || archive->flat || !strcmp(name, "content.xml");
  if (is_by_the_way(name))
    return true;
  contents->numpy = contents->numpy || (length > 4 && !strcmp(name + length - 4, ".npy"));
  if (contents->files < EO_TABLES) {
    size_t most = sizeof contents->file->name - 1;
    eo_series_init(&contents->file[contents->files], "", 0);
    snprintf(contents->file[contents->files].name, most + 1, "%s", name + (length > most ? length - most : 0));
  }
  contents->files++;
  return contents->files < 10000;
}

struct copy {
  int number; /* of the file among those that are not by the way */
  FILE *file;
};

static bool copy_file(void *context, struct eo_archive *archive, const char *name)
{
  struct copy *copy = context;
  if (is_by_the_way(name) || copy->number-- > 0)
    return true;
  char *bytes = malloc(EO_ARCHIVE_PIECE);
  int64_t got = 1;
  if (!bytes) {
    eo_error_memory(archive->error);
    return false;
  }
  while (got > 0 && (got = eo_archive_read(archive, bytes, EO_ARCHIVE_PIECE)) > 0)
    if (fwrite(bytes, 1, (size_t)got, copy->file) != (size_t)got) {
      eo_error_set(archive->error, EO_ERROR_FILE, "", "A temporary file could not be written: %s.", strerror(errno));
      got = -1;
    }
  free(bytes);
  return false;
}

/* One table of a spreadsheet, or one file of a zip; contents: names of all that could be asked for. */
static enum eo_code unpack(struct eo_archive *archive, int number, FILE *file, struct contents *contents)
{
  struct copy copy = {number, file};
  EO_TRY(eo_archive_visit(archive, look, contents));
  bool sheets = contents->workbook || contents->opendocument;
  if (contents->binary)
    return eo_error_set(archive->error, EO_ERROR_INPUT, "",
                        "The file is a binary Excel workbook (.xlsb); open it in a spreadsheet program and save it as "
                        ".xlsx or as text.");
  if (!sheets && contents->numpy)
    return eo_error_set(archive->error, EO_ERROR_INPUT, "",
                        "The file is a NumPy archive (.npz); save the arrays as text or .mat (numpy.savetxt, "
                        "scipy.io.savemat).");
  if (!sheets && (contents->files < 1 || contents->files > EO_TABLES))
    return eo_error_set(archive->error, EO_ERROR_INPUT, "",
                        "The archive holds %d files; pack those of one recording, %d at most.", contents->files,
                        EO_TABLES);
  if (!sheets)
    return eo_archive_visit(archive, copy_file, &copy);
  contents->files = 1;
  eo_series_init(&contents->file[0], "", 0);
  return contents->workbook
             ? eo_workbook_write(archive, file, contents->file[0].name, sizeof contents->file[0].name)
             : eo_opendocument_write(archive, file, contents->file[0].name, sizeof contents->file[0].name);
}

/* A flat OpenDocument spreadsheet (.fods) is the content of an .ods by itself. */
static bool is_xml(const char *path)
{
  char head[8] = "";
  FILE *file = fopen(path, "r");
  bool read = file && fread(head, 1, sizeof head, file) == sizeof head;
  if (file)
    fclose(file);
  return read && memmem(head, sizeof head, "<?xml", 5);
}

enum eo_code eo_archive_unpack(const char *path, const struct eo_reader_options *options,
                               const struct eo_series_sink *sink, struct eo_notes *notes, struct eo_error *error)
{
  struct stat state;
  struct contents *contents = calloc(1, sizeof *contents);
  FILE *file = contents ? fopen(options->unpack_to, "w") : NULL;
  if (!file || stat(path, &state)) {
    if (file)
      fclose(file);
    free(contents);
    return eo_error_set(error, EO_ERROR_FILE, "", "A temporary file could not be made in %.200s.", options->unpack_to);
  }
  struct eo_archive archive = {.path = path,
                               .bytes = state.st_size,
                               .limit = options->max_bytes,
                               .error = error,
                               .notes = notes,
                               .flat = is_xml(path),
                               .tables = true};
  enum eo_code code = unpack(&archive, options->unpack_number, file, contents);
  if (fclose(file) && !code)
    code = eo_error_set(error, EO_ERROR_FILE, "", "A temporary file could not be written.");
  if (!code)
    code = sink->begin(sink->context, contents->file, contents->files, error);
  free(contents);
  return code;
}
