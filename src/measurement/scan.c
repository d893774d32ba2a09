/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"

enum { BLOCK = 4096, CHUNK = 256, WRONG_ROWS = 100 };
static const double UNLIKE = 0.06, ALIKE = 0.2; /* relative: sizes of steps that differ, that do not */
static const double MOST_ROWS = 20;  /* times the usual step: a counter that starts again later shows plainly */
static const double LANDING = 0.3;   /* typical steps: a step back by less is noise */
static const double NEAR_ZERO = 1.5; /* typical steps from 0, in the row after an index pulse */
enum { GAP = 20 };                   /* rows that cannot be used */
static const double LEAP = 100;      /* typical intervals: a step of the time by more is a fault */

double eo_scan_quantile(double *value, int count, double share)
{
  if (count < 1)
    return NAN;
  eo_sort_numbers(count, value);
  return value[(int)(share * (count - 1) + 0.5)];
}

/* A counter that starts again every few rows has steps of two sizes: one as it counts, one where it starts again, which
   with the first makes its width; their shares are as those sizes. step[steps]: in order. Its usual step; 0: it is no
   such counter. */
static double wide_step(struct eo_scan_column *column, const double *step, int steps)
{
  double least = steps > 50 ? step[steps / 50] : 0, most = steps > 50 ? step[steps - 1 - steps / 50] : 0;
  double sum[2] = {0};
  int count[2] = {0};
  for (int i = 0; i < steps; i++) {
    int high = step[i] > (least + most) / 2;
    sum[high] += step[i];
    count[high]++;
  }
  if (!count[0] || !count[1] || !(least > 0))
    return 0;
  double low = sum[0] / count[0], high = sum[1] / count[1], share = (double)count[1] / steps;
  bool two = high > (1 + UNLIKE) * low && least > (1 - ALIKE) * low &&
             step[count[0] - 1 - count[0] / 50] < (1 + ALIKE) * low;
  if (!two || high > MOST_ROWS * low || fabs(share * (low + high) / low - 1) > ALIKE)
    return 0;
  column->width = low + high;
  return low;
}

static void learn_column(struct eo_scan_column *scan_column, const double *rows, int count, int columns, int column,
                         double *scratch)
{
  int steps = 0;
  double sum = 0, before = NAN;
  scan_column->quantum = INFINITY;
  for (int i = 0; i < count; i++) {
    double value = rows[(size_t)i * (size_t)columns + (size_t)column];
    if (i % CHUNK && isfinite(value) && isfinite(before)) {
      double step = fabs(value - before);
      scratch[steps++] = step;
      if (step > 0 && step < scan_column->quantum)
        scan_column->quantum = step;
    }
    before = isfinite(value) ? value : before;
  }
  int kept = steps - steps / 10;
  eo_scan_quantile(scratch, steps, 0.5);
  for (int i = 0; i < kept; i++)
    sum += scratch[i];
  double wide = wide_step(scan_column, scratch, steps);
  scan_column->typical = wide > 0 ? wide : kept ? sum / kept : 0;
  if (!isfinite(scan_column->quantum))
    scan_column->quantum = 0;
}

static double typical_interval(const struct eo_tracks *tracks, const double *rows, int count, int columns,
                               double *scratch)
{
  int steps = 0;
  if (tracks->time_column < 0)
    return tracks->interval;
  for (int i = 1; i < count; i++) {
    if (i % CHUNK == 0)
      continue;
    const double *row = rows + (size_t)i * (size_t)columns + tracks->time_column;
    double step = (row[0] - row[-columns]) * tracks->time_scale;
    if (step > 0)
      scratch[steps++] = step;
  }
  return eo_scan_quantile(scratch, steps, 0.5);
}

static bool usable(const struct eo_tracks *tracks, const double *row)
{
  bool good = tracks->time_column < 0 || isfinite(row[tracks->time_column]);
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < eo_track_columns(&tracks->channel[member]); k++)
      good = good && isfinite(row[tracks->channel[member].column[k]]);
  return good;
}

/* A run of equal values ended before the row `at`. */
static void note_hold(struct eo_scan_column *column, int64_t at, double step)
{
  column->pairs += column->run == 2;
  if (column->run > 2 && column->holds++ < EO_SCAN_HOLDS)
    column->hold[column->holds - 1] = (struct eo_scan_hold){at - column->run + 1, column->run - 1, step};
}

