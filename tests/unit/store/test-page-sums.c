/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bits turned in the database and in its journal: what is read afterwards is what was written, or an error. FLIPS=N
   sets how many (default 120). And: files of earlier versions get their sums, with a copy kept of what they were. */
#define _GNU_SOURCE /* nftw */
#include "base/random.h"
#include "store/designs.h"
#include "store/page_sums.h"
#include "store/store.h"
#include "format/text.h"
#include "support/tap.h"

#include <fcntl.h>
#include <ftw.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { DESIGNS = 40 };

static struct eo_error error;
static char folder[200];

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *place)
{
  (void)status, (void)type;
  return place->level ? remove(path) : 0;
}

static void empty(void)
{
  nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static struct eo_store *open_store(void)
{
  struct eo_store *store = NULL;
  return eo_store_open(&store, folder, EO_STORE_WRITE, &error) ? NULL : store;
}

static const char *name_file(const char *ending)
{
  static char name[300];
  snprintf(name, sizeof name, "%s/easeoff.db%s", folder, ending);
  return name;
}

/* What design number i says: longer than a page now and then. */
static void write_document(int i, char text[9000])
{
  int length = snprintf(text, 9000, "{\"number\":%d,\"text\":\"", i);
  for (int k = 0; k < 100 + i % 7 * 1200; k++)
    text[length++] = (char)('a' + (i * 31 + k * 7) % 26);
  strcpy(text + length, "\"}");
}

static bool fill(struct eo_store *store)
{
  enum eo_design_outcome outcome;
  char text[9000];
  for (int i = 1; i <= DESIGNS; i++) {
    write_document(i, text);
    if (eo_store_add_design(store, "a name", text, 1000, NULL, NULL, &outcome, &error))
      return false;
  }
  return true;
}

struct seen {
  int good, wrong;
};

static enum eo_code see(void *context, const struct eo_stored_design *row, struct eo_error *unused)
{
  struct seen *seen = context;
  char text[9000];
  (void)unused;
  write_document((int)row->id, text);
  bool same = strcmp(row->document, text) == 0 && strcmp(row->name, "a name") == 0 && row->revision == 1;
  seen->good += same;
  seen->wrong += !same;
  return EO_OK;
}

/* Reads every design by its number and in a list. True: an error was told. */
static bool read_all(struct eo_store *store, struct seen *seen)
{
  enum eo_design_outcome outcome;
  bool told = false;
  for (int i = 1; i <= DESIGNS; i++) {
    if (eo_store_find_design(store, i, see, seen, &outcome, &error))
      told = true;
    else
      seen->wrong += outcome != EO_DESIGN_DONE; /* a design that is there is not "missing" */
  }
  struct seen listed = {0};
  if (eo_store_list_designs(store, 0, 1000, see, &listed, &error))
    told = true;
  else
    seen->wrong += listed.good != DESIGNS;
  seen->wrong += listed.wrong;
  return told;
}

static bool turn_bit(const char *path, off_t at, int bit)
{
  unsigned char byte = 0;
  int file = open(path, O_RDWR | O_CLOEXEC);
  bool good = file >= 0 && pread(file, &byte, 1, at) == 1;
  byte ^= (unsigned char)(1 << bit);
  good = good && pwrite(file, &byte, 1, at) == 1;
  close(file);
  return good;
}

static off_t size_of(const char *path)
{
  struct stat status;
  return stat(path, &status) == 0 ? status.st_size : 0;
}

static off_t choose(off_t below)
{
  static uint64_t draw;
  return (off_t)(eo_random_unit(eo_random_at(7, 0, 0, 0), draw++) * (double)below);
}

static void test_database(int flips)
{
  struct eo_store *store = open_store();
  int told = 0, refused = 0, same = 0;
  struct seen seen = {0};
  ok(store && fill(store), "a database is made and filled");
  eo_store_close(store);
  for (int i = 0; i < flips; i++) {
    off_t at = choose(size_of(name_file("")));
    int bit = (int)choose(8);
    turn_bit(name_file(""), at, bit);
    store = open_store();
    bool error_told = store && read_all(store, &seen);
    refused += !store;
    told += error_told;
    same += store && !error_told;
    eo_store_close(store);
    if (i % 16 == 0 && access(name_file("-wal"), F_OK) == 0)
      printf("# the journal is still there\n");
    turn_bit(name_file(""), at, bit);
  }
  ok(seen.wrong == 0,
     "%d bits are turned: %d refuse the file, %d are told on reading, %d stand where nothing is; 0 wrong answers: %d",
     flips, refused, told, same, seen.wrong);
  ok(refused + told > flips / 2, "most turned bits are noticed");
  store = open_store();
  seen = (struct seen){0};
  ok(store && !read_all(store, &seen) && seen.good == DESIGNS && !seen.wrong,
     "all is there when the bit is turned back");
  eo_store_close(store);
}

/* What is committed but not yet in the database: another connection reads it out of the journal. */
static void test_journal(int flips)
{
  empty();
  struct eo_store *writer = open_store();
  struct seen seen = {0};
  int told = 0;
  ok(writer && fill(writer) && size_of(name_file("-wal")) > 100000, "a journal is made and filled");
  for (int i = 0; i < flips; i++) {
    off_t at = 32 + choose(size_of(name_file("-wal")) - 32);
    int bit = (int)choose(8);
    struct eo_store *reader = open_store();
    turn_bit(name_file("-wal"), at, bit);
    told += reader && read_all(reader, &seen);
    turn_bit(name_file("-wal"), at, bit);
    eo_store_close(reader);
  }
  ok(seen.wrong == 0 && told > 0, "%d bits of the journal are turned and %d are told; 0 wrong answers: %d", flips, told,
     seen.wrong);
  eo_store_close(writer);
}

/* The first 100 bytes of every version say that nothing is kept free. */
static void test_earlier(void)
{
  struct eo_text sql = {0};
  char file[400];
  sqlite3 *handle = NULL;
  empty();
  snprintf(file, sizeof file, "%s/tests/schema/0005.sql", getenv("SOURCES") ? getenv("SOURCES") : ".");
  ok(eo_text_read(&sql, file, 1 << 20, &error) == EO_OK && sqlite3_open(name_file(""), &handle) == SQLITE_OK &&
         sqlite3_exec(handle, sql.data, NULL, NULL, NULL) == SQLITE_OK,
     "a database of an earlier version is made");
  sqlite3_close(handle);
  eo_text_done(&sql);
  struct eo_store *store = open_store();
  ok(store != NULL, "a database of an earlier version is opened: %s", store ? "" : error.text);
  ok(size_of(name_file(".schema-5")) > 4096, "a database of an earlier version is kept as it was");
  eo_store_close(store);
  unsigned char page[4096];
  int input = open(name_file(""), O_RDONLY | O_CLOEXEC), good = 0, pages = 0;
  for (unsigned number = 1; read(input, page, sizeof page) == (ssize_t)sizeof page; number++, pages++)
    good += eo_page_sum_holds(page, sizeof page, number);
  close(input);
  ok(pages > 5 && good == pages, "%d of %d pages of the database have their sum", good, pages);
}

/* Another program that writes without them is noticed. */
static void test_foreign_writer(void)
{
  sqlite3 *handle;
  struct seen seen = {0};
  empty();
  struct eo_store *store = open_store();
  ok(store && fill(store), "another database is made and filled");
  eo_store_close(store);
  ok(sqlite3_open(name_file(""), &handle) == SQLITE_OK &&
         sqlite3_exec(handle, "UPDATE design SET name = 'another' WHERE id = 3", NULL, NULL, NULL) == SQLITE_OK,
     "another program changes the database");
  sqlite3_close(handle);
  store = open_store();
  ok(!store || read_all(store, &seen), "the change by another program is told: %s", error.text);
  eo_store_close(store);
}

int main(void)
{
  const char *wanted = getenv("FLIPS");
  int flips = wanted ? atoi(wanted) : 120;
  snprintf(folder, sizeof folder, "%s/easeoff-sums-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  if (!mkdtemp(folder))
    return 99;
  test_database(flips);
  test_journal(flips / 4);
  test_earlier();
  test_foreign_writer();
  empty();
  rmdir(folder);
  return tap_done();
}
