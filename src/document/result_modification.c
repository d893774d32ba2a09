/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The modification as curves and as a surface: what is taken off over the profile and over the face; where reliefs
   start in every way in which drawings state it. */
#include <math.h>

#include "document/flank_grid_document.h"
#include "document/result_private.h"
#include "gear/modification.h"

enum { POINTS = 61, MAP_ROWS = 31, MAP_COLUMNS = 41 };

struct relief_start {
  double rack, diameter, roll_length, roll_angle, length;
};

static const struct eo_outline_row start_rows[] = {
    EO_KEY("u_mm", "number", "rack coordinate from the pitch point, + towards the tip", .unit = &eo_unit_mm,
           EO_AT(struct relief_start, rack)),
    EO_KEY("diameter_mm", "number", "diameter", .unit = &eo_unit_mm, EO_AT(struct relief_start, diameter)),
    EO_KEY("roll_length_mm", "number", "length of roll from the base circle", .unit = &eo_unit_mm,
           EO_AT(struct relief_start, roll_length)),
    EO_KEY("roll_angle_deg", "number", "roll angle from the base circle", .unit = &eo_unit_deg,
           EO_AT(struct relief_start, roll_angle)),
    EO_KEY("length_mm", "number", "from the end of the active profile on this side, along the path of contact",
           .unit = &eo_unit_mm, EO_AT(struct relief_start, length)),
};
static const struct eo_outline start_outline = EO_OUTLINE("ReliefStart", start_rows);

/* What is taken off one flank. */
struct curves {
  double crowning, coefficient, profile[POINTS], lead[POINTS];
  struct eo_series profile_curve, lead_curve;
  json_t *tip_start, *root_start, *surface, *coast;
};

#define CURVE_ROWS                                                                                                     \
  EO_KEY("lead_crowning_um", "number", "at the face ends", .unit = &eo_unit_um, EO_AT(struct curves, crowning)),       \
      EO_KEY("lead_crowning_per_um", "number", "the same as coefficient a_l of the square", .unit = &eo_unit_per_um,   \
             EO_AT(struct curves, coefficient)),                                                                       \
      EO_KEY("tip_relief_start", "object?", "null: no tip relief", .outline = &start_outline,                          \
             EO_AT(struct curves, tip_start)),                                                                         \
      EO_KEY("root_relief_start", "object?", "null: no root relief", .outline = &start_outline,                        \
             EO_AT(struct curves, root_start)),                                                                        \
      EO_KEY("profile_um", "[number]", "taken off over u_mm of the member, in mid face", .unit = &eo_unit_um,          \
             EO_AT(struct curves, profile_curve)),                                                                     \
      EO_KEY("lead_um", "[number]", "taken off over eta_mm, at the pitch point where profiles vary over the face",     \
             .unit = &eo_unit_um, EO_AT(struct curves, lead_curve)),                                                   \
      EO_KEY("surface_um", "[[number]]?",                                                                              \
             "taken off, a row for each surface_u_mm of the member, a number for each surface_eta_mm; null: profiles " \
             "are the same all over the face",                                                                         \
             .unit = &eo_unit_um, EO_AT(struct curves, surface))
static const struct eo_outline_row coast_rows[] = {CURVE_ROWS};
static const struct eo_outline coast_curves = EO_OUTLINE("CoastFlankCurves", coast_rows);
static const struct eo_outline_row flank_rows[] = {
    CURVE_ROWS, EO_KEY("coast", "object?", "the coast flank, over the same places y; null: unmodified",
                       .outline = &coast_curves, EO_AT(struct curves, coast))};
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
  const struct relief_start view = {place.rack, place.diameter, place.roll_length, place.roll_angle,
                                    place.length[side]};
  return eo_outline_encode(&start_outline, &view);
}

