/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/overflow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 2048
#define STEPS 4.0 /* by so many steps a row may come earlier or later than the mean */
#define FULL 4.0  /* times that at least until it starts again */

/* How far each column falls where it starts again, over all rows. */
struct fall {
  bool looked_for;
  double before, least, most;
  int64_t count;
};

/* By its unit or name; ticks where the file states what one is. */
static bool is_time(const struct eo_recording *recording, int column, const struct eo_column *look)
{
  const char *name = eo_recording_name(recording, column);
  bool ticks = eo_recording_tick(recording) > 0 && eo_column_named(name, EO_TICK_WORDS);
  return look->quantity == EO_QUANTITY_TIME || eo_column_named(name, EO_CLOCK_WORDS) || ticks;
}

/* Ticks of a stated clock, where nothing else tells when a row was taken: all columns are the times of pulses. */
static bool holds_pulses(const struct eo_recording *recording, const struct eo_column *look)
{
  bool pulses = eo_recording_tick(recording) > 0;
  for (int c = 0; c < eo_recording_columns(recording); c++)
    pulses = pulses && !is_time(recording, c, &look[c]) && !(eo_recording_clock(recording, c).interval > 0) &&
             (look[c].quantity == EO_QUANTITY_COUNT || look[c].quantity == EO_QUANTITY_NONE);
  return pulses;
}

/* Its last value is not beyond those of the first rows, or these fall. */
static enum eo_code may_fall(const struct eo_recording *recording, int column, const struct eo_column *look, bool *may,
                             struct eo_error *error)
{
  double *row = malloc((size_t)eo_recording_columns(recording) * sizeof *row);
  int64_t rows = eo_recording_length(recording, column);
  enum eo_code code = row ? eo_recording_read(recording, rows - 1, 1, row, error) : eo_error_memory(error);
  *may = !code && (look->resets > 0 || !(row[column] >= look->high));
  free(row);
  return code;
}

static void add_row(struct fall *fall, int columns, const double *row)
{
  for (int c = 0; c < columns; c++) {
    if (!fall[c].looked_for || isnan(row[c]))
      continue;
    double drop = fall[c].before - row[c];
    fall[c].before = row[c];
    if (!(drop > 0))
      continue;
    fall[c].least = fall[c].count ? fmin(fall[c].least, drop) : drop;
    fall[c].most = fall[c].count ? fmax(fall[c].most, drop) : drop;
    fall[c].count++;
  }
}

static enum eo_code scan(const struct eo_recording *recording, struct fall *fall, struct eo_error *error)
{
  int64_t rows = eo_recording_rows(recording);
  int columns = eo_recording_columns(recording);
  double *block = malloc(BLOCK * (size_t)columns * sizeof *block);
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; !code && first < rows; first += BLOCK) {
    int64_t n = rows - first < BLOCK ? rows - first : BLOCK;
    code = eo_recording_read(recording, first, n, block, error);
    for (int64_t i = 0; !code && i < n; i++)
      add_row(fall, columns, block + i * columns);
  }
  free(block);
  return code;
}

/* All falls are as large as the turn but for a step. */
static bool fits(const struct fall *fall, double turn, double step, double tick)
{
  double off = STEPS * step + tick;
  return turn > FULL * off && fabs(fall->least + step - turn) <= off && fabs(fall->most + step - turn) <= off;
}

/* Counters have 16, 24 or 32 bits; their ticks are one of the column's unit, or of ms, us, 0.1 us or ns where the
   values are seconds. Times of day and of an hour start again, too. */
static double turn_of(const struct fall *fall, const struct eo_column *look)
{
  static const double bits[] = {0x1p16, 0x1p24, 0x1p32}, ticks[] = {1e-3, 1e-6, 1e-7, 1e-9},
                      periods[] = {60, 3600, 86400, 604800};
  double unit = look->quantity == EO_QUANTITY_TIME ? look->factor : 1;
  for (size_t i = 0; i < sizeof bits / sizeof *bits; i++) {
    if (fits(fall, bits[i], look->step, 1))
      return bits[i];
    for (size_t k = 0; k < sizeof ticks / sizeof *ticks; k++)
      if (fits(fall, bits[i] * ticks[k] / unit, look->step, ticks[k] / unit))
        return bits[i] * ticks[k] / unit;
  }
  for (size_t i = 0; i < sizeof periods / sizeof *periods; i++)
    if (fits(fall, periods[i] / unit, look->step, 0))
      return periods[i] / unit;
  return 0;
}

enum eo_code eo_overflow_find(const struct eo_recording *recording, const struct eo_column *look, double *turn,
                              struct eo_error *error)
{
  struct fall fall[EO_RECORDING_COLUMNS];
  int columns = eo_recording_columns(recording);
  bool any = false, pulses = holds_pulses(recording, look);
  for (int c = 0; c < columns; c++) {
    turn[c] = 0;
    fall[c] = (struct fall){.before = NAN};
    if (look[c].count > 1 && look[c].step > 0 && (pulses || is_time(recording, c, &look[c])))
      EO_TRY(may_fall(recording, c, &look[c], &fall[c].looked_for, error));
    any = any || fall[c].looked_for;
  }
  if (any)
    EO_TRY(scan(recording, fall, error));
  for (int c = 0; c < columns; c++)
    if (fall[c].count > 0)
      turn[c] = turn_of(&fall[c], &look[c]);
  return EO_OK;
}
