/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A check sum in every page of the database, compared whenever a page is read: what a disk gives back otherwise than it
   was given is an error (SQLITE_IOERR_DATA) and never an answer. A layer between SQLite and the system's files ("VFS").
   It puts the sums into the last EO_PAGE_SUM bytes of each page, which SQLite leaves free when told so; pages that are
   still in the journal are compared by the sums that the journal has of its own (wal.c, "WAL file format"). Any program
   reads such a file; another one that writes it leaves pages without the right sum behind. */
#ifndef EASEOFF_STORE_PAGE_SUMS_H
#define EASEOFF_STORE_PAGE_SUMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <sqlite3.h>

enum { EO_PAGE_SUM = 8 /* bytes */ };

/* The name under which sqlite3_open_v2() finds it. */
extern const char eo_page_sums_vfs[];

/* Makes it known to SQLite, once in the process; any number of threads may call. SQLite's code. */
int eo_page_sums_register(void);

/* Whether pages are compared while they are read, per connection; they are from the start. While one transaction writes
   more than fits into memory its own pages in the journal have no sums yet: VACUUM, for whoever runs it. */
void eo_page_sums_compare(sqlite3 *handle, bool compare);

/* Whether a page, number from 1, is as it was written. All zeros: it never was. */
bool eo_page_sum_holds(const unsigned char *page, size_t size, unsigned number);

/* Gives every page of a file the sum that belongs to what it holds now, and brings it to the disk. How many had another
   one; -1 with errno: it cannot be read or written (0: there is no room for sums in it). Nobody else may have it open.
 */
int64_t eo_page_sums_renew(const char *path);

#endif
