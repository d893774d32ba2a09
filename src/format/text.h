/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A text that grows, and its way to a file: everything is composed first and written in one go, so that no reader ever
   finds half of it. */
#ifndef EASEOFF_FORMAT_TEXT_H
#define EASEOFF_FORMAT_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/error.h"

struct eo_text {
  char *data;  /* owned, ends with NUL; NULL while empty */
  size_t size; /* bytes without the NUL */
  size_t capacity;
  bool failed; /* an allocation failed: the text is incomplete and the writers below refuse it */
};

/* Start from {0}. Adding never fails visibly: check `failed` at the end (the writers do). */
void eo_text_add(struct eo_text *text, const char *string);
void eo_text_add_bytes(struct eo_text *text, const void *data, size_t size);
/* Where `more` bytes and a NUL may be written, to be counted in size by who writes them; NULL: failed. */
char *eo_text_room(struct eo_text *text, size_t more);
/* As content or attribute of XML and HTML: the characters they keep for themselves as entities, control characters but
   tab and line feed as blanks. */
void eo_text_add_escaped(struct eo_text *text, const char *string);
void eo_text_print(struct eo_text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void eo_text_done(struct eo_text *text);

/* Reads a whole file ("-": standard input) of at most limit bytes. EO_ERROR_INPUT when it cannot be read or is larger.
 */
enum eo_code eo_text_read(struct eo_text *text, const char *path, size_t limit, struct eo_error *error);

/* Writes everything and flushes; EO_ERROR_FILE when the stream took less (full disk, closed pipe). */
enum eo_code eo_text_write(const struct eo_text *text, FILE *stream, const char *name, struct eo_error *error);

/* Replaces the file at path: written beside it under a temporary name, flushed to the disk, renamed; the old file stays
   when anything fails. */
enum eo_code eo_text_save(const struct eo_text *text, const char *path, struct eo_error *error);

/* Copies at most size - 1 bytes of a string for people: control characters and bytes that are no UTF-8 become '?', no
   character is cut in two, and a shortened string ends with "...". size >= 8. */
void eo_text_clean(char *target, size_t size, const char *source);

#endif