static bool add_value(struct eo_scan_column *column, double value, int64_t at, int64_t used)
{
  double step = used ? value - column->before : 0;
  if (!used || value < column->low) {
    column->low = value;
    column->at_low = 0;
  }
  if (!used || value > column->high) {
    column->high = value;
    column->at_high = 0;
  }
  column->at_low += value == column->low;
  column->at_high += value == column->high;
  column->rises += (step > 0) - (step < 0);
  if (step != 0)
    note_hold(column, at, step);
  column->run = used && step == 0 ? column->run + 1 : 1;
  column->travel = column->run > 1 ? column->travel : 0;
  if (used && at - column->last > GAP)
    step = 0; /* what jumps over a gap is the way in it */
  column->last = at;
  bool wide = column->width > 0 ? fabs(step) > column->width / 2
                                : fabs(step) > 3 * column->typical && fabs(step) > (column->high - column->low) / 2;
  if (used && (wide || fabs(step) > 10 * column->typical) && column->typical > 0) {
    if (column->jumps < EO_SCAN_JUMPS) {
      column->jump[column->jumps] = fabs(step) + column->typical;
      column->jump_row[column->jumps] = step < 0 ? -at : at;
    }
    column->jumps++;
    column->falls += step < 0;
  }
  for (int below = 0; below < 2 && used; below++) {
    double size = below ? step : -step, from_zero = below ? -value : value;
    if (column->landing[below] < 0 && size > LANDING * column->typical && from_zero >= 0 &&
        from_zero <= NEAR_ZERO * column->typical) {
      column->landing[below] = at;
      column->landed[below] = size;
    }
  }
  column->before = value;
  return step == 0;
}

/* Runs of equal values count where the other channel goes on at no less than half its usual pace: a rig may rest. */
static void note_runs(struct eo_scan *scan, const struct eo_tracks *tracks, const double step[2], int64_t at)
{
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < eo_track_columns(&tracks->channel[member]); k++) {
      struct eo_scan_column *column = &scan->column[member][k];
      const struct eo_scan_column *other = &scan->column[!member][0];
      double steps = other->typical > 0 ? fabs(step[!member]) / other->typical : 0;
      if (column->run > 1)
        column->travel += steps < 10 ? steps : 1;
      if (column->run > column->longest && 2 * column->travel >= (double)column->run) {
        column->longest = column->run;
        column->longest_row = at - column->run + 1;
      }
    }
}

static void add_row(struct eo_scan *scan, const struct eo_tracks *tracks, const double *row, int64_t at)
{
  if (!usable(tracks, row)) {
    if (!scan->unusable++)
      scan->unusable_row = at;
    return;
  }
  double time = tracks->time_column < 0 ? tracks->interval * (double)at : row[tracks->time_column] * tracks->time_scale;
  double before = scan->column[0][0].before;
  bool same = scan->used > 0;
  double step[2];
  for (int member = 0; member < 2; member++)
    step[member] = scan->used ? row[tracks->channel[member].column[0]] - scan->column[member][0].before : 0;
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < eo_track_columns(&tracks->channel[member]); k++)
      same = add_value(&scan->column[member][k], row[tracks->channel[member].column[k]], at, scan->used) && same;
  note_runs(scan, tracks, step, at);
  if (scan->used && time <= scan->time_last) {
    double pace = fabs(row[tracks->channel[0].column[0]] - before), usual = scan->column[0][0].typical;
    if (scan->backward + scan->standing == 0)
      scan->time_row = at;
    scan->backward += time < scan->time_last;
    if (scan->time_last - time > LEAP * scan->interval && scan->returns++ < EO_SCAN_RETURNS)
      scan->return_row[scan->returns - 1] = at;
    scan->standing += time == scan->time_last;
    scan->duplicate += time == scan->time_last && same;
    scan->steady += fabs(pace - usual) < usual / 2;
  } else if (scan->used && time - scan->time_last < LEAP * scan->interval)
    scan->risen += time - scan->time_last;
  else
    scan->leaps += scan->used > 0;
  scan->time_last = time;
  if (!scan->used)
    scan->time_first = time;
  scan->used++;
}

/* rows[BLOCK][columns] from chunks spread over the recording: its start alone may be a rest. */
static enum eo_code read_samples(const struct eo_recording *recording, int64_t total, double *rows, int *count,
                                 struct eo_error *error)
{
  int columns = eo_recording_columns(recording), chunks = BLOCK / CHUNK;
  *count = 0;
  if (total <= BLOCK) {
    *count = (int)total;
    return eo_recording_read(recording, 0, total, rows, error);
  }
  for (int i = 0; i < chunks; i++) {
    int64_t first = (total - CHUNK) * i / (chunks - 1);
    enum eo_code code = eo_recording_read(recording, first, CHUNK, rows + (size_t)*count * (size_t)columns, error);
    if (code)
      return code;
    *count += CHUNK;
  }
  return EO_OK;
}

static enum eo_code learn(struct eo_scan *scan, const struct eo_recording *recording, const struct eo_tracks *tracks,
                          double *rows, double *scratch, struct eo_error *error)
{
  int columns = eo_recording_columns(recording), count;
  enum eo_code code = read_samples(recording, scan->rows, rows, &count, error);
  for (int member = 0; member < 2 && !code; member++)
    for (int k = 0; k < eo_track_columns(&tracks->channel[member]); k++)
      learn_column(&scan->column[member][k], rows, count, columns, tracks->channel[member].column[k], scratch);
  if (!code)
    scan->interval = typical_interval(tracks, rows, count, columns, scratch);
  return code;
}

