/* SPDX-License-Identifier: GPL-3.0-or-later */
/* STEP and STL: the file as ISO 10303-21 has it, by a reader of its own; splines against the exact surface; the same
   file loaded and meshed by OpenCASCADE through gmsh, where that is installed, its nodes against the exact surface. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "document/design_document.h"
#include "document/examples.h"
#include "exchange/exports.h"
#include "exchange/flank_pieces.h"
#include "exchange/flank_rest.h"
#include "exchange/patch.h"
#include "exchange/step.h"
#include "exchange/tooth.h"
#include "support/step-mesh.h"
#include "support/tap.h"

static const double allowed = 10e-9; /* m off the exact surface */

static struct eo_design design;
static struct eo_geometry geometry;
static const char *hand = "";                /* of the designs that are built */
static enum eo_apex apex = EO_APEX_TRAILING; /* the same */

static void build(const char *name)
{
  struct eo_error error;
  bool found = eo_example_build(name, &design);
  snprintf(design.gear_pair.hand, sizeof design.gear_pair.hand, "%s", hand);
  design.alignment.apex = apex;
  if (!found || eo_design_complete(&design, &geometry, &error))
    printf("Bail out! example %s\n", name);
}

static void init(struct eo_tooth *tooth, int member, int end)
{
  struct eo_error error;
  if (eo_tooth_init(tooth, &design, &geometry, member, end, &error))
    printf("Bail out! %s\n", error.text);
}

/* The file: */

struct listing {
  int instances, faces, shells, loops, wrong;
  const char **at; /* of each instance, from 1 */
};

/* Instances are numbered in order from 1; every reference is to one that is there. */
static struct listing list_instances(const char *text)
{
  struct listing l = {0};
  l.at = calloc(strlen(text) / 8, sizeof *l.at);
  const char *line = strstr(text, "DATA;\n") + 6;
  while (strncmp(line, "ENDSEC", 6) != 0) {
    l.instances++;
    l.wrong += strtol(line + 1, NULL, 10) != l.instances;
    l.at[l.instances] = strchr(line, '=') + 1;
    l.faces += strncmp(l.at[l.instances], "ADVANCED_FACE", 13) == 0;
    l.shells += strncmp(l.at[l.instances], "OPEN_SHELL", 10) == 0;
    line = strchr(line, '\n') + 1;
  }
  for (int i = 1; i <= l.instances; i++)
    for (const char *c = l.at[i]; *c != '\n'; c++)
      if (*c == '#') {
        long to = strtol(c + 1, NULL, 10);
        l.wrong += to < 1 || to >= i; /* and before it */
      }
  return l;
}

/* Multiplicities add up to points and degree and one, knots rise. */
static int check_splines(const struct listing *l)
{
  int wrong = 0;
  for (int i = 1; i <= l->instances; i++) {
    if (strncmp(l->at[i], "B_SPLINE_CURVE_WITH_KNOTS", 25) != 0)
      continue;
    int points = 0, sum = 0, knots = 0, many = 0;
    double before = -1;
    const char *c = strchr(l->at[i], '#');
    for (; *c != ')'; c++)
      points += *c == '#';
    const char *list = strchr(c, '(');
    for (c = list + 1; *c != ')'; c++)
      if (isdigit((unsigned char)*c)) {
        sum += *c - '0';
        many++;
      }
    for (c = strchr(c, '(') + 1; *c != ')';) {
      char *end;
      double knot = strtod(c, &end);
      wrong += knot <= before;
      before = knot;
      knots++;
      c = end + (*end == ',');
    }
    wrong += sum != points + 4 || knots != many || before != 1;
  }
  return wrong;
}

/* Loops that run along one edge twice: faces that are no more than a line, which a reader takes for periodic ones. */
static int check_loops(const struct listing *l)
{
  int wrong = 0;
  for (int i = 1; i <= l->instances; i++) {
    long edge[4] = {0};
    int edges = 0;
    if (strncmp(l->at[i], "EDGE_LOOP", 9) != 0)
      continue;
    for (const char *c = l->at[i]; *c != '\n'; c++)
      if (*c == '#' && edges < 4) {
        const char *of = strchr(l->at[strtol(c + 1, NULL, 10)], '#');
        edge[edges++] = strtol(of + 1, NULL, 10);
      }
    bool twice = edges < 2;
    for (int a = 0; a < edges; a++)
      for (int b = 0; b < a; b++)
        twice = twice || edge[a] == edge[b];
    wrong += twice;
  }
  return wrong;
}

