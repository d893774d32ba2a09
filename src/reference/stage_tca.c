/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>

#include "reference/stage.h"
#include "reference/stage_input.h"
#include "contact/unloaded.h"

enum { MOST_PHASES = 2000 };

struct input {
  struct eo_design design;
  int end;
  enum eo_stage_pivot pivot;
  struct eo_numbers phase;
};

static const struct eo_field input[] = {
    EO_STAGE_GEAR_PAIR(struct input),
    EO_STAGE_ALIGNMENT(struct input),
    EO_STAGE_MODIFICATION(struct input),
    EO_STAGE_END(struct input, end),
    EO_STAGE_PIVOT(struct input, pivot),
    EO_SERIES(
        struct input, phase, "phase_mm", &eo_unit_mm, MOST_PHASES, -1e3, 1e3, EO_FIELD_REQUIRED,
        "phases c of one pair of teeth: arc of the pinion's base circle, 0 with the mid-face slice in the pitch point"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

static const char *const touches[] = {"point", "edge", "none", NULL};

static const struct eo_field contact[] = {
    EO_CHOICE(struct eo_unloaded, touch, "touch", touches, EO_TOUCH_POINT,
              "inside the flank; at its edge, or along a line; no pair in mesh"),
    EO_OUT(struct eo_unloaded, transmission_error, "transmission_error_um", &eo_unit_um,
           "of the gear, transverse; negative when it lags"),
    EO_OUT(struct eo_unloaded, path, "s_mm", &eo_unit_mm, "of the contact"),
    EO_OUT(struct eo_unloaded, eta, "eta_mm", &eo_unit_mm, "of the contact"),
    EO_OUT(struct eo_unloaded, residual, "residual", NULL,
           "largest of the five equations, in m and in parts of 1; 0 for the smallest gap"),
};
static const struct eo_table contact_table = EO_TABLE("a contact", struct eo_unloaded, contact);

struct row {
  double phase, difference;
  struct eo_unloaded exact, minimum;
};

static const struct eo_field row[] = {
    EO_OUT(struct row, phase, "phase_mm", &eo_unit_mm, "c"),
    EO_OBJECT(struct row, exact, "exact", &contact_table,
              "of the exact surfaces: equal positions and normals (Litvin); null unless they touch in a point"),
    EO_OBJECT(struct row, minimum, "minimum_gap", &contact_table, "smallest gap along the contact line"),
    EO_OUT(struct row, difference, "difference_um", &eo_unit_um,
           "exact minus smallest gap, less the mean difference; null unless both touch in a point"),
};
static const struct eo_table row_table = EO_TABLE("a phase", struct row, row);

struct output {
  double mean, largest;
  int rows;
  struct row row[MOST_PHASES];
};

static const struct eo_field output[] = {
    EO_OUT(struct output, mean, "mean_difference_um", &eo_unit_um,
           "of the two forms over the phases where both touch in a point; axial float takes it up"),
    EO_OUT(struct output, largest, "largest_difference_um", &eo_unit_um, "of what is left"),
    EO_LIST(struct output, row, rows, "phases", &row_table, 0, MOST_PHASES, "one row per phase"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

/* Where surfaces do not touch in a point the five equations have no solution on the flanks, or a whole line of them;
   without a pair in mesh nothing has a meaning. */
static void drop_meaningless(struct eo_unloaded *found, bool point_only)
{
  if (found->touch == EO_TOUCH_NONE || (point_only && found->touch == EO_TOUCH_EDGE))
    found->transmission_error = found->path = found->eta = found->residual = NAN;
}

static void compare(struct output *found)
{
  int count = 0;
  double sum = 0;
  for (int i = 0; i < found->rows; i++) {
    struct row *this_row = &found->row[i];
    bool both = this_row->exact.touch == EO_TOUCH_POINT && this_row->minimum.touch == EO_TOUCH_POINT;
    this_row->difference = both ? this_row->exact.transmission_error - this_row->minimum.transmission_error : NAN;
    sum += both ? this_row->difference : 0;
    count += both;
  }
  found->mean = count ? sum / count : NAN;
  found->largest = count ? 0 : NAN;
  for (int i = 0; i < found->rows; i++) {
    found->row[i].difference -= found->mean;
    if (!isnan(found->row[i].difference))
      found->largest = fmax(found->largest, fabs(found->row[i].difference));
  }
}

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  struct eo_design design = given->design;
  struct eo_stage_field field;
  int rows = given->phase.count;
  struct eo_unloaded *result = calloc((size_t)2 * rows + 1, sizeof *result);
  enum eo_code code = result ? eo_stage_field_init(&field, &design, given->end, given->pivot, error)
                             : eo_error_memory(error);
  if (!code) {
    double sign = given->end == EO_LEFT ? -1 : 1;
    struct eo_shaft_errors errors = {sign * design.alignment.shaft_angle_in_plane,
                                     sign * design.alignment.shaft_angle_out_of_plane, -field.pivot};
    code = eo_unloaded_exact(&field.gap, &errors, rows, given->phase.value, result, error);
    eo_unloaded_minimum(&field.gap, rows, given->phase.value, result + rows);
  }
  if (!code) {
    for (int i = 0; i < rows; i++)
      found->row[i] = (struct row){.phase = given->phase.value[i], .exact = result[i], .minimum = result[rows + i]};
    found->rows = rows;
    compare(found);
    for (int i = 0; i < rows; i++) {
      drop_meaningless(&found->row[i].exact, true);
      drop_meaningless(&found->row[i].minimum, false);
    }
  }
  free(result);
  return code;
}

const struct eo_stage eo_stage_tca = {
    "tca", "unloaded contact of one pair of teeth, in two independent forms", &input_table, &output_table, true, run};
