/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One position of the mesh cycle with its courses, shared by the files that make it and go through the period. */
#ifndef EASEOFF_CONTACT_TOOTH_COURSES_PRIVATE_H
#define EASEOFF_CONTACT_TOOTH_COURSES_PRIVATE_H

#include "contact/hunting_private.h"
#include "contact/tooth_course.h"

/* One position of the mesh cycle of an end. */
struct eo_follow_place {
  int j;                                          /* of the grid */
  int pairs, first;                               /* first: number of the first pair */
  int leader;                                     /* carries most where all teeth are alike */
  struct eo_course_state alike;                   /* where all pairs stand as they do without deviations */
  int courses;                                    /* of pairs that can carry beside the leader */
  struct eo_tooth_course course[EO_COURSE_PAIRS]; /* [courses], that of the pair that carries most first */
  struct eo_tooth_course across[EO_COURSE_NODES]; /* of the second one's pair, from the nodes of the first */
  bool crossed;                                   /* they are there */
};

/* What one end of a pair's course carried at the places before, of which `at` is the last, while the same pair carried
   most. */
struct eo_trail {
  int known, at, leader;
  double *load[EO_HUNTING_BEFORE]; /* [most points] line loads */
  double approach[EO_HUNTING_BEFORE];
};

struct eo_follow {
  const struct eo_hunting_input *input;
  double within, settled;      /* of Z between solutions; of a solution, m */
  int end, places, step;       /* of a mesh cycle, step of the grid's positions apart */
  int teeth[2], cycles, lines; /* of the hunting period; pairs at most */
  bool formed;                 /* teeth of the end have forms of their own */
  int failures;
  struct eo_loaded_workspace *workspace, *own; /* own: where none is lent */
  struct eo_loaded_end solved;
  double *gap;                       /* [points of the grid] with a pair moved away */
  double *start, *weight;            /* [most points] line loads of teeth alike; share of the load of its pair */
  double *share, *reach;             /* [most points] of 1 N more; into contact, m */
  double *off[2];                    /* [member]: [teeth] what each adds to the gap of the pair at hand */
  double *apart;                     /* [lines][cycles] gap of each pair, m */
  bool apart_known[EO_COURSE_PAIRS]; /* [lines] at every place: without forms a gap is one number */
  int first_line;                    /* number of the pair whose gaps come first */
  struct eo_trail *trail;            /* [lines][2] of the nearer end and the farther one */
  double *trail_room;
  struct eo_follow_place place;
};

/* Makes the courses of a place: step times `at` of the grid's positions. From the place before where there is one. */
void eo_follow_prepare(struct eo_follow *follow, int at);

/* Contact there in a cycle of the hunting period. loads: with load and square. */
void eo_follow_find(const struct eo_follow *follow, int cycle, bool loads, struct eo_course_state *state);

/* In tooth_trail.c. The solution of an end of a course goes into its trail; puts what the trail leads to in the place
   of a solution, false: there is none. */
bool eo_trails_init(struct eo_follow *follow, int points); /* false: memory */
void eo_trails_forget(struct eo_follow *follow);
void eo_trails_done(struct eo_follow *follow);
void eo_trail_add(const struct eo_follow *follow, struct eo_trail *trail);
bool eo_trail_lead(struct eo_follow *follow, const struct eo_trail *trail);

#endif
