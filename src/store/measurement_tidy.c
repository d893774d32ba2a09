/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a start does about folders in DATA/measurements that do not stand as they should. Recordings are the one thing
   that cannot be computed again, so nothing is removed here but unfinished uploads and what somebody asked to have
   deleted; recordings without a row are set aside, and what is not ours is left where it is. */
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "store/measurement_files.h"
#include "store/measurements.h"
#include "store/statement.h"

#define ASIDE "lost+found"

enum { MOST_DIGITS = 15 };   /* of a recording's number: a double in JSON still tells it from the next one */
enum { MOST_COPIES = 1000 }; /* of one number that are set aside */

enum kind {
  KIND_OTHER, /* not ours */
  KIND_RECORDING,
  KIND_DELETED,
  KIND_INCOMING,
};

struct entry {
  enum kind kind;
  int64_t id; /* of a recording, present or deleted */
  char path[EO_STORE_PATH];
};

static bool name_path(char *path, const char *folder, const char *name)
{
  int length = snprintf(path, EO_STORE_PATH, "%s/%s", folder, name);
  return length >= 0 && length < EO_STORE_PATH;
}

static enum eo_code fault(const char *path, struct eo_error *error)
{
  return eo_error_set(error, EO_ERROR_FILE, "", "%.250s: %s.", path, strerror(errno));
}

/* The number of a recording at the beginning of a name, as we write it; 0: there is none. */
static int64_t read_number(const char *name, const char **end)
{
  size_t digits = strspn(name, "0123456789");
  *end = name + digits;
  return digits && digits <= MOST_DIGITS && *name != '0' ? strtoll(name, NULL, 10) : 0;
}

static bool is_a(const char *path, mode_t type)
{
  struct stat status;
  return lstat(path, &status) == 0 && (status.st_mode & S_IFMT) == type;
}

static bool holds_recording(const char *path)
{
  char file[EO_STORE_PATH];
  return name_path(file, path, "0") && is_a(file, S_IFREG);
}

/* Nothing but files of ours, or nothing at all: what may be removed. */
static bool holds_nothing_else(const char *path)
{
  DIR *folder = opendir(path);
  const struct dirent *entry;
  bool only = folder != NULL;
  while (only && (entry = readdir(folder)))
    only = eo_measurement_file_is_ours(entry->d_name) || strcmp(entry->d_name, ".") == 0 ||
           strcmp(entry->d_name, "..") == 0;
  if (folder)
    closedir(folder);
  return only;
}

static struct entry classify(const char *root, const char *name)
{
  static const size_t deleted = sizeof EO_MEASUREMENT_DELETED - 1, incoming = sizeof EO_MEASUREMENT_INCOMING - 1;
  struct entry entry = {.kind = KIND_OTHER};
  bool marked = strncmp(name, EO_MEASUREMENT_DELETED, deleted) == 0;
  const char *end;
  if (!name_path(entry.path, root, name) || !is_a(entry.path, S_IFDIR))
    return entry;
  entry.id = read_number(name + (marked ? deleted : 0), &end);
  if (entry.id && !*end && marked)
    entry.kind = KIND_DELETED;
  else if (entry.id && !*end && holds_recording(entry.path))
    entry.kind = KIND_RECORDING;
  else if (strncmp(name, EO_MEASUREMENT_INCOMING, incoming) == 0 && strlen(name + incoming) == EO_MEASUREMENT_LETTERS)
    entry.kind = KIND_INCOMING;
  return entry;
}

static enum eo_code has_row(struct eo_store *store, int64_t id, bool *there, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "SELECT 1 FROM measurement WHERE id = ?", "i", id);
  *there = eo_statement_step(&statement);
  return eo_statement_end(&statement, error);
}

/* DATA/measurements/lost+found/NAME, or NAME-2, NAME-3, ... when that is taken. A folder renamed onto one that holds
   anything stays where it is, so nothing can be overwritten even by somebody who comes between. */
static enum eo_code set_aside(const char *root, const char *name, const char *path, struct eo_error *error)
{
  char aside[EO_STORE_PATH], target[EO_STORE_PATH], numbered[NAME_MAX + 16];
  if (!name_path(aside, root, ASIDE))
    return eo_error_set(error, EO_ERROR_FILE, "", "The path of the data folder is too long.");
  if (mkdir(aside, 0777) && errno != EEXIST)
    return fault(aside, error);
  errno = EEXIST;
  for (int copy = 1; copy <= MOST_COPIES; copy++) {
    struct stat status;
    snprintf(numbered, sizeof numbered, copy > 1 ? "%s-%d" : "%s", name, copy);
    if (!name_path(target, aside, numbered) || lstat(target, &status) == 0)
      continue;
    return rename(path, target) ? fault(target, error) : EO_OK;
  }
  return fault(aside, error);
}

