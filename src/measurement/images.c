/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/images_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measurement/scan.h"
#include "numerics/fft.h"

enum {
  LEAST_ROWS = 1024,
  FINER = 4,  /* lines of a spectrum per line that the rows can tell apart */
  BANDS = 32, /* of the residual's spectrum, each made level */
  BEATS = 9   /* that are looked at: of images, two of noise, the one of neighbours */
};
static const double KURTOSIS = 2.8; /* of noise, with its uncertainty, 3; of the steps of an encoder 1.8 to 2.4 */
static const double DEPTH = 0.1; /* of the beat in the square of the noise, relative: 0.3 of straight lines, less of an
                                     encoder whose noise goes with its lines */
static const double LINE = 12;   /* times the mean of its band: no noise */
static const double SCATTERED = 0.85; /* mean power of noise over median / ln 2: 1; of smooth curves 0.69 */
static const double SLOWEST = 3;      /* beats per turn of the pinion: slower ones the shafts make, too */

enum eo_code eo_images_new(struct eo_images **images, struct eo_error *error)
{
  struct eo_images *made = calloc(1, sizeof *made);
  *images = made;
  if (made)
    made->theta = malloc(sizeof *made->theta * 2 * EO_IMAGES_ROWS);
  if (!made || !made->theta)
    return eo_error_memory(error);
  made->residual = made->theta + EO_IMAGES_ROWS;
  return EO_OK;
}

void eo_images_free(struct eo_images *images)
{
  if (!images)
    return;
  free(images->theta);
  free(images->spectrum);
  free(images->power);
  free(images);
}

void eo_images_add(struct eo_images *images, double theta, double residual)
{
  bool again = images->count && images->theta[images->count - 1] == theta;
  if (images->count == EO_IMAGES_ROWS || again)
    return;
  images->theta[images->count] = theta;
  images->residual[images->count++] = residual;
}

/* Beats of orders with each other, with those that were not fitted too: frequencies that multiples of the mesh have, or
   seem to have at these rows. */
static bool is_mesh(const struct eo_images *images, double mesh, double beat)
{
  for (int i = 1; i <= 2 * EO_MESH_ORDERS; i++)
    if (fabs(fabs(remainder(i * mesh * eo_images_turns_per_row(images), 1)) - beat) * images->count < 1)
      return true;
  return false;
}

/* A frequency per row, with the height of its line in a spectrum above the mean of the others. */
struct beat {
  double frequency, in_images, in_noise;
  bool highest; /* of the images */
};

/* Adds the highest lines of the spectrum to list[BEATS]. mesh: order whose multiples do not count, 0: all count. */
static void list_lines(struct eo_images *images, double mesh, int most, struct beat *list, int *count)
{
  int first = (int)(SLOWEST * eo_images_turns_per_row(images) * images->size) + FINER, last = images->size / 2, n = 0;
  for (int i = first; i <= last; i++)
    images->power[n++] = eo_images_square(images->spectrum[i]);
  double mean = n ? eo_scan_quantile(images->power, n, 0.5) / M_LN2 : 0;
  for (int found = 0; found < most && *count + 1 < BEATS; found++) {
    int best = first;
    for (int i = first; i <= last; i++)
      best = eo_images_square(images->spectrum[i]) > eo_images_square(images->spectrum[best]) ? i : best;
    if (n < 1 || !(eo_images_square(images->spectrum[best]) > EO_IMAGES_CHANCE * mean))
      return;
    struct beat beat = {(double)best / images->size, eo_images_square(images->spectrum[best]) / mean, 0, *count == 0};
    if (!(mesh > 0 && is_mesh(images, mesh, beat.frequency)))
      list[(*count)++] = beat;
    else
      found--;
    for (int i = best - 2 * FINER > first ? best - 2 * FINER : first; i <= last && i <= best + 2 * FINER; i++)
      images->spectrum[i] = 0;
  }
}

/* Images: the residual is the curvature of the vibration times f (1 - f) with the place f between two recorded rows. */
static enum eo_code look_for_images(struct eo_images *images, const struct eo_order_line *mesh, int harmonics,
                                    struct eo_error *error)
{
  memset(images->spectrum, 0, sizeof *images->spectrum * (size_t)images->size);
  for (int i = 0; i < images->count; i++) {
    double complex wave = cexp(I * mesh[0].order * images->theta[i]), power = 1;
    double curvature = 0, turns = eo_images_turns_at(images, i);
    for (int h = 0; h < harmonics; h++)
      curvature += pow(mesh[h].order * turns, 2) * creal(mesh[h].amplitude * (power *= wave));
    images->spectrum[i] = images->residual[i] * curvature;
  }
  return eo_fft_forward(NULL, images->size, images->spectrum, error);
}

