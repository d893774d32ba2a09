/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the two ways to a member's flexibility share. */
#ifndef EASEOFF_FLEXIBILITY_MEMBER_PRIVATE_H
#define EASEOFF_FLEXIBILITY_MEMBER_PRIVATE_H

#include "flexibility/member.h"

struct eo_member_job {
  struct eo_member_result *result;
  const struct eo_geometry *geometry;
  const struct eo_material *material;
  const struct eo_member_settings *settings;
  const struct eo_progress *progress;
  struct eo_member_times *times;
  struct eo_error *error;
  int member;
  struct eo_section section;
  struct eo_sector sector;
};

/* Tells the progress; EO_ERROR_CANCELLED when a stop is asked for. */
enum eo_code eo_member_report(const struct eo_member_job *job, const char *step, double fraction);

/* Now, in seconds; and the seconds since *start, which becomes now. */
double eo_member_now(void);
double eo_member_lap(double *start);

/* Appends the unknowns of the displacements of root nodes 0 .. nodes - 1, [node][layer][3], without the flank's own
   normal at node 0; returns how many. */
int eo_member_list_root(const struct eo_sector *sector, int nodes, int *unknown);

/* Appends the unknowns of the normal displacements of a flank, [row][layer]; returns how many. */
int eo_member_list_flank(const struct eo_sector *sector, const struct eo_flank_nodes *flank, int *unknown);

/* Displacements of root nodes 0 .. nodes - 1, [node][layers + 1][3] in the frames of the layers, from the values of
   these unknowns. */
void eo_member_root_displacement(const struct eo_sector *sector, int nodes, const double *root, const double *flank,
                                 double *displacement);

/* Solves the ring and fills what the job's result holds of it. */
enum eo_code eo_member_solve_ring(struct eo_member_job *job);

#endif
