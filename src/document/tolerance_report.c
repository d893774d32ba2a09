/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the rows of a run to what they say. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "design/made_teeth.h"
#include "document/scatter_distance.h"
#include "document/tolerance_document.h"
#include "evaluation/scatter_levels.h"
#include "tolerance/response_surface.h"

struct eo_scatter_plan eo_tolerance_plan(const struct eo_tolerance_settings *tolerance_settings)
{
  return (struct eo_scatter_plan){.pairs = tolerance_settings->pairs,
                                  .sampling = (enum eo_sampling)tolerance_settings->sampling,
                                  .seed = tolerance_settings->seed,
                                  .vibration = tolerance_settings->vibration,
                                  .root_stress = tolerance_settings->root_stress};
}

double eo_tolerance_memory(const struct eo_design *design, const struct eo_scatter *scatter)
{
  double pairs = design->tolerance.pairs, levels = eo_scatter_is_coarse_first(design) ? 2 : 1,
         numbers = (1 + levels) * eo_scatter_outputs(design) + 3. * scatter->inputs + 2;
  return sizeof(double) * pairs * numbers + eo_surface_memory(design->tolerance.pairs, scatter->inputs) +
         eo_scatter_distance_memory(scatter, design);
}

static double value_at(const struct eo_scatter_run *run, int pair, int scalar, int load_case)
{
  return run->output[(size_t)pair * (size_t)run->outputs + (size_t)(scalar * run->cases + load_case)];
}

enum { OUTPUT_NAMES = 358 };

/* What the pairs have, of single ends or without; returns its length, which may be more than there is room for. */
static size_t list_outputs(const struct eo_tolerance_settings *settings, bool ends, char names[OUTPUT_NAMES])
{
  size_t length = 0;
  int computed = (settings->vibration ? EO_SCALAR_VIBRATION : 0) | (settings->root_stress ? EO_SCALAR_ROOT : 0) |
                 (settings->single_teeth ? EO_SCALAR_TEETH : 0);
  for (int i = 0; i < EO_ALL_SCALARS && length < OUTPUT_NAMES; i++) {
    const struct eo_scalar *scalar = eo_scalar_at(i);
    if (!(scalar->needs & ~computed) && (ends || scalar->end < 0 || scalar->needs & EO_SCALAR_TEETH))
      length += (size_t)snprintf(names + length, OUTPUT_NAMES - length, "%s%s", length ? ", " : "", scalar->key);
  }
  return length;
}

/* An error has no room for those of single ends beside all of the hunting period. */
static enum eo_code refuse_output(const struct eo_tolerance_settings *settings, const char *asked, const char *pointer,
                                  struct eo_error *error)
{
  char names[OUTPUT_NAMES];
  if (list_outputs(settings, true, names) >= OUTPUT_NAMES)
    list_outputs(settings, false, names);
  return eo_error_set(error, EO_ERROR_INPUT, pointer, "There is no output \"%.16s\": %s.", asked, names);
}

static enum eo_code check_limit(const struct eo_tolerance_limit *limit, const struct eo_design *design, int index,
                                struct eo_error *error)
{
  char pointer[64];
  int scalar = eo_scalar_find(limit->output), cases = design->load_cases;
  snprintf(pointer, sizeof pointer, "/tolerance/limits/%d/output", index);
  if (scalar < 0)
    return refuse_output(&design->tolerance, limit->output, pointer, error);
  if (eo_scalar_at(scalar)->needs & EO_SCALAR_TEETH && !design->tolerance.single_teeth)
    return eo_error_set(error, EO_ERROR_INPUT, pointer,
                        "%s is a number of the hunting period, which is computed with \"single_teeth\": true.",
                        limit->output);
  if (eo_scalar_at(scalar)->needs & EO_SCALAR_ROOT && !design->tolerance.root_stress)
    return eo_error_set(error, EO_ERROR_INPUT, pointer,
                        "%s is a root stress, which is computed with \"root_stress\": true.", limit->output);
  if (eo_scalar_at(scalar)->needs & EO_SCALAR_VIBRATION && !design->tolerance.vibration)
    return eo_error_set(error, EO_ERROR_INPUT, pointer,
                        "%s is a number of the vibration, which is computed with \"vibration\": true.", limit->output);
  snprintf(pointer, sizeof pointer, "/tolerance/limits/%d/load_case", index);
  if (limit->load_case > cases)
    return eo_error_set(error, EO_ERROR_INPUT, pointer, "There is no load case %d of %d.", limit->load_case, cases);
  return EO_OK;
}

