/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/examples.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "document/design_document.h"

static double mm(double value)
{
  return eo_unit_in(&eo_unit_mm, value);
}

static double um(double value)
{
  return eo_unit_in(&eo_unit_um, value);
}

static double degrees(double value)
{
  return eo_unit_in(&eo_unit_deg, value);
}

static void name(struct eo_design *design, const char *text)
{
  snprintf(design->name, sizeof design->name, "%s", text);
}

static void size(struct eo_gear_pair *pair, int pinion_teeth, int gear_teeth, double module_mm, double helix_deg,
                 double face_mm, double groove_mm)
{
  pair->teeth[EO_PINION] = pinion_teeth;
  pair->teeth[EO_GEAR] = gear_teeth;
  pair->normal_module = mm(module_mm);
  pair->helix_angle = degrees(helix_deg);
  pair->face_width = mm(face_mm);
  pair->groove_width = mm(groove_mm);
}

static void load(struct eo_design *design, int i, double torque, double rpm, double share)
{
  design->load_case[i] = (struct eo_load_case){
      .torque = torque, .speed = eo_unit_in(&eo_unit_rpm, rpm), .share = share, .power = NAN, .hours = NAN};
  design->load_cases = i + 1;
}

static void relief(struct eo_flank_modification *flank, double tip_um, double tip_start_mm, double root_um,
                   double root_start_mm)
{
  flank->tip_relief = um(tip_um);
  flank->tip_relief_start = mm(tip_start_mm);
  flank->root_relief = um(root_um);
  flank->root_relief_start = mm(root_start_mm);
}

/* What the paper's rig has and another pair would not: stated, so that the numbers of the examples are their own. */
static void state_rig(struct eo_design *design)
{
  design->gear_pair.normal_pressure_angle = degrees(20);
  design->gear_pair.addendum_coefficient = 1;
  design->gear_pair.dedendum_coefficient = 1.25;
  design->gear_pair.fillet_radius_coefficient = 0.38;
  design->gear_pair.backlash = um(100);
  design->gear_pair.tip_alteration = 0;
  for (int i = 0; i < 2; i++)
    design->gear_pair.profile_shift[i] = 0;
  design->alignment.shaft_angle_in_plane = degrees(0.1);
  design->alignment.pinion_axial_stiffness = eo_unit_in(&eo_unit_N_per_um, 200);
  design->supports.bearing_stiffness[EO_PINION] = eo_unit_in(&eo_unit_N_per_um, 800);
  design->supports.bearing_stiffness[EO_GEAR] = eo_unit_in(&eo_unit_N_per_um, 1000);
  for (int end = 0; end < 2; end++)
    design->supports.gear_axial_stiffness[end] = eo_unit_in(&eo_unit_N_per_um, 200);
  design->optimization.tip_relief = design->optimization.root_relief = (struct eo_range){0, um(40)};
  design->optimization.lead_crowning = (struct eo_range){0, um(36)};
  design->resolution.impact_patch = mm(5);
}

/* Table 1; bounds of the reliefs as in section 5, the others as in the product's plan. */
static void build_paper(struct eo_design *design)
{
  name(design, "paper pair");
  size(&design->gear_pair, 17, 44, 6, 24, 55, 50);
  load(design, 0, 621, 2000, 0.2);
  load(design, 1, 828, 2000, 0.5);
  load(design, 2, 1035, 2000, 0.3);
  design->optimization.tip_relief_start = (struct eo_range){mm(0.3), mm(4.5)};
  design->optimization.root_relief_start = (struct eo_range){mm(0.3), mm(5.2)};
}

/* Table 3 states the coefficient a_l in 1/um of x = eta / cos(beta); the document the amount at the face ends. */
static double crowning(const struct eo_gear_pair *pair, double coefficient_per_um)
{
  double x = pair->face_width / (2 * cos(pair->helix_angle));
  return eo_unit_in(&eo_unit_per_um, coefficient_per_um) * x * x;
}

static void build_case_a(struct eo_design *design)
{
  build_paper(design);
  name(design, "paper pair, case A");
  for (int end = 0; end < 2; end++) {
    struct eo_flank_modification *flank = &design->modification.flank[EO_PINION][end];
    relief(flank, 14, 1.6, 17, 3.5);
    flank->lead_crowning = crowning(&design->gear_pair, 1.35e-8);
  }
}

