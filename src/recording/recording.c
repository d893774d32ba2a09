/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/recording.h"
#include "base/utf8.h"
#include "recording/bytes.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LARGEST 1e30 /* no time, angle or load: instruments mark what they could not measure (9.91e37, 9.9e37) */
#define MARKS 65536  /* changes of the distance between row and line that are remembered */

/* From this row on, line = this line + (row - this row). */
struct mark {
  int64_t row, line;
};

struct column {
  char name[EO_RECORDING_NAME];
  char unit[EO_RECORDING_UNIT];
  int64_t length; /* -1: that of the table */
  struct eo_clock clock;
  double turn; /* counts, 0: not stated */
  double lost; /* the value that stands for a lost one; NaN: none does */
};

struct eo_recording {
  int columns;
  char *directory;       /* owned, NULL: no temporary file */
  struct column *column; /* [columns] */
  int file;              /* -1 until needed; holds rows 0 .. file_rows - 1 */
  int64_t file_rows;
  double *buffer; /* [buffer_rows][columns], the rows after those of the file */
  int64_t buffer_rows, capacity, limit;
  struct mark *mark; /* [marks], by row */
  int marks, mark_capacity;
  int64_t next_line;  /* line of the next row, 0: unknown */
  double tick;        /* s, 0: not stated */
  bool lossy;         /* a column has such a value */
  int64_t known_rows; /* rows from here on have no line any more */
};

enum eo_code eo_recording_new(struct eo_recording **recording, int columns, const char *spool_directory,
                              struct eo_error *error)
{
  if (columns < 1 || columns > EO_RECORDING_COLUMNS)
    return eo_error_set(error, EO_ERROR_INPUT, "", "A recording has 1 to %d columns, not %d.", EO_RECORDING_COLUMNS,
                        columns);
  struct eo_recording *this_recording = calloc(1, sizeof *this_recording);
  if (!this_recording)
    return eo_error_memory(error);
  this_recording->file = -1;
  this_recording->columns = columns;
  this_recording->limit = (int64_t)(EO_RECORDING_MEMORY / sizeof(double)) / columns;
  this_recording->known_rows = INT64_MAX;
  this_recording->column = calloc((size_t)columns, sizeof *this_recording->column);
  this_recording->directory = spool_directory ? strdup(spool_directory) : NULL;
  if (!this_recording->column || (spool_directory && !this_recording->directory)) {
    eo_recording_free(this_recording);
    return eo_error_memory(error);
  }
  for (int c = 0; c < columns; c++) {
    this_recording->column[c].length = -1;
    this_recording->column[c].lost = NAN;
    this_recording->column[c].clock = (struct eo_clock){.column = -1, .epoch = EO_CLOCK_NO_EPOCH};
  }
  *recording = this_recording;
  return EO_OK;
}

void eo_recording_set_memory(struct eo_recording *recording, size_t bytes)
{
  int64_t rows = (int64_t)(bytes / sizeof(double)) / recording->columns;
  recording->limit = rows ? rows : 1;
}

void eo_recording_free(struct eo_recording *recording)
{
  if (!recording)
    return;
  if (recording->file >= 0)
    close(recording->file);
  free(recording->directory);
  free(recording->column);
  free(recording->buffer);
  free(recording->mark);
  free(recording);
}

/* Copies whole characters while they fit. Bytes that are no UTF-8 are taken for Latin 1, as older rig software writes
   it. */
static void copy_text(char *to, size_t size, const char *text)
{
  const unsigned char *from = (const unsigned char *)text;
  size_t used = 0;
  while (*from) {
    unsigned char latin[2] = {(unsigned char)(0xc0 | *from >> 6), (unsigned char)(0x80 | (*from & 0x3f))};
    bool control = *from < ' ' || *from == 0x7f;
    size_t n = control ? 0 : eo_utf8_size((const char *)from, SIZE_MAX), wanted = n ? n : *from >= 0xa0 ? 2 : 1;
    if (used + wanted >= size)
      break;
    if (n)
      memcpy(to + used, from, n);
    else if (wanted == 2)
      memcpy(to + used, latin, 2);
    else
      to[used] = ' ';
    used += wanted;
    from += n ? n : 1;
  }
  to[used] = '\0';
}

