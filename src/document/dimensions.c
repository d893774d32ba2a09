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

static void put_triple(struct eo_object *o, const char *key, const double *value, const struct eo_unit *unit)
{
  eo_object_put(o, key, eo_json_column(EO_MEASURED, value, 1, unit, EO_DIGITS_NUMBER));
}

static json_t *text_or_null(const char *text)
{
  return *text ? json_string(text) : json_null();
}

static json_t *encode_member(const struct eo_member_dimensions *m)
{
  struct eo_object o = eo_object_open_as(&member_outline);
  double chord[EO_MEASURED], height[EO_MEASURED];
  for (int k = 0; k < EO_MEASURED; k++) {
    chord[k] = m->chord[k].thickness;
    height[k] = m->chord[k].height;
  }
  eo_object_put_number(&o, "reference_diameter_mm", m->reference_diameter);
  eo_object_put_number(&o, "base_diameter_mm", m->base_diameter);
  eo_object_put_number(&o, "tip_diameter_mm", m->tip_diameter);
  put_triple(&o, "root_diameter_mm", m->root_diameter, &eo_unit_mm);
  put_triple(&o, "form_diameter_mm", m->form_diameter, &eo_unit_mm);
  eo_object_put_number(&o, "active_start_diameter_mm", m->active_start_diameter);
  put_triple(&o, "thickness_allowance_um", m->allowance, &eo_unit_um);
  put_triple(&o, "generating_shift", m->generating_shift, NULL);
  put_triple(&o, "normal_thickness_mm", m->normal_thickness, &eo_unit_mm);
  put_triple(&o, "chord_mm", chord, &eo_unit_mm);
  put_triple(&o, "chord_height_mm", height, &eo_unit_mm);
  eo_object_put_number(&o, "tip_thickness_mm", m->tip_thickness);
  eo_object_put(&o, "teeth_spanned", m->teeth_spanned ? json_integer(m->teeth_spanned) : json_null());
  put_triple(&o, "span_mm", m->span, &eo_unit_mm);
  eo_object_put(&o, "span_reason", text_or_null(m->span_reason));
  eo_object_put_number(&o, "ball_mm", m->ball);
  put_triple(&o, "over_one_ball_mm", m->over_one_ball, &eo_unit_mm);
  put_triple(&o, "over_two_balls_mm", m->over_two_balls, &eo_unit_mm);
  put_triple(&o, "over_pins_mm", m->over_pins, &eo_unit_mm);
  eo_object_put(&o, "ball_reason", text_or_null(m->ball_reason));
  return eo_object_close(&o);
}

static json_t *encode_backlash(const struct eo_pair_dimensions *d)
{
  const struct eo_backlash *range[EO_MEASURED] = {&d->smallest, &d->mean, &d->largest};
  double normal[EO_MEASURED], around[EO_MEASURED], radial[EO_MEASURED];
  struct eo_object o = eo_object_open_as(&backlash_outline);
  for (int k = 0; k < EO_MEASURED; k++) {
    normal[k] = range[k]->normal;
    around[k] = range[k]->circumferential;
    radial[k] = range[k]->radial;
  }
  put_triple(&o, "normal_um", normal, &eo_unit_um);
  put_triple(&o, "circumferential_um", around, &eo_unit_um);
  put_triple(&o, "radial_um", radial, &eo_unit_um);
  return eo_object_close(&o);
}

json_t *eo_dimensions_encode(const struct eo_gear_pair *pair, const struct eo_geometry *geometry)
{
  struct eo_pair_dimensions *d = calloc(1, sizeof *d);
  struct eo_object o = eo_object_open_as(&eo_outline_dimensions);
  if (!d) {
    json_decref(o.json);
    return NULL;
  }
  eo_pair_dimensions_init(d, pair, geometry);
  eo_object_put(&o, "pinion", encode_member(&d->member[EO_PINION]));
  eo_object_put(&o, "gear", encode_member(&d->member[EO_GEAR]));
  eo_object_put_number(&o, "centre_distance_mm", geometry->centre_distance);
  eo_object_put_number(&o, "centre_distance_allowance_um", d->centre_distance_allowance);
  eo_object_put(&o, "backlash", encode_backlash(d));
  free(d);
  return eo_object_close(&o);
}
