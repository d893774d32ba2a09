/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "document/completion.h"
#include "format/inch.h"

struct request {
  const char *file, *units;
  bool json, complete, inches;
  struct eo_design design;
  struct eo_geometry geometry;
  struct eo_warnings warnings;
};

/* The document, taken over, as it is shown. */
static json_t *in_units(const struct request *request, json_t *document)
{
  json_t *shown = request->inches && document ? eo_inch_from_mm(document) : json_incref(document);
  json_decref(document);
  return shown;
}

static int show(const struct request *request)
{
  if (request->complete)
    return eo_app_print_json(in_units(request, eo_design_encode(&request->design)), false);
  json_t *completion = eo_completion_encode(&request->design, &request->geometry, &request->warnings);
  return eo_app_show(in_units(request, completion), request->json, eo_completion_summary);
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
      eo_app_units(request->units, &request->inches, &status) &&
      eo_app_load_design(request->file, &request->design, &request->geometry, &request->warnings, &status))
    status = show(request);
  free(request);
  return status;
}

const struct eo_command eo_command_design = {
    "design", "DESIGN.json [--json] [--complete] [--units mm|inch]",
    "completes a short design: every derived value, and what was assumed",
    "A design needs its teeth, module, helix angle, face width and a load case. All else follows from the pair by "
    "rules\n"
    "of the field, and each value may be stated in other ways (easeoff stage geometry --help lists the keys): "
    "diametral\n"
    "pitch or transverse module; centre distance, working pressure angle or sum of the profile shifts; shifts in mm; "
    "tip\n"
    "diameter or addendum; power instead of torque.\n"
    "\n"
    "--json prints the document that POST /api/v1/check returns, without what only the service adds; --complete "
    "prints\n"
    "the completed design and nothing else. --units inch shows lengths in inches and micrometres in thousandths of an\n"
    "inch; documents keep mm.\n",
    run};
