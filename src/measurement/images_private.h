/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What images.c, which looks for beats, shares with images_rates.c, which tells the recorded rate of a beat. */
#ifndef EASEOFF_MEASUREMENT_IMAGES_PRIVATE_H
#define EASEOFF_MEASUREMENT_IMAGES_PRIVATE_H

#include "measurement/images.h"

#include <complex.h>
#include <stdbool.h>

#define EO_IMAGES_CHANCE 25.0 /* times the mean of the other lines: chance leaves 20 in one of 10,000 */
#define EO_IMAGES_SURE 5.0    /* standard deviations */
#define EO_IMAGES_ALIKE 0.25  /* by which the strongest image may differ from the others, relative */

enum { EO_IMAGE_RATES = 5 /* with one beat */ };

struct eo_images {
  int count, size;          /* rows; samples of a spectrum */
  double *theta;            /* [EO_IMAGES_ROWS] owned, with the others */
  double *residual;         /* [EO_IMAGES_ROWS] */
  double complex *spectrum; /* [size] owned */
  double *power;            /* [size] owned */
};

/* The images that a recorded rate makes of the orders, beside what is there. */
struct eo_image_rate {
  double rate;     /* recorded rows per row */
  double loss;     /* of the RMS that is asked for, when all vibration went through straight lines */
  int side, order; /* of the strongest image: below (-1) or above the rate */
  struct eo_image_match {
    double product[2]; /* of the residual with the real and the imaginary part */
    double energy[3];  /* of the real part, of the imaginary one, of both */
  } match[3];          /* the strongest image, the others, all */
};

double eo_images_square(double complex z);
/* Turns of the pinion per row, at a row and in the mean. */
double eo_images_turns_at(const struct eo_images *images, int row);
double eo_images_turns_per_row(const struct eo_images *images);

/* Rates with one beat, those that carry every order: beyond half of a rate an order is its own image. Returns how many
   there are. */
int eo_image_rates_find(const struct eo_images *images, double beat, const struct eo_order_line *mesh, int harmonics,
                        int asked, struct eo_image_rate list[EO_IMAGE_RATES]);

/* The likeliest of them, of those whose share can be: the most is explained; where chance may have done that, the most
   may be lost. rest: mean square of the residual. */
const struct eo_image_rate *eo_image_likeliest(const struct eo_image_rate *list, int count, double rest);

/* Square sum of the residual that the strongest image (0), the others (1) or all of them (2) are. */
double eo_image_explained(const struct eo_image_rate *candidate, int part);
/* Of the vibration: 1 where both channels went through straight lines, more is none of their making. */
double eo_image_share(const struct eo_image_rate *candidate);
/* What a rate may have taken from the RMS, as far as noise lets it tell. */
double eo_image_most_lost(const struct eo_image_rate *candidate, double rest);
/* Whether the data allow a share that is not more than all of the vibration. */
bool eo_image_can_be(const struct eo_image_rate *candidate, double rest);
/* Whether the strongest image and the others may be there as one, as far as noise lets it tell. */
bool eo_image_can_be_one(const struct eo_image_rate *candidate, double rest);
/* Whether the images of a rate are all there, as one, and much of what is left; rest: mean square of what is no image.
 */
bool eo_image_is_whole(const struct eo_image_rate *candidate, double rest, int rows);

#endif
