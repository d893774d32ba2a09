/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/app.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/inch.h"
#include "format/inch_sentence.h"
#include "format/json.h"

#include <config.h>

const char eo_program[] = PACKAGE_STRING;

static int wrong_usage(const struct eo_command *command, const char *what, const char *argument)
{
  char shown[80];
  eo_text_clean(shown, sizeof shown, argument);
  fprintf(stderr, "easeoff %s: %s%s; usage: easeoff %s %s\n", command->name, what, shown, command->name,
          command->usage);
  return EO_EXIT_INPUT;
}

static int print_help(const struct eo_command *command)
{
  struct eo_text text = {0};
  eo_text_print(&text, "usage: easeoff %s %s\n\n%s.\n", command->name, command->usage, command->summary);
  if (command->help)
    eo_text_print(&text, "\n%s", command->help);
  return eo_app_print(&text);
}

/* The option at argv[*i], consuming its value; NULL when it is none of the list or lacks its value. */
static const struct eo_option *take_option(const struct eo_option *options, int argc, char **argv, int *i)
{
  size_t length = strcspn(argv[*i], "=");
  for (const struct eo_option *option = options; option && option->name; option++) {
    if (strlen(option->name) != length || strncmp(option->name, argv[*i], length) != 0)
      continue;
    bool joined = argv[*i][length] == '=';
    if (option->flag ? joined : !joined && *i + 1 >= argc)
      return NULL;
    if (option->flag)
      *option->flag = true;
    else {
      const char *value = joined ? argv[*i] + length + 1 : argv[++*i];
      if (option->value)
        *option->value = value;
      else if (option->list->count++ < EO_OPTION_MOST)
        option->list->value[option->list->count - 1] = value;
    }
    return option;
  }
  return NULL;
}

bool eo_app_arguments(const struct eo_command *command, int argc, char **argv, const struct eo_option *options,
                      int least, int most, const char **operand, int *operands, int *status)
{
  bool only_operands = false;
  *operands = 0;
  for (int i = 1; i < argc; i++) {
    bool is_option = !only_operands && argv[i][0] == '-' && argv[i][1];
    if (is_option && strcmp(argv[i], "--") == 0)
      only_operands = true;
    else if (is_option && strcmp(argv[i], "--help") == 0) {
      *status = print_help(command);
      return false;
    } else if (is_option && !take_option(options, argc, argv, &i)) {
      *status = wrong_usage(command, "unknown or incomplete option ", argv[i]);
      return false;
    } else if (!is_option && *operands == most) {
      *status = wrong_usage(command, "one argument too many: ", argv[i]);
      return false;
    } else if (!is_option)
      operand[(*operands)++] = argv[i];
  }
  if (*operands >= least)
    return true;
  *status = wrong_usage(command, "an argument is missing", "");
  return false;
}

/* What one program tells one reader; the only state of a command that is not its own. */
static bool in_inches;

int eo_app_fail(const char *file, const struct eo_error *error)
{
  char shown[120] = "";
  struct eo_error told = *error;
  if (in_inches)
    eo_inch_error(&told);
  if (file)
    eo_text_clean(shown, sizeof shown, strcmp(file, "-") == 0 ? "standard input" : file);
  fprintf(stderr, "easeoff: %s%s%s%s%s\n", shown, file ? ": " : "", told.pointer, *told.pointer ? ": " : "", told.text);
  return error->code == EO_ERROR_INPUT ? EO_EXIT_INPUT : EO_EXIT_FAILED;
}

int eo_app_fail_memory(void)
{
  struct eo_error error;
  eo_error_memory(&error);
  return eo_app_fail(NULL, &error);
}

void *eo_app_request(size_t size, int *status)
{
  void *request = calloc(1, size);
  if (!request) {
    *status = eo_app_fail_memory();
  }
  return request;
}

int eo_app_fail_all(const char *file, const struct eo_faults *faults)
{
  int shown = faults->count < EO_MAX_FAULTS ? faults->count : EO_MAX_FAULTS;
  if (faults->fault[0].code == EO_ERROR_MEMORY)
    return eo_app_fail(file, &faults->fault[0]);
  for (int i = 0; i < shown; i++)
    eo_app_fail(file, &faults->fault[i]);
  if (shown < faults->count)
    fprintf(stderr, "easeoff: and %d faults more.\n", faults->count - shown);
  return EO_EXIT_INPUT;
}

int eo_app_print(struct eo_text *text)
{
  struct eo_error error;
  int status = EO_EXIT_DONE;
  if (eo_text_write(text, stdout, "Standard output", &error))
    status = eo_app_fail(NULL, &error);
  eo_text_done(text);
  return status;
}

int eo_app_print_unless(enum eo_code code, struct eo_text *text, const struct eo_error *error)
{
  if (!code)
    return eo_app_print(text);
  eo_text_done(text);
  return eo_app_fail(NULL, error);
}

int eo_app_print_json(json_t *document, bool compact)
{
  struct eo_text text = {0};
  if (!document) {
    return eo_app_fail_memory();
  }
  eo_json_write(&text, document, compact ? EO_JSON_COMPACT : EO_JSON_PRETTY);
  if (compact)
    eo_text_add(&text, "\n");
  json_decref(document);
  return eo_app_print(&text);
}

int eo_app_show(json_t *document, bool json, void (*sum_up)(const json_t *document, struct eo_text *text))
{
  struct eo_text text = {0};
  if (json || !document)
    return eo_app_print_json(document, false);
  sum_up(document, &text);
  json_decref(document);
  return eo_app_print(&text);
}

bool eo_app_load_stated(const char *path, json_t **stated, struct eo_design *design, struct eo_geometry *geometry,
                        struct eo_warnings *warnings, int *status)
{
  struct eo_error error;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *document = NULL;
  *status = EO_EXIT_DONE;
  if (!faults) {
    *status = eo_app_fail_memory();
    goto out;
  }
  document = eo_json_load(path, EO_JSON_DESIGN_BYTES, &error);
  if (!document)
    *status = eo_app_fail(path, &error);
  else if (!eo_design_decode(document, design, warnings, faults))
    *status = eo_app_fail_all(path, faults);
  else if (eo_design_complete(design, geometry, &error)) {
    eo_inch_place(document, &error);
    *status = eo_app_fail(path, &error);
  } else if (warnings)
    eo_design_note_findings(design, geometry, warnings);
out:
  free(faults);
  *stated = document;
  return *status == EO_EXIT_DONE;
}

bool eo_app_load_design(const char *path, struct eo_design *design, struct eo_geometry *geometry,
                        struct eo_warnings *warnings, int *status)
{
  json_t *stated;
  bool good = eo_app_load_stated(path, &stated, design, geometry, warnings, status);
  json_decref(stated);
  return good;
}

bool eo_app_design_or_job(const struct eo_command *command, bool by_number, int operands, int *status)
{
  if (by_number == !operands)
    return true;
  fprintf(stderr, "easeoff %s: %s; usage: easeoff %s %s\n", command->name,
          operands ? "a job is named by its number, no design is needed" : "an argument is missing", command->name,
          command->usage);
  *status = EO_EXIT_INPUT;
  return false;
}

bool eo_app_units(const char *word, bool *inches, int *status)
{
  struct eo_error error;
  *inches = in_inches = word && strcmp(word, "inch") == 0;
  if (!word || *inches || strcmp(word, "mm") == 0)
    return true;
  eo_error_set(&error, EO_ERROR_INPUT, "", "--units takes mm or inch, not \"%.40s\".", word);
  *status = eo_app_fail(NULL, &error);
  return false;
}
