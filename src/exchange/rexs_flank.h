/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One flank of a pair while its modifications are read, and the coordinates they stand in. Lengths in mm as in the
   file. */
#ifndef EASEOFF_EXCHANGE_REXS_FLANK_H
#define EASEOFF_EXCHANGE_REXS_FLANK_H

#include "exchange/rexs_import.h"

struct eo_rexs_flank {
  struct eo_rexs_import *import;
  const struct eo_rexs_wheel *wheel;
  int member, end;
  bool coast;
  struct eo_geometry half; /* of its end */
  double amount;           /* factor on amounts: 1, or cos(beta_b) for those of the transverse section */
  double leading;          /* +1, -1: the face that meets first lies towards + x, - x */
  double datum;            /* the datum face, likewise */
  double width;            /* common face width */
  double shift;            /* mid face of the gear from the common mid face, along x */
  /* what has been read: NaN, not stated */
  double tip_relief, tip_start, root_relief, root_start, crowning, lead_crowning, helix_slope, lead_offset;
  double end_relief[2], end_length[2]; /* [trailing, leading] */
  double profile_slope, barrel, twist;
  const char *tip_shape, *root_shape, *end_shape[2]; /* words of the design */
  json_t *grid;                                      /* owned; NULL */
};

/* Rolling length of a diameter, profile coordinate u of a rolling length (+ to the own tip), mm. */
double eo_rexs_roll(const struct eo_rexs_flank *flank, double diameter);
double eo_rexs_profile(const struct eo_rexs_flank *flank, double roll);
/* u at the tip end and the root end of the active profile: > 0, < 0. */
double eo_rexs_tip_end(const struct eo_rexs_flank *flank);
double eo_rexs_root_end(const struct eo_rexs_flank *flank);

/* Reads one modification into the flank; "": done, else what stands in the way, as the end of "NAME: ". */
typedef const char *eo_rexs_modification(struct eo_rexs_flank *flank, const struct eo_rexs_component *modification);
eo_rexs_modification eo_rexs_tip_relief, eo_rexs_root_relief, eo_rexs_profile_crowning, eo_rexs_profile_slope,
    eo_rexs_profile_twist, eo_rexs_helix_crowning, eo_rexs_helix_slope, eo_rexs_end_relief, eo_rexs_topography;

#endif
