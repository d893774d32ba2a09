/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "store/statement.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

enum eo_code eo_store_fault(const struct eo_store *store, int fault, struct eo_error *error)
{
  static const struct {
    int fault;
    enum eo_code code;
    const char *what;
  } known[] = {
      {SQLITE_BUSY, EO_ERROR_BUSY, "another process has kept it locked for too long"},
      {SQLITE_LOCKED, EO_ERROR_BUSY, "another process has kept it locked for too long"},
      {SQLITE_READONLY, EO_ERROR_FILE, "it or its folder cannot be written"},
      {SQLITE_PERM, EO_ERROR_FILE, "access is denied"},
      {SQLITE_CANTOPEN, EO_ERROR_FILE, "it cannot be opened"},
      {SQLITE_FULL, EO_ERROR_FULL, "the disk is full; what was saved before is kept"},
      {SQLITE_CORRUPT, EO_ERROR_DAMAGED, "it is damaged; easeoff doctor says more, easeoff restore puts a copy back"},
      {SQLITE_NOTADB, EO_ERROR_DAMAGED, "it is damaged or no database; move it away, or restore it from a copy"},
      {SQLITE_IOERR, EO_ERROR_FILE, "reading or writing failed; what was saved before is kept"},
      {SQLITE_IOERR_DATA, EO_ERROR_DAMAGED, "it is damaged, a page is not what was written; easeoff doctor says more"},
      {SQLITE_IOERR_CORRUPTFS, EO_ERROR_DAMAGED, "the file system gives other bytes than it was given"},
  };
  if ((fault & 0xff) == SQLITE_NOMEM)
    return eo_error_memory(error);
  const char *what = "the database refuses this";
  enum eo_code code = EO_ERROR_FILE;
  for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
    if (known[i].fault == (fault & 0xff) || known[i].fault == fault) {
      what = known[i].what;
      code = known[i].code;
    }
  const char *detail = store->handle ? sqlite3_errmsg(store->handle) : sqlite3_errstr(fault);
  return eo_error_set(error, code, "", "%.150s: %s (%.100s).", store->path, what, detail);
}

/* The statement prepared before under the same address, or a new one in the first free place. */
static int prepare(struct eo_store *store, const char *sql, sqlite3_stmt **handle)
{
  int i = 0;
  while (i < EO_STATEMENTS_KEPT - 1 && store->kept[i].sql && store->kept[i].sql != sql)
    i++;
  struct eo_prepared *kept = &store->kept[i];
  if (kept->sql != sql) {
    sqlite3_finalize(kept->handle);
    *kept = (struct eo_prepared){0};
    int fault = sqlite3_prepare_v3(store->handle, sql, -1, SQLITE_PREPARE_PERSISTENT, &kept->handle, NULL);
    if (fault)
      return fault;
    kept->sql = sql;
  }
  *handle = kept->handle;
  return SQLITE_OK;
}

static int bind_number(sqlite3_stmt *handle, int i, double value)
{
  return isfinite(value) ? sqlite3_bind_double(handle, i, value) : sqlite3_bind_null(handle, i);
}

struct eo_statement eo_statement_begin(struct eo_store *store, const char *sql, const char *values, ...)
{
  struct eo_statement statement = {.store = store};
  va_list list;
  statement.fault = prepare(store, sql, &statement.handle);
  va_start(list, values);
  for (int i = 1; values[i - 1] && !statement.fault; i++) {
    const void *data;
    switch (values[i - 1]) {
    case 'i':
      statement.fault = sqlite3_bind_int64(statement.handle, i, va_arg(list, int64_t));
      break;
    case 'n':
      statement.fault = sqlite3_bind_int(statement.handle, i, va_arg(list, int));
      break;
    case 'r':
      statement.fault = bind_number(statement.handle, i, va_arg(list, double));
      break;
    case 't':
      statement.fault = sqlite3_bind_text(statement.handle, i, va_arg(list, const char *), -1, SQLITE_TRANSIENT);
      break;
    case 'b':
      data = va_arg(list, const void *);
      statement.fault = sqlite3_bind_blob64(statement.handle, i, data, va_arg(list, size_t), SQLITE_TRANSIENT);
      break;
    }
  }
  va_end(list);
  return statement;
}

bool eo_statement_step(struct eo_statement *statement)
{
  if (statement->fault)
    return false;
  int code = sqlite3_step(statement->handle);
  if (code != SQLITE_ROW && code != SQLITE_DONE)
    statement->fault = code;
  return code == SQLITE_ROW;
}

enum eo_code eo_statement_end(struct eo_statement *statement, struct eo_error *error)
{
  enum eo_code code = statement->fault ? eo_store_fault(statement->store, statement->fault, error) : EO_OK;
  if (statement->handle) {
    sqlite3_reset(statement->handle);
    sqlite3_clear_bindings(statement->handle);
  }
  return code;
}

enum eo_code eo_statement_finish(struct eo_statement statement, struct eo_error *error)
{
  while (eo_statement_step(&statement))
    ;
  return eo_statement_end(&statement, error);
}

int64_t eo_column_integer(const struct eo_statement *statement, int column)
{
  return sqlite3_column_int64(statement->handle, column);
}

double eo_column_number(const struct eo_statement *statement, int column)
{
  return sqlite3_column_type(statement->handle, column) == SQLITE_NULL
             ? NAN
             : sqlite3_column_double(statement->handle, column);
}

const char *eo_column_text(const struct eo_statement *statement, int column)
{
  const unsigned char *text = sqlite3_column_text(statement->handle, column);
  return text ? (const char *)text : "";
}
