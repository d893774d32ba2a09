/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data sets of a universal file as channels. Text is read once, into one column each; binary data are read where
   they are. */
#include "recording/uff.h"
#include "base/decimal.h"
#include "recording/reader_private.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define BATCH 4096               /* values */
#define MEMORY ((size_t)1 << 19) /* bytes of a column of text in memory */
#define CHANNELS EO_RECORDING_COLUMNS
#define PIECE ((size_t)64 << 10)

/* Where the values of a channel are. */
struct values {
  struct eo_recording *column; /* owned: of text; NULL: binary */
  int64_t at, stride;          /* byte of the first value, from value to value */
  int size;                    /* 4 or 8 bytes */
  bool big;
};

struct uff {
  struct eo_uff_lines lines;
  const char *spool_directory;
  struct eo_notes *notes;
  int count, skipped;
  struct eo_series series[CHANNELS];
  struct values values[CHANNELS];
  double batch[2 * BATCH];
};

static enum eo_code new_column(const struct uff *uff, struct eo_recording **column, struct eo_error *error)
{
  enum eo_code code = eo_recording_new(column, 1, uff->spool_directory, error);
  if (!code && uff->spool_directory)
    eo_recording_set_memory(*column, MEMORY);
  return code;
}

/* The values of a data set of text. What the numbers are is told by their order: widths differ between writers. */
struct stream {
  struct eo_uff_lines *lines;
  const char *at; /* in the current line; NULL: take the next one */
  const struct eo_uff_header *header;
};

static enum eo_code next_number(struct stream *stream, int64_t taken, double *value, struct eo_error *error)
{
  enum eo_code code;
  for (;;) {
    while (stream->at && *stream->at == ' ')
      stream->at++;
    if (stream->at && *stream->at)
      break;
    if (!eo_uff_next(stream->lines, error, &code) || eo_uff_is_end(stream->lines))
      return code ? code
                  : eo_error_set(error, EO_ERROR_INPUT, "",
                                 "UFF: the data set in line %lld ends in line %lld after %lld of %lld values.",
                                 (long long)stream->header->line, (long long)stream->lines->number, (long long)taken,
                                 (long long)stream->header->count);
    stream->at = stream->lines->line;
  }
  const char *end = eo_decimal_read(stream->at, '.', value);
  if (!end)
    return eo_error_set(error, EO_ERROR_INPUT, "", "UFF: line %lld, column %d: there is no number.",
                        (long long)stream->lines->number, (int)(stream->at - stream->lines->line) + 1);
  stream->at = end;
  return EO_OK;
}

/* Reads the numbers of text into column and, for an uneven abscissa, time. */
static enum eo_code read_text(struct uff *uff, const struct eo_uff_header *header, struct eo_recording *time,
                              struct eo_recording *column, struct eo_error *error)
{
  struct stream stream = {&uff->lines, NULL, header};
  double *times = uff->batch, *ordinates = uff->batch + BATCH;
  for (int64_t first = 0; first < header->count; first += BATCH) {
    int64_t n = header->count - first < BATCH ? header->count - first : BATCH;
    for (int64_t i = 0; i < n; i++) {
      if (!header->even)
        EO_TRY(next_number(&stream, first + i, &times[i], error));
      EO_TRY(next_number(&stream, first + i, &ordinates[i], error));
    }
    if (time)
      EO_TRY(eo_recording_append(time, times, n, error));
    EO_TRY(eo_recording_append(column, ordinates, n, error));
  }
  return EO_OK;
}

static enum eo_code add_text(struct uff *uff, const struct eo_uff_header *header, int time, int ordinate,
                             struct eo_error *error)
{
  enum eo_code code = new_column(uff, &uff->values[ordinate].column, error);
  if (!code && time >= 0)
    code = new_column(uff, &uff->values[time].column, error);
  return code
             ? code
             : read_text(uff, header, time >= 0 ? uff->values[time].column : NULL, uff->values[ordinate].column, error);
}

