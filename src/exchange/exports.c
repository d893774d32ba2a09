/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "exchange/exports.h"

#include <stdlib.h>
#include <string.h>

#include "exchange/rexs_export.h"
#include "exchange/step.h"
#include "exchange/stl.h"

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
