/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The modifications of one flank. Diameters are written, never lengths: d(u) = 2 sqrt(r_b^2 + (T + u/k_u)^2), the
   inverse of rexs_profile.c. What has no component of its own goes as a topography over the whole flank. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "exchange/flank_amount.h"
#include "exchange/rexs_export.h"

enum { ROWS = 21, COLUMNS = 21 }; /* of a topography */

struct writer {
  struct eo_rexs_builder *builder;
  const struct eo_rexs_flank_export *flank;
  const json_t *block;
  int flank_id, id;
};

/* A number of the block; 0 where it is absent or null. */
static double number(const struct writer *writer, const char *key)
{
  return json_number_value(json_object_get(writer->block, key));
}

static const char *word(const struct writer *writer, const char *key, const char *otherwise)
{
  const char *text = json_string_value(json_object_get(writer->block, key));
  return text && strcmp(text, "as_relief_shape") != 0 ? text : otherwise;
}

static double tip_end(const struct writer *writer) /* u, mm */
{
  const struct eo_geometry *geometry = writer->flank->geometry;
  return 1e3 * (writer->flank->member == EO_PINION ? geometry->rack_top : -geometry->rack_bottom);
}

static double root_end(const struct writer *writer)
{
  const struct eo_geometry *geometry = writer->flank->geometry;
  return 1e3 * (writer->flank->member == EO_PINION ? geometry->rack_bottom : -geometry->rack_top);
}

static double diameter_of_roll(const struct writer *writer, double roll)
{
  double base = 1e3 * writer->flank->geometry->base_radius[writer->flank->member];
  return 2 * sqrt(base * base + roll * roll);
}

static double roll_of(const struct writer *writer, double u)
{
  const struct eo_geometry *geometry = writer->flank->geometry;
  return 1e3 * geometry->tangent_length[writer->flank->member] + u / geometry->rack_factor;
}

static double diameter_of(const struct writer *writer, double u)
{
  return diameter_of_roll(writer, roll_of(writer, u));
}

static void begin(struct writer *writer, const char *type)
{
  eo_rexs_build(writer->builder, writer->id, type, "");
  eo_rexs_relate(writer->builder, "reference", 0, "origin", writer->flank_id, "referenced", writer->id, (char *)NULL);
  writer->id++;
}

static void end(struct writer *writer)
{
  eo_rexs_build_flag(writer->builder, "is_additive_modification", true);
}

/* The diameter where a relief starts, by whichever of the keys states it; prefix "tip_relief", sign +1, or root, -1. */
static double start_diameter(const struct writer *writer, const char *prefix, double sign)
{
  static const char *const forms[] = {"diameter_mm", "roll_length_mm", "roll_angle_deg", "length_mm"};
  char key[60];
  for (int i = 0; i < 4; i++) {
    snprintf(key, sizeof key, "%s_%s", prefix, forms[i]);
    double value = number(writer, key), base = 1e3 * writer->flank->geometry->base_radius[writer->flank->member];
    if (!(value > 0))
      continue;
    double end_roll = roll_of(writer, sign > 0 ? tip_end(writer) : root_end(writer));
    return i == 0   ? value
           : i == 1 ? diameter_of_roll(writer, value)
           : i == 2 ? diameter_of_roll(writer, value * M_PI / 180 * base)
                    : diameter_of_roll(writer, end_roll - sign * value);
  }
  snprintf(key, sizeof key, "%s_start_mm", prefix);
  return diameter_of(writer, sign * number(writer, key));
}

static void write_relief(struct writer *writer, bool tip)
{
  double amount = number(writer, tip ? "tip_relief_um" : "root_relief_um");
  double reach = tip ? tip_end(writer) : root_end(writer);
  if (amount == 0)
    return;
  begin(writer, tip ? "tip_relief" : "root_relief");
  eo_rexs_build_number(writer->builder, tip ? "tip_relief_datum_diameter" : "root_relief_datum_diameter",
                       start_diameter(writer, tip ? "tip_relief" : "root_relief", tip ? 1 : -1));
  eo_rexs_build_number(writer->builder, tip ? "tip_relief_evaluation_reference" : "root_relief_evaluation_reference",
                       diameter_of(writer, reach));
  /* without what the crowning has taken off there already */
  eo_rexs_build_number(writer->builder, tip ? "tip_relief_depth" : "root_relief_depth",
                       amount / 1e3 - number(writer, "profile_crowning_per_mm") * reach * reach);
  eo_rexs_build_word(
      writer->builder, "shape_of_relief",
      word(writer, tip ? "tip_relief_shape" : "root_relief_shape", word(writer, "relief_shape", "parabolic")));
  eo_rexs_build_flag(writer->builder, "specify_tangential_transition", false);
  end(writer);
}

