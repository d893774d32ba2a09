/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/store.h"

#include "format/text.h"
#include "store/migrations.h"
#include "store/page_sums.h"
#include "store/statement.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* "EASE": tells our files from any other database. */
enum { APPLICATION_ID = 0x45415345, WAIT_MS = 10000 };

static enum eo_code execute(struct eo_store *store, const char *sql, struct eo_error *error)
{
  int fault = sqlite3_exec(store->handle, sql, NULL, NULL, NULL);
  return fault ? eo_store_fault(store, fault, error) : EO_OK;
}

static enum eo_code read_integer(struct eo_store *store, const char *sql, int *value, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, sql, "");
  if (eo_statement_step(&statement))
    *value = (int)eo_column_integer(&statement, 0);
  return eo_statement_end(&statement, error);
}

/* A new database is one page. More pages or a schema's number without a table: the first page is damaged, and writing a
   new one there would lose what the others still hold. */
static enum eo_code expect_tables(struct eo_store *store, int schema, struct eo_error *error)
{
  struct stat status = {0};
  int pages = 0, page_size = 0, tables = 0;
  EO_TRY(read_integer(store, "PRAGMA page_count", &pages, error));
  EO_TRY(read_integer(store, "PRAGMA page_size", &page_size, error));
  if (!schema && pages <= 1 && (stat(store->path, &status) != 0 || status.st_size <= page_size))
    return EO_OK;
  /* another process may be making it */
  EO_TRY(read_integer(store, "SELECT count(*) FROM sqlite_schema", &tables, error));
  return tables ? EO_OK
                : eo_error_set(error, EO_ERROR_FILE, "",
                               "%.200s is damaged: it has content, but no table can be found in it. Put a copy back "
                               "that is whole, or move the file to another place to begin anew.",
                               store->path);
}

/* Whose database this is and how old; both 0 in a new file. */
static enum eo_code identify(struct eo_store *store, int *schema, struct eo_error *error)
{
  int application = 0, tables = 0;
  EO_TRY(read_integer(store, "PRAGMA application_id", &application, error));
  EO_TRY(read_integer(store, "PRAGMA user_version", schema, error));
  EO_TRY(read_integer(store, "SELECT count(*) FROM sqlite_schema", &tables, error));
  if (application != APPLICATION_ID && (application || tables || *schema))
    return eo_error_set(error, EO_ERROR_FILE, "", "%.200s is the database of another program.", store->path);
  if (*schema > eo_store_schema)
    return eo_error_set(error, EO_ERROR_FILE, "",
                        "%.200s has schema %d, this program knows only %d: a newer version of the program wrote it.",
                        store->path, *schema, eo_store_schema);
  return tables ? EO_OK : expect_tables(store, *schema, error);
}

/* Within a transaction: another process may have been faster. */
static enum eo_code apply_steps(struct eo_store *store, struct eo_error *error)
{
  int schema = 0;
  char mark[96];
  EO_TRY(identify(store, &schema, error));
  for (; schema < eo_store_schema; schema++)
    EO_TRY(execute(store, eo_store_migrations[schema], error));
  snprintf(mark, sizeof mark, "PRAGMA application_id = %d; PRAGMA user_version = %d", APPLICATION_ID, eo_store_schema);
  return execute(store, mark, error);
}

static enum eo_code check_references(struct eo_store *store, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "PRAGMA foreign_key_check", "");
  bool broken = eo_statement_step(&statement);
  enum eo_code code = eo_statement_end(&statement, error);
  return code || !broken ? code
                         : eo_error_set(error, EO_ERROR_FILE, "",
                                        "%.150s is damaged: a row refers to one that is not there.", store->path);
}

static enum eo_code apply_and_check(struct eo_store *store, struct eo_error *error)
{
  EO_TRY(apply_steps(store, error));
  return check_references(store, error);
}

static enum eo_code migrate_at_once(struct eo_store *store, struct eo_error *error)
{
  EO_TRY(eo_store_begin(store, error));
  return eo_store_end(store, apply_and_check(store, error), error);
}

/* A step that replaces a table drops the old one: with references watched that would delete what refers to it. */
static enum eo_code migrate(struct eo_store *store, struct eo_error *error)
{
  int schema = 0;
  EO_TRY(identify(store, &schema, error));
  if (schema == eo_store_schema)
    return EO_OK;
  EO_TRY(execute(store, "PRAGMA foreign_keys = OFF", error));
  enum eo_code code = migrate_at_once(store, error);
  enum eo_code end = execute(store, "PRAGMA foreign_keys = ON", code ? NULL : error);
  return code ? code : end;
}

