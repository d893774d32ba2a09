/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "flexibility/section.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gear/names.h"

enum { MAX_TEETH = 5, MOST_RINGS = 64 };

/* The nodes of one tooth, as grids of node numbers. */
struct tooth {
  const struct eo_tooth_division *division;
  int place;    /* 0: the loaded tooth; + counterclockwise */
  int *core;    /* [rows + depth + 1][columns + 1] */
  int *side[2]; /* [depth + 1][fillet + 1]; column 0 is the core's edge, the last column the radial cut */
};

struct builder {
  struct eo_section *section;
  const struct eo_geometry *geometry;
  const struct eo_section_settings *settings;
  int member;
  double pitch_angle;
  double involute_share; /* of the root curve: from the start of the active profile to the form radius */
  double inner_angle;    /* of the core's edge on the foot and below, from the tooth's centre line */
  double foot_radius;
  int depth;     /* elements from the root to the bore: rim and rings */
  double *level; /* [depth + 1]: 0 at the root .. 1 at the foot; below it, radii in m */
  struct tooth tooth[MAX_TEETH];
};

/* Node at polar coordinates of a tooth; the angle counts from its centre line, + towards x > 0. */
static int add_node(struct builder *builder, const struct tooth *tooth, double radius, double angle)
{
  struct eo_section *section = builder->section;
  double turned = angle - tooth->place * builder->pitch_angle;
  section->point[2 * section->nodes] = radius * sin(turned);
  section->point[2 * section->nodes + 1] = radius * cos(turned);
  return section->nodes++;
}

/* Quadrilateral between grid columns i, i + 1 and rows j (outer), j + 1 (inner); flipped where columns run to x < 0.
   half: it is on the loaded side of the loaded tooth. */
static void add_quad(struct builder *builder, const int *grid, int columns, int j, int i, int flipped, int half)
{
  struct eo_section *section = builder->section;
  const int *outer = grid + j * (columns + 1) + i, *inner = outer + columns + 1;
  int *quad = section->quad + 4 * section->quads;
  quad[0] = inner[flipped];
  quad[1] = inner[!flipped];
  quad[2] = outer[!flipped];
  quad[3] = outer[flipped];
  double radius = 0;
  for (int k = 0; k < 4; k++)
    radius += 0.25 * hypot(section->point[2 * quad[k]], section->point[2 * quad[k] + 1]);
  section->half[section->quads++] = half && radius > builder->geometry->root_radius[builder->member];
}

/* Levels between root and bore: the first step has the given share, the others grow geometrically. */
static void grade_levels(double *level, int count, double first)
{
  double low = 1, high = 10, ratio = 1;
  for (int i = 0; i < 60; i++) {
    double sum = 0, step = first;
    ratio = 0.5 * (low + high);
    for (int k = 0; k < count; k++, step *= ratio)
      sum += step;
    if (sum < 1)
      low = ratio;
    else
      high = ratio;
  }
  double sum = 0, step = 1;
  level[0] = 0;
  for (int k = 0; k < count; k++, step *= ratio)
    level[k + 1] = sum += step;
  for (int k = 1; k <= count; k++)
    level[k] /= sum;
}

/* Rings between foot and bore, from the foot inwards: the first is as thick as the rim's last element, each next one a
   quarter thicker, up to 2.5 times the first or a quarter of the radius, whichever is more: what the deep body carries
   varies over lengths of the radius. All are stretched alike to end at the bore. radius[0] = foot; returns how many. */
static int grade_rings(double foot, double bore, double first, double *radius)
{
  static const double GROWTH = 1.25, THICKEST = 2.5, SHARE = 0.25, LEAST = 1e-6;
  double thickness = first, reached = foot;
  int count = 0;
  while (reached > bore + LEAST * foot && count < MOST_RINGS) {
    double next = fmax(0, reached - thickness);
    if (count > 0 && bore - next > reached - bore) /* a thinner ring than half: stretch those above instead */
      break;
    radius[++count] = reached = next;
    thickness = fmin(GROWTH * thickness, fmax(THICKEST * first, SHARE * reached));
  }
  for (int k = 1; k <= count; k++)
    radius[k] = foot - (foot - radius[k]) * (foot - bore) / (foot - reached);
  return count;
}