static json_t *encode_surface(const struct eo_modification_shape *shape, const struct places *places, int digits)
{
  if (!shape->varies)
    return json_null();
  struct eo_object rows = eo_list_open();
  for (int i = 0; i < MAP_ROWS; i++) {
    double row[MAP_COLUMNS];
    for (int j = 0; j < MAP_COLUMNS; j++)
      row[j] = eo_modification_at(shape, places->map_u[i], places->map_eta[j]);
    eo_list_add(&rows, eo_json_reals(MAP_COLUMNS, row, 1, &eo_unit_um, digits));
  }
  return eo_object_close(&rows);
}

static void find_curves(const struct eo_result_source *source, int member, int end,
                        const struct eo_flank_modification *flank, const struct eo_modification_shape *shape,
                        const struct places *places, struct curves *curves)
{
  const struct eo_geometry *geometry = &eo_pair_half(source->pair, end)->geometry;
  double slope[2];
  *curves = (struct curves){.crowning = flank->lead_crowning,
                            .coefficient = eo_modification_lead_coefficient(geometry, flank->lead_crowning),
                            .profile_curve = eo_series_of(POINTS, curves->profile, source->digits),
                            .lead_curve = eo_series_of(POINTS, curves->lead, source->digits),
                            .tip_start = encode_start(geometry, member, flank, EO_TIP_SIDE),
                            .root_start = encode_start(geometry, member, flank, EO_ROOT_SIDE),
                            .surface = encode_surface(shape, places, source->digits)};
  for (int i = 0; i < POINTS; i++) {
    curves->profile[i] = eo_modification_profile(shape, places->u[i], slope);
    curves->lead[i] = shape->varies ? eo_modification_at(shape, 0, places->eta[i])
                                    : eo_modification_lead(shape, places->eta[i] / cos(geometry->helix_angle), slope);
  }
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
    struct curves view;
    find_curves(source, member, end, flank, &shape, places, &view);
    encoded = eo_outline_encode(&coast_curves, &view);
  }
  eo_flank_spline_free(spline);
  return failed ? NULL : encoded;
}

static json_t *encode_flank(const struct eo_result_source *source, int member, int end, const struct places *all)
{
  const struct eo_geometry *geometry = &eo_pair_half(source->pair, end)->geometry;
  struct places places = *all;
  spread(POINTS, -geometry->face_width / 2, geometry->face_width / 2, places.eta);
  spread(MAP_COLUMNS, -geometry->face_width / 2, geometry->face_width / 2, places.map_eta);
  struct eo_modification_shape shape;
  struct eo_flank_spline *spline;
  json_t *encoded = NULL;
  if (!eo_flank_shape(source->design, geometry, EO_DRIVE_FLANK, member, end, &shape, &spline)) {
    struct curves view;
    find_curves(source, member, end, &source->design->modification.flank[member][end], &shape, &places, &view);
    view.coast = encode_coast(source, member, end, &places);
    encoded = eo_outline_encode(&flank_curves, &view);
  }
  eo_flank_spline_free(spline);
  return encoded;
}

struct member_curves {
  bool two, two_helices;
  struct eo_series u, map_u, right_u, right_map_u;
  json_t *end[2];
};

#define OF_MEMBER(name) EO_AT(struct member_curves, name)
static const struct eo_outline_row member_rows[] = {
    EO_KEY("u_mm", "[number]",
           "profile coordinate of the generating rack, from the root end of the active profile to its tip end",
           .unit = &eo_unit_mm, OF_MEMBER(u)),
    EO_KEY("surface_u_mm", "[number]", "the same, for surfaces", .unit = &eo_unit_mm, OF_MEMBER(map_u)),
    EO_KEY("right_u_mm", "[number]", "u_mm of the right end", .unit = &eo_unit_mm, .when = EO_TWO_HELICES,
           OF_MEMBER(right_u), EO_IF(struct member_curves, two_helices)),
    EO_KEY("right_surface_u_mm", "[number]", "surface_u_mm of the right end", .unit = &eo_unit_mm,
           .when = EO_TWO_HELICES, OF_MEMBER(right_map_u), EO_IF(struct member_curves, two_helices)),
    EO_KEY("left", "object", "flank of the left end", .outline = &flank_curves, OF_MEMBER(end[EO_LEFT])),
    EO_KEY("right", "object", "flank of the right end", .when = EO_TWO_ENDS, .outline = &flank_curves,
           OF_MEMBER(end[EO_RIGHT]), EO_IF(struct member_curves, two)),
};
static const struct eo_outline member_curves = EO_OUTLINE("MemberCurves", member_rows);

