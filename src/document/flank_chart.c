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
#include "rating/gear_rating.h"

enum { POINTS = EO_FLANK_CHART_POINTS };

static const char *const member_name[2] = {"pinion", "gear"}, *const end_name[2] = {"left", "right"};

/* Roll length of the place s, and back. */
static double roll_of(const struct eo_geometry *g, int member, double s)
{
  return g->tangent_length[member] + eo_geometry_own_path(member, s);
}

static double path_of(const struct eo_geometry *g, int member, double roll)
{
  return eo_geometry_own_path(member, roll - g->tangent_length[member]);
}

static double roll_at_radius(const struct eo_geometry *g, int member, double radius)
{
  return sqrt(fmax(0, radius * radius - g->base_radius[member] * g->base_radius[member]));
}

/* ISO 1328-1: L_alpha is 92 % of the active length from where the active profile begins. */
static void set_profile_places(struct eo_flank_chart *c, const struct eo_geometry *g,
                               const struct eo_modification_shape *shape)
{
  const double evaluated = 0.92;
  int m = c->member;
  double ends[2] = {roll_of(g, m, g->path_start), roll_of(g, m, g->path_end)};
  c->active[0] = fmin(ends[0], ends[1]);
  c->active[1] = fmax(ends[0], ends[1]);
  c->form = roll_at_radius(g, m, g->form_radius[m]);
  c->range[0] = c->active[0];
  c->range[1] = c->active[0] + evaluated * (c->active[1] - c->active[0]);
  for (int side = 0; side < 2; side++) {
    double own = (side ? 1 : -1) * shape->side[side].start / g->rack_factor;
    c->relief[side] = shape->side[side].length > 0 ? g->tangent_length[m] + own : NAN;
  }
}

/* Equal steps, but for the points next to the ends of the evaluation range, which lie on them. */
static void set_places(struct eo_flank_chart *c, double from, double to)
{
  for (int i = 0; i < POINTS; i++)
    c->x[i] = from + (to - from) * i / (POINTS - 1);
  for (int side = 0; side < 2; side++)
    c->x[lround((c->range[side] - from) / (to - from) * (POINTS - 1))] = c->range[side];
}

static void set_profile(struct eo_flank_chart *c, const struct eo_geometry *g,
                        const struct eo_modification_shape *shape)
{
  int m = c->member;
  set_profile_places(c, g, shape);
  set_places(c, fmin(c->form, c->active[0]), c->active[1]);
  for (int i = 0; i < POINTS; i++) {
    double slope[2];
    c->roll_angle[i] = c->x[i] / g->base_radius[m];
    c->diameter[i] = 2 * hypot(c->x[i], g->base_radius[m]);
    double own = eo_geometry_own_path(m, path_of(g, m, c->x[i]));
    c->nominal[i] = -eo_modification_profile(shape, g->rack_factor * own, slope);
  }
}

/* ISO 1328-1: the evaluation leaves out at each end the smaller of 5 % of the face and one module. */
static void set_helix(struct eo_flank_chart *c, const struct eo_geometry *g, const struct eo_modification_shape *shape)
{
  double width = g->member_width[c->member], half = width / 2, left_out = fmin(0.05 * width, g->normal_module);
  c->active[0] = -half;
  c->active[1] = half;
  c->range[0] = left_out - half;
  c->range[1] = half - left_out;
  c->form = c->relief[0] = c->relief[1] = NAN;
  set_places(c, -half, half);
  for (int i = 0; i < POINTS; i++) {
    double slope;
    c->roll_angle[i] = c->diameter[i] = NAN;
    c->nominal[i] = -eo_modification_lead(shape, c->x[i] / cos(g->helix_angle), &slope);
    if (shape->varies)
      c->nominal[i] = -eo_modification_at(shape, 0, c->x[i]);
  }
}

