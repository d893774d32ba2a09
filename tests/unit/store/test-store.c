/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data folder's database: schema steps, rows and their check sums, two connections, locks, and every way a file can
   be wrong. */
#include <math.h>
#include <sqlite3.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "format/text.h"
#include "store/page_sums.h"
#include "store/evaluations.h"
#include "store/jobs.h"
#include "store/lock.h"
#include "store/migrations.h"
#include "support/tap.h"

enum { CASES = 3 };

static char folder[200], path[240];
static struct eo_error error;

/* Every test begins in an empty folder. */
static void clean(void)
{
  static const char *const names[] = {"easeoff.db", "easeoff.db-wal", "easeoff.db-shm", "easeoff.lock"};
  char name[300];
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    snprintf(name, sizeof name, "%s/%s", folder, names[i]);
    unlink(name);
  }
  snprintf(path, sizeof path, "%s/easeoff.db", folder);
  memset(&error, 0, sizeof error);
}

static struct eo_store *open_store(enum eo_store_mode mode)
{
  struct eo_store *store = NULL;
  if (eo_store_open(&store, folder, mode, &error))
    return NULL;
  return store;
}

/* As another program that knows of the sums in pages: what it writes is taken for ours. */
static int open_beside(sqlite3 **handle)
{
  eo_page_sums_register();
  return sqlite3_open_v2(path, handle, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, eo_page_sums_vfs);
}

/* Straight into the file, past the program. */
static bool execute(const char *sql)
{
  sqlite3 *handle;
  char *message = NULL;
  bool done = open_beside(&handle) == SQLITE_OK && sqlite3_exec(handle, sql, NULL, NULL, &message) == SQLITE_OK;
  if (!done)
    printf("# %s\n", message ? message : sqlite3_errmsg(handle));
  sqlite3_free(message);
  sqlite3_close(handle);
  return done;
}

/* Everything the schema says, as one text (owned). */
static char *read_schema(void)
{
  sqlite3 *handle;
  sqlite3_stmt *statement;
  char *text = calloc(1, 20000);
  open_beside(&handle);
  sqlite3_prepare_v2(handle,
                     "SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL AND name NOT LIKE 'sqlite_%' ORDER BY name",
                     -1, &statement, NULL);
  while (text && sqlite3_step(statement) == SQLITE_ROW) {
    strncat(text, (const char *)sqlite3_column_text(statement, 0), 19999 - strlen(text));
    strncat(text, "\n", 19999 - strlen(text));
  }
  sqlite3_finalize(statement);
  sqlite3_close(handle);
  return text;
}

static int read_integer(const char *sql)
{
  sqlite3 *handle;
  sqlite3_stmt *statement;
  int value = -1;
  open_beside(&handle);
  if (sqlite3_prepare_v2(handle, sql, -1, &statement, NULL) == SQLITE_OK && sqlite3_step(statement) == SQLITE_ROW)
    value = sqlite3_column_int(statement, 0);
  sqlite3_finalize(statement);
  sqlite3_close(handle);
  return value;
}

static const struct eo_stored_problem problem = {
    .hash = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef",
    .spec = "{}",
    .name = "p",
    .evaluator = 1,
    .scenarios = 1,
    .cases = CASES};

static struct eo_stored_evaluation make_row(const char *modification, struct eo_objective_case raw[CASES], double seed)
{
  for (int k = 0; k < CASES; k++) {
    raw[k] = (struct eo_objective_case){.peak_to_peak = 1e-6 / (seed + k),
                                        .impact = 1e3 / 7 * seed,
                                        .rms = 20.1 + seed,
                                        .contact_pressure = 1e9 / 3,
                                        .root_stress = k == 1 ? NAN : 1.5e8,
                                        .edge_load_share = 0.1,
                                        .flank_safety = k ? NAN : 1.2 / 7,
                                        .root_safety = k ? NAN : seed,
                                        .film_ratio = k ? NAN : 0.7,
                                        .contact_temperature = k ? NAN : 99.9,
                                        .failed = k == 2,
                                        .end_impact = {1e3 / 7 * seed, 1e3 / 11}};
    for (int i = 0; i < EO_OBJECTIVE_SAMPLES; i++) /* rows of before have no curve */
      raw[k].transmission[i] = k == 1 ? NAN : 1e-7 * sin(i + seed);
    if (k == 1)
      raw[k].end_impact[0] = raw[k].end_impact[1] = NAN;
  }
  return (struct eo_stored_evaluation){.modification = modification,
                                       .outcome = EO_EVALUATION_NOT_CONVERGED,
                                       .reason = "It did not.",
                                       .cost = 0.01,
                                       .scenarios = 1,
                                       .cases = CASES,
                                       .raw = raw};
}

