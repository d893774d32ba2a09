/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/tooth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/flank_grid_document.h"
#include "gear/surface.h"

const char *const eo_tooth_part_names[EO_TOOTH_PARTS] = {"drive flank", "coast flank", "tip land",
                                                         "root at drive flank", "root at coast flank"};

/* Angle from +y towards +x of the unmodified flank at the pitch radius, as eo_surface_evaluate() has it. */
static double pitch_angle(const struct eo_geometry *geometry, int member, double eta)
{
  const struct eo_flank_modification none = {0};
  struct eo_modification_shape shape;
  struct eo_surface_point point;
  double u, v;
  eo_modification_init(&shape, geometry, member, &none);
  eo_surface_coordinates(geometry, member, 0, eta, &u, &v);
  eo_surface_evaluate(geometry, member, &shape, u, v, &point);
  return atan2(point.position[0], point.position[1]);
}

/* Parameter where the root circle ends and the trochoid begins. */
static double find_circle(const struct eo_geometry *geometry, int member)
{
  const double above = 1e-9; /* m */
  double low = 0, high = 1, point[2], normal[2];
  for (int i = 0; i < 50; i++) {
    double middle = (low + high) / 2;
    eo_geometry_fillet(geometry, member, middle, point, normal);
    if (hypot(point[0], point[1]) - geometry->root_radius[member] > above)
      high = middle;
    else
      low = middle;
  }
  return low;
}

void eo_tooth_done(struct eo_tooth *tooth)
{
  for (int side = 0; side < 2; side++)
    eo_flank_spline_free(tooth->spline[side]);
}

enum eo_code eo_tooth_init(struct eo_tooth *tooth, const struct eo_design *design, const struct eo_geometry *whole,
                           int member, int end, struct eo_error *error)
{
  const double least = 1e-6; /* m: less is no piece of its own */
  memset(tooth, 0, sizeof *tooth);
  tooth->own = eo_geometry_of_half(whole, &design->gear_pair, end);
  const struct eo_geometry *geometry = tooth->geometry = &tooth->own;
  double point[2], normal[2], eta = geometry->face_width / 4;
  tooth->member = member;
  tooth->end = end;
  tooth->two_ends = design->gear_pair.ends == 2;
  tooth->along = (end == EO_LEFT ? -1 : 1) * eo_alignment_outwards(&design->alignment);
  tooth->across = -eo_design_rotation(design);
  for (int side = 0; side < 2; side++)
    if (eo_flank_shape(design, geometry, (enum eo_flank_side)side, member, end, &tooth->shape[side],
                       &tooth->spline[side])) {
      eo_tooth_done(tooth);
      return eo_error_memory(error);
    }
  tooth->shape[EO_COAST_FLANK].mirrored = true; /* flank_point() has it in a frame that runs against y */
  tooth->offset = (end == EO_LEFT ? -1 : 1) * eo_gear_pair_mid_face(&design->gear_pair, end);
  double behind = end == EO_RIGHT ? eo_design_right_lag(design, whole) * 2 * M_PI / geometry->teeth[member] : 0;
  tooth->pitch = pitch_angle(geometry, member, 0);
  tooth->behind = member == EO_PINION ? behind : -behind;
  double along = member == EO_PINION ? eta : -eta; /* z of the surface's own frame */
  tooth->twist = (pitch_angle(geometry, member, eta) - tooth->pitch) / along;
  eo_geometry_involute(geometry, member, geometry->working_radius[member], point, normal);
  tooth->half = atan2(point[0], point[1]);
  tooth->form_path = eo_geometry_own_path(member, eo_geometry_path_at(geometry, member, geometry->form_radius[member]));
  tooth->start_path = eo_geometry_own_path(member,
                                           eo_geometry_path_at(geometry, member, geometry->start_radius[member]));
  tooth->fillet_share = tooth->start_path - tooth->form_path > least ? 0.8 : 1;
  tooth->tip_path = eo_geometry_own_path(member, eo_geometry_path_at(geometry, member, geometry->tip_radius[member]));
  tooth->circle_share = find_circle(geometry, member);
  return EO_OK;
}

static bool is_flank(enum eo_tooth_part part)
{
  return part == EO_TOOTH_DRIVE || part == EO_TOOTH_COAST;
}

static int add_break(double at[EO_TOOTH_PIECES + 1], int count, double value)
{
  const double least = 1e-6; /* a piece smaller than this would be no face */
  if (value <= at[count - 1] + least || value >= 1 - least)
    return count;
  at[count] = value;
  return count + 1;
}

int eo_tooth_breaks(const struct eo_tooth *tooth, enum eo_tooth_part part, int direction,
                    double at[EO_TOOTH_PIECES + 1])
{
  int count = 1;
  at[0] = 0;
  if (!is_flank(part) && part != EO_TOOTH_TIP && direction == 0)
    count = add_break(at, add_break(at, count, tooth->circle_share * tooth->fillet_share), tooth->fillet_share);
  at[count] = 1;
  return count + 1;
}