static void check_file(const char *name, int faces, int shells)
{
  struct eo_text text = {0};
  build(name);
  eo_step_write(&design, &geometry, EO_PINION, false, &text);
  ok(!text.failed && strstr(text.data, "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF"),
     "%s is written as a file of AP242", name);
  struct listing l = list_instances(text.data);
  ok(l.wrong == 0, "%s: %d instances stand in order, each reference to one before", name, l.instances);
  ok(check_splines(&l) == 0, "%s: the knots of every spline agree with its multiplicities", name);
  ok(l.faces == faces && l.shells == shells, "%s: the file has %d faces in %d shells, expected %d in %d", name, l.faces,
     l.shells, faces, shells);
  free(l.at);
  eo_text_done(&text);
}

/* Surfaces: */

/* The frame is that of flank-points: both say where the same point of the flank lies. */
static void check_frame(const char *name, bool coast)
{
  static const char *const end_name[2] = {"left", "right"};
  struct eo_text text = {0};
  double largest = 0;
  int compared = 0, coasts = 0;
  build(name);
  for (int i = 0; i < 4 && coast; i++)
    design.modification.coast[i / 2][i % 2] = (struct eo_flank_modification){
        .tip_relief = 12e-6, .tip_relief_start = 1.5e-3, .helix_slope = (i + 1) * 7e-6, .twist = 5e-6};
  eo_exports_find("flank-points")->write(&design, &geometry, &text);
  for (const char *line = strchr(text.data, '\n') + 1; *line; line = strchr(line, '\n') + 1) {
    char member[8], end[8], flank[8];
    int row, column;
    double x, y, z, point[3];
    if (sscanf(line, "%7[a-z],%7[a-z],%d,%d,%lf,%lf,%lf,%*f,%*f,%*f,%*f,%7[a-z]", member, end, &row, &column, &x, &y,
               &z, flank) != 8 ||
        column % 5)
      continue;
    struct eo_tooth tooth;
    init(&tooth, strcmp(member, "gear") == 0, strcmp(end, end_name[1]) == 0);
    double s = geometry.path_start +
               (geometry.path_end - geometry.path_start) * (tooth.member == EO_PINION ? row / 20. : 1 - row / 20.);
    double p = (eo_geometry_own_path(tooth.member, s) - tooth.start_path) / (tooth.tip_path - tooth.start_path);
    bool on_coast = strcmp(flank, "coast") == 0;
    coasts += on_coast;
    eo_tooth_point(&tooth, on_coast ? EO_TOOTH_COAST : EO_TOOTH_DRIVE, 0, p, 0.5 + tooth.along * (column / 30. - 0.5),
                   point, NULL);
    largest = fmax(largest, hypot(hypot(1e3 * point[0] - x, 1e3 * point[1] - y), 1e3 * point[2] - z));
    compared++;
  }
  ok(compared > 200 && largest < 1e-7 && (coasts > 0) == coast,
     "%s: %d points lie where flank-points has them, within %.1g mm, %d of coast flanks", name, compared, largest,
     coasts);
  eo_text_done(&text);
}

/* A helix slope of 40 um on a coast flank takes half of it off where drive flanks meet first, and adds it at the other
   end, whichever way the surfaces are made. */
static void check_coast_slope(void)
{
  build("paper");
  for (int end = 0; end < 2; end++)
    for (int member = 0; member < 2; member++) {
      struct eo_tooth plain, sloped;
      double at[3], moved[3], normal[3], off[2];
      init(&plain, member, end);
      design.modification.coast[member][end].helix_slope = 40e-6;
      init(&sloped, member, end);
      for (int side = 0; side < 2; side++) {
        double q = (end == EO_LEFT) == (side == 1) ? 0 : 1; /* side 1: outwards */
        eo_tooth_point(&plain, EO_TOOTH_COAST, 0, 0.5, q, at, normal);
        eo_tooth_point(&sloped, EO_TOOTH_COAST, 0, 0.5, q, moved, NULL);
        off[side] = 0;
        for (int i = 0; i < 3; i++)
          off[side] += (at[i] - moved[i]) * normal[i];
      }
      close_to(1e6 * off[1], 20, 0.5, "material off the outer end of a coast flank, um");
      close_to(1e6 * off[0], -20, 0.5, "material on at its inner end, um");
      design.modification.coast[member][end].helix_slope = 0;
    }
}

