#include "evaluation/evaluator_private.h"

#include <stdlib.h>

static enum eo_code init_end(struct eo_end_result *end, const struct eo_contact_grid *grid, struct eo_error *error)
{
  size_t n = (size_t)grid->positions;
  enum eo_code code = eo_loaded_end_init(&end->loaded, grid, error);
  for (int member = 0; member < 2 && !code; member++)
    code = eo_root_history_init(&end->root[member], grid, error);
  if (code)
    return code;
  end->unloaded = calloc(n, sizeof(double));
  end->stiffness = calloc(n, sizeof(double));
  if (!end->unloaded || !end->stiffness)
    return eo_error_memory(error);
  for (int i = 0; i < EO_CURVE_CHANNELS; i++) {
    end->curve[i] = calloc(EO_EVALUATOR_SAMPLES, sizeof(double));
    end->order[i] = calloc(EO_MAX_HARMONICS + 1, sizeof(double complex));
    if (!end->curve[i] || !end->order[i])
      return eo_error_memory(error);
  }
  return EO_OK;
}

static void done_end(struct eo_end_result *end)
{
  eo_loaded_end_done(&end->loaded);
  for (int member = 0; member < 2; member++)
    eo_root_history_done(&end->root[member]);
  free(end->unloaded);
  free(end->stiffness);
  for (int i = 0; i < EO_CURVE_CHANNELS; i++) {
    free(end->curve[i]);
    free(end->order[i]);
  }
}

static enum eo_code init_storage(struct eo_evaluator *e, struct eo_error *error)
{
  const struct eo_contact_grid *grid = e->pair->grid;
  struct eo_evaluation *r = &e->result;
  size_t most = (size_t)e->most_cases;
  enum eo_code code = EO_OK;
  r->positions = grid->positions;
  r->samples = EO_EVALUATOR_SAMPLES;
  r->load_case = calloc(most, sizeof *r->load_case);
  r->objective = calloc(most, sizeof *r->objective);
  e->law = calloc(most, sizeof *e->law);
  e->problem = calloc(most, sizeof *e->problem);
  e->shifted = calloc((size_t)grid->positions, sizeof *e->shifted);
  if (!r->load_case || !r->objective || !e->law || !e->problem || !e->shifted)
    return eo_error_memory(error);
  for (int k = 0; k < e->most_cases && !code; k++) {
    r->load_case[k].transmission = calloc((size_t)grid->positions, sizeof(double));
    if (!r->load_case[k].transmission)
      return eo_error_memory(error);
    for (int end = 0; end < 2 && !code; end++)
      code = init_end(&r->load_case[k].end[end], grid, error);
  }
  for (int end = 0; end < 2 && !code; end++) {
    code = eo_loaded_gaps_init(&e->gaps[end], grid, error);
    if (!code)
      code = eo_loaded_end_init(&e->spare[end], grid, error);
  }
  return code ? code : eo_loaded_workspace_new(&e->contact, grid, error);
}

enum eo_code eo_evaluator_new(struct eo_evaluator **evaluator, const struct eo_pair *pair, int most_cases,
                              struct eo_error *error)
{
  struct eo_evaluator *e = calloc(1, sizeof *e);
  if (!e)
    return eo_error_memory(error);
  e->pair = pair;
  e->most_cases = most_cases;
  e->threads = 1;
  enum eo_code code = init_storage(e, error);
  if (code)
    eo_evaluator_free(e);
  else
    *evaluator = e;
  return code;
}

enum eo_code eo_evaluator_use_threads(struct eo_evaluator *e, int threads, struct eo_error *error)
{
  enum eo_code code = EO_OK;
  if (threads > 1 && !e->second_contact)
    code = eo_loaded_workspace_new(&e->second_contact, e->pair->grid, error);
  if (!code)
    e->threads = threads > 1 ? 2 : 1;
  return code;
}

void eo_evaluator_free(struct eo_evaluator *e)
{
  if (!e)
    return;
  struct eo_evaluation *r = &e->result;
  for (int k = 0; r->load_case && k < e->most_cases; k++) {
    free(r->load_case[k].transmission);
    for (int end = 0; end < 2; end++) {
      done_end(&r->load_case[k].end[end]);
      eo_law_done(e->law ? &e->law[k][end] : NULL);
    }
  }
  for (int end = 0; end < 2; end++) {
    eo_loaded_gaps_done(&e->gaps[end]);
    eo_loaded_end_done(&e->spare[end]);
  }
  for (int i = 0; e->table && i < EO_EVALUATOR_TABLE_LOADS; i++)
    eo_loaded_end_done(&e->table[i]);
  free(e->table);
  free(e->table_rows);
  free(e->shifted);
  eo_loaded_workspace_free(e->contact);
  eo_loaded_workspace_free(e->second_contact);
  for (int thread = 0; thread < 2; thread++)
    eo_root_workspace_free(e->root[thread]);
  free(e->peaks);
  eo_elastic_free(e->bodies);
  eo_loaded_gaps_done(&e->bent);
  eo_vibration_free(e->vibration);
  free(e->law);
  free(e->problem);
  free(r->load_case);
  free(r->objective);
  free(e);
}