/* A deletion that ended half-way. Without a row it is finished; with one it was never done, and is undone. */
static enum eo_code settle_deleted(struct eo_store *store, const char *root, const char *name,
                                   const struct entry *entry, bool row, int *aside, struct eo_error *error)
{
  if (!row) {
    if (holds_nothing_else(entry->path))
      eo_measurement_folder_remove(entry->path);
    return EO_OK;
  }
  if (!eo_measurement_folder_is_there(store, entry->id))
    return eo_measurement_folder_mark(store, entry->id, false, error);
  ++*aside;
  return set_aside(root, name, entry->path, error);
}

static enum eo_code settle(struct eo_store *store, const char *root, const char *name, int *aside,
                           struct eo_error *error)
{
  struct entry entry = classify(root, name);
  bool row = false;
  enum eo_code code = EO_OK;
  if (entry.kind == KIND_INCOMING && holds_nothing_else(entry.path))
    eo_measurement_folder_remove(entry.path);
  if (entry.kind == KIND_RECORDING || entry.kind == KIND_DELETED)
    code = has_row(store, entry.id, &row, error);
  if (!code && entry.kind == KIND_DELETED)
    code = settle_deleted(store, root, name, &entry, row, aside, error);
  if (code || entry.kind != KIND_RECORDING || row)
    return code;
  ++*aside;
  return set_aside(root, name, entry.path, error);
}

/* Every recording belongs to a design, and numbers are never forgotten: a database that never had a design cannot be
   the one that these recordings came with. */
static enum eo_code expect_own_database(struct eo_store *store, const char *root, int recordings,
                                        struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(
      store, "SELECT 1 FROM sqlite_sequence WHERE name IN ('design', 'measurement') AND seq > 0 LIMIT 1", "");
  bool used = eo_statement_step(&statement);
  enum eo_code code = eo_statement_end(&statement, error);
  if (code || used || !recordings)
    return code;
  return eo_error_set(error, EO_ERROR_FILE, "",
                      "%.150s holds %d recording%s, but the database next to it is new and knows none: put the "
                      "easeoff.db that belongs to them back, or move that folder to another place.",
                      root, recordings, recordings == 1 ? "" : "s");
}

static int count_recordings(const char *root, struct dirent *const *names, int count)
{
  int recordings = 0;
  for (int i = 0; i < count; i++)
    recordings += classify(root, names[i]->d_name).kind == KIND_RECORDING;
  return recordings;
}

enum eo_code eo_measurement_folder_tidy(struct eo_store *store, int *aside, struct eo_error *error)
{
  char root[EO_STORE_PATH];
  struct dirent **names;
  *aside = 0;
  if (!name_path(root, store->directory, "measurements"))
    return eo_error_set(error, EO_ERROR_FILE, "", "The path of the data folder is too long.");
  int count = scandir(root, &names, NULL, alphasort);
  if (count < 0)
    return errno == ENOENT ? EO_OK : fault(root, error);
  enum eo_code code = expect_own_database(store, root, count_recordings(root, names, count), error);
  for (int i = 0; i < count; i++) {
    if (!code)
      code = settle(store, root, names[i]->d_name, aside, error);
    free(names[i]);
  }
  free(names);
  return code;
}

/* Of an entry here, or of one that was set aside ("7", "7-2", "deleted-7"). */
static int64_t number_of(const char *root, const char *name, bool aside)
{
  const char *end;
  if (!aside) {
    const struct entry entry = classify(root, name);
    return entry.kind == KIND_RECORDING || entry.kind == KIND_DELETED ? entry.id : 0;
  }
  if (strncmp(name, EO_MEASUREMENT_DELETED, sizeof EO_MEASUREMENT_DELETED - 1) == 0)
    name += sizeof EO_MEASUREMENT_DELETED - 1;
  int64_t id = read_number(name, &end);
  return !*end || *end == '-' ? id : 0;
}

/* A folder that is not there or not ours to read has no number of ours. */
static void find_highest(const char *root, bool aside, int64_t *highest)
{
  DIR *folder = opendir(root);
  const struct dirent *entry;
  while (folder && (entry = readdir(folder))) {
    int64_t id = number_of(root, entry->d_name, aside);
    *highest = id > *highest ? id : *highest;
  }
  if (folder)
    closedir(folder);
}

int64_t eo_measurement_folder_highest(const struct eo_store *store)
{
  char root[EO_STORE_PATH], aside[EO_STORE_PATH];
  int64_t highest = 0;
  if (!name_path(root, store->directory, "measurements") || !name_path(aside, root, ASIDE))
    return 0;
  find_highest(root, false, &highest);
  find_highest(aside, true, &highest);
  return highest;
}
