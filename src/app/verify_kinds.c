/* All kinds of case files, and the bridges to those that report in their own way. */
#include <math.h>

#include "app/verify.h"
#include "app/verify_contact.h"
#include "app/verify_dynamics.h"
#include "app/verify_evaluation.h"
#include "app/verify_optimizer.h"

static void add_judged(void *context, const struct eo_verify_row *row)
{
  eo_verify_judged(context, row->name, row->quantity, row->value, row->expected, row->tolerance, row->pass);
}

static enum eo_code run_optimizer(const json_t *cases, struct eo_verification *v, struct eo_error *error)
{
  return eo_verify_optimizer((json_t *)cases, add_judged, v, error);
}

static enum eo_code run_dynamics(const json_t *cases, struct eo_verification *v, struct eo_error *error)
{
  json_t *rows = json_array(), *row;
  size_t i;
  enum eo_code code = rows ? eo_verify_dynamics(cases, rows, error) : eo_error_memory(error);
  json_array_foreach(rows, i, row)
    eo_verify_judged(v, json_string_value(json_object_get(row, "case")), json_string_value(json_object_get(row, "quantity")),
                     eo_verify_number(row, "value"), eo_verify_number(row, "expected"), eo_verify_number(row, "tolerance"),
                     json_is_true(json_object_get(row, "pass")));
  json_decref(rows);
  return code;
}

static const struct eo_verify_kind kinds[] = {
    {"calculix", eo_verify_calculix},
    {"contact", eo_verify_contact},
    {"dynamics", run_dynamics},
    {"evaluation", eo_verify_evaluation},
    {"optimizer", run_optimizer},
    {"standards", eo_verify_standards},
};

const struct eo_verify_kind *eo_verify_kind_at(int index)
{
  return index >= 0 && index < (int)(sizeof kinds / sizeof kinds[0]) ? &kinds[index] : NULL;
}
