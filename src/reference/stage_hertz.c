/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "reference/stage.h"
#include "contact/hertz.h"
#include "document/design_document.h"

struct input {
  struct eo_material material;
  double relative_radius, depth[2];
  struct eo_numbers line_load;
};

static const struct eo_field input[] = {
    EO_OBJECT(struct input, material, "material", &eo_material_table, "as in a design document; density is not used"),
    EO_NUMBER_REQUIRED(struct input, relative_radius, "relative_radius_mm", &eo_unit_mm, 1e-6, 1e6,
                       "rho_n = rho_1 rho_2/(rho_1 + rho_2), normal to the flanks"),
    EO_NUMBERS(struct input, depth, "depth_mm", 2, &eo_unit_mm, 1e-6, 1e6, EO_FIELD_REQUIRED, NULL, NULL,
               "[pinion, gear] from the flank to the tooth centre surface along the normal"),
    EO_SERIES(struct input, line_load, "line_load_N_per_mm", &eo_unit_N_per_mm, 1e6, 0, 1e9, EO_FIELD_REQUIRED,
              "load per length of contact line"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

enum { HALF_WIDTH, PRESSURE, APPROACH, DERIVATIVE, INVERSE, QUANTITIES };
struct output {
  struct eo_numbers column[QUANTITIES];
};

static const struct eo_field output[] = {
    EO_OUT_SERIES(struct output, column[HALF_WIDTH], "half_width_um", &eo_unit_um, "b of the contact band (Hertz)"),
    EO_OUT_SERIES(struct output, column[PRESSURE], "pressure_MPa", &eo_unit_MPa, "largest contact pressure (Hertz)"),
    EO_OUT_SERIES(struct output, column[APPROACH], "approach_um", &eo_unit_um,
                  "of the tooth centre surfaces (Weber and Banaschek)"),
    EO_OUT_SERIES(struct output, column[DERIVATIVE], "approach_per_line_load_um_mm_per_N", &eo_unit_um_mm_per_N,
                  "derivative of the approach"),
    EO_OUT_SERIES(struct output, column[INVERSE], "line_load_of_approach_N_per_mm", &eo_unit_N_per_mm,
                  "line load found from the approach"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  double modulus = given->material.youngs_modulus, ratio = given->material.poissons_ratio,
         radius = given->relative_radius;
  struct eo_local_law law;
  eo_local_law_init(&law, modulus, ratio, radius, given->depth);
  int count = given->line_load.count;
  for (int i = 0; i < QUANTITIES; i++) {
    double *value = malloc((size_t)(count ? count : 1) * sizeof *value);
    if (!value)
      return eo_error_memory(error);
    found->column[i] = (struct eo_numbers){count, value};
  }
  for (int i = 0; i < count; i++) {
    double q = given->line_load.value[i], approach = eo_local_law_approach(&law, q);
    found->column[HALF_WIDTH].value[i] = eo_hertz_half_width(q, radius, modulus, ratio);
    found->column[PRESSURE].value[i] = eo_hertz_pressure(q, radius, modulus, ratio);
    found->column[APPROACH].value[i] = approach;
    found->column[DERIVATIVE].value[i] = eo_local_law_derivative(&law, q);
    found->column[INVERSE].value[i] = eo_local_law_load(&law, approach);
  }
  return EO_OK;
}

const struct eo_stage eo_stage_hertz = {
    "hertz", "line contact of two teeth: pressure, width and local approach", &input_table, &output_table, false, run};
