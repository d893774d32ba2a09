/* SPDX-License-Identifier: GPL-3.0-or-later */
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
     "the row of a measurement says what was said");
  ok(is_there("%s/measurements/1/%s", "0") && count_entries() == 1,
     "the file of a measurement lies under its number and nowhere else");
  ok(add(design, 'a', &kept) == EO_MEASUREMENT_KNOWN && kept.id == 1 && count_entries() == 1,
     "the same measurement again is the same row");
  ok(add(99, 'b', &kept) == EO_MEASUREMENT_NO_DESIGN && count_entries() == 1,
     "a measurement of no design leaves nothing");
  ok(add(design, 'c', &kept) == EO_MEASUREMENT_DONE && kept.id == 2, "another measurement has the next number");
  int64_t bytes = 0;
  ok(eo_store_measured_bytes(store, &bytes, &error) == EO_OK && bytes == 10,
     "the files of both measurements have %d bytes", (int)bytes);
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
  ok(all == 2 && below == 1 && other == 0, "lists find all %d, before the second %d, of another design %d", all, below,
     other);
  ok(last.id == 2 && *last.summary == 's' && !*last.result,
     "a list has the newest measurement first, without its result");
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
     "a measurement is removed with its file");
  ok(eo_store_remove_measurement(store, 2, &outcome, &error) == EO_OK && outcome == EO_MEASUREMENT_MISSING,
     "a removed measurement is not removed again");
  ok(eo_store_find_measurement(store, 2, remember, &kept, &outcome, &error) == EO_OK &&
         outcome == EO_MEASUREMENT_MISSING,
     "a removed measurement is not found");
  ok(add(1, 'd', &kept) == EO_MEASUREMENT_DONE && kept.id == 3,
     "the number of a removed measurement is not used again");
}

static void make(const char *name)
{
  char path[400];
  snprintf(path, sizeof path, "%s/measurements/%s", folder, name);
  mkdir(path, 0777);
}

/* A folder with one file in it. */
static void make_with(const char *name, const char *file, const char *content)
{
  char path[400];
  make(name);
  snprintf(path, sizeof path, "%s/measurements/%s", folder, name);
  put_file(path, file, content);
}

static bool holds(const char *name, const char *content)
{
  char path[600], found[100] = "";
  snprintf(path, sizeof path, "%s/measurements/%s", folder, name);
  FILE *stream = fopen(path, "r");
  if (stream) {
    found[fread(found, 1, sizeof found - 1, stream)] = '\0';
    fclose(stream);
  }
  return stream && strcmp(found, content) == 0;
}

static int tidy(void)
{
  int aside = -1;
  if (eo_measurement_folder_tidy(store, &aside, &error))
    printf("# %s\n", error.text);
  return aside;
}

/* What the death of a process leaves: files on their way, a folder that was renamed before its row was committed,
   deletions before and after the row was gone. */
static void test_tidying(void)
{
  make_with("incoming-a1B2c3", "0", "half");
  make_with("incoming-a1B2c3", "inflated-Zz09aa", "half");
  make_with("4", "0", "whole, but without a row");
  make_with("deleted-2", "0", "asked for");
  char kept[400], marked[400];
  snprintf(kept, sizeof kept, "%s/measurements/3", folder);
  snprintf(marked, sizeof marked, "%s/measurements/deleted-3", folder);
  ok(rename(kept, marked) == 0 && tidy() == 1, "a start finds one recording without a row");
  ok(!is_there("%s/measurements/%s", "incoming-a1B2c3"), "an unfinished upload goes away at a start");
  ok(!is_there("%s/measurements/%s", "4") && holds("lost+found/4/0", "whole, but without a row"),
     "a recording without a row is set aside");
  ok(!is_there("%s/measurements/%s", "deleted-2"), "a start finishes a deletion without a row");
  ok(holds("3/0", "1,2,3") && !is_there("%s/measurements/%s", "deleted-3"), "a start undoes a deletion with its row");
  ok(holds("1/0", "1,2,3"), "a start leaves a recording with its row");
  make_with("4", "0", "another one");
  make_with("deleted-1", "0", "nobody knows how");
  ok(tidy() == 2 && holds("lost+found/4/0", "whole, but without a row") && holds("lost+found/4-2/0", "another one") &&
         holds("lost+found/deleted-1/0", "nobody knows how") && holds("1/0", "1,2,3"),
     "a start overwrites nothing that was set aside");
  ok(tidy() == 0 && count_entries() == 3, "a second start sets nothing aside");
}

