/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is measured on the members and between them, as a document. */
#include <math.h>
#include <stdlib.h>

#include "document/completion.h"
#include "format/object.h"
#include "rating/pair_dimensions.h"

#define TRIPLE "[nominal, with the upper allowance, with the lower allowance]"
static const struct eo_outline_row member_rows[] = {
    EO_KEY("reference_diameter_mm", "number", "d", .unit = &eo_unit_mm,
           EO_AT(struct eo_member_dimensions, reference_diameter)),
    EO_KEY("base_diameter_mm", "number", "d_b", .unit = &eo_unit_mm, EO_AT(struct eo_member_dimensions, base_diameter)),
    EO_KEY("tip_diameter_mm", "number", "d_a", .unit = &eo_unit_mm, EO_AT(struct eo_member_dimensions, tip_diameter)),
    EO_KEY("root_diameter_mm", "[number]", "d_f of the tooth that is cut, " TRIPLE, .unit = &eo_unit_mm),
    EO_KEY("form_diameter_mm", "[number]", "d_Ff, where the involute starts, " TRIPLE, .unit = &eo_unit_mm),
    EO_KEY("active_start_diameter_mm", "number", "d_Nf, where contact with the mate's tip starts", .unit = &eo_unit_mm,
           EO_AT(struct eo_member_dimensions, active_start_diameter)),
    EO_KEY("thickness_allowance_um", "[number]", "A_sn, " TRIPLE, .unit = &eo_unit_um),
    EO_KEY("generating_shift", "[number]", "x_E that is cut, " TRIPLE),
    EO_KEY("normal_thickness_mm", "[number]", "s_n at the reference cylinder, " TRIPLE, .unit = &eo_unit_mm),
    EO_KEY("chord_mm", "[number]", "normal chord at the reference cylinder, " TRIPLE, .unit = &eo_unit_mm),
    EO_KEY("chord_height_mm", "[number]", "from the tip down to that chord, " TRIPLE, .unit = &eo_unit_mm),
    EO_KEY("tip_thickness_mm", "number", "s_an, normal, without allowance", .unit = &eo_unit_mm,
           EO_AT(struct eo_member_dimensions, tip_thickness)),
    EO_KEY("teeth_spanned", "integer?", "k; null: no span, for the reason"),
    EO_KEY("span_mm", "[number?]", "W_k, " TRIPLE, .unit = &eo_unit_mm),
    EO_KEY("span_reason", "text?", "why there is no span", EO_AT(struct eo_member_dimensions, span_reason)),
    EO_KEY("ball_mm", "number?", "D_M; null: no balls, for the reason", .unit = &eo_unit_mm,
           EO_AT(struct eo_member_dimensions, ball)),
    EO_KEY("over_one_ball_mm", "[number?]", "M_rK from the axis, " TRIPLE, .unit = &eo_unit_mm),
    EO_KEY("over_two_balls_mm", "[number?]", "M_dK in one transverse plane, " TRIPLE, .unit = &eo_unit_mm),
    EO_KEY("over_pins_mm", "[number?]", "M_dR, " TRIPLE, .unit = &eo_unit_mm),
    EO_KEY("ball_reason", "text?", "why there are no balls", EO_AT(struct eo_member_dimensions, ball_reason)),
};
static const struct eo_outline member_outline = EO_OUTLINE("MemberDimensions", member_rows);

static const struct eo_outline_row backlash_rows[] = {
    EO_KEY("normal_um", "[number?]", "j_bn: of a feeler gauge; [smallest, mean, largest]", .unit = &eo_unit_um),
    EO_KEY("circumferential_um", "[number?]", "j_wt at the working pitch circles; [smallest, mean, largest]",
           .unit = &eo_unit_um),
    EO_KEY("radial_um", "[number?]", "j_r: how far the axes may approach; [smallest, mean, largest]",
           .unit = &eo_unit_um),
};
static const struct eo_outline backlash_outline = EO_OUTLINE("BacklashRange", backlash_rows);

static const struct eo_outline_row dimension_rows[] = {
    EO_KEY("pinion", "object", "of the pinion", .outline = &member_outline),
    EO_KEY("gear", "object", "of the gear", .outline = &member_outline),
    EO_KEY("centre_distance_mm", "number", "a", .unit = &eo_unit_mm),
    EO_KEY("centre_distance_allowance_um", "number", "A_a, both ways", .unit = &eo_unit_um),
    EO_KEY("backlash", "object",
           "over the thickness allowances and the centre distance allowance; heat, runout and bearings are not in it",
           .outline = &backlash_outline),
};
const struct eo_outline eo_outline_dimensions = EO_OUTLINE("Dimensions", dimension_rows);

