/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Data sets 58 and 58b of universal files: functions at nodal degrees of freedom, as text or binary.
   Source: Structural Dynamics Research Laboratory, University of Cincinnati, "Universal File Datasets 58 and 58b".
   Internal to the reader. */
#ifndef EASEOFF_RECORDING_UFF_H
#define EASEOFF_RECORDING_UFF_H

#include "recording/bytes.h"
#include "recording/series.h"

#define EO_UFF_LINE 1024 /* bytes of a line at most; the format has 80 */

/* Lines of a file one after the other, with their place. */
struct eo_uff_lines {
  int file;
  int64_t size;
  int64_t number; /* of the last line, from 1; binary data count as no line */
  int64_t at;     /* byte of the file where the next line begins */
  size_t filled;  /* bytes in buffer, which begins at `at - used` */
  size_t used;
  size_t length;              /* of the last line, without its end */
  char line[EO_UFF_LINE + 1]; /* the last line, ended with 0 */
  char buffer[1 << 16];
};

/* False at the end of the file or on an error, which is then set. */
bool eo_uff_next(struct eo_uff_lines *lines, struct eo_error *error, enum eo_code *code);
void eo_uff_seek(struct eo_uff_lines *lines, int64_t at);
bool eo_uff_is_end(const struct eo_uff_lines *lines); /* the line is "    -1" */

/* What the eleven lines at the beginning of a data set say. */
struct eo_uff_header {
  int64_t line; /* of its first line */
  char title[81];
  int function; /* 1: time response */
  int node, direction;
  int type;                 /* of the ordinate: 2 real single, 4 real double, 5 and 6 complex */
  int64_t count;            /* of values */
  bool even;                /* abscissa */
  double start, increment;  /* of an even one */
  int abscissa;             /* 17: time, 18: frequency */
  char time_unit[21];       /* of the abscissa, "" when it is not stated */
  double time_scale;        /* s per unit of the abscissa */
  char label[21], unit[21]; /* of the ordinate's axis */
  bool binary, big;
  int64_t bytes; /* of binary data */
};

/* Reads what follows the line "    58"; the next line is then that of the data. */
enum eo_code eo_uff_read_header(struct eo_uff_lines *lines, struct eo_uff_header *header, struct eo_error *error);

#endif