/* A parabola about u = highest, with its amounts at both ends of the active profile. */
static void write_crowning(struct writer *writer, double coefficient, double highest)
{
  if (coefficient == 0)
    return;
  begin(writer, "profile_crowning");
  eo_rexs_build_number(writer->builder, "profile_crowning_at_tip", coefficient * pow(tip_end(writer) - highest, 2));
  eo_rexs_build_number(writer->builder, "diameter_where_profile_crowning_tip_is_specified",
                       diameter_of(writer, tip_end(writer)));
  eo_rexs_build_number(writer->builder, "profile_crowning_at_root", coefficient * pow(root_end(writer) - highest, 2));
  eo_rexs_build_number(writer->builder, "diameter_where_profile_crowning_root_is_specified",
                       diameter_of(writer, root_end(writer)));
  eo_rexs_build_number(writer->builder, "profile_highest_point", diameter_of(writer, highest));
  eo_rexs_build_word(writer->builder, "shape_of_profile_crowning", "parabolic");
  end(writer);
}

static void write_slope_and_twist(struct writer *writer)
{
  double slope = number(writer, "profile_slope_um") / 1e3, twist = number(writer, "twist_um") / 1e3;
  double half = 1e3 * writer->flank->geometry->face_width / 2;
  if (slope != 0) {
    begin(writer, "profile_slope");
    eo_rexs_build_number(writer->builder, "profile_slope", slope);
    eo_rexs_build_number(writer->builder, "profile_evaluation_start", diameter_of(writer, root_end(writer)));
    eo_rexs_build_number(writer->builder, "profile_evaluation_end", diameter_of(writer, tip_end(writer)));
    end(writer);
  }
  if (twist != 0) {
    begin(writer, "profile_twist");
    eo_rexs_build_number(writer->builder, "profile_twist", writer->flank->leading * twist);
    eo_rexs_build_number(writer->builder, "profile_twist_evaluation_start", diameter_of(writer, root_end(writer)));
    eo_rexs_build_number(writer->builder, "profile_twist_evaluation_end", diameter_of(writer, tip_end(writer)));
    eo_rexs_build_number(writer->builder, "position_of_profile_twist_datum_face", -half);
    eo_rexs_build_number(writer->builder, "position_of_profile_twist_non_datum_face", half);
    end(writer);
  }
}

static void write_lead(struct writer *writer)
{
  double half = 1e3 * writer->flank->geometry->face_width / 2, crowning = number(writer, "lead_crowning_um") / 1e3;
  double slope = (number(writer, "helix_slope_um") + 2 * number(writer, "lead_slope_um")) / 1e3;
  if (crowning != 0) {
    begin(writer, "helix_crowning");
    eo_rexs_build_number(writer->builder, "helix_crowning_amount_datum_face", crowning);
    eo_rexs_build_number(writer->builder, "helix_crowning_amount_non_datum_face", crowning);
    eo_rexs_build_number(writer->builder, "coordinate_where_helix_crowning_is_specified_datum_face", -half);
    eo_rexs_build_number(writer->builder, "coordinate_where_helix_crowning_is_specified_non_datum_face", half);
    eo_rexs_build_number(writer->builder, "helix_highest_point", 0);
    eo_rexs_build_word(writer->builder, "shape_of_helix_crowning", "parabolic");
    end(writer);
  }
  if (slope != 0) {
    begin(writer, "helix_slope");
    eo_rexs_build_number(writer->builder, "helix_slope", writer->flank->leading * slope);
    eo_rexs_build_word(writer->builder, "helix_evaluation_reference", "helix_evaluation_length");
    eo_rexs_build_number(writer->builder, "helix_evaluation_start", -half);
    eo_rexs_build_number(writer->builder, "helix_evaluation_end", half);
    end(writer);
  }
}

