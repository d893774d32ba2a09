/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a piece of a flank generates, and where that lies on the unmodified flank. */
#include "exchange/flank_pieces_private.h"

#include <math.h>

#include "numerics/dense.h"

static const double beside = 1e-9; /* m: one side of a kink is taken this far from it */

static void cross(const double a[3], const double b[3], double product[3])
{
  for (int i = 0; i < 3; i++)
    product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}
const struct eo_modification_shape *eo_flank_shape_of(const struct eo_flank_pieces *pieces)
{
  return &pieces->tooth->shape[pieces->coast];
}
double eo_flank_line_at(const struct eo_flank_pieces *pieces, int k, double y)
{
  const struct eo_flank_line *line = &pieces->line[k];
  return fmin(fmax(line->at + line->rate * y, pieces->u[0]), pieces->u[1]);
}

/* The nearest place of a piece at which its slopes are those of its own side; where it narrows to a point, as far from
   that as it needs to be wide enough. */
static void keep_within(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double *u, double *y)
{
  const double *ends = pieces->y + piece->band;
  double width[2];
  for (int k = 0; k < 2; k++)
    width[k] = eo_flank_line_at(pieces, piece->line[1], ends[k]) - eo_flank_line_at(pieces, piece->line[0], ends[k]);
  double most = fmax(width[0], width[1]), wanted = fmin(4 * beside, most / 2),
         per_width = most > 0 ? (ends[1] - ends[0]) / fabs(width[1] - width[0]) : 0,
         low = ends[0] + fmax(beside, width[0] < wanted ? (wanted - width[0]) * per_width : 0),
         high = ends[1] - fmax(beside, width[1] < wanted ? (wanted - width[1]) * per_width : 0);
  *y = low < high ? fmin(fmax(*y, low), high) : (low + high) / 2;
  low = eo_flank_line_at(pieces, piece->line[0], *y) + beside;
  high = eo_flank_line_at(pieces, piece->line[1], *y) - beside;
  *u = low < high ? fmin(fmax(*u, low), high) : (low + high) / 2;
}

/* Slopes that a piece has at (u, y), at its ends those of its own side, beyond them in a line; returns delta, m. */
static double piece_relief(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double u, double y,
                           double slope[2])
{
  const struct eo_modification_shape *shape = eo_flank_shape_of(pieces);
  double along = (pieces->coast ? -1 : 1) * shape->lengthen, own = u, within = y;
  keep_within(pieces, piece, &own, &within);
  return eo_surface_relief(shape, own, along * within, slope) + slope[0] * (u - own) + slope[1] * along * (y - within);
}

static void generate(const struct eo_flank_pieces *pieces, double u, double y, double delta, const double slope[2],
                     struct eo_surface_point *point)
{
  const struct eo_geometry *geometry = pieces->tooth->geometry;
  int member = pieces->tooth->member;
  double v, same, path = eo_geometry_own_path(member, u / geometry->rack_factor);
  eo_surface_coordinates(geometry, member, path, pieces->coast ? -y : y, &same, &v);
  eo_surface_generate(geometry, member, u, v, delta, slope, point);
}

void eo_flank_piece_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double u, double y,
                       struct eo_surface_point *point)
{
  double slope[2], delta = piece_relief(pieces, piece, u, y, slope);
  generate(pieces, u, y, delta, slope, point);
}

void eo_flank_rack_at(const struct eo_flank_pieces *pieces, double u, double y, struct eo_surface_point *point)
{
  const struct eo_modification_shape *shape = eo_flank_shape_of(pieces);
  double slope[2], delta = eo_surface_relief(shape, u, (pieces->coast ? -1 : 1) * shape->lengthen * y, slope);
  generate(pieces, u, y, delta, slope, point);
}

double eo_flank_turn(const double a[3], const double b[3])
{
  double product[3];
  cross(a, b, product);
  return sqrt(eo_dot(3, product, product));
}

struct eo_flank_frame eo_flank_frame_at(const struct eo_flank_pieces *pieces, double u, double y)
{
  const double none[2] = {0};
  double twist = pieces->tooth->twist, length;
  struct eo_flank_frame frame;
  generate(pieces, u, y, 0, none, &frame.origin);
  const double helix[3] = {twist * frame.origin.position[1], -twist * frame.origin.position[0], 1};
  cross(frame.origin.normal, helix, frame.tangent);
  length = pieces->sense * sqrt(eo_dot(3, frame.tangent, frame.tangent));
  for (int i = 0; i < 3; i++)
    frame.tangent[i] /= length;
  return frame;
}

