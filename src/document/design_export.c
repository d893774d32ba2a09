/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/design_export.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "document/flank_grid_document.h"
#include "document/design_document.h"
#include "document/dimensions_export.h"
#include "document/flank_chart.h"
#include "document/tolerance_export.h"
#include "format/json.h"
#include "gear/names.h"
#include "gear/surface.h"

enum { CHART_POINTS = 61 };

static void put(struct eo_text *text, double value, const struct eo_unit *unit)
{
  double outside = !unit ? value : unit->divide ? value * unit->factor : value / unit->factor;
  eo_text_print(text, ",%.10g", outside + 0.0);
}

static void put_place(struct eo_text *text, int member, int end)
{
  eo_text_print(text, "%s,%s", eo_member_name[member], eo_end_name[end]);
}

static void end_row(struct eo_text *text)
{
  eo_text_add(text, "\r\n");
}

struct flank {
  const struct eo_geometry *geometry;
  int member, end;
  struct eo_modification_shape shape;
  double offset;        /* z of mid face, m */
  double along, across; /* +1, -1: from the frame of its own end to that of the member: z, x */
  double pitch, behind; /* to the frame below, from +x towards +y, rad; what a stagger turns more */
  double half;          /* from the tooth's centre to a flank at the working pitch radius, rad */
  bool coast;
  int rows, columns; /* of a grid of points: root to tip, over the face */
};

typedef void flank_function(const struct flank *flank, struct eo_text *text);

/* Angle from +y towards +x at which an end's unmodified flank stands at the pitch radius in mid face. */
static double pitch_angle(const struct eo_geometry *geometry, int member)
{
  const struct eo_flank_modification none = {0};
  struct eo_modification_shape shape;
  struct eo_surface_point point;
  double u, v;
  eo_modification_init(&shape, geometry, member, &none);
  eo_surface_coordinates(geometry, member, 0, 0, &u, &v);
  eo_surface_evaluate(geometry, member, &shape, u, v, &point);
  return atan2(point.position[0], point.position[1]);
}

static const int usual_grid[2] = {EO_EXPORT_ROWS, EO_EXPORT_COLUMNS};

static void each_flank(const struct eo_design *design, const struct eo_geometry *geometry, const int grid[2],
                       flank_function *function, struct eo_text *text)
{
  int ends = design->gear_pair.ends, flanks = 2 * ends * (eo_design_shows_coast(design) ? 2 : 1);
  for (int i = 0; i < flanks; i++) {
    int end = i % ends, member = i / ends % 2;
    const enum eo_flank_side side = (enum eo_flank_side)(i / ends / 2);
    double point[2], normal[2];
    const struct eo_geometry half = eo_geometry_of_half(geometry, &design->gear_pair, end);
    struct flank flank = {.geometry = &half, .member = member, .end = end, .rows = grid[0], .columns = grid[1]};
    struct eo_flank_spline *spline = NULL;
    text->failed = text->failed || eo_flank_shape(design, &half, side, member, end, &flank.shape, &spline);
    flank.coast = flank.shape.mirrored = side == EO_COAST_FLANK;
    flank.offset = (end == EO_LEFT ? -1 : 1) * eo_gear_pair_mid_face(&design->gear_pair, end);
    flank.along = (end == EO_LEFT ? -1 : 1) * eo_alignment_outwards(&design->alignment);
    flank.across = -eo_design_rotation(design);
    double behind = end == EO_RIGHT ? eo_design_right_lag(design, geometry) * 2 * M_PI / geometry->teeth[member] : 0;
    flank.pitch = pitch_angle(geometry, member);
    flank.behind = member == EO_PINION ? behind : -behind;
    eo_geometry_involute(geometry, member, geometry->working_radius[member], point, normal);
    flank.half = atan2(point[0], point[1]);
    function(&flank, text);
    eo_flank_spline_free(spline);
  }
}

/* From the member's own root to its tip. */
static double path_at(const struct flank *flank, double fraction)
{
  const struct eo_geometry *geometry = flank->geometry;
  double length = geometry->path_end - geometry->path_start;
  return flank->member == EO_PINION ? geometry->path_start + fraction * length : geometry->path_end - fraction * length;
}

static double rack_at(const struct flank *flank, double s)
{
  return flank->geometry->rack_factor * eo_geometry_own_path(flank->member, s);
}