/* Makes the residual's spectrum level and takes its lines out: noise is left. */
static void whiten(struct eo_images *images)
{
  int width = images->size / BANDS; /* of one sign of the frequency, and of the other */
  images->spectrum[0] = images->spectrum[images->size / 2] = 0;
  for (int from = 0; from < images->size / 2; from += width / 2) {
    int n = 0;
    for (int i = from; i < from + width / 2; i++)
      images->power[n++] = eo_images_square(images->spectrum[i]);
    double mean = eo_scan_quantile(images->power, n, 0.5) / M_LN2;
    for (int i = from; i < from + width / 2; i++) {
      double factor = mean > 0 && eo_images_square(images->spectrum[i]) <= LINE * mean ? 1 / sqrt(mean) : 0;
      images->spectrum[i] *= factor;
      if (i)
        images->spectrum[images->size - i] *= factor;
    }
  }
}

static double kurtosis(const struct eo_images *images)
{
  double second = 0, fourth = 0;
  for (int i = 0; i < images->count; i++) {
    second += pow(images->residual[i], 2) / images->count;
    fourth += pow(images->residual[i], 4) / images->count;
  }
  return fourth / (second * second);
}

/* Mean power of the noise, without lines, in an eighth of the rows' rate, the k-th from above; *sine: mean of sin^2 of
   half the phase from row to row there. 0 where the powers do not scatter as those of noise: what an even curve leaves,
   as of angles that were computed, is alike from line to line. */
static double power_in_band(struct eo_images *images, int k, double *sine)
{
  enum { SLICES = 8 }; /* within which the level is the same, or nearly: a line stands out of its own */
  double from = 0.5 - 0.125 * (k + 1), to = from + 0.125, sum = 0, level = 0;
  int all = 0, kept = 0;
  for (int slice = 0; slice < SLICES; slice++) {
    double first = from + 0.125 * slice / SLICES, last = first + 0.125 / SLICES;
    int n = 0;
    for (int i = (int)(first * images->size) + 1; i < (int)(last * images->size); i++)
      images->power[n++] = eo_images_square(images->spectrum[i]);
    double usual = n ? eo_scan_quantile(images->power, n, 0.5) / M_LN2 : 0;
    for (int i = 0; i < n; i++)
      if (images->power[i] <= LINE * usual) {
        sum += images->power[i];
        kept++;
      }
    level += n * usual;
    all += n;
  }
  *sine = 0.5 - (sin(2 * M_PI * to) - sin(2 * M_PI * from)) / (4 * M_PI * (to - from));
  return kept && sum / kept > SCATTERED * level / all ? sum / kept : 0;
}

/* Means of neighbours have less of what alternates from row to row: the power of their noise goes with
   1 - q sin^2(phase / 2), q = 4 f (1 - f) on the place f between them. q, where the upper two bands say so beyond
   chance, the third agrees and it is no rounding; 0 where they do not, or where the power falls off more steeply than
   any mean's. */
static double alike_neighbours(struct eo_images *images)
{
  double power[3], sine[3], chance = sqrt(2 / (images->count / 8.0)); /* of a ratio of two bands, relative */
  for (int k = 0; k < 3; k++)
    power[k] = power_in_band(images, k, &sine[k]);
  double ratio = power[1] / power[0], most = (1 - sine[1]) / (1 - sine[0]);
  if (!(power[0] > 0 && power[2] > 0 && ratio > 1 + EO_IMAGES_SURE * chance &&
        ratio < most * (1 + EO_IMAGES_SURE * chance)))
    return 0;
  /* theory (M8) */
  double q = fmin(1, (ratio - 1) / (ratio * sine[0] - sine[1])), expected = (1 - q * sine[2]) / (1 - q * sine[1]);
  return fabs(power[2] / power[1] / expected - 1) < EO_IMAGES_ALIKE && kurtosis(images) > KURTOSIS ? q : 0;
}

/* Where the beat changes its sign from row to row and the rows stand a quarter before or behind recorded ones, noise
   and images are as large in each row; but every other pair of neighbours has a recorded row in common. The height of
   that above chance. */
static double shared_neighbours(const struct eo_images *images)
{
  double sum = 0, squares = 0;
  for (int i = 0; i + 1 < images->count; i++) {
    double both = creal(images->spectrum[i ? images->size - i : 0]) * creal(images->spectrum[images->size - i - 1]);
    sum += i % 2 ? -both : both;
    squares += both * both;
  }
  return squares > 0 ? sum * sum / squares : 0;
}