static bool same_raw(const struct eo_objective_case *a, const struct eo_objective_case *b)
{
  bool same = true;
  for (int k = 0; k < CASES; k++)
    same = same && a[k].peak_to_peak == b[k].peak_to_peak && a[k].impact == b[k].impact && a[k].rms == b[k].rms &&
           a[k].contact_pressure == b[k].contact_pressure &&
           (a[k].root_stress == b[k].root_stress || (isnan(a[k].root_stress) && isnan(b[k].root_stress))) &&
           (k || (a[k].flank_safety == b[k].flank_safety && a[k].root_safety == b[k].root_safety &&
                  a[k].film_ratio == b[k].film_ratio && a[k].contact_temperature == b[k].contact_temperature)) &&
           isnan(a[1].flank_safety) && isnan(b[1].flank_safety) && a[k].edge_load_share == b[k].edge_load_share &&
           a[k].contact_loss == b[k].contact_loss && a[k].failed == b[k].failed;
  return same;
}

static int64_t add(struct eo_store *store, int64_t id, struct eo_stored_evaluation *row)
{
  bool good = !eo_store_begin(store, &error) && !eo_store_add_evaluation(store, id, row, &error) &&
              !eo_store_commit(store, &error);
  return good ? row->id : -1;
}

static int64_t add_problem(struct eo_store *store)
{
  int64_t id = 0;
  bool good = !eo_store_begin(store, &error) && !eo_store_find_problem(store, &problem, &id, &error) &&
              !eo_store_commit(store, &error);
  return good ? id : -1;
}

static void test_new(void)
{
  clean();
  struct eo_store *store = open_store(EO_STORE_READ);
  ok(!store && error.code == EO_ERROR_INPUT && strstr(error.text, "no history"),
     "reading where nothing is is refused: %s", error.text);
  ok(access(path, F_OK) != 0, "reading where nothing is makes nothing");
  store = open_store(EO_STORE_WRITE);
  ok(store != NULL, "a new database is made %s", error.text);
  ok(eo_store_inspect(store, false, &error) == EO_OK, "a new database is sound");
  eo_store_close(store);
  ok(read_integer("PRAGMA user_version") == eo_store_schema && read_integer("PRAGMA application_id") == 0x45415345,
     "version and application are marked");
  ok(read_integer("SELECT count(*) FROM pragma_table_list WHERE schema = 'main' AND type = 'table' AND strict = 0 AND "
                  "name NOT LIKE 'sqlite_%'") == 0,
     "every table is strict");
}

static enum eo_code count_row(void *context, const struct eo_stored_evaluation *row, const double *x, int size,
                              struct eo_error *fault)
{
  (void)row;
  (void)x;
  (void)size;
  (void)fault;
  ++*(int *)context;
  return EO_OK;
}

/* A kept copy of every schema that was ever released. */
static void test_older(int version)
{
  char file[300];
  struct eo_text sql = {0};
  clean();
  struct eo_store *store = open_store(EO_STORE_WRITE);
  eo_store_close(store);
  char *fresh = read_schema();
  clean();
  snprintf(file, sizeof file, "%s/tests/schema/%04d.sql", getenv("SOURCES") ? getenv("SOURCES") : ".", version);
  ok(eo_text_read(&sql, file, 1 << 20, &error) == EO_OK && execute(sql.data), "a database of schema %d is made",
     version);
  store = open_store(EO_STORE_WRITE);
  ok(store != NULL, "a database of an older schema is opened %s", error.text);
  int rows = 0;
  enum eo_code code = store ? eo_store_each_evaluation(store, 1, 0, NULL, 1, 3, count_row, &rows, &error)
                            : EO_ERROR_FILE;
  ok(!code && rows == 4, "%d of its 4 rows are there and sound %s", rows, error.text);
  eo_store_close(store);
  char *migrated = read_schema();
  ok(read_integer("PRAGMA user_version") == eo_store_schema && strcmp(fresh, migrated) == 0,
     "the schema of an older database becomes that of a new one");
  ok(version < 2 || read_integer("SELECT count(*) FROM candidate c JOIN job j ON j.id = c.job") == 3,
     "what refers to a table that was replaced is still there");
  ok(read_integer("SELECT count(*) FROM design WHERE json_extract(document, '$.version') IS NOT 1") == 0,
     "the stored designs of an older database are documents of version 1");
  free(fresh);
  free(migrated);
  eo_text_done(&sql);
}

