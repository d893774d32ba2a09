/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A curve with its tolerance band along a line that is measured, as SVG (1.1): material to one side, the line linear,
   further scales below it, the evaluation range marked. It knows no gear. */
#ifndef EASEOFF_FORMAT_BAND_CHART_H
#define EASEOFF_FORMAT_BAND_CHART_H

#include "format/text.h"

enum { EO_BAND_MARKS = 8, EO_BAND_SCALES = 2 };

struct eo_band_chart {
  const char *title, *x_label, *y_label; /* borrowed, as all here */
  const char *below, *above;             /* what lies on either side of the curve; NULL: not said */
  int count;
  const double *x, *nominal, *upper, *lower; /* [count], x increasing; NaN in upper or lower: no band there */
  double range[2];                           /* evaluation range along x; NaN: none */
  const char *range_label;
  int scales;
  struct {
    const char *label;
    const double *value; /* [count]: what else the places of x are */
    int decimals;
  } scale[EO_BAND_SCALES];
  int marks;
  struct {
    double x;
    const char *label;
  } mark[EO_BAND_MARKS];
};

/* Appends one <svg> element. */
void eo_band_chart_svg(const struct eo_band_chart *chart, struct eo_text *text);

#endif
