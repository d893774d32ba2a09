#include "measurement/angles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measurement/sampler.h"

static const double DEGREES = 180 / M_PI;
static const double UNEVEN =
    0.2; /* range of the speed in a block, relative: above, steps are judged by their neighbours */
static const double MOVING = 0.1; /* of the fastest block: slower ones do not tell the usual speed */
enum { MOST_LOSSES = 3, AHEAD = 4, ROOM = EO_SAMPLER_BLOCK + AHEAD };

static const char *const member_name[2] = {"pinion", "gear"};

/* Usual speeds of the samples that are held, and the size of step that is out of the ordinary. */
struct usual {
  double rate[2], interval;
  double limit[2], fine[2]; /* of what a row lost, of what a few counts lost stand out of */
  bool uneven;              /* the speed changes much among the samples */
};

struct maker {
  const struct eo_recording *recording;
  const struct eo_tracks *tracks;
  struct eo_findings *findings;
  const struct eo_progress *progress;
  struct eo_scan *scan; /* owned */
  struct eo_sampler sampler;
  struct eo_sample sample[ROOM];
  int held;                       /* samples not yet passed on */
  struct eo_sample last;          /* good one before them */
  struct eo_sample recent[AHEAD]; /* the ones before that, the oldest at kept % AHEAD */
  int64_t kept;
  struct eo_sample low, high; /* of all good ones: those with the extreme pinion angles */
  bool begun;
  struct usual usual; /* of the last block that is long enough to tell */
  bool known;
  double delay;                 /* s taken out of or put into time so far */
  double quantum[2];            /* rad */
  double *rate[2], *proportion; /* [blocks] owned: of each block */
  int blocks, block_room;
  double scratch[ROOM];
  int losses;
  struct loss {
    int channel;
    int64_t row;
    double jump;
  } loss[MOST_LOSSES];
  int64_t gaps, gap_row, spikes, spike_row;
  bool wrapped[2];
};

static int64_t line_of(const struct maker *m, int64_t row)
{
  return row < 0 ? 0 : eo_recording_line(m->recording, row);
}

static struct eo_finding *at_row(const struct maker *m, struct eo_finding *finding, int64_t row)
{
  finding->row = row;
  finding->line = line_of(m, row);
  return finding;
}

/* ---- before anything is converted ---- */

static void judge_time(struct maker *m)
{
  const struct eo_scan *s = m->scan;
  int64_t wrong = s->backward + s->standing - s->duplicate;
  m->sampler.interval = s->interval;
  m->sampler.count_rows = m->tracks->time_column < 0;
  if (s->backward + s->standing == 0)
    return;
  if (wrong == 0) {
    at_row(m,
           eo_findings_add(m->findings, EO_FINDING_TIME, EO_SEVERITY_REPAIRED, -1, (double)s->duplicate,
                           "%lld rows repeat the row before them, the first is row %lld; they were left out.",
                           (long long)s->duplicate, (long long)s->time_row + 1),
           s->time_row);
  } else if ((double)s->steady >= 0.9 * (double)wrong) {
    if (!s->backward && s->used > 1)
      m->sampler.interval = (s->time_last - s->time_first) / (double)(s->used - 1);
    m->sampler.count_rows = true;
    at_row(m,
           eo_findings_add(m->findings, EO_FINDING_TIME, EO_SEVERITY_REPAIRED, -1, (double)wrong,
                           "Time stands still or runs backwards in %lld rows (first in row %lld) while the angles go "
                           "on evenly; it was counted from the rows, "
                           "%.6g ms each.",
                           (long long)wrong, (long long)s->time_row + 1, 1e3 * m->sampler.interval),
           s->time_row);
  } else {
    at_row(m,
           eo_findings_add(m->findings, EO_FINDING_TIME, EO_SEVERITY_REFUSED, -1, (double)wrong,
                           "Time does not rise in %lld rows, the first is row %lld, and the angles are no help there.",
                           (long long)wrong, (long long)s->time_row + 1),
           s->time_row);
  }
}

