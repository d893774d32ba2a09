/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A gear pair made ready for evaluation: everything that micro-geometry, load and speed do not change. Constant once
   made; shared by every thread. Halves of unequal width or helix are two of them, with as many positions: helices that
   meet in the middle of the groove give the right mid face the phase c_R = c_L + (b_R tan(beta_bR) - b_L tan(beta_bL) +
   groove (tan(beta_bR) - tan(beta_bL)))/2 where eta runs outwards, and minus that where it runs inwards. Whole
   positions of it are counted apart, as a stagger is; what is left is in the phases of the right grid (eta outwards,
   the usual sense; inwards it is off by at most half a position). */
#ifndef EASEOFF_EVALUATION_PAIR_H
#define EASEOFF_EVALUATION_PAIR_H

#include "design/design.h"
#include "contact/grid.h"
#include "contact/loaded.h"
#include "contact/iso6336.h"
#include "contact/root.h"
#include "contact/impact.h"
#include "flexibility/flexibility.h"

struct eo_pair {
  struct eo_geometry geometry;
  struct eo_gear_pair gear_pair;
  struct eo_material material;
  struct eo_resolution resolution;
  struct eo_flexibility *flexibility; /* NULL with a foreign kernel */
  struct eo_kernel kernel;
  struct eo_contact_grid *grid;
  struct eo_root_modes *root_modes[2]; /* [member]; NULL with a foreign kernel, as what follows */
  struct eo_root_tables *root;         /* of the points of the grid */
  double pitch_deflection[2];          /* [member]: of mid face at s = 0 under 1 N/m on that row, m */

  struct eo_impact_settings impact;
  double pivot[2];       /* [end]: mid face from the pivot of the shaft angle errors, m */
  struct eo_pair *right; /* owned: the right half where it differs; NULL: as the left one */
  int ahead[2];          /* [inwards]: positions by which the right half's phase is ahead of the left one's */
  double centre_distance_deviation; /* of the axes, m */
  bool borrows;                     /* the flexibility is another pair's: eo_pair_apart() */
  double seconds;                   /* wall time of the preparation */
};

/* How to prepare otherwise than a design says: reference cases bring their own compliance and discretisation. */
struct eo_pair_options {
  const char *cache_directory;                 /* NULL: keep nothing on disk */
  struct eo_kernel kernel;                     /* .evaluate NULL: finite elements */
  const struct eo_contact_grid_settings *grid; /* NULL: of the resolution */
  const double *phase;                         /* [grid->positions] c, m; NULL: equal steps */
  int impact_stations;                         /* see struct eo_impact_settings */
  enum eo_tilt_rule tilt_rule;                 /* see contact/corner.h */
  bool own_pivots;                             /* shaft angle errors about each end's mid face */
};

/* Uses gear_pair, material and resolution of a resolved design. Errors: of the geometry (EO_ERROR_INPUT), flexibility,
   memory, cancelled. */
enum eo_code eo_pair_new(struct eo_pair **pair, const struct eo_design *design, const struct eo_pair_options *options,
                         const struct eo_progress *progress, struct eo_error *error);
void eo_pair_free(struct eo_pair *pair);

/* The same two gears with their axes so far from the centre distance of the drawing, m: a contact grid of its own on
   the flexibility of the pair, which is borrowed as long as this one lives; grid and options as by default. root: with
   the tables of the root stress, where the pair has them. Errors: of eo_geometry_set_apart(), memory. */
enum eo_code eo_pair_apart(struct eo_pair **apart, const struct eo_pair *pair, double deviation, bool root,
                           struct eo_error *error);

/* What one end is evaluated on. */
static inline const struct eo_pair *eo_pair_half(const struct eo_pair *pair, int end)
{
  return end == EO_RIGHT && pair->right ? pair->right : pair;
}

/* Their helices on one footing. */
static inline struct eo_double_helix eo_pair_double_helix(const struct eo_pair *pair)
{
  return eo_contact_double_helix(pair->grid, eo_pair_half(pair, EO_RIGHT)->grid);
}

/* 2 where the halves differ. */
static inline int eo_pair_halves(const struct eo_pair *pair)
{
  return pair->right ? 2 : 1;
}

/* What ISO 6336-1 asks of this pair: solid discs, C_M = 0.8. */
struct eo_iso_stiffness_input eo_pair_iso_stiffness_input(const struct eo_pair *pair);

/* True when the pair serves this design as it is (same gear pair, material and the parts of the resolution that
   preparation uses). */
bool eo_pair_serves(const struct eo_pair *pair, const struct eo_design *design);

#endif
