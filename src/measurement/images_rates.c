/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recorded rates that make one beat with the rows, and how the images that each would make fit the residual. */
#include <math.h>

#include "measurement/images_private.h"

enum { APART = 8 /* rows on either side from which the speed at a row follows */ };
static const double MUCH = 0.5;       /* of what is no image */
static const double MOST_TURNS = 0.9; /* of an order between two recorded rows: at 1 one of its images stands still */
static const double FLAT = 1e-9;      /* of an energy: rounding */

double eo_images_turns_at(const struct eo_images *images, int row)
{
  int from = row < APART ? 0 : row - APART, to = row + APART < images->count ? row + APART : images->count - 1;
  return fabs(images->theta[to] - images->theta[from]) / (2 * M_PI * (to - from));
}

double eo_images_square(double complex z)
{
  return creal(z) * creal(z) + cimag(z) * cimag(z);
}

double eo_images_turns_per_row(const struct eo_images *images)
{
  return fabs(images->theta[images->count - 1] - images->theta[0]) / (2 * M_PI * (images->count - 1));
}

/* An image of a wave that turns by `turns` from one recorded row to the next, as a part of what is left of the wave. */
static double image_of(double turns, int side)
{
  /* theory (M7) */
  double ratio = turns / (1 + side * turns);
  return ratio * ratio;
}

static void set_candidate(struct eo_image_rate *candidate, double rate, const struct eo_order_line *mesh, int harmonics,
                          double turns)
{
  double most = 0;
  *candidate = (struct eo_image_rate){.rate = rate};
  for (int h = 0; h < harmonics; h++) {
    double phase = mesh[h].order * turns / rate;
    for (int side = -1; side <= 1; side += 2)
      if (image_of(phase, side) * cabs(mesh[h].amplitude) > most) {
        most = image_of(phase, side) * cabs(mesh[h].amplitude);
        candidate->side = side;
        candidate->order = h;
      }
  }
}

/* Of the RMS of some orders, when all vibration went through straight lines. */
static double loss_of(const struct eo_image_rate *candidate, const struct eo_order_line *mesh, int orders, double turns)
{
  double left = 0, whole = 0;
  for (int h = 0; h < orders; h++) {
    double phase = mesh[h].order * turns / candidate->rate, gain = pow(sin(M_PI * phase) / (M_PI * phase), 2),
           acceleration = pow(mesh[h].order, 4) * eo_images_square(mesh[h].amplitude);
    left += acceleration;
    whole += acceleration / (gain * gain);
  }
  return 1 - sqrt(left / whole);
}

static void add_row(struct eo_image_rate *candidate, const struct eo_images *images, int row,
                    const double complex *vibration, const double *order, int harmonics)
{
  double turns = eo_images_turns_at(images, row) / candidate->rate, phase = candidate->rate * row;
  double complex strongest = 0, all = 0, beat = cexp(2 * M_PI * I * (phase - floor(phase)));
  for (int h = 0; h < harmonics; h++)
    for (int side = -1; side <= 1; side += 2) {
      double complex image = image_of(fmin(order[h] * turns, MOST_TURNS), side) *
                             (side > 0 ? vibration[h] : conj(vibration[h])) * beat;
      all += image;
      if (h == candidate->order && side == candidate->side)
        strongest = image;
    }
  const double complex part[3] = {strongest, all - strongest, all};
  for (int k = 0; k < 3; k++) {
    struct eo_image_match *match = &candidate->match[k];
    double real = creal(part[k]), imaginary = cimag(part[k]);
    match->product[0] += images->residual[row] * real;
    match->product[1] += images->residual[row] * imaginary;
    match->energy[0] += real * real;
    match->energy[1] += imaginary * imaginary;
    match->energy[2] += real * imaginary;
  }
}

/* What is found of the images as a complex factor, by least squares; its phase is that of the recorded rows. Where the
   beat changes its sign from row to row, the images on either side of the rate are one, and the imaginary part, their
   difference, is far smaller than the real one. */
static double complex factor_of(const struct eo_image_rate *candidate, int part)
{
  const struct eo_image_match *match = &candidate->match[part];
  const double *energy = match->energy;
  double det = energy[0] * energy[1] - energy[2] * energy[2];
  if (!(det > FLAT * energy[0] * energy[0]))
    return energy[0] > 0 ? match->product[0] / energy[0] : 0;
  return (energy[1] * match->product[0] - energy[2] * match->product[1]) / det -
         I * (energy[0] * match->product[1] - energy[2] * match->product[0]) / det;
}

double eo_image_explained(const struct eo_image_rate *candidate, int part)
{
  double complex factor = factor_of(candidate, part);
  return creal(factor) * candidate->match[part].product[0] - cimag(factor) * candidate->match[part].product[1];
}

