/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The local law of line contact (Weber and Banaschek 1953) and its inverse: delta = K q (L - ln q).
   With x = L - ln q and u = delta/(K e^L): u = x e^-x, q = e^L w(u) with w = e^-x, x > 1 (q below the law's turning
   point) and dw/du = 1/(x - 1). w(u) is one universal function, tabulated over octaves of u with its slope, so that a
   load and its rate take neither a logarithm nor a division. From x = 2 on, where the contact is as wide as the tooth
   is thick and the law has lost its meaning, q goes on in a straight line, so that every load has its solution. */
#ifndef EASEOFF_NUMERICS_LOCAL_INVERSE_H
#define EASEOFF_NUMERICS_LOCAL_INVERSE_H

#include "base/error.h"

#include <stdint.h>
#include <string.h>

enum {
  EO_LOCAL_INVERSE_OCTAVES = 63, /* 2^-64 <= u < 2^-1 */
  EO_LOCAL_INVERSE_CELLS = 64    /* of an octave: their width is at most 1/64 of u, which leaves some 1e-10 of w */
};
static const double EO_LOCAL_INVERSE_STRAIGHT = 0.27067056647322535; /* u from which the law is straight: 2 e^-2 */
static const double EO_LOCAL_INVERSE_OFFSET = 0.1353352832366127;    /* w = u - e^-2 there */
static const double EO_LOCAL_INVERSE_LEAST = 5.421010862427522e-20;  /* 2^-64 */

struct eo_local_inverse {
  double (*node)[2]; /* [OCTAVES][CELLS + 1], owned: w, and its slope times the width of the octave's cells */
};

/* Makes the table. Errors: memory. */
enum eo_code eo_local_inverse_init(struct eo_local_inverse *inverse, struct eo_error *error);
void eo_local_inverse_done(struct eo_local_inverse *inverse);

/* w(u) and dw/du for u > 0: the cubic of the cell with its own slope. Below the table, at gaps of a thousandth of an
   atom, the line through zero. */
static inline double eo_local_inverse_at(const double (*node)[2], double u, double *slope)
{
  if (!(u < EO_LOCAL_INVERSE_STRAIGHT)) { /* NaN too: it is not to become an index */
    *slope = 1;
    return u - EO_LOCAL_INVERSE_OFFSET;
  }
  if (u < EO_LOCAL_INVERSE_LEAST) {
    *slope = node[0][0] / EO_LOCAL_INVERSE_LEAST;
    return u * *slope;
  }
  /* the exponent of u tells the octave, the first six bits of its mantissa the cell, the others the place in it */
  static const uint64_t ONE = UINT64_C(1023) << 52, WITHIN = (UINT64_C(1) << 46) - 1;
  uint64_t bits, cell, place;
  memcpy(&bits, &u, sizeof bits);
  cell = (bits >> 46) - (UINT64_C(959) << 6); /* 959: the exponent of 2^-64 */
  cell += cell >> 6;
  place = ONE | (bits & WITHIN) << 6;
  bits = (UINT64_C(2052) << 52) - (bits & UINT64_C(2047) << 52); /* one over the width of a cell */
  double r, per_width;
  memcpy(&r, &place, sizeof r);
  memcpy(&per_width, &bits, sizeof per_width);
  r -= 1;
  const double *low = node[cell], *high = node[cell + 1];
  double rise = high[0] - low[0], bow = 3 * rise - 2 * low[1] - high[1], turn = low[1] + high[1] - 2 * rise;
  *slope = (low[1] + r * (2 * bow + 3 * r * turn)) * per_width;
  return low[0] + r * (low[1] + r * (bow + r * turn));
}

#endif
