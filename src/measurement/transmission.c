/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/transmission.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measurement/axis.h"
#include "measurement/beside.h"
#include "measurement/synchronous.h"
#include "measurement/terms.h"
#include "measurement/waterfall.h"

enum { BLOCK = 4096 };
static const double UNSTEADY = 0.02;   /* range of the speed of whole turns, relative: an acceleration changes by 4 % */
static const double SWING_KNOWN = 0.3; /* standard deviation of its share up to which the sidebands settle it */
static const double SWING_PRIOR = 0.5; /* standard deviation of the share where they do not */
static const double OWN_SHARE = 0.5, OWN_SIGMA = 0.29; /* of the vibration, at the pinion: 0 to 1, all alike */
static const double NOISE_KNOWN = 0.3; /* relative: noise from third differences, which is not white in every encoder */

struct worker {
  const struct eo_angles *angles;
  const struct eo_transmission_settings *settings;
  struct eo_findings *findings;
  const struct eo_progress *progress;
  struct eo_transmission *result;
  int64_t first, last; /* rows that are measured, both inside */
  double origin;       /* s, time of the first row of the recording */
  double start, end;   /* s, of the rows that count */
  struct eo_axis axis;
  struct eo_axis_noise noise;
  double share_sigma; /* of the swing that is taken out of the axis */
  double swing_sums[2];
  struct eo_terms terms;
  struct eo_normal normal;
  double coefficient[EO_MOST_TERMS];
  double mean_speed; /* of all rows of the part, rad/s */
  double from, to;   /* pinion angle of the rows that count, rad */
  double turns;      /* between them */
  double rows[BLOCK][3];
  struct eo_synchronous *synchronous;
  struct eo_waterfall *waterfall;
  struct eo_beside beside;
};

static const int sideband_turns[EO_SIDEBANDS] = {-2, -1, 1, 2};

typedef enum eo_code row_function(struct worker *w, const double row[3], int64_t index, struct eo_error *error);

static enum eo_code each_row(struct worker *w, row_function *function, const char *what, struct eo_error *error)
{
  int64_t total = w->last - w->first + 1;
  for (int64_t done = 0; done < total; done += BLOCK) {
    int count = total - done < BLOCK ? (int)(total - done) : BLOCK;
    enum eo_code code = eo_angles_read(w->angles, w->first + done, count, w->rows[0], error);
    if (!code && eo_progress_report(w->progress, what, (double)done / (double)total))
      code = eo_error_set(error, EO_ERROR_CANCELLED, "", "Stopped.");
    for (int i = 0; i < count && !code; i++)
      code = function(w, w->rows[i], w->first + done + i, error);
    if (code)
      return code;
  }
  return EO_OK;
}

