/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Channels with clocks of their own become one recording: the gear's values are brought to the times of the pinion's.
   Increments are summed up on the way. */
#include "recording/layout_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 4096
#define EVEN 0.02 /* standard deviation of steps over their mean: samples are even */
#define HELD (3 * BLOCK)
#define SAME 1e-6  /* of an interval: times that differ less are equal */
#define WIDEST 1.8 /* usual intervals: a polynomial over a longer gap swings */
#define CARRIED 6  /* columns of one side at most: tracks, torque and speed of both members */

/* The samples of one channel, read forwards. */
struct side {
  const struct eo_recording *recording;
  struct eo_layout_clock clock;
  int columns, column[CARRIED], keys; /* the first `keys` are the channel's own: samples without them are passed over */
  double period[CARRIED];             /* of columns that start again, 0: they do not */
  double shift[CARRIED];              /* turns counted so far, in the column's unit; of increments their sum */
  bool sum;                           /* the first column holds increments */
  int64_t next, rows;                 /* of the recording */
  int64_t first, held;                /* samples: number of the first that is held, how many are */
  bool ended;
  int points;           /* of the polynomial between the samples */
  double begin;         /* s, of the first sample */
  double *block;        /* [BLOCK][columns of the recording] */
  double *time, *value; /* [HELD], [HELD][columns] */
};

struct aligner {
  struct side side[2];
  struct eo_recording *out;
  int columns;
  double *rows; /* [BLOCK][columns] */
  int64_t filled, kept;
  int64_t places[EO_INTERPOLATION_PLACES + 1]; /* values by their place between two samples, see eo_interpolation */
};

static bool same_clock(const struct eo_layout_clock *a, const struct eo_layout_clock *b)
{
  bool column = a->column == b->column && a->scale == b->scale;
  bool even = a->column >= 0 || (fabs(a->interval - b->interval) <= 1e-9 * a->interval &&
                                 fabs(a->start - b->start) <= SAME * a->interval);
  return column && even && fabs(a->shift - b->shift) <= SAME * a->interval;
}

/* Whether two columns of times are equal, and whether rows hold both channels' values: a table with the times of both
   channels has one of them in each row. */
enum eo_code eo_layout_compare(struct eo_guess *guess, struct eo_error *error)
{
  const struct eo_layout_clock *a = &guess->clock[0], *b = &guess->clock[1];
  int first_column = guess->tracks->channel[0].column[0], second_column = guess->tracks->channel[1].column[0];
  int64_t rows = eo_recording_rows(guess->recording), both = 0, one = 0;
  double *block = malloc(BLOCK * (size_t)guess->columns * sizeof *block);
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  guess->equal = true;
  for (int64_t first = 0; !code && first < rows; first += BLOCK) {
    int64_t n = rows - first < BLOCK ? rows - first : BLOCK;
    code = eo_recording_read(guess->recording, first, n, block, error);
    for (int64_t i = 0; !code && i < n; i++) {
      const double *row = block + i * guess->columns;
      bool here = !isnan(row[first_column]), there = !isnan(row[second_column]);
      both += here && there;
      one += here != there;
      if (a->column >= 0 && b->column >= 0 && here && there &&
          fabs(row[a->column] * a->scale - row[b->column] * b->scale - b->shift) > 1e-4 * a->interval)
        guess->equal = false;
    }
  }
  free(block);
  guess->together = both >= one;
  return code;
}

bool eo_layout_needs_align(const struct eo_guess *guess)
{
  bool columns = guess->clock[0].column >= 0 && guess->clock[1].column >= 0;
  bool same = same_clock(&guess->clock[0], &guess->clock[1]) || (columns && guess->equal);
  return guess->kind != EO_LAYOUT_PULSES && (!same || !guess->together || guess->increments[0] || guess->increments[1]);
}

