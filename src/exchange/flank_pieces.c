/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/flank_pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double beside = 1e-9; /* m: one side of a kink is taken this far from it */

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double product[3])
{
  for (int i = 0; i < 3; i++)
    product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static const struct eo_modification_shape *shape_of(const struct eo_flank_pieces *pieces)
{
  return &pieces->tooth->shape[pieces->coast];
}

/* Lines and bands: */

static void add_line(struct eo_flank_pieces *pieces, double at, double rate)
{
  if (pieces->lines < EO_FLANK_LINES)
    pieces->line[pieces->lines++] = (struct eo_flank_line){at, rate};
}

static double line_at(const struct eo_flank_pieces *pieces, int k, double y)
{
  const struct eo_flank_line *line = &pieces->line[k];
  return fmin(fmax(line->at + line->rate * y, pieces->u[0]), pieces->u[1]);
}

/* A corner relief starts where nothing of its plane is left: u = e (end - L_u (1 - (b/2 - f y) / L_y)), e, f: the
   corner's sides. */
static void add_corner_lines(struct eo_flank_pieces *pieces)
{
  const struct eo_modification_shape *shape = shape_of(pieces);
  double half_face = shape->half_width / shape->lengthen;
  for (int i = 0; i < 4; i++) {
    const struct eo_triangular_relief *relief = &shape->triangular[i / 2][i % 2];
    int outwards = i / 2 == EO_TIP_SIDE ? 1 : -1, face = i % 2 == EO_LEADING_SIDE ? 1 : -1;
    if (relief->amount == 0 || !(relief->profile_length > 0) || !(relief->face_length > 0))
      continue;
    double end = outwards * shape->middle + shape->half_profile;
    add_line(pieces, outwards * (end - relief->profile_length * (1 - half_face / relief->face_length)),
             -outwards * face * relief->profile_length / relief->face_length);
  }
}

static void find_lines(struct eo_flank_pieces *pieces)
{
  const struct eo_modification_shape *shape = shape_of(pieces);
  for (int end = 0; end < 2; end++)
    add_line(pieces, pieces->u[end], 0);
  for (int side = 0; side < 2; side++)
    if (shape->side[side].length > 0)
      add_line(pieces, (side ? 1 : -1) * shape->side[side].start, 0);
  for (int border = 0; shape->grid && border < 2; border++)
    add_line(pieces, shape->grid->u[border * (shape->grid->u_knots - 1)], 0);
  add_corner_lines(pieces);
}

static int compare_numbers(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Where two lines cross within the flank; NaN: they do not. */
static double crossing_of(const struct eo_flank_pieces *pieces, const struct eo_flank_line *a,
                          const struct eo_flank_line *b)
{
  const struct eo_flank_line *level = fabs(a->rate) < fabs(b->rate) ? a : b;
  double y = (a->at - b->at) / (b->rate - a->rate), u = level->at + level->rate * y;
  return a->rate != b->rate && u >= pieces->u[0] && u <= pieces->u[1] ? y : NAN;
}

/* Bands end where end reliefs start, where a grid ends, and where lines cross. */
static void find_bands(struct eo_flank_pieces *pieces)
{
  enum { MOST = 8 + EO_FLANK_LINES * (EO_FLANK_LINES + 1) };
  const struct eo_modification_shape *shape = shape_of(pieces);
  double half = pieces->tooth->geometry->member_width[pieces->tooth->member] / 2, least = 2e-6 * half, at[MOST];
  int count = 0;
  for (int i = 0; i < 2; i++)
    if (shape->end[i].amount != 0)
      at[count++] = (i ? 1 : -1) * fmax(0, shape->end[i].start) / shape->lengthen;
  for (int i = 0; shape->grid && i < 2; i++)
    at[count++] = shape->grid->y[i * (shape->grid->y_knots - 1)];
  for (int i = 0; i < pieces->lines; i++) {
    for (int k = 0; k < i; k++) {
      double y = crossing_of(pieces, &pieces->line[i], &pieces->line[k]);
      if (isfinite(y))
        at[count++] = y;
    }
  }
  qsort(at, (size_t)count, sizeof *at, compare_numbers);
  pieces->bands = 0;
  pieces->y[0] = -half;
  for (int i = 0; i < count && pieces->bands < EO_FLANK_BANDS - 1; i++)
    if (at[i] > pieces->y[pieces->bands] + least && at[i] < half - least)
      pieces->y[++pieces->bands] = at[i];
  pieces->y[++pieces->bands] = half;
}

/* What is generated: */

/* The nearest place of a piece at which its slopes are those of its own side; where it narrows to a point, as far from
   that as it needs to be wide enough. */
static void keep_within(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double *u, double *y)
{
  const double *ends = pieces->y + piece->band;
  double width[2];
  for (int k = 0; k < 2; k++)
    width[k] = line_at(pieces, piece->line[1], ends[k]) - line_at(pieces, piece->line[0], ends[k]);
  double most = fmax(width[0], width[1]), wanted = fmin(4 * beside, most / 2),
         per_width = most > 0 ? (ends[1] - ends[0]) / fabs(width[1] - width[0]) : 0,
         low = ends[0] + fmax(beside, width[0] < wanted ? (wanted - width[0]) * per_width : 0),
         high = ends[1] - fmax(beside, width[1] < wanted ? (wanted - width[1]) * per_width : 0);
  *y = low < high ? fmin(fmax(*y, low), high) : (low + high) / 2;
  low = line_at(pieces, piece->line[0], *y) + beside;
  high = line_at(pieces, piece->line[1], *y) - beside;
  *u = low < high ? fmin(fmax(*u, low), high) : (low + high) / 2;
}

/* Slopes that a piece has at (u, y), at its ends those of its own side, beyond them in a line; returns delta, m. */
static double piece_relief(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double u, double y,
                           double slope[2])
{
  const struct eo_modification_shape *shape = shape_of(pieces);
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

static void piece_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double u, double y,
                     struct eo_surface_point *point)
{
  double slope[2], delta = piece_relief(pieces, piece, u, y, slope);
  generate(pieces, u, y, delta, slope, point);
}

/* The unmodified flank at (u, y): origin, normal, and the tangent that is at right angles to the helix. */
struct frame {
  struct eo_surface_point origin;
  double tangent[3];
};

static struct frame frame_at(const struct eo_flank_pieces *pieces, double u, double y)
{
  const double none[2] = {0};
  double twist = pieces->tooth->twist, length;
  struct frame frame;
  generate(pieces, u, y, 0, none, &frame.origin);
  const double helix[3] = {twist * frame.origin.position[1], -twist * frame.origin.position[0], 1};
  cross(frame.origin.normal, helix, frame.tangent);
  length = pieces->sense * sqrt(dot(frame.tangent, frame.tangent));
  for (int i = 0; i < 3; i++)
    frame.tangent[i] /= length;
  return frame;
}

/* How far beyond the frame's origin a point lies towards the tip, m. */
static double ahead(const struct frame *frame, const double position[3])
{
  double from[3];
  for (int i = 0; i < 3; i++)
    from[i] = position[i] - frame->origin.position[i];
  return dot(from, frame->tangent);
}

static double above(const struct frame *frame, const double position[3])
{
  double from[3];
  for (int i = 0; i < 3; i++)
    from[i] = position[i] - frame->origin.position[i];
  return dot(from, frame->origin.normal);
}

static const double near_enough = 1e-12, difference = 1e-7; /* m */
enum { MOST_STEPS = 20 };

/* The piece's own u whose point lies on the normal of the unmodified flank at `place`. */
static double find_u(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double place, double y)
{
  struct frame frame = frame_at(pieces, place, y);
  struct eo_surface_point here, there;
  double u = place;
  for (int i = 0; i < MOST_STEPS; i++) {
    piece_at(pieces, piece, u, y, &here);
    double off = ahead(&frame, here.position);
    if (fabs(off) < near_enough)
      break;
    piece_at(pieces, piece, u + difference, y, &there);
    double rate = (ahead(&frame, there.position) - off) / difference;
    if (!(rate > 1e-3)) /* the flank stands still near the base circle */
      break;
    u -= off / rate;
  }
  return u;
}

/* The place on the unmodified flank on whose normal a point lies. */
static double find_place(const struct eo_flank_pieces *pieces, const double position[3], double guess, double y)
{
  double place = guess;
  for (int i = 0; i < MOST_STEPS; i++) {
    struct frame here = frame_at(pieces, place, y), there = frame_at(pieces, place + difference, y);
    double off = ahead(&here, position), rate = (ahead(&here, there.origin.position)) / difference;
    if (fabs(off) < near_enough || !(rate > 1e-3))
      break;
    place += off / rate;
  }
  return place;
}

/* Seams: */

/* How much of a step along u the flank goes on towards the tip; below 0 it folds. */
static double progress_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece,
                          const struct frame *frame, double u, double y)
{
  struct eo_surface_point here, there;
  piece_at(pieces, piece, u - difference / 2, y, &here);
  piece_at(pieces, piece, u + difference / 2, y, &there);
  return (ahead(frame, there.position) - ahead(frame, here.position)) / difference;
}

/* From an end of a piece to where the flank goes on towards the tip; the end itself where it never does. A relief whose
   exponent is below 2 starts with an infinite curvature and folds there, and so does a steep one near the base circle.
   which: end of the piece. */
static double beyond_fold(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which, double y)
{
  enum { HALVINGS = 40 };
  const double least = 0.02;
  double line = line_at(pieces, piece->line[which], y), far = line_at(pieces, piece->line[1 - which], y), from = 0,
         to = 0, direction = which ? -1 : 1;
  struct frame frame = frame_at(pieces, line, y);
  while (progress_at(pieces, piece, &frame, line + direction * to, y) < least) {
    from = to;
    to = fmax(2 * to, 4 * difference);
    if (to > fabs(far - line))
      return line;
  }
  for (int i = 0; i < HALVINGS && from < to; i++) {
    double middle = (from + to) / 2;
    bool on = progress_at(pieces, piece, &frame, line + direction * middle, y) >= least;
    *(on ? &to : &from) = middle;
  }
  return line + direction * to;
}

/* Where the sides of a line cross: u on each, and the point; false: not within both. */
static bool find_crossing(const struct eo_flank_pieces *pieces, const struct eo_flank_piece side[2], double u, double y,
                          double own[2], struct eo_surface_point *point)
{
  bool found = false;
  double most = (pieces->u[1] - pieces->u[0]) / 20;
  struct frame frame = frame_at(pieces, u, y);
  struct eo_surface_point at[2], moved[2];
  for (int k = 0; k < 2; k++)
    own[k] = beyond_fold(pieces, &side[k], 1 - k, y);
  for (int i = 0; i < MOST_STEPS; i++) {
    double off[2], rate[2][2];
    for (int k = 0; k < 2; k++) {
      piece_at(pieces, &side[k], own[k], y, &at[k]);
      piece_at(pieces, &side[k], own[k] + difference, y, &moved[k]);
      rate[0][k] = (ahead(&frame, moved[k].position) - ahead(&frame, at[k].position)) / difference;
      rate[1][k] = (above(&frame, moved[k].position) - above(&frame, at[k].position)) / difference;
    }
    off[0] = ahead(&frame, at[0].position) - ahead(&frame, at[1].position);
    off[1] = above(&frame, at[0].position) - above(&frame, at[1].position);
    double determinant = rate[0][1] * rate[1][0] - rate[0][0] * rate[1][1];
    found = fabs(off[0]) + fabs(off[1]) < 100 * near_enough;
    if (fabs(off[0]) + fabs(off[1]) < near_enough || determinant == 0)
      break;
    for (int k = 0; k < 2; k++)
      own[k] -= fmin(most, fmax(-most, (off[1] * rate[0][1 - k] - off[0] * rate[1][1 - k]) / determinant));
  }
  *point = at[0];
  return found && own[0] >= line_at(pieces, side[0].line[0], y) && own[1] <= line_at(pieces, side[1].line[1], y);
}

/* Both sides of a line of the piece's band: [below, above]. which: the piece's own end. */
static void sides_of(const struct eo_flank_piece *piece, int which, struct eo_flank_piece side[2])
{
  side[which ? 0 : 1] = *piece;
  side[which ? 1 : 0] = *piece;
  side[which ? 1 : 0].line[which ? 0 : 1] = piece->line[which];
  side[which ? 1 : 0].line[which ? 1 : 0] = piece->beyond[which];
}

/* What both sides of a line generate decides what lies between them. */
static enum eo_flank_seam seam_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which)
{
  enum { PLACES = 5 };
  const double least = 2e-10; /* m, normal: less is no step */
  struct eo_flank_piece side[2];
  double from = pieces->y[piece->band], width = pieces->y[piece->band + 1] - from, largest = 0;
  int apart = 0, crossings = 0;
  bool fold = false;
  sides_of(piece, which, side);
  for (int i = 0; i < PLACES; i++) {
    double y = from + width * (i + 0.5) / PLACES, u = line_at(pieces, piece->line[which], y), turn[3], own[2];
    struct eo_surface_point at[2], unused;
    struct frame frame = frame_at(pieces, u, y);
    for (int k = 0; k < 2; k++)
      piece_at(pieces, &side[k], u, y, &at[k]);
    double step = ahead(&frame, at[1].position) - ahead(&frame, at[0].position);
    cross(at[0].normal, at[1].normal, turn);
    largest = fmax(largest, fabs(step) * sqrt(dot(turn, turn)) / 8);
    apart += step > 0 ? 1 : -1;
    crossings += find_crossing(pieces, side, u, y, own, &unused);
    for (int k = 0; k < 2; k++)
      fold = fold || beyond_fold(pieces, &side[k], 1 - k, y) != u;
  }
  if (largest < least && !fold)
    return EO_SEAM_SMOOTH;
  if (apart == PLACES)
    return EO_SEAM_SWEPT;
  return apart == -PLACES && crossings == PLACES ? EO_SEAM_CROSSING : EO_SEAM_APART;
}

