/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contact over the hunting period with every pair of teeth in mesh as one spring (doc/theory/single-teeth.md):
   quick and coarse, for pairs as made by the hundred. At each position of the mesh cycle a pair of teeth carries what
   it does at its own approach when all pairs approach alike, which a few loads of the full contact tell; pairs bend
   each other as their loads lie. From cycle to cycle only what their teeth are off differs. */
#ifndef EASEOFF_CONTACT_TOOTH_SPRINGS_H
#define EASEOFF_CONTACT_TOOTH_SPRINGS_H

#include "contact/hunting.h"

/* The same as eo_hunting_run() on one thread, for pinions that float (input->hold is not looked at), without root
   stress, and without what stands in the result of every pair and every tooth: load, approach, tangent, most_load,
   most_pressure, failures. stretch: the first so many cycles at all positions of the grid, from the same springs.
   Errors: as there. eo_hunting_done() of both also after an error. */
enum eo_code eo_hunting_sketch(struct eo_hunting *period, struct eo_hunting *stretch, int stretch_cycles,
                               const struct eo_hunting_input *input, struct eo_error *error);

#endif
