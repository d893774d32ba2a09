/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/angles_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double DEGREES = 180 / M_PI;
static const double NEAR = 0.2;   /* steps that the jumps tell a turn to */
static const double SURE = 0.01;  /* relative: what the jumps tell of the width of a counter */
static const double MOVING = 0.1; /* of the fastest block: slower ones do not tell the usual speed */

static int64_t line_of(const struct eo_angles_maker *maker, int64_t row)
{
  return row < 0 ? 0 : eo_recording_line(maker->recording, row);
}

struct eo_finding *eo_angles_at_row(const struct eo_angles_maker *maker, struct eo_finding *finding, int64_t row)
{
  finding->row = row;
  finding->line = line_of(maker, row);
  return finding;
}

/* s between rows whose times stand still or go back now and then. Where many stand, the step that is usual is that of
   the times and none of the rows. */
static double interval_of(const struct eo_scan *scan)
{
  int64_t steps = scan->used - 1 - scan->backward - scan->leaps;
  if (!scan->backward && scan->used > 1)
    return (scan->time_last - scan->time_first) / (double)(scan->used - 1);
  return scan->standing - scan->duplicate > 0 && steps > 0 ? scan->risen / (double)steps : scan->interval;
}

static void judge_time(struct eo_angles_maker *maker)
{
  const struct eo_scan *scan = maker->scan;
  int64_t wrong = scan->backward + scan->standing - scan->duplicate;
  maker->sampler.interval = scan->interval;
  maker->sampler.count_rows = maker->tracks->time_column < 0;
  if (scan->backward + scan->standing == 0)
    return;
  bool even = (double)scan->steady >= 0.9 * (double)wrong;
  if (wrong && !even && scan->returns == wrong && scan->returns <= EO_RUNS) {
    maker->sampler.goes_on = true; /* runs, of which each has a clock that begins anew */
    return;
  }
  if (wrong == 0) {
    eo_angles_at_row(maker,
                     eo_findings_add(maker->findings, EO_FINDING_TIME, EO_SEVERITY_REPAIRED, -1,
                                     (double)scan->duplicate,
                                     "%lld rows repeat the row before them, the first is row %lld; they were left out.",
                                     (long long)scan->duplicate, (long long)scan->time_row + 1),
                     scan->time_row);
  } else if (even) {
    maker->sampler.interval = interval_of(scan);
    maker->sampler.count_rows = true;
    eo_angles_at_row(
        maker,
        eo_findings_add(maker->findings, EO_FINDING_TIME, EO_SEVERITY_REPAIRED, -1, (double)wrong,
                        "Time stands still or runs backwards in %lld rows (first in row %lld) while the angles go "
                        "on evenly; it was counted from the rows, "
                        "%.6g ms each.",
                        (long long)wrong, (long long)scan->time_row + 1, 1e3 * maker->sampler.interval),
        scan->time_row);
  } else {
    eo_angles_at_row(
        maker,
        eo_findings_add(maker->findings, EO_FINDING_TIME, EO_SEVERITY_REFUSED, -1, (double)wrong,
                        "Time does not rise in %lld rows, the first is row %lld, and the angles are no help there.",
                        (long long)wrong, (long long)scan->time_row + 1),
        scan->time_row);
  }
}

static void judge_gaps(struct eo_angles_maker *maker)
{
  const struct eo_scan *scan = maker->scan;
  if (!scan->unusable)
    return;
  bool most = scan->unusable > scan->rows / 2;
  eo_angles_at_row(maker,
                   eo_findings_add(maker->findings, EO_FINDING_NAN, most ? EO_SEVERITY_REFUSED : EO_SEVERITY_REPAIRED,
                                   -1, (double)scan->unusable,
                                   "%lld of %lld rows hold a value that is no number, the first is row %lld; %s.",
                                   (long long)scan->unusable, (long long)scan->rows, (long long)scan->unusable_row + 1,
                                   most ? "too many to go on" : "they were left out"),
                   scan->unusable_row);
}

