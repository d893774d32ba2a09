/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forces put on the nodes of a shaft, and what a deflection is at a place of the face: both linear between the nodes.
 */
#ifndef EASEOFF_TESTS_SUPPORT_SHAFT_LOAD_H
#define EASEOFF_TESTS_SUPPORT_SHAFT_LOAD_H

#include "contact/field.h"

/* Node below eta, and how far eta is on the way to the next one. */
static inline int shaft_node(double face_width, double eta, double *way)
{
  double u = (eta / face_width + 0.5) * (EO_DEFLECTION_NODES - 1);
  int i = u < 0 ? 0 : u > EO_DEFLECTION_NODES - 2 ? EO_DEFLECTION_NODES - 2 : (int)u;
  *way = u - i;
  return i;
}

/* Adds the normal force (N) at (s, eta). */
static inline void shaft_load_add(struct eo_deflection *load, double face_width, double s, double eta, double force)
{
  double way;
  int i = shaft_node(face_width, eta, &way);
  for (int k = 0; k < 2; k++) {
    double share = force * (k ? way : 1 - way);
    load->part[0][i + k] += share;
    load->part[1][i + k] += s * share;
  }
}

__attribute__((unused)) static double shaft_deflection_at(const struct eo_deflection *deflection, double face_width,
                                                          double s, double eta)
{
  double way, part[2];
  int i = shaft_node(face_width, eta, &way);
  for (int k = 0; k < 2; k++)
    part[k] = deflection->part[k][i] + way * (deflection->part[k][i + 1] - deflection->part[k][i]);
  return part[0] + s * part[1];
}

#endif
