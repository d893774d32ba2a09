/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flanks in the drawing's words: one start in five ways, terms by name against their formulas, grids as numbers and as
   text, what older documents meant, and the search that varies a start by diameter. Numbers of the starts: closed form
   (roll length L = sqrt(r^2 - r_b^2), u = k_u (L - L_C)) for the paper's pair. */
#include "document/design_document.h"
#include "document/examples.h"
#include "document/design_export.h"
#include "document/flank_grid_document.h"
#include "document/search_space.h"
#include "format/json.h"
#include "gear/surface.h"
#include "support/paper-pair.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>

static struct eo_faults faults;
static struct eo_geometry geometry;

/* The paper's pair, aligned, with the given modification and anything else. */
static json_t *document_of(const char *modification, const char *more)
{
  char text[8000];
  json_error_t error;
  snprintf(text, sizeof text,
           "{\"gear_pair\":{\"pinion_teeth\":17,\"gear_teeth\":44,\"normal_module_mm\":6,\"helix_angle_deg\":24,"
           "\"face_width_mm\":55},\"modification\":%s%s%s}",
           modification, more,
           strstr(more, "load_cases") ? "" : ",\"load_cases\":[{\"torque_Nm\":828,\"speed_rpm\":2000}]");
  json_t *document = json_loads(text, 0, &error);
  if (!document)
    printf("# %s\n", error.text);
  return document;
}

static bool read_text(const char *modification, const char *more, struct eo_design *design,
                      struct eo_warnings *warnings)
{
  json_t *document = document_of(modification, more);
  struct eo_error error;
  faults.count = 0;
  bool good = document && eo_design_decode(document, design, warnings, &faults);
  json_decref(document);
  if (good && eo_design_complete(design, &geometry, &error)) {
    eo_faults_add(&faults, error.pointer, "%s", error.text);
    good = false;
  }
  return good;
}

static void test_starts(void)
{
  static const struct {
    const char *key;
    double value;
  } way[] = {{"tip_relief_start_mm", 1.5},
             {"tip_relief_diameter_mm", 114.690452},
             {"tip_relief_roll_length_mm", 24.470860},
             {"tip_relief_roll_angle_deg", 27.034852},
             {"tip_relief_length_mm", 9.187096}};
  struct eo_design design;
  for (int i = 0; i < 5; i++) {
    char text[300];
    snprintf(text, sizeof text,
             "{\"pinion\":{\"left\":{\"relief_shape\":\"linear\",\"tip_relief_um\":30,\"%s\":%.9g}}}", way[i].key,
             way[i].value);
    ok(read_text(text, "", &design, NULL), "the start by %s is read %s", way[i].key, faults.fault[0].text);
    double u = eo_relief_start_at(&geometry, EO_PINION, &design.modification.flank[EO_PINION][EO_LEFT], EO_TIP_SIDE);
    close_to(1e3 * u, 1.5, 2e-5, "start on the rack by every other key, mm");
  }
  struct eo_profile_place place = eo_profile_place_at(&geometry, EO_PINION, 1.5e-3);
  close_to(1e3 * place.diameter, 114.690, 5e-4, "diameter of 1.5 mm on the rack, mm");
  close_to(place.roll_angle * 180 / M_PI, 27.035, 5e-4, "roll angle of 1.5 mm on the rack, deg");
  close_to(1e3 * place.roll_length, 24.471, 5e-4, "roll length of 1.5 mm on the rack, mm");
  close_to(1e3 * place.length[EO_TIP_SIDE], 9.187, 5e-4, "length of relief from the tip of 1.5 mm on the rack");
  double worst = 0;
  for (int member = 0; member < 2; member++)
    for (int side = 0; side < 2; side++)
      for (int form = 0; form < 4; form++) {
        struct eo_flank_modification flank = {.tip_relief = 1e-5, .root_relief = 1e-5};
        double u = side == EO_TIP_SIDE ? 2.2e-3 : -1.9e-3;
        struct eo_profile_place at = eo_profile_place_at(&geometry, member, u);
        const double form_value[4] = {at.diameter, at.roll_length, at.roll_angle, at.length[side]};
        (&flank.place[side].diameter)[form] = form_value[form];
        worst = fmax(worst, fabs(eo_relief_start_at(&geometry, member, &flank, side) - u));
      }
  close_to(1e6 * worst, 0, 1e-9, "starts there and back on both members and sides, um");
}

