/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/backup.h"

#include <archive.h>
#include <archive_entry.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "format/text.h"
#include "store/measurement_files.h"
#include "store/measurements.h"
#include "store/statement.h"

enum { BLOCK = 1 << 16, MODE = 0644 };

/* An archive while it is written. */
struct writing {
  struct eo_store *store, *copy; /* the folder's; the copy that goes into the archive */
  struct archive *archive;
  struct eo_text sums;
  struct eo_backup_report *report;
};

static enum eo_code fault(const char *path, struct eo_error *error)
{
  enum eo_code code = errno == ENOSPC || errno == EDQUOT ? EO_ERROR_FULL : EO_ERROR_FILE;
  return eo_error_set(error, code, "", "%.250s: %s.", path, strerror(errno));
}

static enum eo_code archive_fault(struct archive *archive, struct eo_error *error)
{
  const char *what = archive_error_string(archive);
  return eo_error_set(error, archive_errno(archive) == ENOSPC ? EO_ERROR_FULL : EO_ERROR_FILE, "",
                      "The archive cannot be written: %.150s.", what ? what : "no reason is known");
}

static enum eo_code add_entry(struct writing *writing, const char *name, int64_t size, struct eo_error *error)
{
  struct archive_entry *entry = archive_entry_new();
  if (!entry)
    return eo_error_memory(error);
  archive_entry_set_pathname(entry, name);
  archive_entry_set_size(entry, size);
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_entry_set_perm(entry, MODE);
  enum eo_code code = archive_write_header(writing->archive, entry) == ARCHIVE_OK
                          ? EO_OK
                          : archive_fault(writing->archive, error);
  archive_entry_free(entry);
  return code;
}

/* The file's bytes into the archive; sum: what they are. */
static enum eo_code add_bytes(struct writing *writing, int file, const char *path, char sum[EO_HASH_LENGTH + 1],
                              struct eo_error *error)
{
  unsigned char *block = malloc(BLOCK);
  struct eo_hash hash;
  ssize_t got = 0;
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  eo_hash_init(&hash);
  while (!code && (got = read(file, block, BLOCK)) > 0) {
    eo_hash_add(&hash, block, (size_t)got);
    if (archive_write_data(writing->archive, block, (size_t)got) != got)
      code = archive_fault(writing->archive, error);
  }
  if (!code && got < 0)
    code = fault(path, error);
  eo_hash_finish(&hash, sum);
  free(block);
  return code;
}

static enum eo_code add_file(struct writing *writing, const char *path, const char *name, struct eo_error *error)
{
  char sum[EO_HASH_LENGTH + 1];
  struct stat status;
  int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0 || fstat(file, &status))
    return fault(path, error);
  enum eo_code code = add_entry(writing, name, status.st_size, error);
  if (!code)
    code = add_bytes(writing, file, path, sum, error);
  close(file);
  if (!code)
    eo_text_print(&writing->sums, "%s  %s\n", sum, name);
  return code;
}

static void note_missing(struct writing *writing, int64_t id, const char *what)
{
  if (!writing->report->missing++)
    snprintf(writing->report->first, sizeof writing->report->first, "Recording %lld %s.", (long long)id, what);
}

static bool is_whole(const struct writing *writing, const struct eo_stored_measurement *row)
{
  char path[EO_STORE_PATH], sum[EO_HASH_LENGTH + 1];
  for (int i = 0; i < row->files; i++)
    if (!eo_measurement_file_path(writing->store, row->id, i, path, sizeof path) ||
        eo_measurement_file_hash(path, sum, NULL) || strcmp(sum, row->file[i].sha256) != 0)
      return false;
  return true;
}

static enum eo_code take_out(struct writing *writing, int64_t id, struct eo_error *error)
{
  return EO_STATEMENT_RUN(writing->copy, error, "DELETE FROM measurement WHERE id = ?", "i", id);
}

/* One that was deleted since the copy was made is left out of it. */
static enum eo_code add_recording(struct writing *writing, const struct eo_stored_measurement *row,
                                  struct eo_error *error)
{
  char path[EO_STORE_PATH], name[80];
  enum eo_measurement_outcome outcome;
  EO_TRY(eo_store_find_measurement(writing->store, row->id, NULL, NULL, &outcome, error));
  if (outcome == EO_MEASUREMENT_MISSING)
    return take_out(writing, row->id, error);
  if (!is_whole(writing, row)) {
    note_missing(writing, row->id, "is not what was uploaded, or its files are not there");
    return take_out(writing, row->id, error);
  }
  enum eo_code code = EO_OK;
  for (int i = 0; i < row->files && !code; i++) {
    eo_measurement_file_path(writing->store, row->id, i, path, sizeof path);
    snprintf(name, sizeof name, "measurements/%lld/%d", (long long)row->id, i);
    code = add_file(writing, path, name, error);
  }
  writing->report->recordings += !code;
  return code;
}

static enum eo_code copy_row(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  (void)error;
  *(struct eo_stored_measurement *)context = *row; /* its texts are not used */
  return EO_OK;
}

/* Newest first, one at a time: rows may go meanwhile. */
static enum eo_code add_recordings(struct writing *writing, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int64_t before = 0; !code;) {
    struct eo_stored_measurement row = {.id = 0};
    code = eo_store_list_measurements(writing->copy, 0, before, 1, copy_row, &row, error);
    if (!row.id)
      break;
    before = row.id;
    if (!code)
      code = add_recording(writing, &row, error);
  }
  return code;
}

