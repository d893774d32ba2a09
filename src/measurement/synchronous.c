/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/synchronous.h"

#include <math.h>
#include <stdlib.h>

#include "base/sort.h"
#include "numerics/fft.h"

enum { MOST_SAMPLES = 1 << 22, MOST_LEVELS = 1 << 15 };
static const double BAND = 2.2;      /* turns of the pinion on either side of a mesh order */
static const double STEP_LIMIT = 12; /* times the robust spread of the differences of levels */

struct eo_synchronous {
  int teeth[2];
  double from;
  int turns, samples;   /* of the spectrum */
  double complex *grid; /* [samples] residual at equal angles */
  int filled;
  double theta, residual; /* of the row before */
  bool begun;
  double cycle[EO_CYCLE_BINS], turn[2][EO_TURN_BINS];
  int64_t in_cycle[EO_CYCLE_BINS], in_turn[2][EO_TURN_BINS];
  int64_t rows_per_level, row_in_level;
  int levels;
  double level[MOST_LEVELS];
  int64_t level_row[MOST_LEVELS];
};

static int power_of_two(double least)
{
  int n = 64;
  while (n < least && n < MOST_SAMPLES)
    n *= 2;
  return n;
}

enum eo_code eo_synchronous_new(struct eo_synchronous **synchronous, const struct eo_transmission *transmission,
                                const int teeth[2], double from, double turns, struct eo_error *error)
{
  struct eo_synchronous *this_synchronous = calloc(1, sizeof *this_synchronous);
  if (!this_synchronous)
    return eo_error_memory(error);
  double per_turn = (double)transmission->rows / turns;
  int whole = turns >= transmission->hunting ? transmission->hunting : (int)(turns + 1e-9);
  while (whole > 0 && turns >= transmission->hunting && whole + transmission->hunting <= turns + 1e-9 &&
         (whole + transmission->hunting) * per_turn < 0.5 * MOST_SAMPLES)
    whole += transmission->hunting;
  this_synchronous->teeth[0] = teeth[0];
  this_synchronous->teeth[1] = teeth[1];
  this_synchronous->from = from;
  this_synchronous->turns = whole > 0 ? whole : 1;
  this_synchronous->samples =
      power_of_two(fmax(per_turn, 2.2 * (transmission->harmonics + 1) * teeth[0]) * this_synchronous->turns);
  this_synchronous->rows_per_level = (int64_t)fmax(fmax(16, 2 * per_turn / teeth[0]),
                                                   (double)transmission->rows / MOST_LEVELS + 1);
  this_synchronous->grid = calloc((size_t)this_synchronous->samples, sizeof *this_synchronous->grid);
  if (!this_synchronous->grid) {
    free(this_synchronous);
    return eo_error_memory(error);
  }
  *synchronous = this_synchronous;
  return EO_OK;
}

void eo_synchronous_free(struct eo_synchronous *synchronous)
{
  if (synchronous)
    free(synchronous->grid);
  free(synchronous);
}

static int bin_of(double turns, int bins)
{
  int bin = (int)((turns - floor(turns)) * bins);
  return bin < bins ? bin : bins - 1;
}

static double grid_angle(const struct eo_synchronous *synchronous, int i)
{
  return synchronous->from + 2 * M_PI * synchronous->turns * (double)i / synchronous->samples;
}

static void interpolate(struct eo_synchronous *synchronous, double theta, double residual)
{
  for (; synchronous->filled < synchronous->samples && grid_angle(synchronous, synchronous->filled) <= theta;
       synchronous->filled++) {
    double span = theta - synchronous->theta,
           share = synchronous->begun && span > 0
                       ? (grid_angle(synchronous, synchronous->filled) - synchronous->theta) / span
                       : 1;
    synchronous->grid[synchronous->filled] = synchronous->begun
                                                 ? synchronous->residual + share * (residual - synchronous->residual)
                                                 : residual;
  }
  synchronous->theta = theta;
  synchronous->residual = residual;
  synchronous->begun = true;
}

void eo_synchronous_add(struct eo_synchronous *synchronous, int64_t row, double theta, double mesh, double shaft,
                        double residual)
{
  double turns = theta / (2 * M_PI);
  int bin = bin_of(turns * synchronous->teeth[EO_PINION], EO_CYCLE_BINS);
  synchronous->cycle[bin] += mesh + residual;
  synchronous->in_cycle[bin]++;
  for (int member = 0; member < 2; member++) {
    bin = bin_of(member == EO_GEAR ? turns * synchronous->teeth[EO_PINION] / synchronous->teeth[EO_GEAR] : turns,
                 EO_TURN_BINS);
    synchronous->turn[member][bin] += mesh + shaft + residual;
    synchronous->in_turn[member][bin]++;
  }
  if (synchronous->levels < MOST_LEVELS) {
    synchronous->level[synchronous->levels] += residual / (double)synchronous->rows_per_level;
    if (++synchronous->row_in_level == synchronous->rows_per_level) {
      synchronous->level_row[synchronous->levels++] = row;
      synchronous->row_in_level = 0;
    }
  }
  interpolate(synchronous, theta, residual);
}

