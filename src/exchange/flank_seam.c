/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lies between the sides of a kink, and where pieces end. */
#include "exchange/flank_pieces_private.h"

#include <math.h>

/* A side of a line in the frame of a place on it. */
struct side {
  const struct eo_flank_pieces *pieces;
  struct eo_flank_piece piece;
  struct eo_flank_frame frame;
  double y, line, far; /* u of the line and of the side's other end */
  int outwards;        /* from the line: below it -1, above it +1 */
};

/* Where a side's point at u lies: towards the tip, and out of the tooth. */
struct spot {
  double ahead, above;
};

static struct spot spot_at(const struct side *side, double u)
{
  struct eo_surface_point point;
  eo_flank_piece_at(side->pieces, &side->piece, u, side->y, &point);
  return (struct spot){eo_flank_ahead(&side->frame, point.position), eo_flank_above(&side->frame, point.position)};
}

/* Both sides of a line of the piece's band: [below, above]. which: the piece's own end. */
static void look_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which, double y,
                    struct side side[2])
{
  int own = which ? 0 : 1;
  double line = eo_flank_line_at(pieces, piece->line[which], y);
  for (int k = 0; k < 2; k++) {
    side[k] = (struct side){pieces, *piece, eo_flank_frame_at(pieces, line, y), y, line, 0, k ? 1 : -1};
    if (k != own) {
      side[k].piece.line[1 - which] = piece->line[which];
      side[k].piece.line[which] = piece->beyond[which];
    }
    side[k].far = eo_flank_line_at(pieces, side[k].piece.line[k], y);
  }
}

/* How much of a step along u the flank goes on towards the tip; below 0 it folds. */
static double progress_at(const struct side *side, double u)
{
  return (spot_at(side, u + EO_FLANK_STEP / 2).ahead - spot_at(side, u - EO_FLANK_STEP / 2).ahead) / EO_FLANK_STEP;
}

/* From the line to where the flank goes on towards the tip; where it never does, the side's other end, beyond which it
   is taken to go on in a line. A relief whose exponent is below 2 starts with an infinite curvature and folds there,
   and so does a steep one near the base circle. */
static double beyond_fold(const struct side *side)
{
  enum { HALVINGS = 40 };
  const double least = 0.02;
  double from = 0, to = 0;
  while (progress_at(side, side->line + side->outwards * to) < least) {
    from = to;
    to = fmax(2 * to, 4 * EO_FLANK_STEP);
    if (to > fabs(side->far - side->line))
      return side->far;
  }
  for (int i = 0; i < HALVINGS && from < to; i++) {
    double middle = (from + to) / 2;
    bool on = progress_at(side, side->line + side->outwards * middle) >= least;
    *(on ? &to : &from) = middle;
  }
  return side->line + side->outwards * to;
}

/* The u of a side, from `start` on outwards, whose point lies that far ahead. */
static double find_ahead(const struct side *side, double start, double ahead)
{
  double u = start, step = side->outwards * EO_FLANK_STEP; /* away from the fold */
  for (int i = 0; i < 2 * EO_FLANK_STEPS; i++) {
    double here = spot_at(side, u).ahead, off = here - ahead, rate = (spot_at(side, u + step).ahead - here) / step;
    if (fabs(off) < EO_FLANK_NEAR || !(rate > 1e-3))
      break;
    u -= off / rate;
    u = side->outwards > 0 ? fmax(u, start) : fmin(u, start);
  }
  return u;
}

/* Where the sides of a line cross: own[2], u on each. Between the place where the side above begins and the one where
   the side below ends, beyond their folds; false: they do not overlap, or do not cross there. */
