/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of a measurement document: which rows were measured, the order axis, order tracks, torque and speed columns.
   Internal to the document. */
#ifndef EASEOFF_DOCUMENT_MEASUREMENT_PARTS_H
#define EASEOFF_DOCUMENT_MEASUREMENT_PARTS_H

#include <jansson.h>

#include "format/outline.h"
#include "measurement/measurement.h"

extern const struct eo_outline eo_measured_head;           /* what the whole result and the brief one begin with */
extern const struct eo_outline eo_measured_result_outline; /* of a struct eo_transmission */
extern const struct eo_outline eo_part_outline, eo_axis_outline, eo_order_tracks_outline, eo_load_outline;

/* New; NULL without memory. */
json_t *eo_parts_encode(const struct eo_parts *parts);

#endif
