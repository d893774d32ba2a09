/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Square waves, as counters get them, recorded by a voltage input: the times at which they pass the middle between
   their levels are pulses. Of two tracks of an encoder all edges count. */
#include "recording/layout_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define BLOCK 4096
#define ROWS_PER_LINE 8 /* with fewer rows the time of an edge is known to a coarse part of a line only */

struct encoder {
  int tracks, column[2];
  double middle[2];
  bool exact; /* an edge has the time of the row that shows it */
  bool high[2], begun;
  double before[2], time;      /* values and time of the row before */
  int64_t edges, forward;      /* of two tracks: edges in all, those of one direction */
  struct eo_recording *pulses; /* owned, [edges][1], s */
};

static double time_of(const struct eo_layout_clock *clock, const double *row, int64_t number)
{
  return clock->column >= 0 ? row[clock->column] * clock->scale : clock->start + (double)number * clock->interval;
}

/* The time between two rows at which a track passes the middle, by a straight line. */
static enum eo_code keep_edge(struct encoder *encoder, int track, double value, double time, struct eo_error *error)
{
  double share = encoder->exact ? 1
                                : (encoder->middle[track] - encoder->before[track]) / (value - encoder->before[track]);
  double at = encoder->time + share * (time - encoder->time);
  return eo_recording_append(encoder->pulses, &at, 1, error);
}

/* Direction of an edge of two tracks in quadrature: A rises while B is low, and so on. */
static bool goes_forward(const struct encoder *encoder, int track, bool high)
{
  return track == 0 ? high != encoder->high[1] : high == encoder->high[0];
}

static enum eo_code take_row(struct encoder *encoder, const double *row, double time, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  for (int k = 0; k < encoder->tracks; k++)
    if (isnan(row[encoder->column[k]]))
      return EO_OK;
  for (int k = 0; k < encoder->tracks && !code; k++) {
    double value = row[encoder->column[k]];
    bool high = value > encoder->middle[k];
    if (encoder->begun && high != encoder->high[k] && (encoder->tracks == 2 || high)) {
      encoder->edges++;
      encoder->forward += encoder->tracks == 2 && goes_forward(encoder, k, high);
      code = keep_edge(encoder, k, value, time, error);
    }
    encoder->high[k] = high;
    encoder->before[k] = value;
  }
  encoder->time = time;
  encoder->begun = true;
  return code;
}

/* Rows that differ from the one before in a track, and how unlike their times are. */
struct changes {
  int64_t rows, changed;
  double before[4], time; /* of the row before */
  double sum, squares;    /* of the steps of time */
};

/* One way through the rows. */
struct pass {
  const struct eo_guess *guess;
  struct encoder *encoder; /* [2] */
  struct changes changes;
};

static enum eo_code each_row(struct pass *pass,
                             enum eo_code (*take)(struct pass *pass, const double *row, int64_t number,
                                                  struct eo_error *error),
                             struct eo_error *error)
{
  const struct eo_guess *guess = pass->guess;
  int64_t rows = eo_recording_rows(guess->recording);
  double *block = malloc(BLOCK * (size_t)guess->columns * sizeof *block);
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; !code && first < rows; first += BLOCK) {
    int64_t n = rows - first < BLOCK ? rows - first : BLOCK;
    code = eo_recording_read(guess->recording, first, n, block, error);
    for (int64_t i = 0; !code && i < n; i++)
      code = take(pass, block + i * guess->columns, first + i, error);
  }
  free(block);
  return code;
}

static enum eo_code count_change(struct pass *pass, const double *row, int64_t number, struct eo_error *error)
{
  const struct encoder *encoder = pass->encoder;
  struct changes *changes = &pass->changes;
  (void)error;
  double time = time_of(&pass->guess->clock[0], row, number), step = time - changes->time;
  bool changed = false;
  for (int i = 0; i < 4; i++) {
    double value = i % 2 < encoder[i / 2].tracks ? row[encoder[i / 2].column[i % 2]] : 0;
    changed = changed || value != changes->before[i];
    changes->before[i] = value;
  }
  changes->time = time;
  if (changes->rows++ == 0)
    return EO_OK;
  changes->changed += changed;
  changes->sum += step;
  changes->squares += step * step;
  return EO_OK;
}

/* Logic analysers write a row where a track changes and none between. Nearly all rows change something then, at times
   that are anything but even. */
static enum eo_code look_for_changes(struct pass *pass, struct eo_error *error)
{
  static const double NEARLY = 0.9, UNEVEN = 0.1; /* of the rows; standard deviation of the steps over their mean */
  const struct changes *changes = &pass->changes;
  if (pass->guess->clock[0].column < 0 || pass->guess->clock[0].column != pass->guess->clock[1].column)
    return EO_OK;
  EO_TRY(each_row(pass, count_change, error));
  double steps = (double)(changes->rows - 1), mean = changes->sum / steps,
         uneven = sqrt(fmax(0, changes->squares / steps - mean * mean)) / mean;
  pass->encoder[0].exact = pass->encoder[1].exact = (double)changes->changed > NEARLY * steps && uneven > UNEVEN;
  return EO_OK;
}

static enum eo_code find_edges(struct pass *pass, const double *row, int64_t number, struct eo_error *error)
{
  for (int s = 0; s < 2; s++) {
    const struct eo_layout_clock *clock = &pass->guess->clock[s];
    EO_TRY(take_row(&pass->encoder[s], row, time_of(clock, row, number) + clock->shift, error));
  }
  return EO_OK;
}

