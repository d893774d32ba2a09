/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measurement/scan.h"

enum { BLOCK = 4096, MOST_STRETCHES = 4096, MOST_TURNS = 1 << 16, LEAST_ROWS = 8 };
static const double STANDING = 0.02; /* of the fast tenth of all speeds: slower is no measurement, and creeps there */
static const double LEAST_TURNS = 3; /* of the pinion in a part; the shaft orders need them */
static const double STEADY = 0.02;   /* relative: turns this near to their median are one steady state */
static const double RUN_UP = 1.25;   /* highest over lowest speed of turns: below, one number serves all */
static const double MOSTLY = 0.6;    /* of the turns: a steady state this long is meant, the rest leads to it */

static const double LONGER = 1.05; /* by so much a later part has to be longer than an earlier one */

/* A short stretch of rows. */
struct stretch {
  int64_t row;
  double time, angle; /* of the pinion, rad */
};

struct finder {
  const struct eo_angles *angles;
  const struct eo_part_choice *choice;
  struct eo_findings *findings;
  const struct eo_progress *progress;
  struct eo_parts *parts;
  double origin;       /* s, time of the first row */
  int64_t first, last; /* rows that the choice of times leaves */
  int stretches;
  struct stretch *stretch; /* owned, [stretches + 1] */
  double *speed;           /* owned, [stretches] rad/s, signed */
  double *scratch;         /* owned, [stretches + MOST_TURNS] */
  struct stretch *turn;    /* owned, [turns + 1]: where whole turns begin */
  int turns;
  double turns_each; /* pinion turns between them */
};

typedef void row_function(struct finder *f, int64_t index, const double row[3]);

static enum eo_code each_row(struct finder *finder, int64_t first, int64_t last, row_function *function,
                             struct eo_error *error)
{
  double(*rows)[3] = malloc(sizeof *rows * BLOCK);
  enum eo_code code = rows ? EO_OK : eo_error_memory(error);
  for (int64_t at = first; at <= last && !code; at += BLOCK) {
    int count = last - at + 1 < BLOCK ? (int)(last - at + 1) : BLOCK;
    code = eo_angles_read(finder->angles, at, count, rows[0], error);
    if (!code && eo_progress_report(finder->progress, "speed", (double)at / (double)finder->angles->rows))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    for (int i = 0; i < count && !code; i++)
      function(finder, at + i, rows[i]);
  }
  free(rows);
  return code;
}

static int64_t rows_each(const struct finder *f)
{
  int64_t rows = f->angles->rows, each = rows / MOST_STRETCHES + 1, least = rows / 16 < 32 ? rows / 16 : 32;
  return each > least ? each : least > 1 ? least : 1;
}

static void add_stretch(struct finder *finder, int64_t index, const double row[3])
{
  double time = row[0] - finder->origin;
  bool outside = time < finder->choice->from || (finder->choice->to > 0 && time > finder->choice->to);
  if (index == 0 && finder->choice->from <= 0)
    outside = false;
  if (outside)
    return;
  if (finder->first < 0)
    finder->first = index;
  finder->last = index;
  if ((index - finder->first) % rows_each(finder) == 0 && finder->stretches < MOST_STRETCHES)
    finder->stretch[finder->stretches++] = (struct stretch){index, row[0], row[1]};
}

/* The speed of every stretch and the size of the fast ones. */
static double find_speeds(struct finder *f)
{
  int n = --f->stretches;
  for (int i = 0; i < n; i++) {
    double time = f->stretch[i + 1].time - f->stretch[i].time;
    f->speed[i] = time > 0 ? (f->stretch[i + 1].angle - f->stretch[i].angle) / time : 0;
    f->scratch[i] = fabs(f->speed[i]);
  }
  return eo_scan_quantile(f->scratch, n, 0.9);
}

static int direction_of(double speed, double fast)
{
  return speed > STANDING * fast ? 1 : speed < -STANDING * fast ? -1 : 0;
}

static struct eo_part part_between(const struct finder *f, const struct stretch *from, const struct stretch *to)
{
  return (struct eo_part){.first = from->row,
                          .last = to->row,
                          .from = from->time - f->origin,
                          .to = to->time - f->origin,
                          .turns = (to->angle - from->angle) / (2 * M_PI)};
}

/* Runs of stretches that turn one way. Beside a stop or a turn back the stretch at the border moves only in part and is
   left out. */
