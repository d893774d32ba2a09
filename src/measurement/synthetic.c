#include "measurement/synthetic.h"

#include <math.h>
#include <stdlib.h>

#include "base/random.h"

enum { STREAM_PLACES, STREAM_NOISE, STREAM_JITTER, STREAM_SKEW, STREAM_TRACKS };

static const double DEGREES = 180 / M_PI;

static double duration(const struct eo_synthetic *s)
{
  return 2 * M_PI * s->turns / s->speed;
}

/* The pinion's angle without vibration. */
static double smooth(const struct eo_synthetic *s, double time)
{
  double total = duration(s), x = time / total,
         start = 2 * M_PI * eo_random_unit(eo_random_at(s->seed, STREAM_PLACES, 0, 0), 0);
  double rate = s->swing_turns > 0 ? s->speed / s->swing_turns : 0;
  double slow = rate > 0 ? s->swing / rate * (1 - cos(rate * time)) : 0;
  return start + s->speed * (time + s->drift * total * (x * x - x) / 2 + slow);
}

static double vibration(const struct eo_synthetic *s, double theta)
{
  double complex mesh = cexp(I * s->teeth[EO_PINION] * theta), power = 1;
  double sum = 0;
  for (int h = 0; h < s->orders; h++)
    sum += creal(s->order[h] * (power *= mesh));
  return sum;
}

/* What the shaft's encoder would show at a time if it were without noise and steps. */
static double shown_angle(const struct eo_synthetic *s, int member, double time)
{
  double theta = smooth(s, time), sign = member == EO_GEAR ? 1 : -1,
         share = member == EO_GEAR ? 1 - s->pinion_share : s->pinion_share;
  int gear_teeth = s->teeth[EO_GEAR] + (s->fault == EO_FAULT_TEETH ? (int)s->size : 0);
  double turn = member == EO_GEAR ? theta * s->teeth[EO_PINION] / gear_teeth : theta;
  double place = 2 * M_PI * eo_random_unit(eo_random_at(s->seed, STREAM_PLACES, 0, 1), (uint64_t)member);
  double start = member == EO_GEAR ? 2 * M_PI * eo_random_unit(eo_random_at(s->seed, STREAM_PLACES, 0, 2), 0) : 0;
  return start + turn +
         sign * (share * vibration(s, theta) + s->eccentricity[member] * cos(turn + place)) / s->base_radius[member];
}

static double draw(const struct eo_synthetic *s, uint64_t stream, int64_t row, int channel)
{
  return eo_random_normal(eo_random_at(s->seed, stream, (uint64_t)row, 0), (uint64_t)channel);
}

/* The row of the undisturbed recording that a channel shows. */
static int64_t shown_row(const struct eo_synthetic *s, int64_t row, int channel)
{
  if (row < s->row)
    return row;
  switch (s->fault) {
  case EO_FAULT_DROPPED:
  case EO_FAULT_DROPPED_SILENT:
    return row + s->size;
  case EO_FAULT_SLIP:
    return channel == EO_GEAR ? row + s->size : row;
  case EO_FAULT_STUCK:
    return channel == EO_GEAR ? s->row : row;
  default:
    return s->fault == EO_FAULT_CONSTANT && channel == EO_GEAR ? 0 : row;
  }
}

static double channel_angle(const struct eo_synthetic *s, int64_t row, int channel)
{
  int64_t at = s->fault == EO_FAULT_CONSTANT && channel == EO_GEAR ? 0 : shown_row(s, row, channel);
  double time = (double)at / s->sample_rate + s->jitter * draw(s, STREAM_JITTER, at, 0);
  if (channel == EO_GEAR)
    time += s->skew * draw(s, STREAM_SKEW, at, 0);
  double angle = shown_angle(s, channel, time) + s->noise * draw(s, STREAM_NOISE, at, channel);
  if (channel == EO_GEAR && s->fault == EO_FAULT_SPIKE && row == s->row)
    angle += 0.1;
  if (channel == EO_GEAR && s->fault == EO_FAULT_LOST_COUNT && row >= s->row)
    angle -= 2 * M_PI * (double)s->size / s->lines[EO_GEAR];
  return channel == EO_GEAR && s->fault == EO_FAULT_REVERSED ? -angle : angle;
}

/* ---- rows ---- */

static double written_angle(const struct eo_synthetic *s, double angle, int channel)
{
  double step = s->interpolation > 0 ? 2 * M_PI / ((double)s->lines[channel] * s->interpolation) : 0;
  if (step > 0)
    angle = step * floor(angle / step);
  if (s->output == EO_SYNTHETIC_COUNTS)
    return floor(angle / step + 0.5);
  if (s->wrapped)
    angle -= 2 * M_PI * floor(angle / (2 * M_PI));
  bool in_radians = s->radians || s->fault == EO_FAULT_RADIANS ||
                    (s->fault == EO_FAULT_RADIANS_GEAR && channel == EO_GEAR);
  return in_radians ? angle : DEGREES * angle;
}