static double roll_at(const struct flank *flank, double s)
{
  const struct eo_geometry *geometry = flank->geometry;
  double tangent = geometry->tangent_length[flank->member] + eo_geometry_own_path(flank->member, s);
  return tangent / geometry->base_radius[flank->member];
}

static double profile_part(const struct flank *flank, double s)
{
  double slope[2];
  return eo_modification_profile(&flank->shape, rack_at(flank, s), slope);
}

static double lead_part(const struct flank *flank, double eta)
{
  double slope, slopes[2];
  if (flank->shape.varies)
    return eo_modification_at(&flank->shape, 0, eta) - eo_modification_profile(&flank->shape, 0, slopes);
  return eo_modification_lead(&flank->shape, eta / cos(flank->geometry->helix_angle), &slope);
}

static void turn(double vector[3], double angle) /* from +x towards +y */
{
  double c = cos(angle), s = sin(angle), x = vector[0];
  vector[0] = c * x - s * vector[1];
  vector[1] = s * x + c * vector[1];
}

/* Points:
   Frame of a member: z its axis, from the middle of the groove (of the only face) to the right; the working flank of a
   tooth faces +x (-x, all mirrored, where the pinion turns clockwise seen from its left end) and would, unmodified,
   pass through the plane x = 0 at the working pitch radius in mid face. eo_surface_evaluate() gives one end with z
   along eta (pinion) or against it (gear), y towards the face that meets first. A stagger turns the right end back:
   against the motion, which goes to +x on the pinion, to -x on the gear. */
static void place_vector(const struct flank *flank, const double local[3], double shift, double global[3])
{
  double own[3] = {local[0], local[1], local[2]};
  if (flank->coast) { /* half a turn about the tooth's centre, where the drive flank stands `half` away from it */
    turn(own, flank->pitch - flank->half);
    own[0] = -own[0];
    own[2] = -own[2];
    turn(own, flank->half + flank->behind);
  } else
    turn(own, flank->pitch + flank->behind);
  global[0] = flank->across * own[0];
  global[1] = own[1];
  global[2] = shift + flank->along * (flank->member == EO_PINION ? own[2] : -own[2]);
}

/* y: over the face, + on the side where drive flanks meet first. */
static void write_point(const struct flank *flank, double s, double y, struct eo_text *text)
{
  struct eo_surface_point point;
  double u, v, position[3], normal[3], eta = flank->coast ? -y : y;
  eo_surface_coordinates(flank->geometry, flank->member, s, eta, &u, &v);
  eo_surface_evaluate(flank->geometry, flank->member, &flank->shape, u, v, &point);
  place_vector(flank, point.position, flank->offset, position);
  place_vector(flank, point.normal, 0, normal);
  for (int i = 0; i < 3; i++)
    put(text, position[i], &eo_unit_mm);
  for (int i = 0; i < 3; i++)
    put(text, normal[i], NULL);
  put(text, eo_modification_at(&flank->shape, rack_at(flank, s), eta), &eo_unit_um);
}

/* Of the rows of a flank, at their end. */
static void end_flank_row(const struct flank *flank, struct eo_text *text)
{
  eo_text_print(text, ",%s", flank->coast ? "coast" : "drive");
  end_row(text);
}

static void write_flank_points(const struct flank *flank, struct eo_text *text)
{
  for (int i = 0; i < flank->rows; i++)
    for (int j = 0; j < flank->columns; j++) {
      double s = path_at(flank, (double)i / (flank->rows - 1));
      double eta = flank->geometry->member_width[flank->member] * ((double)j / (flank->columns - 1) - 0.5);
      put_place(text, flank->member, flank->end);
      eo_text_print(text, ",%d,%d", i, j);
      write_point(flank, s, eta, text);
      end_flank_row(flank, text);
    }
}

static void write_point_grid(const struct eo_design *design, const struct eo_geometry *geometry, const int grid[2],
                             struct eo_text *text)
{
  eo_text_add(text, "member,end,profile,face,x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,modification_um,flank\r\n");
  each_flank(design, geometry, grid, write_flank_points, text);
}

static void write_points(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  write_point_grid(design, geometry, usual_grid, text);
}

static void write_profile_chart(const struct flank *flank, struct eo_text *text)
{
  for (int i = 0; i < CHART_POINTS; i++) {
    double s = path_at(flank, (double)i / (CHART_POINTS - 1));
    put_place(text, flank->member, flank->end);
    eo_text_add(text, ",profile");
    put(text, rack_at(flank, s), &eo_unit_mm);
    put(text, eo_geometry_radius_at(flank->geometry, flank->member, s), &eo_unit_mm);
    put(text, roll_at(flank, s), &eo_unit_deg);
    put(text, profile_part(flank, s), &eo_unit_um);
    end_flank_row(flank, text);
  }
}

