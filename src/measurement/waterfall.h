/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order tracks: the mesh orders of successive stretches of a recording, with the speed of each, from the residual of
   the fit over all of it. */
#ifndef EASEOFF_MEASUREMENT_WATERFALL_H
#define EASEOFF_MEASUREMENT_WATERFALL_H

#include "measurement/orders.h"

struct eo_waterfall; /* opaque */

/* result: harmonics and turns are known. from: of the axis, rad. NULL in *waterfall, and no error: too few turns for
   two stretches. Errors: memory. */
enum eo_code eo_waterfall_new(struct eo_waterfall **waterfall, const struct eo_transmission *result, const int teeth[2],
                              double from, struct eo_error *error);
void eo_waterfall_free(struct eo_waterfall *waterfall);

/* One row: time in s after the start, angle of the axis, what the fit leaves, m. */
void eo_waterfall_add(struct eo_waterfall *waterfall, double time, double theta, double residual);

/* Fills result->track; its mesh orders are known. Errors: memory. */
enum eo_code eo_waterfall_finish(struct eo_waterfall *waterfall, struct eo_transmission *result,
                                 struct eo_error *error);

#endif
