/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/load.h"

#include <math.h>
#include <stdlib.h>

#include "gear/gear_pair.h"
#include "gear/names.h"
#include "recording/recorded_unit.h"

enum { BLOCK = 4096, SLICES = 50 };
static const double STEADY_TORQUE = 0.1; /* range of the torque over its mean: more is no single operating point */
static const double SAME_TORQUE = 0.05;  /* a column may differ from what was stated by so much */
static const double SAME_RATIO = 0.1;    /* losses between both shafts */
static const double SAME_SPEED = 0.02, OTHER_SPEED = 0.2; /* column against encoder: a doubt, a contradiction */
static const double FAR = 30; /* times the speeds of the load cases: between them and a unit of time or angle taken for
                                 another one (57, 60, 1000) */
static const double SAME_INTERVAL = 1e-6;
static const double RPM = 30 / M_PI;

struct sums {
  double sum[SLICES];
  int64_t count[SLICES];
};

static void add_value(struct sums *sums, double value, double share)
{
  int slice = share < 0 ? 0 : share >= 1 ? SLICES - 1 : (int)(share * SLICES);
  if (!isfinite(value))
    return;
  sums->sum[slice] += value;
  sums->count[slice]++;
}

static struct eo_load_column conclude(const struct sums *sums)
{
  struct eo_load_column column = {0, INFINITY, -INFINITY};
  int64_t count = 0;
  double sign = 0;
  for (int i = 0; i < SLICES; i++) {
    sign += sums->sum[i];
    count += sums->count[i];
  }
  sign = sign < 0 ? -1 : 1;
  if (!count)
    return (struct eo_load_column){NAN, NAN, NAN};
  for (int i = 0; i < SLICES; i++) {
    double mean = sums->count[i] ? sign * sums->sum[i] / (double)sums->count[i] : NAN;
    column.mean += sign * sums->sum[i] / (double)count;
    column.low = fmin(column.low, mean);
    column.high = fmax(column.high, mean);
  }
  return column;
}

static double time_of(const struct eo_tracks *tracks, const double *row, int64_t at)
{
  return tracks->time_column < 0 ? tracks->interval * (double)at : row[tracks->time_column] * tracks->time_scale;
}

/* When the rows of a column beside the encoders were taken, which may be slower than they are. */
struct own_clock {
  bool same;       /* as theirs */
  int column;      /* of times; -1: rows are even */
  double scale;    /* s per unit of that column */
  double start;    /* s after the first row of the encoders; of times what is added to them */
  double interval; /* s */
  int origin;      /* column of the encoders' times, whose first is time 0; -1: none */
};

static struct own_clock own_clock_of(const struct eo_recording *recording, const struct eo_tracks *tracks, int column)
{
  struct eo_clock own = eo_recording_clock(recording, column),
                  theirs = eo_recording_clock(recording, tracks->channel[0].column[0]);
  double factor;
  bool dated = own.epoch != EO_CLOCK_NO_EPOCH && theirs.epoch != EO_CLOCK_NO_EPOCH;
  struct own_clock clock = {.column = own.column,
                            .scale = tracks->time_scale,
                            .start = dated ? (double)(own.epoch - theirs.epoch) * 1e-9 : 0,
                            .interval = own.interval,
                            .origin = own.column < 0      ? -1
                                      : theirs.column < 0 ? tracks->time_column
                                                          : theirs.column};
  if (own.column >= 0) {
    clock.same = own.column == clock.origin;
    if (eo_unit_find(eo_recording_unit(recording, own.column), &factor) == EO_QUANTITY_TIME)
      clock.scale = factor;
  } else {
    clock.same = !(own.interval > 0) || fabs(own.interval / theirs.interval - 1) < SAME_INTERVAL;
    clock.start += theirs.interval > 0 ? own.start - theirs.start : 0;
  }
  return clock;
}

struct reading {
  const struct eo_tracks *tracks;
  const struct eo_track_beside *beside[4];
  struct own_clock clock[4];
  double begin, origin[4]; /* s: the first time of the encoders, on each clock */
  double from, to;
  struct sums sums[4];
};

static void add_row(struct reading *reading, const double *row, int64_t at)
{
  double time = time_of(reading->tracks, row, at);
  reading->begin = isnan(reading->begin) ? time : reading->begin;
  for (int k = 0; k < 4; k++) {
    const struct own_clock *clock = &reading->clock[k];
    if (reading->beside[k]->scale == 0)
      continue;
    if (isnan(reading->origin[k]))
      reading->origin[k] = clock->origin < 0 ? 0 : row[clock->origin] * reading->tracks->time_scale;
    double own = clock->same          ? time - reading->begin
                 : clock->column >= 0 ? row[clock->column] * clock->scale + clock->start - reading->origin[k]
                                      : clock->start + clock->interval * (double)at;
    if (own >= reading->from && own <= reading->to)
      add_value(&reading->sums[k], row[reading->beside[k]->column] * reading->beside[k]->scale,
                (own - reading->from) / (reading->to - reading->from));
  }
}

