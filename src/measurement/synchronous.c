/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/synchronous.h"

#include <math.h>
#include <stdlib.h>

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
  struct eo_synchronous *s = calloc(1, sizeof *s);
  if (!s)
    return eo_error_memory(error);
  double per_turn = (double)transmission->rows / turns;
  int whole = turns >= transmission->hunting ? transmission->hunting : (int)(turns + 1e-9);
  while (whole > 0 && turns >= transmission->hunting && whole + transmission->hunting <= turns + 1e-9 &&
         (whole + transmission->hunting) * per_turn < 0.5 * MOST_SAMPLES)
    whole += transmission->hunting;
  s->teeth[0] = teeth[0];
  s->teeth[1] = teeth[1];
  s->from = from;
  s->turns = whole > 0 ? whole : 1;
  s->samples = power_of_two(fmax(per_turn, 2.2 * (transmission->harmonics + 1) * teeth[0]) * s->turns);
  s->rows_per_level = (int64_t)fmax(fmax(16, 2 * per_turn / teeth[0]), (double)transmission->rows / MOST_LEVELS + 1);
  s->grid = calloc((size_t)s->samples, sizeof *s->grid);
  if (!s->grid) {
    free(s);
    return eo_error_memory(error);
  }
  *synchronous = s;
  return EO_OK;
}

void eo_synchronous_free(struct eo_synchronous *s)
{
  if (s)
    free(s->grid);
  free(s);
}

static int bin_of(double turns, int bins)
{
  int bin = (int)((turns - floor(turns)) * bins);
  return bin < bins ? bin : bins - 1;
}

static double grid_angle(const struct eo_synchronous *s, int i)
{
  return s->from + 2 * M_PI * s->turns * (double)i / s->samples;
}

static void interpolate(struct eo_synchronous *s, double theta, double residual)
{
  for (; s->filled < s->samples && grid_angle(s, s->filled) <= theta; s->filled++) {
    double span = theta - s->theta, share = s->begun && span > 0 ? (grid_angle(s, s->filled) - s->theta) / span : 1;
    s->grid[s->filled] = s->begun ? s->residual + share * (residual - s->residual) : residual;
  }
  s->theta = theta;
  s->residual = residual;
  s->begun = true;
}

void eo_synchronous_add(struct eo_synchronous *s, int64_t row, double theta, double mesh, double shaft, double residual)
{
  double turns = theta / (2 * M_PI);
  int bin = bin_of(turns * s->teeth[EO_PINION], EO_CYCLE_BINS);
  s->cycle[bin] += mesh + residual;
  s->in_cycle[bin]++;
  for (int member = 0; member < 2; member++) {
    bin = bin_of(member == EO_GEAR ? turns * s->teeth[EO_PINION] / s->teeth[EO_GEAR] : turns, EO_TURN_BINS);
    s->turn[member][bin] += mesh + shaft + residual;
    s->in_turn[member][bin]++;
  }
  if (s->levels < MOST_LEVELS) {
    s->level[s->levels] += residual / (double)s->rows_per_level;
    if (++s->row_in_level == s->rows_per_level) {
      s->level_row[s->levels++] = row;
      s->row_in_level = 0;
    }
  }
  interpolate(s, theta, residual);
}

static void average(int bins, const double *sum, const int64_t *count, double *mean)
{
  for (int i = 0; i < bins; i++)
    mean[i] = count[i] ? sum[i] / (double)count[i] : NAN;
}

/* The lines of interpolated residual and exact mesh orders. */
static enum eo_code make_spectrum(struct eo_synchronous *s, struct eo_transmission *transmission,
                                  struct eo_error *error)
{
  int lines = s->turns * (transmission->harmonics + 1) * s->teeth[EO_PINION] + 1;
  if (lines > s->samples / 2)
    lines = s->samples / 2;
  transmission->spectrum = malloc(sizeof *transmission->spectrum * (size_t)lines);
  if (!transmission->spectrum)
    return eo_error_memory(error);
  for (int i = 0; i < s->samples; i++)
    s->grid[i] += eo_transmission_mesh(transmission, grid_angle(s, i) * s->teeth[EO_PINION] / (2 * M_PI));
  eo_fft_forward(s->samples, s->grid);
  transmission->spectrum_turns = s->turns;
  transmission->spectrum_lines = lines;
  for (int k = 0; k < lines; k++)
    transmission->spectrum[k] = (float)(cabs(s->grid[k]) * (k ? 2.0 : 1.0) / s->samples);
  return EO_OK;
}

static double squared_acceleration(const struct eo_transmission *r, int line)
{
  double order = (double)line / r->spectrum_turns;
  return pow(order * r->speed, 4) * r->spectrum[line] * r->spectrum[line] / 2;
}

static void read_spectrum(const struct eo_synchronous *s, struct eo_transmission *transmission)
{
  double lines = 0, band = 0;
  for (int h = 1; h <= transmission->harmonics; h++) {
    int centre = h * s->teeth[EO_PINION] * s->turns, width = (int)(fmin(BAND, 0.49 * s->teeth[EO_PINION]) * s->turns);
    for (int k = centre - width; k <= centre + width; k++)
      if (k > 0 && k < transmission->spectrum_lines)
        band += squared_acceleration(transmission, k);
    if (centre < transmission->spectrum_lines)
      lines += squared_acceleration(transmission, centre);
  }
  transmission->rms_spectrum = sqrt(lines);
  transmission->rms_band = sqrt(band);
}

static int ascending(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* A change of level between two pairs of neighbouring means that stands out of all others. */
static enum eo_code find_step(const struct eo_synchronous *s, struct eo_transmission *transmission,
                              struct eo_error *error)
{
  int n = s->levels - 3, at = 0;
  if (n < 16)
    return EO_OK;
  double *size = malloc(sizeof *size * (size_t)n), largest = 0;
  if (!size)
    return eo_error_memory(error);
  for (int i = 0; i < n; i++) {
    double change = (s->level[i + 3] + s->level[i + 2] - s->level[i + 1] - s->level[i]) / 2;
    size[i] = fabs(change);
    if (size[i] > fabs(largest)) {
      largest = change;
      at = i;
    }
  }
  qsort(size, (size_t)n, sizeof *size, ascending);
  if (fabs(largest) > STEP_LIMIT * 1.4826 * size[n / 2] && fabs(largest) > 1e-7) {
    transmission->step = largest;
    transmission->step_row = s->level_row[at + 1];
  }
  free(size);
  return EO_OK;
}

enum eo_code eo_synchronous_finish(struct eo_synchronous *s, struct eo_transmission *transmission,
                                   struct eo_error *error)
{
  average(EO_CYCLE_BINS, s->cycle, s->in_cycle, transmission->cycle);
  for (int member = 0; member < 2; member++)
    average(EO_TURN_BINS, s->turn[member], s->in_turn[member], transmission->turn[member]);
  for (; s->filled < s->samples; s->filled++)
    s->grid[s->filled] = s->residual;
  enum eo_code code = make_spectrum(s, transmission, error);
  if (code)
    return code;
  read_spectrum(s, transmission);
  return find_step(s, transmission, error);
}
