/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Real-coded genetic operators over the unit cube and the latin hypercube, all on the counter's random numbers. */
#ifndef EASEOFF_OPTIMIZER_OPERATORS_H
#define EASEOFF_OPTIMIZER_OPERATORS_H

#include "base/error.h"
#include "base/random.h"
#include "optimizer/settings.h"

#include <math.h>

/* Streams of the counter; a number is never used twice for different things. */
enum eo_stream {
  EO_STREAM_START = 1,      /* first population: individual i, draw = variable */
  EO_STREAM_TOURNAMENT = 2, /* individual = pair; draws 0, 1 first parent, 2, 3 second */
  EO_STREAM_CROSSOVER = 3,  /* individual = pair; draw 0 whether, 1 + 2 k whether gene k, 2 + 2 k its spread */
  /* individual = child; draw 0 whether (mode individual), 1 + 2 k whether gene k, 2 + 2 k how much */
  EO_STREAM_MUTATION = 4,
  EO_STREAM_LATIN_ORDER = 30,  /* generation = epoch, individual = point, draw = variable */
  EO_STREAM_LATIN_JITTER = 31, /* generation = epoch, individual = cell, draw = variable */
  EO_STREAM_LOCAL = 40,        /* trust region samples */
  EO_STREAM_WARP = 44,         /* lines through the cube, seed 0: individual = line, draw = variable */
  EO_STREAM_PAIRS = 43,        /* pairs of points, seed 0: generation = side, individual = pair, draw = variable */
  EO_STREAM_GLOBAL = 42,       /* samples of the cube: generation = batch, individual = sample; draws 2 k, 2 k + 1 */
  EO_STREAM_EVOLUTION = 41,    /* evolution strategy: generation = batch, individual = sample, draw = axis */
};

/* Into 0..1. */
static inline double eo_unit_clip(double x)
{
  return x > 0 ? (x < 1 ? x : 1) : 0;
}

/* Euclidean, of a[n] and b[n]. */
static inline double eo_unit_distance(const double *a, const double *b, int n)
{
  double sum = 0;
  for (int k = 0; k < n; k++)
    sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sqrt(sum);
}

/* count uniformly random points x[count][n]. */
void eo_random_points(double *x, int count, int n, uint64_t seed);

/* Breeds count children from parents [size][n], rank by fitness[size] (to maximise): binary tournament (the first
   drawn must be strictly better to win), simulated binary crossover (Deb and Agrawal 1995) and polynomial mutation
   (Deb and Goyal 1996), both clipped to the cube. Pairs and children count from first_child (even). */
void eo_breed(const struct eo_optimizer_settings *settings, const double *parents, const double *fitness, int size,
              int generation, int first_child, double *children, int count);

/* Latin hypercube x[count][n] (McKay, Beckman, Conover 1979), one jittered point per cell. scratch: [count]. */
void eo_latin_hypercube(double *x, int count, int n, uint64_t seed, int epoch, double *scratch);

#endif
