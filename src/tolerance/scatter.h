/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inputs that scatter, each a number somewhere in a struct: how a drawn pair comes about. */
#ifndef EASEOFF_TOLERANCE_SCATTER_H
#define EASEOFF_TOLERANCE_SCATTER_H

#include <stdbool.h>
#include <stddef.h>

#include "tolerance/distribution.h"
#include "tolerance/pair_sampler.h"

enum { EO_MAX_SCATTER_INPUTS = 128, EO_SCATTER_NAME = 96, EO_SCATTER_LIST = 200 };

/* What an input is. */
enum eo_scatter_target { EO_TARGET_MEMBER, EO_TARGET_COMPLIANCE, EO_TARGET_SPEED, EO_TARGET_SEED };

struct eo_scatter_input {
  char key[EO_SCATTER_NAME];
  int target;                       /* enum eo_scatter_target */
  size_t offset;                    /* MEMBER: of a double in the struct that is drawn; SEED: of an uint64_t */
  double unit;                      /* SI value = value times unit */
  double nominal, least, most;      /* in the unit of the key; a drawn value beyond a bound is the bound */
  double step;                      /* drawn values stand whole steps from nominal; 0: anywhere */
  bool cyclic;                      /* a phase: what is drawn has no bound, the struct gets its part of a turn, 0..1 */
  struct eo_distribution deviation; /* from nominal */
  int values;
  double value[EO_SCATTER_LIST]; /* of a list; deviation.value points here after eo_scatter_settle() */
  int together;                  /* list: inputs with the same number > 0 take values of one row */
  int fixed_sum;                 /* inputs with the same number > 0 keep the sum of their means */
};

struct eo_scatter {
  int inputs, dimensions; /* dimensions: numbers that a pair takes */
  struct eo_scatter_input input[EO_MAX_SCATTER_INPUTS];
  int dimension[EO_MAX_SCATTER_INPUTS]; /* of each input */
};

/* Counts dimensions and points lists at their values: after every copy, too. Errors: EO_ERROR_INPUT (no input, lists
   that are drawn together and differ in length, a fixed sum of one). */
enum eo_code eo_scatter_settle(struct eo_scatter *scatter, struct eo_error *error);

/* value[inputs] of a point of the sampler, in the units of the keys; returns how many met a bound. */
int eo_scatter_draw(const struct eo_scatter *scatter, const struct eo_sampler *sampler, int point, double *value);

/* Puts them into a struct that holds the nominal values, and the factors (1 where nothing says otherwise). */
void eo_scatter_apply(const struct eo_scatter *scatter, const double *value, void *target, double *compliance,
                      double *speed);

/* Moments of the drawn value of an input, in the unit of its key; with a fixed sum those that are left. */
struct eo_moments eo_scatter_moments(const struct eo_scatter *scatter, int input);

/* Inputs that are quantities: seeds, which stand behind them, are names of what was drawn, and nothing grows with them.
 */
int eo_scatter_quantities(const struct eo_scatter *scatter);

/* Inputs that are independent of each other: without fixed sums and lists drawn together. */
bool eo_scatter_is_independent(const struct eo_scatter *scatter);

#endif
