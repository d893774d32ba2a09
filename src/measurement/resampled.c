/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Programs that export channels with one time bring them to its rows on straight lines. That takes the mesh orders down
   by a tenth and more and leaves no noise that would say so; but rows between two recorded values lie on the line
   through their neighbours as nearly as numbers are written. */
#include "measurement/angles_private.h"

#include <math.h>

static const double STRAIGHT = 0.01; /* of the usual bend at a row: less is none */
static const double SPARSE = 0.03; /* of the others bend by up to ten times that in fine values; in coarse ones none */
static const double MANY = 0.2;    /* of the others differ from each other; those of half precision are a few dozen */
static const double SAME = 1e-6;   /* of the usual bend */
static const double OFTEN = 0.12;  /* of the rows without a bend; noise leaves 1 in 100 */
static const double MOSTLY = 0.6;  /* the same where most rows lie between recorded ones; noise leaves 1 in 50 */
static const double EVEN = 0.02;   /* of a step of time: rows that are even but for the digits of their times */
static const double MOVING = 0.2;  /* of the usual step */
static const double ROUNDING = 1e-13; /* of an angle: bends are those of the numbers themselves */
enum {
  LEAST = 200, /* rows that tell */
  FEW = 16     /* different steps of times that were rounded once or twice */
};

/* How far the angle at a row is from the line through its neighbours, half of it; 0 when a neighbour hardly moves. */
static double bend_of(const struct eo_sample *sample, int channel, bool even, double usual)
{
  double before = sample[1].angle[channel] - sample[0].angle[channel],
         behind = sample[2].angle[channel] - sample[1].angle[channel];
  double first = sample[1].time - sample[0].time, second = sample[2].time - sample[1].time;
  double part = even ? 0.5 : second / (first + second);
  return fmin(fabs(before), fabs(behind)) > MOVING * usual ? fabs(behind * (1 - part) - before * part) : NAN;
}

/* Rows that are even but for the digits of their times: these make few different steps, and none of the times is
   farther from an even one than the steps differ. */
static bool is_even(struct eo_angles_maker *maker, const struct eo_sample *sample, int count)
{
  double usual = (sample[count - 1].time - sample[0].time) / (count - 1), *step = maker->scratch, farthest = 0;
  int kinds = 1;
  for (int i = 1; i < count; i++) {
    step[i - 1] = sample[i].time - sample[i - 1].time;
    farthest = fmax(farthest, fabs(sample[i].time - sample[0].time - i * usual));
  }
  eo_scan_quantile(step, count - 1, 0.5); /* sorts */
  double spread = step[count - 2] - step[0];
  for (int i = 1; i < count - 1; i++)
    kinds += step[i] - step[i - 1] > SAME * usual;
  bool rounded = kinds <= FEW && step[0] > 0 && farthest <= 1.01 * spread;
  return rounded || fmax(step[count - 2] - usual, usual - step[0]) < EVEN * usual;
}

static double usual_step(struct eo_angles_maker *maker, const struct eo_sample *sample, int count, int channel)
{
  for (int i = 1; i < count; i++)
    maker->scratch[i - 1] = fabs(sample[i].angle[channel] - sample[i - 1].angle[channel]);
  return eo_scan_quantile(maker->scratch, count - 1, 0.5);
}

/* Many of the sorted bends are none beside the one of this share, and values are fine enough to tell. */
static bool is_straight(const double *bend, int n, double share, double often, double rounding)
{
  double large = bend[(int)(share * (n - 1))];
  int straight = 0, slight = 0, values = 0;
  while (straight < n && bend[straight] <= STRAIGHT * large)
    straight++;
  while (straight + slight < n && bend[straight + slight] <= 10 * STRAIGHT * large)
    slight++;
  for (int i = straight + 1; i < n; i++)
    values += bend[i] - bend[i - 1] > SAME * large;
  return large > rounding && straight > often * n && slight > SPARSE * (n - straight) && values > MANY * (n - straight);
}

static void look_at(struct eo_angles_maker *maker, const struct eo_sample *sample, int count, int channel, bool even)
{
  double usual = usual_step(maker, sample, count, channel), *bend = maker->scratch;
  double rounding = ROUNDING * fmax(fabs(sample[0].angle[channel]), fabs(sample[count - 1].angle[channel]));
  int n = 0;
  for (int i = 0; i + 2 < count; i++) {
    bend[n] = bend_of(sample + i, channel, even, usual);
    n += !isnan(bend[n]);
  }
  if (n < LEAST)
    return;
  eo_scan_quantile(bend, n, 0.5); /* sorts */
  maker->raster[channel].blocks++;
  maker->raster[channel].straight += is_straight(bend, n, 0.75, OFTEN, rounding) ||
                                     is_straight(bend, n, 0.98, MOSTLY, rounding);
}

void eo_resampled_note(struct eo_angles_maker *maker, const struct eo_sample *sample, int count)
{
  if (count < LEAST || maker->sampler.pulses)
    return;
  bool even = is_even(maker, sample, count);
  for (int channel = 0; channel < 2; channel++) {
    bool ours = channel == 1 && maker->tracks->interpolated.step > 0;
    if (maker->tracks->channel[channel].track == EO_TRACK_ANGLE && !ours)
      look_at(maker, sample, count, channel, even);
  }
}

void eo_resampled_judge(const struct eo_angles_maker *maker)
{
  for (int channel = 0; channel < 2; channel++)
    if (2 * maker->raster[channel].straight > maker->raster[channel].blocks)
      eo_findings_add(maker->findings, EO_FINDING_SAMPLE_RATE, EO_SEVERITY_REFUSED, channel, NAN,
                      "The %s angle lies on straight lines between some of its rows: a program brought it to these "
                      "times, which takes mesh orders away. Export each channel with its own times instead of a common "
                      "raster.",
                      eo_channel_name(channel));
}