static enum eo_code open_side(struct side *side, const struct eo_guess *guess, int member, struct eo_error *error)
{
  const struct eo_track_channel *channel = &guess->tracks->channel[member];
  side->recording = guess->recording;
  side->clock = guess->clock[member];
  side->sum = guess->increments[member];
  side->keys = guess->kind == EO_LAYOUT_SINE_COSINE ? 2 : 1;
  for (int k = 0; k < side->keys; k++)
    side->column[side->columns++] = channel->column[k];
  side->rows = eo_recording_length(guess->recording, channel->column[0]);
  side->points = side->clock.column < 0 || guess->look[side->clock.column].spread < EVEN ? EO_INTERPOLATION_EVEN
                                                                                         : EO_INTERPOLATION_UNEVEN;
  if (guess->kind == EO_LAYOUT_ANGLES && !side->sum && guess->look[channel->column[0]].resets) {
    double turn = eo_column_turn(&guess->look[channel->column[0]]);
    side->period[0] = turn > 0 ? turn : EO_TURN / channel->scale;
  }
  side->block = malloc(BLOCK * (size_t)guess->columns * sizeof *side->block);
  side->time = malloc(HELD * sizeof *side->time);
  side->value = malloc(HELD * CARRIED * sizeof *side->value);
  return side->block && side->time && side->value ? EO_OK : eo_error_memory(error);
}

static void close_side(struct side *side)
{
  free(side->block);
  free(side->time);
  free(side->value);
}

static double time_of(const struct side *side, const double *row, int64_t number)
{
  double time = side->clock.column >= 0 ? row[side->clock.column] * side->clock.scale
                                        : side->clock.start + (double)number * side->clock.interval;
  return time + side->clock.shift;
}

/* Takes one row of the recording as the next sample. Rows without a value or with a time that does not go on are passed
   over. */
static void take_row(struct side *side, const double *row, int64_t number)
{
  double time = time_of(side, row, number), *value = side->value + side->held * CARRIED;
  bool good = isfinite(time) && (!side->held || time > side->time[side->held - 1]);
  for (int k = 0; k < side->columns; k++) {
    value[k] = row[side->column[k]];
    good = good && (k >= side->keys || isfinite(value[k]));
  }
  if (!good)
    return;
  if (side->sum) {
    side->shift[0] += value[0];
    value[0] = side->shift[0];
  }
  for (int k = 0; k < side->keys; k++)
    if (side->period[k] > 0) {
      value[k] += side->shift[k];
      double turns = side->held ? round((value[k] - value[k - CARRIED]) / side->period[k]) : 0;
      value[k] -= turns * side->period[k];
      side->shift[k] -= turns * side->period[k];
    }
  if (!side->first && !side->held)
    side->begin = time;
  side->time[side->held++] = time;
}

/* Forgets samples before `keep` and reads until there is no room for another block. */
static enum eo_code fill(struct side *side, int64_t keep, struct eo_error *error)
{
  int64_t drop = keep - side->first;
  enum eo_code code = EO_OK;
  if (drop > side->held)
    drop = side->held;
  if (drop > 0) {
    memmove(side->time, side->time + drop, (size_t)(side->held - drop) * sizeof *side->time);
    memmove(side->value, side->value + drop * CARRIED, (size_t)(side->held - drop) * CARRIED * sizeof *side->value);
    side->first += drop;
    side->held -= drop;
  }
  while (!code && !side->ended && side->held + BLOCK <= HELD) {
    int64_t n = side->rows - side->next < BLOCK ? side->rows - side->next : BLOCK;
    int columns = eo_recording_columns(side->recording);
    code = eo_recording_read(side->recording, side->next, n, side->block, error);
    for (int64_t i = 0; !code && i < n; i++)
      take_row(side, side->block + i * columns, side->next + i);
    side->next += n;
    side->ended = side->next >= side->rows;
  }
  return code;
}

/* Values of all columns at a time inside samples from .. from + points - 1, by the polynomial through them. */
static void interpolate(const struct side *side, int64_t from, double t, double *values)
{
  double weight[EO_INTERPOLATION_EVEN];
  eo_interpolation_weights(side->points, side->time + from, t, weight);
  for (int c = 0; c < side->columns; c++) {
    const double *column = side->value + from * CARRIED + c;
    double base = column[(long)side->points / 2 * CARRIED], sum = 0;
    for (int i = 0; i < side->points; i++)
      sum += weight[i] * (column[(long)i * CARRIED] - base);
    values[c] = base + sum;
  }
}

/* No two neighbours of the samples are far from each other. */
static bool is_dense(const struct side *side, int64_t from)
{
  double usual = (side->time[from + side->points - 1] - side->time[from]) / (side->points - 1), widest = 0,
         least = INFINITY;
  for (int i = 1; i < side->points; i++) {
    widest = fmax(widest, side->time[from + i] - side->time[from + i - 1]);
    least = fmin(least, side->time[from + i] - side->time[from + i - 1]);
  }
  return widest < WIDEST * usual && least > 0.2 * usual;
}

