/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/synthetic.h"

#include <math.h>
#include <stdlib.h>

#include "base/random.h"

enum { STREAM_PLACES, STREAM_NOISE, STREAM_JITTER, STREAM_SKEW, STREAM_TRACKS };

static const double DEGREES = 180 / M_PI;
static const double STEP_TURNS = 0.25; /* turns in which the speed changes from one steady state to the other */
static const double RUN_UP_FROM = 0.1; /* of the speed that the run-up leads to */
static const double SQUARE_HIGH = 4.8, SQUARE_LOW = 0.2; /* V */
static const double DOUBLE_PULSE = 0.01;                 /* lines between a pulse and its double */

enum content { TIME, ANGLE, TRACK, PULSE, TORQUE, SPEED };

/* What a column holds; channel: whose clock and values. */
struct column {
  enum content content;
  int channel, track;
};

static bool own_clock(const struct eo_synthetic *synthetic)
{
  return synthetic->gear_rate > 0 || synthetic->gear_delay != 0;
}

static int list_columns(const struct eo_synthetic *synthetic, struct column list[EO_SYNTHETIC_COLUMNS])
{
  int count = 0,
      tracks = synthetic->output == EO_SYNTHETIC_SINE_COSINE || synthetic->output == EO_SYNTHETIC_SQUARE ? 2 : 1;
  bool pulses = synthetic->output == EO_SYNTHETIC_PULSES;
  for (int channel = 0; channel < 2; channel++) {
    if (!pulses && (channel == 0 || own_clock(synthetic)))
      list[count++] = (struct column){TIME, channel, 0};
    for (int track = 0; track < tracks; track++)
      list[count++] = (struct column){pulses ? PULSE : tracks == 2 ? TRACK : ANGLE, channel, track};
  }
  if (synthetic->torque != 0 && !pulses)
    list[count++] = (struct column){TORQUE, 0, 0};
  if (synthetic->shows_speed && !pulses)
    list[count++] = (struct column){SPEED, 0, 0};
  return count;
}

static double rate_of(const struct eo_synthetic *synthetic, int channel)
{
  return channel == EO_GEAR && synthetic->gear_rate > 0 ? synthetic->gear_rate : synthetic->sample_rate;
}

/* Of the way there. */
static double duration(const struct eo_synthetic *synthetic)
{
  return 2 * M_PI * synthetic->turns / synthetic->speed;
}

/* Of the run-up. */
static double run_up_duration(const struct eo_synthetic *synthetic)
{
  return 2 * (2 * M_PI * synthetic->run_up / synthetic->speed) / (1 + RUN_UP_FROM);
}

static double whole_duration(const struct eo_synthetic *synthetic)
{
  double longer = run_up_duration(synthetic) * (1 - RUN_UP_FROM) / 2;
  return synthetic->rest[0] + (duration(synthetic) + longer) * (synthetic->turn_back ? 2 : 1) + synthetic->rest[1];
}

static double log_cosh(double x)
{
  return fabs(x) + log1p(exp(-2 * fabs(x))) - M_LN2;
}

/* The pinion's angle without vibration on its way: speed (1 + drift (t/T - 1/2) + swing sin + step/2 tanh) integrated.
 */
static double way(const struct eo_synthetic *synthetic, double time)
{
  double total = duration(synthetic),
         start = 2 * M_PI * eo_random_unit(eo_random_at(synthetic->seed, STREAM_PLACES, 0, 0), 0);
  double x = time / total, rate = synthetic->swing_turns > 0 ? synthetic->speed / synthetic->swing_turns : 0;
  double slow = rate > 0 ? synthetic->swing / rate * (1 - cos(rate * time)) : 0;
  double change = 2 * M_PI / synthetic->speed * STEP_TURNS; /* s, of the tanh */
  double step = synthetic->step / 2 * change * (log_cosh((time - total / 2) / change) - log_cosh(total / 2 / change));
  return start + synthetic->speed *
                     (time + synthetic->drift * total * (x * x - x) / 2 + slow + (synthetic->step != 0 ? step : 0));
}