static void refuse(const char *what, const char *modification, const char *more, const char *pointer)
{
  struct eo_design design;
  bool good = read_text(modification, more, &design, NULL);
  ok(!good && faults.count > 0 && strcmp(faults.fault[0].pointer, pointer) == 0, "the decoder refuses %s: %s: %s", what,
     faults.count ? faults.fault[0].pointer : "", faults.count ? faults.fault[0].text : "");
}

static void test_refusals(void)
{
  refuse("a start stated twice",
         "{\"pinion\":{\"left\":{\"tip_relief_um\":3,\"tip_relief_start_mm\":1,\"tip_relief_diameter_mm\":114}}}", "",
         "/modification/pinion/left/tip_relief_diameter_mm");
  refuse("a start below the base circle", "{\"pinion\":{\"left\":{\"tip_relief_um\":3,\"tip_relief_diameter_mm\":90}}}",
         "", "/modification/pinion/left/tip_relief_diameter_mm");
  refuse("a start on the coast flank beyond the tip",
         "{\"gear\":{\"right\":{\"coast\":{\"tip_relief_um\":3,\"tip_relief_roll_length_mm\":80}}}}", "",
         "/modification/gear/right/coast/tip_relief_roll_length_mm");
  refuse("a triangular relief without a length", "{\"pinion\":{\"left\":{\"tip_leading_triangular_relief_um\":3}}}", "",
         "/modification/pinion/left/tip_leading_triangular_relief_um");
  refuse("a slope under both names", "{\"pinion\":{\"left\":{\"lead_slope_um\":3,\"helix_slope_um\":6}}}", "",
         "/modification/pinion/left/helix_slope_um");
  refuse("a grid whose rows are of unequal length",
         "{\"pinion\":{\"left\":{\"grid\":{\"u_mm\":[-1,1],\"y_mm\":[-1,1],\"delta_um\":[[1,2],[3]]}}}}", "",
         "/modification/pinion/left/grid/delta_um/1");
  refuse("a grid of another size",
         "{\"pinion\":{\"left\":{\"grid\":{\"u_mm\":[-1,1],\"y_mm\":[-1,1],"
         "\"delta_um\":[[1,2]]}}}}",
         "", "/modification/pinion/left/grid");
  refuse("places that do not increase",
         "{\"pinion\":{\"left\":{\"grid\":{\"u_mm\":[1,-1],\"y_mm\":[-1,1],"
         "\"delta_um\":[[1,2],[3,4]]}}}}",
         "", "/modification/pinion/left/grid/u_mm");
  refuse("a table with a word in it",
         "{\"pinion\":{\"right\":{\"coast\":{\"grid\":{\"csv\":\"u,-20,20\\n-3,1,2\\n0,1,x\\n\"}}}}}", "",
         "/modification/pinion/right/coast/grid/csv");
  refuse("an alignment stated twice", "{}",
         ",\"load_cases\":[{\"torque_Nm\":1,\"speed_rpm\":9,\"alignment\":{\"shaft_angle_error_in_plane_deg\":0.1,"
         "\"shaft_angle_error_in_plane_um\":27}}]",
         "/load_cases/0/alignment/shaft_angle_error_in_plane_um");
  refuse("hours in one load case alone", "{}",
         ",\"load_cases\":[{\"torque_Nm\":1,\"speed_rpm\":9,\"hours\":3},{\"torque_Nm\":2,\"speed_rpm\":9}]",
         "/load_cases");
}