/* A piece's end at y: its own u, or the place on the unmodified flank, as u. */
static double end_place(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int which, double y)
{
  double u = line_at(pieces, piece->line[which], y), own[2] = {u, u};
  struct eo_flank_piece side[2];
  struct eo_surface_point at[2];
  if (piece->beyond[which] < 0) {
    piece_at(pieces, piece, u, y, &at[0]);
    return piece->direct ? u : find_place(pieces, at[0].position, u, y);
  }
  sides_of(piece, which, side);
  for (int k = 0; k < 2; k++)
    piece_at(pieces, &side[k], u, y, &at[k]);
  int mine = which ? 0 : 1;
  if (piece->seam[which] == EO_SEAM_CROSSING) {
    find_crossing(pieces, side, u, y, own, &at[0]);
    double far = line_at(pieces, piece->line[1 - which], y); /* a crossing beyond it leaves nothing of the piece */
    own[mine] = which ? fmax(own[mine], far) : fmin(own[mine], far);
    piece_at(pieces, piece, own[mine], y, &at[mine]);
  }
  if (piece->direct)
    return own[mine];
  double place = find_place(pieces, at[mine].position, u, y);
  if (piece->seam[which] != EO_SEAM_SMOOTH)
    return place;
  return (place + find_place(pieces, at[1 - mine].position, u, y)) / 2;
}

