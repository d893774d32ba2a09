/* The smooth part of an angle over time: a least squares cubic spline with knots so far apart that no shaft order bends
   it. It is the order axis: eccentric encoders, noise and the vibration itself do not shift the phase of the mesh,
   changes of speed do. */
#ifndef EASEOFF_MEASUREMENT_TREND_H
#define EASEOFF_MEASUREMENT_TREND_H

#include "base/error.h"

struct eo_trend {
  int intervals;       /* of equal length over the time of the recording */
  double start, step;  /* s */
  double origin, rate; /* rad, rad/s: the straight line that the spline is added to */
  double *coefficient; /* owned, [intervals + 3], rad */
  double *band;        /* owned while fitting: [intervals + 3][4] normal equations, upper band */
};

/* Room for `intervals` pieces between two times; line: angle at the start and its mean rate. Errors: memory. */
enum eo_code eo_trend_start(struct eo_trend *trend, double from, double to, int intervals, double origin, double rate,
                            struct eo_error *error);
void eo_trend_add(struct eo_trend *trend, double time, double angle);

/* Solves; a faint penalty on the third difference carries the spline over gaps. EO_ERROR_NUMERIC when that fails. */
enum eo_code eo_trend_finish(struct eo_trend *trend, struct eo_error *error);
void eo_trend_done(struct eo_trend *trend);

/* Angle at a time; *speed (may be NULL) in rad/s. */
double eo_trend_at(const struct eo_trend *trend, double time, double *speed);

#endif
