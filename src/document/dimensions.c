/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is measured on the members and between them, as a document. */
#include <math.h>
#include <stdlib.h>

#include "document/completion.h"
#include "format/object.h"
#include "format/outline.h"
#include "rating/pair_dimensions.h"

#define TRIPLE "[nominal, with the upper allowance, with the lower allowance]"
/* One member: as it was found, and what it has with both allowances, as series. */
struct member {
  struct eo_member_dimensions own;
  double thickness[EO_MEASURED], height[EO_MEASURED]; /* of the chords */
  double teeth_spanned;                               /* NaN: none */
  struct eo_series root_diameter, form_diameter, allowance, generating_shift, normal_thickness, chord, chord_height,
      span, over_one_ball, over_two_balls, over_pins;
};

static const struct eo_outline_row member_rows[] = {
    EO_KEY("reference_diameter_mm", "number", "d", .unit = &eo_unit_mm, EO_AT(struct member, own.reference_diameter)),
    EO_KEY("base_diameter_mm", "number", "d_b", .unit = &eo_unit_mm, EO_AT(struct member, own.base_diameter)),
    EO_KEY("tip_diameter_mm", "number", "d_a", .unit = &eo_unit_mm, EO_AT(struct member, own.tip_diameter)),
    EO_KEY("root_diameter_mm", "[number]", "d_f of the tooth that is cut, " TRIPLE, .unit = &eo_unit_mm,
           EO_AT(struct member, root_diameter)),
    EO_KEY("form_diameter_mm", "[number]", "d_Ff, where the involute starts, " TRIPLE, .unit = &eo_unit_mm,
           EO_AT(struct member, form_diameter)),
    EO_KEY("active_start_diameter_mm", "number", "d_Nf, where contact with the mate's tip starts", .unit = &eo_unit_mm,
           EO_AT(struct member, own.active_start_diameter)),
    EO_KEY("thickness_allowance_um", "[number]", "A_sn, " TRIPLE, .unit = &eo_unit_um, EO_AT(struct member, allowance)),
    EO_KEY("generating_shift", "[number]", "x_E that is cut, " TRIPLE, EO_AT(struct member, generating_shift)),
    EO_KEY("normal_thickness_mm", "[number]", "s_n at the reference cylinder, " TRIPLE, .unit = &eo_unit_mm,
           EO_AT(struct member, normal_thickness)),
    EO_KEY("chord_mm", "[number]", "normal chord at the reference cylinder, " TRIPLE, .unit = &eo_unit_mm,
           EO_AT(struct member, chord)),
    EO_KEY("chord_height_mm", "[number]", "from the tip down to that chord, " TRIPLE, .unit = &eo_unit_mm,
           EO_AT(struct member, chord_height)),
    EO_KEY("tip_thickness_mm", "number", "s_an, normal, without allowance", .unit = &eo_unit_mm,
           EO_AT(struct member, own.tip_thickness)),
    EO_KEY("teeth_spanned", "integer?", "k; null: no span, for the reason", EO_AT(struct member, teeth_spanned)),
    EO_KEY("span_mm", "[number?]", "W_k, " TRIPLE, .unit = &eo_unit_mm, EO_AT(struct member, span)),
    EO_KEY("span_reason", "text?", "why there is no span", EO_AT(struct member, own.span_reason)),
    EO_KEY("ball_mm", "number?", "D_M; null: no balls, for the reason", .unit = &eo_unit_mm,
           EO_AT(struct member, own.ball)),
    EO_KEY("over_one_ball_mm", "[number?]", "M_rK from the axis, " TRIPLE, .unit = &eo_unit_mm,
           EO_AT(struct member, over_one_ball)),
    EO_KEY("over_two_balls_mm", "[number?]", "M_dK in one transverse plane, " TRIPLE, .unit = &eo_unit_mm,
           EO_AT(struct member, over_two_balls)),
    EO_KEY("over_pins_mm", "[number?]", "M_dR, " TRIPLE, .unit = &eo_unit_mm, EO_AT(struct member, over_pins)),
    EO_KEY("ball_reason", "text?", "why there are no balls", EO_AT(struct member, own.ball_reason)),
};
static const struct eo_outline member_outline = EO_OUTLINE("MemberDimensions", member_rows);

