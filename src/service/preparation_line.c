/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "service/preparation_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void eo_preparation_line_write(const struct eo_preparation_line *line, char *text, size_t size)
{
  switch (line->kind) {
  case EO_PREPARATION_PROGRESS:
    snprintf(text, size, "progress %.4f %s\n", line->fraction, line->what);
    break;
  case EO_PREPARATION_DONE:
    snprintf(text, size, "done\n");
    break;
  case EO_PREPARATION_FAILED:
    snprintf(text, size, "failed %d %s\t%s\n", (int)line->error.code, line->error.pointer, line->error.text);
    break;
  }
}

static bool read_progress(const char *text, struct eo_preparation_line *line)
{
  char *end;
  line->kind = EO_PREPARATION_PROGRESS;
  line->fraction = strtod(text, &end);
  if (end == text || *end != ' ' || !(line->fraction >= 0 && line->fraction <= 1))
    return false;
  snprintf(line->what, sizeof line->what, "%s", end + 1);
  return true;
}

static bool read_failed(const char *text, struct eo_preparation_line *line)
{
  char *end;
  long code = strtol(text, &end, 10);
  const char *tab = strchr(end, '\t');
  if (*end != ' ' || !tab || code <= EO_OK || code > EO_ERROR_LAST)
    return false;
  line->kind = EO_PREPARATION_FAILED;
  line->error.code = (enum eo_code)code;
  snprintf(line->error.pointer, sizeof line->error.pointer, "%.*s", (int)(tab - end - 1), end + 1);
  snprintf(line->error.text, sizeof line->error.text, "%s", tab + 1);
  return true;
}

bool eo_preparation_line_read(const char *text, struct eo_preparation_line *line)
{
  *line = (struct eo_preparation_line){.kind = EO_PREPARATION_DONE};
  if (strncmp(text, "progress ", 9) == 0)
    return read_progress(text + 9, line);
  if (strncmp(text, "failed ", 7) == 0)
    return read_failed(text + 7, line);
  return strcmp(text, "done") == 0;
}