/* Whatever lies there that we did not put there stays as it is. */
static void test_strangers(void)
{
  char outside[300], link[400];
  snprintf(outside, sizeof outside, "%s/outside", folder);
  mkdir(outside, 0777);
  put_file(outside, "0", "x");
  snprintf(link, sizeof link, "%s/measurements/99", folder);
  ok(symlink(outside, link) == 0, "a link is laid into the folder");
  put_file(folder, "measurements/file", "x");
  put_file(folder, "measurements/77", "a file with a number for a name");
  make_with("backup", "0", "x");
  make_with("2026", "notes.txt", "x");
  make_with("01", "0", "x");
  make_with("12345678901234567890", "0", "x");
  make_with("incoming-photos", "0", "x");
  make_with("incoming-photos", "cat.jpg", "x");
  make_with("incoming-letters", "0", "x");
  make_with("deleted-8", "notes.txt", "x");
  ok(tidy() == 0 && holds("file", "x") && holds("77", "a file with a number for a name") && holds("99/0", "x") &&
         holds("backup/0", "x") && holds("2026/notes.txt", "x") && holds("01/0", "x") &&
         holds("12345678901234567890/0", "x") && holds("incoming-photos/0", "x") &&
         holds("incoming-photos/cat.jpg", "x") && holds("incoming-letters/0", "x") && holds("deleted-8/notes.txt", "x"),
     "a start leaves what is not ours where it is");
}

/* Folders that the database knows nothing of, as after an older one was put back. */
static void test_numbers(void)
{
  struct eo_stored_measurement kept = {0};
  make_with("20", "0", "came while the server ran");
  make_with("21", "notes.txt", "not ours, but in the way");
  enum eo_measurement_outcome outcome = add(1, 'f', &kept);
  ok(outcome == EO_MEASUREMENT_DONE && kept.id == 22 && holds("22/0", "1,2,3") &&
         holds("20/0", "came while the server ran") && holds("21/notes.txt", "not ours, but in the way"),
     "a new recording has a number above every folder's: %d", (int)kept.id);
  make_with("lost+found/40-3", "0", "set aside");
  outcome = add(1, 'g', &kept);
  ok(outcome == EO_MEASUREMENT_DONE && kept.id == 41, "a new recording has a number above those set aside: %d",
     (int)kept.id);
  make_with("23", "0", "above the rows, below the highest");
  ok(tidy() == 2 && holds("22/0", "1,2,3") && holds("41/0", "1,2,3"), "the next start sets aside what stands above it");
}

/* A deletion that cannot be finished is undone, files and all. */
static void test_undeleting(void)
{
  enum eo_measurement_outcome outcome;
  make_with("deleted-22", "notes.txt", "in the way");
  ok(eo_store_remove_measurement(store, 22, &outcome, &error) == EO_ERROR_FILE && holds("22/0", "1,2,3"),
     "a deletion that fails leaves the files: %s", error.text);
  struct eo_stored_measurement kept = {0};
  ok(eo_store_find_measurement(store, 22, remember, &kept, &outcome, &error) == EO_OK && outcome == EO_MEASUREMENT_DONE,
     "a deletion that fails leaves the row");
}

static enum eo_code refuse(void *context, const struct eo_stored_measurement *row, struct eo_error *fault)
{
  (void)context, (void)row;
  return eo_error_memory(fault);
}

