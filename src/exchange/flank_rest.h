/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the rack leaves of a flank: of all that it generates the lowest, seen along the normals of the unmodified flank.
   Found without the pieces into which the flank is cut, so it tells how right those are, and where a relief folds:
   there the rack cuts away what it has made. */
#ifndef EASEOFF_EXCHANGE_FLANK_REST_H
#define EASEOFF_EXCHANGE_FLANK_REST_H

#include "exchange/flank_pieces.h"

/* How far points of the pieces are from what the rack leaves, along the normal, and pieces from each other, at most, m.
 */
double eo_flank_rest_error(const struct eo_flank_pieces *pieces);

#endif
