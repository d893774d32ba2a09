/* What an optimizer can be told, in one table: key, range, default, help. A reader of documents needs nothing else.
   Paper: section 4 and Table 2; the paper's values are the defaults. */
#ifndef EASEOFF_OPTIMIZER_SETTINGS_H
#define EASEOFF_OPTIMIZER_SETTINGS_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

enum eo_algorithm { EO_GA, EO_FPGA, EO_CREDIBILITY_GA, EO_NSGA2, EO_ALGORITHMS };
enum eo_mutation_mode { EO_MUTATE_GENE, EO_MUTATE_INDIVIDUAL };
enum eo_distance_norm { EO_NORM_RANGE, EO_NORM_RMS };
enum eo_weight_sum { EO_WEIGHTS_REGION, EO_WEIGHTS_ALL };
enum eo_decision_order { EO_ORDER_BATCH, EO_ORDER_SEQUENTIAL };
enum eo_fitness_form { EO_FITNESS_RECIPROCAL, EO_FITNESS_NEGATIVE };

enum { EO_MAX_VARIABLES = 64, EO_MAX_OBJECTIVES = 8 };

/* Fill with eo_optimizer_defaults(), change what differs; eo_optimizer_new() checks. */
struct eo_optimizer_settings {
  int algorithm;  /* enum eo_algorithm */
  int variables;  /* n, 1 .. EO_MAX_VARIABLES */
  int objectives; /* of nsga2, 1 .. EO_MAX_OBJECTIVES; the others minimise one value */
  uint64_t seed;
  int true_evaluations; /* budget; 0: none for ga and fpga, 500 + 100 n for the others */

  /* operators, for all algorithms */
  double crossover;       /* p_c, of a pair; each gene then with 0.5 */
  double crossover_index; /* eta of simulated binary crossover */
  double mutation;        /* p_m, per gene or per individual */
  double mutation_index;  /* eta of polynomial mutation */
  int mutation_mode;

  /* ga, fpga; population also credibility-ga */
  int population, generations, elite;
  int fitness_form; /* fitness to maximise from the value to minimise */

  /* fpga */
  double trust_threshold;      /* R* */
  double redundancy_threshold; /* I_r* */
  double share_radius;         /* r_share; 0: 0.03 (n/5)^1.9 */
  double weight_decay;         /* alpha of (15) */
  double credibility_loss;     /* beta of (18) */
  double removal_threshold;    /* R_0 */
  int verify;                  /* evaluate each generation's best predicted individual */
  int distance_norm, weight_sum, decision_order;
  int store_predicted;    /* predicted individuals enter the history (S4) */
  int literal_redundancy; /* (17) as printed, which deletes unique rows too */
  int reuse;              /* an individual bit-equal to a true row takes its value */

  /* credibility-ga */
  int batch;                 /* true evaluations at a time */
  int initial_factor;        /* latin hypercube of this times n points per epoch */
  int model_rows;            /* at most this many rows in the surrogate */
  int children;              /* bred from the population for each batch */
  double exploration;        /* kappa */
  double credibility_length; /* l / sqrt n */
  double taboo_radius;       /* / sqrt n */
  int stall_batches;         /* without stall_gain before a new epoch */
  double stall_gain;         /* relative to the spread of the values */
  double polish_share;       /* of the budget, at the end */
  double local_share;        /* of each batch, to the trust region round the best */
  double local_radius;       /* of the trust region at the start of an epoch */
  double sampling_step;      /* first step of the evolution strategy that makes every second epoch */
  int sampling_stall;        /* batches without gain that end such an epoch */
  double evolution_step;     /* first step of the evolution strategy that refines the best row */
  int evolution_samples;     /* from which the surrogate chooses each of its points */
  int evolution_stall;       /* batches without gain that end the refinement */

  /* nsga2 */
  int front_population;
  int front_verified; /* true evaluations per cycle */
  int front_rounds;   /* generations on the surrogates per cycle */
};

enum eo_parameter_kind {
  EO_PARAMETER_NUMBER,
  EO_PARAMETER_INTEGER,
  EO_PARAMETER_SEED,
  EO_PARAMETER_FLAG,
  EO_PARAMETER_CHOICE
};

struct eo_parameter {
  const char *key;
  enum eo_parameter_kind kind; /* member type: NUMBER double, SEED uint64_t, else int (FLAG 0 or 1, CHOICE an index) */
  size_t offset;               /* in struct eo_optimizer_settings */
  double low, high, standard;
  unsigned algorithms;        /* bit 1 << enum eo_algorithm: who reads it */
  const char *const *choices; /* names of a CHOICE, NULL terminated */
  const char *help;           /* one sentence */
};

/* All parameters, in the order of a form. */
const struct eo_parameter *eo_optimizer_parameters(int *count);

/* Reads and sets a parameter, whatever its kind. */
double eo_optimizer_get(const struct eo_optimizer_settings *settings, const struct eo_parameter *parameter);
void eo_optimizer_put(struct eo_optimizer_settings *settings, const struct eo_parameter *parameter, double value);

/* "ga", "fpga", "credibility-ga", "nsga2"; find returns -1 for an unknown name. */
const char *eo_optimizer_algorithm_name(int algorithm);
int eo_optimizer_algorithm_find(const char *name);

void eo_optimizer_defaults(struct eo_optimizer_settings *settings, int algorithm, int variables);

/* Ranges, and what must fit together; the first fault goes to *error with the pointer /optimization/KEY. */
enum eo_code eo_optimizer_settings_check(const struct eo_optimizer_settings *settings, struct eo_error *error);

/* The default r_share of n variables, and the budget that counts (INT_MAX: none). */
double eo_optimizer_share_radius(const struct eo_optimizer_settings *settings);
int eo_optimizer_budget(const struct eo_optimizer_settings *settings);

#endif