enum eo_code eo_tolerance_check_limits(const struct eo_design *design, struct eo_error *error)
{
  const struct eo_tolerance_settings *tolerance_settings = &design->tolerance;
  for (int i = 0; i < tolerance_settings->limits; i++)
    EO_TRY(check_limit(&tolerance_settings->limit[i], design, i, error));
  return EO_OK;
}

/* How far a pair is beyond a limit, over the limit: at most 0 when it is met; infinite where it has no number. */
static double beyond(const struct eo_scatter_run *run, const struct eo_tolerance_limit *limit, int pair)
{
  int scalar = eo_scalar_find(limit->output);
  double worst = -INFINITY, scale = limit->most != 0 ? fabs(limit->most) : 1;
  for (int k = 0; k < run->cases; k++) {
    double value = value_at(run, pair, scalar, k);
    if (limit->load_case == 0 || limit->load_case == k + 1)
      worst = isfinite(value) ? fmax(worst, (value - limit->most) / scale) : INFINITY;
  }
  return worst;
}

/* rows: as many pairs in full as leave the share as open; pairs where they all are. */
static void set_share(struct eo_yield_row *row, int inside, int pairs, int rows)
{
  int as_open = rows < pairs ? (int)lround((double)inside / pairs * rows) : inside;
  row->inside = inside;
  row->pairs = pairs;
  row->fraction = (double)inside / pairs;
  row->exact = eo_clopper_pearson(as_open, rows, 0.95);
  row->wilson = eo_wilson(as_open, rows, 0.95);
}

/* Of a limit at the load cases that it is for: those of the one that is most open. */
static enum eo_code rows_as_open(const struct eo_tolerance_report *report, const struct eo_tolerance_limit *limit,
                                 int *rows, struct eo_error *error)
{
  const struct eo_scatter_run *run = report->run;
  const struct eo_completion completion = eo_scatter_completion(run, report->design);
  *rows = run->pairs;
  for (int k = 0; run->coarse && k < run->cases; k++) {
    struct eo_doubt doubt;
    if (limit->load_case != 0 && limit->load_case != k + 1)
      continue;
    EO_TRY(
        eo_completion_share(&completion, eo_scalar_find(limit->output) * run->cases + k, limit->most, &doubt, error));
    if (doubt.rows < *rows)
      *rows = doubt.rows > 2 ? (int)doubt.rows : 2;
  }
  return EO_OK;
}

static enum eo_code count_yields(struct eo_tolerance_report *report, struct eo_error *error)
{
  const struct eo_tolerance_settings *tolerance_settings = &report->design->tolerance;
  const struct eo_scatter_run *run = report->run;
  int inside[EO_MAX_TOLERANCE_LIMITS + 1] = {0};
  EO_TRY(eo_tolerance_check_limits(report->design, error));
  for (int pair = 0; pair < run->pairs; pair++) {
    bool all = true;
    for (int i = 0; i < tolerance_settings->limits; i++) {
      bool met = beyond(run, &tolerance_settings->limit[i], pair) <= 0;
      inside[i] += met;
      all = all && met;
    }
    inside[tolerance_settings->limits] += all;
  }
  report->yields = tolerance_settings->limits > 0 ? tolerance_settings->limits + 1 : 0;
  int fewest = run->pairs;
  for (int i = 0; i < report->yields; i++) {
    struct eo_yield_row *row = &report->yield[i];
    int rows = fewest;
    if (i < tolerance_settings->limits)
      EO_TRY(rows_as_open(report, &tolerance_settings->limit[i], &rows, error));
    fewest = rows < fewest ? rows : fewest;
    *row = (struct eo_yield_row){.most = NAN};
    if (i < tolerance_settings->limits) {
      memcpy(row->output, tolerance_settings->limit[i].output, sizeof row->output);
      row->load_case = tolerance_settings->limit[i].load_case;
      row->most = tolerance_settings->limit[i].most;
    }
    set_share(row, inside[i], run->pairs, rows);
  }
  return EO_OK;
}

/* By which pairs are told apart where no limit is stated: the largest swing that was computed. */
static const char *swing_of(const struct eo_tolerance_report *report)
{
  return report->design->tolerance.single_teeth ? "period_peak_to_peak_um" : "peak_to_peak_um";
}

