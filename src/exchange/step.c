/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/step_private.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "exchange/flank_rest.h"
#include "gear/names.h"

#include <config.h>

struct writer {
  struct eo_text *text;
  int last; /* number of the instance written last */
};

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
static void put_edges(struct writer *writer, struct eo_step_part *part, const struct eo_step_face *face,
                      const int *point)
{
  static const int ends[EO_STEP_SIDES][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
  const struct eo_patch *patch = &face->patch;
  int *edge = part->id, *vertex = part->id + part->edges, rows = patch->sites[0].count, columns = patch->sites[1].count;
  const int corner[EO_STEP_SIDES] = {0, (rows - 1) * columns, rows * columns - 1, columns - 1};
  for (int k = 0; k < EO_STEP_SIDES; k++)
    if (!vertex[face->vertex[k]])
      vertex[face->vertex[k]] = put(writer, "VERTEX_POINT('',#%d)", point[corner[k]]);
  for (int side = 0; side < EO_STEP_SIDES; side++) {
    struct eo_step_strip strip = eo_step_strip(patch, side);
    if (face->edge[side] < 0 || edge[face->edge[side]])
      continue;
    int curve = put_curve(writer, strip.count, patch->knot[side % 2], point + strip.first, strip.stride);
    edge[face->edge[side]] = put(writer, "EDGE_CURVE('',#%d,#%d,#%d,.T.)", vertex[face->vertex[ends[side][0]]],
                                 vertex[face->vertex[ends[side][1]]], curve);
  }
}

/* The loop runs counter-clockwise seen against the surface's normal: with p at q = 0, with q at p = 1, back. */
static int put_face(struct writer *writer, struct eo_step_part *part, const struct eo_step_face *face, double turn)
{
  const struct eo_patch *patch = &face->patch;
  int count = patch->sites[0].count * patch->sites[1].count, point[EO_PATCH_MOST * EO_PATCH_MOST], edge[EO_STEP_SIDES],
      edges = 0;
  for (int k = 0; k < count; k++)
    point[k] = put_point(writer, patch->control[k], turn);
  int surface = put_surface(writer, patch, point);
  put_edges(writer, part, face, point);
  for (int side = 0; side < EO_STEP_SIDES; side++)
    if (face->edge[side] >= 0)
      edge[edges++] = put(writer, "ORIENTED_EDGE('',*,*,#%d,.%c.)", part->id[face->edge[side]], side < 2 ? 'T' : 'F');
  eo_text_print(writer->text, "#%d=EDGE_LOOP('',", ++writer->last);
  add_list(writer->text, edges, edge, 1);
  eo_text_add(writer->text, ");\n");
  int loop = writer->last, bound = put(writer, "FACE_OUTER_BOUND('',#%d,.T.)", loop);
  return put(writer, "ADVANCED_FACE('',(#%d),#%d,.T.)", bound, surface);
}

static int put_shell(struct writer *writer, struct eo_step_part *part, int number)
{
  const struct eo_tooth *tooth = part->tooth;
  double turn = number * 2 * M_PI / tooth->geometry->teeth[tooth->member];
  int face[EO_FLANK_PIECES];
  memset(part->id, 0, sizeof *part->id * (size_t)(part->edges + part->vertices));
  for (int k = 0; k < part->faces; k++)
    face[k] = put_face(writer, part, &part->face[k], turn);
  eo_text_print(writer->text, "#%d=OPEN_SHELL('%s %s end, tooth %d, %s',", ++writer->last,
                eo_member_name[tooth->member], tooth->two_ends ? eo_end_name[tooth->end] : "single", number + 1,
                eo_tooth_part_names[part->part]);
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
static void tell_errors(const struct eo_step_part *part, const struct eo_tooth *tooth, struct eo_text *text)
{
  const char *name = eo_tooth_part_names[part->part], *end = !tooth->two_ends         ? ""
                                                             : tooth->end == EO_RIGHT ? " of the right end"
                                                                                      : " of the left end";
  double folded = part->flank ? eo_flank_rest_error(&part->pieces) : 0;
  if (part->error > eo_step_tolerance)
    eo_text_print(text, "/* %s%s: up to %.3g um off the exact surface */\n", name, end, 1e6 * part->error);
  if (folded > eo_step_tolerance)
    eo_text_print(text, "/* %s%s, where reliefs fold it: up to %.3g um off what the rack leaves */\n", name, end,
                  1e6 * folded);
}

static bool write_shells(struct writer *writer, const struct eo_tooth *tooth, bool whole, int *shell, int *shells)
{
  int teeth = whole ? tooth->geometry->teeth[tooth->member] : 1;
  struct eo_step_part part;
  for (int kind = 0; kind < EO_TOOTH_PARTS; kind++) {
    bool good = eo_step_part_init(&part, tooth, (enum eo_tooth_part)kind);
    if (good)
      tell_errors(&part, tooth, writer->text);
    for (int number = 0; good && number < teeth; number++)
      shell[(*shells)++] = put_shell(writer, &part, number);
    eo_step_part_done(&part);
    if (!good)
      return false;
  }
  return true;
}

void eo_step_write(const struct eo_design *design, const struct eo_geometry *geometry, int member, bool whole,
                   struct eo_text *text)
{
  struct writer writer = {text, 0};
  char name[200], product[220];
  int context, shells = 0, ends = design->gear_pair.ends;
  int *shell = malloc((size_t)ends * EO_TOOTH_PARTS * (size_t)geometry->teeth[member] * sizeof *shell);
  bool good = shell != NULL;
  clean_name(design->name, name);
  snprintf(product, sizeof product, "%s%s%s", name, *name ? ", " : "", eo_member_name[member]);
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
