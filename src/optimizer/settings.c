/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimizer/settings.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const eo_algorithm_names[] = {[EO_CREDIBILITY_GA] = "credibility-ga",
                                          [EO_FPGA] = "fpga",
                                          [EO_GA] = "ga",
                                          [EO_NSGA2] = "nsga2",
                                          [EO_ALGORITHMS] = NULL};
const char *const eo_mutation_modes[] = {[EO_MUTATE_GENE] = "gene", [EO_MUTATE_INDIVIDUAL] = "individual", NULL};
const char *const eo_distance_norms[] = {[EO_NORM_RANGE] = "range", [EO_NORM_RMS] = "rms", NULL};
const char *const eo_weight_sums[] = {[EO_WEIGHTS_REGION] = "region", [EO_WEIGHTS_ALL] = "all", NULL};
const char *const eo_decision_orders[] = {[EO_ORDER_BATCH] = "batch", [EO_ORDER_SEQUENTIAL] = "sequential", NULL};
const char *const eo_fitness_forms[] = {
    [EO_FITNESS_RECIPROCAL] = "reciprocal", [EO_FITNESS_NEGATIVE] = "negative", NULL};

const char *eo_optimizer_algorithm_name(int algorithm)
{
  return algorithm >= 0 && algorithm < EO_ALGORITHMS ? eo_algorithm_names[algorithm] : "";
}

int eo_optimizer_algorithm_find(const char *name)
{
  for (int i = 0; i < EO_ALGORITHMS; i++)
    if (strcmp(name, eo_algorithm_names[i]) == 0)
      return i;
  return -1;
}

void eo_optimizer_defaults(struct eo_optimizer_settings *settings, int algorithm, int variables)
{
  *settings = (struct eo_optimizer_settings){.algorithm = algorithm, .variables = variables, .objectives = 1};
#define SET(member, standard, help) settings->member = standard;
#define SET_RANGED(member, low, high, standard, help) settings->member = standard;
#define SET_CHOICE(member, names, standard, help) settings->member = standard;
#define SET_NONE(member, low, high, rule, help) settings->member = 0;
#define SET_OPEN(member, low, high, rule, help) settings->member = NAN;
  EO_OPTIMIZER_SETTINGS(SET, SET_NONE, SET_RANGED, SET_OPEN, SET_RANGED, SET, SET_CHOICE)
}

static enum eo_code fault(struct eo_error *error, const char *key, const char *sentence)
{
  char pointer[80];
  snprintf(pointer, sizeof pointer, "/optimization/%s", key);
  return eo_error_set(error, EO_ERROR_INPUT, pointer, "%s", sentence);
}

static enum eo_code check_range(const char *key, double value, double low, double high, struct eo_error *error)
{
  if (value >= low && value <= high)
    return EO_OK;
  char sentence[200];
  snprintf(sentence, sizeof sentence, "%s is %.9g, but must lie between %.9g and %.9g.", key, value, low, high);
  return fault(error, key, sentence);
}

static int count_names(const char *const *names)
{
  int count = 0;
  while (names[count])
    count++;
  return count;
}

/* Each setting against the range in its row; a number left to its rule has none. */
static enum eo_code check_ranges(const struct eo_optimizer_settings *settings, struct eo_error *error)
{
  enum eo_code code = EO_OK;
#define CHECK(member, low, high, ...) \
  code = code ? code : check_range(#member, (double)settings->member, low, high, error);
#define CHECK_SEED(member, ...) CHECK(member, 0, 9007199254740991.0, )
#define CHECK_BUDGET(member, low, high, ...) CHECK(member, 0, high, )
#define CHECK_OPEN(member, low, high, ...) \
  if (!isnan(settings->member))            \
  CHECK(member, low, high, )
#define CHECK_FLAG(member, ...)
#define CHECK_CHOICE(member, names, ...) CHECK(member, 0, count_names(names) - 1, )
  EO_OPTIMIZER_SETTINGS(CHECK_SEED, CHECK_BUDGET, CHECK, CHECK_OPEN, CHECK, CHECK_FLAG, CHECK_CHOICE)
  return code;
}

static enum eo_code check_problem(const struct eo_optimizer_settings *settings, struct eo_error *error)
{
  if (settings->algorithm < 0 || settings->algorithm >= EO_ALGORITHMS)
    return fault(error, "algorithm", "There is no such algorithm.");
  if (settings->variables < 1 || settings->variables > EO_MAX_VARIABLES)
    return eo_error_set(error, EO_ERROR_INPUT, "/optimization/variables",
                        "There are %d variables, but must be 1 to %d.", settings->variables, EO_MAX_VARIABLES);
  if (settings->objectives < 1 || settings->objectives > EO_MAX_OBJECTIVES)
    return eo_error_set(error, EO_ERROR_INPUT, "/optimization/objectives",
                        "There are %d objectives, but must be 1 to %d.", settings->objectives, EO_MAX_OBJECTIVES);
  return EO_OK;
}

enum eo_code eo_optimizer_settings_check(const struct eo_optimizer_settings *settings, struct eo_error *error)
{
  enum eo_code code = check_problem(settings, error);
  if (!code)
    code = check_ranges(settings, error);
  if (code)
    return code;
  if (settings->removal_threshold >= settings->trust_threshold)
    return eo_error_set(error, EO_ERROR_INPUT, "/optimization/removal_threshold",
                        "%.6g is not below the trust threshold %.6g: no prediction would survive a generation.",
                        settings->removal_threshold, settings->trust_threshold);
  if ((settings->algorithm == EO_GA || settings->algorithm == EO_FPGA) && settings->elite >= settings->population)
    return fault(error, "elite", "elite must be smaller than population.");
  return EO_OK;
}

double eo_optimizer_share_radius(const struct eo_optimizer_settings *settings)
{
  return isnan(settings->share_radius) ? 0.03 * pow(settings->variables / 5.0, 1.9) : settings->share_radius;
}

int eo_optimizer_budget(const struct eo_optimizer_settings *settings)
{
  if (settings->true_evaluations > 0)
    return settings->true_evaluations;
  return settings->algorithm == EO_GA || settings->algorithm == EO_FPGA ? INT_MAX : 500 + 100 * settings->variables;
}
