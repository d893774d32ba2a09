/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures of a report from a result document: curves over the mesh cycle and the face, maps over the flank. */
#ifndef EASEOFF_REPORT_FIGURES_H
#define EASEOFF_REPORT_FIGURES_H

#include <jansson.h>

#include "report/page.h"

/* Up to six load cases: the heaviest shares, in the order of the design. */
void eo_figure_transmission(const json_t *result, const struct eo_page *page);
void eo_figure_stiffness(const json_t *result, const struct eo_page *page);
void eo_figure_face_load(const json_t *result, const struct eo_page *page);

/* Pressure, flash temperature and film thickness over the flanks of both ends, at the load case with the largest
   torque. */
void eo_figure_maps(const json_t *result, const struct eo_page *page);

#endif
