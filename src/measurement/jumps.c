/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/angles_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double DEGREES = 180 / M_PI;
static const double UNEVEN =
    0.2; /* range of the speed in a block, relative: above, steps are judged by their neighbours */

static double step_of(const struct eo_sample *from, const struct eo_sample *to, int channel)
{
  return to->angle[channel] - from->angle[channel];
}

static void learn(struct eo_angles_maker *m, const struct eo_sample *s, int count, struct eo_usual *u)
{
  int lag = count / 8 > 0 ? count / 8 : 1, n = 0;
  bool uneven = false;
  for (int i = 1; i < count; i++)
    m->scratch[n++] = s[i].time - s[i - 1].time;
  u->interval = eo_scan_quantile(m->scratch, n, 0.5);
  for (int c = 0; c < 2; c++) {
    n = 0;
    for (int i = lag; i < count; i++)
      m->scratch[n++] = step_of(&s[i - lag], &s[i], c) / (s[i].time - s[i - lag].time);
    u->rate[c] = eo_scan_quantile(m->scratch, n, 0.5);
    double slow = m->scratch[(int)(0.05 * (n - 1))], fast = m->scratch[(int)(0.95 * (n - 1))];
    uneven = uneven || fast - slow > UNEVEN * fmax(fabs(slow), fabs(fast));
    n = 0;
    for (int i = 1; i < count; i++)
      m->scratch[n++] = fabs(step_of(&s[i - 1], &s[i], c) - u->rate[c] * (s[i].time - s[i - 1].time));
    double spread = eo_scan_quantile(m->scratch, n, 0.9), most = m->scratch[(int)(0.995 * (n - 1))];
    double row = fabs(u->rate[c]) * u->interval;
    u->limit[c] = fmax(fmax(4 * spread, 0.4 * row), 1.6 * m->quantum[c]);
    u->fine[c] = fmax(fmax(8 * spread, 3 * most), 1.6 * m->quantum[c]);
  }
  u->uneven = uneven;
}

/* How far the step between two samples is from the usual one. */
static bool odd_step(const struct eo_usual *u, const double limit[2], const struct eo_sample *from,
                     const struct eo_sample *to, double excess[2])
{
  bool odd = false;
  double time = to->time - from->time,
         slack = fmax(0, time - (0.5 + (double)(to->row - from->row)) * u->interval); /* of a gap in time */
  for (int c = 0; c < 2; c++) {
    excess[c] = step_of(from, to, c) - u->rate[c] * time;
    odd = odd || fabs(excess[c]) > limit[c] + 0.02 * fabs(u->rate[c]) * slack;
  }
  return odd;
}

