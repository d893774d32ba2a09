/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Charts of a flank as an inspector reads them: nominal profile and helix with the band of the total tolerance of ISO
   1328-1 (the edition of the rating) and the evaluation range, over roll length, roll angle, diameter, or the face. As
   numbers, CSV and SVG. */
#ifndef EASEOFF_DOCUMENT_FLANK_CHART_H
#define EASEOFF_DOCUMENT_FLANK_CHART_H

#include "design/design.h"
#include "format/text.h"
#include "gear/geometry.h"
#include "rating/flank_tolerance.h"

enum { EO_FLANK_CHART_POINTS = 121 };

/* SI. y: metal beyond the unmodified flank, normal to it; what a modification takes off is below 0. A measured trace
   may be moved along y: only its shape counts against the band, F_alpha or F_beta wide about the nominal curve. */
struct eo_flank_chart {
  enum eo_flank_side side;
  int member, end;
  bool helix;                      /* else the profile */
  double x[EO_FLANK_CHART_POINTS]; /* roll length from the base circle, or place over the face from its middle, + on
                                      the side that meets first on the drive flank, m */
  double roll_angle[EO_FLANK_CHART_POINTS], diameter[EO_FLANK_CHART_POINTS]; /* profile: rad, m */
  double nominal[EO_FLANK_CHART_POINTS];
  double band[EO_FLANK_CHART_POINTS][2]; /* upper, lower; NaN outside the evaluation range, or without a tolerance */
  double range[2];                       /* evaluation range along x */
  double active[2];                      /* profile: roll lengths at d_Nf and at the tip; helix: face ends */
  double form, relief[2];                /* profile: roll length at d_Ff, where root and tip relief begin (NaN: none) */
  struct eo_flank_tolerance tolerance;   /* of the member; NaN: none, see note */
  char note[sizeof((struct eo_error *)0)->text]; /* why there is no tolerance; "" */
};

/* The tolerances of a member by the edition and grade of the rating; NaN where there is none, note ("" else) says why.
 */
void eo_flank_tolerance_of(const struct eo_design *design, const struct eo_geometry *geometry, int member,
                           struct eo_flank_tolerance *tolerance, char *note, size_t size);

/* At mid face (profile), at the pitch point (helix). */
void eo_flank_chart_find(struct eo_flank_chart *chart, const struct eo_design *design,
                         const struct eo_geometry *geometry, enum eo_flank_side side, int member, int end, bool helix);

/* One <svg>; lengths in mm and um, or in inches and thousandths of an inch. */
void eo_flank_chart_svg(const struct eo_flank_chart *chart, const struct eo_design *design, bool inches,
                        struct eo_text *text);

/* Every chart of a design, of coast flanks where they are shown (flank_grid_document.h): rows of numbers; the drawings
   below each other in one SVG. */
void eo_flank_charts_csv(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text);
void eo_flank_charts_svg(const struct eo_design *design, const struct eo_geometry *geometry, struct eo_text *text);

#endif
