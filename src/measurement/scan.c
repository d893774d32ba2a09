#include "measurement/scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 4096 };

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

/* ---- the first rows: what is usual ---- */

static void learn_column(struct eo_scan_column *c, const double *rows, int count, int columns, int column,
                         double *scratch)
{
  int steps = 0;
  double sum = 0, before = NAN;
  c->quantum = INFINITY;
  for (int i = 0; i < count; i++) {
    double value = rows[(size_t)i * (size_t)columns + (size_t)column];
    if (isfinite(value) && isfinite(before)) {
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
    const double *row = rows + (size_t)i * (size_t)columns + t->time_column;
    double step = (row[0] - row[-columns]) * t->time_scale;
    if (step > 0)
      scratch[steps++] = step;
  }
  return eo_scan_quantile(scratch, steps, 0.5);
}

/* ---- every row ---- */

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
  if (c->run > c->longest) {
    c->longest = c->run;
    c->longest_row = at - c->run + 1;
  }
  if (used && fabs(step) > 10 * c->typical && c->typical > 0) {
    if (c->jumps < EO_SCAN_JUMPS)
      c->jump[c->jumps] = fabs(step) + c->typical;
    c->jumps++;
  }
  c->before = value;
  return step == 0;
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
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < eo_track_columns(&t->channel[member]); k++)
      same = add_value(&s->column[member][k], row[t->channel[member].column[k]], at, s->used) && same;
  if (s->used && time <= s->time_last) {
    double step = fabs(row[t->channel[0].column[0]] - before), usual = s->column[0][0].typical;
    if (s->backward + s->standing == 0)
      s->time_row = at;
    s->backward += time < s->time_last;
    s->standing += time == s->time_last;
    s->duplicate += time == s->time_last && same;
    s->steady += step > 0.5 * usual && step < 1.5 * usual;
  }
  s->time_last = time;
  if (!s->used)
    s->time_first = time;
  s->used++;
}

enum eo_code eo_scan_run(struct eo_scan *s, const struct eo_recording *recording, const struct eo_tracks *tracks,
                         const struct eo_progress *progress, struct eo_error *error)
{
  int columns = eo_recording_columns(recording);
  enum eo_code code = EO_OK;
  double *rows = malloc(sizeof *rows * BLOCK * (size_t)(columns + 1)),
         *scratch = rows + (size_t)BLOCK * (size_t)columns;
  if (!rows)
    return eo_error_memory(error);
  memset(s, 0, sizeof *s);
  s->rows = eo_recording_rows(recording);
  for (int64_t first = 0; first < s->rows && !code; first += BLOCK) {
    int count = s->rows - first < BLOCK ? (int)(s->rows - first) : BLOCK;
    if (eo_progress_report(progress, "first look", (double)first / (double)s->rows)) {
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
      break;
    }
    code = eo_recording_read(recording, first, count, rows, error);
    for (int member = 0; member < 2 && !first && !code; member++)
      for (int k = 0; k < eo_track_columns(&tracks->channel[member]); k++)
        learn_column(&s->column[member][k], rows, count, columns, tracks->channel[member].column[k], scratch);
    if (!first && !code)
      s->interval = typical_interval(tracks, rows, count, columns, scratch);
    for (int i = 0; i < count && !code; i++)
      add_row(s, tracks, rows + (size_t)i * (size_t)columns, first + i);
  }
  free(rows);
  return code;
}

/* ---- what it tells ---- */

double eo_scan_period(const struct eo_scan_column *c)
{
  int kept = c->jumps < EO_SCAN_JUMPS ? c->jumps : EO_SCAN_JUMPS, wide = 0, alike = 0;
  double range = c->high - c->low, *sorted = malloc(sizeof *sorted * (size_t)(kept + 1)), period;
  if (!sorted)
    return NAN;
  for (int i = 0; i < kept; i++)
    if (c->jump[i] > 0.5 * range)
      sorted[wide++] = c->jump[i];
  period = eo_scan_quantile(sorted, wide, 0.5);
  for (int i = 0; i < wide; i++)
    alike += fabs(sorted[i] / period - 1) < 0.1;
  free(sorted);
  return wide && alike >= 0.8 * wide && range < 1.05 * period ? period : NAN;
}

double eo_scan_clipped(const struct eo_scan_column *c, int64_t rows)
{
  double amplitude = (c->high - c->low) / 2, step = fmin(c->quantum, amplitude);
  double expected = amplitude > 0 ? acos(1 - step / amplitude) / M_PI : 1;
  double share = (double)(c->at_low > c->at_high ? c->at_low : c->at_high) / (double)rows;
  return share > 3 * expected + 0.005 ? share : 0;
}