enum eo_code eo_scan_run(struct eo_scan *scan, const struct eo_recording *recording, const struct eo_tracks *tracks,
                         const struct eo_progress *progress, struct eo_error *error)
{
  int columns = eo_recording_columns(recording);
  double *rows = malloc(sizeof *rows * BLOCK * (size_t)(columns + 1));
  if (!rows)
    return eo_error_memory(error);
  double *scratch = rows + (size_t)BLOCK * (size_t)columns;
  memset(scan, 0, sizeof *scan);
  scan->rows = eo_recording_rows(recording);
  for (int i = 0; i < 4; i++)
    scan->column[i / 2][i % 2].landing[0] = scan->column[i / 2][i % 2].landing[1] = -1;
  enum eo_code code = learn(scan, recording, tracks, rows, scratch, error);
  for (int64_t first = 0; first < scan->rows && !code; first += BLOCK) {
    int count = scan->rows - first < BLOCK ? (int)(scan->rows - first) : BLOCK;
    if (eo_progress_report(progress, "first look", (double)first / (double)scan->rows)) {
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
      break;
    }
    code = eo_recording_read(recording, first, count, rows, error);
    for (int i = 0; i < count && !code; i++)
      add_row(scan, tracks, rows + (size_t)i * (size_t)columns, first + i);
  }
  for (int i = 0; i < 4; i++)
    note_hold(&scan->column[i / 2][i % 2], scan->rows, NAN);
  free(rows);
  return code;
}

/* Jumps are taken from what is read before and behind them, rows apart: a period of theirs, or a turn, is met as nearly
   as that. Most of them show the period where others are faults. */
static const double NEAR = 0.1, A_TURN = 0.05, MOSTLY = 0.8;

double eo_scan_period(const struct eo_scan_column *column, double turn)
{
  int kept = column->jumps < EO_SCAN_JUMPS ? column->jumps : EO_SCAN_JUMPS, wide = 0, alike = 0;
  double range = column->high - column->low, *sorted = malloc(sizeof *sorted * (size_t)(kept + 1)), period;
  if (!sorted)
    return NAN;
  for (int i = 0; i < kept; i++)
    if (column->jump[i] > range / 2)
      sorted[wide++] = column->jump[i];
  period = eo_scan_quantile(sorted, wide, 0.5);
  if (wide == 2 && turn > 0 && fabs(sorted[1] / turn - 1) < A_TURN)
    period = sorted[1];
  for (int i = 0; i < wide; i++)
    alike += fabs(sorted[i] / period - 1) < NEAR;
  bool first_differs = kept > 1 && alike == wide - 1 && fabs(column->jump[0] / period - 1) >= NEAR;
  free(sorted);
  /* What was zeroed in between reaches over more than a turn, but not over two. */
  double widest = turn > 0 && fabs(period / turn - 1) < A_TURN ? 2 : 1 + A_TURN;
  return wide && (alike >= MOSTLY * wide || first_differs) && range < widest * period ? period : NAN;
}

/* Values that come back after so many rows were wrong ones. */
static bool comes_back(const struct eo_scan_column *column, int jump, int64_t rows)
{
  int64_t here = column->jump_row[jump],
          next = jump + 1 < column->jumps && jump + 1 < EO_SCAN_JUMPS ? column->jump_row[jump + 1] : 0;
  bool opposite = next != 0 && (next < 0) != (here < 0);
  return (opposite ? llabs(next) : rows) - llabs(here) < WRONG_ROWS;
}

/* The jumps against the way the values go, by their rows. */
static int falls_back(const struct eo_scan_column *column, int64_t rows, int64_t row[EO_SCAN_JUMPS])
{
  int n = 0;
  for (int i = 0; i < column->jumps && i < EO_SCAN_JUMPS; i++)
    if ((column->jump_row[i] < 0) == (column->rises > 0) && !comes_back(column, i, rows))
      row[n++] = llabs(column->jump_row[i]);
  return n;
}

int eo_scan_restarts(const struct eo_scan *scan, int64_t row[EO_SCAN_JUMPS])
{
  int64_t other[EO_SCAN_JUMPS];
  int restarts = falls_back(&scan->column[0][0], scan->rows, row);
  bool same = restarts == falls_back(&scan->column[1][0], scan->rows, other) &&
              !memcmp(row, other, (size_t)restarts * sizeof row[0]);
  return same ? restarts : 0;
}

static const double OF_PERIOD = 1e-3; /* the typical step is a mean */

int64_t eo_scan_index_row(const struct eo_scan_column *column, double period)
{
  int below = 2 * column->falls < column->jumps;
  bool partial = column->landing[below] > 0 &&
                 fabs(column->landed[below] + column->typical - period) > 2 * column->typical + OF_PERIOD * period;
  return partial ? column->landing[below] : 0;
}

/* At a limit: more than a wave that is not cut is there, and than so few rows that noise could be. */
static const double TIMES_EXPECTED = 3, FEW = 0.005;

double eo_scan_clipped(const struct eo_scan_column *column, int64_t rows)
{
  double amplitude = (column->high - column->low) / 2, step = fmin(column->quantum, amplitude);
  double expected = amplitude > 0 ? acos(1 - step / amplitude) / M_PI : 1;
  double share = (double)(column->at_low > column->at_high ? column->at_low : column->at_high) / (double)rows;
  return share > TIMES_EXPECTED * expected + FEW ? share : 0;
}
