/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/serve_settings.h"

#include <stdlib.h>
#include <string.h>

#include "format/json.h"
#include "http/header_field.h"

static const struct eo_field server_fields[] = {
    EO_TEXT(struct eo_serve_settings, listen, "listen", "address and port; 127.0.0.1:8080 without; port 0: a free one"),
    EO_TEXT(struct eo_serve_settings, data, "data", "folder of the database and the recordings"),
    EO_TEXT(struct eo_serve_settings, token_file, "token_file", "file whose first line is the token"),
    EO_TEXT(struct eo_serve_settings, host, "host",
            "name under which clients call the server, beside localhost and plain addresses; any with a token"),
    EO_TEXT(struct eo_serve_settings, web, "web", "folder of the page's files"),
    EO_TEXT(struct eo_serve_settings, launcher, "launcher",
            "command that runs optimizations and studies, \"mpirun -n 64 --hostfile hosts\"; without one this process "
            "does"),
    EO_INTEGER_DERIVED(struct eo_serve_settings, threads, "threads", 1, 256, "as many as there are processors",
                       "of an optimization or a sweep"),
    EO_FLAG(struct eo_serve_settings, allow_anyone, "allow_anyone", 0,
            "without a token at an address that others reach"),
    EO_FLAG(struct eo_serve_settings, quiet, "quiet", 0, "errors alone in the log"),
    EO_OBJECT(struct eo_serve_settings, limits, "requests", &eo_http_limits_table, "what clients may do"),
    EO_OBJECT(struct eo_serve_settings, work, "work", &eo_service_limits_table, "what jobs may take and what is kept"),
};
static const struct eo_table server_table = EO_TABLE("the configuration of a server", struct eo_serve_settings,
                                                     server_fields);

enum { MOST_OPTIONS = 80, LONGEST_OPTION = 60 };

/* An option for every key of the tables. */
struct option_set {
  int count;
  struct eo_option option[MOST_OPTIONS + 1];
  char name[MOST_OPTIONS][LONGEST_OPTION];
  const char *value[MOST_OPTIONS];
  bool flag[MOST_OPTIONS];
  const struct eo_field *field[MOST_OPTIONS];
  const char *group[MOST_OPTIONS]; /* NULL: the top */
  const char *config;
};

/* "queued_jobs" is --queued-jobs; units keep their letters. */
static void name_option(const char *key, char *name)
{
  int length = snprintf(name, LONGEST_OPTION, "--%s", key);
  for (int i = 0; i < length && i < LONGEST_OPTION; i++)
    if (name[i] == '_')
      name[i] = '-';
}

static void add_options(struct option_set *set, const struct eo_table *table, const char *group)
{
  for (int i = 0; i < table->count && set->count < MOST_OPTIONS; i++) {
    const struct eo_field *field = &table->field[i];
    if (field->kind == EO_FIELD_OBJECT) {
      add_options(set, field->table, field->key);
      continue;
    }
    int n = set->count++;
    name_option(field->key, set->name[n]);
    set->field[n] = field;
    set->group[n] = group;
    set->option[n] = (struct eo_option){.name = set->name[n]};
    if (field->kind == EO_FIELD_FLAG)
      set->option[n].flag = &set->flag[n];
    else
      set->option[n].value = &set->value[n];
  }
}

/* What an option says, as the file would say it: numbers are numbers, all else is a text that the table judges. */
static json_t *encode_option(const struct option_set *set, int n)
{
  double number;
  enum eo_field_kind kind = set->field[n]->kind;
  if (kind == EO_FIELD_FLAG)
    return set->flag[n] ? json_true() : NULL;
  if (!set->value[n])
    return NULL;
  bool numeric = kind == EO_FIELD_NUMBER || kind == EO_FIELD_INTEGER;
  return numeric && eo_field_real(set->value[n], &number) ? json_real(number) : json_string(set->value[n]);
}

/* Puts the options into what the file said. */
static bool put_options(const struct option_set *set, json_t *document)
{
  for (int n = 0; n < set->count; n++) {
    json_t *value = encode_option(set, n), *group = document;
    if (!value)
      continue;
    if (set->group[n] && !json_is_object(group = json_object_get(document, set->group[n]))) {
      group = json_object();
      if (json_object_set_new(document, set->group[n], group))
        return json_decref(value), false;
    }
    if (json_object_set_new(group, set->field[n]->key, value))
      return false;
  }
  return true;
}

static int tell(const struct option_set *set, const struct eo_faults *faults)
{
  return eo_app_fail_all(set->config ? set->config : "serve", faults);
}

static int decode(const struct option_set *set, struct eo_serve_settings *settings)
{
  struct eo_error error;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  json_t *document = set->config ? eo_json_load(set->config, EO_JSON_DESIGN_BYTES, &error) : json_object();
  int status = EO_EXIT_DONE;
  if (!document && set->config)
    status = eo_app_fail(set->config, &error);
  else if (!faults || !document || !put_options(set, document))
    status = eo_app_fail_memory();
  else {
    eo_table_decode(&server_table, document, NULL, settings, faults);
    if (faults->count)
      status = tell(set, faults);
  }
  json_decref(document);
  free(faults);
  return status;
}

static void describe(struct eo_text *text)
{
  eo_text_add(text, "\nKeys of --config FILE (JSON); each is an option too, with dashes in the place of underscores: "
                    "\"queued_jobs\" is --queued-jobs N.\n\n");
  eo_table_describe(&server_table, false, text);
}

bool eo_serve_settings_read(const struct eo_command *command, int argc, char **argv, struct eo_serve_settings *settings,
                            int *status)
{
  struct option_set *set = calloc(1, sizeof *set);
  const char *none;
  int operands;
  if (!set) {
    *status = eo_app_fail_memory();
    return false;
  }
  struct eo_text help = {0};
  struct eo_command described = *command;
  eo_text_add(&help, command->help);
  describe(&help);
  described.help = help.failed ? command->help : help.data;
  add_options(set, &server_table, NULL);
  set->option[set->count] = (struct eo_option){.name = "--config", .value = &set->config};
  bool good = eo_app_arguments(&described, argc, argv, set->option, 0, 0, &none, &operands, status) &&
              (*status = decode(set, settings)) == EO_EXIT_DONE;
  eo_text_done(&help);
  free(set);
  return good;
}
