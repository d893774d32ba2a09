/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A synthetic recording: what two encoders would record of a pair whose transmission error is known. For teaching and
   for tests: every number is a pure function of the settings and the row, the same for any order of the rows. */
#ifndef EASEOFF_MEASUREMENT_SYNTHETIC_H
#define EASEOFF_MEASUREMENT_SYNTHETIC_H

#include <complex.h>
#include <stdbool.h>
#include <stdint.h>

#include "recording/recording.h"
#include "recording/tracks.h"

enum { EO_SYNTHETIC_ORDERS = 32, EO_SYNTHETIC_COLUMNS = 8 };

enum eo_synthetic_output {
  EO_SYNTHETIC_ANGLES,
  EO_SYNTHETIC_COUNTS,
  EO_SYNTHETIC_SINE_COSINE,
  EO_SYNTHETIC_PULSES,
  EO_SYNTHETIC_INCREMENTS, /* counts since the row before */
  EO_SYNTHETIC_SQUARE,     /* A and B track of each encoder as square waves, V */
};

/* What is wrong with the recording; row and size say where and how much. */
enum eo_synthetic_fault {
  EO_FAULT_NONE,
  EO_FAULT_SWAPPED,
  EO_FAULT_REVERSED,       /* the gear counts backwards */
  EO_FAULT_TEETH,          /* the gear has `size` teeth more than the design */
  EO_FAULT_RADIANS,        /* angles in radians under a heading in degrees */
  EO_FAULT_RADIANS_GEAR,   /* the gear's alone */
  EO_FAULT_DROPPED,        /* `size` rows missing from both, time with them */
  EO_FAULT_DROPPED_SILENT, /* time written on as if nothing was missing */
  EO_FAULT_SLIP,           /* `size` rows missing from the gear */
  EO_FAULT_LOST_COUNT,     /* `size` lines lost by the gear's encoder */
  EO_FAULT_CONSTANT,       /* the gear stands still */
  EO_FAULT_STUCK,          /* from the row on */
  EO_FAULT_SATURATED,      /* raw tracks cut off at 80 % */
  EO_FAULT_TIME,           /* time runs back at the row */
  EO_FAULT_NAN,            /* `size` rows without a number */
  EO_FAULT_SPIKE,          /* one value of the gear is off by 0.1 rad */
  EO_FAULT_MISSED_PULSE,   /* `size` pulses of the gear in a row are not there */
  EO_FAULT_DOUBLE_PULSE,   /* a pulse of the gear is there twice, a hundredth of a line apart */
  EO_FAULTS
};

struct eo_synthetic {
  int teeth[2];
  double base_radius[2]; /* m */
  int orders;
  double complex order[EO_SYNTHETIC_ORDERS]; /* [orders] TE = Re sum order[h - 1] exp(i h teeth theta), m */
  double pinion_share;                       /* of the vibration, 0..1 */
  double speed;                              /* of the pinion, rad/s, mean */
  double drift;                              /* of the speed from start to end, relative; 1.9: a run-up from 0.05 */
  double swing, swing_turns; /* relative amplitude of a swing of the speed, its period in turns of the pinion */
  double step;               /* of the speed half way, between two steady states, relative */
  double run_up;             /* of the turns, the first ones: the speed rises there from a tenth to that of the rest */
  double rest[2];            /* standstill at start and end, s */
  bool turn_back;            /* the pinion then turns back to where it began */
  double turns;              /* of the pinion, one way */
  double sample_rate;        /* Hz */
  double eccentricity[2];    /* amplitude of the first shaft order, m along the line of action, of each encoder */
  bool run_out;              /* of the gears instead: the shafts share it as they share the vibration */
  double noise;              /* of each angle, standard deviation, rad */
  double jitter, skew;       /* of the sampling: of both channels, of the gear alone, s */
  double gear_rate;          /* samples per second of the gear, with a time column of its own; 0: the same clock */
  double gear_delay;         /* s, of the gear's first sample, with a time column of its own unless 0 */
  double torque, torque_change; /* N m, mean, in a column of its own unless 0; change from start to end, relative */
  bool shows_speed;             /* in a column of its own, rpm */
  bool index;                   /* counts start again at 0 with an index pulse each turn */
  int missing[2];               /* teeth left out of each turn of a pulse wheel */
  int lines[2];                 /* per turn */
  int interpolation;            /* steps per line that angles and counts are rounded to; 0: not rounded */
  enum eo_synthetic_output output;
  bool wrapped, radians;      /* angles */
  double amplitude;           /* of raw tracks, zero to peak, V */
  double offset, gain, phase; /* their errors: relative to the amplitude, relative, rad */
  double track_noise;         /* V */
  double track_step;          /* of the converter, V; 0: none */
  enum eo_synthetic_fault fault;
  int64_t row, size; /* of the fault */
  uint64_t seed;
};

/* Ranges that make sense of a row. Errors: EO_ERROR_INPUT. */
enum eo_code eo_synthetic_check(const struct eo_synthetic *synthetic, struct eo_error *error);

int64_t eo_synthetic_rows(const struct eo_synthetic *synthetic);
int eo_synthetic_columns(const struct eo_synthetic *synthetic);
/* Name with unit: "t_s", "angle1_deg", ... */
const char *eo_synthetic_heading(const struct eo_synthetic *synthetic, int column);
/* Decimals that keep more than the recording knows. */
int eo_synthetic_decimals(const struct eo_synthetic *synthetic, int column);

/* rows[count][columns]; where pulse times of the shorter column end: NaN. */
void eo_synthetic_fill(const struct eo_synthetic *synthetic, int64_t first, int64_t count, double *rows);

/* Mean speed of the pinion without run-up and rests, slow swings included, rad/s. */
double eo_synthetic_speed(const struct eo_synthetic *synthetic);

/* Highest less lowest speed over mean turns of the pinion, relative to the mean: what makes a recording unsteady. */
double eo_synthetic_swing(const struct eo_synthetic *synthetic);

/* RMS of the acceleration of mesh orders 1..harmonics at the mean speed, m/s2. */
double eo_synthetic_rms(const struct eo_synthetic *synthetic, int harmonics);

#endif
