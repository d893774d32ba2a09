/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document/flank_chart.h"

#include "document/flank_grid_document.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "format/band_chart.h"
#include "format/unit.h"
#include "gear/modification.h"
#include "gear/names.h"
#include "rating/gear_rating.h"

enum { POINTS = EO_FLANK_CHART_POINTS };

/* Roll length of the place s, and back. */
static double roll_of(const struct eo_geometry *geometry, int member, double s)
{
  return geometry->tangent_length[member] + eo_geometry_own_path(member, s);
}

static double path_of(const struct eo_geometry *geometry, int member, double roll)
{
  return eo_geometry_own_path(member, roll - geometry->tangent_length[member]);
}

static double roll_at_radius(const struct eo_geometry *geometry, int member, double radius)
{
  return sqrt(fmax(0, radius * radius - geometry->base_radius[member] * geometry->base_radius[member]));
}

/* ISO 1328-1: L_alpha is 92 % of the active length from where the active profile begins. */
static void set_profile_places(struct eo_flank_chart *chart, const struct eo_geometry *geometry,
                               const struct eo_modification_shape *shape)
{
  const double evaluated = 0.92;
  int m = chart->member;
  double ends[2] = {roll_of(geometry, m, geometry->path_start), roll_of(geometry, m, geometry->path_end)};
  chart->active[0] = fmin(ends[0], ends[1]);
  chart->active[1] = fmax(ends[0], ends[1]);
  chart->form = roll_at_radius(geometry, m, geometry->form_radius[m]);
  chart->range[0] = chart->active[0];
  chart->range[1] = chart->active[0] + evaluated * (chart->active[1] - chart->active[0]);
  for (int side = 0; side < 2; side++) {
    double own = (side ? 1 : -1) * shape->side[side].start / geometry->rack_factor;
    chart->relief[side] = shape->side[side].length > 0 ? geometry->tangent_length[m] + own : NAN;
  }
}

/* Equal steps, but for the points next to the ends of the evaluation range, which lie on them. */
static void set_places(struct eo_flank_chart *chart, double from, double to)
{
  for (int i = 0; i < POINTS; i++)
    chart->x[i] = from + (to - from) * i / (POINTS - 1);
  for (int side = 0; side < 2; side++)
    chart->x[lround((chart->range[side] - from) / (to - from) * (POINTS - 1))] = chart->range[side];
}

static void set_profile(struct eo_flank_chart *chart, const struct eo_geometry *geometry,
                        const struct eo_modification_shape *shape)
{
  int m = chart->member;
  set_profile_places(chart, geometry, shape);
  set_places(chart, fmin(chart->form, chart->active[0]), chart->active[1]);
  for (int i = 0; i < POINTS; i++) {
    double slope[2];
    chart->roll_angle[i] = chart->x[i] / geometry->base_radius[m];
    chart->diameter[i] = 2 * hypot(chart->x[i], geometry->base_radius[m]);
    double own = eo_geometry_own_path(m, path_of(geometry, m, chart->x[i]));
    chart->nominal[i] = -eo_modification_profile(shape, geometry->rack_factor * own, slope);
  }
}

/* ISO 1328-1: the evaluation leaves out at each end the smaller of 5 % of the face and one module. */
static void set_helix(struct eo_flank_chart *chart, const struct eo_geometry *geometry,
                      const struct eo_modification_shape *shape)
{
  double width = geometry->member_width[chart->member], half = width / 2,
         left_out = fmin(0.05 * width, geometry->normal_module);
  chart->active[0] = -half;
  chart->active[1] = half;
  chart->range[0] = left_out - half;
  chart->range[1] = half - left_out;
  chart->form = chart->relief[0] = chart->relief[1] = NAN;
  set_places(chart, -half, half);
  for (int i = 0; i < POINTS; i++) {
    double slope;
    chart->roll_angle[i] = chart->diameter[i] = NAN;
    chart->nominal[i] = -eo_modification_lead(shape, chart->x[i] / cos(geometry->helix_angle), &slope);
    if (shape->varies)
      chart->nominal[i] = -eo_modification_at(shape, 0, chart->x[i]);
  }
}