/* Whether points of a piece are too near each other for their place to tell u: less than this share of the rack's. */
static bool stands_still(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece)
{
  enum { ROWS = 3, PLACES = 9 };
  const double least = 0.05;
  bool still = false;
  for (int i = 0; i < ROWS * PLACES; i++) {
    int row = i / PLACES;
    double from = pieces->y[piece->band], y = from + (row + 0.5) / ROWS * (pieces->y[piece->band + 1] - from);
    double low = line_at(pieces, piece->line[0], y), high = line_at(pieces, piece->line[1], y),
           u = low + (high - low) * (i % PLACES) / (PLACES - 1);
    struct frame frame = frame_at(pieces, u, y), next = frame_at(pieces, u + difference, y);
    struct eo_surface_point here, there;
    piece_at(pieces, piece, u, y, &here);
    piece_at(pieces, piece, u + difference, y, &there);
    still = still || ahead(&frame, next.origin.position) < least * difference ||
            ahead(&frame, there.position) - ahead(&frame, here.position) < least * difference;
  }
  return still;
}

/* Pieces: */

static void add_piece(struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece)
{
  if (pieces->count < EO_FLANK_PIECES)
    pieces->piece[pieces->count++] = *piece;
}

/* Lines of a band from root to tip; those that coincide, and those outside, once. */
static int sort_lines(const struct eo_flank_pieces *pieces, double y, int order[EO_FLANK_LINES])
{
  int count = 0;
  double least = 1e-6 * (pieces->u[1] - pieces->u[0]);
  for (int k = 0; k < pieces->lines; k++) {
    double u = line_at(pieces, k, y);
    bool wanted = true;
    int at = 0;
    for (int i = 0; i < count; i++) {
      double other = line_at(pieces, order[i], y);
      wanted = wanted && fabs(u - other) > least;
      at += other < u;
    }
    if (!wanted)
      continue;
    memmove(order + at + 1, order + at, sizeof *order * (size_t)(count - at));
    order[at] = k;
    count++;
  }
  return count;
}