static void find_runs(struct finder *finder, double fast)
{
  struct eo_parts *p = finder->parts;
  int n = finder->stretches;
  for (int from = 0, to; from < n; from = to) {
    int way = direction_of(finder->speed[from], fast);
    for (to = from + 1; to < n && direction_of(finder->speed[to], fast) == way;)
      to++;
    int begin = from > 0 ? from + 1 : from, end = to < n ? to - 1 : to;
    if (!way || end <= begin)
      continue;
    struct eo_part part = part_between(finder, &finder->stretch[begin], &finder->stretch[end]);
    if (to == n)
      part.last = finder->last;
    if (fabs(part.turns) < LEAST_TURNS && p->count)
      continue;
    if (p->count && fabs(p->part[0].turns) < LEAST_TURNS)
      p->count = 0; /* a short part stands for itself only where there is nothing else */
    if (p->count < EO_PARTS)
      p->part[p->count] = part;
    p->count++;
  }
}

static void add_turn(struct finder *f, int64_t index, const double row[3])
{
  double angle = fabs(row[1] - f->turn[0].angle);
  if (f->turns == 0 && f->turn[0].row < 0)
    f->turn[0] = (struct stretch){index, row[0], row[1]};
  else if (f->turns < MOST_TURNS && angle >= 2 * M_PI * f->turns_each * (f->turns + 1))
    f->turn[++f->turns] = (struct stretch){index, row[0], row[1]};
}

static double turn_speed(const struct finder *f, int turn)
{
  return fabs((f->turn[turn + 1].angle - f->turn[turn].angle) / (f->turn[turn + 1].time - f->turn[turn].time));
}

static void find_range(const struct finder *f, int from, int to, struct eo_part *part)
{
  part->speed_low = INFINITY;
  part->speed_high = 0;
  for (int i = from; i < to; i++) {
    part->speed_low = fmin(part->speed_low, turn_speed(f, i));
    part->speed_high = fmax(part->speed_high, turn_speed(f, i));
  }
  if (to <= from)
    part->speed_low = part->speed_high = fabs(part->turns) * 2 * M_PI / (part->to - part->from);
}

static enum eo_code find_turns(struct finder *f, struct eo_part *part, struct eo_error *error)
{
  f->turns = 0;
  f->turn[0] = (struct stretch){-1, 0, 0};
  f->turns_each = ceil(fabs(part->turns) / MOST_TURNS);
  f->turns_each = f->turns_each > 1 ? f->turns_each : 1;
  enum eo_code code = each_row(f, part->first, part->last, add_turn, error);
  if (!code)
    find_range(f, 0, f->turns, part);
  return code;
}

/* The longest run of turns near the median of the part's turns: the steady state, if there is one. */
static void find_steady(const struct finder *f, int *from, int *to)
{
  double *speed = f->scratch;
  for (int i = 0; i < f->turns; i++)
    speed[i] = turn_speed(f, i);
  double usual = eo_scan_quantile(speed, f->turns, 0.5);
  *from = *to = 0;
  for (int i = 0, begin = 0; i <= f->turns; i++) {
    if (i < f->turns && fabs(turn_speed(f, i) / usual - 1) < STEADY)
      continue;
    if (i - begin > *to - *from) {
      *from = begin;
      *to = i;
    }
    begin = i + 1;
  }
}

static const double RPM = 30 / M_PI;

static void say_parts(const struct finder *finder)
{
  const struct eo_parts *p = finder->parts;
  const struct eo_part *used = &p->part[p->used];
  double all = finder->stretch[finder->stretches].time - finder->stretch[0].time;
  int kept = p->count < EO_PARTS ? p->count : EO_PARTS;
  if (finder->choice->part || (p->count == 1 && used->first == finder->first && used->last == finder->last))
    return;
  if (kept == 1)
    eo_findings_add(finder->findings, EO_FINDING_UNSTEADY, EO_SEVERITY_REPAIRED, -1, used->from,
                    "The shafts stand still or turn back in %.3g s of %.4g s; what is measured goes from %.4g s to "
                    "%.4g s.",
                    all - (used->to - used->from), all, used->from, used->to)
        ->row = used->first;
  else
    eo_findings_add(finder->findings, EO_FINDING_UNSTEADY, EO_SEVERITY_WARNING, -1, p->count,
                    "The shafts stop or turn back between %d parts; part %d with the most turns, %.4g s to %.4g s, is "
                    "measured. Choose another one by its number.",
                    p->count, p->used + 1, used->from, used->to)
        ->row = used->first;
}

