/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a design says about the gears as they are made: which inputs scatter and how, what is asked of the pairs. In the
   document's words: keys and units are those of the design document, so these structs stay as they were read. */
#ifndef EASEOFF_TOLERANCE_TOLERANCE_SETTINGS_H
#define EASEOFF_TOLERANCE_TOLERANCE_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

#include "tolerance/pair_sampler.h"

enum { EO_MAX_SCATTER_ROWS = 48, EO_MAX_TOLERANCE_LIMITS = 16, EO_SCATTER_KEY = 96, EO_SCATTER_TEXT = 512 };

/* Where the inputs come from beside the rows. */
enum eo_scatter_preset {
  EO_SCATTER_AS_STATED,   /* nowhere */
  EO_SCATTER_ISO_CLASS,   /* tolerances of ISO 1328-1, twice sigma, cut at 2.5 sigma */
  EO_SCATTER_GROUND,      /* three sigma; reliefs and crownings within 2 um */
  EO_SCATTER_AS_MEASURED, /* nowhere; every row has values */
};

/* How the pairs are computed. */
enum eo_scatter_method {
  EO_SCATTER_AUTO,         /* coarse first from EO_COARSE_FIRST_FROM pairs on, where it can be and saves much */
  EO_SCATTER_FULL,         /* every pair in full */
  EO_SCATTER_COARSE_FIRST, /* all coarsely, those that decide in full */
};
enum { EO_COARSE_FIRST_FROM = 500 };

enum eo_scatter_kind {
  EO_SCATTER_NORMAL,
  EO_SCATTER_UNIFORM,
  EO_SCATTER_VALUES,
  EO_SCATTER_FIXED_SUM,
  EO_SCATTER_HALF_NORMAL
};

/* Deviations of one input from its nominal value, in the unit of its key; `*` in the key stands for every name. */
struct eo_scatter_row {
  char key[EO_SCATTER_KEY];
  int kind;                     /* enum eo_scatter_kind */
  double bias, sigma;           /* NORMAL, FIXED_SUM, HALF_NORMAL */
  double cut;                   /* NORMAL, HALF_NORMAL: values beyond do not occur; NaN: none */
  double low, high;             /* UNIFORM */
  char values[EO_SCATTER_TEXT]; /* VALUES: numbers as text */
  char group[32];               /* VALUES: drawn row by row together; FIXED_SUM: whose sum stays what it is */
};

/* A pair is good where no load case has more. */
struct eo_tolerance_limit {
  char output[EO_SCATTER_KEY];
  int load_case; /* 1 ..; 0: every one */
  double most;
};

struct eo_tolerance_settings {
  int preset;  /* enum eo_scatter_preset */
  int edition; /* of ISO 1328-1: enum eo_tolerance_edition of rating/ */
  int grade;   /* class of 2013, grade of 1995 */
  int pairs;
  int sampling; /* enum eo_sampling */
  int method;   /* enum eo_scatter_method */
  uint64_t seed;
  bool vibration, root_stress;
  bool centre_distance; /* scatters within its allowance */
  bool single_teeth;    /* every pair has teeth of its own, over the hunting period */
  int rows;
  struct eo_scatter_row row[EO_MAX_SCATTER_ROWS];
  int limits;
  struct eo_tolerance_limit limit[EO_MAX_TOLERANCE_LIMITS];
};

#endif
