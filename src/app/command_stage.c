/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/stage.h"

#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "format/json.h"

static const struct eo_stage *const stages[] = {
    &eo_stage_geometry,    &eo_stage_modification, &eo_stage_surface, &eo_stage_gap,       &eo_stage_tca,
    &eo_stage_flexibility, &eo_stage_hertz,        &eo_stage_contact, &eo_stage_impact,    &eo_stage_root_stress,
    &eo_stage_iso6336,     &eo_stage_dynamics,     &eo_stage_sdof,    &eo_stage_objective, &eo_stage_evaluation,
};
enum { STAGES = sizeof stages / sizeof stages[0] };

static int list_stages(void)
{
  struct eo_text text = {0};
  for (int i = 0; i < STAGES; i++)
    eo_text_print(&text, "%-14s %s\n", stages[i]->name, stages[i]->summary);
  return eo_app_print(&text);
}

static int describe_stage(const struct eo_stage *stage)
{
  struct eo_text text = {0};
  eo_text_print(&text,
                "usage: easeoff stage %s INPUT.json\n\n%s.\n\nInput, a JSON object (the other keys of a design "
                "document may be there and are not used):\n",
                stage->name, stage->summary);
  eo_table_describe(stage->input, false, &text);
  eo_text_add(&text, "\nOutput:\n");
  eo_table_describe(stage->output, true, &text);
  return eo_app_print(&text);
}

/* A design document is an input too: what belongs to a design but not to the stage is left out. */
static void drop_design_keys(json_t *document, const struct eo_table *input)
{
  for (int i = 0; i < eo_design_table.count; i++) {
    const char *key = eo_design_table.field[i].key;
    bool used = false;
    for (int j = 0; j < input->count; j++)
      used = used || strcmp(input->field[j].key, key) == 0;
    if (!used)
      json_object_del(document, key);
  }
}

static int run_decoded(const struct eo_stage *stage, const char *path, void *input, void *output)
{
  struct eo_error error;
  if (stage->run(input, output, &error))
    return eo_app_fail(path, &error);
  return eo_app_print_json(eo_table_encode(stage->output, output), false);
}

static int run_stage(const struct eo_stage *stage, const char *path)
{
  struct eo_error error;
  int status = EO_EXIT_DONE;
  struct eo_faults *faults = calloc(1, sizeof *faults);
  void *input = calloc(1, stage->input->size), *output = calloc(1, stage->output->size);
  json_t *document = NULL;
  if (!faults || !input || !output) {
    status = eo_app_fail_memory();
    goto out;
  }
  document = eo_json_load(path, EO_JSON_CASES_BYTES, &error);
  if (!document) {
    status = eo_app_fail(path, &error);
    goto out;
  }
  drop_design_keys(document, stage->input);
  if (stage->has_design)
    eo_table_defaults(&eo_design_table, input);
  eo_table_decode(stage->input, document, NULL, input, faults);
  status = faults->count ? eo_app_fail_all(path, faults) : run_decoded(stage, path, input, output);
out:
  if (input)
    eo_table_done(stage->input, input);
  if (output)
    eo_table_done(stage->output, output);
  json_decref(document);
  free(output);
  free(input);
  free(faults);
  return status;
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  const char *operand[2];
  int operands, status;
  const struct eo_stage *stage = NULL;
  for (int i = 0; i < STAGES && argc > 1; i++)
    if (strcmp(argv[1], stages[i]->name) == 0)
      stage = stages[i];
  if (stage && argc == 3 && strcmp(argv[2], "--help") == 0)
    return describe_stage(stage);
  if (!eo_app_arguments(command, argc, argv, NULL, 0, 2, operand, &operands, &status))
    return status;
  if (!operands)
    return list_stages();
  if (stage && operands == 2)
    return run_stage(stage, operand[1]);
  struct eo_error error;
  if (stage)
    eo_error_set(&error, EO_ERROR_INPUT, "",
                 "The input file of stage %s is missing; easeoff stage %s --help describes it.", stage->name,
                 stage->name);
  else
    eo_error_set(&error, EO_ERROR_INPUT, "", "There is no stage \"%.40s\"; easeoff stage lists them.", operand[0]);
  return eo_app_fail(NULL, &error);
}

const struct eo_command eo_command_stage = {
    "stage", "[NAME INPUT.json]", "runs one stage of the computation alone; without a name, the list of stages",
    "easeoff stage NAME --help describes the stage's input and output. A stage that needs only a part of a design "
    "takes a\n"
    "complete design document too: easeoff example paper | easeoff stage geometry -\n",
    run};