/* True when the line that ends a data set follows at a place. */
static bool ends_at(const struct uff *uff, int64_t at)
{
  char text[16] = "";
  int64_t left = uff->lines.size - at;
  if (at < 0 || left < 0)
    return false;
  size_t size = left < (int64_t)sizeof text - 1 ? (size_t)left : sizeof text - 1, i = 0;
  if (eo_bytes_read(uff->lines.file, at, text, size, NULL))
    return false;
  while (text[i] == ' ' || text[i] == '\r' || text[i] == '\n')
    i++;
  return text[i] == '-' && text[i + 1] == '1' && !isdigit((unsigned char)text[i + 2]);
}

/* The bytes of a binary data set: as stated, or, where the writer left them at 0 or miscounted, so that the set ends
   elsewhere, by the number of values. */
static int64_t count_bytes(const struct uff *uff, const struct eo_uff_header *header)
{
  int64_t size = header->type == 4 ? 8 : 4, at = uff->lines.at;
  int64_t wide = header->count * (header->even ? size : 2 * size), narrow = header->count * (4 + size);
  bool by_values = ends_at(uff, at + wide), by_single = !header->even && ends_at(uff, at + narrow);
  if (header->bytes > 0 && (ends_at(uff, at + header->bytes) || (!by_values && !by_single)))
    return header->bytes;
  return by_single || (!by_values && !header->even) ? narrow : wide;
}

/* An uneven abscissa is single or, as some write it, as wide as the values; the number of bytes tells which. */
static enum eo_code add_binary(struct uff *uff, const struct eo_uff_header *header, int time, int ordinate,
                               struct eo_error *error)
{
  int size = header->type == 4 ? 8 : 4;
  int64_t bytes = count_bytes(uff, header);
  int abscissa = header->even ? 0 : bytes == header->count * (4 + size) ? 4 : size;
  struct values *values = &uff->values[ordinate];
  *values =
      (struct values){.at = uff->lines.at + abscissa, .stride = abscissa + size, .size = size, .big = header->big};
  if (bytes < header->count * values->stride || bytes > uff->lines.size - uff->lines.at)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "UFF: the binary data set in line %lld has %lld bytes for %lld values.",
                        (long long)header->line, (long long)bytes, (long long)header->count);
  if (time >= 0)
    uff->values[time] =
        (struct values){.at = uff->lines.at, .stride = values->stride, .size = abscissa, .big = header->big};
  eo_uff_seek(&uff->lines, uff->lines.at + bytes);
  return EO_OK;
}

static void name_series(struct eo_series *series, const struct eo_uff_header *header)
{
  const char *name = *header->title ? header->title : header->label;
  eo_series_init(series, "", header->count);
  int used = snprintf(series->name, sizeof series->name, "%.50s", name);
  if (header->node)
    snprintf(series->name + used, sizeof series->name - (size_t)used, "%s%d:%d", used ? " " : "", header->node,
             header->direction);
  snprintf(series->unit, sizeof series->unit, "%s", header->unit);
  series->clock.interval = header->even ? header->increment * header->time_scale : 0;
  series->clock.start = header->even ? header->start * header->time_scale : 0;
}

/* Over time and real: an encoder's record. Spectra and the like are passed over. */
static bool is_record(const struct eo_uff_header *header)
{
  return header->function <= 1 && (header->type == 2 || header->type == 4) && header->abscissa != 18 &&
         header->count > 0 && (!header->even || header->increment > 0);
}

static enum eo_code add_set(struct uff *uff, const struct eo_uff_header *header, struct eo_error *error)
{
  int time = -1;
  if (uff->count + 2 > CHANNELS)
    return eo_error_set(error, EO_ERROR_INPUT, "", "UFF: the file has more than %d data sets.", CHANNELS);
  if (!header->even) {
    time = uff->count++;
    eo_series_init(&uff->series[time], "time", header->count);
    snprintf(uff->series[time].unit, sizeof uff->series[time].unit, "%s", *header->time_unit ? header->time_unit : "s");
  }
  int ordinate = uff->count++;
  name_series(&uff->series[ordinate], header);
  uff->series[ordinate].clock.column = time;
  return header->binary ? add_binary(uff, header, time, ordinate, error) : add_text(uff, header, time, ordinate, error);
}

