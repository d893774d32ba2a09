/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which columns are times, which belong to which channel, and in what unit. */
#include "recording/layout_private.h"
#include "recording/series.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ODD_ROWS 2 /* times that start again more often are no times of one recording */
#define FAR 100.0  /* times a load case: no speed of this pair */
#define SHORTEST \
  2e-6 /* s from row to row: encoders are recorded with more than 50 and less than 500,000 rows a second */
#define LONGEST 0.02
#define NEAR 30.0 /* times a load case: a unit of time is believed; units differ by more than the square of it */

#define WEAK_WORDS "x|axis|abscissa" /* may as well name a signal */

static const char *unit_name(double scale)
{
  return scale == 1e-3    ? "milliseconds"
         : scale == 1e-6  ? "microseconds"
         : scale == 1e-9  ? "nanoseconds"
         : scale == 1e-7  ? "tenths of a microsecond"
         : scale == 86400 ? "days"
                          : "seconds";
}

/* Dates as numbers give themselves away by their size: days since 1900 or since year 0 with steps below 0.2 s,
   milliseconds, microseconds, nanoseconds and tenths of a microsecond since 1970, 1601 or year 1. 0: no date. */
static double scale_by_size(const struct eo_column *look)
{
  static const struct {
    double low, high, scale, most; /* step at most, in the unit */
  } dates[] = {{20000, 80000, 86400, 2e-6}, {700000, 800000, 86400, 2e-6}, {1e12, 2.2e12, 1e-3, 1e4},
               {1e15, 2.2e15, 1e-6, 1e7},   {1e18, 2.2e18, 1e-9, 1e10},    {1.2e17, 1.5e17, 1e-7, 1e8},
               {6.2e17, 6.6e17, 1e-7, 1e8}, {1e9, 2.2e9, 1, 10},           {2.9e9, 4.6e9, 1, 10}};
  for (size_t i = 0; i < sizeof dates / sizeof *dates; i++)
    if (look->low > dates[i].low && look->high < dates[i].high && look->step < dates[i].most)
      return dates[i].scale;
  return 0;
}

/* Goes up and starts again so many times at most. */
static bool rises_but(const struct eo_column *look, int resets)
{
  return look->count > 1 && look->step > 0 && look->resets <= resets && look->falls <= look->rises / 10;
}

static bool rises(const struct eo_column *look)
{
  return rises_but(look, 0);
}

static bool is_referred(const struct eo_guess *guess, int column)
{
  for (int c = 0; c < guess->columns; c++)
    if (c != column && eo_recording_clock(guess->recording, c).column == column)
      return true;
  return false;
}

static bool counts_rows(const struct eo_guess *guess, int column)
{
  const struct eo_column *look = &guess->look[column];
  bool counting = look->whole && look->step == 1 && look->spread < 1e-12 && !look->resets;
  bool named = eo_column_named(eo_recording_name(guess->recording, column), EO_CLOCK_WORDS "|" EO_TICK_WORDS);
  return counting && look->quantity != EO_QUANTITY_TIME && look->quantity != EO_QUANTITY_ANGLE &&
         (!named || eo_recording_clock(guess->recording, column).interval > 0);
}

/* The first column without a unit that rises more evenly than what follows it. */
static bool leads_evenly(const struct eo_guess *guess, int column)
{
  const struct eo_column *look = &guess->look[column];
  int behind = 0;
  for (int c = 0; c < column; c++)
    if (!guess->number[c])
      return false;
  for (int c = column + 1; c < guess->columns; c++)
    behind += guess->look[c].count > 1 && guess->look[c].step != 0 &&
              (guess->look[c].spread > 5 * look->spread || look->spread < 1e-9);
  return look->spread < 1e-3 && (look->step < 0.1 || look->spread < 1e-9) && !look->whole && behind >= 2;
}

