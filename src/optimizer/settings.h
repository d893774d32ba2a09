/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an optimizer can be told: each setting once, in EO_OPTIMIZER_SETTINGS, with its range, default and help. The
   struct below, its defaults and its check are made of that list, and so is the part of the document that states them
   (document/design_tables.c). Symbols are those of theory (H1) to (H5); the paper's values are the defaults. */
#ifndef EASEOFF_OPTIMIZER_SETTINGS_H
#define EASEOFF_OPTIMIZER_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

enum eo_algorithm { EO_CREDIBILITY_GA, EO_FPGA, EO_GA, EO_NSGA2, EO_ALGORITHMS };
enum eo_mutation_mode { EO_MUTATE_GENE, EO_MUTATE_INDIVIDUAL };
enum eo_distance_norm { EO_NORM_RANGE, EO_NORM_RMS };
enum eo_weight_sum { EO_WEIGHTS_REGION, EO_WEIGHTS_ALL };
enum eo_decision_order { EO_ORDER_BATCH, EO_ORDER_SEQUENTIAL };
enum eo_fitness_form { EO_FITNESS_RECIPROCAL, EO_FITNESS_NEGATIVE };

/* Names of the choices by their enum, NULL at the end. */
extern const char *const eo_algorithm_names[],
    *const eo_mutation_modes[], *const eo_distance_norms[], *const eo_weight_sums[], *const eo_decision_orders[],
                                                                                         *const eo_fitness_forms[];

/* Raised with every change after which a search of the same settings takes another path: a search that was begun by
   another version is not taken up, its evaluations are known to the new one. */
enum { EO_OPTIMIZER_VERSION = 3 };

enum { EO_MAX_VARIABLES = 64, EO_MAX_OBJECTIVES = 8 };

/* The settings in the order of a form. Whoever expands the list says what a row becomes:
   SEED(member, default, help)                     uint64_t below 2^53
   BUDGET(member, low, high, rule, help)           int; 0: by the rule (eo_optimizer_budget())
   NUMBER(member, low, high, default, help)        double
   DERIVED(member, low, high, rule, help)          double; NaN: by the rule
   COUNT(member, low, high, default, help)         int
   FLAG(member, default, help)                     bool
   CHOICE(member, names, default, help)            int, an index of names
   The member is the key of the document too; ranges are inclusive. */
/* clang-format off */
#define EO_OPTIMIZER_SETTINGS(SEED, BUDGET, NUMBER, DERIVED, COUNT, FLAG, CHOICE)                                      \
  SEED(seed, 1, "equal seeds give equal results")                                                                      \
  BUDGET(true_evaluations, 1, 10000000, "none for ga and fpga, 500 + 100 n for the others",                            \
         "most evaluations by the model")                                                                              \
  NUMBER(crossover, 0, 1, 0.8, "probability p_c that a pair of parents is crossed")                                    \
  NUMBER(crossover_index, 0, 1000, 10, "eta of the simulated binary crossover; larger stays nearer the parents")       \
  NUMBER(mutation, 0, 1, 0.3, "probability p_m of mutation")                                                           \
  NUMBER(mutation_index, 0, 1000, 20, "eta of the polynomial mutation; larger changes less")                           \
  CHOICE(mutation_mode, eo_mutation_modes, EO_MUTATE_GENE, "what p_m counts for")                                      \
  COUNT(population, 4, 1000, 50, "individuals of a generation (ga, fpga, credibility-ga)")                             \
  COUNT(generations, 1, 100000, 200, "generations, the first included (ga, fpga)")                                     \
  COUNT(elite, 0, 100, 1, "best individuals that cannot be lost (ga, fpga)")                                           \
  CHOICE(fitness_form, eo_fitness_forms, EO_FITNESS_RECIPROCAL,                                                        \
         "fitness from the value J to minimise: 1/J or -J (ga, fpga)")                                                 \
  NUMBER(trust_threshold, 0, 1, 0.6, "R*: an individual at least this credible is predicted (fpga)")                   \
  NUMBER(redundancy_threshold, 0, 1, 1e-7,                                                                             \
         "I_r*: rows closer than this to their neighbours leave the history (fpga)")                                   \
  DERIVED(share_radius, 1e-6, 10, "0.03 (n/5)^1.9 for n variables",                                                    \
          "r_share, radius in the unit cube of the region that predicts (fpga)")                                       \
  NUMBER(weight_decay, 0, 10000, 20,                                                                                   \
         "alpha: a row at the distance e predicts with a weight that goes with exp(-alpha e) (fpga)")                  \
  NUMBER(credibility_loss, 0, 1, 0.8,                                                                                  \
         "beta: factor on the credibility of predicted rows at the end of each generation (fpga)")                     \
  NUMBER(removal_threshold, 0, 1, 0.1,                                                                                 \
         "R_0: predicted rows less credible leave the history; below trust_threshold (fpga)")                          \
  COUNT(verify, 0, 1, 1,                                                                                               \
        "1: the best predicted individual of each generation is evaluated; 0: none, as in the paper (fpga)")           \
  CHOICE(distance_norm, eo_distance_norms, EO_NORM_RANGE,                                                              \
         "Euclidean distance of normalised variables, or that over sqrt n (fpga)")                                     \
  CHOICE(weight_sum, eo_weight_sums, EO_WEIGHTS_REGION, "rows whose weights add up to 1 (fpga)")                       \
  CHOICE(decision_order, eo_decision_orders, EO_ORDER_BATCH,                                                           \
         "history frozen for a generation, or used as it grows (fpga)")                                                \
  FLAG(store_predicted, true, "predicted individuals enter the history too (fpga)")                                    \
  FLAG(literal_redundancy, false,                                                                                      \
       "redundancy by the gaps of each coordinate alone, as in the paper, which deletes unique rows too (fpga)")       \
  FLAG(reuse, true, "an individual equal to an evaluated one takes its value (ga, fpga)")                              \
  COUNT(batch, 1, 1024, 8, "true evaluations at a time (credibility-ga)")                                              \
  COUNT(initial_factor, 1, 100, 4,                                                                                     \
        "latin hypercube points per variable at the start of an epoch, of the first alone where parts of the value "   \
        "are known (credibility-ga)")                                                                                  \
  COUNT(model_rows, 20, 1000, 300, "most rows of the surrogate (credibility-ga, nsga2)")                               \
  COUNT(children, 4, 10000, 100, "children bred for each batch (credibility-ga)")                                      \
  NUMBER(exploration, 0, 100, 0.3, "kappa: how much doubt counts against a predicted gain (credibility-ga)")           \
  NUMBER(credibility_length, 1e-6, 10, 0.05, "length over sqrt n at which credibility fades (credibility-ga)")         \
  NUMBER(taboo_radius, 0, 1, 0.03,                                                                                     \
         "radius over sqrt n round finished optima, twice that where parts of the value are known (credibility-ga)")   \
  COUNT(stall_batches, 1, 10000, 4, "batches without gain before a new epoch (credibility-ga)")                        \
  NUMBER(stall_gain, 0, 1, 0.002, "gain that counts, relative (credibility-ga)")                                       \
  NUMBER(polish_share, 0, 1, 0.2,                                                                                      \
         "share of the budget that only improves the best, half of it where parts of the value are known "             \
         "(credibility-ga)")                                                                                           \
  NUMBER(local_share, 0, 1, 0.5, "share of each batch for the trust region round the best (credibility-ga)")           \
  NUMBER(local_radius, 1e-6, 0.5, 0.3, "radius of that trust region at the start of an epoch (credibility-ga)")        \
  NUMBER(sampling_step, 1e-6, 0.5, 0.25,                                                                               \
         "first step of the evolution strategy that makes every second epoch (credibility-ga)")                        \
  COUNT(sampling_stall, 1, 10000, 10,                                                                                  \
        "batches without gain that end such an epoch, half as many where parts of the value are known "                \
        "(credibility-ga)")                                                                                            \
  NUMBER(evolution_step, 1e-6, 0.5, 0.03,                                                                              \
         "first step of the evolution strategy that refines the best (credibility-ga)")                                \
  COUNT(evolution_samples, 1, 100, 12,                                                                                 \
        "samples of an evolution strategy from which the surrogate chooses each point (credibility-ga)")               \
  COUNT(evolution_stall, 1, 10000, 6, "batches without gain that end that refinement (credibility-ga)")                \
  COUNT(front_population, 4, 1000, 48, "individuals of a generation (nsga2)")                                          \
  COUNT(front_verified, 1, 1000, 12, "true evaluations per cycle (nsga2)")                                             \
  COUNT(front_rounds, 1, 1000, 20, "generations on the surrogates per cycle (nsga2)")

