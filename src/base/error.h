/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors: filled once, at the lowest place that knows what went wrong, and handed up unchanged. */
#ifndef EASEOFF_BASE_ERROR_H
#define EASEOFF_BASE_ERROR_H

/* The program exits 1 on EO_ERROR_INPUT and 2 on every other error. */
enum eo_code {
  EO_OK = 0,
  EO_ERROR_INPUT,     /* the input is wrong; the pointer names the key */
  EO_ERROR_MEMORY,    /* an allocation failed */
  EO_ERROR_FILE,      /* reading or writing a file failed */
  EO_ERROR_NUMERIC,   /* a solver failed where the model says it cannot */
  EO_ERROR_CANCELLED, /* the caller asked to stop */
  EO_ERROR_FULL,      /* there is no room on the disk: what is deleted makes some */
  EO_ERROR_BUSY,      /* somebody else holds what is needed: the same may go well a moment later */
  EO_ERROR_DAMAGED,   /* what was stored is not what was written */
  EO_ERROR_LAST = EO_ERROR_DAMAGED,
};

struct eo_error {
  enum eo_code code;
  char pointer[160]; /* JSON pointer (RFC 6901) of the key at fault, "" when none */
  char text[400];    /* one full sentence, no newline */
};

/* Fills *error and returns code, so that a caller can write `return eo_error_set(...)`. error may be NULL. */
enum eo_code eo_error_set(struct eo_error *error, enum eo_code code, const char *pointer, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Shorthand for an allocation that failed. */
enum eo_code eo_error_memory(struct eo_error *error);

/* Returns the code of a call that failed; only where nothing is held that would have to be released. */
#define EO_TRY(call)                   \
  do {                                 \
    enum eo_code eo_try_code = (call); \
    if (eo_try_code)                   \
      return eo_try_code;              \
  } while (0)

#endif