/* The design has it up to the common face, REXS up to the gear's own: it goes on beyond in its shape. */
static void write_end_relief(struct writer *writer, bool leading)
{
  bool datum = leading == (writer->flank->leading < 0);
  double amount = number(writer, leading ? "leading_end_relief_um" : "trailing_end_relief_um"),
         length = number(writer, leading ? "leading_end_relief_length_mm" : "trailing_end_relief_length_mm");
  const char *shape = word(writer, leading ? "leading_end_relief_shape" : "trailing_end_relief_shape", "parabolic");
  const struct eo_geometry *geometry = writer->flank->geometry;
  double own = length + 1e3 * (geometry->member_width[writer->flank->member] - geometry->face_width) / 2;
  if (amount == 0 || length == 0)
    return;
  begin(writer, datum ? "end_relief_datum_face" : "end_relief_non_datum_face");
  eo_rexs_build_number(writer->builder, datum ? "end_relief_depth_datum_face" : "end_relief_depth_non_datum_face",
                       eo_relief_carry(shape, amount / 1e3, length, own));
  eo_rexs_build_number(writer->builder, datum ? "end_relief_length_datum_face" : "end_relief_length_non_datum_face",
                       own);
  eo_rexs_build_word(writer->builder, "shape_of_relief", shape);
  end(writer);
}

static void write_topography(struct writer *writer)
{
  double diameter[ROWS], along[COLUMNS], amount[ROWS * COLUMNS], half = 1e3 * writer->flank->geometry->face_width / 2;
  for (int k = 0; k < COLUMNS; k++)
    along[k] = half * (2. * k / (COLUMNS - 1) - 1);
  for (int i = 0; i < ROWS; i++) {
    double u = root_end(writer) + (tip_end(writer) - root_end(writer)) * i / (ROWS - 1);
    diameter[i] = diameter_of(writer, u);
    for (int k = 0; k < COLUMNS; k++)
      amount[i * COLUMNS + k] = 1e3 * eo_flank_amount(writer->flank->design, writer->flank->geometry,
                                                      writer->flank->member, writer->flank->end, writer->flank->coast,
                                                      u * 1e-3, writer->flank->leading * along[k] * 1e-3);
  }
  begin(writer, "topographical_modification");
  eo_rexs_build_numbers(writer->builder, "diameters_of_topographical_modification", ROWS, diameter);
  eo_rexs_build_numbers(writer->builder, "coordinates_of_topographical_modification", COLUMNS, along);
  eo_rexs_build_numbers(writer->builder, "topographical_modification_amounts", ROWS * COLUMNS, amount);
  end(writer);
}

/* Whether REXS has a component for each part of the modification. */
static bool has_components(const struct writer *writer)
{
  static const char *const shapes[] = {"relief_shape", "tip_relief_shape", "root_relief_shape",
                                       "leading_end_relief_shape", "trailing_end_relief_shape"};
  static const char *const corners[] = {"tip_leading_triangular_relief_um", "tip_trailing_triangular_relief_um",
                                        "root_leading_triangular_relief_um", "root_trailing_triangular_relief_um"};
  bool reliefs = number(writer, "tip_relief_um") != 0 || number(writer, "root_relief_um") != 0;
  for (int i = 0; i < 5; i++)
    if (strcmp(word(writer, shapes[i], ""), "exponent") == 0)
      return false;
  for (int i = 0; i < 4; i++)
    if (number(writer, corners[i]) != 0)
      return false;
  if (json_is_object(json_object_get(writer->block, "grid")))
    return false;
  const char *shape = word(writer, "relief_shape", "parabolic");
  bool parabolic = strcmp(word(writer, "tip_relief_shape", shape), "parabolic") == 0 &&
                   strcmp(word(writer, "root_relief_shape", shape), "parabolic") == 0;
  return number(writer, "profile_crowning_per_mm") == 0 || !reliefs || parabolic;
}

int eo_rexs_export_flank(struct eo_rexs_builder *builder, const struct eo_rexs_flank_export *flank, const json_t *block,
                         int flank_id, int id)
{
  struct writer writer = {builder, flank, block, flank_id, id};
  double half = (tip_end(&writer) - root_end(&writer)) / 2;
  if (!block)
    return id;
  if (!has_components(&writer)) {
    write_topography(&writer);
    return writer.id;
  }
  write_relief(&writer, true);
  write_relief(&writer, false);
  write_crowning(&writer, number(&writer, "profile_crowning_per_mm"), 0);
  write_crowning(&writer, number(&writer, "profile_crowning_um") * 1e-3 / (half * half),
                 (tip_end(&writer) + root_end(&writer)) / 2);
  write_slope_and_twist(&writer);
  write_lead(&writer);
  write_end_relief(&writer, true);
  write_end_relief(&writer, false);
  return writer.id;
}
