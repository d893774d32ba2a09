/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The skin is a closed strip of rings, each with the same number of points: over the teeth of the left end, the groove,
   the teeth of the right end, and back through the bore. Ring k and k + 1 are joined by triangles. */
#include "exchange/stl.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "exchange/tooth.h"

enum {
  FACE_ROWS = 17,    /* rings over the face of one end */
  ROOT_POINTS = 7,   /* of each root, without the flank's first */
  FLANK_POINTS = 14, /* of each flank */
  TIP_POINTS = 2,    /* of the tip land, between the flanks */
  TOOTH_POINTS = 2 * ROOT_POINTS + 2 * FLANK_POINTS + TIP_POINTS,
  RINGS = 4 * FACE_ROWS + 4,
};

struct skin {
  const struct eo_design *design;
  const struct eo_geometry *geometry;
  int member, points, rings;
  bool failed;
  double (*ring)[3]; /* [RINGS][points] */
};

static double (*ring_at(struct skin *skin, int k))[3]
{
  return skin->ring + (size_t)k * (size_t)skin->points;
}

/* The profile of one tooth at a place of the face, from the space on its coast side to that on its drive side. */
static void put_tooth(const struct eo_tooth *tooth, int number, double q, double (*point)[3])
{
  int n = 0;
  for (int i = 0; i < ROOT_POINTS; i++)
    eo_tooth_point(tooth, EO_TOOTH_COAST_ROOT, number, (double)i / ROOT_POINTS, q, point[n++], NULL);
  for (int i = 0; i < FLANK_POINTS; i++)
    eo_tooth_point(tooth, EO_TOOTH_COAST, number, (double)i / (FLANK_POINTS - 1), q, point[n++], NULL);
  for (int i = 1; i <= TIP_POINTS; i++)
    eo_tooth_point(tooth, EO_TOOTH_TIP, number, (double)i / (TIP_POINTS + 1), q, point[n++], NULL);
  for (int i = FLANK_POINTS; i-- > 0;)
    eo_tooth_point(tooth, EO_TOOTH_DRIVE, number, (double)i / (FLANK_POINTS - 1), q, point[n++], NULL);
  for (int i = ROOT_POINTS; i-- > 0;) /* the middle of the space is the next tooth's */
    eo_tooth_point(tooth, EO_TOOTH_DRIVE_ROOT, number, (i + 1.) / (ROOT_POINTS + 1), q, point[n++], NULL);
}

/* A ring of one radius at the angles of another one. */
static void add_circle(struct skin *skin, int like, double radius)
{
  double(*from)[3] = ring_at(skin, like), (*to)[3] = ring_at(skin, skin->rings++);
  for (int i = 0; i < skin->points; i++) {
    double length = hypot(from[i][0], from[i][1]);
    to[i][0] = radius * from[i][0] / length;
    to[i][1] = radius * from[i][1] / length;
    to[i][2] = from[0][2];
  }
}

static void add_end(struct skin *skin, int end)
{
  struct eo_tooth tooth;
  struct eo_error error;
  if (eo_tooth_init(&tooth, skin->design, skin->geometry, skin->member, end, &error)) {
    skin->failed = true;
    return;
  }
  for (int row = 0; row < FACE_ROWS; row++) {
    double(*ring)[3] = ring_at(skin, skin->rings++);
    for (int number = 0; number < skin->geometry->teeth[skin->member]; number++)
      put_tooth(&tooth, number, (double)row / (FACE_ROWS - 1), ring + (size_t)number * TOOTH_POINTS);
  }
  eo_tooth_done(&tooth);
}

static void build(struct skin *skin)
{
  double bore = skin->design->gear_pair.bore[skin->member] / 2,
         groove = skin->design->gear_pair.groove_diameter[skin->member] / 2;
  int ends = skin->design->gear_pair.ends;
  add_end(skin, EO_LEFT);
  if (ends == 2) {
    add_circle(skin, FACE_ROWS - 1, groove);
    int last = skin->rings++;
    add_end(skin, EO_RIGHT);
    int next = skin->rings;
    skin->rings = last;
    add_circle(skin, last + 1, groove);
    skin->rings = next;
  }
  int outer = skin->rings - 1;
  if (bore > 0)
    for (int k = outer; k >= 0; k--)
      add_circle(skin, k, bore);
  else { /* solid: both end faces meet in the middle */
    add_circle(skin, outer, 0);
    add_circle(skin, 0, 0);
  }
}

static void put_float(struct eo_text *text, double value)
{
  float single = (float)value;
  uint32_t bits;
  unsigned char bytes[4];
  memcpy(&bits, &single, sizeof bits);
  for (int i = 0; i < 4; i++)
    bytes[i] = (unsigned char)(bits >> (8 * i));
  eo_text_add_bytes(text, bytes, sizeof bytes);
}

/* A triangle seen from outside counter-clockwise; without area it is left out. */
static int put_triangle(struct eo_text *text, const double a[3], const double b[3], const double c[3])
{
  const double least = 1e-18; /* m2 */
  double u[3], v[3], normal[3];
  for (int i = 0; i < 3; i++) {
    u[i] = b[i] - a[i];
    v[i] = c[i] - a[i];
  }
  for (int i = 0; i < 3; i++)
    normal[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
  double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  if (length < least)
    return 0;
  for (int i = 0; i < 3; i++)
    put_float(text, normal[i] / length);
  const double *const corner[3] = {a, b, c};
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3; i++)
      put_float(text, 1e3 * corner[k][i]);
  eo_text_add_bytes(text, "\0", 2);
  return 1;
}

/* Points of a ring follow each other from +y towards +x, rings from left to right: clockwise seen from outside; of a
   mirrored body the other way. */
static uint32_t put_triangles(struct skin *skin, struct eo_text *text)
{
  uint32_t count = 0;
  bool mirrored = eo_design_rotation(skin->design) > 0;
  for (int k = 0; k < skin->rings; k++) {
    double(*a)[3] = ring_at(skin, k), (*b)[3] = ring_at(skin, (k + 1) % skin->rings);
    for (int i = 0; i < skin->points; i++) {
      int next = (i + 1) % skin->points;
      count += (uint32_t)put_triangle(text, a[i], mirrored ? a[next] : b[next], mirrored ? b[next] : a[next]);
      count += (uint32_t)put_triangle(text, a[i], mirrored ? b[next] : b[i], mirrored ? b[i] : b[next]);
    }
  }
  return count;
}

void eo_stl_write(const struct eo_design *design, const struct eo_geometry *geometry, int member, struct eo_text *text)
{
  enum { HEADER = 80 };
  char header[HEADER] = "Easeoff, binary STL, mm; no thickness allowance; for view and print";
  struct skin skin = {.design = design, .geometry = geometry, .member = member};
  skin.points = geometry->teeth[member] * TOOTH_POINTS;
  skin.ring = calloc((size_t)RINGS * (size_t)skin.points, sizeof *skin.ring);
  if (!skin.ring) {
    text->failed = true;
    return;
  }
  build(&skin);
  text->failed = text->failed || skin.failed;
  size_t start = text->size;
  eo_text_add_bytes(text, header, HEADER);
  eo_text_add_bytes(text, "\0\0\0", 4);
  uint32_t count = put_triangles(&skin, text);
  for (int i = 0; i < 4 && !text->failed; i++)
    text->data[start + HEADER + (size_t)i] = (char)(unsigned char)(count >> (8 * i));
  free(skin.ring);
}