/* By its unit or its name. */
static bool is_called_time(const struct eo_guess *guess, int column)
{
  const struct eo_column *look = &guess->look[column];
  bool free_of_unit = look->quantity == EO_QUANTITY_NONE || look->quantity == EO_QUANTITY_COUNT,
       ticks = eo_recording_tick(guess->recording) > 0;
  return look->quantity == EO_QUANTITY_TIME ||
         (free_of_unit && eo_column_named(eo_recording_name(guess->recording, column),
                                          ticks ? EO_CLOCK_WORDS "|" EO_TICK_WORDS : EO_CLOCK_WORDS));
}

/* A column of time goes up by nearly equal steps and never starts again; a unit, a name, its size or another column
   that refers to it says so. */
static bool is_time(const struct eo_guess *guess, int column)
{
  const struct eo_column *look = &guess->look[column];
  if (guess->number[column])
    return false;
  if (is_called_time(guess, column)) /* a row that was cut off, or one out of order, does not make it something else */
    return rises_but(look, ODD_ROWS);
  return rises(look) && (is_referred(guess, column) ||
                         (look->quantity == EO_QUANTITY_NONE && scale_by_size(look) > 0 && look->spread < 0.5));
}

/* An abscissa without a name of time, where nothing better is there. */
static bool is_abscissa(const struct eo_guess *guess, int column)
{
  const struct eo_column *look = &guess->look[column];
  bool named = eo_column_named(eo_recording_name(guess->recording, column), WEAK_WORDS) && look->spread < 0.05;
  return rises(look) && !guess->number[column] && look->quantity == EO_QUANTITY_NONE &&
         !(eo_recording_clock(guess->recording, column).interval > 0) && (named || leads_evenly(guess, column));
}

void eo_layout_mark_times(struct eo_guess *guess)
{
  for (int c = 0; c < guess->columns; c++)
    guess->number[c] = counts_rows(guess, c);
  bool any = false;
  for (int c = 0; c < guess->columns; c++) {
    guess->time[c] = is_time(guess, c);
    any = any || guess->time[c];
  }
  for (int c = 0; c < guess->columns && !any; c++)
    any = guess->time[c] = is_abscissa(guess, c);
}

int eo_layout_pick_time(const struct eo_guess *guess, int channel)
{
  int best = -1, most = -1;
  for (int c = 0; c < guess->columns; c++) {
    if (!guess->time[c] || eo_recording_length(guess->recording, c) < 2)
      continue;
    int shared = eo_column_shared_words(eo_recording_name(guess->recording, c),
                                        eo_recording_name(guess->recording, channel), EO_TIME_WORDS);
    bool fits = eo_recording_length(guess->recording, c) >= eo_recording_length(guess->recording, channel);
    const struct eo_column *look = &guess->look[c];
    double stated = eo_recording_clock(guess->recording, channel).interval;
    bool agrees = stated > 0 &&
                  fabs(look->step * (look->quantity == EO_QUANTITY_TIME ? look->factor : 1) / stated - 1) < 0.01;
    bool moves = look->rises > look->count * 9 / 10;
    int score = 100 * fits + 20 * moves + 4 * shared + 3 * agrees + 2 * (c < channel) +
                (look->quantity == EO_QUANTITY_TIME);
    if (score > most || (score == most && c < channel)) {
      most = score;
      best = c;
    }
  }
  return best;
}

/* Nothing tells when the rows were taken; a column whose times do not go on is named. */
static enum eo_code refuse_times(const struct eo_guess *guess, struct eo_error *error)
{
  char text[80];
  for (int c = 0; c < guess->columns; c++) {
    const struct eo_column *look = &guess->look[c];
    bool constant = look->count > 1 && look->low == look->high && look->low > 0;
    if (!is_called_time(guess, c) || guess->number[c] || (!(look->falls > 0) && !constant))
      continue;
    eo_layout_label(guess, c, text, sizeof text);
    if (look->falls > 9 * look->rises)
      return eo_error_set(error, EO_ERROR_INPUT, "/time",
                          "The times in %s fall from row to row: the last row stands first. Turn the rows round.",
                          text);
    if (constant || (look->low >= 0 && 4 * look->falls > look->rises))
      return eo_error_set(error, EO_ERROR_INPUT, "/time",
                          "The values in %s do not rise: if they are steps from row to row, call the column dt; else "
                          "choose \"none\" as time and give the sampling rate.",
                          text);
    return eo_error_set(
        error, EO_ERROR_INPUT, "/time",
        "The times in %s go back in %d rows: sort the rows by time, or choose \"none\" as time and give "
        "the sampling rate.",
        text, look->falls);
  }
  return eo_error_set(error, EO_ERROR_INPUT, "/sample_rate_Hz",
                      "No column holds the time and the file states no sampling rate; give one.");
}

