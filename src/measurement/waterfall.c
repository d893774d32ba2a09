/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/waterfall.h"

#include <math.h>
#include <stdlib.h>

enum { GEAR_TURNS = 2 }; /* in a stretch at least: its shaft orders and sidebands then fall out of the mesh orders */

struct cell {
  int64_t rows;
  double time[2], theta[2]; /* of its first and last row */
  double complex sum[EO_MESH_ORDERS];
};

struct eo_waterfall {
  int teeth, harmonics, count;
  double from, length; /* rad; of a stretch */
  struct cell *cell;   /* owned, [count] */
};

enum eo_code eo_waterfall_new(struct eo_waterfall **waterfall, const struct eo_transmission *transmission,
                              const int teeth[2], double from, struct eo_error *error)
{
  double least = GEAR_TURNS * (double)teeth[EO_GEAR] / teeth[EO_PINION], turns = transmission->revolutions[EO_PINION];
  double each = least * fmax(1, ceil(turns / least / EO_TRACKS - 1e-9));
  int count = (int)(turns / each + 1e-6);
  *waterfall = NULL;
  if (count < 2)
    return EO_OK;
  struct eo_waterfall *this_waterfall = calloc(1, sizeof *this_waterfall);
  if (this_waterfall)
    this_waterfall->cell = calloc((size_t)count, sizeof *this_waterfall->cell);
  if (!this_waterfall || !this_waterfall->cell) {
    free(this_waterfall);
    return eo_error_memory(error);
  }
  this_waterfall->teeth = teeth[EO_PINION];
  this_waterfall->harmonics = transmission->harmonics;
  this_waterfall->count = count;
  this_waterfall->from = from;
  this_waterfall->length = 2 * M_PI * each;
  *waterfall = this_waterfall;
  return EO_OK;
}

void eo_waterfall_free(struct eo_waterfall *waterfall)
{
  if (waterfall)
    free(waterfall->cell);
  free(waterfall);
}

void eo_waterfall_add(struct eo_waterfall *waterfall, double time, double theta, double residual)
{
  int at = (int)((theta - waterfall->from) / waterfall->length);
  if (theta < waterfall->from || at >= waterfall->count)
    return;
  struct cell *cell = &waterfall->cell[at];
  double complex unit = cexp(-I * waterfall->teeth * theta), power = residual;
  for (int h = 0; h < waterfall->harmonics; h++)
    cell->sum[h] += power *= unit;
  if (!cell->rows++) {
    cell->time[0] = time;
    cell->theta[0] = theta;
  }
  cell->time[1] = time;
  cell->theta[1] = theta;
}

enum eo_code eo_waterfall_finish(struct eo_waterfall *waterfall, struct eo_transmission *transmission,
                                 struct eo_error *error)
{
  if (!waterfall)
    return EO_OK;
  transmission->track = calloc((size_t)waterfall->count, sizeof *transmission->track);
  if (!transmission->track)
    return eo_error_memory(error);
  for (int i = 0; i < waterfall->count; i++) {
    const struct cell *cell = &waterfall->cell[i];
    struct eo_order_track *track = &transmission->track[transmission->tracks];
    if (cell->rows < 2 * waterfall->harmonics || !(cell->time[1] > cell->time[0]))
      continue;
    double square = 0;
    track->from = cell->time[0];
    track->to = cell->time[1];
    track->turns = waterfall->length / (2 * M_PI);
    track->speed = (cell->theta[1] - cell->theta[0]) / (cell->time[1] - cell->time[0]);
    track->rows = cell->rows;
    for (int h = 0; h < waterfall->harmonics; h++) {
      track->amplitude[h] = transmission->mesh[h].amplitude + 2 * cell->sum[h] / (double)cell->rows;
      square += pow(cabs(track->amplitude[h]) * pow(transmission->mesh[h].order * track->speed, 2), 2) / 2;
    }
    track->rms = sqrt(square);
    transmission->tracks++;
  }
  return EO_OK;
}
