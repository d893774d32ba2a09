/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The one form in which a compliance reaches the contact solver: a matrix between points on the flanks of neighbouring
   tooth pairs. */
#ifndef EASEOFF_FLEXIBILITY_KERNEL_H
#define EASEOFF_FLEXIBILITY_KERNEL_H

/* A point where a pair of teeth may touch. */
struct eo_flank_point {
  int pair;    /* index of the tooth pair; pair k + 1 meets one base pitch ahead of pair k (greater s) */
  double s[2]; /* [member]: transverse path coordinate of the point on each flank, at the distance that the pair is
                  drawn for, m; equal there but for tip-edge contact */
  double eta;  /* axial from mid face, + on the side that meets first, m */
};

/* Fills compliance[n][n] (row-major, symmetric, positive semi-definite): the sum of both members' deflection at point i
   along the flank normal, m, under a unit normal force at point j, N. Thread-safe for a constant context. */
typedef void eo_kernel_function(const void *context, int n, const struct eo_flank_point *point, double *compliance);

struct eo_kernel {
  eo_kernel_function *evaluate;
  const void *context; /* borrowed */
};

#endif
