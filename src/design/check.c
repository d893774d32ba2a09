/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "design/check.h"
#include "design/resolution.h"
#include "gear/names.h"

#include <math.h>
#include <stdio.h>

static enum eo_code check_body(const struct eo_gear_pair *pair, const struct eo_geometry *geometry, int i,
                               struct eo_error *error)
{
  double root = 2 * geometry->root_radius[i];
  char key[64];
  snprintf(key, sizeof key, "/gear_pair/%s_bore_mm", eo_member_name[i]);
  if (pair->bore[i] > root - 2 * pair->normal_module)
    return eo_error_set(error, EO_ERROR_INPUT, key,
                        "The bore of %.6g mm leaves less than one module of rim below the root diameter of %.6g mm.",
                        1e3 * pair->bore[i], 1e3 * root);
  snprintf(key, sizeof key, "/gear_pair/%s_groove_diameter_mm", eo_member_name[i]);
  if (pair->ends == 2 && (pair->groove_diameter[i] <= pair->bore[i] || pair->groove_diameter[i] > root))
    return eo_error_set(
        error, EO_ERROR_INPUT, key,
        "The body between the ends, %.6g mm, must be thicker than the bore, %.6g mm, and not above the root, %.6g mm.",
        1e3 * pair->groove_diameter[i], 1e3 * pair->bore[i], 1e3 * root);
  return EO_OK;
}

/* A right half of its own helix must be a pair by itself, on the blanks of the left one. */
static enum eo_code check_right_helix(const struct eo_gear_pair *pair, struct eo_error *error)
{
  if (!eo_gear_pair_has_two_helices(pair))
    return EO_OK;
  const struct eo_gear_pair half = eo_gear_pair_half(pair, EO_RIGHT);
  struct eo_geometry geometry;
  struct eo_error reason;
  enum eo_code code = eo_geometry_init(&geometry, &half, &reason);
  return code ? eo_error_set(
                    error, code, "/gear_pair/right_helix_angle_deg",
                    "The right half, with a normal module of %.6g mm and a normal pressure angle of %.6g deg at "
                    "this helix angle, cannot be made: %.300s",
                    1e3 * half.normal_module, half.normal_pressure_angle * 180 / M_PI, reason.text)
              : EO_OK;
}

/* A narrow right half must keep the teeth in mesh by itself. */
static enum eo_code check_right_half(const struct eo_gear_pair *pair, const struct eo_geometry *right,
                                     struct eo_error *error)
{
  double total = right->transverse_contact_ratio + right->overlap_ratio;
  if (!eo_gear_pair_is_uneven(pair) || total >= 1)
    return EO_OK;
  return eo_error_set(error, EO_ERROR_INPUT,
                      eo_gear_pair_has_two_helices(pair) ? "/gear_pair/right_helix_angle_deg"
                                                         : "/gear_pair/right_face_width_mm",
                      "The total contact ratio of the right end, %.4g, is below 1: the teeth do not mesh continuously. "
                      "A wider face than %.6g mm, a larger helix angle or a longer addendum adds to it.",
                      total, 1e3 * right->face_width);
}

static enum eo_code check_groove(const struct eo_gear_pair *pair, struct eo_error *error)
{
  static const double LEAST = 1e-4; /* m: the groove's springs are as stiff as it is narrow */
  if (pair->ends == 2 && pair->groove_width < LEAST)
    return eo_error_set(error, EO_ERROR_INPUT, "/gear_pair/groove_width_mm",
                        "Two ends need a groove of at least %.6g mm between them, not %.6g mm.", 1e3 * LEAST,
                        1e3 * pair->groove_width);
  for (int i = 0; i < 2 && pair->ends == 2; i++)
    if (eo_gear_pair_groove_width(pair, i) < LEAST)
      return eo_error_set(error, EO_ERROR_INPUT,
                          i ? "/gear_pair/gear_face_width_mm" : "/gear_pair/pinion_face_width_mm",
                          "The own faces of the %s, %.6g mm, leave %.6g mm of the groove of %.6g mm between them, less "
                          "than %.6g mm: a wider groove or narrower faces.",
                          eo_member_name[i], 1e3 * pair->member_width[i], 1e3 * eo_gear_pair_groove_width(pair, i),
                          1e3 * pair->groove_width, 1e3 * LEAST);
  return EO_OK;
}

