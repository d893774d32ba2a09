/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keys of a field table as options of a command: "queued_jobs" is --queued-jobs N; units keep their letters. What
   an option says is put into a document, which the table decodes: ranges, units and defaults stand there alone. */
#ifndef EASEOFF_APP_TABLE_OPTIONS_H
#define EASEOFF_APP_TABLE_OPTIONS_H

#include "app/app.h"
#include "format/table.h"

enum { EO_TABLE_OPTIONS = 100, EO_TABLE_OPTION_NAME = 60 };

struct eo_table_options {
  const struct eo_table *table;
  int count;       /* options of keys */
  bool bare_flags; /* --quiet alone says true; else --wrapped yes|no */
  struct {
    const struct eo_field *field;
    const char *group; /* key of the object that holds the field; NULL: the top */
    char name[EO_TABLE_OPTION_NAME];
    const char *value; /* NULL: not said */
    bool flag;
  } key[EO_TABLE_OPTIONS];
  struct eo_option option[EO_TABLE_OPTIONS + 1]; /* of keys and the command's own; ends with a name NULL */
  int options;
};

/* Zero *options first and set bare_flags; it stays where it is. An option that was added first goes before a later one
   of the same name. */
void eo_table_options_add(struct eo_table_options *options, const struct eo_table *table);
void eo_table_options_add_own(struct eo_table_options *options, struct eo_option option);

/* Where the text of a key is kept, for a second name of its option. */
const char **eo_table_options_text(struct eo_table_options *options, const char *key);

/* eo_app_arguments() with these options; --help describes the keys below the command's own help. */
bool eo_table_options_read(struct eo_table_options *options, const struct eo_command *command, int argc, char **argv,
                           int least, int most, const char **operand, int *operands, int *status);

/* Puts what was said into the document, over what it says itself. A number is a number there, the JSON of an object is
   given in place or as a file, all else is text that the table judges. Errors: EO_ERROR_INPUT, of the file, memory. */
enum eo_code eo_table_options_put(const struct eo_table_options *options, json_t *document, struct eo_error *error);

#endif