struct backlash {
  struct eo_series normal, around, radial;
};

static const struct eo_outline_row backlash_rows[] = {
    EO_KEY("normal_um", "[number?]", "j_bn: of a feeler gauge; [smallest, mean, largest]", .unit = &eo_unit_um,
           EO_AT(struct backlash, normal)),
    EO_KEY("circumferential_um", "[number?]", "j_wt at the working pitch circles; [smallest, mean, largest]",
           .unit = &eo_unit_um, EO_AT(struct backlash, around)),
    EO_KEY("radial_um", "[number?]", "j_r: how far the axes may approach; [smallest, mean, largest]",
           .unit = &eo_unit_um, EO_AT(struct backlash, radial)),
};
static const struct eo_outline backlash_outline = EO_OUTLINE("BacklashRange", backlash_rows);

struct dimensions {
  json_t *member[2], *backlash;
  double distance, allowance;
};

static const struct eo_outline_row dimension_rows[] = {
    EO_KEY("pinion", "object", "of the pinion", .outline = &member_outline,
           EO_AT(struct dimensions, member[EO_PINION])),
    EO_KEY("gear", "object", "of the gear", .outline = &member_outline, EO_AT(struct dimensions, member[EO_GEAR])),
    EO_KEY("centre_distance_mm", "number", "a", .unit = &eo_unit_mm, EO_AT(struct dimensions, distance)),
    EO_KEY("centre_distance_allowance_um", "number", "A_a, both ways", .unit = &eo_unit_um,
           EO_AT(struct dimensions, allowance)),
    EO_KEY("backlash", "object",
           "over the thickness allowances and the centre distance allowance; heat, runout and bearings are not in it",
           .outline = &backlash_outline, EO_AT(struct dimensions, backlash)),
};
const struct eo_outline eo_outline_dimensions = EO_OUTLINE("Dimensions", dimension_rows);

static struct eo_series triple(const double *value)
{
  return eo_series_of(EO_MEASURED, value, EO_DIGITS_NUMBER);
}

static json_t *encode_member(const struct eo_member_dimensions *found)
{
  struct member view = {.own = *found,
                        .teeth_spanned = found->teeth_spanned ? found->teeth_spanned : (double)NAN,
                        .root_diameter = triple(found->root_diameter),
                        .form_diameter = triple(found->form_diameter),
                        .allowance = triple(found->allowance),
                        .generating_shift = triple(found->generating_shift),
                        .normal_thickness = triple(found->normal_thickness),
                        .span = triple(found->span),
                        .over_one_ball = triple(found->over_one_ball),
                        .over_two_balls = triple(found->over_two_balls),
                        .over_pins = triple(found->over_pins)};
  for (int k = 0; k < EO_MEASURED; k++) {
    view.thickness[k] = found->chord[k].thickness;
    view.height[k] = found->chord[k].height;
  }
  view.chord = triple(view.thickness);
  view.chord_height = triple(view.height);
  return eo_outline_encode(&member_outline, &view);
}

static json_t *encode_backlash(const struct eo_pair_dimensions *dimensions)
{
  const struct eo_backlash *range[EO_MEASURED] = {&dimensions->smallest, &dimensions->mean, &dimensions->largest};
  double normal[EO_MEASURED], around[EO_MEASURED], radial[EO_MEASURED];
  for (int k = 0; k < EO_MEASURED; k++) {
    normal[k] = range[k]->normal;
    around[k] = range[k]->circumferential;
    radial[k] = range[k]->radial;
  }
  const struct backlash view = {triple(normal), triple(around), triple(radial)};
  return eo_outline_encode(&backlash_outline, &view);
}

json_t *eo_dimensions_encode(const struct eo_gear_pair *pair, const struct eo_geometry *geometry)
{
  struct eo_pair_dimensions *found = calloc(1, sizeof *found);
  if (!found)
    return NULL;
  eo_pair_dimensions_init(found, pair, geometry);
  const struct dimensions view = {
      .member = {encode_member(&found->member[EO_PINION]), encode_member(&found->member[EO_GEAR])},
      .backlash = encode_backlash(found),
      .distance = geometry->centre_distance,
      .allowance = found->centre_distance_allowance};
  free(found);
  return eo_outline_encode(&eo_outline_dimensions, &view);
}
