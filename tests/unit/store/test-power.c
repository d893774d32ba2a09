/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A power failure at the worst moment: whatever was written and not yet brought to the disk (fsync) is undone, then the
   folder is opened as the next start finds it. What was promised to somebody is there: designs, orders, measurements.
   The calls of SQLite to the system go through here: writes as it offers it, fsync() and fdatasync() in the place of
   the library's. Nothing reaches the disk that the folder is on, so that the test is fast. */
#define _GNU_SOURCE /* nftw */
#include "store/designs.h"
#include "store/evaluations.h"
#include "store/measurements.h"
#include "store/queue.h"
#include "support/tap.h"

#include <dirent.h>
#include <fcntl.h>
#include <ftw.h>
#include <sqlite3.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct eo_error error;
static char folder[200], after[220];

enum { PATH = 400, MOST = 20000 };

/* A write that is not on the disk yet, and what stood there before. */
static struct change {
  char path[PATH];
  off_t at, size_before;
  size_t size; /* 0: the file was cut */
  char *old;
} change[MOST];
static int changes;

static bool name_of(int file, char path[PATH])
{
  char name[64];
  snprintf(name, sizeof name, "/proc/self/fd/%d", file);
  ssize_t length = readlink(name, path, PATH - 1);
  path[length > 0 ? length : 0] = '\0';
  return strncmp(path, folder, strlen(folder)) == 0;
}

static void note(int file, off_t at, size_t size)
{
  struct stat status;
  struct change *c = &change[changes];
  if (changes == MOST || !name_of(file, c->path) || fstat(file, &status))
    return;
  c->at = at;
  c->size = size;
  c->size_before = status.st_size;
  c->old = calloc(size + 1, 1);
  if (size && pread(file, c->old, size, at) < 0)
    printf("# what stood there cannot be read\n");
  changes++;
}

static ssize_t write_at(int file, const void *bytes, size_t size, off_t at)
{
  note(file, at, size);
  return pwrite(file, bytes, size, at);
}

static int cut(int file, off_t size)
{
  struct stat status;
  if (fstat(file, &status) == 0 && size < status.st_size)
    note(file, size, (size_t)(status.st_size - size));
  return ftruncate(file, size);
}

static int bring_to_disk(int file)
{
  char path[PATH];
  int kept = 0;
  name_of(file, path);
  for (int i = 0; i < changes; i++)
    if (strcmp(change[i].path, path) == 0)
      free(change[i].old);
    else
      change[kept++] = change[i];
  changes = kept;
  return 0;
}

int fsync(int file)
{
  return bring_to_disk(file);
}

int fdatasync(int file)
{
  return bring_to_disk(file);
}

static void watch(void)
{
  sqlite3_vfs *vfs = sqlite3_vfs_find(NULL);
  vfs->xSetSystemCall(vfs, "pwrite", (sqlite3_syscall_ptr)write_at);
  vfs->xSetSystemCall(vfs, "pwrite64", (sqlite3_syscall_ptr)write_at);
  vfs->xSetSystemCall(vfs, "ftruncate", (sqlite3_syscall_ptr)cut);
}

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *place)
{
  (void)status, (void)type, (void)place;
  return remove(path);
}