/* Largest excess over a limit; where none is stated the largest swing of the transmission error. */
static double badness(const struct eo_tolerance_report *report, int pair, int *limit)
{
  const struct eo_tolerance_settings *tolerance_settings = &report->design->tolerance;
  double worst = -INFINITY;
  int swing = eo_scalar_find(swing_of(report));
  *limit = -1;
  for (int i = 0; i < tolerance_settings->limits; i++) {
    double own = beyond(report->run, &tolerance_settings->limit[i], pair);
    if (isfinite(own) && own > worst) {
      worst = own;
      *limit = i;
    }
  }
  for (int k = 0; k < report->run->cases && tolerance_settings->limits == 0; k++) {
    double own = value_at(report->run, pair, swing, k);
    worst = isfinite(own) ? fmax(worst, own) : worst;
  }
  return worst;
}

static void find_worst(struct eo_tolerance_report *report)
{
  double worst = -INFINITY, speed;
  int limit, swing = eo_scalar_find("peak_to_peak_um");
  const char *name = swing_of(report);
  for (int pair = 0; pair < report->run->pairs; pair++) {
    double own = badness(report, pair, &limit);
    report->failed += isnan(value_at(report->run, pair, swing, 0));
    if (report->run->full[pair] && own > worst) {
      worst = own;
      report->worst = pair;
      name = limit >= 0 ? report->design->tolerance.limit[limit].output : swing_of(report);
    }
  }
  snprintf(report->worst_of, sizeof report->worst_of, "%s", name);
  report->worst_design = *report->design;
  eo_design_state_teeth(&report->worst_design);
  eo_scatter_apply(report->scatter, report->run->input + (size_t)report->worst * (size_t)report->run->inputs,
                   &report->worst_design, &report->worst_compliance, &speed);
  for (int k = 0; k < report->design->load_cases; k++)
    report->worst_design.load_case[k].speed *= speed;
  eo_table_round_to_document(&eo_design_table, &report->worst_design);
  memset(&report->worst_design.tolerance, 0, sizeof report->worst_design.tolerance);
  eo_table_defaults(&eo_tolerance_table, &report->worst_design.tolerance);
  snprintf(report->worst_design.name, sizeof report->worst_design.name, "%.150s%s %d as made", report->design->name,
           *report->design->name ? ", pair" : "Pair", report->worst + 1);
}

/* One number of all pairs; it is left out again where none has it. input: [pairs][quantities]. */
static enum eo_code report_output(struct eo_tolerance_report *report, int i, int quantities, const double *input,
                                  const struct eo_moments *moments, struct eo_error *error)
{
  const struct eo_scatter_run *run = report->run;
  const struct eo_completion completion = eo_scatter_completion(run, report->design);
  struct eo_report_completion completed = {.completion = &completion, .output = i};
  struct eo_tolerance_case *output = &report->output[report->outputs];
  *output = (struct eo_tolerance_case){
      .scalar = eo_scalar_at(i / run->cases), .load_case = i % run->cases, .nominal = run->nominal[i]};
  report->outputs++; /* so that it is freed */
  if (run->coarse)
    completed.completed = run->completed[i];
  EO_TRY(eo_output_report_make(&output->report, run->pairs, quantities, input, run->output + i, run->outputs, moments,
                               report->design->tolerance.seed, run->coarse ? &completed : NULL, error));
  if (output->report.rows > 0)
    return EO_OK;
  eo_output_report_done(&output->report);
  report->outputs--;
  return EO_OK;
}

static enum eo_code report_outputs(struct eo_tolerance_report *report, int quantities, const double *input,
                                   const struct eo_progress *progress, struct eo_error *error)
{
  const struct eo_scatter_run *run = report->run;
  struct eo_moments moments[EO_MAX_SCATTER_INPUTS];
  bool independent = eo_scatter_is_independent(report->scatter);
  for (int i = 0; i < quantities; i++)
    moments[i] = eo_scatter_moments(report->scatter, i);
  report->output = calloc((size_t)run->outputs, sizeof *report->output);
  if (!report->output)
    return eo_error_memory(error);
  for (int i = 0; i < run->outputs; i++) {
    if (eo_progress_report(progress, "statistics", (double)i / run->outputs))
      return eo_error_set(error, EO_ERROR_CANCELLED, "", "The analysis was stopped.");
    EO_TRY(report_output(report, i, quantities, input, independent ? moments : NULL, error));
  }
  return EO_OK;
}

/* What decides is asked of quantities alone. */
static enum eo_code report_quantities(struct eo_tolerance_report *report, const struct eo_progress *progress,
                                      struct eo_error *error)
{
  const struct eo_scatter_run *run = report->run;
  size_t quantities = (size_t)eo_scatter_quantities(report->scatter);
  double *input = malloc(sizeof *input * (size_t)run->pairs * quantities + 1);
  if (!input)
    return eo_error_memory(error);
  for (int pair = 0; pair < run->pairs; pair++)
    memcpy(input + (size_t)pair * quantities, run->input + (size_t)pair * (size_t)run->inputs,
           sizeof *input * quantities);
  enum eo_code code = report_outputs(report, (int)quantities, input, progress, error);
  free(input);
  return code;
}

