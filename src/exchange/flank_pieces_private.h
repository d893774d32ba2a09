/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the files that cut a flank into pieces; nobody else includes it. Lengths in m; u, y as in flank_pieces.h.
 */
#ifndef EASEOFF_EXCHANGE_FLANK_PIECES_PRIVATE_H
#define EASEOFF_EXCHANGE_FLANK_PIECES_PRIVATE_H

#include "exchange/flank_pieces.h"

#define EO_FLANK_NEAR 1e-12 /* m: what is no distance */
#define EO_FLANK_STEP 1e-7  /* m: of differences */
#define EO_FLANK_SAG 2e-10  /* m, normal: less is no step */
enum { EO_FLANK_STEPS = 20, EO_FLANK_ROWS = 16 };

/* The unmodified flank at (u, y): origin, normal, and the tangent that is at right angles to the helix. */
struct eo_flank_frame {
  struct eo_surface_point origin;
  double tangent[3];
};

/* What the pieces were made of; borrowed from them. */
const struct eo_modification_shape *eo_flank_shape_of(const struct eo_flank_pieces *pieces);

/* u of line k at y, within the flank. */
double eo_flank_line_at(const struct eo_flank_pieces *pieces, int k, double y);

/* What a piece generates, at its ends by the slopes of its own side, beyond them in a line. */
void eo_flank_piece_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double u, double y,
                       struct eo_surface_point *point);

/* What a corner of the rack sweeps between the pieces before and after it; a from 0 to 1: slopes from those of one to
   those of the other. */
void eo_flank_swept_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double a, double y,
                       struct eo_surface_point *point);

/* What the rack generates at (u, y), whichever piece that is of. */
void eo_flank_rack_at(const struct eo_flank_pieces *pieces, double u, double y, struct eo_surface_point *point);

/* The frame at a place, lengths in m. */
struct eo_flank_frame eo_flank_frame_at(const struct eo_flank_pieces *pieces, double u, double y);

/* How far a point lies beyond the frame's origin towards the tip, and how far out of the tooth. */
double eo_flank_ahead(const struct eo_flank_frame *frame, const double position[3]);
double eo_flank_above(const struct eo_flank_frame *frame, const double position[3]);

/* The angle between two unit normals, as its sine. */
double eo_flank_turn(const double a[3], const double b[3]);

/* The piece's own u, between those of `within`, whose point lies on the normal of the unmodified flank at `place`. */
double eo_flank_find_u(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double place, double y,
                       double guess, const double within[2]);

/* The place on the unmodified flank on whose normal a point lies. */
double eo_flank_find_place(const struct eo_flank_pieces *pieces, const double position[3], double guess, double y);

/* Whether points of a piece are too near each other for their place to tell u: less than this share of the rack's. */
bool eo_flank_stands_still(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece);

/* How far the piece above begins beyond where the piece below ends, towards the tip; less than 0: they overlap. *sag:
   how far what lies between bends off a straight way, normal. */
double eo_flank_step_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *below,
                        const struct eo_flank_piece *above, double y, double *sag);

/* Whether what the rack's corner sweeps between two pieces of a band is a piece of its own. */
bool eo_flank_is_swept(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *below,
                       const struct eo_flank_piece *above);

/* Radius of a point of a flank, m. */
double eo_flank_radius(const struct eo_surface_point *point);

/* What is left at an end of the flank (0: root, 1: tip) at y: how many of the band's pieces [count] are folded back
   there as a whole or lie beyond the circle where the flank ends, whether the next one does in part, and whether it
   goes on to that circle beyond its line. */
struct eo_flank_fold {
  int lost;
  bool part, open;
};
struct eo_flank_fold eo_flank_fold_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece,
                                      int count, int which, double y);

/* What of a swept corner lies between the circles where the flank ends. */
void eo_flank_swept_share(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double y,
                          double share[2]);

/* The ends at y of a piece that no corner sweeps. Both are the same where nothing of it is left. */
void eo_flank_ends_at(const struct eo_flank_pieces *pieces, const struct eo_flank_piece *piece, double y,
                      struct eo_flank_row *row);

#endif
