/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The vibration with teeth of their own, roughly: for pairs as made by the hundred, where all steps through the hunting
   period (long_response.h) take too long. */
#ifndef EASEOFF_DYNAMICS_LONG_SKETCH_H
#define EASEOFF_DYNAMICS_LONG_SKETCH_H

#include "dynamics/long_response.h"

enum { EO_LONG_SKETCH_LEAD = 16 }; /* cycles before those that are looked at */

/* RMS of the acceleration normal to the teeth, mean of the ends, m/s2, over the cycles behind the lead: steps of
   half a position, teeth that part without a force, but damped as before. Of the load, harmonics and back
   are not looked at; its cycles need not be a period, but be more than the lead. Errors: EO_ERROR_NUMERIC: there
   are no modes; EO_ERROR_INPUT of the parameters. */
enum eo_code eo_long_sketch_rms(const struct eo_long_case *load, double *rms, struct eo_error *error);

#endif
