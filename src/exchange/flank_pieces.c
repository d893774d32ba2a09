/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/flank_pieces_private.h"

#include <math.h>
#include <string.h>

#include "base/sort.h"

/* Lines and bands: */

static void add_line(struct eo_flank_pieces *pieces, double at, double rate)
{
  if (pieces->lines < EO_FLANK_LINES)
    pieces->line[pieces->lines++] = (struct eo_flank_line){at, rate};
}

/* A corner relief starts where nothing of its plane is left: u = e (end - L_u (1 - (b/2 - f y) / L_y)), e, f: the
   corner's sides. */
static void add_corner_lines(struct eo_flank_pieces *pieces)
{
  const struct eo_modification_shape *shape = eo_flank_shape_of(pieces);
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
  const struct eo_modification_shape *shape = eo_flank_shape_of(pieces);
  for (int end = 0; end < 2; end++)
    add_line(pieces, pieces->u[end], 0);
  for (int side = 0; side < 2; side++)
    if (shape->side[side].length > 0)
      add_line(pieces, (side ? 1 : -1) * shape->side[side].start, 0);
  for (int border = 0; shape->grid && border < 2; border++)
    add_line(pieces, shape->grid->u[border * (shape->grid->u_knots - 1)], 0);
  add_corner_lines(pieces);
}

/* Where two lines cross within the flank; NaN: they do not. */
static double crossing_of(const struct eo_flank_pieces *pieces, const struct eo_flank_line *a,
                          const struct eo_flank_line *b)
{
  const struct eo_flank_line *level = fabs(a->rate) < fabs(b->rate) ? a : b;
  double y = (a->at - b->at) / (b->rate - a->rate), u = level->at + level->rate * y;
  return a->rate != b->rate && u >= pieces->u[0] && u <= pieces->u[1] ? y : NAN;
}

enum { MOST_ENDS = 8 + EO_FLANK_LINES * (EO_FLANK_LINES + 1) };

/* The narrowest band, m: two of its ends that are nearer are one. */
static double least_band(const struct eo_flank_pieces *pieces)
{
  return 5e-6 * pieces->tooth->geometry->member_width[pieces->tooth->member];
}

/* Bands between these, which are put in order, and the faces. */
static void set_bands(struct eo_flank_pieces *pieces, int count, double at[MOST_ENDS])
{
  double half = pieces->tooth->geometry->member_width[pieces->tooth->member] / 2, least = least_band(pieces);
  eo_sort_numbers(count, at);
  pieces->bands = 0;
  pieces->y[0] = -half;
  for (int i = 0; i < count && pieces->bands < EO_FLANK_BANDS - 1; i++)
    if (at[i] > pieces->y[pieces->bands] + least && at[i] < half - least)
      pieces->y[++pieces->bands] = at[i];
  pieces->y[++pieces->bands] = half;
}