void eo_recording_set_column(struct eo_recording *recording, int column, const char *name, const char *unit)
{
  copy_text(recording->column[column].name, sizeof recording->column[column].name, name);
  copy_text(recording->column[column].unit, sizeof recording->column[column].unit, unit);
}

const char *eo_recording_name(const struct eo_recording *recording, int column)
{
  return recording->column[column].name;
}

const char *eo_recording_unit(const struct eo_recording *recording, int column)
{
  return recording->column[column].unit;
}

int eo_recording_columns(const struct eo_recording *recording)
{
  return recording->columns;
}

int64_t eo_recording_rows(const struct eo_recording *recording)
{
  return recording->file_rows + recording->buffer_rows;
}

void eo_recording_set_length(struct eo_recording *recording, int column, int64_t length)
{
  recording->column[column].length = length;
}

int64_t eo_recording_length(const struct eo_recording *recording, int column)
{
  int64_t length = recording->column[column].length;
  int64_t rows = eo_recording_rows(recording);
  return length < 0 || length > rows ? rows : length;
}

void eo_recording_set_clock(struct eo_recording *recording, int column, const struct eo_clock *clock)
{
  recording->column[column].clock = *clock;
}

struct eo_clock eo_recording_clock(const struct eo_recording *recording, int column)
{
  return recording->column[column].clock;
}

void eo_recording_set_turn(struct eo_recording *recording, int column, double counts)
{
  recording->column[column].turn = counts;
}

double eo_recording_turn(const struct eo_recording *recording, int column)
{
  return recording->column[column].turn;
}

void eo_recording_set_lost(struct eo_recording *recording, int column, double value)
{
  recording->column[column].lost = value;
  recording->lossy = true;
}

void eo_recording_set_tick(struct eo_recording *recording, double tick)
{
  recording->tick = tick;
}

double eo_recording_tick(const struct eo_recording *recording)
{
  return recording->tick;
}

/* Creates the temporary file; it has no name, so that it ends with the process. */
static enum eo_code open_spool(struct eo_recording *recording, struct eo_error *error)
{
  if (!recording->directory)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "The recording is larger than the %lld MB that may be held in memory.",
                        (long long)(recording->limit * recording->columns * (int64_t)sizeof(double) >> 20));
  return eo_bytes_spool(recording->directory, &recording->file, error);
}

/* Moves the full buffer to the temporary file. */
static enum eo_code spill(struct eo_recording *recording, struct eo_error *error)
{
  enum eo_code code = recording->file < 0 ? open_spool(recording, error) : EO_OK;
  if (code)
    return code;
  size_t row_size = (size_t)recording->columns * sizeof(double);
  code = eo_bytes_write(recording->file, recording->file_rows * (int64_t)row_size, recording->buffer,
                        (size_t)recording->buffer_rows * row_size, error);
  if (code)
    return code;
  recording->file_rows += recording->buffer_rows;
  recording->buffer_rows = 0;
  return EO_OK;
}

/* Makes room for at least one more row. */
static enum eo_code make_room(struct eo_recording *recording, struct eo_error *error)
{
  if (recording->capacity == recording->limit)
    return spill(recording, error);
  int64_t capacity = recording->capacity ? 2 * recording->capacity : 1024;
  if (capacity > recording->limit)
    capacity = recording->limit;
  double *buffer = realloc(recording->buffer, (size_t)capacity * (size_t)recording->columns * sizeof *buffer);
  if (!buffer)
    return eo_error_memory(error);
  recording->buffer = buffer;
  recording->capacity = capacity;
  return EO_OK;
}