static void judge_gaps(struct maker *m)
{
  const struct eo_scan *s = m->scan;
  if (!s->unusable)
    return;
  bool most = s->unusable > s->rows / 2;
  at_row(m,
         eo_findings_add(
             m->findings, EO_FINDING_NAN, most ? EO_SEVERITY_REFUSED : EO_SEVERITY_REPAIRED, -1, (double)s->unusable,
             "%lld of %lld rows hold a value that is no number, the first is row %lld; %s.", (long long)s->unusable,
             (long long)s->rows, (long long)s->unusable_row + 1, most ? "too many to go on" : "they were left out"),
         s->unusable_row);
}

/* A channel that stands still altogether or for a part of a turn while the other moves on. */
static void judge_still(struct maker *m, int channel)
{
  for (int k = 0; k < eo_track_columns(&m->tracks->channel[channel]); k++) {
    const struct eo_scan_column *c = &m->scan->column[channel][k];
    bool constant = !(c->high > c->low), raw = m->tracks->channel[channel].track == EO_TRACK_SINE_COSINE;
    double advance = (double)c->longest * c->typical * (raw ? 0 : m->sampler.scale[channel]);
    if (constant)
      eo_findings_add(m->findings, EO_FINDING_CONSTANT, EO_SEVERITY_REFUSED, channel, c->low,
                      "The %s channel is constant: every row holds %.9g.", member_name[channel], c->low);
    else if (advance > 0.5 && (double)c->longest * c->typical > 20 * c->quantum && c->longest > 20)
      at_row(m,
             eo_findings_add(m->findings, EO_FINDING_CONSTANT, EO_SEVERITY_REFUSED, channel, (double)c->longest,
                             "The %s channel stands still for %lld rows from row %lld.", member_name[channel],
                             (long long)c->longest, (long long)c->longest_row + 1),
             c->longest_row);
    double clipped = raw && !constant ? eo_scan_clipped(c, m->scan->used) : 0;
    if (clipped > 0)
      eo_findings_add(m->findings, EO_FINDING_SATURATED, clipped > 0.2 ? EO_SEVERITY_REFUSED : EO_SEVERITY_WARNING,
                      channel, clipped, "The %s of the %s is cut off: %.1f %% of its values are exactly %.6g or %.6g.",
                      k ? "cosine" : "sine", member_name[channel], 100 * clipped, c->low, c->high);
  }
}

/* Where an angle starts again and what that says about its unit. */
static void judge_turns(struct maker *m, int channel)
{
  const struct eo_scan_column *c = &m->scan->column[channel][0];
  double scale = m->tracks->channel[channel].scale, period = eo_scan_period(c, 2 * M_PI / scale), turn = period * scale;
  m->sampler.scale[channel] = scale;
  if (fabs(scale - 1) < 1e-9)
    eo_findings_add(m->findings, EO_FINDING_UNITS, EO_SEVERITY_NOTE, channel, scale, "The %s angle is read as radians.",
                    member_name[channel]);
  if (isnan(period))
    return;
  double degrees = turn / (2 * M_PI) * (1 / DEGREES), radians = turn / (2 * M_PI) * DEGREES;
  const char *unit = fabs(degrees - 1) < 0.05 ? "degrees" : fabs(radians - 1) < 0.05 ? "radians" : NULL;
  if (unit) {
    m->sampler.scale[channel] *= fabs(degrees - 1) < 0.05 ? 1 / DEGREES : DEGREES;
    eo_findings_add(m->findings, EO_FINDING_UNITS, EO_SEVERITY_REPAIRED, channel, period,
                    "The %s angle starts again after %.6g: it is in %s, not in the stated unit; read so.",
                    member_name[channel], period, unit);
    turn = 2 * M_PI;
  } else if (fabs(turn / (2 * M_PI) - 1) < 0.05) {
    turn = 2 * M_PI;
  }
  int64_t index = eo_scan_index_row(c, turn / m->sampler.scale[channel]);
  if (index) {
    m->sampler.begin = index > m->sampler.begin ? index : m->sampler.begin;
    at_row(m,
           eo_findings_add(m->findings, EO_FINDING_WRAPPED, EO_SEVERITY_NOTE, channel, (double)index,
                           "The %s counter starts anew at its index pulse before row %lld; what stands before that is "
                           "part of a turn without a zero and is left out.",
                           member_name[channel], (long long)index + 1),
           index);
  }
  m->sampler.period[channel] = turn;
  m->wrapped[channel] = true;
  eo_findings_add(m->findings, EO_FINDING_WRAPPED, EO_SEVERITY_NOTE, channel, (double)c->jumps,
                  "The %s angle starts again every %.6g, %d times; its turns were counted.", member_name[channel],
                  turn / m->sampler.scale[channel], c->jumps);
}

