/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A smooth piece of a surface as one bicubic B-spline through exact points: clamped, knots by averaging (de Boor's
   rule). Where the error asks for it the points lie closer, so a relief that starts with a bend, or a piece that ends
   in a point, has its many points there alone. */
#ifndef EASEOFF_EXCHANGE_PATCH_H
#define EASEOFF_EXCHANGE_PATCH_H

#include <stdbool.h>

enum { EO_PATCH_MOST = 64 };

/* Point (m) and unit normal (may be NULL) of the exact surface at p, q in 0..1. */
typedef void eo_patch_surface(const void *context, double p, double q, double point[3], double normal[3]);

/* Parameters 0..1 of the points along one direction, increasing, both ends among them. */
struct eo_patch_sites {
  int count;
  double at[EO_PATCH_MOST];
};

struct eo_patch {
  struct eo_patch_sites sites[2]; /* along p and q */
  double knot[2][EO_PATCH_MOST + 4];
  double control[EO_PATCH_MOST * EO_PATCH_MOST][3]; /* [along p][along q], m */
};

/* count sites, 2..EO_PATCH_MOST, evenly over 0..1. */
struct eo_patch_sites eo_patch_even_sites(int count);

/* Halves the intervals that are wide, as many as there is room for; false: for none. */
bool eo_patch_halve(struct eo_patch_sites *sites, const bool wide[EO_PATCH_MOST]);

/* Interpolates points at the sites; false: the system is singular (equal points). */
bool eo_patch_fit(struct eo_patch *patch, const struct eo_patch_sites *const sites[2], eo_patch_surface *surface,
                  const void *context);

/* Largest distance from the exact surface along its normal, m, half way between the points along p, q and both. Sets
   those intervals wide[along p, along q] where it is above the tolerance. */
double eo_patch_error(const struct eo_patch *patch, eo_patch_surface *surface, const void *context, double tolerance,
                      bool wide[2][EO_PATCH_MOST]);

#endif
