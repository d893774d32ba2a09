/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An archive back into a data folder. It is unpacked beside, inside the folder, compared with its sums, and only then
   put where it belongs. */
#define _GNU_SOURCE /* nftw */
#include <archive.h>
#include <archive_entry.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "format/text.h"
#include "store/backup.h"
#include "store/designs.h"
#include "store/measurement_files.h"
#include "store/measurements.h"
#include "store/statement.h"

#define SUMS "SHA256SUMS"
enum { MOST_SUMS = 64 << 20, MOST_DESIGNS = 100000, DIGITS = 15 };

static enum eo_code fault(const char *path, struct eo_error *error)
{
  enum eo_code code = errno == ENOSPC || errno == EDQUOT ? EO_ERROR_FULL : EO_ERROR_FILE;
  return eo_error_set(error, code, "", "%.250s: %s.", path, strerror(errno));
}

static enum eo_code damaged(const char *path, const char *why, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_INPUT, "", "%.200s is no archive of easeoff, or damaged: %.120s.", path, why);
}

/* "measurements/7/0", "easeoff.db", "SHA256SUMS" and nothing else: no name of an archive leads elsewhere. */
static bool is_known(const char *name)
{
  if (strcmp(name, "easeoff.db") == 0 || strcmp(name, SUMS) == 0)
    return true;
  if (strncmp(name, "measurements/", 13) != 0)
    return false;
  size_t digits = strspn(name + 13, "0123456789");
  const char *rest = name + 13 + digits;
  return digits >= 1 && digits <= DIGITS && (strcmp(rest, "/0") == 0 || strcmp(rest, "/1") == 0);
}

static enum eo_code write_entry(struct archive *archive, const char *from, const char *path, struct eo_error *error)
{
  int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0)
    return fault(path, error);
  int state = archive_read_data_into_fd(archive, file);
  enum eo_code code = EO_OK;
  if (state != ARCHIVE_OK)
    code = archive_errno(archive) == ENOSPC ? (errno = ENOSPC, fault(path, error))
                                            : damaged(from, archive_error_string(archive), error);
  else if (fsync(file))
    code = fault(path, error);
  close(file);
  return code;
}

static enum eo_code unpack_entry(struct archive *archive, const char *from, const char *folder, const char *name,
                                 struct eo_error *error)
{
  char path[EO_STORE_PATH];
  if (!is_known(name))
    return damaged(from, "it holds files that do not belong there", error);
  snprintf(path, sizeof path, "%.3900s/%.100s", folder, name);
  for (char *slash = path + strlen(folder) + 1; (slash = strchr(slash, '/')); *slash++ = '/') {
    *slash = '\0';
    if (mkdir(path, 0777) && errno != EEXIST)
      return fault(path, error);
  }
  return write_entry(archive, from, path, error);
}

static enum eo_code unpack(const char *from, const char *folder, struct eo_error *error)
{
  enum { PIECE = 1 << 16 };
  struct archive *archive = archive_read_new();
  struct archive_entry *entry;
  enum eo_code code = archive ? EO_OK : eo_error_memory(error);
  if (code)
    return code;
  archive_read_support_filter_gzip(archive);
  archive_read_support_format_tar(archive);
  if (archive_read_open_filename(archive, from, PIECE) != ARCHIVE_OK)
    code = damaged(from, archive_error_string(archive), error);
  while (!code) {
    int state = archive_read_next_header(archive, &entry);
    if (state == ARCHIVE_EOF)
      break;
    if (state != ARCHIVE_OK || archive_entry_filetype(entry) != AE_IFREG)
      code = damaged(from, state == ARCHIVE_OK ? "it holds more than files" : archive_error_string(archive), error);
    else
      code = unpack_entry(archive, from, folder, archive_entry_pathname(entry), error);
  }
  archive_read_free(archive);
  return code;
}

