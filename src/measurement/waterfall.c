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
  struct eo_waterfall *w = calloc(1, sizeof *w);
  if (w)
    w->cell = calloc((size_t)count, sizeof *w->cell);
  if (!w || !w->cell) {
    free(w);
    return eo_error_memory(error);
  }
  w->teeth = teeth[EO_PINION];
  w->harmonics = transmission->harmonics;
  w->count = count;
  w->from = from;
  w->length = 2 * M_PI * each;
  *waterfall = w;
  return EO_OK;
}

void eo_waterfall_free(struct eo_waterfall *w)
{
  if (w)
    free(w->cell);
  free(w);
}

void eo_waterfall_add(struct eo_waterfall *w, double time, double theta, double residual)
{
  int at = (int)((theta - w->from) / w->length);
  if (theta < w->from || at >= w->count)
    return;
  struct cell *c = &w->cell[at];
  double complex unit = cexp(-I * w->teeth * theta), power = residual;
  for (int h = 0; h < w->harmonics; h++)
    c->sum[h] += power *= unit;
  if (!c->rows++) {
    c->time[0] = time;
    c->theta[0] = theta;
  }
  c->time[1] = time;
  c->theta[1] = theta;
}

enum eo_code eo_waterfall_finish(struct eo_waterfall *w, struct eo_transmission *transmission, struct eo_error *error)
{
  if (!w)
    return EO_OK;
  transmission->track = calloc((size_t)w->count, sizeof *transmission->track);
  if (!transmission->track)
    return eo_error_memory(error);
  for (int i = 0; i < w->count; i++) {
    const struct cell *c = &w->cell[i];
    struct eo_order_track *track = &transmission->track[transmission->tracks];
    if (c->rows < 2 * w->harmonics || !(c->time[1] > c->time[0]))
      continue;
    double square = 0;
    track->from = c->time[0];
    track->to = c->time[1];
    track->turns = w->length / (2 * M_PI);
    track->speed = (c->theta[1] - c->theta[0]) / (c->time[1] - c->time[0]);
    track->rows = c->rows;
    for (int h = 0; h < w->harmonics; h++) {
      track->amplitude[h] = transmission->mesh[h].amplitude + 2 * c->sum[h] / (double)c->rows;
      square += pow(cabs(track->amplitude[h]) * pow(transmission->mesh[h].order * track->speed, 2), 2) / 2;
    }
    track->rms = sqrt(square);
    transmission->tracks++;
  }
  return EO_OK;
}
