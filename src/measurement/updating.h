/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inputs of a design that nobody knows, from measurements: least squares on the accelerations of the mesh orders within
   given ranges. Resonances make many minima: the search starts at many points and lists what it finds. The intervals
   come from the profile of the misfit, its least value over all other inputs; where the data cannot tell, that is
   said. */
#ifndef EASEOFF_MEASUREMENT_UPDATING_H
#define EASEOFF_MEASUREMENT_UPDATING_H

#include "measurement/comparison.h"

/* What can be fitted, and its key for people and documents. Gear axial: at both ends; pinion axial: holds the pinion by
   a spring; impact patch: acts only where impacts act in the dynamics. */
#define EO_UNKNOWN_INPUTS(ROW)                             \
  ROW(PINION_BEARING, "pinion_bearing_stiffness_N_per_um") \
  ROW(GEAR_BEARING, "gear_bearing_stiffness_N_per_um")     \
  ROW(MESH_DAMPING, "mesh_damping_ratio")                  \
  ROW(GEAR_AXIAL, "gear_axial_stiffness_N_per_um")         \
  ROW(PINION_AXIAL, "pinion_axial_stiffness_N_per_um")     \
  ROW(IN_PLANE, "shaft_angle_error_in_plane_deg")          \
  ROW(OUT_OF_PLANE, "shaft_angle_error_out_of_plane_deg")  \
  ROW(IMPACT_PATCH, "impact_patch_mm")
#define EO_UNKNOWN_NUMBER(name, key) EO_UNKNOWN_##name,
enum eo_unknown { EO_UNKNOWN_INPUTS(EO_UNKNOWN_NUMBER) EO_UNKNOWNS };

struct eo_update_range {
  enum eo_unknown unknown;
  double low, high; /* SI */
};

struct eo_updated {
  enum eo_unknown unknown;
  double before, value, low, high; /* SI */
  double confidence[2];            /* 95 %, from the lowest to the highest value of all minima within reach */
  bool at_bound;
  bool undetermined;  /* that covers more than half the range: the data do not tell */
  int twin;           /* index of the unknown it cannot be told apart from (correlation above 0.95); -1: none */
  double correlation; /* with it */
};

enum { EO_UPDATE_MINIMA = 16 };

/* Values that fit the measurements about as well as the best ones. */
struct eo_update_minimum {
  double value[EO_UNKNOWNS];         /* [unknowns] SI */
  double confidence[EO_UNKNOWNS][2]; /* 95 %, of this minimum alone; without meaning where it is out of reach */
  double misfit;                     /* as `after` */
  bool within;                       /* the measurements do not rule it out at 95 % */
};

struct eo_update_settings {
  int unknowns;
  struct eo_update_range range[EO_UNKNOWNS];
  double model_error; /* of an order's acceleration, in parts of the measured RMS; 0: as the misfit says */
  int starts;         /* points that the search looks at first; 0: 96 for one unknown, 384 for two, 768 for more */
  uint64_t seed;
};

struct eo_update {
  int unknowns;
  struct eo_updated unknown[EO_UNKNOWNS];
  double correlation[EO_UNKNOWNS][EO_UNKNOWNS];
  double condition; /* of the scaled normal equations; beyond 1e6 the data do not tell all unknowns */
  int residuals,
      used; /* orders compared; measurements used: refused ones and outliers of the caller are not handed in */
  double before, after; /* root mean square of (measured - predicted acceleration) / its standard deviation */
  double model_error;   /* in parts of the measured RMS: as stated, or as what the fit leaves says */
  bool poor;            /* the best fit leaves more than a good model would */
  int minima, within;   /* found, and of them those that the measurements do not rule out; the best first */
  struct eo_update_minimum minimum[EO_UPDATE_MINIMA];
  int evaluations; /* of all measurements */
  bool converged;
};

/* The key of the list above. */
const char *eo_unknown_name(enum eo_unknown unknown);
extern const char *const eo_unknown_names[]; /* by number; ends with NULL */
double eo_unknown_get(const struct eo_design *design, enum eo_unknown unknown);
void eo_unknown_set(struct eo_design *design, enum eo_unknown unknown, double value);

/* Fits; *updated (may be NULL) is the design with the values found. The pair is the design's. Bearing and axial
   stiffnesses, damping and patch are searched on a logarithmic scale. Progress and cancellation reach every evaluation.
   The same result on each run. Errors:
   EO_ERROR_INPUT (no unknowns, the same one twice, ranges, no measurements, fewer orders than unknowns), of the
   evaluation, memory, cancelled. */
enum eo_code eo_update_run(struct eo_update *update, const struct eo_pair *pair, const struct eo_design *design,
                           int count, const struct eo_measured *measured, const struct eo_update_settings *settings,
                           struct eo_design *updated, const struct eo_progress *progress, struct eo_error *error);

#endif
