/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/verify_tolerance_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rating/flank_tolerance.h"
#include "reference/verify_deviations.h"

/* The tolerance of a row's output: "PPLTE_rel", "PPLTE_um". */
static void row_tolerance(const struct eo_tolerance_trial *trial, const char *name, double *relative, double *absolute)
{
  struct eo_case *rows = eo_case_find(trial->tolerance, "rows");
  bool swing = strncmp(name, "PPLTE", 5) == 0, mean = strncmp(name, "LTE_mean", 8) == 0;
  double pp = eo_case_relative_or(rows, "PPLTE_rel", 0.005), of_mean = eo_case_relative_or(rows, "LTE_mean_rel", 0.002),
         pressure = eo_case_relative_or(rows, "max_pressure_rel", 0.005),
         pp_um = eo_case_absolute_or(rows, "PPLTE_um", 0.01), mean_um = eo_case_absolute_or(rows, "LTE_mean_um", 0.01);
  *relative = swing ? pp : mean ? of_mean : pressure;
  *absolute = swing ? pp_um : mean ? mean_um : 0;
}

/* f_HalphaT and f_HbetaT of the class, rounded as the standard prints them; sigma is half of them. */
static enum eo_code check_limit(const struct eo_tolerance_trial *trial, struct eo_case *row,
                                const struct eo_bench_input *input, int grade, struct eo_error *error)
{
  const struct eo_gear_pair *pair = &trial->bench->nominal.gear_pair;
  int member = strstr(input->name, ".gear.") ? EO_GEAR : EO_PINION;
  struct eo_tolerance_input in = {.reference_diameter = pair->normal_module / cos(pair->helix_angle) *
                                                        pair->teeth[member],
                                  .normal_module = pair->normal_module,
                                  .face_width = pair->face_width,
                                  .teeth = pair->teeth[member],
                                  .grade = grade,
                                  .total_contact_ratio = NAN};
  struct eo_flank_tolerance limit;
  struct eo_case *expected = eo_case_find(row, "limit");
  if (!expected || input->end < 0)
    return EO_OK;
  EO_TRY(eo_flank_tolerance(&limit, EO_ISO1328_2013, &in, error));
  double value = 1e6 * (strstr(input->name, "profile_slope") ? limit.profile_slope : limit.helix_slope);
  eo_verify_number(trial->v, expected, value, 0, 1e-6);
  eo_verify_derived(trial->v, expected, "sigma", value / 2, input->distribution.sigma, 1e-6);
  return EO_OK;
}

static enum eo_code check_variables(const struct eo_tolerance_trial *trial, struct eo_case *variables,
                                    struct eo_error *error)
{
  int grade = eo_case_whole_or(trial->item, "tolerance_class_iso_1328_1_2013", 1, 11, 5);
  for (int i = 0; i < eo_case_size(variables); i++) {
    struct eo_case *row = eo_case_at(variables, i);
    const struct eo_bench_input *input = &trial->bench->input[i];
    EO_TRY(check_limit(trial, row, input, grade, error));
    eo_verify_uncompared(trial->v, eo_case_find(row, "limit_unrounded"),
                         "tolerances are computed as the standard rounds");
    double nominal = eo_case_number(row, "nominal"), si;
    memcpy(&si, (const char *)&trial->bench->nominal + input->offset, sizeof si);
    if (input->index < 0)
      eo_verify_derived(trial->v, eo_case_find(row, "nominal"), "the nominal flanks", si / input->unit, nominal, 1e-9);
  }
  return EO_OK;
}

static void read_columns(struct eo_tolerance_trial *trial, struct eo_case *columns)
{
  trial->columns = eo_case_size(columns);
  if (trial->columns <= trial->inputs || trial->columns > EO_TOLERANCE_COLUMNS)
    eo_case_fault(columns, "The inputs and then the outputs are expected here.");
  for (int i = 0; i < trial->columns && !eo_case_faulty(columns); i++) {
    struct eo_case *column = eo_case_at(columns, i);
    trial->name[i] = eo_case_is_text(column) ? eo_case_text(column) : "";
    trial->output[i] = i < trial->inputs ? -1 : eo_bench_output_find(trial->name[i]);
    if (i < trial->inputs ? strcmp(trial->name[i], trial->bench->input[i].name) != 0 : trial->output[i] < 0)
      eo_case_fault(column, "This is not the name of an input in the order of the variables, or of an output.");
  }
}

