/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What straight lines between recorded rows leave in the residual of the fit. A program that brings a channel to other
   times on straight lines takes the mesh orders down, by up to a third of them, and leaves what it took beside them: an
   image of every order on either side of the recorded rate, and noise that swells with the place between two recorded
   rows. Both go with the beat of the two rates, which no gear knows of. Where the recorded rate is the same as that of
   the rows, or a multiple, nothing beats; then the noise of neighbouring rows is alike. */
#ifndef EASEOFF_MEASUREMENT_IMAGES_H
#define EASEOFF_MEASUREMENT_IMAGES_H

#include "measurement/orders.h"

enum { EO_IMAGES_ROWS = 1 << 16 }; /* looked at, the first ones */

struct eo_images; /* opaque */

struct eo_images_found {
  double rate;  /* recorded rows per row, the likeliest of those with this beat; 0: no beat was found */
  double share; /* of the vibration that went through the straight lines: 1, or that of one shaft */
  double loss;  /* what that may have taken from the RMS of the orders asked for, relative */
  double alike; /* 1 - power of the noise that alternates from row to row, relative to slow noise; 0: none is missing */
  double alike_loss; /* of the RMS, where the orders went the same way */
};

/* Errors: memory. */
enum eo_code eo_images_new(struct eo_images **images, struct eo_error *error);
void eo_images_free(struct eo_images *images);

/* The next row: angle of the axis, rad, and what the fit leaves, m. Beyond EO_IMAGES_ROWS
   none is taken; one that repeats the angle before it tells nothing. */
void eo_images_add(struct eo_images *images, double theta, double residual);

/* mesh[harmonics]: orders that were fitted, of which the first `asked` are the answer. Errors: memory. */
enum eo_code eo_images_find(struct eo_images *images, const struct eo_order_line *mesh, int harmonics, int asked,
                            struct eo_images_found *found, struct eo_error *error);

#endif