void eo_flank_tolerance_of(const struct eo_design *design, const struct eo_geometry *g, int member,
                           struct eo_flank_tolerance *tolerance, char *note, size_t size)
{
  const struct eo_rating_settings *r = &design->rating;
  struct eo_error error = {.text = ""};
  const struct eo_tolerance_input in = {.reference_diameter = 2 * g->reference_radius[member],
                                        .normal_module = g->normal_module,
                                        .face_width = g->member_width[member],
                                        .teeth = g->teeth[member],
                                        .grade = r->accuracy_grade,
                                        .total_contact_ratio = g->transverse_contact_ratio + g->overlap_ratio};
  *tolerance = (struct eo_flank_tolerance){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  eo_flank_tolerance(tolerance, eo_rating_tolerance_edition(r), &in, &error);
  snprintf(note, size, "%s", error.text);
}

void eo_flank_chart_find(struct eo_flank_chart *c, const struct eo_design *design, const struct eo_geometry *whole,
                         enum eo_flank_side side, int member, int end, bool helix)
{
  const struct eo_geometry own = eo_geometry_of_half(whole, &design->gear_pair, end), *geometry = &own;
  struct eo_modification_shape shape;
  *c = (struct eo_flank_chart){.side = side, .member = member, .end = end, .helix = helix};
  struct eo_flank_spline *spline;
  bool failed = eo_flank_shape(design, geometry, side, member, end, &shape, &spline);
  if (helix)
    set_helix(c, geometry, &shape);
  else
    set_profile(c, geometry, &shape);
  eo_flank_spline_free(spline);
  eo_flank_tolerance_of(design, geometry, member, &c->tolerance, c->note, sizeof c->note);
  if (failed)
    snprintf(c->note, sizeof c->note, "There was no memory for the flank's grid: it is not in this chart.");
  double half = (helix ? c->tolerance.helix_total : c->tolerance.profile_total) / 2;
  const double slack = 1e-9; /* m, of rounding at the ends of the range */
  for (int i = 0; i < POINTS; i++) {
    bool inside = c->x[i] >= c->range[0] - slack && c->x[i] <= c->range[1] + slack;
    c->band[i][0] = inside ? c->nominal[i] + half : NAN;
    c->band[i][1] = inside ? c->nominal[i] - half : NAN;
  }
}

/* One chart in the units of drawings. */
struct drawing {
  double x[POINTS], angle[POINTS], diameter[POINTS], nominal[POINTS], upper[POINTS], lower[POINTS];
  char title[200], range[120];
};

static void fill_drawing(struct drawing *d, const struct eo_flank_chart *c, const struct eo_design *design)
{
  const struct eo_rating_settings *r = &design->rating;
  double tolerance = 1e6 * (c->helix ? c->tolerance.helix_total : c->tolerance.profile_total);
  bool new = r->edition == EO_ISO6336_2019;
  for (int i = 0; i < POINTS; i++) {
    d->x[i] = 1e3 * c->x[i];
    d->angle[i] = c->roll_angle[i] * 180 / M_PI;
    d->diameter[i] = 1e3 * c->diameter[i];
    d->nominal[i] = 1e6 * c->nominal[i];
    d->upper[i] = 1e6 * c->band[i][0];
    d->lower[i] = 1e6 * c->band[i][1];
  }
  snprintf(d->title, sizeof d->title, "%s, %s of the %s%s%s", c->helix ? "Helix" : "Profile",
           c->helix ? "at the pitch point" : "mid face", member_name[c->member],
           c->side == EO_COAST_FLANK ? ", coast flank" : "",
           design->gear_pair.ends == 1 ? ""
           : c->end                    ? ", right end"
                                       : ", left end");
  if (isnan(tolerance))
    snprintf(d->range, sizeof d->range, "evaluation range %.4g mm", 1e3 * (c->range[1] - c->range[0]));
  else
    snprintf(d->range, sizeof d->range, "evaluation range %.4g mm, %s %.6g um (ISO 1328-1:%s, %s %d)",
             1e3 * (c->range[1] - c->range[0]), c->helix ? "F_beta" : "F_alpha", tolerance, new ? "2013" : "1995",
             new ? "class" : "grade", r->accuracy_grade);
}

void eo_flank_chart_svg(const struct eo_flank_chart *c, const struct eo_design *design, struct eo_text *text)
{
  struct drawing *d = malloc(sizeof *d);
  if (!d) {
    text->failed = true;
    return;
  }
  fill_drawing(d, c, design);
  struct eo_band_chart chart = {.title = d->title,
                                .x_label = c->helix ? "face, mm" : "roll length, mm",
                                .y_label = "deviation, um",
                                .below = "material",
                                .above = "air",
                                .count = POINTS,
                                .x = d->x,
                                .nominal = d->nominal,
                                .upper = d->upper,
                                .lower = d->lower,
                                .range = {1e3 * c->range[0], 1e3 * c->range[1]},
                                .range_label = d->range};
  if (c->helix) {
    chart.marks = 2;
    chart.mark[0].x = d->x[0];
    chart.mark[0].label = c->side == EO_COAST_FLANK ? "meets first" : "meets last";
    chart.mark[1].x = d->x[POINTS - 1];
    chart.mark[1].label = c->side == EO_COAST_FLANK ? "meets last" : "meets first";
  } else {
    chart.scales = 2;
    chart.scale[0].label = "roll angle, deg";
    chart.scale[0].value = d->angle;
    chart.scale[0].decimals = 2;
    chart.scale[1].label = "diameter, mm";
    chart.scale[1].value = d->diameter;
    chart.scale[1].decimals = 2;
    const struct {
      double x;
      const char *label;
    } places[] = {{c->form, "d_Ff"},
                  {c->active[0], "d_Nf"},
                  {c->active[1], "d_a"},
                  {c->relief[0], "root relief"},
                  {c->relief[1], "tip relief"}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
      chart.mark[chart.marks].x = 1e3 * places[i].x;
      chart.mark[chart.marks++].label = places[i].label;
    }
  }
  eo_band_chart_svg(&chart, text);
  free(d);
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

static void write_rows(const struct eo_flank_chart *c, const struct eo_design *design, struct eo_text *text)
{
  (void)design;
  for (int i = 0; i < POINTS; i++) {
    eo_text_print(text, "%s,%s,%s", member_name[c->member], end_name[c->end], c->helix ? "helix" : "profile");
    put(text, c->helix ? NAN : c->x[i], 1e3);
    put(text, c->roll_angle[i], 180 / M_PI);
    put(text, c->diameter[i], 1e3);
    put(text, c->helix ? c->x[i] : NAN, 1e3);
    put(text, c->nominal[i], 1e6);
    put(text, c->band[i][0], 1e6);
    put(text, c->band[i][1], 1e6);
    eo_text_print(text, ",%s\r\n", c->side == EO_COAST_FLANK ? "coast" : "drive");
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
static void write_on_sheet(const struct eo_flank_chart *c, const struct eo_design *design, struct eo_text *text)
{
  enum { WIDTH = 720, HEIGHT = 370 };
  int number = (((int)c->side * 2 + c->member) * design->gear_pair.ends + c->end) * 2 + c->helix;
  eo_text_print(text, "<svg x=\"0\" y=\"%d\" width=\"%d\" height=\"%d\">\n", number * HEIGHT, WIDTH, HEIGHT);
  eo_flank_chart_svg(c, design, text);
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