static void turn_vector(double vector[3], double angle) /* from +y towards +x */
{
  double c = cos(angle), s = sin(angle), x = vector[0], y = vector[1];
  vector[0] = c * x + s * y;
  vector[1] = c * y - s * x;
}

/* From a generated flank's own frame to that of its own end with its tooth's centre on +y in mid face. */
static void turn_flank(const struct eo_tooth *tooth, bool coast, const struct eo_surface_point *exact, double point[3],
                       double normal[3])
{
  memcpy(point, exact->position, sizeof exact->position);
  memcpy(normal, exact->normal, sizeof exact->normal);
  double *const both[2] = {point, normal};
  for (int i = 0; i < 2; i++) {
    turn_vector(both[i], tooth->half - tooth->pitch);
    if (coast) { /* half a turn about the tooth's centre */
      both[i][0] = -both[i][0];
      both[i][2] = -both[i][2];
    }
  }
}

/* eta: + to the face that meets first. */
static void flank_point(const struct eo_tooth *tooth, bool coast, double path, double eta, double point[3],
                        double normal[3])
{
  struct eo_surface_point exact;
  double u, v, s = eo_geometry_own_path(tooth->member, path), own = coast ? -eta : eta;
  eo_surface_coordinates(tooth->geometry, tooth->member, s, own, &u, &v);
  eo_surface_evaluate(tooth->geometry, tooth->member, &tooth->shape[coast], u, v, &exact);
  turn_flank(tooth, coast, &exact, point, normal);
}

/* What is no flank: a transverse profile that turns with z. */
static void swept_point(const struct eo_tooth *tooth, enum eo_tooth_part part, double p, double z, double point[3],
                        double normal[3])
{
  const struct eo_geometry *geometry = tooth->geometry;
  if (part == EO_TOOTH_TIP) {
    double tip[2], across[2];
    eo_geometry_involute(geometry, tooth->member, geometry->tip_radius[tooth->member], tip, across);
    double angle = (2 * p - 1) * atan2(tip[0], tip[1]);
    normal[0] = sin(angle);
    normal[1] = cos(angle);
    for (int i = 0; i < 2; i++)
      point[i] = geometry->tip_radius[tooth->member] * normal[i];
  } else {
    double share = tooth->fillet_share;
    if (p <= share)
      eo_geometry_fillet(geometry, tooth->member, p / share, point, normal);
    else {
      double path = tooth->form_path + (p - share) / (1 - share) * (tooth->start_path - tooth->form_path);
      double radius = eo_geometry_radius_at(geometry, tooth->member, eo_geometry_own_path(tooth->member, path));
      eo_geometry_involute(geometry, tooth->member, fmax(radius, geometry->base_radius[tooth->member]), point, normal);
    }
    if (part == EO_TOOTH_COAST_ROOT) {
      point[0] = -point[0];
      normal[0] = -normal[0];
    }
  }
  point[2] = z;
  /* the tangent along z, (dx/dz, dy/dz, 1) with the tooth's twist, is at right angles to the normal */
  normal[2] = -tooth->twist * (normal[0] * point[1] - normal[1] * point[0]);
  double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  for (int i = 0; i < 3; i++)
    normal[i] /= length;
  turn_vector(point, tooth->twist * z);
  turn_vector(normal, tooth->twist * z);
}

/* From the frame of the tooth's own end to that of the member. */
static void set_in_member(const struct eo_tooth *tooth, int number, double point[3], double normal[3])
{
  double angle = -tooth->half - tooth->behind + number * 2 * M_PI / tooth->geometry->teeth[tooth->member];
  double *const both[2] = {point, normal};
  for (int i = 0; i < 2; i++) {
    turn_vector(both[i], angle);
    both[i][0] *= tooth->across;
    both[i][2] *= tooth->member == EO_PINION ? tooth->along : -tooth->along;
  }
  point[2] += tooth->offset;
}

void eo_tooth_point(const struct eo_tooth *tooth, enum eo_tooth_part part, int number, double p, double q,
                    double point[3], double normal[3])
{
  const struct eo_geometry *geometry = tooth->geometry;
  double y = geometry->member_width[tooth->member] * tooth->along * (q - 0.5), unused[3];
  double *across = normal ? normal : unused;
  if (is_flank(part))
    flank_point(tooth, part == EO_TOOTH_COAST, tooth->start_path + p * (tooth->tip_path - tooth->start_path), y, point,
                across);
  else
    swept_point(tooth, part, p, tooth->member == EO_PINION ? y : -y, point, across);
  set_in_member(tooth, number, point, across);
}

void eo_tooth_place(const struct eo_tooth *tooth, bool coast, const struct eo_surface_point *generated, double point[3],
                    double normal[3])
{
  double unused[3], *across = normal ? normal : unused;
  turn_flank(tooth, coast, generated, point, across);
  set_in_member(tooth, 0, point, across);
}
