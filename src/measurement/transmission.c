#include "measurement/transmission.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measurement/beside.h"
#include "measurement/synchronous.h"
#include "measurement/terms.h"

enum { BLOCK = 4096 };
static const double TREND_TURNS = 5; /* of the pinion, at least, and two of the gear, between knots */

struct worker {
  const struct eo_angles *angles;
  const struct eo_transmission_settings *settings;
  struct eo_findings *findings;
  const struct eo_progress *progress;
  struct eo_transmission *result;
  struct eo_trend trend;
  struct eo_terms terms;
  double coefficient[EO_MOST_TERMS];
  double from, to; /* smooth pinion angle of the rows that count, rad */
  double turns;    /* between them */
  double rows[BLOCK][3];
  struct eo_synchronous *synchronous;
  struct eo_beside beside;
};

static const int sideband_turns[EO_SIDEBANDS] = {-2, -1, 1, 2};

typedef enum eo_code row_function(struct worker *w, const double row[3], int64_t index, struct eo_error *error);

static enum eo_code each_row(struct worker *w, row_function *function, const char *what, struct eo_error *error)
{
  for (int64_t first = 0; first < w->angles->rows; first += BLOCK) {
    int count = w->angles->rows - first < BLOCK ? (int)(w->angles->rows - first) : BLOCK;
    enum eo_code code = eo_angles_read(w->angles, first, count, w->rows[0], error);
    if (!code && eo_progress_report(w->progress, what, (double)first / (double)w->angles->rows))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    for (int i = 0; i < count && !code; i++)
      code = function(w, w->rows[i], first + i, error);
    if (code)
      return code;
  }
  return EO_OK;
}

static double error_of(const struct worker *w, const double row[3])
{
  return w->settings->base_radius[EO_GEAR] * row[2] - w->settings->base_radius[EO_PINION] * row[1];
}

/* ---- the axis ---- */

static enum eo_code add_to_trend(struct worker *w, const double row[3], int64_t index, struct eo_error *error)
{
  (void)index;
  (void)error;
  eo_trend_add(&w->trend, row[0], row[1]);
  return EO_OK;
}

static enum eo_code fit_trend(struct worker *w, struct eo_error *error)
{
  double first[3], last[3], ratio = (double)w->settings->teeth[EO_GEAR] / w->settings->teeth[EO_PINION];
  int64_t rows = w->angles->rows;
  enum eo_code code = eo_angles_read(w->angles, 0, 1, first, error);
  if (!code)
    code = eo_angles_read(w->angles, rows - 1, 1, last, error);
  if (code)
    return code;
  double turns = (last[1] - first[1]) / (2 * M_PI), spacing = fmax(TREND_TURNS, 2 * ratio);
  int intervals = turns < 2 * spacing ? 1 : turns > 1e6 * spacing ? 1000000 : (int)(turns / spacing);
  code = eo_trend_start(&w->trend, first[0], last[0], intervals, first[1], (last[1] - first[1]) / (last[0] - first[0]),
                        error);
  if (!code)
    code = each_row(w, add_to_trend, "trend of the angle", error);
  if (!code)
    code = eo_trend_finish(&w->trend, error);
  if (code)
    return code;
  w->from = eo_trend_at(&w->trend, first[0], NULL);
  w->to = eo_trend_at(&w->trend, last[0], NULL);
  return EO_OK;
}

static int greatest_divisor(int a, int b)
{
  return b ? greatest_divisor(b, a % b) : a;
}

/* Whole hunting periods, or whole turns of the gear, keep shaft orders and sidebands out of the mesh orders. */
static void choose_turns(struct worker *w)
{
  const int *teeth = w->settings->teeth;
  double turns = (w->to - w->from) / (2 * M_PI), gear = turns * teeth[EO_PINION] / teeth[EO_GEAR], whole = turns;
  w->result->hunting = teeth[EO_GEAR] / greatest_divisor(teeth[0], teeth[1]);
  double hunting = floor(turns / w->result->hunting) * w->result->hunting;
  if (hunting > 0.9 * turns)
    whole = hunting;
  else if (gear >= 4)
    whole = floor(gear) * teeth[EO_GEAR] / teeth[EO_PINION];
  w->turns = whole;
  w->to = w->from + 2 * M_PI * whole;
}