static double written_track(const struct eo_synthetic *s, double angle, int64_t row, int channel, int track)
{
  double phase = angle * s->lines[channel], size = s->amplitude * (track ? 1 : 1 + s->gain);
  double value = (track ? cos(phase - s->phase) : sin(phase)) * size + s->offset * s->amplitude * (track ? -0.5 : 1);
  value += s->track_noise * draw(s, STREAM_TRACKS, row, 2 * channel + track);
  if (s->fault == EO_FAULT_SATURATED)
    value = fmin(fmax(value, -0.8 * s->amplitude), 0.8 * s->amplitude);
  return s->track_step > 0 ? s->track_step * round(value / s->track_step) : value;
}

static double written_time(const struct eo_synthetic *s, int64_t row)
{
  int64_t at = s->fault == EO_FAULT_DROPPED ? shown_row(s, row, EO_PINION) : row;
  if (s->fault == EO_FAULT_TIME && row >= s->row)
    at -= s->size > 0 ? s->size : 10;
  return (double)at / s->sample_rate;
}

/* The time at which line `pulse` of an encoder passes, by secants: the angle is all but straight. */
static double pulse_time(const struct eo_synthetic *s, int channel, int64_t pulse)
{
  double step = 2 * M_PI / s->lines[channel], first = ceil(shown_angle(s, channel, 0) / step);
  double wanted = step * (first + (double)pulse),
         rate = channel == EO_GEAR ? s->speed * s->teeth[EO_PINION] / s->teeth[EO_GEAR] : s->speed;
  double time = (wanted - shown_angle(s, channel, 0)) / rate;
  for (int i = 0; i < 30; i++) {
    double off = wanted - shown_angle(s, channel, time);
    time += off / rate;
    if (fabs(off) < 1e-14 * fabs(wanted))
      break;
  }
  return time + s->jitter * draw(s, STREAM_JITTER, pulse, channel);
}

static int64_t pulses_of(const struct eo_synthetic *s, int channel)
{
  double ratio = channel == EO_GEAR ? (double)s->teeth[EO_PINION] / s->teeth[EO_GEAR] : 1;
  return (int64_t)(s->turns * ratio * s->lines[channel]) - 1;
}

static void fill_row(const struct eo_synthetic *s, int64_t row, double *value)
{
  int swapped = s->fault == EO_FAULT_SWAPPED;
  bool empty = s->fault == EO_FAULT_NAN && row >= s->row && row < s->row + (s->size > 0 ? s->size : 1);
  if (s->output == EO_SYNTHETIC_PULSES) {
    for (int channel = 0; channel < 2; channel++)
      value[channel ^ swapped] = row < pulses_of(s, channel) ? pulse_time(s, channel, row) : NAN;
    return;
  }
  value[0] = written_time(s, row);
  for (int channel = 0; channel < 2; channel++) {
    double angle = channel_angle(s, row, channel);
    int place = channel ^ swapped;
    if (s->output == EO_SYNTHETIC_SINE_COSINE) {
      value[1 + 2 * place] = written_track(s, angle, row, channel, 0);
      value[2 + 2 * place] = written_track(s, angle, row, channel, 1);
    } else {
      value[1 + place] = written_angle(s, angle, channel);
    }
  }
  if (empty)
    value[2] = NAN;
}

void eo_synthetic_fill(const struct eo_synthetic *s, int64_t first, int64_t count, double *rows)
{
  int columns = eo_synthetic_columns(s);
  for (int64_t i = 0; i < count; i++)
    fill_row(s, first + i, rows + i * columns);
}

int64_t eo_synthetic_rows(const struct eo_synthetic *s)
{
  if (s->output == EO_SYNTHETIC_PULSES)
    return pulses_of(s, 0) > pulses_of(s, 1) ? pulses_of(s, 0) : pulses_of(s, 1);
  return (int64_t)(duration(s) * s->sample_rate) + 1;
}

int eo_synthetic_columns(const struct eo_synthetic *s)
{
  return s->output == EO_SYNTHETIC_PULSES ? 2 : s->output == EO_SYNTHETIC_SINE_COSINE ? 5 : 3;
}

const char *eo_synthetic_heading(const struct eo_synthetic *s, int column)
{
  static const char *const pulses[] = {"pinion_pulse_s", "gear_pulse_s"}, *const degrees[] = {"t_s", "angle1_deg",
                                                                                              "angle2_deg"};
  static const char *const radians[] = {"t_s", "angle1_rad", "angle2_rad"}, *const counts[] = {"t_s", "count1",
                                                                                               "count2"};
  static const char *const tracks[] = {"t_s", "pinion_sin_V", "pinion_cos_V", "gear_sin_V", "gear_cos_V"};
  switch (s->output) {
  case EO_SYNTHETIC_PULSES:
    return pulses[column];
  case EO_SYNTHETIC_SINE_COSINE:
    return tracks[column];
  case EO_SYNTHETIC_COUNTS:
    return counts[column];
  case EO_SYNTHETIC_ANGLES:
    break;
  }
  return s->radians ? radians[column] : degrees[column];
}