static void average(int bins, const double *sum, const int64_t *count, double *mean)
{
  for (int i = 0; i < bins; i++)
    mean[i] = count[i] ? sum[i] / (double)count[i] : NAN;
}

/* The lines of interpolated residual and exact mesh orders. */
static enum eo_code make_spectrum(struct eo_synchronous *synchronous, struct eo_transmission *transmission,
                                  struct eo_error *error)
{
  int lines = synchronous->turns * (transmission->harmonics + 1) * synchronous->teeth[EO_PINION] + 1;
  if (lines > synchronous->samples / 2)
    lines = synchronous->samples / 2;
  transmission->spectrum = malloc(sizeof *transmission->spectrum * (size_t)lines);
  if (!transmission->spectrum)
    return eo_error_memory(error);
  for (int i = 0; i < synchronous->samples; i++)
    synchronous->grid[i] +=
        eo_transmission_mesh(transmission, grid_angle(synchronous, i) * synchronous->teeth[EO_PINION] / (2 * M_PI));
  EO_TRY(eo_fft_forward(NULL, synchronous->samples, synchronous->grid, error));
  transmission->spectrum_turns = synchronous->turns;
  transmission->spectrum_lines = lines;
  for (int k = 0; k < lines; k++)
    transmission->spectrum[k] = (float)(cabs(synchronous->grid[k]) * (k ? 2.0 : 1.0) / synchronous->samples);
  return EO_OK;
}

static double squared_acceleration(const struct eo_transmission *transmission, int line)
{
  double order = (double)line / transmission->spectrum_turns;
  return pow(order * transmission->speed, 4) * transmission->spectrum[line] * transmission->spectrum[line] / 2;
}

static void read_spectrum(const struct eo_synchronous *synchronous, struct eo_transmission *transmission)
{
  double lines = 0, band = 0;
  for (int h = 1; h <= transmission->harmonics; h++) {
    int centre = h * synchronous->teeth[EO_PINION] * synchronous->turns,
        width = (int)(fmin(BAND, 0.49 * synchronous->teeth[EO_PINION]) * synchronous->turns);
    for (int k = centre - width; k <= centre + width; k++)
      if (k > 0 && k < transmission->spectrum_lines)
        band += squared_acceleration(transmission, k);
    if (centre < transmission->spectrum_lines)
      lines += squared_acceleration(transmission, centre);
  }
  transmission->rms_spectrum = sqrt(lines);
  transmission->rms_band = sqrt(band);
}

/* A change of level between two pairs of neighbouring means that stands out of all others. */
static enum eo_code find_step(const struct eo_synchronous *synchronous, struct eo_transmission *transmission,
                              struct eo_error *error)
{
  int n = synchronous->levels - 3, at = 0;
  if (n < 16)
    return EO_OK;
  double *size = malloc(sizeof *size * (size_t)n), largest = 0;
  if (!size)
    return eo_error_memory(error);
  for (int i = 0; i < n; i++) {
    double change =
        (synchronous->level[i + 3] + synchronous->level[i + 2] - synchronous->level[i + 1] - synchronous->level[i]) / 2;
    size[i] = fabs(change);
    if (size[i] > fabs(largest)) {
      largest = change;
      at = i;
    }
  }
  eo_sort_numbers(n, size);
  if (fabs(largest) > STEP_LIMIT * 1.4826 * size[n / 2] && fabs(largest) > 1e-7) {
    transmission->step = largest;
    transmission->step_row = synchronous->level_row[at + 1];
  }
  free(size);
  return EO_OK;
}

enum eo_code eo_synchronous_finish(struct eo_synchronous *synchronous, struct eo_transmission *transmission,
                                   struct eo_error *error)
{
  average(EO_CYCLE_BINS, synchronous->cycle, synchronous->in_cycle, transmission->cycle);
  for (int member = 0; member < 2; member++)
    average(EO_TURN_BINS, synchronous->turn[member], synchronous->in_turn[member], transmission->turn[member]);
  for (; synchronous->filled < synchronous->samples; synchronous->filled++)
    synchronous->grid[synchronous->filled] = synchronous->residual;
  enum eo_code code = make_spectrum(synchronous, transmission, error);
  if (code)
    return code;
  read_spectrum(synchronous, transmission);
  return find_step(synchronous, transmission, error);
}