/* A channel that stands still altogether or for a part of a turn while the other moves on. */
static void judge_still(struct eo_angles_maker *maker, int channel)
{
  for (int k = 0; k < eo_track_columns(&maker->tracks->channel[channel]); k++) {
    const struct eo_scan_column *column = &maker->scan->column[channel][k];
    bool constant = !(column->high > column->low), raw = maker->tracks->channel[channel].track == EO_TRACK_SINE_COSINE;
    double advance = (double)column->longest * column->typical * (raw ? 0 : maker->sampler.scale[channel]);
    if (constant)
      eo_findings_add(maker->findings, EO_FINDING_CONSTANT, EO_SEVERITY_REFUSED, channel, column->low,
                      "The %s channel is constant: every row holds %.9g.", eo_channel_name(channel), column->low);
    else if (advance > 0.5 && (double)column->longest * column->typical > 20 * column->quantum &&
             column->longest > 20 && !eo_holds_left_out(maker, channel, column->longest_row + 1))
      eo_angles_at_row(
          maker,
          eo_findings_add(maker->findings, EO_FINDING_CONSTANT, EO_SEVERITY_REFUSED, channel, (double)column->longest,
                          "The %s channel stands still for %lld rows from row %lld.", eo_channel_name(channel),
                          (long long)column->longest, (long long)column->longest_row + 1),
          column->longest_row);
    double clipped = raw && !constant ? eo_scan_clipped(column, maker->scan->used) : 0;
    if (clipped > 0)
      eo_findings_add(maker->findings, EO_FINDING_SATURATED, clipped > 0.2 ? EO_SEVERITY_REFUSED : EO_SEVERITY_WARNING,
                      channel, clipped, "The %s of the %s is cut off: %.1f %% of its values are exactly %.6g or %.6g.",
                      k ? "cosine" : "sine", eo_channel_name(channel), 100 * clipped, column->low, column->high);
  }
}

/* A counter overflows at a power of two or a round number, which the jumps tell but for the step's own changes. */
static double exact_overflow(const struct eo_scan_column *column, double period)
{
  double width = exp2(round(log2(period))), near = 0.1 * column->typical + 1;
  for (double unit = 1e6; unit >= 100 && fabs(period - width) > near; unit /= 10)
    if (round(period / unit) > 0 && fabs(round(period / unit) * unit - period) <= near)
      return round(period / unit) * unit;
  bool near_width = fabs(period - width) <= (width > 8 * column->typical ? 2 * column->typical : SURE * width);
  return near_width ? width : period;
}

/* All that jumps are the beginnings of runs: no turns are counted there. */
static bool restarts_only(const struct eo_angles_maker *maker, const struct eo_scan_column *column)
{
  int found = 0;
  for (int i = 0; i < column->jumps && i < EO_SCAN_JUMPS; i++)
    for (int k = 0; k < maker->restarts; k++)
      found += llabs(column->jump_row[i]) == maker->restart[k];
  return found == column->jumps;
}