/* Bands end where end reliefs start, where a grid ends, and where lines cross. */
static int list_ends(const struct eo_flank_pieces *pieces, double at[MOST_ENDS])
{
  const struct eo_modification_shape *shape = eo_flank_shape_of(pieces);
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
  return count;
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
    double u = eo_flank_line_at(pieces, k, y);
    bool wanted = true;
    int at = 0;
    for (int i = 0; i < count; i++) {
      double other = eo_flank_line_at(pieces, order[i], y);
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

/* The pieces of a band but for swept corners, from root to tip; returns how many. */
static int list_pieces(const struct eo_flank_pieces *pieces, int band, struct eo_flank_piece piece[EO_FLANK_LINES])
{
  int order[EO_FLANK_LINES];
  int count = sort_lines(pieces, (pieces->y[band] + pieces->y[band + 1]) / 2, order) - 1;
  for (int i = 0; i < count; i++)
    piece[i] = (struct eo_flank_piece){.band = band, .line = {order[i], order[i + 1]}};
  return count;
}

/* u in the middle of where a piece turns back at y and goes on again; NaN: nowhere, or from its end on. */
static double find_fold_within(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double y)
{
  enum { STEPS = 200 };
  double low = eo_flank_line_at(pieces, piece->line[0], y), high = eo_flank_line_at(pieces, piece->line[1], y),
         step = (high - low) / STEPS, before = -INFINITY;
  struct eo_flank_frame frame = eo_flank_frame_at(pieces, (low + high) / 2, y);
  int turned = 0; /* the first step of those that lead back */
  for (int i = 0; i <= STEPS; i++) {
    struct eo_surface_point point;
    eo_flank_piece_at(pieces, piece, low + i * step, y, &point);
    double ahead = eo_flank_ahead(&frame, point.position);
    bool back = ahead < before;
    if (!back && turned > 1)
      return low + (turned - 1 + i - 1) * step / 2;
    turned = !back ? 0 : turned ? turned : i;
    before = ahead;
  }
  return NAN;
}

/* A line within such a fold, so that its sides are pieces, which cross. */
static void add_fold_lines(struct eo_flank_pieces *pieces)
{
  for (int band = 0; band < pieces->bands; band++) {
    struct eo_flank_piece piece[EO_FLANK_LINES];
    int count = list_pieces(pieces, band, piece);
    for (int i = 0; i < count; i++) {
      double u = find_fold_within(pieces, &piece[i], (pieces->y[band] + pieces->y[band + 1]) / 2);
      if (isfinite(u))
        add_line(pieces, u, 0);
    }
  }
}

/* Where pieces that overlap begin to lie apart, between two rows. */
static double find_turn(const struct eo_flank_pieces *pieces, const struct eo_flank_piece side[2], double low,
                        double high)
{
  enum { HALVINGS = 40 };
  double sag, first = eo_flank_step_at(pieces, &side[0], &side[1], low, &sag);
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (low + high) / 2, step = eo_flank_step_at(pieces, &side[0], &side[1], middle, &sag);
    *((step > 0) == (first > 0) ? &low : &high) = middle;
  }
  return (low + high) / 2;
}

/* Adds where that is within a band, for lines where a corner sweeps more than nothing; returns how many there are now.
 */
static int add_turns(const struct eo_flank_pieces *pieces, int band, int most, double *at, int count)
{
  struct eo_flank_piece piece[EO_FLANK_LINES];
  int own = list_pieces(pieces, band, piece);
  double from = pieces->y[band], row = (pieces->y[band + 1] - from) / EO_FLANK_ROWS, sag;
  for (int i = 0; i + 1 < own; i++) {
    double before = eo_flank_step_at(pieces, &piece[i], &piece[i + 1], from, &sag);
    for (int r = 1; r <= EO_FLANK_ROWS && eo_flank_is_swept(pieces, &piece[i], &piece[i + 1]); r++) {
      double step = eo_flank_step_at(pieces, &piece[i], &piece[i + 1], from + r * row, &sag);
      if ((step > 0) != (before > 0) && count < most)
        at[count++] = find_turn(pieces, &piece[i], from + (r - 1) * row, from + r * row);
      before = step;
    }
  }
  return count;
}

static bool same_fold(struct eo_flank_fold a, struct eo_flank_fold b)
{
  return a.lost == b.lost && a.part == b.part && a.open == b.open;
}

/* Where an end of the flank begins to fold, or a piece to be lost there, between two rows. */
static double find_fold(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, int count, int which,
                        double low, double high)
{
  enum { HALVINGS = 40 };
  struct eo_flank_fold first = eo_flank_fold_at(pieces, piece, count, which, low);
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (low + high) / 2;
    *(same_fold(eo_flank_fold_at(pieces, piece, count, which, middle), first) ? &low : &high) = middle;
  }
  return (low + high) / 2;
}