/* The same with rests, run through backwards on the way back, slower in the run-up: there time goes by as the integral
   of a speed that rises evenly. */
static double smooth(const struct eo_synthetic *synthetic, double time)
{
  double ramp = run_up_duration(synthetic), total = duration(synthetic) + ramp * (1 - RUN_UP_FROM) / 2;
  time -= synthetic->rest[0];
  if (synthetic->turn_back && time > total)
    time = 2 * total - time;
  if (synthetic->rest[0] > 0 || synthetic->turn_back || ramp > 0)
    time = fmax(time, 0);
  if (synthetic->rest[1] > 0 && !synthetic->turn_back)
    time = fmin(time, total);
  if (ramp > 0 && time < ramp)
    return way(synthetic, RUN_UP_FROM * time + (1 - RUN_UP_FROM) * time * time / (2 * ramp));
  return way(synthetic, time - ramp * (1 - RUN_UP_FROM) / 2);
}

static double vibration(const struct eo_synthetic *synthetic, double theta)
{
  double complex mesh = cexp(I * synthetic->teeth[EO_PINION] * theta), power = 1;
  double sum = 0;
  for (int h = 0; h < synthetic->orders; h++)
    sum += creal(synthetic->order[h] * (power *= mesh));
  return sum;
}

/* First order of a shaft at its angle, m. */
static double shaft_order(const struct eo_synthetic *synthetic, int member, double turn)
{
  double place = 2 * M_PI * eo_random_unit(eo_random_at(synthetic->seed, STREAM_PLACES, 0, 1), (uint64_t)member);
  return synthetic->eccentricity[member] * cos(turn + place);
}

/* What the shaft's encoder would show at a time if it were without noise and steps. */
static double shown_angle(const struct eo_synthetic *synthetic, int member, double time)
{
  double theta = smooth(synthetic, time), sign = member == EO_GEAR ? 1 : -1,
         share = member == EO_GEAR ? 1 - synthetic->pinion_share : synthetic->pinion_share;
  int gear_teeth = synthetic->teeth[EO_GEAR] + (synthetic->fault == EO_FAULT_TEETH ? (int)synthetic->size : 0);
  double turn = member == EO_GEAR ? theta * synthetic->teeth[EO_PINION] / gear_teeth : theta;
  double start = member == EO_GEAR ? 2 * M_PI * eo_random_unit(eo_random_at(synthetic->seed, STREAM_PLACES, 0, 2), 0)
                                   : 0;
  double own = synthetic->run_out
                   ? share * (shaft_order(synthetic, EO_PINION, theta) +
                              shaft_order(synthetic, EO_GEAR, theta * synthetic->teeth[EO_PINION] / gear_teeth))
                   : shaft_order(synthetic, member, turn);
  return start + turn + sign * (share * vibration(synthetic, theta) + own) / synthetic->base_radius[member];
}

static double draw(const struct eo_synthetic *synthetic, uint64_t stream, int64_t row, int channel)
{
  return eo_random_normal(eo_random_at(synthetic->seed, stream, (uint64_t)row, 0), (uint64_t)channel);
}

/* The row of the undisturbed recording that a channel shows. */
static int64_t shown_row(const struct eo_synthetic *synthetic, int64_t row, int channel)
{
  if (row < synthetic->row)
    return row;
  switch (synthetic->fault) {
  case EO_FAULT_DROPPED:
  case EO_FAULT_DROPPED_SILENT:
    return row + synthetic->size;
  case EO_FAULT_SLIP:
    return channel == EO_GEAR ? row + synthetic->size : row;
  case EO_FAULT_STUCK:
    return channel == EO_GEAR ? synthetic->row : row;
  default:
    return synthetic->fault == EO_FAULT_CONSTANT && channel == EO_GEAR ? 0 : row;
  }
}

