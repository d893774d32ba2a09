/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "http/schemas.h"

#include <string.h>

#include "document/design_document.h"
#include "document/geometry_table.h"
#include "document/measurement_document.h"
#include "document/result.h"
#include "document/sweep_document.h"
#include "document/tolerance_document.h"
#include "exchange/import.h"
#include "document/update_document.h"
#include "format/schema.h"
#include "document/study_result.h"
#include "http/answers.h"
#include "http/reply.h"
#include "http/route.h"
#include "reproduction/reproduction.h"
#include "variants/variant_cost.h"
#include "variants/variant_table.h"
#include "study/job_document.h"
#include "study/job_history.h"
#include "study/history_document.h"
#include "study/history_prune.h"
#include "document/rig_answer.h"

static const struct eo_outline_row description_rows[] = {
    EO_KEY("openapi", "text", "version of OpenAPI"), EO_KEY("info", "any", "as OpenAPI says"),
    EO_KEY("servers", "any", "as OpenAPI says"),     EO_KEY("security", "any", "as OpenAPI says"),
    EO_KEY("paths", "any", "as OpenAPI says"),       EO_KEY("components", "any", "as OpenAPI says"),
};
static const struct eo_outline description = EO_OUTLINE("Description", description_rows);

static const struct eo_outline *const outlines[] = {&eo_result_outline,
                                                    &eo_sweep_outline,
                                                    &eo_tolerance_outline,
                                                    &eo_study_outline,
                                                    &eo_job_outline,
                                                    &eo_pruned_outline,
                                                    &eo_job_generations_outline,
                                                    &eo_job_history_outline,
                                                    &eo_records_outline,
                                                    &eo_rig_comparison_outline,
                                                    &eo_rig_fit_outline,
                                                    &eo_measurement_outline,
                                                    &eo_measurement_brief,
                                                    &description,
                                                    &eo_outline_problem,
                                                    &eo_outline_health,
                                                    &eo_outline_live,
                                                    &eo_outline_session,
                                                    &eo_outline_examples,
                                                    &eo_outline_exports,
                                                    &eo_outline_form,
                                                    &eo_outline_check,
                                                    &eo_outline_stored_design,
                                                    &eo_outline_designs,
                                                    &eo_outline_preparing,
                                                    &eo_outline_jobs,
                                                    &eo_outline_job_files,
                                                    &eo_reproduction_outline,
                                                    &eo_outline_job_history_page,
                                                    &eo_outline_problem_rows,
                                                    &eo_outline_stored,
                                                    &eo_outline_stored_measurement,
                                                    &eo_outline_listed_measurement,
                                                    &eo_outline_measurements,
                                                    &eo_variant_table_outline,
                                                    &eo_variant_columns_outline,
                                                    &eo_variant_cost_outline,
                                                    &eo_import_outline};

/* What a fit takes, with what it works on. */
static json_t *fit_order(void)
{
  json_t *schema = eo_table_json_schema(&eo_update_table, true), *more = json_object_get(schema, "properties");
  bool good = json_object_set_new(more, "measurements",
                                  json_pack("{s:s, s:{s:s}}", "type", "array", "items", "type", "integer")) == 0 &&
              json_object_set_new(more, "design", json_pack("{s:s}", "$ref", "#/components/schemas/Design")) == 0 &&
              json_object_set_new(schema, "required", json_pack("[s]", "unknowns")) == 0;
  return good ? schema : (json_decref(schema), NULL);
}

/* Bytes of a recording; the name of the part may come twice. */
static json_t *file_part(void)
{
  return json_pack("{s:s, s:s, s:s}", "type", "string", "format", "binary", "description",
                   "the recording as it is, of any kind that is read; twice where each encoder has its own file, the "
                   "pinion's first");
}

/* What a route takes, under the last of its names; a form has files too. */
static bool add_order(json_t *schemas, const struct eo_route *route)
{
  const char *other = strrchr(route->takes, '|');
  json_t *schema = eo_table_json_schema(route->order, true);
  bool good = !route->form || (json_object_set_new(json_object_get(schema, "properties"), "file", file_part()) == 0 &&
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
  good = good && json_object_set_new(schemas, "FitOrder", fit_order()) == 0;
  if (good)
    return schemas;
  json_decref(schemas);
  return NULL;
}
