/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The modification as curves: what is taken off over the profile and over the face. */
#include <math.h>

#include "document/result_private.h"
#include "gear/modification.h"

enum { POINTS = 61 };

static json_t *encode_curve(const double *value)
{
  return eo_json_reals(POINTS, value, 1, &eo_unit_um, EO_DIGITS_CURVE);
}

static const struct eo_outline_row flank_rows[] = {
    EO_KEY("lead_crowning_um", "number", "at the face ends", .unit = &eo_unit_um),
    EO_KEY("lead_crowning_per_um", "number", "the same as coefficient a_l of the square", .unit = &eo_unit_per_um),
    EO_KEY("profile_um", "[number]", "taken off over u_mm of the member", .unit = &eo_unit_um),
    EO_KEY("lead_um", "[number]", "taken off over eta_mm", .unit = &eo_unit_um),
};
static const struct eo_outline flank_curves = EO_OUTLINE("FlankCurves", flank_rows);

static json_t *encode_flank(const struct eo_result_source *source, int member, int end, const double *u,
                            const double *eta)
{
  const struct eo_flank_modification *flank = &source->design->modification.flank[member][end];
  struct eo_modification_shape shape;
  struct eo_object o = eo_object_open_as(&flank_curves);
  double profile[POINTS], lead[POINTS], slope[2];
  eo_modification_init(&shape, &source->pair->geometry, member, flank);
  for (int i = 0; i < POINTS; i++) {
    profile[i] = eo_modification_profile(&shape, u[i], slope);
    lead[i] = eo_modification_lead(&shape, eta[i] / cos(source->pair->geometry.helix_angle), slope);
  }
  eo_object_put_number(&o, "lead_crowning_um", flank->lead_crowning);
  eo_object_put_number(&o, "lead_crowning_per_um",
                       eo_modification_lead_coefficient(&source->pair->geometry, flank->lead_crowning));
  eo_object_put(&o, "profile_um", encode_curve(profile));
  eo_object_put(&o, "lead_um", encode_curve(lead));
  return eo_object_close(&o);
}

static const struct eo_outline_row member_rows[] = {
    EO_KEY("u_mm", "[number]",
           "profile coordinate of the generating rack, from the root end of the active profile to its tip end",
           .unit = &eo_unit_mm),
    EO_KEY("left", "object", "flank of the left end", .outline = &flank_curves),
    EO_KEY("right", "object", "flank of the right end", .when = EO_TWO_ENDS, .outline = &flank_curves),
};
static const struct eo_outline member_curves = EO_OUTLINE("MemberCurves", member_rows);

/* u runs from the root end of the member's own active profile to its tip end. */
static json_t *encode_member(const struct eo_result_source *source, int member, const double *eta)
{
  const struct eo_geometry *g = &source->pair->geometry;
  double bottom = member == EO_PINION ? g->rack_bottom : -g->rack_top,
         top = member == EO_PINION ? g->rack_top : -g->rack_bottom, u[POINTS];
  struct eo_object o = eo_object_open_as(&member_curves);
  for (int i = 0; i < POINTS; i++)
    u[i] = bottom + (top - bottom) * i / (POINTS - 1);
  eo_object_put(&o, "u_mm", eo_json_reals(POINTS, u, 1, &eo_unit_mm, EO_DIGITS_CURVE));
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&o, eo_result_end[end], encode_flank(source, member, end, u, eta));
  return eo_object_close(&o);
}

static const struct eo_outline_row modification_rows[] = {
    EO_KEY("eta_mm", "[number]", "place along the face from its middle", .unit = &eo_unit_mm),
    EO_KEY("pinion", "object", "pinion", .outline = &member_curves),
    EO_KEY("gear", "object", "gear", .outline = &member_curves),
};
const struct eo_outline eo_outline_modification = EO_OUTLINE("ModificationCurves", modification_rows);

json_t *eo_result_modification(struct eo_result_source *source)
{
  struct eo_object o = eo_object_open_as(&eo_outline_modification);
  double eta[POINTS];
  for (int i = 0; i < POINTS; i++)
    eta[i] = source->pair->geometry.face_width * ((double)i / (POINTS - 1) - 0.5);
  eo_object_put(&o, "eta_mm", eo_json_reals(POINTS, eta, 1, &eo_unit_mm, EO_DIGITS_CURVE));
  for (int member = 0; member < 2; member++)
    eo_object_put(&o, eo_result_member[member], encode_member(source, member, eta));
  return eo_object_close(&o);
}
