/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/angles_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double DEGREES = 180 / M_PI;
static const double MOVING = 0.1; /* of the fastest block: slower ones do not tell the usual speed */

static int64_t line_of(const struct eo_angles_maker *m, int64_t row)
{
  return row < 0 ? 0 : eo_recording_line(m->recording, row);
}

struct eo_finding *eo_angles_at_row(const struct eo_angles_maker *m, struct eo_finding *finding, int64_t row)
{
  finding->row = row;
  finding->line = line_of(m, row);
  return finding;
}

static void judge_time(struct eo_angles_maker *m)
{
  const struct eo_scan *s = m->scan;
  int64_t wrong = s->backward + s->standing - s->duplicate;
  m->sampler.interval = s->interval;
  m->sampler.count_rows = m->tracks->time_column < 0;
  if (s->backward + s->standing == 0)
    return;
  if (wrong == 0) {
    eo_angles_at_row(m,
                     eo_findings_add(m->findings, EO_FINDING_TIME, EO_SEVERITY_REPAIRED, -1, (double)s->duplicate,
                                     "%lld rows repeat the row before them, the first is row %lld; they were left out.",
                                     (long long)s->duplicate, (long long)s->time_row + 1),
                     s->time_row);
  } else if ((double)s->steady >= 0.9 * (double)wrong) {
    if (!s->backward && s->used > 1)
      m->sampler.interval = (s->time_last - s->time_first) / (double)(s->used - 1);
    m->sampler.count_rows = true;
    eo_angles_at_row(
        m,
        eo_findings_add(m->findings, EO_FINDING_TIME, EO_SEVERITY_REPAIRED, -1, (double)wrong,
                        "Time stands still or runs backwards in %lld rows (first in row %lld) while the angles go "
                        "on evenly; it was counted from the rows, "
                        "%.6g ms each.",
                        (long long)wrong, (long long)s->time_row + 1, 1e3 * m->sampler.interval),
        s->time_row);
  } else {
    eo_angles_at_row(
        m,
        eo_findings_add(m->findings, EO_FINDING_TIME, EO_SEVERITY_REFUSED, -1, (double)wrong,
                        "Time does not rise in %lld rows, the first is row %lld, and the angles are no help there.",
                        (long long)wrong, (long long)s->time_row + 1),
        s->time_row);
  }
}

static void judge_gaps(struct eo_angles_maker *m)
{
  const struct eo_scan *s = m->scan;
  if (!s->unusable)
    return;
  bool most = s->unusable > s->rows / 2;
  eo_angles_at_row(m,
                   eo_findings_add(m->findings, EO_FINDING_NAN, most ? EO_SEVERITY_REFUSED : EO_SEVERITY_REPAIRED, -1,
                                   (double)s->unusable,
                                   "%lld of %lld rows hold a value that is no number, the first is row %lld; %s.",
                                   (long long)s->unusable, (long long)s->rows, (long long)s->unusable_row + 1,
                                   most ? "too many to go on" : "they were left out"),
                   s->unusable_row);
}

/* A channel that stands still altogether or for a part of a turn while the other moves on. */
static void judge_still(struct eo_angles_maker *m, int channel)
{
  for (int k = 0; k < eo_track_columns(&m->tracks->channel[channel]); k++) {
    const struct eo_scan_column *c = &m->scan->column[channel][k];
    bool constant = !(c->high > c->low), raw = m->tracks->channel[channel].track == EO_TRACK_SINE_COSINE;
    double advance = (double)c->longest * c->typical * (raw ? 0 : m->sampler.scale[channel]);
    if (constant)
      eo_findings_add(m->findings, EO_FINDING_CONSTANT, EO_SEVERITY_REFUSED, channel, c->low,
                      "The %s channel is constant: every row holds %.9g.", eo_channel_name(channel), c->low);
    else if (advance > 0.5 && (double)c->longest * c->typical > 20 * c->quantum && c->longest > 20)
      eo_angles_at_row(m,
                       eo_findings_add(m->findings, EO_FINDING_CONSTANT, EO_SEVERITY_REFUSED, channel,
                                       (double)c->longest, "The %s channel stands still for %lld rows from row %lld.",
                                       eo_channel_name(channel), (long long)c->longest, (long long)c->longest_row + 1),
                       c->longest_row);
    double clipped = raw && !constant ? eo_scan_clipped(c, m->scan->used) : 0;
    if (clipped > 0)
      eo_findings_add(m->findings, EO_FINDING_SATURATED, clipped > 0.2 ? EO_SEVERITY_REFUSED : EO_SEVERITY_WARNING,
                      channel, clipped, "The %s of the %s is cut off: %.1f %% of its values are exactly %.6g or %.6g.",
                      k ? "cosine" : "sine", eo_channel_name(channel), 100 * clipped, c->low, c->high);
  }
}

