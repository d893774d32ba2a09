/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pulse times as angles: line k of an encoder with N lines passes at the angle 2 pi k / N. The samples stand at
   the pulses of the pinion; the angle of the gear there comes from Lagrange's polynomial through the gear pulses
   around, of which recording/interpolation.h says what it leaves of a wave; none stands where a line of the gear is
   missing. */
#include "measurement/pulse_train.h"
#include "measurement/sampler.h"

#include <math.h>
#include <stdlib.h>

enum { NODES = EO_INTERPOLATION_UNEVEN, SIDE = EO_SAMPLER_BLOCK };

/* The pulses of one encoder, in blocks. */
struct train {
  struct eo_pulse_train made;
  int64_t first; /* index of the first one in the block */
  int count;
  double pulse[SIDE][2]; /* time, line */
};

struct eo_pulses {
  struct train train[2];
  int64_t next, near;                               /* pinion pulse; gear pulse at or before it */
  int64_t places[EO_INTERPOLATION_PLACES], samples; /* how many samples stand where between two gear pulses, and all */
};

enum eo_code eo_pulses_new(struct eo_pulses **pulses, const struct eo_recording *recording,
                           const struct eo_tracks *tracks, const char *spool_directory, struct eo_error *error)
{
  struct eo_pulses *this_pulses = calloc(1, sizeof *this_pulses);
  enum eo_code code = this_pulses ? EO_OK : eo_error_memory(error);
  for (int i = 0; i < 2 && !code; i++)
    code = eo_pulse_train_make(&this_pulses->train[i].made, recording, tracks, i, spool_directory, error);
  if (code)
    eo_pulses_free(this_pulses);
  else
    *pulses = this_pulses;
  return code;
}

void eo_pulses_free(struct eo_pulses *pulses)
{
  for (int i = 0; i < 2 && pulses; i++)
    eo_pulse_train_done(&pulses->train[i].made);
  free(pulses);
}

void eo_pulses_judge(const struct eo_pulses *pulses, struct eo_findings *findings)
{
  for (int i = 0; i < 2; i++)
    eo_pulse_train_judge(&pulses->train[i].made, i, findings);
}

/* Time and line of a pulse; the block moves when the pulse is not in it. */
static enum eo_code pulse_at(struct train *train, int64_t pulse, const double **found, struct eo_error *error)
{
  if (pulse < train->first || pulse >= train->first + train->count) {
    int64_t first = pulse > NODES ? pulse - NODES : 0, left = train->made.count - first;
    int count = left < SIDE ? (int)left : SIDE;
    enum eo_code code = eo_recording_read(train->made.pulses, first, count, train->pulse[0], error);
    if (code)
      return code;
    train->first = first;
    train->count = count;
  }
  *found = train->pulse[pulse - train->first];
  return EO_OK;
}

/* The line of the gear, with its fraction, that passes at `time`: between pulses near and near + 1. */
static enum eo_code interpolate(struct eo_pulses *pulses, double time, double *line, struct eo_error *error)
{
  struct train *gear = &pulses->train[1];
  int64_t first = pulses->near - NODES / 2 + 1;
  double node[NODES], passed[NODES], weight[NODES];
  *line = 0;
  for (int i = 0; i < NODES; i++) {
    const double *pulse;
    enum eo_code code = pulse_at(gear, first + i, &pulse, error);
    if (code)
      return code;
    node[i] = pulse[0];
    passed[i] = pulse[1];
  }
  eo_interpolation_weights(NODES, node, time, weight);
  for (int i = 0; i < NODES; i++)
    *line += weight[i] * (passed[i] - passed[0]);
  *line += passed[0];
  return EO_OK;
}

/* Moves the gear's pulses on until the next one is after `time`. */
static enum eo_code advance(struct eo_pulses *pulses, double time, struct eo_error *error)
{
  const double *after;
  while (pulses->near + 1 < pulses->train[1].made.count) {
    enum eo_code code = pulse_at(&pulses->train[1], pulses->near + 1, &after, error);
    if (code || after[0] > time)
      return code;
    pulses->near++;
  }
  return EO_OK;
}

/* One sample at a pinion pulse. *taken: it lies between neighbouring lines of the gear. */
static enum eo_code sample_at(struct eo_pulses *pulses, struct eo_sample *sample, bool *taken, struct eo_error *error)
{
  const double *pulse;
  double time, own, line, low[2] = {0}, high[2] = {0};
  *taken = false;
  enum eo_code code = pulse_at(&pulses->train[0], pulses->next, &pulse, error);
  if (code)
    return code;
  time = pulse[0];
  own = pulse[1];
  code = advance(pulses, time, error);
  for (int i = 0; i < 2 && !code && pulses->near + 1 < pulses->train[1].made.count; i++) {
    code = pulse_at(&pulses->train[1], pulses->near + i, &pulse, error);
    (i ? high : low)[0] = pulse[0];
    (i ? high : low)[1] = pulse[1];
  }
  bool amid = pulses->near >= NODES / 2 - 1 && pulses->near + NODES / 2 < pulses->train[1].made.count;
  if (code || !amid || time < low[0] || high[1] - low[1] > 1.5)
    return code;
  code = interpolate(pulses, time, &line, error);
  *sample =
      (struct eo_sample){time,
                         {2 * M_PI * own / pulses->train[0].made.lines, 2 * M_PI * line / pulses->train[1].made.lines},
                         pulses->next};
  *taken = !code && isfinite(line);
  if (*taken) {
    pulses->places[(int)((time - low[0]) / (high[0] - low[0]) * EO_INTERPOLATION_PLACES) % EO_INTERPOLATION_PLACES]++;
    pulses->samples++;
  }
  return code;
}

enum eo_code eo_pulses_state(struct eo_pulses *pulses, struct eo_interpolation *interpolated, struct eo_error *error)
{
  struct train *gear = &pulses->train[1];
  const double *pulse, *last;
  *interpolated = (struct eo_interpolation){.points = NODES};
  if (pulses->samples == 0)
    return EO_OK;
  EO_TRY(pulse_at(gear, 0, &pulse, error));
  double time = pulse[0], line = pulse[1];
  EO_TRY(pulse_at(gear, gear->made.count - 1, &last, error));
  interpolated->step = (last[0] - time) / (last[1] - line);
  for (int i = 0; i < EO_INTERPOLATION_PLACES; i++)
    interpolated->share[i] = (double)pulses->places[i] / (double)pulses->samples;
  return EO_OK;
}

enum eo_code eo_pulses_next(struct eo_pulses *pulses, struct eo_sample *sample, int *count, struct eo_error *error)
{
  *count = 0;
  if (pulses->train[1].made.count < NODES)
    return EO_OK;
  for (; *count < EO_SAMPLER_BLOCK && pulses->next < pulses->train[0].made.count &&
         pulses->near + 1 < pulses->train[1].made.count;
       pulses->next++) {
    bool taken;
    enum eo_code code = sample_at(pulses, &sample[*count], &taken, error);
    if (code)
      return code;
    *count += taken;
  }
  return EO_OK;
}
