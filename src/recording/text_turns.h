/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts per turn in the heading of a text file: of one encoder, of both in one line, as lines that something
   multiplies. Internal to the text reader. */
#ifndef EASEOFF_RECORDING_TEXT_TURNS_H
#define EASEOFF_RECORDING_TEXT_TURNS_H

#include "recording/notes.h"
#include "recording/stated.h"
#include "recording/text_cell.h"
#include "recording/text_number.h"

#define EO_TURNS 8 /* of one list */

/* What a line has said of turns so far. */
struct eo_turns {
  struct eo_header_number before; /* the number before, and that which began the list */
  struct eo_stated stated;        /* the last counts per turn */
  int count;                      /* of the list; 0: there is none */
  double turn[EO_TURNS];          /* [count] */
  const char *from, *first, *end; /* the list: its key, its first number, its end */
};

/* What a number states, with its key as it stands in its cell, else with what is before it in the line. */
struct eo_stated eo_header_fact(const char *from, const char *number, double value, const char *unit);

/* Whether what is stated is about a column: turns by its number ("CPR1" of "Enc1") when one has it, else by whose it
 * is.
 */
bool eo_header_means(const struct eo_text_format *format, const struct eo_stated *stated, int column);

/* What the next number of a line states; one that goes on with a list, or multiplies the lines before it, by what they
   are. */
struct eo_stated eo_turns_state(struct eo_turns *turns, const struct eo_text_format *format,
                                const struct eo_header_number *number, const char *end);

/* Whether counts or lines per turn of a column are stated. */
bool eo_turns_known(const struct eo_text_format *format, int column);

/* Takes counts or lines per turn, or what multiplies them, to one column, in the place of any that it has. */
void eo_turns_set(struct eo_text_format *format, int column, const struct eo_stated *stated);

/* Takes counts per turn, and what multiplies them, to the columns that are meant. */
void eo_turns_use(struct eo_text_format *format, const struct eo_stated *stated);

/* At the end of a line: a list of counts per turn is that of pinion and gear, or of the columns in their order. */
void eo_turns_end(const struct eo_turns *turns, struct eo_text_format *format);

/* Counts per turn in the name of a column: "Pinion (512 PPR)", "Pinion [counts, 18000000/rev]". */
void eo_turns_of_name(struct eo_text_format *format, int column, const struct eo_cell *cell);

/* When all is read: counts per turn for columns that count, if need be lines by what multiplies them; lines for others.
   Where a counter takes as many edges of both encoders' lines, turn holds lines: whether they are in it already, the
   orders of shafts and mesh tell later. head: with the first row. */
void eo_turns_settle(struct eo_text_format *format, const char *head);

/* Tells what was multiplied and how a list was understood. */
void eo_turns_note(const struct eo_text_format *format, struct eo_notes *notes);

#endif