static enum eo_code check(const struct eo_guess *guess, const struct encoder *encoder, int member,
                          struct eo_error *error)
{
  const char *whose = member ? "gear" : "pinion";
  double lines = (double)encoder->edges / (encoder->tracks == 2 ? 4 : 1),
         rows = (double)eo_recording_rows(guess->recording);
  if (!(guess->choice->lines[member] > 0) && !(eo_recording_turn(guess->recording, encoder->column[0]) > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/lines",
                        "The %s's encoder was recorded as a square wave; give its lines per turn.", whose);
  if (lines < 3 || (!encoder->exact && rows / lines < ROWS_PER_LINE))
    return eo_error_set(
        error, EO_ERROR_INPUT, "/kind",
        "The %s's encoder was recorded as a square wave with %.3g rows per line: the times of its edges "
        "cannot be told from that. Record at %d rows per line or more, or the counts of a counter.",
        whose, rows / lines, ROWS_PER_LINE);
  if (encoder->tracks == 2 && fabs((double)encoder->forward / (double)encoder->edges - 0.5) < 0.48)
    return eo_error_set(error, EO_ERROR_INPUT, "/columns",
                        "The square waves of the %s change direction in %.3g %% of their edges: they are no two tracks "
                        "of one encoder, or the shaft swings.",
                        whose,
                        100 * fmin((double)encoder->forward, (double)(encoder->edges - encoder->forward)) /
                            (double)encoder->edges);
  return EO_OK;
}

/* Edges of both, side by side; the shorter one ends in NaN. */
static enum eo_code append_edges(struct eo_recording *out, const struct encoder encoder[2], int64_t first, int64_t n,
                                 struct eo_error *error)
{
  double column[BLOCK], rows[2 * BLOCK];
  for (int s = 0; s < 2; s++) {
    int64_t left = encoder[s].edges - first, got = left < 0 ? 0 : left < n ? left : n;
    if (got)
      EO_TRY(eo_recording_read(encoder[s].pulses, first, got, column, error));
    for (int64_t i = 0; i < n; i++)
      rows[2 * i + s] = i < got ? column[i] : NAN;
  }
  return eo_recording_append(out, rows, n, error);
}

static enum eo_code join(const struct encoder encoder[2], const char *spool_directory, struct eo_recording **pulses,
                         struct eo_error *error)
{
  struct eo_recording *out = NULL;
  int64_t most = encoder[0].edges > encoder[1].edges ? encoder[0].edges : encoder[1].edges;
  enum eo_code code = eo_recording_new(&out, 2, spool_directory, error);
  for (int64_t first = 0; !code && first < most; first += BLOCK)
    code = append_edges(out, encoder, first, most - first < BLOCK ? most - first : BLOCK, error);
  if (code) {
    eo_recording_free(out);
    return code;
  }
  for (int s = 0; s < 2; s++) {
    eo_recording_set_column(out, s, s ? "gear" : "pinion", "s");
    eo_recording_set_length(out, s, encoder[s].edges);
  }
  *pulses = out;
  return EO_OK;
}

static void set_tracks(struct eo_guess *guess, const struct encoder encoder[2])
{
  for (int s = 0; s < 2; s++) {
    double stated = eo_recording_turn(guess->recording, encoder[s].column[0]);
    double lines = guess->choice->lines[s] > 0 ? guess->choice->lines[s] : stated;
    guess->tracks->channel[s] = (struct eo_track_channel){
        .track = EO_TRACK_PULSES, .column = {s, s}, .lines = lines * (encoder[s].tracks == 2 ? 4 : 1), .factor = 1};
    guess->tracks->torque[s].scale = guess->tracks->speed[s].scale = 0;
    eo_notes_add(guess->notes, "%lld edges of the square wave%s of the %s are its pulses, %.6g per turn.",
                 (long long)encoder[s].edges, encoder[s].tracks == 2 ? "s" : "", s ? "gear" : "pinion",
                 guess->tracks->channel[s].lines);
  }
  guess->tracks->time_column = -1;
  guess->tracks->time_scale = 1;
  guess->kind = EO_LAYOUT_PULSES;
}

static enum eo_code decode(struct eo_guess *guess, struct encoder encoder[2], const char *spool_directory,
                           struct eo_recording **pulses, struct eo_error *error)
{
  for (int s = 0; s < 2; s++) {
    encoder[s].tracks = guess->kind == EO_LAYOUT_SINE_COSINE ? 2 : 1;
    for (int k = 0; k < encoder[s].tracks; k++) {
      int column = guess->tracks->channel[s].column[k];
      encoder[s].column[k] = column;
      encoder[s].middle[k] = (guess->look[column].low + guess->look[column].high) / 2;
    }
    EO_TRY(eo_recording_new(&encoder[s].pulses, 1, spool_directory, error));
  }
  struct pass pass = {.guess = guess, .encoder = encoder};
  EO_TRY(look_for_changes(&pass, error));
  if (encoder[0].exact)
    eo_notes_add(guess->notes, "The rows are the changes of the tracks, as logic analysers list them: their times are "
                               "those of the edges.");
  EO_TRY(each_row(&pass, find_edges, error));
  for (int s = 0; s < 2; s++)
    EO_TRY(check(guess, &encoder[s], s, error));
  EO_TRY(join(encoder, spool_directory, pulses, error));
  set_tracks(guess, encoder);
  return EO_OK;
}

enum eo_code eo_layout_decode_squares(struct eo_guess *guess, const char *spool_directory, struct eo_recording **pulses,
                                      struct eo_error *error)
{
  struct encoder encoder[2] = {0};
  enum eo_code code = decode(guess, encoder, spool_directory, pulses, error);
  eo_recording_free(encoder[0].pulses);
  eo_recording_free(encoder[1].pulses);
  return code;
}
