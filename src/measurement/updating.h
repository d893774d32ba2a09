/* Inputs of a design that nobody knows, from measurements: least squares on the accelerations of the mesh orders within
   given ranges, with confidence intervals, and a warning where the data cannot tell. */
#ifndef EASEOFF_MEASUREMENT_UPDATING_H
#define EASEOFF_MEASUREMENT_UPDATING_H

#include "measurement/comparison.h"

enum eo_unknown {
  EO_UNKNOWN_PINION_BEARING, /* supports.bearing_stiffness[EO_PINION], N/m */
  EO_UNKNOWN_GEAR_BEARING,
  EO_UNKNOWN_MESH_DAMPING, /* supports.mesh_damping_ratio */
  EO_UNKNOWN_GEAR_AXIAL,   /* both ends' supports.gear_axial_stiffness, N/m */
  EO_UNKNOWN_PINION_AXIAL, /* alignment.pinion_axial_stiffness, N/m; holds the pinion by a spring */
  EO_UNKNOWN_IN_PLANE,     /* alignment.shaft_angle_in_plane, rad */
  EO_UNKNOWN_OUT_OF_PLANE,
  EO_UNKNOWN_IMPACT_PATCH, /* resolution.impact_patch, m; acts only where impacts act in the dynamics */
  EO_UNKNOWNS
};

struct eo_update_range {
  enum eo_unknown unknown;
  double low, high; /* SI */
};

struct eo_updated {
  enum eo_unknown unknown;
  double before, value, low, high; /* SI */
  double confidence[2];            /* 95 %, cut to the range */
  bool at_bound;
  bool undetermined;  /* the interval covers more than half the range: the data do not tell */
  int twin;           /* index of the unknown it cannot be told apart from (correlation above 0.95); -1: none */
  double correlation; /* with it */
};

struct eo_update_settings {
  int unknowns;
  struct eo_update_range range[EO_UNKNOWNS];
  double model_error; /* of an order's acceleration, in parts of the measured RMS; 0: 0.05 */
  int starts;         /* points that the search looks at first; 0: 8 per unknown */
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
  int evaluations;      /* of all measurements */
  bool converged;
};

/* "pinion_bearing_stiffness", ... : keys for people and documents. */
const char *eo_unknown_name(enum eo_unknown unknown);
extern const char *const eo_unknown_names[]; /* by number; ends with NULL */
double eo_unknown_get(const struct eo_design *design, enum eo_unknown unknown);
void eo_unknown_set(struct eo_design *design, enum eo_unknown unknown, double value);

/* Fits; *updated (may be NULL) is the design with the values found. The pair is the design's. Bearing and axial
   stiffnesses, damping and patch are searched on a logarithmic scale. The same result on each run. Errors:
   EO_ERROR_INPUT (no unknowns, the same one twice, ranges, no measurements, fewer orders than unknowns), of the
   evaluation, memory, cancelled. */
enum eo_code eo_update_run(struct eo_update *update, const struct eo_pair *pair, const struct eo_design *design,
                           int count, const struct eo_measured *measured, const struct eo_update_settings *settings,
                           struct eo_design *updated, const struct eo_progress *progress, struct eo_error *error);

#endif