static void write_lead_chart(const struct flank *flank, struct eo_text *text)
{
  for (int i = 0; i < CHART_POINTS; i++) {
    double eta = flank->geometry->member_width[flank->member] * ((double)i / (CHART_POINTS - 1) - 0.5);
    put_place(text, flank->member, flank->end);
    eo_text_add(text, ",lead");
    put(text, eta, &eo_unit_mm);
    eo_text_add(text, ",,");
    put(text, lead_part(flank, flank->coast ? -eta : eta), &eo_unit_um);
    end_flank_row(flank, text);
  }
}

static void write_charts_of(const struct flank *flank, struct eo_text *text)
{
  write_profile_chart(flank, text);
  write_lead_chart(flank, text);
}

static void write_charts(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  eo_text_add(text, "member,end,chart,coordinate_mm,radius_mm,roll_angle_deg,modification_um,flank\r\n");
  each_flank(design, geometry, usual_grid, write_charts_of, text);
}

static void write_topography_of(const struct flank *flank, struct eo_text *text)
{
  for (int i = 0; i < flank->rows; i++)
    for (int j = 0; j < flank->columns; j++) {
      double s = path_at(flank, (double)i / (flank->rows - 1));
      double eta = flank->geometry->member_width[flank->member] * ((double)j / (flank->columns - 1) - 0.5);
      put_place(text, flank->member, flank->end);
      put(text, eo_geometry_radius_at(flank->geometry, flank->member, s), &eo_unit_mm);
      put(text, roll_at(flank, s), &eo_unit_deg);
      put(text, eta, &eo_unit_mm);
      put(text, eo_modification_at(&flank->shape, rack_at(flank, s), flank->coast ? -eta : eta), &eo_unit_um);
      end_flank_row(flank, text);
    }
}

static void write_topography_grid(const struct eo_design *design, const struct eo_geometry *geometry, const int grid[2],
                                  struct eo_text *text)
{
  eo_text_add(text, "member,end,radius_mm,roll_angle_deg,face_mm,modification_um,flank\r\n");
  each_flank(design, geometry, grid, write_topography_of, text);
}

static void write_topography(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  write_topography_grid(design, geometry, usual_grid, text);
}

/* Everything that is taken off a flank as a table that the key grid of a flank takes as csv: u over rows, y over
   columns. Somewhat beyond the active profile, where flanks that do not fit each other still touch: a grid goes on with
   its border value. */
static void write_flank_grid(const struct eo_design *design, const struct eo_geometry *geometry,
                             enum eo_flank_side side, int member, int end, const int size[2], struct eo_text *text)
{
  const struct eo_geometry half = eo_geometry_of_half(geometry, &design->gear_pair, end);
  double u[EO_EXPORT_GRID_MOST], y[EO_EXPORT_GRID_MOST], ends[2];
  struct eo_modification_shape shape;
  struct eo_flank_spline *spline = NULL;
  double *delta = malloc(sizeof *delta * (size_t)size[0] * (size_t)size[1]);
  text->failed = text->failed || !delta || eo_flank_shape(design, &half, side, member, end, &shape, &spline);
  eo_active_profile(&half, member, ends);
  ends[EO_ROOT_SIDE] -= half.normal_module / 10;
  ends[EO_TIP_SIDE] += half.normal_module / 10;
  for (int j = 0; j < size[1]; j++)
    y[j] = half.member_width[member] * ((double)j / (size[1] - 1) - 0.5);
  for (int i = 0; i < size[0] && !text->failed; i++) {
    u[i] = ends[EO_ROOT_SIDE] + (ends[EO_TIP_SIDE] - ends[EO_ROOT_SIDE]) * i / (size[0] - 1);
    for (int j = 0; j < size[1]; j++)
      delta[i * size[1] + j] = eo_modification_at(&shape, u[i], y[j]);
  }
  struct eo_flank_grid grid = {.u_knots = size[0], .y_knots = size[1], .u = u, .y = y, .delta = delta};
  eo_text_print(text, "# %s, %s, %s\n", eo_member_name[member], eo_end_name[end],
                side == EO_DRIVE_FLANK ? "drive flank" : "coast flank");
  if (!text->failed)
    eo_flank_grid_to_text(&grid, text);
  eo_flank_spline_free(spline);
  free(delta);
}

