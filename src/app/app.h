/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program: sub-commands, their options, and how they end. Exit status 0: done; 1: the input is wrong; 2: it failed.
 */
#ifndef EASEOFF_APP_APP_H
#define EASEOFF_APP_APP_H

#include <stdbool.h>

#include <jansson.h>

#include "base/error.h"
#include "document/design_document.h"
#include "format/faults.h"
#include "format/text.h"

enum { EO_EXIT_DONE = 0, EO_EXIT_INPUT = 1, EO_EXIT_FAILED = 2 };

struct eo_command {
  const char *name;
  const char *usage;   /* operands and options, one line */
  const char *summary; /* one line */
  const char *help;    /* more for --help, ends with a newline; may be NULL */
  int (*run)(const struct eo_command *command, int argc,
             char **argv); /* argv[0]: the sub-command; returns the exit status */
};

extern const struct eo_command eo_command_analyze;
extern const struct eo_command eo_command_backup;
extern const struct eo_command eo_command_doctor;
extern const struct eo_command eo_command_design;
extern const struct eo_command eo_command_example;
extern const struct eo_command eo_command_export;
extern const struct eo_command eo_command_history;
extern const struct eo_command eo_command_import;
extern const struct eo_command eo_command_measure;
extern const struct eo_command eo_command_optimize;
extern const struct eo_command eo_command_prepare;
extern const struct eo_command eo_command_reproduce;
extern const struct eo_command eo_command_report;
extern const struct eo_command eo_command_restore;
extern const struct eo_command eo_command_rig;
extern const struct eo_command eo_command_serve;
extern const struct eo_command eo_command_stage;
extern const struct eo_command eo_command_study;
extern const struct eo_command eo_command_sweep;
extern const struct eo_command eo_command_tolerance;
extern const struct eo_command eo_command_verify;

/* "easeoff 0.1.0" */
extern const char eo_program[];

/* An option is a flag or takes a value ("--csv DIR" or "--csv=DIR"); --help is known to every command. */
struct eo_option {
  const char *name;            /* with its dashes; NULL ends the list */
  bool *flag;                  /* set to true, or */
  const char **value;          /* set to the argument, or */
  struct eo_option_list *list; /* each of its arguments is added */
};

enum { EO_OPTION_MOST = 64 };
struct eo_option_list {
  int count; /* beyond EO_OPTION_MOST they are counted alone */
  const char *value[EO_OPTION_MOST];
};

/* Sorts options from operands; operand[most] is filled and *operands counted. Returns true to go on; false when the
   command is over (help printed, or wrong usage told on standard error) with *status set. */
bool eo_app_arguments(const struct eo_command *command, int argc, char **argv, const struct eo_option *options,
                      int least, int most, const char **operand, int *operands, int *status);

/* Zeroed memory for what a command was asked; the caller's to free. NULL: told on standard error, *status set. */
void *eo_app_request(size_t size, int *status);

/* One line on standard error; returns the exit status that belongs to the error. file: NULL when no file is concerned.
 */
int eo_app_fail(const char *file, const struct eo_error *error);
int eo_app_fail_memory(void); /* an allocation failed */

/* One line per fault. */
int eo_app_fail_all(const char *file, const struct eo_faults *faults);

/* Prints to standard output in one go and frees the text. */
int eo_app_print(struct eo_text *text);
/* The same, or with a code the error in its place. */
int eo_app_print_unless(enum eo_code code, struct eo_text *text, const struct eo_error *error);

/* Prints a document and releases it; NULL: no memory. */
int eo_app_print_json(json_t *document, bool compact);

/* Prints a document, or what sums it up, and releases it; NULL: no memory. */
int eo_app_show(json_t *document, bool json, void (*sum_up)(const json_t *document, struct eo_text *text));

/* Reads, decodes and completes a design ("-": standard input), warnings collected. False with *status set and told. */
bool eo_app_load_design(const char *path, struct eo_design *design, struct eo_geometry *geometry,
                        struct eo_warnings *warnings, int *status);
/* The same; *stated: the document as it was stated, owned, NULL where there is none. */
bool eo_app_load_stated(const char *path, json_t **stated, struct eo_design *design, struct eo_geometry *geometry,
                        struct eo_warnings *warnings, int *status);

/* Of a command that takes a design or, by_number, the job that was ordered: false with *status set and told where both
   are given or none. */
bool eo_app_design_or_job(const struct eo_command *command, bool by_number, int operands, int *status);

/* --units mm|inch, before a design is read: what is told of it from then on, faults too, is told so. False with *status
   set and told for another word. */
bool eo_app_units(const char *word, bool *inches, int *status);

#endif
