/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any bytes as an archive that shall be restored: what is no archive is refused, and nothing is written outside the
   folder, nor stays in it. For libFuzzer, and replayed by replay.c. */
#define _GNU_SOURCE /* nftw */
#include "fuzz/fuzz.h"
#include "store/backup.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[200], data[220], archive[220];

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *place)
{
  (void)status, (void)type, (void)place;
  return remove(path);
}

static void clean(void)
{
  nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static int leftovers;

static int count_entry(const char *path, const struct stat *status, int type, struct FTW *place)
{
  (void)status, (void)type, (void)place;
  leftovers += strstr(path, "/restore-") != NULL;
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
  struct eo_backup_report report;
  struct eo_error error = {0};
  if (!*folder) {
    snprintf(folder, sizeof folder, "%s/easeoff-fuzz-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
    if (!mkdtemp(folder))
      abort();
    atexit(clean);
    snprintf(data, sizeof data, "%s/data", folder);
    snprintf(archive, sizeof archive, "%s/archive", folder);
  }
  FILE *file = fopen(archive, "wb");
  if (!file || fwrite(bytes, 1, size, file) != size)
    abort();
  fclose(file);
  if (eo_backup_restore(data, archive, &report, &error) && !*error.text)
    abort();
  leftovers = 0;
  nftw(folder, count_entry, 16, FTW_PHYS);
  if (leftovers)
    abort();
  nftw(data, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
  return 0;
}
