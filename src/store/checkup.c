/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/checkup.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "store/designs.h"
#include "store/evaluations.h"
#include "store/measurement_files.h"
#include "store/measurements.h"
#include "store/page_sums.h"
#include "store/queue.h"
#include "store/statement.h"

enum { TOLD_PAGES = 20 };

struct looking {
  struct eo_store *store;
  eo_checkup_visit *visit;
  void *context;
  struct eo_checkup *sum;
};

__attribute__((format(printf, 3, 4))) static void tell(struct looking *looking, enum eo_loss loss, const char *format,
                                                       ...)
{
  char text[500];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  const struct eo_finding_of_store finding = {loss, text};
  looking->sum->lost += loss == EO_LOSS_LOST;
  looking->sum->again += loss == EO_LOSS_AGAIN;
  looking->visit(looking->context, &finding);
}

/* The table or index that a page belongs to, found without comparing. */
static void name_owner(struct looking *looking, int64_t page, char *name, size_t size)
{
  eo_page_sums_compare(looking->store->handle, false);
  struct eo_statement statement = eo_statement_begin(looking->store, "SELECT name FROM dbstat WHERE pageno = ?", "i",
                                                     page);
  snprintf(name, size, "%s", eo_statement_step(&statement) ? eo_column_text(&statement, 0) : "");
  eo_statement_end(&statement, NULL);
  eo_page_sums_compare(looking->store->handle, true);
}

static void look_at_page(struct looking *looking, const unsigned char *page, size_t size, int64_t number, int *wrong)
{
  char owner[80];
  looking->sum->pages++;
  if (eo_page_sum_holds(page, size, (unsigned)number) || ++*wrong > TOLD_PAGES)
    return;
  name_owner(looking, number, owner, sizeof owner);
  tell(looking, EO_LOSS_NOTE, "Page %lld of the database is not what was written%s%s.", (long long)number,
       *owner ? "; it belongs to " : "", owner);
}

/* Pages that are written while they are read here may differ for a moment: those that do are read once more. */
static enum eo_code look_at_pages(struct looking *looking, struct eo_error *error)
{
  size_t size = 0;
  int wrong = 0, file = open(looking->store->path, O_RDONLY | O_CLOEXEC);
  unsigned char header[100];
  if (file < 0 || pread(file, header, sizeof header, 0) != (ssize_t)sizeof header) {
    enum eo_code code = eo_error_set(error, EO_ERROR_FILE, "", "%.250s: %s.", looking->store->path, strerror(errno));
    if (file >= 0)
      close(file);
    return code;
  }
  size = (size_t)header[16] << 8 | header[17];
  size = size == 1 ? 65536 : size;
  unsigned char *page = header[20] == EO_PAGE_SUM && size >= 512 ? malloc(size) : NULL;
  if (!page)
    tell(looking, EO_LOSS_NOTE,
         "The pages of the database have no sums yet: they get them when a server starts alone.");
  for (int64_t number = 1; page && pread(file, page, size, (number - 1) * (int64_t)size) == (ssize_t)size; number++) {
    if (!eo_page_sum_holds(page, size, (unsigned)number) &&
        pread(file, page, size, (number - 1) * (int64_t)size) != (ssize_t)size)
      break;
    look_at_page(looking, page, size, number, &wrong);
  }
  if (wrong > TOLD_PAGES)
    tell(looking, EO_LOSS_NOTE, "And %d pages more.", wrong - TOLD_PAGES);
  free(page);
  close(file);
  return EO_OK;
}

static int64_t find_last(struct looking *looking, const char *sql)
{
  struct eo_statement statement = eo_statement_begin(looking->store, sql, "");
  int64_t last = eo_statement_step(&statement) ? eo_column_integer(&statement, 0) : 0;
  eo_statement_end(&statement, NULL);
  return last;
}

#define LAST_OF(table) "SELECT ifnull((SELECT seq FROM sqlite_sequence WHERE name = '" table "'), 0)"

static void look_at_designs(struct looking *looking)
{
  int64_t last = find_last(looking, LAST_OF("design"));
  for (int64_t id = 1; id <= last; id++) {
    enum eo_design_outcome outcome = EO_DESIGN_MISSING;
    struct eo_error error;
    enum eo_code code = eo_store_find_design(looking->store, id, NULL, NULL, &outcome, &error);
    looking->sum->designs += !code && outcome == EO_DESIGN_DONE;
    if (code)
      tell(looking, EO_LOSS_LOST, "Design %lld, if there is one, cannot be read.", (long long)id);
  }
}

