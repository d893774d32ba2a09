/* The modification as curves: what is taken off over the profile and over the face. */
#include <math.h>

#include "document/result_parts.h"
#include "gear/modification.h"

enum { POINTS = 61 };

static json_t *encode_curve(const double *value)
{
  return eo_json_reals(POINTS, value, 1, &eo_unit_um, EO_DIGITS_CURVE);
}

static json_t *encode_flank(const struct eo_result_source *source, int member, int end, const double *u, const double *eta)
{
  const struct eo_flank_modification *flank = &source->design->modification.flank[member][end];
  struct eo_modification_shape shape;
  struct eo_result_object o = eo_result_open();
  double profile[POINTS], lead[POINTS], slope[2];
  eo_modification_init(&shape, &source->pair->geometry, member, flank);
  for (int i = 0; i < POINTS; i++) {
    profile[i] = eo_modification_profile(&shape, u[i], slope);
    lead[i] = eo_modification_lead(&shape, eta[i] / cos(source->pair->geometry.helix_angle), slope);
  }
  eo_result_put_number(&o, "lead_crowning_um", flank->lead_crowning, &eo_unit_um);
  eo_result_put_number(&o, "lead_crowning_per_um", eo_modification_lead_coefficient(&source->pair->geometry, flank->lead_crowning), &eo_unit_per_um);
  eo_result_put(&o, "profile_um", encode_curve(profile));
  eo_result_put(&o, "lead_um", encode_curve(lead));
  return eo_result_close(&o);
}

/* u runs from the root end of the member's own active profile to its tip end. */
static json_t *encode_member(const struct eo_result_source *source, int member, const double *eta)
{
  const struct eo_geometry *g = &source->pair->geometry;
  double bottom = member == EO_PINION ? g->rack_bottom : -g->rack_top, top = member == EO_PINION ? g->rack_top : -g->rack_bottom, u[POINTS];
  struct eo_result_object o = eo_result_open();
  for (int i = 0; i < POINTS; i++)
    u[i] = bottom + (top - bottom) * i / (POINTS - 1);
  eo_result_put(&o, "u_mm", eo_json_reals(POINTS, u, 1, &eo_unit_mm, EO_DIGITS_CURVE));
  for (int end = 0; end < source->ends; end++)
    eo_result_put(&o, eo_result_end[end], encode_flank(source, member, end, u, eta));
  return eo_result_close(&o);
}

json_t *eo_result_modification(struct eo_result_source *source)
{
  struct eo_result_object o = eo_result_open();
  double eta[POINTS];
  for (int i = 0; i < POINTS; i++)
    eta[i] = source->pair->geometry.face_width * ((double)i / (POINTS - 1) - 0.5);
  eo_result_put(&o, "eta_mm", eo_json_reals(POINTS, eta, 1, &eo_unit_mm, EO_DIGITS_CURVE));
  for (int member = 0; member < 2; member++)
    eo_result_put(&o, eo_result_member[member], encode_member(source, member, eta));
  return eo_result_close(&o);
}