static void copy_file(const char *from, const char *to)
{
  static char block[1 << 16];
  int input = open(from, O_RDONLY | O_CLOEXEC), output = open(to, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  ssize_t size;
  while ((size = read(input, block, sizeof block)) > 0)
    if (write(output, block, (size_t)size) != size)
      printf("# %s cannot be written\n", to);
  close(input);
  close(output);
}

/* The folder as the disk has it, opened; the store that is open goes on beside it. */
static struct eo_store *power_off(void)
{
  struct eo_store *store = NULL;
  char from[PATH * 2], to[PATH * 2];
  DIR *entries = opendir(folder);
  const struct dirent *entry;
  snprintf(after, sizeof after, "%s-after", folder);
  nftw(after, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
  mkdir(after, 0777);
  while (entries && (entry = readdir(entries)))
    if (strncmp(entry->d_name, "easeoff.db", 10) == 0 && !strstr(entry->d_name, "-shm")) {
      snprintf(from, sizeof from, "%s/%.100s", folder, entry->d_name);
      snprintf(to, sizeof to, "%s/%.100s", after, entry->d_name);
      copy_file(from, to);
    }
  if (entries)
    closedir(entries);
  for (int i = changes - 1; i >= 0; i--) {
    snprintf(to, sizeof to, "%s%s", after, change[i].path + strlen(folder));
    int file = open(to, O_WRONLY | O_CLOEXEC);
    if (file >= 0 && change[i].size && pwrite(file, change[i].old, change[i].size, change[i].at) < 0)
      printf("# %s cannot be undone\n", to);
    if (file >= 0 && ftruncate(file, change[i].size_before) != 0)
      printf("# %s cannot be cut\n", to);
    close(file);
  }
  return eo_store_open(&store, after, EO_STORE_WRITE, &error) ? NULL : store;
}

static const char hash[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

static int64_t count_evaluated(struct eo_store *store)
{
  int64_t last = 0;
  return store && !eo_store_last_evaluation(store, &last, &error) ? last : -1;
}

/* In the usual mode the last rows may be gone: that the failure is one. */
static void test_usual(struct eo_store *store)
{
  struct eo_objective_case raw = {.peak_to_peak = 1, .impact = 1, .rms = 1};
  const struct eo_stored_problem problem = {
      .hash = hash, .spec = "{}", .name = "", .evaluator = 1, .scenarios = 1, .cases = 1};
  struct eo_stored_evaluation row = {.scenarios = 1, .cases = 1, .raw = &raw, .modification = "{}"};
  int64_t id = 0;
  ok(!eo_store_find_problem(store, &problem, &id, &error), "a problem is stored");
  ok(!eo_store_add_evaluation(store, id, &row, &error) && count_evaluated(store) == 1, "an evaluation is stored");
  struct eo_store *other = power_off();
  ok(other && count_evaluated(other) == 0, "an evaluation may be gone after a power failure, and then whole");
  eo_store_close(other);
}

static bool has_design(struct eo_store *store, int64_t id)
{
  enum eo_design_outcome outcome;
  return store && !eo_store_find_design(store, id, NULL, NULL, &outcome, &error) && outcome == EO_DESIGN_DONE;
}

static enum eo_code see_job(void *context, const struct eo_stored_job *job, struct eo_error *unused)
{
  (void)unused;
  *(enum eo_job_state *)context = job->state;
  return EO_OK;
}

static void test_promises(struct eo_store *store)
{
  enum eo_design_outcome outcome;
  enum eo_job_outcome ordered;
  enum eo_job_state state = EO_JOB_FAILED;
  enum eo_measurement_outcome measured;
  char incoming[PATH];
  int64_t job = 0;
  ok(!eo_store_add_design(store, "a", "{}", 10, NULL, NULL, &outcome, &error), "a design is stored");
  struct eo_store *other = power_off();
  ok(has_design(other, 1), "a design is there after a power failure");
  eo_store_close(other);
  const struct eo_queue_entry entry = {.kind = EO_JOB_OPTIMIZE, .design = "{}", .name = "a job", .algorithm = "ga"};
  ok(!eo_queue_add(store, &entry, 10, &job, &ordered, &error), "a job is ordered");
  other = power_off();
  ok(other && !eo_queue_find(other, job, see_job, &state, &ordered, &error) && ordered == EO_JOB_OUTCOME_DONE &&
         state == EO_JOB_QUEUED,
     "an order is there after a power failure");
  eo_store_close(other);
  const struct eo_stored_measurement row = {.design = 1,
                                            .digest = hash,
                                            .torque = 1,
                                            .speed = 1,
                                            .layout = "",
                                            .pair = hash,
                                            .summary = "{}",
                                            .result = "{}",
                                            .files = 1,
                                            .file = {{.name = "a.csv",
                                                      .size = 1,
                                                      .sha256 = "0123456789abcdef0123456789"
                                                                "abcdef0123456789abcdef01234"
                                                                "56789abcdef"}}};
  bool made = !eo_measurement_folder_new(store, incoming, sizeof incoming, &error);
  char file[PATH + 4];
  snprintf(file, sizeof file, "%s/0", incoming);
  FILE *stream = made ? fopen(file, "w") : NULL;
  if (stream) {
    fputs("1", stream);
    fclose(stream);
  }
  ok(stream && !eo_store_add_measurement(store, &row, incoming, NULL, NULL, &measured, &error),
     "a recording is kept: %s", error.text);
  other = power_off();
  ok(other && !eo_store_find_measurement(other, 1, NULL, NULL, &measured, &error) && measured == EO_MEASUREMENT_DONE,
     "a recording is there after a power failure");
  eo_store_close(other);
  ok(!eo_store_remove_measurement(store, 1, &measured, &error) &&
         !eo_store_remove_design(store, 1, 1, &outcome, &error),
     "a recording and a design are deleted");
  other = power_off();
  ok(other && !has_design(other, 1), "what was deleted stays deleted after a power failure");
  eo_store_close(other);
}

int main(void)
{
  struct eo_store *store = NULL;
  snprintf(folder, sizeof folder, "%s/easeoff-power-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  if (!mkdtemp(folder))
    return 99;
  watch();
  ok(!eo_store_open(&store, folder, EO_STORE_WRITE, &error), "a database is opened");
  test_usual(store);
  test_promises(store);
  eo_store_close(store);
  nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
  nftw(after, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
  for (int i = 0; i < changes; i++)
    free(change[i].old);
  return tap_done();
}