/* Adds where that is within a band, more than once between two rows if it has to; returns how many there are now. */
static int add_folds(const struct eo_flank_pieces *pieces, int band, int most, double *at, int count)
{
  enum { TIMES = 4 };
  struct eo_flank_piece piece[EO_FLANK_LINES];
  int own = list_pieces(pieces, band, piece);
  double from = pieces->y[band], row = (pieces->y[band + 1] - from) / EO_FLANK_ROWS, behind = 1e-6 * row;
  for (int which = 0; which < 2; which++) {
    struct eo_flank_fold before = eo_flank_fold_at(pieces, piece, own, which, from);
    for (int r = 1; r <= EO_FLANK_ROWS; r++) {
      double low = from + (r - 1) * row, high = from + r * row;
      const struct eo_flank_fold fold = eo_flank_fold_at(pieces, piece, own, which, high);
      for (int i = 0; i < TIMES && !same_fold(fold, before) && count < most; i++) {
        low = find_fold(pieces, piece, own, which, low, high);
        at[count++] = low;
        low = fmin(low + behind, high);
        before = eo_flank_fold_at(pieces, piece, own, which, low);
      }
      before = fold;
    }
  }
  return count;
}

/* A corner between a piece that is lost and one that is cut itself is lost, too. */
static void cut_band(struct eo_flank_pieces *pieces, int band)
{
  struct eo_flank_piece piece[EO_FLANK_LINES];
  int count = list_pieces(pieces, band, piece);
  double middle = (pieces->y[band] + pieces->y[band + 1]) / 2;
  const struct eo_flank_fold root = eo_flank_fold_at(pieces, piece, count, 0, middle),
                             tip = eo_flank_fold_at(pieces, piece, count, 1, middle);
  int first = root.lost, last = count - 1 - tip.lost;
  for (int i = 0; i < count; i++) {
    piece[i].lost = i < first || i > last;
    piece[i].open[0] = i == first && root.open;
    piece[i].open[1] = i == last && tip.open;
    piece[i].direct = eo_flank_stands_still(pieces, &piece[i]);
    piece[i].swept[1] = i + 1 < count && eo_flank_is_swept(pieces, &piece[i], &piece[i + 1]);
    add_piece(pieces, &piece[i]);
    if (!piece[i].swept[1])
      continue;
    piece[i + 1].swept[0] = true;
    add_piece(pieces, &(struct eo_flank_piece){.band = band,
                                               .line = {piece[i].line[1], piece[i].line[1]},
                                               .lost = i < first - !root.part || i > last - tip.part,
                                               .direct = true});
  }
}

/* How far beyond an end of the flank's circle the rack generates at (u, y), m. */
static double beyond_circle(const struct eo_flank_pieces *pieces, int which, double u, double y)
{
  struct eo_surface_point point;
  eo_flank_rack_at(pieces, u, y, &point);
  return (which ? 1 : -1) * (eo_flank_radius(&point) - pieces->radius[which]);
}

/* How far beyond an end of the active profile the rack goes, m, for the flank to reach its circle at y; INFINITY: that
   takes more than a small part of the profile, or the flank turns back before. Over a kink what is generated jumps. */
static double reach_at(const struct eo_flank_pieces *pieces, int which, double y)
{
  enum { PARTS = 20, STEPS = 50 };
  const double least = 0.02; /* of progress per step of the rack */
  double step = (pieces->u[1] - pieces->u[0]) / PARTS / STEPS;
  int outwards = which ? 1 : -1;
  for (int i = 0; i <= STEPS; i++) {
    double u = pieces->u[which] + outwards * i * step, off = beyond_circle(pieces, which, u, y);
    if (off > -EO_FLANK_NEAR)
      return i * step;
    double beside[2]; /* not at u, which may lie on a kink */
    for (int k = 0; k < 2; k++)
      beside[k] = beyond_circle(pieces, which, u + outwards * (k + 1) * EO_FLANK_STEP, y);
    if (!(beside[1] - beside[0] > least * EO_FLANK_STEP))
      break;
  }
  return INFINITY;
}

