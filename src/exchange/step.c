/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/step.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "exchange/flank_pieces.h"
#include "exchange/flank_rest.h"
#include "exchange/patch.h"
#include "exchange/tooth.h"

#include <config.h>

static const double tolerance = 5e-9; /* m: half of what a file may be off */
enum { FIRST_COUNT = 8, SWEPT_COUNT = 5 };

struct writer {
  struct eo_text *text;
  int last; /* number of the instance written last */
};

enum { SIDES = 4 };

/* A smooth piece. Its sides: along p at q = 0, along q at p = 1, along p at q = 1, along q at p = 0; its corners (0,
   0), (1, 0), (1, 1), (0, 1). */
struct face {
  int i, j;          /* what is no flank: the piece along p and along q */
  int group[2];      /* pieces that share a number of points along p, along q */
  int edge[SIDES];   /* numbers in the part; -1: the side is one point */
  int vertex[SIDES]; /* numbers in the part */
  double error;      /* m */
  struct eo_patch patch;
};

enum { GROUPS = EO_FLANK_LINES * EO_FLANK_LINES };

/* One part of a tooth in smooth pieces. */
struct part {
  const struct eo_tooth *tooth;
  enum eo_tooth_part part;
  bool flipped; /* p runs backwards, so that dS/dp x dS/dq points out of the tooth */
  bool flank;
  struct eo_flank_pieces pieces; /* of a flank */
  double at[2][EO_TOOTH_PIECES + 1];
  struct eo_patch_sites sites[2][GROUPS]; /* of each group */
  double error;                           /* m off the exact surface at most, between the points */
  int faces;
  struct face *face; /* owned */
  int edges, vertices;
  int *id; /* owned: of every edge, then of every vertex, in the file */
};

struct piece {
  const struct part *part;
  int number;
  struct eo_flank_row *row;
};

/* Surfaces: */

static void piece_point(const void *context, double p, double q, double point[3], double normal[3])
{
  const struct piece *piece = context;
  const struct part *part = piece->part;
  const struct face *face = &part->face[piece->number];
  double own = part->flipped ? 1 - p : p;
  if (part->flank) {
    eo_flank_piece_point(&part->pieces, piece->number, piece->row, own, q, point, normal);
    return;
  }
  const double *from = &part->at[0][face->i], *to = &part->at[1][face->j];
  eo_tooth_point(part->tooth, part->part, 0, from[0] + own * (from[1] - from[0]), to[0] + q * (to[1] - to[0]), point,
                 normal);
}

/* Whether dS/dp x dS/dq points into the tooth. */
static bool points_in(const struct part *part)
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

static void set_flank_faces(struct part *part)
{
  for (int k = 0; k < part->faces; k++) {
    const struct eo_flank_piece *piece = &part->pieces.piece[k];
    struct face *face = &part->face[k];
    face->group[0] = piece->line[0] * EO_FLANK_LINES + piece->line[1];
    face->group[1] = piece->band;
    if (piece->line[0] == piece->line[1])
      part->sites[0][face->group[0]] = eo_patch_even_sites(SWEPT_COUNT);
  }
}

static bool cut_faces(struct part *part)
{
  int pieces[2] = {1, 1};
  for (int k = 0; k < GROUPS; k++)
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
  part->id = calloc((size_t)part->faces * 2 * SIDES, sizeof *part->id);
  if (!part->face || !part->id)
    return false;
  if (part->flank)
    set_flank_faces(part);
  for (int k = 0; k < part->faces && !part->flank; k++) {
    struct face *face = &part->face[k];
    face->i = face->group[0] = k / pieces[1];
    face->j = face->group[1] = k % pieces[1];
  }
  part->flipped = points_in(part);
  return true;
}

/* Fits a piece to the points that it has now; says where it asks for more. */
static bool fit_face(struct part *part, int number, bool wide[2][GROUPS][EO_PATCH_MOST])
{
  struct face *face = &part->face[number];
  struct eo_flank_row row = {.b = -1};
  const struct piece piece = {part, number, &row};
  const struct eo_patch_sites *const sites[2] = {&part->sites[0][face->group[0]], &part->sites[1][face->group[1]]};
  bool own[2][EO_PATCH_MOST] = {{false}};
  if (!eo_patch_fit(&face->patch, sites, piece_point, &piece))
    return false;
  face->error = eo_patch_error(&face->patch, piece_point, &piece, tolerance, own);
  for (int d = 0; d < 2; d++)
    for (int i = 0; i < EO_PATCH_MOST; i++)
      wide[d][face->group[d]][i] = wide[d][face->group[d]][i] || own[d][i];
  return true;
}

