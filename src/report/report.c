/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/report.h"

#include <stdlib.h>
#include <string.h>

#include "document/flank_chart.h"
#include "document/flank_grid_document.h"
#include "document/geometry_table.h"
#include "document/result.h"
#include "format/json.h"
#include "format/plot.h"
#include "report/figures.h"
#include "report/page.h"
#include "report/sheet.h"

static const char *find_text(const json_t *value, const char *path)
{
  const char *text = json_string_value(eo_json_find(value, path));
  return text ? text : "";
}

static void put_identity(const json_t *result, const struct eo_page *page)
{
  const char *name = find_text(result, "design/name");
  eo_text_add(page->text, "<h1>");
  eo_text_add_escaped(page->text, *name ? name : "A gear pair without a name");
  eo_text_add(page->text, "</h1>\n<p>Report of load capacity, contact and flanks, made by ");
  eo_text_add_escaped(page->text, find_text(result, "program"));
  eo_text_print(page->text,
                "</p>\n<p class=\"hash\">design %s<br>evaluation %s</p>\n"
                "<p>The design's hash is the SHA-256 of its canonical document (keys sorted, no spaces): the same hash "
                "is the same design, and the same program gives the same report.</p>\n",
                find_text(result, "design_hash"), find_text(result, "evaluation_hash"));
}

static void put_verdict(const json_t *result, const struct eo_page *page)
{
  const json_t *rating = json_object_get(result, "rating"), *passes = eo_json_find(rating, "verdict/passes");
  const struct eo_outline *outline = eo_sheet_part(&eo_result_outline, "rating");
  eo_page_heading(page, 2, "Verdict");
  if (json_is_true(passes))
    eo_text_add(page->text, "<p class=\"yes\">Every safety reaches its minimum.</p>\n");
  else if (json_is_false(passes))
    eo_text_add(page->text, "<p class=\"no\">A safety does not reach its minimum.</p>\n");
  else {
    eo_text_add(page->text, "<p class=\"no\">Not rated: ");
    eo_text_add_escaped(page->text, find_text(rating, "reason"));
    eo_text_add(page->text, "</p>\n");
  }
  eo_sheet_outline(page, eo_sheet_part(outline, "verdict"), json_object_get(rating, "verdict"), 3, NULL);
  if (json_array_size(json_object_get(result, "warnings"))) {
    eo_page_heading(page, 3, "Warnings");
    eo_page_list(page, json_object_get(result, "warnings"));
  }
}

static void put_inputs(const json_t *result, const struct eo_design *from, const struct eo_page *page)
{
  const struct eo_sheet_source source = {from, json_object_get(result, "assumed")};
  json_t *design = json_copy(json_object_get(result, "design"));
  json_object_del(design, "optimization"); /* how a flank was searched for is nothing to sign */
  eo_page_heading(page, 2, "Inputs");
  eo_sheet_groups(page, &eo_design_table, design, &source);
  json_decref(design);
  if (!eo_json_find(result, "design/rating")) {
    eo_page_heading(page, 3, "Inputs of the rating");
    eo_sheet_table(page, &eo_rating_table, eo_json_find(result, "rating/settings"), "/rating", &source);
  }
}

static void put_standards(const json_t *result, const struct eo_page *page)
{
  eo_page_heading(page, 2, "Standards and methods");
  eo_page_list(page, eo_json_find(result, "rating/standards"));
  eo_page_list(page, eo_json_find(result, "tribology/methods"));
  eo_page_heading(page, 3, "Unchecked");
  eo_page_paragraph(page, "Neither the standard's own text nor a published report was at hand for these; they must be "
                          "checked before somebody signs on them alone.");
  eo_page_list(page, eo_json_find(result, "rating/unchecked"));
}

static void put_geometry(const json_t *result, const struct eo_page *page)
{
  eo_page_heading(page, 2, "Geometry");
  eo_sheet_table(page, &eo_geometry_table, json_object_get(result, "geometry"), "/geometry", NULL);
  if (json_is_object(json_object_get(result, "right_geometry"))) {
    eo_page_heading(page, 3, "Right end");
    eo_sheet_table(page, &eo_geometry_table, json_object_get(result, "right_geometry"), "/right_geometry", NULL);
  }
  if (json_is_object(json_object_get(result, "dimensions"))) {
    eo_page_heading(page, 3, "Dimensions of the drawing");
    eo_sheet_outline(page, eo_sheet_part(&eo_result_outline, "dimensions"), json_object_get(result, "dimensions"), 4,
                     NULL);
  }
  if (json_is_object(json_object_get(result, "right_dimensions"))) {
    eo_page_heading(page, 3, "Dimensions of the drawing, right end");
    eo_sheet_outline(page, eo_sheet_part(&eo_result_outline, "right_dimensions"),
                     json_object_get(result, "right_dimensions"), 4, NULL);
  }
  eo_page_heading(page, 3, "Flexibility");
  eo_sheet_outline(page, eo_sheet_part(&eo_result_outline, "flexibility"), json_object_get(result, "flexibility"), 4,
                   NULL);
}

