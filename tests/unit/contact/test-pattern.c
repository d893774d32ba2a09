/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contact pattern and the sharing of load against what they are made of: balance of forces, and closed forms on a
   flank whose contact lines stay whole. */
#include <stdlib.h>

#include "contact/pattern.h"
#include "document/examples.h"
#include "evaluation/analysis.h"
#include "document/design_document.h"
#include "flexibility/closed_form.h"
#include "support/tap.h"

static const struct eo_closed_form form = {
    .compliance = 1.5e-9, .length = 12e-3, .centre = -0.8e-3, .linear = 20, .quadratic = 4000};

/* Line load under a Hertz pressure: q = pi p^2 rho 2 (1 - nu^2) / E (Johnson 1985, (4.45) solved for the load). */
static double line_load(const struct eo_pair *pair, double pressure, double s)
{
  double nu = pair->material.poissons_ratio;
  return 2 * M_PI * pressure * pressure * eo_geometry_relative_radius(&pair->geometry, s) * (1 - nu * nu) /
         pair->material.youngs_modulus;
}

/* The integral of q over s and eta: the contact lines sweep the flank once while one base pitch passes under the whole
   load. */
static double swept_load(const struct eo_pair *pair, const struct eo_contact_pattern *pattern)
{
  double sum = 0, ds = pattern->path[1] - pattern->path[0], deta = pattern->eta[1] - pattern->eta[0];
  for (int i = 0; i < EO_PATTERN_ROWS; i++)
    for (int j = 0; j < EO_PATTERN_COLUMNS; j++) {
      double weight = (i == 0 || i == EO_PATTERN_ROWS - 1 ? 0.5 : 1) *
                      (j == 0 || j == EO_PATTERN_COLUMNS - 1 ? 0.5 : 1);
      sum += weight * line_load(pair, pattern->pressure[i * EO_PATTERN_COLUMNS + j], pattern->path[i]) * ds * deta;
    }
  return sum / (pair->geometry.transverse_base_pitch * cos(pair->geometry.base_helix_angle));
}

static void check(const char *example, double shaft_angle, double tolerance)
{
  struct eo_design *design = calloc(1, sizeof *design);
  struct eo_geometry geometry;
  struct eo_error error;
  struct eo_pair *pair;
  struct eo_analysis *analysis;
  struct eo_pair_options options = {.kernel = {eo_closed_form_kernel, &form}};
  eo_example_build(example, design);
  design->resolution.tip_edge_contact = false;
  design->alignment.shaft_angle_in_plane = shaft_angle;
  if (eo_design_complete(design, &geometry, &error) || eo_pair_new(&pair, design, &options, NULL, &error) ||
      eo_analysis_new(&analysis, pair, &error) || eo_analysis_run(analysis, design, 0, &error)) {
    ok(0, "%s is prepared: %s", example, error.text);
    return;
  }
  const struct eo_case_result *c = &analysis->evaluation->load_case[0];
  struct eo_contact_pattern *pattern = malloc(sizeof *pattern);
  double highest = 0, widest = INFINITY, deepest = 0, sum = 0,
         *share = calloc((size_t)pair->grid->positions, sizeof *share);
  eo_contact_pattern_init(pattern, pair->grid);
  eo_contact_pattern_load(pattern, pair->grid, &c->end[0].loaded);
  eo_contact_pattern_unload(pattern, eo_evaluator_field(analysis->evaluator, 0, 0), c->end[0].unloaded);
  for (int i = 0; i < EO_PATTERN_ROWS * EO_PATTERN_COLUMNS; i++) {
    highest = fmax(highest, pattern->pressure[i]);
    widest = fmin(widest, pattern->clearance[i]);
    deepest = fmax(deepest, pattern->clearance[i]);
  }
  /* At the face ends the pattern carries the last cell on to the edge, so it may lie a little above the cells
     themselves. */
  near(swept_load(pair, pattern), c->force, tolerance, example);
  ok(highest < 1.05 * c->end[0].max_pressure && highest > 0.9 * c->end[0].max_pressure,
     "%s: the largest pressure of the pattern is %.1f of %.1f MPa", example, highest / 1e6,
     c->end[0].max_pressure / 1e6);
  ok(widest >= 0 && widest < 0.3e-6 && (deepest > 1e-6) == (shaft_angle != 0 || *example == 'n'),
     "%s: the unloaded teeth touch somewhere, gaps up to %.3g um", example, 1e6 * deepest);
  int range[2];
  eo_contact_grid_pairs(pair->grid, range);
  for (int k = range[0]; k <= range[1]; k++) {
    eo_contact_pair_share(pair->grid, &c->end[0].loaded, k, share);
    sum += share[3];
  }
  close_to(sum, 1, 1e-7, "sum of the shares of the tooth pairs");
  free(share);
  free(pattern);
  eo_analysis_free(analysis);
  eo_pair_free(pair);
  free(design);
}

int main(void)
{
  check("paper", 0, 0.01);
  check("paper", 1e-3, 0.02);
  check("narrow", 5e-4, 0.02);
  return tap_done();
}