#define EO_MEMBER_SEED(member, standard, help)               uint64_t member;
#define EO_MEMBER_BUDGET(member, low, high, rule, help)      int member;
#define EO_MEMBER_NUMBER(member, low, high, standard, help)  double member;
#define EO_MEMBER_COUNT(member, low, high, standard, help)   int member;
#define EO_MEMBER_FLAG(member, standard, help)               bool member;
#define EO_MEMBER_CHOICE(member, names, standard, help)      int member;
/* clang-format on */

/* Fill with eo_optimizer_defaults(), change what differs; eo_optimizer_new() checks. */
struct eo_optimizer_settings {
  int algorithm;  /* enum eo_algorithm */
  int variables;  /* n, 1 .. EO_MAX_VARIABLES */
  int objectives; /* of nsga2, 1 .. EO_MAX_OBJECTIVES; the others minimise one value */
  EO_OPTIMIZER_SETTINGS(EO_MEMBER_SEED, EO_MEMBER_BUDGET, EO_MEMBER_NUMBER, EO_MEMBER_NUMBER, EO_MEMBER_COUNT,
                        EO_MEMBER_FLAG, EO_MEMBER_CHOICE)
};

#undef EO_MEMBER_SEED
#undef EO_MEMBER_BUDGET
#undef EO_MEMBER_NUMBER
#undef EO_MEMBER_COUNT
#undef EO_MEMBER_FLAG
#undef EO_MEMBER_CHOICE

/* "credibility-ga", "fpga", "ga", "nsga2"; find returns -1 for an unknown name. */
const char *eo_optimizer_algorithm_name(int algorithm);
int eo_optimizer_algorithm_find(const char *name);

/* The defaults of the list above, of an algorithm and so many variables. */
void eo_optimizer_defaults(struct eo_optimizer_settings *settings, int algorithm, int variables);

/* Ranges, and what must fit together; the first fault goes to *error with the pointer /optimization/KEY. */
enum eo_code eo_optimizer_settings_check(const struct eo_optimizer_settings *settings, struct eo_error *error);

/* r_share: as set, or 0.03 (n/5)^1.9 when it is NaN. */
double eo_optimizer_share_radius(const struct eo_optimizer_settings *settings);

/* The budget that counts (INT_MAX: none). */
int eo_optimizer_budget(const struct eo_optimizer_settings *settings);

#endif
