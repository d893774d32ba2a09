/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hundred drawn gears through the whole analysis, at a coarse resolution: each is analysed to finite numbers, or
   refused with number, limit and remedy at a key of the gear. An argument: how many of them. */
#include <stdlib.h>

#include "document/design_document.h"
#include "document/result.h"
#include "evaluation/analysis.h"
#include "support/drawn-gears.h"
#include "support/tap.h"

static struct eo_design design;
static struct eo_geometry geometry;
static struct eo_faults faults;

static json_t *coarse(int i)
{
  json_t *document = drawn(i);
  json_object_set_new(document, "resolution",
                      json_pack("{s:i,s:i,s:i,s:i,s:i}", "positions", 16, "cells_per_line", 8, "layers", 6,
                                "flank_rows", 6, "fillet_elements", 8));
  return document;
}

static bool is_finite(const struct eo_analysis *analysis)
{
  const struct eo_objective_case *c = &analysis->evaluation->objective[0];
  return isfinite(c->peak_to_peak) && isfinite(c->impact) && isfinite(c->contact_pressure) && c->contact_pressure > 0;
}

static void run(int i, bool *analysed, bool *fair, struct eo_error *error)
{
  const struct eo_pair_options options = {0};
  struct eo_pair *pair = NULL;
  struct eo_analysis *analysis = NULL;
  json_t *document = coarse(i);
  faults.count = 0;
  memset(error, 0, sizeof *error);
  enum eo_code code = eo_design_decode(document, &design, NULL, &faults) ? EO_OK : eo_faults_first(&faults, error);
  json_decref(document);
  if (!code)
    code = eo_design_complete(&design, &geometry, error);
  if (!code)
    code = eo_pair_new(&pair, &design, &options, NULL, error);
  if (!code)
    code = eo_analysis_new(&analysis, pair, error);
  if (!code)
    code = eo_analysis_run(analysis, &design, EO_WANT_ROOT, error);
  *fair = code && is_fair_refusal(error);
  *analysed = !code && is_finite(analysis);
  eo_analysis_free(analysis);
  eo_pair_free(pair);
}

int main(int argc, char **argv)
{
  int count = argc > 1 ? atoi(argv[1]) : 100, analysed = 0, refused = 0;
  for (int i = 0; i < count; i++) {
    struct eo_error error;
    bool done, fair;
    run(i, &done, &fair, &error);
    analysed += done;
    refused += fair;
    printf("# gear %d: %s%s %s\n", i, done ? "analysed" : "refused at ", done ? "" : error.pointer,
           done ? "" : error.text);
    fflush(stdout);
    if (!done && !fair)
      ok(false, "gear %d is analysed: %d/%d teeth, m %.4g mm: %s: %s", i, geometry.teeth[0], geometry.teeth[1],
         1e3 * geometry.normal_module, error.pointer, error.text);
  }
  ok(analysed + refused == count && analysed > count / 2, "%d of %d drawn gears are analysed, %d refused", analysed,
     count, refused);
  return tap_done();
}