static double error_of(const struct worker *w, const double row[3])
{
  return w->axis.sign * (w->settings->base_radius[EO_GEAR] * row[2] - w->settings->base_radius[EO_PINION] * row[1]);
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

/* The time at which the counted turns end, between the last two rows around it; noise of the readings. */
static enum eo_code look(struct worker *w, const double row[3], int64_t index, struct eo_error *error)
{
  double theta = eo_axis_angle(&w->axis, row[1]);
  (void)index;
  (void)error;
  eo_axis_noise_add(&w->noise, row[1]);
  if (theta <= w->to)
    w->end = row[0];
  return EO_OK;
}

/* The rows of the part, their direction, and the turns that count. */
static enum eo_code choose_rows(struct worker *w, struct eo_error *error)
{
  const struct eo_part *part = &w->result->parts.measured;
  double first[3], last[3], begin[3];
  w->first = part->first;
  w->last = part->last;
  enum eo_code code = eo_angles_read(w->angles, 0, 1, begin, error);
  if (!code)
    code = eo_angles_read(w->angles, w->first, 1, first, error);
  if (!code)
    code = eo_angles_read(w->angles, w->last, 1, last, error);
  if (code)
    return code;
  w->origin = begin[0];
  w->axis = (struct eo_axis){.sign = last[1] < first[1] ? -1 : 1};
  w->from = eo_axis_angle(&w->axis, first[1]);
  w->to = eo_axis_angle(&w->axis, last[1]);
  w->start = first[0];
  w->mean_speed = (w->to - w->from) / (last[0] - first[0]);
  choose_turns(w);
  if (w->axis.sign < 0)
    eo_findings_add(
        w->findings, EO_FINDING_REVERSED, EO_SEVERITY_NOTE, -1, part->turns,
        "The part that is measured turns the other way: the flanks that carry there may be the other ones.");
  return each_row(w, look, "axis", error);
}

static void measure_speed(struct worker *w)
{
  struct eo_transmission *r = w->result;
  r->seconds = w->end - w->start;
  r->revolutions[EO_PINION] = w->turns;
  r->revolutions[EO_GEAR] = w->turns * w->settings->teeth[EO_PINION] / w->settings->teeth[EO_GEAR];
  r->speed = w->mean_speed;
  r->speed_low = fmin(r->parts.measured.speed_low, r->speed);
  r->speed_high = fmax(r->parts.measured.speed_high, r->speed);
}

static void judge_axis(struct worker *w)
{
  struct eo_transmission *r = w->result;
  double per_turn = 2 * M_PI / (w->angles->interval * r->speed_high); /* where the shaft is fastest */
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
  if (swing > UNSTEADY)
    eo_findings_add(w->findings, EO_FINDING_UNSTEADY, EO_SEVERITY_WARNING, -1, swing,
                    "The speed of whole turns goes from %.5g to %.5g rpm, %.2g %% of its mean; amplitudes are means of "
                    "all turns, accelerations are stated for %.6g rpm.",
                    30 / M_PI * r->speed_low, 30 / M_PI * r->speed_high, 100 * swing, 30 / M_PI * r->speed);
  if (r->harmonics < r->asked)
    eo_findings_add(w->findings, EO_FINDING_SAMPLE_RATE, r->harmonics ? EO_SEVERITY_WARNING : EO_SEVERITY_REFUSED, -1,
                    per_turn,
                    "%.4g samples per turn of the pinion carry %d mesh orders of %d teeth, not the %d wanted.",
                    per_turn, r->harmonics, w->settings->teeth[EO_PINION], r->asked);
}

static enum eo_code add_to_fit(struct worker *w, const double row[3], int64_t index, struct eo_error *error)
{
  double theta = eo_axis_angle(&w->axis, row[1]), *terms = eo_normal_row(&w->normal);
  (void)index;
  (void)error;
  if (theta < w->from || theta > w->to)
    return EO_OK;
  eo_terms_at(&w->terms, row[0], theta, terms);
  terms[w->terms.count] = error_of(w, row);
  eo_normal_add(&w->normal);
  return EO_OK;
}

static enum eo_code fit_terms(struct worker *w, struct eo_error *error)
{
  enum eo_code code = eo_normal_init(&w->normal, w->terms.count, error);
  if (!code)
    code = each_row(w, add_to_fit, "orders", error);
  if (!code)
    code = eo_normal_solve(&w->normal, w->coefficient, &w->result->condition, error);
  w->result->rows = w->normal.rows;
  eo_normal_done(&w->normal);
  return code;
}

static double complex amplitude_of(const struct worker *w, int at)
{
  const double *c = w->coefficient + w->terms.drift + 2 * at;
  return c[0] - I * c[1];
}

/* The parts of the transmission error at a row: drift, mesh orders, shaft orders. */
static void parts_at(const struct worker *w, const double row[3], double theta, double part[3])
{
  double value[EO_MOST_TERMS];
  int mesh_end = w->terms.drift + 2 * w->result->harmonics;
  eo_terms_at(&w->terms, row[0], theta, value);
  part[0] = part[1] = part[2] = 0;
  for (int i = 0; i < w->terms.count; i++)
    part[i < w->terms.drift ? 0 : i < mesh_end ? 1 : 2] += value[i] * w->coefficient[i];
}

/* What a phase of the axis does to the mesh orders: their derivative, m/rad. */
static double mesh_slope(const struct worker *w, double theta)
{
  double complex mesh = cexp(I * w->settings->teeth[EO_PINION] * theta), power = 1, sum = 0;
  for (int h = 0; h < w->result->harmonics; h++)
    sum += I * w->terms.order[h] * amplitude_of(w, h) * (power *= mesh);
  return creal(sum);
}

static enum eo_code add_residual(struct worker *w, const double row[3], int64_t index, struct eo_error *error)
{
  double theta = eo_axis_angle(&w->axis, row[1]), part[3];
  (void)error;
  if (theta < w->from || theta > w->to)
    return EO_OK;
  parts_at(w, row, theta, part);
  double residual = error_of(w, row) - part[0] - part[1] - part[2];
  w->result->residual += residual * residual;
  eo_beside_add(&w->beside, theta, residual);
  eo_synchronous_add(w->synchronous, index, theta, part[1], part[2], residual);
  if (w->waterfall)
    eo_waterfall_add(w->waterfall, row[0] - w->origin, theta, residual);
  return EO_OK;
}

/* The fit of the share: what is left of the transmission error against what the swing would do to the mesh orders. */
static enum eo_code add_swing(struct worker *w, const double row[3], int64_t index, struct eo_error *error)
{
  double theta = eo_axis_angle(&w->axis, row[1]), part[3];
  (void)index;
  (void)error;
  if (theta < w->from || theta > w->to)
    return EO_OK;
  parts_at(w, row, theta, part);
  double residual = error_of(w, row) - part[0] - part[1] - part[2];
  double effect = mesh_slope(w, theta) * eo_axis_swing(&w->axis, theta);
  w->swing_sums[0] += residual * effect;
  w->swing_sums[1] += effect * effect;
  eo_beside_add(&w->beside, theta, residual);
  return EO_OK;
}

/* Shaft orders of the pinion in the transmission error come from its encoder, and then the axis has them too, or from
   the gears, and then it has not. The sidebands of the mesh orders tell: with the wrong axis the swing e leaves
   (d TE / d theta) e in the residual. Where they are too weak the encoder is taken for the cause, and what that changes
   is part of the uncertainty. */
static enum eo_code settle_axis(struct worker *w, struct eo_error *error)
{
  struct eo_axis *axis = &w->axis;
  for (int k = 0; k < EO_SHAFT_ORDERS; k++)
    axis->swing[k] = w->terms.shaft_at[EO_PINION][k] < 0
                         ? 0
                         : -amplitude_of(w, w->terms.shaft_at[EO_PINION][k]) / w->settings->base_radius[EO_PINION];
  axis->share = 1;
  enum eo_code code = fit_terms(w, error);
  if (!code)
    code = each_row(w, add_swing, "axis", error);
  if (code)
    return code;
  double noise = 0, wanted = 0;
  for (int h = 0; h < w->result->harmonics; h++) { /* of a row, from the noise beside the strongest orders */
    double weight = pow(w->terms.order[h] * cabs(amplitude_of(w, h)), 2);
    noise += weight * pow(eo_beside_sigma(&w->beside, h, 0), 2) * (double)w->result->rows / 2;
    wanted += weight;
  }
  double sigma = wanted > 0 && w->swing_sums[1] > 0 ? sqrt(noise / wanted / w->swing_sums[1]) : INFINITY;
  w->share_sigma = SWING_PRIOR;
  if (!(sigma < SWING_KNOWN))
    return EO_OK;
  double off = w->swing_sums[0] / w->swing_sums[1];
  w->share_sigma = sigma;
  if (off < 3 * sigma)
    return EO_OK;
  axis->share = fmax(0, 1 - off);
  return fit_terms(w, error);
}

static struct eo_order_line line_of(const struct worker *w, int at)
{
  double order = w->terms.order[at], speed = w->result->speed;
  double complex amplitude = amplitude_of(w, at);
  return (struct eo_order_line){
      .order = order, .amplitude = amplitude, .acceleration = order * order * speed * speed * cabs(amplitude)};
}

/* The axis shows the pinion's share s of the vibration f too, theta = reading + s f / r_b: what is fitted is
   f + s (f^2)' / (2 r_b). Its part at mesh order h + 1 for s = 1, m. */
static double complex own_vibration(const struct worker *w, int h)
{
  int orders = w->result->harmonics;
  double complex square = 0; /* of f^2 at that order */
  for (int j = 0; j < h; j++)
    square += amplitude_of(w, j) * amplitude_of(w, h - 1 - j) / 2;
  for (int j = 0; j + h + 1 < orders; j++)
    square += conj(amplitude_of(w, j)) * amplitude_of(w, j + h + 1);
  return I * w->terms.order[h] * square / (2 * w->settings->base_radius[EO_PINION]);
}

/* A mesh order, what noise of the axis takes away put back; how sure the axis is. */
static struct eo_order_line mesh_line(const struct worker *w, int h)
{
  struct eo_order_line line = line_of(w, h);
  double complex own = own_vibration(w, h);
  double in_phase = creal(own * conj(line.amplitude)) / fmax(cabs(line.amplitude), 1e-300);
  line.amplitude -= OWN_SHARE * own;
  line.acceleration = pow(line.order * w->result->speed, 2) * cabs(line.amplitude);
  double phase = line.order * w->result->axis_noise, left = exp(-phase * phase / 2);
  line.amplitude /= left;
  line.acceleration /= left;
  line.sigma = eo_beside_sigma(&w->beside, h, w->result->residual) / left;
  double swing = 1 - eo_axis_loss(&w->axis, line.order, w->share_sigma);
  line.systematic[0] = cabs(line.amplitude) * hypot(swing, NOISE_KNOWN * (1 - left));
  line.systematic[1] = OWN_SIGMA * in_phase;
  return line;
}

static void read_sidebands(struct worker *w, int h)
{
  struct eo_transmission *r = w->result;
  for (int k = 0; k < 2 * EO_SIDEBANDS; k++) {
    int member = k / EO_SIDEBANDS, at = k % EO_SIDEBANDS;
    double shaft = member == EO_GEAR ? (double)w->settings->teeth[EO_PINION] / w->settings->teeth[EO_GEAR] : 1;
    double order = r->mesh[h].order + shaft * sideband_turns[at];
    double complex amplitude = eo_beside_sideband(&w->beside, h, member, sideband_turns[at]);
    r->sideband[h][member][at] =
        (struct eo_order_line){.order = order,
                               .amplitude = amplitude,
                               .sigma = r->mesh[h].sigma,
                               .acceleration = order * order * r->speed * r->speed * cabs(amplitude)};
  }
}

/* How much smaller the RMS would be on the axis as it was read. */
static double axis_bias(const struct worker *w)
{
  const struct eo_transmission *r = w->result;
  double with = 0, without = 0;
  for (int h = 0; h < r->harmonics; h++) {
    double phase = r->mesh[h].order * r->axis_noise, square = pow(r->mesh[h].acceleration, 2);
    with += square;
    without += square * pow(eo_axis_loss(&w->axis, r->mesh[h].order, w->axis.share) * exp(-phase * phase / 2), 2);
  }
  return with > 0 ? 1 - sqrt(without / with) : 0;
}

static void read_lines(struct worker *w)
{
  struct eo_transmission *r = w->result;
  r->axis_noise = eo_axis_noise_sigma(&w->noise);
  r->axis_swing = w->axis.share * cabs(w->axis.swing[0]);
  for (int h = 0; h < r->harmonics; h++) {
    r->mesh[h] = mesh_line(w, h);
    r->rms_upto[h] = eo_transmission_rms(r->mesh, h + 1, r->speed, &r->rms_sigma);
    read_sidebands(w, h);
  }
  r->axis_bias = axis_bias(w);
  r->rms = r->harmonics ? r->rms_upto[r->harmonics - 1] : 0;
  for (int member = 0; member < 2; member++)
    for (int k = 0; k < EO_SHAFT_ORDERS; k++) {
      r->separate[member][k] = w->terms.shaft_at[member][k] >= 0;
      double order = (k + 1) *
                     (member == EO_GEAR ? (double)w->settings->teeth[EO_PINION] / w->settings->teeth[EO_GEAR] : 1);
      r->shaft[member][k] = r->separate[member][k] ? line_of(w, w->terms.shaft_at[member][k])
                                                   : (struct eo_order_line){.order = order};
      r->shaft[member][k].sigma = sqrt(2) * r->residual / sqrt((double)r->rows);
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
  double square = 0, variance = 0, shift[2] = {0, 0};
  for (int i = 0; i < count; i++) {
    double weight = pow(line[i].order * omega, 4) / 2, noise = line[i].sigma * line[i].sigma;
    double signal = pow(cabs(line[i].amplitude), 2) - 2 * noise;
    square += weight * signal;
    variance += weight * weight * 4 * noise * (fmax(signal, 0) + noise);
    for (int k = 0; k < 2; k++)
      shift[k] += 2 * weight * cabs(line[i].amplitude) * line[i].systematic[k];
  }
  square = fmax(square, 0);
  double rms = sqrt(square), spread = sqrt(variance);
  double above = sqrt(square + spread) - rms, below = (rms - sqrt(fmax(0, square - 2 * spread))) / 2;
  *sigma = hypot(hypot(fmax(above, below), EO_RMS_SYSTEMATIC * rms),
                 rms > 0 ? hypot(shift[0], shift[1]) / (2 * rms) : 0);
  return rms;
}

static bool refused(const struct worker *w)
{
  return eo_findings_worst(w->findings) == EO_SEVERITY_REFUSED;
}

static enum eo_code fit(struct worker *w, struct eo_error *error)
{
  eo_terms_init(&w->terms, w->settings->teeth, w->result->harmonics, w->turns, w->start, w->end);
  eo_beside_init(&w->beside, w->settings->teeth, w->result->harmonics, w->turns);
  enum eo_code code = fit_terms(w, error);
  if (!code)
    code = settle_axis(w, error);
  eo_beside_init(&w->beside, w->settings->teeth, w->result->harmonics, w->turns);
  if (!code)
    code = eo_synchronous_new(&w->synchronous, w->result, w->settings->teeth, w->from, w->turns, error);
  if (!code)
    code = eo_waterfall_new(&w->waterfall, w->result, w->settings->teeth, w->from, error);
  return code ? code : each_row(w, add_residual, "residual", error);
}

static enum eo_code measure(struct worker *w, struct eo_error *error)
{
  struct eo_transmission *r = w->result;
  enum eo_code code = eo_parts_find(&r->parts, w->angles, &w->settings->part, w->findings, w->progress, error);
  if (code || refused(w))
    return code;
  code = choose_rows(w, error);
  if (code)
    return code;
  measure_speed(w);
  judge_axis(w);
  if (refused(w))
    return EO_OK;
  code = fit(w, error);
  if (code)
    return code;
  r->residual = sqrt(r->residual / (double)r->rows);
  read_lines(w);
  code = eo_synchronous_finish(w->synchronous, r, error);
  if (!code)
    code = eo_waterfall_finish(w->waterfall, r, error);
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
  eo_normal_done(&w->normal);
  eo_synchronous_free(w->synchronous);
  eo_waterfall_free(w->waterfall);
  free(w);
  return code;
}

void eo_transmission_done(struct eo_transmission *result)
{
  free(result->spectrum);
  free(result->track);
  result->spectrum = NULL;
  result->track = NULL;
}
