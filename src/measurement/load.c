/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measurement/load.h"

#include <math.h>
#include <stdlib.h>

#include "gear/gear_pair.h"

enum { BLOCK = 4096, SLICES = 50 };
static const double STEADY_TORQUE = 0.1; /* range of the torque over its mean: more is no single operating point */
static const double SAME_TORQUE = 0.05;  /* a column may differ from what was stated by so much */
static const double SAME_RATIO = 0.1;    /* losses between both shafts */
static const double SAME_SPEED = 0.02, OTHER_SPEED = 0.2; /* column against encoder: a doubt, a contradiction */
static const double FAR = 30; /* times the speeds of the load cases: between them and a unit of time or angle taken for
                                 another one (57, 60, 1000) */
static const double RPM = 30 / M_PI;

static const char *const member_name[2] = {"pinion", "gear"};

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

enum eo_code eo_load_read(struct eo_load *load, const struct eo_recording *recording, const struct eo_tracks *tracks,
                          double from, double to, struct eo_error *error)
{
  const struct eo_track_beside *beside[4] = {&tracks->torque[0], &tracks->torque[1], &tracks->speed[0],
                                             &tracks->speed[1]};
  struct eo_load_column *column[4] = {&load->torque[0], &load->torque[1], &load->speed[0], &load->speed[1]};
  int columns = eo_recording_columns(recording), wanted = 0;
  int64_t rows = eo_recording_rows(recording);
  for (int i = 0; i < 4; i++) {
    *column[i] = (struct eo_load_column){NAN, NAN, NAN};
    wanted += beside[i]->scale != 0;
  }
  for (int member = 0; member < 2; member++)
    load->open[member] = !tracks->speed[member].stated;
  load->unnamed = !tracks->speed[EO_PINION].named;
  load->pinion_torque = NAN;
  if (!wanted || tracks->channel[0].track == EO_TRACK_PULSES)
    return EO_OK;
  struct sums *sums = calloc(4, sizeof *sums);
  double *block = malloc(sizeof *block * BLOCK * (size_t)columns), begin = NAN;
  enum eo_code code = sums && block ? EO_OK : eo_error_memory(error);
  for (int64_t first = 0; first < rows && !code; first += BLOCK) {
    int count = rows - first < BLOCK ? (int)(rows - first) : BLOCK;
    code = eo_recording_read(recording, first, count, block, error);
    for (int i = 0; i < count && !code; i++) {
      const double *row = block + (size_t)i * (size_t)columns;
      double time = time_of(tracks, row, first + i);
      begin = isnan(begin) ? time : begin;
      time -= begin;
      for (int k = 0; k < 4 && time >= from && time <= to; k++)
        if (beside[k]->scale != 0)
          add_value(&sums[k], row[beside[k]->column] * beside[k]->scale, (time - from) / (to - from));
    }
  }
  for (int k = 0; k < 4 && !code; k++)
    *column[k] = conclude(&sums[k]);
  free(sums);
  free(block);
  return code;
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
                  "The torque column of the %s has a mean of %.5g N m over what is measured%s.", member_name[from],
                  load_column->mean,
                  from == EO_GEAR ? "; over the ratio of the teeth, without losses, it stands for the pinion's" : "");
  if (spread > STEADY_TORQUE)
    eo_findings_add(findings, EO_FINDING_TORQUE, EO_SEVERITY_WARNING, from, spread,
                    "The torque of the %s is not steady: %.5g to %.5g N m; the vibration belongs to no single load.",
                    member_name[from], load_column->low, load_column->high);
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
                      member_name[member], units[i].name);
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
                      member_name[member], RPM * speed, RPM * known->measured);
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