/* What is usual between two samples, with a speed that holds on one side of them. */
static bool fits_beside(const struct eo_usual *u, const struct eo_sample *from, const struct eo_sample *to,
                        const struct eo_sample *a, const struct eo_sample *b, struct eo_usual *here)
{
  double time = b->time - a->time, passed = to->time - from->time;
  bool fits = time > 0;
  *here = *u;
  for (int c = 0; c < 2 && time > 0; c++) {
    here->rate[c] = step_of(a, b, c) / time;
    here->limit[c] = fmax(u->limit[c], 0.4 * fabs(here->rate[c]) * u->interval);
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
static bool odd_beside(const struct eo_angles_maker *m, const struct eo_usual *u, const struct eo_sample *s, int left,
                       struct eo_usual *here, double excess[2])
{
  struct eo_usual after = {0};
  int ahead = left - 1 < EO_AHEAD - 1 ? left - 1 : EO_AHEAD - 1;
  const struct eo_sample *oldest = &m->recent[m->kept < EO_AHEAD ? 0 : m->kept % EO_AHEAD];
  bool before = m->kept > 1;
  *here = *u;
  if (before && fits_beside(u, &m->last, s, oldest, &m->last, here))
    return false;
  if (ahead > 0 && fits_beside(u, &m->last, s, s, s + ahead, &after))
    return false;
  if (before && ahead > 0 && u->uneven && lies_between(here, &after, &m->last, s))
    return false;
  return odd_step(here, here->limit, &m->last, s, excess);
}

/* Both channels went on by the same time: rows are missing, and time was written on as if they were not. Else one
   slipped. */
static void judge_jump(struct eo_angles_maker *m, struct eo_angles *a, const struct eo_usual *u, const double excess[2],
                       struct eo_sample *s)
{
  double ratio = u->rate[1] / u->rate[0], rows = excess[0] / (u->rate[0] * u->interval);
  bool both = fabs(excess[1] - ratio * excess[0]) < fmax(u->limit[1], fabs(ratio) * u->limit[0]);
  if (both) {
    m->delay += excess[0] / u->rate[0];
    a->dropped += llround(fabs(rows));
    if (!m->gaps++)
      m->gap_row = s->row;
    return;
  }
  int channel = fabs(excess[0]) / u->limit[0] > fabs(excess[1]) / u->limit[1] ? 0 : 1;
  if (a->slips++ < 4) {
    rows = excess[channel] / (u->rate[channel] * u->interval);
    eo_angles_at_row(
        m,
        eo_findings_add(m->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, channel, DEGREES * excess[channel],
                        "The %s channel jumps by %.5g degrees (%.3g rows) at row %lld and the other does not: rows "
                        "or counts were lost in one channel.",
                        eo_channel_name(channel), DEGREES * excess[channel], rows, (long long)s->row + 1),
        s->row);
  }
}

static enum eo_code keep(struct eo_angles_maker *m, struct eo_angles *a, struct eo_sample *s, double (*out)[3],
                         int *count, struct eo_error *error)
{
  double *row = out[*count];
  if (!m->begun || s->angle[0] < m->low.angle[0])
    m->low = *s;
  if (!m->begun || s->angle[0] > m->high.angle[0])
    m->high = *s;
  m->begun = true;
  m->last = m->recent[m->kept++ % EO_AHEAD] = *s;
  row[0] = s->time + m->delay;
  row[1] = s->angle[0];
  row[2] = s->angle[1];
  if (++*count < EO_SAMPLER_BLOCK)
    return EO_OK;
  *count = 0;
  return eo_recording_append(a->series, out[0], EO_SAMPLER_BLOCK, error);
}

static bool note_block(struct eo_angles_maker *m, const struct eo_usual *u)
{
  if (u->rate[0] == 0 || u->rate[1] == 0)
    return true;
  if (m->blocks == m->block_room) {
    int room = m->block_room ? 2 * m->block_room : 64;
    double *bigger = realloc(m->rate[0], sizeof *bigger * (size_t)room * 3);
    if (!bigger)
      return false;
    memmove(bigger + 2 * room, bigger + 2 * m->block_room, sizeof *bigger * (size_t)m->blocks);
    memmove(bigger + room, bigger + m->block_room, sizeof *bigger * (size_t)m->blocks);
    m->rate[0] = bigger;
    m->rate[1] = bigger + room;
    m->proportion = bigger + 2 * room;
    m->block_room = room;
  }
  m->rate[0][m->blocks] = u->rate[0];
  m->rate[1][m->blocks] = u->rate[1];
  m->proportion[m->blocks++] = u->rate[1] / u->rate[0];
  return true;
}

/* A value far off that is followed by good ones; how many samples to leave out, 0 when it is no such thing. */
static int spike_length(const struct eo_usual *u, const double limit[2], const struct eo_sample *last,
                        const struct eo_sample *s, int left)
{
  double excess[2];
  for (int i = 1; i < EO_AHEAD && i < left; i++)
    if (!odd_step(u, limit, last, &s[i], excess))
      return i;
  return 0;
}

/* One channel moves on by less than a row and stays there. Where that happens often it is how the encoder counts. */
static void note_lost_counts(struct eo_angles_maker *m, const struct eo_usual *u, const double excess[2],
                             const struct eo_sample *s, int left)
{
  double ratio = u->rate[1] / u->rate[0];
  bool both = fabs(excess[1] - ratio * excess[0]) < fmax(u->fine[1], fabs(ratio) * u->fine[0]);
  if (both || spike_length(u, u->fine, &m->last, s, left))
    return;
  int channel = fabs(excess[0]) / u->fine[0] > fabs(excess[1]) / u->fine[1] ? 0 : 1;
  if (m->losses < EO_MOST_LOSSES)
    m->loss[m->losses] = (struct loss){channel, s->row, excess[channel]};
  m->losses++;
}

enum eo_code eo_jumps_pass_on(struct eo_angles_maker *m, struct eo_angles *a, bool final, double (*out)[3],
                              int *written, struct eo_error *error)
{
  const struct eo_usual *u = &m->usual;
  double excess[2];
  int until = final ? m->held : m->held - EO_AHEAD, i = 0;
  enum eo_code code = EO_OK;
  if (m->held >= 512 || (!m->known && m->held >= 32)) {
    learn(m, m->sample, m->held, &m->usual);
    m->known = true;
    if (!note_block(m, u))
      return eo_error_memory(error);
  }
  for (; i < until && !code; i++) {
    struct eo_sample *s = &m->sample[i];
    struct eo_usual here = *u;
    bool judge = m->known && m->begun;
    if (judge && (u->uneven || odd_step(u, u->limit, &m->last, s, excess)) &&
        odd_beside(m, u, s, m->held - i, &here, excess)) {
      int skip = spike_length(&here, here.limit, &m->last, s, m->held - i);
      if (skip) {
        if (!m->spikes)
          m->spike_row = s->row;
        m->spikes += skip;
        i += skip - 1;
        continue;
      }
      judge_jump(m, a, &here, excess, s);
    } else if (judge && !u->uneven && odd_step(u, u->fine, &m->last, s, excess)) {
      note_lost_counts(m, u, excess, s, m->held - i);
    } else if (judge && s->time - m->last.time > 1.5 * u->interval && s->row - m->last.row == 1) {
      a->dropped += llround((s->time - m->last.time) / u->interval) - 1;
      if (!m->gaps++)
        m->gap_row = s->row;
    }
    code = keep(m, a, s, out, written, error);
  }
  i = i < m->held ? i : m->held;
  memmove(m->sample, m->sample + i, sizeof *m->sample * (size_t)(m->held - i));
  m->held -= i;
  return code;
}

void eo_jumps_judge(struct eo_angles_maker *m, const struct eo_angles *a)
{
  for (int i = 0; i < m->losses && m->losses <= EO_MOST_LOSSES; i++)
    eo_angles_at_row(
        m,
        eo_findings_add(m->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, m->loss[i].channel,
                        DEGREES * m->loss[i].jump,
                        "The %s channel jumps by %.5g degrees at row %lld and stays there while the other does not: "
                        "counts were lost in one channel.",
                        eo_channel_name(m->loss[i].channel), DEGREES * m->loss[i].jump, (long long)m->loss[i].row + 1),
        m->loss[i].row);
  if (m->gaps)
    eo_angles_at_row(
        m,
        eo_findings_add(m->findings, EO_FINDING_DROPPED, EO_SEVERITY_REPAIRED, -1, (double)a->dropped,
                        "About %lld rows are missing from both channels in %lld places, the first before row %lld; "
                        "the angles say for how long, and time was "
                        "set by them.",
                        (long long)a->dropped, (long long)m->gaps, (long long)m->gap_row + 1),
        m->gap_row);
  if (m->spikes)
    eo_angles_at_row(m,
                     eo_findings_add(m->findings, EO_FINDING_SPIKE, EO_SEVERITY_REPAIRED, -1, (double)m->spikes,
                                     "%lld single rows are far off, the first is row %lld; they were left out.",
                                     (long long)m->spikes, (long long)m->spike_row + 1),
                     m->spike_row);
  if (a->slips > 4)
    eo_findings_add(m->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, -1, a->slips,
                    "There are %d such jumps altogether.", a->slips);
}