static double channel_angle(const struct eo_synthetic *synthetic, int64_t row, int channel)
{
  int64_t at = synthetic->fault == EO_FAULT_CONSTANT && channel == EO_GEAR ? 0 : shown_row(synthetic, row, channel);
  double time = (double)at / rate_of(synthetic, channel) + synthetic->jitter * draw(synthetic, STREAM_JITTER, at, 0);
  if (channel == EO_GEAR)
    time += synthetic->gear_delay + synthetic->skew * draw(synthetic, STREAM_SKEW, at, 0);
  double angle = shown_angle(synthetic, channel, time) + synthetic->noise * draw(synthetic, STREAM_NOISE, at, channel);
  if (channel == EO_GEAR && synthetic->fault == EO_FAULT_SPIKE && row == synthetic->row)
    angle += 0.1;
  if (channel == EO_GEAR && synthetic->fault == EO_FAULT_LOST_COUNT && row >= synthetic->row)
    angle -= 2 * M_PI * (double)synthetic->size / synthetic->lines[EO_GEAR];
  return channel == EO_GEAR && synthetic->fault == EO_FAULT_REVERSED ? -angle : angle;
}

/* The angle at the index pulse before it. */
static double turn_begin(double angle)
{
  return 2 * M_PI * floor(angle / (2 * M_PI));
}

static double step_of(const struct eo_synthetic *synthetic, int channel)
{
  return synthetic->interpolation > 0 ? 2 * M_PI / ((double)synthetic->lines[channel] * synthetic->interpolation) : 0;
}

/* Counts since the encoder was switched on, or since the last index pulse once one has come. */
static double written_count(const struct eo_synthetic *synthetic, double angle, int channel)
{
  double step = step_of(synthetic, channel), begin = shown_angle(synthetic, channel, 0);
  if (synthetic->index)
    begin = fabs(turn_begin(angle) - turn_begin(begin)) > 1 ? turn_begin(angle) : begin;
  return synthetic->index ? floor((angle - begin) / step) : floor(angle / step + 0.5);
}

static double written_angle(const struct eo_synthetic *synthetic, int64_t row, int channel)
{
  double angle = channel_angle(synthetic, row, channel), step = step_of(synthetic, channel);
  if (synthetic->output == EO_SYNTHETIC_COUNTS)
    return written_count(synthetic, step * floor(angle / step), channel);
  if (synthetic->output == EO_SYNTHETIC_INCREMENTS)
    return floor(angle / step) - floor(channel_angle(synthetic, row - 1, channel) / step);
  if (step > 0)
    angle = step * floor(angle / step);
  if (synthetic->wrapped)
    angle -= turn_begin(angle);
  bool in_radians = synthetic->radians || synthetic->fault == EO_FAULT_RADIANS ||
                    (synthetic->fault == EO_FAULT_RADIANS_GEAR && channel == EO_GEAR);
  return in_radians ? angle : DEGREES * angle;
}

static double written_track(const struct eo_synthetic *synthetic, int64_t row, int channel, int track)
{
  double phase = channel_angle(synthetic, row, channel) * synthetic->lines[channel],
         size = synthetic->amplitude * (track ? 1 : 1 + synthetic->gain);
  if (synthetic->output == EO_SYNTHETIC_SQUARE)
    return (track ? cos(phase) : sin(phase)) >= 0 ? SQUARE_HIGH : SQUARE_LOW;
  double value = (track ? cos(phase - synthetic->phase) : sin(phase)) * size +
                 synthetic->offset * synthetic->amplitude * (track ? -0.5 : 1);
  value += synthetic->track_noise * draw(synthetic, STREAM_TRACKS, row, 2 * channel + track);
  if (synthetic->fault == EO_FAULT_SATURATED)
    value = fmin(fmax(value, -0.8 * synthetic->amplitude), 0.8 * synthetic->amplitude);
  return synthetic->track_step > 0 ? synthetic->track_step * round(value / synthetic->track_step) : value;
}