static enum eo_code look_at_files(void *context, const struct eo_stored_measurement *row, struct eo_error *error)
{
  struct looking *looking = context;
  char path[EO_STORE_PATH], sum[EO_HASH_LENGTH + 1];
  (void)error;
  for (int i = 0; i < row->files; i++)
    if (!eo_measurement_file_path(looking->store, row->id, i, path, sizeof path) ||
        eo_measurement_file_hash(path, sum, NULL))
      tell(looking, EO_LOSS_LOST, "Recording %lld: its file \"%s\" cannot be read.", (long long)row->id,
           row->file[i].name);
    else if (strcmp(sum, row->file[i].sha256) != 0)
      tell(looking, EO_LOSS_LOST, "Recording %lld: its file \"%s\" is not what was uploaded.", (long long)row->id,
           row->file[i].name);
  return EO_OK;
}

static void look_at_recordings(struct looking *looking)
{
  int64_t last = find_last(looking, LAST_OF("measurement"));
  for (int64_t id = 1; id <= last; id++) {
    enum eo_measurement_outcome outcome = EO_MEASUREMENT_MISSING;
    struct eo_error error;
    enum eo_code code = eo_store_find_measurement(looking->store, id, look_at_files, looking, &outcome, &error);
    looking->sum->recordings += !code && outcome == EO_MEASUREMENT_DONE;
    if (code)
      tell(looking, EO_LOSS_AGAIN,
           "Recording %lld: its row cannot be read; where measurements/%lld is there, its files can be uploaded again.",
           (long long)id, (long long)id);
  }
}

static enum eo_code see_job(void *context, const struct eo_stored_job *job, struct eo_error *error)
{
  (void)context, (void)job, (void)error;
  return EO_OK;
}

static void look_at_jobs(struct looking *looking)
{
  int64_t last = find_last(looking, LAST_OF("job"));
  for (int64_t id = 1; id <= last; id++) {
    enum eo_job_outcome outcome = EO_JOB_OUTCOME_MISSING;
    struct eo_error error;
    enum eo_code code = eo_queue_find(looking->store, id, see_job, NULL, &outcome, &error);
    looking->sum->jobs += !code && outcome == EO_JOB_OUTCOME_DONE;
    if (code)
      tell(looking, EO_LOSS_AGAIN, "Job %lld, if there is one, cannot be read: its search can be run again.",
           (long long)id);
  }
}

static void look_at_history(struct looking *looking)
{
  int64_t wrong = 0;
  struct eo_error error;
  enum eo_code code = eo_store_count_damaged(looking->store, &looking->sum->evaluations, &wrong, &error);
  if (code)
    tell(looking, EO_LOSS_AGAIN, "The history of evaluations cannot be read to its end: they can be computed again.");
  if (wrong)
    tell(looking, EO_LOSS_AGAIN,
         "%lld evaluations of the history are damaged; easeoff history prune --damaged removes them, and they are "
         "computed "
         "again.",
         (long long)wrong);
}

enum eo_code eo_store_checkup(struct eo_store *store, eo_checkup_visit *visit, void *context,
                              struct eo_checkup *checkup, struct eo_error *error)
{
  struct looking looking = {store, visit, context, checkup};
  struct eo_error found;
  *checkup = (struct eo_checkup){0};
  EO_TRY(look_at_pages(&looking, error));
  if (eo_store_inspect(store, false, &found))
    tell(&looking, EO_LOSS_NOTE, "%s", found.text);
  look_at_designs(&looking);
  look_at_recordings(&looking);
  look_at_jobs(&looking);
  look_at_history(&looking);
  return EO_OK;
}

enum eo_code eo_store_trust(const char *directory, int64_t *pages, struct eo_error *error)
{
  char path[EO_STORE_PATH];
  snprintf(path, sizeof path, "%.4000s/easeoff.db", directory);
  *pages = eo_page_sums_renew(path);
  return *pages >= 0 ? EO_OK
                     : eo_error_set(error, EO_ERROR_FILE, "", "%.250s: %s.", path,
                                    errno ? strerror(errno) : "its pages have no sums");
}
