/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a design leaves open, derived, against the model's printed figures. */
#include "document/design_document.h"
#include "document/examples.h"
#include "support/tap.h"

static struct eo_design design;

/* Figures of physics.md section 9, of the paper pair. */
static void test_derived(void)
{
  struct eo_geometry geometry;
  struct eo_error error = {0};
  eo_example_build("paper-case-a", &design);
  ok(isnan(design.gear_pair.bore[EO_GEAR]) && isnan(design.supports.mass[0]), "derived values are open in an example");
  ok(eo_design_complete(&design, &geometry, &error) == EO_OK, "the derived values of the example are found %s",
     error.text);
  near(design.supports.mass[EO_PINION], 5.608, 2e-4, "mass of the pinion, kg");
  near(design.supports.inertia[EO_PINION], 8.134e-3, 2e-4, "inertia of the pinion, kg m2");
  near(design.supports.mass[EO_GEAR], 35.73, 2e-4, "mass of the gear, kg");
  near(design.supports.inertia[EO_GEAR], 0.3970, 2e-4, "inertia of the gear, kg m2");
  near(design.supports.groove_axial_stiffness[EO_PINION], 2.90e10, 2e-3, "EA/L of the pinion's groove, N/m");
  near(design.supports.groove_axial_stiffness[EO_GEAR], 2.13e11, 2e-3, "EA/L of the gear's groove, N/m");
  close_to(design.gear_pair.bore[EO_GEAR], 0.09, 1e-15, "bore of the gear by default");
  close_to(design.gear_pair.centre_distance, 0.2003184389666066, 1e-15, "centre distance of the example");
  close_to(design.modification.flank[EO_PINION][EO_LEFT].lead_crowning, 12.23e-6, 0.005e-6, "a_l at the face ends");
  ok(isnan(design.supports.mesh_damping_stiffness), "the mesh damping of the example waits for the mesh stiffness");
  close_to(design.optimization.search.share_radius, 0.03, 1e-15, "sharing radius r_share for 5 variables");
  eo_example_build("paper-case-b", &design);
  eo_design_complete(&design, &geometry, &error);
  close_to(design.optimization.search.share_radius, 0.11, 0.005, "sharing radius r_share for 10 variables");
  close_to(design.shafts.bearing_position[EO_PINION][EO_RIGHT], 0.025 + 0.055 + 0.0275, 1e-15,
           "place of the right bearing: half a face width outside");
}

static void test_robust(void)
{
  struct eo_geometry geometry;
  eo_example_build("paper", &design);
  design.objective.robust = EO_ROBUST_WORST;
  eo_design_complete(&design, &geometry, NULL);
  ok(design.objective.scenarios == 7 && design.objective.scenario[0].in_plane == design.alignment.shaft_angle_in_plane,
     "a robust objective has seven scenarios, the nominal one first");
}

int main(void)
{
  test_derived();
  test_robust();
  return tap_done();
}
