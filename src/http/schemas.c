#include "http/schemas.h"

#include <string.h>

#include "document/design_document.h"
#include "document/geometry_table.h"
#include "document/measurement_document.h"
#include "document/result.h"
#include "document/sweep_document.h"
#include "format/schema.h"
#include "document/study_result.h"
#include "http/route.h"
#include "http/shape.h"
#include "study/job_document.h"
#include "study/job_history.h"
#include "study/history_document.h"
#include "document/rig_answer.h"

static const struct {
  const char *name, *notation;
} shapes[] = {
    {"Description", "{openapi text, info any, servers any, security any, paths any, components any}"},
    {"Problem",
     "{type text, title text, status integer, detail text, errors [{pointer text, detail text}], request_id text,"
     " findings? [Finding], notes? [text], layout? Layout?, signal? Signal, ...}"},
    {"Health", "{status 'ok|failing', program text, uptime_s number, jobs {queued integer, running integer}, database "
               "'ok|failing', warnings [text]}"},
    {"Session", "{required flag, authorized flag}"},
    {"Examples", "{items [{name text, title text}]}"},
    {"Exports", "{items [{name text, title text, type text}]}"},
    {"Form", "{design Fields, sweep Fields}"},
    {"Fields", "{name text, fields [Field]}"},
    {"Field", "{key text, kind 'number|integer|seed|flag|text|choice|numbers|limit|object|list|series', unit? text, "
              "symbol? text, low? number, high? number,"
              " number_low? number, number_high? number, count? integer, default? any, choices? [text], help? text, "
              "required flag, nullable flag,"
              " derived? text, fields? [Field]}"},
    {"Check", "{design ResolvedDesign, geometry Geometry, warnings [text], prepared flag}"},
    {"StoredDesign",
     "{id integer, revision integer, name text, created text, updated text, design Design, warnings [text]}"},
    {"Designs", "{items [{id integer, revision integer, name text, created text, updated text}], next text?}"},
    {"Preparing", "{job Job?}"},
    {"Jobs", "{items [Job], next text?}"},
    {"JobHistory", "{items [JobHistoryRow], next text?}"},
    {"AskedLayout", "{kind? text, unit? text, time? any, time_unit? text, columns? {pinion? any, gear? any}, "
                    "sample_rate_Hz? number?, lines? any}"},
    {"Stored", "{id integer, design integer, created text, stated_speed_rpm number?, asked_layout AskedLayout?,"
               " files [{name text, size integer, sha256 text}]}"},
    {"Measurements", "{items [ListedMeasurement], next text?}"},
    {"FitOrder", "{unknowns {}, model_error? number, seed? integer, measurements? [integer], design? Design}"},
};

static const struct eo_outline *const outlines[] = {
    &eo_result_outline,          &eo_sweep_outline,       &eo_study_outline,    &eo_job_outline,
    &eo_job_generations_outline, &eo_job_history_outline, &eo_records_outline,  &eo_rig_comparison_outline,
    &eo_rig_fit_outline,         &eo_measurement_outline, &eo_measurement_brief};

/* A stored measurement is what was measured, behind what is known of its storage. */
static json_t *stored(const json_t *schemas, const char *measured)
{
  const json_t *inner = json_object_get(schemas, measured);
  json_t *schema = json_deep_copy(json_object_get(schemas, "Stored"));
  bool good = json_object_update(json_object_get(schema, "properties"), json_object_get(inner, "properties")) == 0 &&
              json_array_extend(json_object_get(schema, "required"), json_object_get(inner, "required")) == 0 &&
              json_object_del(schema, "additionalProperties") == 0;
  return good ? schema : (json_decref(schema), NULL);
}

/* Any of the inputs that can be fitted, each with its range. */
static json_t *fit_order(const json_t *plain)
{
  json_t *schema = json_deep_copy(plain),
         *unknowns = json_object_get(json_object_get(schema, "properties"), "unknowns");
  for (int i = 0; eo_unknown_names[i]; i++)
    json_object_set_new(json_object_get(unknowns, "properties"), eo_unknown_names[i],
                        json_pack("{s:s, s:{s:s}, s:i, s:i, s:s}", "type", "array", "items", "type", "number",
                                  "minItems", 2, "maxItems", 2, "description", "lowest, highest"));
  return schema;
}

/* What a route takes, under the last of its names; a form has files too. */
static bool add_order(json_t *schemas, const struct eo_route *route)
{
  const char *other = strrchr(route->takes, '|');
  json_t *schema = eo_table_json_schema(route->order, true);
  bool good = !route->form || (json_object_set_new(json_object_get(schema, "properties"), "file", json_object()) == 0 &&
                               json_array_append_new(json_object_get(schema, "required"), json_string("file")) == 0);
  return json_object_set_new(schemas, other ? other + 1 : route->takes, schema) == 0 && good;
}

static bool add_orders(json_t *schemas, const struct eo_route *const *routes)
{
  bool good = true;
  for (; *routes; routes++)
    for (const struct eo_route *route = *routes; route->pattern && good; route++)
      good = !route->order || add_order(schemas, route);
  return good;
}

json_t *eo_openapi_schemas(const struct eo_route *const *routes)
{
  json_t *schemas = json_object();
  bool good = json_object_set_new(schemas, "Design", eo_table_json_schema(&eo_design_table, true)) == 0 &&
              add_orders(schemas, routes);
  for (size_t i = 0; i < sizeof outlines / sizeof outlines[0]; i++)
    good = good && eo_outline_add_schemas(outlines[i], schemas);
  for (size_t i = 0; i < sizeof shapes / sizeof shapes[0]; i++)
    good = good && json_object_set_new(schemas, shapes[i].name, eo_shape_schema(shapes[i].notation)) == 0;
  good = good && json_object_set_new(schemas, "Measurement", stored(schemas, "MeasurementOfFile")) == 0 &&
         json_object_set_new(schemas, "ListedMeasurement", stored(schemas, "BriefMeasurement")) == 0;
  good = good && json_object_set_new(schemas, "FitOrder", fit_order(json_object_get(schemas, "FitOrder"))) == 0;
  if (good)
    return schemas;
  json_decref(schemas);
  return NULL;
}
