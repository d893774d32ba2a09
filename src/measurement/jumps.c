/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/angles_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double DEGREES = 180 / M_PI;
static const double UNEVEN =
    0.2; /* range of the speed in a block, relative: above, steps are judged by their neighbours */
static const double MOSTLY = 0.8; /* of the distances between gaps: even ones */
/* Of values in order: between them nearly all, few enough left out that a fault in twenty rows is not usual. */
static const double LOW = 0.05, MIDDLE = 0.5, HIGH = 0.95;
/* What a step may differ from the usual one, at least: of the step of a row, of which a fault loses or adds a whole
   one; of a count, which two readings may split; per time of a gap, by the speed that changes in it. */
static const double OF_ROW = 0.4, OF_COUNT = 1.6, OF_GAP = 0.02;
enum { LEAST_DISTANCES = 8 };

static double step_of(const struct eo_sample *from, const struct eo_sample *to, int channel)
{
  return to->angle[channel] - from->angle[channel];
}

static void learn(struct eo_angles_maker *maker, const struct eo_sample *sample, int count, struct eo_usual *usual)
{
  int lag = count / 8 > 0 ? count / 8 : 1, n = 0;
  bool uneven = false;
  for (int i = 1; i < count; i++)
    maker->scratch[n++] = sample[i].time - sample[i - 1].time;
  usual->interval = eo_scan_quantile(maker->scratch, n, MIDDLE);
  usual->gap = maker->scratch[(int)(HIGH * (n - 1))] + usual->interval / 2; /* uneven rows alone are no gap */
  for (int c = 0; c < 2; c++) {
    n = 0;
    for (int i = lag; i < count; i++)
      maker->scratch[n++] = step_of(&sample[i - lag], &sample[i], c) / (sample[i].time - sample[i - lag].time);
    usual->rate[c] = eo_scan_quantile(maker->scratch, n, MIDDLE);
    double slow = maker->scratch[(int)(LOW * (n - 1))], fast = maker->scratch[(int)(HIGH * (n - 1))];
    uneven = uneven || fast - slow > UNEVEN * fmax(fabs(slow), fabs(fast));
    n = 0;
    for (int i = 1; i < count; i++)
      maker->scratch[n++] =
          fabs(step_of(&sample[i - 1], &sample[i], c) - usual->rate[c] * (sample[i].time - sample[i - 1].time));
    double spread = eo_scan_quantile(maker->scratch, n, 0.9), most = maker->scratch[(int)(0.995 * (n - 1))];
    double row = fabs(usual->rate[c]) * usual->interval;
    usual->limit[c] = fmax(fmax(4 * spread, OF_ROW * row), OF_COUNT * maker->quantum[c]);
    usual->fine[c] = fmax(fmax(8 * spread, 3 * most), OF_COUNT * maker->quantum[c]);
  }
  usual->uneven = uneven;
}

/* How far the step between two samples is from the usual one. */
static bool odd_step(const struct eo_usual *usual, const double limit[2], const struct eo_sample *from,
                     const struct eo_sample *to, double excess[2])
{
  bool odd = false;
  double time = to->time - from->time, slack = fmax(0, time - 1.5 * usual->interval); /* of a gap in time */
  for (int c = 0; c < 2; c++) {
    excess[c] = step_of(from, to, c) - usual->rate[c] * time;
    odd = odd || fabs(excess[c]) > limit[c] + OF_GAP * fabs(usual->rate[c]) * slack;
  }
  return odd;
}

/* What is usual between two samples, with a speed that holds on one side of them. */
static bool fits_beside(const struct eo_usual *usual, const struct eo_sample *from, const struct eo_sample *to,
                        const struct eo_sample *a, const struct eo_sample *b, struct eo_usual *here)
{
  double time = b->time - a->time, passed = to->time - from->time;
  bool fits = time > 0;
  *here = *usual;
  for (int c = 0; c < 2 && time > 0; c++) {
    here->rate[c] = step_of(a, b, c) / time;
    here->limit[c] = fmax(usual->limit[c], OF_ROW * fabs(here->rate[c]) * usual->interval);
    fits = fits && fabs(step_of(from, to, c) - here->rate[c] * passed) <= here->limit[c];
  }
  return fits;
}

