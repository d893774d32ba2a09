/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where both channels jump at once: how far the shafts went on meanwhile, which the ratio of the teeth tells but for
   whole hunting periods, and where a new run begins, whose angles have nothing to do with those before. */
#include "measurement/angles_private.h"

#include <math.h>
#include <stdlib.h>

static const double SAME_RATIO = 0.02;  /* relative: the speeds of a block against the teeth */
static const double SHAFTS = 1e-3;      /* rad: by so much eccentric encoders may differ from the ratio of the teeth */
static const double SHAFTS_PART = 0.02; /* of the jump: more would be one channel's own */
static const double LOST_ROWS = 10;     /* fewer than the time says: a clock may be late by some */
static const double PAUSE = 100;        /* intervals: a recording that was begun once more */
enum { MOST_TURNS = 2048 };

/* The second channel's way over that of the first, signed: by the teeth, where the speeds agree with them. */
static double ratio_of(const struct eo_angles_maker *maker, const struct eo_usual *usual, bool *exact)
{
  double seen = usual->rate[1] / usual->rate[0];
  *exact = false;
  for (int swap = 0; swap < 2; swap++) {
    double expected = (double)maker->teeth[swap] / maker->teeth[!swap];
    if (fabs(fabs(seen) / expected - 1) < SAME_RATIO) {
      *exact = true;
      return copysign(expected, seen);
    }
  }
  return seen;
}

/* A way of both shafts from one sample to the next. */
struct way {
  double step[2];   /* rad */
  int64_t turns[2]; /* of the angles that start again, which it takes beside those that were counted */
};

/* The way that the first channel's turns leave for the second. False: they do not belong together. */
static bool way_of(const struct eo_usual *usual, const double period[2], double ratio, const double step[2],
                   int64_t turns, struct way *way)
{
  double own = step[0] + (double)turns * period[0], wanted = ratio * own;
  double slack = fmax(fmax(usual->limit[1], fabs(ratio) * usual->limit[0]), fmin(SHAFTS, SHAFTS_PART * fabs(own)));
  int64_t other = period[1] > 0 ? llround((wanted - step[1]) / period[1]) : 0;
  *way = (struct way){{own, step[1] + (double)other * period[1]}, {turns, other}};
  return fabs(way->step[1] - wanted) < slack;
}

/* The way forwards that fits both channels and is nearest to what the time says; false: none does, or several that are
   no hunting period apart. */
static bool find_way(const struct eo_angles_maker *maker, const struct eo_usual *usual, const double period[2],
                     const double step[2], double passed, struct way *best)
{
  bool exact, found = false, sole = true;
  double ratio = ratio_of(maker, usual, &exact), hunting = 2 * M_PI * fmax(maker->teeth[0], maker->teeth[1]),
         usually = usual->rate[0] * passed;
  if (usual->rate[0] == 0 || !isfinite(ratio))
    return false;
  int64_t most = exact && period[0] > 0 ? (int64_t)fmin(hunting / period[0], MOST_TURNS) : 0;
  for (int64_t turns = -most; turns <= most; turns++) {
    struct way way;
    if (!way_of(usual, period, ratio, step, turns, &way) || (most && way.step[0] * usual->rate[0] < 0))
      continue;
    sole = sole && (!found || fabs(remainder(way.step[0] - best->step[0], hunting)) < SHAFTS);
    if (!found || fabs(way.step[0] - usually) < fabs(best->step[0] - usually))
      *best = way;
    found = true;
  }
  return found && sole;
}

