/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lies between the sides of a kink, and where pieces end. */
#include "exchange/flank_pieces_private.h"

#include <math.h>

/* A side of a line in the frame of a place on it. */
struct side {
  const struct eo_flank_pieces *pieces;
  struct eo_flank_piece piece;
  struct eo_flank_frame frame;
  double y, line, own, far; /* u of the line, of the side's own end there, and of its other end */
  int outwards;             /* from the line: below it -1, above it +1 */
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

/* Two pieces where they meet. Where what lies between them is lost each is taken to go on as far as the other's line.
 */
static void look_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *below,
                    const struct eo_flank_piece *above, double y, struct side side[2])
{
  double end = eo_flank_line_at(pieces, below->line[1], y), start = eo_flank_line_at(pieces, above->line[0], y);
  struct eo_flank_frame frame = eo_flank_frame_at(pieces, start, y);
  side[0] = (struct side){pieces, *below, frame, y, start, end, eo_flank_line_at(pieces, below->line[0], y), -1};
  side[1] = (struct side){pieces, *above, frame, y, end, start, eo_flank_line_at(pieces, above->line[1], y), 1};
}

/* The step at which a side is looked at; it stays on one that is short. */
static double step_of(const struct side *side)
{
  return fmin(EO_FLANK_STEP, fabs(side->far - side->own) / 4);
}

/* How much of a step along u, away from the line, the flank goes on towards the tip; below 0 it folds. */
static double progress_at(const struct side *side, double u)
{
  double step = side->outwards * step_of(side);
  return (spot_at(side, u + step).ahead - spot_at(side, u).ahead) / step;
}

/* From the line to where the flank goes on towards the tip; where it never does, the side's other end, beyond which it
   is taken to go on in a line. A relief whose exponent is below 2 starts with an infinite curvature and folds there,
   and so does a steep one near the base circle. */
static double beyond_fold(const struct side *side)
{
  enum { HALVINGS = 40 };
  const double least = 0.02;
  double from = 0, to = 0, last = fabs(side->far - side->own) - step_of(side);
  if (!(last > 0))
    return side->far;
  if (progress_at(side, side->own) >= least)
    return side->line;
  while (progress_at(side, side->own + side->outwards * to) < least) {
    if (to >= last)
      return side->far;
    from = to;
    to = fmin(fmax(2 * to, 4 * EO_FLANK_STEP), last);
  }
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (from + to) / 2;
    bool on = progress_at(side, side->own + side->outwards * middle) >= least;
    *(on ? &to : &from) = middle;
  }
  return side->own + side->outwards * to;
}

/* The u of a side, from `start` on outwards, whose point lies that far ahead; where there is none, the last one before
   the side folds. */
static double find_ahead(const struct side *side, double start, double ahead)
{
  double u = start, good = start, bad = side->outwards > 0 ? INFINITY : -INFINITY,
         step = side->outwards * EO_FLANK_STEP;
  for (int i = 0; i < 3 * EO_FLANK_STEPS && fabs(bad - good) > EO_FLANK_NEAR; i++) {
    double here = spot_at(side, u).ahead, off = here - ahead, rate = (spot_at(side, u + step).ahead - here) / step;
    *(rate > 1e-3 ? &good : &bad) = u;
    if (u == bad && u == start)
      break;
    if (u == good && fabs(off) < EO_FLANK_NEAR)
      break;
    if (u == good) { /* beside a fold the rate is next to nothing */
      double most = 2 * fabs(u - start) + 16 * EO_FLANK_STEP;
      u -= fmin(fmax(off / rate, -most), most);
    }
    u = side->outwards > 0 ? fmax(u, start) : fmin(u, start);
    if (side->outwards * (bad - u) <= 0)
      u = (good + bad) / 2;
  }
  return good;
}

/* Where a number that has other signs at at[0] and at[1], off[0] and off[1], is nothing: false position (Illinois), and
   halves. */
static double find_zero(double (*off_at)(const void *context, double u), const void *context, double at[2],
                        double off[2])
{
  enum { ROUNDS = 60 };
  for (int i = 0; i < ROUNDS && fabs(at[1] - at[0]) > EO_FLANK_NEAR; i++) {
    double share = i % 4 == 3 || off[0] == off[1] ? 0.5 : off[0] / (off[0] - off[1]),
           u = at[0] + share * (at[1] - at[0]), here = off_at(context, u);
    if (fabs(here) < EO_FLANK_NEAR / 100)
      return u;
    int same = here * off[0] > 0 ? 0 : 1;
    at[same] = u;
    off[same] = here;
    off[1 - same] /= 2;
  }
  return (at[0] + at[1]) / 2;
}

