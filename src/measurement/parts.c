/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measurement/scan.h"

enum { BLOCK = 4096, MOST_STRETCHES = 4096, STRETCHES = MOST_STRETCHES + 2 * EO_RUNS, MOST_TURNS = 1 << 16 };
static const double STANDING = 0.02; /* of the fast tenth of all speeds: slower is no measurement, and creeps there */
static const double LEAST_TURNS = 3; /* of the pinion in a part; the shaft orders need them */
static const double STEADY = 0.02;   /* relative: turns this near to their median are one steady state */
static const double RUN_UP = 1.25;   /* highest over lowest speed of turns: below, one number serves all */
static const double TAIL = 0.25;     /* of a turn: less tells no speed */
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
  int stretches;
  struct stretch *stretch; /* owned, [stretches + 1] */
  double *speed;           /* owned, [stretches] rad/s, signed */
  double *scratch;         /* owned, [stretches + MOST_TURNS] */
  struct stretch *turn;    /* owned, [turns + 1]: where whole turns begin */
  int turns;
  double turns_each;   /* pinion turns between them */
  struct stretch tail; /* the last row of the part, behind the last whole turn */
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

static int64_t rows_each(const struct finder *finder)
{
  int64_t rows = finder->angles->rows, each = rows / MOST_STRETCHES + 1, least = rows / 16 < 32 ? rows / 16 : 32;
  return each > least ? each : least > 1 ? least : 1;
}

/* A run begins with this row. */
static bool begins_run(const struct finder *finder, int64_t row)
{
  for (int i = 0; i < finder->angles->breaks; i++)
    if (finder->angles->run[i] == row)
      return true;
  return false;
}

static void add_stretch(struct finder *finder, int64_t index, const double row[3])
{
  bool ends = begins_run(finder, index) || begins_run(finder, index + 1);
  if ((ends || index % rows_each(finder) == 0) && finder->stretches < STRETCHES)
    finder->stretch[finder->stretches++] = (struct stretch){index, row[0], row[1]};
}

/* The speed of every stretch and the size of the fast ones. */
static double find_speeds(struct finder *finder)
{
  int n = --finder->stretches;
  for (int i = 0; i < n; i++) {
    double time = finder->stretch[i + 1].time - finder->stretch[i].time;
    bool across = begins_run(finder, finder->stretch[i + 1].row);
    finder->speed[i] = time > 0 && !across ? (finder->stretch[i + 1].angle - finder->stretch[i].angle) / time : 0;
    finder->scratch[i] = fabs(finder->speed[i]);
  }
  return eo_scan_quantile(finder->scratch, n, 0.9);
}

static int direction_of(double speed, double fast)
{
  return speed > STANDING * fast ? 1 : speed < -STANDING * fast ? -1 : 0;
}

static struct eo_part part_between(const struct finder *finder, const struct stretch *from, const struct stretch *to)
{
  return (struct eo_part){.first = from->row,
                          .last = to->row,
                          .from = from->time - finder->angles->origin,
                          .to = to->time - finder->angles->origin,
                          .turns = (to->angle - from->angle) / (2 * M_PI)};
}

/* Runs of stretches that turn one way. Beside a stop or a turn back the stretch at the border moves only in part and is
   left out. */
static void find_runs(struct finder *finder, double fast)
{
  struct eo_parts *parts = finder->parts;
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
      part.last = finder->angles->rows - 1;
    if (fabs(part.turns) < LEAST_TURNS && parts->count)
      continue;
    if (parts->count && fabs(parts->part[0].turns) < LEAST_TURNS)
      parts->count = 0; /* a short part stands for itself only where there is nothing else */
    if (parts->count < EO_PARTS)
      parts->part[parts->count] = part;
    parts->count++;
  }
}

static void add_turn(struct finder *finder, int64_t index, const double row[3])
{
  double angle = fabs(row[1] - finder->turn[0].angle);
  finder->tail = (struct stretch){index, row[0], row[1]};
  if (finder->turns == 0 && finder->turn[0].row < 0)
    finder->turn[0] = (struct stretch){index, row[0], row[1]};
  else if (finder->turns < MOST_TURNS && angle >= 2 * M_PI * finder->turns_each * (finder->turns + 1))
    finder->turn[++finder->turns] = (struct stretch){index, row[0], row[1]};
}

