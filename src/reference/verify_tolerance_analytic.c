/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_tolerance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/known_law.h"
#include "tolerance/influence.h"
#include "tolerance/interval.h"
#include "tolerance/statistics.h"
#include "tolerance/response_surface.h"

enum { MODEL_POINTS = 256 };

struct model_case {
  struct eo_tolerance_bench *bench;
  struct eo_case *item, *expected;
  int output; /* EO_BENCH_... that the law is about */
  double nominal[EO_BENCH_OUTPUTS];
  double slope[EO_BENCH_INPUTS], float_slope[EO_BENCH_INPUTS];
  double *input, *value, *afloat; /* [points][inputs], [points], [points] */
};

/* Which input a key like "pinion" or "left" means; -1 with a fault. */
static int input_of(const struct model_case *model_case, struct eo_case *value)
{
  for (int i = 0; i < model_case->bench->inputs; i++)
    if (strstr(model_case->bench->input[i].name, eo_case_key(value)))
      return i;
  eo_case_fault(value, "No variable has this in its name.");
  return -1;
}

/* The change of the response for one unit of each input. */
static void find_slopes(struct model_case *model_case)
{
  struct eo_tolerance_bench *bench = model_case->bench;
  double value[EO_BENCH_INPUTS] = {0}, output[EO_BENCH_OUTPUTS] = {0}, origin[EO_BENCH_OUTPUTS] = {0};
  for (int i = 0; i < bench->inputs; i++)
    value[i] = eo_distribution_moments(&bench->input[i].distribution).mean;
  eo_bench_evaluate(bench, value, origin);
  for (int i = 0; i < bench->inputs; i++) {
    value[i] += 1;
    eo_bench_evaluate(bench, value, output);
    value[i] -= 1;
    model_case->slope[i] = output[model_case->output] - origin[model_case->output];
    model_case->float_slope[i] = output[EO_BENCH_FLOAT] - origin[EO_BENCH_FLOAT];
  }
}

static enum eo_code sample(struct model_case *model_case, struct eo_error *error)
{
  struct eo_tolerance_bench *bench = model_case->bench;
  double least[EO_BENCH_OUTPUTS] = {0}, most[EO_BENCH_OUTPUTS] = {0};
  EO_TRY(eo_bench_draw(bench->input, bench->inputs, MODEL_POINTS, model_case->input, error));
  for (int i = 0; i < MODEL_POINTS; i++) {
    double output[EO_BENCH_OUTPUTS] = {0};
    if (!eo_bench_evaluate(bench, model_case->input + (size_t)i * (size_t)bench->inputs, output))
      eo_verify_diverged(bench->v, model_case->item);
    model_case->value[i] = output[model_case->output];
    model_case->afloat[i] = output[EO_BENCH_FLOAT];
    for (int k = 0; k < EO_BENCH_OUTPUTS; k++) {
      least[k] = i ? fmin(least[k], output[k]) : output[k];
      most[k] = i ? fmax(most[k], output[k]) : output[k];
    }
  }
  if (eo_case_find(model_case->expected, "PPLTE_um")) {
    eo_verify_derived(bench->v, eo_case_find(model_case->expected, "PPLTE_um"), "spread over all samples",
                      most[EO_BENCH_PPLTE] - least[EO_BENCH_PPLTE], 0, 1e-4);
    eo_verify_derived(bench->v, eo_case_find(model_case->expected, "max_pressure_MPa"), "spread over all samples",
                      most[EO_BENCH_PRESSURE] - least[EO_BENCH_PRESSURE], 0, 0.05);
  }
  return EO_OK;
}

/* A sum of normals is normal; one input alone keeps its own distribution: exact quantiles of the change. */
static bool exact_change(const struct model_case *model_case, double share, double *change)
{
  const struct eo_tolerance_bench *bench = model_case->bench;
  double variance = 0;
  if (bench->inputs == 1) {
    const struct eo_distribution *distribution = &bench->input[0].distribution;
    *change = model_case->slope[0] *
              (eo_distribution_quantile(distribution, model_case->slope[0] < 0 ? 1 - share : share) -
               eo_distribution_moments(distribution).mean);
    return true;
  }
  for (int i = 0; i < bench->inputs; i++) {
    const struct eo_distribution *this_distribution = &bench->input[i].distribution;
    if (this_distribution->kind != EO_DISTRIBUTION_NORMAL || !isinf(this_distribution->cut))
      return false;
    variance += pow(model_case->slope[i] * this_distribution->sigma, 2);
  }
  *change = sqrt(variance) * eo_normal_quantile(share);
  return true;
}

