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
static double number(const struct writer *w, const char *key)
{
  return json_number_value(json_object_get(w->block, key));
}

static const char *word(const struct writer *w, const char *key, const char *otherwise)
{
  const char *text = json_string_value(json_object_get(w->block, key));
  return text && strcmp(text, "as_relief_shape") != 0 ? text : otherwise;
}

static double tip_end(const struct writer *w) /* u, mm */
{
  const struct eo_geometry *g = w->flank->geometry;
  return 1e3 * (w->flank->member == EO_PINION ? g->rack_top : -g->rack_bottom);
}

static double root_end(const struct writer *w)
{
  const struct eo_geometry *g = w->flank->geometry;
  return 1e3 * (w->flank->member == EO_PINION ? g->rack_bottom : -g->rack_top);
}

static double diameter_of_roll(const struct writer *w, double roll)
{
  double base = 1e3 * w->flank->geometry->base_radius[w->flank->member];
  return 2 * sqrt(base * base + roll * roll);
}

static double roll_of(const struct writer *w, double u)
{
  const struct eo_geometry *g = w->flank->geometry;
  return 1e3 * g->tangent_length[w->flank->member] + u / g->rack_factor;
}

static double diameter_of(const struct writer *w, double u)
{
  return diameter_of_roll(w, roll_of(w, u));
}

static void begin(struct writer *w, const char *type)
{
  eo_rexs_build(w->builder, w->id, type, "");
  eo_rexs_relate(w->builder, "reference", 0, "origin", w->flank_id, "referenced", w->id, (char *)NULL);
  w->id++;
}

static void end(struct writer *w)
{
  eo_rexs_build_flag(w->builder, "is_additive_modification", true);
}

/* The diameter where a relief starts, by whichever of the keys states it; prefix "tip_relief", sign +1, or root, -1. */
static double start_diameter(const struct writer *w, const char *prefix, double sign)
{
  static const char *const forms[] = {"diameter_mm", "roll_length_mm", "roll_angle_deg", "length_mm"};
  char key[60];
  for (int i = 0; i < 4; i++) {
    snprintf(key, sizeof key, "%s_%s", prefix, forms[i]);
    double value = number(w, key), base = 1e3 * w->flank->geometry->base_radius[w->flank->member];
    if (!(value > 0))
      continue;
    double end_roll = roll_of(w, sign > 0 ? tip_end(w) : root_end(w));
    return i == 0   ? value
           : i == 1 ? diameter_of_roll(w, value)
           : i == 2 ? diameter_of_roll(w, value * M_PI / 180 * base)
                    : diameter_of_roll(w, end_roll - sign * value);
  }
  snprintf(key, sizeof key, "%s_start_mm", prefix);
  return diameter_of(w, sign * number(w, key));
}

static void write_relief(struct writer *w, bool tip)
{
  double amount = number(w, tip ? "tip_relief_um" : "root_relief_um");
  double reach = tip ? tip_end(w) : root_end(w);
  if (amount == 0)
    return;
  begin(w, tip ? "tip_relief" : "root_relief");
  eo_rexs_build_number(w->builder, tip ? "tip_relief_datum_diameter" : "root_relief_datum_diameter",
                       start_diameter(w, tip ? "tip_relief" : "root_relief", tip ? 1 : -1));
  eo_rexs_build_number(w->builder, tip ? "tip_relief_evaluation_reference" : "root_relief_evaluation_reference",
                       diameter_of(w, reach));
  /* without what the crowning has taken off there already */
  eo_rexs_build_number(w->builder, tip ? "tip_relief_depth" : "root_relief_depth",
                       amount / 1e3 - number(w, "profile_crowning_per_mm") * reach * reach);
  eo_rexs_build_word(w->builder, "shape_of_relief",
                     word(w, tip ? "tip_relief_shape" : "root_relief_shape", word(w, "relief_shape", "parabolic")));
  eo_rexs_build_flag(w->builder, "specify_tangential_transition", false);
  end(w);
}

