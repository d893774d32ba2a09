/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scales of raw TDMS values: each takes what another one gives, the first ones the raw value. */
#include "recording/tdms.h"

/* Between the points of a table; beyond its ends the value of the end. */
static double table_value(const struct eo_tdms_scale *scale, double x)
{
  int n = scale->terms[0] < scale->terms[1] ? scale->terms[0] : scale->terms[1];
  const double *y = scale->term[0], *before = scale->term[1];
  bool rises = before[n - 1] > before[0];
  int i = 1;
  while (i < n - 1 && (rises ? x > before[i] : x < before[i]))
    i++;
  double part = before[i] != before[i - 1] ? (x - before[i - 1]) / (before[i] - before[i - 1]) : 0;
  part = part < 0 ? 0 : part > 1 ? 1 : part;
  return y[i - 1] + part * (y[i] - y[i - 1]);
}

/* Sum of c_k x^k by Horner's rule; a linear scale has two terms. */
static double polynomial_value(const struct eo_tdms_scale *scale, double x)
{
  double value = 0;
  for (int k = scale->terms[0]; k-- > 0;)
    value = value * x + scale->term[0][k];
  return value;
}

static double value_of(const struct eo_tdms_channel *channel, int64_t number, double raw)
{
  if (number < 0 || number >= EO_TDMS_SCALES || channel->scale[number].kind == EO_TDMS_NO_SCALE)
    return raw;
  const struct eo_tdms_scale *scale = &channel->scale[number];
  double x = value_of(channel, scale->source[0], raw);
  switch (scale->kind) {
  case EO_TDMS_TABLE:
    return table_value(scale, x);
  case EO_TDMS_ADD:
    return x + value_of(channel, scale->source[1], raw);
  case EO_TDMS_SUBTRACT: /* the left one from the right one, as the drivers do */
    return value_of(channel, scale->source[1], raw) - x;
  default:
    return polynomial_value(scale, x);
  }
}

/* The scale with the highest number gives the channel's values. */
static int64_t last_scale(const struct eo_tdms_channel *channel)
{
  int64_t last = channel->scales - 1;
  return last < EO_TDMS_SCALES ? last : EO_TDMS_SCALES - 1;
}

double eo_tdms_scaled(const struct eo_tdms_channel *channel, double raw)
{
  return channel->scale ? value_of(channel, last_scale(channel), raw) : raw;
}

/* left: scales that one value may still pass; of one that leads to itself, or of sums of sums, there are more. */
static bool can_use(const struct eo_tdms_channel *channel, int64_t number, int *left)
{
  if (number < 0 || number >= EO_TDMS_SCALES || channel->scale[number].kind == EO_TDMS_NO_SCALE)
    return true;
  const struct eo_tdms_scale *scale = &channel->scale[number];
  bool two = scale->kind == EO_TDMS_ADD || scale->kind == EO_TDMS_SUBTRACT;
  bool terms = two || (scale->kind == EO_TDMS_TABLE ? scale->terms[0] > 1 && scale->terms[1] > 1 : scale->terms[0] > 0);
  return --*left >= 0 && scale->kind != EO_TDMS_OTHER_SCALE && terms && can_use(channel, scale->source[0], left) &&
         (!two || can_use(channel, scale->source[1], left));
}

bool eo_tdms_can_scale(const struct eo_tdms_channel *channel)
{
  int left = 4 * EO_TDMS_SCALES;
  if (channel->scales > EO_TDMS_SCALES)
    return false;
  return !channel->scale ||
         (can_use(channel, last_scale(channel), &left) && channel->scale[last_scale(channel)].kind != EO_TDMS_NO_SCALE);
}
