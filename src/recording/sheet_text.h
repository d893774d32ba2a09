/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sheets of a spreadsheet as lines of text, cells parted by tabs: what small ones state, then the largest table, or
   several. A reader hands over all sheets once for each pass, in the same order; which of them are written is settled
   here. Internal to the readers. */
#ifndef EASEOFF_RECORDING_SHEET_TEXT_H
#define EASEOFF_RECORDING_SHEET_TEXT_H

#include "recording/zip_files.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#define EO_SHEETS 256        /* that are told apart; those beyond are left out */
#define EO_SHEET_COLUMNS 512 /* cells of a row beyond these are left out */
#define EO_SHEET_NAME 96

enum eo_sheet_pass {
  EO_SHEET_COUNT, /* nothing is written */
  EO_SHEET_FACTS,
  EO_SHEET_TABLES
};

struct eo_sheet {
  char name[EO_SHEET_NAME];
  int64_t cells;          /* that hold something */
  int64_t commas, points; /* texts that are numbers with a decimal comma, with a point */
  int64_t empty, zero;    /* formulas without a value, of the value 0, */
  int64_t formulas;       /* and in all */
  bool facts;             /* small: what it states holds for the tables */
};

struct eo_sheet_text {
  FILE *file, *line; /* line: memory, for the row that is being written */
  char *row;
  size_t length;
  int64_t bytes, most; /* that were written, that may be */
  bool several;        /* tables that are nearly as large as the largest are written, too, each below its name */
  bool recalculated;   /* the book asks to be computed when it is opened: values 0 may stand for none */
  /* of all sheets */
  enum eo_sheet_pass pass;
  struct eo_sheet sheet[EO_SHEETS];
  int sheets, best, tables, facts;
  bool comma; /* numbers are written with a decimal comma, as their neighbours that are texts have it */
  /* of the current one */
  int current;
  bool writing;
  int written, widest; /* tabs of the current row so far; of the widest row of its table */
  int numbers, texts;  /* cells of the row */
  bool names;          /* the row before is of texts without a gap, */
  bool heading;        /* or of texts at all */
};

/* Visits the archive once for each pass that has something to do; visit hands over the sheets that it finds. Notes of
   what they lack go to those of the archive. Errors: those of visit; EO_ERROR_INPUT: no sheet holds anything. */
enum eo_code eo_sheet_text_write(struct eo_sheet_text *text, struct eo_archive *archive,
                                 bool (*visit)(void *context, struct eo_archive *archive, const char *name),
                                 void *context);

/* The next sheet; false when its cells are of no use in this pass. */
bool eo_sheet_text_next(struct eo_sheet_text *text, const char *name);

/* Cells of a row come in the order of their columns, from 0; those left out are empty. Tabs and line ends in a text
   become blanks. A number has a decimal point. */
void eo_sheet_text_cell(struct eo_sheet_text *text, int column, const char *cell);
void eo_sheet_text_number(struct eo_sheet_text *text, int column, const char *number);
/* Days since 1970 as "2024-03-05T08:59:59.5000000". */
void eo_sheet_text_moment(struct eo_sheet_text *text, int column, double days);
/* A part of a day as "08:59:59.5000000". */
void eo_sheet_text_time(struct eo_sheet_text *text, int column, double days);
/* A formula, beside the value that is stored with it; "": none. */
void eo_sheet_text_formula(struct eo_sheet_text *text, const char *value);

/* Ends the row. Spreadsheets do not store the empty cells at the end of a row: rows of numbers are filled up to the
   names above them and to the widest row of their table so far. times: of rows that follow each other with the same
   cells an OpenDocument spreadsheet may store one. */
void eo_sheet_text_row(struct eo_sheet_text *text, int64_t times);

/* Name of the largest sheet; "" when none holds anything. */
const char *eo_sheet_text_name(const struct eo_sheet_text *text);

#endif
