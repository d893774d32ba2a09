/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/step.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "exchange/patch.h"
#include "exchange/tooth.h"

#include <config.h>

static const double tolerance = 5e-9; /* m: half of what a file may be off */
enum { FIRST_COUNT = 8, MORE = 4 };

struct writer {
  struct eo_text *text;
  int last; /* number of the instance written last */
};

/* One part of a tooth in smooth pieces. */
struct part {
  const struct eo_tooth *tooth;
  enum eo_tooth_part part;
  bool flipped; /* p runs backwards, so that dS/dp x dS/dq points out of the tooth */
  int pieces[2];
  double at[2][EO_TOOTH_PIECES + 1];
  int count[2][EO_TOOTH_PIECES]; /* points of each piece */
  double error;                  /* m off the exact surface at most, between the points */
  struct eo_patch *patch;        /* [pieces[0]][pieces[1]] */
  int vertex[EO_TOOTH_PIECES + 1][EO_TOOTH_PIECES + 1];
  int along[EO_TOOTH_PIECES][EO_TOOTH_PIECES + 1];  /* edges with p, [piece][boundary of q] */
  int across[EO_TOOTH_PIECES + 1][EO_TOOTH_PIECES]; /* edges with q */
};

struct piece {
  const struct part *part;
  int i, j;
};

/* Surfaces: */

static void part_point(const struct part *part, double p, double q, double point[3], double normal[3])
{
  eo_tooth_point(part->tooth, part->part, 0, part->flipped ? 1 - p : p, q, point, normal);
}

static void piece_point(const void *context, double p, double q, double point[3], double normal[3])
{
  const struct piece *piece = context;
  const double *from = &piece->part->at[0][piece->i], *to = &piece->part->at[1][piece->j];
  part_point(piece->part, from[0] + p * (from[1] - from[0]), to[0] + q * (to[1] - to[0]), point, normal);
}

/* Whether dS/dp x dS/dq points into the tooth. */
static bool points_in(const struct part *part)
{
  const double step = 1e-3;
  double a[3], b[3], c[3], normal[3], cross;
  part_point(part, 0.5, 0.5, a, normal);
  part_point(part, 0.5 + step, 0.5, b, NULL);
  part_point(part, 0.5, 0.5 + step, c, NULL);
  for (int i = 0; i < 3; i++) {
    b[i] -= a[i];
    c[i] -= a[i];
  }
  cross = (b[1] * c[2] - b[2] * c[1]) * normal[0] + (b[2] * c[0] - b[0] * c[2]) * normal[1] +
          (b[0] * c[1] - b[1] * c[0]) * normal[2];
  return cross < 0;
}

static void cut_pieces(struct part *part)
{
  for (int d = 0; d < 2; d++) {
    double at[EO_TOOTH_PIECES + 1];
    int count = eo_tooth_breaks(part->tooth, part->part, d, at);
    part->pieces[d] = count - 1;
    for (int i = 0; i < count; i++)
      part->at[d][i] = d == 0 && part->flipped ? 1 - at[count - 1 - i] : at[i];
    for (int i = 0; i < part->pieces[d]; i++)
      part->count[d][i] = FIRST_COUNT;
  }
}

/* Fits every piece; true when all are near enough. Pieces that are not get more points, with their neighbours. */
static bool fit_pieces(struct part *part, bool *failed)
{
  bool good = true;
  int count[2][EO_TOOTH_PIECES];
  memcpy(count, part->count, sizeof count);
  part->error = 0;
  for (int i = 0; i < part->pieces[0]; i++)
    for (int j = 0; j < part->pieces[1]; j++) {
      const struct piece piece = {part, i, j};
      const int points[2] = {part->count[0][i], part->count[1][j]};
      struct eo_patch *patch = &part->patch[i * part->pieces[1] + j];
      *failed = *failed || !eo_patch_fit(patch, points, piece_point, &piece);
      double error = *failed ? 0 : eo_patch_error(patch, piece_point, &piece);
      part->error = fmax(part->error, error);
      if (error > tolerance) {
        count[0][i] = part->count[0][i] + MORE;
        count[1][j] = part->count[1][j] + MORE;
        good = false;
      }
    }
  memcpy(part->count, count, sizeof count);
  return good;
}

