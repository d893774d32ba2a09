/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A synthetic recording in memory, and what its columns are stated to mean, also where a fault makes that untrue. */
#ifndef EASEOFF_TESTS_SUPPORT_SYNTHETIC_RECORDING_H
#define EASEOFF_TESTS_SUPPORT_SYNTHETIC_RECORDING_H

#include "measurement/synthetic.h"

#include <math.h>
#include <string.h>

static inline int synthetic_column(const struct eo_synthetic *synthetic, const char *heading)
{
  for (int c = 0; c < eo_synthetic_columns(synthetic); c++)
    if (strcmp(eo_synthetic_heading(synthetic, c), heading) == 0)
      return c;
  return -1;
}

static inline void synthetic_tracks(const struct eo_synthetic *synthetic, struct eo_tracks *tracks)
{
  static const char *const counts[] = {"count1", "count2"}, *const degrees[] = {"angle1_deg", "angle2_deg"},
                           *const radians[] = {"angle1_rad", "angle2_rad"},
                           *const sines[] = {"pinion_sin_V", "gear_sin_V"},
                           *const pulses[] = {"pinion_pulse_s", "gear_pulse_s"};
  bool timed = synthetic->output == EO_SYNTHETIC_PULSES, raw = synthetic->output == EO_SYNTHETIC_SINE_COSINE,
       counted = synthetic->output == EO_SYNTHETIC_COUNTS;
  const char *const *heading = timed ? pulses : raw ? sines : counted ? counts : synthetic->radians ? radians : degrees;
  *tracks = (struct eo_tracks){.time_column = timed ? -1 : 0, .time_scale = 1, .interval = 1 / synthetic->sample_rate};
  for (int i = 0; i < 2; i++) {
    struct eo_track_channel *channel = &tracks->channel[i];
    channel->track = timed ? EO_TRACK_PULSES : raw ? EO_TRACK_SINE_COSINE : EO_TRACK_ANGLE;
    channel->column[0] = synthetic_column(synthetic, heading[i]);
    channel->column[1] = channel->column[0] + 1;
    channel->scale = counted              ? 2 * M_PI / ((double)synthetic->lines[i] * synthetic->interpolation)
                     : synthetic->radians ? 1
                                          : M_PI / 180;
    channel->lines = synthetic->lines[i];
    channel->unit = EO_TRACK_VOLT;
    channel->factor = 1;
  }
  if (synthetic->torque != 0 && !timed)
    tracks->torque[EO_PINION] =
        (struct eo_track_beside){.scale = 1, .column = synthetic_column(synthetic, "torque1_Nm"), .stated = true};
  if (synthetic->shows_speed && !timed)
    tracks->speed[EO_PINION] = (struct eo_track_beside){
        .scale = M_PI / 30, .column = synthetic_column(synthetic, "speed1_rpm"), .stated = true};
}

/* The whole as a recording that the caller frees. */
static inline enum eo_code synthetic_record(const struct eo_synthetic *synthetic, struct eo_recording **recording,
                                            struct eo_error *fault)
{
  enum { BLOCK = 1024 };
  double rows[BLOCK * EO_SYNTHETIC_COLUMNS];
  int64_t total = eo_synthetic_rows(synthetic), pulses[2] = {0, 0};
  int columns = eo_synthetic_columns(synthetic);
  enum eo_code code = eo_recording_new(recording, columns, NULL, fault);
  for (int64_t first = 0; first < total && !code; first += BLOCK) {
    int64_t count = total - first < BLOCK ? total - first : BLOCK;
    eo_synthetic_fill(synthetic, first, count, rows);
    for (int64_t i = 0; i < count; i++)
      for (int c = 0; c < 2; c++)
        pulses[c] += !isnan(rows[i * columns + c]);
    code = eo_recording_append(*recording, rows, count, fault);
  }
  for (int c = 0; c < 2 && !code && synthetic->output == EO_SYNTHETIC_PULSES; c++)
    eo_recording_set_length(*recording, c, pulses[c]);
  return code;
}

#endif
