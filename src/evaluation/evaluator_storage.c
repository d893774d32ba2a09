/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/design_rating.h"
#include "evaluation/evaluator_private.h"

#include <stdlib.h>

static enum eo_code init_end(struct eo_end_result *end, const struct eo_contact_grid *grid, struct eo_error *error)
{
  size_t n = (size_t)grid->positions;
  EO_TRY(eo_loaded_end_init(&end->loaded, grid, error));
  for (int member = 0; member < 2; member++)
    EO_TRY(eo_root_history_init(&end->root[member], grid, error));
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

static enum eo_code init_case(struct eo_case_result *load_case, const struct eo_contact_grid *const grid[2],
                              struct eo_error *error)
{
  load_case->transmission = calloc((size_t)grid[EO_LEFT]->positions, sizeof(double));
  if (!load_case->transmission)
    return eo_error_memory(error);
  for (int end = 0; end < 2; end++)
    EO_TRY(init_end(&load_case->end[end], grid[end], error));
  return EO_OK;
}

/* The workspaces of a thread. */
static enum eo_code add_workspaces(struct eo_evaluator *evaluator, int thread, struct eo_error *error)
{
  for (int half = 0; half < eo_pair_halves(evaluator->pair); half++)
    EO_TRY(eo_loaded_workspace_new(&evaluator->loaded[thread][half], eo_evaluator_grid(evaluator, half), error));
  return EO_OK;
}

static enum eo_code init_storage(struct eo_evaluator *evaluator, struct eo_error *error)
{
  const struct eo_contact_grid *const both[2] = {eo_evaluator_grid(evaluator, EO_LEFT),
                                                 eo_evaluator_grid(evaluator, EO_RIGHT)},
                                      *grid = both[EO_LEFT];
  struct eo_evaluation *result = &evaluator->result;
  size_t most = (size_t)evaluator->most_cases;
  result->positions = grid->positions;
  result->samples = EO_EVALUATOR_SAMPLES;
  result->load_case = calloc(most, sizeof *result->load_case);
  result->objective = calloc(most, sizeof *result->objective);
  evaluator->law = calloc(most, sizeof *evaluator->law);
  evaluator->law_of = calloc(most, sizeof *evaluator->law_of);
  evaluator->problem = calloc(most, sizeof *evaluator->problem);
  evaluator->shifted = calloc((size_t)grid->positions, sizeof *evaluator->shifted);
  evaluator->table_rows = calloc(EO_EVALUATOR_TABLE_ROWS * (size_t)grid->positions, sizeof *evaluator->table_rows);
  if (!result->load_case || !result->objective || !evaluator->law || !evaluator->law_of || !evaluator->problem ||
      !evaluator->shifted || !evaluator->table_rows)
    return eo_error_memory(error);
  for (int k = 0; k < evaluator->most_cases; k++)
    EO_TRY(init_case(&result->load_case[k], both, error));
  for (int end = 0; end < 2; end++) {
    EO_TRY(eo_loaded_end_init(&evaluator->spare[end], both[end], error));
  }
  EO_TRY(eo_fft_tables_new(&evaluator->fft, error));
  EO_TRY(eo_team_new(&evaluator->team, error));
  return add_workspaces(evaluator, 0, error);
}

enum eo_code eo_evaluator_new(struct eo_evaluator **result, const struct eo_pair *pair, int most_cases,
                              struct eo_error *error)
{
  struct eo_evaluator *evaluator = calloc(1, sizeof *evaluator);
  if (!evaluator)
    return eo_error_memory(error);
  evaluator->pair = pair;
  evaluator->most_cases = most_cases;
  evaluator->threads = 1;
  enum eo_code code = init_storage(evaluator, error);
  if (code)
    eo_evaluator_free(evaluator);
  else
    *result = evaluator;
  return code;
}

enum eo_code eo_evaluator_use_threads(struct eo_evaluator *evaluator, int threads, struct eo_error *error)
{
  if (threads > 1 && !evaluator->loaded[1][0])
    EO_TRY(add_workspaces(evaluator, 1, error));
  evaluator->threads = threads > 1 ? 2 : 1;
  eo_team_use(evaluator->team, evaluator->threads);
  return EO_OK;
}

struct eo_team *eo_evaluator_team(const struct eo_evaluator *evaluator)
{
  return evaluator->team;
}

const struct eo_gap_field *eo_evaluator_field(const struct eo_evaluator *evaluator, int load_case, int end)
{
  return &evaluator->meeting[evaluator->meeting_of[load_case]]->field[eo_reuse_stored_at(evaluator, end)];
}

static void done_results(struct eo_evaluator *evaluator)
{
  struct eo_evaluation *result = &evaluator->result;
  for (int k = 0; result->load_case && k < evaluator->most_cases; k++) {
    free(result->load_case[k].transmission);
    for (int end = 0; end < 2; end++) {
      done_end(&result->load_case[k].end[end]);
      eo_law_done(evaluator->law ? &evaluator->law[k][end] : NULL);
    }
  }
  free(result->load_case);
  free(result->objective);
  free(evaluator->law);
  free(evaluator->law_of);
  free(evaluator->problem);
}

const struct eo_pair *eo_evaluator_pair(const struct eo_evaluator *evaluator)
{
  return evaluator->pair;
}

void eo_evaluator_free(struct eo_evaluator *evaluator)
{
  if (!evaluator)
    return;
  eo_team_free(evaluator->team);
  eo_design_rating_free(evaluator->rating);
  done_results(evaluator);
  for (int end = 0; end < 2; end++) {
    eo_loaded_end_done(&evaluator->spare[end]);
  }
  for (int i = 0; evaluator->table && i < EO_EVALUATOR_TABLE_LOADS; i++)
    eo_loaded_end_done(&evaluator->table[i]);
  free(evaluator->table);
  eo_fft_tables_free(evaluator->fft);
  free(evaluator->table_rows);
  free(evaluator->shifted);
  for (int i = 0; i < 4; i++) {
    eo_loaded_workspace_free(evaluator->loaded[i / 2][i % 2]);
    eo_root_workspace_free(evaluator->root[i / 2][i % 2]);
  }
  for (int half = 0; half < 2; half++) {
    for (int i = 0; evaluator->root_loads[half] && i < 2 * evaluator->most_cases; i++)
      eo_root_loads_done(&evaluator->root_loads[half][i]);
    free(evaluator->root_loads[half]);
    free(evaluator->peaks[half]);
  }
  free(evaluator->made);
  eo_meetings_done(evaluator);
  eo_loaded_gaps_done(&evaluator->gaps_on_bent_bodies);
  for (int thread = 0; thread < 2; thread++)
    eo_vibration_free(evaluator->vibration[thread]);
  free(evaluator);
}
