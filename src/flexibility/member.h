/* One member's finite-element results: compliance of its flank, of its neighbours' flanks, and root stress, all under
   unit normal loads on the nodes of the flank. */
#ifndef EASEOFF_FLEXIBILITY_MEMBER_H
#define EASEOFF_FLEXIBILITY_MEMBER_H

#include "base/progress.h"
#include "flexibility/sector.h"
#include "flexibility/stress.h"

struct eo_member_settings {
  struct eo_section_settings section;
  int layers;
  double bore_radius; /* m */
};

/* Seconds of wall time per step, and what the factorisation took. */
struct eo_member_times {
  double mesh, ordering, factorisation, compliance, half_tooth, stress;
  double unknowns, entries; /* of the matrix, of its factor */
  double memory;            /* bytes, the sparse solver's peak */
};

/* Flank points are numbered row * (layers + 1) + layer: rows in ascending s, layers in ascending eta.
   flank = rows * (layers + 1) points, next = next_rows * (layers + 1), stresses = root_points * (layers + 1) *
   EO_STRESSES. */
struct eo_member_result {
  int rows, next_rows, layers, root_points;
  double *s;              /* [rows], m */
  double *next_s;         /* [next_rows], m */
  double *full;           /* [flank][flank], m/N, symmetric: the whole sector */
  double *half;           /* [flank][flank], m/N, symmetric: the loaded half tooth alone */
  double *next[2];        /* [flank][next]: on the same flank of pair k - 1, k + 1 under loads on pair k, m/N */
  double *stress;         /* [flank][stresses], Pa/N: loads on the tooth itself */
  double *next_stress[2]; /* [next][stresses], Pa/N: loads on pair k - 1, k + 1, stress in the root of pair k */
  double *root;           /* [root_points][2]: position in the section, m */
  double *arc;            /* [root_points]: along the root from the start of the active profile, m */
};

/* Errors: as eo_section_init(), eo_sector_init() and eo_sparse_*; EO_ERROR_CANCELLED. progress may be NULL; fractions
   0..1. */
enum eo_code eo_member_compute(struct eo_member_result *result, const struct eo_geometry *geometry, int member,
                               const struct eo_material *material, const struct eo_member_settings *settings,
                               const struct eo_progress *progress, struct eo_member_times *times,
                               struct eo_error *error);
void eo_member_result_done(struct eo_member_result *result);

#endif
