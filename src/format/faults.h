/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything that is wrong with an input, not only the first thing. */
#ifndef EASEOFF_FORMAT_FAULTS_H
#define EASEOFF_FORMAT_FAULTS_H

#include "base/error.h"

enum { EO_MAX_FAULTS = 100 };

struct eo_faults {
  int count;                            /* all that were found; only the first EO_MAX_FAULTS are kept */
  struct eo_error fault[EO_MAX_FAULTS]; /* in the order of the document */
};

/* Start from count = 0. pointer: JSON pointer, "" for the document as a whole. The text is cleaned for one line. */
void eo_faults_add(struct eo_faults *faults, const char *pointer, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* There was no memory to look at all: that is the first fault then, and no fault of the input. */
void eo_faults_memory(struct eo_faults *faults);

/* EO_OK without faults; else copies the first into *error and returns its code. */
enum eo_code eo_faults_first(const struct eo_faults *faults, struct eo_error *error);

/* Where a value stands in the document: a chain on the stack from the innermost value outwards. */
struct eo_path {
  const struct eo_path *up; /* NULL at the top */
  const char *key;          /* NULL: a list element */
  int index;
};

/* RFC 6901; shortened at the end when it does not fit. */
void eo_path_pointer(const struct eo_path *path, char *pointer, int size);

/* The same with the fault's place given as a path. */
void eo_faults_at(struct eo_faults *faults, const struct eo_path *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