static void write_flank_grids(const struct eo_design *design, const struct eo_geometry *geometry, const int size[2],
                              struct eo_text *text)
{
  for (int side = 0; side < 2; side++)
    for (int member = 0; member < 2; member++)
      for (int end = 0; end < design->gear_pair.ends; end++)
        write_flank_grid(design, geometry, (enum eo_flank_side)side, member, end, size, text);
}

static void write_usual_flank_grids(const struct eo_design *design, const struct eo_geometry *geometry,
                                    struct eo_text *text)
{
  write_flank_grids(design, geometry, usual_grid, text);
}

static void write_design(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  (void)geometry;
  json_t *document = eo_design_encode(design);
  if (document)
    eo_json_write(text, document, EO_JSON_PRETTY);
  else
    text->failed = true;
  json_decref(document);
}

static const struct eo_export formats[] = {
    {"flank-points", "points and normals of the working flanks, exactly as generated, with what is taken off",
     "text/csv; charset=utf-8", "csv", write_points, write_point_grid},
    {"modification-chart", "profile and lead modification as curves", "text/csv; charset=utf-8", "csv", write_charts,
     NULL},
    {"k-chart", "nominal profile and helix with tolerance bands, over roll length, roll angle, diameter, face",
     "text/csv; charset=utf-8", "csv", eo_flank_charts_csv, NULL},
    {"k-chart-drawing", "the same as drawings", "image/svg+xml", "svg", eo_flank_charts_svg, NULL},
    {"tolerances", "flank tolerances by ISO 1328-1, edition and grade of the rating", "text/csv; charset=utf-8", "csv",
     eo_tolerances_csv, NULL},
    {"dimensions", "tooth thickness, span, balls and pins, form circles, allowances and backlash, with their symbols",
     "text/csv; charset=utf-8", "csv", eo_dimensions_csv, NULL},
    {"topography", "what is taken off, over profile and face", "text/csv; charset=utf-8", "csv", write_topography,
     write_topography_grid},
    {"flank-grids",
     "what is taken off each drive and coast flank, one table after the other, as a flank's grid takes it",
     "text/csv; charset=utf-8", "csv", write_usual_flank_grids, write_flank_grids},
    {"design", "the design with every default resolved", "application/json", "json", write_design, NULL},
};
enum { FORMATS = sizeof formats / sizeof formats[0] };

const struct eo_export *eo_export_at(int index)
{
  return index >= 0 && index < FORMATS ? &formats[index] : NULL;
}

const struct eo_export *eo_export_find(const char *name)
{
  for (int i = 0; i < FORMATS; i++)
    if (strcmp(formats[i].name, name) == 0)
      return &formats[i];
  return NULL;
}

enum eo_code eo_export_write(const struct eo_export *format, const struct eo_design *design,
                             const struct eo_geometry *geometry, int rows, int columns, struct eo_text *text,
                             struct eo_error *error)
{
  const int grid[2] = {rows ? rows : usual_grid[0], columns ? columns : usual_grid[1]};
  bool usual = grid[0] == usual_grid[0] && grid[1] == usual_grid[1];
  if (!usual && !format->write_grid)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The format \"%s\" has no rows and columns to choose.",
                        format->name);
  if (usual)
    format->write(design, geometry, text);
  else
    format->write_grid(design, geometry, grid, text);
  return EO_OK;
}

bool eo_export_has_columns(const struct eo_export *format)
{
  static const char *const names[] = {"flank-points", "topography", "modification-chart"};
  bool has = false;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    has = has || strcmp(format->name, names[i]) == 0;
  return has;
}

void eo_export_file_name(const struct eo_export *format, const struct eo_design *design, char *name, size_t size)
{
  size_t most = size - strlen(format->name) - strlen(format->ending) - 3, length = 0;
  for (const char *c = design->name; *c && length < most; c++)
    if (isalnum((unsigned char)*c) && (unsigned char)*c < 128)
      name[length++] = (char)tolower((unsigned char)*c);
    else if (length && name[length - 1] != '-')
      name[length++] = '-';
  while (length && name[length - 1] == '-')
    length--;
  snprintf(name + length, size - length, "%s%s.%s", length ? "-" : "", format->name, format->ending);
}
