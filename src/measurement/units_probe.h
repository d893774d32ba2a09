/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The unit of the angles, when neither turns nor a stated speed tell: in the right one the transmission error has lines
   at the shaft and mesh orders, in a wrong one it has none there. */
#ifndef EASEOFF_MEASUREMENT_UNITS_PROBE_H
#define EASEOFF_MEASUREMENT_UNITS_PROBE_H

#include "measurement/transmission.h"
#include "recording/tracks.h"

/* What is open, and the unit in which the angles have been read, rad. */
struct eo_unit_doubt {
  enum eo_track_doubt kind;
  double scale;
};

/* *factor: by which both angles have to be multiplied, of those that the doubt leaves open (180/pi and pi/180 always),
   NaN when none shows lines, or when the recording is too short to show them as it is read. Looks at no more than the
   first quarter of a million rows. Errors: memory, files. */
enum eo_code eo_units_probe(const struct eo_angles *angles, const struct eo_transmission_settings *settings,
                            const struct eo_unit_doubt *doubt, double *factor, struct eo_error *error);

/* The same, with its finding. */
enum eo_code eo_units_judge(struct eo_angles *angles, const struct eo_transmission_settings *settings,
                            const struct eo_unit_doubt *doubt, struct eo_findings *findings, struct eo_error *error);

#endif