/* The body itself tells hand and apex: right-handed teeth turn positively about z as z grows, drive flanks face the way
   the pinion turns (the gear's against theirs), and the face that meets first is ahead on the pinion. */
static void check_hand(const char *name, const char *left_hand, enum eo_apex wanted)
{
  int wrong = 0;
  hand = left_hand;
  apex = wanted;
  build(name);
  double right = strcmp(left_hand, "right") == 0 ? 1 : -1, out = wanted == EO_APEX_LEADING ? -1 : 1;
  for (int member = 0; member < 2; member++)
    for (int end = 0; end < design.gear_pair.ends; end++) {
      struct eo_tooth tooth;
      double face[2][3], normal[3], angle[2];
      init(&tooth, member, end);
      for (int q = 0; q < 2; q++) {
        eo_tooth_point(&tooth, EO_TOOTH_DRIVE, 0, 0.5, q, face[q], normal);
        angle[q] = atan2(-face[q][0], face[q][1]); /* about z, from +y */
      }
      double rises = (end == EO_RIGHT) != (member == EO_GEAR) ? -right : right, rotation = -right * out,
             first = (end == EO_LEFT ? -1 : 1) * out;
      wrong += !(face[1][2] > face[0][2]) || !((angle[1] - angle[0]) * rises > 0);
      wrong += !(-normal[0] * rotation > 0);
      wrong += member == EO_PINION && !((angle[1] - angle[0]) * rotation * first > 0);
    }
  ok(wrong == 0, "%s, %s hand, apex %s: helix, flank and first face of every end agree", name, left_hand,
     wanted == EO_APEX_LEADING ? "leading" : "trailing");
  check_frame(name, true);
  hand = "";
  apex = EO_APEX_TRAILING;
}

static void check_hands(void)
{
  static const char *const hands[2] = {"left", "right"};
  for (int i = 0; i < 2; i++)
    for (int leading = 0; leading < 2; leading++) {
      check_hand("paper-case-b", hands[i], (enum eo_apex)leading);
      check_hand("single", hands[i], (enum eo_apex)leading);
    }
}

/* Unmodified flanks and roots meet at the form circle, and the tooth is as thick as it should be at the reference
   circle: s_t = m_t (pi/2 + 2 x tan(alpha_n)) (ISO 21771). */
static void check_tooth(const char *name)
{
  struct eo_tooth tooth;
  double gap = 0, thickness = 0, a[3], b[3];
  build(name);
  memset(&design.modification, 0, sizeof design.modification);
  for (int member = 0; member < 2; member++) {
    init(&tooth, member, EO_LEFT);
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < 5; k++) {
        static const enum eo_tooth_part pairs[4][2] = {{EO_TOOTH_DRIVE, EO_TOOTH_DRIVE_ROOT},
                                                       {EO_TOOTH_COAST, EO_TOOTH_COAST_ROOT},
                                                       {EO_TOOTH_DRIVE, EO_TOOTH_TIP},
                                                       {EO_TOOTH_COAST, EO_TOOTH_TIP}};
        eo_tooth_point(&tooth, pairs[i][0], 3, i < 2 ? 0 : 1, k / 4., a, NULL);
        eo_tooth_point(&tooth, pairs[i][1], 3, i < 2 ? 1 : i == 2, k / 4., b, NULL);
        gap = fmax(gap, hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]));
      }
    double p =
        (eo_geometry_own_path(member, eo_geometry_path_at(&geometry, member, geometry.reference_radius[member])) -
         tooth.start_path) /
        (tooth.tip_path - tooth.start_path);
    eo_tooth_point(&tooth, EO_TOOTH_DRIVE, 0, p, 0.5, a, NULL);
    eo_tooth_point(&tooth, EO_TOOTH_COAST, 0, p, 0.5, b, NULL);
    double angle = fabs(atan2(a[0], a[1]) - atan2(b[0], b[1]));
    double expected = geometry.transverse_module *
                      (M_PI / 2 + 2 * geometry.profile_shift[member] * tan(geometry.normal_pressure_angle));
    thickness = fmax(thickness, fabs(angle * geometry.reference_radius[member] - expected));
  }
  close_to(gap, 0, 1e-9, "gap between flanks, roots and tip land, m");
  close_to(thickness, 0, 1e-9, "tooth thickness at the reference circle, m");
}

