/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a search in the document: their defaults, and those that contradict each other. */
#include <string.h>

#include "document/design_document.h"
#include "document/examples.h"
#include "document/search_space.h"
#include "support/tap.h"

static struct eo_design design;

/* Each with the key it is reported at. */
struct contradiction {
  const char *what, *key;
  void (*apply)(struct eo_design *design);
};

static void wide_bounds(struct eo_design *d)
{
  d->optimization.tip_relief_start.high = 5.2e-3;
}
static void wide_root_bounds(struct eo_design *d)
{
  d->optimization.root_relief_start.high = 5.8e-3;
}
static void high_floor(struct eo_design *d)
{
  d->optimization.search.removal_threshold = 0.6;
}
static void whole_elite(struct eo_design *d)
{
  d->optimization.search.algorithm = EO_GA;
  d->optimization.search.elite = d->optimization.search.population;
}
static void same_variable(struct eo_design *d)
{
  d->optimization.variables = EO_VARIABLES_LISTED;
  d->optimization.listed = 2;
  d->optimization.list[0] = d->optimization.list[1] =
      (struct eo_listed_variable){.member = EO_PINION, .end = EO_BOTH_ENDS, .bounds = {0, 40}};
}
static void no_variables(struct eo_design *d)
{
  d->optimization.variables = EO_VARIABLES_LISTED;
}

/* What only a search uses: no analysis is refused for it, a search is, and whoever reads the design is told. */
static const struct contradiction search_contradictions[] = {
    {"tip start bounds outside the flank", "/optimization/bounds/tip_relief_start_mm", wide_bounds},
    {"root start bounds outside the flank", "/optimization/bounds/root_relief_start_mm", wide_root_bounds},
    {"a removal threshold R_0 above R*", "/optimization/removal_threshold", high_floor},
    {"an elite of everybody", "/optimization/elite", whole_elite},
    {"a variable twice", "/optimization/variable_list/1", same_variable},
    {"variables that nobody lists", "/optimization/variable_list", no_variables},
};

static void test_search_contradictions(void)
{
  for (size_t i = 0; i < sizeof search_contradictions / sizeof *search_contradictions; i++) {
    const struct contradiction *row = &search_contradictions[i];
    struct eo_geometry geometry;
    struct eo_error error = {0};
    static struct eo_study_space space;
    static struct eo_warnings warnings;
    eo_example_build("paper-case-a", &design);
    row->apply(&design);
    ok(eo_design_complete(&design, &geometry, &error) == EO_OK, "an analysis does not mind %s", row->what);
    ok(eo_study_space_init(&space, &design, &geometry, &error) == EO_ERROR_INPUT &&
           strcmp(error.pointer, row->key) == 0,
       "a search is refused: %s: %s", error.pointer, error.text);
    warnings.count = 0;
    eo_design_note_findings(&design, &geometry, &warnings);
    ok(warnings.count == 1 && strcmp(warnings.key[0], row->key) == 0,
       "a warning says what the analysis passes over: %s", warnings.text[0]);
  }
}

/* Every setting of the optimizer has its row in the document, with the same default. */
static void test_search(void)
{
  struct eo_optimizer_settings standard;
  const struct eo_optimizer_settings *search = &design.optimization.search;
  struct eo_error error = {0};
  struct eo_geometry geometry;
  int differing = 0;
  eo_example_build("paper-case-b", &design);
  eo_optimizer_defaults(&standard, EO_CREDIBILITY_GA, 10);
#define COMPARE(member, ...) differing += search->member != standard.member;
#define SKIP(...)
  EO_OPTIMIZER_SETTINGS(COMPARE, COMPARE, COMPARE, SKIP, COMPARE, COMPARE, COMPARE)
  ok(differing == 0 && search->algorithm == EO_CREDIBILITY_GA && isnan(search->share_radius),
     "an example has the optimizer's defaults");
  ok(eo_design_complete(&design, &geometry, &error) == EO_OK && search->variables == 10 && search->objectives == 3 &&
         search->share_radius == eo_optimizer_share_radius(&standard),
     "a complete design says how many variables there are");
}

int main(void)
{
  test_search_contradictions();
  test_search();
  return tap_done();
}