/* A grid with a gain is the grid of so much larger numbers. */
static void test_gain(void)
{
  static const double u[2] = {-5e-3, 5e-3}, y[3] = {-25e-3, 0, 25e-3}, delta[6] = {1e-6, 2e-6, -3e-6, 5e-6, 0, 4e-6};
  double larger[6], slope[2], other[2], worst = 0;
  struct eo_flank_modification plain = {.tip_relief = 5e-6, .tip_relief_start = 1e-3}, gained = plain;
  struct eo_modification_shape shape[2], slice[2];
  struct eo_flank_spline *spline[2] = {NULL, NULL};
  struct eo_error error;
  gained.grid_gain = 0.5;
  for (int i = 0; i < 6; i++)
    larger[i] = 1.5 * delta[i];
  const struct eo_flank_grid grid[2] = {{.u_knots = 2, .y_knots = 3, .u = u, .y = y, .delta = larger},
                                        {.u_knots = 2, .y_knots = 3, .u = u, .y = y, .delta = delta}};
  for (int i = 0; i < 2; i++) {
    eo_flank_spline_new(&spline[i], &grid[i], &error);
    eo_modification_init(&shape[i], &geometry, EO_PINION, i ? &gained : &plain);
    eo_modification_complete(&shape[i], spline[i], false);
  }
  for (int j = -4; j <= 4; j++)
    for (int i = -4; i <= 4; i++) {
      for (int k = 0; k < 2; k++)
        eo_modification_slice(&shape[k], 6e-3 * j, &slice[k]);
      double a = eo_modification_profile(&slice[0], 1e-3 * i, slope),
             b = eo_modification_profile(&slice[1], 1e-3 * i, other);
      worst = fmax(worst, fmax(fabs(a - b), 1e-3 * fabs(slope[0] - other[0])));
    }
  close_to(1e6 * worst, 0, 1e-9, "delta of a grid under a gain of a half, half as much again, um");
  for (int i = 0; i < 2; i++)
    eo_flank_spline_free(spline[i]);
  refuse("a gain of no grid", "{\"pinion\":{\"left\":{\"grid_gain\":0.5}}}", "", "/modification/pinion/left/grid_gain");
}

static struct eo_warnings found;

/* What a finding says of a flank's root relief; NULL: nothing. */
static const char *fold_found(struct eo_design *design)
{
  struct eo_error error;
  struct eo_geometry own;
  found.count = 0;
  if (eo_design_complete(design, &own, &error))
    printf("Bail out! %s\n", error.text);
  eo_design_note_findings(design, &own, &found);
  for (int i = 0; i < found.count; i++)
    if (!strcmp(found.key[i], "/modification/pinion/left/root_relief_um"))
      return found.text[i];
  return NULL;
}

/* A rack with a steep relief near the base circle cuts away what it has made: said with the most that does not. */
static void test_fold(void)
{
  static struct eo_design folded;
  eo_example_build("paper", &folded);
  struct eo_flank_modification *flank = &folded.modification.flank[EO_PINION][EO_LEFT];
  flank->root_relief_start = 4.5e-3;
  flank->root_relief = 80e-6;
  const char *text = fold_found(&folded), *most = text ? strstr(text, "Up to ") : NULL;
  double amount = most ? 1e-6 * strtod(most + 6, NULL) : 0;
  ok(amount > 1e-6 && amount < 80e-6 && strstr(text, "The flank folds between the diameters 104."),
     "a steep relief folds: %s", text ? text : "not found");
  flank->root_relief = 0.99 * amount;
  ok(!fold_found(&folded), "a little less relief does not fold");
  flank->root_relief = 1.01 * amount;
  ok(fold_found(&folded) != NULL, "a little more relief folds");
}

