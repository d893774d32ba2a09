/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The finite-element mesh of a transverse section: a sector of a few teeth, quadrilaterals. Per tooth a core block
   (columns across the tooth, rows from the tip down to the start of the active profile and on down to the bore) and two
   side blocks whose upper edge is the root from there to the middle of the tooth space (after the division of a tooth
   in Litvin and Fuentes 2004). Neighbours share only the radial cut between them, so that teeth may be divided
   differently. Below the side blocks plain rings may go on towards the axis. */
#ifndef EASEOFF_FLEXIBILITY_SECTION_H
#define EASEOFF_FLEXIBILITY_SECTION_H

#include "base/error.h"
#include "gear/geometry.h"

#include <stdbool.h>

/* How one tooth is divided. */
struct eo_tooth_division {
  int columns;   /* across the tooth, even: the tooth's centre is a column of nodes */
  int rows;      /* over the active profile, in even steps of the path coordinate */
  int fillet[2]; /* along the root, at x < 0 and x > 0 */
};

struct eo_section_settings {
  int teeth;                                    /* 1, 3 or 5 */
  struct eo_tooth_division loaded, next, outer; /* the loaded tooth, its two neighbours, the teeth beyond */
  int rim;                                      /* from the root to the foot */
  double foot_radius; /* where the lines that follow the root end, m; plain rings go on to the bore below it. Not above
                         the bore: no rings */
  bool open;          /* one tooth of a ring: the cut faces are free, and its cuts are listed */
  bool floating;      /* so is the bore; what lies at the foot or below keeps its place along the axis */
};

/* Which displacements of a node are held: those along x, y and the axis. */
enum { EO_HELD_X = 1, EO_HELD_Y = 2, EO_HELD_AXIAL = 4, EO_HELD_ALL = 7 };

/* Nodes of a section on one flank, in ascending path coordinate s. */
struct eo_flank_nodes {
  int count;
  int *node;      /* [count] */
  double *s;      /* [count], m */
  double *normal; /* [count][2], transverse, out of the tooth */
};

/* Frame: the loaded tooth's centre line along +y, its loaded flank at x > 0; lengths in m. */
struct eo_section {
  int nodes, quads;
  double *point;       /* [nodes][2] */
  int *quad;           /* [quads][4], counterclockwise */
  unsigned char *half; /* [quads]: 1 in the loaded half of the loaded tooth: loaded side of its centre line, outside the
                          root circle */
  unsigned char *fixed;  /* [nodes]: EO_HELD_... bits; all on the bore and on both radial cut faces of a sector */
  unsigned char *centre; /* [nodes]: 1 on the centre line of the loaded tooth, tip to bore */
  double bore_radius;
  struct eo_flank_nodes flank; /* loaded flank of the loaded tooth */
  struct eo_flank_nodes
      next_flank[2]; /* same side of the neighbours; [0]: pair k - 1, [1]: pair k + 1; empty with 1 tooth */
  int cut_nodes;     /* on each cut of an open section, from the root inwards */
  int *cut[2];       /* [cut_nodes]: at x < 0, x > 0; the second is the first turned clockwise by a pitch */
  int root_nodes;    /* on the loaded side, from the start of the active profile to the middle of the tooth space */
  int *root;         /* [root_nodes]; root[0] is also a flank node */
};

/* bore_radius: where the sector ends inwards. Errors: memory; EO_ERROR_INPUT when that many teeth do not fit round the
   gear or the bore leaves no rim. */
enum eo_code eo_section_init(struct eo_section *section, const struct eo_geometry *geometry, int member,
                             double bore_radius, const struct eo_section_settings *settings, struct eo_error *error);
void eo_section_done(struct eo_section *section);

#endif
