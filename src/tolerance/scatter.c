/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tolerance/scatter.h"

#include <math.h>
#include <string.h>

static double sum_of_variances(const struct eo_scatter *scatter, int group)
{
  double sum = 0;
  for (int i = 0; i < scatter->inputs; i++)
    if (scatter->input[i].fixed_sum == group)
      sum += scatter->input[i].deviation.sigma * scatter->input[i].deviation.sigma;
  return sum;
}

/* The first input before it that takes its rows from the same list; -1: none. */
static int partner_of(const struct eo_scatter *scatter, int input)
{
  int together = scatter->input[input].together;
  for (int i = 0; i < input && together > 0; i++)
    if (scatter->input[i].together == together)
      return i;
  return -1;
}

static int count_group(const struct eo_scatter *scatter, int group)
{
  int count = 0;
  for (int i = 0; i < scatter->inputs; i++)
    count += scatter->input[i].fixed_sum == group;
  return count;
}

enum eo_code eo_scatter_settle(struct eo_scatter *scatter, struct eo_error *error)
{
  scatter->dimensions = 0;
  if (scatter->inputs < 1)
    return eo_error_set(error, EO_ERROR_INPUT, "/tolerance", "Nothing scatters: state a preset or inputs.");
  for (int i = 0; i < scatter->inputs; i++) {
    struct eo_scatter_input *input = &scatter->input[i];
    int partner = partner_of(scatter, i);
    if (partner >= 0 && scatter->input[partner].values != input->values)
      return eo_error_set(
          error, EO_ERROR_INPUT, "/tolerance/inputs",
          "%s has %d values and %s of the same group %d: lists that are drawn together are equally long.", input->key,
          input->values, scatter->input[partner].key, scatter->input[partner].values);
    if (input->fixed_sum > 0 && count_group(scatter, input->fixed_sum) < 2)
      return eo_error_set(error, EO_ERROR_INPUT, "/tolerance/inputs",
                          "%s alone cannot keep a sum: give two inputs or more the same group.", input->key);
    scatter->dimension[i] = partner >= 0 ? scatter->dimension[partner] : scatter->dimensions++;
    if (input->deviation.kind == EO_DISTRIBUTION_LIST) {
      input->deviation.values = input->values;
      input->deviation.value = input->value;
    }
  }
  return EO_OK;
}

/* Normals under the condition that their deviations cancel: each gives up its share of the variance of what is over,
   which leaves sigma_i^2 (1 - sigma_i^2 / sum): theory (A2). */
static void keep_sums(const struct eo_scatter *scatter, double *value)
{
  for (int i = 0; i < scatter->inputs; i++) {
    int group = scatter->input[i].fixed_sum;
    double over = 0, variances = sum_of_variances(scatter, group);
    bool first = group > 0 && variances > 0;
    for (int j = 0; j < i && first; j++)
      first = scatter->input[j].fixed_sum != group;
    if (!first)
      continue;
    for (int j = i; j < scatter->inputs; j++)
      if (scatter->input[j].fixed_sum == group)
        over += value[j] - scatter->input[j].deviation.mean;
    for (int j = i; j < scatter->inputs; j++)
      if (scatter->input[j].fixed_sum == group)
        value[j] -= over * scatter->input[j].deviation.sigma * scatter->input[j].deviation.sigma / variances;
  }
}

int eo_scatter_draw(const struct eo_scatter *scatter, const struct eo_sampler *sampler, int point, double *value)
{
  double u[EO_MAX_SCATTER_INPUTS];
  int bounded = 0;
  eo_sampler_at(sampler, point, u);
  for (int i = 0; i < scatter->inputs; i++)
    value[i] = eo_distribution_quantile(&scatter->input[i].deviation, u[scatter->dimension[i]]);
  keep_sums(scatter, value);
  for (int i = 0; i < scatter->inputs; i++) {
    const struct eo_scatter_input *input = &scatter->input[i];
    double deviation = input->step > 0 ? input->step * round(value[i] / input->step) : value[i],
           drawn = input->nominal + deviation;
    if (input->target == EO_TARGET_SEED)
      drawn = floor(drawn);
    value[i] = input->cyclic ? drawn : fmin(fmax(drawn, input->least), input->most);
    bounded += value[i] != drawn;
  }
  return bounded;
}

void eo_scatter_apply(const struct eo_scatter *scatter, const double *value, void *target, double *compliance,
                      double *speed)
{
  *compliance = *speed = 1;
  for (int i = 0; i < scatter->inputs; i++) {
    const struct eo_scatter_input *input = &scatter->input[i];
    double si = value[i] * input->unit;
    if (input->target == EO_TARGET_COMPLIANCE)
      *compliance = value[i];
    else if (input->target == EO_TARGET_SPEED)
      *speed = value[i];
    else if (input->target == EO_TARGET_SEED) {
      uint64_t seed = (uint64_t)value[i];
      memcpy((char *)target + input->offset, &seed, sizeof seed);
    } else {
      si = input->cyclic ? si - floor(si) : si;
      memcpy((char *)target + input->offset, &si, sizeof si);
    }
  }
}

struct eo_moments eo_scatter_moments(const struct eo_scatter *scatter, int i)
{
  const struct eo_scatter_input *input = &scatter->input[i];
  struct eo_moments moments = eo_distribution_moments(&input->deviation);
  moments.mean += input->nominal;
  if (input->fixed_sum > 0) {
    double variances = sum_of_variances(scatter, input->fixed_sum), own = input->deviation.sigma;
    moments.deviation = own * sqrt(fmax(0, 1 - own * own / variances));
  }
  return moments;
}

int eo_scatter_quantities(const struct eo_scatter *scatter)
{
  int count = scatter->inputs;
  while (count > 0 && scatter->input[count - 1].target == EO_TARGET_SEED)
    count--;
  return count;
}

bool eo_scatter_is_independent(const struct eo_scatter *scatter)
{
  bool independent = true;
  for (int i = 0; i < scatter->inputs && independent; i++)
    independent = scatter->input[i].fixed_sum == 0 && partner_of(scatter, i) < 0;
  return independent;
}