static double speed_between(const struct stretch *from, const struct stretch *to)
{
  return fabs((to->angle - from->angle) / (to->time - from->time));
}

static double turn_speed(const struct finder *finder, int turn)
{
  return speed_between(&finder->turn[turn], &finder->turn[turn + 1]);
}

/* What is left behind the last whole turn counts when it is more than a small part of one. */
static bool has_tail(const struct finder *finder)
{
  const struct stretch *last = &finder->turn[finder->turns];
  return last->row >= 0 && fabs(finder->tail.angle - last->angle) > 2 * M_PI * TAIL;
}

static void find_range(const struct finder *finder, int from, int to, struct eo_part *part)
{
  part->speed_low = INFINITY;
  part->speed_high = 0;
  for (int i = from; i < to; i++) {
    part->speed_low = fmin(part->speed_low, turn_speed(finder, i));
    part->speed_high = fmax(part->speed_high, turn_speed(finder, i));
  }
  if (to > from && to == finder->turns && has_tail(finder)) {
    double speed = speed_between(&finder->turn[to], &finder->tail);
    part->speed_low = fmin(part->speed_low, speed);
    part->speed_high = fmax(part->speed_high, speed);
  }
  if (to <= from)
    part->speed_low = part->speed_high = fabs(part->turns) * 2 * M_PI / (part->to - part->from);
}

static enum eo_code find_turns(struct finder *finder, struct eo_part *part, struct eo_error *error)
{
  finder->turns = 0;
  finder->turn[0] = (struct stretch){-1, 0, 0};
  finder->turns_each = ceil(fabs(part->turns) / MOST_TURNS);
  finder->turns_each = finder->turns_each > 1 ? finder->turns_each : 1;
  enum eo_code code = each_row(finder, part->first, part->last, add_turn, error);
  if (!code)
    find_range(finder, 0, finder->turns, part);
  return code;
}

