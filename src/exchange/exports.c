/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/exports.h"

#include <stdlib.h>
#include <string.h>

#include "document/design_document.h"
#include "exchange/rexs_export.h"
#include "exchange/step.h"
#include "exchange/stl.h"
#include "exchange/table_export.h"

static void write_rexs(const struct eo_design *design, const struct eo_geometry *geometry, int version,
                       enum eo_rexs_form form, struct eo_text *text)
{
  struct eo_rexs_model *model = calloc(1, sizeof *model);
  if (!model) {
    text->failed = true;
    return;
  }
  eo_rexs_export(design, geometry, version, true, model);
  eo_rexs_write(model, form, text);
  eo_rexs_done(model);
  free(model);
}

static void write_xml(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  write_rexs(design, geometry, EO_REXS_EXPORT_VERSION, EO_REXS_XML, text);
}

static void write_json(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  write_rexs(design, geometry, EO_REXS_EXPORT_VERSION, EO_REXS_JSON, text);
}

static void write_zip(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  write_rexs(design, geometry, EO_REXS_EXPORT_VERSION, EO_REXS_ZIP, text);
}

static void write_newest(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  write_rexs(design, geometry, 200, EO_REXS_XML, text);
}

static void write_newest_json(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  write_rexs(design, geometry, 200, EO_REXS_JSON, text);
}

#define STEP(name, member, whole)                                                                                    \
  static void write_##name(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text) \
  {                                                                                                                  \
    eo_step_write(design, geometry, member, whole, text);                                                            \
  }
STEP(pinion_tooth, EO_PINION, false)
STEP(gear_tooth, EO_GEAR, false)
STEP(pinion_teeth, EO_PINION, true)
STEP(gear_teeth, EO_GEAR, true)

static void write_pinion_stl(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  eo_stl_write(design, geometry, EO_PINION, text);
}

static void write_gear_stl(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text)
{
  eo_stl_write(design, geometry, EO_GEAR, text);
}

static void write_table(const struct eo_design *design, enum eo_table_layout layout, struct eo_text *text)
{
  json_t *document = eo_design_encode(design);
  const json_t *const documents[] = {document};
  if (document)
    eo_table_write(documents, 1, layout, text);
  text->failed = text->failed || !document;
  json_decref(document);
}

#define TABLE(name, layout)                                                                                          \
  static void write_##name(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text) \
  {                                                                                                                  \
    (void)geometry;                                                                                                  \
    write_table(design, layout, text);                                                                               \
  }
TABLE(point_table, EO_TABLE_POINT)
TABLE(comma_table, EO_TABLE_COMMA)
TABLE(workbook, EO_TABLE_WORKBOOK)
TABLE(rows, EO_TABLE_ROWS)

static const struct eo_export formats[] = {
    {"rexs", "the pair as a REXS 1.7 model, for other gear programs", "application/xml", "rexs", write_xml, NULL},
    {"rexs-json", "the same as JSON", "application/json", "rexsj", write_json, NULL},
    {"rexs-zip", "the same in a zip archive", "application/zip", "rexsz", write_zip, NULL},
    {"rexs-2.0.0", "the pair as a REXS 2.0.0 model", "application/xml", "rexs", write_newest, NULL},
    {"rexs-2.0.0-json", "the same as JSON", "application/json", "rexsj", write_newest_json, NULL},
    {"step-pinion", "one tooth of each end of the pinion for CAD: B-spline faces within 5 nm, STEP AP242", "model/step",
     "step", write_pinion_tooth, NULL},
    {"step-gear", "the same of the gear", "model/step", "step", write_gear_tooth, NULL},
    {"step-pinion-whole", "all teeth of the pinion", "model/step", "step", write_pinion_teeth, NULL},
    {"step-gear-whole", "all teeth of the gear", "model/step", "step", write_gear_teeth, NULL},
    {"stl-pinion", "the pinion as a closed surface of triangles, for view and print", "model/stl", "stl",
     write_pinion_stl, NULL},
    {"stl-gear", "the gear as a closed surface of triangles, for view and print", "model/stl", "stl", write_gear_stl,
     NULL},
    {"table", "the design as a table key;pinion;gear;unit for spreadsheets, read back by easeoff import",
     "text/csv; charset=utf-8", "csv", write_point_table, NULL},
    {"table-comma", "the same with decimal comma", "text/csv; charset=utf-8", "csv", write_comma_table, NULL},
    {"workbook", "the same as .xlsx", "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet", "xlsx",
     write_workbook, NULL},
    {"table-rows", "one design per row below its keys", "text/csv; charset=utf-8", "csv", write_rows, NULL},
};
enum { FORMATS = sizeof formats / sizeof formats[0] };

const struct eo_export *eo_exports_at(int index)
{
  int before = 0;
  while (eo_export_at(before))
    before++;
  if (index < before)
    return eo_export_at(index);
  return index - before < FORMATS ? &formats[index - before] : NULL;
}

const struct eo_export *eo_exports_find(const char *name)
{
  for (int i = 0; i < FORMATS; i++)
    if (strcmp(formats[i].name, name) == 0)
      return &formats[i];
  return eo_export_find(name);
}

void eo_exports_tell(const struct eo_export *format, const struct eo_text *file, struct eo_text *notes)
{
  const char *end;
  if (strcmp(format->type, "model/step") != 0 || file->failed)
    return;
  for (const char *at = strstr(file->data, "/* "); at && (end = strstr(at, " */")); at = strstr(end, "/* ")) {
    eo_text_add_bytes(notes, at + 3, (size_t)(end - at - 3));
    eo_text_add(notes, "\n");
  }
}

enum eo_code eo_exports_write_many(const struct eo_export *format, const json_t *const *documents, int count,
                                   struct eo_text *text, struct eo_error *error)
{
  static const struct {
    const char *name;
    enum eo_table_layout layout;
  } tables[] = {{"table", EO_TABLE_POINT},
                {"table-comma", EO_TABLE_COMMA},
                {"workbook", EO_TABLE_WORKBOOK},
                {"table-rows", EO_TABLE_ROWS}};
  for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
    if (strcmp(tables[i].name, format->name) == 0) {
      eo_table_write(documents, count, tables[i].layout, text);
      return EO_OK;
    }
  return eo_error_set(error, EO_ERROR_INPUT, "",
                      "The format \"%s\" takes one design; several go into table, table-comma, table-rows or workbook.",
                      format->name);
}
