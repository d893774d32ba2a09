/* Pulse times as angles: the k-th pulse of an encoder with N lines passes at the angle 2 pi k / N. The samples stand at
   the pulses of the pinion; the angle of the gear there comes from Lagrange's polynomial through the six gear pulses
   around (about 1e-4 of a harmonic that has eight pulses per period). */
#include "measurement/sampler.h"

#include <math.h>
#include <stdlib.h>

enum { NODES = 6, SIDE = EO_SAMPLER_BLOCK };

/* The pulses of one encoder, in blocks. */
struct train {
  int column;
  int64_t length, first; /* pulses; index of the first one in the block */
  int count;
  double time[SIDE];
};

struct eo_pulses {
  const struct eo_recording *recording;
  const struct eo_tracks *tracks;
  struct train train[2];
  int64_t next, near; /* pinion pulse; gear pulse at or before it */
  double *rows;
};

/* Empty cells at the end of the shorter column are no pulses. */
static enum eo_code find_length(struct eo_pulses *p, struct train *train, struct eo_error *error)
{
  int columns = eo_recording_columns(p->recording);
  train->length = eo_recording_length(p->recording, train->column);
  while (train->length > 0) {
    int64_t first = train->length > SIDE ? train->length - SIDE : 0;
    enum eo_code code = eo_recording_read(p->recording, first, train->length - first, p->rows, error);
    if (code)
      return code;
    for (; train->length > first; train->length--)
      if (isfinite(p->rows[(size_t)(train->length - 1 - first) * (size_t)columns + (size_t)train->column]))
        return EO_OK;
  }
  return EO_OK;
}

enum eo_code eo_pulses_new(struct eo_pulses **pulses, const struct eo_recording *recording,
                           const struct eo_tracks *tracks, struct eo_error *error)
{
  struct eo_pulses *p = calloc(1, sizeof *p);
  if (p)
    p->rows = malloc(sizeof *p->rows * SIDE * (size_t)eo_recording_columns(recording));
  if (!p || !p->rows) {
    eo_pulses_free(p);
    return eo_error_memory(error);
  }
  p->recording = recording;
  p->tracks = tracks;
  enum eo_code code = EO_OK;
  for (int i = 0; i < 2 && !code; i++) {
    p->train[i].column = tracks->channel[i].column[0];
    code = find_length(p, &p->train[i], error);
  }
  if (code)
    eo_pulses_free(p);
  else
    *pulses = p;
  return code;
}

void eo_pulses_free(struct eo_pulses *p)
{
  if (p)
    free(p->rows);
  free(p);
}

/* Makes the pulses from `first` on available. */
static enum eo_code load(struct eo_pulses *p, struct train *train, int64_t first, struct eo_error *error)
{
  int columns = eo_recording_columns(p->recording);
  int64_t left = train->length - first;
  int count = left < SIDE ? (int)left : SIDE;
  enum eo_code code = eo_recording_read(p->recording, first, count, p->rows, error);
  if (code)
    return code;
  train->first = first;
  train->count = count;
  for (int i = 0; i < count; i++)
    train->time[i] = p->rows[(size_t)i * (size_t)columns + (size_t)train->column] * p->tracks->time_scale;
  return EO_OK;
}

/* The time of a pulse; the block moves when the pulse is not in it. */
static enum eo_code pulse_at(struct eo_pulses *p, struct train *train, int64_t pulse, double *time,
                             struct eo_error *error)
{
  if (pulse < train->first || pulse >= train->first + train->count) {
    int64_t first = pulse > NODES ? pulse - NODES : 0;
    enum eo_code code = load(p, train, first, error);
    if (code)
      return code;
  }
  *time = train->time[pulse - train->first];
  return EO_OK;
}

/* The pulse of the gear, with its fraction, that passes at `time`: between pulses near and near + 1. */
static enum eo_code interpolate(struct eo_pulses *p, double time, double *pulse, struct eo_error *error)
{
  struct train *gear = &p->train[1];
  int64_t first = p->near - NODES / 2 + 1;
  first = first < 0 ? 0 : first + NODES > gear->length ? gear->length - NODES : first;
  double node[NODES];
  *pulse = 0;
  for (int i = 0; i < NODES; i++) {
    enum eo_code code = pulse_at(p, gear, first + i, &node[i], error);
    if (code)
      return code;
  }
  for (int i = 0; i < NODES; i++) {
    double weight = 1;
    for (int j = 0; j < NODES; j++)
      if (j != i)
        weight *= (time - node[j]) / (node[i] - node[j]);
    *pulse += weight * i;
  }
  *pulse += (double)first;
  return EO_OK;
}

enum eo_code eo_pulses_next(struct eo_pulses *p, struct eo_sample *sample, int *count, struct eo_error *error)
{
  const struct eo_track_channel *channel = p->tracks->channel;
  *count = 0;
  if (p->train[1].length < NODES)
    return EO_OK;
  for (; *count < EO_SAMPLER_BLOCK && p->next < p->train[0].length; p->next++) {
    double time, after, pulse;
    enum eo_code code = pulse_at(p, &p->train[0], p->next, &time, error);
    while (!code && isfinite(time) && p->near + 1 < p->train[1].length &&
           !(code = pulse_at(p, &p->train[1], p->near + 1, &after, error)) && !(after > time))
      p->near++;
    if (code)
      return code;
    if (p->near + 1 >= p->train[1].length)
      break;
    code = pulse_at(p, &p->train[1], p->near, &after, error);
    if (!code && isfinite(time) && time >= after)
      code = interpolate(p, time, &pulse, error);
    else
      continue; /* before the first pulse of the gear, or no number */
    if (code)
      return code;
    if (!isfinite(pulse))
      continue;
    sample[(*count)++] = (struct eo_sample){
        time, {2 * M_PI * (double)p->next / channel[0].lines, 2 * M_PI * pulse / channel[1].lines}, p->next};
  }
  return EO_OK;
}