static void cut_band(struct eo_flank_pieces *pieces, int band)
{
  int order[EO_FLANK_LINES];
  int count = sort_lines(pieces, (pieces->y[band] + pieces->y[band + 1]) / 2, order);
  enum eo_flank_seam before = EO_SEAM_SMOOTH;
  for (int i = 0; i + 1 < count; i++) {
    struct eo_flank_piece piece = {band, {order[i], order[i + 1]}, {-1, -1}, {before, EO_SEAM_SMOOTH}, false};
    if (i > 0)
      piece.beyond[0] = order[i - 1];
    if (i + 2 < count) {
      piece.beyond[1] = order[i + 2];
      piece.seam[1] = seam_at(pieces, &piece, 1);
    }
    before = piece.seam[1];
    piece.direct = stands_still(pieces, &piece);
    add_piece(pieces, &piece);
    if (before == EO_SEAM_SWEPT)
      add_piece(
          pieces,
          &(struct eo_flank_piece){
              band, {order[i + 1], order[i + 1]}, {order[i], order[i + 2]}, {EO_SEAM_SWEPT, EO_SEAM_SWEPT}, true});
  }
}

void eo_flank_pieces_init(struct eo_flank_pieces *pieces, const struct eo_tooth *tooth, enum eo_tooth_part part)
{
  memset(pieces, 0, sizeof *pieces);
  pieces->tooth = tooth;
  pieces->coast = part == EO_TOOTH_COAST;
  pieces->sense = 1;
  pieces->u[0] = tooth->geometry->rack_factor * tooth->start_path;
  pieces->u[1] = tooth->geometry->rack_factor * tooth->tip_path;
  struct frame root = frame_at(pieces, pieces->u[0], 0), tip = frame_at(pieces, pieces->u[1], 0);
  pieces->sense = ahead(&root, tip.origin.position) > 0 ? 1 : -1;
  find_lines(pieces);
  find_bands(pieces);
  for (int band = 0; band < pieces->bands; band++)
    cut_band(pieces, band);
}

