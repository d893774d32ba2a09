#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/case_pair.h"
#include "design/resolution.h"
#include "reference/verify_contact.h"
#include "evaluation/evaluator.h"

/* A number in the file's words, for instance after "z " in "z 17/44, mn 6". */
static double number_in(const char *text, const char *mark, double fallback)
{
  const char *found = text ? strstr(text, mark) : NULL;
  return found ? atof(found + strlen(mark)) : fallback;
}

/* The pair: the block "input", or the paper's with the teeth and module of the words. */
static enum eo_code read_design(const json_t *file, struct eo_design *design, struct eo_error *error)
{
  const char *what = json_string_value(json_object_get(file, "what"));
  const char *teeth = what ? strstr(what, "z ") : NULL, *slash = teeth ? strchr(teeth, '/') : NULL;
  json_t *input = json_object_get(file, "input");
  json_t *made = input ? json_incref(input)
                       : json_pack("{s:[i,i], s:f, s:f, s:f}", "z", teeth ? atoi(teeth + 2) : 17,
                                   slash ? atoi(slash + 1) : 44, "mn", number_in(what, "mn ", 6), "beta_deg",
                                   number_in(what, "beta ", 24), "b", number_in(what, "b ", 55));
  if (!made)
    return eo_error_memory(error);
  enum eo_code code = eo_case_design(made, design, error);
  json_decref(made);
  struct eo_resolution *r = &design->resolution;
  r->sector_teeth = eo_case_count(json_string_value(json_object_get(file, "boundary")), "-tooth sectors", 3);
  r->neighbour_coupling = false;
  r->tip_edge_contact = true;
  return code;
}

static void check_phase(struct eo_verification *v, const char *label, const json_t *block, const struct eo_pair *pair,
                        const struct eo_evaluation *r, int j, double shift)
{
  const struct eo_contact_position *p = &pair->grid->position[j];
  const double *line_load = r->load_case[0].end[0].loaded.line_load + p->first;
  char quantity[80];
  const char *key;
  json_t *share;
  double lte = 1e6 * r->load_case[0].transmission[j];
  snprintf(quantity, sizeof quantity, "LTE um less the mean difference, c %.6g", 1e3 * p->phase);
  eo_verify_add(v, label, quantity, lte - shift, eo_verify_element(block, "LTE_um", j), 0.1);
  json_object_foreach(json_array_get(json_object_get(block, "share"), (size_t)j), key, share)
  {
    double load = 0, pitch = pair->geometry.transverse_base_pitch;
    for (int i = 0; i < p->points; i++)
      if (fabs(p->phase + p->point[i].pair * pitch - 1e-3 * atof(key)) < 1e-2 * pitch)
        load += line_load[i] * p->length[i];
    snprintf(quantity, sizeof quantity, "load share of the pair at c %.8s", key);
    eo_verify_add(v, label, quantity, load / r->load_case[0].force, json_number_value(share), 0.015);
  }
}

static enum eo_code check_block(struct eo_verification *v, const char *label, const json_t *file, const json_t *block,
                                struct eo_error *error)
{
  const json_t *phases = json_object_get(block, "phases_mm");
  int n = (int)json_array_size(phases);
  double *phase = calloc((size_t)n + 1, sizeof *phase);
  struct eo_design *design = malloc(sizeof *design);
  struct eo_pair *pair = NULL;
  struct eo_evaluator *evaluator = NULL;
  const struct eo_evaluation *r;
  enum eo_code code = phase && design ? read_design(file, design, error) : eo_error_memory(error);
  if (!code) {
    struct eo_contact_grid_settings grid = eo_contact_grid_default(&design->resolution);
    struct eo_pair_options options = {.grid = &grid, .phase = phase, .own_pivots = true};
    struct eo_geometry geometry;
    grid.positions = design->resolution.positions = n;
    for (int j = 0; j < n; j++)
      phase[j] = 1e-3 * json_number_value(json_array_get(phases, (size_t)j));
    code = eo_geometry_init(&geometry, &design->gear_pair, error);
    if (!code) {
      eo_design_resolve(design, &geometry);
      double force = number_in(json_string_value(json_object_get(file, "what")), "normal force ", NAN);
      design->load_case[0].torque = 2 * force * geometry.base_radius[0] * cos(geometry.base_helix_angle);
      eo_case_modification(json_object_get(block, "mod"), &design->gear_pair,
                           &design->modification.flank[EO_PINION][EO_LEFT]);
      design->modification.flank[EO_PINION][EO_RIGHT] = design->modification.flank[EO_PINION][EO_LEFT];
      code = eo_pair_new(&pair, design, &options, NULL, error);
    }
  }
  if (!code)
    code = eo_evaluator_new(&evaluator, pair, 1, error);
  if (!code)
    code = eo_evaluator_contact(evaluator, design, &r, error);
  if (!code) {
    double mean = 0, expected = 0;
    for (int j = 0; j < n; j++) {
      mean += 1e6 * r->load_case[0].transmission[j] / n;
      expected += eo_verify_element(block, "LTE_um", j) / n;
    }
    eo_verify_add(v, label, "mean LTE um", mean, expected, 0.03 * expected);
    for (int j = 0; j < n; j++)
      check_phase(v, label, block, pair, r, j, mean - expected);
  }
  eo_evaluator_free(evaluator);
  eo_pair_free(pair);
  free(design);
  free(phase);
  return code;
}

enum eo_code eo_verify_calculix(const json_t *file, struct eo_verification *v, struct eo_error *error)
{
  const char *name;
  json_t *block;
  json_object_foreach((json_t *)file, name, block) if (json_is_object(block) && json_object_get(block, "phases_mm"))
  {
    enum eo_code code = check_block(v, name, file, block, error);
    if (code)
      return code;
  }
  return EO_OK;
}
