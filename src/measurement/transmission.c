/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/transmission_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double UNSTEADY = 0.02; /* range of the speed of whole turns, relative: an acceleration changes by 4 % */

enum eo_code eo_order_fit_each_row(struct eo_order_fit *fit, eo_order_fit_row *function, const char *what,
                                   struct eo_error *error)
{
  int64_t total = fit->last - fit->first + 1;
  for (int64_t done = 0; done < total; done += EO_ORDER_FIT_BLOCK) {
    int count = total - done < EO_ORDER_FIT_BLOCK ? (int)(total - done) : EO_ORDER_FIT_BLOCK;
    enum eo_code code = eo_angles_read(fit->angles, fit->first + done, count, fit->rows[0], error);
    if (!code && eo_progress_report(fit->progress, what, (double)done / (double)total))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    for (int i = 0; i < count && !code; i++)
      code = function(fit, fit->rows[i], fit->first + done + i, error);
    if (code)
      return code;
  }
  return EO_OK;
}

double eo_order_fit_error(const struct eo_order_fit *fit, const double row[3])
{
  /* theory (M1) */
  return fit->axis.sign *
         (fit->settings->base_radius[EO_GEAR] * row[2] - fit->settings->base_radius[EO_PINION] * row[1]);
}

static int greatest_divisor(int a, int b)
{
  return b ? greatest_divisor(b, a % b) : a;
}

/* Whole hunting periods, or whole turns of the gear, keep shaft orders and sidebands out of the mesh orders. */
static void choose_turns(struct eo_order_fit *fit)
{
  const int *teeth = fit->settings->teeth;
  double turns = (fit->to - fit->from) / (2 * M_PI), gear = turns * teeth[EO_PINION] / teeth[EO_GEAR], whole = turns;
  fit->result->hunting = teeth[EO_GEAR] / greatest_divisor(teeth[0], teeth[1]);
  double hunting = floor(turns / fit->result->hunting) * fit->result->hunting;
  if (hunting > 0.9 * turns)
    whole = hunting;
  else if (gear >= 4)
    whole = floor(gear) * teeth[EO_GEAR] / teeth[EO_PINION];
  fit->turns = whole;
  fit->to = fit->from + 2 * M_PI * whole;
}

/* The time at which the counted turns end, between the last two rows around it; noise of the readings. */
static enum eo_code look(struct eo_order_fit *fit, const double row[3], int64_t index, struct eo_error *error)
{
  double theta = eo_axis_angle(&fit->axis, row[1]);
  (void)index;
  (void)error;
  eo_axis_noise_add(&fit->noise, row[0], row[1]);
  if (theta <= fit->to)
    fit->end = row[0];
  return EO_OK;
}

/* The rows of the part, their direction, and the turns that count. */
static enum eo_code choose_rows(struct eo_order_fit *fit, struct eo_error *error)
{
  const struct eo_part *part = &fit->result->parts.measured;
  double first[3], last[3], begin[3];
  fit->first = part->first;
  fit->last = part->last;
  enum eo_code code = eo_angles_read(fit->angles, 0, 1, begin, error);
  if (!code)
    code = eo_angles_read(fit->angles, fit->first, 1, first, error);
  if (!code)
    code = eo_angles_read(fit->angles, fit->last, 1, last, error);
  if (code)
    return code;
  fit->origin = begin[0];
  fit->axis = (struct eo_axis){.sign = last[1] < first[1] ? -1 : 1,
                               .ratio = {1, (double)fit->settings->teeth[EO_PINION] / fit->settings->teeth[EO_GEAR]}};
  fit->from = eo_axis_angle(&fit->axis, first[1]);
  fit->to = eo_axis_angle(&fit->axis, last[1]);
  fit->start = first[0];
  fit->mean_speed = (fit->to - fit->from) / (last[0] - first[0]);
  choose_turns(fit);
  if (fit->axis.sign < 0)
    eo_findings_add(
        fit->findings, EO_FINDING_REVERSED, EO_SEVERITY_NOTE, -1, part->turns,
        "The part that is measured turns the other way: the flanks that carry there may be the other ones.");
  return eo_order_fit_each_row(fit, look, "axis", error);
}

static void measure_speed(struct eo_order_fit *fit)
{
  struct eo_transmission *result = fit->result;
  result->seconds = fit->end - fit->start;
  result->revolutions[EO_PINION] = fit->turns;
  result->revolutions[EO_GEAR] = fit->turns * fit->settings->teeth[EO_PINION] / fit->settings->teeth[EO_GEAR];
  result->speed = fit->mean_speed;
  result->speed_low = fmin(result->parts.measured.speed_low, result->speed);
  result->speed_high = fmax(result->parts.measured.speed_high, result->speed);
}

/* Rows whose number per turn is a multiple of the teeth: orders beyond half of the rate look like those below it. Said
   where the lowest of them is one that a pair may well have. */