static enum eo_code read_rows(struct reading *reading, const struct eo_recording *recording, struct eo_error *error)
{
  int columns = eo_recording_columns(recording);
  int64_t rows = eo_recording_rows(recording);
  double *block = malloc(sizeof *block * BLOCK * (size_t)columns);
  enum eo_code code = block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; first < rows && !code; first += BLOCK) {
    int count = rows - first < BLOCK ? (int)(rows - first) : BLOCK;
    code = eo_recording_read(recording, first, count, block, error);
    for (int i = 0; i < count && !code; i++)
      add_row(reading, block + (size_t)i * (size_t)columns, first + i);
  }
  free(block);
  return code;
}

enum eo_code eo_load_read(struct eo_load *load, const struct eo_recording *recording, const struct eo_tracks *tracks,
                          double from, double to, struct eo_error *error)
{
  struct reading reading = {.tracks = tracks,
                            .beside = {&tracks->torque[0], &tracks->torque[1], &tracks->speed[0], &tracks->speed[1]},
                            .begin = NAN,
                            .origin = {NAN, NAN, NAN, NAN},
                            .from = from,
                            .to = to};
  struct eo_load_column *column[4] = {&load->torque[0], &load->torque[1], &load->speed[0], &load->speed[1]};
  int wanted = 0;
  for (int i = 0; i < 4; i++) {
    *column[i] = (struct eo_load_column){NAN, NAN, NAN};
    wanted += reading.beside[i]->scale != 0;
    if (reading.beside[i]->scale != 0)
      reading.clock[i] = own_clock_of(recording, tracks, reading.beside[i]->column);
  }
  for (int member = 0; member < 2; member++)
    load->open[member] = !tracks->speed[member].stated;
  load->unnamed = !tracks->speed[EO_PINION].named;
  load->pinion_torque = NAN;
  if (!wanted || tracks->channel[0].track == EO_TRACK_PULSES)
    return EO_OK;
  EO_TRY(read_rows(&reading, recording, error));
  for (int k = 0; k < 4; k++)
    *column[k] = conclude(&reading.sums[k]);
  return EO_OK;
}

static void judge_torque(struct eo_load *load, const struct eo_load_known *known, struct eo_findings *findings)
{
  double ratio = (double)known->teeth[EO_PINION] / known->teeth[EO_GEAR];
  double own = load->torque[EO_PINION].mean, other = load->torque[EO_GEAR].mean * ratio;
  int from = isnan(own) ? EO_GEAR : EO_PINION;
  const struct eo_load_column *load_column = &load->torque[from];
  load->pinion_torque = from == EO_GEAR ? other : own;
  if (isnan(load->pinion_torque))
    return;
  double spread = (load_column->high - load_column->low) / load_column->mean;
  eo_findings_add(findings, EO_FINDING_TORQUE, EO_SEVERITY_NOTE, from, load->pinion_torque,
                  "The torque column of the %s has a mean of %.5g N m over what is measured%s.", eo_member_name[from],
                  load_column->mean,
                  from == EO_GEAR ? "; over the ratio of the teeth, without losses, it stands for the pinion's" : "");
  if (spread > STEADY_TORQUE)
    eo_findings_add(findings, EO_FINDING_TORQUE, EO_SEVERITY_WARNING, from, spread,
                    "The torque of the %s is not steady: %.5g to %.5g N m; the vibration belongs to no single load.",
                    eo_member_name[from], load_column->low, load_column->high);
  if (!isnan(own) && !isnan(other) && fabs(other / own - 1) > SAME_RATIO)
    eo_findings_add(findings, EO_FINDING_TORQUE, EO_SEVERITY_WARNING, -1, other / own,
                    "The torque columns contradict each other: %.5g N m at the pinion, %.5g N m at the gear, which "
                    "would be %.5g N m at the pinion.",
                    own, load->torque[EO_GEAR].mean, other);
  if (!isnan(known->torque) && fabs(load->pinion_torque / known->torque - 1) > SAME_TORQUE)
    eo_findings_add(findings, EO_FINDING_TORQUE, EO_SEVERITY_WARNING, from, load->pinion_torque,
                    "The recording has %.5g N m at the pinion, not the stated %.5g N m; the stated one is compared "
                    "with.",
                    load->pinion_torque, known->torque);
}