static void check_exact(const struct model_case *model_case, struct eo_case *law)
{
  struct eo_case *rows = eo_case_find(law, "percentiles");
  for (int i = 0; i < eo_case_size(rows); i++) {
    struct eo_case *row = eo_case_at(rows, i), *minus = eo_case_find(row, "minus_nominal");
    double change = NAN;
    if (!minus)
      continue;
    if (exact_change(model_case, eo_case_number(row, "percent") / 100, &change))
      eo_verify_number(model_case->bench->v, minus, change, 1e-5, 2e-6);
    else
      eo_verify_derived(model_case->bench->v, minus, "value less the nominal one",
                        eo_case_number(row, "value") - eo_case_number(model_case->expected, "LTE_mean_nominal_um"),
                        eo_case_real(minus), 2e-6);
  }
  if (eo_case_find(law, "std_over_sigma")) {
    const struct eo_distribution *distribution = &model_case->bench->input[0].distribution;
    eo_verify_member(model_case->bench->v, law, "std_over_sigma",
                     eo_distribution_moments(distribution).deviation / distribution->sigma, 0, 1e-6);
  }
}

static enum eo_code check_model_law(const struct model_case *model_case, struct eo_case *law, struct eo_error *error)
{
  struct eo_known_law known = {model_case->bench->v, MODEL_POINTS, model_case->value,
                               model_case->output == EO_BENCH_MEAN ? 0.02 : 5e-4};
  EO_TRY(eo_verify_law(&known, law, error));
  check_exact(model_case, law);
  return EO_OK;
}

static enum eo_code check_model_regression(const struct model_case *model_case, struct eo_error *error)
{
  struct eo_case *block = eo_case_find(model_case->expected, "standardised_regression"),
                 *alone = eo_case_find(model_case->expected, "standardised_regression_R2");
  double coefficient[EO_BENCH_INPUTS];
  struct eo_regression regression = {.coefficient = coefficient};
  if (!block && !alone)
    return EO_OK;
  EO_TRY(eo_regression_run(&regression, MODEL_POINTS, model_case->bench->inputs, model_case->input, model_case->value,
                           error));
  /* a share of the variance that chance explains: one part in N for each input; four times that */
  if (alone)
    eo_verify_number(model_case->bench->v, alone, regression.r2, 0, 4. * model_case->bench->inputs / MODEL_POINTS);
  for (int i = 0; i < eo_case_size(block); i++) {
    struct eo_case *value = eo_case_at(block, i);
    bool share = strcmp(eo_case_key(value), "R2") == 0;
    int input = share ? 0 : input_of(model_case, value);
    /* columns of a sample are not quite uncorrelated: 0.02 for evenly spread points */
    eo_verify_number(model_case->bench->v, value,
                     share       ? regression.r2
                     : input < 0 ? NAN
                                 : coefficient[input],
                     0, share ? 1e-4 : 0.02);
  }
  return EO_OK;
}

static enum eo_code check_model_indices(const struct model_case *model_case, struct eo_error *error)
{
  static const char *const key[2] = {"sobol_first", "sobol_total"};
  double index[2][EO_BENCH_INPUTS];
  struct eo_moments moments[EO_BENCH_INPUTS];
  struct eo_surface surface;
  if (!eo_case_find(model_case->expected, key[0]) && !eo_case_find(model_case->expected, key[1]))
    return EO_OK;
  for (int i = 0; i < model_case->bench->inputs; i++)
    moments[i] = eo_distribution_moments(&model_case->bench->input[i].distribution);
  enum eo_code code = eo_surface_fit(&surface, MODEL_POINTS, model_case->bench->inputs, moments, model_case->input,
                                     model_case->value, error);
  if (!code)
    eo_surface_indices(&surface, index[0], index[1]);
  for (int k = 0; k < 2 && !code; k++) {
    struct eo_case *block = eo_case_find(model_case->expected, key[k]);
    for (int i = 0; i < eo_case_size(block); i++) {
      int input = input_of(model_case, eo_case_at(block, i));
      eo_verify_number(model_case->bench->v, eo_case_at(block, i), input < 0 ? NAN : index[k][input], 0,
                       eo_index_tolerance);
    }
  }
  eo_surface_done(&surface);
  return code;
}