/* Where a flank stands in a document. */
struct flank_place {
  const struct eo_geometry *geometry;
  enum eo_flank_side side;
  int member, end;
};

/* Pointer to a key of the flank; prefix and key make its name. */
static void point_to(const struct flank_place *place, const char *prefix, const char *key, char pointer[128])
{
  snprintf(pointer, 128, "/modification/%s/%s/%s%s%s", eo_member_name[place->member], eo_end_name[place->end],
           place->side == EO_COAST_FLANK ? "coast/" : "", prefix, key);
}

static const char *const relief_side[2] = {"root", "tip"};

/* The key of the way in which a start is stated. */
static const char *stated_key(const struct eo_relief_place *stated)
{
  return stated->diameter > 0      ? "_relief_diameter_mm"
         : stated->roll_length > 0 ? "_relief_roll_length_mm"
         : stated->roll_angle > 0  ? "_relief_roll_angle_deg"
         : stated->length > 0      ? "_relief_length_mm"
                                   : "_relief_start_mm";
}

/* One way to state a start at most, at a place on the active profile, before it ends on this side. */
static enum eo_code check_relief(const struct eo_flank_modification *flank, int side, const struct flank_place *place,
                                 struct eo_error *error)
{
  double amount = side == EO_TIP_SIDE ? flank->tip_relief : flank->root_relief, end[2],
         rack = side == EO_TIP_SIDE ? flank->tip_relief_start : flank->root_relief_start;
  const struct eo_relief_place *stated = &flank->place[side];
  int ways = eo_relief_places_stated(stated);
  bool twice = ways > 1 || (ways == 1 && rack != 0);
  char key[128];
  if (!twice && amount == 0)
    return EO_OK;
  point_to(place, relief_side[side], stated_key(stated), key);
  if (twice)
    return eo_error_set(error, EO_ERROR_INPUT, key,
                        "The start of a relief is stated in one way: %s_relief_start_mm (0 where another is taken), "
                        "_diameter_mm, _roll_length_mm, _roll_angle_deg or _length_mm; here are %d.",
                        relief_side[side], ways + (rack != 0));
  double start = eo_relief_start_at(place->geometry, place->member, flank, side);
  eo_active_profile(place->geometry, place->member, end);
  bool inside = side == EO_TIP_SIDE ? start < end[EO_TIP_SIDE] : start > end[EO_ROOT_SIDE];
  if (ways == 0) {
    double active = side == EO_TIP_SIDE ? end[EO_TIP_SIDE] : -end[EO_ROOT_SIDE];
    return inside ? EO_OK
                  : eo_error_set(error, EO_ERROR_INPUT, key,
                                 "%.6g mm is not inside the active profile, which ends %.6g mm from the pitch point on "
                                 "this side.",
                                 1e3 * rack, 1e3 * active);
  }
  if (inside && start > end[EO_ROOT_SIDE] && start < end[EO_TIP_SIDE])
    return EO_OK;
  struct eo_profile_place from = eo_profile_place_at(place->geometry, place->member, end[EO_ROOT_SIDE]),
                          to = eo_profile_place_at(place->geometry, place->member, end[EO_TIP_SIDE]);
  return eo_error_set(error, EO_ERROR_INPUT, key,
                      "The relief does not start on the active profile, which reaches from diameter %.6g to %.6g mm, "
                      "length of roll %.6g to %.6g mm, roll angle %.6g to %.6g deg.",
                      1e3 * from.diameter, 1e3 * to.diameter, 1e3 * from.roll_length, 1e3 * to.roll_length,
                      from.roll_angle * 180 / M_PI, to.roll_angle * 180 / M_PI);
}

/* Between its vertices a profile has one middle part. */
static enum eo_code check_vertices(const struct eo_flank_modification *flank, const struct flank_place *place,
                                   struct eo_error *error)
{
  char key[128];
  if (flank->tip_relief == 0 || flank->root_relief == 0)
    return EO_OK;
  double root = eo_relief_start_at(place->geometry, place->member, flank, EO_ROOT_SIDE),
         tip = eo_relief_start_at(place->geometry, place->member, flank, EO_TIP_SIDE);
  if (root <= tip)
    return EO_OK;
  point_to(place, "root", stated_key(&flank->place[EO_ROOT_SIDE]), key);
  return eo_error_set(error, EO_ERROR_INPUT, key,
                      "The root relief starts at diameter %.6g mm, beyond the tip relief, which starts at %.6g mm.",
                      1e3 * eo_profile_place_at(place->geometry, place->member, root).diameter,
                      1e3 * eo_profile_place_at(place->geometry, place->member, tip).diameter);
}

