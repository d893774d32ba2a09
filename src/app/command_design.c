/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "document/completion.h"
#include "format/inch.h"

struct request {
  const char *file, *units;
  bool json, complete;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings;
};

/* Takes the document over. */
static int print_document(json_t *document, bool inches)
{
  json_t *shown = inches && document ? eo_inch_from_mm(document) : json_incref(document);
  json_decref(document);
  return eo_app_print_json(shown, false);
}

static int show(const struct request *request, bool inches)
{
  if (request->complete)
    return print_document(eo_design_encode(&request->design), inches);
  json_t *completion = eo_completion_encode(&request->design, &request->geometry, &request->warnings);
  struct eo_text text = {0};
  if (request->json || !completion)
    return print_document(completion, inches);
  eo_completion_summary(completion, inches, &text);
  json_decref(completion);
  return eo_app_print(&text);
}

static int run_request(const struct request *request)
{
  struct eo_error error;
  bool inches;
  return eo_app_units(request->units, &inches, &error) ? eo_app_fail(NULL, &error) : show(request, inches);
}

static int run(const struct eo_command *command, int argc, char **argv)
{
  int operands, status;
  struct request *request = eo_app_request(sizeof *request, &status);
  if (!request)
    return status;
  const struct eo_option options[] = {{.name = "--json", .flag = &request->json},
                                      {.name = "--complete", .flag = &request->complete},
                                      {.name = "--units", .value = &request->units},
                                      {.name = NULL}};
  if (eo_app_arguments(command, argc, argv, options, 1, 1, &request->file, &operands, &status) &&
      eo_app_load_design(request->file, &request->design, &request->geometry, &request->warnings, &status))
    status = run_request(request);
  free(request);
  return status;
}

const struct eo_command eo_command_design = {
    "design", "DESIGN.json [--json] [--complete] [--units mm|inch]",
    "completes a terse design: every derived value, and what was assumed",
    "A design needs its teeth, module, helix angle, face width and a load case; all else follows from the pair by "
    "rules "
    "of the\nfield, and each may be stated in other ways (easeoff stage geometry --help lists the keys): diametral "
    "pitch "
    "or transverse\nmodule; centre distance, working pressure angle or sum of the profile shifts; shifts in mm; tip "
    "diameter or addendum;\npower instead of torque. --json prints the document that POST /api/v1/check returns, less "
    "what the service knows beyond\nit; --complete the completed design alone. --units inch shows lengths in inches "
    "and "
    "micrometres in thousandths of an inch;\ndocuments keep mm.\n",
    run};
