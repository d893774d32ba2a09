/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/stage_input.h"

#include <stdlib.h>
#include <string.h>

const char *const eo_stage_pivots[] = {"groove", "mid_face", NULL};

enum eo_code eo_stage_complete(struct eo_design *design, struct eo_geometry *geometry, int end, struct eo_error *error)
{
  if (end >= design->gear_pair.ends)
    return eo_error_set(error, EO_ERROR_INPUT, "/end", "The pair has one end, the left one.");
  return eo_design_complete(design, geometry, error);
}

enum eo_code eo_stage_field_init(struct eo_stage_field *field, struct eo_design *design, int end,
                                 enum eo_stage_pivot pivot, struct eo_error *error)
{
  enum eo_code code = eo_stage_complete(design, &field->geometry, end, error);
  if (code)
    return code;
  const struct eo_alignment *alignment = &design->alignment;
  bool own = pivot == EO_PIVOT_MID_FACE || design->gear_pair.ends == 1;
  field->pivot = own ? 0 : (design->gear_pair.face_width + design->gear_pair.groove_width) / 2;
  eo_corner_gap_init(field->corner, &field->geometry);
  eo_gap_field_init(&field->gap, &field->geometry, &design->modification.flank[EO_PINION][end],
                    &design->modification.flank[EO_GEAR][end], end, alignment->shaft_angle_in_plane,
                    alignment->shaft_angle_out_of_plane, field->pivot, field->corner);
  return EO_OK;
}

enum eo_code eo_stage_same_length(const struct eo_numbers *first, const char *first_key,
                                  const struct eo_numbers *second, const char *key, struct eo_error *error)
{
  if (first->count == second->count)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT, key, "%d entries, but %d in %s.", second->count, first->count,
                      first_key + 1);
}

enum eo_code eo_stage_columns(int columns, struct eo_numbers *series, int rows, struct eo_error *error)
{
  for (int i = 0; i < columns; i++) {
    double *value = calloc(rows ? (size_t)rows : 1, sizeof *value);
    if (!value)
      return eo_error_memory(error);
    series[i] = (struct eo_numbers){rows, value};
  }
  return EO_OK;
}

enum eo_code eo_stage_copy(struct eo_numbers *series, int rows, const double *value, struct eo_error *error)
{
  enum eo_code code = eo_stage_columns(1, series, rows, error);
  if (!code)
    memcpy(series->value, value, sizeof *value * (size_t)rows);
  return code;
}
