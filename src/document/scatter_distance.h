/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The centre distance among what scatters: it is drawn in steps, so that few distances are prepared, and within what
   the pair can be assembled at. */
#ifndef EASEOFF_DOCUMENT_SCATTER_DISTANCE_H
#define EASEOFF_DOCUMENT_SCATTER_DISTANCE_H

#include "design/design.h"
#include "tolerance/scatter.h"

/* Its place in struct eo_design. */
#define EO_SCATTER_DISTANCE offsetof(struct eo_design, alignment.centre_distance_deviation)

/* Steps from end to end of what is drawn: theory (A15). */
enum { EO_SCATTER_DISTANCE_STEPS = 16 };

/* Within the allowance of the design (js7 unless stated): normal, which is 2 sigma (ground: 3), cut there. */
struct eo_scatter_row eo_scatter_distance_row(const struct eo_design *design);

/* Sets the step of an input with its distribution. pointer: of the row. Errors: EO_ERROR_INPUT (a distance at which the
   teeth jam or do not reach each other, a fixed sum). */
enum eo_code eo_scatter_settle_distance(struct eo_scatter_input *input, const struct eo_design *design,
                                        const struct eo_scatter_row *row, const char *pointer, struct eo_error *error);

/* The step of a run whose centre distance scatters, in the unit of its key; 0: it does not, or has few values. */
double eo_scatter_distance_step(const struct eo_scatter *scatter);

/* What their contact grids take in memory, bytes, on the side of much; 0 where no distance scatters. */
double eo_scatter_distance_memory(const struct eo_scatter *scatter, const struct eo_design *design);

#endif