/* Where points on the flank are no good parameters, those of the rack may be. */
static bool fit_evenly(struct part *part, int number, bool wide[2][GROUPS][EO_PATCH_MOST])
{
  bool *direct = &part->pieces.piece[number].direct, before = *direct;
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
static bool fit_faces(struct part *part)
{
  bool again = true, wide[2][GROUPS][EO_PATCH_MOST];
  while (again) {
    memset(wide, 0, sizeof wide);
    for (int k = 0; k < part->faces; k++) {
      const struct face *face = &part->face[k];
      bool same = face->patch.sites[0].count == part->sites[0][face->group[0]].count &&
                  face->patch.sites[1].count == part->sites[1][face->group[1]].count;
      if (!same && !fit_face(part, k, wide))
        return false;
    }
    again = false;
    for (int d = 0; d < 2; d++)
      for (int g = 0; g < GROUPS; g++)
        again = eo_patch_halve(&part->sites[d][g], wide[d][g]) || again;
  }
  for (int k = 0; k < part->faces; k++) {
    if (part->face[k].error > tolerance && part->flank && !fit_evenly(part, k, wide))
      return false;
    part->error = fmax(part->error, part->face[k].error);
  }
  return true;
}

/* Edges: */

/* Which control points a side has: the first, how far to the next, how many. */
struct strip {
  int first, stride, count;
};

static struct strip strip_of(const struct eo_patch *patch, int side)
{
  int rows = patch->sites[0].count, columns = patch->sites[1].count;
  if (side % 2 == 0)
    return (struct strip){side ? columns - 1 : 0, columns, rows};
  return (struct strip){side == 1 ? (rows - 1) * columns : 0, 1, columns};
}

static bool same_point(const double a[3], const double b[3])
{
  return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]) < tolerance;
}

static bool same_side(const struct face *a, int of_a, const struct face *b, int of_b)
{
  struct strip x = strip_of(&a->patch, of_a), y = strip_of(&b->patch, of_b);
  bool same = x.count == y.count;
  for (int i = 0; i < x.count && same; i++)
    same = same_point(a->patch.control[x.first + i * x.stride], b->patch.control[y.first + i * y.stride]);
  return same;
}

static bool is_point(const struct face *face, int side)
{
  struct strip strip = strip_of(&face->patch, side);
  bool same = true;
  for (int i = 1; i < strip.count && same; i++)
    same = same_point(face->patch.control[strip.first], face->patch.control[strip.first + i * strip.stride]);
  return same;
}

static const double *corner_of(const struct face *face, int corner)
{
  int rows = face->patch.sites[0].count, columns = face->patch.sites[1].count;
  return face->patch.control[(corner == 1 || corner == 2 ? (rows - 1) * columns : 0) + (corner >= 2 ? columns - 1 : 0)];
}

/* Neighbours have an edge in common where their sides are one curve, and corners that are one point. */
static void join_faces(struct part *part)
{
  for (int k = 0; k < SIDES * part->faces; k++) {
    struct face *face = &part->face[k / SIDES];
    int own = k % SIDES;
    face->vertex[own] = part->vertices;
    face->edge[own] = is_point(face, own) ? -1 : part->edges;
    for (int i = k - 1; i >= 0; i--) {
      const struct face *other = &part->face[i / SIDES];
      if (same_point(corner_of(face, own), corner_of(other, i % SIDES)))
        face->vertex[own] = other->vertex[i % SIDES];
      if (face->edge[own] >= 0 && own % 2 == i % 2 && same_side(face, own, other, i % SIDES))
        face->edge[own] = other->edge[i % SIDES];
    }
    part->vertices += face->vertex[own] == part->vertices;
    part->edges += face->edge[own] == part->edges;
  }
}

static bool prepare(struct part *part, const struct eo_tooth *tooth, enum eo_tooth_part kind)
{
  memset(part, 0, sizeof *part);
  part->tooth = tooth;
  part->part = kind;
  part->flank = kind == EO_TOOTH_DRIVE || kind == EO_TOOTH_COAST;
  if (!cut_faces(part) || !fit_faces(part))
    return false;
  join_faces(part);
  return true;
}