static void judge_folding(struct eo_order_fit *fit)
{
  double interval = fmax(fit->angles->interval, fit->angles->interpolated.step);
  int teeth = fit->settings->teeth[EO_PINION];
  double per_turn = 2 * M_PI / (interval * fit->result->speed);
  double multiple = round(per_turn / teeth), lowest = multiple - fit->result->harmonics;
  if (fabs(per_turn - multiple * teeth) * fit->turns < 1 && lowest <= 2 * EO_USUAL_ORDERS)
    eo_findings_add(
        fit->findings, EO_FINDING_SAMPLE_RATE, EO_SEVERITY_WARNING, -1, per_turn,
        "%.4g samples per turn of the pinion are %.0f times its %d teeth: the mesh order %.0f looks like order %.0f at "
        "these rows, and so on down to the first; what the pair has of them is in the orders below. Record at another "
        "rate.",
        per_turn, multiple, teeth, lowest, multiple - lowest);
}

static void judge_axis(struct eo_order_fit *fit)
{
  struct eo_transmission *result = fit->result;
  double interval = fmax(fit->angles->interval, fit->angles->interpolated.step);
  double per_turn = 2 * M_PI / (interval * result->speed_high); /* where the shaft is fastest */
  double turns = result->revolutions[EO_PINION], gear = result->revolutions[EO_GEAR],
         swing = (result->speed_high - result->speed_low) / result->speed;
  int possible = (int)(0.45 * per_turn / fit->settings->teeth[EO_PINION]);
  fit->possible = possible < EO_MESH_ORDERS ? possible : EO_MESH_ORDERS;
  result->asked = fit->settings->harmonics ? fit->settings->harmonics : EO_USUAL_ORDERS;
  result->asked = result->asked < 1 ? 1 : result->asked > EO_MESH_ORDERS ? EO_MESH_ORDERS : result->asked;
  result->harmonics = result->asked < possible ? result->asked : possible;
  if (turns < 3 || gear < 1.5)
    eo_findings_add(
        fit->findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_REFUSED, -1, turns,
        "The recording covers %.3g turns of the pinion and %.3g of the gear; shaft orders need at least 3 and 1.5.",
        turns, gear);
  else if (gear < 5)
    eo_findings_add(
        fit->findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_WARNING, -1, turns,
        "The recording covers only %.3g turns of the pinion and %.3g of the gear; a hunting period is %d turns.", turns,
        gear, result->hunting);
  if (swing > UNSTEADY)
    eo_findings_add(fit->findings, EO_FINDING_UNSTEADY, EO_SEVERITY_WARNING, -1, swing,
                    "The speed of whole turns goes from %.5g to %.5g rpm, %.2g %% of its mean; amplitudes are means of "
                    "all turns, accelerations are stated for %.6g rpm.",
                    30 / M_PI * result->speed_low, 30 / M_PI * result->speed_high, 100 * swing,
                    30 / M_PI * result->speed);
  if (result->harmonics < result->asked)
    eo_findings_add(fit->findings, EO_FINDING_SAMPLE_RATE,
                    result->harmonics ? EO_SEVERITY_WARNING : EO_SEVERITY_REFUSED, -1, per_turn,
                    "%.4g samples per turn of the pinion carry %d mesh orders of %d teeth, not the %d wanted.",
                    per_turn, result->harmonics, fit->settings->teeth[EO_PINION], result->asked);
  if (result->harmonics)
    judge_folding(fit);
}

static enum eo_code add_to_fit(struct eo_order_fit *fit, const double row[3], int64_t index, struct eo_error *error)
{
  double theta = eo_axis_angle(&fit->axis, row[1]), *terms = eo_normal_row(&fit->normal);
  (void)index;
  (void)error;
  if (theta < fit->from || theta > fit->to)
    return EO_OK;
  eo_terms_at(&fit->terms, row[0], theta, terms);
  terms[fit->terms.count] = eo_order_fit_error(fit, row);
  eo_normal_add(&fit->normal);
  return EO_OK;
}

enum eo_code eo_order_fit_solve(struct eo_order_fit *fit, struct eo_error *error)
{
  enum eo_code code = eo_normal_init(&fit->normal, fit->terms.count, error);
  if (!code)
    code = eo_order_fit_each_row(fit, add_to_fit, "orders", error);
  if (!code)
    code = eo_normal_solve(&fit->normal, fit->coefficient, &fit->result->condition, error);
  fit->result->rows = fit->normal.rows;
  eo_normal_done(&fit->normal);
  return code;
}

double complex eo_order_fit_amplitude(const struct eo_order_fit *fit, int at)
{
  const double *c = fit->coefficient + fit->terms.drift + 2 * at;
  return c[0] - I * c[1];
}

/* The parts of the transmission error at a row: drift, mesh orders, shaft orders. */
static void find_parts(const struct eo_order_fit *fit, const double row[3], double theta, double part[3])
{
  double value[EO_MOST_TERMS];
  int mesh_end = fit->terms.drift + 2 * fit->result->harmonics;
  eo_terms_at(&fit->terms, row[0], theta, value);
  part[0] = part[1] = part[2] = 0;
  for (int i = 0; i < fit->terms.count; i++)
    part[i < fit->terms.drift ? 0 : i < mesh_end ? 1 : 2] += value[i] * fit->coefficient[i];
}

