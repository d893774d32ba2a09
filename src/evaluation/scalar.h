/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Single numbers of a load case, by name: what a tolerance analysis counts and what an objective may be. */
#ifndef EASEOFF_EVALUATION_SCALAR_H
#define EASEOFF_EVALUATION_SCALAR_H

#include "evaluation/evaluator.h"

/* What it takes beyond the static half of an evaluation; TEETH: whole revolutions (pitch_analysis.h). */
enum { EO_SCALAR_VIBRATION = 1, EO_SCALAR_ROOT = 2, EO_SCALAR_TEETH = 4 };

/* Those of an evaluation, EO_SCALARS, and behind them those of the hunting period. */
enum { EO_ALL_SCALARS = EO_SCALARS + 8 };

struct eo_scalar {
  const char *key;  /* with the unit of the document */
  const char *help; /* one line for people */
  double unit;      /* SI value = value times unit */
  int needs;        /* EO_SCALAR_... */
  int order;        /* of the transmission error; 0: none */
  int end;          /* EO_LEFT, EO_RIGHT; -1: the pair, or the worse end */
  int what;         /* of scalar.c */
};

/* Keys of an evaluation's by index, NULL at the end: the words of a choice. */
extern const char *const eo_scalar_keys[];

/* NULL after the last; the index of a key, -1: none. */
const struct eo_scalar *eo_scalar_at(int index);
int eo_scalar_find(const char *key);

/* Of a load case, in the unit of the key; NaN where there is none (no such end, contact or vibration did not converge,
   not asked for, of the hunting period). */
double eo_scalar_value(const struct eo_scalar *scalar, const struct eo_evaluation *evaluation, int load_case);

/* Of its hunting period, likewise: of scalars with EO_SCALAR_TEETH. */
struct eo_pitch_case;
double eo_scalar_of_period(const struct eo_scalar *scalar, const struct eo_pitch_case *period);

#endif
