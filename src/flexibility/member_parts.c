/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What both ways to solve a member share: progress, the unknowns of flank and root, displacements in the root. */
#include "flexibility/member_private.h"
#include "base/clock.h"
#include "gear/names.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum eo_code eo_member_report(const struct eo_member_job *job, const char *step, double fraction)
{
  char what[64];
  if (!job->progress)
    return EO_OK;
  what[0] = 0;
  strcat(strcat(strcat(what, eo_member_name[job->member]), ": "), step);
  if (eo_progress_report(job->progress, what, fraction))
    return eo_error_set(job->error, EO_ERROR_CANCELLED, "", "The preparation of the flexibility was stopped.");
  return EO_OK;
}

double eo_member_now(void)
{
  return 1e-3 * eo_clock_milliseconds();
}

double eo_member_lap(double *start)
{
  const double before = *start;
  *start = eo_member_now();
  return *start - before;
}

int eo_member_list_flank(const struct eo_sector *sector, const struct eo_flank_nodes *flank, int *unknown)
{
  int count = 0;
  for (int k = 0; k < flank->count; k++)
    for (int l = 0; l <= sector->layers; l++)
      unknown[count++] = eo_sector_unknown(sector, flank->node[k], l, 0);
  return count;
}

int eo_member_list_root(const struct eo_sector *sector, int nodes, int *unknown)
{
  int count = 0;
  for (int i = 0; i < nodes; i++)
    for (int l = 0; l <= sector->layers; l++)
      for (int c = i == 0; c < 3; c++)
        unknown[count++] = eo_sector_unknown(sector, sector->section->root[i], l, c);
  return count;
}

void eo_member_root_displacement(const struct eo_sector *sector, int nodes, const double *root, const double *flank,
                                 double *displacement)
{
  const struct eo_section *section = sector->section;
  int across = sector->layers + 1, corner_row = 0;
  while (section->flank.node[corner_row] != section->root[0])
    corner_row++;
  const double(*frame)[3] = (const double(*)[3])sector->frame[section->root[0]];
  for (int l = 0; l < across; l++) {
    double local[3] = {flank[corner_row * across + l], root[2 * l], root[2 * l + 1]};
    for (int c = 0; c < 3; c++)
      displacement[3 * l + c] = frame[0][c] * local[0] + frame[1][c] * local[1] + frame[2][c] * local[2];
  }
  memcpy(displacement + 3 * across, root + 2 * across, (size_t)(3 * across * (nodes - 1)) * sizeof *displacement);
}

/* What node i of a row of nodes stands for by the trapezoidal rule. */
static double share_of(const double *place, int count, int i)
{
  double before = i > 0 ? place[i - 1] : place[i], after = i < count - 1 ? place[i + 1] : place[i];
  return 0.5 * fabs(after - before);
}

enum eo_code eo_member_cut_weights(const struct eo_sector *sector, int teeth, double *weight)
{
  const struct eo_section *section = sector->section;
  double *radius = malloc(sizeof *radius * (size_t)section->cut_nodes);
  if (!radius)
    return EO_ERROR_MEMORY;
  for (int i = 0; i < section->cut_nodes; i++)
    radius[i] = hypot(section->point[2 * section->cut[0][i]], section->point[2 * section->cut[0][i] + 1]);
  for (int i = 0; i < section->cut_nodes; i++)
    for (int l = 0; l <= sector->layers; l++) {
      double height = sector->width / sector->layers * (l == 0 || l == sector->layers ? 0.5 : 1);
      *weight++ = 2 * M_PI / teeth * radius[i] * share_of(radius, section->cut_nodes, i) * height;
    }
  free(radius);
  return EO_OK;
}
