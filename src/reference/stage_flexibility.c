/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/stage.h"
#include "design/resolution.h"
#include "reference/stage_mesh.h"
#include "flexibility/export.h"

enum { MOST_ROWS = 64, MOST_PLACES = 400, MOST_POINTS = 500 };

struct mesh_input {
  char file[1000];
  int member;
  enum eo_mesh_element element;
  int row;
};

static const char *const elements[] = {"C3D8I", "C3D20R", NULL};

static const struct eo_field mesh_input[] = {
    {.key = "file",
     .kind = EO_FIELD_TEXT,
     .flags = EO_FIELD_REQUIRED,
     .offset = offsetof(struct mesh_input, file),
     .count = sizeof((struct mesh_input *)0)->file,
     .help = "name of the file to write"},
    EO_STAGE_MEMBER(struct mesh_input, member),
    EO_CHOICE(struct mesh_input, element, "element", elements, EO_MESH_C3D8I,
              "this program's bricks, or quadratic ones on the same mesh"),
    EO_INTEGER(struct mesh_input, row, "row", 0, 60, 0,
               "row of flank nodes, counted from the smallest s, that carries 1 N per mm of face width"),
};
static const struct eo_table mesh_table = EO_TABLE("mesh", struct mesh_input, mesh_input);

struct point_input {
  int pair;
  double s, eta, force;
};

static const struct eo_field point_input[] = {
    EO_INTEGER(struct point_input, pair, "pair", -1000, 1000, 0,
               "tooth pair; pair k + 1 meets one base pitch ahead of pair k"),
    EO_NUMBER_REQUIRED(struct point_input, s, "s_mm", &eo_unit_mm, -1e3, 1e3, "on the flank, path coordinate"),
    EO_NUMBER_REQUIRED(struct point_input, eta, "eta_mm", &eo_unit_mm, -5e3, 5e3,
                       "axial from mid face, + on the side that meets first"),
    EO_NUMBER(struct point_input, force, "force_N", &eo_unit_N, -1e9, 1e9, 0,
              "normal to the flank; 0: only the deflection is asked for"),
};
static const struct eo_table point_table = EO_TABLE("a point", struct point_input, point_input);

struct input {
  struct eo_design design;
  struct eo_stage_kernel kernel;
  struct eo_numbers s, eta;
  int points;
  struct point_input point[MOST_POINTS];
  int export;
  struct mesh_input mesh;
};

static const struct eo_field input[] = {
    EO_STAGE_GEAR_PAIR(struct input),
    EO_STAGE_MATERIAL(struct input),
    EO_STAGE_RESOLUTION(struct input),
    EO_TEXT(struct input, kernel.cache_directory, "cache_directory",
            "where finite elements are kept for the next run; empty: nowhere"),
    EO_SERIES(struct input, s, "s_mm", &eo_unit_mm, MOST_ROWS, -1e3, 1e3, 0,
              "rows of constant s that carry a uniform load of 1 N per mm of face width"),
    EO_SERIES(struct input, eta, "eta_mm", &eo_unit_mm, MOST_PLACES, -5e3, 5e3, 0,
              "where on these rows the deflection is asked for; empty: both face ends and mid face"),
    EO_LIST(struct input, point, points, "points", &point_table, 0, MOST_POINTS,
            "point loads and where their deflection is asked for"),
    EO_OPTIONAL(struct input, mesh, export, "mesh", &mesh_table, "no mesh is written",
                "the mesh of one member as an input file of CalculiX, in m and N"),
};
static const struct eo_table input_table = EO_TABLE("the input", struct input, input);

static const struct eo_field times[] = {
    EO_OUT(struct eo_member_times, unknowns, "unknowns", NULL,
           "of the sector's matrix; these are 0 when it came from the cache"),
    EO_OUT(struct eo_member_times, entries, "factor_entries", NULL, "of its factor"),
    EO_OUT(struct eo_member_times, memory, "memory_bytes", NULL, "the sparse solver's peak"),
};
static const struct eo_table times_table = EO_TABLE("the work", struct eo_member_times, times);

