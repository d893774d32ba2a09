/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What loaded contact works in and fills, made and freed. */
#include "contact/loaded_private.h"

#include <stdlib.h>

enum eo_code eo_loaded_workspace_new(struct eo_loaded_workspace **result, const struct eo_contact_grid *grid,
                                     struct eo_error *error)
{
  struct eo_loaded_workspace *ws = calloc(1, sizeof *ws);
  if (!ws)
    return eo_error_memory(error);
  long points = grid->most_points + EO_GRAM_LANE, width = eo_gram_width(grid->most_rank);
  double **vector[] = {&ws->load,  &ws->rate,   &ws->gap,       &ws->bend,      &ws->correction,
                       &ws->local, &ws->spread, &ws->course[0], &ws->course[1], &ws->course[2]};
  double **modal[] = {&ws->mode,    &ws->trial,           &ws->residual,        &ws->step,
                      &ws->tangent, &ws->modal_course[0], &ws->modal_course[1], &ws->modal_course[2]};
  bool complete = eo_local_inverse_init(&ws->inverse, error) == EO_OK;
  for (int i = 0; i < 10; i++)
    complete = (*vector[i] = eo_gram_allocate(points)) && complete;
  for (int i = 0; i < 8; i++)
    complete = (*modal[i] = eo_gram_allocate(width)) && complete;
  complete = (ws->matrix = eo_gram_allocate(width * width / 2)) && complete;
  complete = (ws->packed = eo_gram_allocate(points * width / 2)) && complete;
  complete = (ws->blend = eo_gram_allocate(points + EO_GRAM_FLOATS)) && complete;
  if (!complete) {
    eo_loaded_workspace_free(ws);
    return eo_error_memory(error);
  }
  ws->gram = eo_gram_select();
  ws->partial = grid->partial_cells;
  *result = ws;
  return EO_OK;
}

void eo_loaded_workspace_free(struct eo_loaded_workspace *ws)
{
  if (!ws)
    return;
  double *const owned[] = {ws->load,   ws->rate, ws->gap,   ws->bend,     ws->correction, ws->local,
                           ws->spread, ws->mode, ws->trial, ws->residual, ws->step,       ws->tangent};
  for (int i = 0; i < 3; i++) {
    free(ws->course[i]);
    free(ws->modal_course[i]);
  }
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++)
    free(owned[i]);
  free(ws->matrix);
  free(ws->packed);
  free(ws->blend);
  eo_local_inverse_done(&ws->inverse);
  free(ws);
}

enum eo_code eo_loaded_gaps_init(struct eo_loaded_gaps *gaps, const struct eo_contact_grid *grid,
                                 struct eo_error *error)
{
  gaps->gap = calloc((size_t)grid->points, sizeof(double));
  gaps->unloaded = calloc((size_t)grid->positions, sizeof(double));
  if (gaps->gap && gaps->unloaded)
    return EO_OK;
  eo_loaded_gaps_done(gaps);
  return eo_error_memory(error);
}

void eo_loaded_gaps_done(struct eo_loaded_gaps *gaps)
{
  free(gaps->gap);
  free(gaps->unloaded);
  gaps->gap = gaps->unloaded = NULL;
}

enum eo_code eo_loaded_end_init(struct eo_loaded_end *end, const struct eo_contact_grid *grid, struct eo_error *error)
{
  size_t n = (size_t)grid->positions;
  *end = (struct eo_loaded_end){.load = calloc(n, sizeof(double)),
                                .approach = calloc(n, sizeof(double)),
                                .tangent = calloc(n, sizeof(double)),
                                .nearby = calloc(n * EO_LOADED_NEARBY, sizeof(double)),
                                .line_load = calloc((size_t)grid->points, sizeof(double))};
  if (end->load && end->approach && end->tangent && end->nearby && end->line_load)
    return EO_OK;
  eo_loaded_end_done(end);
  return eo_error_memory(error);
}

void eo_loaded_end_done(struct eo_loaded_end *end)
{
  free(end->load);
  free(end->approach);
  free(end->tangent);
  free(end->nearby);
  free(end->line_load);
  *end = (struct eo_loaded_end){0};
}
