/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest principal stress of a root whose stresses are coefficient x shape, for many coefficients at once. Most of
   a sum comes from its first shapes; what the others can still add to a node is bounded by the two norms of the rest
   (Cauchy and Schwarz), so that most nodes are told from the largest one by part of their sums. A sum that is finished
   has the same bytes as if all were. */
#ifndef EASEOFF_FLEXIBILITY_ROOT_FIELD_H
#define EASEOFF_FLEXIBILITY_ROOT_FIELD_H

#include "base/error.h"
#include "numerics/gram.h"

struct eo_root_field {
  int rank;
  int blocks, columns; /* of a few nodes each; floats of all of them, with padding */
  int levels;          /* of a sum, each some shapes more */
  float *shape;        /* [blocks][rank][EO_STRESSES][nodes of a block] */
  float *rest;         /* [levels][nodes of all blocks]: norm of the shapes behind a level */
};

/* shape[rank][nodes][EO_STRESSES], Pa. Errors: memory. */
enum eo_code eo_root_field_init(struct eo_root_field *field, int rank, int nodes, const double *shape,
                                struct eo_error *error);
void eo_root_field_done(struct eo_root_field *field);

/* [rank][columns of a block]: the shapes where a block has them. */
float *eo_root_field_block(const struct eo_root_field *field, int block);

/* After the shapes have changed. */
void eo_root_field_bound(struct eo_root_field *field);

/* Of each of coefficient[rows][stride], aligned to EO_GRAM_ALIGN: the largest principal stress, 0 where nothing is in
   tension, and its node. room[rows][columns]: scratch, aligned as well. A row comes from its coefficients alone. */
void eo_root_field_find_largest(const struct eo_root_field *field, const struct eo_gram *gram, int rows,
                                const float *coefficient, int stride, float *room, double *largest, int *node);

#endif