static const struct eo_field report[] = {
    EO_TEXT(struct eo_flexibility_report, key, "key", "hash of everything the result depends on"),
    EO_FLAG(struct eo_flexibility_report, from_cache, "from_cache", 0, "read instead of computed"),
    EO_TEXT(struct eo_flexibility_report, note, "note", "why the cache could not be used or kept"),
    EO_OUT_PAIR(struct eo_flexibility_report, smallest_eigenvalue, "smallest_eigenvalue", NULL,
                "[pinion, gear] of the compliance of a flank with its neighbours, over the largest; 0 from the cache"),
    EO_OBJECT(struct eo_flexibility_report, times[EO_PINION], "pinion", &times_table, "size of the pinion's model"),
    EO_OBJECT(struct eo_flexibility_report, times[EO_GEAR], "gear", &times_table, "size of the gear's model"),
};
static const struct eo_table report_table = EO_TABLE("report", struct eo_flexibility_report, report);

struct row_output {
  double s;
  struct eo_numbers member[2];
};

static const struct eo_field row_output[] = {
    EO_OUT(struct row_output, s, "s_mm", &eo_unit_mm, "of the row"),
    EO_OUT_SERIES(struct row_output, member[EO_PINION], "pinion_um", &eo_unit_um,
                  "normal deflection of the pinion's tooth at each eta, local part removed"),
    EO_OUT_SERIES(struct row_output, member[EO_GEAR], "gear_um", &eo_unit_um, "likewise of the gear's"),
};
static const struct eo_table row_table = EO_TABLE("a row", struct row_output, row_output);

struct output {
  struct eo_flexibility_report report;
  double bore_radius[2];
  struct eo_numbers eta, deflection[2];
  int rows;
  struct row_output row[MOST_ROWS];
};

static const struct eo_field output[] = {
    EO_OBJECT(struct output, report, "report", &report_table, "of the preparation"),
    EO_OUT_PAIR(struct output, bore_radius, "fixed_radius_mm", &eo_unit_mm,
                "[pinion, gear] where the sector ends inwards and is held"),
    EO_OUT_SERIES(struct output, eta, "eta_mm", &eo_unit_mm, "of the columns of rows"),
    EO_LIST(struct output, row, rows, "rows", &row_table, 0, MOST_ROWS, "under a uniform load on that row alone"),
    EO_OUT_SERIES(struct output, deflection[EO_PINION], "pinion_point_um", &eo_unit_um,
                  "normal deflection of the pinion's teeth at each of points under all of them"),
    EO_OUT_SERIES(struct output, deflection[EO_GEAR], "gear_point_um", &eo_unit_um, "likewise of the gear's"),
};
static const struct eo_table output_table = EO_TABLE("the output", struct output, output);

/* Trapezoidal rule with the nodes of the layers; compliance: scratch [n][n]. */
static void deflect_row(struct row_output *out, const struct eo_flexibility *flexibility, const struct eo_numbers *eta,
                        int layers, double width, struct eo_flank_point *point, double *compliance)
{
  int n = layers + 1 + eta->count;
  for (int i = 0; i < n; i++)
    point[i] = (struct eo_flank_point){
        0, {out->s, out->s}, i <= layers ? width * ((double)i / layers - 0.5) : eta->value[i - layers - 1]};
  for (int member = 0; member < 2; member++) {
    memset(compliance, 0, sizeof *compliance * (size_t)(n * n));
    eo_flexibility_add_compliance(flexibility, member, n, point, compliance);
    for (int i = 0; i < eta->count; i++)
      for (int j = 0; j <= layers; j++)
        out->member[member].value[i] += compliance[(layers + 1 + i) * n + j] * 1e3 * width / layers *
                                        (j == 0 || j == layers ? 0.5 : 1);
  }
}

static enum eo_code deflect_rows(struct output *found, const struct input *given,
                                 const struct eo_flexibility *flexibility, int layers, double width,
                                 struct eo_error *error)
{
  int n = layers + 1 + found->eta.count;
  struct eo_flank_point *point = calloc((size_t)n, sizeof *point);
  double *compliance = calloc((size_t)n * n, sizeof *compliance);
  enum eo_code code = point && compliance ? EO_OK : eo_error_memory(error);
  for (int i = 0; i < given->s.count && !code; i++) {
    found->row[i].s = given->s.value[i];
    found->rows = i + 1;
    code = eo_stage_columns(2, found->row[i].member, found->eta.count, error);
    if (!code)
      deflect_row(&found->row[i], flexibility, &found->eta, layers, width, point, compliance);
  }
  free(compliance);
  free(point);
  return code;
}

