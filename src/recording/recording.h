/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A recording: rows x columns of doubles as one rig file holds them, in the file's own units. The last rows stay in
   memory; what does not fit goes to a temporary file that has no name, so that a gigabyte of text can be read on a
   small machine. Threads: one thread appends; once that is over any number of threads may read. */
#ifndef EASEOFF_RECORDING_RECORDING_H
#define EASEOFF_RECORDING_RECORDING_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

#define EO_RECORDING_COLUMNS 256               /* columns of one recording at most */
#define EO_RECORDING_MEMORY ((size_t)64 << 20) /* bytes of rows that stay in memory */
#define EO_RECORDING_NAME 64                   /* bytes of a column's name with its final 0 */
#define EO_RECORDING_UNIT 24

struct eo_recording; /* opaque */

/* columns: 1..EO_RECORDING_COLUMNS. spool_directory: where rows beyond EO_RECORDING_MEMORY go, copied; NULL: more than
   that is an error. Errors: EO_ERROR_MEMORY, EO_ERROR_INPUT (number of columns). *recording is untouched on failure. */
enum eo_code eo_recording_new(struct eo_recording **recording, int columns, const char *spool_directory,
                              struct eo_error *error);
void eo_recording_free(struct eo_recording *recording); /* NULL is fine */

/* Bytes of rows that stay in memory instead of EO_RECORDING_MEMORY; before the first row. */
void eo_recording_set_memory(struct eo_recording *recording, size_t bytes);

/* Names and units as the file has them, cut to the sizes above and always valid UTF-8 (other bytes are taken for Latin
   1); "" when the file says nothing. */
void eo_recording_set_column(struct eo_recording *recording, int column, const char *name, const char *unit);
const char *eo_recording_name(const struct eo_recording *recording, int column);
const char *eo_recording_unit(const struct eo_recording *recording, int column);

/* rows[count][columns]; a cell without a value is NaN. Errors: EO_ERROR_MEMORY, EO_ERROR_FILE (temporary file). */
enum eo_code eo_recording_append(struct eo_recording *recording, const double *rows, int64_t count,
                                 struct eo_error *error);
int eo_recording_columns(const struct eo_recording *recording);
int64_t eo_recording_rows(const struct eo_recording *recording);

/* Columns shorter than the table (pulse times of two encoders, channels of a binary file): rows from this one on are
   NaN and mean nothing. The length is that of the table unless it was set. */
void eo_recording_set_length(struct eo_recording *recording, int column, int64_t length);
int64_t eo_recording_length(const struct eo_recording *recording, int column);

/* When the rows of one column were taken, as the file states it. Every column has a clock of its own, since a file may
   hold channels of several loggers or rates; columns that were sampled together have equal ones. Row k stands at
   start + k interval when the rows are even, else at the value in column `column` of the same row, in that column's
   unit. A file that says nothing has interval 0 and column -1: what the times are is then for the layout to find. */
struct eo_clock {
  int column;        /* of the recording, that holds the times of this one; -1: none */
  double interval;   /* s between rows that are even; 0: not stated */
  double start;      /* s: time of row 0 where rows are even */
  int64_t epoch;     /* ns since 1970-01-01: when the time 0 was; EO_CLOCK_NO_EPOCH: not stated. Local or universal: two
                        clocks are only compared with each other */
  double other;      /* s: another interval that the file states for the same rows; 0: it does not contradict itself */
  double thinned;    /* of so many samples a row was made, before or behind the stated rate; 0: not stated */
  double resolution; /* s that times resolve, and may count where they are whole; 0: not stated */
  int thins, told;   /* enum eo_stated_strength of that number and of the intervals */
};
#define EO_CLOCK_NO_EPOCH INT64_MIN

void eo_recording_set_clock(struct eo_recording *recording, int column, const struct eo_clock *clock);
struct eo_clock eo_recording_clock(const struct eo_recording *recording, int column);

/* What the file states of an encoder's counts: per turn of the one in this column; 0: nothing. */
void eo_recording_set_turn(struct eo_recording *recording, int column, double counts);
double eo_recording_turn(const struct eo_recording *recording, int column);

/* A value of the column that stands for a lost one: it is read as NaN from then on. */
void eo_recording_set_lost(struct eo_recording *recording, int column, double value);

/* The length of one tick in which columns of ticks count the time, s; 0: not stated. */
void eo_recording_set_tick(struct eo_recording *recording, double tick);
double eo_recording_tick(const struct eo_recording *recording);

/* The next row to be appended stands in this line of the file (from 1); those after it count on by one. */
void eo_recording_set_line(struct eo_recording *recording, int64_t line);
/* The line of the file a row was read from; 0 when the file has no lines. */
int64_t eo_recording_line(const struct eo_recording *recording, int64_t row);

/* Copies rows first .. first + count - 1 to rows[count][columns]. Thread-safe against other readers.
   Errors: EO_ERROR_INPUT (range), EO_ERROR_FILE. */
enum eo_code eo_recording_read(const struct eo_recording *recording, int64_t first, int64_t count, double *rows,
                               struct eo_error *error);

#endif