/* Where an angle starts again and what that says about its unit. */
static void judge_turns(struct eo_angles_maker *maker, int channel)
{
  const struct eo_scan_column *column = &maker->scan->column[channel][0];
  double scale = maker->tracks->channel[channel].scale, period = eo_scan_period(column, 2 * M_PI / scale),
         turn = period * scale;
  maker->sampler.scale[channel] = scale;
  if (fabs(scale - 1) < 1e-9)
    eo_findings_add(maker->findings, EO_FINDING_UNITS, EO_SEVERITY_NOTE, channel, scale,
                    "The %s angle is read as radians.", eo_channel_name(channel));
  if (isnan(period) || restarts_only(maker, column))
    return;
  double degrees = turn / (2 * M_PI) * (1 / DEGREES), radians = turn / (2 * M_PI) * DEGREES;
  bool may = fabs(scale - 1) < 1e-9 || fabs(scale * DEGREES - 1) < 1e-9; /* counts and gon are none of both */
  const char *unit = !may ? NULL : fabs(degrees - 1) < 0.05 ? "degrees" : fabs(radians - 1) < 0.05 ? "radians" : NULL;
  double quarters = round(4 * turn / (2 * M_PI)), seen = turn;
  if (unit) {
    maker->sampler.scale[channel] *= fabs(degrees - 1) < 0.05 ? 1 / DEGREES : DEGREES;
    eo_findings_add(maker->findings, EO_FINDING_UNITS, EO_SEVERITY_REPAIRED, channel, period,
                    "The %s angle starts again after %.6g: it is in %s, not in the stated unit; read so.",
                    eo_channel_name(channel), period, unit);
    turn = 2 * M_PI;
  } else if (fabs(turn / (2 * M_PI) - 1) < 0.05) {
    turn = 2 * M_PI;
  } else if (column->quantum < 1 && fabs(turn - quarters * M_PI / 2) < NEAR * column->typical * scale) {
    turn = quarters * M_PI / 2; /* half turns, several turns: the jumps tell them but for the last digits */
  } else if (column->quantum >= 1) {
    period = exact_overflow(column, period);
    turn = period * scale;
  }
  bool parts = quarters != 4 && column->quantum < 1; /* the first turn is told by what was seen of it */
  int64_t index = eo_scan_index_row(column, (parts ? seen : turn) / maker->sampler.scale[channel]);
  if (index) {
    maker->sampler.begin = index > maker->sampler.begin ? index : maker->sampler.begin;
    eo_angles_at_row(
        maker,
        eo_findings_add(maker->findings, EO_FINDING_WRAPPED, EO_SEVERITY_NOTE, channel, (double)index,
                        "The %s counter starts anew at its index pulse before row %lld; what stands before that is "
                        "part of a turn without a zero and is left out.",
                        eo_channel_name(channel), (long long)index + 1),
        index);
  }
  maker->sampler.period[channel] = turn;
  maker->wrapped[channel] = true;
  eo_findings_add(maker->findings, EO_FINDING_WRAPPED, EO_SEVERITY_NOTE, channel, (double)column->jumps,
                  "The %s angle starts again every %.6g, %d times; its turns were counted.", eo_channel_name(channel),
                  turn / maker->sampler.scale[channel], column->jumps);
}

static int compare_rows(const void *a, const void *b)
{
  int64_t one = *(const int64_t *)a, two = *(const int64_t *)b;
  return (one > two) - (one < two);
}

/* Rows in which both angles or the clock start anew: the angles of two runs have nothing to do with each other. */
static void find_restarts(struct eo_angles_maker *maker)
{
  const struct eo_scan *scan = maker->scan;
  int64_t row[EO_SCAN_JUMPS + EO_RUNS];
  int n = maker->tracks->channel[0].track == EO_TRACK_ANGLE ? eo_scan_restarts(scan, row) : 0;
  for (int64_t i = 0; i < scan->returns && maker->sampler.goes_on; i++)
    row[n++] = scan->return_row[i];
  qsort(row, (size_t)n, sizeof *row, compare_rows);
  for (int i = 0; i < n; i++)
    if (maker->restarts < EO_RUNS + 1 && (i == 0 || row[i] != row[i - 1]))
      maker->restart[maker->restarts++] = row[i];
}