/* OpenCASCADE: */

static void check_loaded(const char *name, int member)
{
  char folder[64], path[100], line[200];
  double largest = 0, node[3];
  int nodes = 0, ends;
  build(name);
  ends = design.gear_pair.ends;
  bool made = make_mesh(&design, &geometry, member, folder);
  snprintf(path, sizeof path, "%s/tooth.msh", folder);
  FILE *mesh = made ? fopen(path, "r") : NULL;
  struct eo_tooth tooth[2];
  for (int end = 0; end < ends; end++)
    init(&tooth[end], member, end);
  while (mesh && fgets(line, sizeof line, mesh) && strncmp(line, "$Nodes", 6) != 0)
    continue;
  while (mesh && fgets(line, sizeof line, mesh) && *line != '$') {
    int number;
    char rest[4];
    if (sscanf(line, "%d %lf %lf %lf %3s", &number, &node[0], &node[1], &node[2], rest) != 4)
      continue;
    double nearest = 1;
    for (int c = 0; c < 3; c++)
      node[c] *= 1e-3;
    const struct eo_tooth *own = &tooth[ends == 2 && node[2] > 0];
    for (int part = 0; part < EO_TOOTH_PARTS && nearest > allowed; part++)
      nearest = fmin(nearest, distance_from(own, (enum eo_tooth_part)part, node));
    if (nearest > allowed)
      printf("# node %.9g %.9g %.9g mm is %.3g nm off\n", 1e3 * node[0], 1e3 * node[1], 1e3 * node[2], 1e9 * nearest);
    largest = fmax(largest, nearest);
    nodes++;
  }
  if (mesh)
    fclose(mesh);
  remove_mesh(folder);
  ok(nodes > 100 && largest <= allowed,
     "%s: OpenCASCADE meshes the tooth; %d nodes lie within %.2g nm of the exact surface", name, nodes, 1e9 * largest);
}

/* Pieces of a flank with kinks lie on the surface that eo_tooth_point() has, what corners of the rack sweep between
   its sides; the file says of no part that it is further off than allowed. */
static void check_pieces(const char *what, bool folds, bool begins_behind)
{
  double largest = 0, gap = 0, rest = 0, off_circle = 0, point[3], next[3], normal[3];
  int swept = 0, pieces = 0, behind = 0;
  for (int member = 0; member < 2; member++)
    for (int coast = 0; coast < 2; coast++) {
      static struct eo_flank_pieces flank;
      struct eo_tooth tooth;
      init(&tooth, member, EO_LEFT);
      eo_flank_pieces_init(&flank, &tooth, coast ? EO_TOOTH_COAST : EO_TOOTH_DRIVE);
      rest = fmax(rest, eo_flank_rest_error(&flank));
      for (int k = 0; k < flank.count; k++) {
        const struct eo_flank_piece *piece = &flank.piece[k];
        struct eo_flank_row row = {.b = -1}, other = {.b = -1};
        bool corner = piece->line[0] == piece->line[1];
        if (piece->lost)
          continue;
        swept += corner;
        pieces++;
        for (int i = 0; i < 9 && !corner && !folds; i++) { /* a way to the nearest point does not lead over a fold */
          eo_flank_piece_point(&flank, k, &row, 0.1 + 0.4 * (i % 3), 0.1 + 0.4 * (i / 3), point, NULL);
          largest = fmax(largest, distance_from(&tooth, coast ? EO_TOOTH_COAST : EO_TOOTH_DRIVE, point));
        }
        for (int i = 0; i <= 4 && (k == 0 || piece[-1].lost || piece[-1].band != piece->band); i++) {
          eo_flank_piece_point(&flank, k, &row, 0, 0.1 + 0.2 * i, point, NULL);
          behind += hypot(point[0], point[1]) > flank.radius[0] + 1e-9;
        }
        for (int i = 0; i <= 4 && (k + 1 == flank.count || piece[1].lost || piece[1].band != piece->band); i++) {
          eo_flank_piece_point(&flank, k, &row, 1, 0.001 + 0.2495 * i, point, NULL);
          off_circle = fmax(off_circle, fabs(hypot(point[0], point[1]) - geometry.tip_radius[member]));
        }
        for (int i = 0; i <= 4 && k + 1 < flank.count && piece[1].band == piece->band && !piece[1].lost; i++) {
          eo_flank_piece_point(&flank, k, &row, 1, 0.1 + 0.2 * i, point, normal);
          eo_flank_piece_point(&flank, k + 1, &other, 0, 0.1 + 0.2 * i, next, NULL);
          gap = fmax(gap, fabs((next[0] - point[0]) * normal[0] + (next[1] - point[1]) * normal[1] +
                               (next[2] - point[2]) * normal[2]));
        }
      }
      eo_tooth_done(&tooth);
    }
  ok(largest < 1e-9, "%s: %d pieces, %d swept by a corner, lie within %.2g nm of the exact flank", what, pieces, swept,
     1e9 * largest);
  ok((behind > 0) == begins_behind, "%s: %d rows begin behind a fold at the root", what, behind);
  ok(off_circle < 1e-9, "%s: the flank ends on the tip circle, within %.2g nm", what, 1e9 * off_circle);
  ok(rest < 2e-9, "%s: the pieces are what the rack leaves, within %.2g nm", what, 1e9 * rest);
  ok(gap < allowed / 2, "%s: the pieces meet within %.2g nm, along the normal", what, 1e9 * gap);
  for (int member = 0; member < 2; member++) {
    struct eo_text text = {0};
    eo_step_write(&design, &geometry, member, false, &text);
    const char *word = strstr(text.data, "/* ");
    struct listing l = list_instances(text.data);
    int wrong = check_loops(&l);
    ok(wrong == 0, "%s: %d of %d faces are lines", what, wrong, l.faces);
    free(l.at);
    ok(!text.failed && text.size < 1500000 && !word,
       "%s: the file has %zu bytes, and every spline is within 5 nm %.60s", what, text.size, word ? word : "");
    eo_text_done(&text);
  }
}

