/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contact over the hunting period from few solutions (doc/theory/single-teeth.md): what happens at a position of
   the mesh cycle depends on nothing but how far the pairs of teeth in mesh stand from each other, which is one number
   where two of them carry. Each pair is moved away from the one that carries most, and what comes between the solutions
   is interpolated. */
#ifndef EASEOFF_CONTACT_TOOTH_COURSES_H
#define EASEOFF_CONTACT_TOOTH_COURSES_H

#include "contact/hunting.h"

/* The same as eo_hunting_run() on one thread, for pinions that float (input->hold is not looked at), without root
   stress, and without what stands in the result of every pair and every tooth: load, approach, tangent, most_load,
   most_pressure, failures. within: how far the approach half way between two solutions may be off the cubic through
   them, m, before more are made; INFINITY: no more than three of each pair, each within 0.1 nm, from
   input->alike and from the places before. Teeth with slopes and crownings of their
   own are taken at the mean by load of what these add to the gap, to first order. stretch: the first so many cycles at
   all positions of the grid. Errors: as there. eo_hunting_done() of both also after an error. */
enum eo_code eo_hunting_follow(struct eo_hunting *period, struct eo_hunting *stretch, int stretch_cycles, double within,
                               const struct eo_hunting_input *input, struct eo_error *error);

#endif
