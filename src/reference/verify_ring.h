/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cases of kind "ring": compliance of whole gear bodies, and what the loaded contact makes of it. */
#ifndef EASEOFF_REFERENCE_VERIFY_RING_H
#define EASEOFF_REFERENCE_VERIFY_RING_H

#include "design/resolution.h"
#include "reference/verify.h"

struct eo_ring_tolerances {
  double own, face_end, between, part, stiffness, share, root; /* relative, but the share */
  double swing[2], pairs_swing[2];                             /* PPLTE: um, relative: the larger counts */
};

struct eo_ring_case {
  struct eo_verification *v;
  struct eo_case *file;
  struct eo_ring_tolerances tolerance;
  struct eo_design design; /* of "macro" */
  struct eo_geometry geometry;
  double held_radius[2];              /* of the support "solid", m; NaN: not described */
  struct eo_flexibility *flexibility; /* of the support prepared last for compliances */
  char support[60];                   /* its name */
};

/* Sets body and support of a design; a support this program does not have is a fault at `where`. */
void eo_ring_support(const struct eo_ring_case *ring_case, const char *name, struct eo_case *where,
                     struct eo_design *design);

/* Prepares a design's flexibility on the mesh that the file states; of the list of pairs, or the rest. reach: 0: as
   many pairs as are in contact. */
enum eo_code eo_ring_prepare(const struct eo_ring_case *ring_case, bool pairs, int reach, struct eo_design *design,
                             struct eo_flexibility **flexibility, struct eo_error *error);

/* Blocks "ltca" and "pairs". */
eo_verify_function eo_ring_check_ltca, eo_ring_check_pairs;

#endif
