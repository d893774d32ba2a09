/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/flank_rest.h"

#include <math.h>
#include <string.h>

#include "base/sort.h"
#include "gear/surface.h"

/* The unmodified flank in the frame of eo_tooth_point(): an involute helicoid that begins on the base cylinder at the
   angle start + turn z, from +y in the direction `sense`. */
struct involute {
  double base, start, turn, sense;
  double cosine; /* of the base helix angle */
};

/* Where the normal of the unmodified flank through a point meets it, and how far from it the point is, m. */
struct foot {
  double roll; /* length on the tangent of the base circle */
  double height;
};

enum { EVEN = 3000, DOUBLINGS = 16, BLENDS = 24, MOST = EVEN + EO_MOST_VERTICES * (2 * DOUBLINGS + BLENDS) };

/* What is generated in one transverse section, from root to tip. */
struct section {
  int count;
  struct foot at[MOST];
};

static void point_at(const struct eo_flank_pieces *pieces, double u, double y, double delta, const double slope[2],
                     double point[3], double normal[3])
{
  const struct eo_tooth *tooth = pieces->tooth;
  struct eo_surface_point generated;
  double v, same, path = eo_geometry_own_path(tooth->member, u / tooth->geometry->rack_factor);
  eo_surface_coordinates(tooth->geometry, tooth->member, path, pieces->coast ? -y : y, &same, &v);
  eo_surface_generate(tooth->geometry, tooth->member, u, v, delta, slope, &generated);
  eo_tooth_place(tooth, pieces->coast, &generated, point, normal);
}

/* A point lies on the tangent of the base circle with the length *tangent; the involute on that tangent has the length
   that is returned. */
static double string_of(const struct involute *involute, const double point[3], double *tangent)
{
  double square = point[0] * point[0] + point[1] * point[1] - involute->base * involute->base;
  *tangent = sqrt(fmax(0, square));
  return involute->base * (involute->sense * atan2(point[0], point[1]) + atan2(*tangent, involute->base) -
                           involute->start - involute->turn * point[2]);
}

static struct foot foot_of(const struct involute *involute, const double point[3])
{
  double tangent, off, length = string_of(involute, point, &tangent);
  off = (tangent - length) * involute->cosine;
  return (struct foot){tangent - off * involute->cosine, off};
}

/* From three points of the unmodified flank: in the middle, nearer to the tip, nearer to a face. */
static struct involute involute_of(const struct eo_flank_pieces *pieces)
{
  const struct eo_tooth *tooth = pieces->tooth;
  const double none[2] = {0};
  struct involute involute = {.base = tooth->geometry->base_radius[tooth->member]};
  double middle = (pieces->u[0] + pieces->u[1]) / 2, tip = pieces->u[1], width = tooth->geometry->face_width / 4,
         at[3][3], normal[3], tangent;
  point_at(pieces, tip, 0, 0, none, at[1], normal);
  point_at(pieces, middle, width, 0, none, at[2], normal);
  point_at(pieces, middle, 0, 0, none, at[0], normal);
  involute.cosine = sqrt(1 - normal[2] * normal[2]);
  involute.sense = atan2(at[1][0], at[1][1]) > atan2(at[0][0], at[0][1]) ? 1 : -1;
  double length = string_of(&involute, at[0], &tangent);
  involute.start = (length - tangent) / involute.base;
  length = string_of(&involute, at[2], &tangent);
  involute.turn = (length - tangent) / involute.base / (at[2][2] - at[0][2]);
  involute.start -= involute.turn * at[0][2];
  return involute;
}

/* Where the flank is looked at: everywhere, and closer and closer to kinks. */
static int list_places(const struct eo_flank_pieces *pieces, int kinks, const double *kink, double *place)
{
  const double nearest = 1e-9; /* m */
  int count = 0;
  for (int i = 0; i <= EVEN - 1; i++)
    place[count++] = pieces->u[0] + (pieces->u[1] - pieces->u[0]) * i / (EVEN - 1);
  for (int k = 0; k < kinks; k++)
    for (int i = 0; i < 2 * DOUBLINGS; i++) {
      double u = kink[k] + (i % 2 ? 1 : -1) * ldexp(nearest, i / 2);
      if (u > pieces->u[0] && u < pieces->u[1])
        place[count++] = u;
    }
  eo_sort_numbers(count, place);
  return count;
}