/* Kinks of every kind. */
static void check_kinks(const char *name)
{
  for (int kind = 0; kind < 7; kind++) {
    char what[100];
    struct eo_error error;
    static const char *const kinds[7] = {
        "linear reliefs", "linear reliefs and end reliefs", "corner relief",           "grid",
        "corner reliefs", "grid whose border turns",        "a root relief that folds"};
    static const double u[3] = {-0.6e-3, 0, 0.9e-3}, y[3] = {-4e-3, 0, 5e-3},
                        delta[9] = {1e-6, 2e-6, 3e-6, 0, 1e-6, 2e-6, 3e-6, 4e-6, 5e-6},
                        border[9] = {4e-6, 0, -4e-6, 0, 0, 0, -5e-6, 1e-6, 5e-6};
    build(name);
    for (int i = 0; i < 8; i++) {
      struct eo_flank_modification *flank = i < 4 ? &design.modification.flank[i / 2][i % 2]
                                                  : &design.modification.coast[i / 2 % 2][i % 2];
      *flank = (struct eo_flank_modification){.lead_crowning = 5e-6, .helix_slope = 4e-6};
      if (kind < 2) {
        flank->shape = EO_RELIEF_LINEAR;
        flank->tip_relief = 25e-6;
        flank->tip_relief_start = 0.8e-3;
        flank->root_relief = 12e-6;
        flank->root_relief_start = 1.1e-3;
      }
      if (kind == 1) {
        flank->end_relief[0] = flank->end_relief[1] = 15e-6;
        flank->end_relief_length[0] = flank->end_relief_length[1] = 3e-3;
        flank->end_shape[0] = EO_RELIEF_LINEAR;
        flank->end_shape[1] = EO_RELIEF_CIRCULAR;
      }
      if (kind == 2)
        flank->triangular[EO_TIP_SIDE][EO_LEADING_SIDE] = (struct eo_triangular_relief){8e-6, 1.5e-3, 5e-3, 1};
      const struct eo_flank_grid grid = {.u_knots = 3, .y_knots = 3, .u = u, .y = y, .delta = delta};
      if (kind == 4) { /* one starts with an infinite curvature, and its border crosses that of the other */
        flank->triangular[EO_ROOT_SIDE][EO_TRAILING_SIDE] = (struct eo_triangular_relief){9e-6, 2.5e-3, 12e-3, 1.4};
        flank->triangular[EO_ROOT_SIDE][EO_LEADING_SIDE] = (struct eo_triangular_relief){8e-6, 2e-3, 11e-3, 1};
        flank->triangular[EO_TIP_SIDE][EO_LEADING_SIDE] = (struct eo_triangular_relief){9e-6, 5e-3, 9e-3, 1};
      }
      if (kind == 6) {
        flank->shape = EO_RELIEF_EXPONENT;
        flank->exponent[EO_ROOT_SIDE] = 3;
        flank->root_relief = 25e-6 * geometry.normal_module / 1e-3;
        flank->root_relief_start = 1.5e-3;
      }
      const struct eo_flank_grid turning = {.u_knots = 3, .y_knots = 3, .u = u, .y = y, .delta = border};
      if (kind == 5 &&
          eo_flank_grids_put(&design.grids, (enum eo_flank_side)(i / 4), i / 2 % 2, i % 2, &turning, &error))
        printf("Bail out! %s\n", error.text);
      if (kind == 3 && eo_flank_grids_put(&design.grids, (enum eo_flank_side)(i / 4), i / 2 % 2, i % 2, &grid, &error))
        printf("Bail out! %s\n", error.text);
      flank->twist = kind == 2 ? 3e-6 : 0;
    }
    snprintf(what, sizeof what, "%s, %s", name, kinds[kind]);
    check_pieces(what, kind == 4 || kind == 6, kind == 6);
  }
}

