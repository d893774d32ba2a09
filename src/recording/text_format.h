/* How a text file is laid out, found from its first lines. Internal to the text reader. */
#ifndef EASEOFF_RECORDING_TEXT_FORMAT_H
#define EASEOFF_RECORDING_TEXT_FORMAT_H

#include "base/error.h"
#include "recording/reader.h"

#include <stdbool.h>

#define EO_TEXT_HEAD ((size_t)256 << 10) /* bytes from which the layout is found */
#define EO_TEXT_CELLS 512                /* cells of a row at most */

struct eo_text_format {
  char separator, point, line_end;
  int cells;                                   /* of a row */
  int columns;                                 /* cells that hold numbers */
  bool number[EO_TEXT_CELLS];                  /* [cells] */
  int64_t first_line;                          /* of the first row, from 1 */
  size_t first_byte;                           /* of the first row, in the text */
  size_t header_byte;                          /* where the header starts: behind a byte order mark */
  double interval;                             /* s, from a sampling rate in the header; 0: not stated */
  char name[EO_TEXT_CELLS][EO_RECORDING_NAME]; /* [cells] */
  char unit[EO_TEXT_CELLS][EO_RECORDING_UNIT]; /* [cells] */
};

/* Finds separator, decimal point, first row and cells; members of choice that are not 0 are taken as they are.
   head[size + 1]: the beginning of the file, ended by a byte 0; whole: the file ends there. Errors: EO_ERROR_INPUT: no
   table of numbers. */
enum eo_code eo_text_guess(struct eo_text_format *format, const char *head, size_t size, bool whole,
                           const struct eo_text_choice *choice, struct eo_error *error);

/* Fills names, units and interval from the lines before the first row. */
void eo_text_read_header(struct eo_text_format *format, const char *head);

#endif
