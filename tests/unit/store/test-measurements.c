/* Measurements in the data folder: rows and files together, what a killed process leaves, and what belongs to what. */
#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "format/text.h"
#include "store/designs.h"
#include "store/measurements.h"
#include "support/tap.h"

static char folder[200];
static struct eo_store *store;
static struct eo_error error;

static void put_file(const char *directory, const char *name, const char *content)
{
  char path[600];
  snprintf(path, sizeof path, "%s/%s", directory, name);
  FILE *stream = fopen(path, "w");
  if (stream) {
    fputs(content, stream);
    fclose(stream);
  }
}

static bool is_there(const char *format, const char *name)
{
  char path[600];
  struct stat status;
  snprintf(path, sizeof path, format, folder, name);
  return lstat(path, &status) == 0;
}

static int count_entries(void)
{
  char path[300];
  snprintf(path, sizeof path, "%s/measurements", folder);
  DIR *directory = opendir(path);
  int count = 0;
  for (const struct dirent *entry; directory && (entry = readdir(directory));)
    count += *entry->d_name != '.';
  if (directory)
    closedir(directory);
  return count;
}

static enum eo_code remember(void *context, const struct eo_stored_measurement *row, struct eo_error *fault)
{
  (void)fault;
  struct eo_stored_measurement *kept = context;
  *kept = *row;
  kept->layout = *row->layout ? "some" : "";
  kept->summary = strstr(row->summary, "\"s\"") ? "s" : "";
  kept->result = strstr(row->result, "\"r\"") ? "r" : "";
  return EO_OK;
}

static enum eo_code count(void *context, const struct eo_stored_measurement *row, struct eo_error *fault)
{
  (void)row, (void)fault;
  ++*(int *)context;
  return EO_OK;
}

static int64_t add_design(void)
{
  enum eo_design_outcome outcome;
  static int64_t next;
  return eo_store_add_design(store, "d", "{}", 100, NULL, NULL, &outcome, &error) ? 0 : ++next;
}

/* A measurement with one file; digest: one letter, repeated. */
static enum eo_measurement_outcome add(int64_t design, char letter, struct eo_stored_measurement *kept)
{
  char incoming[400], digest[EO_HASH_LENGTH + 1] = "";
  enum eo_measurement_outcome outcome = EO_MEASUREMENT_MISSING;
  memset(digest, letter, EO_HASH_LENGTH);
  struct eo_stored_measurement row = {.design = design,
                                      .digest = digest,
                                      .unmodified = true,
                                      .torque = 828,
                                      .speed = NAN,
                                      .layout = "",
                                      .pair = digest,
                                      .summary = "{\"s\":1}",
                                      .result = "{\"r\":1}",
                                      .files = 1};
  snprintf(row.file[0].name, sizeof row.file[0].name, "run \"7\".csv");
  snprintf(row.file[0].sha256, sizeof row.file[0].sha256, "%s", digest);
  row.file[0].size = 5;
  if (eo_measurement_folder_new(store, incoming, sizeof incoming, &error))
    return outcome;
  put_file(incoming, "0", "1,2,3");
  if (eo_store_add_measurement(store, &row, incoming, remember, kept, &outcome, &error))
    printf("# %s\n", error.text);
  eo_measurement_folder_remove(incoming);
  return outcome;
}

static void test_adding(void)
{
  struct eo_stored_measurement kept = {0};
  int64_t design = add_design();
  enum eo_measurement_outcome outcome = add(design, 'a', &kept);
  ok(outcome == EO_MEASUREMENT_DONE && kept.id == 1 && kept.design == design && kept.unmodified && isnan(kept.speed) &&
         !*kept.layout,
     "a measurement is added");
  ok(*kept.summary == 's' && *kept.result == 'r' && kept.files == 1 &&
         strcmp(kept.file[0].name, "run \"7\".csv") == 0 && kept.file[0].size == 5,
     "and its row says what was said");
  ok(is_there("%s/measurements/1/%s", "0") && count_entries() == 1, "its file lies under its number and nowhere else");
  ok(add(design, 'a', &kept) == EO_MEASUREMENT_KNOWN && kept.id == 1 && count_entries() == 1,
     "the same again is the same");
  ok(add(99, 'b', &kept) == EO_MEASUREMENT_NO_DESIGN && count_entries() == 1, "one of no design leaves nothing");
  ok(add(design, 'c', &kept) == EO_MEASUREMENT_DONE && kept.id == 2, "another one has the next number");
  int64_t bytes = 0;
  ok(eo_store_measured_bytes(store, &bytes, &error) == EO_OK && bytes == 10, "their files have %d bytes", (int)bytes);
}

