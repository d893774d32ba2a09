/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a design's single ranges cannot say: keys that must agree with each other and with the geometry. */
#ifndef EASEOFF_DESIGN_CHECK_H
#define EASEOFF_DESIGN_CHECK_H

#include "base/error.h"
#include "design/design.h"
#include "gear/geometry.h"

/* design: resolved; geometry: of its gear pair. EO_ERROR_INPUT with the key: bore or groove that leaves no body, relief
   that starts outside the active flank, end reliefs that overlap, bounds outside the active flank, thresholds, weights
   and harmonics that contradict each other, bearings in the wrong order and, with elastic bodies, inside the toothed
   body; a shaft thinner than its bore. */
enum eo_code eo_design_check(const struct eo_design *design, const struct eo_geometry *geometry,
                             struct eo_error *error);

/* The part of it that concerns the flanks: reliefs that start outside the active flank, end reliefs that overlap or
   have no length. */
enum eo_code eo_modification_check(const struct eo_design *design, const struct eo_geometry *geometry,
                                   struct eo_error *error);

#endif
