/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/images.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measurement/scan.h"
#include "numerics/fft.h"

enum {
  LEAST_ROWS = 1024,
  FINER = 4,  /* lines of a spectrum per line that the rows can tell apart */
  BANDS = 32, /* of the residual's spectrum, each made level */
  APART = 8,  /* rows on either side from which the speed at a row follows */
  RATES = 5,  /* with the same beat */
  BEATS = 8   /* that are looked at */
};
static const double CHANCE = 25;    /* times the mean of the other lines: chance leaves 20 in one of 10,000 */
static const double KURTOSIS = 2.8; /* of noise, with its uncertainty, 3; of the steps of an encoder 1.8 to 2.4 */
static const double DEPTH = 0.1; /* of the beat in the square of the noise, relative: 0.3 of straight lines, less of an
                                     encoder whose noise goes with its lines */
static const double MUCH = 0.5;  /* of what is no image */
static const double LINE = 12;   /* times the mean of its band: no noise */
static const double SCATTERED = 0.85; /* mean power of noise over median / ln 2: 1; of smooth curves 0.69 */
static const double SLOWEST = 3;      /* beats per turn of the pinion: slower ones the shafts make, too */
static const double MOST_TURNS = 0.9; /* of an order between two recorded rows: at 1 one of its images stands still */
static const double SURE = 5;         /* standard deviations */
static const double ALIKE = 0.25;     /* by which the strongest image may differ from the others, relative */

struct eo_images {
  int count, size;          /* rows; samples of a spectrum */
  double *theta;            /* [EO_IMAGES_ROWS] owned, with the others */
  double *residual;         /* [EO_IMAGES_ROWS] */
  double complex *spectrum; /* [size] owned */
  double *power;            /* [size] owned */
};

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

/* Turns of the pinion per row, at a row. */
static double turns_at(const struct eo_images *images, int row)
{
  int from = row < APART ? 0 : row - APART, to = row + APART < images->count ? row + APART : images->count - 1;
  return fabs(images->theta[to] - images->theta[from]) / (2 * M_PI * (to - from));
}

static double square(double complex z)
{
  return creal(z) * creal(z) + cimag(z) * cimag(z);
}

static double turns_per_row(const struct eo_images *images)
{
  return fabs(images->theta[images->count - 1] - images->theta[0]) / (2 * M_PI * (images->count - 1));
}

/* Beats of orders with each other, with those that were not fitted too: frequencies that multiples of the mesh have, or
   seem to have at these rows. */
static bool is_mesh(const struct eo_images *images, double mesh, double beat)
{
  for (int i = 1; i <= 2 * EO_MESH_ORDERS; i++)
    if (fabs(fabs(remainder(i * mesh * turns_per_row(images), 1)) - beat) * images->count < 1)
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
  int first = (int)(SLOWEST * turns_per_row(images) * images->size) + FINER, last = images->size / 2, n = 0;
  for (int i = first; i <= last; i++)
    images->power[n++] = square(images->spectrum[i]);
  double mean = n ? eo_scan_quantile(images->power, n, 0.5) / M_LN2 : 0;
  for (int found = 0; found < most && *count < BEATS; found++) {
    int best = first;
    for (int i = first; i <= last; i++)
      best = square(images->spectrum[i]) > square(images->spectrum[best]) ? i : best;
    if (n < 1 || !(square(images->spectrum[best]) > CHANCE * mean))
      return;
    struct beat beat = {(double)best / images->size, square(images->spectrum[best]) / mean, 0, *count == 0};
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
    double curvature = 0, turns = turns_at(images, i);
    for (int h = 0; h < harmonics; h++)
      curvature += pow(mesh[h].order * turns, 2) * creal(mesh[h].amplitude * (power *= wave));
    images->spectrum[i] = images->residual[i] * curvature;
  }
  return eo_fft_forward(images->size, images->spectrum, error);
}

