/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/series.h"
#include "recording/recorded_unit.h"
#include "recording/source.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

#include "base/sort.h"

#define BLOCK 4096     /* rows that are copied at once */
#define SHORT 20       /* a channel with so many times fewer values than the longest belongs to something else */
#define LASTS 0.5      /* unless it is a slow one, which lasts as long: of the time of the others */
#define SLOWEST 0.02   /* s: no rows of an encoder; of two intervals the one below is theirs */
#define SAME_RATE 0.01 /* relative: an interval may be rounded */

static bool same_interval(double a, double b)
{
  return fabs(a - b) <= 1e-9 * fabs(a);
}

static bool sampled_together(const struct eo_series *a, const struct eo_series *b)
{
  return a->length == b->length && same_interval(a->clock.interval, b->clock.interval);
}

static int count_like(const struct eo_series_file *file, const struct eo_series *like)
{
  int count = 0;
  for (int i = 0; i < file->count; i++)
    count += sampled_together(&file->series[i], like);
  return count;
}

static int64_t longest(const struct eo_series_file *file)
{
  int64_t length = 0;
  for (int i = 0; i < file->count; i++)
    if (file->series[i].length > length)
      length = file->series[i].length;
  return length;
}

/* The channel whose like are the most among those at least half as long as the longest; NULL when none has company. */
static const struct eo_series *find_group(const struct eo_series_file *file)
{
  const struct eo_series *best = NULL;
  int most = 1;
  int64_t length = longest(file);
  for (int i = 0; i < file->count; i++) {
    const struct eo_series *series = &file->series[i];
    int count = series->length > 1 && series->length >= length / 2 ? count_like(file, series) : 0;
    if (count > most || (count == most && best && series->length > best->length)) {
      most = count;
      best = series;
    }
  }
  return best;
}

/* Torque and speed are often taken more slowly than the encoders; their clock tells when. */
static bool is_slow_load(const struct eo_series *series, const struct eo_series *group)
{
  double factor, lasts = (double)series->length * series->clock.interval;
  enum eo_quantity quantity = eo_unit_find(series->unit, &factor);
  if (quantity != EO_QUANTITY_TORQUE && quantity != EO_QUANTITY_SPEED)
    return false;
  return series->clock.column >= 0 ||
         (lasts > 0 && group && lasts >= LASTS * (double)group->length * group->clock.interval);
}

/* Marks the channels that are taken however few values they have, with their times. */
static void find_slow(const struct eo_series_file *file, const struct eo_series *group, bool slow[EO_SERIES])
{
  for (int i = 0; i < file->count && i < EO_SERIES; i++) {
    if (!is_slow_load(&file->series[i], group))
      continue;
    int time = file->series[i].clock.column;
    slow[i] = true;
    if (time >= 0 && time < EO_SERIES)
      slow[time] = true;
  }
}

/* Fills chosen[] with the channels of the table and says what stays out. */
static int choose(const struct eo_series_file *file, int *chosen, struct eo_notes *notes)
{
  const struct eo_series *group = find_group(file), *other = NULL;
  int64_t least = longest(file) / SHORT;
  int count = 0, left_out = 0;
  bool slow[EO_SERIES] = {false};
  find_slow(file, group, slow);
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < file->count; i++) {
      const struct eo_series *series = &file->series[i];
      bool first = group && sampled_together(series, group);
      if (first != (pass == 0) || series->length <= 1)
        continue;
      if (count < EO_RECORDING_COLUMNS && (series->length >= least || (i < EO_SERIES && slow[i])))
        chosen[count++] = i;
      else
        left_out++, other = series;
    }
  eo_sort_integers(count, chosen);
  if (left_out)
    eo_notes_add(
        notes, "%d channel%s with far fewer values than the others %s left out, for instance \"%s\" with %lld values.",
        left_out, left_out == 1 ? "" : "s", left_out == 1 ? "was" : "were", other->name, (long long)other->length);
  return count;
}