/* Length of the root from the form radius to the middle of the tooth space. */
static double fillet_length(const struct builder *builder)
{
  enum { PIECES = 64 };
  double length = 0, last[2], point[2], normal[2];
  eo_geometry_fillet(builder->geometry, builder->member, 1, last, normal);
  for (int i = 1; i <= PIECES; i++) {
    eo_geometry_fillet(builder->geometry, builder->member, 1 - (double)i / PIECES, point, normal);
    length += hypot(point[0] - last[0], point[1] - last[1]);
    memcpy(last, point, sizeof last);
  }
  return length;
}

/* Point and outward normal at share q of the way from the start of the active profile to the middle of the tooth space.
 */
static void root_point(const struct builder *builder, double q, double point[2], double normal[2])
{
  const struct eo_geometry *geometry = builder->geometry;
  double start = geometry->start_radius[builder->member];
  if (q <= builder->involute_share) {
    double way = builder->involute_share > 0 ? q / builder->involute_share : 0;
    eo_geometry_involute(geometry, builder->member, start + way * (geometry->form_radius[builder->member] - start),
                         point, normal);
  } else {
    eo_geometry_fillet(geometry, builder->member, (1 - q) / (1 - builder->involute_share), point, normal);
  }
}

/* Share u of a cubic line from share q of the root down to the foot. It leaves the root halfway between the inward
   normal and the radius and arrives radially. */
static void line_point(const struct builder *builder, double q, double u, double *radius, double *angle)
{
  double top[2], normal[2], p[2], bottom = builder->inner_angle + q * (builder->pitch_angle / 2 - builder->inner_angle);
  root_point(builder, q, top, normal);
  double down[2] = {-sin(bottom), -cos(bottom)}, foot = builder->foot_radius, r = hypot(top[0], top[1]);
  double start[2] = {-normal[0] - top[0] / r, -normal[1] - top[1] / r}, size = hypot(start[0], start[1]);
  double length = hypot(top[0] + foot * down[0], top[1] + foot * down[1]), v = 1 - u;
  for (int i = 0; i < 2; i++)
    p[i] = (1 + 2 * u) * v * v * top[i] - u * u * (3 - 2 * u) * foot * down[i] +
           length * (u * v * v * start[i] / size - u * u * v * down[i]);
  *radius = hypot(p[0], p[1]);
  *angle = atan2(p[0], p[1]);
}

/* Node row j below the root at share q of it: on the cubic lines down to the foot, radially below. */
static void depth_point(const struct builder *builder, double q, int j, double *radius, double *angle)
{
  if (j <= builder->settings->rim) {
    line_point(builder, q, builder->level[j], radius, angle);
    return;
  }
  *radius = builder->level[j];
  *angle = builder->inner_angle + q * (builder->pitch_angle / 2 - builder->inner_angle);
}

/* Path coordinate of row j: 0 at the tip, rows at the start of the active profile. */
static double row_path(const struct builder *builder, int rows, int j)
{
  const struct eo_geometry *geometry = builder->geometry;
  double share = (double)j / rows;
  return builder->member == EO_PINION ? geometry->path_end + share * (geometry->path_start - geometry->path_end)
                                      : geometry->path_start + share * (geometry->path_end - geometry->path_start);
}

static void add_core_nodes(struct builder *builder, struct tooth *tooth)
{
  int columns = tooth->division->columns, rows = tooth->division->rows, *node = tooth->core;
  for (int j = 0; j <= rows + builder->depth; j++) {
    double radius, angle, point[2], normal[2];
    if (j < rows) {
      radius = eo_geometry_radius_at(builder->geometry, builder->member, row_path(builder, rows, j));
      eo_geometry_involute(builder->geometry, builder->member, radius, point, normal);
      angle = atan2(point[0], point[1]);
    } else {
      depth_point(builder, 0, j - rows, &radius, &angle);
    }
    for (int i = 0; i <= columns; i++)
      *node++ = add_node(builder, tooth, radius, angle * (2.0 * i / columns - 1));
  }
}

