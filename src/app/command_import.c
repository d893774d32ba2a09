/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/number.h"
#include "exchange/import.h"
#include "exchange/rexs_model.h"
#include "format/json.h"

static void tell_list(const char *title, const json_t *list)
{
  const json_t *entry;
  size_t i;
  json_array_foreach(list, i, entry) fprintf(stderr, "%s: %s\n", title, json_string_value(entry));
}

/* Attributes of one component, "A of C", on one line. */
static void tell_unused(const json_t *list)
{
  const char *open = NULL;
  const json_t *entry;
  size_t i;
  json_array_foreach(list, i, entry)
  {
    const char *text = json_string_value(entry), *of = strstr(text, " of ");
    bool same = open && of && strcmp(open, of) == 0;
    if (open && !same)
      fprintf(stderr, "%s\n", open);
    fprintf(stderr, "%s%.*s", same ? ", " : "not used: ", of ? (int)(of - text) : (int)strlen(text), text);
    open = of ? of : "";
  }
  if (open)
    fprintf(stderr, "%s\n", open);
}

static void tell_pairs(const struct eo_import *import)
{
  for (int i = 0; i < import->pairs; i++) {
    const struct eo_import_pair *pair = &import->pair[i];
    fprintf(stderr, "%s %d: %s%s%s%s\n", pair->number == import->taken ? "read" : "pair", pair->number, pair->label,
            pair->ends == 2 ? ", double helical" : "", *pair->remark ? "; " : "", pair->remark);
  }
}

/* "FILE: line 4, column 2: what is wrong". */
static void tell_faults(const char *file, const struct eo_import *import)
{
  for (int i = 0; i < import->faults; i++) {
    const struct eo_import_fault *fault = &import->fault[i];
    fprintf(stderr, "easeoff: %s: ", file);
    if (fault->line)
      fprintf(stderr, "line %d, column %d: ", fault->line, fault->column);
    else if (fault->pointer)
      fprintf(stderr, "%s: ", fault->pointer);
    fprintf(stderr, "%s\n", fault->text);
  }
}

static int save_design(const struct eo_import *import, const char *path)
{
  struct eo_text text = {0};
  struct eo_error error;
  eo_json_write(&text, import->design, EO_JSON_PRETTY);
  if (!path || strcmp(path, "-") == 0)
    return eo_app_print(&text);
  int status = eo_text_save(&text, path, &error) ? eo_app_fail(NULL, &error) : EO_EXIT_DONE;
  eo_text_done(&text);
  return status;
}

static int answer(const char *file, const struct eo_import *import, bool json, const char *path)
{
  int status = import->faults ? EO_EXIT_INPUT : EO_EXIT_DONE;
  if (json) {
    int printed = eo_app_print_json(eo_import_encode(import), false);
    return printed ? printed : status;
  }
  tell_pairs(import);
  tell_list("assumed", import->assumed);
  tell_list("refused", import->refused);
  tell_unused(import->not_used);
  tell_list("note", import->notes);
  tell_faults(file, import);
  return status ? status : save_design(import, path);
}

/* The options as the document that the field table reads; false: told. */
static bool read_options(const char *pair, const char *flank, bool transverse, bool reversed,
                         struct eo_import_options *options, int *status)
{
  struct eo_faults faults = {0};
  struct eo_error error;
  int number = 0;
  if (pair && !eo_app_read_whole(pair, "--pair", 1, 100000, &number, &error)) {
    *status = eo_app_fail(NULL, &error);
    return false;
  }
  json_t *document = json_pack("{s:b, s:b, s:i}", "transverse", transverse, "reversed", reversed, "pair", number);
  if (flank)
    json_object_set_new(document, "flank", json_string(flank));
  eo_table_decode(&eo_import_options_table, document, NULL, options, &faults);
  json_decref(document);
  if (faults.count)
    *status = eo_app_fail_all(NULL, &faults);
  return faults.count == 0;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  const char *file, *pair = NULL, *flank = NULL, *path = NULL;
  bool transverse = false, reversed = false, json = false;
  int operands, status;
  const struct eo_option list[] = {{.name = "--pair", .value = &pair},
                                   {.name = "--flank", .value = &flank},
                                   {.name = "--transverse", .flag = &transverse},
                                   {.name = "--reversed", .flag = &reversed},
                                   {.name = "--json", .flag = &json},
                                   {.name = "-o", .value = &path},
                                   {.name = NULL}};
  struct eo_import_options options = {0};
  struct eo_import import;
  struct eo_text text = {0};
  struct eo_error error;
  if (!eo_app_arguments(command, argc, argv, list, 1, 1, &file, &operands, &status) ||
      !read_options(pair, flank, transverse, reversed, &options, &status))
    return status;
  if (eo_text_read(&text, file, EO_REXS_BYTES, &error))
    return eo_app_fail(NULL, &error);
  enum eo_code code = eo_import_read(&import, text.size ? text.data : "", text.size, &options, &error);
  status = code ? eo_app_fail(file, &error) : answer(file, &import, json, path);
  eo_import_done(&import);
  eo_text_done(&text);
  return status;
}

const struct eo_command eo_command_import = {
    "import", "FILE [--pair N] [--flank left|right] [--transverse] [--reversed] [--json] [-o DESIGN.json]",
    "a design from a REXS model or a table of another program",
    "REXS 1.0 to 2.0.0, as XML, JSON or zip. A model with several gear pairs is listed, and --pair N chooses one of "
    "them.\n"
    "What the file does not state takes its default. On standard error the program names what was assumed, refused or "
    "not\n"
    "used.\n"
    "\n"
    "  --flank       which flank of the driver is loaded, where the file leaves it open\n"
    "  --transverse  amounts of modifications are in the transverse section; else they are normal to the flank\n"
    "  --reversed    a positive helix slope takes material off towards the datum face; else towards the other one\n"
    "  --json        the whole answer as the API gives it, with the design in it\n"
    "\n"
    "GDE (VDI/VDE 2610), KISSsoft and MASTA files and those of measuring and grinding machines have no public layout:\n"
    "export REXS or a table from the program that made them.\n",
    run};