static enum eo_code fit_ellipses(struct eo_angles_maker *maker, struct eo_angles *angles, struct eo_error *error)
{
  struct eo_ellipse_sums sums[2];
  int columns = eo_recording_columns(maker->recording);
  int64_t rows = maker->scan->rows;
  double *block = malloc(sizeof *block * EO_SAMPLER_BLOCK * (size_t)columns);
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  for (int channel = 0; channel < 2; channel++) {
    const struct eo_scan_column *column = maker->scan->column[channel];
    eo_ellipse_start(&sums[channel],
                     (double[]){(column[0].low + column[0].high) / 2, (column[1].low + column[1].high) / 2},
                     fmax(column[0].high - column[0].low, 1e-300) / 2);
  }
  for (int64_t first = 0; first < rows && !code; first += EO_SAMPLER_BLOCK) {
    int count = rows - first < EO_SAMPLER_BLOCK ? (int)(rows - first) : EO_SAMPLER_BLOCK;
    code = eo_recording_read(maker->recording, first, count, block, error);
    for (int i = 0; i < count && !code; i++)
      for (int channel = 0; channel < 2; channel++) {
        const struct eo_track_channel *track_channel = &maker->tracks->channel[channel];
        double sine = block[(size_t)i * (size_t)columns + (size_t)track_channel->column[0]],
               cosine = block[(size_t)i * (size_t)columns + (size_t)track_channel->column[1]];
        if (track_channel->track == EO_TRACK_SINE_COSINE && isfinite(sine) && isfinite(cosine))
          eo_ellipse_add(&sums[channel], sine, cosine);
      }
  }
  for (int channel = 0; channel < 2 && !code; channel++)
    if (maker->tracks->channel[channel].track == EO_TRACK_SINE_COSINE &&
        !eo_ellipse_fit(&sums[channel], &angles->ellipse[channel]))
      eo_findings_add(maker->findings, EO_FINDING_TRACK, EO_SEVERITY_REFUSED, channel, NAN,
                      "The sine and cosine of the %s draw no ellipse.", eo_channel_name(channel));
  free(block);
  return code;
}

/* Usual limits of 1 Vpp and 11 uA encoders: 0.6..1.2 Vpp, 7..16 uApp, ratio 0.8..1.25, phase 90 +- 10 degrees. */
static void judge_ellipse(struct eo_angles_maker *maker, const struct eo_ellipse *ellipse, int channel)
{
  const struct eo_track_channel *track_channel = &maker->tracks->channel[channel];
  double ratio = ellipse->amplitude[0] / ellipse->amplitude[1], phase = DEGREES * ellipse->skew;
  eo_findings_add(maker->findings, EO_FINDING_TRACK, EO_SEVERITY_NOTE, channel, ratio,
                  "Offsets (%.2g, %.2g), ratio %.4g and phase %.2f degrees of the %s tracks were corrected.",
                  ellipse->offset[0], ellipse->offset[1], ratio, 90 + phase, eo_channel_name(channel));
  for (int k = 0; k < 2 && track_channel->unit != EO_TRACK_UNKNOWN; k++) {
    bool volt = track_channel->unit == EO_TRACK_VOLT;
    double size = 2 * ellipse->amplitude[k] * track_channel->factor, low = volt ? 0.6 : 7, high = volt ? 1.2 : 16;
    if (size < low || size > high)
      eo_findings_add(maker->findings, EO_FINDING_TRACK, EO_SEVERITY_WARNING, channel, size,
                      "The %s of the %s has an amplitude of %.3g %s, outside the usual %.3g..%.3g.",
                      k ? "cosine" : "sine", eo_channel_name(channel), size, volt ? "Vpp" : "uApp", low, high);
  }
  if (ratio < 0.8 || ratio > 1.25)
    eo_findings_add(maker->findings, EO_FINDING_TRACK, EO_SEVERITY_WARNING, channel, ratio,
                    "The sine of the %s is %.3g times its cosine, outside the usual 0.8..1.25; corrected.",
                    eo_channel_name(channel), ratio);
  if (fabs(phase) > 10)
    eo_findings_add(maker->findings, EO_FINDING_TRACK, EO_SEVERITY_WARNING, channel, 90 + phase,
                    "The tracks of the %s are %.1f degrees apart, outside the usual 80..100; corrected.",
                    eo_channel_name(channel), 90 + phase);
}

