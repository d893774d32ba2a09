/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recording/notes.h"

#include <stdarg.h>
#include <stdio.h>

void eo_notes_add(struct eo_notes *notes, const char *format, ...)
{
  if (!notes || notes->count == EO_NOTES)
    return;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(notes->text[notes->count++], EO_NOTE_LENGTH, format, arguments);
  va_end(arguments);
}