static enum eo_code read_rows(struct eo_tolerance_trial *trial, struct eo_case *samples, struct eo_error *error)
{
  struct eo_case *rows = eo_case_need(samples, "rows");
  trial->inputs = eo_case_whole(samples, "inputs", 1, EO_BENCH_INPUTS);
  trial->rows = eo_case_whole(samples, "listed", 2, 100000);
  eo_case_whole(samples, "drawn", trial->rows, 10000000);
  if (trial->inputs != trial->bench->inputs || eo_case_size(rows) != trial->rows)
    eo_case_fault(samples, "Inputs or rows are not as many as stated.");
  read_columns(trial, eo_case_need(samples, "columns"));
  if (eo_case_faulty(samples))
    return EO_OK;
  size_t n = (size_t)trial->rows, columns = (size_t)trial->columns, inputs = (size_t)trial->inputs;
  trial->input = malloc(sizeof *trial->input * n * (inputs + 2 * columns));
  if (!trial->input)
    return eo_error_memory(error);
  trial->listed = trial->input + n * inputs;
  trial->computed = trial->listed + n * columns;
  for (size_t i = 0; i < n; i++) {
    double row[EO_TOLERANCE_COLUMNS];
    if (eo_case_numbers(eo_case_at(rows, (int)i), trial->columns, EO_TOLERANCE_COLUMNS, row) < 0)
      return EO_OK;
    memcpy(trial->input + i * inputs, row, sizeof *row * inputs);
    for (size_t c = 0; c < columns; c++)
      trial->listed[c * n + i] = row[c];
  }
  return EO_OK;
}

/* Every row again. */
static void check_rows(struct eo_tolerance_trial *trial, struct eo_case *rows)
{
  for (int i = 0; i < trial->rows; i++) {
    double output[EO_BENCH_OUTPUTS];
    bool converged = eo_bench_evaluate(trial->bench, trial->input + (size_t)i * (size_t)trial->inputs, output);
    if (!converged)
      eo_verify_diverged(trial->v, eo_case_at(rows, i));
    for (int c = trial->inputs; c < trial->columns; c++) {
      double relative, absolute;
      row_tolerance(trial, trial->name[c], &relative, &absolute);
      trial->computed[(size_t)c * (size_t)trial->rows + (size_t)i] = output[trial->output[c]];
      if (converged)
        eo_verify_number(trial->v, eo_case_at(eo_case_at(rows, i), c), output[trial->output[c]], relative, absolute);
    }
  }
}

/* Of the nominal pair. */
static void check_nominal(struct eo_tolerance_trial *trial)
{
  struct eo_case *expected = eo_case_find(eo_case_find(trial->item, "nominal"), "expected");
  double output[EO_BENCH_OUTPUTS], relative, absolute;
  if (!eo_bench_evaluate(trial->bench, NULL, output))
    eo_verify_diverged(trial->v, expected);
  for (int i = 0; i < EO_BENCH_OUTPUTS; i++) {
    row_tolerance(trial, eo_bench_output_name(i), &relative, &absolute);
    eo_verify_member(trial->v, expected, eo_bench_output_name(i), output[i], relative, absolute);
  }
}

/* How the listed inputs fell: mean and second moment about the true mean, in standard errors. */
static void check_draw(const struct eo_tolerance_trial *trial, struct eo_case *block)
{
  for (int i = 0; i < trial->inputs && block; i++) {
    struct eo_moments moments = eo_distribution_moments(&trial->bench->input[i].distribution);
    double mean = 0, square = 0, root = sqrt(trial->rows);
    for (int row = 0; row < trial->rows; row++) {
      double z = (trial->input[(size_t)row * (size_t)trial->inputs + (size_t)i] - moments.mean) / moments.deviation;
      mean += z / root;
      square += (z * z - 1) / (root * sqrt(moments.fourth - 1));
    }
    double found[2] = {mean, square};
    eo_verify_list(trial->v, eo_case_need(block, trial->name[i]), 2, found, 1, 0, 0.0051);
  }
}