/* Standard deviation of a factor in the direction that is known least; rest: mean square of what is no image. */
static double unsure(const struct eo_image_rate *candidate, int part, double rest)
{
  const double *energy = candidate->match[part].energy;
  double least = (energy[0] + energy[1]) / 2 - hypot((energy[0] - energy[1]) / 2, energy[2]);
  return least > FLAT * energy[0] ? sqrt(rest / least) : INFINITY;
}

static void add_rows(struct eo_image_rate *list, int count, const struct eo_images *images,
                     const struct eo_order_line *mesh, int harmonics)
{
  double order[EO_MESH_ORDERS];
  double complex vibration[EO_MESH_ORDERS];
  for (int h = 0; h < harmonics; h++)
    order[h] = mesh[h].order;
  for (int i = 0; i < images->count; i++) {
    double complex wave = cexp(I * order[0] * images->theta[i]), power = 1;
    for (int h = 0; h < harmonics; h++)
      vibration[h] = mesh[h].amplitude * (power *= wave);
    for (int k = 0; k < count; k++)
      add_row(&list[k], images, i, vibration, order, harmonics);
  }
}

int eo_image_rates_find(const struct eo_images *images, double beat, const struct eo_order_line *mesh, int harmonics,
                        int asked, struct eo_image_rate list[EO_IMAGE_RATES])
{
  const double rate[EO_IMAGE_RATES] = {beat, 1 - beat, 1 + beat, 2 - beat, 2 + beat};
  double turns = eo_images_turns_per_row(images);
  int count = 0;
  for (int i = 0; i < EO_IMAGE_RATES; i++)
    if (mesh[harmonics - 1].order * turns < MOST_TURNS * rate[i])
      set_candidate(&list[count++], rate[i], mesh, harmonics, turns);
  add_rows(list, count, images, mesh, harmonics);
  for (int i = 0; i < count; i++)
    list[i].loss = loss_of(&list[i], mesh, asked, turns);
  return count;
}

double eo_image_share(const struct eo_image_rate *candidate)
{
  return cabs(factor_of(candidate, 2));
}

bool eo_image_can_be(const struct eo_image_rate *candidate, double rest)
{
  enum { PLACES = 64 };
  const double *energy = candidate->match[2].energy;
  double complex factor = factor_of(candidate, 2);
  double least = cabs(factor) < 1 + EO_IMAGES_ALIKE ? 0 : INFINITY;
  for (int i = 0; i < PLACES; i++) {
    double complex off = conj(factor - (1 + EO_IMAGES_ALIKE) * cexp(2 * M_PI * I * i / PLACES)); /* of the two parts */
    least = fmin(least, energy[0] * creal(off) * creal(off) + energy[1] * cimag(off) * cimag(off) +
                            2 * energy[2] * creal(off) * cimag(off));
  }
  return least < EO_IMAGES_SURE * EO_IMAGES_SURE * rest;
}

bool eo_image_can_be_one(const struct eo_image_rate *candidate, double rest)
{
  double complex strongest = factor_of(candidate, 0), others = factor_of(candidate, 1);
  return cabs(others - strongest) < EO_IMAGES_ALIKE * cabs(strongest) + EO_IMAGES_SURE * unsure(candidate, 1, rest);
}

bool eo_image_is_whole(const struct eo_image_rate *candidate, double rest, int rows)
{
  double complex strongest = factor_of(candidate, 0), others = factor_of(candidate, 1);
  return cabs(others - strongest) < EO_IMAGES_ALIKE * cabs(strongest) &&
         eo_image_explained(candidate, 1) > 2 * EO_IMAGES_CHANCE * rest &&
         eo_image_explained(candidate, 2) > MUCH * rest * rows;
}

double eo_image_most_lost(const struct eo_image_rate *candidate, double rest)
{
  return fmin(1, eo_image_share(candidate) + 2 * unsure(candidate, 2, rest)) * candidate->loss;
}

const struct eo_image_rate *eo_image_likeliest(const struct eo_image_rate *list, int count, double rest)
{
  const struct eo_image_rate *best = list;
  for (int i = 1; i < count; i++) {
    double more = eo_image_explained(&list[i], 2) - eo_image_explained(best, 2);
    bool better = fabs(more) > EO_IMAGES_CHANCE * rest
                      ? more > 0
                      : eo_image_most_lost(&list[i], rest) > eo_image_most_lost(best, rest);
    if (eo_image_can_be(&list[i], rest) && (better || !eo_image_can_be(best, rest)))
      best = &list[i];
  }
  return best;
}