/* Two sides, and where each begins behind its fold. */
struct seam {
  const struct side *side;
  const double *start;
};

/* How far out of the tooth the side below lies at u above the other at the same place; own[2]: u on each. */
static double gap_at(const struct side side[2], const double start[2], double u, double own[2])
{
  struct spot here = spot_at(&side[0], u);
  own[0] = u;
  own[1] = find_ahead(&side[1], start[1], here.ahead);
  return here.above - spot_at(&side[1], own[1]).above;
}

static double gap_of(const void *context, double u)
{
  const struct seam *seam = context;
  double own[2];
  return gap_at(seam->side, seam->start, u, own);
}

/* Where the sides of a line cross: own[2], u on each. Between the place where the side above begins and the one where
   the side below ends, beyond their folds; false: they do not overlap, or do not cross there. Where a side folds back
   before the other ends and lies above it even there, nothing of it is left: the fold. */
static bool find_crossing(const struct side side[2], double own[2])
{
  double start[2] = {beyond_fold(&side[0]), beyond_fold(&side[1])}, at[2], off[2];
  double first = spot_at(&side[1], start[1]).ahead, end = spot_at(&side[0], start[0]).ahead;
  if (!(end > first))
    return false;
  at[0] = find_ahead(&side[0], start[0], first);
  at[1] = find_ahead(&side[0], start[0], spot_at(&side[1], find_ahead(&side[1], start[1], end)).ahead);
  off[0] = gap_at(side, start, at[0], own);
  bool lost = off[0] > 0 && at[0] > side[0].far && at[0] < side[0].own &&
              spot_at(&side[0], at[0]).ahead - first > EO_FLANK_STEP;
  off[1] = gap_at(side, start, at[1], own);
  if (off[0] * off[1] > 0 && lost)
    gap_at(side, start, at[0], own);
  if (off[0] * off[1] > 0)
    return lost || (off[1] < 0 && own[1] > side[1].own && own[1] < side[1].far &&
                    end - spot_at(&side[0], at[1]).ahead > EO_FLANK_STEP);
  const struct seam seam = {side, start};
  gap_at(side, start, find_zero(gap_of, &seam, at, off), own);
  return true;
}

double eo_flank_step_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *below,
                        const struct eo_flank_piece *above, double y, double *sag)
{
  struct side side[2];
  struct eo_surface_point at[2];
  look_at(pieces, below, above, y, side);
  for (int k = 0; k < 2; k++)
    eo_flank_piece_at(pieces, &side[k].piece, side[k].line, y, &at[k]);
  double step = eo_flank_ahead(&side[0].frame, at[1].position) - eo_flank_ahead(&side[0].frame, at[0].position);
  *sag = fabs(step) * eo_flank_turn(at[0].normal, at[1].normal) / 8;
  return step;
}

bool eo_flank_is_swept(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *below,
                       const struct eo_flank_piece *above)
{
  double from = pieces->y[below->band], width = pieces->y[below->band + 1] - from, sag, largest = 0;
  for (int i = 0; i <= EO_FLANK_ROWS; i++)
    if (eo_flank_step_at(pieces, below, above, from + width * i / EO_FLANK_ROWS, &sag) > 0)
      largest = fmax(largest, sag);
  return largest > EO_FLANK_SAG;
}

/* The piece of the band before (-1) or after (+1) one of which something is left, NULL: none. */
static const struct eo_flank_piece *next_to(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece,
                                            int direction)
{
  const struct eo_flank_piece *next = piece + direction;
  while (next >= pieces->piece && next < pieces->piece + pieces->count &&
         (next->lost || next->line[0] == next->line[1]))
    next += direction;
  bool there = next >= pieces->piece && next < pieces->piece + pieces->count && next->band == piece->band;
  return there ? next : NULL;
}

/* Where two pieces meet at y: u on each, and the place on the unmodified flank. */
struct meeting {
  double own[2], place[2];
};