/* deviations by name against the formulas of their definition. */
static void test_terms(void)
{
  struct eo_flank_modification flank = {.profile_slope = 4e-6,
                                        .profile_barrel = 6e-6,
                                        .helix_slope = 5e-6,
                                        .twist = 12e-6,
                                        .end_shape = {EO_RELIEF_LINEAR, EO_RELIEF_EXPONENT},
                                        .end_relief = {7e-6, 9e-6},
                                        .end_relief_length = {5e-3, 8e-3},
                                        .end_exponent = {0, 3}};
  flank.triangular[EO_ROOT_SIDE][EO_TRAILING_SIDE] = (struct eo_triangular_relief){11e-6, 3e-3, 20e-3, 2};
  double end[2], half = geometry.face_width / 2, worst = 0;
  struct eo_modification_shape shape;
  eo_active_profile(&geometry, EO_GEAR, end);
  eo_modification_init(&shape, &geometry, EO_GEAR, &flank);
  for (int i = -4; i <= 24; i++) /* beyond the active profile too, where a tip goes on */
    for (int j = 0; j <= 20; j++) {
      double u = end[0] + (end[1] - end[0]) * i / 20, y = half * (j / 10. - 1);
      double xi = (u - (end[0] + end[1]) / 2) / ((end[1] - end[0]) / 2), zeta = y / half;
      double trailing = (-y - half + 5e-3) / 5e-3, leading = (y - half + 8e-3) / 8e-3;
      double corner = 1 - (u - end[0]) / 3e-3 - (y + half) / 20e-3;
      double delta = 2e-6 * xi + 6e-6 * xi * xi + 2.5e-6 * zeta + 3e-6 * xi * zeta + 7e-6 * fmax(0, trailing) +
                     9e-6 * pow(fmax(0, leading), 3) + 11e-6 * pow(fmax(0, corner), 2);
      worst = fmax(worst, fabs(eo_modification_at(&shape, u, y) - delta));
    }
  close_to(1e6 * worst, 0, 1e-9, "difference between the terms by name and their formulas, um");
  eo_modification_complete(&shape, NULL, true);
  near(eo_modification_at(&shape, 1e-3, 20e-3), ({
         struct eo_modification_shape plain;
         eo_modification_init(&plain, &geometry, EO_GEAR, &flank);
         eo_modification_at(&plain, 1e-3, -20e-3);
       }),
       1e-12, "terms of a coast flank, whose y runs against eta");
}

/* What makes a surface smooth: knots met, slope and curvature continuous, straight at the border, constant beyond. */
static void test_spline(void)
{
  enum { U = 7, Y = 6 };
  double u[U], y[Y], delta[U * Y], slope[2], before[2], after[2], worst = 0;
  struct eo_flank_spline *spline;
  struct eo_error error;
  for (int i = 0; i < U; i++)
    u[i] = 1e-3 * (i - 3) * (1 + 0.1 * i);
  for (int j = 0; j < Y; j++)
    y[j] = 1e-2 * (j - 2.5);
  for (int i = 0; i < U; i++)
    for (int j = 0; j < Y; j++)
      delta[i * Y + j] = 1e-6 * sin(i * 1.7 + j * 0.9);
  struct eo_flank_grid grid = {.u_knots = U, .y_knots = Y, .u = u, .y = y, .delta = delta};
  ok(eo_flank_spline_new(&spline, &grid, &error) == EO_OK, "a spline is laid through a grid");
  for (int i = 0; i < U; i++)
    for (int j = 0; j < Y; j++)
      worst = fmax(worst, fabs(eo_flank_spline_at(spline, u[i], y[j], NULL) - delta[i * Y + j]));
  close_to(1e6 * worst, 0, 1e-12, "difference of the spline from its knots, um");
  double h = 1e-7, kink = 0, bend = 0;
  for (int i = 1; i < U - 1; i++) {
    eo_flank_spline_at(spline, u[i], 7e-3, slope);
    eo_flank_spline_at(spline, u[i] - h, 7e-3, before);
    eo_flank_spline_at(spline, u[i] + h, 7e-3, after);
    kink = fmax(kink, fabs(slope[1] - slope[0]));
    bend = fmax(bend, fabs(after[0] - 2 * slope[0] + before[0]));
  }
  close_to(kink, 0, 0, "kink of the spline at its knots");
  close_to(bend, 0, 1e-9, "jump of its curvature at its knots");
  eo_flank_spline_at(spline, u[0], 0, slope);
  eo_flank_spline_at(spline, u[0] + h, 0, after);
  eo_flank_spline_at(spline, u[1], 0, before);
  ok(fabs(after[0] - slope[1]) < 1e-3 * fabs(before[0] - slope[1]), "the spline is straight at the border");
  close_to(eo_flank_spline_at(spline, u[0] - 1e-3, y[2], slope), delta[2], 1e-18,
           "value of the spline beyond the border, m");
  ok(slope[0] == 0 && slope[1] == 0, "the spline has no slope beyond the border");
  double across = 0;
  for (int i = 0; i < 20; i++) {
    double place = y[0] + (y[Y - 1] - y[0]) * (i + 0.5) / 20;
    across = fmax(across, fabs(eo_flank_spline_across(spline, u[2] * 1.1, place) -
                               (eo_flank_spline_at(spline, u[2] * 1.1, place + h, NULL) -
                                eo_flank_spline_at(spline, u[2] * 1.1, place - h, NULL)) /
                                   (2 * h)));
  }
  close_to(across, 0, 1e-9, "difference of the spline's slope over the face from its values");
  ok(eo_flank_spline_across(spline, u[2], y[0] - 1e-9) == 0, "the spline has no slope over the face beyond the border");
  eo_flank_spline_free(spline);
}