/* Instances: */

__attribute__((format(printf, 2, 3))) static int put(struct writer *writer, const char *format, ...)
{
  char line[1200];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  eo_text_print(writer->text, "#%d=%s;\n", ++writer->last, line);
  return writer->last;
}

/* A real of Part 21 has a point always. */
static const char *real(double value, char text[40])
{
  char plain[36];
  snprintf(plain, sizeof plain, "%.13G", value + 0.0);
  char *power = strchr(plain, 'E');
  if (strchr(plain, '.'))
    snprintf(text, 40, "%s", plain);
  else if (power)
    snprintf(text, 40, "%.*s.%s", (int)(power - plain), plain, power);
  else
    snprintf(text, 40, "%s.", plain);
  return text;
}

/* turn: of the tooth, from +y towards +x. */
static int put_point(struct writer *writer, const double point[3], double turn)
{
  char x[40], y[40], z[40];
  double c = cos(turn), s = sin(turn);
  return put(writer, "CARTESIAN_POINT('',(%s,%s,%s))", real(1e3 * (c * point[0] + s * point[1]), x),
             real(1e3 * (c * point[1] - s * point[0]), y), real(1e3 * point[2], z));
}

/* "(4,1,1,4)" and "(0.,0.3,0.6,1.)": the ends stand four times. */
static void add_knots(struct eo_text *text, int count, const double *knot, bool values)
{
  char number[40];
  eo_text_add(text, "(");
  for (int i = 3; i <= count; i++)
    if (values)
      eo_text_print(text, "%s%s", i > 3 ? "," : "", real(knot[i], number));
    else
      eo_text_add(text, i == 3 ? "4" : i == count ? ",4" : ",1");
  eo_text_add(text, ")");
}

static void add_list(struct eo_text *text, int count, const int *id, int stride)
{
  eo_text_add(text, "(");
  for (int i = 0; i < count; i++)
    eo_text_print(text, "%s#%d", i ? "," : "", id[i * stride]);
  eo_text_add(text, ")");
}

static int put_surface(struct writer *writer, const struct eo_patch *patch, const int *point)
{
  struct eo_text *text = writer->text;
  eo_text_print(text, "#%d=B_SPLINE_SURFACE_WITH_KNOTS('',3,3,(", ++writer->last);
  for (int i = 0; i < patch->sites[0].count; i++) {
    eo_text_add(text, i ? "," : "");
    add_list(text, patch->sites[1].count, point + i * patch->sites[1].count, 1);
  }
  eo_text_add(text, "),.UNSPECIFIED.,.F.,.F.,.F.,");
  for (int part = 0; part < 4; part++) {
    add_knots(text, patch->sites[part % 2].count, patch->knot[part % 2], part >= 2);
    eo_text_add(text, ",");
  }
  eo_text_add(text, ".UNSPECIFIED.);\n");
  return writer->last;
}

static int put_curve(struct writer *writer, int count, const double *knot, const int *point, int stride)
{
  struct eo_text *text = writer->text;
  eo_text_print(text, "#%d=B_SPLINE_CURVE_WITH_KNOTS('',3,", ++writer->last);
  add_list(text, count, point, stride);
  eo_text_add(text, ",.UNSPECIFIED.,.F.,.F.,");
  add_knots(text, count, knot, false);
  eo_text_add(text, ",");
  add_knots(text, count, knot, true);
  eo_text_add(text, ",.UNSPECIFIED.);\n");
  return writer->last;
}

