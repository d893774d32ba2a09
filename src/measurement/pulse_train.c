/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/pulse_train.h"

#include <math.h>
#include <stdlib.h>

#include "measurement/scan.h"

enum { BLOCK = 4096, SIDE = 4, WINDOW = 2 * SIDE + 2, MOST_GAPS = 64, MOST_BACK = 3 };
static const double DOUBLE = 0.4; /* of the usual distance: two pulses of the same line */
static const double WHOLE = 0.25; /* a gap is a whole number of lines but for so much */

/* The pulses around the one that is judged. */
struct maker {
  const struct eo_recording *recording;
  struct eo_pulse_train *train;
  int column;
  double scale;               /* s per unit */
  double before;              /* time of the last pulse that counts */
  double line;                /* of it */
  double usual[SIDE];         /* distances per line before, a ring */
  int64_t seen;               /* pulses that count */
  double gap_line[MOST_GAPS]; /* where lines are missing, and how many */
  int gap_size[MOST_GAPS];
  int64_t gaps;
  double out[BLOCK][2];
  int held;
};

static enum eo_code flush(struct maker *maker, struct eo_error *error)
{
  enum eo_code code = maker->held ? eo_recording_append(maker->train->pulses, maker->out[0], maker->held, error)
                                  : EO_OK;
  maker->train->count += maker->held;
  maker->held = 0;
  return code;
}

/* The usual distance of two lines there: the median of those before and after. */
static double usual_distance(const struct maker *maker, const double *time, int ahead)
{
  double distance[WINDOW];
  int count = 0;
  for (int i = 0; i < SIDE && i < maker->seen - 1; i++)
    distance[count++] = maker->usual[i];
  for (int i = 1; i <= ahead && i <= SIDE; i++)
    distance[count++] = time[i] - time[i - 1];
  return eo_scan_quantile(distance, count, 0.5);
}

static void note_gap(struct maker *maker, int size, int64_t row)
{
  struct eo_pulse_train *train = maker->train;
  if (maker->gaps < MOST_GAPS) {
    maker->gap_line[maker->gaps] = maker->line;
    maker->gap_size[maker->gaps] = size;
  }
  if (!maker->gaps++)
    train->missed_at = row;
  train->missed += size;
}

/* One pulse: time[0] is judged, time[1..ahead] are those after it. */
static enum eo_code take(struct maker *maker, const double *time, int ahead, int64_t row, struct eo_error *error)
{
  struct eo_pulse_train *train = maker->train;
  double distance = time[0] - maker->before, lines = 1;
  if (maker->seen > 0) {
    double usual = usual_distance(maker, time, ahead), share = distance / usual;
    if (distance < 0) {
      if (!train->back++)
        train->back_at = row;
      return EO_OK;
    }
    if (share < DOUBLE) {
      if (!train->doubled++)
        train->doubled_at = row;
      return EO_OK;
    }
    lines = fmax(1, round(share));
    if (lines > 1 && fabs(share - lines) > WHOLE * lines) {
      if (!train->unclear)
        train->unclear_at = row;
      train->unclear = true;
    }
    if (lines > 1)
      note_gap(maker, (int)lines - 1, row);
    maker->usual[(maker->seen - 1) % SIDE] = distance / lines;
    maker->line += lines;
  }
  maker->before = time[0];
  maker->seen++;
  maker->out[maker->held][0] = time[0];
  maker->out[maker->held++][1] = maker->line;
  return maker->held == BLOCK ? flush(maker, error) : EO_OK;
}

/* Gaps of one size, each a turn after the one before: teeth that are missing of the wheel. Lines per turn may have been
   stated with them or without. */
static void find_wheel(struct maker *maker, double stated)
{
  struct eo_pulse_train *train = maker->train;
  int gaps = maker->gaps < MOST_GAPS ? (int)maker->gaps : MOST_GAPS, size = maker->gap_size[0];
  train->lines = stated;
  for (int with = 0; with < 2 && gaps >= 2; with++) {
    double turn = stated + (with ? size : 0);
    bool each = true;
    for (int i = 1; i < gaps; i++)
      each = each && maker->gap_size[i] == size && fabs(maker->gap_line[i] - maker->gap_line[i - 1] - turn) < 0.5;
    if (!each)
      continue;
    train->lines = turn;
    train->teeth_missing = size;
    train->missed = 0;
    return;
  }
}

/* Programs fill the shorter column up with zeros or with its last value. *length: of what stands before that. */
static enum eo_code find_end(const struct maker *maker, int64_t *length, struct eo_error *error)
{
  int columns = eo_recording_columns(maker->recording);
  double before = NAN, last = NAN, *block = malloc(sizeof *block * BLOCK * (size_t)columns);
  int64_t run = 0, began = 0; /* of equal values; row of the first */
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; first < *length && !code; first += BLOCK) {
    int count = *length - first < BLOCK ? (int)(*length - first) : BLOCK;
    code = eo_recording_read(maker->recording, first, count, block, error);
    for (int i = 0; i < count && !code; i++) {
      double value = block[(size_t)i * (size_t)columns + (size_t)maker->column];
      if (isnan(value))
        continue;
      if (value != last)
        before = last, run = 0, began = first + i;
      last = value;
      run++;
    }
  }
  free(block);
  bool falls = last < before;
  if (falls || run > 2)
    *length = maker->train->filled_at = falls ? began : began + 1;
  return code;
}

