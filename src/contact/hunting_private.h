/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the walk over the hunting period works in, shared by the files that make it and walk. */
#ifndef EASEOFF_CONTACT_HUNTING_PRIVATE_H
#define EASEOFF_CONTACT_HUNTING_PRIVATE_H

#include "contact/hunting.h"

/* Cycles that one thread goes through from a start of its own; instants that a start goes on from. */
enum { EO_HUNTING_BLOCK = 8, EO_HUNTING_BEFORE = 3 };

/* What one thread has found. */
struct eo_hunting_find {
  struct eo_hunting_place *tooth_load[2][2], *tooth_stress[2]; /* as in struct eo_hunting */
  struct eo_hunting_place most_load[2], most_pressure[2], most_stress[2];
  int failures, alone;
};

/* What one thread works with. */
struct eo_hunting_walker {
  struct eo_loaded_workspace *loaded[2]; /* [end] */
  struct eo_root_workspace *root[2];     /* [end]; NULL: no root stress; one where the ends have one grid */
  struct eo_root_loads root_loads[2];
  struct eo_root_history history[2];
  double *gap[2];                 /* [end]: [grid->points] of the cycle at hand, behind it of the one before */
  struct eo_loaded_end solved[2]; /* [end]: the same */
  struct eo_hunting_find find;
};

struct eo_hunt {
  const struct eo_hunting_input *input;
  struct eo_hunting *result;
  int step;                         /* of the grid's positions */
  struct eo_hunting_walker *walker; /* [threads] */
};

/* Cycles, instants and pairs of a result that has nothing else yet. EO_ERROR_INPUT: too many instants. */
enum eo_code eo_hunting_count(struct eo_hunting *hunting, const struct eo_hunting_input *input, struct eo_error *error);

/* Makes room for the result and the work. eo_hunt_end() also after an error. */
enum eo_code eo_hunt_begin(struct eo_hunt *hunt, struct eo_hunting *result, const struct eo_hunting_input *input,
                           struct eo_error *error);
void eo_hunt_end(struct eo_hunt *hunt);

#endif
