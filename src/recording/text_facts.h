/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines before the first row of a text file and the facts in them. Internal to the text reader. */
#ifndef EASEOFF_RECORDING_TEXT_FACTS_H
#define EASEOFF_RECORDING_TEXT_FACTS_H

#include "recording/text_format.h"

#define EO_HEADER_LINES 512 /* that are looked at; the last ones */

/* A line of the header without the mark of a comment. */
struct eo_header_line {
  const char *start, *end;
};

struct eo_header {
  int lines;
  struct eo_header_line line[EO_HEADER_LINES]; /* those that hold anything, in their order */
};

/* Cells of a line up to the last that is not empty. */
int eo_header_cells(const struct eo_header_line *line, char separator);

void eo_header_split(struct eo_header *header, const struct eo_text_format *format, const char *head);

/* Fills clocks, tick and counts per turn of the format from lines such as "Sample rate: 4000 Hz", "Delta X;0,00025",
   "Encoder resolution: 18000 counts/rev", "Start time: 2024-03-05T08:59:59.5", from a value below its name, and from a
   line with a value for each column. names: index of the line of names, -1: none; the names of the format are set. */
void eo_header_facts(const struct eo_header *header, struct eo_text_format *format, int names);

/* Takes the rate that a line between the rows or behind them states, to all columns: where the heading states none it
   is theirs, else it stands beside what was stated. scratch: room for one column. */
void eo_header_late_fact(struct eo_text_format *format, struct eo_text_format *scratch, const char *start,
                         const char *end);

#endif