/* Where a relief is too steep for that the flank ends where the end of the active profile generates, on no circle. */
static void reach_circles(struct eo_flank_pieces *pieces)
{
  enum { ROWS = 65 };
  const struct eo_tooth *tooth = pieces->tooth;
  double width = tooth->geometry->member_width[tooth->member], reach[2] = {0};
  pieces->radius[0] = tooth->geometry->start_radius[tooth->member];
  pieces->radius[1] = tooth->geometry->tip_radius[tooth->member];
  for (int i = 0; i < ROWS; i++)
    for (int end = 0; end < 2; end++)
      reach[end] = fmax(reach[end], reach_at(pieces, end, ((double)i / (ROWS - 1) - 0.5) * width));
  for (int end = 0; end < 2; end++)
    if (isfinite(reach[end]))
      pieces->u[end] += (end ? 1 : -1) * reach[end];
    else
      pieces->radius[end] = end ? INFINITY : 0;
}

void eo_flank_pieces_init(struct eo_flank_pieces *pieces, const struct eo_tooth *tooth, enum eo_tooth_part part)
{
  memset(pieces, 0, sizeof *pieces);
  pieces->tooth = tooth;
  pieces->coast = part == EO_TOOTH_COAST;
  pieces->sense = 1;
  pieces->u[0] = tooth->geometry->rack_factor * tooth->start_path;
  pieces->u[1] = tooth->geometry->rack_factor * tooth->tip_path;
  struct eo_flank_frame root = eo_flank_frame_at(pieces, pieces->u[0], 0),
                        tip = eo_flank_frame_at(pieces, pieces->u[1], 0);
  pieces->sense = eo_flank_ahead(&root, tip.origin.position) > 0 ? 1 : -1;
  reach_circles(pieces);
  find_lines(pieces);
  double at[MOST_ENDS];
  int ends = list_ends(pieces, at);
  set_bands(pieces, ends, at);
  add_fold_lines(pieces);
  ends = list_ends(pieces, at);
  set_bands(pieces, ends, at);
  for (int band = 0; band < pieces->bands; band++)
    ends = add_folds(pieces, band, MOST_ENDS, at, add_turns(pieces, band, MOST_ENDS, at, ends));
  set_bands(pieces, ends, at);
  for (int band = 0; band < pieces->bands; band++)
    cut_band(pieces, band);
}

/* What a corner of the rack sweeps, as far as neither side of it is lost: else the point where its neighbours meet. */
static void swept_point(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece,
                        const struct eo_flank_row *row, double a, double y, struct eo_surface_point *point)
{
  if (row->own[1] == eo_flank_line_at(pieces, piece->line[0], y))
    eo_flank_swept_at(pieces, piece, row->share[0] + a * (row->share[1] - row->share[0]), y, point);
  else
    eo_flank_piece_at(pieces, row->maker, row->own[1], y, point);
}

void eo_flank_piece_point(const struct eo_flank_pieces *pieces, int k, struct eo_flank_row *row, double a, double b,
                          double point[3], double normal[3])
{
  const struct eo_flank_piece *piece = &pieces->piece[k];
  bool corner = piece->line[0] == piece->line[1];
  double from = pieces->y[piece->band], width = pieces->y[piece->band + 1] - from, y = from + b * width,
         least = fmin(least_band(pieces) / width, 0.1); /* nearer to its ends than that may lie another one's */
  struct eo_surface_point generated;
  if (row->b != b && corner)
    eo_flank_swept_share(pieces, piece, y, row->share);
  if (row->b != b)
    eo_flank_ends_at(pieces, corner ? piece - 1 : piece, from + fmin(fmax(b, least), 1 - least) * width, row);
  row->b = b;
  if (corner)
    swept_point(pieces, piece, row, a, y, &generated);
  else {
    double u = row->own[0] + a * (row->own[1] - row->own[0]),
           place = row->place[0] + a * (row->place[1] - row->place[0]);
    if (!piece->direct && row->own[1] > row->own[0])
      u = eo_flank_find_u(pieces, piece, place, y, u, row->own);
    eo_flank_piece_at(pieces, row->maker, u, y, &generated);
  }
  eo_tooth_place(pieces->tooth, pieces->coast, &generated, point, normal);
}