/* A step between the speed before and the speed after it, in both channels: the shafts start or stop there. */
static bool lies_between(const struct eo_usual *before, const struct eo_usual *after, const struct eo_sample *from,
                         const struct eo_sample *to)
{
  double time = to->time - from->time;
  bool between = true;
  for (int c = 0; c < 2; c++) {
    double step = step_of(from, to, c), low = fmin(before->rate[c], after->rate[c]) * time,
           high = fmax(before->rate[c], after->rate[c]) * time, slack = fmax(before->limit[c], after->limit[c]) / 4;
    between = between && step >= low - slack && step <= high + slack;
  }
  return between;
}

/* Where the speed changes within a block, a step that goes on as those before it or as those after it is none. *here:
   what is usual there. */
static bool odd_beside(const struct eo_angles_maker *maker, const struct eo_usual *usual,
                       const struct eo_sample *sample, int left, struct eo_usual *here, double excess[2])
{
  struct eo_usual after = {0};
  int ahead = left - 1 < EO_AHEAD - 1 ? left - 1 : EO_AHEAD - 1;
  const struct eo_sample *oldest = &maker->recent[maker->kept < EO_AHEAD ? 0 : maker->kept % EO_AHEAD];
  bool before = maker->kept > 1;
  *here = *usual;
  if (before && fits_beside(usual, &maker->last, sample, oldest, &maker->last, here))
    return false;
  if (ahead > 0 && fits_beside(usual, &maker->last, sample, sample, sample + ahead, &after))
    return false;
  if (before && ahead > 0 && usual->uneven && lies_between(here, &after, &maker->last, sample))
    return false;
  return odd_step(here, here->limit, &maker->last, sample, excess);
}

/* Rows are missing from both channels, and time was written on as if they were not. */
static void note_hidden_gap(struct eo_angles_maker *maker, struct eo_angles *angles, const struct eo_usual *usual,
                            double excess, const struct eo_sample *sample)
{
  maker->delay += excess / usual->rate[0];
  angles->dropped += llround(fabs(excess / (usual->rate[0] * usual->interval)));
  if (maker->hidden++ && maker->hidden <= EO_MOST_DISTANCES)
    maker->distance[maker->hidden - 2] = (double)(sample->row - maker->hidden_row);
  maker->hidden_row = sample->row;
  if (!maker->gaps++)
    maker->gap_row = sample->row;
}

/* One channel slipped. */
static void refuse_slip(struct eo_angles_maker *maker, struct eo_angles *angles, const struct eo_usual *usual,
                        const double excess[2], const struct eo_sample *sample)
{
  int channel = fabs(excess[0]) / usual->limit[0] > fabs(excess[1]) / usual->limit[1] ? 0 : 1;
  if (angles->slips++ < 4) {
    char size[32] = ""; /* in rows, unless the channel stood still before */
    double rows = excess[channel] / (usual->rate[channel] * usual->interval);
    if (isfinite(rows))
      snprintf(size, sizeof size, " (%.3g rows)", rows);
    eo_angles_at_row(
        maker,
        eo_findings_add(maker->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, channel, DEGREES * excess[channel],
                        "The %s channel jumps by %.5g degrees%s at row %lld (%.5g s) and the other does not: "
                        "rows or counts were lost in one channel; times without it can be chosen.",
                        eo_channel_name(channel), DEGREES * excess[channel], size, (long long)sample->row + 1,
                        sample->time - angles->origin),
        sample->row);
  }
}

/* left: samples from this one on. */
static void judge_jump(struct eo_angles_maker *maker, struct eo_angles *angles, const struct eo_usual *usual,
                       double excess[2], struct eo_sample *sample, int left, int written)
{
  bool settled = eo_gaps_settle(maker, usual, sample, left, excess);
  if (!settled && eo_gaps_pauses(maker, usual, sample, excess))
    eo_gaps_begin_run(maker, angles, sample, written, "time leaps there, and both angles go on from other values");
  else if (!settled)
    refuse_slip(maker, angles, usual, excess, sample);
  else if (eo_gaps_stops(maker, usual, sample, left, excess))
    eo_gaps_begin_run(maker, angles, sample, written, "time leaps there, and the angles go on from where they were");
  else
    note_hidden_gap(maker, angles, usual, excess[0], sample);
}

static enum eo_code keep(struct eo_angles_maker *maker, struct eo_angles *angles, struct eo_sample *sample,
                         double (*out)[3], int *count, struct eo_error *error)
{
  double *row = out[*count];
  if (!maker->begun || sample->angle[0] < maker->low.angle[0])
    maker->low = *sample;
  if (!maker->begun || sample->angle[0] > maker->high.angle[0])
    maker->high = *sample;
  maker->begun = true;
  maker->last = maker->recent[maker->kept++ % EO_AHEAD] = *sample;
  row[0] = sample->time + maker->delay;
  row[1] = sample->angle[0];
  row[2] = sample->angle[1];
  if (++*count < EO_SAMPLER_BLOCK)
    return EO_OK;
  *count = 0;
  return eo_recording_append(angles->series, out[0], EO_SAMPLER_BLOCK, error);
}