static bool prepare(struct part *part, const struct eo_tooth *tooth, enum eo_tooth_part kind)
{
  memset(part, 0, sizeof *part);
  part->tooth = tooth;
  part->part = kind;
  part->flipped = points_in(part);
  cut_pieces(part);
  part->patch = calloc((size_t)part->pieces[0] * (size_t)part->pieces[1], sizeof *part->patch);
  bool failed = !part->patch, near = false;
  for (int points = FIRST_COUNT; !failed && !near && points <= EO_PATCH_MOST - MORE; points += MORE)
    near = fit_pieces(part, &failed);
  return !failed;
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
  for (int i = 0; i < patch->count[0]; i++) {
    eo_text_add(text, i ? "," : "");
    add_list(text, patch->count[1], point + i * patch->count[1], 1);
  }
  eo_text_add(text, "),.UNSPECIFIED.,.F.,.F.,.F.,");
  for (int part = 0; part < 4; part++) {
    add_knots(text, patch->count[part % 2], patch->knot[part % 2], part >= 2);
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

/* Edges of a piece that no neighbour has written yet: boundary control points are the edge's, so both have one curve.
 */
static void put_edges(struct writer *writer, struct part *part, int i, int j, const int *point)
{
  const struct eo_patch *patch = &part->patch[i * part->pieces[1] + j];
  int rows = patch->count[0], columns = patch->count[1];
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2; b++)
      if (!part->vertex[i + a][j + b])
        part->vertex[i + a][j + b] = put(writer, "VERTEX_POINT('',#%d)",
                                         point[a * (rows - 1) * columns + b * (columns - 1)]);
  for (int side = 0; side < 2; side++) {
    if (!part->along[i][j + side]) {
      int curve = put_curve(writer, rows, patch->knot[0], point + side * (columns - 1), columns);
      part->along[i][j + side] = put(writer, "EDGE_CURVE('',#%d,#%d,#%d,.T.)", part->vertex[i][j + side],
                                     part->vertex[i + 1][j + side], curve);
    }
    if (!part->across[i + side][j]) {
      int curve = put_curve(writer, columns, patch->knot[1], point + side * (rows - 1) * columns, 1);
      part->across[i + side][j] = put(writer, "EDGE_CURVE('',#%d,#%d,#%d,.T.)", part->vertex[i + side][j],
                                      part->vertex[i + side][j + 1], curve);
    }
  }
}

/* The loop runs counter-clockwise seen against the surface's normal: with p at q = 0, with q at p = 1, back. */
static int put_face(struct writer *writer, struct part *part, int i, int j, double turn)
{
  const struct eo_patch *patch = &part->patch[i * part->pieces[1] + j];
  int count = patch->count[0] * patch->count[1], point[EO_PATCH_MOST * EO_PATCH_MOST];
  for (int k = 0; k < count; k++)
    point[k] = put_point(writer, patch->control[k], turn);
  int surface = put_surface(writer, patch, point);
  put_edges(writer, part, i, j, point);
  int edge[4] = {
      put(writer, "ORIENTED_EDGE('',*,*,#%d,.T.)", part->along[i][j]),
      put(writer, "ORIENTED_EDGE('',*,*,#%d,.T.)", part->across[i + 1][j]),
      put(writer, "ORIENTED_EDGE('',*,*,#%d,.F.)", part->along[i][j + 1]),
      put(writer, "ORIENTED_EDGE('',*,*,#%d,.F.)", part->across[i][j]),
  };
  int loop = put(writer, "EDGE_LOOP('',(#%d,#%d,#%d,#%d))", edge[0], edge[1], edge[2], edge[3]);
  int bound = put(writer, "FACE_OUTER_BOUND('',#%d,.T.)", loop);
  return put(writer, "ADVANCED_FACE('',(#%d),#%d,.T.)", bound, surface);
}

static int put_shell(struct writer *writer, struct part *part, int number)
{
  static const char *const member_name[2] = {"pinion", "gear"}, *const end_name[2] = {"left", "right"};
  const struct eo_tooth *tooth = part->tooth;
  double turn = number * 2 * M_PI / tooth->geometry->teeth[tooth->member];
  int face[EO_TOOTH_PIECES * EO_TOOTH_PIECES], count = 0;
  memset(part->vertex, 0, sizeof part->vertex);
  memset(part->along, 0, sizeof part->along);
  memset(part->across, 0, sizeof part->across);
  for (int i = 0; i < part->pieces[0]; i++)
    for (int j = 0; j < part->pieces[1]; j++)
      face[count++] = put_face(writer, part, i, j, turn);
  eo_text_print(writer->text, "#%d=OPEN_SHELL('%s %s end, tooth %d, %s',", ++writer->last, member_name[tooth->member],
                tooth->two_ends ? end_name[tooth->end] : "single", number + 1, eo_tooth_part_names[part->part]);
  add_list(writer->text, count, face, 1);
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

static bool write_shells(struct writer *writer, const struct eo_tooth *tooth, bool whole, int *shell, int *shells)
{
  int teeth = whole ? tooth->geometry->teeth[tooth->member] : 1;
  struct part part;
  for (int kind = 0; kind < EO_TOOTH_PARTS; kind++) {
    bool good = prepare(&part, tooth, (enum eo_tooth_part)kind);
    if (good && part.error > tolerance)
      eo_text_print(writer->text, "/* %s: a kink across its pieces; up to %.3g nm off the exact surface */\n",
                    eo_tooth_part_names[kind], 1e9 * part.error);
    for (int number = 0; good && number < teeth; number++)
      shell[(*shells)++] = put_shell(writer, &part, number);
    free(part.patch);
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
