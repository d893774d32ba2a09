/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the columns of a recording mean, as the signal chain needs it: where the time is, what each encoder gave and
   which columns beside them are torque and speed. Both encoders stand on one clock here: where a recording has a clock
   for each, eo_layout_find() has brought the gear's channel to the times of the pinion's. */
#ifndef EASEOFF_RECORDING_TRACKS_H
#define EASEOFF_RECORDING_TRACKS_H

#include "gear/gear_pair.h"
#include "recording/interpolation.h"

#include <stdbool.h>

enum eo_track {
  EO_TRACK_ANGLE,       /* angle or count, wrapped or not */
  EO_TRACK_SINE_COSINE, /* two raw tracks */
  EO_TRACK_PULSES,      /* times at which lines passed; both channels then */
};

enum eo_track_unit { EO_TRACK_UNKNOWN, EO_TRACK_VOLT, EO_TRACK_MICROAMPERE }; /* of raw tracks */

/* What is open about the scale of an angle; the lines of the transmission error may settle it. */
enum eo_track_doubt {
  EO_DOUBT_NONE,
  EO_DOUBT_UNIT,  /* nothing states the unit: it is a guess */
  EO_DOUBT_GRAD,  /* "grad": degrees in German, gon elsewhere */
  EO_DOUBT_EDGES, /* counts, where lines per turn are stated: a counter takes one, two or four edges of each */
  EO_DOUBT_WIDTH, /* counts that start again where a counter overflows, which need not be a turn */
};

struct eo_track_channel {
  enum eo_track track;
  int column[2];             /* of the recording: the angle, the sine and the cosine, or the pulse times */
  double scale;              /* of an angle: rad per unit of the column */
  enum eo_track_doubt doubt; /* of that scale */
  double lines;              /* sine periods, or pulses, per turn; of raw tracks and pulses */
  enum eo_track_unit unit;   /* of raw tracks as scaled by factor */
  double factor;             /* raw tracks: V or uA per unit of the column; 1 when the unit is not known */
};

/* A column beside the encoders. */
struct eo_track_beside {
  double scale; /* N m or rad/s per unit of the column; 0: there is no such column */
  int column;   /* of the recording */
  bool stated;  /* the unit is the file's own, else it is a guess from the name */
  bool named;   /* the name tells the shaft, else it is taken for the pinion's */
  int told;     /* how much name and unit tell; what tells more takes its place */
};

struct eo_tracks {
  int time_column;   /* -1: rows are even: row k stands at k interval, whatever a column of time looks like */
  double time_scale; /* s per unit of the time column, and of pulse times */
  double interval;   /* s between rows without a time column */
  struct eo_track_channel channel[2];         /* [member] */
  struct eo_track_beside torque[2], speed[2]; /* [member]; torque in N m, speed in rad/s */
  struct eo_interpolation interpolated;       /* of the gear's channel */
  struct eo_track_source { /* [member]: where the values were in the file, whatever the recording is now */
    int time, column[2];
    double time_scale;
  } source[2];
};

#endif
