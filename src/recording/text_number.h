/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers in the heading of a text file, and the units behind them. Internal to the text reader. */
#ifndef EASEOFF_RECORDING_TEXT_NUMBER_H
#define EASEOFF_RECORDING_TEXT_NUMBER_H

#include "recording/text_format.h"

struct eo_header_number {
  const char *from, *at, *after, *behind; /* where its key and itself begin, where itself and its unit end */
  double value;
  char unit[32];
};

/* Reads a number of the header, "2^23" and "9 000 000" among them; returns the place after it, NULL: there is none. A
   comma with digits behind it is a decimal comma wherever commas part no cells or nothing else makes sense of
   "0,00025"; before groups of three of a file with decimal points it marks thousands. in_one_cell: its key stands in
   the same cell, as that of "rate: 5,000", so that no comma parts it from the next. */
const char *eo_header_number_at(const struct eo_text_format *format, const char *p, const char *end, bool in_one_cell,
                                double *value);

/* The word behind a number: "kHz", "counts/rev", "counts per rev", "bit" of "23-bit". Another number is none, but that
   of another cell. Returns the place after it. */
const char *eo_header_unit(const char *number, const char *end, char *unit, size_t size);

/* Bytes of what multiplies the number behind it ("x" of "x4"); 0: no such mark is there. */
size_t eo_header_times(const char *p, const char *end);

/* True when nothing but one mark or word of a list stands between two numbers: "512, 2048", "512 and 2048". */
bool eo_header_list_gap(const char *from, const char *to);

/* What stands between two places, without blanks and marks around it. */
void eo_header_trim(char *to, size_t size, const char *from, const char *end);

#endif