void eo_flank_tolerance_of(const struct eo_design *design, const struct eo_geometry *geometry, int member,
                           struct eo_flank_tolerance *tolerance, char *note, size_t size)
{
  const struct eo_rating_settings *settings = &design->rating;
  struct eo_error error = {.text = ""};
  const struct eo_tolerance_input in = {.reference_diameter = 2 * geometry->reference_radius[member],
                                        .normal_module = geometry->normal_module,
                                        .face_width = geometry->member_width[member],
                                        .teeth = geometry->teeth[member],
                                        .grade = settings->accuracy_grade,
                                        .total_contact_ratio = geometry->transverse_contact_ratio +
                                                               geometry->overlap_ratio,
                                        .helix_angle = geometry->helix_angle};
  *tolerance = (struct eo_flank_tolerance){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  eo_flank_tolerance(tolerance, eo_rating_tolerance_edition(settings), &in, &error);
  snprintf(note, size, "%s", error.text);
}

void eo_flank_chart_find(struct eo_flank_chart *chart, const struct eo_design *design, const struct eo_geometry *whole,
                         enum eo_flank_side side, int member, int end, bool helix)
{
  const struct eo_geometry own = eo_geometry_of_half(whole, &design->gear_pair, end), *geometry = &own;
  struct eo_modification_shape shape;
  *chart = (struct eo_flank_chart){.side = side, .member = member, .end = end, .helix = helix};
  struct eo_flank_spline *spline;
  bool failed = eo_flank_shape(design, geometry, side, member, end, &shape, &spline);
  if (helix)
    set_helix(chart, geometry, &shape);
  else
    set_profile(chart, geometry, &shape);
  eo_flank_spline_free(spline);
  eo_flank_tolerance_of(design, geometry, member, &chart->tolerance, chart->note, sizeof chart->note);
  if (failed)
    snprintf(chart->note, sizeof chart->note, "There was no memory for the flank's grid: it is not in this chart.");
  double half = (helix ? chart->tolerance.helix_total : chart->tolerance.profile_total) / 2;
  const double slack = 1e-9; /* m, of rounding at the ends of the range */
  for (int i = 0; i < POINTS; i++) {
    bool inside = chart->x[i] >= chart->range[0] - slack && chart->x[i] <= chart->range[1] + slack;
    chart->band[i][0] = inside ? chart->nominal[i] + half : NAN;
    chart->band[i][1] = inside ? chart->nominal[i] - half : NAN;
  }
}

/* What lengths and deviations are shown in. */
static const struct shown_units {
  double length, deviation; /* of SI */
  const char *length_name, *deviation_name, *face, *roll_length, *diameter, *deviation_label;
  int decimals;
} shown_units[2] = {
    {1e3, 1e6, "mm", "um", "face, mm", "roll length, mm", "diameter, mm", "deviation, um", 2},
    {1e3 / 25.4, 1e6 / 25.4, "in", "thou", "face, in", "roll length, in", "diameter, in", "deviation, thou", 4}};

/* One chart in the units of drawings. */
struct drawing {
  double x[POINTS], angle[POINTS], diameter[POINTS], nominal[POINTS], upper[POINTS], lower[POINTS];
  char title[200], range[120];
};

static void fill_drawing(struct drawing *drawing, const struct eo_flank_chart *chart, const struct eo_design *design,
                         const struct shown_units *in)
{
  const struct eo_rating_settings *settings = &design->rating;
  double tolerance = in->deviation * (chart->helix ? chart->tolerance.helix_total : chart->tolerance.profile_total);
  bool new = settings->edition == EO_ISO6336_2019;
  for (int i = 0; i < POINTS; i++) {
    drawing->x[i] = in->length * chart->x[i];
    drawing->angle[i] = chart->roll_angle[i] * 180 / M_PI;
    drawing->diameter[i] = in->length * chart->diameter[i];
    drawing->nominal[i] = in->deviation * chart->nominal[i];
    drawing->upper[i] = in->deviation * chart->band[i][0];
    drawing->lower[i] = in->deviation * chart->band[i][1];
  }
  snprintf(drawing->title, sizeof drawing->title, "%s, %s of the %s%s%s", chart->helix ? "Helix" : "Profile",
           chart->helix ? "at the pitch point" : "mid face", eo_member_name[chart->member],
           chart->side == EO_COAST_FLANK ? ", coast flank" : "",
           design->gear_pair.ends == 1 ? ""
           : chart->end                ? ", right end"
                                       : ", left end");
  if (isnan(tolerance))
    snprintf(drawing->range, sizeof drawing->range, "evaluation range %.4g %s",
             in->length * (chart->range[1] - chart->range[0]), in->length_name);
  else
    snprintf(drawing->range, sizeof drawing->range, "evaluation range %.4g %s, %s %.6g %s (ISO 1328-1:%s, %s %d)",
             in->length * (chart->range[1] - chart->range[0]), in->length_name, chart->helix ? "F_beta" : "F_alpha",
             tolerance, in->deviation_name, new ? "2013" : "1995", new ? "class" : "grade", settings->accuracy_grade);
}

void eo_flank_chart_svg(const struct eo_flank_chart *flank_chart, const struct eo_design *design, bool inches,
                        struct eo_text *text)
{
  const struct shown_units *in = &shown_units[inches];
  struct drawing *drawing = malloc(sizeof *drawing);
  if (!drawing) {
    text->failed = true;
    return;
  }
  fill_drawing(drawing, flank_chart, design, in);
  struct eo_band_chart chart = {.title = drawing->title,
                                .x_label = flank_chart->helix ? in->face : in->roll_length,
                                .y_label = in->deviation_label,
                                .below = "material",
                                .above = "air",
                                .count = POINTS,
                                .x = drawing->x,
                                .nominal = drawing->nominal,
                                .upper = drawing->upper,
                                .lower = drawing->lower,
                                .range = {in->length * flank_chart->range[0], in->length * flank_chart->range[1]},
                                .range_label = drawing->range};
  if (flank_chart->helix) {
    chart.marks = 2;
    chart.mark[0].x = drawing->x[0];
    chart.mark[0].label = flank_chart->side == EO_COAST_FLANK ? "meets first" : "meets last";
    chart.mark[1].x = drawing->x[POINTS - 1];
    chart.mark[1].label = flank_chart->side == EO_COAST_FLANK ? "meets last" : "meets first";
  } else {
    chart.scales = 2;
    chart.scale[0].label = "roll angle, deg";
    chart.scale[0].value = drawing->angle;
    chart.scale[0].decimals = 2;
    chart.scale[1].label = in->diameter;
    chart.scale[1].value = drawing->diameter;
    chart.scale[1].decimals = in->decimals;
    const struct {
      double x;
      const char *label;
    } places[] = {{flank_chart->form, "d_Ff"},
                  {flank_chart->active[0], "d_Nf"},
                  {flank_chart->active[1], "d_a"},
                  {flank_chart->relief[0], "root relief"},
                  {flank_chart->relief[1], "tip relief"}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
      chart.mark[chart.marks].x = in->length * places[i].x;
      chart.mark[chart.marks++].label = places[i].label;
    }
  }
  eo_band_chart_svg(&chart, text);
  free(drawing);
}

typedef void chart_function(const struct eo_flank_chart *chart, const struct eo_design *design, struct eo_text *text);

static void each_chart(const struct eo_design *design, const struct eo_geometry *geometry, chart_function *function,
                       struct eo_text *text)
{
  struct eo_flank_chart *chart = malloc(sizeof *chart);
  text->failed = text->failed || !chart;
  int flanks = 2 * design->gear_pair.ends * (eo_design_shows_coast(design) ? 2 : 1);
  for (int i = 0; i < flanks * 2 && chart; i++) {
    int flank = i / 2, end = flank % design->gear_pair.ends, member = flank / design->gear_pair.ends % 2;
    eo_flank_chart_find(chart, design, geometry, (enum eo_flank_side)(flank / design->gear_pair.ends / 2), member, end,
                        i % 2 == 1);
    function(chart, design, text);
  }
  free(chart);
}

static void put(struct eo_text *text, double value, double unit)
{
  eo_text_add(text, ",");
  if (isfinite(value))
    eo_text_print(text, "%.10g", value * unit + 0.0);
}

static void write_rows(const struct eo_flank_chart *chart, const struct eo_design *design, struct eo_text *text)
{
  (void)design;
  for (int i = 0; i < POINTS; i++) {
    eo_text_print(text, "%s,%s,%s", eo_member_name[chart->member], eo_end_name[chart->end],
                  chart->helix ? "helix" : "profile");
    put(text, chart->helix ? NAN : chart->x[i], 1e3);
    put(text, chart->roll_angle[i], 180 / M_PI);
    put(text, chart->diameter[i], 1e3);
    put(text, chart->helix ? chart->x[i] : NAN, 1e3);
    put(text, chart->nominal[i], 1e6);
    put(text, chart->band[i][0], 1e6);
    put(text, chart->band[i][1], 1e6);
    eo_text_print(text, ",%s\r\n", chart->side == EO_COAST_FLANK ? "coast" : "drive");
  }
}

void eo_flank_charts_csv(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  eo_text_add(
      text,
      "member,end,chart,roll_length_mm,roll_angle_deg,diameter_mm,face_mm,nominal_um,upper_um,lower_um,flank\r\n");
  each_chart(design, geometry, write_rows, text);
}

/* Where the next drawing of a sheet goes. */
static void write_on_sheet(const struct eo_flank_chart *chart, const struct eo_design *design, struct eo_text *text)
{
  enum { WIDTH = 720, HEIGHT = 370 };
  int number = (((int)chart->side * 2 + chart->member) * design->gear_pair.ends + chart->end) * 2 + chart->helix;
  eo_text_print(text, "<svg x=\"0\" y=\"%d\" width=\"%d\" height=\"%d\">\n", number * HEIGHT, WIDTH, HEIGHT);
  eo_flank_chart_svg(chart, design, false, text);
  eo_text_add(text, "</svg>\n");
}

void eo_flank_charts_svg(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  enum { WIDTH = 720, HEIGHT = 370 };
  eo_text_print(text, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\">\n", WIDTH,
                (eo_design_shows_coast(design) ? 8 : 4) * design->gear_pair.ends * HEIGHT, WIDTH);
  each_chart(design, geometry, write_on_sheet, text);
  eo_text_add(text, "</svg>\n");
}