static enum eo_code even_clock(struct eo_guess *guess, int channel, struct eo_layout_clock *clock,
                               struct eo_error *error)
{
  struct eo_clock stated = eo_recording_clock(guess->recording, channel);
  clock->interval = guess->choice->sample_rate > 0 ? 1 / guess->choice->sample_rate : stated.interval;
  clock->start = stated.start;
  char ratio[96] = "sampling rates";
  if (stated.thinned > 1 && !eo_series_contradicts(stated.interval * stated.thinned, stated.other))
    snprintf(ratio, sizeof ratio, "a sampling rate and that a row is made of %.6g samples, which makes rates",
             stated.thinned);
  if (stated.other > 0 && !(guess->choice->sample_rate > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/sample_rate_Hz",
                        "The file states %s of %.6g and %.6g Hz, and no column holds the time: give the one "
                        "that the rows have.",
                        ratio, 1 / stated.interval, 1 / stated.other);
  return clock->interval > 0 ? EO_OK : refuse_times(guess, error);
}

/* A unit that the file states must be known, of times as of angles: a guess in its place would be a wrong speed. */
static enum eo_code check_time_unit(const struct eo_guess *guess, int column, struct eo_error *error)
{
  char text[80];
  enum eo_quantity quantity = guess->look[column].quantity;
  bool ticks = eo_recording_tick(guess->recording) > 0 || quantity == EO_QUANTITY_COUNT;
  if (guess->choice->time_scale > 0 || quantity != EO_QUANTITY_NONE || ticks || !eo_layout_has_unit(guess, column))
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, "/time_unit",
                      "The file states \"%.40s\" as the unit of %s, which is not known here: give the unit of the time "
                      "(s, ms, us, ns, or the seconds that one of them takes).",
                      eo_recording_unit(guess->recording, column), eo_layout_label(guess, column, text, sizeof text));
}

/* Rows come at a rate that an encoder is recorded with. */
static bool is_usual(double interval)
{
  return fabs(interval) > SHORTEST && fabs(interval) < LONGEST;
}

/* Whole numbers without a unit count what the file says that its times resolve, "timestamp resolution: 10 us"; but not
   surely where they are multiples of that in a finer unit. */
static enum eo_code count_resolution(const struct eo_guess *guess, int column, double *scale, struct eo_error *error)
{
  static const double finer[] = {1e-3, 1e-6, 1e-9};
  char text[80];
  const struct eo_column *look = &guess->look[column];
  double each = eo_recording_clock(guess->recording, column).resolution;
  if (!(each > 0) || !look->whole || look->quantity != EO_QUANTITY_NONE || !is_usual(look->step * each))
    return EO_OK;
  for (size_t i = 0; i < sizeof finer / sizeof *finer; i++) {
    double units = round(each / finer[i]);
    if (units > 1 && is_usual(look->step * finer[i]) && fmod(look->step, units) == 0 && fmod(look->low, units) == 0)
      return eo_error_set(error, EO_ERROR_INPUT, "/time_unit",
                          "The file states that times resolve %.6g s and no unit of %s, which may count that or units "
                          "of %.6g s: give the seconds that one of them takes.",
                          each, eo_layout_label(guess, column, text, sizeof text), finer[i]);
  }
  *scale = each;
  return EO_OK;
}