bool eo_order_fit_residual(const struct eo_order_fit *fit, const double row[3], double *theta, double part[3],
                           double *residual)
{
  *theta = eo_axis_angle(&fit->axis, row[1]);
  if (*theta < fit->from || *theta > fit->to)
    return false;
  find_parts(fit, row, *theta, part);
  *residual = eo_order_fit_error(fit, row) - part[0] - part[1] - part[2];
  return true;
}

static enum eo_code add_residual(struct eo_order_fit *fit, const double row[3], int64_t index, struct eo_error *error)
{
  double theta, part[3], residual;
  (void)error;
  if (!eo_order_fit_residual(fit, row, &theta, part, &residual))
    return EO_OK;
  fit->result->residual += residual * residual;
  eo_beside_add(&fit->beside, theta, residual);
  eo_synchronous_add(fit->synchronous, index, theta, part[1], part[2], residual);
  if (fit->waterfall)
    eo_waterfall_add(fit->waterfall, row[0] - fit->origin, theta, residual);
  return EO_OK;
}

static void judge_result(struct eo_order_fit *fit)
{
  struct eo_transmission *result = fit->result;
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < 512; i++) {
    double value = eo_transmission_mesh(result, i / 512.0);
    low = fmin(low, value);
    high = fmax(high, value);
  }
  result->mesh_peak_to_peak = result->harmonics ? high - low : 0;
  if (result->rms_sigma > 0.25 * result->rms)
    eo_findings_add(fit->findings, EO_FINDING_RESOLUTION, EO_SEVERITY_WARNING, -1, result->rms_sigma,
                    "The mesh orders drown in noise or quantisation: RMS %.3g m/s2 with a standard deviation of %.3g.",
                    result->rms, result->rms_sigma);
  if (result->step != 0)
    eo_findings_add(fit->findings, EO_FINDING_SLIP, EO_SEVERITY_WARNING, -1, 1e6 * result->step,
                    "The transmission error changes its level by %.3g um about row %lld: lost counts, or a shaft "
                    "coupling that moved.",
                    1e6 * result->step, (long long)result->step_row + 1)
        ->row = result->step_row;
}

static bool refused(const struct eo_order_fit *fit)
{
  return eo_findings_worst(fit->findings) == EO_SEVERITY_REFUSED;
}

static enum eo_code run_fit(struct eo_order_fit *fit, struct eo_error *error)
{
  eo_terms_init(&fit->terms, fit->settings->teeth, fit->result->harmonics, fit->turns, fit->start, fit->end);
  eo_beside_init(&fit->beside, fit->settings->teeth, fit->result->harmonics, fit->turns);
  EO_TRY(eo_order_fit_solve(fit, error));
  EO_TRY(eo_order_fit_settle_axis(fit, error));
  eo_beside_init(&fit->beside, fit->settings->teeth, fit->result->harmonics, fit->turns);
  EO_TRY(eo_synchronous_new(&fit->synchronous, fit->result, fit->settings->teeth, fit->from, fit->turns, error));
  EO_TRY(eo_waterfall_new(&fit->waterfall, fit->result, fit->settings->teeth, fit->from, error));
  return eo_order_fit_each_row(fit, add_residual, "residual", error);
}

static enum eo_code measure(struct eo_order_fit *fit, struct eo_error *error)
{
  struct eo_transmission *result = fit->result;
  EO_TRY(eo_parts_find(&result->parts, fit->angles, &fit->settings->part, fit->findings, fit->progress, error));
  if (refused(fit))
    return EO_OK;
  EO_TRY(choose_rows(fit, error));
  measure_speed(fit);
  judge_axis(fit);
  if (refused(fit))
    return EO_OK;
  EO_TRY(run_fit(fit, error));
  result->residual = sqrt(result->residual / (double)result->rows);
  eo_order_fit_read_lines(fit);
  EO_TRY(eo_order_fit_judge_images(fit, error));
  EO_TRY(eo_synchronous_finish(fit->synchronous, result, error));
  EO_TRY(eo_waterfall_finish(fit->waterfall, result, error));
  judge_result(fit);
  return EO_OK;
}

enum eo_code eo_transmission_measure(struct eo_transmission *result, const struct eo_angles *angles,
                                     const struct eo_transmission_settings *settings, struct eo_findings *findings,
                                     const struct eo_progress *progress, struct eo_error *error)
{
  struct eo_order_fit *fit = calloc(1, sizeof *fit);
  memset(result, 0, sizeof *result);
  if (!fit)
    return eo_error_memory(error);
  fit->angles = angles;
  fit->settings = settings;
  fit->findings = findings;
  fit->progress = progress;
  fit->result = result;
  enum eo_code code = EO_OK;
  if (angles->rows < 64)
    eo_findings_add(findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_REFUSED, -1, (double)angles->rows,
                    "The recording has only %lld rows that can be used%s.", (long long)angles->rows,
                    settings->part.from > 0 || settings->part.to > 0 ? " in the times asked for" : "");
  else
    code = measure(fit, error);
  eo_normal_done(&fit->normal);
  eo_synchronous_free(fit->synchronous);
  eo_waterfall_free(fit->waterfall);
  free(fit);
  return code;
}
