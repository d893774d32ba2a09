/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is read from two measured angles: orders, their tracks, averages; and what follows from them alone. */
#ifndef EASEOFF_MEASUREMENT_ORDERS_H
#define EASEOFF_MEASUREMENT_ORDERS_H

#include <complex.h>
#include <stdbool.h>
#include <stdint.h>

#include "measurement/parts.h"

enum {
  EO_MESH_ORDERS = 32,
  EO_SHAFT_ORDERS = 3,
  EO_SIDEBANDS = 4,
  EO_CYCLE_BINS = 128,
  EO_TURN_BINS = 512,
  EO_TRACKS = 64
};

/* One order: value = Re amplitude exp(i order theta), theta the pinion's angle with its encoder's zero. */
struct eo_order_line {
  double order;             /* per turn of the pinion */
  double complex amplitude; /* m */
  double sigma;             /* m, of its real and of its imaginary part, from the noise beside it */
  double systematic[2]; /* m, of the amplitude, alike in all orders: eccentricity and noise, vibration in the axis */
  double acceleration;  /* (order omega)^2 |amplitude|, m/s2 */
};

/* One stretch of the recording. */
struct eo_order_track {
  double from, to; /* s after the first row of the recording */
  double turns;    /* of the pinion */
  double speed;    /* of the pinion, rad/s, mean */
  int64_t rows;
  double complex amplitude[EO_MESH_ORDERS]; /* [harmonics] m */
  double rms;                               /* m/s2, of the mesh orders at that speed; noise is in it */
};

struct eo_transmission {
  struct eo_parts parts; /* of the recording, and what was measured of it */
  int64_t rows;
  double seconds, revolutions[2];      /* of pinion and gear */
  double speed, speed_low, speed_high; /* of the pinion, rad/s: turns over time of the part, extremes of whole turns */
  int asked, harmonics;                /* mesh orders wanted and possible */
  struct eo_order_line mesh[EO_MESH_ORDERS];      /* [harmonics] */
  struct eo_order_line shaft[2][EO_SHAFT_ORDERS]; /* [member]; amplitude 0 where it coincides with another order */
  bool separate[2][EO_SHAFT_ORDERS];
  struct eo_order_line sideband[EO_MESH_ORDERS][2][EO_SIDEBANDS]; /* [h][member] at -2, -1, 1, 2 turns of that shaft */
  double rms, rms_sigma;           /* m/s2 of the mesh orders together, its standard deviation */
  double rms_upto[EO_MESH_ORDERS]; /* [harmonics] of the orders up to h */
  int tracks;
  struct eo_order_track *track; /* owned, [tracks], in the order of time; none where the recording is short */
  double axis_swing;            /* rad: first order of the pinion's encoder that was taken out of the axis */
  double axis_noise;            /* rad, standard deviation of a reading of the pinion's encoder */
  double axis_bias;             /* relative, of the RMS: what both would have taken away, put right */
  double mesh_peak_to_peak;     /* m, of the mesh orders over a cycle */
  double residual;              /* m, RMS of what no term explains */
  double drift[4];              /* m, Legendre coefficients over the time of the recording */
  double condition;             /* of the scaled normal equations */
  double step;                  /* m: the largest sudden change of level, if it stands out of the noise; else 0 */
  int64_t step_row;             /* row of the series near it */
  /* Secondary: the samples interpolated to equal steps of the pinion's angle, over whole hunting periods where there
     are any. */
  int hunting;                        /* turns of the pinion until the same teeth meet again */
  int spectrum_turns, spectrum_lines; /* turns analysed; lines[k] is at order k / spectrum_turns */
  float *spectrum;                    /* owned, [spectrum_lines] m */
  double rms_spectrum, rms_band; /* m/s2: of the lines at the mesh orders; with everything within 2.2 turns of them */
  double cycle[EO_CYCLE_BINS];   /* m: time-synchronous average over a mesh cycle */
  double turn[2][EO_TURN_BINS];  /* [member] over a turn, without drift */
};

/* Relative standard deviation that stands for what is left out in second order: sidebands on sidebands, shaft orders
   beyond the third. */
static const double EO_RMS_SYSTEMATIC = 0.0001;

void eo_transmission_done(struct eo_transmission *result);

/* Root of the summed squares of the accelerations of lines[count], the expected part of the noise taken off, and its
   standard deviation (EO_RMS_SYSTEMATIC included): |RMS - truth| stays below twice that in 95 % of cases, for small RMS
   too. omega: rad/s. */
double eo_transmission_rms(const struct eo_order_line *line, int count, double omega, double *sigma);

/* TE of the mesh orders at mesh phase 0..1. */
double eo_transmission_mesh(const struct eo_transmission *result, double phase);

#endif
