/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The modification as curves and as a surface: what is taken off over the profile and over the face; where reliefs
   start in every way in which drawings state it. */
#include <math.h>

#include "document/flank_grid_document.h"
#include "document/result_private.h"
#include "gear/modification.h"

enum { POINTS = 61, MAP_ROWS = 31, MAP_COLUMNS = 41 };

static json_t *encode_curve(const double *value, int digits)
{
  return eo_json_reals(POINTS, value, 1, &eo_unit_um, digits);
}

static const struct eo_outline_row start_rows[] = {
    EO_KEY("u_mm", "number", "rack coordinate from the pitch point, + towards the tip", .unit = &eo_unit_mm),
    EO_KEY("diameter_mm", "number", "diameter", .unit = &eo_unit_mm),
    EO_KEY("roll_length_mm", "number", "length of roll from the base circle", .unit = &eo_unit_mm),
    EO_KEY("roll_angle_deg", "number", "roll angle from the base circle", .unit = &eo_unit_deg),
    EO_KEY("length_mm", "number", "from the end of the active profile on this side, along the path of contact",
           .unit = &eo_unit_mm),
};
static const struct eo_outline start_outline = EO_OUTLINE("ReliefStart", start_rows);

#define CURVE_ROWS                                                                                                     \
  EO_KEY("lead_crowning_um", "number", "at the face ends", .unit = &eo_unit_um),                                       \
      EO_KEY("lead_crowning_per_um", "number", "the same as coefficient a_l of the square", .unit = &eo_unit_per_um),  \
      EO_KEY("tip_relief_start", "object?", "null: no tip relief", .outline = &start_outline),                         \
      EO_KEY("root_relief_start", "object?", "null: no root relief", .outline = &start_outline),                       \
      EO_KEY("profile_um", "[number]", "taken off over u_mm of the member, in mid face", .unit = &eo_unit_um),         \
      EO_KEY("lead_um", "[number]", "taken off over eta_mm, at the pitch point where profiles vary over the face",     \
             .unit = &eo_unit_um),                                                                                     \
      EO_KEY("surface_um", "[[number]]?",                                                                              \
             "taken off, a row for each surface_u_mm of the member, a number for each surface_eta_mm; null: profiles " \
             "are the same all over the face",                                                                         \
             .unit = &eo_unit_um)
static const struct eo_outline_row coast_rows[] = {CURVE_ROWS};
static const struct eo_outline coast_curves = EO_OUTLINE("CoastFlankCurves", coast_rows);
static const struct eo_outline_row flank_rows[] = {
    CURVE_ROWS,
    EO_KEY("coast", "object?", "the coast flank, over the same places y; null: unmodified", .outline = &coast_curves)};
static const struct eo_outline flank_curves = EO_OUTLINE("FlankCurves", flank_rows);

/* Places on a member and over the face at which curves and surfaces are written. */
struct places {
  double u[POINTS], eta[POINTS], map_u[MAP_ROWS], map_eta[MAP_COLUMNS];
};

static void spread(int count, double from, double to, double *place)
{
  for (int i = 0; i < count; i++)
    place[i] = from + (to - from) * i / (count - 1);
}

static json_t *encode_start(const struct eo_geometry *geometry, int member, const struct eo_flank_modification *flank,
                            int side)
{
  if ((side == EO_TIP_SIDE ? flank->tip_relief : flank->root_relief) == 0)
    return json_null();
  struct eo_profile_place place = eo_profile_place_at(geometry, member,
                                                      eo_relief_start_at(geometry, member, flank, side));
  struct eo_object object = eo_object_open_as(&start_outline);
  eo_object_put_number(&object, "u_mm", place.rack);
  eo_object_put_number(&object, "diameter_mm", place.diameter);
  eo_object_put_number(&object, "roll_length_mm", place.roll_length);
  eo_object_put_number(&object, "roll_angle_deg", place.roll_angle);
  eo_object_put_number(&object, "length_mm", place.length[side]);
  return eo_object_close(&object);
}

static json_t *encode_surface(const struct eo_modification_shape *shape, const struct places *places, int digits)
{
  json_t *rows = shape->varies ? json_array() : json_null();
  bool failed = !rows;
  for (int i = 0; i < MAP_ROWS && shape->varies && !failed; i++) {
    double row[MAP_COLUMNS];
    for (int j = 0; j < MAP_COLUMNS; j++)
      row[j] = eo_modification_at(shape, places->map_u[i], places->map_eta[j]);
    failed = json_array_append_new(rows, eo_json_reals(MAP_COLUMNS, row, 1, &eo_unit_um, digits)) != 0;
  }
  if (!failed)
    return rows;
  json_decref(rows);
  return NULL;
}

static void put_curves(struct eo_object *object, const struct eo_result_source *source, int member,
                       const struct eo_flank_modification *flank, const struct eo_modification_shape *shape,
                       const struct places *places)
{
  const struct eo_geometry *geometry = &source->pair->geometry;
  double profile[POINTS], lead[POINTS], slope[2];
  for (int i = 0; i < POINTS; i++) {
    profile[i] = eo_modification_profile(shape, places->u[i], slope);
    lead[i] = shape->varies ? eo_modification_at(shape, 0, places->eta[i])
                            : eo_modification_lead(shape, places->eta[i] / cos(geometry->helix_angle), slope);
  }
  eo_object_put_number(object, "lead_crowning_um", flank->lead_crowning);
  eo_object_put_number(object, "lead_crowning_per_um",
                       eo_modification_lead_coefficient(geometry, flank->lead_crowning));
  eo_object_put(object, "tip_relief_start", encode_start(geometry, member, flank, EO_TIP_SIDE));
  eo_object_put(object, "root_relief_start", encode_start(geometry, member, flank, EO_ROOT_SIDE));
  eo_object_put(object, "profile_um", encode_curve(profile, source->digits));
  eo_object_put(object, "lead_um", encode_curve(lead, source->digits));
  eo_object_put(object, "surface_um", encode_surface(shape, places, source->digits));
}