static enum eo_code read_all(struct maker *maker, int64_t length, struct eo_error *error)
{
  int columns = eo_recording_columns(maker->recording), ahead = 0;
  double time[SIDE + 1], *block = malloc(sizeof *block * BLOCK * (size_t)columns);
  int64_t row[SIDE + 1];
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; first < length && !code; first += BLOCK) {
    int count = length - first < BLOCK ? (int)(length - first) : BLOCK;
    code = eo_recording_read(maker->recording, first, count, block, error);
    for (int i = 0; i < count && !code; i++) {
      double value = block[(size_t)i * (size_t)columns + (size_t)maker->column] * maker->scale;
      if (!isfinite(value))
        continue;
      row[ahead] = first + i;
      time[ahead++] = value;
      if (ahead <= SIDE)
        continue;
      code = take(maker, time, SIDE, row[0], error);
      for (int k = 1; k < ahead; k++) {
        time[k - 1] = time[k];
        row[k - 1] = row[k];
      }
      ahead--;
    }
  }
  for (int k = 0; k < ahead && !code; k++)
    code = take(maker, time + k, ahead - k - 1, row[k], error);
  free(block);
  return code ? code : flush(maker, error);
}

enum eo_code eo_pulse_train_make(struct eo_pulse_train *train, const struct eo_recording *recording,
                                 const struct eo_tracks *tracks, int channel, const char *spool_directory,
                                 struct eo_error *error)
{
  struct maker *maker = calloc(1, sizeof *maker);
  *train = (struct eo_pulse_train){.missed_at = -1, .doubled_at = -1, .unclear_at = -1, .back_at = -1, .filled_at = -1};
  enum eo_code code = maker ? eo_recording_new(&train->pulses, 2, spool_directory, error) : eo_error_memory(error);
  if (!code) {
    maker->recording = recording;
    maker->train = train;
    maker->column = tracks->channel[channel].column[0];
    maker->scale = tracks->time_scale;
    int64_t length = eo_recording_length(recording, maker->column);
    code = find_end(maker, &length, error);
    code = code ? code : read_all(maker, length, error);
    find_wheel(maker, tracks->channel[channel].lines);
  }
  free(maker);
  return code;
}

void eo_pulse_train_done(struct eo_pulse_train *train)
{
  eo_recording_free(train->pulses);
  train->pulses = NULL;
}

/* A few may be out of order; where many are, all that follows a late one would be left out. */
static void judge_order(const struct eo_pulse_train *train, int channel, const char *name, struct eo_findings *findings)
{
  if (train->filled_at >= 0)
    eo_findings_add(findings, EO_FINDING_PULSE, EO_SEVERITY_NOTE, channel, (double)train->filled_at,
                    "From row %lld on one value fills up the column of the %s; it was left out.",
                    (long long)train->filled_at + 1, name)
        ->row = train->filled_at;
  if (train->back > MOST_BACK)
    eo_findings_add(findings, EO_FINDING_PULSE, EO_SEVERITY_REFUSED, channel, (double)train->back,
                    "%lld pulses of the %s are earlier than one before them, the first in row %lld: the rows are out "
                    "of order, or the counter starts again after another number of ticks than 16, 24 or 32 bits have. "
                    "Write times that go on.",
                    (long long)train->back, name, (long long)train->back_at + 1)
        ->row = train->back_at;
  else if (train->back)
    eo_findings_add(findings, EO_FINDING_PULSE, EO_SEVERITY_REPAIRED, channel, (double)train->back,
                    "%lld pulses of the %s are earlier than the one before, the first in row %lld; they were left out.",
                    (long long)train->back, name, (long long)train->back_at + 1)
        ->row = train->back_at;
}

void eo_pulse_train_judge(const struct eo_pulse_train *train, int channel, struct eo_findings *findings)
{
  const char *name = channel ? "gear" : "pinion";
  judge_order(train, channel, name, findings);
  if (train->teeth_missing)
    eo_findings_add(findings, EO_FINDING_PULSE, EO_SEVERITY_NOTE, channel, train->teeth_missing,
                    "The wheel of the %s has %.0f teeth less %d that are missing; their lines were counted.", name,
                    train->lines, train->teeth_missing);
  if (train->missed)
    eo_findings_add(findings, EO_FINDING_PULSE, EO_SEVERITY_REPAIRED, channel, (double)train->missed,
                    "%lld lines of the %s gave no pulse, the first before row %lld; they were counted by the time that "
                    "passed.",
                    (long long)train->missed, name, (long long)train->missed_at + 1)
        ->row = train->missed_at;
  if (train->doubled)
    eo_findings_add(findings, EO_FINDING_PULSE, EO_SEVERITY_REPAIRED, channel, (double)train->doubled,
                    "%lld pulses of the %s follow the one before at once, the first in row %lld; they were left out.",
                    (long long)train->doubled, name, (long long)train->doubled_at + 1)
        ->row = train->doubled_at;
  if (train->unclear)
    eo_findings_add(
        findings, EO_FINDING_PULSE, EO_SEVERITY_REFUSED, channel, (double)train->unclear_at,
        "Before row %lld the %s has a gap that is no whole number of lines: how many pulses were lost there "
        "cannot be told.",
        (long long)train->unclear_at + 1, name)
        ->row = train->unclear_at;
}
