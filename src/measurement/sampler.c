/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/sampler.h"

#include <math.h>
#include <stdlib.h>

static const double LATE = 1.5;    /* intervals: rows are missing where more time passes from one to the next */
static const double DRIFT = 0.005; /* relative: how far the speed may have changed behind a gap */

enum eo_code eo_sampler_init(struct eo_sampler *sampler, const struct eo_recording *recording,
                             const struct eo_tracks *tracks, const char *spool_directory, struct eo_error *error)
{
  *sampler = (struct eo_sampler){.recording = recording, .tracks = tracks};
  if (tracks->channel[0].track == EO_TRACK_PULSES)
    return eo_pulses_new(&sampler->pulses, recording, tracks, spool_directory, error);
  sampler->rows = malloc(sizeof *sampler->rows * EO_SAMPLER_BLOCK * (size_t)eo_recording_columns(recording));
  return sampler->rows ? EO_OK : eo_error_memory(error);
}

void eo_sampler_done(struct eo_sampler *sampler)
{
  free(sampler->rows);
  eo_pulses_free(sampler->pulses);
  *sampler = (struct eo_sampler){0};
}

/* rad, not unwrapped; NaN when a value is missing */
static double raw_angle(const struct eo_sampler *sampler, int channel, const double *row)
{
  const struct eo_track_channel *track_channel = &sampler->tracks->channel[channel];
  if (track_channel->track == EO_TRACK_SINE_COSINE)
    return eo_ellipse_angle(&sampler->ellipse[channel], row[track_channel->column[0]], row[track_channel->column[1]]) /
           track_channel->lines;
  return row[track_channel->column[0]] * sampler->scale[channel];
}

/* Rows that fit into the time since the last one, where the angle after so many is known well enough. */
static double rows_passed(const struct eo_sampler *sampler, int channel, double time)
{
  double rows = sampler->interval > 0 ? (time - sampler->time) / sampler->interval : 1;
  return rows > LATE && rows * fabs(sampler->step[channel]) * DRIFT < sampler->period[channel] / 4 ? rows : 1;
}

/* The step is the one nearest to the usual one; whole turns are counted so that rounding does not grow. */
static double unwrap(struct eo_sampler *sampler, int channel, double angle, double time)
{
  double period = sampler->period[channel];
  if (sampler->started && period > 0) {
    double rows = rows_passed(sampler, channel, time), step = angle - sampler->raw[channel],
           turns = round((rows * sampler->step[channel] - step) / period);
    sampler->turns[channel] += (int64_t)turns;
    step += turns * period;
    if (rows == 1 && fabs(step) < 0.45 * period)
      sampler->step[channel] += 0.02 * (step - sampler->step[channel]);
  }
  sampler->raw[channel] = angle;
  return angle + (double)sampler->turns[channel] * period;
}

/* The row repeats the value before it while the shaft goes on. */
static bool is_held(struct eo_sampler *sampler, int64_t row)
{
  bool held = false;
  for (int c = 0; c < 2; c++) {
    const struct eo_scan_hold *hold = sampler->hold[c];
    while (sampler->held[c] < sampler->holds[c] && row >= hold[sampler->held[c]].row + hold[sampler->held[c]].rows)
      sampler->held[c]++;
    held = held || (sampler->held[c] < sampler->holds[c] && row >= hold[sampler->held[c]].row);
  }
  return held;
}

enum eo_code eo_sampler_next(struct eo_sampler *sampler, struct eo_sample *sample, int *count, struct eo_error *error)
{
  const struct eo_tracks *tracks = sampler->tracks;
  if (sampler->pulses)
    return eo_pulses_next(sampler->pulses, sample, count, error);
  *count = 0;
  while (!*count && sampler->next < eo_recording_rows(sampler->recording)) {
    int64_t left = eo_recording_rows(sampler->recording) - sampler->next;
    int columns = eo_recording_columns(sampler->recording),
        rows = left < EO_SAMPLER_BLOCK ? (int)left : EO_SAMPLER_BLOCK;
    enum eo_code code = eo_recording_read(sampler->recording, sampler->next, rows, sampler->rows, error);
    if (code)
      return code;
    for (int i = 0; i < rows; i++) {
      const double *row = sampler->rows + (size_t)i * (size_t)columns;
      double time = sampler->count_rows ? sampler->interval * (double)(sampler->next + i)
                                        : row[tracks->time_column] * tracks->time_scale;
      if (sampler->goes_on && sampler->started && time + sampler->shift < sampler->time)
        sampler->shift = sampler->time + sampler->interval - time;
      time += sampler->shift;
      double angle[2] = {raw_angle(sampler, 0, row), raw_angle(sampler, 1, row)};
      bool usable = isfinite(time) && isfinite(angle[0]) && isfinite(angle[1]);
      bool repeated = sampler->started && time == sampler->time && angle[0] == sampler->raw[0] &&
                      angle[1] == sampler->raw[1];
      if (!usable || repeated || is_held(sampler, sampler->next + i) || sampler->next + i < sampler->begin)
        continue;
      sample[*count] = (struct eo_sample){
          time, {unwrap(sampler, 0, angle[0], time), unwrap(sampler, 1, angle[1], time)}, sampler->next + i};
      sampler->time = time;
      sampler->started = true;
      ++*count;
    }
    sampler->next += rows;
  }
  return EO_OK;
}