static enum eo_code check_end_reliefs(const struct eo_flank_modification *flank, const struct flank_place *place,
                                      struct eo_error *error)
{
  static const char *const which[2] = {"trailing", "leading"};
  char key[128];
  double length = 0, face_width = place->geometry->face_width;
  for (int k = 0; k < 2; k++) {
    length += flank->end_relief_length[k];
    if (flank->end_relief[k] <= 0 || flank->end_relief_length[k] > 0)
      continue;
    point_to(place, which[k], "_end_relief_um", key);
    return eo_error_set(error, EO_ERROR_INPUT, key,
                        "An end relief of %.6g um needs its length: %s_end_relief_length_mm above 0, and up to %.6g "
                        "mm with the other end's.",
                        1e6 * flank->end_relief[k], which[k], 1e3 * face_width);
  }
  if (length <= face_width)
    return EO_OK;
  point_to(place, which[flank->end_relief_length[0] <= flank->end_relief_length[1]], "_end_relief_length_mm", key);
  return eo_error_set(error, EO_ERROR_INPUT, key, "The end reliefs are %.6g mm long together, the face only %.6g mm.",
                      1e3 * length, 1e3 * face_width);
}

static enum eo_code check_triangles(const struct eo_flank_modification *flank, const struct flank_place *place,
                                    struct eo_error *error)
{
  static const char *const face[2] = {"_trailing", "_leading"};
  for (int i = 0; i < 4; i++) {
    const struct eo_triangular_relief *relief = &flank->triangular[i / 2][i % 2];
    char corner[32], key[128];
    if (relief->amount == 0 || (relief->profile_length > 0 && relief->face_length > 0))
      continue;
    snprintf(corner, sizeof corner, "%s%s", relief_side[i / 2], face[i % 2]);
    point_to(place, corner, "_triangular_relief_um", key);
    return eo_error_set(error, EO_ERROR_INPUT, key,
                        "A triangular relief of %.6g um needs lengths above 0: %s_triangular_profile_length_mm and "
                        "%s_triangular_face_length_mm.",
                        1e6 * relief->amount, corner, corner);
  }
  return EO_OK;
}

static enum eo_code check_flank(const struct eo_flank_modification *flank, const struct flank_place *place,
                                struct eo_error *error)
{
  EO_TRY(check_relief(flank, EO_TIP_SIDE, place, error));
  EO_TRY(check_relief(flank, EO_ROOT_SIDE, place, error));
  EO_TRY(check_vertices(flank, place, error));
  EO_TRY(check_end_reliefs(flank, place, error));
  return check_triangles(flank, place, error);
}

static enum eo_code check_gain(const struct eo_design *design, const struct eo_flank_modification *flank,
                               const struct flank_place *place, struct eo_error *error)
{
  char key[128];
  if (flank->grid_gain == 0 || design->grids.place[place->side][place->member][place->end].u_knots > 0)
    return EO_OK;
  point_to(place, "grid_gain", "", key);
  return eo_error_set(error, EO_ERROR_INPUT, key,
                      "There is no grid on this flank of which %.6g more could be laid on: state a grid, or 0 here.",
                      flank->grid_gain);
}

static enum eo_code check_nodes(const struct eo_design *design, const struct eo_flank_modification *flank,
                                const struct flank_place *place, struct eo_error *error)
{
  const struct eo_grid_place *grid = &design->grids.place[place->side][place->member][place->end];
  char key[128];
  for (int i = 0; i < flank->nodes; i++)
    if (flank->node[i].row > grid->u_knots || flank->node[i].column > grid->y_knots || grid->u_knots == 0) {
      point_to(place, "grid_nodes", "", key);
      return eo_error_set(error, EO_ERROR_INPUT, key,
                          "Row %d, column %d: the grid of this flank has %d rows and %d columns (0: there is none).",
                          flank->node[i].row, flank->node[i].column, grid->u_knots, grid->y_knots);
    }
  return EO_OK;
}