/* The pinion's speed by the column of a member over that by the encoder. */
static double speed_ratio(const struct eo_load *load, const struct eo_load_known *known, int member)
{
  double ratio = member == EO_GEAR ? (double)known->teeth[EO_GEAR] / known->teeth[EO_PINION] : 1;
  return load->speed[member].mean * ratio / known->measured;
}

/* A column that states no unit and contradicts the encoder in rpm may agree with it in another one. */
static void settle_unit(struct eo_load *load, const struct eo_load_known *known, int member,
                        struct eo_findings *findings)
{
  static const struct {
    const char *name;
    double rpm; /* that one of them is */
  } units[] = {{"rad/s", 30 / M_PI}, {"turns per second", 60}, {"degrees per second", 1. / 6}};
  struct eo_load_column *column = &load->speed[member];
  double off = speed_ratio(load, known, member);
  for (size_t i = 0; load->open[member] && fabs(off - 1) > SAME_SPEED && i < sizeof units / sizeof *units; i++)
    if (fabs(off * units[i].rpm - 1) <= SAME_SPEED) {
      load->open[member] = false;
      column->mean *= units[i].rpm;
      column->low *= units[i].rpm;
      column->high *= units[i].rpm;
      eo_findings_add(findings, EO_FINDING_SPEED, EO_SEVERITY_NOTE, member, column->mean,
                      "The speed column of the %s states no unit; in %s it is that of the encoder.",
                      eo_member_name[member], units[i].name);
    }
}

/* A column that names no shaft is taken for the pinion's; it may be the gear's. */
static void settle_shaft(struct eo_load *load, const struct eo_load_known *known, struct eo_findings *findings)
{
  double ratio = (double)known->teeth[EO_GEAR] / known->teeth[EO_PINION];
  if (!load->unnamed || !isnan(load->speed[EO_GEAR].mean) ||
      !(fabs(speed_ratio(load, known, EO_PINION) * ratio - 1) <= SAME_SPEED))
    return;
  load->speed[EO_GEAR] = load->speed[EO_PINION];
  load->speed[EO_PINION].mean = NAN;
  load->open[EO_GEAR] = load->open[EO_PINION];
  eo_findings_add(findings, EO_FINDING_SPEED, EO_SEVERITY_NOTE, EO_GEAR, load->speed[EO_GEAR].mean,
                  "The speed column tells no shaft; its speed is that of the gear.");
}

/* True when the column speaks for the encoder's speed. */
static bool judge_column(struct eo_load *load, const struct eo_load_known *known, struct eo_findings *findings)
{
  bool agrees = false;
  settle_shaft(load, known, findings);
  for (int member = 0; member < 2; member++) {
    settle_unit(load, known, member, findings);
    double off = fabs(speed_ratio(load, known, member) - 1), speed = speed_ratio(load, known, member) * known->measured;
    bool backed = !isnan(known->speed) && fabs(known->measured / known->speed - 1) < SAME_TORQUE;
    if (isnan(speed))
      continue;
    agrees = agrees || off <= SAME_SPEED;
    if (off > SAME_SPEED)
      eo_findings_add(findings, EO_FINDING_SPEED,
                      off > OTHER_SPEED && !backed ? EO_SEVERITY_REFUSED : EO_SEVERITY_WARNING, member, RPM * speed,
                      "The speed column of the %s says %.6g rpm of the pinion, its encoder %.6g rpm: which of them is "
                      "right, or is the unit of the time or the lines per turn another one? State the speed.",
                      eo_member_name[member], RPM * speed, RPM * known->measured);
  }
  return agrees;
}

/* A speed that no load case comes near, and that nobody stated, is a question. */
static void judge_speed(struct eo_load *load, const struct eo_load_known *known, struct eo_findings *findings)
{
  bool agrees = judge_column(load, known, findings);
  double low = known->expected[0], high = known->expected[1];
  if (agrees || !isnan(known->speed) || !(low > 0) || !(high > 0))
    return;
  if (known->measured > low / FAR && known->measured < high * FAR)
    return;
  eo_findings_add(
      findings, EO_FINDING_SPEED, EO_SEVERITY_REFUSED, -1, RPM * known->measured,
      "The pinion would run at %.6g rpm; the load cases of the design have %.6g to %.6g rpm. Is the time or "
      "the angle in another unit, or were the lines per turn others? State the speed if it is right.",
      RPM * known->measured, RPM * low, RPM * high);
}

void eo_load_judge(struct eo_load *load, const struct eo_load_known *known, struct eo_findings *findings)
{
  judge_torque(load, known, findings);
  judge_speed(load, known, findings);
}
