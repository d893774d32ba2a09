/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A few pairs as made, drawn once for a robust search: the same deviations for every design that it tries, so that two
   designs differ by what they are and not by how they were drawn. A part of struct eo_design, derived from its block
   `tolerance` and not in the document. */
#ifndef EASEOFF_DESIGN_DRAWN_PAIRS_H
#define EASEOFF_DESIGN_DRAWN_PAIRS_H

#include <stddef.h>

enum { EO_MAX_DRAWN_PAIRS = 64, EO_MAX_DRAWN_INPUTS = 48 };

struct eo_drawn_pairs {
  int pairs, inputs; /* 0 pairs: none are drawn */
  int first;         /* of them that are looked at; 0: all */
  struct eo_drawn_input {
    int target;       /* enum eo_scatter_target of tolerance/scatter.h */
    size_t offset;    /* in struct eo_design */
    double low, high; /* SI: what the number may be */
  } input[EO_MAX_DRAWN_INPUTS];
  double deviation[EO_MAX_DRAWN_PAIRS][EO_MAX_DRAWN_INPUTS]; /* SI */
};

struct eo_design;
struct eo_scenario;

/* *made: the design as the pair comes out, and its scenario. An amount that stands at its lower bound 0 is not made and
   does not scatter. */
void eo_drawn_pair_apply(const struct eo_design *design, int pair, struct eo_design *made,
                         struct eo_scenario *scenario);

enum { EO_MAX_PAIR_STATES = EO_MAX_DRAWN_PAIRS + 1 };

/* How many states of the pair a robust objective is made of: drawn ones, or listed scenarios; 1: it is not robust. */
int eo_design_states(const struct eo_design *design);
/* How many are evaluated: one more where a front sets the nominal pair against them. */
int eo_design_scenarios(const struct eo_design *design);

#endif
