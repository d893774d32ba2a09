/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of a recording as time and two continuous angles, one after the other: the inside of eo_angles_make(). */
#ifndef EASEOFF_MEASUREMENT_SAMPLER_H
#define EASEOFF_MEASUREMENT_SAMPLER_H

#include "measurement/scan.h"

struct eo_sample {
  double time;     /* s */
  double angle[2]; /* [channel], rad */
  int64_t row;
};

enum { EO_SAMPLER_BLOCK = 4096 };

struct eo_sampler {
  const struct eo_recording *recording;
  const struct eo_tracks *tracks;
  const struct eo_ellipse *ellipse; /* [channel] of raw tracks */
  bool count_rows;                  /* time is the number of the row times the interval */
  bool goes_on;                     /* where the clock begins anew it goes on by an interval */
  double interval, shift;           /* s; put into the time by then */
  double scale[2], period[2]; /* [channel] rad per unit of an angle; rad after which it starts again, 0: it does not */
  const struct eo_scan_hold *hold[2]; /* [channel][holds], by rows: they are left out */
  int holds[2], held[2];              /* how many, and how many are passed */
  int64_t begin;                      /* rows before it are left out */
  int64_t next;                       /* row */
  int64_t turns[2];                   /* seen so far */
  bool started;
  double raw[2], time;      /* of the row before, not unwrapped */
  double step[2];           /* usual step of each channel, rad; follows slowly */
  double *rows;             /* owned: one block of the recording */
  struct eo_pulses *pulses; /* owned; NULL unless both channels are pulse times */
};

enum eo_code eo_sampler_init(struct eo_sampler *sampler, const struct eo_recording *recording,
                             const struct eo_tracks *tracks, const char *spool_directory, struct eo_error *error);
void eo_sampler_done(struct eo_sampler *sampler);

/* sample[EO_SAMPLER_BLOCK]; *count 0 at the end. Rows without numbers and repeated rows are left out. */
enum eo_code eo_sampler_next(struct eo_sampler *sampler, struct eo_sample *sample, int *count, struct eo_error *error);

/* Pulse times: the angle of the gear at the pulses of the pinion, by interpolation between its own pulses. */
enum eo_code eo_pulses_new(struct eo_pulses **pulses, const struct eo_recording *recording,
                           const struct eo_tracks *tracks, const char *spool_directory, struct eo_error *error);
void eo_pulses_free(struct eo_pulses *pulses);
void eo_pulses_judge(const struct eo_pulses *pulses, struct eo_findings *findings);
enum eo_code eo_pulses_next(struct eo_pulses *pulses, struct eo_sample *sample, int *count, struct eo_error *error);

/* After the last sample: how they stood between the pulses of the gear. */
enum eo_code eo_pulses_state(struct eo_pulses *pulses, struct eo_interpolation *interpolated, struct eo_error *error);

#endif
