/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A part of a tooth in smooth pieces: B-spline faces within the tolerance, their edges and corners. */
#include "exchange/step_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double eo_step_tolerance = 5e-9;
enum { FIRST_COUNT = 8, SWEPT_COUNT = 5 };

struct piece {
  const struct eo_step_part *part;
  int number;
  struct eo_flank_row *row;
};

/* Surfaces: */

static void piece_point(const void *context, double p, double q, double point[3], double normal[3])
{
  const struct piece *piece = context;
  const struct eo_step_part *part = piece->part;
  const struct eo_step_face *face = &part->face[piece->number];
  double own = part->flipped ? 1 - p : p;
  if (part->flank) {
    eo_flank_piece_point(&part->pieces, face->i, piece->row, own, q, point, normal);
    return;
  }
  const double *from = &part->at[0][face->i], *to = &part->at[1][face->j];
  eo_tooth_point(part->tooth, part->part, 0, from[0] + own * (from[1] - from[0]), to[0] + q * (to[1] - to[0]), point,
                 normal);
}

/* Whether dS/dp x dS/dq points into the tooth. */
static bool points_in(const struct eo_step_part *part)
{
  const double step = 1e-3;
  double a[3], b[3], c[3], normal[3], cross;
  struct eo_flank_row row = {.b = -1};
  const struct piece piece = {part, 0, &row};
  piece_point(&piece, 0.5, 0.5, a, normal);
  piece_point(&piece, 0.5 + step, 0.5, b, NULL);
  piece_point(&piece, 0.5, 0.5 + step, c, NULL);
  for (int i = 0; i < 3; i++) {
    b[i] -= a[i];
    c[i] -= a[i];
  }
  cross = (b[1] * c[2] - b[2] * c[1]) * normal[0] + (b[2] * c[0] - b[0] * c[2]) * normal[1] +
          (b[0] * c[1] - b[1] * c[0]) * normal[2];
  return cross < 0;
}

/* Of every piece of which something is left. */
static void set_flank_faces(struct eo_step_part *part)
{
  part->faces = 0;
  for (int k = 0; k < part->pieces.count; k++) {
    const struct eo_flank_piece *piece = &part->pieces.piece[k];
    struct eo_step_face *face = &part->face[part->faces];
    if (piece->lost)
      continue;
    part->faces++;
    face->i = k;
    face->group[0] = piece->line[0] * EO_FLANK_LINES + piece->line[1];
    face->group[1] = piece->band;
    if (piece->line[0] == piece->line[1])
      part->sites[0][face->group[0]] = eo_patch_even_sites(SWEPT_COUNT);
  }
}

static bool cut_faces(struct eo_step_part *part)
{
  int pieces[2] = {1, 1};
  for (int k = 0; k < EO_STEP_GROUPS; k++)
    part->sites[0][k] = part->sites[1][k] = eo_patch_even_sites(FIRST_COUNT);
  if (part->flank) {
    eo_flank_pieces_init(&part->pieces, part->tooth, part->part);
    part->faces = part->pieces.count;
  } else {
    for (int d = 0; d < 2; d++)
      pieces[d] = eo_tooth_breaks(part->tooth, part->part, d, part->at[d]) - 1;
    part->faces = pieces[0] * pieces[1];
  }
  part->face = calloc((size_t)part->faces, sizeof *part->face);
  part->id = calloc((size_t)part->faces * 2 * EO_STEP_SIDES, sizeof *part->id);
  if (!part->face || !part->id)
    return false;
  if (part->flank)
    set_flank_faces(part);
  for (int k = 0; k < part->faces && !part->flank; k++) {
    struct eo_step_face *face = &part->face[k];
    face->i = face->group[0] = k / pieces[1];
    face->j = face->group[1] = k % pieces[1];
  }
  part->flipped = points_in(part);
  return true;
}

/* Fits a piece to the points that it has now; says where it asks for more. */
static bool fit_face(struct eo_step_part *part, int number, bool wide[2][EO_STEP_GROUPS][EO_PATCH_MOST])
{
  struct eo_step_face *face = &part->face[number];
  struct eo_flank_row row = {.b = -1};
  const struct piece piece = {part, number, &row};
  const struct eo_patch_sites *const sites[2] = {&part->sites[0][face->group[0]], &part->sites[1][face->group[1]]};
  bool own[2][EO_PATCH_MOST] = {{false}};
  if (!eo_patch_fit(&face->patch, sites, piece_point, &piece))
    return false;
  face->error = eo_patch_error(&face->patch, piece_point, &piece, eo_step_tolerance, own);
  for (int d = 0; d < 2; d++)
    for (int i = 0; i < EO_PATCH_MOST; i++)
      wide[d][face->group[d]][i] = wide[d][face->group[d]][i] || own[d][i];
  return true;
}

/* Where points on the flank are no good parameters, those of the rack may be. */
static bool fit_evenly(struct eo_step_part *part, int number, bool wide[2][EO_STEP_GROUPS][EO_PATCH_MOST])
{
  bool *direct = &part->pieces.piece[part->face[number].i].direct, before = *direct;
  double error = part->face[number].error;
  *direct = true;
  bool fitted = fit_face(part, number, wide);
  if (fitted && part->face[number].error > error) {
    *direct = before;
    fitted = fit_face(part, number, wide);
  }
  return fitted;
}