double eo_flank_ahead(const struct eo_flank_frame *frame, const double position[3])
{
  double from[3];
  for (int i = 0; i < 3; i++)
    from[i] = position[i] - frame->origin.position[i];
  return eo_dot(3, from, frame->tangent);
}

double eo_flank_above(const struct eo_flank_frame *frame, const double position[3])
{
  double from[3];
  for (int i = 0; i < 3; i++)
    from[i] = position[i] - frame->origin.position[i];
  return eo_dot(3, from, frame->origin.normal);
}

/* Newton's steps, or halves where they leave what is left. */
double eo_flank_find_u(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double place, double y,
                       double guess, const double within[2])
{
  struct eo_flank_frame frame = eo_flank_frame_at(pieces, place, y);
  struct eo_surface_point here, there;
  double u = guess, low = within[0], high = within[1];
  for (int i = 0; i < 2 * EO_FLANK_STEPS; i++) {
    eo_flank_piece_at(pieces, piece, u, y, &here);
    double off = eo_flank_ahead(&frame, here.position);
    if (fabs(off) < EO_FLANK_NEAR)
      break;
    *(off > 0 ? &high : &low) = u;
    eo_flank_piece_at(pieces, piece, u + EO_FLANK_STEP, y, &there);
    double rate = (eo_flank_ahead(&frame, there.position) - off) / EO_FLANK_STEP, next = u - off / rate;
    bool good = rate > 1e-3 && next >= low && next <= high;
    if (!good && !(isfinite(low) && isfinite(high))) /* the flank stands still near the base circle */
      break;
    u = good ? next : (low + high) / 2;
  }
  return u;
}

double eo_flank_find_place(const struct eo_flank_pieces *pieces, const double position[3], double guess, double y)
{
  double place = guess;
  for (int i = 0; i < EO_FLANK_STEPS; i++) {
    struct eo_flank_frame here = eo_flank_frame_at(pieces, place, y),
                          there = eo_flank_frame_at(pieces, place + EO_FLANK_STEP, y);
    double off = eo_flank_ahead(&here, position), rate = (eo_flank_ahead(&here, there.origin.position)) / EO_FLANK_STEP;
    if (fabs(off) < EO_FLANK_NEAR || !(rate > 1e-3))
      break;
    place += off / rate;
  }
  return place;
}

bool eo_flank_stands_still(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece)
{
  enum { ROWS = 3, PLACES = 9 };
  const double least = 0.05;
  bool still = false;
  for (int i = 0; i < ROWS * PLACES; i++) {
    int row = i / PLACES;
    double from = pieces->y[piece->band], y = from + (row + 0.5) / ROWS * (pieces->y[piece->band + 1] - from);
    double low = eo_flank_line_at(pieces, piece->line[0], y), high = eo_flank_line_at(pieces, piece->line[1], y),
           u = low + (high - low) * (i % PLACES) / (PLACES - 1);
    struct eo_flank_frame frame = eo_flank_frame_at(pieces, u, y),
                          next = eo_flank_frame_at(pieces, u + EO_FLANK_STEP, y);
    struct eo_surface_point here, there;
    eo_flank_piece_at(pieces, piece, u, y, &here);
    eo_flank_piece_at(pieces, piece, u + EO_FLANK_STEP, y, &there);
    still = still || eo_flank_ahead(&frame, next.origin.position) < least * EO_FLANK_STEP ||
            eo_flank_ahead(&frame, there.position) - eo_flank_ahead(&frame, here.position) < least * EO_FLANK_STEP;
  }
  return still;
}

void eo_flank_swept_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double a, double y,
                       struct eo_surface_point *point)
{
  double u = eo_flank_line_at(pieces, piece->line[0], y), slope[2][2], delta = 0;
  for (int k = 0; k < 2; k++)
    delta = piece_relief(pieces, piece + (k ? 1 : -1), u, y, slope[k]);
  const double mixed[2] = {slope[0][0] + a * (slope[1][0] - slope[0][0]),
                           slope[0][1] + a * (slope[1][1] - slope[0][1])};
  generate(pieces, u, y, delta, mixed, point);
}