/* Every line "SUM  NAME" is a file with that sum, and the database is among them. */
static enum eo_code compare_sums(const char *from, const char *folder, struct eo_error *error)
{
  char path[EO_STORE_PATH], sum[EO_HASH_LENGTH + 1];
  struct eo_text text = {0};
  bool database = false;
  snprintf(path, sizeof path, "%.4000s/" SUMS, folder);
  if (eo_text_read(&text, path, MOST_SUMS, NULL))
    return damaged(from, "it has no list of its files", error);
  enum eo_code code = EO_OK;
  char *line = text.data ? text.data : (char[]){""};
  while (*line && !code) {
    size_t length = strcspn(line, "\n");
    bool last = !line[length];
    line[length] = '\0';
    const char *name = length > EO_HASH_LENGTH + 2 ? line + EO_HASH_LENGTH + 2 : "";
    snprintf(path, sizeof path, "%.3900s/%.100s", folder, name);
    if (!is_known(name) || eo_measurement_file_hash(path, sum, NULL) || strncmp(sum, line, EO_HASH_LENGTH) != 0)
      code = damaged(from, "a file in it is not what was written", error);
    database = database || strcmp(name, "easeoff.db") == 0;
    line += length + !last;
  }
  eo_text_done(&text);
  return code || database ? code : damaged(from, "it has no database", error);
}

/* Moves what was unpacked into a folder that has no database. */
static enum eo_code put_whole(const char *directory, const char *folder, struct eo_error *error)
{
  char from[EO_STORE_PATH], to[EO_STORE_PATH];
  snprintf(from, sizeof from, "%.4000s/measurements", folder);
  snprintf(to, sizeof to, "%.4000s/measurements", directory);
  if (access(from, F_OK) == 0 && rename(from, to))
    return errno == ENOTEMPTY || errno == EEXIST
               ? eo_error_set(error, EO_ERROR_INPUT, "",
                              "%.200s holds recordings already, but there is no database next "
                              "to them: move that folder to another place.",
                              to)
               : fault(to, error);
  snprintf(from, sizeof from, "%.4000s/easeoff.db", folder);
  snprintf(to, sizeof to, "%.4000s/easeoff.db", directory);
  return rename(from, to) ? fault(to, error) : EO_OK;
}

/* Both stores while one is added to the other. */
struct merging {
  struct eo_store *from, *to;
  int64_t design; /* number there of the design in hand */
  struct eo_backup_report *report;
};

/* The design with this name and text; 0: there is none. */
static enum eo_code find_same(struct eo_store *store, const struct eo_stored_design *design, int64_t *id,
                              struct eo_error *error)
{
  struct eo_statement statement =
      eo_statement_begin(store, "SELECT id FROM design WHERE name = ? AND document = ? ORDER BY id LIMIT 1", "tt",
                         design->name, design->document);
  *id = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  return eo_statement_end(&statement, error);
}

static enum eo_code take_id(void *context, const struct eo_stored_design *design, struct eo_error *error)
{
  (void)error;
  *(int64_t *)context = design->id;
  return EO_OK;
}

static enum eo_code add_recording(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  struct merging *merging = context;
  struct eo_stored_measurement own = *row;
  char folder[EO_STORE_PATH], digest[EO_HASH_LENGTH + 1];
  enum eo_measurement_outcome outcome;
  struct eo_hash hash;
  if (own.design != merging->design) { /* the digest says of which design: another one has another */
    eo_hash_init(&hash);
    eo_hash_add_text(&hash, "restored", row->digest);
    eo_hash_add_number(&hash, "design", (double)merging->design);
    eo_hash_finish(&hash, digest);
    own.digest = digest;
    own.design = merging->design;
  }
  if (!eo_measurement_folder_path(merging->from, "", row->id, folder, sizeof folder))
    return eo_error_set(error, EO_ERROR_FILE, "", "The path of the data folder is too long.");
  EO_TRY(eo_store_add_measurement(merging->to, &own, folder, NULL, NULL, &outcome, error));
  merging->report->recordings += outcome == EO_MEASUREMENT_DONE;
  merging->report->known += outcome == EO_MEASUREMENT_KNOWN;
  return EO_OK;
}

struct one {
  struct merging *merging;
  int64_t id;
};

static enum eo_code see_recording(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  struct one *one = context;
  enum eo_measurement_outcome outcome;
  one->id = row->id;
  return eo_store_find_measurement(one->merging->from, row->id, add_recording, one->merging, &outcome, error);
}

static enum eo_code add_recordings(struct merging *merging, int64_t design, struct eo_error *error)
{
  struct one one = {.merging = merging};
  enum eo_code code = EO_OK;
  for (int64_t before = 0; !code; before = one.id) {
    one.id = 0;
    code = eo_store_list_measurements(merging->from, design, before, 1, see_recording, &one, error);
    if (!one.id)
      break;
  }
  return code;
}