static enum eo_code prepare_tracks(struct eo_angles_maker *maker, struct eo_angles *angles, struct eo_error *error)
{
  bool any = false;
  for (int channel = 0; channel < 2; channel++) {
    angles->raw[channel] = maker->tracks->channel[channel].track == EO_TRACK_SINE_COSINE;
    any = any || angles->raw[channel];
    if (angles->raw[channel]) {
      maker->sampler.period[channel] = 2 * M_PI / maker->tracks->channel[channel].lines;
    } else {
      judge_turns(maker, channel);
      eo_holds_find(maker, channel);
    }
    judge_still(maker, channel);
  }
  if (!any || eo_findings_worst(maker->findings) == EO_SEVERITY_REFUSED)
    return EO_OK;
  enum eo_code code = fit_ellipses(maker, angles, error);
  for (int channel = 0; channel < 2 && !code; channel++)
    if (angles->raw[channel] && eo_findings_worst(maker->findings) != EO_SEVERITY_REFUSED)
      judge_ellipse(maker, &angles->ellipse[channel], channel);
  maker->sampler.ellipse = angles->ellipse;
  return code;
}

/* Moves the samples in the times that are asked for to the front and returns their number. */
static int keep_asked(struct eo_angles_maker *maker, struct eo_angles *angles, struct eo_sample *sample, int count)
{
  int kept = 0;
  if (!maker->origin_known && count)
    angles->origin = sample->time;
  maker->origin_known = maker->origin_known || count;
  for (int i = 0; i < count; i++) {
    double time = sample[i].time - angles->origin;
    if (time >= maker->asked->from && !(maker->asked->to > 0 && time > maker->asked->to))
      sample[kept++] = sample[i];
  }
  return kept;
}

static enum eo_code convert_rows(struct eo_angles_maker *maker, struct eo_angles *angles, double (*out)[3],
                                 struct eo_error *error)
{
  const double rows = (double)(maker->scan->rows ? maker->scan->rows : 1);
  int written = 0;
  for (int count = 1; count;) {
    struct eo_sample *samples = maker->sample + maker->held;
    EO_TRY(eo_sampler_next(&maker->sampler, samples, &count, error));
    int kept = keep_asked(maker, angles, samples, count);
    eo_resampled_note(maker, samples, kept);
    maker->held += kept;
    if (eo_progress_report(maker->progress, "angles", (double)maker->sampler.next / rows))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    EO_TRY(eo_jumps_pass_on(maker, angles, count == 0, out, &written, error));
  }
  return written ? eo_recording_append(angles->series, out[0], written, error) : EO_OK;
}