static enum eo_code flush(struct aligner *aligner, struct eo_error *error)
{
  enum eo_code code = eo_recording_append(aligner->out, aligner->rows, aligner->filled, error);
  aligner->kept += aligner->filled;
  aligner->filled = 0;
  return code;
}

static enum eo_code put_row(struct aligner *aligner, double t, const double *first, const double *second,
                            struct eo_error *error)
{
  double *to = aligner->rows + aligner->filled * aligner->columns;
  *to++ = t;
  for (int c = 0; c < aligner->side[0].columns; c++)
    *to++ = first[c];
  for (int c = 0; c < aligner->side[1].columns; c++)
    *to++ = second[c];
  return ++aligner->filled == BLOCK ? flush(aligner, error) : EO_OK;
}

/* The gear's values at a time: those of a sample that stands there, else between samples; NULL where it has none. at:
   number of the last sample not after t. */
static const double *values_at(struct aligner *aligner, int64_t at, double t, double *values)
{
  const struct side *side = &aligner->side[1];
  int64_t i = at - side->first, from = i - side->points / 2 + 1;
  double before = side->time[i], step = i + 1 < side->held ? side->time[i + 1] - before : before - side->time[i - 1];
  bool here = fabs(t - before) <= SAME * step, next = i + 1 < side->held && fabs(t - before - step) <= SAME * step;
  if (here || next) {
    aligner->places[EO_INTERPOLATION_PLACES]++;
    return side->value + (here ? i : i + 1) * CARRIED;
  }
  if (t < before || from < 0 || from + side->points > side->held || !is_dense(side, from))
    return NULL; /* at the ends a polynomial swings: only its middle is used */
  interpolate(side, from, t, values);
  aligner->places[(int)((t - before) / step * EO_INTERPOLATION_PLACES) % EO_INTERPOLATION_PLACES]++;
  return values;
}

static enum eo_code align_rows(struct aligner *aligner, struct eo_error *error)
{
  struct side *a = &aligner->side[0], *b = &aligner->side[1];
  double values[CARRIED];
  int64_t at = 0;
  enum eo_code code = fill(b, 0, error);
  for (int64_t n = 0; !code; n++) {
    if (n >= a->first + a->held) {
      code = fill(a, n ? n - 1 : 0, error); /* the sample before stays, for its turns */
      if (code || n >= a->first + a->held)
        break;
    }
    double t = a->time[n - a->first];
    for (;;) {
      if (at + 2 + b->points > b->first + b->held && !b->ended)
        code = fill(b, at > b->points ? at - b->points : 0, error);
      if (code || at + 1 >= b->first + b->held || !(b->time[at + 1 - b->first] <= t))
        break;
      at++;
    }
    const double *second = !code && b->held > b->points ? values_at(aligner, at, t, values) : NULL;
    if (!second && aligner->kept + aligner->filled < b->points)
      aligner->filled = 0; /* a lone sample at the beginning makes a gap */
    if (second)
      code = put_row(aligner, t, a->value + (n - a->first) * CARRIED, second, error);
  }
  return code ? code : flush(aligner, error);
}

/* Torque and speed go with the side whose clock they share; others are left behind. */
static void carry_beside(struct eo_guess *guess, struct aligner *aligner)
{
  struct eo_track_beside *beside[4] = {&guess->tracks->torque[0], &guess->tracks->torque[1], &guess->tracks->speed[0],
                                       &guess->tracks->speed[1]};
  for (int i = 0; i < 4; i++) {
    int side = -1;
    for (int s = 0; beside[i]->scale != 0 && s < 2 && side < 0; s++) {
      struct eo_clock own = eo_recording_clock(guess->recording, beside[i]->column);
      int time = own.column >= 0 ? own.column : eo_layout_pick_time(guess, beside[i]->column);
      bool same = guess->tracks->source[s].time >= 0 ? time == guess->tracks->source[s].time
                                                     : fabs(own.interval / guess->clock[s].interval - 1) < 1e-6;
      bool whole = eo_recording_length(guess->recording, beside[i]->column) >= aligner->side[s].rows;
      side = same && whole && aligner->side[s].columns < CARRIED ? s : -1;
    }
    if (side < 0) {
      char text[80];
      if (beside[i]->scale != 0)
        eo_notes_add(guess->notes, "%s has a clock of its own and is left out.",
                     eo_layout_label(guess, beside[i]->column, text, sizeof text));
      beside[i]->scale = 0;
      continue;
    }
    aligner->side[side].column[aligner->side[side].columns++] = beside[i]->column;
  }
}

