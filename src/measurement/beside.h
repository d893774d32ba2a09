/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual of the fit beside every mesh order: noise between the orders of the shafts, what repeats with them,
   sidebands. */
#ifndef EASEOFF_MEASUREMENT_BESIDE_H
#define EASEOFF_MEASUREMENT_BESIDE_H

#include "measurement/orders.h"

enum {
  EO_BESIDE_BINS = 16,   /* between the orders, on either side */
  EO_BESIDE_NEAREST = 2, /* the first of them is so many bins of 1 / turns away */
  EO_BESIDE_TURNS = 8,   /* whole turns of each shaft, on either side; the first two are the sidebands */
  EO_BESIDE_PHASORS = 2 * EO_BESIDE_BINS + 4 * EO_BESIDE_TURNS
};

struct eo_beside {
  int harmonics;
  double teeth, gear; /* of the pinion; turns of the gear per turn of the pinion */
  double turns;       /* of the pinion that are analysed */
  int64_t rows;
  double real[EO_MESH_ORDERS][EO_BESIDE_PHASORS], imaginary[EO_MESH_ORDERS][EO_BESIDE_PHASORS];
};

void eo_beside_init(struct eo_beside *beside, const int teeth[2], int harmonics, double turns);
void eo_beside_add(struct eo_beside *beside, double theta, double residual);

/* Standard deviation of the cosine and sine amplitudes of mesh order h + 1: from a robust mean power
   between the orders, or, where that is clearly larger, at whole turns of either shaft beyond the sidebands (steps of
   an encoder that is sampled in step with its shaft only show there). residual: RMS, stands in where too few bins are
   free of sidebands.
 */
double eo_beside_sigma(const struct eo_beside *beside, int h, double residual);

/* Amplitude of the sideband `turns` (-2, -1, 1, 2) of a shaft at mesh order h + 1. */
double complex eo_beside_sideband(const struct eo_beside *beside, int h, int member, int turns);

#endif