/* Readers of a folder that cannot be written can bring nothing up to date. */
static enum eo_code expect_present(struct eo_store *store, struct eo_error *error)
{
  int schema = 0;
  EO_TRY(identify(store, &schema, error));
  return schema == eo_store_schema
             ? EO_OK
             : eo_error_set(error, EO_ERROR_FILE, "",
                            "%.200s has the older schema %d and cannot be brought to %d, because it cannot be written.",
                            store->path, schema, eo_store_schema);
}

static enum eo_code make_folder(const char *directory, struct eo_error *error)
{
  struct stat status;
  if (mkdir(directory, 0777) == 0 || (stat(directory, &status) == 0 && S_ISDIR(status.st_mode)))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_FILE, "", "The data folder %.200s cannot be made: %s.", directory,
                      strerror(errno == EEXIST ? ENOTDIR : errno));
}

static enum eo_code connect(struct eo_store *store, const char *name, int flags, struct eo_error *error)
{
  int fault = eo_page_sums_register(), reserved = EO_PAGE_SUM;
  if (!fault)
    fault = sqlite3_open_v2(name, &store->handle, flags | SQLITE_OPEN_NOMUTEX, eo_page_sums_vfs);
  if (fault)
    return eo_store_fault(store, fault, error);
  sqlite3_extended_result_codes(store->handle, 1);
  sqlite3_file_control(store->handle, "main", SQLITE_FCNTL_RESERVE_BYTES, &reserved); /* of a new file */
  eo_store_wait(store, WAIT_MS);
  /* NORMAL: a commit survives the death of the process; after a power failure the last ones may be missing, whole, and
     are computed anew. What was promised to somebody goes through eo_store_begin_lasting(). No page of a transaction
     goes to the journal before its end: see page_sums.h. */
  EO_TRY(execute(store, "PRAGMA foreign_keys = ON; PRAGMA synchronous = NORMAL; PRAGMA cache_spill = OFF", error));
  bool reads = flags & SQLITE_OPEN_READONLY; /* the mode of a file is written even where it is that already */
  return reads ? EO_OK : execute(store, "PRAGMA auto_vacuum = INCREMENTAL", error);
}

static bool has_sums(struct eo_store *store)
{
  int reserved = -1;
  sqlite3_file_control(store->handle, "main", SQLITE_FCNTL_RESERVE_BYTES, &reserved);
  return reserved == EO_PAGE_SUM;
}

/* Everything into new pages. What it writes may be more than fits into memory. */
static enum eo_code rebuild(struct eo_store *store, struct eo_error *error)
{
  eo_page_sums_compare(store->handle, false);
  enum eo_code code = execute(store, "PRAGMA cache_spill = ON; VACUUM; PRAGMA cache_spill = OFF", error);
  execute(store, "PRAGMA cache_spill = OFF", NULL);
  eo_page_sums_compare(store->handle, true);
  return code ? code : execute(store, "PRAGMA wal_checkpoint(TRUNCATE)", error);
}

static enum eo_code flush(const char *path, struct eo_error *error)
{
  int file = open(path, O_RDONLY | O_CLOEXEC);
  bool good = file >= 0 && fsync(file) == 0;
  enum eo_code code = good ? EO_OK : eo_error_set(error, EO_ERROR_FILE, "", "%.250s: %s.", path, strerror(errno));
  if (file >= 0)
    close(file);
  return code;
}

/* The journal's mode can change only while nobody else is there, and SQLite then does not wait on its own. */
static enum eo_code use_journal(struct eo_store *store, struct eo_error *error)
{
  int fault = SQLITE_BUSY;
  for (int i = 0; i < 100 && (fault & 0xff) == SQLITE_BUSY; i++) {
    if (i)
      sqlite3_sleep(50);
    fault = sqlite3_exec(store->handle, "PRAGMA journal_mode = WAL", NULL, NULL, NULL);
  }
  return fault ? eo_store_fault(store, fault, error) : EO_OK;
}

/* SQLite takes a journal without its database for one that was left over, and deletes it. */
static enum eo_code expect_no_lone_journal(const struct eo_store *store, struct eo_error *error)
{
  struct stat database = {0}, journal = {0};
  char *name = malloc(strlen(store->path) + sizeof "-wal");
  if (!name)
    return eo_error_memory(error);
  sprintf(name, "%s-wal", store->path);
  bool left = stat(name, &journal) == 0 && journal.st_size > 0; /* before the database, which is always made first */
  bool alone = left && (stat(store->path, &database) != 0 || database.st_size == 0);
  free(name);
  return alone ? eo_error_set(error, EO_ERROR_FILE, "",
                              "%.150s is missing or empty, but its journal %.150s-wal is there: put the database back, "
                              "or move the journal to another place.",
                              store->path, store->path)
               : EO_OK;
}

