/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The three objectives, the constraints and the fitness: theory (O1) (O2) (O3). */
#ifndef EASEOFF_EVALUATION_OBJECTIVE_H
#define EASEOFF_EVALUATION_OBJECTIVE_H

#include "design/design.h"

enum { EO_SCALARS = 19 }; /* numbers of evaluation/scalar.h */

enum { EO_OBJECTIVE_SAMPLES = 32 }; /* of the transmission error: its mesh harmonics beyond 12 are small */

/* What the objectives need of one load case: raw, before weights, so that a history can serve any later weighting. */
struct eo_objective_case {
  double peak_to_peak;     /* PPLTE of the pair, m */
  double impact;           /* general entering impact, worse end, N */
  double rms;              /* normal acceleration, mean of the ends' RMS, m/s2 */
  double contact_pressure; /* largest, Pa */
  double root_stress;      /* largest, Pa; NaN when it was not computed */
  double edge_load_share;  /* largest share of P on tip-edge points */
  double contact_loss;     /* largest fraction of the cycle out of contact */
  /* Of the duty cycle as a whole, at its first load case; NaN at the others, and where no limit asks for the rating. */
  double flank_safety, root_safety; /* least S_H and S_F over members and ends, Miner and static; 0: not rated */
  double film_ratio;                /* least specific film thickness */
  double contact_temperature;       /* largest, degrees Celsius */
  bool failed;                      /* contact or vibration did not converge: the numbers above mean nothing */
  /* What peak_to_peak is the range of, but for what lies between the samples, and impact the largest: LTE of the pair
     less its mean, m, at phases i / samples; N, of each end (equal where there is one). NaN: not kept. */
  double transmission[EO_OBJECTIVE_SAMPLES], end_impact[2];
  double scalar[EO_SCALARS]; /* in the units of their keys; NaN unless a term or a limit of the objective asks */
};

/* f_i = sum_k share_k value_ik / n of n cases, theory (O1). */
struct eo_objective_sums {
  double f[3]; /* f1 PPLTE (m), f2 impact (N), f3 RMS (m/s2) */
  bool failed;
};

struct eo_objective_value {
  struct eo_objective_sums sums;
  double objective; /* J, dimensionless when normalised; NaN when failed */
  double violation; /* sum of relative excesses over the constraints */
  double fitness;   /* 1/J - penalty * violation; EO_FITNESS_WORST when failed (the paper prints the penalty with +) */
  int terms;
  double term[EO_MAX_OBJECTIVE_TERMS]; /* each term of the objective in the unit of its key, over the states as f is */
  double nominal; /* J of the nominal pair alone, beside the pairs as made; NaN: it was not asked for */
};

static const double EO_FITNESS_WORST = -1e9;

/* No number at all, failed. */
struct eo_objective_case eo_objective_nothing(void);

/* f1, f2, f3 as means over load_case[cases] with their shares, SI (theory (O1)); value[cases]. failed: one of the cases
   failed or a sum is no number. */
void eo_objective_sum(int cases, const struct eo_load_case *load_case, const struct eo_objective_case *value,
                      struct eo_objective_sums *sums);

/* J = sum w_i f_i / f_i(unmodified) (normalise: unmodified) or sum w_i f_i in SI units (none), and the terms that are
   no percentiles. unmodified: [cases], the same design without modification; needed to normalise and for
   no_worse_than_unmodified. relief_outside: 1 when a relief starts outside the active flank. */
void eo_objective_value(const struct eo_objective *objective, int cases, const struct eo_load_case *load_case,
                        const struct eo_objective_case *value, const struct eo_objective_case *unmodified,
                        bool relief_outside, struct eo_objective_value *result);

/* The same without the judgement that follows: J may be 0 where all of it is percentiles. */
void eo_objective_weigh(const struct eo_objective *objective, int cases, const struct eo_load_case *load_case,
                        const struct eo_objective_case *value, const struct eo_objective_case *unmodified,
                        bool relief_outside, struct eo_objective_value *result);
/* The fitness of J and the violation as they stand; without a J above 0 there is none. */
void eo_objective_judge(const struct eo_objective *objective, struct eo_objective_value *value);

/* Whether a limit asks for what only the rating gives. */
bool eo_objective_wants_rating(const struct eo_objective *objective);

/* True when a relief of the modification starts at or beyond the end of the active profile; bottom, top: u_A < 0 < u_E
   of the pinion, m. */
bool eo_objective_relief_outside(const struct eo_modification *modification, double bottom, double top);

#endif