static void read_remarks(const struct eo_tolerance_trial *trial)
{
  static const char *const information[] = {"table_against_search", "discretisation"};
  struct eo_case *relations = eo_case_find(trial->item, "exact_relations");
  for (int i = 0; i < 2; i++)
    if (eo_case_find(trial->item, information[i]))
      eo_case_skip(eo_case_find(trial->item, information[i]));
  if (relations) {
    eo_case_skip(relations);
    eo_verify_note(trial->v,
                   "exact_relations, table_against_search, discretisation are for information, not compared.");
  }
  eo_case_remark(trial->tolerance, "statistics_of_listed_outputs");
  eo_case_remark(trial->tolerance, "own_samples");
}

static enum eo_code run_trial(struct eo_tolerance_trial *trial, struct eo_error *error)
{
  struct eo_case *variables = eo_case_need(trial->item, "variables"), *samples = eo_case_need(trial->item, "samples");
  trial->tolerance = eo_case_find(trial->item, "tolerance");
  trial->statistics = eo_case_need(trial->item, "statistics");
  read_remarks(trial);
  EO_TRY(eo_bench_read(trial->bench, trial->item, eo_case_need(trial->item, "nominal"), error));
  if (!eo_case_faulty(trial->item))
    eo_bench_read_inputs(trial->bench, variables);
  if (eo_case_faulty(trial->item))
    return EO_OK;
  EO_TRY(check_variables(trial, variables, error));
  EO_TRY(read_rows(trial, samples, error));
  if (eo_case_faulty(trial->item))
    return EO_OK;
  check_nominal(trial);
  check_rows(trial, eo_case_find(samples, "rows"));
  check_draw(trial, eo_case_find(trial->item, "draw_check"));
  return eo_verify_tolerance_statistics(trial, error);
}

static enum eo_code run_case(void *context, struct eo_case *item, struct eo_error *error)
{
  struct eo_tolerance_bench *bench = context;
  struct eo_tolerance_trial trial = {.bench = bench, .v = bench->v, .item = item};
  eo_case_remark(item, "id");
  enum eo_code code = run_trial(&trial, error);
  free(trial.input);
  return code;
}

static enum eo_code check_pairs(void *context, struct eo_case *pairs, struct eo_error *error)
{
  const struct eo_tolerance_bench *bench = context;
  return eo_verify_deviation_pairs(bench->v, pairs, error);
}

static const struct eo_verify_block blocks[] = {
    {"pairs", EO_BLOCK_EITHER, check_pairs},
    {"statistics", EO_BLOCK_INPUT, NULL},
    {"cases", EO_BLOCK_EACH, run_case},
    {"analytic", EO_BLOCK_EACH, eo_verify_tolerance_analytic},
    {NULL, EO_BLOCK_INPUT, NULL},
};

enum eo_code eo_verify_tolerance(struct eo_case *file, struct eo_verification *verification, struct eo_error *error)
{
  struct eo_tolerance_bench *bench = calloc(1, sizeof *bench);
  struct eo_case *words = eo_case_find(file, "conventions"), *rules = eo_case_find(file, "statistics");
  struct eo_case *form = words ? eo_case_find(words, "closed_form_flexibility") : NULL;
  if (!bench)
    return eo_error_memory(error);
  bench->file = file;
  bench->v = verification;
  for (int i = 0; i < eo_case_size(rules); i++)
    eo_case_text(eo_case_at(rules, i)); /* words alone */
  if (form)
    eo_case_closed_form(form, &bench->form);
  else
    eo_case_fault(file, "The closed-form flexibility is stated in \"conventions\".");
  enum eo_code code = eo_case_faulty(file) ? EO_OK : eo_verify_blocks(verification, file, blocks, bench, error);
  eo_bench_done(bench);
  free(bench);
  return code;
}
