/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Degrees or radians, when neither turns nor a stated speed tell: in the right unit the transmission error has lines at
   the shaft and mesh orders, in the wrong one it has none there. */
#ifndef EASEOFF_MEASUREMENT_UNITS_PROBE_H
#define EASEOFF_MEASUREMENT_UNITS_PROBE_H

#include "measurement/transmission.h"

/* *factor: 1, 180/pi or pi/180 by which both angles have to be multiplied, NaN when no unit shows lines. Looks at no
   more than the first quarter of a million rows. Errors: memory, files. */
enum eo_code eo_units_probe(const struct eo_angles *angles, const struct eo_transmission_settings *settings,
                            double *factor, struct eo_error *error);

/* The same, with its finding. */
enum eo_code eo_units_judge(struct eo_angles *angles, const struct eo_transmission_settings *settings,
                            struct eo_findings *findings, struct eo_error *error);

#endif
