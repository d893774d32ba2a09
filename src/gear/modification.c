/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gear/modification.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

bool eo_modification_equal(const struct eo_flank_modification *a, const struct eo_flank_modification *b)
{
  /* behind the shape there are doubles only: no padding */
  size_t from = offsetof(struct eo_flank_modification, tip_relief);
  return a->shape == b->shape && memcmp((const char *)a + from, (const char *)b + from, sizeof *a - from) == 0;
}

bool eo_modification_is_none(const struct eo_flank_modification *m)
{
  return m->tip_relief == 0 && m->root_relief == 0 && m->profile_crowning == 0 && m->lead_crowning == 0 &&
         m->lead_slope == 0 && m->lead_offset == 0 && m->end_relief[0] == 0 && m->end_relief[1] == 0;
}

double eo_modification_lead_coefficient(const struct eo_geometry *g, double crowning)
{
  double half = g->face_width / 2 / cos(g->helix_angle);
  return crowning / (half * half);
}

static struct eo_relief relief(double start, double end, double amount, double crowning)
{
  struct eo_relief r = {.start = start, .length = fmax(0, end - start)};
  r.value = crowning * start * start;
  r.slope = 2 * crowning * start;
  r.depth = amount - r.value - r.slope * r.length;
  if (amount == 0) /* no relief on this side: the crowning goes on */
    r.length = 0;
  return r;
}

void eo_modification_init(struct eo_modification_shape *shape, const struct eo_geometry *g, int member,
                          const struct eo_flank_modification *flank)
{
  double top = member == EO_PINION ? g->rack_top : -g->rack_bottom;
  double bottom = member == EO_PINION ? -g->rack_bottom : g->rack_top;
  double half = g->face_width / 2 / cos(g->helix_angle);
  *shape =
      (struct eo_modification_shape){.relief = flank->shape, .crowning = flank->profile_crowning, .half_width = half};
  shape->side[0] = relief(flank->root_relief_start, bottom, flank->root_relief, flank->profile_crowning);
  shape->side[1] = relief(flank->tip_relief_start, top, flank->tip_relief, flank->profile_crowning);
  shape->lead[0] = flank->lead_offset;
  shape->lead[1] = flank->lead_slope / half;
  shape->lead[2] = eo_modification_lead_coefficient(g, flank->lead_crowning);
  for (int i = 0; i < 2; i++) {
    shape->end_relief[i] = flank->end_relief[i];
    shape->end_start[i] = half - flank->end_relief_length[i] / cos(g->helix_angle);
  }
}

/* Relief at distance t >= 0 beyond its vertex; *slope along t. */
static double relief_value(const struct eo_relief *r, enum eo_relief_shape form, double t, double *slope)
{
  double tangent = r->value + r->slope * t;
  switch (form) {
  case EO_RELIEF_LINEAR:
    *slope = r->slope + r->depth / r->length;
    return tangent + r->depth * t / r->length;
  case EO_RELIEF_CIRCULAR: {
    double depth = fabs(r->depth), sign = r->depth < 0 ? -1 : 1;
    if (depth == 0)
      break;
    double radius = (r->length * r->length + depth * depth) / (2 * depth),
           root = sqrt(fmax(radius * radius - t * t, 1e-6 * radius * radius));
    *slope = r->slope + sign * t / root;
    return tangent + sign * t * t / (radius + root);
  }
  case EO_RELIEF_PARABOLIC:
    break;
  }
  double ratio = t / r->length;
  *slope = r->slope + 2 * r->depth * ratio / r->length;
  return tangent + r->depth * ratio * ratio;
}

double eo_modification_profile(const struct eo_modification_shape *shape, double u, double slope[2])
{
  int tip = u >= 0, direction = tip ? 1 : -1;
  const struct eo_relief *r = &shape->side[tip];
  double beyond = fabs(u) - r->start, middle = 2 * shape->crowning * u, unused;
  if (r->length == 0 || beyond < 0) {
    slope[0] = slope[1] = middle;
    return shape->crowning * u * u;
  }
  double outer, value = relief_value(r, shape->relief, beyond, &outer);
  slope[0] = slope[1] = direction * outer;
  if (beyond == 0) { /* at the vertex: the inner side belongs to the middle parabola */
    slope[tip ? 0 : 1] = middle;
    if (r->start == 0 && shape->side[1 - tip].length > 0 && shape->side[1 - tip].start == 0) {
      relief_value(&shape->side[1 - tip], shape->relief, 0, &unused);
      slope[tip ? 0 : 1] = -direction * unused;
    }
  }
  return value;
}

double eo_modification_lead(const struct eo_modification_shape *shape, double x, double *slope)
{
  int side = x > 0;
  double value = shape->lead[0] + x * (shape->lead[1] + x * shape->lead[2]);
  double derivative = shape->lead[1] + 2 * x * shape->lead[2];
  double beyond = fabs(x) - shape->end_start[side], length = shape->half_width - shape->end_start[side];
  if (shape->end_relief[side] != 0 && beyond > 0 && length > 0) {
    double ratio = beyond / length;
    value += shape->end_relief[side] * ratio * ratio;
    derivative += (side ? 2 : -2) * shape->end_relief[side] * ratio / length;
  }
  *slope = derivative;
  return value;
}
