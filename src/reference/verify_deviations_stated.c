/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a file of flanks as made states of its pairs and of tolerances. */
#include "reference/verify_deviations.h"

#include <math.h>

#include "design/resolution.h"
#include "rating/flank_tolerance.h"
#include "reference/case_pair.h"

void eo_case_deviation_pair(struct eo_case *pair, struct eo_design *design)
{
  struct eo_case *input = eo_case_need(pair, "input");
  eo_case_design(input, design);
  design->gear_pair.ends = eo_case_whole_or(input, "ends", 1, 2, 2);
  design->gear_pair.bore[EO_PINION] = 0;
  design->resolution.positions = 64;
  design->resolution.cells_per_line = 30;
  design->resolution.tip_edge_contact = false;
  design->resolution.elements.body = EO_BODY_SECTOR;
  design->resolution.elements.sector_teeth = 3;
  design->resolution.elements.neighbour_coupling = false;
}

static enum eo_code check_pair(struct eo_verification *verification, struct eo_case *pair, struct eo_error *error)
{
  struct eo_case *output = eo_case_find(pair, "check");
  struct eo_design design;
  struct eo_geometry geometry;
  double torque[EO_MAX_LOAD_CASES];
  eo_case_deviation_pair(pair, &design);
  if (eo_case_find(pair, "torques_Nm"))
    eo_case_numbers(eo_case_find(pair, "torques_Nm"), -1, EO_MAX_LOAD_CASES, torque);
  if (eo_case_faulty(pair))
    return EO_OK;
  EO_TRY(eo_geometry_init(&geometry, &design.gear_pair, error));
  if (output)
    eo_case_check_geometry(verification, output, &geometry, 1e3, 1e-9);
  eo_verify_member(verification, output, "aw", geometry.working_pressure_angle, 1e-9, 0);
  return EO_OK;
}

enum eo_code eo_verify_deviation_pairs(struct eo_verification *verification, struct eo_case *pairs,
                                       struct eo_error *error)
{
  for (int i = 0; i < eo_case_size(pairs); i++)
    EO_TRY(check_pair(verification, eo_case_at(pairs, i), error));
  return EO_OK;
}

/* Rounded as the standard prints them. */
static enum eo_code check_tolerance_row(struct eo_verification *verification, struct eo_case *row,
                                        struct eo_error *error)
{
  struct eo_tolerance_input in = {.reference_diameter = 1e-3 * eo_case_number(row, "d_mm"),
                                  .normal_module = 1e-3 * eo_case_number(row, "mn_mm"),
                                  .face_width = 1e-3 * eo_case_number(row, "b_mm"),
                                  .teeth = eo_case_whole(row, "z", 1, 100000),
                                  .grade = eo_case_whole(row, "tolerance_class", 1, 11),
                                  .total_contact_ratio = NAN};
  struct eo_case *rounded = eo_case_need(row, "rounded_um");
  struct eo_flank_tolerance tolerance;
  if (eo_case_faulty(row))
    return EO_OK;
  EO_TRY(eo_flank_tolerance(&tolerance, EO_ISO1328_2013, &in, error));
  const struct {
    const char *key;
    double value;
  } all[] = {{"f_pT", tolerance.single_pitch},
             {"F_pT", tolerance.total_pitch},
             {"f_HalphaT", tolerance.profile_slope},
             {"f_falphaT", tolerance.profile_form},
             {"f_HbetaT", tolerance.helix_slope},
             {"f_fbetaT", tolerance.helix_form},
             {"F_alphaT", tolerance.profile_total},
             {"F_betaT", tolerance.helix_total},
             {"F_rT", tolerance.runout}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    eo_verify_member(verification, rounded, all[i].key, 1e6 * all[i].value, 0, 1e-6);
  if (eo_case_find(row, "unrounded_um"))
    eo_verify_uncompared(verification, eo_case_find(row, "unrounded_um"),
                         "tolerances are computed as the standard rounds them");
  return EO_OK;
}

enum eo_code eo_verify_flank_tolerances(struct eo_verification *verification, struct eo_case *block,
                                        struct eo_error *error)
{
  struct eo_case *rows = eo_case_need(block, "rows");
  eo_case_number_or(block, "tolerance_um", 0);
  for (int i = 0; i < eo_case_size(rows); i++)
    EO_TRY(check_tolerance_row(verification, eo_case_at(rows, i), error));
  return EO_OK;
}
