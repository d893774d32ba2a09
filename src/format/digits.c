/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/digits.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EXACT_POWER = 22 }; /* the largest power of ten that is a double */
static const double power[EXACT_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                              1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* 00, 01, .. 99 */
static const char pair_of_digits[] =
    "0001020304050607080910111213141516171819202122232425262728293031323334353637383940414243444546474849"
    "5051525354555657585960616263646566676869707172737475767778798081828384858687888990919293949596979899";

static uint64_t bits_of(double value)
{
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

/* floor(log10(value)) for 1 <= value < 1e22: from the binary exponent, log10(2) = 1233/4096. */
static int find_exponent(double value)
{
  int exponent = ((int)(bits_of(value) >> 52) - 1023) * 1233 >> 12;
  return exponent + (value >= power[exponent + 1]);
}

/* Decimals that show so many digits of a positive value, one less for some just below a power of ten; -1: none of what
   follows can be done exactly. */
static int find_decimals(double value, int digits)
{
  if (!(value >= 1e-13 && value < 1e15))
    return -1;
  int decimals = digits - 1 - (value >= 1 ? find_exponent(value) : find_exponent(value * 1e13) - 13);
  return decimals >= 0 && decimals <= EXACT_POWER ? decimals : -1;
}

enum { MOST_DIGITS = 24 }; /* of a number of 64 bits, in whole words for copies of a fixed size */

/* The digits of a number above 0, at the end of `digits`; returns how many. Two at a time, and in 32 bits as soon as
   that is enough: divisions take longer than all else here. */
static int write_digits(char digits[MOST_DIGITS], uint64_t number)
{
  char *to = digits + MOST_DIGITS;
  for (; number >> 32; number /= 100)
    memcpy(to -= 2, pair_of_digits + 2 * (number % 100), 2);
  uint32_t rest = (uint32_t)number;
  for (; rest >= 100; rest /= 100)
    memcpy(to -= 2, pair_of_digits + 2 * (rest % 100), 2);
  memcpy(to -= 2, pair_of_digits + 2 * rest, 2);
  return (int)(digits + MOST_DIGITS - to) - (rest < 10);
}

/* number / 10^decimals without trailing zeros, as C's %g writes it but for the zeros of an exponent. Writes within 32
   characters; returns the length. */
static int write_decimal(char *text, bool negative, uint64_t number, int decimals)
{
  char room[2 * MOST_DIGITS], *to = text;
  for (; decimals > 0 && number % 10 == 0; decimals--)
    number /= 10;
  int length = write_digits(room, number), exponent = length - 1 - decimals;
  const char *digits = room + MOST_DIGITS - length;
  *to = '-';
  to += negative;
  if (exponent < 0 && exponent >= -4) { /* 0.000 and the digits */
    memcpy(to, "0.000", 5);
    memcpy(to += 1 - exponent, digits, MOST_DIGITS);
    to += length;
  } else { /* the digits, those before the point moved to make room for it */
    int whole = exponent < 0 ? 1 : exponent + 1;
    memcpy(to + 1, digits, MOST_DIGITS);
    for (int i = 0; i < whole; i++)
      to[i] = to[i + 1];
    to[whole] = '.';
    to += length + (length > whole);
  }
  if (exponent < -4) {
    *to++ = 'e';
    *to++ = '-';
    if (exponent <= -10)
      *to++ = '1';
    *to++ = (char)('0' + -exponent % 10);
  }
  *to = '\0';
  return (int)(to - text);
}

/* What the loop below finds, without printing and reading: a decimal number of up to 15 digits is the nearest double of
   its digits over a power of ten, as long as both are exact. Returns its length; 0: not so short, or too large or
   small. */
static int write_short(char *text, double value)
{
  double size = fabs(value);
  for (int digits = 9; digits <= 15; digits += 3) {
    int decimals = find_decimals(size, digits);
    double number = decimals < 0 ? 0 : nearbyint(size * power[decimals]);
    if (decimals < 0 || number >= 1e15 || number / power[decimals] != size)
      continue;
    return write_decimal(text, value < 0, (uint64_t)number, decimals);
  }
  return 0;
}

static int write_long(char *text, int size, double value)
{
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, (size_t)size, "%.*g", digits, value);
    if (strtod(text, NULL) == value)
      break;
  }
  char *exponent = strchr(text, 'e'); /* 1e-07 -> 1e-7, 1e+20 -> 1e20 */
  if (exponent) {
    char *to = exponent + 1, *from = to;
    if (*from == '-')
      to = ++from;
    while (*from == '+' || (*from == '0' && from[1]))
      from++;
    memmove(to, from, strlen(from) + 1);
  }
  return (int)strlen(text);
}

int eo_digits_write(char *text, int size, double value)
{
  uint64_t bits =
      bits_of(value); /* for the sign of a zero: where it compares values, the compiler may take all zeros for one */
  int length = bits << 1 ? write_short(text, value) : write_decimal(text, bits >> 63, 0, 0);
  return length ? length : write_long(text, size, value);
}

/* number / 10^decimals is |value| of so many digits: through integers where that is exact and no tie is near. False:
   text has to tell. */
static bool round_exactly(double value, int digits, uint64_t *number, int *decimals)
{
  double size = fabs(value);
  *decimals = find_decimals(size, digits);
  if (*decimals < 0)
    return false;
  double scaled = size * power[*decimals];
  int64_t whole = (int64_t)scaled; /* below 1e18; a processor has an instruction for signed ones */
  double past = scaled - (double)whole - 0.5;
  whole += past > 0;
  *number = (uint64_t)whole;
  return scaled >= power[digits - 1] * (1 + 1e-12) && (double)whole < power[digits] && fabs(past) > 1e-15 * scaled;
}

double eo_digits_round(double value, int digits)
{
  char text[EO_DIGITS_ROOM];
  uint64_t number;
  int decimals;
  if (value == 0)
    return value;
  if (round_exactly(value, digits, &number, &decimals))
    return copysign((double)number / power[decimals], value);
  snprintf(text, sizeof text, "%.*g", digits, value);
  return strtod(text, NULL);
}

int eo_digits_write_rounded(char *text, int size, double value, int digits)
{
  uint64_t number;
  int decimals;
  if (value != 0 && round_exactly(value, digits, &number, &decimals))
    return write_decimal(text, value < 0, number, decimals);
  return eo_digits_write(text, size, eo_digits_round(value, digits));
}
