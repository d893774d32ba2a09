/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 4096, CHUNK = 256 };
static const double LANDING = 0.3;   /* typical steps: a step back by less is noise */
static const double NEAR_ZERO = 1.5; /* typical steps from 0, in the row after an index pulse */

static int ascending(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double eo_scan_quantile(double *value, int count, double share)
{
  if (count < 1)
    return NAN;
  qsort(value, (size_t)count, sizeof *value, ascending);
  return value[(int)(share * (count - 1) + 0.5)];
}

static void learn_column(struct eo_scan_column *c, const double *rows, int count, int columns, int column,
                         double *scratch)
{
  int steps = 0;
  double sum = 0, before = NAN;
  c->quantum = INFINITY;
  for (int i = 0; i < count; i++) {
    double value = rows[(size_t)i * (size_t)columns + (size_t)column];
    if (i % CHUNK && isfinite(value) && isfinite(before)) {
      double step = fabs(value - before);
      scratch[steps++] = step;
      if (step > 0 && step < c->quantum)
        c->quantum = step;
    }
    before = isfinite(value) ? value : before;
  }
  int kept = steps - steps / 10;
  eo_scan_quantile(scratch, steps, 0.5);
  for (int i = 0; i < kept; i++)
    sum += scratch[i];
  c->typical = kept ? sum / kept : 0;
  if (!isfinite(c->quantum))
    c->quantum = 0;
}

static double typical_interval(const struct eo_tracks *t, const double *rows, int count, int columns, double *scratch)
{
  int steps = 0;
  if (t->time_column < 0)
    return t->interval;
  for (int i = 1; i < count; i++) {
    if (i % CHUNK == 0)
      continue;
    const double *row = rows + (size_t)i * (size_t)columns + t->time_column;
    double step = (row[0] - row[-columns]) * t->time_scale;
    if (step > 0)
      scratch[steps++] = step;
  }
  return eo_scan_quantile(scratch, steps, 0.5);
}

static bool usable(const struct eo_tracks *t, const double *row)
{
  bool good = t->time_column < 0 || isfinite(row[t->time_column]);
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < eo_track_columns(&t->channel[member]); k++)
      good = good && isfinite(row[t->channel[member].column[k]]);
  return good;
}

static bool add_value(struct eo_scan_column *c, double value, int64_t at, int64_t used)
{
  double step = used ? value - c->before : 0;
  if (!used || value < c->low) {
    c->low = value;
    c->at_low = 0;
  }
  if (!used || value > c->high) {
    c->high = value;
    c->at_high = 0;
  }
  c->at_low += value == c->low;
  c->at_high += value == c->high;
  c->run = used && step == 0 ? c->run + 1 : 1;
  c->travel = c->run > 1 ? c->travel : 0;
  if (used && fabs(step) > 10 * c->typical && c->typical > 0) {
    if (c->jumps < EO_SCAN_JUMPS)
      c->jump[c->jumps] = fabs(step) + c->typical;
    c->jumps++;
    c->falls += step < 0;
  }
  for (int below = 0; below < 2 && used; below++) {
    double size = below ? step : -step, from_zero = below ? -value : value;
    if (c->landing[below] < 0 && size > LANDING * c->typical && from_zero >= 0 && from_zero <= NEAR_ZERO * c->typical) {
      c->landing[below] = at;
      c->landed[below] = size;
    }
  }
  c->before = value;
  return step == 0;
}

/* Runs of equal values count where the other channel goes on at no less than half its usual pace: a rig may rest. */
static void note_runs(struct eo_scan *s, const struct eo_tracks *t, const double step[2], int64_t at)
{
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < eo_track_columns(&t->channel[member]); k++) {
      struct eo_scan_column *c = &s->column[member][k];
      const struct eo_scan_column *other = &s->column[!member][0];
      double steps = other->typical > 0 ? fabs(step[!member]) / other->typical : 0;
      if (c->run > 1)
        c->travel += steps < 10 ? steps : 1;
      if (c->run > c->longest && 2 * c->travel >= (double)c->run) {
        c->longest = c->run;
        c->longest_row = at - c->run + 1;
      }
    }
}

