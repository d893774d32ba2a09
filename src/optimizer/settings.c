#include "optimizer/settings.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const mutation_modes[] = {"gene", "individual", NULL};
static const char *const distance_norms[] = {"range", "rms", NULL};
static const char *const weight_sums[] = {"region", "all", NULL};
static const char *const decision_orders[] = {"batch", "sequential", NULL};
static const char *const fitness_forms[] = {"reciprocal", "negative", NULL};
static const char *const algorithm_names[] = {"ga", "fpga", "credibility-ga", "nsga2"};

enum {
  GA = 1 << EO_GA,
  FPGA = 1 << EO_FPGA,
  CREDIBILITY = 1 << EO_CREDIBILITY_GA,
  NSGA2 = 1 << EO_NSGA2,
  GENETIC = GA | FPGA,
  ALL = GA | FPGA | CREDIBILITY | NSGA2
};

#define NUMBER(key, low, high, standard, who, help)                                                              \
  {                                                                                                              \
#key, EO_PARAMETER_NUMBER, offsetof(struct eo_optimizer_settings, key), low, high, standard, who, NULL, help \
  }
#define INTEGER(key, low, high, standard, who, help)                                                              \
  {                                                                                                               \
#key, EO_PARAMETER_INTEGER, offsetof(struct eo_optimizer_settings, key), low, high, standard, who, NULL, help \
  }
#define FLAG(key, standard, who, help)                                                                    \
  {                                                                                                       \
#key, EO_PARAMETER_FLAG, offsetof(struct eo_optimizer_settings, key), 0, 1, standard, who, NULL, help \
  }
#define CHOICE(key, high, standard, choices, who, help)                                                           \
  {                                                                                                               \
#key, EO_PARAMETER_CHOICE, offsetof(struct eo_optimizer_settings, key), 0, high, standard, who, choices, help \
  }

