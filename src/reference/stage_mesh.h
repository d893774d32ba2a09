/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A gear pair made ready for loaded contact from a stage's input: what the stages contact, impact, root-stress and
   evaluation share. */
#ifndef EASEOFF_REFERENCE_STAGE_MESH_H
#define EASEOFF_REFERENCE_STAGE_MESH_H

#include "reference/stage_input.h"
#include "contact/loaded.h"
#include "design/resolution.h"
#include "evaluation/pair.h"
#include "flexibility/closed_form.h"

enum { EO_STAGE_LOADS = EO_MAX_LOAD_CASES };

/* Where the compliance comes from. */
struct eo_stage_kernel {
  int closed; /* 1: the closed form */
  struct eo_closed_form form;
  char cache_directory[1000]; /* "": keep nothing */
};
extern const struct eo_table eo_stage_kernel_table;
#define EO_STAGE_KERNEL(type, member) \
  EO_OBJECT(type, member, "kernel", &eo_stage_kernel_table, "compliance of the teeth")

struct eo_stage_mesh_input {
  struct eo_design design;
  struct eo_stage_kernel kernel;
  enum eo_stage_pivot pivot;
  struct eo_numbers phase, torque, force;
  double edge_reach, compliance_factor;
  int edge_cells;
};

/* The rows of an input struct that starts with `struct eo_stage_mesh_input mesh`; the design is its first member. */
#define EO_STAGE_MESH(type)                                                                                           \
  EO_OBJECT(type, mesh.design.gear_pair, "gear_pair", &eo_gear_pair_table, "as in a design document"),                \
      EO_OBJECT(type, mesh.design.material, "material", &eo_material_table, "as in a design document"),               \
      EO_OBJECT(type, mesh.design.alignment, "alignment", &eo_alignment_table, "as in a design document"),            \
      EO_OBJECT(type, mesh.design.modification, "modification", &eo_modification_terms_table,                         \
                "as in a design document"),                                                                           \
      EO_OBJECT(type, mesh.design.resolution, "resolution", &eo_resolution_table,                                     \
                "as in a design document; what the stage does not compute is not used"),                              \
      EO_STAGE_KERNEL(type, mesh.kernel), EO_STAGE_PIVOT(type, mesh.pivot),                                           \
      EO_SERIES(type, mesh.phase, "phase_mm", &eo_unit_mm, 1024, -1e3, 1e3, 0,                                        \
                "phases c of pair 0, ascending over one base pitch; empty: resolution.positions equal steps from 0"), \
      EO_SERIES(type, mesh.torque, "torque_Nm", &eo_unit_Nm, EO_STAGE_LOADS, 1e-3, 1e8, 0,                            \
                "loads: on the pinion shaft, all ends together"),                                                     \
      EO_SERIES(type, mesh.force, "force_N", &eo_unit_N, EO_STAGE_LOADS, 1e-3, 1e9, 0,                                \
                "instead of torque_Nm: normal force of each end"),                                                    \
      EO_INTEGER(type, mesh.edge_cells, "tip_edge_cells", 1, 200, EO_EDGE_CELLS,                                      \
                 "cells on every stretch beyond the path of contact, with resolution.tip_edge_contact"),              \
      EO_NUMBER_DERIVED(type, mesh.edge_reach, "tip_edge_reach_mm", &eo_unit_mm, 1e-3, 100, "4/15 m_n",               \
                        "length of such a stretch along s"),                                                          \
      EO_NUMBER(type, mesh.compliance_factor, "compliance_factor", NULL, 0.01, 100, 1, "on bulk and local compliance")

struct eo_stage_mesh {
  struct eo_design design; /* complete */
  struct eo_pair *pair;
  struct eo_gap_field field[2]; /* [end] */
  struct eo_loaded_gaps gaps[2];
  struct eo_loaded_workspace *workspace;
  struct eo_loaded_end end[2]; /* of the last load solved */
  double factor;
  int stagger; /* positions by which the right end lags */
};

/* options: kernel and cache filled from the stage's kernel. */
struct eo_pair_options eo_stage_pair_options(const struct eo_stage_kernel *kernel, enum eo_stage_pivot pivot);

/* Finite elements alone, by the design's gear pair, material and resolution. */
enum eo_code eo_stage_prepare(const struct eo_design *design, const struct eo_stage_kernel *kernel,
                              struct eo_flexibility **flexibility, struct eo_error *error);

enum eo_code eo_stage_mesh_init(struct eo_stage_mesh *mesh, const struct eo_stage_mesh_input *input,
                                struct eo_error *error);
void eo_stage_mesh_done(struct eo_stage_mesh *mesh);

/* Number of loads, or 0 with *error filled when torque and force are both given or both missing. */
int eo_stage_mesh_loads(const struct eo_stage_mesh_input *input, struct eo_error *error);

/* Normal force per end of load k, N, and its torque, N m. */
double eo_stage_mesh_force(const struct eo_stage_mesh *mesh, const struct eo_stage_mesh_input *input, int k,
                           double *torque);

/* Loaded contact of all ends; fills mesh->end. */
void eo_stage_mesh_solve(struct eo_stage_mesh *mesh, double force);

#endif
