/* What the columns of a recording mean, as the signal chain needs it: where the time is and what each encoder gave. */
#ifndef EASEOFF_RECORDING_TRACKS_H
#define EASEOFF_RECORDING_TRACKS_H

#include "gear/gear_pair.h"

enum eo_track {
  EO_TRACK_ANGLE,       /* angle or count, wrapped or not */
  EO_TRACK_SINE_COSINE, /* two raw tracks */
  EO_TRACK_PULSES,      /* times at which lines passed; both channels then */
};

enum eo_track_unit { EO_TRACK_UNKNOWN, EO_TRACK_VOLT, EO_TRACK_MICROAMPERE }; /* of raw tracks */

struct eo_track_channel {
  enum eo_track track;
  int column[2];           /* of the recording: the angle, the sine and the cosine, or the pulse times */
  double scale;            /* of an angle: rad per unit of the column */
  double lines;            /* sine periods, or pulses, per turn; of raw tracks and pulses */
  enum eo_track_unit unit; /* of raw tracks as scaled by factor */
  double factor;           /* raw tracks: V or uA per unit of the column; 1 when the unit is not known */
};

struct eo_tracks {
  int time_column;                    /* -1: none; then the recording states the interval between rows */
  double time_scale;                  /* s per unit of the time column, and of pulse times */
  double interval;                    /* s between rows without a time column */
  struct eo_track_channel channel[2]; /* [member] */
};

#endif
