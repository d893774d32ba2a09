/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Line plots as SVG (1.1) that stands alone or inside an HTML page: axes with round numbers, grid, legend; colours by
   CSS classes with attributes as a fallback, so that a page may restyle them. */
#ifndef EASEOFF_FORMAT_PLOT_H
#define EASEOFF_FORMAT_PLOT_H

#include <stdbool.h>

#include "format/text.h"

enum { EO_PLOT_SERIES = 8 };

struct eo_plot {
  const char *title, *x_label, *y_label; /* borrowed, as all here */
  int series;
  struct eo_plot_series {
    const char *name;
    int count;
    const double *x, *y; /* [count]; points that are not finite interrupt the line */
    bool dots;           /* points instead of a line */
  } line[EO_PLOT_SERIES];
  bool from_zero; /* the y axis begins at 0 */
};

/* Appends one <svg> element. */
void eo_plot_svg(const struct eo_plot *plot, struct eo_text *text);

#endif