static enum eo_code check_size(const struct eo_series_file *file, const int *chosen, int count, int64_t rows,
                               struct eo_error *error)
{
  if (!count)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The file has no channel with numbers over time.");
  if (rows > INT64_MAX / 8 / count / 2 || rows * count * 8 > file->limit)
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "The %d channels of %lld values are more than the %lld MB that are read at most.", count,
                        (long long)rows, (long long)(file->limit >> 20));
  if (rows * count * 8 > EO_SOURCE_FREE && rows * count * 8 / EO_SOURCE_EXPANSION > file->bytes)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The file states %lld values of \"%s\" but has only %lld bytes.",
                        (long long)rows, file->series[chosen[0]].name, (long long)file->bytes);
  return EO_OK;
}

static enum eo_code copy_block(const struct eo_series_file *file, const int *chosen, int count, int64_t first,
                               int64_t rows, double *values, double *table, struct eo_error *error)
{
  for (int c = 0; c < count; c++) {
    int64_t left = file->series[chosen[c]].length - first, n = left < 0 ? 0 : left < rows ? left : rows;
    enum eo_code code = n ? file->read(file->context, chosen[c], first, n, values, error) : EO_OK;
    if (code)
      return code;
    for (int64_t i = 0; i < rows; i++)
      table[i * count + c] = i < n ? values[i] : NAN;
  }
  return EO_OK;
}

/* The chosen series; where one is the time of another its new number is told. */
static void choose_columns(const struct eo_series_file *file, const int *chosen, int count, struct eo_series *column)
{
  for (int c = 0; c < count; c++) {
    column[c] = file->series[chosen[c]];
    eo_series_settle(&column[c].clock);
    int time = column[c].clock.column;
    column[c].clock.column = -1;
    for (int k = 0; time >= 0 && k < count; k++)
      if (chosen[k] == time)
        column[c].clock.column = k;
  }
}

/* values: [BLOCK][count + 1], room to work. */
static enum eo_code copy_columns(const struct eo_series_file *file, const int *chosen, int count, int64_t rows,
                                 const struct eo_series *column, double *values, const struct eo_series_sink *sink,
                                 struct eo_error *error)
{
  EO_TRY(sink->begin(sink->context, column, count, error));
  for (int64_t first = 0; first < rows; first += BLOCK) {
    int64_t n = rows - first < BLOCK ? rows - first : BLOCK;
    EO_TRY(copy_block(file, chosen, count, first, n, values, values + BLOCK, error));
    EO_TRY(sink->rows(sink->context, values + BLOCK, n, error));
  }
  return EO_OK;
}

static enum eo_code copy_all(const struct eo_series_file *file, const int *chosen, int count, int64_t rows,
                             const struct eo_series_sink *sink, struct eo_error *error)
{
  struct eo_series *column = malloc((size_t)count * sizeof *column);
  double *values = malloc(BLOCK * sizeof *values * (size_t)(count + 1));
  if (column)
    choose_columns(file, chosen, count, column);
  enum eo_code code = column && values ? copy_columns(file, chosen, count, rows, column, values, sink, error)
                                       : eo_error_memory(error);
  free(column);
  free(values);
  return code;
}

enum eo_code eo_series_copy(const struct eo_series_file *file, const struct eo_series_sink *sink,
                            struct eo_notes *notes, struct eo_error *error)
{
  int chosen[EO_RECORDING_COLUMNS] = {0};
  int count = choose(file, chosen, notes);
  int64_t rows = 0;
  for (int c = 0; c < count; c++)
    if (file->series[chosen[c]].length > rows)
      rows = file->series[chosen[c]].length;
  enum eo_code code = check_size(file, chosen, count, rows, error);
  return code ? code : copy_all(file, chosen, count, rows, sink, error);
}

