/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/examples.h"

#include "app/app.h"

static int list_examples(void)
{
  struct eo_text text = {0};
  const struct eo_example *example;
  for (int i = 0; (example = eo_example_at(i)); i++)
    eo_text_print(&text, "%-14s %s\n", example->name, example->summary);
  return eo_app_print(&text);
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  const char *name;
  int operands, status;
  struct eo_design design;
  if (!eo_app_arguments(command, argc, argv, NULL, 0, 1, &name, &operands, &status))
    return status;
  if (!operands)
    return list_examples();
  if (eo_example_build(name, &design))
    return eo_app_print_json(eo_design_encode(&design), false);
  struct eo_error error;
  eo_error_set(&error, EO_ERROR_INPUT, "", "There is no example \"%.40s\"; easeoff example lists them.", name);
  return eo_app_fail(NULL, &error);
}

const struct eo_command eo_command_example = {
    "example", "[NAME]", "prints a design to start from; without a name, the list of examples",
    "The design is complete: it has every key with its value, and null where the value is derived from the others.\n",
    run};