enum eo_code eo_tolerance_report_new(struct eo_tolerance_report **result, const struct eo_design *design,
                                     const struct eo_scatter *scatter, const struct eo_scatter_run *run, bool assumed,
                                     const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_tolerance_report *report = calloc(1, sizeof *report);
  if (!report)
    return eo_error_memory(error);
  report->design = design;
  report->scatter = scatter;
  report->run = run;
  report->assumed = assumed;
  enum eo_code code = count_yields(report, error);
  if (!code)
    code = report_quantities(report, progress, error);
  if (!code)
    find_worst(report);
  if (code)
    eo_tolerance_report_free(report);
  else
    *result = report;
  return code;
}

void eo_tolerance_report_free(struct eo_tolerance_report *report)
{
  if (!report)
    return;
  for (int i = 0; i < report->outputs; i++)
    eo_output_report_done(&report->output[i].report);
  free(report->output);
  free(report);
}

/* The worst error of an output over the load cases. */
static double largest_error(const struct eo_tolerance_report *report, const char *key)
{
  double largest = NAN;
  for (int i = 0; i < report->outputs; i++)
    if (strcmp(report->output[i].scalar->key, key) == 0)
      largest = fmax(largest, report->output[i].report.coarse_error);
  return largest;
}

bool eo_tolerance_completion_note(const struct eo_tolerance_report *report, char note[EO_COMPLETION_NOTE])
{
  const struct eo_scatter_run *run = report->run;
  char rms[60] = "";
  bool teeth = report->design->tolerance.single_teeth;
  double error = largest_error(report, teeth ? "period_rms_m_per_s2" : "rms_m_per_s2");
  if (!run->coarse)
    return false;
  if (isfinite(error))
    snprintf(rms, sizeof rms, ", the RMS acceleration by %.2g m/s2", error);
  snprintf(
      note, EO_COMPLETION_NOTE,
      "%d of %d pairs were computed in full, the others on a coarse grid%s and corrected by these: a pair's "
      "peak-to-peak error%s is off by %.2g um%s (root mean square of pairs left out, worst load case). The intervals "
      "have this in them; the method \"full\" computes every pair.",
      eo_scatter_full_pairs(run), run->pairs, teeth ? " with fewer solutions for their teeth" : "",
      teeth ? " over the hunting period" : "", largest_error(report, swing_of(report)), rms);
  return true;
}

bool eo_tolerance_stopped_note(const struct eo_tolerance_report *report, char note[EO_STOPPED_NOTE])
{
  const struct eo_scatter_run *run = report->run;
  int asked = report->design->tolerance.pairs;
  if (!report->stopped || (!run->coarse && run->pairs == asked))
    return false;
  if (run->coarse)
    snprintf(
        note, EO_STOPPED_NOTE,
        "Stopped when %d of %d pairs had been computed in full, all of them coarsely: the intervals are those of so "
        "few.",
        eo_scatter_full_pairs(run), asked);
  else
    snprintf(note, EO_STOPPED_NOTE,
             "Stopped: these are the first %d of the %d pairs that were asked for, and the intervals are those of so "
             "few.",
             run->pairs, asked);
  return true;
}

void eo_tolerance_csv(const struct eo_tolerance_report *report, struct eo_text *text)
{
  const struct eo_scatter_run *run = report->run;
  eo_text_add(text, "pair");
  for (int i = 0; i < run->inputs; i++)
    eo_text_print(text, ",%s", report->scatter->input[i].key);
  for (int i = 0; i < run->outputs; i++)
    eo_text_print(text, ",load_cases.%d.%s", i % run->cases + 1, eo_scalar_at(i / run->cases)->key);
  eo_text_add(text, "\r\n");
  for (int pair = 0; pair < run->pairs; pair++) {
    if (!run->full[pair])
      continue;
    eo_text_print(text, "%d", pair + 1);
    for (int i = 0; i < run->inputs; i++)
      eo_text_print(text, ",%.12g", run->input[(size_t)pair * (size_t)run->inputs + (size_t)i]);
    for (int i = 0; i < run->outputs; i++) {
      double value = run->output[(size_t)pair * (size_t)run->outputs + (size_t)i];
      if (isfinite(value))
        eo_text_print(text, ",%.12g", value);
      else
        eo_text_add(text, ",");
    }
    eo_text_add(text, "\r\n");
  }
}