static void build_case_b(struct eo_design *design)
{
  struct eo_flank_modification *flank = design->modification.flank[EO_PINION];
  build_paper(design);
  name(design, "paper pair, case B");
  relief(&flank[EO_LEFT], 13, 1.45, 16, 3.8);
  flank[EO_LEFT].lead_crowning = crowning(&design->gear_pair, 1.03e-8);
  relief(&flank[EO_RIGHT], 13, 1.31, 17, 3.6);
  flank[EO_RIGHT].lead_crowning = crowning(&design->gear_pair, 1.79e-8);
  design->optimization.variables = EO_VARIABLES_PER_END;
}

/* A light pump drive whose ends are so narrow that less than one axial pitch overlaps. */
static void build_narrow(struct eo_design *design)
{
  name(design, "narrow pump drive");
  size(&design->gear_pair, 23, 67, 4, 20, 24, 30);
  design->alignment.shaft_angle_in_plane = degrees(0.03);
  load(design, 0, 120, 3000, 0.3);
  load(design, 1, 180, 3000, 0.5);
  load(design, 2, 240, 3000, 0.2);
  for (int end = 0; end < 2; end++)
    relief(&design->modification.flank[EO_PINION][end], 10, 1.5, 10, 1.5);
}

/* A marine reduction stage: few pinion teeth, so a long addendum on the pinion and a rounded centre distance. */
static void build_shifted(struct eo_design *design)
{
  struct eo_gear_pair *pair = &design->gear_pair;
  name(design, "profile-shifted marine stage");
  size(pair, 15, 58, 8, 28, 90, 70);
  pair->profile_shift[EO_PINION] = 0.35;
  pair->profile_shift[EO_GEAR] = 0.1;
  pair->centre_distance = mm(334.3);
  design->alignment.shaft_angle_in_plane = degrees(0.02);
  load(design, 0, 2000, 1200, 0.5);
  load(design, 1, 3200, 1500, 0.5);
  for (int end = 0; end < 2; end++) {
    struct eo_flank_modification *flank = &design->modification.flank[EO_PINION][end];
    relief(flank, 25, 3, 20, 2);
    flank->lead_crowning = um(8);
  }
}

/* A turbo-compressor stage with one helical end on thrust bearings. */
static void build_single(struct eo_design *design)
{
  struct eo_flank_modification *flank = &design->modification.flank[EO_PINION][EO_LEFT];
  name(design, "single helical compressor stage");
  size(&design->gear_pair, 31, 76, 3, 17, 40, 0);
  design->gear_pair.ends = 1;
  design->gear_pair.backlash = um(80);
  design->alignment.shaft_angle_in_plane = degrees(0.02);
  design->alignment.pinion_axial = EO_AXIAL_FIXED;
  load(design, 0, 150, 6000, 0.4);
  load(design, 1, 220, 6000, 0.6);
  relief(flank, 12, 1, 8, 1);
  flank->lead_crowning = um(5);
}

static const struct eo_example examples[] = {
    {"paper", "the paper's herringbone pair (Table 1), unmodified", build_paper},
    {"paper-case-a", "with the modification of Table 3, case A: the same on both ends", build_case_a},
    {"paper-case-b", "with the modification of Table 3, case B: one for each end", build_case_b},
    {"narrow", "a herringbone pump drive, 23/67 teeth, with an overlap ratio below 1", build_narrow},
    {"shifted", "a herringbone marine stage, 15/58 teeth, with profile shift and a set centre distance", build_shifted},
    {"single", "a single helical compressor stage, 31/76 teeth", build_single},
};

const struct eo_example *eo_example_at(int index)
{
  int count = (int)(sizeof examples / sizeof examples[0]);
  return index >= 0 && index < count ? &examples[index] : NULL;
}

bool eo_example_build(const char *example_name, struct eo_design *design)
{
  const struct eo_example *example;
  for (int i = 0; (example = eo_example_at(i)); i++)
    if (strcmp(example->name, example_name) == 0) {
      memset(design, 0, sizeof *design);
      eo_table_defaults(&eo_design_table, design);
      state_rig(design);
      example->build(design);
      eo_table_round_to_document(&eo_design_table, design);
      return true;
    }
  return false;
}
