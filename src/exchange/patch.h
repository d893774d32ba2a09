/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A smooth piece of a surface as one bicubic B-spline through exact points: clamped, knots by averaging (de Boor's
   rule), as many points as its error asks for. */
#ifndef EASEOFF_EXCHANGE_PATCH_H
#define EASEOFF_EXCHANGE_PATCH_H

#include <stdbool.h>

enum { EO_PATCH_LEAST = 6, EO_PATCH_MOST = 64 };

/* Point (m) and unit normal (may be NULL) of the exact surface at p, q in 0..1. */
typedef void eo_patch_surface(const void *context, double p, double q, double point[3], double normal[3]);

struct eo_patch {
  int count[2]; /* points along p and q */
  double knot[2][EO_PATCH_MOST + 4];
  double control[EO_PATCH_MOST * EO_PATCH_MOST][3]; /* [along p][along q], m */
};

/* Interpolates count[0] times count[1] points; false: the system is singular (equal points). */
bool eo_patch_fit(struct eo_patch *patch, const int count[2], eo_patch_surface *surface, const void *context);

/* The spline's point. */
void eo_patch_at(const struct eo_patch *patch, double p, double q, double point[3]);

/* Largest distances from the exact surface along its normal, m, half way between the points: along p, along q, along
   both. */
enum { EO_PATCH_BOTH = 2, EO_PATCH_ERRORS };
void eo_patch_error(const struct eo_patch *patch, eo_patch_surface *surface, const void *context,
                    double error[EO_PATCH_ERRORS]);

#endif