static void put_triple(struct eo_object *object, const char *key, const double *value, const struct eo_unit *unit)
{
  eo_object_put(object, key, eo_json_column(EO_MEASURED, value, 1, unit, EO_DIGITS_NUMBER));
}

static json_t *text_or_null(const char *text)
{
  return *text ? json_string(text) : json_null();
}

static json_t *encode_member(const struct eo_member_dimensions *dimensions)
{
  struct eo_object object = eo_object_open_as(&member_outline);
  double chord[EO_MEASURED], height[EO_MEASURED];
  for (int k = 0; k < EO_MEASURED; k++) {
    chord[k] = dimensions->chord[k].thickness;
    height[k] = dimensions->chord[k].height;
  }
  eo_object_put_number(&object, "reference_diameter_mm", dimensions->reference_diameter);
  eo_object_put_number(&object, "base_diameter_mm", dimensions->base_diameter);
  eo_object_put_number(&object, "tip_diameter_mm", dimensions->tip_diameter);
  put_triple(&object, "root_diameter_mm", dimensions->root_diameter, &eo_unit_mm);
  put_triple(&object, "form_diameter_mm", dimensions->form_diameter, &eo_unit_mm);
  eo_object_put_number(&object, "active_start_diameter_mm", dimensions->active_start_diameter);
  put_triple(&object, "thickness_allowance_um", dimensions->allowance, &eo_unit_um);
  put_triple(&object, "generating_shift", dimensions->generating_shift, NULL);
  put_triple(&object, "normal_thickness_mm", dimensions->normal_thickness, &eo_unit_mm);
  put_triple(&object, "chord_mm", chord, &eo_unit_mm);
  put_triple(&object, "chord_height_mm", height, &eo_unit_mm);
  eo_object_put_number(&object, "tip_thickness_mm", dimensions->tip_thickness);
  eo_object_put(&object, "teeth_spanned",
                dimensions->teeth_spanned ? json_integer(dimensions->teeth_spanned) : json_null());
  put_triple(&object, "span_mm", dimensions->span, &eo_unit_mm);
  eo_object_put(&object, "span_reason", text_or_null(dimensions->span_reason));
  eo_object_put_number(&object, "ball_mm", dimensions->ball);
  put_triple(&object, "over_one_ball_mm", dimensions->over_one_ball, &eo_unit_mm);
  put_triple(&object, "over_two_balls_mm", dimensions->over_two_balls, &eo_unit_mm);
  put_triple(&object, "over_pins_mm", dimensions->over_pins, &eo_unit_mm);
  eo_object_put(&object, "ball_reason", text_or_null(dimensions->ball_reason));
  return eo_object_close(&object);
}

static json_t *encode_backlash(const struct eo_pair_dimensions *dimensions)
{
  const struct eo_backlash *range[EO_MEASURED] = {&dimensions->smallest, &dimensions->mean, &dimensions->largest};
  double normal[EO_MEASURED], around[EO_MEASURED], radial[EO_MEASURED];
  struct eo_object object = eo_object_open_as(&backlash_outline);
  for (int k = 0; k < EO_MEASURED; k++) {
    normal[k] = range[k]->normal;
    around[k] = range[k]->circumferential;
    radial[k] = range[k]->radial;
  }
  put_triple(&object, "normal_um", normal, &eo_unit_um);
  put_triple(&object, "circumferential_um", around, &eo_unit_um);
  put_triple(&object, "radial_um", radial, &eo_unit_um);
  return eo_object_close(&object);
}

json_t *eo_dimensions_encode(const struct eo_gear_pair *pair, const struct eo_geometry *geometry)
{
  struct eo_pair_dimensions *dimensions = calloc(1, sizeof *dimensions);
  struct eo_object object = eo_object_open_as(&eo_outline_dimensions);
  if (!dimensions) {
    json_decref(object.json);
    return NULL;
  }
  eo_pair_dimensions_init(dimensions, pair, geometry);
  eo_object_put(&object, "pinion", encode_member(&dimensions->member[EO_PINION]));
  eo_object_put(&object, "gear", encode_member(&dimensions->member[EO_GEAR]));
  eo_object_put_number(&object, "centre_distance_mm", geometry->centre_distance);
  eo_object_put_number(&object, "centre_distance_allowance_um", dimensions->centre_distance_allowance);
  eo_object_put(&object, "backlash", encode_backlash(dimensions));
  free(dimensions);
  return eo_object_close(&object);
}