static void test_strangers(void)
{
  clean();
  eo_store_close(open_store(EO_STORE_WRITE));
  execute("PRAGMA user_version = 99");
  ok(!open_store(EO_STORE_WRITE) && error.code == EO_ERROR_FILE && strstr(error.text, "newer version"),
     "a database of a newer schema is refused: %s", error.text);
  ok(!open_store(EO_STORE_READ) && strstr(error.text, "newer version"),
     "a database of a newer schema is refused to readers too");
  clean();
  execute("CREATE TABLE cake (x)");
  ok(!open_store(EO_STORE_WRITE) && strstr(error.text, "another program"),
     "the database of another program is refused: %s", error.text);
  ok(read_integer("SELECT count(*) FROM sqlite_schema") == 1, "the database of another program is left alone");
  clean();
  FILE *file = fopen(path, "w");
  for (int i = 0; i < 5000; i++)
    fputs("no database ", file);
  fclose(file);
  ok(!open_store(EO_STORE_WRITE) && strstr(error.text, "damaged"), "a file that is no database is refused: %s",
     error.text);
}

/* A step that fails must leave the older schema as it was. */
static void test_failed_step(void)
{
  clean();
  execute("CREATE TABLE problem (x); PRAGMA application_id = 1161909061;");
  ok(!open_store(EO_STORE_WRITE) && error.code == EO_ERROR_FILE, "a step of the schema that fails is told: %s",
     error.text);
  ok(read_integer("PRAGMA user_version") == 0 && read_integer("SELECT count(*) FROM sqlite_schema") == 1,
     "a step of the schema that fails leaves nothing behind");
}

static void test_rows(void)
{
  struct eo_objective_case raw[CASES], other[CASES], found[CASES];
  clean();
  struct eo_store *store = open_store(EO_STORE_WRITE);
  int64_t id = add_problem(store);
  ok(id == 1 && add_problem(store) == 1, "a problem is known by its hash");
  struct eo_stored_evaluation row = make_row("{\"a\":1}", raw, 3),
                              back = {.scenarios = 1, .cases = CASES, .raw = found};
  ok(eo_store_find_evaluation(store, id, "{\"a\":1}", &back, &error) == EO_OK && back.id == 0,
     "a row that is not there is not found");
  ok(add(store, id, &row) == 1, "a row is added %s", error.text);
  ok(eo_store_find_evaluation(store, id, "{\"a\":1}", &back, &error) == EO_OK && back.id == 1 && same_raw(raw, found) &&
         back.cost == 0.01 && back.outcome == EO_EVALUATION_NOT_CONVERGED && strcmp(back.reason, "It did not.") == 0,
     "a row comes back bit for bit");
  struct eo_stored_evaluation again = make_row("{\"a\":1}", other, 5);
  ok(add(store, id, &again) == 1 && same_raw(raw, other), "a second row for the same point becomes the first");
  ok(eo_store_find_evaluation(store, 7, "{\"a\":1}", &back, &error) == EO_OK && back.id == 0,
     "another problem does not know the row");
  eo_store_begin(store, &error);
  row = make_row("{\"a\":2}", raw, 4);
  eo_store_add_evaluation(store, id, &row, &error);
  eo_store_rollback(store);
  int64_t last;
  eo_store_last_evaluation(store, &last, &error);
  ok(last == 1, "a transaction that is not finished leaves nothing");
  row = make_row("no json", raw, 4);
  ok(add(store, id, &row) == -1 && error.code == EO_ERROR_FILE, "what is no JSON is refused: %s", error.text);
  eo_store_rollback(store);
  eo_store_close(store);
}

static void test_curves(void)
{
  struct eo_objective_case raw[CASES], found[CASES];
  clean();
  struct eo_store *store = open_store(EO_STORE_WRITE);
  int64_t id = add_problem(store);
  struct eo_stored_evaluation row = make_row("{\"a\":1}", raw, 3),
                              back = {.scenarios = 1, .cases = CASES, .raw = found};
  add(store, id, &row);
  ok(eo_store_find_evaluation(store, id, "{\"a\":1}", &back, &error) == EO_OK &&
         memcmp(found[0].transmission, raw[0].transmission, sizeof raw[0].transmission) == 0 &&
         memcmp(found[2].end_impact, raw[2].end_impact, sizeof raw[2].end_impact) == 0,
     "a transmission error comes back bit for bit");
  ok(isnan(found[1].transmission[5]) && isnan(found[1].end_impact[0]), "a curve that was not kept is no number");
  execute("UPDATE raw SET curve = (SELECT curve FROM raw WHERE load_case = 2) WHERE load_case = 1");
  ok(eo_store_find_evaluation(store, id, "{\"a\":1}", &back, &error) == EO_ERROR_DAMAGED,
     "a curve that came from elsewhere is refused: %s", error.text);
  eo_store_close(store);
}

