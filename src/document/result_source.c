/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of a result are written from: the scratch of one thread, and columns over the mesh cycle. */
#include "document/result_private.h"

#include <stdlib.h>

bool eo_result_has(const struct eo_result_source *source, unsigned part, const struct eo_case_result *load_case)
{
  int only = (int)(source->left_out >> 16 & 0xff) - 1;
  return !(source->left_out & part) && (!load_case || only < 0 || load_case == &source->evaluation->load_case[only]);
}

bool eo_result_has_overview(const struct eo_result_source *source, unsigned part,
                            const struct eo_case_result *load_case)
{
  return source->left_out & EO_RESULT_OVERVIEW || eo_result_has(source, part, load_case);
}

/* The usual number of digits, or fewer where the answer is to have at most so many, and `less` of that. */
static int digits_of(int usual, unsigned left_out, int less)
{
  int most = (int)(left_out >> 24) - less;
  return left_out >> 24 && most < usual ? most : usual;
}

struct eo_series eo_result_curve(const struct eo_result_source *source, int end, const double *value, double scale)
{
  return (struct eo_series){.value = value,
                            .count = source->positions,
                            .lag = end == EO_RIGHT ? source->lag : 0,
                            .scale = scale,
                            .digits = source->digits};
}

struct eo_contact_pattern *eo_result_pattern(const struct eo_result_source *source, int end)
{
  return &source->pattern[end == EO_RIGHT && source->pair->right];
}

json_t *eo_result_right_face(const struct eo_result_source *source, int count, const double *place)
{
  enum { MOST = 64 };
  double right[MOST];
  if (!source->pair->right || !place)
    return json_null();
  for (int i = 0; i < count && i < MOST; i++)
    right[i] = place[i] * source->pair->right->geometry.face_width / source->pair->geometry.face_width;
  return eo_json_reals(count, right, 1, &eo_unit_mm, source->digits);
}

struct eo_series eo_result_map(const struct eo_result_source *source, const double *value)
{
  return (struct eo_series){.value = source->left_out & EO_RESULT_NO_MAPS ? NULL : value,
                            .rows = EO_PATTERN_ROWS,
                            .count = EO_PATTERN_COLUMNS,
                            .scale = 1,
                            .digits = source->map_digits};
}

json_t *eo_result_position(const struct eo_result_source *source)
{
  for (int j = 0; j < source->positions; j++)
    source->scratch[j] = source->pair->grid->position[j].phase;
  return eo_json_column(source->positions, source->scratch, 1 / source->pair->geometry.transverse_base_pitch, NULL,
                        source->digits);
}

bool eo_result_source_init(struct eo_result_source *source, const struct eo_analysis *analysis,
                           const struct eo_design *design, unsigned left_out)
{
  const struct eo_evaluation *evaluation = analysis->evaluation;
  *source =
      (struct eo_result_source){.analysis = analysis,
                                .evaluation = evaluation,
                                .pair = analysis->pair,
                                .design = design,
                                .ends = evaluation->ends,
                                .positions = evaluation->positions,
                                .lag = eo_evaluator_stagger(analysis->pair, design, &evaluation->load_case[0].running),
                                .normal = cos(analysis->pair->geometry.base_helix_angle),
                                .helix = eo_pair_double_helix(analysis->pair),
                                .left_out = left_out,
                                .digits = digits_of(EO_DIGITS_CURVE, left_out, 0),
                                .map_digits = digits_of(EO_DIGITS_MAP, left_out, 2)};
  source->pattern = malloc(2 * sizeof *source->pattern);
  source->scratch = calloc((size_t)evaluation->positions, sizeof *source->scratch);
  for (int half = 0; source->pattern && half < eo_pair_halves(source->pair); half++)
    eo_contact_pattern_init(&source->pattern[half], eo_pair_half(source->pair, half)->grid);
  return source->pattern && source->scratch;
}

void eo_result_source_write_only(struct eo_result_source *source)
{
  source->ready = EO_DIGITS_READY;
  source->digits |= EO_DIGITS_READY;
  source->map_digits |= EO_DIGITS_READY;
}

void eo_result_source_done(struct eo_result_source *source)
{
  free(source->pattern);
  free(source->scratch);
}
