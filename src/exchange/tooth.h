/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The surfaces of one tooth in the frame of the member (that of flank-points): z the axis, from the middle of the
   groove (of the only face) to the right; the drive flank would, unmodified, pass through x = 0 at the working pitch
   radius in mid face. It faces +x, or -x where the pinion turns clockwise seen from its left end: that is the mirror
   image. Teeth have no thickness allowance. Flanks are modified over their active profile, tip included; what
   lies below it belongs to the root, unmodified: a relief is not defined there, and going on it can fold near the base
   circle. */
#ifndef EASEOFF_EXCHANGE_TOOTH_H
#define EASEOFF_EXCHANGE_TOOTH_H

#include <stdbool.h>

#include "design/design.h"
#include "gear/geometry.h"
#include "gear/modification.h"
#include "gear/surface.h"

enum eo_tooth_part {
  EO_TOOTH_DRIVE,
  EO_TOOTH_COAST,
  EO_TOOTH_TIP,
  EO_TOOTH_DRIVE_ROOT,
  EO_TOOTH_COAST_ROOT,
  EO_TOOTH_PARTS
};
extern const char *const eo_tooth_part_names[EO_TOOTH_PARTS];

enum { EO_TOOTH_PIECES = EO_MOST_VERTICES + 1 };

struct eo_tooth {
  struct eo_geometry own;             /* of its end */
  const struct eo_geometry *geometry; /* the same; a tooth stays where it was made */
  int member, end;
  bool two_ends;
  double along, across;                  /* +1, -1: from the frame of its own end to that of the member: z, x */
  struct eo_modification_shape shape[2]; /* [drive, coast] */
  struct eo_flank_spline *spline[2];     /* owned: their grids; NULL: none */
  double offset;                         /* z of mid face, m */
  double pitch;                          /* angle of the unmodified flank at the pitch radius in mid face as
                                            eo_surface_evaluate() has it, from +y towards +x, rad */
  double behind;                         /* a stagger: turn from +x towards +y, rad */
  double half;  /* from the tooth's centre to the drive flank at the working pitch radius, rad */
  double twist; /* of the tooth per m of z in its own end, from +y towards +x, rad/m */
  double form_path, start_path, tip_path; /* own path coordinate of the form circle, of the start of the active profile
                                             and of the tip, m */
  double fillet_share;                    /* of the root's parameter up to the form circle; behind it the involute */
  double circle_share;                    /* of that part, the root circle */
};

/* Release with eo_tooth_done(). Errors: memory. */
enum eo_code eo_tooth_init(struct eo_tooth *tooth, const struct eo_design *design, const struct eo_geometry *geometry,
                           int member, int end, struct eo_error *error);
void eo_tooth_done(struct eo_tooth *tooth);

/* Where what is no flank is cut into smooth pieces (flanks: flank_pieces.h): parameters 0..1 along (0: profile, 1:
   face); 0 and 1 among them. Returns how many, at least 2. */
int eo_tooth_breaks(const struct eo_tooth *tooth, enum eo_tooth_part part, int direction,
                    double at[EO_TOOTH_PIECES + 1]);

/* Point (m) and unit normal (may be NULL), out of the tooth. p: profile, from root to tip, of the tip land from the
   coast to the drive flank, of a root from the middle of the tooth space to the flank; q: face, from left to right.
   number: of the tooth, 0 the one described above, the others from the drive flank's side on. */
void eo_tooth_point(const struct eo_tooth *tooth, enum eo_tooth_part part, int number, double p, double q,
                    double point[3], double normal[3]);

/* A point of a generated flank, tooth 0, in the frame of the member; normal may be NULL. */
void eo_tooth_place(const struct eo_tooth *tooth, bool coast, const struct eo_surface_point *generated, double point[3],
                    double normal[3]);

#endif