static enum eo_code count(struct eo_store *store, const char *sql, int64_t *value, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, sql, "");
  *value = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  return eo_statement_end(&statement, error);
}

/* Everything but one design and what belongs to it. */
static enum eo_code keep_one(struct eo_store *copy, int64_t design, struct eo_error *error)
{
  static const char *const others[] = {
      "DELETE FROM measurement WHERE design <> ?",
      "DELETE FROM design WHERE id <> ?",
      "DELETE FROM job WHERE ? > 0",
      "DELETE FROM problem WHERE ? > 0",
  };
  enum eo_code code = EO_OK;
  for (size_t i = 0; i < sizeof others / sizeof others[0] && !code; i++)
    code = eo_statement_finish(eo_statement_begin(copy, others[i], "i", design), error);
  int64_t left = 0;
  if (!code)
    code = count(copy, "SELECT count(*) FROM design", &left, error);
  return code || left ? code : eo_error_set(error, EO_ERROR_INPUT, "", "There is no design %lld.", (long long)design);
}

static enum eo_code add_all(struct writing *writing, const char *copied, int64_t design, struct eo_error *error)
{
  char database[EO_STORE_PATH];
  snprintf(database, sizeof database, "%.4000s/easeoff.db", copied);
  EO_TRY(eo_store_copy(writing->store, database, error));
  EO_TRY(eo_store_open(&writing->copy, copied, EO_STORE_WRITE, error));
  if (design)
    EO_TRY(keep_one(writing->copy, design, error));
  EO_TRY(add_recordings(writing, error));
  EO_TRY(count(writing->copy, "SELECT count(*) FROM design", &writing->report->designs, error));
  EO_TRY(count(writing->copy, "SELECT count(*) FROM job", &writing->report->jobs, error));
  EO_TRY(eo_store_compact(writing->copy, error));
  eo_store_close(writing->copy);
  writing->copy = NULL;
  EO_TRY(add_file(writing, database, "easeoff.db", error));
  if (writing->sums.failed)
    return eo_error_memory(error);
  EO_TRY(add_entry(writing, "SHA256SUMS", (int64_t)writing->sums.size, error));
  return archive_write_data(writing->archive, writing->sums.data, writing->sums.size) == (la_ssize_t)writing->sums.size
             ? EO_OK
             : archive_fault(writing->archive, error);
}

static enum eo_code open_archive(struct writing *writing, const char *path, struct eo_error *error)
{
  writing->archive = archive_write_new();
  if (!writing->archive)
    return eo_error_memory(error);
  archive_write_add_filter_gzip(writing->archive);
  archive_write_set_format_pax_restricted(writing->archive);
  return archive_write_open_filename(writing->archive, path) == ARCHIVE_OK ? EO_OK
                                                                           : archive_fault(writing->archive, error);
}

static enum eo_code bring_to_disk(const char *path, struct eo_error *error)
{
  int file = open(path, O_RDONLY | O_CLOEXEC);
  enum eo_code code = file >= 0 && fsync(file) == 0 ? EO_OK : fault(path, error);
  if (file >= 0)
    close(file);
  return code;
}

static enum eo_code fill_archive(struct writing *writing, const char *copied, const char *part, int64_t design,
                                 struct eo_error *error)
{
  EO_TRY(open_archive(writing, part, error));
  EO_TRY(add_all(writing, copied, design, error));
  return archive_write_close(writing->archive) == ARCHIVE_OK ? EO_OK : archive_fault(writing->archive, error);
}

/* Complete beside its place, then there: nobody takes half of it for a backup. */
static enum eo_code write_archive(struct writing *writing, const char *path, const char *part, const char *copied,
                                  int64_t design, struct eo_error *error)
{
  enum eo_code code = fill_archive(writing, copied, part, design, error);
  archive_write_free(writing->archive);
  eo_store_close(writing->copy);
  if (!code)
    code = bring_to_disk(part, error);
  if (!code && link(part, path)) /* fails where there is a file already */
    code = fault(path, error);
  unlink(part);
  return code;
}

static void remove_copy(const char *folder)
{
  static const char *const names[] = {"easeoff.db", "easeoff.db-wal", "easeoff.db-shm", "easeoff.lock"};
  char path[EO_STORE_PATH];
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    snprintf(path, sizeof path, "%.4000s/%s", folder, names[i]);
    unlink(path);
  }
  rmdir(folder);
}

enum eo_code eo_backup_write(struct eo_store *store, const char *path, int64_t design, struct eo_backup_report *report,
                             struct eo_error *error)
{
  struct writing writing = {.store = store, .report = report};
  struct eo_text part = {0}, copied = {0};
  *report = (struct eo_backup_report){.whole = !design};
  if (access(path, F_OK) == 0)
    return eo_error_set(error, EO_ERROR_INPUT, "", "%.250s is there already.", path);
  eo_text_print(&part, "%s.part-%d", path, (int)getpid());
  eo_text_print(&copied, "%s.copy-XXXXXX", path);
  enum eo_code code = part.failed || copied.failed ? eo_error_memory(error) : EO_OK;
  if (!code && !mkdtemp(copied.data))
    code = fault(path, error);
  if (!code) {
    code = write_archive(&writing, path, part.data, copied.data, design, error);
    remove_copy(copied.data);
  }
  eo_text_done(&writing.sums);
  eo_text_done(&part);
  eo_text_done(&copied);
  return code;
}