/* The radial cut on the counterclockwise side (side 0) was made by nobody yet; on side 1 the previous tooth made it. */
static void add_side_nodes(struct builder *builder, struct tooth *tooth, int side, const struct tooth *before)
{
  int columns = tooth->division->columns, fillet = tooth->division->fillet[side], *node = tooth->side[side];
  const int *edge = tooth->core + tooth->division->rows * (columns + 1) + (side ? columns : 0);
  for (int j = 0; j <= builder->depth; j++, node += fillet + 1) {
    node[0] = edge[j * (columns + 1)];
    int last = side && before ? fillet : fillet + 1;
    for (int i = 1; i < last; i++) {
      double radius, angle;
      depth_point(builder, (double)i / fillet, j, &radius, &angle);
      node[i] = add_node(builder, tooth, radius, side ? angle : -angle);
    }
    if (side && before)
      node[fillet] = before->side[0][j * (before->division->fillet[0] + 1) + before->division->fillet[0]];
  }
}

static void add_quads(struct builder *builder, const struct tooth *tooth)
{
  const struct eo_tooth_division *division = tooth->division;
  for (int j = 0; j < division->rows + builder->depth; j++)
    for (int i = 0; i < division->columns; i++)
      add_quad(builder, tooth->core, division->columns, j, i, 0, !tooth->place && i >= division->columns / 2);
  for (int side = 0; side < 2; side++)
    for (int j = 0; j < builder->depth; j++)
      for (int i = 0; i < division->fillet[side]; i++)
        add_quad(builder, tooth->side[side], division->fillet[side], j, i, !side, !tooth->place && side);
}

static void mark_cut(const struct builder *builder, const struct tooth *tooth, int side)
{
  int fillet = tooth->division->fillet[side];
  for (int j = 0; j <= builder->depth; j++) {
    int node = tooth->side[side][j * (fillet + 1) + fillet];
    if (builder->settings->open)
      builder->section->cut[side][j] = node;
    else
      builder->section->fixed[node] = EO_HELD_ALL;
  }
}

static void mark_nodes(struct builder *builder)
{
  static const double ROUNDING = 1e-9;
  struct eo_section *section = builder->section;
  int teeth = builder->settings->teeth;
  for (int i = 0; i < section->nodes; i++) {
    double radius = hypot(section->point[2 * i], section->point[2 * i + 1]);
    if (builder->settings->floating)
      section->fixed[i] = radius < builder->foot_radius * (1 + ROUNDING) ? EO_HELD_AXIAL : 0;
    else
      section->fixed[i] = radius < section->bore_radius * (1 + ROUNDING) ? EO_HELD_ALL : 0;
  }
  mark_cut(builder, &builder->tooth[0], 1);
  mark_cut(builder, &builder->tooth[teeth - 1], 0);
  section->cut_nodes = builder->settings->open ? builder->depth + 1 : 0;
  const struct tooth *loaded = &builder->tooth[teeth / 2];
  int columns = loaded->division->columns;
  for (int j = 0; j <= loaded->division->rows + builder->depth; j++)
    section->centre[loaded->core[j * (columns + 1) + columns / 2]] = 1;
}

static enum eo_code list_flank(const struct builder *builder, const struct tooth *tooth, struct eo_flank_nodes *flank)
{
  int rows = tooth->division->rows, columns = tooth->division->columns;
  flank->node = malloc((size_t)(rows + 1) * sizeof *flank->node);
  flank->s = malloc((size_t)(rows + 1) * sizeof *flank->s);
  flank->normal = malloc((size_t)(rows + 1) * 2 * sizeof *flank->normal);
  if (!flank->node || !flank->s || !flank->normal)
    return EO_ERROR_MEMORY;
  flank->count = rows + 1;
  for (int k = 0; k <= rows; k++) {
    int j = builder->member == EO_PINION ? rows - k : k;
    double point[2], normal[2], turn = -tooth->place * builder->pitch_angle;
    flank->node[k] = tooth->core[j * (columns + 1) + columns];
    flank->s[k] = row_path(builder, rows, j);
    eo_geometry_involute(builder->geometry, builder->member,
                         eo_geometry_radius_at(builder->geometry, builder->member, flank->s[k]), point, normal);
    flank->normal[2 * k] = normal[0] * cos(turn) + normal[1] * sin(turn);
    flank->normal[2 * k + 1] = -normal[0] * sin(turn) + normal[1] * cos(turn);
  }
  return EO_OK;
}