/* A parabola about u = highest, with its amounts at both ends of the active profile. */
static void write_crowning(struct writer *w, double coefficient, double highest)
{
  if (coefficient == 0)
    return;
  begin(w, "profile_crowning");
  eo_rexs_build_number(w->builder, "profile_crowning_at_tip", coefficient * pow(tip_end(w) - highest, 2));
  eo_rexs_build_number(w->builder, "diameter_where_profile_crowning_tip_is_specified", diameter_of(w, tip_end(w)));
  eo_rexs_build_number(w->builder, "profile_crowning_at_root", coefficient * pow(root_end(w) - highest, 2));
  eo_rexs_build_number(w->builder, "diameter_where_profile_crowning_root_is_specified", diameter_of(w, root_end(w)));
  eo_rexs_build_number(w->builder, "profile_highest_point", diameter_of(w, highest));
  eo_rexs_build_word(w->builder, "shape_of_profile_crowning", "parabolic");
  end(w);
}

static void write_slope_and_twist(struct writer *w)
{
  double slope = number(w, "profile_slope_um") / 1e3, twist = number(w, "twist_um") / 1e3;
  double half = 1e3 * w->flank->geometry->face_width / 2;
  if (slope != 0) {
    begin(w, "profile_slope");
    eo_rexs_build_number(w->builder, "profile_slope", slope);
    eo_rexs_build_number(w->builder, "profile_evaluation_start", diameter_of(w, root_end(w)));
    eo_rexs_build_number(w->builder, "profile_evaluation_end", diameter_of(w, tip_end(w)));
    end(w);
  }
  if (twist != 0) {
    begin(w, "profile_twist");
    eo_rexs_build_number(w->builder, "profile_twist", w->flank->leading * twist);
    eo_rexs_build_number(w->builder, "profile_twist_evaluation_start", diameter_of(w, root_end(w)));
    eo_rexs_build_number(w->builder, "profile_twist_evaluation_end", diameter_of(w, tip_end(w)));
    eo_rexs_build_number(w->builder, "position_of_profile_twist_datum_face", -half);
    eo_rexs_build_number(w->builder, "position_of_profile_twist_non_datum_face", half);
    end(w);
  }
}

static void write_lead(struct writer *w)
{
  double half = 1e3 * w->flank->geometry->face_width / 2, crowning = number(w, "lead_crowning_um") / 1e3;
  double slope = (number(w, "helix_slope_um") + 2 * number(w, "lead_slope_um")) / 1e3;
  if (crowning != 0) {
    begin(w, "helix_crowning");
    eo_rexs_build_number(w->builder, "helix_crowning_amount_datum_face", crowning);
    eo_rexs_build_number(w->builder, "helix_crowning_amount_non_datum_face", crowning);
    eo_rexs_build_number(w->builder, "coordinate_where_helix_crowning_is_specified_datum_face", -half);
    eo_rexs_build_number(w->builder, "coordinate_where_helix_crowning_is_specified_non_datum_face", half);
    eo_rexs_build_number(w->builder, "helix_highest_point", 0);
    eo_rexs_build_word(w->builder, "shape_of_helix_crowning", "parabolic");
    end(w);
  }
  if (slope != 0) {
    begin(w, "helix_slope");
    eo_rexs_build_number(w->builder, "helix_slope", w->flank->leading * slope);
    eo_rexs_build_word(w->builder, "helix_evaluation_reference", "helix_evaluation_length");
    eo_rexs_build_number(w->builder, "helix_evaluation_start", -half);
    eo_rexs_build_number(w->builder, "helix_evaluation_end", half);
    end(w);
  }
}

