/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a file states about its sampling beside its numbers: one list of words for headings of text, properties of TDMS,
   variables of MATLAB and attributes of HDF5. Internal to the readers. */
#ifndef EASEOFF_RECORDING_STATED_H
#define EASEOFF_RECORDING_STATED_H

#include "recording/moment.h"

#include <stdbool.h>
#include <stddef.h>

enum eo_stated_kind {
  EO_STATED_NOTHING,
  EO_STATED_INTERVAL,   /* s between rows */
  EO_STATED_START,      /* s: time of the first row */
  EO_STATED_TICK,       /* s of one tick of the clock that times are counted by */
  EO_STATED_RESOLUTION, /* s that times resolve */
  EO_STATED_TURN,       /* counts or pulses per turn of an encoder */
  EO_STATED_FOLD,       /* counts for each line of an encoder: interpolation, or the edges that a counter takes */
  EO_STATED_SCALE,      /* value = scale * stored + offset */
  EO_STATED_OFFSET,
  EO_STATED_THINNED, /* of so many samples a row was made */
  EO_STATED_KINDS
};

/* What a rate speaks of, and what a number of samples for a row changes: a rate is that of the rows unless something of
   a greater strength divides it. */
enum eo_stated_strength {
  EO_STATED_CONVERTER, /* any rate */
  EO_STATED_OUTPUT,    /* behind averages: "output rate"; averages and oversampling */
  EO_STATED_ROWS,      /* behind all: "stored rate", "effective rate"; decimation, "every 4th sample is stored" */
};

struct eo_stated {
  enum eo_stated_kind kind;
  double value; /* in the unit above */
  int member;   /* 0: of the pinion, 1: of the gear, -1: the key does not say */
  int number;   /* of a channel, in the key: "CPR1"; -1: none */
  bool lines;   /* EO_STATED_TURN: lines or pulses, which EO_STATED_FOLD multiplies; not so counts */
  bool vague;   /* EO_STATED_TURN: by a resolution in bits or in an angle, which need not be that of the counts */
  enum eo_stated_strength strength; /* of EO_STATED_INTERVAL and EO_STATED_THINNED */
};

/* What a number under a key means. unit: of the number, "" when it stands in the key ("Sampling rate [kHz]", "dt_ms")
   or nowhere; the unit wins over the word, so that an interval in Hz is a rate. EO_STATED_NOTHING for other keys and
   for numbers that are no such thing. */
struct eo_stated eo_stated_read(const char *key, double number, const char *unit);

/* 0 and 1 when a name says pinion and gear, -1 else. */
int eo_stated_member(const char *name);

/* The last number of a name, of a channel for instance: 1 of "Encoder 1"; -1: there is none. */
int eo_stated_number(const char *name);

/* True for units that tell what a number is whatever its key: bits, and angles of less than a turn. */
bool eo_stated_keeps(const char *unit);

/* True for words that tell what is no sampling: filters, numbers of points, what a device could do. */
bool eo_stated_excludes(const char *words);

/* Of how many samples of the converter a row was made, as a line of a heading or a key with its value says:
   "decimation factor: 4", "every 4th sample is stored", "64 kHz / 16", "averages: 4". 0: it says nothing of that. */
double eo_stated_ratio(const char *line, enum eo_stated_strength *strength);

/* The same of a text under a key, as a fact: "decimation" "4:1", "comment" "every 4th sample is stored". */
struct eo_stated eo_stated_read_ratio(const char *key, const char *text);

/* True for words that say that of the rows only one in so many was kept. */
bool eo_stated_thins(const char *words);

/* True for keys that state when a recording began: "Start time", "Startzeit", "T0", ... */
bool eo_stated_begin(const char *key);

/* The number of a text such as "4 kHz" or "0,25 ms" and its unit, "" when it has none. False for other texts, and for
   those that may mean two numbers ("4,000"). */
bool eo_stated_read_number(const char *text, double *number, char *unit, size_t size);

/* When the recording of the values began, by a text under a key that says so. */
bool eo_stated_moment(const char *key, const char *text, struct eo_moment *moment);

#endif