enum eo_code eo_modification_check(const struct eo_design *design, const struct eo_geometry *geometry,
                                   struct eo_error *error)
{
  for (int side = 0; side < 2; side++)
    for (int i = 0; i < 2; i++)
      for (int end = 0; end < design->gear_pair.ends; end++) {
        const struct eo_geometry half = eo_geometry_of_half(geometry, &design->gear_pair, end);
        const struct flank_place place = {&half, (enum eo_flank_side)side, i, end};
        const struct eo_flank_modification *flank = side == EO_DRIVE_FLANK ? &design->modification.flank[i][end]
                                                                           : &design->modification.coast[i][end];
        EO_TRY(check_flank(flank, &place, error));
        EO_TRY(check_gain(design, flank, &place, error));
        EO_TRY(check_nodes(design, flank, &place, error));
      }
  return EO_OK;
}

static enum eo_code check_start_bounds(const struct eo_range *range, double active, const char *key,
                                       struct eo_error *error)
{
  if (range->low < range->high && range->high < active)
    return EO_OK;
  return eo_error_set(
      error, EO_ERROR_INPUT, key,
      "The bounds %.6g .. %.6g mm must increase and stay inside the active profile, which ends at %.6g mm.",
      1e3 * range->low, 1e3 * range->high, 1e3 * active);
}

enum eo_code eo_design_check_search(const struct eo_design *design, const struct eo_geometry *geometry,
                                    struct eo_error *error)
{
  const struct eo_optimization *optimization = &design->optimization;
  if (optimization->variables != EO_VARIABLES_LISTED && optimization->listed)
    return eo_error_set(error, EO_ERROR_INPUT, "/optimization/variable_list",
                        "Variables are listed, but variables is not \"listed\".");
  if (optimization->variables == EO_VARIABLES_LISTED && !optimization->listed)
    return eo_error_set(error, EO_ERROR_INPUT, "/optimization/variable_list", "At least one variable must be listed.");
  EO_TRY(eo_optimizer_settings_check(&optimization->search, error));
  EO_TRY(check_start_bounds(&optimization->tip_relief_start, geometry->rack_top,
                            "/optimization/bounds/tip_relief_start_mm", error));
  return check_start_bounds(&optimization->root_relief_start, -geometry->rack_bottom,
                            "/optimization/bounds/root_relief_start_mm", error);
}

/* Contact points at one mesh position, roughly: every contact line across the face, and the pieces of tip edges. */
static double contact_points(const struct eo_resolution *resolution, const struct eo_geometry *geometry, int cells)
{
  return (geometry->transverse_contact_ratio + geometry->overlap_ratio + 1) *
         (cells + (resolution->tip_edge_contact ? 2 * EO_EDGE_CELLS : 0));
}

/* Of what a prepared pair may hold: contact points at a mesh position, and bytes of the matrices of all positions. */
static const double MOST_POINTS = 2000, MOST_GIB = 1, GIB = 1 << 30;

static bool is_too_fine(const struct eo_resolution *resolution, const struct eo_geometry *geometry, int cells)
{
  double points = contact_points(resolution, geometry, cells);
  return points > MOST_POINTS || sizeof(float) * points * points * resolution->positions > MOST_GIB * GIB;
}

int eo_resolution_usual_cells(const struct eo_resolution *resolution, const struct eo_geometry *geometry)
{
  int cells = EO_CELLS_USUAL;
  while (cells > EO_CELLS_LEAST && is_too_fine(resolution, geometry, cells))
    cells--;
  return cells;
}

static enum eo_code check_resolution(const struct eo_resolution *resolution, const struct eo_geometry *geometry,
                                     struct eo_error *error)
{
  double lines = ceil(geometry->transverse_contact_ratio + geometry->overlap_ratio);
  EO_TRY(eo_flexibility_check_sector(&resolution->elements, error));
  if (2 * resolution->te_harmonics > resolution->positions)
    return eo_error_set(error, EO_ERROR_INPUT, "/resolution/te_harmonics",
                        "%d harmonics cannot be told apart on %d mesh positions: at most %d.", resolution->te_harmonics,
                        resolution->positions, resolution->positions / 2);
  if (is_too_fine(resolution, geometry, EO_CELLS_LEAST))
    return eo_error_set(
        error, EO_ERROR_INPUT, "/gear_pair/face_width_mm",
        "The face of %.6g mm holds up to %.0f contact lines at once, more than can be computed with at "
        "%d mesh positions (about 70 at 64): a narrower face, a smaller helix angle or a larger module.",
        1e3 * geometry->face_width, lines, resolution->positions);
  if (is_too_fine(resolution, geometry, resolution->cells_per_line))
    return eo_error_set(
        error, EO_ERROR_INPUT, "/resolution/cells_per_line",
        "%d cells on each of up to %.0f contact lines, at %d mesh positions, are too many: at most %.0f "
        "points at a position and %.0f GiB in all, which %d cells keep.",
        resolution->cells_per_line, lines, resolution->positions, MOST_POINTS, MOST_GIB,
        eo_resolution_usual_cells(resolution, geometry));
  return EO_OK;
}

