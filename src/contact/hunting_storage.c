/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the walk over the hunting period works in and fills, made and freed. */
#include "contact/hunting_private.h"

#include <stdlib.h>

/* Of a cycle, at which root stress is read: four times as many change its maximum by 0.2 % (the pairs of teeth differ,
   so that what one of them does between two positions another does at one), and take as much time as the contact. */
enum { ROOT_POSITIONS = 16 };

static struct eo_hunting_place *make_places(int count, bool *complete)
{
  struct eo_hunting_place *place = calloc((size_t)count, sizeof *place);
  *complete = *complete && place;
  return place;
}

static double *make_numbers(int count, bool *complete)
{
  double *number = calloc((size_t)count, sizeof *number);
  *complete = *complete && number;
  return number;
}

enum eo_code eo_hunting_count(struct eo_hunting *hunting, const struct eo_hunting_input *input, struct eo_error *error)
{
  const struct eo_geometry *geometry = &input->grid[0]->geometry;
  int range[2];
  eo_contact_grid_pairs(input->grid[0], range);
  *hunting = (struct eo_hunting){.ends = input->ends,
                                 .positions = input->positions,
                                 .first_line = range[0],
                                 .teeth = {geometry->teeth[0], geometry->teeth[1]},
                                 .cycles = eo_hunting_cycles(geometry->teeth)};
  for (int end = 1; end < input->ends; end++) {
    int own[2];
    eo_contact_grid_pairs(input->grid[end], own);
    hunting->first_line = own[0] < hunting->first_line ? own[0] : hunting->first_line;
    range[1] = own[1] > range[1] ? own[1] : range[1];
  }
  hunting->lines = range[1] - hunting->first_line + 1;
  if ((double)hunting->cycles * hunting->positions > EO_HUNTING_MOST_INSTANTS)
    return eo_error_set(error, EO_ERROR_INPUT, "/pitch/positions_per_cycle",
                        "%d and %d teeth meet again after %d mesh cycles; with %d positions each that is more than the "
                        "%d instants that are computed.",
                        hunting->teeth[0], hunting->teeth[1], hunting->cycles, hunting->positions,
                        EO_HUNTING_MOST_INSTANTS);
  hunting->instants = hunting->cycles * hunting->positions;
  return EO_OK;
}

static enum eo_code make_result(struct eo_hunting *hunting, const struct eo_hunting_input *input,
                                struct eo_error *error)
{
  bool complete = true;
  EO_TRY(eo_hunting_count(hunting, input, error));
  for (int end = 0; end < hunting->ends; end++) {
    hunting->load[end] = make_numbers(hunting->instants, &complete);
    hunting->approach[end] = make_numbers(hunting->instants, &complete);
    hunting->tangent[end] = make_numbers(hunting->instants, &complete);
    hunting->pair_load[end] = calloc((size_t)hunting->instants * (size_t)hunting->lines,
                                     sizeof *hunting->pair_load[end]);
    complete = complete && hunting->pair_load[end];
    for (int member = 0; member < 2; member++)
      hunting->tooth_load[end][member] = make_places(hunting->teeth[member], &complete);
  }
  for (int member = 0; member < 2 && input->root[EO_LEFT]; member++)
    hunting->tooth_stress[member] = make_places(hunting->ends * hunting->teeth[member], &complete);
  return complete ? EO_OK : eo_error_memory(error);
}

static enum eo_code make_find(struct eo_hunting_find *find, const struct eo_hunting *hunting, struct eo_error *error)
{
  bool complete = true;
  for (int member = 0; member < 2; member++) {
    for (int end = 0; end < hunting->ends; end++)
      find->tooth_load[end][member] = make_places(hunting->teeth[member], &complete);
    if (hunting->tooth_stress[member])
      find->tooth_stress[member] = make_places(hunting->ends * hunting->teeth[member], &complete);
  }
  return complete ? EO_OK : eo_error_memory(error);
}

static enum eo_code make_walker(struct eo_hunting_walker *walker, const struct eo_hunt *hunt, struct eo_error *error)
{
  const struct eo_hunting_input *input = hunt->input;
  bool complete = true;
  EO_TRY(make_find(&walker->find, hunt->result, error));
  for (int end = 0; end < input->ends; end++) {
    EO_TRY(eo_loaded_workspace_new(&walker->loaded[end], input->grid[end], error));
    EO_TRY(eo_loaded_end_init(&walker->solved[end], input->grid[end], error));
    walker->gap[end] = make_numbers(input->grid[end]->points, &complete);
  }
  bool one_grid = input->ends == 1 || input->grid[EO_RIGHT] == input->grid[EO_LEFT];
  for (int end = 0; complete && input->root[EO_LEFT] && end < (one_grid ? 1 : 2); end++) {
    int step = input->positions > ROOT_POSITIONS ? input->positions / ROOT_POSITIONS * hunt->step : hunt->step;
    EO_TRY(eo_root_workspace_new(&walker->root[end], input->root[end], 1, error));
    EO_TRY(eo_root_loads_init(&walker->root_loads[end], input->root[end], step, error));
    EO_TRY(eo_root_history_init(&walker->history[end], input->grid[end], error));
  }
  return complete ? EO_OK : eo_error_memory(error);
}

enum eo_code eo_hunt_begin(struct eo_hunt *hunt, struct eo_hunting *result, const struct eo_hunting_input *input,
                           struct eo_error *error)
{
  *hunt = (struct eo_hunt){.input = input, .result = result, .step = input->grid[0]->positions / input->positions};
  EO_TRY(make_result(result, input, error));
  hunt->walker = calloc((size_t)input->threads, sizeof *hunt->walker);
  if (!hunt->walker)
    return eo_error_memory(error);
  for (int thread = 0; thread < input->threads; thread++)
    EO_TRY(make_walker(&hunt->walker[thread], hunt, error));
  return EO_OK;
}

static void walker_done(struct eo_hunting_walker *walker)
{
  for (int end = 0; end < 2; end++) {
    eo_loaded_workspace_free(walker->loaded[end]);
    eo_loaded_end_done(&walker->solved[end]);
    free(walker->gap[end]);
    free(walker->find.tooth_stress[end]);
    for (int member = 0; member < 2; member++)
      free(walker->find.tooth_load[end][member]);
  }
  for (int end = 0; end < 2; end++) {
    eo_root_workspace_free(walker->root[end]);
    eo_root_loads_done(&walker->root_loads[end]);
    eo_root_history_done(&walker->history[end]);
  }
}

void eo_hunt_end(struct eo_hunt *hunt)
{
  for (int thread = 0; hunt->walker && thread < hunt->input->threads; thread++)
    walker_done(&hunt->walker[thread]);
  free(hunt->walker);
}

void eo_hunting_done(struct eo_hunting *hunting)
{
  for (int end = 0; end < 2; end++) {
    free(hunting->load[end]);
    free(hunting->approach[end]);
    free(hunting->tangent[end]);
    free(hunting->pair_load[end]);
    free(hunting->tooth_stress[end]);
    for (int member = 0; member < 2; member++)
      free(hunting->tooth_load[end][member]);
  }
  *hunting = (struct eo_hunting){0};
}
