/* The documents of the API in the short notation of shape.h; designs and geometry come from their field tables. */
#include <string.h>

#include "document/design_document.h"
#include "document/geometry_table.h"
#include "document/rig_document.h"
#include "document/schema.h"
#include "document/sweep_document.h"
#include "http/openapi.h"
#include "http/shape.h"

static const struct { const char *name, *notation; } shapes[] = {
    {"Any", "{...}"},
    {"Problem", "{type text, title text, status integer, detail text, errors [{pointer text, detail text}], request_id text, ...}"},
    {"Health", "{status 'ok|failing', program text, uptime_s number, jobs {queued integer, running integer}, database 'ok|failing'}"},
    {"Session", "{required flag, authorized flag}"},
    {"Token", "{token text}"},
    {"Examples", "{items [{name text, title text}]}"},
    {"Exports", "{items [{name text, title text, type text}]}"},
    {"Form", "{design Fields, sweep Fields}"},
    {"Fields", "{name text, fields [{key text, kind 'number|integer|seed|flag|text|choice|numbers|limit|object|list|series', help text, ...}], ...}"},
    {"Check", "{design ResolvedDesign, geometry Geometry, warnings [text], prepared flag}"},
    {"DesignOrNamed", "{name? any, design? Design, ...}"},
    {"StoredDesign", "{id integer, revision integer, name text, created text, updated text, design Design, warnings [text]}"},
    {"Designs", "{items [{id integer, revision integer, name text, created text, updated text}], next text?}"},
    {"Result", "{program text, design ResolvedDesign, design_hash text, evaluation_hash text, resolution Any, geometry Geometry, load_cases [Any],"
               " objectives Any, eigenfrequencies_Hz [number], warnings [text], timing_ms Any, ...}"},
    {"Preparing", "{job Job?}"},
    {"Sweep", "{program text, design ResolvedDesign, design_hash text, torque_Nm [number], speed_rpm [number], modified Any, unmodified Any, ...}"},
    {"Objectives", "{J number?, f1_um number?, f2_N number?, f3_m_per_s2 number?, fitness number?, ...}"},
    {"Job", "{id integer, kind 'optimize|prepare', name text, algorithm text?, state 'queued|preparing|running|done|failed|cancelled', priority integer,"
            " created text, started text?, finished text?,"
            " progress {fraction number?, what text?, generation integer?, true_evaluations integer?, predicted integer?, reused integer?, individuals integer?,"
            " pfc_percent number?, seconds number?, seconds_left number?, ...},"
            " best Objectives?, unmodified Objectives?, error {detail text, ...}?, design? Any, ...}"},
    {"Jobs", "{items [Job], next text?}"},
    {"JobOrder", "{kind? 'optimize|prepare', design Design, priority? integer, fresh? flag}"},
    {"JobChange", "{priority? integer}"},
    {"OptimizationResult", "{program text, design ResolvedDesign, algorithm text, best Any?, unmodified Any, individuals integer, true_evaluations integer,"
                           " pfc_percent number?, generations any, stopped text, ...}"},
    {"Generations", "{generation [integer], best [number?], mean [number?], true_evaluations [integer], predicted [integer], pfc_percent [number?]}"},
    {"JobHistory", "{items [{ordinal integer, generation integer, individual integer, outcome text, reason text?, modification Any, f1_um number?,"
                   " f2_N number?, f3_m_per_s2 number?, J number?, fitness number?, violation number?, reused flag}], next text?}"},
    {"MeasurementForm", "{design text, label 'modified|unmodified', torque_Nm text, speed_rpm? text, end? 'left|right', harmonics? text, layout? text,"
                        " file any}"},
    {"Finding", "{kind text, severity 'note|repaired|warning|refused', channel? text?, row? integer?, line? integer?, value? number?, text text}"},
    {"MeasurementFiles", "[{name text, size integer, sha256 text}]"},
    {"Measurement", "{id integer, design integer, created text, stated_speed_rpm number?, asked_layout any, files MeasurementFiles, file text,"
                    " label 'unmodified|modified', torque_Nm number, end 'left|right', notes [text], layout any, findings [Finding], refused flag, signal Any,"
                    " result Any, ...}"},
    {"Measurements", "{items [{id integer, design integer, created text, stated_speed_rpm number?, asked_layout any, files MeasurementFiles, file text,"
                     " label 'unmodified|modified', torque_Nm number, end 'left|right', findings [Finding], refused flag, result Any, ...}], next text?}"},
    {"LeftOut", "[{id integer, reason text}]"},
    {"Comparison", "{program text, design_hash text, id [integer], left_out LeftOut, measurements Any, details [Any], reductions [Any], ratio number?,"
                   " spread number?, ...}"},
    {"FitOrder", "{unknowns {...}, model_error? number, seed? integer, measurements? [integer], design? Design}"},
    {"Fit", "{unknowns [Any], correlation any, condition number?, misfit Any, measurements integer, orders integer, evaluations integer, converged flag,"
            " warnings [text], id [integer], left_out LeftOut, design Any, ...}"},
    {"History", "{problems [Any], jobs [Any]}"},
};

/* A design, and the axes to sweep; torque and speed are taken as shorter keys too. */
static json_t *sweep_request(void)
{
  json_t *schema = eo_table_json_schema(&eo_sweep_request_table, true), *properties = json_object_get(schema, "properties");
  json_t *design = json_pack("{s:s}", "$ref", "#/components/schemas/Design");
  static const char *const full[] = {"torque_Nm", "speed_rpm"}, *const brief[] = {"torque", "speed"};
  for (int i = 0; i < 2; i++) {
    json_t *axis = json_pack("{s:[O, {s:s}]}", "anyOf", json_object_get(properties, full[i]), "type", "null");
    json_object_set(properties, brief[i], axis);
    json_object_set_new(properties, full[i], axis);
  }
  if (json_object_set_new(properties, "design", design) == 0 && json_object_set_new(schema, "required", json_pack("[s]", "design")) == 0)
    return schema;
  json_decref(schema);
  return NULL;
}

/* A design, and the keys of eo_rig_table. */
static json_t *rig_order(void)
{
  return json_pack("{s:s, s:{s:{s:s}, s:o}, s:[s], s:b}", "type", "object", "properties", "design", "$ref", "#/components/schemas/Design", "rig",
                   eo_table_json_schema(&eo_rig_table, true), "required", "design", "additionalProperties", 0);
}

json_t *eo_openapi_schemas(void)
{
  json_t *schemas = json_object();
  bool failed = json_object_set_new(schemas, "Design", eo_table_json_schema(&eo_design_table, true)) != 0;
  failed = json_object_set_new(schemas, "ResolvedDesign", eo_table_json_schema(&eo_design_table, false)) != 0 || failed;
  failed = json_object_set_new(schemas, "Geometry", eo_table_json_schema(&eo_geometry_table, false)) != 0 || failed;
  failed = json_object_set_new(schemas, "SweepRequest", sweep_request()) != 0 || failed;
  failed = json_object_set_new(schemas, "RigOrder", rig_order()) != 0 || failed;
  for (size_t i = 0; i < sizeof shapes / sizeof shapes[0]; i++)
    failed = json_object_set_new(schemas, shapes[i].name, eo_shape_schema(shapes[i].notation)) != 0 || failed;
  if (!failed)
    return schemas;
  json_decref(schemas);
  return NULL;
}