static void write_end_relief(struct writer *w, bool leading)
{
  bool datum = leading == (w->flank->leading < 0);
  double amount = number(w, leading ? "leading_end_relief_um" : "trailing_end_relief_um"),
         length = number(w, leading ? "leading_end_relief_length_mm" : "trailing_end_relief_length_mm");
  if (amount == 0 || length == 0)
    return;
  begin(w, datum ? "end_relief_datum_face" : "end_relief_non_datum_face");
  eo_rexs_build_number(w->builder, datum ? "end_relief_depth_datum_face" : "end_relief_depth_non_datum_face",
                       amount / 1e3);
  eo_rexs_build_number(w->builder, datum ? "end_relief_length_datum_face" : "end_relief_length_non_datum_face", length);
  eo_rexs_build_word(w->builder, "shape_of_relief",
                     word(w, leading ? "leading_end_relief_shape" : "trailing_end_relief_shape", "parabolic"));
  end(w);
}

static void write_topography(struct writer *w)
{
  double diameter[ROWS], along[COLUMNS], amount[ROWS * COLUMNS], half = 1e3 * w->flank->geometry->face_width / 2;
  for (int k = 0; k < COLUMNS; k++)
    along[k] = half * (2. * k / (COLUMNS - 1) - 1);
  for (int i = 0; i < ROWS; i++) {
    double u = root_end(w) + (tip_end(w) - root_end(w)) * i / (ROWS - 1);
    diameter[i] = diameter_of(w, u);
    for (int k = 0; k < COLUMNS; k++)
      amount[i * COLUMNS + k] = 1e3 * eo_flank_amount(w->flank->design, w->flank->geometry, w->flank->member,
                                                      w->flank->end, w->flank->coast, u * 1e-3,
                                                      w->flank->leading * along[k] * 1e-3);
  }
  begin(w, "topographical_modification");
  eo_rexs_build_numbers(w->builder, "diameters_of_topographical_modification", ROWS, diameter);
  eo_rexs_build_numbers(w->builder, "coordinates_of_topographical_modification", COLUMNS, along);
  eo_rexs_build_numbers(w->builder, "topographical_modification_amounts", ROWS * COLUMNS, amount);
  end(w);
}

/* Whether REXS has a component for each part of the modification. */
static bool has_components(const struct writer *w)
{
  static const char *const shapes[] = {"relief_shape", "tip_relief_shape", "root_relief_shape",
                                       "leading_end_relief_shape", "trailing_end_relief_shape"};
  static const char *const corners[] = {"tip_leading_triangular_relief_um", "tip_trailing_triangular_relief_um",
                                        "root_leading_triangular_relief_um", "root_trailing_triangular_relief_um"};
  bool reliefs = number(w, "tip_relief_um") != 0 || number(w, "root_relief_um") != 0;
  for (int i = 0; i < 5; i++)
    if (strcmp(word(w, shapes[i], ""), "exponent") == 0)
      return false;
  for (int i = 0; i < 4; i++)
    if (number(w, corners[i]) != 0)
      return false;
  if (json_is_object(json_object_get(w->block, "grid")))
    return false;
  const char *shape = word(w, "relief_shape", "parabolic");
  bool parabolic = strcmp(word(w, "tip_relief_shape", shape), "parabolic") == 0 &&
                   strcmp(word(w, "root_relief_shape", shape), "parabolic") == 0;
  return number(w, "profile_crowning_per_mm") == 0 || !reliefs || parabolic;
}

int eo_rexs_export_flank(struct eo_rexs_builder *builder, const struct eo_rexs_flank_export *flank, const json_t *block,
                         int flank_id, int id)
{
  struct writer w = {builder, flank, block, flank_id, id};
  double half = (tip_end(&w) - root_end(&w)) / 2;
  if (!block)
    return id;
  if (!has_components(&w)) {
    write_topography(&w);
    return w.id;
  }
  write_relief(&w, true);
  write_relief(&w, false);
  write_crowning(&w, number(&w, "profile_crowning_per_mm"), 0);
  write_crowning(&w, number(&w, "profile_crowning_um") * 1e-3 / (half * half), (tip_end(&w) + root_end(&w)) / 2);
  write_slope_and_twist(&w);
  write_lead(&w);
  write_end_relief(&w, true);
  write_end_relief(&w, false);
  return w.id;
}
