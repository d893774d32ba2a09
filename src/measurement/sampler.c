/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/sampler.h"

#include <math.h>
#include <stdlib.h>

enum eo_code eo_sampler_init(struct eo_sampler *s, const struct eo_recording *recording, const struct eo_tracks *tracks,
                             const char *spool_directory, struct eo_error *error)
{
  *s = (struct eo_sampler){.recording = recording, .tracks = tracks};
  if (tracks->channel[0].track == EO_TRACK_PULSES)
    return eo_pulses_new(&s->pulses, recording, tracks, spool_directory, error);
  s->rows = malloc(sizeof *s->rows * EO_SAMPLER_BLOCK * (size_t)eo_recording_columns(recording));
  return s->rows ? EO_OK : eo_error_memory(error);
}

void eo_sampler_done(struct eo_sampler *s)
{
  free(s->rows);
  eo_pulses_free(s->pulses);
  *s = (struct eo_sampler){0};
}

/* rad, not unwrapped; NaN when a value is missing */
static double raw_angle(const struct eo_sampler *s, int channel, const double *row)
{
  const struct eo_track_channel *c = &s->tracks->channel[channel];
  if (c->track == EO_TRACK_SINE_COSINE)
    return eo_ellipse_angle(&s->ellipse[channel], row[c->column[0]], row[c->column[1]]) / c->lines;
  return row[c->column[0]] * s->scale[channel];
}

/* The step is the one nearest to the usual one; whole turns are counted so that rounding does not grow. */
static double unwrap(struct eo_sampler *s, int channel, double angle)
{
  double period = s->period[channel];
  if (s->started && period > 0) {
    double step = angle - s->raw[channel], turns = round((s->step[channel] - step) / period);
    s->turns[channel] += (int64_t)turns;
    step += turns * period;
    if (fabs(step) < 0.45 * period)
      s->step[channel] += 0.02 * (step - s->step[channel]);
  }
  s->raw[channel] = angle;
  return angle + (double)s->turns[channel] * period;
}

enum eo_code eo_sampler_next(struct eo_sampler *s, struct eo_sample *sample, int *count, struct eo_error *error)
{
  const struct eo_tracks *t = s->tracks;
  if (s->pulses)
    return eo_pulses_next(s->pulses, sample, count, error);
  *count = 0;
  while (!*count && s->next < eo_recording_rows(s->recording)) {
    int64_t left = eo_recording_rows(s->recording) - s->next;
    int columns = eo_recording_columns(s->recording), rows = left < EO_SAMPLER_BLOCK ? (int)left : EO_SAMPLER_BLOCK;
    enum eo_code code = eo_recording_read(s->recording, s->next, rows, s->rows, error);
    if (code)
      return code;
    for (int i = 0; i < rows; i++) {
      const double *row = s->rows + (size_t)i * (size_t)columns;
      double time = s->count_rows ? s->interval * (double)(s->next + i) : row[t->time_column] * t->time_scale;
      double angle[2] = {raw_angle(s, 0, row), raw_angle(s, 1, row)};
      bool usable = isfinite(time) && isfinite(angle[0]) && isfinite(angle[1]);
      bool repeated = s->started && time == s->time && angle[0] == s->raw[0] && angle[1] == s->raw[1];
      if (!usable || repeated || s->next + i < s->begin)
        continue;
      sample[*count] = (struct eo_sample){time, {unwrap(s, 0, angle[0]), unwrap(s, 1, angle[1])}, s->next + i};
      s->time = time;
      s->started = true;
      ++*count;
    }
    s->next += rows;
  }
  return EO_OK;
}
