/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every allocation of our own code fails once, and so does every call that writes: each place (the call and who called
   it) in a run of its own, until a run meets no new place. What is run then has to end with an error that says what is
   wrong, or to do without; nothing may crash, and with the address sanitizer nothing may leak. The linker leads the
   calls of our objects here (--wrap); the libraries below keep their own. */
#define _GNU_SOURCE
#include "document/design_document.h"
#include "document/examples.h"
#include "document/measure_file.h"
#include "document/result.h"
#include "evaluation/analysis.h"
#include "exchange/exports.h"
#include "exchange/import.h"
#include "format/json.h"
#include "store/backup.h"
#include "store/designs.h"
#include "store/measurements.h"
#include "store/queue.h"
#include "store/store.h"
#include "support/tap.h"

#include <errno.h>
#include <ftw.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <unwind.h>

/* Frames that tell places apart: the same allocation from another caller is another way out. DEPTH=N takes more of
   them, and longer. */
enum { FRAMES = 2, PLACES = 1 << 14, MOST_RUNS = 4000 };
static int frames = FRAMES;

static struct {
  atomic_bool armed;  /* a new place fails */
  atomic_bool fallen; /* one has failed in this run */
  atomic_uint_least64_t seen[PLACES];
  atomic_int places;
  bool writes; /* calls that write, else allocations */
} fault;

struct walk {
  uint64_t hash;
  int frames;
};

static _Unwind_Reason_Code step(struct _Unwind_Context *context, void *argument)
{
  struct walk *walk = argument;
  if (walk->frames++ >= 2) /* this file's own */
    walk->hash = (walk->hash ^ (uint64_t)_Unwind_GetIP(context)) * 1099511628211u;
  return walk->frames > frames + 2 ? _URC_END_OF_STACK : _URC_NO_REASON;
}

