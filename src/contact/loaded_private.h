/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The workspace of loaded contact, shared by the files that make it and work in it. */
#ifndef EASEOFF_CONTACT_LOADED_PRIVATE_H
#define EASEOFF_CONTACT_LOADED_PRIVATE_H

#include "contact/loaded.h"
#include "contact/local_inverse.h"
#include "numerics/gram.h"

struct eo_loaded_workspace {
  struct eo_local_inverse inverse;
  const struct eo_gram *gram;
  bool partial;              /* cells may touch in part */
  double *load, *rate, *gap; /* [most_points]: p, dp/dg, scaled gaps */
  double *bend, *correction; /* [most_points]: deflection by the modes, and by what they leave of the compliance */
  double *local, *spread;    /* [most_points]: local approach g, and half its change over the cell */
  double *mode, *trial;      /* [most_rank + 1]: a and Z */
  double *residual, *step, *tangent; /* [most_rank + 1] */
  float *matrix, *packed, *blend;    /* scratch of the kernel; matrix: minus the inverse of Newton's */
};

#endif
