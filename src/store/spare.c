/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/spare.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "store/measurement_files.h"
#include "store/statement.h"

/* The journal of some deletions, and how much of it must be free before so much of the disk is set aside. */
enum { SPARE = 1 << 20, TIMES = 8 };

static bool name_spare(const struct eo_store *store, char path[EO_STORE_PATH])
{
  int length = snprintf(path, EO_STORE_PATH, "%s/easeoff.spare", store->directory);
  return length > 0 && length < EO_STORE_PATH;
}

int64_t eo_store_free_bytes(const struct eo_store *store)
{
  struct statvfs disk;
  return statvfs(store->directory, &disk) == 0 ? (int64_t)disk.f_bavail * (int64_t)disk.f_frsize : -1;
}

void eo_spare_keep(struct eo_store *store)
{
  char path[EO_STORE_PATH];
  struct stat status;
  if (!name_spare(store, path) || (stat(path, &status) == 0 && status.st_size >= SPARE) ||
      eo_store_free_bytes(store) < (int64_t)TIMES * SPARE)
    return;
  int file = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0)
    return;
  bool kept = posix_fallocate(file, 0, SPARE) == 0;
  close(file);
  if (!kept)
    unlink(path);
}

bool eo_spare_give(struct eo_store *store)
{
  char path[EO_STORE_PATH];
  struct stat status;
  return name_spare(store, path) && stat(path, &status) == 0 && status.st_size > 0 && unlink(path) == 0;
}

enum eo_code eo_store_probe(struct eo_store *store, struct eo_error *error)
{
  enum { PATIENCE = 100 };
  struct eo_statement statement = eo_statement_begin(store, "PRAGMA application_id", "");
  int64_t id = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  enum eo_code code = eo_statement_end(&statement, error);
  if (code)
    return code;
  char same[60];
  snprintf(same, sizeof same, "PRAGMA application_id = %lld", (long long)id);
  eo_store_wait(store, PATIENCE);
  int fault = sqlite3_exec(store->handle, same, NULL, NULL, NULL);
  return fault ? eo_store_fault(store, fault, error) : EO_OK;
}
