/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several files that belong together: composed in memory, written under temporary names, then renamed, so that a folder
   holds all of them or none of them anew. */
#ifndef EASEOFF_FORMAT_FILE_SET_H
#define EASEOFF_FORMAT_FILE_SET_H

#include "format/text.h"

struct eo_file_set {
  int count, capacity;
  struct eo_file_set_file {
    char *name;
    struct eo_text text;
  } * file;    /* owned */
  bool failed; /* an allocation failed: nothing will be saved */
};

/* Start from {0}. The text of a new file, valid until the next one is added; NULL without memory. */
struct eo_text *eo_file_set_add(struct eo_file_set *bundle, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void eo_file_set_done(struct eo_file_set *bundle);

/* Makes the directory if it is missing (its parent must exist). Files of the same names are replaced, others stay.
   Errors: EO_ERROR_FILE, memory; then no file is new and a directory that was made is gone again. */
enum eo_code eo_file_set_save(const struct eo_file_set *bundle, const char *directory, struct eo_error *error);

#endif
