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

/* The interval between rows in seconds and the time of row 0, when the file states them instead of holding a time
   column; 0: not stated. */
void eo_recording_set_interval(struct eo_recording *recording, double interval, double start);
double eo_recording_interval(const struct eo_recording *recording); /* s */
double eo_recording_start(const struct eo_recording *recording);    /* s */

/* The next row to be appended stands in this line of the file (from 1); those after it count on by one. */
void eo_recording_set_line(struct eo_recording *recording, int64_t line);
/* The line of the file a row was read from; 0 when the file has no lines. */
int64_t eo_recording_line(const struct eo_recording *recording, int64_t row);

/* Copies rows first .. first + count - 1 to rows[count][columns]. Thread-safe against other readers.
   Errors: EO_ERROR_INPUT (range), EO_ERROR_FILE. */
enum eo_code eo_recording_read(const struct eo_recording *recording, int64_t first, int64_t count, double *rows,
                               struct eo_error *error);

#endif