static enum eo_code find_clock(struct eo_guess *guess, int member, struct eo_error *error)
{
  struct eo_layout_clock *clock = &guess->clock[member];
  int channel = guess->tracks->channel[member].column[0];
  const char *chosen = member && guess->choice->gear_time ? guess->choice->gear_time : guess->choice->time;
  *clock = (struct eo_layout_clock){.column = -1,
                                    .scale = guess->choice->time_scale > 0 ? guess->choice->time_scale : 1};
  if (chosen && strcmp(chosen, "none")) {
    enum eo_code code = eo_layout_chosen(guess, chosen, "/time", &clock->column, error);
    if (code)
      return code;
  } else if (!chosen && !(guess->choice->sample_rate > 0)) {
    clock->column = eo_recording_clock(guess->recording, channel).column;
    if (clock->column < 0 || guess->number[clock->column]) /* an index of the rows is no time */
      clock->column = eo_layout_pick_time(guess, channel);
  }
  if (clock->column < 0)
    return even_clock(guess, channel, clock, error);
  const struct eo_column *look = &guess->look[clock->column];
  EO_TRY(check_time_unit(guess, clock->column, error));
  if (!(guess->choice->time_scale > 0) && look->quantity == EO_QUANTITY_TIME)
    clock->scale = look->factor;
  else if (!(guess->choice->time_scale > 0) && eo_recording_tick(guess->recording) > 0 &&
           (look->quantity == EO_QUANTITY_COUNT || look->whole))
    clock->scale = eo_recording_tick(guess->recording);
  if (clock->scale == 1 && !(guess->choice->time_scale > 0) && look->quantity == EO_QUANTITY_NONE &&
      scale_by_size(look) > 0)
    clock->scale = scale_by_size(look);
  if (clock->scale == 1 && !(guess->choice->time_scale > 0))
    EO_TRY(count_resolution(guess, clock->column, &clock->scale, error));
  clock->interval = look->step * clock->scale;
  return EO_OK;
}

static int64_t epoch_of(const struct eo_guess *guess, int member)
{
  int column = guess->clock[member].column >= 0 ? guess->clock[member].column
                                                : guess->tracks->channel[member].column[0];
  return eo_recording_clock(guess->recording, column).epoch;
}

enum eo_code eo_layout_find_clocks(struct eo_guess *guess, struct eo_error *error)
{
  for (int member = 0; member < 2; member++) {
    enum eo_code code = find_clock(guess, member, error);
    if (code)
      return code;
  }
  int64_t epoch[2] = {epoch_of(guess, 0), epoch_of(guess, 1)};
  if (epoch[0] != EO_CLOCK_NO_EPOCH && epoch[1] != EO_CLOCK_NO_EPOCH && !(guess->choice->sample_rate > 0))
    guess->clock[1].shift = (double)(epoch[1] - epoch[0]) * 1e-9;
  return EO_OK;
}

static double time_at(const struct eo_guess *guess, const struct eo_layout_clock *clock, int64_t row)
{
  double values[EO_RECORDING_COLUMNS];
  struct eo_error error;
  if (clock->column < 0)
    return clock->start + (double)row * clock->interval;
  return eo_recording_read(guess->recording, row, 1, values, &error) ? NAN : values[clock->column] * clock->scale;
}

double eo_layout_rate(const struct eo_guess *guess, int column, const struct eo_layout_clock *clock)
{
  const struct eo_column *look = &guess->look[column];
  double seconds = time_at(guess, clock, look->last) - time_at(guess, clock, look->first);
  return look->pace * (double)(look->count - 1) / seconds;
}

bool eo_layout_is_open(const struct eo_guess *guess, int member)
{
  int column = guess->clock[member].column;
  return column >= 0 && !(guess->choice->time_scale > 0) && guess->look[column].quantity != EO_QUANTITY_TIME &&
         guess->clock[member].scale == 1;
}

static const double time_units[] = {1, 1e-3, 1e-6, 1e-9, 86400};

double eo_layout_time_factor(const struct eo_guess *guess, int member)
{
  for (size_t i = 0; eo_layout_is_open(guess, member) && i < sizeof time_units / sizeof *time_units; i++)
    if (is_usual(guess->clock[member].interval * time_units[i]))
      return time_units[i];
  return 1;
}