/* Edges and corners of a piece that no neighbour has written yet. */
static void put_edges(struct writer *writer, struct part *part, const struct face *face, const int *point)
{
  static const int ends[SIDES][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
  const struct eo_patch *patch = &face->patch;
  int *edge = part->id, *vertex = part->id + part->edges, rows = patch->sites[0].count, columns = patch->sites[1].count;
  const int corner[SIDES] = {0, (rows - 1) * columns, rows * columns - 1, columns - 1};
  for (int k = 0; k < SIDES; k++)
    if (!vertex[face->vertex[k]])
      vertex[face->vertex[k]] = put(writer, "VERTEX_POINT('',#%d)", point[corner[k]]);
  for (int side = 0; side < SIDES; side++) {
    struct strip strip = strip_of(patch, side);
    if (face->edge[side] < 0 || edge[face->edge[side]])
      continue;
    int curve = put_curve(writer, strip.count, patch->knot[side % 2], point + strip.first, strip.stride);
    edge[face->edge[side]] = put(writer, "EDGE_CURVE('',#%d,#%d,#%d,.T.)", vertex[face->vertex[ends[side][0]]],
                                 vertex[face->vertex[ends[side][1]]], curve);
  }
}

/* The loop runs counter-clockwise seen against the surface's normal: with p at q = 0, with q at p = 1, back. */
static int put_face(struct writer *writer, struct part *part, const struct face *face, double turn)
{
  const struct eo_patch *patch = &face->patch;
  int count = patch->sites[0].count * patch->sites[1].count, point[EO_PATCH_MOST * EO_PATCH_MOST], edge[SIDES],
      edges = 0;
  for (int k = 0; k < count; k++)
    point[k] = put_point(writer, patch->control[k], turn);
  int surface = put_surface(writer, patch, point);
  put_edges(writer, part, face, point);
  for (int side = 0; side < SIDES; side++)
    if (face->edge[side] >= 0)
      edge[edges++] = put(writer, "ORIENTED_EDGE('',*,*,#%d,.%c.)", part->id[face->edge[side]], side < 2 ? 'T' : 'F');
  eo_text_print(writer->text, "#%d=EDGE_LOOP('',", ++writer->last);
  add_list(writer->text, edges, edge, 1);
  eo_text_add(writer->text, ");\n");
  int loop = writer->last, bound = put(writer, "FACE_OUTER_BOUND('',#%d,.T.)", loop);
  return put(writer, "ADVANCED_FACE('',(#%d),#%d,.T.)", bound, surface);
}

static int put_shell(struct writer *writer, struct part *part, int number)
{
  static const char *const member_name[2] = {"pinion", "gear"}, *const end_name[2] = {"left", "right"};
  const struct eo_tooth *tooth = part->tooth;
  double turn = number * 2 * M_PI / tooth->geometry->teeth[tooth->member];
  int face[EO_FLANK_PIECES];
  memset(part->id, 0, sizeof *part->id * (size_t)(part->edges + part->vertices));
  for (int k = 0; k < part->faces; k++)
    face[k] = put_face(writer, part, &part->face[k], turn);
  eo_text_print(writer->text, "#%d=OPEN_SHELL('%s %s end, tooth %d, %s',", ++writer->last, member_name[tooth->member],
                tooth->two_ends ? end_name[tooth->end] : "single", number + 1, eo_tooth_part_names[part->part]);
  add_list(writer->text, part->faces, face, 1);
  eo_text_add(writer->text, ");\n");
  return writer->last;
}

/* The file: */

/* Apostrophes doubled; what is not plain ASCII becomes '?'. */
static void clean_name(const char *name, char clean[200])
{
  size_t length = 0;
  for (const char *c = name; *c && length < 196; c++) {
    if (*c == '\'')
      clean[length++] = '\'';
    clean[length++] = *c >= ' ' && *c <= '~' && *c != '\\' ? *c : '?';
  }
  clean[length] = '\0';
}

static void write_header(struct eo_text *text, const char *name)
{
  char date[40];
  time_t now = time(NULL);
  struct tm utc;
  strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S+00:00", gmtime_r(&now, &utc));
  eo_text_print(text,
                "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('tooth surfaces, lengths in mm'),'2;1');\n"
                "FILE_NAME('%s','%s',(''),(''),'Easeoff %s','Easeoff','');\n"
                "FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }'));\n"
                "ENDSEC;\nDATA;\n",
                name, date, PACKAGE_VERSION);
}

/* Product, units and context; returns the shape's definition, *context the representation's. */
static int write_product(struct writer *writer, const char *name, int *context)
{
  int application = put(writer, "APPLICATION_CONTEXT('managed model based 3d engineering')");
  put(writer,
      "APPLICATION_PROTOCOL_DEFINITION('international standard',"
      "'ap242_managed_model_based_3d_engineering',2014,#%d)",
      application);
  int product_context = put(writer, "PRODUCT_CONTEXT('',#%d,'mechanical')", application);
  int product = put(writer, "PRODUCT('%s','%s','',(#%d))", name, name, product_context);
  put(writer, "PRODUCT_RELATED_PRODUCT_CATEGORY('part','',(#%d))", product);
  int formation = put(writer, "PRODUCT_DEFINITION_FORMATION('','',#%d)", product);
  int definition_context = put(writer, "PRODUCT_DEFINITION_CONTEXT('part definition',#%d,'design')", application);
  int definition = put(writer, "PRODUCT_DEFINITION('','',#%d,#%d)", formation, definition_context);
  int shape = put(writer, "PRODUCT_DEFINITION_SHAPE('','',#%d)", definition);
  int length = put(writer, "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"),
      angle = put(writer, "(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))"),
      solid = put(writer, "(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
  int uncertainty =
      put(writer, "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-06),#%d,'distance_accuracy_value','')", length);
  *context = put(writer,
                 "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#%d))"
                 "GLOBAL_UNIT_ASSIGNED_CONTEXT((#%d,#%d,#%d))REPRESENTATION_CONTEXT('',''))",
                 uncertainty, length, angle, solid);
  return shape;
}

/* What of a part the file cannot promise, as comments. */
static void tell_errors(const struct part *part, const struct eo_tooth *tooth, struct eo_text *text)
{
  const char *name = eo_tooth_part_names[part->part], *end = !tooth->two_ends         ? ""
                                                             : tooth->end == EO_RIGHT ? " of the right end"
                                                                                      : " of the left end";
  double folded = part->flank ? eo_flank_rest_error(&part->pieces) : 0;
  if (part->error > tolerance)
    eo_text_print(text, "/* %s%s: up to %.3g um off the exact surface */\n", name, end, 1e6 * part->error);
  if (folded > tolerance)
    eo_text_print(text, "/* %s%s, where reliefs fold it: up to %.3g um off what the rack leaves */\n", name, end,
                  1e6 * folded);
}

static bool write_shells(struct writer *writer, const struct eo_tooth *tooth, bool whole, int *shell, int *shells)
{
  int teeth = whole ? tooth->geometry->teeth[tooth->member] : 1;
  struct part part;
  for (int kind = 0; kind < EO_TOOTH_PARTS; kind++) {
    bool good = prepare(&part, tooth, (enum eo_tooth_part)kind);
    if (good)
      tell_errors(&part, tooth, writer->text);
    for (int number = 0; good && number < teeth; number++)
      shell[(*shells)++] = put_shell(writer, &part, number);
    free(part.face);
    free(part.id);
    if (!good)
      return false;
  }
  return true;
}

void eo_step_write(const struct eo_design *design, const struct eo_geometry *geometry, int member, bool whole,
                   struct eo_text *text)
{
  static const char *const member_name[2] = {"pinion", "gear"};
  struct writer writer = {text, 0};
  char name[200], product[220];
  int context, shells = 0, ends = design->gear_pair.ends;
  int *shell = malloc((size_t)ends * EO_TOOTH_PARTS * (size_t)geometry->teeth[member] * sizeof *shell);
  bool good = shell != NULL;
  clean_name(design->name, name);
  snprintf(product, sizeof product, "%s%s%s", name, *name ? ", " : "", member_name[member]);
  write_header(text, product);
  int shape = write_product(&writer, product, &context);
  for (int end = 0; end < ends && good; end++) {
    struct eo_tooth tooth;
    struct eo_error error;
    good = !eo_tooth_init(&tooth, design, geometry, member, end, &error);
    if (good) {
      good = write_shells(&writer, &tooth, whole, shell, &shells);
      eo_tooth_done(&tooth);
    }
  }
  if (good) {
    eo_text_print(text, "#%d=SHELL_BASED_SURFACE_MODEL('',", ++writer.last);
    add_list(text, shells, shell, 1);
    eo_text_add(text, ");\n");
    int model = writer.last, origin = put(&writer, "CARTESIAN_POINT('',(0.,0.,0.))"),
        z = put(&writer, "DIRECTION('',(0.,0.,1.))"), x = put(&writer, "DIRECTION('',(1.,0.,0.))"),
        place = put(&writer, "AXIS2_PLACEMENT_3D('',#%d,#%d,#%d)", origin, z, x);
    int representation = put(&writer, "MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#%d,#%d),#%d)", place, model, context);
    put(&writer, "SHAPE_DEFINITION_REPRESENTATION(#%d,#%d)", shape, representation);
  }
  eo_text_add(text, "ENDSEC;\nEND-ISO-10303-21;\n");
  text->failed = text->failed || !good;
  free(shell);
}