/* One side of a kink has its own slope as near to it as one likes: a corner relief of 10 um over 2 x 5 mm takes off 5
   um per mm of u and 2 um per mm of y behind its border, and nothing before it. */
static void test_slopes_at_border(void)
{
  struct eo_flank_modification flank = {0};
  struct eo_modification_shape shape;
  struct eo_geometry g;
  double end[2], slope[2], y, cosine;
  struct eo_error error;
  struct eo_gear_pair pair = paper_pair();
  if (eo_geometry_init(&g, &pair, &error))
    printf("Bail out! %s\n", error.text);
  cosine = cos(g.helix_angle);
  flank.triangular[EO_TIP_SIDE][EO_LEADING_SIDE] = (struct eo_triangular_relief){10e-6, 2e-3, 5e-3, 1};
  eo_modification_init(&shape, &g, EO_PINION, &flank);
  eo_active_profile(&g, EO_PINION, end);
  y = g.face_width / 2 - 2.5e-3; /* there the border is 1 mm below the tip */
  for (int side = -1; side <= 1; side += 2) {
    eo_surface_relief(&shape, end[1] - 1e-3 + side * 1e-8, y / cosine, slope);
    close_to(slope[0], side > 0 ? 5e-3 : 0, 1e-15, "slope along the profile 10 nm from a border");
    close_to(slope[1], side > 0 ? 2e-3 * cosine : 0, 1e-15, "slope over the face 10 nm from a border");
  }
}

static void test_grid_document(void)
{
  static const char csv[] =
      "{\"pinion\":{\"left\":{\"grid\":{\"csv\":\"# measured\\nu/y;-20;0;20,5\\r\\n-3;1,5;2;3\\n0;4;5;"
      "6\\n2,25;-1;0;1\\n\"}}},\"gear\":{\"right\":{\"coast\":{\"grid\":{\"u_mm\":[-1,1],\"y_mm\":[-2,2],"
      "\"delta_um\":[[1,2],[3,4]]}}}}}";
  static struct eo_design design, back;
  struct eo_error error;
  ok(read_text(csv, "", &design, NULL), "a table with decimal commas is read %s", faults.fault[0].text);
  struct eo_flank_grid grid = eo_flank_grid_at(&design.grids, EO_DRIVE_FLANK, EO_PINION, EO_LEFT);
  ok(grid.u_knots == 3 && grid.y_knots == 3 && grid.y[2] == 20.5e-3 && grid.u[2] == 2.25e-3 && grid.delta[6] == -1e-6,
     "a table with decimal commas gives its numbers");
  json_t *document = eo_design_encode(&design);
  ok(document && json_object_get(json_object_get(json_object_get(json_object_get(json_object_get(document, "modificati"
                                                                                                           "on"),
                                                                                 "gear"),
                                                                 "right"),
                                                 "coast"),
                                 "grid"),
     "a grid of the coast flank is written to the document");
  faults.count = 0;
  ok(document && eo_design_decode(document, &back, NULL, &faults) && !eo_design_complete(&back, &geometry, &error) &&
         eo_flank_grids_equal(&design.grids, &back.grids),
     "grids survive their document %s", faults.fault[0].text);
  json_decref(document);
  struct eo_text text = {0};
  eo_flank_grid_to_text(&grid, &text);
  json_t *again = eo_flank_grid_from_text(text.data, &error);
  ok(again && json_array_size(json_object_get(again, "delta_um")) == 3,
     "a grid is written as text and read again: %.30s", text.data);
  json_decref(again);
  eo_text_done(&text);
  char hash[2][EO_HASH_LENGTH + 1];
  struct eo_text spec[2] = {{0}, {0}};
  eo_design_problem(&design, &spec[0], hash[0], &error);
  memset(&design.grids, 0, sizeof design.grids);
  eo_design_problem(&design, &spec[1], hash[1], &error);
  ok(strcmp(hash[0], hash[1]) != 0, "a grid makes another problem of a search");
  eo_text_done(&spec[0]);
  eo_text_done(&spec[1]);
}