static const struct eo_parameter parameters[] = {
    {"seed", EO_PARAMETER_SEED, offsetof(struct eo_optimizer_settings, seed), 0, 9007199254740991.0, 1, ALL, NULL,
     "Equal seeds give equal results."},
    INTEGER(true_evaluations, 0, 10000000, 0, ALL,
            "Budget of true evaluations; 0: none for ga and fpga, 500 + 100 n for the others."),
    NUMBER(crossover, 0, 1, 0.8, ALL, "Probability p_c that a pair of parents is crossed."),
    NUMBER(crossover_index, 0, 1000, 10, ALL,
           "Distribution index of simulated binary crossover; larger stays nearer the parents."),
    NUMBER(mutation, 0, 1, 0.3, ALL, "Probability p_m of mutation."),
    NUMBER(mutation_index, 0, 1000, 20, ALL, "Distribution index of polynomial mutation; larger changes less."),
    CHOICE(mutation_mode, 1, EO_MUTATE_GENE, mutation_modes, ALL,
           "What p_m counts for: each gene, or the individual (each gene then with 1/n)."),
    INTEGER(population, 4, 1000, 50, GENETIC | CREDIBILITY, "Individuals of a generation."),
    INTEGER(generations, 1, 100000, 200, GENETIC, "Generations, the random first one included."),
    INTEGER(elite, 0, 100, 1, GENETIC, "Best individuals that cannot be lost from one generation to the next."),
    CHOICE(fitness_form, 1, EO_FITNESS_RECIPROCAL, fitness_forms, GENETIC,
           "Fitness from the value J to minimise: 1/J (values <= 0 count as failed) or -J."),
    NUMBER(trust_threshold, 0, 1, 0.6, FPGA, "R*: an individual at least this credible is predicted."),
    NUMBER(redundancy_threshold, 0, 1, 1e-7, FPGA,
           "I_r*: rows closer than this to their neighbours leave the history."),
    NUMBER(share_radius, 0, 10, 0, FPGA, "r_share, radius of the region that predicts; 0: 0.03 (n/5)^1.9."),
    NUMBER(weight_decay, 0, 10000, 20, FPGA, "alpha: how fast the weight of a row falls with its distance."),
    NUMBER(credibility_loss, 0, 1, 0.8, FPGA, "beta: factor on the credibility of predicted rows per generation."),
    NUMBER(removal_threshold, 0, 1, 0.1, FPGA, "R_0: predicted rows less credible than this leave the history."),
    FLAG(verify, 1, FPGA, "Evaluate the best predicted individual of each generation."),
    CHOICE(distance_norm, 1, EO_NORM_RANGE, distance_norms, FPGA,
           "Euclidean distance of normalised variables, or that over sqrt n."),
    CHOICE(weight_sum, 1, EO_WEIGHTS_REGION, weight_sums, FPGA,
           "Rows in the sum of (15): those of the region, or all."),
    CHOICE(decision_order, 1, EO_ORDER_BATCH, decision_orders, FPGA,
           "Decide a whole generation on the history before it, or one individual after another."),
    FLAG(store_predicted, 1, FPGA, "Predicted individuals enter the history too."),
    FLAG(literal_redundancy, 0, FPGA, "Redundancy exactly as printed, which deletes unique rows too."),
    FLAG(reuse, 1, GENETIC, "An individual equal to an evaluated one takes its value and is not counted."),
    INTEGER(batch, 1, 1024, 8, CREDIBILITY, "True evaluations at a time."),
    INTEGER(initial_factor, 1, 100, 4, CREDIBILITY, "Latin hypercube points per variable at the start of an epoch."),
    INTEGER(model_rows, 20, 1000, 300, CREDIBILITY | NSGA2, "Most rows of the surrogate."),
    INTEGER(children, 4, 10000, 100, CREDIBILITY, "Children bred for each batch."),
    NUMBER(exploration, 0, 100, 0.3, CREDIBILITY, "kappa: how much doubt counts against a predicted gain."),
    NUMBER(credibility_length, 1e-6, 10, 0.05, CREDIBILITY, "Length over sqrt n at which credibility fades."),
    NUMBER(taboo_radius, 0, 1, 0.03, CREDIBILITY, "Radius over sqrt n round finished optima that later epochs avoid."),
    INTEGER(stall_batches, 1, 10000, 4, CREDIBILITY, "Batches without gain before a new epoch."),
    NUMBER(stall_gain, 0, 1, 0.002, CREDIBILITY, "Gain that counts, relative."),
    NUMBER(polish_share, 0, 1, 0.2, CREDIBILITY, "Share of the budget that only improves the best."),
    NUMBER(local_share, 0, 1, 0.5, CREDIBILITY, "Share of each batch for the trust region round the best."),
    NUMBER(local_radius, 1e-6, 0.5, 0.3, CREDIBILITY, "Radius of the trust region at the start of an epoch."),
    NUMBER(sampling_step, 1e-6, 0.5, 0.25, CREDIBILITY,
           "First step of the evolution strategy that makes every second epoch."),
    INTEGER(sampling_stall, 1, 10000, 10, CREDIBILITY, "Batches without gain that end such an epoch."),
    NUMBER(evolution_step, 1e-6, 0.5, 0.03, CREDIBILITY,
           "First step of the evolution strategy that refines the best row."),
    INTEGER(evolution_stall, 1, 10000, 6, CREDIBILITY, "Batches without gain that end the refinement."),
    INTEGER(evolution_samples, 1, 100, 12, CREDIBILITY,
            "Samples of an evolution strategy from which the surrogate chooses each point."),
    INTEGER(front_population, 4, 1000, 48, NSGA2, "Individuals of a generation."),
    INTEGER(front_verified, 1, 1000, 12, NSGA2, "True evaluations per cycle."),
    INTEGER(front_rounds, 1, 1000, 20, NSGA2, "Generations on the surrogates per cycle."),
};

enum { PARAMETERS = sizeof parameters / sizeof *parameters };

const struct eo_parameter *eo_optimizer_parameters(int *count)
{
  *count = PARAMETERS;
  return parameters;
}

const char *eo_optimizer_algorithm_name(int algorithm)
{
  return algorithm >= 0 && algorithm < EO_ALGORITHMS ? algorithm_names[algorithm] : "";
}

int eo_optimizer_algorithm_find(const char *name)
{
  for (int i = 0; i < EO_ALGORITHMS; i++)
    if (strcmp(name, algorithm_names[i]) == 0)
      return i;
  return -1;
}

