/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is read from the samples beside the fit: averages over mesh cycle and turns, the spectrum over whole turns by
   interpolation and FFT, changes of level. Fed row by row. */
#ifndef EASEOFF_MEASUREMENT_SYNCHRONOUS_H
#define EASEOFF_MEASUREMENT_SYNCHRONOUS_H

#include "measurement/orders.h"

struct eo_synchronous; /* opaque */

/* result: harmonics, hunting and rows are known. from, turns: of the smooth pinion angle, rad. Errors: memory. */
enum eo_code eo_synchronous_new(struct eo_synchronous **synchronous, const struct eo_transmission *result,
                                const int teeth[2], double from, double turns, struct eo_error *error);
void eo_synchronous_free(struct eo_synchronous *synchronous);

/* The parts of the TE of one row, m. */
void eo_synchronous_add(struct eo_synchronous *synchronous, int64_t row, double theta, double mesh, double shaft,
                        double residual);

/* Fills the secondary members of the result; its mesh orders are known. Errors: memory. */
enum eo_code eo_synchronous_finish(struct eo_synchronous *synchronous, struct eo_transmission *result,
                                   struct eo_error *error);

#endif