static void put_flanks(const struct eo_design *design, const struct eo_geometry *geometry, const struct eo_page *page)
{
  struct eo_flank_chart *chart = malloc(sizeof *chart);
  page->text->failed = page->text->failed || !chart;
  eo_page_heading(page, 2, "Flanks");
  eo_page_paragraph(page,
                    "Nominal profile and helix; a modification takes metal off and lies below 0. The band is the "
                    "total tolerance, centred on the nominal curve: a measured trace may be moved across it, only "
                    "its shape and slope count.");
  int ends = design->gear_pair.ends, charts = 4 * ends * (eo_design_shows_coast(design) ? 2 : 1);
  for (int i = 0; i < charts && chart; i++) {
    bool helix = i % 2 == 1;
    int end = i / 2 % ends, member = i / 2 / ends % 2;
    enum eo_flank_side side = (enum eo_flank_side)(i / 4 / ends);
    eo_flank_chart_find(chart, design, geometry, side, member, end, helix);
    eo_flank_chart_svg(chart, design, page->inches, page->text);
    if (*chart->note && !helix && !end && side == EO_DRIVE_FLANK)
      eo_page_paragraph(page, chart->note);
  }
  free(chart);
}

static void put_contact(const json_t *result, const struct eo_page *page)
{
  static const char *const elsewhere[] = {"position", NULL};
  const struct eo_outline *outline = eo_sheet_part(&eo_result_outline, "load_cases");
  const json_t *cases = json_object_get(result, "load_cases");
  eo_page_heading(page, 2, "Contact, stress and vibration");
  eo_figure_transmission(result, page);
  eo_figure_stiffness(result, page);
  eo_figure_face_load(result, page);
  eo_figure_maps(result, page);
  for (size_t i = 0; i < json_array_size(cases); i++) {
    const json_t *load_case = json_array_get(cases, i);
    eo_text_print(page->text, "<h3>%.6g N m, %.6g rpm <code>load_cases/%zu</code></h3>\n",
                  eo_json_find_number(load_case, "torque_Nm"), eo_json_find_number(load_case, "speed_rpm"), i);
    eo_sheet_outline(page, outline, load_case, 4, elsewhere);
  }
  eo_page_heading(page, 3, "Objectives");
  eo_sheet_outline(page, eo_sheet_part(&eo_result_outline, "objectives"), json_object_get(result, "objectives"), 4,
                   NULL);
}

static void put_rating(const json_t *result, const struct eo_page *page)
{
  static const char *const above[] = {"outcome", "reason", "settings", "standards", "unchecked", "verdict", NULL};
  eo_page_heading(page, 2, "Rating");
  eo_sheet_outline(page, eo_sheet_part(&eo_result_outline, "rating"), json_object_get(result, "rating"), 3, above);
}

static void put_tribology(const json_t *result, const struct eo_page *page)
{
  eo_page_heading(page, 2, "Tribology");
  eo_sheet_outline(page, eo_sheet_part(&eo_result_outline, "tribology"), json_object_get(result, "tribology"), 3, NULL);
}

/* Nothing where the design states no single teeth. */
static void put_pitch(const json_t *result, const struct eo_page *page)
{
  const json_t *pitch = json_object_get(result, "pitch");
  if (!json_is_object(pitch))
    return;
  eo_page_heading(page, 2, "Single teeth over the hunting period");
  eo_sheet_outline(page, eo_sheet_part(&eo_result_outline, "pitch"), pitch, 3, NULL);
}

/* result: spelt as the page is. */
static void put_all(const json_t *result, const struct eo_design *design, const struct eo_geometry *geometry,
                    const struct eo_page *page)
{
  const char *name = find_text(result, "design/name");
  eo_page_begin(page, *name ? name : "Easeoff");
  put_identity(result, page);
  put_verdict(result, page);
  put_inputs(result, design, page);
  put_standards(result, page);
  put_geometry(result, page);
  put_flanks(design, geometry, page);
  put_rating(result, page);
  put_tribology(result, page);
  put_pitch(result, page);
  put_contact(result, page);
  eo_page_end(page);
}

/* From a result document of that design (with rating), which is in mm; the result is read alone. */
static void write_page(const json_t *result, const struct eo_design *design, const struct eo_geometry *geometry,
                       const struct eo_page *page)
{
  json_t *spelt = page->inches ? eo_inch_from_mm(result) : NULL;
  if (page->inches && !spelt)
    page->text->failed = true;
  else
    put_all(spelt ? spelt : result, design, geometry, page);
  json_decref(spelt);
}

static enum eo_code write_report(const struct eo_analysis *analysis, const struct eo_design *design,
                                 const struct eo_warnings *warnings, const struct eo_page *page, struct eo_error *error)
{
  json_t *result = eo_result_encode_part(analysis, design, warnings, EO_RESULT_NO_HISTORIES | EO_RESULT_NO_PITCH);
  if (!result)
    return eo_error_memory(error);
  write_page(result, design, &analysis->pair->geometry, page);
  json_decref(result);
  return page->text->failed ? eo_error_memory(error) : EO_OK;
}

enum eo_code eo_report_make(const struct eo_pair *pair, const struct eo_design *design,
                            const struct eo_warnings *warnings, const struct eo_progress *progress,
                            const struct eo_page *page, struct eo_error *error)
{
  struct eo_analysis *analysis;
  EO_TRY(eo_analysis_new(&analysis, pair, error));
  analysis->progress = progress;
  enum eo_code code = eo_analysis_run(
      analysis, design, EO_WANT_ROOT | EO_WANT_BAND | EO_WANT_CURVES | EO_WANT_RATING | EO_WANT_PITCH, error);
  if (!code && eo_progress_report(progress, "report", 1))
    code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
  if (!code)
    code = write_report(analysis, design, warnings, page, error);
  eo_analysis_free(analysis);
  return code;
}