/* Both flanks lead the motion of the pinion and trail that of the gear: pair k + 1 is clockwise on the pinion. */
static enum eo_code list_boundary(struct builder *builder)
{
  struct eo_section *section = builder->section;
  int middle = builder->settings->teeth / 2, ahead = builder->member == EO_PINION ? -1 : 1;
  const struct tooth *loaded = &builder->tooth[middle];
  enum eo_code code = list_flank(builder, loaded, &section->flank);
  for (int k = 0; k < 2 && middle > 0 && !code; k++)
    code = list_flank(builder, &builder->tooth[middle + (k ? ahead : -ahead)], &section->next_flank[k]);
  section->root = malloc((size_t)(loaded->division->fillet[1] + 1) * sizeof *section->root);
  if (code || !section->root)
    return EO_ERROR_MEMORY;
  section->root_nodes = loaded->division->fillet[1] + 1;
  memcpy(section->root, loaded->side[1], (size_t)section->root_nodes * sizeof *section->root);
  return EO_OK;
}

/* Upper bounds of the number of nodes and quadrilaterals, and the grids of node numbers. */
static enum eo_code allocate(struct builder *builder)
{
  int depth = builder->depth;
  size_t nodes = 0, quads = 0;
  for (int t = 0; t < builder->settings->teeth; t++) {
    struct tooth *tooth = &builder->tooth[t];
    tooth->place = t - builder->settings->teeth / 2;
    tooth->division = !tooth->place            ? &builder->settings->loaded
                      : abs(tooth->place) == 1 ? &builder->settings->next
                                               : &builder->settings->outer;
    const struct eo_tooth_division *division = tooth->division;
    size_t core = (size_t)(division->rows + depth + 1) * (size_t)(division->columns + 1);
    tooth->core = malloc(core * sizeof *tooth->core);
    nodes += core;
    quads += core;
    for (int side = 0; side < 2; side++) {
      size_t block = (size_t)(depth + 1) * (size_t)(division->fillet[side] + 1);
      tooth->side[side] = malloc(block * sizeof *tooth->side[side]);
      nodes += block;
      quads += block;
      if (!tooth->core || !tooth->side[side])
        return EO_ERROR_MEMORY;
    }
  }
  struct eo_section *section = builder->section;
  section->point = malloc(nodes * 2 * sizeof *section->point);
  section->quad = malloc(quads * 4 * sizeof *section->quad);
  section->half = malloc(quads);
  section->fixed = calloc(nodes, 1);
  section->centre = calloc(nodes, 1);
  for (int side = 0; side < 2; side++)
    section->cut[side] = malloc((size_t)(depth + 1) * sizeof *section->cut[side]);
  return section->point && section->quad && section->half && section->fixed && section->centre && section->cut[0] &&
                 section->cut[1]
             ? EO_OK
             : EO_ERROR_MEMORY;
}

static enum eo_code check(const struct builder *builder, struct eo_error *error)
{
  static const double BORE_MOST = 0.98; /* of the root radius: a thinner rim is no mesh */
  if (builder->settings->teeth >= builder->geometry->teeth[builder->member])
    return eo_error_set(error, EO_ERROR_INPUT, "/resolution/sector_teeth",
                        "A sector of %d teeth does not fit round the %s with its %d teeth.", builder->settings->teeth,
                        eo_member_name[builder->member], builder->geometry->teeth[builder->member]);
  if (!(builder->section->bore_radius > 0 &&
        builder->section->bore_radius < BORE_MOST * builder->geometry->root_radius[builder->member]))
    return eo_error_set(error, EO_ERROR_INPUT,
                        builder->member ? "/gear_pair/gear_bore_mm" : "/gear_pair/pinion_bore_mm",
                        "The bore of the %s leaves no rim below its teeth.", eo_member_name[builder->member]);
  return EO_OK;
}

