/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/anatomy.h"

#include <math.h>

double eo_anatomy_reduce(const struct eo_part_group *group, const double *part, int *most, int *least)
{
  *most = 0;
  *least = group->kind == EO_PART_RANGE ? 0 : -1;
  for (int i = 1; i < group->count; i++) {
    *most = part[i] > part[*most] ? i : *most;
    if (*least >= 0 && part[i] < part[*least])
      *least = i;
  }
  return part[*most] - (*least >= 0 ? part[*least] : 0);
}

/* Adds the soft largest of sign * part, times sign, to the weights; returns it. */
static double add_soft(const struct eo_part_group *group, const double *part, double sign, double softness,
                       double *weight)
{
  double most = sign * part[0];
  for (int i = 1; i < group->count; i++)
    most = fmax(most, sign * part[i]);
  double sum = exp((sign * part[0] - most) / softness);
  for (int i = 1; i < group->count; i++)
    sum += exp((sign * part[i] - most) / softness);
  for (int i = 0; i < group->count; i++)
    weight[i] += sign * exp((sign * part[i] - most) / softness) / sum;
  return most + softness * log(sum);
}

double eo_anatomy_soften(const struct eo_part_group *group, const double *part, double softness, double *weight)
{
  for (int i = 0; i < group->count; i++)
    weight[i] = 0;
  const double most = add_soft(group, part, 1, softness, weight);
  return group->kind == EO_PART_RANGE ? most + add_soft(group, part, -1, softness, weight) : most;
}

/* theory (H6) */
double eo_anatomy_sum(const struct eo_anatomy *anatomy, const double *part)
{
  double sum = 0;
  int most, least;
  for (int g = 0; g < anatomy->groups; part += anatomy->group[g++].count)
    sum += anatomy->group[g].weight * eo_anatomy_reduce(&anatomy->group[g], part, &most, &least);
  return sum;
}
