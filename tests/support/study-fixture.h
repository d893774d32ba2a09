/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper pair on a coarse mesh and few positions, and folders for its history: for tests of the study loop. */
#ifndef EASEOFF_TESTS_SUPPORT_STUDY_FIXTURE_H
#define EASEOFF_TESTS_SUPPORT_STUDY_FIXTURE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "document/search_space.h"
#include "document/design_document.h"
#include "document/examples.h"
#include "format/json.h"
#include "study/study.h"
#include "store/evaluations.h"

static struct eo_error error;
static char folder[200];

__attribute__((unused)) static void coarse_design(struct eo_design *design, const char *algorithm, int budget)
{
  eo_example_build("paper", design);
  struct eo_resolution *r = &design->resolution;
  r->positions = 16;
  r->cells_per_line = 6;
  r->elements.body = EO_BODY_SECTOR;
  r->elements.sector_teeth = 3;
  r->elements.neighbour_coupling = false;
  r->elements.layers = 6;
  r->elements.flank_rows = 4;
  r->elements.fillet_elements = 6;
  r->harmonics = 6;
  r->te_harmonics = 6;
  design->optimization.search.algorithm = eo_optimizer_algorithm_find(algorithm);
  design->optimization.search.true_evaluations = budget;
  design->optimization.search.population = 20;
}

/* For an analysis and for a search. */
__attribute__((unused)) static bool complete(struct eo_design *design)
{
  struct eo_geometry geometry;
  struct eo_study_space space;
  return eo_design_complete(design, &geometry, &error) == EO_OK &&
         eo_study_space_init(&space, design, &geometry, &error) == EO_OK;
}

/* The pair of coarse_design(); alignment, load cases and modification may differ. */
__attribute__((unused)) static struct eo_pair *coarse_pair(void)
{
  static struct eo_design design;
  const struct eo_pair_options options = {0};
  struct eo_pair *pair = NULL;
  coarse_design(&design, "ga", 1);
  if (!complete(&design) || eo_pair_new(&pair, &design, &options, NULL, &error))
    printf("Bail out! %s\n", error.text);
  return pair;
}

__attribute__((unused)) static bool make_folder(void)
{
  snprintf(folder, sizeof folder, "%s/easeoff-study-XXXXXX", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  return mkdtemp(folder) != NULL;
}

/* Nothing stays but the folder itself. */
__attribute__((unused)) static void empty_folder(void)
{
  static const char *const names[] = {"easeoff.db", "easeoff.db-wal", "easeoff.db-shm", "easeoff.lock", "result"};
  char name[300];
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    snprintf(name, sizeof name, "%s/%s", folder, names[i]);
    unlink(name);
  }
}

/* The part of a study's document that must not depend on threads, interruptions and the clock; owned. NULL after a
   failure. */
__attribute__((unused)) static char *lasting_part(const struct eo_study_plan *plan,
                                                  const struct eo_study_result *result)
{
  json_t *document = NULL;
  if (eo_study_document(plan, result, NULL, &document, &error))
    return NULL;
  json_object_del(document, "run");
  json_object_del(json_object_get(json_object_get(document, "best"), "result"), "timing_ms");
  char *text = json_dumps(document, JSON_SORT_KEYS);
  json_decref(document);
  return text;
}

#endif