/* ---- raw tracks ---- */

static enum eo_code fit_ellipses(struct maker *m, struct eo_angles *a, struct eo_error *error)
{
  struct eo_ellipse_sums sums[2];
  int columns = eo_recording_columns(m->recording);
  int64_t rows = m->scan->rows;
  double *block = malloc(sizeof *block * EO_SAMPLER_BLOCK * (size_t)columns);
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  for (int channel = 0; channel < 2; channel++) {
    const struct eo_scan_column *c = m->scan->column[channel];
    eo_ellipse_start(&sums[channel], (double[]){(c[0].low + c[0].high) / 2, (c[1].low + c[1].high) / 2},
                     fmax(c[0].high - c[0].low, 1e-300) / 2);
  }
  for (int64_t first = 0; first < rows && !code; first += EO_SAMPLER_BLOCK) {
    int count = rows - first < EO_SAMPLER_BLOCK ? (int)(rows - first) : EO_SAMPLER_BLOCK;
    code = eo_recording_read(m->recording, first, count, block, error);
    for (int i = 0; i < count && !code; i++)
      for (int channel = 0; channel < 2; channel++) {
        const struct eo_track_channel *c = &m->tracks->channel[channel];
        double sine = block[(size_t)i * (size_t)columns + (size_t)c->column[0]],
               cosine = block[(size_t)i * (size_t)columns + (size_t)c->column[1]];
        if (c->track == EO_TRACK_SINE_COSINE && isfinite(sine) && isfinite(cosine))
          eo_ellipse_add(&sums[channel], sine, cosine);
      }
  }
  for (int channel = 0; channel < 2 && !code; channel++)
    if (m->tracks->channel[channel].track == EO_TRACK_SINE_COSINE &&
        !eo_ellipse_fit(&sums[channel], &a->ellipse[channel]))
      eo_findings_add(m->findings, EO_FINDING_TRACK, EO_SEVERITY_REFUSED, channel, NAN,
                      "The sine and cosine of the %s draw no ellipse.", member_name[channel]);
  free(block);
  return code;
}

/* Usual limits of 1 Vpp and 11 uA encoders: 0.6..1.2 Vpp, 7..16 uApp, ratio 0.8..1.25, phase 90 +- 10 degrees. */
static void judge_ellipse(struct maker *m, const struct eo_ellipse *e, int channel)
{
  const struct eo_track_channel *c = &m->tracks->channel[channel];
  double ratio = e->amplitude[0] / e->amplitude[1], phase = DEGREES * e->skew;
  eo_findings_add(m->findings, EO_FINDING_TRACK, EO_SEVERITY_NOTE, channel, ratio,
                  "Offsets (%.2g, %.2g), ratio %.4g and phase %.2f degrees of the %s tracks were corrected.",
                  e->offset[0], e->offset[1], ratio, 90 + phase, member_name[channel]);
  for (int k = 0; k < 2 && c->unit != EO_TRACK_UNKNOWN; k++) {
    bool volt = c->unit == EO_TRACK_VOLT;
    double size = 2 * e->amplitude[k] * c->factor, low = volt ? 0.6 : 7, high = volt ? 1.2 : 16;
    if (size < low || size > high)
      eo_findings_add(m->findings, EO_FINDING_TRACK, EO_SEVERITY_WARNING, channel, size,
                      "The %s of the %s has an amplitude of %.3g %s, outside the usual %.3g..%.3g.",
                      k ? "cosine" : "sine", member_name[channel], size, volt ? "Vpp" : "uApp", low, high);
  }
  if (ratio < 0.8 || ratio > 1.25)
    eo_findings_add(m->findings, EO_FINDING_TRACK, EO_SEVERITY_WARNING, channel, ratio,
                    "The sine of the %s is %.3g times its cosine, outside the usual 0.8..1.25; corrected.",
                    member_name[channel], ratio);
  if (fabs(phase) > 10)
    eo_findings_add(m->findings, EO_FINDING_TRACK, EO_SEVERITY_WARNING, channel, 90 + phase,
                    "The tracks of the %s are %.1f degrees apart, outside the usual 80..100; corrected.",
                    member_name[channel], 90 + phase);
}