static void test_damage(void)
{
  struct eo_objective_case raw[CASES];
  clean();
  struct eo_store *store = open_store(EO_STORE_WRITE);
  int64_t id = add_problem(store), removed = 0;
  char text[40];
  for (int i = 0; i < 5; i++) {
    snprintf(text, sizeof text, "{\"a\":%d}", i);
    struct eo_stored_evaluation row = make_row(text, raw, i + 1);
    add(store, id, &row);
  }
  execute("UPDATE raw SET rms_m_per_s2 = rms_m_per_s2 * 1.0000001 WHERE evaluation = 3 AND load_case = 1; DELETE FROM "
          "raw WHERE evaluation = 4 AND load_case = 2");
  struct eo_stored_evaluation back = {.scenarios = 1, .cases = CASES, .raw = raw};
  ok(eo_store_find_evaluation(store, id, "{\"a\":2}", &back, &error) == EO_ERROR_DAMAGED && strstr(error.text, "row 3"),
     "a row with a changed number is told as damaged: %s", error.text);
  ok(eo_store_find_evaluation(store, id, "{\"a\":3}", &back, &error) == EO_ERROR_DAMAGED && strstr(error.text, "row 4"),
     "a row with a missing number is told as damaged");
  int rows = 0;
  ok(eo_store_each_evaluation(store, id, 0, NULL, 1, CASES, count_row, &rows, &error) == EO_ERROR_DAMAGED && rows == 2,
     "no row is handed out from the damage on");
  bool good = !eo_store_begin(store, &error) && !eo_store_remove_damaged(store, &removed, &error) &&
              !eo_store_commit(store, &error);
  rows = 0;
  ok(good && removed == 2, "both damaged rows can be removed %s", error.text);
  ok(eo_store_each_evaluation(store, id, 0, NULL, 1, CASES, count_row, &rows, &error) == EO_OK && rows == 3,
     "the other three rows stay");
  eo_store_close(store);
}

/* Rows of test_garbage() are known by their modification. */
static enum eo_code check_row(void *context, const struct eo_stored_evaluation *row, const double *x, int size,
                              struct eo_error *fault)
{
  struct eo_objective_case expected[CASES];
  int a = -1;
  make_row("", expected, sscanf(row->modification, "{\"a\":%d}", &a) == 1 ? (double)a + 1 : (double)NAN);
  if (!same_raw(row->raw, expected) || row->cost != 0.01)
    *(int *)context += 1000;
  return count_row(context, row, x, size, fault);
}

/* Random bytes over the file: an error or sound rows, never a wrong number. */
static void test_garbage(void)
{
  struct eo_objective_case raw[CASES];
  int refused = 0, whole = 0, wrong = 0;
  for (int round = 0; round < 60; round++) {
    clean();
    struct eo_store *store = open_store(EO_STORE_WRITE);
    int64_t id = add_problem(store);
    char text[40];
    eo_store_begin(store, &error);
    for (int i = 0; i < 40; i++) {
      snprintf(text, sizeof text, "{\"a\":%d}", i);
      struct eo_stored_evaluation row = make_row(text, raw, i + 1);
      eo_store_add_evaluation(store, id, &row, &error);
    }
    eo_store_commit(store, &error);
    eo_store_close(store);
    FILE *file = fopen(path, "r+");
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    for (int i = 0; i < 1 + round % 5; i++) {
      fseek(file, 100 + (long)((unsigned)(round * 7919 + i * 104729) % (unsigned)(size - 100)), SEEK_SET);
      fputc((round * 31 + i * 17) & 255, file);
    }
    fclose(file);
    int rows = 0;
    store = open_store(EO_STORE_WRITE);
    enum eo_code code = store ? eo_store_each_evaluation(store, id, 0, NULL, 1, CASES, check_row, &rows, &error)
                              : EO_ERROR_FILE;
    wrong += rows > 40;
    refused += code == EO_ERROR_FILE || code == EO_ERROR_DAMAGED;
    whole += code == EO_OK;
    eo_store_close(store);
  }
  ok(refused + whole == 60 && refused > 20 && !wrong,
     "garbage is written into 60 files: %d refused, %d untouched where it matters, %d with a wrong row", refused, whole,
     wrong);
}

