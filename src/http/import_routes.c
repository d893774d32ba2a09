/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of other programs. The body is the file itself, as it is. */
#include <stdlib.h>
#include <string.h>

#include "exchange/import.h"
#include "http/http_private.h"
#include "http/route.h"

static int flank_of(const char *word)
{
  return !word ? 0 : strcmp(word, "left") == 0 ? 1 : 2;
}

/* 422, with each fault as an error and the whole answer beside: the pairs to choose from stand in it. */
static void refuse(struct eo_request *request, const struct eo_import *import)
{
  struct eo_problem_fault *fault = malloc((size_t)import->faults * sizeof *fault);
  if (!fault) {
    eo_reply_no_memory(&request->reply);
    return;
  }
  for (int i = 0; i < import->faults; i++) {
    const char *pointer = import->fault[i].pointer;
    fault[i] = (struct eo_problem_fault){"", pointer ? pointer : "", import->fault[i].text};
  }
  const struct eo_problem_more more = {
      .faults = import->faults, .fault = fault, .of_import = true, .imported = eo_import_encode(import)};
  eo_reply_problem_with(&request->reply, 422, "import", &more, import->fault[0].text);
  free(fault);
}

static void import(struct eo_request *request)
{
  struct eo_import_options options = {
      .pair = (int)eo_route_number(request, "pair"),
      .transverse = eo_route_number(request, "transverse") != 0,
      .reversed = eo_route_number(request, "reversed") != 0,
      .flank = flank_of(eo_request_query(request, "flank")),
  };
  struct eo_import answer;
  struct eo_error error;
  if (eo_import_read(&answer, request->body.size ? request->body.data : "", request->body.size, &options, &error))
    eo_reply_error(&request->reply, "", &error);
  else if (answer.faults)
    refuse(request, &answer);
  else
    eo_reply_json(&request->reply, 200, eo_import_encode(&answer));
  eo_import_done(&answer);
}

const struct eo_route eo_routes_import[] = {
    {.method = EO_POST,
     .pattern = "/import",
     .handle = import,
     .name = "importDesign",
     .takes = "application/octet-stream",
     .body = (size_t)32 << 20,
     .rate = EO_RATE_START,
     .aside = true,
     .gives = "200 Import",
     .query = {{"pair", 0, 100000, 0, NULL,
                "which of the pairs, or of the designs of a table, from 1; 0: the only one"},
               {"flank", 0, 0, 0, "left|right", "loaded flank of the driver, where the file leaves it open"},
               {"transverse", 0, 1, 0, NULL, "1: amounts of modifications stand in the transverse section"},
               {"reversed", 0, 1, 0, NULL, "1: a positive helix slope takes material off towards the datum face"}},
     .summary = "A design out of a REXS model or a table; the body is the file. Of several pairs one is chosen."},
    {0}};