static json_t *encode_coast(const struct eo_result_source *source, int member, int end, const struct places *places)
{
  const struct eo_geometry *geometry = &eo_pair_half(source->pair, end)->geometry;
  const struct eo_flank_modification *flank = &source->design->modification.coast[member][end];
  struct eo_modification_shape shape;
  struct eo_flank_spline *spline;
  bool failed = eo_flank_shape(source->design, geometry, EO_COAST_FLANK, member, end, &shape, &spline);
  json_t *encoded = json_null();
  if (!failed && (spline || !eo_modification_is_none(flank))) {
    struct eo_object object = eo_object_open_as(&coast_curves);
    put_curves(&object, source, member, flank, &shape, places);
    encoded = eo_object_close(&object);
  }
  eo_flank_spline_free(spline);
  return failed ? NULL : encoded;
}

static json_t *encode_flank(const struct eo_result_source *source, int member, int end, const struct places *all)
{
  const struct eo_geometry *geometry = &eo_pair_half(source->pair, end)->geometry;
  struct places own = *all, *places = &own;
  spread(POINTS, -geometry->face_width / 2, geometry->face_width / 2, own.eta);
  spread(MAP_COLUMNS, -geometry->face_width / 2, geometry->face_width / 2, own.map_eta);
  struct eo_object object = eo_object_open_as(&flank_curves);
  struct eo_modification_shape shape;
  struct eo_flank_spline *spline;
  object.failed = eo_flank_shape(source->design, geometry, EO_DRIVE_FLANK, member, end, &shape, &spline);
  put_curves(&object, source, member, &source->design->modification.flank[member][end], &shape, places);
  eo_object_put(&object, "coast", encode_coast(source, member, end, places));
  eo_flank_spline_free(spline);
  return eo_object_close(&object);
}

static const struct eo_outline_row member_rows[] = {
    EO_KEY("u_mm", "[number]",
           "profile coordinate of the generating rack, from the root end of the active profile to its tip end",
           .unit = &eo_unit_mm),
    EO_KEY("surface_u_mm", "[number]", "the same, for surfaces", .unit = &eo_unit_mm),
    EO_KEY("left", "object", "flank of the left end", .outline = &flank_curves),
    EO_KEY("right", "object", "flank of the right end", .when = EO_TWO_ENDS, .outline = &flank_curves),
};
static const struct eo_outline member_curves = EO_OUTLINE("MemberCurves", member_rows);

/* u runs from the root end of the member's own active profile to its tip end. */
static json_t *encode_member(const struct eo_result_source *source, int member, struct places *places)
{
  double ends[2];
  struct eo_object object = eo_object_open_as(&member_curves);
  eo_active_profile(&source->pair->geometry, member, ends);
  spread(POINTS, ends[EO_ROOT_SIDE], ends[EO_TIP_SIDE], places->u);
  spread(MAP_ROWS, ends[EO_ROOT_SIDE], ends[EO_TIP_SIDE], places->map_u);
  eo_object_put(&object, "u_mm", eo_json_reals(POINTS, places->u, 1, &eo_unit_mm, source->digits));
  eo_object_put(&object, "surface_u_mm", eo_json_reals(MAP_ROWS, places->map_u, 1, &eo_unit_mm, source->digits));
  for (int end = 0; end < source->ends; end++)
    eo_object_put(&object, eo_result_end[end], encode_flank(source, member, end, places));
  return eo_object_close(&object);
}

static const struct eo_outline_row modification_rows[] = {
    EO_KEY("eta_mm", "[number]", "place along the face from its middle, + towards the end that meets first",
           .unit = &eo_unit_mm),
    EO_KEY("surface_eta_mm", "[number]", "the same, for surfaces", .unit = &eo_unit_mm),
    EO_KEY("right_eta_mm", "[number]", "eta_mm of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN),
    EO_KEY("right_surface_eta_mm", "[number]", "surface_eta_mm of the right end", .unit = &eo_unit_mm,
           .when = EO_UNEVEN),
    EO_KEY("pinion", "object", "pinion", .outline = &member_curves),
    EO_KEY("gear", "object", "gear", .outline = &member_curves),
};
const struct eo_outline eo_outline_modification = EO_OUTLINE("ModificationCurves", modification_rows);

json_t *eo_result_modification(struct eo_result_source *source)
{
  struct eo_object object = eo_object_open_as(&eo_outline_modification);
  struct places places;
  double half = source->pair->geometry.face_width / 2;
  spread(POINTS, -half, half, places.eta);
  spread(MAP_COLUMNS, -half, half, places.map_eta);
  eo_object_put(&object, "eta_mm", eo_json_reals(POINTS, places.eta, 1, &eo_unit_mm, source->digits));
  eo_object_put(&object, "surface_eta_mm", eo_json_reals(MAP_COLUMNS, places.map_eta, 1, &eo_unit_mm, source->digits));
  eo_result_put_right_face(&object, "right_eta_mm", source, POINTS, places.eta, true);
  eo_result_put_right_face(&object, "right_surface_eta_mm", source, MAP_COLUMNS, places.map_eta, true);
  for (int member = 0; member < 2; member++)
    eo_object_put(&object, eo_result_member[member], encode_member(source, member, &places));
  return eo_object_close(&object);
}
