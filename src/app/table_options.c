/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/table_options.h"

#include <stdio.h>
#include <string.h>

#include "format/json.h"
#include "http/header_field.h"

static void name_option(const char *key, char name[EO_TABLE_OPTION_NAME])
{
  snprintf(name, EO_TABLE_OPTION_NAME, "--%s", key);
  for (char *c = name; *c; c++)
    *c = *c == '_' ? '-' : *c;
}

void eo_table_options_add_own(struct eo_table_options *options, struct eo_option option)
{
  if (options->options < EO_TABLE_OPTIONS)
    options->option[options->options++] = option;
}

static void add_key(struct eo_table_options *options, const struct eo_field *field, const char *group)
{
  int n = options->count++;
  bool bare = field->kind == EO_FIELD_FLAG && options->bare_flags;
  options->key[n].field = field;
  options->key[n].group = group;
  name_option(field->key, options->key[n].name);
  eo_table_options_add_own(options, (struct eo_option){.name = options->key[n].name,
                                                       .flag = bare ? &options->key[n].flag : NULL,
                                                       .value = bare ? NULL : &options->key[n].value});
}

static void add_group(struct eo_table_options *options, const struct eo_table *table, const char *group)
{
  for (int i = 0; i < table->count && options->count < EO_TABLE_OPTIONS; i++)
    if (table->field[i].kind == EO_FIELD_OBJECT)
      add_group(options, table->field[i].table, table->field[i].key);
    else
      add_key(options, &table->field[i], group);
}

void eo_table_options_add(struct eo_table_options *options, const struct eo_table *table)
{
  options->table = table;
  add_group(options, table, NULL);
}

const char **eo_table_options_text(struct eo_table_options *options, const char *key)
{
  int n = 0;
  while (strcmp(options->key[n].field->key, key) != 0)
    n++;
  return &options->key[n].value;
}

bool eo_table_options_read(struct eo_table_options *options, const struct eo_command *command, int argc, char **argv,
                           int least, int most, const char **operand, int *operands, int *status)
{
  struct eo_text help = {0};
  struct eo_command described = *command;
  eo_text_print(&help, "%s\n", command->help);
  eo_table_describe(options->table, false, &help);
  if (!help.failed)
    described.help = help.data;
  bool more = eo_app_arguments(&described, argc, argv, options->option, least, most, operand, operands, status);
  eo_text_done(&help);
  return more;
}

/* As the document would say it; NULL with *error filled. */
static json_t *read_value(const struct eo_field *field, const char *name, const char *text, struct eo_error *error)
{
  double number;
  bool numeric = field->kind == EO_FIELD_NUMBER || field->kind == EO_FIELD_INTEGER || field->kind == EO_FIELD_SEED;
  if (field->kind == EO_FIELD_DOCUMENT)
    return *text == '{' ? eo_json_parse(text, strlen(text), error) : eo_json_load(text, EO_JSON_DESIGN_BYTES, error);
  if (field->kind == EO_FIELD_FLAG && (strcmp(text, "yes") == 0 || strcmp(text, "no") == 0))
    return json_boolean(*text == 'y');
  json_t *value = numeric && eo_field_real(text, &number) ? eo_json_whole(number) : json_string(text);
  if (!value)
    eo_error_set(error, EO_ERROR_INPUT, "", "%s takes text in UTF-8.", name);
  return value;
}

/* The object that holds a key of the group, made where it is missing. */
static json_t *find_group(json_t *document, const char *group)
{
  json_t *object = group ? json_object_get(document, group) : document;
  if (!json_is_object(object) && !json_object_set_new(document, group, json_object()))
    object = json_object_get(document, group);
  return object;
}

enum eo_code eo_table_options_put(const struct eo_table_options *options, json_t *document, struct eo_error *error)
{
  for (int i = 0; i < options->count; i++) {
    if (!options->key[i].value && !options->key[i].flag)
      continue;
    const struct eo_field *field = options->key[i].field;
    json_t *value = options->key[i].flag ? json_true()
                                         : read_value(field, options->key[i].name, options->key[i].value, error);
    if (!value)
      return error->code;
    if (json_object_set_new(find_group(document, options->key[i].group), field->key, value))
      return eo_error_memory(error);
  }
  return EO_OK;
}
