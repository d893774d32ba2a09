/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ellipse that the sine and cosine tracks of an encoder draw, and the angle on it (Heydemann 1981): offsets,
   unequal gain and a phase that is not 90 degrees, from a least squares conic through the samples. */
#ifndef EASEOFF_MEASUREMENT_ELLIPSE_H
#define EASEOFF_MEASUREMENT_ELLIPSE_H

#include <stdbool.h>
#include <stdint.h>

/* Sums of the products of x^2, xy, y^2, x, y and 1 over the samples, taken about a point and in a unit near their
   centre and size, so that fourth powers stay near 1. */
struct eo_ellipse_sums {
  double centre[2], scale;
  int64_t count;
  double moment[6][6];
};

/* sine = offset[0] + amplitude[0] sin(a), cosine = offset[1] + amplitude[1] cos(a - skew). */
struct eo_ellipse {
  double offset[2];
  double amplitude[2]; /* zero to peak, in the unit of the samples */
  double skew;         /* rad: the phase between the tracks is 90 degrees + skew */
};

/* centre: any point inside, scale: any size about the amplitude. */
void eo_ellipse_start(struct eo_ellipse_sums *sums, const double centre[2], double scale);
void eo_ellipse_add(struct eo_ellipse_sums *sums, double sine, double cosine);

/* False when the samples do not draw an ellipse (constant, a line, too few). */
bool eo_ellipse_fit(const struct eo_ellipse_sums *sums, struct eo_ellipse *ellipse);

/* The angle in -pi..pi. */
double eo_ellipse_angle(const struct eo_ellipse *ellipse, double sine, double cosine);

#endif