static double written_time(const struct eo_synthetic *synthetic, int64_t row, int channel)
{
  int64_t at = synthetic->fault == EO_FAULT_DROPPED ? shown_row(synthetic, row, EO_PINION) : row;
  if (synthetic->fault == EO_FAULT_TIME && row >= synthetic->row)
    at -= synthetic->size > 0 ? synthetic->size : 10;
  return (double)at / rate_of(synthetic, channel) + (channel == EO_GEAR ? synthetic->gear_delay : 0);
}

/* The time at which an encoder's line passes, by secants: the angle goes one way. */
static double passing_time(const struct eo_synthetic *synthetic, int channel, double line)
{
  double step = 2 * M_PI / synthetic->lines[channel],
         first = ceil(shown_angle(synthetic, channel, synthetic->rest[0]) / step);
  double wanted = step * (first + line),
         rate = channel == EO_GEAR ? synthetic->speed * synthetic->teeth[EO_PINION] / synthetic->teeth[EO_GEAR]
                                   : synthetic->speed;
  double time = synthetic->rest[0] + (wanted - shown_angle(synthetic, channel, synthetic->rest[0])) / rate;
  for (int i = 0; i < 400; i++) {
    double off = wanted - shown_angle(synthetic, channel, time);
    time += off / rate;
    if (fabs(off) < 1e-14 * fabs(wanted))
      break;
  }
  return time;
}

static int64_t pulses_of(const struct eo_synthetic *synthetic, int channel)
{
  double ratio = channel == EO_GEAR ? (double)synthetic->teeth[EO_PINION] / synthetic->teeth[EO_GEAR] : 1;
  double teeth = synthetic->lines[channel] - synthetic->missing[channel], turns = synthetic->turns * ratio;
  int64_t pulses = (int64_t)(turns * teeth) - (synthetic->missing[channel] ? (int64_t)teeth : 1);
  if (channel == EO_GEAR && synthetic->fault == EO_FAULT_MISSED_PULSE)
    pulses -= synthetic->size;
  return pulses + (channel == EO_GEAR && synthetic->fault == EO_FAULT_DOUBLE_PULSE);
}

/* The pulse-th time that the wheel gives: teeth that are missing and faults left out or put in. */
static double pulse_time(const struct eo_synthetic *synthetic, int channel, int64_t pulse)
{
  int64_t teeth = synthetic->lines[channel] - synthetic->missing[channel];
  double extra = 0;
  if (channel == EO_GEAR && pulse >= synthetic->row && synthetic->fault == EO_FAULT_MISSED_PULSE)
    pulse += synthetic->size;
  if (channel == EO_GEAR && pulse > synthetic->row && synthetic->fault == EO_FAULT_DOUBLE_PULSE) {
    extra = pulse == synthetic->row + 1 ? DOUBLE_PULSE : 0;
    pulse--;
  }
  long line = pulse / teeth * synthetic->lines[channel] + pulse % teeth;
  return passing_time(synthetic, channel, (double)line + extra) +
         synthetic->jitter * draw(synthetic, STREAM_JITTER, pulse, channel);
}

static int64_t rows_of(const struct eo_synthetic *synthetic, int channel)
{
  double delay = channel == EO_GEAR ? synthetic->gear_delay : 0;
  return synthetic->output == EO_SYNTHETIC_PULSES
             ? pulses_of(synthetic, channel)
             : (int64_t)((whole_duration(synthetic) - delay) * rate_of(synthetic, channel)) + 1;
}