static enum eo_code deflect_points(struct output *found, const struct input *given,
                                   const struct eo_flexibility *flexibility, struct eo_error *error)
{
  int n = given->points;
  struct eo_flank_point *point = calloc((size_t)n + 1, sizeof *point);
  double *compliance = calloc((size_t)n * n + 1, sizeof *compliance);
  enum eo_code code = point && compliance ? eo_stage_columns(2, found->deflection, n, error) : eo_error_memory(error);
  for (int i = 0; i < n && !code; i++)
    point[i] =
        (struct eo_flank_point){given->point[i].pair, {given->point[i].s, given->point[i].s}, given->point[i].eta};
  for (int member = 0; member < 2 && !code; member++) {
    memset(compliance, 0, sizeof *compliance * (size_t)(n * n));
    eo_flexibility_add_compliance(flexibility, member, n, point, compliance);
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++)
        found->deflection[member].value[i] += compliance[i * n + j] * given->point[j].force;
  }
  free(compliance);
  free(point);
  return code;
}

static int write_text(void *context, const char *text, size_t length)
{
  struct eo_text *all = context;
  eo_text_add_bytes(all, text, length);
  return all->failed;
}

static enum eo_code export_mesh(const struct input *given, const struct eo_design *design,
                                const struct eo_geometry *geometry, const struct eo_flexibility_settings *settings,
                                struct eo_error *error)
{
  const struct mesh_input *mesh = &given->mesh;
  if (mesh->row > settings->flank_rows)
    return eo_error_set(error, EO_ERROR_INPUT, "/mesh/row", "The flank has rows 0 to %d.", settings->flank_rows);
  struct eo_member_settings member = eo_flexibility_member_settings(settings, geometry, &design->gear_pair,
                                                                    mesh->member);
  struct eo_mesh_load *load = calloc((size_t)settings->layers + 1, sizeof *load);
  struct eo_text text = {0};
  if (!load)
    return eo_error_memory(error);
  for (int l = 0; l <= settings->layers; l++)
    load[l] = (struct eo_mesh_load){
        mesh->row, l, 1e3 * geometry->face_width / settings->layers * (l == 0 || l == settings->layers ? 0.5 : 1)};
  struct eo_mesh_case row = {settings->layers + 1, load};
  enum eo_code code = eo_mesh_export(geometry, mesh->member, &design->material, &member, mesh->element, 1, &row,
                                     write_text, &text, error);
  if (!code)
    code = eo_text_save(&text, mesh->file, error);
  eo_text_done(&text);
  free(load);
  return code;
}

static enum eo_code choose_places(struct eo_numbers *eta, const struct eo_numbers *given, double width,
                                  struct eo_error *error)
{
  const double usual[3] = {-width / 2, 0, width / 2};
  return given->count ? eo_stage_copy(eta, given->count, given->value, error) : eo_stage_copy(eta, 3, usual, error);
}

static enum eo_code deflect(struct output *found, const struct input *given, const struct eo_flexibility *flexibility,
                            const struct eo_geometry *geometry, int layers, struct eo_error *error)
{
  found->report = *eo_flexibility_report(flexibility);
  EO_TRY(choose_places(&found->eta, &given->eta, geometry->face_width, error));
  EO_TRY(deflect_rows(found, given, flexibility, layers, geometry->face_width, error));
  return deflect_points(found, given, flexibility, error);
}

static enum eo_code run(const void *in, void *out, struct eo_error *error)
{
  const struct input *given = in;
  struct output *found = out;
  struct eo_design design = given->design;
  struct eo_geometry geometry;
  struct eo_flexibility *flexibility = NULL;
  EO_TRY(eo_stage_complete(&design, &geometry, EO_LEFT, error));
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design.resolution);
  for (int i = 0; i < 2; i++)
    found->bore_radius[i] = eo_flexibility_bore_radius(&settings, &geometry, &design.gear_pair, i);
  if (given->export)
    EO_TRY(export_mesh(given, &design, &geometry, &settings, error));
  EO_TRY(eo_stage_prepare(&design, &given->kernel, &flexibility, error));
  enum eo_code code = deflect(found, given, flexibility, &geometry, settings.layers, error);
  eo_flexibility_free(flexibility);
  return code;
}

const struct eo_stage eo_stage_flexibility = {
    "flexibility", "finite-element compliance of the teeth, without the local part",
    &input_table,  &output_table,
    true,          run};