static void add_row(struct eo_scan *s, const struct eo_tracks *t, const double *row, int64_t at)
{
  if (!usable(t, row)) {
    if (!s->unusable++)
      s->unusable_row = at;
    return;
  }
  double time = t->time_column < 0 ? t->interval * (double)at : row[t->time_column] * t->time_scale;
  double before = s->column[0][0].before;
  bool same = s->used > 0;
  double step[2];
  for (int member = 0; member < 2; member++)
    step[member] = s->used ? row[t->channel[member].column[0]] - s->column[member][0].before : 0;
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < eo_track_columns(&t->channel[member]); k++)
      same = add_value(&s->column[member][k], row[t->channel[member].column[k]], at, s->used) && same;
  note_runs(s, t, step, at);
  if (s->used && time <= s->time_last) {
    double pace = fabs(row[t->channel[0].column[0]] - before), usual = s->column[0][0].typical;
    if (s->backward + s->standing == 0)
      s->time_row = at;
    s->backward += time < s->time_last;
    s->standing += time == s->time_last;
    s->duplicate += time == s->time_last && same;
    s->steady += pace > 0.5 * usual && pace < 1.5 * usual;
  }
  s->time_last = time;
  if (!s->used)
    s->time_first = time;
  s->used++;
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

static enum eo_code learn(struct eo_scan *s, const struct eo_recording *recording, const struct eo_tracks *tracks,
                          double *rows, double *scratch, struct eo_error *error)
{
  int columns = eo_recording_columns(recording), count;
  enum eo_code code = read_samples(recording, s->rows, rows, &count, error);
  for (int member = 0; member < 2 && !code; member++)
    for (int k = 0; k < eo_track_columns(&tracks->channel[member]); k++)
      learn_column(&s->column[member][k], rows, count, columns, tracks->channel[member].column[k], scratch);
  if (!code)
    s->interval = typical_interval(tracks, rows, count, columns, scratch);
  return code;
}

enum eo_code eo_scan_run(struct eo_scan *s, const struct eo_recording *recording, const struct eo_tracks *tracks,
                         const struct eo_progress *progress, struct eo_error *error)
{
  int columns = eo_recording_columns(recording);
  double *rows = malloc(sizeof *rows * BLOCK * (size_t)(columns + 1));
  if (!rows)
    return eo_error_memory(error);
  double *scratch = rows + (size_t)BLOCK * (size_t)columns;
  memset(s, 0, sizeof *s);
  s->rows = eo_recording_rows(recording);
  for (int i = 0; i < 4; i++)
    s->column[i / 2][i % 2].landing[0] = s->column[i / 2][i % 2].landing[1] = -1;
  enum eo_code code = learn(s, recording, tracks, rows, scratch, error);
  for (int64_t first = 0; first < s->rows && !code; first += BLOCK) {
    int count = s->rows - first < BLOCK ? (int)(s->rows - first) : BLOCK;
    if (eo_progress_report(progress, "first look", (double)first / (double)s->rows)) {
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
      break;
    }
    code = eo_recording_read(recording, first, count, rows, error);
    for (int i = 0; i < count && !code; i++)
      add_row(s, tracks, rows + (size_t)i * (size_t)columns, first + i);
  }
  free(rows);
  return code;
}

double eo_scan_period(const struct eo_scan_column *c, double turn)
{
  int kept = c->jumps < EO_SCAN_JUMPS ? c->jumps : EO_SCAN_JUMPS, wide = 0, alike = 0;
  double range = c->high - c->low, *sorted = malloc(sizeof *sorted * (size_t)(kept + 1)), period;
  if (!sorted)
    return NAN;
  for (int i = 0; i < kept; i++)
    if (c->jump[i] > 0.5 * range)
      sorted[wide++] = c->jump[i];
  period = eo_scan_quantile(sorted, wide, 0.5);
  if (wide == 2 && turn > 0 && fabs(sorted[1] / turn - 1) < 0.05)
    period = sorted[1];
  for (int i = 0; i < wide; i++)
    alike += fabs(sorted[i] / period - 1) < 0.1;
  bool first_differs = kept > 1 && alike == wide - 1 && fabs(c->jump[0] / period - 1) >= 0.1;
  free(sorted);
  return wide && (alike >= 0.8 * wide || first_differs) && range < 1.05 * period ? period : NAN;
}

int64_t eo_scan_index_row(const struct eo_scan_column *c, double period)
{
  int below = 2 * c->falls < c->jumps;
  bool partial = c->landing[below] > 0 &&
                 fabs(c->landed[below] + c->typical - period) > 2 * c->typical + 0.001 * period;
  return partial ? c->landing[below] : 0;
}

double eo_scan_clipped(const struct eo_scan_column *c, int64_t rows)
{
  double amplitude = (c->high - c->low) / 2, step = fmin(c->quantum, amplitude);
  double expected = amplitude > 0 ? acos(1 - step / amplitude) / M_PI : 1;
  double share = (double)(c->at_low > c->at_high ? c->at_low : c->at_high) / (double)rows;
  return share > 3 * expected + 0.005 ? share : 0;
}