/* Where one of two pieces is the flank's last and folded back as a whole the other ends behind its own fold. */
static bool find_lost(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *below,
                      const struct eo_flank_piece *above, const struct side side[2], double own[2])
{
  double start[2] = {beyond_fold(&side[0]), beyond_fold(&side[1])};
  bool lost[2] = {start[0] == side[0].far && !next_to(pieces, below, -1),
                  start[1] == side[1].far && !next_to(pieces, above, 1)};
  for (int k = 0; k < 2; k++)
    own[k] = lost[k] ? side[k].own : start[k];
  return lost[0] != lost[1];
}

/* Where they cross. Else each ends at its line; where what lies between is no more than nothing, in the middle of it.
 */
static struct meeting meet(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *below,
                           const struct eo_flank_piece *above, double y)
{
  const double anywhere[2] = {-INFINITY, INFINITY};
  struct meeting meeting = {0};
  struct side side[2];
  look_at(pieces, below, above, y, side);
  bool corner = below->swept[1] && next_to(pieces, below, 1) == above,
       crossing = !corner && (find_lost(pieces, below, above, side, meeting.own) || find_crossing(side, meeting.own));
  for (int k = 0; k < 2; k++) {
    struct eo_surface_point point;
    if (!crossing)
      meeting.own[k] = side[k].line;
    eo_flank_piece_at(pieces, &side[k].piece, meeting.own[k], y, &point);
    meeting.place[k] = eo_flank_find_place(pieces, point.position, side[k].line, y);
  }
  if (crossing || corner)
    return meeting;
  meeting.place[0] = meeting.place[1] = (meeting.place[0] + meeting.place[1]) / 2;
  for (int k = 0; k < 2; k++)
    if (!side[k].piece.direct)
      meeting.own[k] = eo_flank_find_u(pieces, &side[k].piece, meeting.place[k], y, side[k].line, anywhere);
  return meeting;
}

double eo_flank_radius(const struct eo_surface_point *point)
{
  return hypot(point->position[0], point->position[1]);
}

/* How far the point at u of a side at an end of the flank (the root's where it looks towards the tip) is beyond the
   circle there, m. */
static double beyond_circle(const void *context, double u)
{
  const struct side *side = context;
  struct eo_surface_point point;
  eo_flank_piece_at(side->pieces, &side->piece, u, side->y, &point);
  double radius = side->pieces->radius[side->outwards < 0];
  return radius > 0 ? side->outwards * (radius - eo_flank_radius(&point)) : -INFINITY;
}

/* The u of a side at an end of the flank that lies on its circle, from `start` on; where that is within the circle, the
   start, or beyond the line of a side that is open; where all of it is beyond, its other end. */
static double on_circle(const struct side *side, double start, bool open)
{
  double at[2] = {start, side->far}, off[2] = {beyond_circle(side, start)}, most = fabs(side->far - side->own);
  if (off[0] <= 0 && (!open || isinf(off[0])))
    return start;
  for (double way = 16 * EO_FLANK_STEP; off[0] <= 0; way *= 2) {
    if (way > most)
      return start;
    at[1] = at[0];
    at[0] = start - side->outwards * way;
    off[0] = beyond_circle(side, at[0]);
  }
  off[1] = beyond_circle(side, at[1]);
  if (off[1] > 0) { /* it may begin with a fold that leads back over the circle */
    struct side turned = *side;
    turned.outwards = -side->outwards;
    turned.line = turned.own = side->far;
    turned.far = side->own;
    at[1] = beyond_fold(&turned);
    off[1] = beyond_circle(side, at[1]);
  }
  return off[1] > 0 ? side->far : find_zero(beyond_circle, side, at, off);
}

void eo_flank_swept_share(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double y,
                          double share[2])
{
  enum { HALVINGS = 50 };
  for (int which = 0; which < 2; which++) {
    double in = 1 - which, out = which;
    share[which] = which;
    for (int i = 0; i < HALVINGS; i++) {
      struct eo_surface_point point;
      double at = i ? (in + out) / 2 : out;
      eo_flank_swept_at(pieces, piece, at, y, &point);
      bool within = (which ? 1 : -1) * (eo_flank_radius(&point) - pieces->radius[which]) <= EO_FLANK_NEAR;
      if (i == 0 && within)
        break;
      *(within ? &in : &out) = at;
      share[which] = in;
    }
  }
}