int eo_synthetic_decimals(const struct eo_synthetic *s, int column)
{
  if (s->output == EO_SYNTHETIC_PULSES)
    return 12;
  if (column == 0)
    return 9;
  return s->output == EO_SYNTHETIC_COUNTS ? 0 : s->output == EO_SYNTHETIC_SINE_COSINE ? 6 : s->radians ? 11 : 9;
}

void eo_synthetic_tracks(const struct eo_synthetic *s, struct eo_tracks *tracks)
{
  bool pulses = s->output == EO_SYNTHETIC_PULSES, raw = s->output == EO_SYNTHETIC_SINE_COSINE;
  *tracks = (struct eo_tracks){.time_column = pulses ? -1 : 0, .time_scale = 1, .interval = 1 / s->sample_rate};
  for (int i = 0; i < 2; i++) {
    struct eo_track_channel *c = &tracks->channel[i];
    c->track = pulses ? EO_TRACK_PULSES : raw ? EO_TRACK_SINE_COSINE : EO_TRACK_ANGLE;
    c->column[0] = pulses ? i : raw ? 1 + 2 * i : 1 + i;
    c->column[1] = c->column[0] + 1;
    c->scale = s->output == EO_SYNTHETIC_COUNTS ? 2 * M_PI / ((double)s->lines[i] * s->interpolation)
               : s->radians                     ? 1
                                                : M_PI / 180;
    c->lines = s->lines[i];
    c->unit = EO_TRACK_VOLT;
    c->factor = 1;
  }
}

enum eo_code eo_synthetic_check(const struct eo_synthetic *s, struct eo_error *error)
{
  bool lines = s->output == EO_SYNTHETIC_ANGLES && !s->interpolation;
  if (!(s->speed > 0) || !(s->turns > 0) || !(s->sample_rate > 0) || s->orders < 0 || s->orders > EO_SYNTHETIC_ORDERS)
    return eo_error_set(error, EO_ERROR_INPUT, "", "Speed, turns and sample rate of a rig are positive.");
  if (!lines && (s->lines[0] < 1 || s->lines[1] < 1 || (s->output == EO_SYNTHETIC_COUNTS && s->interpolation < 1)))
    return eo_error_set(error, EO_ERROR_INPUT, "",
                        "Counts, pulses and raw tracks need lines per turn, counts and steps an interpolation.");
  if (s->output == EO_SYNTHETIC_COUNTS &&
      ((double)s->lines[0] * s->interpolation > 1e9 || (double)s->lines[1] * s->interpolation > 1e9))
    return eo_error_set(error, EO_ERROR_INPUT, "", "More than 1e9 counts per turn are no counts any more.");
  if (duration(s) * s->sample_rate > 1e9)
    return eo_error_set(error, EO_ERROR_INPUT, "", "The recording would have %.3g rows, more than 1e9.",
                        duration(s) * s->sample_rate);
  return EO_OK;
}

enum eo_code eo_synthetic_record(const struct eo_synthetic *s, struct eo_recording **recording, struct eo_error *error)
{
  enum { BLOCK = 1024 };
  double rows[BLOCK * EO_SYNTHETIC_COLUMNS];
  int64_t total = eo_synthetic_rows(s);
  enum eo_code code = eo_recording_new(recording, eo_synthetic_columns(s), NULL, error);
  for (int64_t first = 0; first < total && !code; first += BLOCK) {
    int64_t count = total - first < BLOCK ? total - first : BLOCK;
    eo_synthetic_fill(s, first, count, rows);
    code = eo_recording_append(*recording, rows, count, error);
  }
  if (!code && s->output == EO_SYNTHETIC_PULSES)
    for (int channel = 0; channel < 2; channel++)
      eo_recording_set_length(*recording, channel ^ (s->fault == EO_FAULT_SWAPPED), pulses_of(s, channel));
  return code;
}

double eo_synthetic_speed(const struct eo_synthetic *s)
{
  return (smooth(s, duration(s)) - smooth(s, 0)) / duration(s);
}

double eo_synthetic_rms(const struct eo_synthetic *s, int harmonics)
{
  double sum = 0, speed = eo_synthetic_speed(s);
  for (int h = 1; h <= harmonics && h <= s->orders; h++)
    sum += pow(cabs(s->order[h - 1]) * pow(h * s->teeth[EO_PINION] * speed, 2), 2) / 2;
  return sqrt(sum);
}