/* A transaction that cannot be finished, because there is nothing to keep. */
static void test_failing(void)
{
  enum eo_measurement_outcome outcome;
  char digest[EO_HASH_LENGTH + 1] = "";
  int all = 0, entries = count_entries();
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
     "a measurement without files is refused: %s", error.text);
  row.result = "{";
  char incoming[400];
  eo_measurement_folder_new(store, incoming, sizeof incoming, &error);
  put_file(incoming, "0", "");
  ok(eo_store_add_measurement(store, &row, incoming, NULL, NULL, &outcome, &error) == EO_ERROR_FILE,
     "a measurement whose layout is no JSON is refused");
  row.result = "{}";
  enum eo_code code = eo_store_add_measurement(store, &row, incoming, refuse, NULL, &outcome, &error);
  ok(code == EO_ERROR_MEMORY && access(incoming, F_OK) == 0, "a transaction that ends badly gives the files back");
  eo_measurement_folder_remove(incoming);
  eo_store_list_measurements(store, 0, 0, 10, count, &all, &error);
  ok(all == 4 && count_entries() == entries, "a transaction that ends badly leaves no files");
}

static bool is_refused(const char *words)
{
  int aside;
  struct eo_store *other = NULL;
  enum eo_code code = eo_store_open(&other, folder, EO_STORE_WRITE, &error);
  if (!code)
    code = eo_measurement_folder_tidy(other, &aside, &error);
  eo_store_close(other);
  return (code == EO_ERROR_FILE || code == EO_ERROR_DAMAGED) && strstr(error.text, words) && holds("1/0", "1,2,3") &&
         holds("41/0", "1,2,3");
}

static void overwrite(const char *path, long at, const void *bytes, size_t size)
{
  FILE *file = fopen(path, "r+");
  if (file) {
    fseek(file, at, SEEK_SET);
    fwrite(bytes, 1, size, file);
    fclose(file);
  }
}

static void test_other_databases(void)
{
  char path[300], away[300], journal[300];
  snprintf(path, sizeof path, "%s/easeoff.db", folder);
  snprintf(away, sizeof away, "%s/away.db", folder);
  snprintf(journal, sizeof journal, "%s/easeoff.db-wal", folder);
  eo_store_close(store);
  store = NULL;
  ok(rename(path, away) == 0 && is_refused("4 recordings, but the database next to it is new"),
     "recordings beside a new database are refused: %s", error.text);
  ok(is_refused("is new"), "recordings beside a new database are refused at the next start too");
  ok(truncate(path, 0) == 0 && is_refused("is new"), "recordings beside an empty file are refused");
  truncate(path, 0);
  put_file(folder, "easeoff.db-wal", "what was last written");
  ok(is_refused("its journal") && access(journal, F_OK) == 0, "a journal without its database is refused: %s",
     error.text);
  unlink(journal);
  rename(away, path);
}

/* The first page of a database, damaged so that it says: a new one, without tables. */
static void test_damaged_database(void)
{
  static const unsigned char leaf[8] = {13, 0, 0, 0, 0, 16, 0, 0}, nothing[12] = {0};
  char path[300];
  struct stat before, after;
  snprintf(path, sizeof path, "%s/easeoff.db", folder);
  overwrite(path, 60, nothing, sizeof nothing); /* whose database it is, and its schema's number */
  overwrite(path, 100, leaf, sizeof leaf);      /* the root of the table of tables */
  stat(path, &before);
  ok(is_refused("is damaged"), "a database whose first page is damaged is refused: %s", error.text);
  ok(stat(path, &after) == 0 && after.st_size == before.st_size && after.st_size > 4096,
     "a database that is refused is left as it is");
}

int main(void)
{
  char path[300], command[400];
  int aside;
  snprintf(folder, sizeof folder, "%s/easeoff-measurements-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  if (!mkdtemp(folder) || eo_store_open(&store, folder, EO_STORE_WRITE, &error))
    return 99;
  ok(eo_measurement_folder_tidy(store, &aside, &error) == EO_OK && aside == 0, "an empty data folder is tidy");
  test_adding();
  test_listing();
  test_removing();
  test_tidying();
  test_strangers();
  test_numbers();
  test_undeleting();
  test_failing();
  test_other_databases();
  test_damaged_database();
  eo_store_close(store);
  snprintf(path, sizeof path, "%s/measurements/99", folder);
  unlink(path);
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  ok(system(command) == 0, "the folder is removed");
  return tap_done();
}
