/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Root bending stress of one tooth through its mesh, from the contact loads and the stress influence of the
   finite-element model. */
#ifndef EASEOFF_CONTACT_ROOT_H
#define EASEOFF_CONTACT_ROOT_H

#include "contact/loaded.h"
#include "flexibility/root_modes.h"

/* The largest principal stress on a loaded root. */
struct eo_root_place {
  double stress;    /* Pa; 0 when nothing is in tension */
  double arc, eta;  /* along the root from the start of the active profile, from mid face, m */
  int point, layer; /* of the root's nodes */
};

/* On the root of `tooth` under the normal forces force[n], N, at the points. stress[root points][layers +
   1][EO_STRESSES] receives the whole field (eo_flexibility_root()). */
void eo_root_find_largest(const struct eo_flexibility *flexibility, int member, int tooth, int n,
                          const struct eo_flank_point *point, const double *force, double *stress,
                          struct eo_root_place *place);

struct eo_root_history {
  int phases;      /* 0: not computed */
  double *phase;   /* [phases]: c of the tooth's pair over base pitches, ascending */
  double *stress;  /* [phases]: largest principal stress of the loaded root over face and fillet, from the 30 degree
                      tangent inwards, Pa */
  double maximum;  /* of the history, Pa */
  double arc, eta; /* where it is: along the root from the start of the active profile, from mid face, m */
};

/* Room for the mesh of a tooth over every position of the grid. */
enum eo_code eo_root_history_init(struct eo_root_history *history, const struct eo_contact_grid *grid,
                                  struct eo_error *error);
void eo_root_history_done(struct eo_root_history *history);

/* The largest stress of a tooth in its mesh under one end's loads. */
struct eo_root_peak {
  double stress; /* Pa */
  int node;      /* of the root's nodes, see eo_root_modes_find_largest() */
};

/* What the loads of a contact grid's points are to the roots of both members; constant once made, shared by all
   threads. Borrows the grid and the modes [member], which are turned to its loads. */
struct eo_root_tables;
enum eo_code eo_root_tables_new(struct eo_root_tables **tables, const struct eo_contact_grid *grid,
                                struct eo_root_modes *const modes[2], struct eo_error *error);
void eo_root_tables_free(struct eo_root_tables *tables);

/* The loads of one end at every step-th position of the grid, as the roots of both members feel them. */
struct eo_root_loads {
  int step;
  float *force;     /* [grid->points], N */
  float *remote[2]; /* [member]: [pairs][positions that count][remote stride]: to the roots of other teeth */
};
enum eo_code eo_root_loads_init(struct eo_root_loads *loads, const struct eo_root_tables *tables, int step,
                                struct eo_error *error);
void eo_root_loads_done(struct eo_root_loads *loads);
void eo_root_loads_find(struct eo_root_loads *loads, const struct eo_root_tables *tables,
                        const struct eo_loaded_end *end);

/* Scratch of one thread for at most `ends` ends at a time; borrows the tables. */
struct eo_root_workspace;
enum eo_code eo_root_workspace_new(struct eo_root_workspace **workspace, const struct eo_root_tables *tables, int ends,
                                   struct eo_error *error);
void eo_root_workspace_free(struct eo_root_workspace *workspace);

/* One tooth of a member, of the range that eo_contact_grid_pairs() tells, under the loads of several ends at once, all
   of one step: its phases and stresses in each history[ends], and its peak[ends]. Teeth may be computed in any order,
   on any thread. */
void eo_root_tooth_compute(struct eo_root_workspace *workspace, int member, int tooth, int ends,
                           const struct eo_root_loads *const *loads, struct eo_root_history *const *history,
                           struct eo_root_peak *peak);

/* When every tooth is there: the number of phases, the maximum and its place. root: of the member's flexibility;
   peak[teeth], stride apart; step: of the loads. */
void eo_root_history_finish(struct eo_root_history *history, const struct eo_root *root,
                            const struct eo_contact_grid *grid, int step, const struct eo_root_peak *peak, int stride);

/* All of this for one end. */
void eo_root_history_compute(struct eo_root_history *history, struct eo_root_workspace *workspace,
                             const struct eo_root *root, int member, const struct eo_root_loads *loads);

#endif