/* Where an angle starts again and what that says about its unit. */
static void judge_turns(struct eo_angles_maker *m, int channel)
{
  const struct eo_scan_column *c = &m->scan->column[channel][0];
  double scale = m->tracks->channel[channel].scale, period = eo_scan_period(c, 2 * M_PI / scale), turn = period * scale;
  m->sampler.scale[channel] = scale;
  if (fabs(scale - 1) < 1e-9)
    eo_findings_add(m->findings, EO_FINDING_UNITS, EO_SEVERITY_NOTE, channel, scale, "The %s angle is read as radians.",
                    eo_channel_name(channel));
  if (isnan(period))
    return;
  double degrees = turn / (2 * M_PI) * (1 / DEGREES), radians = turn / (2 * M_PI) * DEGREES;
  const char *unit = fabs(degrees - 1) < 0.05 ? "degrees" : fabs(radians - 1) < 0.05 ? "radians" : NULL;
  if (unit) {
    m->sampler.scale[channel] *= fabs(degrees - 1) < 0.05 ? 1 / DEGREES : DEGREES;
    eo_findings_add(m->findings, EO_FINDING_UNITS, EO_SEVERITY_REPAIRED, channel, period,
                    "The %s angle starts again after %.6g: it is in %s, not in the stated unit; read so.",
                    eo_channel_name(channel), period, unit);
    turn = 2 * M_PI;
  } else if (fabs(turn / (2 * M_PI) - 1) < 0.05) {
    turn = 2 * M_PI;
  }
  int64_t index = eo_scan_index_row(c, turn / m->sampler.scale[channel]);
  if (index) {
    m->sampler.begin = index > m->sampler.begin ? index : m->sampler.begin;
    eo_angles_at_row(
        m,
        eo_findings_add(m->findings, EO_FINDING_WRAPPED, EO_SEVERITY_NOTE, channel, (double)index,
                        "The %s counter starts anew at its index pulse before row %lld; what stands before that is "
                        "part of a turn without a zero and is left out.",
                        eo_channel_name(channel), (long long)index + 1),
        index);
  }
  m->sampler.period[channel] = turn;
  m->wrapped[channel] = true;
  eo_findings_add(m->findings, EO_FINDING_WRAPPED, EO_SEVERITY_NOTE, channel, (double)c->jumps,
                  "The %s angle starts again every %.6g, %d times; its turns were counted.", eo_channel_name(channel),
                  turn / m->sampler.scale[channel], c->jumps);
}

static enum eo_code fit_ellipses(struct eo_angles_maker *m, struct eo_angles *a, struct eo_error *error)
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
                      "The sine and cosine of the %s draw no ellipse.", eo_channel_name(channel));
  free(block);
  return code;
}

/* Usual limits of 1 Vpp and 11 uA encoders: 0.6..1.2 Vpp, 7..16 uApp, ratio 0.8..1.25, phase 90 +- 10 degrees. */
static void judge_ellipse(struct eo_angles_maker *m, const struct eo_ellipse *e, int channel)
{
  const struct eo_track_channel *c = &m->tracks->channel[channel];
  double ratio = e->amplitude[0] / e->amplitude[1], phase = DEGREES * e->skew;
  eo_findings_add(m->findings, EO_FINDING_TRACK, EO_SEVERITY_NOTE, channel, ratio,
                  "Offsets (%.2g, %.2g), ratio %.4g and phase %.2f degrees of the %s tracks were corrected.",
                  e->offset[0], e->offset[1], ratio, 90 + phase, eo_channel_name(channel));
  for (int k = 0; k < 2 && c->unit != EO_TRACK_UNKNOWN; k++) {
    bool volt = c->unit == EO_TRACK_VOLT;
    double size = 2 * e->amplitude[k] * c->factor, low = volt ? 0.6 : 7, high = volt ? 1.2 : 16;
    if (size < low || size > high)
      eo_findings_add(m->findings, EO_FINDING_TRACK, EO_SEVERITY_WARNING, channel, size,
                      "The %s of the %s has an amplitude of %.3g %s, outside the usual %.3g..%.3g.",
                      k ? "cosine" : "sine", eo_channel_name(channel), size, volt ? "Vpp" : "uApp", low, high);
  }
  if (ratio < 0.8 || ratio > 1.25)
    eo_findings_add(m->findings, EO_FINDING_TRACK, EO_SEVERITY_WARNING, channel, ratio,
                    "The sine of the %s is %.3g times its cosine, outside the usual 0.8..1.25; corrected.",
                    eo_channel_name(channel), ratio);
  if (fabs(phase) > 10)
    eo_findings_add(m->findings, EO_FINDING_TRACK, EO_SEVERITY_WARNING, channel, 90 + phase,
                    "The tracks of the %s are %.1f degrees apart, outside the usual 80..100; corrected.",
                    eo_channel_name(channel), 90 + phase);
}

static enum eo_code prepare_tracks(struct eo_angles_maker *m, struct eo_angles *a, struct eo_error *error)
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

static enum eo_code convert(struct eo_angles_maker *m, struct eo_angles *a, struct eo_error *error)
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
      code = eo_jumps_pass_on(m, a, count == 0, out, &written, error);
  }
  if (!code && written)
    code = eo_recording_append(a->series, out[0], written, error);
  free(out);
  return code;
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

static void conclude(struct eo_angles_maker *m, struct eo_angles *a)
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
  eo_jumps_judge(m, a);
}

enum eo_code eo_angles_make(struct eo_angles *a, const struct eo_recording *recording, const struct eo_tracks *tracks,
                            const char *spool_directory, struct eo_findings *findings,
                            const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_angles_maker *m = calloc(1, sizeof *m);
  memset(a, 0, sizeof *a);
  if (m)
    m->scan = calloc(1, sizeof *m->scan);
  if (!m || !m->scan) {
    free(m);
    return eo_error_memory(error);
  }
  a->interpolated = tracks->interpolated;
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
