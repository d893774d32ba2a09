/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a design's single ranges cannot say: keys that must agree with each other and with the geometry. */
#ifndef EASEOFF_DESIGN_CHECK_H
#define EASEOFF_DESIGN_CHECK_H

#include "base/error.h"
#include "design/design.h"
#include "gear/geometry.h"

/* What an analysis uses. design: resolved; geometry: of its gear pair. EO_ERROR_INPUT with the key: bore or groove that
   leaves no body, relief that starts outside the active flank, end reliefs that overlap, weights and harmonics that
   contradict each other and, with elastic bodies, bearings in the wrong order or inside the toothed body, a shaft
   thinner than its bore. Settings of the search are not looked at. */
enum eo_code eo_design_check(const struct eo_design *design, const struct eo_geometry *geometry,
                             struct eo_error *error);

/* Cells of a contact line where nobody states them: 30, fewer where they would be more than can be computed with. */
int eo_resolution_usual_cells(const struct eo_resolution *resolution, const struct eo_geometry *geometry);

/* What only a search uses: its settings, thresholds and variables, bounds outside the active flank. */
enum eo_code eo_design_check_search(const struct eo_design *design, const struct eo_geometry *geometry,
                                    struct eo_error *error);

/* The part of it that concerns the flanks: reliefs that start outside the active flank, end reliefs that overlap or
   have no length. */
enum eo_code eo_modification_check(const struct eo_design *design, const struct eo_geometry *geometry,
                                   struct eo_error *error);

#endif