/* A flank with reliefs and twist, exported as a table, read as a grid: the same deviation at its knots. */
static void test_export(void)
{
  static struct eo_design design, back;
  struct eo_text text = {0};
  struct eo_error error;
  struct eo_modification_shape shape, again;
  struct eo_flank_spline *spline;
  double worst = 0, end[2];
  ok(read_text("{\"gear\":{\"left\":{\"coast\":{\"tip_relief_um\":9,\"twist_um\":8,\"lead_crowning_um\":4}}}}", "",
               &design, NULL) &&
         !eo_export_write(eo_export_find("flank-grids"), &design, &geometry, 15, 9, &text, &error),
     "a pair's flanks are exported as tables");
  char *from = text.data ? strstr(text.data, "# gear, left, coast") : NULL,
       *to = from ? strstr(from + 1, "\n# ") : NULL;
  if (!ok(from && to, "the export holds one table for each flank"))
    return;
  *to = 0;
  json_t *csv = json_pack("{s:s}", "csv", from),
         *dumped = json_pack("{s:{s:{s:{s:o}}}}", "gear", "left", "coast", "grid", csv);
  char *written = json_dumps(dumped, JSON_COMPACT);
  ok(read_text(written, "", &back, NULL), "the exported table is read as a grid %s",
     faults.count ? faults.fault[0].text : "");
  eo_modification_init(&shape, &geometry, EO_GEAR, &design.modification.coast[EO_GEAR][EO_LEFT]);
  eo_flank_shape(&back, &geometry, EO_COAST_FLANK, EO_GEAR, EO_LEFT, &again, &spline);
  eo_active_profile(&geometry, EO_GEAR, end);
  end[0] -= geometry.normal_module / 10;
  end[1] += geometry.normal_module / 10;
  for (int i = 0; i < 15; i++)
    for (int j = 0; j < 9; j++) {
      double u = end[0] + (end[1] - end[0]) * i / 14, y = geometry.face_width * (j / 8. - 0.5);
      worst = fmax(worst, fabs(eo_modification_at(&shape, u, y) - eo_modification_at(&again, u, y)));
    }
  close_to(1e6 * worst, 0, 1e-4, "difference of the exported grid from its flank at the knots, um");
  eo_flank_spline_free(spline);
  free(written);
  json_decref(dumped);
  eo_text_done(&text);
}

static void test_migration(void)
{
  struct eo_design design;
  struct eo_warnings warnings = {0};
  ok(read_text("{\"pinion\":{\"left\":{\"lead_slope_um\":3,\"tip_relief_um\":5,\"tip_relief_start_mm\":1}}}",
               ",\"optimization\":{\"variables\":\"listed\",\"variable_list\":[{\"parameter\":\"lead_slope_um\","
               "\"bounds\":[-4,5]}]}",
               &design, &warnings),
     "an older document is read %s", faults.fault[0].text);
  near(design.modification.flank[EO_PINION][EO_LEFT].helix_slope, 6e-6, 1e-12,
       "slope of lead_slope_um 3 over that of helix_slope_um 6");
  ok(warnings.count == 1 && strstr(warnings.text[0], "helix_slope_um"), "a warning tells of the older name: %s",
     warnings.text[0]);
  ok(strcmp(eo_variable_parameters[design.optimization.list[0].parameter], "helix_slope_um") == 0 &&
         design.optimization.list[0].bounds.low == -8 && design.optimization.list[0].bounds.high == 10,
     "the older variable of a search is read by its new name");
  struct eo_modification_shape shape;
  double slope;
  eo_modification_init(&shape, &geometry, EO_PINION, &design.modification.flank[EO_PINION][EO_LEFT]);
  near(eo_modification_lead(&shape, shape.half_width, &slope), 3e-6, 1e-12,
       "lead slope of an older document at the face end, m");
  struct eo_modification read;
  struct eo_error error;
  ok(!eo_modification_read("{\"gear\":{\"right\":{\"lead_slope_um\":-2}}}", &read, &error) &&
         fabs(read.flank[EO_GEAR][EO_RIGHT].helix_slope + 4e-6) < 1e-18,
     "rows of an older history are read by the new name");
}

