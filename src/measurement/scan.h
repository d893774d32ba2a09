/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One pass over a recording before anything is made of it: ranges, steps, turns, rows that cannot be used. */
#ifndef EASEOFF_MEASUREMENT_SCAN_H
#define EASEOFF_MEASUREMENT_SCAN_H

#include "base/progress.h"
#include "measurement/ellipse.h"
#include "measurement/finding.h"
#include "recording/recording.h"
#include "recording/tracks.h"

enum { EO_SCAN_JUMPS = 4096, EO_SCAN_COLUMNS = 5, EO_SCAN_RETURNS = 16, EO_SCAN_HOLDS = 256 };

/* Rows that repeat the one before them. */
struct eo_scan_hold {
  int64_t row, rows; /* the first, and how many */
  double step;       /* to the value behind them; NaN: they are the last */
};

/* One column of values, in its own unit. */
struct eo_scan_column {
  double low, high;
  double typical;               /* size of a step: mean of the smaller nine tenths in samples of all rows */
  double width;                 /* of a counter that starts again every few rows; 0: it is none */
  double quantum;               /* smallest step that is not zero there */
  int64_t at_low, at_high;      /* values equal to low, to high */
  int64_t longest, longest_row; /* run of equal values while the other channel goes on */
  int64_t run;
  double travel; /* of the other channel in that run, its own typical steps */
  double before;
  int64_t last;  /* row of that value */
  int64_t pairs; /* of equal values, no more of them: common where a step is less than a count */
  int holds;     /* of more than one row; the first EO_SCAN_HOLDS are kept */
  struct eo_scan_hold hold[EO_SCAN_HOLDS];
  int jumps; /* steps of more than ten typical ones, or three and half the range; the first EO_SCAN_JUMPS are kept */
  double jump[EO_SCAN_JUMPS];
  int64_t jump_row[EO_SCAN_JUMPS]; /* negative: downwards into that row */
  int64_t rises;                   /* steps up less those down */
  int falls;                       /* of the jumps, those downwards */
  int64_t landing[2];              /* first row at which the values step back to 0: from above, from below; -1: never */
  double landed[2];                /* size of that step */
};

struct eo_scan {
  int64_t rows, used;             /* of the recording; with numbers in every column that matters */
  int64_t unusable, unusable_row; /* rows with NaN, the first */
  int64_t backward, standing, duplicate,
      time_row;   /* rows whose time lies before, at that of the row before; with the same values too */
  int64_t steady; /* of the first two, those at which the first angle goes on as usual */
  int64_t returns, return_row[EO_SCAN_RETURNS]; /* of those before: by so much that the clock began anew; the first */
  double time_first, time_last, interval;       /* s; typical step of time */
  double risen;                                 /* s: the sum of the steps up, but for leaps, */
  int64_t leaps;                                /* steps of so many intervals that they are none of the clock */
  struct eo_scan_column column[2][2];           /* [member][track] */
};

/* Scans angles and raw tracks; progress from 0 to 1. Errors: reading, memory, cancelled. */
enum eo_code eo_scan_run(struct eo_scan *scan, const struct eo_recording *recording, const struct eo_tracks *tracks,
                         const struct eo_progress *progress, struct eo_error *error);

/* The turn after which a column starts again, in its unit; NaN when it does not. turn: of its unit, 0: not known. The
   first turn may be a part of one, up to an index pulse. */
double eo_scan_period(const struct eo_scan_column *column, double turn);

/* How often both angles fall back in the same rows, which turns of two shafts never do: runs follow each other. row: in
   which the next one begins. */
int eo_scan_restarts(const struct eo_scan *scan, int64_t row[EO_SCAN_JUMPS]);

/* The row of the index pulse that ended a first turn in part, so that the values before it have another zero; 0: none.
 */
int64_t eo_scan_index_row(const struct eo_scan_column *column, double period);

/* The part of the samples of a sine that is cut off at its extremes; 0 for a clean one. */
double eo_scan_clipped(const struct eo_scan_column *column, int64_t rows);

/* Columns of the tracks of one channel: 2 for raw tracks, else 1. */
static inline int eo_track_columns(const struct eo_track_channel *channel)
{
  return channel->track == EO_TRACK_SINE_COSINE ? 2 : 1;
}

/* The quantile (0.5: median) of value[count], which is reordered; NaN of none. */
double eo_scan_quantile(double *value, int count, double share);

#endif
