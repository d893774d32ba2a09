/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the columns of a recording mean: guessed from names, units and values, said in sentences, overridden by the
   caller. */
#ifndef EASEOFF_RECORDING_LAYOUT_H
#define EASEOFF_RECORDING_LAYOUT_H

#include "recording/notes.h"
#include "recording/recording.h"
#include "recording/tracks.h"

enum eo_layout_kind { EO_LAYOUT_GUESS_KIND, EO_LAYOUT_ANGLES, EO_LAYOUT_SINE_COSINE, EO_LAYOUT_PULSES };
enum eo_layout_unit { EO_LAYOUT_GUESS_UNIT, EO_LAYOUT_DEGREE, EO_LAYOUT_RADIAN, EO_LAYOUT_TURN, EO_LAYOUT_COUNT };

/* Zeroed: everything is guessed. A column is given by its name or by its number from 1; a name is taken first. */
struct eo_layout_choice {
  enum eo_layout_kind kind;
  enum eo_layout_unit unit; /* of angles */
  const char *time;         /* column; "none": there is none, whatever it looks like */
  const char *gear_time;    /* column of the gear's own times; NULL: as above */
  const char *column[2][2]; /* [member]: the angle, sine and cosine, or pulse times */
  double sample_rate;       /* Hz, for rows without time */
  double lines[2];          /* [member] per turn: counts, sine periods or pulses; 0: not known */
  double time_scale;        /* s per unit of the time */
};

/* What is known of the pair before its recording is read; zeroed: nothing. */
struct eo_layout_pair {
  int teeth[2];    /* [member]: the encoders turn in the inverse ratio */
  double speed[2]; /* lowest and highest of the pinion in the load cases of the design, rad/s */
  bool stated;     /* both are the one that was stated for the recording */
};

/* Finds what the columns of *recording mean: fills *tracks and adds what was guessed to notes. Where pinion and gear
   have different clocks (own rates, own columns of time, own rows), the gear's columns are brought to the times of the
   pinion's and *recording is replaced by one that holds both on one clock, its columns being the time, the pinion's and
   the gear's values (turns counted), torque and speed; the old one is freed. pair may be NULL. spool_directory: see
   eo_recording_new(). Errors: EO_ERROR_INPUT, with the key of the layout that would settle it as pointer ("/time",
   "/time_unit", "/sample_rate_Hz", "/columns", "/lines", "/unit", "/kind"), EO_ERROR_FILE, EO_ERROR_MEMORY; *recording
   is then as it was. */
enum eo_code eo_layout_find(struct eo_recording **recording, const struct eo_layout_choice *choice,
                            const struct eo_layout_pair *pair, const char *spool_directory, struct eo_tracks *tracks,
                            struct eo_notes *notes, struct eo_error *error);

/* One recording from two files of one run, one per encoder, pinion first: the columns of the second are put beside
   those of the first, each with the clock of its file; their names tell which file they are of. Where both files state
   when they began, the difference of their clocks is kept, else their times are taken for those of one clock, which is
   noted. eo_layout_find() brings them together. choice may name the time column; NULL: guess. The caller frees
   *combined. Errors: EO_ERROR_INPUT: too many columns; EO_ERROR_FILE; EO_ERROR_MEMORY. */
enum eo_code eo_layout_combine(const struct eo_recording *pinion, const struct eo_recording *gear,
                               const struct eo_layout_choice *choice, const char *spool_directory,
                               struct eo_recording **combined, struct eo_notes *notes, struct eo_error *error);

#endif
