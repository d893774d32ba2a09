/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One member's finite-element results: compliance of its flank, coupling with the teeth around it, and root stress, all
   under unit normal loads on the nodes of the flank. Of a sector (the loaded tooth and its neighbours between fixed
   cuts), or of the whole ring from one tooth's sector (flexibility/ring.h). */
#ifndef EASEOFF_FLEXIBILITY_MEMBER_H
#define EASEOFF_FLEXIBILITY_MEMBER_H

#include "base/progress.h"
#include "flexibility/ring.h"
#include "flexibility/sector.h"
#include "flexibility/stress.h"

struct eo_member_settings {
  struct eo_section_settings section; /* open: a ring, else a sector */
  int layers;
  double bore_radius; /* m */
  int reach;          /* D: coupling with the teeth up to so many pairs ahead and behind; 1 with a sector */
  int threads;        /* for the harmonics of a ring; 0: one per processor */
  enum eo_ring_method method;
};

/* Seconds of wall time per step, and what the factorisation took. */
struct eo_member_times {
  double mesh, ordering, factorisation, compliance, harmonics, half_tooth, stress;
  double unknowns, entries; /* of the matrix, of its factor */
  double memory;            /* bytes, the sparse solver's peak */
};

/* Flank points are numbered row * (layers + 1) + layer: rows in ascending s, layers in ascending eta.
   flank = rows * (layers + 1) points, next = next_rows * (layers + 1), stresses = root_points * (layers + 1) *
   EO_STRESSES. A sector's neighbours have coarser rows of their own. All teeth of a ring are alike; there the loads on
   other teeth, whose effect on a root is smooth, are only kept on every second row. */
struct eo_member_result {
  int rows, coupled_rows, next_rows, layers, root_points, reach;
  double *s;              /* [rows], m */
  double *next_s;         /* [next_rows], m */
  double *full;           /* [flank][flank], m/N, symmetric: the whole body */
  double *half;           /* [flank][flank], m/N, symmetric: the loaded half tooth alone */
  double *next[2];        /* [reach][flank][coupled_rows * (layers + 1)]: on the same flank of pair k - d, k + d under
                             loads on pair k, m/N */
  double *stress;         /* [flank][stresses], Pa/N: loads on the tooth itself */
  double *next_stress[2]; /* [reach][next][stresses], Pa/N: loads on pair k - d, k + d, stress in the root of pair k */
  double *part[2]; /* [rows]: what the ring's harmonics 0 and +-1 (torque and thrust; net force and tilting moment) give
                      to the deflection of mid face under a uniform load on the row, m per N/m; 0 of a sector */
  double *root;    /* [root_points][2]: position in the section, m */
  double *arc;     /* [root_points]: along the root from the start of the active profile, m */
};

/* What the nodes of a ring's cut stand for when a floating body is balanced: weight[cut_nodes][layers + 1], share of
   the volume of a tooth, m3, by the trapezoidal rule over radius and face. Errors: memory. */
enum eo_code eo_member_cut_weights(const struct eo_sector *sector, int teeth, double *weight);

/* Of a ring's rows, every how many carry the loads on other teeth: a cubic spline needs four. */
static inline int eo_member_row_step(int rows)
{
  return rows % 2 == 1 && rows >= 7 ? 2 : 1;
}

/* Errors: as eo_section_init(), eo_sector_init() and eo_sparse_*; EO_ERROR_CANCELLED. progress may be NULL; fractions
   0..1. */
enum eo_code eo_member_compute(struct eo_member_result *result, const struct eo_geometry *geometry, int member,
                               const struct eo_material *material, const struct eo_member_settings *settings,
                               const struct eo_progress *progress, struct eo_member_times *times,
                               struct eo_error *error);
void eo_member_result_done(struct eo_member_result *result);

#endif