/* Every piece with as many points as it needs; false: memory, or a system that has no solution. */
static bool fit_faces(struct eo_step_part *part)
{
  bool again = true, wide[2][EO_STEP_GROUPS][EO_PATCH_MOST];
  while (again) {
    memset(wide, 0, sizeof wide);
    for (int k = 0; k < part->faces; k++) {
      const struct eo_step_face *face = &part->face[k];
      bool same = face->patch.sites[0].count == part->sites[0][face->group[0]].count &&
                  face->patch.sites[1].count == part->sites[1][face->group[1]].count;
      if (!same && !fit_face(part, k, wide))
        return false;
    }
    again = false;
    for (int d = 0; d < 2; d++)
      for (int g = 0; g < EO_STEP_GROUPS; g++)
        again = eo_patch_halve(&part->sites[d][g], wide[d][g]) || again;
  }
  for (int k = 0; k < part->faces; k++) {
    if (part->face[k].error > eo_step_tolerance && part->flank && !fit_evenly(part, k, wide))
      return false;
    part->error = fmax(part->error, part->face[k].error);
  }
  return true;
}

/* Edges: */

struct eo_step_strip eo_step_strip(const struct eo_patch *patch, int side)
{
  int rows = patch->sites[0].count, columns = patch->sites[1].count;
  if (side % 2 == 0)
    return (struct eo_step_strip){side ? columns - 1 : 0, columns, rows};
  return (struct eo_step_strip){side == 1 ? (rows - 1) * columns : 0, 1, columns};
}

static bool same_point(const double a[3], const double b[3])
{
  return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]) < eo_step_tolerance;
}

static bool same_side(const struct eo_step_face *a, int of_a, const struct eo_step_face *b, int of_b)
{
  struct eo_step_strip x = eo_step_strip(&a->patch, of_a), y = eo_step_strip(&b->patch, of_b);
  bool same = x.count == y.count;
  for (int i = 0; i < x.count && same; i++)
    same = same_point(a->patch.control[x.first + i * x.stride], b->patch.control[y.first + i * y.stride]);
  return same;
}

static bool is_point(const struct eo_step_face *face, int side)
{
  struct eo_step_strip strip = eo_step_strip(&face->patch, side);
  bool same = true;
  for (int i = 1; i < strip.count && same; i++)
    same = same_point(face->patch.control[strip.first], face->patch.control[strip.first + i * strip.stride]);
  return same;
}

static const double *corner_of(const struct eo_step_face *face, int corner)
{
  int rows = face->patch.sites[0].count, columns = face->patch.sites[1].count;
  return face->patch.control[(corner == 1 || corner == 2 ? (rows - 1) * columns : 0) + (corner >= 2 ? columns - 1 : 0)];
}

/* Whether a face is no wider than the tolerance anywhere, along p or along q. */
static bool is_line(const struct eo_step_face *face)
{
  int rows = face->patch.sites[0].count, columns = face->patch.sites[1].count;
  bool along[2] = {true, true};
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < columns; j++) {
      const double *own = face->patch.control[i * columns + j];
      along[0] = along[0] && same_point(own, face->patch.control[i * columns]);
      along[1] = along[1] && same_point(own, face->patch.control[j]);
    }
  return along[0] || along[1];
}

/* What is a line is no face: its neighbours have it as an edge. A reader would take the two edges of such a face for
   one and could not mesh it. */
static void drop_lines(struct eo_step_part *part)
{
  int kept = 0;
  for (int k = 0; k < part->faces; k++)
    if (!is_line(&part->face[k])) {
      if (kept < k)
        part->face[kept] = part->face[k];
      kept++;
    }
  part->faces = kept;
}

/* Neighbours have an edge in common where their sides are one curve, and corners that are one point. */
static void join_faces(struct eo_step_part *part)
{
  for (int k = 0; k < EO_STEP_SIDES * part->faces; k++) {
    struct eo_step_face *face = &part->face[k / EO_STEP_SIDES];
    int own = k % EO_STEP_SIDES;
    face->vertex[own] = part->vertices;
    face->edge[own] = is_point(face, own) ? -1 : part->edges;
    for (int i = k - 1; i >= 0; i--) {
      const struct eo_step_face *other = &part->face[i / EO_STEP_SIDES];
      if (same_point(corner_of(face, own), corner_of(other, i % EO_STEP_SIDES)))
        face->vertex[own] = other->vertex[i % EO_STEP_SIDES];
      if (face->edge[own] >= 0 && own % 2 == i % 2 && same_side(face, own, other, i % EO_STEP_SIDES))
        face->edge[own] = other->edge[i % EO_STEP_SIDES];
    }
    part->vertices += face->vertex[own] == part->vertices;
    part->edges += face->edge[own] == part->edges;
  }
}

bool eo_step_part_init(struct eo_step_part *part, const struct eo_tooth *tooth, enum eo_tooth_part kind)
{
  memset(part, 0, sizeof *part);
  part->tooth = tooth;
  part->part = kind;
  part->flank = kind == EO_TOOTH_DRIVE || kind == EO_TOOTH_COAST;
  if (!cut_faces(part) || !fit_faces(part))
    return false;
  drop_lines(part);
  join_faces(part);
  return true;
}

void eo_step_part_done(struct eo_step_part *part)
{
  free(part->face);
  free(part->id);
}