/* Variance of the slopes of one end, and the square of their mean over it. */
static double chi_square_of(const struct model_case *model_case, int end, double *noncentral)
{
  double variance = 0, mean = 0;
  for (int i = 0; i < model_case->bench->inputs; i++)
    if (model_case->bench->input[i].end == end) {
      struct eo_moments own = eo_distribution_moments(&model_case->bench->input[i].distribution);
      variance += own.deviation * own.deviation;
      mean += own.mean;
    }
  *noncentral += variance > 0 ? mean * mean / variance : 0;
  return variance;
}

/* TE = -s X: s from one slope of the size of its sigma. */
static void check_scale(const struct model_case *model_case)
{
  double value[EO_BENCH_INPUTS] = {0}, output[EO_BENCH_OUTPUTS] = {0}, none = 0;
  const struct eo_bench_input *first = &model_case->bench->input[0];
  if (!eo_case_find(model_case->expected, "s_um"))
    return;
  value[0] = first->distribution.sigma;
  eo_bench_evaluate(model_case->bench, value, output);
  double x = value[0] * value[0] / chi_square_of(model_case, first->end, &none);
  eo_verify_member(model_case->bench->v, model_case->expected, "s_um", -output[EO_BENCH_UNLOADED] / x, 1e-3, 0);
}

/* "with_mean_helix_slope_6_um": the same with all slopes displaced. */
static enum eo_code check_displaced(struct model_case *model_case, struct eo_error *error)
{
  for (int i = 0; i < eo_case_size(model_case->expected); i++) {
    struct eo_case *block = eo_case_peek(model_case->expected, i);
    static const char start[] = "with_mean_helix_slope_";
    if (strncmp(eo_case_key(block), start, sizeof start - 1) != 0)
      continue;
    eo_case_at(model_case->expected, i);
    double mean = strtod(eo_case_key(block) + sizeof start - 1, NULL), noncentral = 0;
    for (int k = 0; k < model_case->bench->inputs; k++)
      model_case->bench->input[k].distribution.mean += mean;
    for (int end = 0; end < model_case->bench->ends; end++)
      chi_square_of(model_case, end, &noncentral);
    eo_verify_member(model_case->bench->v, block, "noncentrality", noncentral, 1e-6, 0);
    enum eo_code code = sample(model_case, error);
    if (!code)
      code = check_model_law(model_case, eo_case_need(block, "unloaded_TE"), error);
    for (int k = 0; k < model_case->bench->inputs; k++)
      model_case->bench->input[k].distribution.mean -= mean;
    EO_TRY(code);
  }
  return EO_OK;
}

/* Columns are the variables in their order, then outputs. */
static void check_model_rows(const struct model_case *model_case)
{
  struct eo_case *block = eo_case_find(model_case->item, "rows"),
                 *columns = block ? eo_case_need(block, "columns") : NULL,
                 *rows = block ? eo_case_need(block, "rows") : NULL;
  int inputs = model_case->bench->inputs, count = eo_case_size(columns);
  for (int i = 0; i < eo_case_size(rows) && !eo_case_faulty(block); i++) {
    double row[EO_BENCH_INPUTS + EO_BENCH_OUTPUTS], output[EO_BENCH_OUTPUTS] = {0};
    if (eo_case_numbers(eo_case_at(rows, i), count, EO_BENCH_INPUTS + EO_BENCH_OUTPUTS, row) < 0)
      return;
    eo_bench_evaluate(model_case->bench, row, output);
    for (int c = 0; c < count; c++) {
      const char *name = eo_case_text(eo_case_at(columns, c));
      int which = c < inputs ? -1 : name ? eo_bench_output_find(name) : -1;
      static const double relative[EO_BENCH_OUTPUTS] = {0.005, 0.002, 0.005, 0.005, 0.005, 0.005, 0.005, 0, 0};
      static const double absolute[EO_BENCH_OUTPUTS] = {0.01, 0.01, 0, 0.01, 0.01, 0, 0, 0.03, 5e-4};
      if (c >= inputs && which < 0)
        eo_case_fault(eo_case_at(columns, c), "There is no such output.");
      if (which >= 0)
        eo_verify_number(model_case->bench->v, eo_case_at(eo_case_at(rows, i), c), output[which], relative[which],
                         absolute[which]);
      if (which == EO_BENCH_MEAN) /* what the input alone does */
        eo_verify_derived(
            model_case->bench->v, eo_case_at(eo_case_at(rows, i), c), "change from the nominal pair",
            output[which] - model_case->nominal[which],
            row[c] - eo_case_number_or(model_case->expected, "LTE_mean_nominal_um", model_case->nominal[which]), 1e-4);
    }
  }
}

