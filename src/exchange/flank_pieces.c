/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/flank_pieces_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
  const struct eo_modification_shape *shape = eo_flank_shape_of(pieces);
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
      piece.seam[1] = eo_flank_seam_at(pieces, &piece, 1);
    }
    before = piece.seam[1];
    piece.direct = eo_flank_stands_still(pieces, &piece);
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
  struct eo_flank_frame root = eo_flank_frame_at(pieces, pieces->u[0], 0),
                        tip = eo_flank_frame_at(pieces, pieces->u[1], 0);
  pieces->sense = eo_flank_ahead(&root, tip.origin.position) > 0 ? 1 : -1;
  find_lines(pieces);
  find_bands(pieces);
  for (int band = 0; band < pieces->bands; band++)
    cut_band(pieces, band);
}

void eo_flank_piece_point(const struct eo_flank_pieces *pieces, int k, struct eo_flank_row *row, double a, double b,
                          double point[3], double normal[3])
{
  const struct eo_flank_piece *piece = &pieces->piece[k];
  double from = pieces->y[piece->band], y = from + b * (pieces->y[piece->band + 1] - from);
  struct eo_surface_point generated;
  if (piece->line[0] == piece->line[1])
    eo_flank_swept_at(pieces, piece, a, y, &generated);
  else {
    if (row->b != b)
      eo_flank_ends_at(pieces, piece, y, row);
    row->b = b;
    double u = row->own[0] + a * (row->own[1] - row->own[0]),
           place = row->place[0] + a * (row->place[1] - row->place[0]);
    if (!piece->direct)
      u = eo_flank_find_u(pieces, piece, place, y, u, row->own);
    eo_flank_piece_at(pieces, piece, u, y, &generated);
  }
  eo_tooth_place(pieces->tooth, pieces->coast, &generated, point, normal);
}
