/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What one column of a recording looks like: its name in words and its values in a few figures. Internal to the layout.
 */
#ifndef EASEOFF_RECORDING_COLUMN_H
#define EASEOFF_RECORDING_COLUMN_H

#include "recording/recording.h"
#include "recording/recorded_unit.h"

#include <stdbool.h>

/* Whose a channel is, by its name, as lists for eo_column_named(): English, German, French, Spanish, Italian,
 * Portuguese. */
#define EO_PINION_WORDS                                                                                        \
  "pinion|ritzel|input|driver|drive|driving|eingang|antrieb|motor|pignon|pinon|pignone|pinhao|menant|menante|" \
  "entree|entrada|ingresso"
#define EO_GEAR_WORDS                                                                                                  \
  "gear|wheel|rad|grossrad|output|driven|ausgang|abtrieb|roue|rueda|ruota|roda|corona|mene|menee|sortie|salida|saida|" \
  "uscita"

/* Names of columns of times, and of those of a counter's ticks. */
#define EO_CLOCK_WORDS                                                                                              \
  "t|time|times|zeit|timestamp|timestamps|elapsed|uhrzeit|zeitstempel|datum|date|datetime|datenum|tid|temps|tempo|" \
  "tiempo|heure|hora|horodatage|seconds"
#define EO_TICK_WORDS "tick|ticks|timer|tcnt|clk|takte"

struct eo_column {
  enum eo_quantity quantity; /* of its unit */
  double factor;             /* of its unit */
  int64_t count;             /* values looked at */
  int64_t first, last;       /* rows of the first and the last of them */
  double low, high;
  bool whole;       /* all are whole numbers */
  double step;      /* mean step between neighbours, without the resets */
  double pace;      /* mean travel per row whatever the way, 0 or more */
  double spread;    /* standard deviation of steps over |step| */
  int rises, falls; /* steps up and down */
  int resets;       /* steps against the trend by more than half the range */
  bool levels;      /* nearly all values lie at one of two levels, as those of a square wave */
  double period;    /* usual height of the resets and a step, roughly the turn; 0: none */
};

/* Looks at the first rows. Errors of reading. */
enum eo_code eo_column_look(const struct eo_recording *recording, int column, struct eo_column *look,
                            struct eo_error *error);

/* The turn after which a column starts again, exactly: 360, 2 pi, 1, 400 and the like, or the roundest number of counts
   that the values allow. 0: it does not start again, or after what cannot be told. */
double eo_column_turn(const struct eo_column *look);

/* Words that two names share, each as often as it is in both; words of the list count for nothing. */
int eo_column_shared_words(const char *name, const char *other, const char *ignored);

/* True when one of the words, separated by '|' and in lower case, is a word of the name; digits are words of their own.
 */
bool eo_column_named(const char *name, const char *words);

#endif
