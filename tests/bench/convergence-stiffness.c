/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The level of mesh stiffness over tooth numbers and helix angles, ring and sector, beside ISO 6336-1 with and without
   C_M: unmodified pairs of m_n 6, b 55 mm under 135 N/mm, 16 positions, 14 layers. c = mean of (P/Z) cos^2(beta_b)/b.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "document/design_document.h"
#include "evaluation/evaluator.h"
#include "evaluation/pair.h"
#include "gear/entry.h"

static const int teeth[][2] = {{17, 44}, {20, 60}, {24, 95}, {50, 50}};
static const double helix[] = {0, 15, 24, 30};
static const struct {
  const char *name;
  enum eo_body body;
  enum eo_body_support support;
} model[] = {{"floating", EO_BODY_RING, EO_SUPPORT_FLOATING},
             {"held", EO_BODY_RING, EO_SUPPORT_HELD},
             {"5 teeth", EO_BODY_SECTOR, EO_SUPPORT_HELD}};
enum { MODELS = sizeof model / sizeof *model };

/* Pa, or NaN with the reason on stderr. */
static double stiffness_of(const struct eo_design *design, struct eo_iso_stiffness_input *iso)
{
  struct eo_pair_options options = {.own_pivots = true};
  struct eo_pair *pair = NULL;
  struct eo_evaluator *evaluator = NULL;
  const struct eo_evaluation *r;
  struct eo_error error;
  double sum = 0;
  if (eo_pair_new(&pair, design, &options, NULL, &error) || eo_evaluator_new(&evaluator, pair, 1, &error) ||
      eo_evaluator_contact(evaluator, design, &r, &error)) {
    fprintf(stderr, "%s\n", error.text);
    sum = NAN;
  } else {
    double normal = cos(pair->geometry.base_helix_angle);
    for (int j = 0; j < r->positions; j++)
      sum += r->load_case[0].force / r->load_case[0].end[0].loaded.approach[j] / r->positions;
    sum *= normal * normal / pair->geometry.face_width;
    *iso = eo_pair_iso_stiffness_input(pair);
  }
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  return sum;
}

/* False when a model could not be computed. */
static bool print_pair(const int z[2], double degrees)
{
  struct eo_design design = {0};
  struct eo_geometry geometry;
  struct eo_error error;
  struct eo_iso_stiffness_input input = {.theory_factor = 0};
  struct eo_iso_stiffness low, high;
  double c[MODELS];
  bool computed = true;
  eo_table_defaults(&eo_design_table, &design);
  design.gear_pair.teeth[0] = z[0];
  design.gear_pair.teeth[1] = z[1];
  design.gear_pair.normal_module = 6e-3;
  design.gear_pair.helix_angle = degrees * M_PI / 180;
  design.gear_pair.face_width = 55e-3;
  design.alignment.shaft_angle_in_plane = 0;
  design.resolution.positions = design.resolution.cells_per_line = 16;
  design.resolution.elements.layers = 14;
  design.resolution.elements.flank_rows = 8;
  design.resolution.tip_edge_contact = false;
  printf("%3d/%-3d %4g", z[0], z[1], degrees);
  if (eo_gear_pair_settle(&design.gear_pair, &error) || eo_geometry_init(&geometry, &design.gear_pair, &error)) {
    printf("  %s\n", error.text);
    return false;
  }
  eo_design_resolve(&design, &geometry);
  design.load_cases = 1;
  design.load_case[0].torque = 2 * 135e3 * design.gear_pair.face_width * geometry.reference_radius[0];
  for (int i = 0; i < MODELS; i++) {
    design.resolution.elements.body = model[i].body;
    design.resolution.elements.support = model[i].support;
    c[i] = stiffness_of(&design, &input);
    computed = computed && isfinite(c[i]);
  }
  input.theory_factor = 0.8;
  eo_iso_stiffness(&low, &input);
  input.theory_factor = 1;
  eo_iso_stiffness(&high, &input);
  printf(" %8.2f %6.2f", 1e-9 * low.mesh_alpha, 1e-9 * high.mesh_alpha);
  for (int i = 0; i < MODELS; i++)
    printf("  %8.2f (%+5.1f %%)", 1e-9 * c[i], 100 * (c[i] / low.mesh_alpha - 1));
  printf("\n");
  fflush(stdout);
  return computed;
}

int main(void)
{
  bool computed = true;
  printf("\nMesh stiffness c_gamma, N/(mm um); in brackets against ISO 6336-1 with C_M = 0.8\n");
  printf("%-12s %8s %6s", "teeth, helix", "C_M 0.8", "1");
  for (int i = 0; i < MODELS; i++)
    printf("  %18s", model[i].name);
  printf("\n");
  for (size_t i = 0; i < sizeof teeth / sizeof *teeth; i++)
    for (size_t k = 0; k < sizeof helix / sizeof *helix; k++)
      computed &= print_pair(teeth[i], helix[k]);
  return !computed;
}