/* The core narrows towards the foot, so that the lines from the fillet down have room beside it: to this share of the
   tooth's half angle at the start of its active profile, of which at most so much of the pitch counts; roots may be so
   thick that no room would be left. */
static const double CORE_SHARE = 0.6, CORE_PITCH_MOST = 0.35;

/* An involute below the active profile that is shorter than this share of the fillet gets no elements of its own. */
static const double INVOLUTE_LEAST = 1e-6;

/* Everything that the nodes are placed by. */
static enum eo_code plan(struct builder *builder)
{
  const struct eo_geometry *geometry = builder->geometry;
  double point[2], normal[2], start = geometry->start_radius[builder->member], bore = builder->section->bore_radius;
  double fillet = fillet_length(builder), involute = start - geometry->form_radius[builder->member];
  int rim = builder->settings->rim;
  builder->level = malloc((size_t)(rim + MOST_RINGS + 1) * sizeof *builder->level);
  if (!builder->level)
    return EO_ERROR_MEMORY;
  builder->pitch_angle = 2 * M_PI / geometry->teeth[builder->member];
  builder->involute_share = involute > INVOLUTE_LEAST * fillet ? involute / (involute + fillet) : 0;
  eo_geometry_involute(geometry, builder->member, start, point, normal);
  builder->inner_angle = CORE_SHARE * fmin(atan2(point[0], point[1]), CORE_PITCH_MOST * builder->pitch_angle);
  builder->foot_radius = fmax(bore, builder->settings->foot_radius);
  double depth = geometry->root_radius[builder->member] - builder->foot_radius;
  grade_levels(builder->level, rim, (fillet + involute) / builder->settings->loaded.fillet[1] / depth);
  double last = depth * (builder->level[rim] - builder->level[rim - 1]), radius[MOST_RINGS + 1];
  int rings = grade_rings(builder->foot_radius, bore, last, radius);
  for (int k = 1; k <= rings; k++)
    builder->level[rim + k] = radius[k];
  builder->depth = rim + rings;
  return EO_OK;
}

static void build(struct builder *builder)
{
  for (int t = 0; t < builder->settings->teeth; t++) {
    struct tooth *tooth = &builder->tooth[t];
    const struct tooth *before = t ? tooth - 1 : NULL;
    add_core_nodes(builder, tooth);
    add_side_nodes(builder, tooth, 1, before);
    add_side_nodes(builder, tooth, 0, NULL);
    add_quads(builder, tooth);
  }
  mark_nodes(builder);
}

static enum eo_code lay_out(struct builder *builder)
{
  EO_TRY(plan(builder));
  EO_TRY(allocate(builder));
  build(builder);
  return list_boundary(builder);
}

enum eo_code eo_section_init(struct eo_section *section, const struct eo_geometry *geometry, int member,
                             double bore_radius, const struct eo_section_settings *settings, struct eo_error *error)
{
  struct builder builder = {.section = section, .geometry = geometry, .settings = settings, .member = member};
  *section = (struct eo_section){.bore_radius = bore_radius};
  EO_TRY(check(&builder, error));
  enum eo_code code = lay_out(&builder);
  for (int t = 0; t < settings->teeth; t++) {
    free(builder.tooth[t].core);
    free(builder.tooth[t].side[0]);
    free(builder.tooth[t].side[1]);
  }
  free(builder.level);
  if (code) {
    eo_section_done(section);
    return eo_error_memory(error);
  }
  return EO_OK;
}

static void free_flank(struct eo_flank_nodes *flank)
{
  free(flank->node);
  free(flank->s);
  free(flank->normal);
}

void eo_section_done(struct eo_section *section)
{
  if (!section)
    return;
  free(section->point);
  free(section->quad);
  free(section->half);
  free(section->fixed);
  free(section->centre);
  free(section->root);
  free(section->cut[0]);
  free(section->cut[1]);
  free_flank(&section->flank);
  free_flank(&section->next_flank[0]);
  free_flank(&section->next_flank[1]);
  *section = (struct eo_section){0};
}