static void measure_speed(struct worker *w)
{
  struct eo_transmission *r = w->result;
  double end = w->trend.start + w->trend.step * w->trend.intervals, low = w->trend.start, high = end;
  for (int i = 0; i < 60; i++) { /* the time at which the counted turns end */
    double middle = (low + high) / 2;
    if (eo_trend_at(&w->trend, middle, NULL) < w->to)
      low = middle;
    else
      high = middle;
  }
  r->seconds = high - w->trend.start;
  r->revolutions[EO_PINION] = w->turns;
  r->revolutions[EO_GEAR] = w->turns * w->settings->teeth[EO_PINION] / w->settings->teeth[EO_GEAR];
  r->speed = 2 * M_PI * w->turns / r->seconds;
  r->speed_low = INFINITY;
  r->speed_high = -INFINITY;
  for (int i = 0; i <= 2 * w->trend.intervals; i++) {
    double speed;
    eo_trend_at(&w->trend, w->trend.start + w->trend.step * i / 2, &speed);
    r->speed_low = fmin(r->speed_low, speed);
    r->speed_high = fmax(r->speed_high, speed);
  }
}

static void judge_axis(struct worker *w)
{
  struct eo_transmission *r = w->result;
  double per_turn = (double)w->angles->rows * 2 * M_PI / (w->trend.step * w->trend.intervals * r->speed);
  double turns = r->revolutions[EO_PINION], gear = r->revolutions[EO_GEAR],
         swing = (r->speed_high - r->speed_low) / r->speed;
  int possible = (int)(0.45 * per_turn / w->settings->teeth[EO_PINION]);
  r->asked = w->settings->harmonics ? w->settings->harmonics : 8;
  r->asked = r->asked < 1 ? 1 : r->asked > EO_MESH_ORDERS ? EO_MESH_ORDERS : r->asked;
  r->harmonics = r->asked < possible ? r->asked : possible;
  if (turns < 3 || gear < 1.5)
    eo_findings_add(
        w->findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_REFUSED, -1, turns,
        "The recording covers %.3g turns of the pinion and %.3g of the gear; shaft orders need at least 3 and 1.5.",
        turns, gear);
  else if (gear < 5)
    eo_findings_add(
        w->findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_WARNING, -1, turns,
        "The recording covers only %.3g turns of the pinion and %.3g of the gear; a hunting period is %d turns.", turns,
        gear, r->hunting);
  if (swing > 0.02)
    eo_findings_add(
        w->findings, EO_FINDING_UNSTEADY, swing > 0.5 ? EO_SEVERITY_REFUSED : EO_SEVERITY_WARNING, -1, swing,
        "The speed is not steady: %.5g to %.5g rpm, %.2g %% of its mean; accelerations are stated at %.6g rpm.",
        30 / M_PI * r->speed_low, 30 / M_PI * r->speed_high, 100 * swing, 30 / M_PI * r->speed);
  if (r->harmonics < r->asked)
    eo_findings_add(w->findings, EO_FINDING_SAMPLE_RATE, r->harmonics ? EO_SEVERITY_WARNING : EO_SEVERITY_REFUSED, -1,
                    per_turn,
                    "%.4g samples per turn of the pinion carry %d mesh orders of %d teeth, not the %d wanted.",
                    per_turn, r->harmonics, w->settings->teeth[EO_PINION], r->asked);
}

/* ---- the fit ---- */

static enum eo_code fit_terms(struct worker *w, struct eo_error *error)
{
  struct eo_normal normal;
  enum eo_code code = eo_normal_init(&normal, w->terms.count, error);
  for (int64_t first = 0; first < w->angles->rows && !code; first += BLOCK) {
    int count = w->angles->rows - first < BLOCK ? (int)(w->angles->rows - first) : BLOCK;
    code = eo_angles_read(w->angles, first, count, w->rows[0], error);
    if (!code && eo_progress_report(w->progress, "orders", (double)first / (double)w->angles->rows))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    for (int i = 0; i < count && !code; i++) {
      double theta = eo_trend_at(&w->trend, w->rows[i][0], NULL), *row = eo_normal_row(&normal);
      if (theta > w->to)
        continue;
      eo_terms_at(&w->terms, w->rows[i][0], theta, row);
      row[w->terms.count] = error_of(w, w->rows[i]);
      eo_normal_add(&normal);
    }
  }
  if (!code)
    code = eo_normal_solve(&normal, w->coefficient, &w->result->condition, error);
  w->result->rows = normal.rows;
  eo_normal_done(&normal);
  return code;
}

