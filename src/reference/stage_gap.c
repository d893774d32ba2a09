/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/stage.h"
#include "reference/stage_input.h"

struct input {
  struct eo_design design;
  int end;
  enum eo_stage_pivot pivot;
  struct eo_numbers s, eta, phase;
};

static const struct eo_field input[] = {
    EO_STAGE_GEAR_PAIR(struct input),
    EO_STAGE_ALIGNMENT(struct input),
    EO_STAGE_MODIFICATION(struct input),
    EO_STAGE_END(struct input, end),
    EO_STAGE_PIVOT(struct input, pivot),
    EO_SERIES(struct input, s, "s_mm", &eo_unit_mm, EO_STAGE_MOST, -1e3, 1e3, 0,
              "places: path coordinate from the pitch point, + to the pinion's tip; beyond the path of contact the gap "
              "of the tip corner"),
    EO_SERIES(struct input, eta, "eta_mm", &eo_unit_mm, EO_STAGE_MOST, -5e3, 5e3, 0,
              "places: axial from mid face, + on the side that meets first; as many as of s_mm"),
    EO_SERIES(struct input, phase, "phase_mm", &eo_unit_mm, EO_STAGE_MOST, -1e3, 1e3, 0,
              "phases c of a transverse slice in mesh, lead and shaft angle errors apart"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

enum { GAP, SLOPE, PINION, GEAR, PLACE_COLUMNS };
enum { SLICE, SLICE_SLOPE, SLICE_COLUMNS };
struct output {
  double datum;
  struct eo_numbers place[PLACE_COLUMNS], slice[SLICE_COLUMNS];
};

static const struct eo_field output[] = {
    EO_OUT(struct output, datum, "datum_um", &eo_unit_um, "smallest gap anywhere on the active flank"),
    EO_OUT_SERIES(struct output, place[GAP], "gap_um", &eo_unit_um, "at each place, normal to the flank"),
    EO_OUT_SERIES(struct output, place[SLOPE], "slope", NULL, "d gap / ds at constant eta"),
    EO_OUT_SERIES(struct output, place[PINION], "pinion_s_mm", &eo_unit_mm, "where on the pinion's flank"),
    EO_OUT_SERIES(struct output, place[GEAR], "gear_s_mm", &eo_unit_mm, "where on the gear's flank"),
    EO_OUT_SERIES(struct output, slice[SLICE], "slice_gap_um", &eo_unit_um,
                  "exact gap of the slice at each phase, normal"),
    EO_OUT_SERIES(struct output, slice[SLICE_SLOPE], "slice_slope", NULL, "d gap / dc"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  struct eo_design design = given->design;
  struct eo_stage_field field;
  EO_TRY(eo_stage_same_length(&given->s, "/s_mm", &given->eta, "/eta_mm", error));
  EO_TRY(eo_stage_field_init(&field, &design, given->end, given->pivot, error));
  EO_TRY(eo_stage_columns(PLACE_COLUMNS, found->place, given->s.count, error));
  EO_TRY(eo_stage_columns(SLICE_COLUMNS, found->slice, given->phase.count, error));
  found->datum = eo_gap_field_datum(&field.gap);
  for (int i = 0; i < given->s.count; i++) {
    double place[2];
    found->place[GAP].value[i] = eo_gap_field_at(&field.gap, given->s.value[i], given->eta.value[i],
                                                 &found->place[SLOPE].value[i], place);
    found->place[PINION].value[i] = place[EO_PINION];
    found->place[GEAR].value[i] = place[EO_GEAR];
  }
  for (int i = 0; i < given->phase.count; i++)
    found->slice[SLICE].value[i] = eo_slice_gap_at(&field.gap.slice, given->phase.value[i],
                                                   &found->slice[SLICE_SLOPE].value[i]);
  return EO_OK;
}

const struct eo_stage eo_stage_gap = {
    "gap", "distance of the flanks of one end before any load", &input_table, &output_table, true, run};