static bool note_block(struct eo_angles_maker *maker, const struct eo_usual *usual)
{
  if (usual->rate[0] == 0 || usual->rate[1] == 0)
    return true;
  if (maker->blocks == maker->block_room) {
    int room = maker->block_room ? 2 * maker->block_room : 64;
    double *bigger = realloc(maker->rate[0], sizeof *bigger * (size_t)room * 3);
    if (!bigger)
      return false;
    memmove(bigger + 2 * room, bigger + 2 * maker->block_room, sizeof *bigger * (size_t)maker->blocks);
    memmove(bigger + room, bigger + maker->block_room, sizeof *bigger * (size_t)maker->blocks);
    maker->rate[0] = bigger;
    maker->rate[1] = bigger + room;
    maker->proportion = bigger + 2 * room;
    maker->block_room = room;
  }
  maker->rate[0][maker->blocks] = usual->rate[0];
  maker->rate[1][maker->blocks] = usual->rate[1];
  maker->proportion[maker->blocks++] = usual->rate[1] / usual->rate[0];
  return true;
}

/* A value far off that is followed by good ones; how many samples to leave out, 0 when it is no such thing. */
static int spike_length(const struct eo_usual *usual, const double limit[2], const struct eo_sample *last,
                        const struct eo_sample *sample, int left)
{
  double excess[2];
  for (int i = 1; i < EO_AHEAD && i < left; i++)
    if (!odd_step(usual, limit, last, &sample[i], excess))
      return i;
  return 0;
}

/* One channel moves on by less than a row and stays there. Where that happens often it is how the encoder counts. */
static void note_lost_counts(struct eo_angles_maker *maker, const struct eo_usual *usual, const double excess[2],
                             const struct eo_sample *sample, int left)
{
  double ratio = usual->rate[1] / usual->rate[0];
  bool both = fabs(excess[1] - ratio * excess[0]) < fmax(usual->fine[1], fabs(ratio) * usual->fine[0]);
  if (both || spike_length(usual, usual->fine, &maker->last, sample, left))
    return;
  int channel = fabs(excess[0]) / usual->fine[0] > fabs(excess[1]) / usual->fine[1] ? 0 : 1;
  if (maker->losses < EO_MOST_LOSSES)
    maker->loss[maker->losses] = (struct loss){channel, sample->row, excess[channel]};
  maker->losses++;
}

static void leave_out(struct eo_angles_maker *maker, int64_t row, int count)
{
  if (!maker->spikes)
    maker->spike_row = row;
  maker->spikes += count;
}

/* How many samples from here on are far off; few at the end of all are, whatever might have followed. */
static int count_spikes(const struct eo_angles_maker *maker, const struct eo_usual *usual,
                        const struct eo_sample *sample, int left, bool final)
{
  int length = spike_length(usual, usual->limit, &maker->last, sample, left);
  return !length && final && left < EO_AHEAD ? left : length;
}

/* The sample that was kept first of all is what is far off, when those behind it go on alike; it has not left `out`. */
static bool begins_wrong(struct eo_angles_maker *maker, int *written)
{
  if (maker->kept > 1 || maker->spikes >= EO_AHEAD)
    return false;
  leave_out(maker, maker->last.row, 1);
  maker->kept = 0;
  maker->begun = false;
  *written = 0;
  return true;
}

