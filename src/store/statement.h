/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SQL statements with their values, for this floor alone. A fault is kept and told once, by eo_statement_end(). */
#ifndef EASEOFF_STORE_STATEMENT_H
#define EASEOFF_STORE_STATEMENT_H

#include "store/store.h"

#include <stdbool.h>
#include <sqlite3.h>

enum { EO_STATEMENTS_KEPT = 64 };

struct eo_store {
  sqlite3 *handle;
  char *directory, *path; /* of the database; owned */
  bool lasting;           /* the transaction that is open began with eo_store_begin_lasting() */
  int lock;               /* file descriptor of the job locks, -1: not open yet */
  struct eo_prepared {
    const char *sql;
    sqlite3_stmt *handle;
  } kept[EO_STATEMENTS_KEPT];
};

struct eo_statement {
  struct eo_store *store;
  sqlite3_stmt *handle;
  int fault; /* SQLite's code of the first failure, SQLITE_OK while there is none */
};

/* sql: one statement, a literal (it is kept under its address). values: one letter for each: i int64_t, n int, r double
   (not finite: NULL), t const char * (NULL: NULL), b const void * and size_t. */
struct eo_statement eo_statement_begin(struct eo_store *store, const char *sql, const char *values, ...);

/* True when there is a row to read; false at the end and after a failure. */
bool eo_statement_step(struct eo_statement *statement);

/* Ends the use; the first failure as an error. */
enum eo_code eo_statement_end(struct eo_statement *statement, struct eo_error *error);

/* Begins, steps to the end, ends. */
#define EO_STATEMENT_RUN(store, error, sql, ...) eo_statement_finish(eo_statement_begin(store, sql, __VA_ARGS__), error)
enum eo_code eo_statement_finish(struct eo_statement statement, struct eo_error *error);

/* Columns of the present row. Text is borrowed until the next step; NULL becomes NaN or "". */
int64_t eo_column_integer(const struct eo_statement *statement, int column);
double eo_column_number(const struct eo_statement *statement, int column);
const char *eo_column_text(const struct eo_statement *statement, int column);

/* A failure of SQLite in words. */
enum eo_code eo_store_fault(const struct eo_store *store, int fault, struct eo_error *error);

#endif