/* An end of a piece at y: u, and the place on the unmodified flank. */
struct end {
  double own, place;
};

/* Where a piece meets its neighbour towards the tip (1) or the root (0), or the one behind it (NULL: none) where
   nothing is left of the neighbour. */
static struct end end_at_neighbour(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which,
                                   const struct eo_flank_piece *next, const struct eo_flank_piece *behind, double y)
{
  int direction = which ? 1 : -1, mine = which ? 0 : 1;
  struct meeting here = which ? meet(pieces, piece, next, y) : meet(pieces, next, piece, y);
  if (behind) {
    struct meeting there = which ? meet(pieces, next, behind, y) : meet(pieces, behind, next, y);
    if (direction * (there.own[mine] - here.own[1 - mine]) < 0)
      here = which ? meet(pieces, piece, behind, y) : meet(pieces, behind, piece, y);
  }
  return (struct end){here.own[mine], here.place[mine]};
}

/* A piece seen from an end of the flank. */
static struct side from_end(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which,
                            double y)
{
  double end = eo_flank_line_at(pieces, piece->line[which], y);
  return (struct side){pieces,
                       *piece,
                       eo_flank_frame_at(pieces, end, y),
                       y,
                       end,
                       end,
                       eo_flank_line_at(pieces, piece->line[1 - which], y),
                       which ? -1 : 1};
}

struct eo_flank_fold eo_flank_fold_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece,
                                      int count, int which, double y)
{
  const double least = 1e-9; /* m */
  struct eo_flank_fold fold = {0};
  int inwards = which ? -1 : 1;
  for (const struct eo_flank_piece *own = piece + (which ? count - 1 : 0); fold.lost < count - 1; own += inwards) {
    struct side side = from_end(pieces, own, which, y);
    double behind = beyond_fold(&side), start = on_circle(&side, behind, fold.open), end = side.far;
    if (start != side.far)
      end = end_at_neighbour(pieces, own, 1 - which, own + inwards, fold.lost < count - 2 ? own + 2 * inwards : NULL, y)
                .own;
    bool folded = behind != side.own && start == behind;
    fold.part = folded || (fold.open && inwards * (start - side.own) > least);
    bool on_no_circle = !folded && start != side.far && !isfinite(beyond_circle(&side, start));
    if (inwards * (end - start) > 0 || on_no_circle)
      break;
    fold.open = !folded;
    fold.lost++;
  }
  return fold;
}

/* An end of a piece that has a neighbour there, or that of the flank: behind its fold, on its circle, or where a corner
   goes on. */
static struct end find_end(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which,
                           double y)
{
  int direction = which ? 1 : -1;
  const struct eo_flank_piece *next = next_to(pieces, piece, direction);
  if (next)
    return end_at_neighbour(pieces, piece, which, next, next_to(pieces, next, direction), y);
  struct side side = from_end(pieces, piece, which, y);
  double own = side.own;
  if (!piece->swept[which] || piece[direction].lost)
    own = on_circle(&side, beyond_fold(&side), piece->open[which]);
  struct eo_surface_point point;
  eo_flank_piece_at(pieces, piece, own, y, &point);
  return (struct end){own, eo_flank_find_place(pieces, point.position, own, y)};
}

void eo_flank_ends_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double y,
                      struct eo_flank_row *row)
{
  const struct eo_flank_piece *before = next_to(pieces, piece, -1), *after = next_to(pieces, piece, 1);
  row->maker = piece;
  if (piece->lost) {
    row->own[0] = row->own[1] = row->place[0] = row->place[1] = eo_flank_line_at(pieces, piece->line[1], y);
    return;
  }
  for (int which = 0; which < 2; which++) {
    struct end end = find_end(pieces, piece, which, y);
    row->own[which] = end.own;
    row->place[which] = end.place;
  }
  if (row->own[1] > row->own[0] && (piece->direct || row->place[1] > row->place[0]))
    return;
  if (before && after) {
    struct meeting meeting = meet(pieces, before, after, y);
    row->maker = before;
    row->place[0] = row->place[1] = meeting.place[0];
    row->own[0] = row->own[1] = meeting.own[0];
  } else { /* the crossing lies beyond the flank's end */
    row->place[0] = row->place[1] = row->place[before ? 0 : 1];
    row->own[0] = row->own[1] = row->own[before ? 0 : 1];
  }
}
