/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a text file is laid out, found from its first lines. Internal to the text reader. */
#ifndef EASEOFF_RECORDING_TEXT_FORMAT_H
#define EASEOFF_RECORDING_TEXT_FORMAT_H

#include "base/error.h"
#include "recording/reader.h"
#include "recording/recording.h"

#include <stdbool.h>

#define EO_TEXT_HEAD ((size_t)256 << 10) /* bytes from which the layout is found */
#define EO_TEXT_CELLS 512                /* cells of a row at most */

/* What the cells of one place hold. */
enum eo_text_content {
  EO_TEXT_WORDS, /* left out */
  EO_TEXT_NUMBER,
  EO_TEXT_UNIT,   /* numbers with a unit behind them */
  EO_TEXT_LEVEL,  /* words for the levels of a square wave */
  EO_TEXT_HEX,    /* hexadecimal numbers without a mark */
  EO_TEXT_ARC,    /* degrees, minutes and seconds between colons */
  EO_TEXT_MOMENT, /* dates and times */
  EO_TEXT_DATE,   /* dates that go with the times of day in the cell beside them */
  EO_TEXT_BESIDE, /* numbers about the value of the row, its quality for instance; left out */
};

struct eo_text_format {
  char separator, point, line_end;             /* separator: one character, or a name of text_cell.h */
  int cells;                                   /* of a row */
  int columns;                                 /* cells that become columns: all but words and dates */
  bool plain;                                  /* every cell is a decimal number */
  enum eo_text_content content[EO_TEXT_CELLS]; /* [cells] */
  int date[EO_TEXT_CELLS];                     /* [cells] of a time of day: place of its date, -1: none */
  int64_t first_line;                          /* of the first row, from 1 */
  int rows;                                    /* of the head that are known to be rows */
  size_t first_byte;                           /* of the first row, in the text */
  size_t header_byte;                          /* where the header starts: behind a byte order mark */
  struct eo_clock clock[EO_TEXT_CELLS];        /* [cells] as the heading states it */
  double tick, turn[EO_TEXT_CELLS];            /* s; counts per turn; 0: not stated */
  double lines[EO_TEXT_CELLS];                 /* [cells] lines or pulses per turn; 0: not stated */
  double fold[EO_TEXT_CELLS];                  /* [cells] counts for each line by interpolation; 0: not stated */
  double edges[EO_TEXT_CELLS];                 /* [cells] that a counter takes of each line; 0: not stated */
  bool vague[EO_TEXT_CELLS];                   /* [cells] the counts per turn are those of a resolution */
  char listed[160];                            /* a note on counts per turn that one line lists; "": none */
  uint64_t key[EO_TEXT_CELLS];                 /* [cells] of their names in the rows (text_named.h); 0: none */
  char name[EO_TEXT_CELLS][EO_RECORDING_NAME]; /* [cells] */
  char unit[EO_TEXT_CELLS][EO_RECORDING_UNIT]; /* [cells] */
};

/* Whether the cells of a place become a column. */
bool eo_text_is_column(const struct eo_text_format *format, int cell);
/* Whether the name or the unit of a place is that of times, or of a counter's ticks. */
bool eo_text_is_called_time(const struct eo_text_format *format, int cell);

/* Finds separator, decimal point, first row and cells; members of choice that are not 0 are taken as they are.
   head[size + 1]: the beginning of the file, ended by a byte 0; whole: the file ends there. Errors: EO_ERROR_INPUT: no
   table of numbers. */
enum eo_code eo_text_guess(struct eo_text_format *format, const char *head, size_t size, bool whole,
                           const struct eo_text_choice *choice, struct eo_error *error);

/* Fills names, units and what is stated of the sampling from the lines before the first row. */
void eo_text_read_header(struct eo_text_format *format, const char *head);

#endif