/* u runs from the root end of the member's own active profile to its tip end. */
static void spread_profile(const struct eo_geometry *geometry, int member, struct places *places)
{
  double ends[2];
  eo_active_profile(geometry, member, ends);
  spread(POINTS, ends[EO_ROOT_SIDE], ends[EO_TIP_SIDE], places->u);
  spread(MAP_ROWS, ends[EO_ROOT_SIDE], ends[EO_TIP_SIDE], places->map_u);
}

static json_t *encode_member(const struct eo_result_source *source, int member, struct places *places)
{
  bool two_helices = eo_gear_pair_has_two_helices(&source->pair->gear_pair);
  struct places right = *places;
  spread_profile(&source->pair->geometry, member, places);
  spread_profile(&eo_pair_half(source->pair, EO_RIGHT)->geometry, member, &right);
  struct member_curves view = {.two = source->ends == 2,
                               .two_helices = two_helices,
                               .u = eo_series_of(POINTS, places->u, source->digits),
                               .map_u = eo_series_of(MAP_ROWS, places->map_u, source->digits),
                               .right_u = eo_series_of(POINTS, right.u, source->digits),
                               .right_map_u = eo_series_of(MAP_ROWS, right.map_u, source->digits)};
  for (int end = 0; end < source->ends; end++)
    view.end[end] = encode_flank(source, member, end, end == EO_RIGHT && two_helices ? &right : places);
  return eo_outline_encode(&member_curves, &view);
}

struct modification {
  bool uneven;
  struct eo_series eta, map_eta;
  json_t *right_eta, *right_map_eta, *member[2];
};

#define OF_MODIFICATION(name) EO_AT(struct modification, name)
static const struct eo_outline_row modification_rows[] = {
    EO_KEY("eta_mm", "[number]", "place along the face from its middle, + towards the end that meets first",
           .unit = &eo_unit_mm, OF_MODIFICATION(eta)),
    EO_KEY("surface_eta_mm", "[number]", "the same, for surfaces", .unit = &eo_unit_mm, OF_MODIFICATION(map_eta)),
    EO_KEY("right_eta_mm", "[number]", "eta_mm of the right end", .unit = &eo_unit_mm, .when = EO_UNEVEN,
           OF_MODIFICATION(right_eta), EO_IF(struct modification, uneven)),
    EO_KEY("right_surface_eta_mm", "[number]", "surface_eta_mm of the right end", .unit = &eo_unit_mm,
           .when = EO_UNEVEN, OF_MODIFICATION(right_map_eta), EO_IF(struct modification, uneven)),
    EO_KEY("pinion", "object", "pinion", .outline = &member_curves, OF_MODIFICATION(member[EO_PINION])),
    EO_KEY("gear", "object", "gear", .outline = &member_curves, OF_MODIFICATION(member[EO_GEAR])),
};
const struct eo_outline eo_outline_modification = EO_OUTLINE("ModificationCurves", modification_rows);

json_t *eo_result_modification(struct eo_result_source *source)
{
  struct places places = {0};
  double half = source->pair->geometry.face_width / 2;
  spread(POINTS, -half, half, places.eta);
  spread(MAP_COLUMNS, -half, half, places.map_eta);
  struct modification view = {.uneven = source->pair->right,
                              .eta = eo_series_of(POINTS, places.eta, source->digits),
                              .map_eta = eo_series_of(MAP_COLUMNS, places.map_eta, source->digits),
                              .right_eta = eo_result_right_face(source, POINTS, places.eta),
                              .right_map_eta = eo_result_right_face(source, MAP_COLUMNS, places.map_eta)};
  for (int member = 0; member < 2; member++)
    view.member[member] = encode_member(source, member, &places);
  return eo_outline_encode(&eo_outline_modification, &view);
}