/* ---- the residual ---- */

static enum eo_code add_residual(struct worker *w, const double row[3], int64_t index, struct eo_error *error)
{
  double value[EO_MOST_TERMS], theta = eo_trend_at(&w->trend, row[0], NULL), smooth = 0, mesh = 0, shaft = 0;
  int mesh_end = w->terms.drift + 2 * w->result->harmonics;
  (void)error;
  if (theta > w->to)
    return EO_OK;
  eo_terms_at(&w->terms, row[0], theta, value);
  for (int i = 0; i < w->terms.drift; i++)
    smooth += value[i] * w->coefficient[i];
  for (int i = w->terms.drift; i < mesh_end; i++)
    mesh += value[i] * w->coefficient[i];
  for (int i = mesh_end; i < w->terms.count; i++)
    shaft += value[i] * w->coefficient[i];
  double residual = error_of(w, row) - smooth - mesh - shaft;
  w->result->residual += residual * residual;
  eo_beside_add(&w->beside, theta, residual);
  eo_synchronous_add(w->synchronous, index, theta, mesh, shaft, residual);
  return EO_OK;
}

/* ---- what it says ---- */

static struct eo_order_line line_of(const struct worker *w, int at)
{
  double order = w->terms.order[at], speed = w->result->speed;
  const double *c = w->coefficient + w->terms.drift + 2 * at;
  double complex amplitude = c[0] - I * c[1];
  return (struct eo_order_line){
      .order = order, .amplitude = amplitude, .acceleration = order * order * speed * speed * cabs(amplitude)};
}

static void read_lines(struct worker *w)
{
  struct eo_transmission *r = w->result;
  double rows = (double)r->rows;
  for (int h = 0; h < r->harmonics; h++) {
    r->mesh[h] = line_of(w, h);
    r->mesh[h].sigma = eo_beside_sigma(&w->beside, h, r->residual);
    r->rms_upto[h] = eo_transmission_rms(r->mesh, h + 1, r->speed, &r->rms_sigma);
    for (int k = 0; k < 2 * EO_SIDEBANDS; k++) {
      int member = k / EO_SIDEBANDS, at = k % EO_SIDEBANDS;
      double shaft = member == EO_GEAR ? (double)w->settings->teeth[EO_PINION] / w->settings->teeth[EO_GEAR] : 1;
      double order = r->mesh[h].order + shaft * sideband_turns[at];
      double complex amplitude = eo_beside_sideband(&w->beside, h, member, sideband_turns[at]);
      r->sideband[h][member][at] = (struct eo_order_line){order, amplitude, r->mesh[h].sigma,
                                                          order * order * r->speed * r->speed * cabs(amplitude)};
    }
  }
  r->rms = r->harmonics ? r->rms_upto[r->harmonics - 1] : 0;
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < EO_SHAFT_ORDERS; k++) {
      r->separate[member][k] = w->terms.shaft_at[member][k] >= 0;
      double order = (k + 1) *
                     (member == EO_GEAR ? (double)w->settings->teeth[EO_PINION] / w->settings->teeth[EO_GEAR] : 1);
      r->shaft[member][k] = r->separate[member][k] ? line_of(w, w->terms.shaft_at[member][k])
                                                   : (struct eo_order_line){.order = order};
      r->shaft[member][k].sigma = sqrt(2) * r->residual / sqrt(rows);
    }
  memcpy(r->drift, w->coefficient, sizeof r->drift);
}