static double cell(const struct eo_synthetic *synthetic, const struct column *column, int64_t row)
{
  int channel = column->content == TIME ? column->channel : column->channel ^ (synthetic->fault == EO_FAULT_SWAPPED);
  double time = (double)row / synthetic->sample_rate, moment = 1e-3 / synthetic->speed;
  if (row >= rows_of(synthetic, channel))
    return NAN;
  switch (column->content) {
  case TIME:
    return written_time(synthetic, row, channel);
  case ANGLE:
    return written_angle(synthetic, row, channel);
  case TRACK:
    return written_track(synthetic, row, channel, column->track);
  case PULSE:
    return pulse_time(synthetic, channel, row);
  case TORQUE:
    return synthetic->torque * (1 + synthetic->torque_change * (time / whole_duration(synthetic) - 0.5));
  case SPEED:
    break;
  }
  return 30 / M_PI * (smooth(synthetic, time + moment) - smooth(synthetic, time - moment)) / (2 * moment);
}

void eo_synthetic_fill(const struct eo_synthetic *synthetic, int64_t first, int64_t count, double *rows)
{
  struct column list[EO_SYNTHETIC_COLUMNS];
  int columns = list_columns(synthetic, list);
  for (int64_t i = 0; i < count; i++) {
    int64_t row = first + i;
    bool empty = synthetic->fault == EO_FAULT_NAN && row >= synthetic->row &&
                 row < synthetic->row + (synthetic->size > 0 ? synthetic->size : 1);
    for (int c = 0; c < columns; c++)
      rows[i * columns + c] = cell(synthetic, &list[c], row);
    if (empty && columns > 2)
      rows[i * columns + 2] = NAN;
  }
}

int64_t eo_synthetic_rows(const struct eo_synthetic *synthetic)
{
  return rows_of(synthetic, 0) > rows_of(synthetic, 1) ? rows_of(synthetic, 0) : rows_of(synthetic, 1);
}

int eo_synthetic_columns(const struct eo_synthetic *synthetic)
{
  struct column list[EO_SYNTHETIC_COLUMNS];
  return list_columns(synthetic, list);
}

const char *eo_synthetic_heading(const struct eo_synthetic *synthetic, int column)
{
  static const char *const time[] = {"t_s", "t2_s"}, *const pulses[] = {"pinion_pulse_s", "gear_pulse_s"};
  static const char *const degrees[] = {"angle1_deg", "angle2_deg"}, *const radians[] = {"angle1_rad", "angle2_rad"};
  static const char *const counts[] = {"count1", "count2"};
  static const char *const sines[2][2] = {{"pinion_sin_V", "pinion_cos_V"}, {"gear_sin_V", "gear_cos_V"}};
  static const char *const squares[2][2] = {{"pinion_A_V", "pinion_B_V"}, {"gear_A_V", "gear_B_V"}};
  struct column list[EO_SYNTHETIC_COLUMNS];
  list_columns(synthetic, list);
  const struct column *this_column = &list[column];
  bool counted = synthetic->output == EO_SYNTHETIC_COUNTS || synthetic->output == EO_SYNTHETIC_INCREMENTS;
  switch (this_column->content) {
  case TIME:
    return time[this_column->channel];
  case PULSE:
    return pulses[this_column->channel];
  case TRACK:
    return (synthetic->output == EO_SYNTHETIC_SQUARE ? squares : sines)[this_column->channel][this_column->track];
  case TORQUE:
    return "torque1_Nm";
  case SPEED:
    return "speed1_rpm";
  case ANGLE:
    break;
  }
  return (counted ? counts : synthetic->radians ? radians : degrees)[this_column->channel];
}

int eo_synthetic_decimals(const struct eo_synthetic *synthetic, int column)
{
  struct column list[EO_SYNTHETIC_COLUMNS];
  list_columns(synthetic, list);
  bool counted = synthetic->output == EO_SYNTHETIC_COUNTS || synthetic->output == EO_SYNTHETIC_INCREMENTS;
  switch (list[column].content) {
  case TIME:
    return 9;
  case PULSE:
    return 12;
  case TRACK:
    return 6;
  case TORQUE:
  case SPEED:
    return 3;
  case ANGLE:
    break;
  }
  return counted ? 0 : synthetic->radians ? 11 : 9;
}