static void say_steady(const struct finder *f, const struct eo_part *whole)
{
  const struct eo_part *m = &f->parts->measured;
  eo_findings_add(f->findings, EO_FINDING_UNSTEADY, EO_SEVERITY_REPAIRED, -1, whole->speed_high / whole->speed_low,
                  "The speed goes from %.5g to %.5g rpm; the steady state from %.4g s to %.4g s (%.0f of %.0f turns, "
                  "%.5g to %.5g rpm) is measured, what leads to it is left out.",
                  RPM * whole->speed_low, RPM * whole->speed_high, m->from, m->to, fabs(m->turns), fabs(whole->turns),
                  RPM * m->speed_low, RPM * m->speed_high)
      ->row = m->first;
}

/* Run-up and run-down beside a long steady state are left out; the caller may keep them. */
static enum eo_code settle_part(struct finder *finder, struct eo_error *error)
{
  struct eo_parts *p = finder->parts;
  struct eo_part *whole = &p->part[p->used];
  int from, to;
  enum eo_code code = find_turns(finder, whole, error);
  p->measured = *whole;
  if (code || finder->choice->whole || whole->speed_high < RUN_UP * whole->speed_low)
    return code;
  find_steady(finder, &from, &to);
  if ((to - from) * finder->turns_each < fmax(MOSTLY * fabs(whole->turns), LEAST_TURNS))
    return EO_OK;
  p->measured = part_between(finder, &finder->turn[from], &finder->turn[to]);
  if (to == finder->turns)
    p->measured.last = whole->last;
  find_range(finder, from, to, &p->measured);
  say_steady(finder, whole);
  return EO_OK;
}

static void refuse(const struct finder *f, const char *why, double value)
{
  eo_findings_add(f->findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_REFUSED, -1, value, "%s", why);
}

static enum eo_code choose(struct finder *finder, struct eo_error *error)
{
  struct eo_parts *p = finder->parts;
  int kept = p->count < EO_PARTS ? p->count : EO_PARTS;
  if (!kept) {
    refuse(finder, "The pinion does not turn far enough for a measurement.", 0);
    return EO_OK;
  }
  if (finder->choice->part > kept) {
    eo_findings_add(finder->findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_REFUSED, -1, finder->choice->part,
                    "There is no part %d: the shafts turn without a stop in %d part%s.", finder->choice->part, kept,
                    kept == 1 ? "" : "s");
    return EO_OK;
  }
  enum eo_code code = EO_OK;
  p->used = finder->choice->part > 0 ? finder->choice->part - 1 : 0;
  for (int i = 0; i < kept && !finder->choice->part; i++)
    if (fabs(p->part[i].turns) > LONGER * fabs(p->part[p->used].turns))
      p->used = i;
  for (int i = 0; i < kept && !code; i++)
    if (i != p->used)
      code = find_turns(finder, &p->part[i], error);
  say_parts(finder);
  return code ? code : settle_part(finder, error);
}

static enum eo_code find(struct finder *finder, struct eo_error *error)
{
  double first[3];
  enum eo_code code = eo_angles_read(finder->angles, 0, 1, first, error);
  finder->origin = first[0];
  finder->first = finder->last = -1;
  if (!code)
    code = each_row(finder, 0, finder->angles->rows - 1, add_stretch, error);
  if (code)
    return code;
  if (finder->stretches < 2 || finder->last - finder->first < LEAST_ROWS) {
    refuse(finder, "Hardly a row of the recording lies in the times asked for.", (double)finder->stretches);
    return EO_OK;
  }
  find_runs(finder, find_speeds(finder));
  return choose(finder, error);
}

enum eo_code eo_parts_find(struct eo_parts *parts, const struct eo_angles *angles, const struct eo_part_choice *choice,
                           struct eo_findings *findings, const struct eo_progress *progress, struct eo_error *error)
{
  struct finder f = {.angles = angles, .choice = choice, .findings = findings, .progress = progress, .parts = parts};
  *parts = (struct eo_parts){.used = -1};
  f.stretch = malloc(sizeof *f.stretch * MOST_STRETCHES);
  f.speed = malloc(sizeof *f.speed * MOST_STRETCHES);
  f.turn = malloc(sizeof *f.turn * (MOST_TURNS + 1));
  f.scratch = malloc(sizeof *f.scratch * (MOST_STRETCHES + MOST_TURNS));
  enum eo_code code = f.stretch && f.speed && f.turn && f.scratch ? find(&f, error) : eo_error_memory(error);
  free(f.stretch);
  free(f.speed);
  free(f.turn);
  free(f.scratch);
  return code;
}