/* Over a kink what the rack's corner sweeps, with slopes from those of one side to those of the other. */
static void make_section(const struct eo_flank_pieces *pieces, const struct involute *involute, double y,
                         struct section *section)
{
  const struct eo_modification_shape *shape = &pieces->tooth->shape[pieces->coast];
  struct eo_modification_shape slice;
  double kink[EO_MOST_VERTICES], place[MOST], point[3], slope[2], before[2] = {0};
  eo_modification_slice(shape, pieces->coast ? -y : y, &slice);
  int kinks = eo_modification_vertices(&slice, kink), count = list_places(pieces, kinks, kink, place), next = 0;
  section->count = 0;
  for (int i = 0; i < count; i++) {
    double delta = eo_surface_relief(shape, place[i], (pieces->coast ? -1 : 1) * shape->lengthen * y, slope);
    bool over = false;
    for (; next < kinks && kink[next] < place[i]; next++)
      over = over || i > 0;
    for (int k = over ? 1 : BLENDS; k <= BLENDS; k++) {
      double share = (double)k / BLENDS;
      const double mixed[2] = {before[0] + share * (slope[0] - before[0]), before[1] + share * (slope[1] - before[1])};
      point_at(pieces, place[i], y, delta, mixed, point, NULL);
      section->at[section->count++] = foot_of(involute, point);
    }
    before[0] = slope[0];
    before[1] = slope[1];
  }
}

/* The least height at a roll length; NAN beyond the flank's ends. */
static double lowest_at(const struct section *section, double roll)
{
  const double same = 2e-8; /* m: where slopes are steep an end lies so far from the last place */
  double lowest = NAN;
  for (int end = 0; end < 2; end++) {
    const struct foot *foot = &section->at[end ? section->count - 1 : 0], *next = foot + (end ? -1 : 1);
    double rise = foot->roll != next->roll ? (foot->height - next->height) / (foot->roll - next->roll) : 0;
    if (fabs(foot->roll - roll) < same)
      lowest = fmin(lowest, foot->height + (roll - foot->roll) * rise);
  }
  for (int i = 0; i + 1 < section->count; i++) {
    const struct foot *a = &section->at[i], *b = a + 1;
    if (a->roll == b->roll || (roll - a->roll) * (roll - b->roll) > 0)
      continue;
    lowest = fmin(lowest, a->height + (roll - a->roll) / (b->roll - a->roll) * (b->height - a->height));
  }
  return lowest;
}

/* How far a straight way between two points of one row, with normals, is off one that bends evenly; along the helix the
   points may lie apart. */
static double off_between(const struct involute *involute, double from[2][3], double to[2][3])
{
  const double twist = involute->sense * involute->turn, helix[3] = {twist * from[0][1], -twist * from[0][0], 1};
  double along = 0, across = 0, length = 0, turn = 0;
  for (int i = 0; i < 3; i++)
    along += (to[0][i] - from[0][i]) * helix[i] / (1 + helix[0] * helix[0] + helix[1] * helix[1]);
  for (int i = 0; i < 3; i++) {
    double way = to[0][i] - from[0][i] - along * helix[i], change = to[1][i] - from[1][i];
    across += way * from[1][i];
    length += way * way;
    turn += change * change;
  }
  return fabs(across) + sqrt(length * turn) / 8;
}

/* Of one row: b of a band. */
static double row_error(const struct eo_flank_pieces *pieces, const struct involute *involute,
                        const struct section *section, int band, double b)
{
  static const double places[] = {0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1};
  enum { PLACES = sizeof places / sizeof *places };
  double largest = 0, here[2][3], end[2][3] = {{0}};
  bool begun = false;
  for (int k = 0; k < pieces->count; k++) {
    struct eo_flank_row row = {.b = -1};
    if (pieces->piece[k].band != band || pieces->piece[k].lost)
      continue;
    for (int n = 0; n < PLACES; n++) {
      eo_flank_piece_point(pieces, k, &row, places[n], b, here[0], here[1]);
      struct foot foot = foot_of(involute, here[0]);
      largest = fmax(largest, fabs(foot.height - lowest_at(section, foot.roll)));
      if (n == 0 && begun)
        largest = fmax(largest, off_between(involute, end, here));
    }
    memcpy(end, here, sizeof end);
    begun = true;
  }
  return largest;
}

double eo_flank_rest_error(const struct eo_flank_pieces *pieces)
{
  static const double rows[] = {0.003, 0.2, 0.5, 0.8, 0.997};
  enum { ROWS = sizeof rows / sizeof *rows };
  struct involute involute = involute_of(pieces);
  struct section section;
  double largest = 0;
  for (int i = 0; i < pieces->bands * ROWS; i++) {
    int band = i / ROWS;
    double b = rows[i % ROWS];
    make_section(pieces, &involute, pieces->y[band] + b * (pieces->y[band + 1] - pieces->y[band]), &section);
    largest = fmax(largest, row_error(pieces, &involute, &section, band, b));
  }
  return largest;
}