/* Whether this call shall fail: the first one from a place that was not met before, one in a run. */
static bool falls(bool writes)
{
  struct walk walk = {14695981039346656037u, 0};
  if (!atomic_load(&fault.armed) || fault.writes != writes || atomic_load(&fault.fallen))
    return false;
  _Unwind_Backtrace(step, &walk);
  for (uint64_t i = walk.hash % PLACES;; i = (i + 1) % PLACES) {
    uint64_t free_place = 0;
    if (atomic_load(&fault.seen[i]) == walk.hash)
      return false;
    if (atomic_load(&fault.seen[i]) == 0 && atomic_compare_exchange_strong(&fault.seen[i], &free_place, walk.hash)) {
      atomic_fetch_add(&fault.places, 1);
      return !atomic_exchange(&fault.fallen, true);
    }
  }
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
char *__real_strdup(const char *text);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
char *__wrap_strdup(const char *text);

void *__wrap_malloc(size_t size)
{
  return falls(false) ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
  return falls(false) ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *old, size_t size)
{
  return falls(false) ? NULL : __real_realloc(old, size);
}

char *__wrap_strdup(const char *text)
{
  return falls(false) ? NULL : __real_strdup(text);
}

/* The disk is full. */
static bool is_full(void)
{
  bool full = falls(true);
  if (full)
    errno = ENOSPC;
  return full;
}

#define WRAP(type, name, parameters, arguments, failed)    \
  type __real_##name parameters;                           \
  type __wrap_##name parameters;                           \
  type __wrap_##name parameters                            \
  {                                                        \
    return is_full() ? (failed) : __real_##name arguments; \
  }
WRAP(ssize_t, write, (int file, const void *bytes, size_t size), (file, bytes, size), -1)
WRAP(size_t, fwrite, (const void *bytes, size_t size, size_t count, FILE *file), (bytes, size, count, file), 0)
WRAP(int, fflush, (FILE * file), (file), EOF)
WRAP(int, fsync, (int file), (file), -1)
WRAP(int, mkdir, (const char *path, mode_t mode), (path, mode), -1)
WRAP(char *, mkdtemp, (char *path), (path), NULL)
WRAP(int, rename, (const char *from, const char *to), (from, to), -1)
WRAP(int, link, (const char *from, const char *to), (from, to), -1)

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

static const char *name_file(const char *name)
{
  static char path[2][300];
  static int turn;
  turn = !turn;
  snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
  return path[turn];
}

/* What a run came to: an error, or not. */
typedef enum eo_code scenario(struct eo_error *error);

/* Runs it until no new place is met. Every error has a sentence. */
static void try_all(const char *what, scenario *run, bool writes)
{
  int runs = 0, told = 0, silent = 0, first = atomic_load(&fault.places);
  struct eo_error error;
  bool more = true;
  fault.writes = writes;
  for (; more && runs < MOST_RUNS; runs++) {
    error = (struct eo_error){0};
    atomic_store(&fault.fallen, false);
    atomic_store(&fault.armed, true);
    enum eo_code code = run(&error);
    atomic_store(&fault.armed, false);
    more = atomic_load(&fault.fallen);
    told += code != EO_OK;
    if (code && (!*error.text || error.code != code)) {
      silent++;
      printf("# %s: code %d, error %d \"%s\"\n", what, (int)code, (int)error.code, error.text);
    }
    if (code && !more)
      printf("# %s: %s\n", what, error.text);
  }
  atomic_store(&fault.fallen, false);
  bool well = run(&error) == EO_OK;
  int places = atomic_load(&fault.places) - first;
  ok(well && !silent && !more, "%s: %d %s failed once, %d were told, the last run went well", what, places,
     writes ? "writes" : "allocations", told);
}

static struct eo_design design;
static struct eo_geometry geometry;
static char *design_text;

static void make_design(void)
{
  struct eo_error error;
  eo_example_build("paper", &design);
  struct eo_resolution *r = &design.resolution;
  design.load_cases = 1;
  design.load_case[0].share = 1;
  r->positions = 8;
  r->cells_per_line = 4;
  r->elements.body = EO_BODY_SECTOR;
  r->elements.sector_teeth = 3;
  r->elements.neighbour_coupling = false;
  r->elements.layers = 4;
  r->elements.flank_rows = 4;
  r->elements.fillet_elements = 6;
  r->harmonics = 4;
  r->te_harmonics = 4;
  struct eo_text text = {0};
  if (eo_design_complete(&design, &geometry, &error))
    printf("Bail out! %s\n", error.text);
  eo_design_write(&design, &text);
  design_text = text.data;
}

static enum eo_code decode(struct eo_error *error)
{
  static struct eo_design read;
  struct eo_geometry own;
  struct eo_warnings warnings = {0};
  return eo_design_read(design_text, strlen(design_text), &read, &own, &warnings, error);
}

static struct eo_pair *kept_pair;

static enum eo_code prepare(struct eo_error *error)
{
  const struct eo_pair_options options = {.cache_directory = name_file("flexibility")};
  struct eo_pair *pair = NULL;
  enum eo_code code = eo_pair_new(&pair, &design, &options, NULL, error);
  if (code)
    return code;
  if (!kept_pair)
    kept_pair = pair;
  else
    eo_pair_free(pair);
  return EO_OK;
}

/* Times differ from run to run. */
static void cut_times(struct eo_text *text)
{
  char *times = text->data ? strstr(text->data, "\"timing_ms\":{") : NULL, *end = times ? strchr(times, '}') : NULL;
  if (end)
    memmove(times, end, strlen(end) + 1);
}

static char *expected; /* the document of a run in which nothing failed */
static int different;

/* What does without something gives the same numbers. */
static void compare(struct eo_text *text)
{
  cut_times(text);
  if (!expected)
    expected = strdup(text->data);
  else if (strcmp(expected, text->data) != 0) {
    size_t at = 0;
    while (expected[at] == text->data[at])
      at++;
    printf("# %.60s, expected %.60s\n", text->data + (at < 30 ? 0 : at - 30), expected + (at < 30 ? 0 : at - 30));
    different++;
  }
}

static enum eo_code analyse(struct eo_error *error)
{
  struct eo_analysis *analysis = NULL;
  struct eo_text text = {0};
  const struct eo_warnings warnings = {0};
  enum eo_code code = eo_analysis_new(&analysis, kept_pair, error);
  if (!code)
    code = eo_analysis_run(analysis, &design, EO_WANT_CURVES | EO_WANT_ROOT, error);
  if (!code)
    code = eo_result_write(analysis, &design, &warnings, 0, &text, error);
  if (!code && text.failed)
    code = eo_error_memory(error);
  if (!code)
    compare(&text);
  eo_text_done(&text);
  eo_analysis_free(analysis);
  return code;
}

static struct eo_text foreign; /* a file of another program */
static int foreign_pair;       /* that is chosen of it; 0: the only one */

/* The whole answer or an error: what is read without a check would be another answer. */
static enum eo_code import_file(struct eo_error *error)
{
  const struct eo_import_options options = {.pair = foreign_pair, .flank = 1};
  struct eo_import import;
  struct eo_text text = {0};
  enum eo_code code = eo_import_read(&import, foreign.data, foreign.size, &options, error);
  json_t *answer = code ? NULL : eo_import_encode(&import);
  if (!code && !answer)
    code = eo_error_memory(error);
  if (answer)
    eo_json_write(&text, answer, EO_JSON_COMPACT);
  if (!code && text.failed)
    code = eo_error_memory(error);
  if (!code)
    compare(&text);
  json_decref(answer);
  eo_text_done(&text);
  eo_import_done(&import);
  return code;
}

static void try_foreign(const char *what, int pair)
{
  foreign_pair = pair;
  free(expected);
  expected = NULL;
  different = 0;
  struct eo_error error;
  import_file(&error);
  try_all(what, import_file, false);
  ok(expected && !different, "an import with a failed allocation reads the same or fails");
  eo_text_done(&foreign);
}

static void try_imports(void)
{
  static const struct {
    const char *name;
    int pair;
  } file[] = {{"errors-1.6.rexs", 0},        {"two-stage-1.5.rexsj", 0},   {"two-stage-1.5.rexs", 2},
              {"paper-case-b-1.4.rexsz", 0}, {"paper-case-b-1.7.rexs", 0}, {"paper-case-b-2.0.0.rexsj", 0},
              {"single-crowned-1.7.rexs", 0}};
  struct eo_error error;
  char path[500];
  for (int i = 0; i < (int)(sizeof file / sizeof *file); i++) {
    snprintf(path, sizeof path, "%s/exchange/%s", getenv("CASES") ? getenv("CASES") : "tests/cases", file[i].name);
    if (ok(eo_text_read(&foreign, path, (size_t)1 << 20, &error) == EO_OK, "%s is loaded", file[i].name))
      try_foreign(file[i].name, file[i].pair);
  }
  eo_text_add(&foreign, "key;pinion;gear;unit\nname;one;;\nz;17;44;\nzz;1;;\nkey;pinion;gear;unit\nz;1;2;\n");
  try_foreign("a table of two designs", 2);
  eo_text_add(&foreign, "name,gear_pair.pinion_teeth,zz\none,17,1\n");
  try_foreign("a table with a key that is none", 0);
  eo_exports_find("rexs")->write(&design, &geometry, &foreign);
  try_foreign("a file of our own", 0);
}

static const char hash[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

static enum eo_code add_recording(struct eo_store *store, struct eo_error *error)
{
  static int number;
  char incoming[300], digest[EO_HASH_LENGTH + 1];
  enum eo_measurement_outcome outcome;
  snprintf(digest, sizeof digest, "%064d", ++number);
  const struct eo_stored_measurement row = {.design = 1,
                                            .digest = digest,
                                            .torque = 1,
                                            .speed = 1,
                                            .layout = "",
                                            .pair = hash,
                                            .summary = "{}",
                                            .result = "{}",
                                            .files = 1,
                                            .file = {{.name = "a.csv", .size = 1}}};
  eo_hash_hex("1", 1, ((struct eo_measurement_file *)&row.file[0])->sha256);
  enum eo_code code = eo_measurement_folder_new(store, incoming, sizeof incoming, error);
  if (code)
    return code;
  char file[320];
  snprintf(file, sizeof file, "%s/0", incoming);
  FILE *stream = fopen(file, "w");
  if (stream) {
    fputs("1", stream);
    fclose(stream);
  }
  code = eo_store_add_measurement(store, &row, incoming, NULL, NULL, &outcome, error);
  if (code)
    eo_measurement_folder_remove(incoming);
  return code;
}

static enum eo_code keep(struct eo_error *error)
{
  struct eo_store *store = NULL;
  enum eo_design_outcome outcome;
  enum eo_job_outcome ordered;
  int64_t job;
  const struct eo_queue_entry entry = {.kind = EO_JOB_OPTIMIZE, .design = "{}", .name = "a job", .algorithm = "ga"};
  enum eo_code code = eo_store_open(&store, folder, EO_STORE_WRITE, error);
  if (!code)
    code = eo_store_add_design(store, "a", "{}", 100000, NULL, NULL, &outcome, error);
  if (!code)
    code = eo_queue_add(store, &entry, 100000, &job, &ordered, error);
  if (!code)
    code = add_recording(store, error);
  eo_store_close(store);
  return code;
}

static enum eo_code back_up(struct eo_error *error)
{
  struct eo_store *store = NULL;
  struct eo_backup_report report;
  char archive[300], other[300];
  snprintf(archive, sizeof archive, "%s", name_file("archive.tar.gz"));
  snprintf(other, sizeof other, "%s", name_file("restored"));
  unlink(archive);
  enum eo_code code = eo_store_open(&store, folder, EO_STORE_READ, error);
  if (!code)
    code = eo_backup_write(store, archive, 0, &report, error);
  if (!code)
    code = eo_backup_restore(other, archive, &report, error);
  eo_store_close(store);
  return code;
}

/* Nothing of what failed stays beside what is kept. */
static int count_leftovers(void)
{
  char command[900];
  int count = -1;
  snprintf(command, sizeof command, "ls %s %s/restored %s/measurements | grep -cE 'part-|copy-|restore-|incoming-'",
           folder, folder, folder);
  FILE *stream = popen(command, "r");
  if (!stream || fscanf(stream, "%d", &count) != 1)
    count = -1;
  if (stream)
    pclose(stream);
  return count;
}

static bool record(void)
{
  FILE *stream = fopen(name_file("run.csv"), "w");
  if (!stream)
    return false;
  fprintf(stream, "time_s,pinion_deg,gear_deg\n");
  for (int i = 0; i < 4000; i++) {
    double t = i / 8000.0, angle = 360 * 33.0 * t;
    fprintf(stream, "%.8f,%.6f,%.6f\n", t, angle, angle * 17 / 44 + 0.001 * sin(17 * angle * M_PI / 180));
  }
  fclose(stream);
  return true;
}

static enum eo_code measure(struct eo_error *error)
{
  json_t *document = NULL;
  const struct eo_measure_request request = {.path = name_file("run.csv"),
                                             .torque = 800,
                                             .stated_speed = NAN,
                                             .geometry = &geometry,
                                             .spool_directory = folder};
  enum eo_code code = eo_measure_file(&request, NULL, &document, NULL, NULL, error);
  json_decref(document);
  return code;
}

int main(void)
{
  if (getenv("DEPTH"))
    frames = atoi(getenv("DEPTH"));
  snprintf(folder, sizeof folder, "%s/easeoff-faults-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  if (!__real_mkdtemp(folder))
    return 99;
  make_design();
  try_all("reading a design", decode, false);
  try_all("preparing a pair", prepare, false);
  try_all("keeping a prepared pair", prepare, true);
  struct eo_error error;
  analyse(&error);
  try_all("an analysis and its document", analyse, false);
  ok(expected && !different, "an analysis that does without something gives the same numbers");
  try_imports();
  if (record()) {
    try_all("measuring a recording", measure, false);
    try_all("spooling a recording", measure, true);
  }
  empty();
  try_all("storing", keep, false);
  try_all("storing on a full disk", keep, true);
  try_all("backup and restore", back_up, false);
  try_all("backup and restore on a full disk", back_up, true);
  ok(count_leftovers() == 0, "nothing half-written stays: %d", count_leftovers());
  eo_pair_free(kept_pair);
  free(design_text);
  free(expected);
  empty();
  rmdir(folder);
  return tap_done();
}