static enum eo_code add_design(void *context, const struct eo_stored_design *design, struct eo_error *error)
{
  struct merging *merging = context;
  enum eo_design_outcome outcome;
  EO_TRY(find_same(merging->to, design, &merging->design, error));
  merging->report->known += merging->design != 0;
  if (merging->design)
    return EO_OK;
  EO_TRY(eo_store_add_design(merging->to, design->name, design->document, MOST_DESIGNS, take_id, &merging->design,
                             &outcome, error));
  merging->report->designs += outcome == EO_DESIGN_DONE;
  return outcome == EO_DESIGN_DONE
             ? EO_OK
             : eo_error_set(error, EO_ERROR_FULL, "", "%d designs are stored already.", MOST_DESIGNS);
}

static enum eo_code merge_all(struct merging *merging, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(merging->from, "SELECT coalesce(max(id), 0) FROM design", "");
  int64_t last = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  enum eo_code code = eo_statement_end(&statement, error);
  for (int64_t id = 1; id <= last && !code; id++) {
    enum eo_design_outcome outcome;
    code = eo_store_find_design(merging->from, id, add_design, merging, &outcome, error);
    if (!code && outcome == EO_DESIGN_DONE)
      code = add_recordings(merging, id, error);
  }
  return code;
}

static enum eo_code merge(const char *directory, const char *folder, struct eo_backup_report *report,
                          struct eo_error *error)
{
  struct merging merging = {.report = report};
  enum eo_code code = eo_store_open(&merging.from, folder, EO_STORE_WRITE, error);
  if (!code)
    code = eo_store_open(&merging.to, directory, EO_STORE_WRITE, error);
  if (!code)
    code = merge_all(&merging, error);
  eo_store_close(merging.from);
  eo_store_close(merging.to);
  return code;
}

static enum eo_code count_whole(const char *directory, struct eo_backup_report *report, struct eo_error *error)
{
  struct eo_store *store = NULL;
  EO_TRY(eo_store_open(&store, directory, EO_STORE_WRITE, error));
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT (SELECT count(*) FROM design), (SELECT count(*) FROM measurement), (SELECT count(*) FROM job)",
      "");
  if (eo_statement_step(&statement)) {
    report->designs = eo_column_integer(&statement, 0);
    report->recordings = eo_column_integer(&statement, 1);
    report->jobs = eo_column_integer(&statement, 2);
  }
  enum eo_code code = eo_statement_end(&statement, error);
  eo_store_close(store);
  return code;
}

static enum eo_code put(const char *directory, const char *path, const char *folder, struct eo_backup_report *report,
                        struct eo_error *error)
{
  char database[EO_STORE_PATH];
  EO_TRY(unpack(path, folder, error));
  EO_TRY(compare_sums(path, folder, error));
  snprintf(database, sizeof database, "%.4000s/easeoff.db", directory);
  report->whole = access(database, F_OK) != 0;
  if (!report->whole)
    return merge(directory, folder, report, error);
  EO_TRY(put_whole(directory, folder, error));
  return count_whole(directory, report, error);
}

/* What was unpacked into a folder of our own. */
static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *place)
{
  (void)status, (void)type, (void)place;
  return remove(path);
}

enum eo_code eo_backup_restore(const char *directory, const char *path, struct eo_backup_report *report,
                               struct eo_error *error)
{
  enum { DESCRIPTORS = 8 };
  struct eo_text folder = {0};
  *report = (struct eo_backup_report){0};
  if (access(path, R_OK))
    return eo_error_set(error, EO_ERROR_INPUT, "", "%.250s: %s.", path, strerror(errno));
  if (mkdir(directory, 0777) && errno != EEXIST)
    return fault(directory, error);
  eo_text_print(&folder, "%s/restore-XXXXXX", directory);
  enum eo_code code = folder.failed ? eo_error_memory(error) : EO_OK;
  if (!code && !mkdtemp(folder.data))
    code = fault(directory, error);
  if (!code) {
    code = put(directory, path, folder.data, report, error);
    nftw(folder.data, remove_entry, DESCRIPTORS, FTW_DEPTH | FTW_PHYS);
  }
  eo_text_done(&folder);
  return code;
}