void eo_optimizer_put(struct eo_optimizer_settings *settings, const struct eo_parameter *p, double value)
{
  char *member = (char *)settings + p->offset;
  if (p->kind == EO_PARAMETER_NUMBER)
    memcpy(member, &value, sizeof value);
  else if (p->kind == EO_PARAMETER_SEED)
    memcpy(member, &(uint64_t){(uint64_t)value}, sizeof(uint64_t));
  else
    memcpy(member, &(int){(int)value}, sizeof(int));
}

double eo_optimizer_get(const struct eo_optimizer_settings *settings, const struct eo_parameter *p)
{
  const char *member = (const char *)settings + p->offset;
  if (p->kind == EO_PARAMETER_NUMBER) {
    double number;
    memcpy(&number, member, sizeof number);
    return number;
  }
  if (p->kind == EO_PARAMETER_SEED) {
    uint64_t seed;
    memcpy(&seed, member, sizeof seed);
    return (double)seed;
  }
  int integer;
  memcpy(&integer, member, sizeof integer);
  return integer;
}

void eo_optimizer_defaults(struct eo_optimizer_settings *settings, int algorithm, int variables)
{
  *settings = (struct eo_optimizer_settings){.algorithm = algorithm, .variables = variables, .objectives = 1};
  for (int i = 0; i < PARAMETERS; i++)
    eo_optimizer_put(settings, &parameters[i], parameters[i].standard);
}

static enum eo_code fault(struct eo_error *error, const char *key, const char *sentence)
{
  char pointer[80];
  snprintf(pointer, sizeof pointer, "/optimization/%s", key);
  return eo_error_set(error, EO_ERROR_INPUT, pointer, "%s", sentence);
}

static enum eo_code check_range(const struct eo_optimizer_settings *settings, const struct eo_parameter *p,
                                struct eo_error *error)
{
  const double value = eo_optimizer_get(settings, p);
  if (value >= p->low && value <= p->high)
    return EO_OK;
  char sentence[200];
  snprintf(sentence, sizeof sentence, "%s is %.9g, but must lie between %.9g and %.9g.", p->key, value, p->low,
           p->high);
  return fault(error, p->key, sentence);
}

static enum eo_code check_problem(const struct eo_optimizer_settings *s, struct eo_error *error)
{
  if (s->algorithm < 0 || s->algorithm >= EO_ALGORITHMS)
    return fault(error, "algorithm", "There is no such algorithm.");
  if (s->variables < 1 || s->variables > EO_MAX_VARIABLES)
    return eo_error_set(error, EO_ERROR_INPUT, "/optimization/variables",
                        "There are %d variables, but must be 1 to %d.", s->variables, EO_MAX_VARIABLES);
  if (s->objectives < 1 || s->objectives > EO_MAX_OBJECTIVES)
    return eo_error_set(error, EO_ERROR_INPUT, "/optimization/objectives",
                        "There are %d objectives, but must be 1 to %d.", s->objectives, EO_MAX_OBJECTIVES);
  return EO_OK;
}

enum eo_code eo_optimizer_settings_check(const struct eo_optimizer_settings *settings, struct eo_error *error)
{
  enum eo_code code = check_problem(settings, error);
  for (int i = 0; i < PARAMETERS && code == EO_OK; i++)
    code = check_range(settings, &parameters[i], error);
  if (code != EO_OK)
    return code;
  if (settings->algorithm == EO_FPGA && settings->removal_threshold >= settings->trust_threshold)
    return fault(
        error, "removal_threshold",
        "removal_threshold (R_0) must be below trust_threshold (R*), or predictions would be made from nothing but "
        "rows about to be removed.");
  if ((settings->algorithm == EO_GA || settings->algorithm == EO_FPGA) && settings->elite >= settings->population)
    return fault(error, "elite", "elite must be smaller than population.");
  return EO_OK;
}

double eo_optimizer_share_radius(const struct eo_optimizer_settings *settings)
{
  return settings->share_radius > 0 ? settings->share_radius : 0.03 * pow(settings->variables / 5.0, 1.9);
}

int eo_optimizer_budget(const struct eo_optimizer_settings *settings)
{
  if (settings->true_evaluations > 0)
    return settings->true_evaluations;
  return settings->algorithm == EO_GA || settings->algorithm == EO_FPGA ? INT_MAX : 500 + 100 * settings->variables;
}