/* The data set whose number stands in the current line, up to the line "    -1" that ends it. */
static enum eo_code read_set(struct uff *uff, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  const char *p = uff->lines.line;
  while (*p == ' ')
    p++;
  if (p[0] == '5' && p[1] == '8' && (!p[2] || p[2] == ' ' || (p[2] | 0x20) == 'b')) {
    struct eo_uff_header header;
    code = eo_uff_read_header(&uff->lines, &header, error);
    if (!code && is_record(&header))
      code = add_set(uff, &header, error);
    else if (!code) {
      uff->skipped++;
      if (header.binary)
        eo_uff_seek(&uff->lines,
                    uff->lines.at + (header.bytes < uff->lines.size - uff->lines.at ? header.bytes
                                                                                    : uff->lines.size - uff->lines.at));
    }
  }
  while (!code && eo_uff_next(&uff->lines, error, &code) && !eo_uff_is_end(&uff->lines))
    ;
  return code;
}

static enum eo_code read_sets(struct uff *uff, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  while (!code && eo_uff_next(&uff->lines, error, &code)) {
    if (!eo_uff_is_end(&uff->lines))
      continue;
    if (eo_uff_next(&uff->lines, error, &code))
      code = read_set(uff, error);
  }
  if (!code && uff->skipped)
    eo_notes_add(uff->notes, "%d data set%s that %s no real record over time %s left out.", uff->skipped,
                 uff->skipped == 1 ? "" : "s", uff->skipped == 1 ? "is" : "are", uff->skipped == 1 ? "was" : "were");
  return code;
}

static enum eo_code read_binary(const struct uff *uff, const struct values *this_values, int64_t first, int64_t count,
                                double *values, struct eo_error *error)
{
  unsigned char bytes[PIECE];
  int64_t most = ((int64_t)PIECE - this_values->size) / this_values->stride + 1;
  while (count > 0) {
    int64_t n = count < most ? count : most;
    enum eo_code code = eo_bytes_read(uff->lines.file, this_values->at + first * this_values->stride, bytes,
                                      (size_t)((n - 1) * this_values->stride + this_values->size), error);
    if (code)
      return code;
    for (int64_t i = 0; i < n; i++) {
      const unsigned char *p = bytes + i * this_values->stride;
      *values++ = this_values->size == 8 ? eo_bytes_double(p, this_values->big) : eo_bytes_float(p, this_values->big);
    }
    first += n;
    count -= n;
  }
  return EO_OK;
}

static enum eo_code read_values(void *context, int series, int64_t first, int64_t count, double *values,
                                struct eo_error *error)
{
  const struct uff *uff = context;
  const struct values *this_values = &uff->values[series];
  return this_values->column ? eo_recording_read(this_values->column, first, count, values, error)
                             : read_binary(uff, this_values, first, count, values, error);
}

enum eo_code eo_uff_read(const char *path, const struct eo_reader_options *options, const struct eo_series_sink *sink,
                         struct eo_notes *notes, struct eo_error *error)
{
  struct uff *uff = calloc(1, sizeof *uff);
  if (!uff)
    return eo_error_memory(error);
  uff->spool_directory = options->spool_directory;
  uff->notes = notes;
  enum eo_code code = eo_bytes_open(path, &uff->lines.file, &uff->lines.size, error);
  if (code) {
    free(uff);
    return code;
  }
  code = read_sets(uff, error);
  if (!code) {
    struct eo_series_file file = {uff->series, uff->count, uff->lines.size, options->max_bytes, read_values, uff};
    code = eo_series_copy(&file, sink, notes, error);
  }
  close(uff->lines.file);
  for (int i = 0; i < uff->count; i++)
    eo_recording_free(uff->values[i].column);
  free(uff);
  return code;
}
