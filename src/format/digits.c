/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format/digits.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"

typedef unsigned __int128 wide;

/* Powers of five, and by a power of two of ten, with 64 bits. */
#define UP(power) ((uint64_t)(power) << __builtin_clzll(power))
#define FOUR(power) UP(power), UP(power * 5ull), UP(power * 25ull), UP(power * 125ull)
static const uint64_t power_of_five[] = {FOUR(1),
                                         FOUR(625),
                                         FOUR(390625),
                                         FOUR(244140625),
                                         FOUR(152587890625),
                                         FOUR(95367431640625),
                                         FOUR(59604644775390625)};
enum { MOST_DECIMALS = sizeof power_of_five / sizeof *power_of_five - 1 };

/* floor(log2(10^n)) of what follows. */
static int log2_of_power(int n)
{
  return n * 13607 >> 12;
}

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

/* A decimal beside a value: number / 10^decimals. */
struct decimal {
  uint64_t number;
  int decimals;
  bool same; /* it is read back as the value */
};

/* |value| * 10^decimals is here in full, an integer of 127 bits of which 64 and `behind` are behind the point. Of two
   numbers as near the even one, as printf does it. False: it has more bits. */
static bool scale(double value, int decimals, struct decimal *decimal)
{
  static const uint64_t least = (uint64_t)1 << 62;
  uint64_t bits = bits_of(value), significand = (bits << 11 >> 1) | least;
  int behind = 1084 - (int)(bits << 1 >> 53) - log2_of_power(decimals);
  if (decimals < 0 || decimals > MOST_DECIMALS || behind < 1 || behind > 63)
    return false;
  wide scaled = (wide)significand * power_of_five[decimals], half = (wide)1 << behind << 63;
  uint64_t odd = (uint64_t)(scaled >> 64) >> behind & 1, number = (uint64_t)((scaled + half - 1 + odd) >> 64) >> behind;
  wide back = (wide)(number << behind) << 64;
  /* half of the way to the next doubles; below a power of two it is a quarter */
  wide above = (wide)power_of_five[decimals] << 9, below = above >> (significand == least);
  *decimal = (struct decimal){number, decimals, back + below - scaled < above + below};
  return true;
}

/* The value of so many significant digits; false: text has to tell. */
static bool find_decimal(double value, int digits, struct decimal *decimal)
{
  int power_of_two = (int)(bits_of(value) << 1 >> 53) - 1023, exponent = power_of_two * 1233 >> 12; /* log10(2) */
  if (!(fabs(value) < 1e15) || !scale(value, digits - 1 - exponent, decimal))
    return false;
  return decimal->number < power_of_five[digits] >> (63 - log2_of_power(digits)) ||
         scale(value, digits - 2 - exponent, decimal);
}

enum { MOST_DIGITS = 18 }; /* of what is written here, whole pairs, for copies of a fixed size */

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

/* number / 10^decimals without trailing zeros, as C's %g writes it but for the zeros of an exponent. Returns the
   length. */
static int write_decimal(char *text, bool negative, uint64_t number, int decimals)
{
  char room[2 * MOST_DIGITS], *to = text;
  int length = write_digits(room, number), exponent = length - 1 - decimals;
  const char *digits = room + MOST_DIGITS - length;
  for (; decimals > 0 && digits[length - 1] == '0'; decimals--)
    length--;
  *to = '-';
  to += negative;
  if (exponent < 0 && exponent >= -4) { /* 0.000 and the digits */
    memcpy(to, "0.000", 5);
    memcpy(to += 1 - exponent, digits, MOST_DIGITS);
    to += length;
  } else {
    int whole = exponent < 0 ? 1 : exponent + 1;
    memcpy(to, digits, MOST_DIGITS);
    memcpy(to + whole + 1, digits + whole, MOST_DIGITS);
    to[whole] = '.';
    to += length + (length > whole);
  }
  if (exponent < -4) {
    *to++ = 'e';
    *to++ = '-';
    if (exponent <= -10)
      *to++ = (char)('0' + -exponent / 10);
    *to++ = (char)('0' + -exponent % 10);
  }
  *to = '\0';
  return (int)(to - text);
}

/* What is far from 1. */
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
  struct decimal decimal;
  bool negative = bits_of(value) >> 63; /* of a zero, too, whose sign the compiler may not tell */
  if (value == 0)
    return write_decimal(text, negative, 0, 0);
  for (int digits = 9; digits <= 17; digits += digits < 15 ? 3 : 1)
    if (find_decimal(value, digits, &decimal) && decimal.same)
      return write_decimal(text, negative, decimal.number, decimal.decimals);
  return write_long(text, size, value);
}

double eo_digits_round(double value, int digits)
{
  static const uint64_t exact = (uint64_t)1 << 53; /* as are powers of ten up to 22 */
  char text[EO_DIGITS_ROOM];
  struct decimal decimal;
  bool found = value != 0 && find_decimal(value, digits, &decimal);
  if (value == 0 || (found && decimal.same))
    return value;
  if (found && decimal.number < exact && decimal.decimals <= 22)
    return copysign((double)decimal.number / eo_decimal_power[decimal.decimals], value);
  snprintf(text, sizeof text, "%.*g", digits, value);
  return strtod(text, NULL);
}

int eo_digits_write_rounded(char *text, int size, double value, int digits)
{
  struct decimal decimal;
  if (value != 0 && find_decimal(value, digits, &decimal))
    return write_decimal(text, value < 0, decimal.number, decimal.decimals);
  return eo_digits_write(text, size, eo_digits_round(value, digits));
}
