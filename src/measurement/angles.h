/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From columns to two angles over time: raw tracks corrected and interpolated, turns counted, rows without numbers left
   out, gaps and jumps found. What can be repaired without a guess is repaired and said; what cannot is a refusing
   finding. */
#ifndef EASEOFF_MEASUREMENT_ANGLES_H
#define EASEOFF_MEASUREMENT_ANGLES_H

#include "measurement/scan.h"

/* Times of a recording that are asked for, s after its first row; to 0: until the end. */
struct eo_times {
  double from, to;
};

/* Runs that follow each other in one recording: what the angles of one say of those of another is not known. */
enum { EO_RUNS = 16 };

struct eo_angles {
  struct eo_recording
      *series; /* owned, [rows][3]: t in s, angles in rad as the channels gave them; NULL after a refusal */
  int64_t rows;
  double origin;                /* s, time of the recording's first row */
  int from[2];                  /* [member]: channel it is taken from */
  double factor[2];             /* [member]: of that channel's angle */
  double interval;              /* usual step of time, s */
  double rate[2];               /* [channel] median speed, rad/s, signed */
  double ratio;                 /* rate[1] / rate[0], over the whole recording where nothing jumps */
  double ratio_tolerance;       /* by which the ratio of good angles may differ from that of the teeth */
  int slips;                    /* jumps of one channel against the other */
  int64_t dropped;              /* rows missing from both channels */
  struct eo_ellipse ellipse[2]; /* [channel] of raw tracks */
  bool raw[2], wrapped[2];
  double around[2]; /* [channel] rad after which a counter starts again every few rows; 0: it does not */
  struct eo_interpolation interpolated; /* of the second channel, whose values were brought to the first one's times */
  int breaks;                           /* runs that begin behind the first one */
  int64_t run[EO_RUNS];                 /* [breaks]: row with which each of them begins */
  bool units_in_doubt;                  /* one channel is in degrees, the other in radians, and it is open which */
};

/* asked: what lies outside is not judged either. teeth: of pinion and gear, by whose ratio gaps are told from slips.
   spool_directory: see eo_recording_new(). Findings are added; a refusal
   leaves angles->series NULL and is no error. Errors: memory, files, cancelled. eo_angles_done() also after an error.
 */
enum eo_code eo_angles_make(struct eo_angles *angles, const struct eo_recording *recording,
                            const struct eo_tracks *tracks, const struct eo_times *asked, const int teeth[2],
                            const char *spool_directory, struct eo_findings *findings,
                            const struct eo_progress *progress, struct eo_error *error);
void eo_angles_done(struct eo_angles *angles);

/* rows[count][3]: t in s, pinion and gear angle in rad as from[] and factor[] say, with the zero of each encoder. */
enum eo_code eo_angles_read(const struct eo_angles *angles, int64_t first, int64_t count, double *rows,
                            struct eo_error *error);

#endif
