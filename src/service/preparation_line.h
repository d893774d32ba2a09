/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a process that prepares a pair says, one line each: "progress 0.25 pinion: factorisation", "done", "failed CODE
   POINTER<tab>TEXT". Written by app/command_prepare.c, read by preparation.c. */
#ifndef EASEOFF_SERVICE_PREPARATION_LINE_H
#define EASEOFF_SERVICE_PREPARATION_LINE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

enum eo_preparation_line_kind { EO_PREPARATION_PROGRESS, EO_PREPARATION_DONE, EO_PREPARATION_FAILED };

struct eo_preparation_line {
  enum eo_preparation_line_kind kind;
  double fraction;
  char what[80];
  struct eo_error error;
};

/* With its newline. */
void eo_preparation_line_write(const struct eo_preparation_line *line, char *text, size_t size);

/* Without one; false: it is none of these. */
bool eo_preparation_line_read(const char *text, struct eo_preparation_line *line);

#endif