static void test_listing(void)
{
  int all = 0, below = 0, other = 0;
  struct eo_stored_measurement last = {0};
  int64_t design = add_design();
  eo_store_list_measurements(store, 0, 0, 10, count, &all, &error);
  eo_store_list_measurements(store, 0, 2, 10, count, &below, &error);
  eo_store_list_measurements(store, design, 0, 10, count, &other, &error);
  eo_store_list_measurements(store, 1, 0, 1, remember, &last, &error);
  ok(all == 2 && below == 1 && other == 0, "lists: all %d, before the second %d, of another design %d", all, below,
     other);
  ok(last.id == 2 && *last.summary == 's' && !*last.result, "the newest first, without its result");
}

static void test_removing(void)
{
  enum eo_measurement_outcome outcome;
  enum eo_design_outcome used;
  struct eo_stored_measurement kept = {0};
  eo_store_remove_design(store, 1, 0, &used, &error);
  ok(used == EO_DESIGN_USED, "a design with measurements stays");
  ok(eo_store_remove_measurement(store, 2, &outcome, &error) == EO_OK && outcome == EO_MEASUREMENT_DONE &&
         count_entries() == 1,
     "one is removed with its file");
  ok(eo_store_remove_measurement(store, 2, &outcome, &error) == EO_OK && outcome == EO_MEASUREMENT_MISSING, "once");
  ok(eo_store_find_measurement(store, 2, remember, &kept, &outcome, &error) == EO_OK &&
         outcome == EO_MEASUREMENT_MISSING,
     "and is not found");
  ok(add(1, 'd', &kept) == EO_MEASUREMENT_DONE && kept.id == 3, "its number is not used again");
}

/* What the death of a process leaves: files on their way, a folder that was renamed before its row was committed, one
   whose row is gone. */
static void test_tidying(void)
{
  char path[400], outside[300];
  snprintf(outside, sizeof outside, "%s/outside", folder);
  mkdir(outside, 0777);
  put_file(outside, "kept", "x");
  eo_measurement_folder_new(store, path, sizeof path, &error);
  put_file(path, "0", "half");
  snprintf(path, sizeof path, "%s/measurements/4", folder);
  mkdir(path, 0777);
  put_file(path, "0", "whole, but without a row");
  snprintf(path, sizeof path, "%s/measurements/01", folder);
  mkdir(path, 0777);
  snprintf(path, sizeof path, "%s/measurements/link", folder);
  ok(symlink(outside, path) == 0, "a link");
  put_file(folder, "measurements/file", "x");
  ok(count_entries() == 7, "leftovers");
  ok(eo_measurement_folder_tidy(store, &error) == EO_OK && count_entries() == 2, "go away at a start %s", error.text);
  ok(is_there("%s/measurements/1/%s", "0") && is_there("%s/measurements/3/%s", "0"), "what has a row stays");
  ok(is_there("%s/outside/%s", "kept"), "and so does what a link leads to");
  snprintf(path, sizeof path, "%s/kept", outside);
  unlink(path);
  rmdir(outside);
}

/* A transaction that cannot be finished, because there is nothing to keep. */
static void test_failing(void)
{
  enum eo_measurement_outcome outcome;
  char digest[EO_HASH_LENGTH + 1] = "";
  int all = 0;
  memset(digest, 'e', EO_HASH_LENGTH);
  struct eo_stored_measurement row = {.design = 1,
                                      .digest = digest,
                                      .torque = 1,
                                      .speed = NAN,
                                      .layout = "",
                                      .pair = digest,
                                      .summary = "{}",
                                      .result = "{}",
                                      .files = 1};
  snprintf(row.file[0].sha256, sizeof row.file[0].sha256, "%s", digest);
  ok(eo_store_add_measurement(store, &row, "/nonexistent", NULL, NULL, &outcome, &error) == EO_ERROR_FILE,
     "no files: %s", error.text);
  row.result = "{";
  char incoming[400];
  eo_measurement_folder_new(store, incoming, sizeof incoming, &error);
  put_file(incoming, "0", "");
  ok(eo_store_add_measurement(store, &row, incoming, NULL, NULL, &outcome, &error) == EO_ERROR_FILE, "no JSON");
  eo_measurement_folder_remove(incoming);
  eo_store_list_measurements(store, 0, 0, 10, count, &all, &error);
  ok(all == 2 && count_entries() == 2, "nothing of either stays");
}

int main(void)
{
  static const char *const names[] = {"easeoff.db", "easeoff.db-wal", "easeoff.db-shm"};
  char path[300];
  snprintf(folder, sizeof folder, "%s/easeoff-measurements-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  if (!mkdtemp(folder) || eo_store_open(&store, folder, EO_STORE_WRITE, &error))
    return 99;
  ok(eo_measurement_folder_tidy(store, &error) == EO_OK, "an empty data folder is tidy");
  test_adding();
  test_listing();
  test_removing();
  test_tidying();
  test_failing();
  eo_store_close(store);
  snprintf(path, sizeof path, "%s/measurements", folder);
  eo_measurement_folder_remove(path);
  for (int i = 0; i < 3; i++) {
    snprintf(path, sizeof path, "%s/%s", folder, names[i]);
    unlink(path);
  }
  ok(rmdir(folder) == 0, "nothing else was written");
  return tap_done();
}
