/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of a spreadsheet as lines of text, cells parted by tabs. Internal to the readers. */
#ifndef EASEOFF_RECORDING_SHEET_TEXT_H
#define EASEOFF_RECORDING_SHEET_TEXT_H

#include <stdio.h>

#define EO_SHEET_COLUMNS 512 /* cells of a row beyond these are left out */

struct eo_sheet_text {
  FILE *file;
  int written; /* tabs of the current row so far */
};

/* Cells of a row come in the order of their columns, from 0; those left out are empty. Tabs and line ends in a text
   become blanks. */
void eo_sheet_text_cell(struct eo_sheet_text *sheet, int column, const char *text);
/* Days since 1970 as "2024-03-05T08:59:59.5000000". */
void eo_sheet_text_moment(struct eo_sheet_text *sheet, int column, double days);
/* A part of a day as "08:59:59.5000000". */
void eo_sheet_text_time(struct eo_sheet_text *sheet, int column, double days);
void eo_sheet_text_row(struct eo_sheet_text *sheet); /* ends the row */

#endif