static enum eo_code check_kind(const struct eo_synthetic *synthetic, struct eo_error *error)
{
  bool pulses = synthetic->output == EO_SYNTHETIC_PULSES, counted = synthetic->output == EO_SYNTHETIC_COUNTS;
  if (pulses && (synthetic->turn_back || synthetic->run_up > 0))
    return eo_error_set(error, EO_ERROR_INPUT, "", "Pulses are recorded without a way back and without a run-up.");
  if (synthetic->run_up < 0 || synthetic->run_up > synthetic->turns)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The run-up is longer than the recording.");
  if (synthetic->index && !counted)
    return eo_error_set(error, EO_ERROR_INPUT, "", "An index pulse goes with counts.");
  for (int i = 0; i < 2; i++)
    if (synthetic->missing[i] && (!pulses || synthetic->missing[i] > synthetic->lines[i] / 3))
      return eo_error_set(error, EO_ERROR_INPUT, "",
                          "Missing teeth go with pulses, and leave two thirds of the wheel.");
  if (fabs(synthetic->drift) / 2 + synthetic->swing + fabs(synthetic->step) / 2 >= 1)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Drift, swing and step of the speed would stop the shaft.");
  return EO_OK;
}

enum eo_code eo_synthetic_check(const struct eo_synthetic *synthetic, struct eo_error *error)
{
  bool lines = synthetic->output == EO_SYNTHETIC_ANGLES && !synthetic->interpolation,
       counted = synthetic->output == EO_SYNTHETIC_COUNTS || synthetic->output == EO_SYNTHETIC_INCREMENTS;
  if (!(synthetic->speed > 0) || !(synthetic->turns > 0) || !(synthetic->sample_rate > 0) || synthetic->orders < 0 ||
      synthetic->orders > EO_SYNTHETIC_ORDERS)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Speed, turns and sample rate of a rig are positive.");
  if (!lines && (synthetic->lines[0] < 1 || synthetic->lines[1] < 1 || (counted && synthetic->interpolation < 1)))
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "Counts, pulses and raw tracks need lines per turn, counts and steps an interpolation.");
  if (counted && ((double)synthetic->lines[0] * synthetic->interpolation > 1e9 ||
                  (double)synthetic->lines[1] * synthetic->interpolation > 1e9))
    return eo_error_set(error, EO_ERROR_INPUT, "", "More than 1e9 counts per turn are no counts any more.");
  enum eo_code code = check_kind(synthetic, error);
  if (!code && whole_duration(synthetic) * rate_of(synthetic, EO_GEAR) > 1e9)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The recording would have more than 1e9 rows.");
  if (!code && whole_duration(synthetic) * synthetic->sample_rate > 1e9)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The recording would have %.3g rows, more than 1e9.",
                        whole_duration(synthetic) * synthetic->sample_rate);
  return code;
}

double eo_synthetic_speed(const struct eo_synthetic *synthetic)
{
  return (way(synthetic, duration(synthetic)) - way(synthetic, 0)) / duration(synthetic);
}

double eo_synthetic_swing(const struct eo_synthetic *synthetic)
{
  double turn = 2 * M_PI / synthetic->speed, low = INFINITY, high = 0;
  for (int i = 0; i + 1 <= synthetic->turns; i++) {
    double speed = (way(synthetic, (i + 1) * turn) - way(synthetic, i * turn)) / turn;
    low = fmin(low, speed);
    high = fmax(high, speed);
  }
  return high > low ? (high - low) / synthetic->speed : 0;
}

double eo_synthetic_rms(const struct eo_synthetic *synthetic, int harmonics)
{
  double sum = 0, speed = eo_synthetic_speed(synthetic);
  for (int h = 1; h <= harmonics && h <= synthetic->orders; h++)
    sum += pow(cabs(synthetic->order[h - 1]) * pow(h * synthetic->teeth[EO_PINION] * speed, 2), 2) / 2;
  return sqrt(sum);
}
