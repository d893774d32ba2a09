/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any bytes as a file of another program: an answer with faults that are sentences, or a design that can be decoded.
   For libFuzzer, and replayed by replay.c. */
#include "document/design_document.h"
#include "exchange/import.h"
#include "fuzz/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void demand(bool good, const char *what)
{
  if (good)
    return;
  fprintf(stderr, "fuzz-import: %s\n", what);
  abort();
}

static void look(const struct eo_import *import)
{
  for (int i = 0; i < import->faults; i++) {
    const char *text = import->fault[i].text;
    demand(text && *text && !strchr(text, '\n'), "a fault without a sentence");
  }
  demand(!import->design || import->faults == 0, "a design beside faults");
  demand(import->design || import->faults > 0, "neither a design nor a fault");
  json_t *answer = eo_import_encode(import);
  demand(answer != NULL, "no answer");
  json_decref(answer);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
  for (int pair = 0; pair < 2; pair++) {
    const struct eo_import_options options = {.pair = pair, .flank = pair, .transverse = pair};
    struct eo_import import;
    struct eo_error error;
    demand(eo_import_read(&import, (const char *)bytes, size, &options, &error) == EO_OK,
           "no memory, and there is enough: a text that JSON does not take");
    look(&import);
    eo_import_done(&import);
  }
  return 0;
}