void eo_series_init(struct eo_series *series, const char *name, int64_t length)
{
  *series = (struct eo_series){.length = length, .clock = {.column = -1, .epoch = EO_CLOCK_NO_EPOCH}};
  snprintf(series->name, sizeof series->name, "%s", name);
}

bool eo_series_contradicts(double interval, double other)
{
  return interval > 0 && other > 0 && fabs(other / interval - 1) > SAME_RATE;
}

void eo_series_tell(struct eo_clock *clock, const struct eo_stated *stated)
{
  if (stated->kind == EO_STATED_THINNED && (int)stated->strength >= clock->thins)
    clock->thinned = stated->value, clock->thins = (int)stated->strength;
  if (stated->kind == EO_STATED_RESOLUTION)
    clock->resolution = stated->value;
  if (stated->kind != EO_STATED_INTERVAL)
    return;
  bool contradicts = eo_series_contradicts(clock->interval, stated->value);
  if (contradicts && stated->value > SLOWEST && clock->interval < SLOWEST)
    return;
  if (!(clock->interval > 0) || (contradicts && clock->interval > SLOWEST && stated->value < SLOWEST))
    clock->interval = stated->value;
  else if (contradicts)
    clock->other = stated->value;
  clock->told = (int)stated->strength > clock->told ? (int)stated->strength : clock->told;
}

void eo_series_settle(struct eo_clock *clock)
{
  double longer = fmax(clock->interval, clock->other), shorter = fmin(clock->interval, clock->other);
  if (!(clock->thinned > 1) || !(clock->interval > 0))
    return;
  if (clock->other > 0 && !eo_series_contradicts(shorter * clock->thinned, longer))
    clock->interval = longer, clock->other = 0;
  else if (!(clock->other > 0) && clock->told < clock->thins)
    clock->other = clock->interval * clock->thinned;
}

bool eo_series_state(struct eo_series *series, const struct eo_stated *stated)
{
  switch (stated->kind) {
  case EO_STATED_INTERVAL:
  case EO_STATED_THINNED:
  case EO_STATED_RESOLUTION:
    eo_series_tell(&series->clock, stated);
    return true;
  case EO_STATED_START:
    series->clock.start = stated->value;
    return true;
  case EO_STATED_TICK:
    series->tick = stated->value;
    return true;
  case EO_STATED_TURN:
    series->turn = stated->value;
    return true;
  default:
    return false;
  }
}

static enum eo_code begin_recording(void *context, const struct eo_series *column, int columns, struct eo_error *error)
{
  struct eo_series_recorder *recorder = context;
  enum eo_code code = eo_recording_new(&recorder->recording, columns, recorder->spool_directory, error);
  if (code)
    return code;
  recorder->total = 0;
  for (int c = 0; c < columns; c++) {
    eo_recording_set_column(recorder->recording, c, column[c].name, column[c].unit);
    eo_recording_set_length(recorder->recording, c, column[c].length);
    eo_recording_set_clock(recorder->recording, c, &column[c].clock);
    eo_recording_set_turn(recorder->recording, c, column[c].turn);
    if (column[c].tick > 0)
      eo_recording_set_tick(recorder->recording, column[c].tick);
    if (column[c].length > recorder->total)
      recorder->total = column[c].length;
  }
  return EO_OK;
}

static enum eo_code record_rows(void *context, const double *rows, int64_t count, struct eo_error *error)
{
  struct eo_series_recorder *recorder = context;
  if (eo_progress_report(recorder->progress, "rig file",
                         (double)eo_recording_rows(recorder->recording) / (double)recorder->total))
    return eo_error_set(error, EO_ERROR_CANCELLED, "", "Reading the file was cancelled.");
  return eo_recording_append(recorder->recording, rows, count, error);
}

struct eo_series_sink eo_series_recorder_sink(struct eo_series_recorder *recorder)
{
  return (struct eo_series_sink){begin_recording, record_rows, recorder};
}
