/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of STEP share: step_part.c cuts a part of a tooth into faces that are fitted, step.c writes them. */
#ifndef EASEOFF_EXCHANGE_STEP_PRIVATE_H
#define EASEOFF_EXCHANGE_STEP_PRIVATE_H

#include "exchange/flank_pieces.h"
#include "exchange/patch.h"
#include "exchange/step.h"
#include "exchange/tooth.h"

extern const double eo_step_tolerance; /* m: half of what a file may be off */

enum { EO_STEP_SIDES = 4 };

/* A smooth piece. Its sides: along p at q = 0, along q at p = 1, along p at q = 1, along q at p = 0; its corners (0,
   0), (1, 0), (1, 1), (0, 1). */
struct eo_step_face {
  int i, j;                  /* of a flank its piece; else the piece along p and along q */
  int group[2];              /* pieces that share a number of points along p, along q */
  int edge[EO_STEP_SIDES];   /* numbers in the part; -1: the side is one point */
  int vertex[EO_STEP_SIDES]; /* numbers in the part */
  double error;              /* m */
  struct eo_patch patch;
};

enum { EO_STEP_GROUPS = EO_FLANK_LINES * EO_FLANK_LINES };

/* One part of a tooth in smooth pieces. */
struct eo_step_part {
  const struct eo_tooth *tooth;
  enum eo_tooth_part part;
  bool flipped; /* p runs backwards, so that dS/dp x dS/dq points out of the tooth */
  bool flank;
  struct eo_flank_pieces pieces; /* of a flank */
  double at[2][EO_TOOTH_PIECES + 1];
  struct eo_patch_sites sites[2][EO_STEP_GROUPS]; /* of each group */
  double error;                                   /* m off the exact surface at most, between the points */
  int faces;
  struct eo_step_face *face; /* owned */
  int edges, vertices;
  int *id; /* owned: of every edge, then of every vertex, in the file */
};

/* The part in as many faces as it needs, and which edges and corners they have in common. False: memory, or a system
   that has no solution; done all the same. */
bool eo_step_part_init(struct eo_step_part *part, const struct eo_tooth *tooth, enum eo_tooth_part kind);
void eo_step_part_done(struct eo_step_part *part);

/* Which control points a side has: the first, how far to the next, how many. */
struct eo_step_strip {
  int first, stride, count;
};
struct eo_step_strip eo_step_strip(const struct eo_patch *patch, int side);

#endif
