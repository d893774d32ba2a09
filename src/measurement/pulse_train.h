/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pulses of one encoder with the line that each of them is: pulses that are there twice left out, lines that gave
   none counted on, the gap of a wheel with missing teeth recognised. */
#ifndef EASEOFF_MEASUREMENT_PULSE_TRAIN_H
#define EASEOFF_MEASUREMENT_PULSE_TRAIN_H

#include "measurement/finding.h"
#include "recording/recording.h"
#include "recording/tracks.h"

struct eo_pulse_train {
  struct eo_recording *pulses; /* owned, [count][2]: time in s, line from 0 */
  int64_t count;
  double lines;                  /* per turn, those of missing teeth counted */
  int teeth_missing;             /* in each turn; 0: the wheel is whole */
  int64_t missed, doubled;       /* single lines without a pulse, pulses left out */
  int64_t missed_at, doubled_at; /* first of them, row of the recording */
  int64_t back, back_at;         /* earlier than the one before and left out */
  int64_t filled_at;             /* row from which the column holds one value again and again; -1: to its end pulses */
  bool unclear;                  /* gaps that fit no whole number of lines */
  int64_t unclear_at;
};

/* The pulses of a channel. Errors: memory, files. eo_pulse_train_done() also after an error. */
enum eo_code eo_pulse_train_make(struct eo_pulse_train *train, const struct eo_recording *recording,
                                 const struct eo_tracks *tracks, int channel, const char *spool_directory,
                                 struct eo_error *error);
void eo_pulse_train_done(struct eo_pulse_train *train);

/* What was left out, counted on or cannot be told. */
void eo_pulse_train_judge(const struct eo_pulse_train *train, int channel, struct eo_findings *findings);

#endif