/* What a corner of the rack sweeps: slopes from those of one side to those of the other. */
static void swept_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double a, double y,
                     struct eo_surface_point *point)
{
  struct eo_flank_piece side[2] = {*piece, *piece};
  double u = line_at(pieces, piece->line[0], y), slope[2][2], delta = 0;
  side[0].line[0] = piece->beyond[0];
  side[1].line[1] = piece->beyond[1];
  for (int k = 0; k < 2; k++)
    delta = piece_relief(pieces, &side[k], u, y, slope[k]);
  const double mixed[2] = {slope[0][0] + a * (slope[1][0] - slope[0][0]),
                           slope[0][1] + a * (slope[1][1] - slope[0][1])};
  generate(pieces, u, y, delta, mixed, point);
}

void eo_flank_piece_point(const struct eo_flank_pieces *pieces, int k, struct eo_flank_row *row, double a, double b,
                          double point[3], double normal[3])
{
  const struct eo_flank_piece *piece = &pieces->piece[k];
  double from = pieces->y[piece->band], y = from + b * (pieces->y[piece->band + 1] - from);
  struct eo_surface_point generated;
  if (piece->line[0] == piece->line[1])
    swept_at(pieces, piece, a, y, &generated);
  else {
    if (row->b != b)
      for (int which = 0; which < 2; which++)
        row->place[which] = end_place(pieces, piece, which, y);
    row->b = b;
    double place = row->place[0] + a * fmax(0, row->place[1] - row->place[0]);
    piece_at(pieces, piece, piece->direct ? place : find_u(pieces, piece, place, y), y, &generated);
  }
  eo_tooth_place(pieces->tooth, pieces->coast, &generated, point, normal);
}