/* DIR/easeoff.db.schema-N, as it was: a newer schema cannot be read by an older program. One that is there is of an
   attempt before, and as good. */
static enum eo_code keep_copy(struct eo_store *store, int schema, struct eo_error *error)
{
  struct eo_text path = {0};
  eo_text_print(&path, "%s.schema-%d", store->path, schema);
  if (path.failed)
    return eo_error_memory(error);
  enum eo_code code = EO_OK;
  if (access(path.data, F_OK) != 0)
    code = eo_store_copy(store, path.data, error);
  eo_text_done(&path);
  return code;
}

/* A file of an earlier version has no room for sums: it is written anew, once, while nobody else works on it. Where
   that cannot be done it goes on without them until the next time. */
static void use_sums(struct eo_store *store)
{
  int reserved = EO_PAGE_SUM;
  if (has_sums(store))
    return;
  sqlite3_file_control(store->handle, "main", SQLITE_FCNTL_RESERVE_BYTES, &reserved);
  rebuild(store, NULL);
}

static enum eo_code open_for_writing(struct eo_store *store, int flags, struct eo_error *error)
{
  int schema = 0;
  EO_TRY(expect_no_lone_journal(store, error));
  EO_TRY(connect(store, store->path, SQLITE_OPEN_READWRITE | flags, error));
  EO_TRY(identify(store, &schema, error));
  EO_TRY(use_journal(store, error));
  if (schema && schema < eo_store_schema)
    EO_TRY(keep_copy(store, schema, error));
  EO_TRY(migrate(store, error));
  use_sums(store);
  return EO_OK;
}

/* "file:PATH?immutable=1": a database in WAL mode cannot be read in the usual way where its journal cannot be made. */
static char *name_immutable(const char *path)
{
  static const char before[] = "file:", after[] = "?immutable=1";
  char *name = malloc(3 * strlen(path) + sizeof before + sizeof after), *end = name;
  if (!name)
    return NULL;
  end += sprintf(end, "%s", before);
  for (const unsigned char *c = (const unsigned char *)path; *c; c++)
    end += strchr("?#%", *c) || *c <= ' ' ? sprintf(end, "%%%02X", *c) : sprintf(end, "%c", *c);
  strcpy(end, after);
  return name;
}

/* Where nobody can write nobody does, unless a journal is left: then SQLite has to see it. */
static enum eo_code open_unwritable(struct eo_store *store, struct eo_error *error)
{
  char *name = name_immutable(store->path), *journal = malloc(strlen(store->path) + sizeof "-wal");
  enum eo_code code = name && journal ? EO_OK : eo_error_memory(error);
  if (!code) {
    sprintf(journal, "%s-wal", store->path);
    bool left = access(journal, F_OK) == 0;
    code = connect(store, left ? store->path : name, SQLITE_OPEN_READONLY | (left ? 0 : SQLITE_OPEN_URI), error);
  }
  free(name);
  free(journal);
  return code ? code : expect_present(store, error);
}

static enum eo_code open_for_reading(struct eo_store *store, struct eo_error *error)
{
  if (access(store->path, F_OK))
    return eo_error_set(error, EO_ERROR_INPUT, "", "There is no history in %.200s.", store->directory);
  if (access(store->path, W_OK) == 0 && access(store->directory, W_OK) == 0)
    return open_for_writing(store, 0, error);
  return open_unwritable(store, error);
}

static enum eo_code name_files(struct eo_store *store, const char *directory, struct eo_error *error)
{
  store->directory = strdup(directory);
  store->path = malloc(strlen(directory) + sizeof "/easeoff.db");
  if (!store->directory || !store->path)
    return eo_error_memory(error);
  sprintf(store->path, "%s/easeoff.db", directory);
  return EO_OK;
}

static enum eo_code open_folder(struct eo_store *store, const char *directory, enum eo_store_mode mode,
                                struct eo_error *error)
{
  EO_TRY(name_files(store, directory, error));
  if (mode != EO_STORE_WRITE)
    return open_for_reading(store, error);
  EO_TRY(make_folder(directory, error));
  return open_for_writing(store, SQLITE_OPEN_CREATE, error);
}

enum eo_code eo_store_open(struct eo_store **result, const char *directory, enum eo_store_mode mode,
                           struct eo_error *error)
{
  struct eo_store *store = calloc(1, sizeof *store);
  if (!store)
    return eo_error_memory(error);
  store->lock = -1;
  enum eo_code code = open_folder(store, directory, mode, error);
  if (code)
    eo_store_close(store);
  else
    *result = store;
  return code;
}