bool eo_gaps_settle(struct eo_angles_maker *maker, const struct eo_usual *usual, struct eo_sample *sample, int left,
                    double excess[2])
{
  double period[2], step[2], passed = sample->time - maker->last.time;
  struct way way;
  for (int c = 0; c < 2; c++) { /* turns of raw tracks are too short to tell them apart */
    period[c] = maker->tracks->channel[c].track == EO_TRACK_ANGLE ? maker->sampler.period[c] : 0;
    step[c] = sample->angle[c] - maker->last.angle[c];
  }
  if (!find_way(maker, usual, period, step, passed, &way))
    return false;
  for (int c = 0; c < 2; c++) {
    excess[c] = way.step[c] - usual->rate[c] * passed;
    maker->sampler.turns[c] += way.turns[c];
    for (int i = 0; i < left && way.turns[c]; i++)
      sample[i].angle[c] += (double)way.turns[c] * period[c];
  }
  return true;
}

bool eo_gaps_pauses(const struct eo_angles_maker *maker, const struct eo_usual *usual, const struct eo_sample *sample,
                    const double excess[2])
{
  return sample->time - maker->last.time > PAUSE * usual->interval && fabs(excess[0]) > usual->limit[0] &&
         fabs(excess[1]) > usual->limit[1];
}

bool eo_gaps_stops(const struct eo_angles_maker *maker, const struct eo_usual *usual, const struct eo_sample *sample,
                   int left, const double excess[2])
{
  double rows = excess[0] / (usual->rate[0] * usual->interval), passed = sample->time - maker->last.time;
  bool whole = !(maker->sampler.period[0] > 0) && !(maker->sampler.period[1] > 0) && !maker->sampler.pulses;
  int ahead = left - 1 < EO_AHEAD - 1 ? left - 1 : EO_AHEAD - 1;
  double on = ahead > 0 ? (sample[ahead].time - sample->time) / ahead / usual->interval : 1;
  return whole && passed > usual->gap && rows < -LOST_ROWS && on > 0.5; /* a late clock makes up for it at once */
}

void eo_gaps_widen(struct eo_angles_maker *maker)
{
  if (maker->begun &&
      maker->high.angle[0] - maker->low.angle[0] > maker->widest[1].angle[0] - maker->widest[0].angle[0]) {
    maker->widest[0] = maker->low;
    maker->widest[1] = maker->high;
  }
}

void eo_gaps_begin_run(struct eo_angles_maker *maker, struct eo_angles *angles, const struct eo_sample *sample,
                       int written, const char *why)
{
  if (!maker->begun)
    return;
  if (angles->breaks == EO_RUNS) {
    maker->more_runs = true;
    return;
  }
  if (!angles->breaks) {
    maker->run_why = why;
    maker->run_row = sample->row;
    maker->run_time = sample->time + maker->delay - angles->origin;
  }
  angles->run[angles->breaks++] = eo_recording_rows(angles->series) + written;
  eo_gaps_widen(maker);
  maker->begun = false; /* low and high are those of one run */
  for (int i = 0; i < EO_AHEAD; i++)
    maker->recent[i] = *sample;
}

bool eo_gaps_starts_anew(struct eo_angles_maker *maker, int64_t row)
{
  bool anew = false;
  for (; maker->next_restart < maker->restarts && maker->restart[maker->next_restart] <= row; maker->next_restart++)
    anew = true;
  return anew;
}

void eo_gaps_judge(struct eo_angles_maker *maker, const struct eo_angles *angles)
{
  if (maker->more_runs)
    eo_angles_at_row(maker,
                     eo_findings_add(maker->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, -1, EO_RUNS,
                                     "More than %d runs follow each other, the second begins in row %lld after %.6g s: "
                                     "%s. State the times of one of them (from, to).",
                                     EO_RUNS, (long long)maker->run_row + 1, maker->run_time, maker->run_why),
                     maker->run_row);
  else if (angles->breaks)
    eo_angles_at_row(maker,
                     eo_findings_add(maker->findings, EO_FINDING_DROPPED, EO_SEVERITY_REPAIRED, -1, angles->breaks + 1,
                                     "%d runs follow each other, the second begins in row %lld after %.6g s: %s. How "
                                     "the angles of one belong to those of another is not known; each is a part of "
                                     "its own.",
                                     angles->breaks + 1, (long long)maker->run_row + 1, maker->run_time,
                                     maker->run_why),
                     maker->run_row);
}