/* Noise of two recorded rows is less on the middle between them than at either: its square goes with the beat. */
static enum eo_code look_at_noise(struct eo_images *images, double *alike, double *shared, struct eo_error *error)
{
  double mean = 0;
  memset(images->spectrum, 0, sizeof *images->spectrum * (size_t)images->size);
  for (int i = 0; i < images->count; i++)
    images->spectrum[i] = images->residual[i];
  EO_TRY(eo_fft_forward(NULL, images->size, images->spectrum, error));
  *alike = alike_neighbours(images);
  whiten(images);
  EO_TRY(eo_fft_forward(NULL, images->size, images->spectrum, error)); /* the rows from behind */
  *shared = shared_neighbours(images);
  for (int i = 0; i < images->count; i++) {
    images->power[i] = eo_images_square(images->spectrum[i ? images->size - i : 0]);
    mean += images->power[i] / images->count;
  }
  memset(images->spectrum, 0, sizeof *images->spectrum * (size_t)images->size);
  for (int i = 0; i < images->count; i++)
    images->spectrum[i] = images->power[i] - mean;
  return eo_fft_forward(NULL, images->size, images->spectrum, error);
}

/* What straight lines with a beat take away. It is there where images and noise have it both (noise of an encoder's
   steps as well: there the images have to be one), where all images are there as one, or where noise that is no
   rounding has it. */
static void judge_beat(struct eo_images *images, const struct eo_order_line *mesh, int harmonics, int asked,
                       const struct beat *beat, struct eo_images_found *found)
{
  struct eo_image_rate list[EO_IMAGE_RATES];
  double rest = 0;
  int count = eo_image_rates_find(images, beat->frequency, mesh, harmonics, asked, list);
  if (!count)
    return;
  for (int i = 0; i < images->count; i++)
    rest += images->residual[i] * images->residual[i] / images->count;
  const struct eo_image_rate *best = eo_image_likeliest(list, count, rest);
  if (!eo_image_can_be(best, rest))
    return;
  rest -= eo_image_explained(best, 2) / images->count;
  bool rounded = kurtosis(images) <= KURTOSIS,
       both = beat->in_images > EO_IMAGES_CHANCE && beat->in_noise > EO_IMAGES_CHANCE &&
              (!rounded || eo_image_can_be_one(best, rest)),
       noise = beat->in_noise > fmax(EO_IMAGES_CHANCE, DEPTH * DEPTH * images->count / 8) && !rounded;
  double loss = noise ? eo_image_most_lost(best, rest) : fmin(1, eo_image_share(best)) * best->loss;
  bool there = both || noise || (beat->highest && eo_image_is_whole(best, rest, images->count));
  if (there && loss > found->loss) {
    found->rate = best->rate;
    found->share = eo_image_share(best);
    found->loss = loss;
  }
}

/* Of the RMS of some orders, where they went through means of neighbours as the noise did. */
static double alike_loss(double alike, const struct eo_order_line *mesh, int orders, double turns)
{
  double left = 0, whole = 0;
  for (int h = 0; h < orders; h++) {
    /* theory (M8) */
    double gain = 1 - alike * pow(sin(M_PI * mesh[h].order * turns), 2),
           acceleration = pow(mesh[h].order, 4) * eo_images_square(mesh[h].amplitude);
    left += acceleration;
    whole += acceleration / gain;
  }
  return 1 - sqrt(left / whole);
}

/* Beats that the noise has: those that the images have too are one. */
static void join_beats(struct beat *list, int of_images, int count, int rows)
{
  for (int i = of_images; i < count; i++) {
    list[i].in_noise = list[i].in_images;
    list[i].in_images = 0;
    list[i].highest = false;
    for (int k = 0; k < of_images; k++)
      if (fabs(list[k].frequency - list[i].frequency) * rows < 2) {
        list[k].in_noise = list[i].in_noise;
        list[i].in_images = list[k].in_images;
      }
  }
}

enum eo_code eo_images_find(struct eo_images *images, const struct eo_order_line *mesh, int harmonics, int asked,
                            struct eo_images_found *found, struct eo_error *error)
{
  struct beat beat[BEATS];
  int count = 0;
  double alike = 0, shared = 0;
  *found = (struct eo_images_found){0};
  if (images->count < LEAST_ROWS)
    return EO_OK;
  for (images->size = 2 * BANDS; images->size < FINER * images->count;)
    images->size *= 2;
  images->spectrum = malloc(sizeof *images->spectrum * (size_t)images->size);
  images->power = malloc(sizeof *images->power * (size_t)images->size);
  if (!images->spectrum || !images->power)
    return eo_error_memory(error);
  EO_TRY(look_for_images(images, mesh, harmonics, error));
  list_lines(images, mesh[0].order, BEATS - 3, beat, &count);
  int of_images = count;
  EO_TRY(look_at_noise(images, &alike, &shared, error));
  found->alike = alike;
  found->alike_loss = alike_loss(alike, mesh, asked, eo_images_turns_per_row(images));
  list_lines(images, 0, 2, beat, &count);
  if (shared > EO_IMAGES_CHANCE)
    beat[count++] = (struct beat){.frequency = 0.5, .in_images = shared};
  join_beats(beat, of_images, count, images->count);
  for (int i = 0; i < count; i++)
    judge_beat(images, mesh, harmonics, asked, &beat[i], found);
  return EO_OK;
}
