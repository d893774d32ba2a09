/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluation/objective_terms.h"

#include <math.h>
#include <stdio.h>

#include "base/sort.h"
#include "evaluation/scalar.h"
#include "tolerance/statistics.h"

double eo_objective_excess(double limit, double value)
{
  if (!(value > limit))
    return 0;
  return limit > 0 ? value / limit - 1 : value - limit;
}

static enum eo_code check_row(const struct eo_design *design, const char *list, int row, int output, int load_case,
                              double percent, struct eo_error *error)
{
  const struct eo_scalar *scalar = eo_scalar_at(output);
  char pointer[64];
  snprintf(pointer, sizeof pointer, "/objective/%s/%d/load_case", list, row);
  if (load_case > design->load_cases)
    return eo_error_set(error, EO_ERROR_INPUT, pointer, "There is no load case %d: the design has %d.", load_case,
                        design->load_cases);
  snprintf(pointer, sizeof pointer, "/objective/%s/%d/output", list, row);
  if (scalar->end >= design->gear_pair.ends)
    return eo_error_set(error, EO_ERROR_INPUT, pointer, "The pair has one end, the left one: there is no %s.",
                        scalar->key);
  if (2 * scalar->order >= design->resolution.positions)
    return eo_error_set(error, EO_ERROR_INPUT, pointer,
                        "%d mesh positions do not hold order %d: state more than %d in resolution.positions.",
                        design->resolution.positions, scalar->order, 2 * scalar->order);
  snprintf(pointer, sizeof pointer, "/objective/%s/%d/percent", list, row);
  if (!isnan(percent) && eo_design_states(design) < 2)
    return eo_error_set(error, EO_ERROR_INPUT, pointer,
                        "A percentile is taken over several states of the pair: state objective.robust with "
                        "scatter_pairs or scenarios, or no percent.");
  return EO_OK;
}

static enum eo_code check_front(const struct eo_design *design, struct eo_error *error)
{
  if (design->optimization.search.algorithm != EO_NSGA2)
    return EO_OK;
  if (design->optimization.front == EO_FRONT_NOMINAL_AND_ROBUST && eo_design_states(design) < 2)
    return eo_error_set(error, EO_ERROR_INPUT, "/optimization/front",
                        "A front of the nominal against the robust objective needs a robust one: state "
                        "objective.robust with scatter_pairs or scenarios.");
  if (design->optimization.front == EO_FRONT_TERMS && design->objective.terms < 2)
    return eo_error_set(error, EO_ERROR_INPUT, "/optimization/front",
                        "A front over the terms of the objective needs two of them in objective.terms, not %d.",
                        design->objective.terms);
  return EO_OK;
}