/* The longest run of turns near the median of the part's turns: the steady state, if there is one. */
static void find_steady(const struct finder *finder, int *from, int *to)
{
  double *speed = finder->scratch;
  for (int i = 0; i < finder->turns; i++)
    speed[i] = turn_speed(finder, i);
  double usual = eo_scan_quantile(speed, finder->turns, 0.5);
  *from = *to = 0;
  for (int i = 0, begin = 0; i <= finder->turns; i++) {
    if (i < finder->turns && fabs(turn_speed(finder, i) / usual - 1) < STEADY)
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
  const struct eo_parts *parts = finder->parts;
  const struct eo_part *used = &parts->part[parts->used];
  double all = finder->stretch[finder->stretches].time - finder->stretch[0].time;
  int kept = parts->count < EO_PARTS ? parts->count : EO_PARTS;
  if (finder->choice->part || (parts->count == 1 && used->first == 0 && used->last == finder->angles->rows - 1))
    return;
  if (kept == 1 && finder->angles->breaks)
    eo_findings_add(finder->findings, EO_FINDING_UNSTEADY, EO_SEVERITY_REPAIRED, -1, used->from,
                    "One run alone has turns enough: what is measured goes from %.4g s to %.4g s of %.4g s.",
                    used->from, used->to, all)
        ->row = used->first;
  else if (kept == 1)
    eo_findings_add(finder->findings, EO_FINDING_UNSTEADY, EO_SEVERITY_REPAIRED, -1, used->from,
                    "The shafts stand still or turn back in %.3g s of %.4g s; what is measured goes from %.4g s to "
                    "%.4g s.",
                    all - (used->to - used->from), all, used->from, used->to)
        ->row = used->first;
  else
    eo_findings_add(finder->findings, EO_FINDING_UNSTEADY, EO_SEVERITY_WARNING, -1, parts->count,
                    "%s between %d parts; part %d with the most turns, %.4g s to %.4g s, is "
                    "measured. Choose another one by its number.",
                    finder->angles->breaks ? "The recording starts anew, or the shafts stop or turn back,"
                                           : "The shafts stop or turn back",
                    parts->count, parts->used + 1, used->from, used->to)
        ->row = used->first;
}

static void say_steady(const struct finder *finder, const struct eo_part *whole)
{
  const struct eo_part *part = &finder->parts->measured;
  eo_findings_add(finder->findings, EO_FINDING_UNSTEADY, EO_SEVERITY_REPAIRED, -1, whole->speed_high / whole->speed_low,
                  "The speed goes from %.5g to %.5g rpm; the steady state from %.4g s to %.4g s (%.0f of %.0f turns, "
                  "%.5g to %.5g rpm) is measured, what leads to it is left out.",
                  RPM * whole->speed_low, RPM * whole->speed_high, part->from, part->to, fabs(part->turns),
                  fabs(whole->turns), RPM * part->speed_low, RPM * part->speed_high)
      ->row = part->first;
}

/* Run-up and run-down beside a long steady state are left out; the caller may keep them. */
static enum eo_code settle_part(struct finder *finder, struct eo_error *error)
{
  struct eo_parts *parts = finder->parts;
  struct eo_part *whole = &parts->part[parts->used];
  int from, to;
  enum eo_code code = find_turns(finder, whole, error);
  parts->measured = *whole;
  if (code || finder->choice->whole || whole->speed_high < RUN_UP * whole->speed_low)
    return code;
  find_steady(finder, &from, &to);
  if ((to - from) * finder->turns_each < fmax(MOSTLY * fabs(whole->turns), LEAST_TURNS))
    return EO_OK;
  parts->measured = part_between(finder, &finder->turn[from], &finder->turn[to]);
  bool steady_tail = to == finder->turns &&
                     (!has_tail(finder) ||
                      fabs(speed_between(&finder->turn[to], &finder->tail) / turn_speed(finder, to - 1) - 1) < STEADY);
  if (steady_tail)
    parts->measured = part_between(finder, &finder->turn[from], &finder->tail);
  else if (to == finder->turns)
    finder->tail = finder->turn[to]; /* a run-down */
  find_range(finder, from, to, &parts->measured);
  say_steady(finder, whole);
  return EO_OK;
}

static void refuse(const struct finder *finder, const char *why, double value)
{
  eo_findings_add(finder->findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_REFUSED, -1, value, "%s", why);
}

static enum eo_code choose(struct finder *finder, struct eo_error *error)
{
  struct eo_parts *parts = finder->parts;
  int kept = parts->count < EO_PARTS ? parts->count : EO_PARTS;
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
  parts->used = finder->choice->part > 0 ? finder->choice->part - 1 : 0;
  for (int i = 0; i < kept && !finder->choice->part; i++)
    if (fabs(parts->part[i].turns) > LONGER * fabs(parts->part[parts->used].turns))
      parts->used = i;
  for (int i = 0; i < kept && !code; i++)
    if (i != parts->used)
      code = find_turns(finder, &parts->part[i], error);
  say_parts(finder);
  return code ? code : settle_part(finder, error);
}

static enum eo_code find(struct finder *finder, struct eo_error *error)
{
  EO_TRY(each_row(finder, 0, finder->angles->rows - 1, add_stretch, error));
  find_runs(finder, find_speeds(finder));
  return choose(finder, error);
}

enum eo_code eo_parts_find(struct eo_parts *parts, const struct eo_angles *angles, const struct eo_part_choice *choice,
                           struct eo_findings *findings, const struct eo_progress *progress, struct eo_error *error)
{
  struct finder finder = {
      .angles = angles, .choice = choice, .findings = findings, .progress = progress, .parts = parts};
  *parts = (struct eo_parts){.used = -1};
  finder.stretch = malloc(sizeof *finder.stretch * STRETCHES);
  finder.speed = malloc(sizeof *finder.speed * STRETCHES);
  finder.turn = malloc(sizeof *finder.turn * (MOST_TURNS + 1));
  finder.scratch = malloc(sizeof *finder.scratch * (STRETCHES + MOST_TURNS));
  enum eo_code code = finder.stretch && finder.speed && finder.turn && finder.scratch ? find(&finder, error)
                                                                                      : eo_error_memory(error);
  free(finder.stretch);
  free(finder.speed);
  free(finder.turn);
  free(finder.scratch);
  return code;
}