static void set_scale(struct eo_guess *guess, int member, double scale)
{
  struct eo_layout_clock *clock = &guess->clock[member];
  clock->interval *= scale / clock->scale;
  clock->scale = scale;
}

/* Pinion's speed in rad/s; NaN where values do not tell it. */
static double pinion_speed(const struct eo_guess *guess)
{
  const struct eo_track_channel *channel = &guess->tracks->channel[0];
  const struct eo_column *look = &guess->look[channel->column[0]];
  if (guess->kind == EO_LAYOUT_PULSES)
    return EO_TURN / channel->lines / (look->step * guess->clock[0].scale);
  if (guess->kind != EO_LAYOUT_ANGLES)
    return NAN;
  if (guess->increments[0])
    return fabs((look->low + look->high) / 2 * channel->scale / guess->clock[0].interval);
  return fabs(eo_layout_rate(guess, channel->column[0], &guess->clock[0]) * channel->scale);
}

/* The one unit of time but s that makes a speed near the load cases, of rows at a usual rate; 0: none or several do. */
static double scale_by_speed(const struct eo_guess *guess, double speed)
{
  double found = 0;
  for (size_t i = 1; i < sizeof time_units / sizeof *time_units; i++)
    if (speed / time_units[i] > guess->pair->speed[0] / NEAR && speed / time_units[i] < guess->pair->speed[1] * NEAR &&
        is_usual(guess->clock[0].interval * time_units[i]))
      found = found > 0 ? -1 : time_units[i];
  return found > 0 ? found : 0;
}

/* "timestamp (80 MHz clock)", "t*1000": what the name says of the unit is not understood here.
 */
static bool says_more(const struct eo_guess *guess, int column)
{
  return strpbrk(eo_recording_name(guess->recording, column), "([/*");
}

enum eo_code eo_layout_judge_speed(struct eo_guess *guess, struct eo_error *error)
{
  char text[80];
  bool open[2] = {eo_layout_is_open(guess, 0), eo_layout_is_open(guess, 1)};
  if (guess->clock[0].column >= 0 && guess->look[guess->clock[0].column].quantity == EO_QUANTITY_NONE &&
      guess->clock[0].scale != 1 && guess->clock[0].scale == scale_by_size(&guess->look[guess->clock[0].column]))
    eo_notes_add(guess->notes, "%s holds dates as numbers, in %s.",
                 eo_layout_label(guess, guess->clock[0].column, text, sizeof text), unit_name(guess->clock[0].scale));
  double speed = pinion_speed(guess), low = guess->pair ? guess->pair->speed[0] : 0,
         high = guess->pair ? guess->pair->speed[1] : 0;
  if (!(high > 0) || isnan(speed) || (speed > low / FAR && speed < high * FAR))
    return EO_OK;
  double scale = open[0] && !says_more(guess, guess->clock[0].column) ? scale_by_speed(guess, speed) : 0;
  if (scale > 0) {
    for (int member = 0; member < 2; member++)
      if (open[member])
        set_scale(guess, member, scale);
    eo_notes_add(
        guess->notes,
        "Nothing states the unit of %s; in seconds the pinion would turn at %.3g rpm, far from every load case: "
        "read in %s.",
        eo_layout_label(guess, guess->clock[0].column, text, sizeof text), speed * 60 / EO_TURN, unit_name(scale));
    return EO_OK;
  }
  if (guess->choice->time_scale > 0 || guess->choice->sample_rate > 0)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, guess->clock[0].column < 0 ? "/sample_rate_Hz" : "/time_unit",
                      "The pinion would turn at %.3g rpm, a hundred times away from %s (%.4g to %.4g rpm): state the "
                      "unit of the time or "
                      "the sampling rate, and the unit of the angles.",
                      speed * 60 / EO_TURN, guess->pair->stated ? "what was stated" : "every load case of the design",
                      low * 60 / EO_TURN, high * 60 / EO_TURN);
}