static enum eo_code prepare_tracks(struct maker *m, struct eo_angles *a, struct eo_error *error)
{
  bool any = false;
  for (int channel = 0; channel < 2; channel++) {
    a->raw[channel] = m->tracks->channel[channel].track == EO_TRACK_SINE_COSINE;
    any = any || a->raw[channel];
    if (a->raw[channel])
      m->sampler.period[channel] = 2 * M_PI / m->tracks->channel[channel].lines;
    else
      judge_turns(m, channel);
    judge_still(m, channel);
  }
  if (!any || eo_findings_worst(m->findings) == EO_SEVERITY_REFUSED)
    return EO_OK;
  enum eo_code code = fit_ellipses(m, a, error);
  for (int channel = 0; channel < 2 && !code; channel++)
    if (a->raw[channel] && eo_findings_worst(m->findings) != EO_SEVERITY_REFUSED)
      judge_ellipse(m, &a->ellipse[channel], channel);
  m->sampler.ellipse = a->ellipse;
  return code;
}

/* ---- jumps ---- */

static double step_of(const struct eo_sample *from, const struct eo_sample *to, int channel)
{
  return to->angle[channel] - from->angle[channel];
}

static void learn(struct maker *m, const struct eo_sample *s, int count, struct usual *u)
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
static bool odd_step(const struct usual *u, const double limit[2], const struct eo_sample *from,
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
static bool fits_beside(const struct usual *u, const struct eo_sample *from, const struct eo_sample *to,
                        const struct eo_sample *a, const struct eo_sample *b, struct usual *here)
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
static bool lies_between(const struct usual *before, const struct usual *after, const struct eo_sample *from,
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
static bool odd_beside(const struct maker *m, const struct usual *u, const struct eo_sample *s, int left,
                       struct usual *here, double excess[2])
{
  struct usual after;
  int ahead = left - 1 < AHEAD - 1 ? left - 1 : AHEAD - 1;
  const struct eo_sample *oldest = &m->recent[m->kept < AHEAD ? 0 : m->kept % AHEAD];
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
static void judge_jump(struct maker *m, struct eo_angles *a, const struct usual *u, const double excess[2],
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
    at_row(m,
           eo_findings_add(m->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, channel, DEGREES * excess[channel],
                           "The %s channel jumps by %.5g degrees (%.3g rows) at row %lld and the other does not: rows "
                           "or counts were lost in one channel.",
                           member_name[channel], DEGREES * excess[channel], rows, (long long)s->row + 1),
           s->row);
  }
}

static enum eo_code keep(struct maker *m, struct eo_angles *a, struct eo_sample *s, double (*out)[3], int *count,
                         struct eo_error *error)
{
  double *row = out[*count];
  if (!m->begun || s->angle[0] < m->low.angle[0])
    m->low = *s;
  if (!m->begun || s->angle[0] > m->high.angle[0])
    m->high = *s;
  m->begun = true;
  m->last = m->recent[m->kept++ % AHEAD] = *s;
  row[0] = s->time + m->delay;
  row[1] = s->angle[0];
  row[2] = s->angle[1];
  if (++*count < EO_SAMPLER_BLOCK)
    return EO_OK;
  *count = 0;
  return eo_recording_append(a->series, out[0], EO_SAMPLER_BLOCK, error);
}

static bool note_block(struct maker *m, const struct usual *u)
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
static int spike_length(const struct usual *u, const double limit[2], const struct eo_sample *last,
                        const struct eo_sample *s, int left)
{
  double excess[2];
  for (int i = 1; i < AHEAD && i < left; i++)
    if (!odd_step(u, limit, last, &s[i], excess))
      return i;
  return 0;
}

/* One channel moves on by less than a row and stays there. Where that happens often it is how the encoder counts. */
static void note_lost_counts(struct maker *m, const struct usual *u, const double excess[2], const struct eo_sample *s,
                             int left)
{
  double ratio = u->rate[1] / u->rate[0];
  bool both = fabs(excess[1] - ratio * excess[0]) < fmax(u->fine[1], fabs(ratio) * u->fine[0]);
  if (both || spike_length(u, u->fine, &m->last, s, left))
    return;
  int channel = fabs(excess[0]) / u->fine[0] > fabs(excess[1]) / u->fine[1] ? 0 : 1;
  if (m->losses < MOST_LOSSES)
    m->loss[m->losses] = (struct loss){channel, s->row, excess[channel]};
  m->losses++;
}

static enum eo_code pass_on(struct maker *m, struct eo_angles *a, bool final, double (*out)[3], int *written,
                            struct eo_error *error)
{
  const struct usual *u = &m->usual;
  double excess[2];
  int until = final ? m->held : m->held - AHEAD, i = 0;
  enum eo_code code = EO_OK;
  if (m->held >= 512 || (!m->known && m->held >= 32)) {
    learn(m, m->sample, m->held, &m->usual);
    m->known = true;
    if (!note_block(m, u))
      return eo_error_memory(error);
  }
  for (; i < until && !code; i++) {
    struct eo_sample *s = &m->sample[i];
    struct usual here = *u;
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

static enum eo_code convert(struct maker *m, struct eo_angles *a, struct eo_error *error)
{
  double(*out)[3] = malloc(sizeof *out * EO_SAMPLER_BLOCK);
  int count = 1, written = 0;
  enum eo_code code = out ? EO_OK : eo_error_memory(error);
  for (int c = 0; c < 2; c++) {
    const struct eo_scan_column *column = &m->scan->column[c][0];
    bool coarse = !a->raw[c] && column->typical < 0.5 * column->quantum; /* most rows repeat the one before */
    m->quantum[c] = coarse ? column->quantum * fabs(m->sampler.scale[c]) : 0;
    m->sampler.step[c] = 0;
  }
  while (!code && count) {
    code = eo_sampler_next(&m->sampler, m->sample + m->held, &count, error);
    m->held += code ? 0 : count;
    if (!code && eo_progress_report(m->progress, "angles",
                                    (double)m->sampler.next / (double)(m->scan->rows ? m->scan->rows : 1)))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    if (!code)
      code = pass_on(m, a, count == 0, out, &written, error);
  }
  if (!code && written)
    code = eo_recording_append(a->series, out[0], written, error);
  free(out);
  return code;
}

/* ---- afterwards ---- */

static void judge_jumps(struct maker *m, const struct eo_angles *a)
{
  for (int i = 0; i < m->losses && m->losses <= MOST_LOSSES; i++)
    at_row(m,
           eo_findings_add(m->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, m->loss[i].channel,
                           DEGREES * m->loss[i].jump,
                           "The %s channel jumps by %.5g degrees at row %lld and stays there while the other does not: "
                           "counts were lost in one channel.",
                           member_name[m->loss[i].channel], DEGREES * m->loss[i].jump, (long long)m->loss[i].row + 1),
           m->loss[i].row);
  if (m->gaps)
    at_row(m,
           eo_findings_add(m->findings, EO_FINDING_DROPPED, EO_SEVERITY_REPAIRED, -1, (double)a->dropped,
                           "About %lld rows are missing from both channels in %lld places, the first before row %lld; "
                           "the angles say for how long, and time was "
                           "set by them.",
                           (long long)a->dropped, (long long)m->gaps, (long long)m->gap_row + 1),
           m->gap_row);
  if (m->spikes)
    at_row(m,
           eo_findings_add(m->findings, EO_FINDING_SPIKE, EO_SEVERITY_REPAIRED, -1, (double)m->spikes,
                           "%lld single rows are far off, the first is row %lld; they were left out.",
                           (long long)m->spikes, (long long)m->spike_row + 1),
           m->spike_row);
  if (a->slips > 4)
    eo_findings_add(m->findings, EO_FINDING_SLIP, EO_SEVERITY_REFUSED, -1, a->slips,
                    "There are %d such jumps altogether.", a->slips);
}

/* The median over the blocks that move. */
static double usual_rate(double *rate, int blocks)
{
  double fastest = 0;
  int moving = 0;
  for (int i = 0; i < blocks; i++)
    fastest = fmax(fastest, fabs(rate[i]));
  for (int i = 0; i < blocks; i++)
    if (fabs(rate[i]) > MOVING * fastest)
      rate[moving++] = rate[i];
  return eo_scan_quantile(rate, moving, 0.5);
}

static void conclude(struct maker *m, struct eo_angles *a)
{
  double advance = m->high.angle[0] - m->low.angle[0];
  a->rows = eo_recording_rows(a->series);
  a->interval = m->usual.interval;
  a->from[0] = 0;
  a->from[1] = 1;
  a->factor[0] = a->factor[1] = 1;
  bool even = a->slips == 0 && advance > 0;
  a->ratio = even ? (m->high.angle[1] - m->low.angle[1]) / advance : eo_scan_quantile(m->proportion, m->blocks, 0.5);
  for (int c = 0; c < 2; c++) {
    a->rate[c] = usual_rate(m->rate[c], m->blocks);
    a->wrapped[c] = m->wrapped[c];
  }
  if (!even)
    advance = fabs(a->rate[0]) * a->interval * EO_SAMPLER_BLOCK;
  a->ratio_tolerance = fmax(1e-6, 0.02 / fmax(advance, 0.1));
  judge_jumps(m, a);
}

enum eo_code eo_angles_make(struct eo_angles *a, const struct eo_recording *recording, const struct eo_tracks *tracks,
                            const char *spool_directory, struct eo_findings *findings,
                            const struct eo_progress *progress, struct eo_error *error)
{
  struct maker *m = calloc(1, sizeof *m);
  memset(a, 0, sizeof *a);
  if (m)
    m->scan = calloc(1, sizeof *m->scan);
  if (!m || !m->scan) {
    free(m);
    return eo_error_memory(error);
  }
  m->recording = recording;
  m->tracks = tracks;
  m->findings = findings;
  m->progress = progress;
  bool pulses = tracks->channel[0].track == EO_TRACK_PULSES;
  enum eo_code code = eo_sampler_init(&m->sampler, recording, tracks, spool_directory, error);
  if (!code && !pulses)
    code = eo_scan_run(m->scan, recording, tracks, progress, error);
  if (!code && !pulses) {
    judge_time(m);
    judge_gaps(m);
    code = prepare_tracks(m, a, error);
  }
  if (pulses && !code)
    eo_pulses_judge(m->sampler.pulses, findings);
  if (pulses)
    m->scan->rows = eo_recording_rows(recording);
  if (!code && eo_findings_worst(findings) != EO_SEVERITY_REFUSED) {
    code = eo_recording_new(&a->series, 3, spool_directory, error);
    if (!code)
      code = convert(m, a, error);
    if (!code)
      conclude(m, a);
  }
  if (a->series && (code || eo_findings_worst(findings) == EO_SEVERITY_REFUSED))
    eo_angles_done(a);
  eo_sampler_done(&m->sampler);
  free(m->rate[0]);
  free(m->scan);
  free(m);
  return code;
}

void eo_angles_done(struct eo_angles *a)
{
  eo_recording_free(a->series);
  a->series = NULL;
}

enum eo_code eo_angles_read(const struct eo_angles *a, int64_t first, int64_t count, double *rows,
                            struct eo_error *error)
{
  enum eo_code code = eo_recording_read(a->series, first, count, rows, error);
  for (int64_t i = 0; i < count && !code; i++) {
    double *row = rows + 3 * i, channel[2] = {row[1], row[2]};
    row[1] = a->factor[0] * channel[a->from[0]];
    row[2] = a->factor[1] * channel[a->from[1]];
  }
  return code;
}
