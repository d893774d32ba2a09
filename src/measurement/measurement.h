/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rig recording to its result: the one place where the order angles -> which is which -> transmission error -> orders
   is written. */
#ifndef EASEOFF_MEASUREMENT_MEASUREMENT_H
#define EASEOFF_MEASUREMENT_MEASUREMENT_H

#include "measurement/load.h"
#include "measurement/transmission.h"

struct eo_measurement {
  struct eo_findings findings;
  bool refused;                 /* a finding forbids a result; `transmission` is then empty */
  int64_t rows;                 /* of the recording */
  double interval;              /* usual step of time, s */
  double ratio;                 /* gear angle over pinion angle as the channels gave them */
  bool raw[2];                  /* [channel] */
  struct eo_ellipse ellipse[2]; /* [channel] of raw tracks */
  struct eo_transmission transmission;
  struct eo_load load; /* columns of torque and speed over what was measured */
};

struct eo_measurement_settings {
  struct eo_transmission_settings transmission;
  double stated_speed;         /* of the pinion, rad/s; NaN: not known */
  double stated_torque;        /* of the pinion, N m; NaN: not known */
  double expected_speed[2];    /* of the pinion: lowest and highest of the load cases, rad/s; 0: not known */
  const char *spool_directory; /* borrowed; see eo_recording_new() */
};

/* Errors: memory, files, cancelled. What is wrong with the recording is no error: it stands in findings.
   eo_measurement_done() also after an error. Passes over the recording: look, ellipse (raw tracks), angles, trend, fit,
   residual; memory does not grow with the rows. */
enum eo_code eo_measurement_run(struct eo_measurement *measurement, const struct eo_recording *recording,
                                const struct eo_tracks *tracks, const struct eo_measurement_settings *settings,
                                const struct eo_progress *progress, struct eo_error *error);
void eo_measurement_done(struct eo_measurement *measurement);

#endif