static enum eo_code convert(struct eo_angles_maker *maker, struct eo_angles *angles, struct eo_error *error)
{
  double(*out)[3] = malloc(sizeof *out * EO_SAMPLER_BLOCK);
  for (int c = 0; c < 2; c++) {
    const struct eo_scan_column *column = &maker->scan->column[c][0];
    bool coarse = !angles->raw[c] && column->typical < 0.5 * column->quantum; /* most rows repeat the one before */
    maker->quantum[c] = coarse ? column->quantum * fabs(maker->sampler.scale[c]) : 0;
    maker->sampler.step[c] = 0;
  }
  enum eo_code code = out ? convert_rows(maker, angles, out, error) : eo_error_memory(error);
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

static void conclude(struct eo_angles_maker *maker, struct eo_angles *angles)
{
  const struct eo_track_channel *pinion = &maker->tracks->channel[0];
  eo_gaps_widen(maker);
  const struct eo_sample *low = &maker->widest[0], *high = &maker->widest[1];
  double advance = high->angle[0] - low->angle[0];
  angles->rows = eo_recording_rows(angles->series);
  angles->interval = maker->usual.interval;
  angles->from[0] = 0;
  angles->from[1] = 1;
  angles->factor[0] = angles->factor[1] = 1;
  bool even = angles->slips == 0 && advance > 0;
  angles->ratio = even ? (high->angle[1] - low->angle[1]) / advance
                       : eo_scan_quantile(maker->proportion, maker->blocks, 0.5);
  for (int c = 0; c < 2; c++) {
    angles->rate[c] = usual_rate(maker->rate[c], maker->blocks);
    angles->wrapped[c] = maker->wrapped[c];
    angles->around[c] = maker->wrapped[c] && maker->scan->column[c][0].width > 0 ? maker->sampler.period[c] : 0;
  }
  if (!even)
    advance = fabs(angles->rate[0]) * angles->interval * EO_SAMPLER_BLOCK;
  if (pinion->doubt == EO_DOUBT_UNIT) /* what is taken for radians may be degrees */
    advance *= fmin(1, 1 / DEGREES / pinion->scale);
  angles->ratio_tolerance = fmax(1e-6, 0.02 / fmax(advance, 0.1));
  eo_jumps_judge(maker, angles);
  eo_resampled_judge(maker);
}

/* What the columns are found to hold, before they are read once more as angles. */
static enum eo_code prepare(struct eo_angles_maker *maker, struct eo_angles *angles, const char *spool_directory,
                            struct eo_error *error)
{
  EO_TRY(eo_sampler_init(&maker->sampler, maker->recording, maker->tracks, spool_directory, error));
  if (maker->tracks->channel[0].track == EO_TRACK_PULSES) {
    eo_pulses_judge(maker->sampler.pulses, maker->findings);
    maker->scan->rows = eo_recording_rows(maker->recording);
    return EO_OK;
  }
  EO_TRY(eo_scan_run(maker->scan, maker->recording, maker->tracks, maker->progress, error));
  judge_time(maker);
  judge_gaps(maker);
  find_restarts(maker);
  return prepare_tracks(maker, angles, error);
}

static enum eo_code make(struct eo_angles_maker *maker, struct eo_angles *angles, const char *spool_directory,
                         struct eo_error *error)
{
  EO_TRY(prepare(maker, angles, spool_directory, error));
  if (eo_findings_worst(maker->findings) == EO_SEVERITY_REFUSED)
    return EO_OK;
  EO_TRY(eo_recording_new(&angles->series, 3, spool_directory, error));
  EO_TRY(convert(maker, angles, error));
  if (maker->sampler.pulses)
    EO_TRY(eo_pulses_state(maker->sampler.pulses, &angles->interpolated, error));
  conclude(maker, angles);
  return EO_OK;
}

enum eo_code eo_angles_make(struct eo_angles *angles, const struct eo_recording *recording,
                            const struct eo_tracks *tracks, const struct eo_times *asked, const int teeth[2],
                            const char *spool_directory, struct eo_findings *findings,
                            const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_angles_maker *maker = calloc(1, sizeof *maker);
  memset(angles, 0, sizeof *angles);
  if (maker)
    maker->scan = calloc(1, sizeof *maker->scan);
  if (!maker || !maker->scan) {
    free(maker);
    return eo_error_memory(error);
  }
  angles->interpolated = tracks->interpolated;
  maker->recording = recording;
  maker->tracks = tracks;
  maker->asked = asked;
  maker->teeth[0] = teeth[0];
  maker->teeth[1] = teeth[1];
  maker->findings = findings;
  maker->progress = progress;
  enum eo_code code = make(maker, angles, spool_directory, error);
  if (angles->series && (code || eo_findings_worst(findings) == EO_SEVERITY_REFUSED))
    eo_angles_done(angles);
  eo_sampler_done(&maker->sampler);
  free(maker->rate[0]);
  free(maker->scan);
  free(maker);
  return code;
}

void eo_angles_done(struct eo_angles *angles)
{
  eo_recording_free(angles->series);
  angles->series = NULL;
}

enum eo_code eo_angles_read(const struct eo_angles *angles, int64_t first, int64_t count, double *rows,
                            struct eo_error *error)
{
  enum eo_code code = eo_recording_read(angles->series, first, count, rows, error);
  for (int64_t i = 0; i < count && !code; i++) {
    double *row = rows + 3 * i, channel[2] = {row[1], row[2]};
    row[1] = angles->factor[0] * channel[angles->from[0]];
    row[2] = angles->factor[1] * channel[angles->from[1]];
  }
  return code;
}