static void check_model_nominal(const struct model_case *model_case)
{
  struct eo_case *this_case = model_case->expected;
  struct eo_verification *verification = model_case->bench->v;
  eo_verify_member(verification, this_case, "LTE_mean_nominal_um", model_case->nominal[EO_BENCH_MEAN], 0.002, 0);
  eo_verify_member(verification, this_case, "PPLTE_um", model_case->nominal[EO_BENCH_PPLTE], 0.005, 0.01);
  eo_verify_member(verification, this_case, "max_pressure_MPa", model_case->nominal[EO_BENCH_PRESSURE], 0.005, 0);
  eo_verify_member(verification, this_case, "float_mean_nominal_um", model_case->nominal[EO_BENCH_FLOAT], 0, 0.03);
  eo_verify_member(verification, this_case, "slope_um_per_um", model_case->slope[0], 1e-5, 0);
  if (eo_case_find(this_case, "float_mean_std_um")) {
    double variance = 0;
    for (int i = 0; i < model_case->bench->inputs; i++)
      variance += pow(
          model_case->float_slope[i] * eo_distribution_moments(&model_case->bench->input[i].distribution).deviation, 2);
    eo_verify_member(verification, this_case, "float_mean_std_um", sqrt(variance), 1e-4, 0);
  }
  if (eo_case_find(this_case, "correlation_LTE_float"))
    eo_verify_member(verification, this_case, "correlation_LTE_float",
                     eo_correlation(MODEL_POINTS, model_case->value, model_case->afloat), 0, 1e-6);
  check_scale(model_case);
}

static enum eo_code run_model(struct model_case *model_case, struct eo_error *error)
{
  struct eo_case *law = eo_case_find(model_case->expected, "LTE_mean");
  model_case->output = law ? EO_BENCH_MEAN : EO_BENCH_UNLOADED;
  if (!law)
    law = eo_case_need(model_case->expected, "unloaded_TE");
  if (!eo_bench_evaluate(model_case->bench, NULL, model_case->nominal))
    eo_verify_diverged(model_case->bench->v, model_case->item);
  EO_TRY(sample(model_case, error));
  find_slopes(model_case);
  check_model_nominal(model_case);
  EO_TRY(check_model_law(model_case, law, error));
  EO_TRY(check_model_regression(model_case, error));
  EO_TRY(check_model_indices(model_case, error));
  check_model_rows(model_case);
  return check_displaced(model_case, error);
}

static enum eo_code run_model_case(struct eo_tolerance_bench *bench, struct eo_case *item, struct eo_error *error)
{
  struct model_case model_case = {.bench = bench, .item = item, .expected = eo_case_need(item, "expected")};
  bool unloaded = eo_case_flag_or(item, "unloaded", false);
  eo_case_remark(model_case.expected, "law");
  EO_TRY(eo_bench_read(bench, item, item, error));
  if (unloaded != !(bench->torque > 0))
    eo_case_fault(eo_case_find(item, "T_Nm"), "Unloaded is without torque, and the other way round.");
  if (!eo_case_faulty(item))
    eo_bench_read_inputs(bench, eo_case_need(item, "variables"));
  if (eo_case_faulty(item))
    return EO_OK;
  model_case.input = malloc(sizeof *model_case.input * MODEL_POINTS * (size_t)(bench->inputs + 2));
  if (!model_case.input)
    return eo_error_memory(error);
  model_case.value = model_case.input + (size_t)MODEL_POINTS * (size_t)bench->inputs;
  model_case.afloat = model_case.value + MODEL_POINTS;
  enum eo_code code = run_model(&model_case, error);
  free(model_case.input);
  return code;
}

enum eo_code eo_verify_tolerance_analytic(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_tolerance_bench *bench = context;
  static const char *const kinds[] = {"model", "function", NULL};
  struct eo_case *tolerance = eo_case_find(item, "tolerance");
  eo_case_remark(item, "id");
  for (int i = 0; i < eo_case_size(tolerance); i++) {
    struct eo_case *value = eo_case_at(tolerance, i);
    if (eo_case_is_text(value))
      eo_case_text(value);
    else
      eo_case_real(value);
  }
  int kind = eo_case_need(item, "kind_of_case") ? eo_case_choice(item, "kind_of_case", kinds, 0) : 0;
  return kind == 0 ? run_model_case(bench, item, error) : eo_verify_tolerance_response(bench->v, item, error);
}