/* STL: */

static float float_at(const char *bytes)
{
  float value;
  memcpy(&value, bytes, sizeof value);
  return value;
}

/* Closed: the triangles seen from any point add up to one volume, and that is positive; the sum of their areas times
   normals is nothing. */
static void check_stl(const char *name, const char *format, double low, double high)
{
  struct eo_text text = {0};
  double volume = 0, sum[3] = {0}, area = 0;
  build(name);
  eo_exports_find(format)->write(&design, &geometry, &text);
  uint32_t count;
  memcpy(&count, text.data + 80, sizeof count);
  ok(text.size == 84 + 50 * (size_t)count && strncmp(text.data, "solid", 5) != 0, "%s: the file holds %u triangles",
     format, count);
  for (uint32_t i = 0; i < count; i++) {
    double v[3][3], cross[3];
    for (int k = 0; k < 9; k++)
      v[k / 3][k % 3] = (double)float_at(text.data + 84 + 50 * (size_t)i + 12 + 4 * (size_t)k);
    for (int c = 0; c < 3; c++) {
      int d = (c + 1) % 3, e = (c + 2) % 3;
      cross[c] = (v[1][d] - v[0][d]) * (v[2][e] - v[0][e]) - (v[1][e] - v[0][e]) * (v[2][d] - v[0][d]);
      sum[c] += cross[c] / 2;
      volume += v[0][c] * cross[c] / 6;
    }
    area += sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]) / 2;
  }
  close_to((fabs(sum[0]) + fabs(sum[1]) + fabs(sum[2])) / area, 0, 1e-6,
           "sum of areas times normals, 0 for a closed body");
  ok(volume > low && volume < high, "%s: the volume is %.6g mm3, expected %.4g .. %.4g", format, volume, low, high);
  eo_text_done(&text);
}

int main(void)
{
  check_file("paper-case-b", 2 * (3 + 1 + 1 + 3 + 3), 10);
  check_file("single", 3 + 1 + 1 + 3 + 3, 5);
  check_frame("paper-case-b", false);
  check_frame("paper-case-b", true);
  check_frame("single", true);
  check_coast_slope();
  check_tooth("paper");
  check_tooth("shifted");
  if (system("command -v gmsh >/dev/null 2>&1") == 0) {
    check_loaded("paper-case-b", EO_PINION);
    check_loaded("paper-case-b", EO_GEAR);
    check_loaded("shifted", EO_GEAR);
  } else
    ok(1, "loading in OpenCASCADE # SKIP gmsh is not installed");
  check_hands();
  check_kinks("paper");
  hand = "left";
  check_kinks("single");
  hand = "";
  /* pinion of the paper: between root and tip cylinders, 2 x 55 mm, and 50 mm of groove body 94.65 mm */
  double groove = 1e9 * M_PI * 0.047325 * 0.047325 * 0.05, low = 1e9 * M_PI * 0.04905 * 0.04905 * 0.11 + groove,
         high = 1e9 * M_PI * 0.0618 * 0.0618 * 0.11 + groove;
  check_stl("paper-case-b", "stl-pinion", low, high);
  hand = "left";
  check_stl("paper-case-b", "stl-pinion", low, high);
  return tap_done();
}