enum eo_code eo_recording_append(struct eo_recording *recording, const double *rows, int64_t count,
                                 struct eo_error *error)
{
  while (count > 0) {
    if (recording->buffer_rows == recording->capacity) {
      enum eo_code code = make_room(recording, error);
      if (code)
        return code;
    }
    int64_t room = recording->capacity - recording->buffer_rows;
    int64_t n = count < room ? count : room;
    size_t values = (size_t)n * (size_t)recording->columns;
    double *to = recording->buffer + recording->buffer_rows * recording->columns;
    for (size_t i = 0; i < values; i++)
      to[i] = fabs(rows[i]) < LARGEST ? rows[i] : NAN;
    recording->buffer_rows += n;
    if (recording->next_line)
      recording->next_line += n;
    rows += values;
    count -= n;
  }
  return EO_OK;
}

static bool grow_marks(struct eo_recording *recording)
{
  if (recording->marks < recording->mark_capacity)
    return true;
  int capacity = recording->mark_capacity ? 2 * recording->mark_capacity : 16;
  struct mark *mark = capacity <= MARKS ? realloc(recording->mark, (size_t)capacity * sizeof *mark) : NULL;
  if (!mark)
    return false;
  recording->mark = mark;
  recording->mark_capacity = capacity;
  return true;
}

void eo_recording_set_line(struct eo_recording *recording, int64_t line)
{
  int64_t row = eo_recording_rows(recording);
  if (line == recording->next_line || row >= recording->known_rows)
    return;
  if (!grow_marks(recording)) {
    recording->known_rows = row;
    return;
  }
  recording->mark[recording->marks++] = (struct mark){row, line};
  recording->next_line = line;
}

int64_t eo_recording_line(const struct eo_recording *recording, int64_t row)
{
  if (row < 0 || row >= recording->known_rows || row >= eo_recording_rows(recording))
    return 0;
  int low = 0, high = recording->marks; /* the last mark at or before the row */
  while (low < high) {
    int middle = (low + high) / 2;
    if (recording->mark[middle].row <= row)
      low = middle + 1;
    else
      high = middle;
  }
  return low ? recording->mark[low - 1].line + row - recording->mark[low - 1].row : 0;
}

static enum eo_code read_all(int file, void *bytes, size_t size, off_t at, struct eo_error *error)
{
  char *to = bytes;
  while (size > 0) {
    ssize_t n = pread(file, to, size, at);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return eo_error_set(error, EO_ERROR_FILE, "", "The temporary file of a recording could not be read: %s.",
                          n < 0 ? strerror(errno) : "it is too short");
    to += n;
    at += n;
    size -= (size_t)n;
  }
  return EO_OK;
}

static void leave_lost_out(const struct eo_recording *recording, int64_t count, double *rows)
{
  for (int64_t i = 0; i < count; i++)
    for (int c = 0; c < recording->columns; c++)
      if (rows[i * recording->columns + c] == recording->column[c].lost)
        rows[i * recording->columns + c] = NAN;
}

enum eo_code eo_recording_read(const struct eo_recording *recording, int64_t first, int64_t count, double *rows,
                               struct eo_error *error)
{
  int64_t total = eo_recording_rows(recording);
  if (first < 0 || count < 0 || first > total || count > total - first)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Rows %lld to %lld of a recording of %lld rows were asked for.",
                        (long long)first, (long long)(first + count - 1), (long long)total);
  size_t row_size = (size_t)recording->columns * sizeof(double);
  int64_t in_file = first < recording->file_rows ? recording->file_rows - first : 0;
  if (in_file > count)
    in_file = count;
  if (in_file) {
    enum eo_code code = read_all(recording->file, rows, (size_t)in_file * row_size, (off_t)first * (off_t)row_size,
                                 error);
    if (code)
      return code;
  }
  if (count > in_file)
    memcpy(rows + in_file * recording->columns,
           recording->buffer + (first + in_file - recording->file_rows) * recording->columns,
           (size_t)(count - in_file) * row_size);
  if (recording->lossy)
    leave_lost_out(recording, count, rows);
  return EO_OK;
}
