/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "variants/variant_cost.h"

#include <math.h>
#include <stdlib.h>

#include "design/resolution.h"
#include "flexibility/preparation_cost.h"
#include "store/variant_rows.h"
#include "variants/variant_study.h"

/* Bytes of a row beside its numbers, and of an index (measured: tests/bench/bench-crew.c). */
static const double ROW_BYTES = 560;

#define AT(member) EO_AT(struct eo_variant_cost, member)
static const struct eo_outline_row cost_rows[] = {
    EO_KEY("variants", "integer", "of the study", AT(rows)),
    EO_KEY("pairs", "integer", "gear pairs to be prepared, those that are kept already among them", AT(pairs)),
    EO_KEY("refused_pairs", "integer", "of them that cannot be as their first variant states them", AT(refused_pairs)),
    EO_KEY("memory_bytes", "number", "of the largest preparation", AT(memory)),
    EO_KEY("preparation_s", "number", "of a processor, for all pairs", AT(preparation)),
    EO_KEY("evaluation_s", "number?", "of a processor, for one variant; null: none was evaluated yet", AT(evaluation)),
    EO_KEY("kept_bytes", "number", "of the rows in the data folder", AT(kept)),
};
const struct eo_outline eo_variant_cost_outline = EO_OUTLINE("StudyCost", cost_rows);

static enum eo_code find_pair(const struct eo_variant_plan *plan, const json_t *values, struct eo_design *design,
                              struct eo_preparation_cost *pair, struct eo_error *error)
{
  struct eo_geometry geometry;
  if (!design || !values)
    return eo_error_memory(error);
  EO_TRY(eo_variant_design(plan->base, plan->axis, plan->axes, values, design, &geometry, error));
  struct eo_flexibility_settings settings = eo_flexibility_settings_of(&design->resolution);
  return eo_preparation_cost_find(&geometry, &design->gear_pair, &settings, pair, error);
}

static enum eo_code add_pair(const struct eo_variant_plan *plan, int variant, struct eo_variant_cost *cost,
                             struct eo_error *error)
{
  struct eo_design *design = malloc(sizeof *design);
  struct eo_preparation_cost pair = {0};
  json_t *values = eo_variant_values(plan, variant);
  enum eo_code code = find_pair(plan, values, design, &pair, error);
  json_decref(values);
  free(design);
  if (code == EO_ERROR_INPUT) {
    cost->refused_pairs++;
    return EO_OK;
  }
  EO_TRY(code);
  cost->memory = fmax(cost->memory, pair.memory);
  cost->preparation += pair.seconds;
  return EO_OK;
}

/* The values that a pair depends on are other ones than those of the variant before. */
static bool is_another_pair(const struct eo_variant_plan *plan, int before, int variant)
{
  json_t *one = eo_variant_values(plan, before), *other = eo_variant_values(plan, variant);
  bool differs = false;
  for (int i = 0; i < plan->axes; i++)
    if (plan->axis[i].of_pair && !json_equal(json_array_get(one, (size_t)i), json_array_get(other, (size_t)i)))
      differs = true;
  json_decref(one);
  json_decref(other);
  return differs;
}

enum eo_code eo_variant_cost_find(const struct eo_variant_plan *plan, struct eo_store *store,
                                  struct eo_variant_cost *cost, struct eo_error *error)
{
  struct eo_scalars scalars;
  int *order = malloc(sizeof *order * ((size_t)plan->rows + 1));
  *cost = (struct eo_variant_cost){.rows = plan->rows, .evaluation = NAN};
  if (!order)
    return eo_error_memory(error);
  enum eo_code code = eo_variant_sort(plan, order, &cost->pairs, error);
  for (int i = 0; i < plan->rows && !code; i++)
    if (i == 0 || is_another_pair(plan, order[i - 1], order[i]))
      code = add_pair(plan, order[i], cost, error);
  free(order);
  if (!code)
    code = eo_variant_scalars(plan, &scalars, error);
  if (code)
    return code;
  cost->kept = (ROW_BYTES + 8. * scalars.count) * plan->rows;
  if (store)
    code = eo_store_mean_cost(store, &cost->evaluation, error);
  eo_scalars_done(&scalars);
  return code;
}