static void test_two(void)
{
  struct eo_objective_case raw[CASES];
  clean();
  struct eo_store *one = open_store(EO_STORE_WRITE), *two = open_store(EO_STORE_WRITE);
  int64_t id = add_problem(one);
  struct eo_stored_evaluation row = make_row("{}", raw, 1);
  eo_store_begin(one, &error);
  eo_store_add_evaluation(one, id, &row, &error);
  eo_store_wait(two, 100);
  ok(eo_store_begin(two, &error) == EO_ERROR_BUSY && strstr(error.text, "locked"),
     "a second writer waits, and is then refused: %s", error.text);
  struct eo_stored_evaluation back = {.scenarios = 1, .cases = CASES, .raw = raw};
  ok(eo_store_find_evaluation(two, id, "{}", &back, &error) == EO_OK && back.id == 0,
     "readers do not wait and see what was there before the writer");
  eo_store_commit(one, &error);
  ok(eo_store_find_evaluation(two, id, "{}", &back, &error) == EO_OK && back.id == 1,
     "readers see what the writer committed");
  row = make_row("{\"b\":1}", raw, 2);
  ok(add(two, id, &row) == 2, "the second writer writes after the first");
  eo_store_close(one);
  eo_store_close(two);
}

static void test_jobs(void)
{
  struct eo_objective_case raw[CASES];
  static const char hash[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";
  clean();
  struct eo_store *one = open_store(EO_STORE_WRITE), *two = open_store(EO_STORE_WRITE);
  int64_t id = add_problem(one);
  struct eo_stored_evaluation row = make_row("{}", raw, 1);
  add(one, id, &row);
  struct eo_stored_job job = {.problem = id,
                              .study = hash,
                              .space = hash,
                              .design = "{}",
                              .name = "j",
                              .algorithm = "ga",
                              .state = EO_JOB_RUNNING,
                              .best_value = NAN},
                       same = {0};
  bool taken = false;
  ok(eo_store_resume_job(one, hash, false, &same, &error) == EO_OK && same.id == 0,
     "a study without a job takes none up");
  ok(eo_store_add_job(one, &job, &error) == EO_OK && job.import_upto == 1 &&
         !eo_store_claim_job(one, job.id, &taken, &error) && taken,
     "a job begins that knows one row");
  ok(eo_store_resume_job(two, hash, false, &same, &error) == EO_OK && same.id == 0,
     "a job that somebody works on is not taken up");
  ok(eo_store_job_is_taken(two, job.id), "another connection sees that the job is taken");
  eo_store_close(one);
  ok(!eo_store_job_is_taken(two, job.id), "another connection sees that the job was left");
  ok(eo_store_resume_job(two, hash, true, &same, &error) == EO_OK && same.id == 0, "a fresh study is another job");
  ok(eo_store_resume_job(two, hash, false, &same, &error) == EO_OK && same.id == job.id && same.import_upto == 1,
     "a job that was left is taken up");
  const double x[2] = {0.25, 1};
  struct eo_stored_candidate candidate = {
      .job = job.id, .evaluation = 1, .ordinal = 0, .reused = false, .x = x, .size = 2};
  eo_store_log_candidate(two, &candidate, &error);
  candidate.reused = true;
  ok(eo_store_log_candidate(two, &candidate, &error) == EO_OK && !candidate.reused, "a row that a job logged stays");
  eo_store_close(two);
}

static void test_folders(void)
{
  struct eo_store *store = NULL;
  char file[300];
  clean();
  eo_store_close(open_store(EO_STORE_WRITE));
  snprintf(file, sizeof file, "%s/easeoff.db/below", folder);
  ok(eo_store_open(&store, file, EO_STORE_WRITE, &error) == EO_ERROR_FILE && strstr(error.text, "cannot be made"),
     "a folder below a file is not made: %s", error.text);
  ok(eo_store_open(&store, path, EO_STORE_WRITE, &error) == EO_ERROR_FILE && strstr(error.text, "cannot be made"),
     "a file in the place of the folder is refused: %s", error.text);
}

int main(void)
{
  snprintf(folder, sizeof folder, "%s/easeoff-store-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  if (!mkdtemp(folder))
    return 99;
  test_new();
  for (int version = 1; version <= eo_store_schema; version++)
    test_older(version);
  test_strangers();
  test_failed_step();
  test_rows();
  test_curves();
  test_damage();
  test_garbage();
  test_two();
  test_jobs();
  test_folders();
  clean();
  rmdir(folder);
  return tap_done();
}
