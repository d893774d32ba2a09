/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* strtod_l */
#include "base/decimal.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FIVES 27 /* 5^27 is the last below 2^63 */

const double eo_decimal_power[23] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                     1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

typedef unsigned __int128 wide;

static uint64_t power_of_five(int exponent)
{
  uint64_t power = 1;
  for (int i = 0; i < exponent; i++)
    power *= 5;
  return power;
}

/* mantissa * 10^exponent to the nearest double, exponent -FIVES..FIVES, mantissa > 0. */
static double scale_exactly(uint64_t mantissa, int exponent)
{
  if (exponent >= 0)
    return ldexp((double)((wide)mantissa * power_of_five(exponent)), exponent);
  /* The quotient has 64 bits or more: a bit for the remainder at its end is enough to round it rightly. */
  uint64_t divisor = power_of_five(-exponent);
  int shift = __builtin_clzll(mantissa);
  wide dividend = (wide)(mantissa << shift) << 64;
  wide quotient = dividend / divisor;
  quotient |= quotient * divisor != dividend;
  return ldexp((double)quotient, exponent - 64 - shift);
}

/* The C library's own conversion, whatever locale the process has set. */
static double convert(const char *text, const char *end, char point)
{
  size_t length = (size_t)(end - text);
  char short_copy[64];
  char *copy = length < sizeof short_copy ? short_copy : malloc(length + 1);
  locale_t locale = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
  double value = NAN;
  if (copy && locale) {
    for (size_t i = 0; i < length; i++)
      copy[i] = text[i] == point ? '.' : (text[i] | 0x20) == 'd' ? 'e' : text[i];
    copy[length] = '\0';
    value = strtod_l(copy, NULL, locale);
    value = isfinite(value) ? value : NAN;
  }
  if (locale)
    freelocale(locale);
  if (copy != short_copy)
    free(copy);
  return value;
}

double eo_decimal_scale(const struct eo_decimal *decimal, const char *text, const char *end, char point)
{
  double value;
  if (decimal->digits <= 19 && decimal->mantissa == 0)
    value = 0;
  else if (decimal->digits <= 19 && decimal->exponent >= -FIVES && decimal->exponent <= FIVES)
    value = scale_exactly(decimal->mantissa, decimal->exponent);
  else
    return convert(text, end, point);
  return decimal->negative ? -value : value;
}