enum eo_code eo_jumps_pass_on(struct eo_angles_maker *maker, struct eo_angles *angles, bool final, double (*out)[3],
                              int *written, struct eo_error *error)
{
  const struct eo_usual *usual = &maker->usual;
  double excess[2];
  int until = final ? maker->held : maker->held - EO_AHEAD, i = 0;
  enum eo_code code = EO_OK;
  if (maker->held >= 512 || (!maker->known && maker->held >= 32)) {
    learn(maker, maker->sample, maker->held, &maker->usual);
    maker->known = true;
    if (!note_block(maker, usual))
      return eo_error_memory(error);
  }
  for (; i < until && !code; i++) {
    struct eo_sample *sample = &maker->sample[i];
    struct eo_usual here = *usual;
    bool judge = maker->known && maker->begun;
    if (eo_gaps_starts_anew(maker, sample->row))
      eo_gaps_begin_run(maker, angles, sample, *written, "angles or clock start anew there");
    else if (judge && (usual->uneven || odd_step(usual, usual->limit, &maker->last, sample, excess)) &&
             odd_beside(maker, usual, sample, maker->held - i, &here, excess)) {
      int skip = count_spikes(maker, &here, sample, maker->held - i, final);
      if (skip) {
        leave_out(maker, sample->row, skip);
        i += skip - 1;
        continue;
      }
      if (!begins_wrong(maker, written))
        judge_jump(maker, angles, &here, excess, sample, maker->held - i, *written);
    } else if (judge && !usual->uneven && sample->row == maker->last.row + 1 &&
               odd_step(usual, usual->fine, &maker->last, sample, excess)) {
      note_lost_counts(maker, usual, excess, sample, maker->held - i);
    } else if (judge && !maker->sampler.pulses && sample->time - maker->last.time > usual->gap &&
               sample->row - maker->last.row == 1) { /* of pulses their lines say it */
      angles->dropped += llround((sample->time - maker->last.time) / usual->interval) - 1;
      if (!maker->gaps++)
        maker->gap_row = sample->row;
    }
    code = keep(maker, angles, sample, out, written, error);
  }
  i = i < maker->held ? i : maker->held;
  memmove(maker->sample, maker->sample + i, sizeof *maker->sample * (size_t)(maker->held - i));
  maker->held -= i;
  return code;
}

/* Rows that are missing from both channels, or there twice, at even distances: a program took the recorded row that is
   the nearest to each of its own, and then the times are right; or they were lost, and then they are not. */
static bool is_even(struct eo_angles_maker *maker, double *distance)
{
  int count = (int)(maker->hidden <= EO_MOST_DISTANCES ? maker->hidden : EO_MOST_DISTANCES) - 1, even = 0;
  if (count < LEAST_DISTANCES)
    return false;
  *distance = eo_scan_quantile(maker->distance, count, MIDDLE);
  for (int i = 0; i < count; i++)
    even += fabs(maker->distance[i] - *distance) <= 1;
  return even > MOSTLY * count;
}

static void judge_gaps(struct eo_angles_maker *maker, const struct eo_angles *angles)
{
  double distance;
  if (is_even(maker, &distance))
    eo_angles_at_row(maker,
                     eo_findings_add(maker->findings, EO_FINDING_SAMPLE_RATE, EO_SEVERITY_REFUSED, -1, distance,
                                     "Every %.3g rows one is missing from both channels or there twice: a program took "
                                     "the recorded value that is the nearest to each of its times, or rows are lost; "
                                     "which of both decides on the speed. Export each channel as it was recorded.",
                                     distance),
                     maker->gap_row);
  else if (maker->gaps)
    eo_angles_at_row(
        maker,
        eo_findings_add(maker->findings, EO_FINDING_DROPPED, EO_SEVERITY_REPAIRED, -1, (double)angles->dropped,
                        "About %lld rows are missing from both channels in %lld places, the first before row %lld; "
                        "the angles say for how long, and time was "
                        "set by them.",
                        (long long)angles->dropped, (long long)maker->gaps, (long long)maker->gap_row + 1),
        maker->gap_row);
}

void eo_jumps_judge(struct eo_angles_maker *maker, const struct eo_angles *angles)
{
  for (int i = 0; i < maker->losses && maker->losses <= EO_MOST_LOSSES; i++)
    eo_angles_at_row(
        maker,
        eo_findings_add(maker->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, maker->loss[i].channel,
                        DEGREES * maker->loss[i].jump,
                        "The %s channel jumps by %.5g degrees at row %lld and stays there while the other does not: "
                        "counts were lost in one channel.",
                        eo_channel_name(maker->loss[i].channel), DEGREES * maker->loss[i].jump,
                        (long long)maker->loss[i].row + 1),
        maker->loss[i].row);
  judge_gaps(maker, angles);
  eo_gaps_judge(maker, angles);
  if (maker->spikes)
    eo_angles_at_row(maker,
                     eo_findings_add(maker->findings, EO_FINDING_SPIKE, EO_SEVERITY_REPAIRED, -1, (double)maker->spikes,
                                     "%lld single rows are far off, the first is row %lld; they were left out.",
                                     (long long)maker->spikes, (long long)maker->spike_row + 1),
                     maker->spike_row);
  if (angles->slips > 4)
    eo_findings_add(maker->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, -1, angles->slips,
                    "There are %d such jumps altogether.", angles->slips);
}