/* How the gear's values stand between its samples, for those who ask what became of its vibration. */
static void state_places(struct eo_guess *guess, const struct aligner *aligner)
{
  struct eo_interpolation *interpolated = &guess->tracks->interpolated;
  int64_t exact = aligner->places[EO_INTERPOLATION_PLACES], all = exact;
  for (int i = 0; i < EO_INTERPOLATION_PLACES; i++)
    all += aligner->places[i];
  if (exact == all)
    return;
  const struct side *gear = &aligner->side[1]; /* all of it has been read */
  interpolated->points = gear->points;
  interpolated->step = (gear->time[gear->held - 1] - gear->begin) / (double)(gear->first + gear->held - 1);
  for (int i = 0; i <= EO_INTERPOLATION_PLACES; i++)
    interpolated->share[i] = (double)aligner->places[i] / (double)all;
}

/* The tracks now speak of the new columns, whose names and units are the old ones. */
static void rename_tracks(struct eo_guess *guess, const struct aligner *aligner)
{
  int to = 1, moved[EO_RECORDING_COLUMNS] = {0};
  eo_recording_set_column(aligner->out, 0, "time", "s");
  for (int s = 0; s < 2; s++)
    for (int c = 0; c < aligner->side[s].columns; c++) {
      int old = aligner->side[s].column[c];
      eo_recording_set_column(aligner->out, to, eo_recording_name(guess->recording, old),
                              eo_recording_unit(guess->recording, old));
      moved[old] = to++;
    }
  for (int s = 0; s < 2; s++) {
    for (int k = 0; k < aligner->side[s].keys; k++)
      guess->tracks->channel[s].column[k] = moved[guess->tracks->channel[s].column[k]];
    guess->tracks->torque[s].column = moved[guess->tracks->torque[s].column];
    guess->tracks->speed[s].column = moved[guess->tracks->speed[s].column];
  }
  guess->tracks->time_column = 0;
  guess->tracks->time_scale = 1;
  guess->tracks->interval = guess->clock[0].interval;
}

static enum eo_code align(struct eo_guess *guess, struct aligner *aligner, const char *spool_directory,
                          struct eo_error *error)
{
  carry_beside(guess, aligner);
  aligner->columns = 1 + aligner->side[0].columns + aligner->side[1].columns;
  aligner->rows = malloc(BLOCK * (size_t)aligner->columns * sizeof *aligner->rows);
  enum eo_code code = aligner->rows ? eo_recording_new(&aligner->out, aligner->columns, spool_directory, error)
                                    : eo_error_memory(error);
  if (!code)
    code = align_rows(aligner, error);
  if (code)
    return code;
  if (!aligner->kept)
    return eo_error_set(error, EO_ERROR_INPUT, "/time",
                        "The times of pinion and gear do not overlap, or one has fewer than %d values.",
                        aligner->side[1].points + 1);
  for (int s = 0; s < 2; s++)
    if (guess->increments[s])
      eo_notes_add(guess->notes, "The increments of the %s were summed up.", s ? "gear" : "pinion");
  if (!same_clock(&guess->clock[0], &guess->clock[1]) || aligner->kept < aligner->side[0].rows)
    eo_notes_add(
        guess->notes,
        "Pinion and gear have times of their own: the gear's values were brought to the times of the pinion's, "
        "which leaves %lld of %lld rows.",
        (long long)aligner->kept, (long long)aligner->side[0].rows);
  state_places(guess, aligner);
  rename_tracks(guess, aligner);
  return EO_OK;
}

enum eo_code eo_layout_align(struct eo_guess *guess, const char *spool_directory, struct eo_recording **aligned,
                             struct eo_error *error)
{
  struct aligner *aligner = calloc(1, sizeof *aligner);
  if (!aligner)
    return eo_error_memory(error);
  enum eo_code code = open_side(&aligner->side[0], guess, 0, error);
  if (!code)
    code = open_side(&aligner->side[1], guess, 1, error);
  if (!code)
    code = align(guess, aligner, spool_directory, error);
  if (code)
    eo_recording_free(aligner->out);
  else
    *aligned = aligner->out;
  close_side(&aligner->side[0]);
  close_side(&aligner->side[1]);
  free(aligner->rows);
  free(aligner);
  return code;
}
