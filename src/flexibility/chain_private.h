/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of a ring by chains share: chain.c makes chains of single teeth, chain_merge.c joins two of them,
   chain_close.c closes the ring and finds the faces again. */
#ifndef EASEOFF_FLEXIBILITY_CHAIN_PRIVATE_H
#define EASEOFF_FLEXIBILITY_CHAIN_PRIVATE_H

#include <stddef.h>

#include "flexibility/chain.h"

/* Of the balancing forces: rotation, translation along x, along y. */
enum { EO_CHAIN_PATTERNS = 3 };

/* Teeth side by side, condensed; matrices by columns. */
struct eo_chain {
  int teeth;
  double *left, *right; /* S_LL, S_RR: [face][face], symmetric; owned, as all */
  double *across;       /* S_LR */
  double *body[2];      /* [EO_CHAIN_PATTERNS][face]: balancing forces on the left, the right face */
  double moved[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS]; /* work of the patterns inside */
};

/* A face that was eliminated between a chain and one more tooth, and how to find it again. */
struct eo_chain_join {
  int first;      /* tooth at which the joined chain begins */
  bool leading;   /* the single tooth stands left of the chain */
  double *factor; /* of K */
  double *across; /* the chain's S_LR before */
  double *body;   /* [EO_CHAIN_PATTERNS][face]: balancing forces on the face */
};

struct eo_chain_work {
  const struct eo_ring_tooth *tooth;
  const struct eo_progress *progress;
  const char *what;
  double first, last;
  int steps, step;
  double *field; /* [EO_CHAIN_PATTERNS][face]: rotation, translation along x, y of a tooth's own left face */
  struct eo_chain single;
  struct eo_chain_join *join; /* [2 reach] */
  int joins;
};

/* Room for the matrices of a face of n unknowns; `body` is 0. Done leaves an empty chain. Errors: memory. */
enum eo_code eo_chain_init(struct eo_chain *chain, size_t n, struct eo_error *error);
void eo_chain_done(struct eo_chain *chain);

/* The patterns of the first tooth's frame as tooth t sees them: columns of coefficients. */
void eo_chain_turn(const struct eo_ring_tooth *tooth, int t, double turn[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS]);

/* out = body turn, patterns of a chain that begins t teeth further on; [EO_CHAIN_PATTERNS][face]. */
void eo_chain_turn_body(const struct eo_ring_tooth *tooth, int t, const double *body, double *out);

/* sum += turn' moved turn. */
void eo_chain_add_moved(const struct eo_ring_tooth *tooth, int t,
                        const double moved[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS],
                        double sum[EO_CHAIN_PATTERNS][EO_CHAIN_PATTERNS]);

/* a and b side by side -> out, which is fresh and, on an error too, the caller's to end. join: NULL, or takes what
   finds the face again. A step of the work: reports it. Errors: memory, EO_ERROR_NUMERIC, EO_ERROR_CANCELLED. */
enum eo_code eo_chain_merge(struct eo_chain_work *work, const struct eo_chain *a, const struct eo_chain *b,
                            struct eo_chain *out, struct eo_chain_join *join, struct eo_error *error);

/* Tooth 0 between the ends of the chain of all others, motion->reach of them joined last: fills motion->left. Errors:
   memory, EO_ERROR_NUMERIC. */
enum eo_code eo_chain_close(const struct eo_chain_work *work, const struct eo_chain *chain,
                            struct eo_ring_motion *motion, struct eo_error *error);

#endif