static void test_hours(void)
{
  struct eo_design design;
  ok(read_text("{}",
               ",\"load_cases\":[{\"torque_Nm\":1,\"speed_rpm\":9,\"hours\":300,\"name\":\"astern\",\"direction\":"
               "\"astern\"},"
               "{\"torque_Nm\":2,\"speed_rpm\":9,\"hours\":900}]",
               &design, NULL) &&
         design.load_case[0].share == 0.25 && design.load_case[1].share == 0.75 &&
         design.load_case[0].flank == EO_COAST_FLANK && strcmp(design.load_case[0].name, "astern") == 0,
     "shares follow from hours, the flank from the direction %s", faults.fault[0].text);
}

/* Case A's starts by diameter: the space holds case A, and gives its flank back. */
static void test_space(void)
{
  static struct eo_design design;
  struct eo_study_space space;
  struct eo_error error;
  ok(read_text("{\"pinion\":{\"left\":{\"tip_relief_start_mm\":1},\"right\":{\"tip_relief_start_mm\":1}}}",
               ",\"optimization\":{\"variables\":\"listed\",\"variable_list\":["
               "{\"parameter\":\"tip_relief_um\",\"bounds\":[0,40]},{\"parameter\":\"root_relief_um\",\"bounds\":[0,40]"
               "},{\"parameter\":\"lead_crowning_um\",\"bounds\":[0,36]},"
               "{\"parameter\":\"tip_relief_diameter_mm\",\"bounds\":[111.9,122.4]},"
               "{\"parameter\":\"root_relief_diameter_mm\",\"bounds\":[104.8,111.5]},"
               "{\"flank\":\"both\",\"parameter\":\"twist_um\",\"bounds\":[-5,5]}]}",
               &design, NULL),
     "a search over diameters is read %s", faults.count ? faults.fault[0].text : "");
  ok(eo_study_space_init(&space, &design, &geometry, &error) == EO_OK && space.count == 6,
     "a search over diameters has its variables");
  const double wanted[6] = {14e-6, 17e-6, 12e-6, 1.6e-3, -3.5e-3, 2e-6};
  double x[6] = {14. / 40,
                 17. / 40,
                 12. / 36,
                 (1e3 * eo_profile_place_at(&geometry, EO_PINION, 1.6e-3).diameter - 111.9) / 10.5,
                 (1e3 * eo_profile_place_at(&geometry, EO_PINION, -3.5e-3).diameter - 104.8) / 6.7,
                 0.7},
         back[6];
  struct eo_modification m;
  eo_study_space_apply(&space, &design.modification, x, &m);
  const struct eo_flank_modification *f = &m.flank[EO_PINION][EO_RIGHT];
  const double got[6] = {f->tip_relief,
                         f->root_relief,
                         f->lead_crowning,
                         eo_relief_start_at(&geometry, EO_PINION, f, EO_TIP_SIDE),
                         eo_relief_start_at(&geometry, EO_PINION, f, EO_ROOT_SIDE),
                         m.coast[EO_PINION][EO_LEFT].twist};
  for (int i = 0; i < 6; i++)
    near(got[i], wanted[i], 1e-6, "a variable of case A");
  ok(eo_study_space_locate(&space, &design.modification, &m, back) && fabs(back[3] - x[3]) < 1e-12 &&
         fabs(back[5] - 0.7) < 1e-12,
     "a row of the search is found again from its modification");
  struct eo_text text = {0};
  struct eo_modification read;
  ok(!eo_modification_write(&m, 2, &text, &error) && !eo_modification_read(text.data, &read, &error) &&
         eo_modification_equal(&read.flank[EO_PINION][EO_LEFT], &m.flank[EO_PINION][EO_LEFT]) &&
         eo_modification_equal(&read.coast[EO_PINION][EO_RIGHT], &m.coast[EO_PINION][EO_RIGHT]),
     "a row of the history is read as one of the search");
  eo_text_done(&text);
}

int main(void)
{
  test_starts();
  test_refusals();
  test_gain();
  test_terms();
  test_fold();
  test_spline();
  test_slopes_at_border();
  test_grid_document();
  test_export();
  test_migration();
  test_hours();
  test_space();
  return tap_done();
}