static bool find_crossing(const struct side side[2], double own[2])
{
  enum { ROUNDS = 60 };
  double start[2] = {beyond_fold(&side[0]), beyond_fold(&side[1])}, at[2], off[2];
  struct spot end = spot_at(&side[0], start[0]), first = spot_at(&side[1], start[1]);
  if (!(end.ahead > first.ahead))
    return false;
  at[0] = find_ahead(&side[0], start[0], first.ahead);
  at[1] = start[0];
  off[0] = spot_at(&side[0], at[0]).above - first.above;
  off[1] = end.above - spot_at(&side[1], find_ahead(&side[1], start[1], end.ahead)).above;
  if (off[0] * off[1] > 0)
    return false;
  own[1] = start[1];
  for (int i = 0; i < ROUNDS && fabs(at[1] - at[0]) > EO_FLANK_NEAR; i++) { /* false position (Illinois), and halves */
    double share = i % 4 == 3 || off[0] == off[1] ? 0.5 : off[0] / (off[0] - off[1]);
    own[0] = at[0] + share * (at[1] - at[0]);
    struct spot here = spot_at(&side[0], own[0]);
    own[1] = find_ahead(&side[1], start[1], here.ahead);
    double here_off = here.above - spot_at(&side[1], own[1]).above;
    if (fabs(here_off) < EO_FLANK_NEAR / 100)
      return true;
    int same = here_off * off[0] > 0 ? 0 : 1;
    at[same] = own[0];
    off[same] = here_off;
    off[1 - same] /= 2;
  }
  return true;
}

double eo_flank_step_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which, double y)
{
  struct side side[2];
  look_at(pieces, piece, which, y, side);
  return spot_at(&side[1], side[1].line).ahead - spot_at(&side[0], side[0].line).ahead;
}

enum eo_flank_seam eo_flank_seam_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which)
{
  enum { PLACES = 5 };
  const double least = 2e-10; /* m, normal: less is no step */
  double from = pieces->y[piece->band], width = pieces->y[piece->band + 1] - from, largest = 0;
  int apart = 0, crossings = 0;
  bool fold = false;
  for (int i = 0; i < PLACES; i++) {
    double y = from + width * (i + 0.5) / PLACES, step = eo_flank_step_at(pieces, piece, which, y), own[2];
    struct side side[2];
    struct eo_surface_point at[2];
    look_at(pieces, piece, which, y, side);
    for (int k = 0; k < 2; k++) {
      eo_flank_piece_at(pieces, &side[k].piece, side[k].line, y, &at[k]);
      fold = fold || beyond_fold(&side[k]) != side[k].line;
    }
    largest = fmax(largest, fabs(step) * eo_flank_turn(at[0].normal, at[1].normal) / 8);
    apart += step > 0 ? 1 : -1;
    crossings += find_crossing(side, own);
  }
  if (largest < least && !fold)
    return EO_SEAM_SMOOTH;
  if (crossings == PLACES)
    return EO_SEAM_CROSSING;
  return apart == PLACES ? EO_SEAM_SWEPT : EO_SEAM_APART;
}

/* A piece's end at y. */
static void find_end(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which,
                     struct eo_flank_row *row, double y)
{
  double u = eo_flank_line_at(pieces, piece->line[which], y), own[2];
  struct eo_surface_point point;
  struct side side[2];
  int mine = which ? 0 : 1;
  bool kink = piece->beyond[which] >= 0;
  row->own[which] = u;
  if (kink)
    look_at(pieces, piece, which, y, side);
  if (kink && piece->seam[which] == EO_SEAM_CROSSING && find_crossing(side, own))
    row->own[which] = own[mine];
  eo_flank_piece_at(pieces, piece, row->own[which], y, &point);
  row->place[which] = eo_flank_find_place(pieces, point.position, u, y);
  if (!kink || piece->seam[which] != EO_SEAM_SMOOTH || piece->direct)
    return;
  eo_flank_piece_at(pieces, &side[1 - mine].piece, u, y, &point);
  row->place[which] = (row->place[which] + eo_flank_find_place(pieces, point.position, u, y)) / 2;
  const double anywhere[2] = {-INFINITY, INFINITY};
  row->own[which] = eo_flank_find_u(pieces, piece, row->place[which], y, u, anywhere);
}

void eo_flank_ends_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double y,
                      struct eo_flank_row *row)
{
  bool crossing[2];
  for (int which = 0; which < 2; which++) {
    find_end(pieces, piece, which, row, y);
    crossing[which] = piece->seam[which] == EO_SEAM_CROSSING && piece->beyond[which] >= 0;
  }
  if (piece->direct ? row->own[1] > row->own[0] : row->place[1] > row->place[0])
    return;
  double share = crossing[0] == crossing[1] ? 0.5 : crossing[1]; /* the crossing lies beyond the piece's other end */
  row->place[0] = row->place[1] = (1 - share) * row->place[0] + share * row->place[1];
  row->own[0] = row->own[1] = (1 - share) * row->own[0] + share * row->own[1];
}
