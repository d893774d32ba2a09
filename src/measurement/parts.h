/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which rows of a recording are measured: the shafts may stand still at its start and end, turn back, run up, or change
   from one steady state to another. Everything here is said in findings; the caller may choose. */
#ifndef EASEOFF_MEASUREMENT_PARTS_H
#define EASEOFF_MEASUREMENT_PARTS_H

#include "base/progress.h"
#include "measurement/angles.h"

enum { EO_PARTS = 16 };

/* What the caller wants of the recording; zeroed: the longest part. */
struct eo_part_choice {
  int part;        /* number from 1 in the list of parts; 0: the one with the most turns */
  bool whole;      /* keep run-up and run-down beside a steady state */
  double from, to; /* s after the first row; to 0: until the end */
};

/* A stretch in which the pinion turns one way without a stop. */
struct eo_part {
  int64_t first, last;          /* rows of the angles, both inside */
  double from, to;              /* s after the first row of the recording */
  double turns;                 /* of the pinion, negative: backwards */
  double speed_low, speed_high; /* of whole turns of the pinion, rad/s, not signed */
};

struct eo_parts {
  int count;                     /* all that are long enough to be measured; beyond EO_PARTS they are only counted */
  struct eo_part part[EO_PARTS]; /* in the order of time */
  int used;                      /* index of the one that is measured; -1: none */
  struct eo_part measured;       /* what is measured of it: all, or its steady state */
};

/* Finds the parts, chooses one and says so. A choice that does not exist, and a recording without a part, are refused
   by a finding. Errors: memory, files, cancelled. */
enum eo_code eo_parts_find(struct eo_parts *parts, const struct eo_angles *angles, const struct eo_part_choice *choice,
                           struct eo_findings *findings, const struct eo_progress *progress, struct eo_error *error);

#endif
