/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the layout: times, columns, and bringing channels to one clock. Internal to the layout. */
#ifndef EASEOFF_RECORDING_LAYOUT_PRIVATE_H
#define EASEOFF_RECORDING_LAYOUT_PRIVATE_H

#include "recording/column.h"
#include "recording/layout.h"

#define EO_TURN 6.283185307179586 /* rad */
#define EO_TIME_WORDS                                                                                                 \
  "t|time|times|zeit|timestamp|timestamps|elapsed|uhrzeit|zeitstempel|datum|date|datetime|datenum|tid|temps|tempo|x|" \
  "axis"

/* Times of one channel. */
struct eo_layout_clock {
  int column;      /* of the times; -1: rows are even */
  double scale;    /* s per unit of that column */
  double interval; /* s between rows, of the column its mean step */
  double start;    /* s: time of row 0 where rows are even */
  double shift;    /* s that are added, so that clocks which began at different times agree */
};

struct eo_guess {
  const struct eo_recording *recording;
  const struct eo_layout_choice *choice;
  const struct eo_layout_pair *pair;
  struct eo_tracks *tracks;
  struct eo_notes *notes;
  int columns;
  struct eo_column look[EO_RECORDING_COLUMNS];
  bool time[EO_RECORDING_COLUMNS];                 /* holds times */
  bool number[EO_RECORDING_COLUMNS];               /* counts the rows */
  int candidates, candidate[EO_RECORDING_COLUMNS]; /* columns that may be angles, tracks or pulses */
  int rival[2];                                    /* another pair that turns in the ratio of the teeth; -1: none */
  enum eo_layout_kind kind;
  bool equal, together;            /* times of both channels are equal; rows hold values of both */
  bool square;                     /* the tracks are square waves */
  bool increments[2];              /* [member]: counts since the row before */
  struct eo_layout_clock clock[2]; /* [member] */
};

/* For people: the name of a column, or its number. */
const char *eo_layout_label(const struct eo_guess *guess, int column, char *text, size_t size);

/* A column by its name, else by its number. */
enum eo_code eo_layout_chosen(const struct eo_guess *guess, const char *chosen, const char *pointer, int *column,
                              struct eo_error *error);

/* Values go one way, but for resets, and do go. */
bool eo_layout_turns(const struct eo_column *look);

/* States rates and counts per turn that a column holds in all rows, for the other columns. */
void eo_layout_read_constants(const struct eo_guess *guess, struct eo_recording *recording);

/* Fills time[] and number[]. */
void eo_layout_mark_times(struct eo_guess *guess);
/* Of several columns of time the one whose name shares most words with the channel's; of equals the nearest before it,
   else the first. -1: there is none. */
int eo_layout_pick_time(const struct eo_guess *guess, int channel);
/* The clock of each member's channel, whose column is known: chosen, stated, by name, by place. */
enum eo_code eo_layout_find_clocks(struct eo_guess *guess, struct eo_error *error);
/* Nothing states the unit of a member's times: they are taken for seconds so far. */
bool eo_layout_is_open(const struct eo_guess *guess, int member);
/* s per unit of a member's times where nothing states it, as read so far: the unit in which rows come at a rate that an
   encoder is recorded with. 1: seconds, or the unit is known. */
double eo_layout_time_factor(const struct eo_guess *guess, int member);
/* Settles units of time that nothing states and asks where the speed is far from every load case; the channels' scales
   are known. */
enum eo_code eo_layout_judge_speed(struct eo_guess *guess, struct eo_error *error);
/* Columns of times that are coarser than their rows are even give way to the count of the rows. */
enum eo_code eo_layout_make_even(struct eo_guess *guess, struct eo_error *error);
/* Fills scale and doubt of a member's channel of angles. Errors: the key that would settle it. */
enum eo_code eo_layout_find_scale(struct eo_guess *guess, int member, struct eo_error *error);
const char *eo_layout_scale_name(double scale); /* "degrees", ... */
/* Values per second of a column by its clock, without the resets, in the column's unit. */
double eo_layout_rate(const struct eo_guess *guess, int column, const struct eo_layout_clock *clock);

/* Two speeds whose ratio is that of the teeth, whichever of them is the pinion's. */
bool eo_layout_is_tooth_ratio(const struct eo_guess *guess, double ratio);
/* Of many candidates the two that turn in the ratio of the teeth; true when there are such. */
bool eo_layout_find_pair(struct eo_guess *guess);
/* Asks where names and units do not tell one pair from another. */
enum eo_code eo_layout_ask_rival(const struct eo_guess *guess, struct eo_error *error);
/* The file states a unit of the column, known or not. */
bool eo_layout_has_unit(const struct eo_guess *guess, int column);
/* Columns of torque and speed beside the channels. */
void eo_layout_find_beside(struct eo_guess *guess);

/* Fills equal and together. */
enum eo_code eo_layout_compare(struct eo_guess *guess, struct eo_error *error);
/* True when the channels must be brought to one clock, or their increments summed up. */
bool eo_layout_needs_align(const struct eo_guess *guess);
/* A new recording with the time in s, the channels and what is beside them; the tracks then speak of it. */
enum eo_code eo_layout_align(struct eo_guess *guess, const char *spool_directory, struct eo_recording **aligned,
                             struct eo_error *error);
/* Square waves become the times of their edges, in two columns. */
enum eo_code eo_layout_decode_squares(struct eo_guess *guess, const char *spool_directory, struct eo_recording **pulses,
                                      struct eo_error *error);

#endif