enum eo_code eo_objective_check(const struct eo_design *design, struct eo_error *error)
{
  const struct eo_objective *objective = &design->objective;
  double sum = objective->weight[0] + objective->weight[1] + objective->weight[2];
  for (int i = 0; i < objective->terms; i++) {
    const struct eo_objective_term *term = &objective->term[i];
    sum += term->weight;
    EO_TRY(check_row(design, "terms", i, term->output, term->load_case, term->percent, error));
  }
  for (int i = 0; i < objective->limits; i++) {
    const struct eo_objective_limit *limit = &objective->limit[i];
    EO_TRY(check_row(design, "limits", i, limit->output, limit->load_case, limit->percent, error));
  }
  if (!(sum > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "/objective/weights",
                        "At least one weight, of these or of a term, must be above 0.");
  return check_front(design, error);
}

bool eo_objective_wants_scalars(const struct eo_objective *objective)
{
  return objective->terms + objective->limits > 0;
}

bool eo_objective_wants_root(const struct eo_objective *objective)
{
  bool wants = !isnan(objective->root_stress);
  for (int i = 0; i < objective->terms; i++)
    wants = wants || eo_scalar_at(objective->term[i].output)->needs & EO_SCALAR_ROOT;
  for (int i = 0; i < objective->limits; i++)
    wants = wants || eo_scalar_at(objective->limit[i].output)->needs & EO_SCALAR_ROOT;
  return wants;
}

static bool is_there(int output, int load_case, int cases, const struct eo_objective_case *value)
{
  bool there = true;
  for (int k = 0; k < cases; k++)
    there = there && ((load_case > 0 && load_case != k + 1) || isfinite(value[k].scalar[output]));
  return there;
}

bool eo_objective_has_scalars(const struct eo_objective *objective, int cases, const struct eo_objective_case *value)
{
  bool there = true;
  for (int i = 0; i < objective->terms; i++)
    there = there && is_there(objective->term[i].output, objective->term[i].load_case, cases, value);
  for (int i = 0; i < objective->limits; i++)
    there = there && is_there(objective->limit[i].output, objective->limit[i].load_case, cases, value);
  return there;
}

/* theory (O5): of a load case, or the mean over the duty cycle by share of time. */
static double number_of(const struct eo_objective_term *term, int cases, const struct eo_load_case *load_case,
                        const struct eo_objective_case *value)
{
  double sum = 0, shares = 0;
  if (term->load_case > 0)
    return value[term->load_case - 1].scalar[term->output];
  for (int k = 0; k < cases; k++) {
    sum += load_case[k].share * value[k].scalar[term->output];
    shares += load_case[k].share;
  }
  return sum / shares;
}

/* What a term adds to J over its weight. What the unmodified pair already has at zero counts once it is there, as f1,
   f2, f3 do. */
static double part_of(const struct eo_objective *objective, const struct eo_objective_term *term, double number,
                      double before)
{
  double scale = !isnan(term->scale) ? term->scale : objective->normalise == EO_NORMALISE_NONE ? 1 : before;
  return scale > 0 ? number / scale : number > 0;
}

void eo_objective_add_terms(const struct eo_objective *objective, int cases, const struct eo_load_case *load_case,
                            const struct eo_objective_case *of, const struct eo_objective_case *before,
                            struct eo_objective_value *value)
{
  value->terms = objective->terms;
  for (int i = 0; i < objective->terms; i++) {
    const struct eo_objective_term *term = &objective->term[i];
    value->term[i] = number_of(term, cases, load_case, of);
    if (isnan(term->percent))
      value->objective += term->weight *
                          part_of(objective, term, value->term[i], number_of(term, cases, load_case, before));
  }
  for (int i = 0; i < objective->limits; i++) {
    const struct eo_objective_limit *limit = &objective->limit[i];
    for (int k = 0; k < cases; k++)
      if (isnan(limit->percent) && (limit->load_case == 0 || limit->load_case == k + 1))
        value->violation += eo_objective_excess(limit->most, of[k].scalar[limit->output]);
  }
}

static double percentile(int states, double *column, double percent)
{
  eo_sort_numbers(states, column);
  return eo_percentile(states, column, percent);
}

/* theory (O6) */
void eo_objective_add_percentiles(const struct eo_objective *objective, int states, int cases,
                                  const struct eo_load_case *load_case, const struct eo_objective_case *of,
                                  const struct eo_objective_case *before, struct eo_objective_value *value)
{
  double number[EO_MAX_PAIR_STATES], part[EO_MAX_PAIR_STATES];
  for (int t = 0; t < objective->terms; t++) {
    const struct eo_objective_term *term = &objective->term[t];
    for (int i = 0; i < states; i++) {
      number[i] = number_of(term, cases, load_case, of + i * cases);
      part[i] = part_of(objective, term, number[i], number_of(term, cases, load_case, before + i * cases));
    }
    if (isnan(term->percent))
      continue;
    value->term[t] = percentile(states, number, term->percent);
    value->objective += term->weight * percentile(states, part, term->percent);
  }
  for (int l = 0; l < objective->limits; l++) {
    const struct eo_objective_limit *limit = &objective->limit[l];
    for (int k = 0; k < cases; k++) {
      if (isnan(limit->percent) || (limit->load_case > 0 && limit->load_case != k + 1))
        continue;
      for (int i = 0; i < states; i++)
        number[i] = of[i * cases + k].scalar[limit->output];
      value->violation += eo_objective_excess(limit->most, percentile(states, number, limit->percent));
    }
  }
}

void eo_front_values(const struct eo_design *design, const struct eo_objective_value *value,
                     const struct eo_objective_value *before, double *axis)
{
  switch (design->optimization.front) {
  case EO_FRONT_NOMINAL_AND_ROBUST:
    axis[0] = value->nominal;
    axis[1] = value->objective;
    break;
  case EO_FRONT_TERMS:
    for (int i = 0; i < design->objective.terms; i++)
      axis[i] = value->term[i];
    break;
  default:
    for (int i = 0; i < 3; i++)
      axis[i] = before->sums.f[i] > 0 ? value->sums.f[i] / before->sums.f[i] : value->sums.f[i];
  }
}

static void robust_name(const struct eo_objective *objective, char *name, size_t size)
{
  switch (objective->robust) {
  case EO_ROBUST_PERCENTILE:
    snprintf(name, size, "J that %.3g %% of the pairs stay below", objective->robust_percent);
    break;
  case EO_ROBUST_SIGMAS:
    snprintf(name, size, "J, mean and %.3g sigma", objective->robust_sigmas);
    break;
  default:
    snprintf(name, size, objective->robust == EO_ROBUST_WORST ? "J of the worst state" : "J, mean of the states");
  }
}

void eo_front_axis_name(const struct eo_design *design, int axis, char *name, size_t size)
{
  static const char *const sums[3] = {"f1 over the unmodified pair's", "f2 over the unmodified pair's",
                                      "f3 over the unmodified pair's"};
  const struct eo_objective_term *term = &design->objective.term[axis];
  int length;
  switch (design->optimization.front) {
  case EO_FRONT_NOMINAL_AND_ROBUST:
    if (axis > 0)
      robust_name(&design->objective, name, size);
    else
      snprintf(name, size, "J of the nominal pair");
    break;
  case EO_FRONT_TERMS:
    length = term->load_case > 0
                 ? snprintf(name, size, "%s of load case %d", eo_scalar_keys[term->output], term->load_case)
                 : snprintf(name, size, "%s over the duty cycle", eo_scalar_keys[term->output]);
    if (!isnan(term->percent) && length > 0 && (size_t)length < size)
      snprintf(name + length, size - (size_t)length, ", %.3g %%", term->percent);
    break;
  default:
    snprintf(name, size, "%s", sums[axis]);
  }
}