static void judge_result(struct worker *w)
{
  struct eo_transmission *r = w->result;
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < 512; i++) {
    double value = eo_transmission_mesh(r, i / 512.0);
    low = fmin(low, value);
    high = fmax(high, value);
  }
  r->mesh_peak_to_peak = r->harmonics ? high - low : 0;
  if (r->rms_sigma > 0.25 * r->rms)
    eo_findings_add(w->findings, EO_FINDING_RESOLUTION, EO_SEVERITY_WARNING, -1, r->rms_sigma,
                    "The mesh orders drown in noise or quantisation: RMS %.3g m/s2 with a standard deviation of %.3g.",
                    r->rms, r->rms_sigma);
  if (r->step != 0)
    eo_findings_add(w->findings, EO_FINDING_SLIP, EO_SEVERITY_WARNING, -1, 1e6 * r->step,
                    "The transmission error changes its level by %.3g um about row %lld: lost counts, or a shaft "
                    "coupling that moved.",
                    1e6 * r->step, (long long)r->step_row + 1)
        ->row = r->step_row;
}

double eo_transmission_mesh(const struct eo_transmission *r, double phase)
{
  double sum = 0;
  for (int h = 0; h < r->harmonics; h++)
    sum += creal(r->mesh[h].amplitude * cexp(2 * M_PI * I * (h + 1) * phase));
  return sum;
}

double eo_transmission_rms(const struct eo_order_line *line, int count, double omega, double *sigma)
{
  double square = 0, variance = 0;
  for (int i = 0; i < count; i++) {
    double weight = pow(line[i].order * omega, 4) / 2, noise = line[i].sigma * line[i].sigma;
    double signal = pow(cabs(line[i].amplitude), 2) - 2 * noise;
    square += weight * signal;
    variance += weight * weight * 4 * noise * (fmax(signal, 0) + noise);
  }
  square = fmax(square, 0);
  double rms = sqrt(square), spread = sqrt(variance);
  double above = sqrt(square + spread) - rms, below = (rms - sqrt(fmax(0, square - 2 * spread))) / 2;
  *sigma = hypot(fmax(above, below), EO_RMS_SYSTEMATIC * rms);
  return rms;
}

static bool refused(const struct worker *w)
{
  return eo_findings_worst(w->findings) == EO_SEVERITY_REFUSED;
}

static enum eo_code measure(struct worker *w, struct eo_error *error)
{
  enum eo_code code = fit_trend(w, error);
  if (code)
    return code;
  if (!(w->to > w->from)) {
    eo_findings_add(w->findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_REFUSED, -1, 0, "The pinion does not turn.");
    return EO_OK;
  }
  choose_turns(w);
  measure_speed(w);
  judge_axis(w);
  if (refused(w))
    return EO_OK;
  eo_terms_init(&w->terms, w->settings->teeth, w->result->harmonics, w->turns, w->trend.start,
                w->trend.start + w->result->seconds);
  eo_beside_init(&w->beside, w->settings->teeth, w->result->harmonics, w->turns);
  code = fit_terms(w, error);
  if (!code)
    code = eo_synchronous_new(&w->synchronous, w->result, w->settings->teeth, w->from, w->turns, error);
  if (!code)
    code = each_row(w, add_residual, "residual", error);
  if (code)
    return code;
  w->result->residual = sqrt(w->result->residual / (double)w->result->rows);
  read_lines(w);
  code = eo_synchronous_finish(w->synchronous, w->result, error);
  if (!code)
    judge_result(w);
  return code;
}

enum eo_code eo_transmission_measure(struct eo_transmission *result, const struct eo_angles *angles,
                                     const struct eo_transmission_settings *settings, struct eo_findings *findings,
                                     const struct eo_progress *progress, struct eo_error *error)
{
  struct worker *w = calloc(1, sizeof *w);
  memset(result, 0, sizeof *result);
  if (!w)
    return eo_error_memory(error);
  w->angles = angles;
  w->settings = settings;
  w->findings = findings;
  w->progress = progress;
  w->result = result;
  enum eo_code code = EO_OK;
  if (angles->rows < 64)
    eo_findings_add(findings, EO_FINDING_TOO_SHORT, EO_SEVERITY_REFUSED, -1, (double)angles->rows,
                    "The recording has only %lld rows that can be used.", (long long)angles->rows);
  else
    code = measure(w, error);
  eo_trend_done(&w->trend);
  eo_synchronous_free(w->synchronous);
  free(w);
  return code;
}

void eo_transmission_done(struct eo_transmission *result)
{
  free(result->spectrum);
  result->spectrum = NULL;
}
