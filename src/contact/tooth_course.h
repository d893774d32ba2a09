/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the contact of one mesh position goes on as one pair of teeth is moved away from the others: solutions at a few
   nodes of its distance, and all between them. Beyond the outer ones nothing changes but that Z moves with a pair which
   carries alone. */
#ifndef EASEOFF_CONTACT_TOOTH_COURSE_H
#define EASEOFF_CONTACT_TOOTH_COURSE_H

#include <stdbool.h>

/* PAIRS: at once, that teeth of a ring are coupled over, and more. */
enum { EO_COURSE_PAIRS = 32, EO_COURSE_NODES = 33 };

/* What a solution leaves, or what stands between two (but for reach). Of pairs in their order. */
struct eo_course_state {
  double approach, tangent;                                                      /* Z, m; k_tan, N/m */
  double load[EO_COURSE_PAIRS], share[EO_COURSE_PAIRS], square[EO_COURSE_PAIRS]; /* N; of 1 N more, and so dZ/dw; of the
                                                                                    largest pressure, Pa2 */
  double reach[EO_COURSE_PAIRS]; /* m, how far a pair reaches into contact; -INFINITY: it is not there */
};

struct eo_tooth_course {
  int mover; /* pair that is moved */
  int nodes;
  double at[EO_COURSE_NODES]; /* m, ascending */
  double end[2];              /* m, the outer nodes' solutions: between there and the nodes nothing changes but Z */
  struct eo_course_state state[EO_COURSE_NODES];
};

/* What is asked of so many pairs: loads: with load and square. */
void eo_course_state_copy(struct eo_course_state *state, const struct eo_course_state *from, int pairs, bool loads);

/* Makes room for a node and returns its state; NULL: there is none left. */
struct eo_course_state *eo_tooth_course_add(struct eo_tooth_course *course, double at);

/* All of it there, of so many pairs: between the nodes as theory (P8) and (P9) say. loads: with load and square. */
void eo_tooth_course_find(const struct eo_tooth_course *course, int pairs, double at, bool loads,
                          struct eo_course_state *state);

/* All of it where another pair moves as well: across[course->nodes] are the courses of that one from the nodes of this,
   of the outer ones from their solutions. */
void eo_tooth_course_cross(const struct eo_tooth_course *course, const struct eo_tooth_course *across, int pairs,
                           double at, double other, bool loads, struct eo_course_state *state);

#endif