void eo_store_close(struct eo_store *store)
{
  if (!store)
    return;
  for (int i = 0; i < EO_STATEMENTS_KEPT; i++)
    sqlite3_finalize(store->kept[i].handle);
  sqlite3_close(store->handle);
  if (store->lock >= 0)
    close(store->lock);
  free(store->directory);
  free(store->path);
  free(store);
}

void eo_store_wait(struct eo_store *store, int milliseconds)
{
  sqlite3_busy_timeout(store->handle, milliseconds);
}

enum eo_code eo_store_begin_lasting(struct eo_store *store, struct eo_error *error)
{
  EO_TRY(execute(store, "PRAGMA synchronous = FULL", error));
  enum eo_code code = eo_store_begin(store, error);
  if (code)
    execute(store, "PRAGMA synchronous = NORMAL", NULL);
  else
    store->lasting = true;
  return code;
}

static void end_lasting(struct eo_store *store)
{
  if (store->lasting)
    execute(store, "PRAGMA synchronous = NORMAL", NULL);
  store->lasting = false;
}

/* Immediate: a transaction that begins as a reader cannot become a writer once somebody else has written. */
enum eo_code eo_store_begin(struct eo_store *store, struct eo_error *error)
{
  return execute(store, "BEGIN IMMEDIATE", error);
}

enum eo_code eo_store_commit(struct eo_store *store, struct eo_error *error)
{
  EO_TRY(execute(store, "COMMIT", error));
  end_lasting(store);
  return EO_OK;
}

void eo_store_rollback(struct eo_store *store)
{
  if (!sqlite3_get_autocommit(store->handle))
    sqlite3_exec(store->handle, "ROLLBACK", NULL, NULL, NULL);
  end_lasting(store);
}

enum eo_code eo_store_end(struct eo_store *store, enum eo_code code, struct eo_error *error)
{
  if (!code)
    code = eo_store_commit(store, error);
  if (code)
    eo_store_rollback(store);
  return code;
}

/* Pages a step: a few milliseconds, after which others have their turn. */
enum eo_code eo_store_compact(struct eo_store *store, struct eo_error *error)
{
  int before = INT_MAX, left = 0, mode = 0;
  EO_TRY(read_integer(store, "PRAGMA auto_vacuum", &mode, error));
  if (mode != 2) /* of an earlier version, with somebody beside it all the time */
    EO_TRY(rebuild(store, error));
  EO_TRY(read_integer(store, "PRAGMA freelist_count", &left, error));
  for (; left && left < before; sqlite3_sleep(1)) {
    before = left;
    EO_TRY(execute(store, "PRAGMA incremental_vacuum(500)", error));
    EO_TRY(read_integer(store, "PRAGMA freelist_count", &left, error));
  }
  return execute(store, "PRAGMA wal_checkpoint(TRUNCATE)", error);
}

enum eo_code eo_store_copy(struct eo_store *store, const char *path, struct eo_error *error)
{
  struct eo_statement statement = eo_statement_begin(store, "VACUUM INTO ?", "t", path);
  enum eo_code code = eo_statement_finish(statement, error);
  if (!code && has_sums(store) && eo_page_sums_renew(path) < 0) /* SQLite wrote pages before the first one, which says
                                                                   that they have sums */
    code = eo_error_set(error, EO_ERROR_FILE, "", "%.250s: %s.", path, strerror(errno));
  if (code)
    unlink(path);
  return code ? code : flush(path, error);
}

enum eo_code eo_store_inspect(struct eo_store *store, bool quickly, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  struct eo_statement statement = quickly ? eo_statement_begin(store, "PRAGMA quick_check(1)", "")
                                          : eo_statement_begin(store, "PRAGMA integrity_check(1)", "");
  if (eo_statement_step(&statement) && strcmp(eo_column_text(&statement, 0), "ok") != 0)
    code = eo_error_set(error, EO_ERROR_DAMAGED, "", "%.150s is damaged: %.200s.", store->path,
                        eo_column_text(&statement, 0));
  enum eo_code end = eo_statement_end(&statement, code ? NULL : error);
  return code ? code : end;
}

int64_t eo_store_size(const struct eo_store *store, int64_t *journal)
{
  struct stat status;
  struct eo_text name = {0};
  eo_text_print(&name, "%s-wal", store->path);
  *journal = !name.failed && stat(name.data, &status) == 0 ? status.st_size : 0;
  eo_text_done(&name);
  return stat(store->path, &status) == 0 ? status.st_size : 0;
}
