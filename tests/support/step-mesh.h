/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a point is from the exact surface of a tooth, and a STEP file meshed by OpenCASCADE through gmsh. */
#ifndef EASEOFF_TESTS_SUPPORT_STEP_MESH_H
#define EASEOFF_TESTS_SUPPORT_STEP_MESH_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "exchange/step.h"
#include "exchange/tooth.h"

static double apart(const double a[3], const double b[3])
{
  return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static double clamp(double value)
{
  return fmin(1, fmax(0, value));
}

static double clamp_profile(double beyond, double value)
{
  return fmin(1 + beyond, fmax(-beyond, value));
}

/* One step of Gauss and Newton on the parameters of the nearest point. */
static void refine(const struct eo_tooth *tooth, enum eo_tooth_part part, double beyond, const double node[3],
                   double *p, double *q)
{
  const double step = 1e-5;
  double point[3], other[3], along[2][3], gram[3] = {0}, right[2] = {0};
  eo_tooth_point(tooth, part, 0, *p, *q, point, NULL);
  for (int d = 0; d < 2; d++) {
    double to = (d ? *q : *p) > 0.5 ? -step : step;
    eo_tooth_point(tooth, part, 0, d ? *p : *p + to, d ? *q + to : *q, other, NULL);
    for (int c = 0; c < 3; c++)
      along[d][c] = (other[c] - point[c]) / to;
  }
  for (int c = 0; c < 3; c++) {
    gram[0] += along[0][c] * along[0][c];
    gram[1] += along[0][c] * along[1][c];
    gram[2] += along[1][c] * along[1][c];
    right[0] += along[0][c] * (node[c] - point[c]);
    right[1] += along[1][c] * (node[c] - point[c]);
  }
  double determinant = gram[0] * gram[2] - gram[1] * gram[1];
  *p = clamp_profile(beyond, *p + (gram[2] * right[0] - gram[1] * right[1]) / determinant);
  *q = clamp(*q + (gram[0] * right[1] - gram[1] * right[0]) / determinant);
}

/* Distance of a point from the exact part, m: along its normal where the part is nearest, found step by step; beyond:
   how far the profile's parameter goes beyond its ends. */
static double distance_within(const struct eo_tooth *tooth, enum eo_tooth_part part, double beyond,
                              const double node[3])
{
  double p = 0.5, q = 0.5, best = 1, point[3], normal[3], other[3];
  for (int i = 0; i <= 12; i++)
    for (int k = 0; k <= 12; k++) {
      eo_tooth_point(tooth, part, 0, i / 12., k / 12., point, NULL);
      double d = apart(node, point);
      if (d < best) {
        best = d;
        p = i / 12.;
        q = k / 12.;
      }
    }
  if (best > 20e-3 + tooth->geometry->face_width / 12) /* not near this part */
    return best;
  for (double step = 1 / 24.; step > 1e-6;) { /* to the neighbour that is nearer, else closer around */
    double to[2] = {p, q}, nearest = best;
    for (int i = -1; i <= 1; i++)
      for (int k = -1; k <= 1; k++) {
        eo_tooth_point(tooth, part, 0, clamp_profile(beyond, p + i * step), clamp(q + k * step), other, NULL);
        if (apart(node, other) < nearest) {
          nearest = apart(node, other);
          to[0] = clamp_profile(beyond, p + i * step);
          to[1] = clamp(q + k * step);
        }
      }
    step = nearest < best ? step : step / 2;
    best = nearest;
    p = to[0];
    q = to[1];
  }
  for (int round = 0; round < 6; round++) { /* not over a kink, from where the way leads on */
    double to[2] = {p, q};
    refine(tooth, part, beyond, node, &to[0], &to[1]);
    eo_tooth_point(tooth, part, 0, to[0], to[1], other, NULL);
    if (!(apart(node, other) < best))
      break;
    best = apart(node, other);
    p = to[0];
    q = to[1];
  }
  eo_tooth_point(tooth, part, 0, p, q, point, normal);
  double along_normal = 0, whole = apart(node, point);
  for (int c = 0; c < 3; c++)
    along_normal += (node[c] - point[c]) * normal[c];
  return whole > 1e-6 ? whole : fabs(along_normal);
}

/* A flank's rack goes on beyond both ends of its active profile as far as the circles of its ends ask for; a way that
   is looked for there as well can end in a fold. */
__attribute__((unused)) static double distance_from(const struct eo_tooth *tooth, enum eo_tooth_part part,
                                                    const double node[3])
{
  const double beyond = 0.06;
  double own = distance_within(tooth, part, 0, node);
  bool flank = part == EO_TOOTH_DRIVE || part == EO_TOOTH_COAST;
  return flank && own > 1e-9 ? fmin(own, distance_within(tooth, part, beyond, node)) : own;
}

__attribute__((unused)) static bool make_mesh(const struct eo_design *design, const struct eo_geometry *geometry,
                                              int member, char folder[64])
{
  struct eo_text text = {0};
  struct eo_error error;
  char path[100], command[300];
  strcpy(folder, "/tmp/easeoff-step-XXXXXX");
  if (!mkdtemp(folder))
    return false;
  snprintf(path, sizeof path, "%s/tooth.step", folder);
  eo_step_write(design, geometry, member, false, &text);
  bool good = !eo_text_save(&text, path, &error);
  eo_text_done(&text);
  snprintf(command, sizeof command,
           "cd %s && timeout 120 gmsh -2 -clmax 9 -format msh2 -o tooth.msh tooth.step >log 2>&1", folder);
  return good && system(command) == 0;
}

__attribute__((unused)) static void remove_mesh(const char *folder)
{
  static const char *const names[] = {"tooth.step", "tooth.msh", "log"};
  char path[100];
  for (int i = 0; i < 3; i++) {
    snprintf(path, sizeof path, "%s/%s", folder, names[i]);
    unlink(path);
  }
  rmdir(folder);
}

#endif