static enum eo_code check_shaft(const struct eo_shafts *shafts, const struct eo_gear_pair *pair, int i,
                                struct eo_error *error)
{
  const double *bearing = shafts->bearing_position[i];
  char key[64];
  for (int k = 0; k < 2; k++) {
    double face = eo_gear_pair_face_width(pair, k),
           half = (pair->ends == 2 ? pair->groove_width / 2 + face : face / 2) + eo_gear_pair_extra_width(pair, i) / 2;
    snprintf(key, sizeof key, "/shafts/%s_%s_bearing_mm", eo_member_name[i], eo_end_name[k]);
    if (k == EO_LEFT ? bearing[k] > -half : bearing[k] < half)
      return eo_error_set(error, EO_ERROR_INPUT, key,
                          "The %s bearing at %.6g mm is not outside the toothed body, which ends at %.6g mm.",
                          eo_end_name[k], 1e3 * bearing[k], 1e3 * (k == EO_LEFT ? -half : half));
  }
  snprintf(key, sizeof key, "/shafts/%s_shaft_diameter_mm", eo_member_name[i]);
  if (shafts->shaft_diameter[i] <= pair->bore[i])
    return eo_error_set(error, EO_ERROR_INPUT, key,
                        "The shaft, %.6g mm, must be thicker than the bore that runs through it, %.6g mm.",
                        1e3 * shafts->shaft_diameter[i], 1e3 * pair->bore[i]);
  return EO_OK;
}

/* Of elastic bodies alone: nothing else looks at the bearings' places. */
static enum eo_code check_shafts(const struct eo_shafts *shafts, const struct eo_gear_pair *pair,
                                 struct eo_error *error)
{
  for (int i = 0; i < 2 && shafts->enabled; i++) {
    if (!(shafts->bearing_position[i][EO_LEFT] < shafts->bearing_position[i][EO_RIGHT]))
      return eo_error_set(error, EO_ERROR_INPUT, i ? "/shafts/gear_left_bearing_mm" : "/shafts/pinion_left_bearing_mm",
                          "The left bearing at %.6g mm is not left of the right one at %.6g mm.",
                          1e3 * shafts->bearing_position[i][EO_LEFT], 1e3 * shafts->bearing_position[i][EO_RIGHT]);
    EO_TRY(check_shaft(shafts, pair, i, error));
  }
  return EO_OK;
}

static enum eo_code check_objective(const struct eo_objective *objective, struct eo_error *error)
{
  if (objective->robust != EO_ROBUST_OFF && objective->scatter_pairs > 0 &&
      objective->first_pairs > objective->scatter_pairs)
    return eo_error_set(error, EO_ERROR_INPUT, "/objective/first_pairs",
                        "%d pairs are not among the %d of scatter_pairs: state fewer.", objective->first_pairs,
                        objective->scatter_pairs);
  return EO_OK;
}

enum eo_code eo_design_check(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_error *error)
{
  EO_TRY(check_right_helix(&design->gear_pair, error));
  const struct eo_geometry right = eo_geometry_of_half(geometry, &design->gear_pair, EO_RIGHT);
  EO_TRY(check_right_half(&design->gear_pair, &right, error));
  EO_TRY(check_groove(&design->gear_pair, error));
  for (int i = 0; i < 2; i++)
    EO_TRY(check_body(&design->gear_pair, geometry, i, error));
  EO_TRY(eo_modification_check(design, geometry, error));
  EO_TRY(check_resolution(&design->resolution, geometry, error));
  if (eo_gear_pair_is_uneven(&design->gear_pair))
    EO_TRY(check_resolution(&design->resolution, &right, error));
  EO_TRY(check_shafts(&design->shafts, &design->gear_pair, error));
  EO_TRY(check_objective(&design->objective, error));
  return eo_pitch_check(&design->pitch, geometry, design->resolution.positions, error);
}