/* Makes the residual's spectrum level and takes its lines out: noise is left. */
static void whiten(struct eo_images *images)
{
  int width = images->size / BANDS; /* of one sign of the frequency, and of the other */
  images->spectrum[0] = images->spectrum[images->size / 2] = 0;
  for (int from = 0; from < images->size / 2; from += width / 2) {
    int n = 0;
    for (int i = from; i < from + width / 2; i++)
      images->power[n++] = square(images->spectrum[i]);
    double mean = eo_scan_quantile(images->power, n, 0.5) / M_LN2;
    for (int i = from; i < from + width / 2; i++) {
      double factor = mean > 0 && square(images->spectrum[i]) <= LINE * mean ? 1 / sqrt(mean) : 0;
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
  double from = 0.5 - 0.125 * (k + 1), to = from + 0.125, sum = 0;
  int n = 0, kept = 0;
  for (int i = (int)(from * images->size) + 1; i < (int)(to * images->size); i++)
    images->power[n++] = square(images->spectrum[i]);
  *sine = 0.5 - (sin(2 * M_PI * to) - sin(2 * M_PI * from)) / (4 * M_PI * (to - from));
  double usual = n ? eo_scan_quantile(images->power, n, 0.5) / M_LN2 : 0;
  for (int i = 0; i < n; i++)
    if (images->power[i] <= LINE * usual) {
      sum += images->power[i];
      kept++;
    }
  return kept && sum / kept > SCATTERED * usual ? sum / kept : 0;
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
  if (!(power[0] > 0 && power[2] > 0 && ratio > 1 + SURE * chance && ratio < most * (1 + SURE * chance)))
    return 0;
  /* theory (M8) */
  double q = fmin(1, (ratio - 1) / (ratio * sine[0] - sine[1])), expected = (1 - q * sine[2]) / (1 - q * sine[1]);
  return fabs(power[2] / power[1] / expected - 1) < ALIKE && kurtosis(images) > KURTOSIS ? q : 0;
}

/* Noise of two recorded rows is less on the middle between them than at either: its square goes with the beat. */
static enum eo_code look_at_noise(struct eo_images *images, double *alike, struct eo_error *error)
{
  double mean = 0;
  memset(images->spectrum, 0, sizeof *images->spectrum * (size_t)images->size);
  for (int i = 0; i < images->count; i++)
    images->spectrum[i] = images->residual[i];
  EO_TRY(eo_fft_forward(images->size, images->spectrum, error));
  *alike = alike_neighbours(images);
  whiten(images);
  EO_TRY(eo_fft_forward(images->size, images->spectrum, error)); /* the rows from behind */
  for (int i = 0; i < images->count; i++) {
    images->power[i] = square(images->spectrum[i ? images->size - i : 0]);
    mean += images->power[i] / images->count;
  }
  memset(images->spectrum, 0, sizeof *images->spectrum * (size_t)images->size);
  for (int i = 0; i < images->count; i++)
    images->spectrum[i] = images->power[i] - mean;
  return eo_fft_forward(images->size, images->spectrum, error);
}

/* The images that a recorded rate makes of the orders, beside what is there. */
struct candidate {
  double rate;     /* recorded rows per row */
  int side, order; /* of the strongest image: below (-1) or above the rate */
  /* [0] the strongest image, [1] the others, [2] all */
  double complex product[3]; /* with the residual */
  double energy[3];
};

/* An image of a wave that turns by `turns` from one recorded row to the next, as a part of what is left of the wave. */
static double image_of(double turns, int side)
{
  /* theory (M7) */
  double ratio = turns / (1 + side * turns);
  return ratio * ratio;
}

static void set_candidate(struct candidate *candidate, double rate, const struct eo_order_line *mesh, int harmonics,
                          double turns)
{
  double most = 0;
  *candidate = (struct candidate){.rate = rate};
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
static double loss_of(const struct candidate *candidate, const struct eo_order_line *mesh, int orders, double turns)
{
  double left = 0, whole = 0;
  for (int h = 0; h < orders; h++) {
    double phase = mesh[h].order * turns / candidate->rate, gain = pow(sin(M_PI * phase) / (M_PI * phase), 2),
           acceleration = pow(mesh[h].order, 4) * square(mesh[h].amplitude);
    left += acceleration;
    whole += acceleration / (gain * gain);
  }
  return 1 - sqrt(left / whole);
}

static void add_row(struct candidate *candidate, const struct eo_images *images, int row,
                    const double complex *vibration, const double *order, int harmonics)
{
  double turns = turns_at(images, row) / candidate->rate, phase = candidate->rate * row;
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
    candidate->product[k] += images->residual[row] * conj(part[k]);
    candidate->energy[k] += square(part[k]);
  }
}

/* What is found of the images as a complex factor: its phase is that of the recorded rows. */
static double complex factor_of(const struct candidate *candidate, int part)
{
  return candidate->energy[part] > 0 ? 2 * candidate->product[part] / candidate->energy[part] : 0;
}

static double explained(const struct candidate *candidate, int part)
{
  return square(factor_of(candidate, part)) * candidate->energy[part] / 2;
}

/* Rates with one beat, those that carry every order: beyond half of a rate an order is its own image. */
static int list_rates(double beat, const struct eo_order_line *mesh, int harmonics, double turns,
                      struct candidate list[RATES])
{
  const double rate[RATES] = {beat, 1 - beat, 1 + beat, 2 - beat, 2 + beat};
  int count = 0;
  for (int i = 0; i < RATES; i++)
    if (mesh[harmonics - 1].order * turns < MOST_TURNS * rate[i])
      set_candidate(&list[count++], rate[i], mesh, harmonics, turns);
  return count;
}

static void add_rows(struct candidate *list, int count, const struct eo_images *images,
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

/* Of the vibration: 1 where both channels went through straight lines, more is none of their making. */
static double share_of(const struct candidate *candidate)
{
  return cabs(factor_of(candidate, 2));
}

static bool can_be(const struct candidate *candidate)
{
  return share_of(candidate) < 1 + ALIKE;
}

/* Whether the strongest image and the others may be there as one, as far as noise lets it tell. */
static bool can_be_one(const struct candidate *candidate, double rest)
{
  double complex strongest = factor_of(candidate, 0), others = factor_of(candidate, 1);
  double unsure = candidate->energy[1] > 0 ? SURE * sqrt(2 * rest / candidate->energy[1]) : INFINITY;
  return cabs(others - strongest) < ALIKE * cabs(strongest) + unsure;
}

/* Whether the images of a candidate are all there, as one, and much of what is left; rest: mean square of what is no
   image. */
static bool is_whole(const struct candidate *candidate, double rest, int rows)
{
  double complex strongest = factor_of(candidate, 0), others = factor_of(candidate, 1);
  return cabs(others - strongest) < ALIKE * cabs(strongest) && explained(candidate, 1) > 2 * CHANCE * rest &&
         explained(candidate, 2) > MUCH * rest * rows;
}

/* The likeliest of the rates with a beat: the most is explained, with a share that can be. */
static const struct candidate *likeliest(const struct candidate *list, int count)
{
  const struct candidate *best = list;
  for (int i = 1; i < count; i++) {
    bool more = explained(&list[i], 2) > explained(best, 2);
    if (can_be(&list[i]) && (more || !can_be(best)))
      best = &list[i];
  }
  return best;
}

/* What straight lines with a beat take away. It is there where images and noise have it both (noise of an encoder's
   steps as well: there the images have to be one), where all images are there as one, or where noise that is no
   rounding has it. */
static void judge_beat(struct eo_images *images, const struct eo_order_line *mesh, int harmonics, int asked,
                       const struct beat *beat, struct eo_images_found *found)
{
  struct candidate list[RATES];
  double rest = 0;
  int count = list_rates(beat->frequency, mesh, harmonics, turns_per_row(images), list);
  if (!count)
    return;
  add_rows(list, count, images, mesh, harmonics);
  const struct candidate *best = likeliest(list, count);
  if (!can_be(best))
    return;
  for (int i = 0; i < images->count; i++)
    rest += images->residual[i] * images->residual[i];
  rest = (rest - explained(best, 2)) / images->count;
  bool rounded = kurtosis(images) <= KURTOSIS,
       both = beat->in_images > CHANCE && beat->in_noise > CHANCE && (!rounded || can_be_one(best, rest)),
       noise = beat->in_noise > fmax(CHANCE, DEPTH * DEPTH * images->count / 8) && !rounded;
  double sure = sqrt(2 * rest / best->energy[2]),
         loss = fmin(1, share_of(best) + (noise ? 2 * sure : 0)) * loss_of(best, mesh, asked, turns_per_row(images));
  bool there = both || noise || (beat->highest && is_whole(best, rest, images->count));
  if (there && loss > found->loss) {
    found->rate = best->rate;
    found->share = share_of(best);
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
           acceleration = pow(mesh[h].order, 4) * square(mesh[h].amplitude);
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
  double alike = 0;
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
  list_lines(images, mesh[0].order, BEATS - 2, beat, &count);
  int of_images = count;
  EO_TRY(look_at_noise(images, &alike, error));
  found->alike = alike;
  found->alike_loss = alike_loss(alike, mesh, asked, turns_per_row(images));
  list_lines(images, 0, 2, beat, &count);
  join_beats(beat, of_images, count, images->count);
  for (int i = 0; i < count; i++)
    judge_beat(images, mesh, harmonics, asked, &beat[i], found);
  return EO_OK;
}
