/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A flank as the rack generates it, cut into smooth pieces. Where the slope of the modification jumps (a linear
   relief's start, the border of a grid or of a corner relief) the rack has a corner, and either both sides generate
   beyond each other: their pieces end where they cross; or neither reaches the other: between them lies what the corner
   itself sweeps, a narrow piece of its own, tangent to both. A band ends where one turns into the other. Near the base
   circle a steep relief turns the flank back from its root end on; the rack cuts that away with what it generates
   behind the fold, so the flank begins there. Else it reaches from the circle where the active profile starts to the
   tip circle: a relief moves what the rack generates along the flank, so the rack goes on as far as that takes. Bands
   of y, lines of u across them. */
#ifndef EASEOFF_EXCHANGE_FLANK_PIECES_H
#define EASEOFF_EXCHANGE_FLANK_PIECES_H

#include "exchange/tooth.h"

enum { EO_FLANK_LINES = 12, EO_FLANK_BANDS = 48, EO_FLANK_PIECES = EO_FLANK_BANDS * 2 * EO_FLANK_LINES };

/* u = at + rate y, m. */
struct eo_flank_line {
  double at, rate;
};

/* Between two lines of a band; a swept corner: both are the same. */
struct eo_flank_piece {
  int band, line[2];
  bool swept[2]; /* what lies beyond each end is a swept corner */
  bool lost;     /* folded back at an end of the flank, or beyond the circle where it ends: nothing of it is left */
  bool open[2];  /* all that lies beyond its line there is beyond the circle: it goes on as far as that */
  bool direct; /* u goes evenly from end to end: near the base circle the flank stands still; else the place on it does
                */
};

struct eo_flank_pieces {
  const struct eo_tooth *tooth;
  bool coast;
  double u[2];                               /* root and tip end of what the rack needs for it, m */
  double radius[2];                          /* of the circles on which the flank ends, m; 0, INFINITY: on none */
  int lines;                                 /* the first: root end, the second: tip end */
  struct eo_flank_line line[EO_FLANK_LINES]; /* in no order: they cross at ends of bands only */
  int bands;
  double y[EO_FLANK_BANDS + 1]; /* m */
  int count;
  struct eo_flank_piece piece[EO_FLANK_PIECES];
  double sense; /* of the profile's tangent, +1 or -1 */
};

/* part: a flank. The tooth stays where it is. */
void eo_flank_pieces_init(struct eo_flank_pieces *pieces, const struct eo_tooth *tooth, enum eo_tooth_part part);

/* The piece's ends at one y, kept from point to point. */
struct eo_flank_row {
  double b;                           /* less than 0: none yet */
  const struct eo_flank_piece *maker; /* the piece, or where nothing of it is left its neighbour */
  double own[2];                      /* the piece's u, m */
  double place[2]; /* the places on the unmodified flank on whose normals these points lie, as u, m */
  double share[2]; /* of a swept corner, what of it lies between the circles where the flank ends */
};

/* Point (m) and unit normal (may be NULL), out of the tooth, of piece k, which is not lost, of tooth 0 in the frame of
   eo_tooth_point(); a: from root to tip, b: from low y to high. */
void eo_flank_piece_point(const struct eo_flank_pieces *pieces, int k, struct eo_flank_row *row, double a, double b,
                          double point[3], double normal[3]);

#endif
